"""A smooth distribution through measured values, whose tails end where so many values can tell nothing more.

plotting position   the normal score at which the i-th of n values in order is expected
"""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from scipy.special import ndtri

from flexlash.schema.argument_checks import number, numbers
from flexlash.schema.arrays import Array
from flexlash.schema.variant import FEWEST_PARTS
from flexlash.tolerance.truncated_normal import TruncatedNormal

if TYPE_CHECKING:
    from scipy.interpolate import PPoly

__all__ = ["Measured"]

_INSIDE = 0.95
"""Probability that all of as many values as were measured lie between the ends."""

_SPACING = 0.5
"""Scores between knots, about; closer ones would follow the accidents of a sample."""

_STIFFNESS = 0.1
"""Weight of the curvature, which draws the curve towards the straight one of a normal distribution."""

_LEAST_SLOPE = 0.02
"""Least rise of the curve in a score, in standard deviations of the sample, so that no two scores share a value."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_STEPS = 24
"""Steps of Newton's method, or halvings, behind a score; the same for each, so that none depends on the others."""


class Measured:
    """Distribution of a part's dimension by measured values; its mean and sd (n − 1) are the sample's, exactly.

    A smooth curve through the values in order over their normal scores, drawn a little towards the straight line of a
    normal distribution. Beyond the least and the greatest of n values nothing was measured: the curve goes on with its
    last slope, as a normal tail does, and ends where 95 of 100 samples of n values would lie wholly inside. For 60
    values the ends are at 0.043 % and 99.957 % of the uncut curve. Nothing rarer than about 1 in 40 n is invented: what
    hangs on this input alone has the probability 0 beyond its ends, where a normal of the same mean and sd would go on.

    Equation: x = x̄ + s (q(u) − E q)/sd q, where q minimises Σ wᵢ² (zᵢ − q(uᵢ))² + λ ∫ q″² du among cubic splines that
        rise everywhere; zᵢ values in order less their mean, over their sd, uᵢ = Φ⁻¹((i − 3/8)/(n + 1/4)),
        wᵢ² = φ(uᵢ)²/(pᵢ (1 − pᵢ)) and λ = 0.1; u is a normal score cut where (1 − 2 ε)ⁿ = 0.95.
    Arguments: at least 5 finite values, not all equal, in the unit of the dimension and any order; `shift` is added to
        each, such as the nominal size where deviations from it were measured.
    Valid: values of independent parts of one process. Doubled values, as a gauge rounds them, do no harm. Sixty values
        of a normal process give P97.5 to 0.27 sd and P99.865 to 0.48 (a normal of their mean and sd: 0.23 and 0.32),
        those of a uniform one to 0.15 and 0.56 (0.34 and 1.28).
    Source: Blom 1958 (plotting positions); Ramsay 1988 (monotone regression splines); at the ends the binomial
        probability that none of n values lies beyond.

    >>> sample = Measured([1.61, 1.60, 1.62, 1.60, 1.59, 1.63])
    >>> round(sample.expectation, 12), round(sample.standard_deviation, 9)
    (1.608333333333, 0.014719601)
    """

    def __init__(self, values: npt.ArrayLike, shift: float = 0.0) -> None:
        measured = numbers("values", values)
        if measured.ndim != 1 or len(measured) < FEWEST_PARTS:
            raise ValueError(f"values have the shape {measured.shape}: at least {FEWEST_PARTS} in a row are required")
        if not np.isfinite(measured).all():
            raise ValueError("values must be finite")
        if measured.min() == measured.max():
            raise ValueError(f"values are all {measured[0]:g}: at least two that differ are required")
        self._shift = number("shift", shift)
        # A zero is added, since zeros of either sign are one value.
        self._curve = _curve_through(tuple((np.sort(measured) + 0.0).tolist()))

    @property
    def _key(self) -> tuple[str, float, float]:
        return self._curve.digest, self.location, self.scale

    def __repr__(self) -> str:
        return f"<Measured: mean {self.location:g}, sd {self.scale:g}>"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Measured) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    @property
    def shape(self) -> tuple[str | float, ...]:
        """A digest of the values in order less their mean, over their standard deviation."""
        return ("measured", self._curve.digest)

    @property
    def location(self) -> float:
        """The mean of the values and the shift."""
        return self._curve.mean + self._shift

    @property
    def scale(self) -> float:
        """The standard deviation of the values (n − 1)."""
        return self._curve.sd

    @property
    def breaks(self) -> tuple[float, ...]:
        """The scores of the knots, where the third derivative jumps."""
        return self._curve.breaks

    @property
    def expectation(self) -> float:
        """The mean of the values and the shift."""
        return self.location

    @property
    def standard_deviation(self) -> float:
        """The standard deviation of the values (n − 1)."""
        return self.scale

    def standard(self, probability: Array) -> Array:
        """Return quantiles of the shape with the mean 0 and the standard deviation 1."""
        return self._curve.at(self._curve.cut.standard(probability))

    def standard_at(self, score: Array) -> Array:
        """Return quantiles of the shape at the probabilities of scores, counted from the nearer end."""
        return self._curve.at(self._curve.cut.standard_at(score))

    def probability_below(self, standard: Array) -> Array:
        """Return the distribution function of the shape, the cut normal's at the scores where the curve has values."""
        return self._curve.cut.probability_below(self._curve.scores(standard))


