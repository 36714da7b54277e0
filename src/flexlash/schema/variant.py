"""The records that travel from submission to report: a variant, its tolerance rows and limits, the settings."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, TypeAlias

from flexlash.schema.angle_unit import ANGLE_UNITS, AngleUnit
from flexlash.schema.columns import SETTINGS
from flexlash.schema.limit_verdict import VerdictBounds

__all__ = [
    "FAR",
    "FEWEST_PARTS",
    "OVERRIDDEN",
    "CorrelationRow",
    "Limits",
    "Material",
    "MeasuredDimension",
    "ScattersBetween",
    "Settings",
    "ToleranceRow",
    "Variant",
]

ScattersBetween: TypeAlias = Literal["parts", "lots"]
"""Whether every part has a value of its own, or a whole lot one."""

_UNSEEN, _LAST_DIGITS = 1e-15, 1e-13
"""Difference [SI], and as a share of the value, up to which two measured values are one."""

FAR = 8.3
"""Beyond this many standard deviations a normal has no weight in double precision."""


@dataclass(frozen=True, kw_only=True)
class Material:
    """A material of the submission; elastic constants and yield strength in Pa, density in kg/m³."""

    name: str
    constants: dict[str, float]
    yield_strength: float | None = None
    density: float | None = None


@dataclass(frozen=True, kw_only=True)
class Variant:
    """One valid row of Variants in SI; `dimensions` holds those it has itself, by name.

    A dimension that is blank because it equals another is absent: mean_radius when a bore is given,
    disk_thickness, disk radii, a fillet of 0, E and ν when the material gives G. `youngs_modulus` and
    `poisson_ratio` are those of the material in any case, for what does not follow from G.
    """

    row: int
    name: str
    flexspline_type: str
    material: str
    tolerance_class: str
    dimensions: dict[str, float]
    rated_torque: float | None = None
    load_inertia: float | None = None
    backlash_limit: float | None = None
    system_limit: float | None = None
    bearing_width: float | None = None
    engaged_teeth: float | None = None
    radial_deflection: float | None = None
    yield_strength: float | None = None
    youngs_modulus: float | None = None
    poisson_ratio: float | None = None
    density: float | None = None


FEWEST_PARTS = 5
"""Fewest parts that tell how a dimension scatters, or two of them together: fewer leave nearly everything open."""


@dataclass(frozen=True, kw_only=True)
class MeasuredDimension:
    """What was measured of one dimension in a sample [SI]: values in the order of the sheet.

    A tolerance row that is used has those of at least five parts, which are not all equal.
    `are_deviations` says that they are what was measured above the entered value. `parts` are the rows of Measurements
    that the values come from, so that values of one part can be told in two dimensions.
    """

    sample: str
    dimension: str
    values: tuple[float, ...]
    parts: tuple[int, ...]
    are_deviations: bool = False

    @cached_property
    def mean(self) -> float:
        """Mean of the values."""
        return math.fsum(self.values) / len(self.values)

    @property
    def scatters(self) -> bool:
        """Whether some of the values differ by more than their last digits, and by more than any gauge sees."""
        least, most = min(self.values), max(self.values)
        return most - least > _UNSEEN + _LAST_DIGITS * max(abs(least), abs(most))

    @cached_property
    def standard_deviation(self) -> float:
        """Standard deviation of the values (n − 1), about their rounded mean; 0 where they do not differ."""
        if not self.scatters:
            return 0.0
        return math.sqrt(math.fsum((value - self.mean) ** 2 for value in self.values) / (len(self.values) - 1))

    @cached_property
    def _digest(self) -> int:
        # Of numbers alone, whose hashes are alike in every process.
        return hash((self.values, self.parts, self.are_deviations))

    def __hash__(self) -> int:
        """Return a hash that is worked out once, since a sample may have thousands of values."""
        return self._digest


@dataclass(frozen=True, kw_only=True)
class ToleranceRow:
    """One row of Tolerances: deviations in SI (or a fraction when relative), or a grade.

    `mean_shift` and `sd` of a normal process are in the unit of the deviations, so that they are relative, too.
    `harmful_shift` says instead which share of the width of the limits the mean lies off their middle, to the side
    that raises the backlash. `cpk` is the one told beside a mean shift, which should give it. `sample` is what was
    measured of the dimension: its mean and standard deviation are those of the process. `scatters_between` says whether
    it is one value for a whole lot. A row that a class takes over from another keeps the name and the row number of
    that class.
    """

    row: int
    tolerance_class: str
    dimension: str
    lower: float = 0.0
    upper: float = 0.0
    relative: bool = False
    grade: str | None = None
    distribution: str = "normal"
    limits_sigma: float = 3.0
    mean_shift: float = 0.0
    sd: float | None = None
    harmful_shift: float = 0.0
    cpk: float | None = None
    sample: MeasuredDimension | None = None
    scatters_between: ScattersBetween = "parts"

    @property
    def scatters(self) -> bool:
        """Whether the limits differ; those of a grade always do."""
        return bool(self.grade) or self.lower < self.upper

    @property
    def has_process(self) -> bool:
        """Whether parts scatter about a mean of their own, and not merely somewhere between the limits."""
        return self.distribution not in {"uniform", "triangular"}

    @property
    def waits_for_size(self) -> bool:
        """Whether limits, or a sample's mean beside them, are known only for the size that a variant has."""
        return bool(self.grade or (self.sample and (self.relative or not self.sample.are_deviations)))


