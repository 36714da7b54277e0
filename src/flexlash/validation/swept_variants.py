"""Which variants a row of Sweep is about: those that can have the dimension beside what else they are entered with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

from flexlash.schema.decision_rows import SweepRow
from flexlash.schema.spellings import plain
from flexlash.validation.replaced_rows import Replacement, with_replacements
from flexlash.validation.validated import Validated

__all__ = ["SweptVariants", "swept_variants"]


@dataclass(frozen=True, kw_only=True)
class SweptVariants:
    """The variants of a sweep, row number and name of each.

    `lacking` are those that cannot have the dimension, each with the rule that says so; `faulty` the names of those
    that have errors of their own.
    """

    variants: Sequence[tuple[int, str]] = ()
    lacking: Sequence[tuple[str, str]] = ()
    faulty: Sequence[str] = ()


def swept_variants(validated: Validated, sweep: SweepRow) -> SweptVariants:
    """Return which variants a sweep is about, and which it names or meets without being able to be about them.

    A variant lacks a dimension where its cell is blank and no value of the sweep makes a part.
    """
    named = [
        (row, name)
        for row, name, _ in validated.submitted
        if sweep.variant is None or plain(name) == plain(sweep.variant)
    ]
    sound = frozenset(validated.variants.rows)
    variants, lacking = [], []
    for row, name in named:
        if row not in sound:
            continue
        if why := _lacks(validated, sweep, row):
            lacking.append((name, why))
        else:
            variants.append((row, name))
    faulty = [name for row, name in named if row not in sound]
    return SweptVariants(variants=variants, lacking=lacking, faulty=faulty)


def _lacks(validated: Validated, sweep: SweepRow, row: int) -> str:
    """Return the message of the rule that no point of a sweep keeps, where a swept cell is blank; else nothing."""
    if validated.table is None:
        return ""
    dimensions = [one for one in (sweep.first, sweep.second) if one is not None]
    own = validated.table.frame.row(validated.table.frame["row"].to_list().index(row), named=True)
    if all(own[one.key] is not None for one in dimensions):
        return ""
    keys = [one.key for one in dimensions]
    points = [
        Replacement(row=row, values=dict(zip(keys, values, strict=True)))
        for values in product(*(one.values for one in dimensions))
    ]
    checked = with_replacements(validated, points)
    if len(checked.variants):
        return ""
    first = next(found for found in checked.findings if found.level == "error")
    return first.message.removeprefix(first.place).lstrip(": ")
