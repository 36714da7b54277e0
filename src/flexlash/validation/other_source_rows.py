"""Other sources: from the typed table to records in SI, and what in a row contradicts what else stands there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from flexlash.schema.columns import columns_of
from flexlash.schema.decision_columns import source_unit
from flexlash.schema.decision_rows import OtherSource
from flexlash.schema.findings import spelled_out
from flexlash.schema.part_row import PartRow
from flexlash.schema.spellings import plain
from flexlash.schema.units import find_unit
from flexlash.validation.ledger import Ledger
from flexlash.validation.validated import Table

__all__ = ["MOST_SOURCES", "SourceRows", "other_sources_of", "report_unused_limits"]

_COLUMNS = columns_of("Other sources")
_DEVIATIONS = ("lower_deviation", "upper_deviation")
_SCATTER = ("distribution", "limits_sigma")
_ANGLE, _RADIAL = "arcmin", "mm radial play"
_PLAUSIBLE = {"arcmin": 600.0, "mm": 1.0}
"""Greatest play and deviation that is plausible, in the unit of the entry."""

MOST_SOURCES = 50
"""Most sources of a drive: the work for each variant grows with every one that scatters."""

_EDGE = PartRow.edge
"""What counts as 0: deviations that cancel a value as decimals may miss it by a last binary digit."""


@dataclass(frozen=True, kw_only=True)
class SourceRows:
    """The sound rows of Other sources; `are_faulty` where another has an error, so that their sum lacks a source."""

    rows: tuple[OtherSource, ...] = ()
    are_faulty: bool = False


def other_sources_of(table: Table, ledger: Ledger) -> SourceRows:
    """Return the sources of a sheet; `ledger` holds what was found in it so far, and gets what is wrong with rows."""
    doubled = _report_twice(table, ledger)
    sound = []
    are_faulty = ledger.everything or bool(doubled) or bool(table.faulty)
    for record in table.frame.iter_rows(named=True):
        before = len(ledger.findings)
        _check_row(table, ledger, record)
        if ledger.has_errors(before):
            are_faulty = True
        elif record["row"] not in doubled and not any((record["row"], key) in table.faulty for key in _COLUMNS):
            sound.append(_source(record))
    if table.frame.height > MOST_SOURCES:
        first = table.frame["row"][MOST_SOURCES]
        ledger.add_in(table, "E385", first, "source", known=table.frame.height, other=MOST_SOURCES)
        are_faulty = True
    return SourceRows(rows=tuple(sound), are_faulty=are_faulty)


def report_unused_limits(variants: Table, ledger: Ledger) -> None:
    """Warn once of system limits where no source is entered, so that there is no system to judge."""
    index = variants.heading.columns.get("system_limit_arcmin")
    if index is None:
        return
    is_given = (
        index in variants.whole.filled if variants.whole else any(index in row for row in variants.cells.values())
    )
    if is_given:
        ledger.add_in(variants, "W466", variants.heading.row, "system_limit_arcmin")


def _report_twice(table: Table, ledger: Ledger) -> set[int]:
    """Report every row whose source another row names too; return the rows."""
    rows: dict[str, list[int]] = {}
    for row, name in table.frame.select("row", "source").drop_nulls().iter_rows():
        rows.setdefault(plain(name), []).append(row)
    doubled = {row: others for group in rows.values() for row, others in table.partners(group, "source")}
    for row, others in doubled.items():
        ledger.add_in(table, "E361", row, "source", value=table.entered(row, "source"), other=others)
    return set(doubled)


def _check_row(table: Table, ledger: Ledger, record: Mapping[str, Any]) -> None:
    """Check what the cells of a row must be to one another; those with a fault of their own are left alone."""
    row = record["row"]
    faulty = {key for key in _COLUMNS if (row, key) in table.faulty}
    for key, requirement in _missing(record, faulty):
        ledger.add_in(table, "E201", row, key, requirement=requirement)
    for key, words in _misplaced(record, faulty):
        ledger.add_in(table, "E362", row, key, value=table.entered(row, key), detail=words)
    for key, words in _without_part(record, faulty):
        ledger.add_in(table, "W461", row, key, value=table.entered(row, key), detail=words)
    if not faulty.intersection({"enter_as", "value_arcmin", "kind", *_DEVIATIONS}):
        _check_play(table, ledger, record)


def _missing(record: Mapping[str, Any], faulty: set[str]) -> Iterator[tuple[str, str]]:
    """Yield the blank cells that another cell of the row requires, each with what is required."""
    blank = {key for key in _COLUMNS if record[key] is None} - faulty
    form, lower, upper = record["enter_as"], *(record[key] for key in _DEVIATIONS)
    if form not in {None, _ANGLE} and "enter_as" not in faulty and "radius_mm" in blank:
        yield "radius_mm", f"{_COLUMNS['radius_mm'].requirement}, at which the play in mm acts,"
    if record["side"] == "input" and "side" not in faulty and "ratio" in blank:
        yield "ratio", f"{_COLUMNS['ratio'].requirement}, by which an input side is divided,"
    for key, beside in zip(_DEVIATIONS, (upper, lower), strict=True):
        if key in blank and beside is not None:
            yield key, "a number beside the other deviation (0 is a value)"


def _misplaced(record: Mapping[str, Any], faulty: set[str]) -> Iterator[tuple[str, str]]:
    """Yield the cells that what else stands in the row leaves no meaning, each with the reason."""
    form, side = record["enter_as"] or _ANGLE, record["side"] or "output"
    if "enter_as" not in faulty:
        if record["radius_mm"] is not None and form == _ANGLE:
            yield "radius_mm", "the row is entered as arcmin, and an angle needs no radius"
        if record["pressure_angle_deg"] is not None and form != _RADIAL:
            yield "pressure_angle_deg", f"the row is entered as {form}, and only a radial play has a pressure angle"
    if record["ratio"] is not None and side == "output" and "side" not in faulty:
        yield "ratio", "the row is one of the output, and only a play of the input is divided by a ratio"


def _without_part(record: Mapping[str, Any], faulty: set[str]) -> Iterator[tuple[str, str]]:
    """Yield the cells that do no harm and nothing else, each with the reason."""
    if record["kind"] == "random" and record["value_arcmin"] and "kind" not in faulty:
        yield "value_arcmin", "of a random source only the deviations combine"
    scatters = any(record[key] is not None or key in faulty for key in _DEVIATIONS)
    for key in _SCATTER:
        if record[key] is not None and not scatters:
            yield key, "without deviations the source does not scatter"
    if record["limits_sigma"] is not None and scatters and record["distribution"] in {"uniform", "triangular"}:
        yield "limits_sigma", f"a {record['distribution']} source scatters between its deviations alone"


def _check_play(table: Table, ledger: Ledger, record: Mapping[str, Any]) -> None:
    """Check value and deviations, in the unit of the entry, where they can be read."""
    row, value, (lower, upper) = record["row"], record["value_arcmin"], (record[key] for key in _DEVIATIONS)
    unit = source_unit(record["enter_as"])
    if lower is None and upper is None:
        if value is None or record["kind"] == "random":
            is_random = record["kind"] == "random"
            detail = (
                "deviations, which are all that a random source has," if is_random else "a value, deviations or both"
            )
            ledger.add_in(table, "E363", row, "lower_deviation" if is_random else "value_arcmin", detail=detail)
    elif lower is not None and upper is not None:
        if lower > upper:
            ledger.add_in(table, "E318", row, "lower_deviation", value=lower, other=upper)
        elif record["kind"] != "random":
            ends = (value or 0.0) + lower, (value or 0.0) + upper
            if found := _negative_play(*ends):
                code, play = found
                facts = {"value": lower, "detail": f"{spelled_out(play)} {unit}"}
                ledger.add_in(table, code, row, "lower_deviation", **facts)
    for key in ("value_arcmin", *_DEVIATIONS):
        if record[key] is not None and abs(record[key]) > _PLAUSIBLE[unit]:
            facts = {"value": f"{record[key]:.10g}", "detail": f"at most {spelled_out(_PLAUSIBLE[unit])} {unit}"}
            ledger.add_in(table, "W440", row, key, **facts)


def _negative_play(least: float, most: float) -> tuple[str, float] | None:
    """Return the code of a play that is negative on average, or at the least, and how much it is; else None."""
    middle = (least + most) / 2
    code, found = ("E364", middle) if middle < -_EDGE else ("W462", least)
    return (code, found) if found < -_EDGE else None


def _source(record: Mapping[str, Any]) -> OtherSource:
    """Return a sound row in SI; the value of a random source takes no part."""
    form: Any = record["enter_as"] or _ANGLE
    unit = find_unit(source_unit(form), "angle" if form == _ANGLE else "length")
    size = unit.si if unit else 1.0
    is_random = record["kind"] == "random"
    angle, radius = _COLUMNS["pressure_angle_deg"], record["radius_mm"]
    pressure = float(record["pressure_angle_deg"] or angle.default or 0)
    given = {key: record[key] for key in (*_SCATTER, "side", "ratio", "kind") if record[key] is not None}
    return OtherSource(
        row=record["row"],
        name=record["source"],
        enter_as=form,
        value=0.0 if is_random else (record["value_arcmin"] or 0.0) * size,
        lower=(record["lower_deviation"] or 0.0) * size,
        upper=(record["upper_deviation"] or 0.0) * size,
        radius=None if radius is None else radius * _COLUMNS["radius_mm"].si_unit.si,
        pressure_angle=pressure * angle.si_unit.si if form == _RADIAL else None,
        **given,
    )
