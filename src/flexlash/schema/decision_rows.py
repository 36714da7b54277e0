"""The records of the sheets Other sources, Levers and Sweep, from the submission to the report."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

__all__ = ["LeverRow", "OtherSource", "SweepRow", "SweptDimension"]


@dataclass(frozen=True, kw_only=True)
class OtherSource:
    """One sound row of Other sources: value and deviations as angles [rad] or plays [m], not yet at the output.

    `radius` [m] is None for an angle; `pressure_angle` [rad] is that of a radial play; `ratio` is 1 on the output side.
    """

    row: int
    name: str
    enter_as: Literal["arcmin", "mm at radius", "mm radial play"] = "arcmin"
    value: float = 0.0
    lower: float = 0.0
    upper: float = 0.0
    radius: float | None = None
    pressure_angle: float | None = None
    distribution: str = "normal"
    limits_sigma: float = 3.0
    side: Literal["output", "input"] = "output"
    ratio: float = 1.0
    kind: Literal["systematic", "random"] = "systematic"


@dataclass(frozen=True, kw_only=True)
class LeverRow:
    """One sound row of Levers in SI; None is what its cell leaves to the built-in defaults.

    `dimension` is a dimension of Variants, or `material`.
    """

    row: int
    dimension: str
    may_change: bool | None = None
    lowest: float | None = None
    highest: float | None = None
    step: float | None = None
    cost_per_step: float = 1.0
    tolerance_may_change: bool | None = None
    cost_per_grade: float = 1.0


@dataclass(frozen=True, kw_only=True)
class SweptDimension:
    """A dimension and the values that it takes, in the unit of its column of Variants, `key`."""

    key: str
    values: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class SweepRow:
    """One sound row of Sweep; `variant` is None for every variant. A row of 0 was asked for on the command line."""

    row: int = 0
    variant: str | None = None
    first: SweptDimension
    second: SweptDimension | None = None