@dataclass(frozen=True, kw_only=True, slots=True)
class Limits:
    """Smallest and largest allowed value of a dimension [SI] and how parts scatter between or around them.

    `low` and `high` are the drawing's, whatever the process does. A normal or truncated normal process has its mean
    `mean_shift` off the middle of the limits, and the standard deviation `sd`; without one the limits lie `sigma`
    standard deviations from the middle. A process that was measured has its `sample`, and mean and sd as given: a
    measured one has the shape of the sample's values. Raises ValueError for a shift or sd of what is not normal or
    measured, or does not scatter.
    """

    low: float
    high: float
    distribution: str = "normal"
    sigma: float = 3.0
    mean_shift: float = 0.0
    sd: float | None = None
    cut: tuple[float, float] | None = None
    sample: MeasuredDimension | None = None
    scatters_between: ScattersBetween = "parts"

    def __post_init__(self) -> None:
        has_mean = "normal" in self.distribution or self.distribution == "measured"
        if (self.mean_shift or self.sd is not None) and not (self.low < self.high and has_mean):
            raise ValueError("mean_shift and sd are those of a normal distribution between limits that differ")

    @property
    def middle(self) -> float:
        """Middle of the limits."""
        return (self.low + self.high) / 2

    @property
    def mean(self) -> float:
        """Mean of the process before any cut."""
        return self.middle + self.mean_shift

    @property
    def standard_deviation(self) -> float:
        """Standard deviation of the normal before any cut."""
        return (self.high - self.low) / (2 * self.sigma) if self.sd is None else self.sd

    @property
    def reach(self) -> tuple[float, float]:
        """Smallest and largest value of a normal, or between limits; a measured shape alone tells how far it goes."""
        if self.distribution == "normal":
            far = FAR * self.standard_deviation
            return self.mean - far, self.mean + far
        return self.low, self.high


@dataclass(frozen=True, kw_only=True)
class CorrelationRow:
    """One row of Correlations: Pearson's correlation of the normal scores of two dimensions of a class."""

    row: int
    tolerance_class: str
    first: str
    second: str
    correlation: float


OVERRIDDEN = ("seed", "method", "samples", "target_percent", "angle_unit")
"""Settings that an option of a run may give in the place of the sheet's."""


@dataclass(frozen=True, kw_only=True)
class Settings:
    """What holds for all variants of a submission."""

    seed: int = 0
    coverage_percent: float = 95.0
    method: Literal["line", "sobol", "random"] = "line"
    samples: int | None = None
    lost_motion_percent: float = 4.0
    acceptable_ppm: float = 1350.0
    target_percent: float = 99.865
    mean_shift_factor: float = 0.3
    angle_unit: Literal["arcmin", "arcsec"] = "arcmin"
    calibrations: dict[str, float] = field(
        default_factory=lambda: {column.key: 1.0 for column in SETTINGS if column.role == "dimension"}
    )

    @property
    def verdict_bounds(self) -> VerdictBounds:
        """Which share of units over the limit each verdict allows, by the target."""
        return VerdictBounds.of(self.target_percent)

    @property
    def angles(self) -> AngleUnit:
        """The unit in which a reader is told angles."""
        return ANGLE_UNITS[self.angle_unit]
