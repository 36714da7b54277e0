"""Levers: from the typed table to records in SI, and what in a row contradicts what else stands there."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from flexlash.schema.column import Column
from flexlash.schema.columns import DIMENSIONS, columns_of
from flexlash.schema.decision_columns import MATERIAL
from flexlash.schema.decision_rows import LeverRow
from flexlash.schema.findings import spelled_out
from flexlash.validation.ledger import Ledger
from flexlash.validation.validated import Table

__all__ = ["ALL_LEVERS", "Levers", "lever_rows_of", "withheld_levers"]

_COLUMNS = columns_of("Levers")
ALL_LEVERS = frozenset(_COLUMNS["dimension"].choices)
"""Every dimension that Levers may name, and material."""

_RANGE = ("lowest", "highest", "step")
_TOLERANCE = ("tolerance_may_change", "cost_per_grade")


@dataclass(frozen=True, kw_only=True)
class Levers:
    """What Levers says by dimension; `withheld` are dimensions that an error there leaves unknown.

    Advice that overlooks what nobody can do is worse than none: of these neither value nor tolerance may change.
    """

    rows: Mapping[str, LeverRow] = field(default_factory=dict)
    withheld: frozenset[str] = frozenset()


def lever_rows_of(table: Table, variants: Table | None, ledger: Ledger) -> Levers:
    """Return the levers of a sheet; `ledger` holds what was found in it so far, and gets what is wrong with rows.

    An error withholds the dimension of its row; all of them where it cannot be told which that is.
    """
    doubled = _report_twice(table, ledger)
    rows: dict[str, LeverRow] = {}
    withheld = set(ALL_LEVERS) if ledger.everything else set()
    for record in table.frame.iter_rows(named=True):
        row, dimension = record["row"], record["dimension"]
        faulty = {key for key in _COLUMNS if (row, key) in table.faulty}
        if dimension is None or "dimension" in faulty:
            withheld |= ALL_LEVERS
            continue
        before = len(ledger.findings)
        _check_row(table, ledger, record, faulty)
        if dimension != MATERIAL:
            _check_range(table, variants, ledger, record)
        if faulty or row in doubled or ledger.has_errors(before):
            withheld.add(dimension)
        else:
            rows[dimension] = _lever(record)
    return Levers(rows=rows | withheld_levers(withheld), withheld=frozenset(withheld))


def withheld_levers(dimensions: Iterable[str]) -> dict[str, LeverRow]:
    """Return the rows of dimensions of which nothing may be advised, in the order of the list."""
    return {
        name: LeverRow(row=0, dimension=name, may_change=False, tolerance_may_change=False)
        for name in sorted(dimensions, key=_COLUMNS["dimension"].choices.index)
    }


def _report_twice(table: Table, ledger: Ledger) -> set[int]:
    """Report every row whose dimension another row has too; return the rows."""
    rows: dict[str, list[int]] = {}
    for row, name in table.frame.select("row", "dimension").drop_nulls().iter_rows():
        rows.setdefault(name, []).append(row)
    doubled = {row: others for group in rows.values() for row, others in table.partners(group, "dimension")}
    for row, others in doubled.items():
        ledger.add_in(table, "E361", row, "dimension", value=table.entered(row, "dimension"), other=others)
    return set(doubled)


def _check_row(table: Table, ledger: Ledger, record: Mapping[str, Any], faulty: set[str]) -> None:
    """Report cells that the kind of lever leaves no meaning, and those that take no part."""
    row, is_material = record["row"], record["dimension"] == MATERIAL
    for key in (*_RANGE, *_TOLERANCE):
        if record[key] is None or not is_material:
            continue
        words = "the choice of another material has no range, no step and no tolerance"
        ledger.add_in(table, "E362", row, key, value=table.entered(row, key), detail=words)
    if record["may_change"] == "no" and not is_material and "may_change" not in faulty:
        for key in _RANGE:
            if record[key] is not None:
                words = "the row says that the dimension may not change"
                ledger.add_in(table, "W461", row, key, value=table.entered(row, key), detail=words)


def _check_range(table: Table, variants: Table | None, ledger: Ledger, record: Mapping[str, Any]) -> None:
    """Check lowest, highest and step beside one another, the bounds of the dimension and the entered variants."""
    row, column = record["row"], DIMENSIONS[record["dimension"]]
    before = len(ledger.findings)
    for key in ("lowest", "highest"):
        if record[key] is not None and (code := _out_of_bounds(column, record[key], is_highest=key == "highest")):
            ledger.add_in(table, code, row, key, value=record[key], requirement=column.requirement)
    lowest, highest, step = (record[key] for key in _RANGE)
    if lowest is not None and highest is not None and lowest > highest:
        ledger.add_in(table, "E365", row, "lowest", value=lowest, other=highest)
    if len(ledger.findings) > before:
        return
    entered = _entered(variants, column)
    if step is not None and (words := _step_words(column, record, entered)):
        ledger.add_in(table, "W463", row, "step", value=step, detail=words)
    low, high = -math.inf if lowest is None else lowest, math.inf if highest is None else highest
    if entered and not any(low <= value <= high for value in entered):
        least, most = (f"{end:.10g}" for end in (min(entered), max(entered)))
        words = f"{least}{column.unit_behind}" if least == most else f"{least} to {most}{column.unit_behind}"
        key = "lowest" if lowest is not None and min(entered) < lowest else "highest"
        ledger.add_in(table, "W464", row, key, value=record[key], detail=words, other=column.plain_name)


def _out_of_bounds(column: Column, value: float, *, is_highest: bool) -> str:
    """Return the code of an end of a range that the dimension cannot have, else an empty text.

    A lowest value may be the bound that a dimension must exceed: it then says nothing more.
    """
    low, high = column.minimum, column.maximum
    if low is not None and (value < low or (is_highest and column.exclusive_minimum and value == low)):
        return "E207"
    return "E208" if high is not None and value > high else ""


def _step_words(column: Column, record: Mapping[str, Any], entered: list[float]) -> str:
    """Return what is odd about a step, in words: it leaves no room, or exceeds what is entered."""
    lowest, highest, step = (record[key] for key in _RANGE)
    if lowest is not None and highest is not None and step > highest - lowest:
        # The decimals of range and step meet on a multiple but for last digits.
        multiples = math.floor(highest / step + 1e-9) - math.ceil(lowest / step - 1e-9) + 1
        return f"{'one multiple' if multiples else 'no multiple'} of it lies from {lowest:.10g} to {highest:.10g}"
    if entered and step > max(entered):
        return f"every entered value is less, at most {spelled_out(max(entered))}{column.unit_behind}"
    return ""


def _entered(variants: Table | None, column: Column) -> list[float]:
    """Return what the variants have entered of a dimension."""
    if variants is None or variants.whole:
        return []
    cells = variants.frame.select("row", column.key).drop_nulls().iter_rows()
    return [value for row, value in cells if (row, column.key) not in variants.faulty]


def _lever(record: Mapping[str, Any]) -> LeverRow:
    """Return a sound row in SI."""
    name = record["dimension"]
    size = 1.0 if name == MATERIAL else DIMENSIONS[name].si_unit.si
    costs = {key: record[key] for key in ("cost_per_step", "cost_per_grade") if record[key] is not None}
    return LeverRow(
        row=record["row"],
        dimension=name,
        **dict(_answers(record)),
        **{key: record[key] * size for key in _RANGE if record[key] is not None},
        **costs,
    )


def _answers(record: Mapping[str, Any]) -> Iterator[tuple[str, bool]]:
    """Yield what is answered by yes or no."""
    for key in ("may_change", "tolerance_may_change"):
        if record[key] is not None:
            yield key, record[key] == "yes"
