"""How far a dimension can go: the rules of a part at sizes and at limits, for many variants and values at once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from flexlash.mechanics.flexspline import radius_of
from flexlash.schema.arrays import Array
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.part_row import PartRow, PartRule
from flexlash.schema.part_rules import PART_RULES
from flexlash.tolerance.dimension_limits import bounds_of
from flexlash.tolerance.gaps import gaps
from flexlash.tolerance.limit_arrays import LimitArrays
from flexlash.validation.unit_mistakes import SHARES

__all__ = ["ArrayRow", "broken_rules", "makes_a_part", "reach_of"]

Bools = npt.NDArray[np.bool_]

_ROOM = 1e-6
"""Part of the sizes that face each other which must be left between them."""

_FAR = 5.0
"""Times the present value, or part of it, up to which a radius or a torque is looked for."""


@dataclass(frozen=True, kw_only=True)
class ArrayRow(PartRow):
    """Rows of one type with the same dimensions as operands: arrays by name [SI], which broadcast."""

    type: str
    sizes: Mapping[str, Array]

    def given(self, name: str) -> bool:
        """Return whether the rows have a dimension."""
        return name in self.sizes

    def blank(self, name: str) -> bool:
        """Return whether the rows have not a dimension."""
        return name not in self.sizes

    def entered(self, name: str) -> Array:
        """Return a dimension in the unit of the template; NaN for a blank, which satisfies no comparison."""
        return self.sizes[name] / DIMENSIONS[name].si_unit.si if name in self.sizes else np.array(np.nan)

    def is_type(self, *types: str) -> bool:
        """Return whether the flexsplines are of one of these types."""
        return self.type in types

    def when(self, condition: bool, then: Array, otherwise: Array) -> Array:  # noqa: FBT001
        """Return one of two operands."""
        return then if condition else otherwise

    def all_of(self, *conditions: Bools | bool) -> Bools:
        """Return where all conditions hold."""
        return np.asarray(np.logical_and.reduce(np.broadcast_arrays(*conditions)))

    def any_of(self, *conditions: Bools | bool) -> Bools:
        """Return where at least one condition holds."""
        return np.asarray(np.logical_or.reduce(np.broadcast_arrays(*conditions)))


def broken_rules(kind: str, sizes: Mapping[str, Array], *, errors: bool) -> Iterator[tuple[PartRule, Bools]]:
    """Yield the rules of one level with where they are broken; information is none."""
    row = ArrayRow(type=kind, sizes=sizes)
    for rule in PART_RULES:
        if rule.code[0] == ("E" if errors else "W"):
            conditions = tuple(rule.broken(row))
            if not any(condition is False for condition in conditions):
                yield rule, row.all_of(*conditions)


def makes_a_part(kind: str, sizes: Mapping[str, Array], limits: Mapping[str, LimitArrays]) -> Bools:
    """Return where dimensions of one shape [SI], and all between their limits, make a part; NaN makes none."""
    sound = np.asarray(np.logical_and.reduce(np.broadcast_arrays(*(np.isfinite(size) for size in sizes.values()))))
    with np.errstate(all="ignore"):
        for _, broken in broken_rules(kind, sizes, errors=True):
            sound = sound & ~broken
        ends = {name: (one.low, one.high) for name, one in limits.items()}
        for name, (low, high) in ends.items():
            least, most = bounds_of(name)
            # What a grade does not tabulate is NaN, and no comparison holds.
            sound = sound & (low > least) & (high <= most) & (high - low <= 2 * np.abs(sizes[name]))
        for gap in gaps(kind, sizes):
            if gap.reached.kind == "impossible":
                facing = [
                    factor * ends.get(name, (sizes[name],) * 2)[factor < 0] for name, factor in gap.factors.items()
                ]
                sound = sound & (sum(facing) > _ROOM * sum(np.abs(one) for one in facing))
    return sound


def reach_of(dimension: str, sizes: Mapping[str, Array], present: Array) -> tuple[Array, Array]:
    """Return between which values [SI] a dimension of variants (variants,) is looked for.

    Lengths are looked for within what they can be in mean radii, angles and exponents within the bounds of their
    column, radii of the wall and torques within a fifth and five times what they are; always about what they are.
    """
    column = DIMENSIONS[dimension]
    if column.key in SHARES:
        radius = np.asarray(radius_of(sizes))
        low, high = (share * radius for share in SHARES[column.key])
    elif column.maximum is not None and column.minimum is not None:
        low, high = (np.full_like(present, end * column.si_unit.si) for end in (column.minimum, column.maximum))
    else:
        low, high = present / _FAR, present * _FAR
    return np.minimum(low, present), np.maximum(high, present)