@dataclass(frozen=True, kw_only=True)
class _Curve:
    """A sample's curve: standard values with the mean 0 and sd 1 over scores, which the `cut` normal has.

    `mean` and `sd` are the sample's, `digest` that of its values less their mean and over their sd; `breaks` are the
    scores, before the cut, of the knots.
    """

    mean: float
    sd: float
    digest: str
    cut: TruncatedNormal
    pieces: PPoly
    breaks: tuple[float, ...]

    def at(self, score: Array) -> Array:
        """Return the standard values at scores, in their shape."""
        return np.asarray(self.pieces(score))

    def scores(self, standard: Array) -> Array:
        """Return the scores that have standard values, by Newton's method within brackets; an end beyond the ends."""
        knots, slope = self.pieces.x, self.pieces.derivative()
        values = self.at(knots)
        inside = np.clip(standard, values[0], values[-1])
        piece = np.clip(np.searchsorted(values, inside, side="right") - 1, 0, len(knots) - 2)
        low, high = knots[piece], knots[piece + 1]
        score = low + (inside - values[piece]) / (values[piece + 1] - values[piece]) * (high - low)
        for _ in range(_STEPS):
            off = self.at(score) - inside
            low, high = np.where(off <= 0, score, low), np.where(off >= 0, score, high)
            step = score - off / slope(score)
            score = np.where((step >= low) & (step <= high), step, (low + high) / 2)
        return score


@lru_cache(maxsize=256)
def _curve_through(values: tuple[float, ...]) -> _Curve:
    """Return the curve through values in order, some of which differ."""
    # Deviations from one of the values keep the digits that the size of a dimension would take.
    origin = values[len(values) // 2]
    beyond = np.array(values) - origin
    shift = float(beyond.mean())
    deviation = beyond - shift
    sd = math.hypot(*deviation) / math.sqrt(len(values) - 1)
    standardised = deviation / sd
    end = -float(ndtri((1 - _INSIDE ** (1 / len(values))) / 2))
    cut, pieces = TruncatedNormal(0.0, 1.0, -end, end), _standard(_monotone_spline(standardised, end))
    half = ndtri(cut.probability_below(-np.abs(pieces.x[1:-1])))
    return _Curve(
        mean=origin + shift,
        sd=sd,
        digest=hashlib.sha256(standardised.tobytes()).hexdigest(),
        cut=cut,
        pieces=pieces,
        breaks=tuple(np.copysign(half, pieces.x[1:-1]).tolist()),
    )


def _monotone_spline(values: Array, end: float) -> PPoly:
    """Return the cubic spline over scores ± end that rises everywhere and lies nearest to values in order."""
    # An eighth of a second and 25 MB that no process pays in which nothing was measured.
    from scipy.interpolate import BSpline, PPoly
    from scipy.optimize import nnls

    count = math.ceil(2 * end / _SPACING)
    step = 2 * end / count
    slopes = BSpline(step * (np.arange(count + 5) - 2) - end, np.eye(count + 2), 2)
    probability = (np.arange(len(values)) + 0.625) / (len(values) + 0.25)
    score = ndtri(probability)
    weight = np.exp(-score * score) / (2 * math.pi * probability * (1 - probability))
    basis = slopes.antiderivative()(score)
    # The height of the curve is free: only what lies off the weighted mean is fitted.
    basis -= (weight[:, None] * basis).sum(axis=0) / weight.sum()
    rest = values - (weight * values).sum() / weight.sum() - _LEAST_SLOPE * basis.sum(axis=1)
    bends = np.diff(np.eye(count + 2), axis=0)
    squares = np.einsum("ki,kj->ij", weight[:, None] * basis, basis) + _STIFFNESS / step * bends.T @ bends
    root = np.linalg.cholesky(squares)
    rise, _ = nnls(root.T, np.linalg.solve(root, (weight * rest) @ basis))
    curve = BSpline(slopes.t, _LEAST_SLOPE + rise, 2).antiderivative()
    knots = slopes.t[2:-2]
    powers = [curve.derivative(order)(knots[:-1]) / math.factorial(order) for order in (3, 2, 1)]
    return PPoly(np.array([*powers, curve(knots[:-1])]), knots)


def _standard(pieces: PPoly) -> PPoly:
    """Return a curve less its mean over its standard deviation, under the normal density."""
    half = np.diff(pieces.x)[:, None] / 2
    scores = pieces.x[:-1, None] + half * (1 + _NODES)
    weights = half * _WEIGHTS * np.exp(-scores * scores / 2)
    weights /= weights.sum()
    values = pieces(scores)
    mean = (weights * values).sum()
    sd = np.sqrt((weights * (values - mean) ** 2).sum())
    coefficients = pieces.c / sd
    coefficients[-1] -= mean / sd
    return type(pieces)(coefficients, pieces.x)
