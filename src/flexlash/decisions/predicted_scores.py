"""About where a changed dimension meets the limit: by moments of second order, for many variants at once.

score           how many standard deviations the limit lies above the mean of the backlash, as a normal one would count
                them: what skewness and kurtosis change at the target is taken off
level           the score at which the share of units over the limit is the target; it hardly changes with a dimension,
                which is what makes a prediction sharp
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from flexlash.analysis.backlash_models import BACKLASH_OF
from flexlash.decisions.changes import Change
from flexlash.decisions.part_range import makes_a_part, reach_of
from flexlash.schema.arrays import Array
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.variant import ToleranceRow
from flexlash.schema.variant_arrays import Indices
from flexlash.tolerance.limit_arrays import LimitArrays, beyond_doubt, limits_alike
from flexlash.tolerance.row_probabilities import SCALED_SHAPES, OverLimits, probabilities_alike
from flexlash.tolerance.sampling import SamplingPlan

__all__ = ["ChangedAlike", "Crossing", "Moments"]

Bools = npt.NDArray[np.bool_]

_LOOKED_AT = 20
"""Values at which each side of the present one is looked at, the nearer ones closer together."""

_HALVINGS, _CHORDS, _FALSE_POSITIONS = 44, 4, 12
_SMALL = 1e-12
"""Part of the mean backlash below which its standard deviation is none."""

_SHAPES = {"uniform": (3**-0.5, 1.8), "triangular": (6**-0.5, 2.4)}
"""Standard deviation beside half the width of the limits, and fourth moment of the standard score."""

_NORMAL = 3.0
"""Fourth moment of a normal score."""


class Moments(NamedTuple):
    """Mean, standard deviation, skewness and excess kurtosis of the backlash, each of the shape of the values."""

    mean: Array
    sd: Array
    skewness: Array
    excess: Array

    def bend(self, level: float) -> Array:
        """Return by how many standard deviations a quantile lies above that of a normal distribution.

        Equation: γ₁ (z² − 1)/6 + γ₂ (z³ − 3 z)/24 − γ₁² (2 z³ − 5 z)/36
        Source: Cornish and Fisher 1938.
        """
        square, cube = level * level, level * level * level
        skew = self.skewness * ((square - 1) / 6) - self.skewness**2 * ((2 * cube - 5 * level) / 36)
        return skew + self.excess * ((cube - 3 * level) / 24)


@dataclass(frozen=True, kw_only=True)
class Crossing:
    """The value nearest to the present one at which the limit is just met, each (variants,), NaN where there is none.

    `before` and `beyond` are values to either side of it, of which the one nearer to the present value is `before`.
    """

    value: Array
    before: Array
    beyond: Array


@dataclass(frozen=True, kw_only=True)
class ChangedAlike:
    """One change of variants of one type and class that have the same dimensions [SI], each array (variants,).

    `limit` is the greatest backlash [rad]; `ties` are correlations of the scores of pairs of dimensions; `target` is
    the level of Φ up to which units are to be within the limit.
    """

    kind: str
    change: Change
    sizes: Mapping[str, Array]
    limit: Array
    rows: Sequence[ToleranceRow]
    target: float
    ties: Mapping[tuple[str, str], float] = field(default_factory=dict)

    def take(self, indices: Indices) -> ChangedAlike:
        """Return some of the variants."""
        sizes = {name: size[indices] for name, size in self.sizes.items()}
        return replace(self, sizes=sizes, limit=self.limit[indices])

    def extreme(self, *, highest: Bools) -> Array:
        """Return the values (variants,) within the ends with the highest score, or the lowest one."""
        part = np.linspace(0, 1, 2 * _LOOKED_AT + 1)
        low, high = self.ends
        values = low[:, None] + (high - low)[:, None] * part
        values[:, -1] = high
        scores = np.where(highest[:, None], 1, -1) * self.scores(values)
        best = np.argmax(np.where(np.isnan(scores), -np.inf, scores), axis=1)
        return np.asarray(values[np.arange(len(low)), best])

    @cached_property
    def present(self) -> Array:
        """The present values."""
        return self.sizes[self.change.present or self.change.dimension]

    @cached_property
    def _base(self) -> dict[str, Array]:
        """The dimensions after the change, with the present value."""
        kept = {name: self.sizes[same] for name, same in self.change.splits.items()}
        return {**self.sizes, **kept, self.change.dimension: self.present}

    @cached_property
    def _limits(self) -> dict[str, LimitArrays]:
        return limits_alike(self._base, self.rows, BACKLASH_OF[self.kind])

    def _at(self, values: Array) -> tuple[dict[str, Array], dict[str, LimitArrays]]:
        """Return dimensions and limits at values (variants, k), each (variants, 1) or of that shape."""
        name, count = self.change.dimension, values.shape[1]
        sizes = {one: size[:, None] for one, size in self._base.items()} | {name: values}
        limits = {one: LimitArrays(*(end[:, None] for end in limit)) for one, limit in self._limits.items()}
        if own := [row for row in self.rows if row.dimension == name]:
            asked = self._base if own[0].harmful_shift else {}
            flat = {one: np.repeat(size, count) for one, size in asked.items()} | {name: values.ravel()}
            found = limits_alike(flat, own, BACKLASH_OF[self.kind])
            limits |= {one: LimitArrays(*(end.reshape(values.shape) for end in limit)) for one, limit in found.items()}
        return sizes, limits

    def inputs(self, values: Array) -> tuple[dict[str, Array], dict[str, LimitArrays], Bools]:
        """Return dimensions and limits (variants,) at values (variants,), and where nothing is to be said of these."""
        sizes, limits = self._at(values[:, None])
        flat = {name: np.broadcast_to(size[:, 0], values.shape) for name, size in sizes.items()}
        ends = {name: LimitArrays(*(end[:, 0] for end in limits[name])) for name in DIMENSIONS if name in limits}
        with np.errstate(all="ignore"):
            sure = self.makes_a_part(values[:, None])[:, 0] & beyond_doubt(self.kind, flat, ends)
        return flat, ends, sure

    def over_limit(self, values: Array, plan: SamplingPlan) -> OverLimits:
        """Return the shares over the limit at values (variants,) by lines.

        NaN where limits may reach what makes no part, or cut their tails, or where lines do not serve.
        """
        sizes, limits, sure = self.inputs(values)
        shapes = {row.dimension: row.distribution for row in self.rows}
        scatters = {name: one.low < one.high for name, one in limits.items()}
        known = all(shapes[name] in SCALED_SHAPES for name in limits)
        over, rows = OverLimits(*np.full((3, len(values)), np.nan)), np.flatnonzero(sure)
        if known and len(rows) and all(one[rows].all() or not one[rows].any() for one in scatters.values()):
            varied = {name for name, one in scatters.items() if one[rows].all()}
            told = probabilities_alike(
                BACKLASH_OF[self.kind],
                {name: size[rows] for name, size in sizes.items()},
                {name: (LimitArrays(*(end[rows] for end in one)), shapes[name]) for name, one in limits.items()},
                self.limit[rows],
                plan=plan,
                ties=[(*pair, tie) for pair, tie in self.ties.items() if tie and varied.issuperset(pair)],
            )
            for every, some in zip(over, told, strict=True):
                every[rows] = some
        return over

    def makes_a_part(self, values: Array) -> Bools:
        """Return whether values (variants, k), and all between their limits, make parts."""
        return np.broadcast_to(makes_a_part(self.kind, *self._at(values)), values.shape)

    def moments(self, values: Array) -> Moments:
        """Return the moments of the backlash (variants, k) at values of that shape.

        Equation: μ = y + Σ cᵢ, σ² = Σ (dᵢ² + (mᵢ − 1) cᵢ²) + 2 Σ ρᵢⱼ dᵢ dⱼ, γ₁ σ³ = 6 d² c + 3 Σ dᵢ² cᵢ (mᵢ − 3),
            γ₂ σ⁴ = Σ dᵢ⁴ (mᵢ − 3), with dᵢ = (y₊ − y₋)/2 and cᵢ = (y₊ + y₋)/2 − y of the backlash one standard
            deviation of an input above and below its mean, m the fourth moment of its standard score; d is the length
            of all dᵢ, and c the same as cᵢ one standard deviation along their direction
        """
        sizes, limits = self._at(values)
        model, shapes = BACKLASH_OF[self.kind], {row.dimension: row.distribution for row in self.rows}
        inputs = {name: _moments(one, shapes[name]) for name, one in limits.items()}
        with np.errstate(all="ignore"):
            centre = sizes | {name: mean for name, (mean, _) in inputs.items()}
            middle = np.broadcast_to(model(centre), values.shape)
            mean, slopes = middle, {}
            variance = third = fourth = length = np.zeros(values.shape)
            for name, (own, sd) in inputs.items():
                above, below = model({**centre, name: own + sd}), model({**centre, name: own - sd})
                slope, curve = (above - below) / 2, (above + below) / 2 - middle
                mean, slopes[name], square = mean + curve, slope, slope * slope
                moment = _SHAPES.get(shapes[name], (0.0, _NORMAL))[1]
                variance = variance + square + (moment - 1) * curve * curve
                third = third + 3 * (moment - _NORMAL) * square * curve
                length = length + square
                fourth = fourth + (moment - _NORMAL) * square * square
            root = np.sqrt(np.where(length > 0, length, 1.0))
            along = [
                model(centre | {name: own + side * sd * slopes[name] / root for name, (own, sd) in inputs.items()})
                for side in (-1, 1)
            ]
            third = third + 6 * length * ((along[0] + along[1]) / 2 - middle)
            for (first, second), tie in self.ties.items():
                if first in slopes and second in slopes:
                    variance = variance + 2 * tie * slopes[first] * slopes[second]
            sd = np.maximum(np.sqrt(np.maximum(variance, 0.0)), _SMALL * np.abs(mean))
            cube = sd * sd * sd
            return Moments(mean, sd, third / cube, fourth / (cube * sd))

    def scores(self, values: Array) -> Array:
        """Return the scores (variants, k) at values of that shape."""
        moments = self.moments(values)
        with np.errstate(all="ignore"):
            return np.asarray((self.limit[:, None] - moments.mean) / moments.sd - moments.bend(self.target))

    def score(self, values: Array) -> Array:
        """Return the scores (variants,) at values (variants,)."""
        return self.scores(values[:, None])[:, 0]

    @cached_property
    def ends(self) -> tuple[Array, Array]:
        """The least and greatest values that are looked at: those that make a part, within reach."""
        low, high = reach_of(self.change.dimension, self._base, self.present)
        return self._last_part(low), self._last_part(high)

    def _last_part(self, end: Array) -> Array:
        """Return the value nearest to an end, on the way to it, that makes a part; the present one always does."""
        sound, broken = self.present, end
        if (reached := self.makes_a_part(end[:, None])[:, 0]).all():
            return end
        for _ in range(_HALVINGS):
            middle = (sound + broken) / 2
            fine = self.makes_a_part(middle[:, None])[:, 0]
            sound, broken = np.where(fine, middle, sound), np.where(fine, broken, middle)
        return np.where(reached, end, sound)

    def crossing(self, level: Array, *, wanted: Bools) -> Crossing:
        """Return where scores come to a level (variants,): to or above it where that is `wanted`, else below it."""
        found = [self._on_side(end, level, wanted) for end in self.ends]
        distances = [np.abs(one.value - self.present) for one in found]
        first = ~(distances[1] < distances[0]) & ~np.isnan(distances[0])
        return Crossing(**{name: np.where(first, *(getattr(one, name) for one in found)) for name in vars(found[0])})

    def _on_side(self, end: Array, level: Array, wanted: Bools) -> Crossing:
        """Return the nearest crossing between the present value and an end."""
        part = (np.arange(1, _LOOKED_AT + 1) / _LOOKED_AT) ** 2
        values = self.present[:, None] + (end - self.present)[:, None] * part
        there = (self.scores(values) >= level[:, None]) == wanted[:, None]
        there &= (end != self.present)[:, None]
        index = np.argmax(there, axis=1)
        rows = np.arange(len(level))
        has = there[rows, index]
        beyond = values[rows, index]
        before = np.where(index > 0, values[rows, index - 1], self.present)
        value = self._false_position(before, beyond, level, has)
        return Crossing(**{
            name: np.where(has, one, np.nan)
            for name, one in (("value", value), ("before", before), ("beyond", beyond))
        })  # fmt: skip

    def _false_position(self, low: Array, high: Array, level: Array, has: Bools) -> Array:
        """Return where scores cross a level between two values, by the Illinois rule."""
        if not has.any():
            return high
        at_low, at_high = self.score(low) - level, self.score(high) - level
        value = high
        for _ in range(_FALSE_POSITIONS):
            with np.errstate(all="ignore"):
                tried = high - at_high * (high - low) / (at_high - at_low)
            value = np.where(np.isfinite(tried), np.clip(tried, np.minimum(low, high), np.maximum(low, high)), high)
            found = self.score(value) - level
            other = found * at_high < 0
            low, at_low = np.where(other, high, low), np.where(other, at_high, at_low / 2)
            high, at_high = value, found
        return value

    def value_at(self, near: Array, level: Array) -> Array:
        """Return the values (variants,) at which scores are at a level, next to values that are near."""
        step = 1e-5 * np.maximum(np.abs(near), np.abs(self.present))
        with np.errstate(all="ignore"):
            rise = (self.score(near + step) - self.score(near - step)) / (2 * step)
            value = near
            for _ in range(_CHORDS):
                value = value - (self.score(value) - level) / rise
        return value


def _moments(limits: LimitArrays, shape: str) -> tuple[Array, Array]:
    """Return mean and standard deviation of a dimension, before any cut."""
    if shape in _SHAPES:
        return limits.mean, _SHAPES[shape][0] * (limits.high - limits.low) / 2
    return limits.mean, limits.sd
