"""The backlash of the whole drive: the spread of the wind-up and the plays of Other sources, combined by every rule.

mean            that of the wind-up's spread and the middle of every play
deviations      T of the wind-up is three of its standard deviations, whatever its limits; of a play half its width
Monte Carlo     the model of the wind-up plus every play, the plays as further inputs, by the method of the run
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from flexlash.analysis.drive_sources import DriveModel, OutputPlay, output_plays
from flexlash.schema.arrays import Array
from flexlash.schema.number_words import share_error
from flexlash.schema.variant import Settings
from flexlash.tolerance.row_batches import TolerancedRow, batch_statistics, batches_alike
from flexlash.tolerance.sampling import SamplingPlan
from flexlash.tolerance.spread_statistics import SpreadStatistics
from flexlash.tolerance.tolerance_chains import Contribution, combined
from flexlash.validation.validated import Validated

__all__ = ["WINDUP", "WINDUP_SIGMAS", "DriveBudget", "DriveShares", "budget_of", "drive_shares", "plays_of"]

WINDUP = "wind-up"
"""What the wind-up of the flexspline is called among the sources."""

WINDUP_SIGMAS = 3.0
"""Standard deviations of the wind-up's backlash that count as its tolerance T."""


@dataclass(frozen=True, kw_only=True)
class DriveBudget:
    """The plays beside the wind-up, and the part η of every deviation by which a mean may lie off."""

    plays: tuple[OutputPlay, ...]
    shift: float

    @cached_property
    def _names(self) -> tuple[str, ...]:
        """The names of the plays among the inputs of the model, by their order: the same points for the same order."""
        return tuple(f"source {number}" for number in range(1, len(self.plays) + 1))

    def plan(self, plan: SamplingPlan) -> SamplingPlan:
        """Return the plan of the whole drive: the plays draw after all dimensions, whose points stay as they are."""
        return replace(
            plan, later_inputs=(*plan.later_inputs, *self._names), cross_check=False, shares=False, coverage=0.95
        )

    def row(self, row: TolerancedRow, limit: float | None) -> TolerancedRow:
        """Return a row of the wind-up as that of the whole drive, with the limit of the drive."""
        plays = dict(zip(self._names, self.plays, strict=True))
        return TolerancedRow(
            model=DriveModel(row.model, self._names),
            nominal={**row.nominal, **{name: play.mean for name, play in plays.items()}},
            limits={**row.limits, **{name: play.limits for name, play in plays.items() if play.limits is not None}},
            upper_limit=limit,
            correlation=row.correlation,
        )

    def contributions(self, sd: float) -> list[Contribution]:
        """Return the links of the chain: the wind-up, whose backlash has this standard deviation [rad], every play."""
        windup = Contribution(tolerance=WINDUP_SIGMAS * sd, shift=self.shift)
        return [windup, *(play.contribution(self.shift) for play in self.plays)]

    def with_budget(
        self, drives: Sequence[TolerancedRow], windups: Sequence[SpreadStatistics], plan: SamplingPlan
    ) -> list[SpreadStatistics]:
        """Return the statistics of wind-ups with those of their whole drives, rows made by `row`, beside them."""
        drawn: dict[int, SpreadStatistics] = {}
        for batch in batches_alike(drives):
            drawn |= zip(batch, batch_statistics([drives[index] for index in batch], self.plan(plan)), strict=True)
        return [
            replace(one, numbers={**one.numbers, **self._combined(one), **_drawn_numbers(drawn[index])})
            for index, one in enumerate(windups)
        ]

    def _combined(self, windup: SpreadStatistics) -> dict[str, float | None]:
        """Return mean and high values [rad] by every rule, from mean and standard deviation of the wind-up's spread."""
        mean = sum((play.mean for play in self.plays), windup.numbers["mean"] or 0.0)
        rules = combined(self.contributions(windup.numbers["sd"] or 0.0))
        high = {f"system_{rule}_high": mean + float(reach) for rule, reach in rules._asdict().items()}
        return {"system_mean": mean, **high}


def plays_of(validated: Validated) -> tuple[OutputPlay, ...]:
    """Return the other sources at the output; none where one of them has an error, since a sum would lack it."""
    return () if validated.sources_are_faulty else output_plays(validated.other_sources)


def budget_of(validated: Validated, settings: Settings) -> DriveBudget | None:
    """Return the budget of the whole drive; None without other sources, and where one of them has an error."""
    plays = plays_of(validated)
    return DriveBudget(plays=plays, shift=settings.mean_shift_factor) if plays else None


def _drawn_numbers(drive: SpreadStatistics) -> dict[str, float | None]:
    """Return what Monte Carlo tells of the whole drive."""
    found = drive.numbers
    told: dict[str, float | None] = {f"system_{name}": found[name] for name in _DRAWN}
    over = found.get("probability_over_limit")
    if over is not None:
        low, high = (found.get(f"probability_over_limit_{end}") or 0.0 for end in ("low", "high"))
        told |= {
            "system_probability_over_limit": over,
            "system_probability_over_limit_standard_error": share_error(low, high),
        }
    return told


_DRAWN = ("p99_865", "p99_865_standard_error")


@dataclass(frozen=True, kw_only=True)
class DriveShares:
    """What one source, or the wind-up, has of the whole drive: of the mean, the variance and the sum of deviations."""

    name: str
    of_mean: float
    of_variance: float
    of_worst_case: float


def drive_shares(budget: DriveBudget, mean: float, sd: float) -> list[DriveShares]:
    """Return the shares of the wind-up, whose backlash has this mean and standard deviation [rad], and of every play.

    Equation: mean μ_i/Σμ; variance σ_i²/Σσ², since the plays are independent; worst case T_i/ΣT
    """
    means = np.array([mean, *(play.mean for play in budget.plays)])
    sds = np.array([sd, *(play.sd for play in budget.plays)])
    tolerances = np.array([float(one.tolerance) for one in budget.contributions(sd)])
    parts = [_shares(values).tolist() for values in (means, sds**2, tolerances)]
    names = (WINDUP, *(play.name for play in budget.plays))
    return [
        DriveShares(name=name, of_mean=of_mean, of_variance=of_variance, of_worst_case=of_worst_case)
        for name, of_mean, of_variance, of_worst_case in zip(names, *parts, strict=True)
    ]


def _shares(values: Array) -> Array:
    """Return values as shares of their sum, 0 where that is 0."""
    total = values.sum()
    return values / total if total else values * 0.0
