"""Variants beside each other: backlash against mass, and against what they cost more than one of them."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.special import ndtri

from flexlash.analysis.computed import Computed
from flexlash.decisions.drawing_steps import drawing_step, relative_cost
from flexlash.decisions.pareto import pareto_front
from flexlash.decisions.side_effects import PartNumbers
from flexlash.decisions.tolerance_widths import grades_finer, half_width, shop_tolerances
from flexlash.mechanics.flexspline import disk_radii, radius_of
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.decision_columns import MATERIAL
from flexlash.schema.decision_rows import LeverRow
from flexlash.schema.spellings import plain
from flexlash.schema.units import as_entered
from flexlash.tolerance.distribution_curves import CURVE_SCORES, Curve
from flexlash.tolerance.spread_statistics import PERCENTILES

__all__ = ["TradeOff", "quantile_of", "trade_offs"]

_DIGITS = 12
"""Digits of a probability and of a cost: what arithmetic leaves behind them is not told."""

_ABSENT_IS_NONE = frozenset({"rim_length", "hub_fillet_radius", "junction_fillet_radius", "tooth_face_width"})
"""Dimensions that a part without them has as 0."""


@dataclass(frozen=True, kw_only=True)
class TradeOff:
    """A variant among others: the backlash [rad] that the target's share of units stays below, mass [kg], cost.

    None stands for a mass without a density and a cost that cannot be counted. `light` says whether the variant is on
    the front of backlash and mass among variants of the same torque, `cheap` the same of backlash and cost; None where
    that is not known, or there is no other variant of this torque.
    """

    quantile: float
    mass: float | None
    cost: float | None = None
    light: bool | None = None
    cheap: bool | None = None


def trade_offs(
    computed: Sequence[Computed], quantiles: Sequence[float], rows: Mapping[str, LeverRow], base: int = 0
) -> list[TradeOff]:
    """Return the trade-off of each variant of which the backlash of the target is known [rad], in their order.

    `rows` are those of the sheet Levers by dimension; where there are none no cost is told. It is what it costs to
    change the variant of the index `base` into each other one, by the steps and costs of the Levers table.
    """
    if not computed:
        return []
    masses = PartNumbers([one.variant for one in computed]).mass
    costs = [_change_cost(computed[base], one, rows) if rows else None for one in computed]
    torques = [one.variant.dimensions["torque"] for one in computed]
    light = _fronts(torques, quantiles, masses.tolist())
    cheap = _fronts(torques, quantiles, [math.nan if cost is None else cost for cost in costs])
    return [
        TradeOff(quantile=quantile, mass=None if math.isnan(mass) else mass, cost=cost, light=by_mass, cheap=by_cost)
        for quantile, mass, cost, by_mass, by_cost in zip(quantiles, masses.tolist(), costs, light, cheap, strict=True)
    ]


def quantile_of(computed: Computed, curve: Curve, percent: float) -> float:
    """Return the backlash [rad] that so many per cent of the units of a variant stay below.

    It is that of Results where they hold it, else it is read off the curve, by a cubic that only rises.
    """
    probability = round(percent / 100, _DIGITS)
    for name, stored in PERCENTILES.items():
        if round(stored, _DIGITS) == probability and computed.spread is not None:
            value = computed.spread.numbers.get(name)
            if value is not None:
                return value
    return float(PchipInterpolator(CURVE_SCORES, curve.outputs)(ndtri(probability)))


def _fronts(torques: Sequence[float], quantiles: Sequence[float], others: Sequence[float]) -> list[bool | None]:
    """Return whether each variant is on the front among those of its torque; None where nothing can be compared."""
    found: list[bool | None] = [None] * len(torques)
    alike: dict[float, list[int]] = defaultdict(list)
    for index, (torque, other) in enumerate(zip(torques, others, strict=True)):
        if not math.isnan(other):
            alike[torque].append(index)
    for indices in alike.values():
        if len(indices) > 1:
            front = pareto_front(np.array([(quantiles[index], others[index]) for index in indices]))
            for index, is_on in zip(indices, front.tolist(), strict=True):
                found[index] = is_on
    return found


def _change_cost(base: Computed, other: Computed, rows: Mapping[str, LeverRow]) -> float | None:
    """Return what it costs to make a variant into another one; None between types, or where one has no such dimension.

    Steps of nominal values cost whichever way they go, a dimension that is blank in both nothing; tolerances of another
    class cost grades, less than nothing where they are wider. Those of the same class are as hard to keep.
    """
    if base.variant.flexspline_type != other.variant.flexspline_type:
        return None
    before, after = _sizes(base), _sizes(other)
    both_by_bore = "bore_diameter" in before and "bore_diameter" in after
    for sizes in (before, after):
        sizes.pop("mean_radius" if both_by_bore else "bore_diameter", None)
    if before.keys() != after.keys():
        return None
    parts = []
    entered = {"mean_radius", *base.variant.dimensions, *other.variant.dimensions}
    for name in before:
        if name not in entered:
            continue
        row, size = rows.get(name), DIMENSIONS[name].si_unit.si
        old, new = (as_entered(value, size) for value in (before[name], after[name]))
        parts.append(relative_cost(old, new, drawing_step(name, row), row))
    other_class = plain(base.variant.tolerance_class) != plain(other.variant.tolerance_class)
    for name in shop_tolerances(base.limits) if other_class else ():
        wide, narrow = (half_width(one.limits[name]) if name in one.limits else 0.0 for one in (base, other))
        if wide > 0 and narrow > 0:
            cost = rows[name].cost_per_grade if name in rows else 1.0
            parts.append(cost * grades_finer(narrow / wide))
    if base.variant.material != other.variant.material:
        parts.append(rows[MATERIAL].cost_per_step if MATERIAL in rows else 1.0)
    return float(f"{math.fsum(parts):.{_DIGITS}g}") + 0.0


def _sizes(one: Computed) -> dict[str, float]:
    """Return the sizes [SI] of the part that its drawing shows, blank ones that follow others filled in."""
    entered, kind = one.variant.dimensions, one.variant.flexspline_type
    sizes = {
        name: value for name, value in entered.items() if DIMENSIONS[name].sheet == "Variants" and name != "torque"
    }
    sizes["mean_radius"] = float(radius_of(entered))
    sizes.setdefault("rim_thickness", entered["wall_thickness"])
    sizes |= {name: 0.0 for name in _ABSENT_IS_NONE if name not in sizes}
    if kind != "cylinder":
        inner, outer = disk_radii(entered)
        sizes |= {"disk_inner_radius": float(inner), "disk_outer_radius": float(outer)}
        if "disk_thickness_exponent" not in sizes:
            sizes.setdefault("disk_thickness", entered["wall_thickness"])
    return {name: sizes[name] for name in DIMENSIONS if name in sizes}
