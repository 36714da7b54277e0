"""A sweep that is asked for beside a submission: checked, and put in the place of its sheet Sweep."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from decimal import Decimal

import polars as pl

from flexlash.analysis.assessment import assess
from flexlash.analysis.examination import Examined
from flexlash.analysis.run_summary import listed
from flexlash.reading.raw import RawSheet, RawValue
from flexlash.schema.argument_checks import number
from flexlash.schema.columns import columns_of
from flexlash.schema.decision_rows import SweepRow, SweptDimension
from flexlash.schema.findings import shown
from flexlash.schema.spellings import plain, suggested
from flexlash.schema.swept_columns import swept_column
from flexlash.schema.swept_values import MOST_POINTS, swept_values
from flexlash.validation.swept_variants import swept_variants
from flexlash.validation.validated import Validated

__all__ = ["SweepError", "asked_sweep", "swept_alone", "with_sweep"]

_SHEET, _HEAD, _ROW = "Sweep", 1, 2
_MOST_DIMENSIONS, _NAMED = 2, 3


class SweepError(ValueError):
    """What was asked for cannot be swept; the message says why and what to do."""


def asked_sweep(vary: Mapping[str, Sequence[float]], variant: str | None = None) -> SweepRow:
    """Return the sweep over one or two dimensions, by the names of their columns, through these values in order.

    Raises SweepError for a dimension that there is not, no value or none that is a number, and too many points.
    """
    if not 0 < len(vary) <= _MOST_DIMENSIONS:
        raise SweepError(f"one or two dimensions can be swept together, not {len(vary)}")
    try:
        swept = [
            SweptDimension(key=swept_column(name).key, values=_along([number(name, value) for value in values]))
            for name, values in vary.items()
        ]
    except (TypeError, ValueError) as fault:
        raise SweepError(str(fault)) from fault
    for one in swept:
        if not one.values:
            raise SweepError(f"{one.key} has no value to take")
    first, *others = swept
    if others and others[0].key == first.key:
        raise SweepError(f"{first.key} is swept twice; name two dimensions")
    sweep = SweepRow(row=_ROW, variant=variant, first=first, second=others[0] if others else None)
    _require_few(_points(sweep), "")
    return sweep


def with_sweep(found: Examined, sweep: SweepRow | None) -> Examined:
    """Return an examined submission that asks for this sweep and no other, for its own sheet Sweep where it is None.

    Its variants must be as few as can be computed. The sweep stands on the sheet Sweep, so that whatever carries the
    submission carries it, unless its values have no step. Raises SweepError where nothing can be swept.
    """
    validated = found.validated
    if validated is None:
        return found
    if sweep is None:
        if not validated.sweeps:
            faulty = " without an error" if validated.faulty_sweeps else ""
            raise SweepError(f"its sheet Sweep has no row{faulty}; say what to sweep: --vary NAME=FROM:TO:STEP")
        return found
    sweep = replace(sweep, variant=_known_name(validated, sweep.variant))
    variants = swept_variants(validated, sweep)
    if not variants.variants:
        why = [f"{name}: {words}" for name, words in variants.refused.items()]
        why += [f"{name} has errors of its own" for name in variants.faulty]
        raise SweepError(f"no value makes a part: {listed(why, _NAMED)}" if why else "there is no variant")
    _require_few(_points(sweep) * len(variants.variants), f" of {len(variants.variants):,} variants")
    sheets = {name: one for name, one in found.submission.sheets.items() if plain(name) != plain(_SHEET)}
    heads = {schema: row for schema, row in validated.header_rows.items() if schema != _SHEET}
    if sheet := _sheet(sweep):
        sheets, heads = sheets | {_SHEET: sheet}, heads | {_SHEET: _HEAD}
    submission = replace(found.submission, sheets=sheets)
    validated = replace(validated, sweeps=(sweep,), faulty_sweeps=(), header_rows=heads)
    return replace(found, submission=submission, validated=validated)


def swept_alone(found: Examined) -> Examined:
    """Return an examined submission with the variants that are swept and no other, for who wants the points alone."""
    validated = found.validated
    if validated is None or validated.table is None or validated.variants.frame is None:
        return found
    wanted = {row for sweep in validated.sweeps for row, _ in swept_variants(validated, sweep).variants}
    others = {row for row, _, _ in validated.submitted} - wanted
    is_wanted, sheet = pl.col("row").is_in(list(wanted)), validated.table.sheet
    validated = replace(
        validated,
        findings=tuple(one for one in validated.findings if not (one.sheet == sheet and one.row in others)),
        table=replace(validated.table, frame=validated.table.frame.filter(is_wanted)),
        variants=replace(validated.variants, frame=validated.variants.frame.filter(is_wanted)),
    )
    return replace(found, validated=validated, nominal=assess(validated, found.settings))


def _along(values: Sequence[float]) -> tuple[float, ...]:
    """Return values each once, rising unless they fall.

    >>> _along([3, 1, 2, 1]), _along([3, 2, 1])
    ((1, 2, 3), (3, 2, 1))
    """
    rising = sorted(set(values))
    return tuple(rising[::-1] if [*values] == rising[::-1] else rising)


def _points(sweep: SweepRow) -> int:
    return len(sweep.first.values) * (len(sweep.second.values) if sweep.second else 1)


def _require_few(points: int, of_variants: str) -> None:
    if points > MOST_POINTS:
        raise SweepError(
            f"that is {points:,} points{of_variants}; at most {MOST_POINTS:,} are computed at once. Take larger steps"
            f"{', or name one with --variant' if of_variants else ''}"
        )


def _known_name(validated: Validated, name: str | None) -> str | None:
    """Return the name of a variant as Variants has it; raise SweepError, with the nearest, where there is none."""
    names = {plain(known): known for _, known, _ in validated.submitted}
    if name is None or plain(name) in names:
        return None if name is None else names[plain(name)]
    near = suggested(name, names.values())
    raise SweepError(f"there is no variant {shown(name)}{f'; did you mean {near}?' if near else ''}")


def _sheet(sweep: SweepRow) -> RawSheet | None:
    """Return the sheet Sweep that asks for a sweep; None where its values are not so many steps from first to last."""
    cells: dict[str, RawValue] = {} if sweep.variant is None else {"variant": sweep.variant}
    for start, swept in (("", sweep.first), ("second_", sweep.second)):
        if swept is None:
            continue
        first, last = swept.values[0], swept.values[-1]
        step = abs(float(Decimal(repr(swept.values[1])) - Decimal(repr(first)))) if len(swept.values) > 1 else 1.0
        if step == 0 or swept_values(first, last, step) != swept.values:
            return None
        dimension = columns_of("Variants")[swept.key].dimension
        cells |= {f"{start}dimension": dimension, f"{start}from": first, f"{start}to": last, f"{start}step": step}
    columns = columns_of(_SHEET)
    places = {key: place for place, key in enumerate(columns, start=1)}
    head: dict[int, RawValue] = {place: columns[key].label for key, place in places.items()}
    return RawSheet(name=_SHEET, rows={_HEAD: head, _ROW: {places[key]: value for key, value in cells.items()}})
