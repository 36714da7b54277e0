"""Where lines pass: a few replicates of scrambled points across the direction, as standard normal scores."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.special import ndtr, ndtri

from flexlash.schema.arrays import Array
from flexlash.tolerance.digital_nets import scrambled_net

__all__ = ["LINE_REPLICATES", "Net", "line_net", "mirrored_net", "normal_density"]

LINE_REPLICATES = 8
"""Independent replicates behind every standard error: 7 degrees of freedom."""

_SPACED = {8: 4.0, 16: 5.0}
"""Points of an evenly spaced coordinate, and how far it reaches to both sides."""


def normal_density(score: Array) -> Array:
    """Return the standard normal density at scores, in their shape.

    >>> round(float(normal_density(np.array(0.0))), 9)
    0.39894228
    """
    return np.asarray(np.exp(score * score * -0.5) * (1 / np.sqrt(2 * np.pi)))


@dataclass(frozen=True, kw_only=True)
class Net:
    """Scores (coordinates, lines) and the weights (lines,) of the lines, which sum to 1 in each replicate.

    `spaced` counts the points of an evenly spaced first coordinate, or is 0; `beyond` is the probability that it
    leaves out at both ends.
    """

    scores: Array
    weights: Array
    spaced: int = 0
    beyond: float = 0.0

    @property
    def lines(self) -> int:
        """Lines in all replicates."""
        return len(self.weights)


@lru_cache(maxsize=64)
def line_net(seed: int, width: int, lines: int, *, single_curved: bool) -> Net:
    """Return a net of `width` coordinates, another one for each number of lines.

    Where the output curves with one score alone, the first coordinate, which serves it, is evenly spaced, shifted at
    random and weighted by the normal density: the trapezoidal rule, which converges faster than any net. A coordinate
    that is alone is spaced too.

    Equation: uᵢⱼ = Φ⁻¹ of scrambled Sobol' points, LINE_REPLICATES independent ones
    Arguments: seed; lines in all, LINE_REPLICATES times a power of two.
    Valid: any width; beyond 64 coordinates the points are independent.
    Source: Owen 1995; L'Ecuyer and others on conditional Monte Carlo with randomized quasi-Monte Carlo.
    """
    generator = np.random.default_rng([seed, lines])
    count = lines // LINE_REPLICATES
    spaced = max((points for points in _SPACED if points <= count), default=0)
    if not (spaced and (width == 1 or (single_curved and width))):
        points = scrambled_net(width, LINE_REPLICATES, count, generator).reshape(width, lines)
        return Net(scores=np.asarray(ndtri(points)), weights=np.full(lines, 1 / count))
    points = scrambled_net(width - 1, LINE_REPLICATES, count, generator).reshape(width - 1, lines)
    shifted = (np.arange(spaced) + generator.random((LINE_REPLICATES, 1))) / spaced
    first = np.repeat((2 * shifted - 1) * _SPACED[spaced], count // spaced, axis=1)
    weights = np.exp(-first * first / 2)
    weights = weights / weights.sum(axis=1, keepdims=True)
    return Net(
        scores=np.concatenate([first.reshape(1, lines), ndtri(points)]),
        weights=weights.reshape(lines),
        spaced=spaced,
        beyond=2 * float(ndtr(-_SPACED[spaced])),
    )


@lru_cache(maxsize=64)
def mirrored_net(seed: int, width: int, points: int) -> Array:
    """Return scores (width, points), half of them mirrored so that linear effects cancel; replicate after replicate.

    Some pairs of coordinates of a small net lie on one diagonal or the other, at random: each replicate takes the
    coordinates in an order of its own, so that no interaction is seen from the same side by all.

    Equation: u = ± Φ⁻¹ of scrambled Sobol' points, LINE_REPLICATES independent ones
    Arguments: seed; points in all, 2 · LINE_REPLICATES times a power of two.
    Valid: any width; beyond 64 coordinates the points are independent.
    Source: Owen 1995; antithetic points (Hammersley and Morton 1956).

    >>> scores = mirrored_net(0, 3, 32).reshape(3, 8, 4)
    >>> bool((scores[:, :, :2] == -scores[:, :, 2:]).all())
    True
    """
    generator = np.random.default_rng([seed, points, width])
    half = ndtri(scrambled_net(width, LINE_REPLICATES, points // (2 * LINE_REPLICATES), generator))
    order = generator.permuted(np.tile(np.arange(width)[:, None], LINE_REPLICATES), axis=0)
    half = np.take_along_axis(half, order[:, :, None], axis=0)
    return np.concatenate([half, -half], axis=2).reshape(width, points)
