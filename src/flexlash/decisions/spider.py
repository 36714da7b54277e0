"""Spider curves: how the backlash of a variant follows each dimension alone, in parts of what both are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexlash.analysis.computed import Computed
from flexlash.decisions.changes import Change, changes_of
from flexlash.decisions.part_range import makes_a_part
from flexlash.mechanics.flexspline import backlash
from flexlash.schema.arrays import Array
from flexlash.schema.columns import DIMENSIONS

__all__ = ["SPIDER_CHANGES", "SpiderLine", "spider_of"]

_REACH, _STEPS = 10, 21
SPIDER_CHANGES = tuple(round(float(part), 12) for part in np.linspace(-_REACH, _REACH, _STEPS) / 100)
"""Changes of a dimension at which the backlash is computed, as parts of the dimension."""


@dataclass(frozen=True, kw_only=True)
class SpiderLine:
    """How the nominal backlash follows one dimension; all numbers are changes as parts of what is on the drawing.

    `moves` are dimensions that follow because they are the same on the drawing; `alone` says that such a one stays.
    `backlash` are the changes at `SPIDER_CHANGES`, None where no part can be made. `tolerance` are the limits of the
    dimension, `swing` the backlash there; None where it does not scatter or, on the drawing, not alone.
    """

    dimension: str
    moves: tuple[str, ...] = ()
    alone: bool = False
    backlash: tuple[float | None, ...]
    tolerance: tuple[float, float] | None = None
    swing: tuple[float, float] | None = None

    @property
    def reach(self) -> float:
        """How much the backlash changes at most within the changes."""
        return max((abs(one) for one in self.backlash if one is not None), default=0.0)


def spider_of(computed: Computed) -> list[SpiderLine]:
    """Return a line for each dimension of a variant's drawing, the steepest first.

    The backlash is that of the mechanics at each point, all other dimensions as entered. The torque and the material
    are on no line: neither is of the part.
    """
    variant = computed.variant
    lines = [
        _line(computed, change)
        for change in changes_of(variant, lambda name: name != "torque")
        if change.before(variant.dimensions)
    ]
    return sorted(lines, key=lambda line: -round(line.reach, 9))


def _line(computed: Computed, change: Change) -> SpiderLine:
    """Return the line of a change."""
    kind, present = computed.variant.flexspline_type, change.before(computed.variant.dimensions)
    values = present * (1 + np.array(SPIDER_CHANGES))
    sizes = _sizes(computed, change, values)
    with np.errstate(all="ignore"):
        sound = makes_a_part(kind, sizes, {}) & (values <= _greatest(change.dimension))
    found = _changes(computed, change, values)
    limits = computed.limits.get(change.dimension)
    alone = bool(change.splits or change.present)
    tolerance = swing = None
    if limits is not None and limits.low < limits.high and not alone:
        ends = np.array([limits.low, limits.high])
        tolerance = limits.low / present - 1, limits.high / present - 1
        low, high = _changes(computed, change, ends).tolist()
        swing = low, high
    return SpiderLine(
        dimension=change.dimension,
        moves=change.moves,
        alone=alone,
        backlash=tuple(one if is_sound else None for one, is_sound in zip(found.tolist(), sound.tolist(), strict=True)),
        tolerance=tolerance,
        swing=swing,
    )


def _sizes(computed: Computed, change: Change, values: Array) -> dict[str, Array]:
    """Return dimensions [SI] with other values of one of them."""
    entered = computed.variant.dimensions
    kept = {name: entered[same] for name, same in change.splits.items()}
    sizes = {name: np.full_like(values, size) for name, size in {**entered, **kept}.items()}
    return {**sizes, change.dimension: values}


def _changes(computed: Computed, change: Change, values: Array) -> Array:
    """Return by which part of it the backlash changes at other values of a dimension."""
    kind = computed.variant.flexspline_type
    with np.errstate(all="ignore"):
        found = np.asarray(backlash(kind, _sizes(computed, change, values)))
        return found / float(backlash(kind, computed.variant.dimensions)) - 1


def _greatest(dimension: str) -> float:
    """Return the greatest value [SI] that a dimension may have."""
    column = DIMENSIONS[dimension]
    return np.inf if column.maximum is None else column.maximum * column.si_unit.si
