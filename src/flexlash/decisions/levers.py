"""The Levers table: for each variant with a limit, what single changes do, and which of them cost least."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, TypeAlias

import polars as pl

from flexlash.analysis.computed import Computed
from flexlash.analysis.options import Options
from flexlash.analysis.tolerance_spread import sampling_plan
from flexlash.decisions.lever import Lever, Present, Terms
from flexlash.decisions.material_levers import material_levers
from flexlash.decisions.nominal_levers import nominal_levers
from flexlash.decisions.range_notes import beyond_entered_range, faults_of, growing_worse
from flexlash.decisions.side_effects import PartNumbers, effects_between
from flexlash.decisions.tolerance_levers import tolerance_levers
from flexlash.schema.decision_results import LEVERS_TABLE
from flexlash.schema.decision_rows import LeverRow
from flexlash.schema.variant import Settings, Variant
from flexlash.tolerance.spread_statistics import PERCENTILES
from flexlash.workers import mapped

__all__ = ["levers_of", "present_of", "terms_of"]

_TOGETHER = 125
"""Variants whose levers are found together."""

_PER_WORKER = 60
"""Variants below which starting a worker costs more than it saves."""

Found: TypeAlias = tuple[int, Lever, Variant | None]
"""The index of a variant, a lever of it, and the variant as drawn with that; None where it is as it was."""

_KINDS: Sequence[Callable[[Sequence[Present], Terms], Iterator[Found]]] = (
    nominal_levers,
    tolerance_levers,
    material_levers,
)
"""What yields the levers of variants, in the order of the table."""


def levers_of(
    computed: Mapping[int, Computed], settings: Settings, levers: Mapping[str, LeverRow], options: Options | None = None
) -> pl.DataFrame:
    """Return the Levers table of the computed variants that have a limit, in submitted order.

    `levers` are the rows of the sheet Levers by dimension, `options` those of the run. A variant's levers have the same
    bits whatever its neighbours are. Nothing is computed of a variant without a spread.
    """
    presents = [present for variant in computed.values() if (present := present_of(variant)) is not None]
    found: list[Lever] = []
    if presents:
        terms = terms_of(next(iter(computed.values())), settings, levers, options or Options())
        pieces = [presents[start : start + _TOGETHER] for start in range(0, len(presents), _TOGETHER)]
        workers = min(1 if options is None else options.jobs, len(presents) // _PER_WORKER)
        found = [lever for piece in mapped(partial(_levers, terms=terms), pieces, workers) for lever in piece]
    columns = [column.key for column in LEVERS_TABLE]
    types: dict[str, type[pl.DataType]] = {
        column.key: pl.Float64 if column.is_number else pl.String for column in LEVERS_TABLE
    }
    types["rank"] = pl.Int64
    records = [_record(lever, rank) for lever, rank in zip(found, _ranks(found), strict=True)]
    return pl.DataFrame(records, schema=types, orient="row").select(columns)


def present_of(computed: Computed) -> Present | None:
    """Return what a variant is now; None without a limit or a spread."""
    limit, spread = computed.variant.backlash_limit, computed.spread
    over = None if spread is None else spread.numbers.get("probability_over_limit")
    if limit is None or spread is None or over is None:
        return None
    known = {probability: spread.numbers.get(name) for name, probability in PERCENTILES.items()}
    quantiles = {probability: value for probability, value in known.items() if value is not None}
    return Present(variant=computed.variant, limit=limit, over=over, quantiles=quantiles)


def terms_of(computed: Computed, settings: Settings, levers: Mapping[str, LeverRow], options: Options) -> Terms:
    """Return what holds for all levers of the submission that a variant belongs to."""
    validated = computed.among.validated
    blocked = validated.blocked.materials
    return Terms(
        classes=validated.classes,
        correlations=computed.among.correlations,
        materials={name: one for name, one in validated.materials.items() if name not in blocked},
        rows=levers,
        plan=replace(sampling_plan(settings, options), cross_check=False, shares=False),
        target=settings.verdict_bounds.meets,
        angles=settings.angles,
    )


def _levers(presents: Sequence[Present], terms: Terms) -> list[Lever]:
    """Return the levers of some variants, variant by variant."""
    found = [one for levers in _KINDS for one in levers(presents, terms)]
    changed = [(lever.variant, after) for _, lever, after in found if after is not None]
    told = iter(_told([lever for _, lever, after in found if after is not None], changed, terms))
    of_variant: dict[int, list[Lever]] = defaultdict(list)
    for index, lever, after in found:
        of_variant[index].append(lever if after is None else next(told))
    return [lever for index in range(len(presents)) for lever in of_variant[index]]


def _told(levers: Sequence[Lever], changed: Sequence[tuple[Variant, Variant]], terms: Terms) -> Iterator[Lever]:
    """Yield levers with what they do beside the backlash; each belongs to a variant before and after it."""
    if not levers:
        return
    before, after = (PartNumbers([pair[side] for pair in changed]) for side in (0, 1))
    faults = zip(faults_of(before), faults_of(after), strict=True)
    for lever, effects, (old, new) in zip(levers, effects_between(before, after), faults, strict=True):
        beyond = [words for name, words in new.items() if name not in old] + [*beyond_entered_range(lever, terms)]
        notes = (*lever.notes, *beyond, *growing_worse(lever, terms))
        yield replace(lever, effects=effects, leaves_range=lever.leaves_range or bool(beyond), notes=notes)


def _ranks(levers: Sequence[Lever]) -> list[int | None]:
    """Return the rank of each lever among those of its variant that are possible, in range and meet the limit."""
    of_variant: dict[int, list[int]] = defaultdict(list)
    for index, lever in enumerate(levers):
        if lever.possible and lever.direction == "meet" and not lever.leaves_range:
            of_variant[lever.variant.row].append(index)
    ranks: list[int | None] = [None] * len(levers)
    for indices in of_variant.values():
        for rank, index in enumerate(sorted(indices, key=lambda one: levers[one].relative_cost or 0.0), start=1):
            ranks[index] = rank
    return ranks


def _record(lever: Lever, rank: int | None) -> dict[str, Any]:
    """Return a lever as a row of the table."""
    effects = lever.effects
    return {
        "variant": lever.variant.name,
        "dimension": lever.dimension,
        "moves": "+".join(lever.moves) or None,
        "what": lever.what,
        "direction": lever.direction,
        "from_value": lever.from_value,
        "to_value": lever.to_value,
        "drawing_value": lever.drawing_value,
        "to_material": lever.to_material,
        "unit": lever.unit or None,
        "possible": "yes" if lever.possible else "no",
        "reason": lever.reason or None,
        "probability_over_limit_after": lever.over,
        "ppm_after": None if lever.over is None else lever.over * 1e6,
        "mass_change_percent": effects and _percent(effects.mass_change),
        "stiffness_change_percent": effects and _percent(effects.stiffness_change),
        "von_mises_MPa_after": effects and effects.von_mises / 1e6,
        "bending_stress_change_percent": effects and _percent(effects.bending_stress_change),
        "in_range": ("no" if lever.leaves_range else "yes") if lever.possible else None,
        "range_note": "; ".join(lever.notes) or None,
        "relative_cost": lever.relative_cost,
        "rank": rank,
    }


def _percent(share: float | None) -> float | None:
    return None if share is None else 100 * share
