"""The records of levers: what a variant is now, what holds for all levers of a submission, and one lever."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from statistics import NormalDist
from typing import Literal

from flexlash.schema.angle_unit import ARC_MINUTES, AngleUnit
from flexlash.schema.decision_rows import LeverRow
from flexlash.schema.variant import Material, ToleranceRow, Variant
from flexlash.tolerance.sampling import SamplingPlan

__all__ = ["Direction", "Effects", "Lever", "Present", "Terms"]

Direction = Literal["meet", "relax"]
"""Whether a change is wanted that brings a variant within its limit, or how far one may go that keeps it there."""


@dataclass(frozen=True, kw_only=True)
class Terms:
    """What holds for all levers of a submission.

    `classes` are its tolerance classes, `correlations` those of the scores of pairs of dimensions, `materials` the ones
    that a variant may be made of, each by plain name; `rows` the rows of Levers by dimension. `plan` is that of the
    run, `target` the greatest share of units that may be over the limit, `angles` the unit in which reasons tell an
    angle.
    """

    classes: Mapping[str, Sequence[ToleranceRow]]
    correlations: Mapping[str, Mapping[tuple[str, str], float]] = field(default_factory=dict)
    materials: Mapping[str, Material] = field(default_factory=dict)
    rows: Mapping[str, LeverRow] = field(default_factory=dict)
    plan: SamplingPlan
    target: float
    angles: AngleUnit = ARC_MINUTES

    @property
    def level(self) -> float:
        """The level of Φ up to which units are to be within the limit."""
        return NormalDist().inv_cdf(1 - self.target)

    def may_change(self, dimension: str) -> bool:
        """Return whether the nominal value of a dimension, or the material, may change: the torque only if told so."""
        row = self.rows.get(dimension)
        return dimension != "torque" if row is None or row.may_change is None else row.may_change


@dataclass(frozen=True, kw_only=True)
class Present:
    """A variant with a limit as it is [SI]: the share of its units over the limit, and quantiles of its backlash.

    `quantiles` are by probability; of a variant without scatter all are the same.
    """

    variant: Variant
    limit: float
    over: float
    quantiles: Mapping[float, float]

    def direction(self, target: float) -> Direction:
        """Return what is wanted of its levers, where so great a share of units may be over the limit."""
        return "relax" if self.over <= target else "meet"


@dataclass(frozen=True, kw_only=True)
class Effects:
    """What a change does beside the backlash: changes as shares, the greatest von Mises stress of torsion [Pa].

    None is what hangs on a density, or an elastic constant, that a material has not.
    """

    mass_change: float | None
    stiffness_change: float
    von_mises: float
    bending_stress_change: float | None


@dataclass(frozen=True, kw_only=True)
class Lever:
    """One change of a variant alone; values in the unit of the row, None where there is none.

    `reason` says why it cannot do it; such a lever has neither `to_value` nor `drawing_value`. `over` is the share of
    units over the limit with the drawing value. `leaves_range` says that the drawing value does not keep to the rules
    of a part, to plausible proportions or to the range of Levers; `notes` what it does not keep to, or what gets worse.
    """

    variant: Variant
    dimension: str
    moves: tuple[str, ...] = ()
    what: Literal["nominal", "tolerance", "material"]
    direction: Direction
    unit: str
    from_value: float | None = None
    to_value: float | None = None
    drawing_value: float | None = None
    to_material: str | None = None
    reason: str = ""
    over: float | None = None
    effects: Effects | None = None
    leaves_range: bool = False
    notes: tuple[str, ...] = ()
    relative_cost: float | None = None

    @property
    def possible(self) -> bool:
        """Whether the change alone can do it."""
        return not self.reason
