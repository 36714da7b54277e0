"""Which variants a row of Sweep is about: those of which some value of the sweep makes a part."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from flexlash.schema.decision_rows import SweepRow
from flexlash.schema.spellings import plain
from flexlash.validation.sweep_rows import why_no_part
from flexlash.validation.validated import Validated

__all__ = ["SweptVariants", "swept_variants"]


@dataclass(frozen=True, kw_only=True)
class SweptVariants:
    """The variants of a sweep, row number and name of each, in submitted order.

    `refused` are those of which no value makes a part, each with the words of the rule that says so; `faulty` the names
    of those that have errors of their own.
    """

    variants: Sequence[tuple[int, str]] = ()
    refused: Mapping[str, str] = field(default_factory=dict)
    faulty: Sequence[str] = ()


def swept_variants(validated: Validated, sweep: SweepRow) -> SweptVariants:
    """Return which variants a sweep is about, and which it names or meets without being able to be about them."""
    if validated.table is None:
        return SweptVariants()
    sound = frozenset(validated.variants.rows)
    variants, refused, faulty = [], {}, []
    for record in validated.table.frame.iter_rows(named=True):
        name = record["variant"] or ""
        if sweep.variant is not None and plain(name) != plain(sweep.variant):
            continue
        if record["row"] not in sound:
            faulty.append(name)
        elif words := why_no_part(sweep, record):
            refused[name] = words
        else:
            variants.append((record["row"], name))
    return SweptVariants(variants=variants, refused=refused, faulty=faulty)
