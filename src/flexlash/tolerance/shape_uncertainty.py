"""What n measured values leave open of the shape of their distribution: its skewness, and how long its tails are.

curve           standardised values over normal scores, beyond the outermost in a straight line as a normal tail goes on
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from typing import TypeAlias

import numpy as np
from scipy.special import ndtri

from flexlash.schema.arrays import Array
from flexlash.tolerance.measured import Measured
from flexlash.tolerance.sample_uncertainty import UPPER_SCORE

__all__ = ["BENDS", "bent_values"]

Values: TypeAlias = tuple[float, ...]

BENDS = 2
"""Ways in which a curve is bent: more or less skewed, with longer or shorter tails."""

_POINTS = 1000, 20_000
"""Fewest and most values that stand for a bent curve, so many that its tails do not end where a limit may lie."""

_CAUTION = 1.5
"""Times the standard errors by which a curve is bent: few values show less of a tail than there is."""

_SLOPE_OVER = 0.5
"""Scores over which the slope of a curve at its outermost value is taken."""


@lru_cache(maxsize=128)
def bent_values(values: Values) -> tuple[tuple[Values, Values], ...]:
    """Return pairs of standardised values: less and more skewed than a sample, then with shorter and longer tails.

    Equation: q(u) ± 1.96 f s₃/6 (u² − 1) and ± 1.96 f s₄/24 (u³ − 3u), q the curve, u normal scores, f = 1.5; s₃, s₄
        standard errors of skewness and excess kurtosis: √(6/n) and √(24/n), or what the values show where that is more
    Arguments: at least 5 finite values that differ.
    Valid: f is chosen so that of gamma processes with the skewness 1 and 1.4 the true P99.865 lies inside for 20 to 200
        values; of normal and uniform processes it nearly always does.
    Source: Cornish and Fisher 1938 (the bends); Kendall and Stuart, chapter 10 (standard errors by influence).

    >>> (less, more), (short, long) = bent_values((1.0, 2.0, 3.0, 4.0, 5.0, 6.5))
    >>> less[-1] < more[-1], short[-1] < long[-1]
    (True, True)
    """
    return tuple(_bent(values))


def _bent(values: Values) -> Iterator[tuple[Values, Values]]:
    """Yield the pairs; bends that turn a curve back are put in order."""
    points = min(max(len(values), _POINTS[0]), _POINTS[1])
    scores = ndtri((np.arange(points) + 0.625) / (points + 0.25))
    curve, (skewness, kurtosis) = _curve(values, scores), _errors(values)
    reach = _CAUTION * UPPER_SCORE
    for bend in (skewness / 6 * (scores**2 - 1), kurtosis / 24 * (scores**3 - 3 * scores)):
        less, more = (tuple(np.sort(curve + side * reach * bend).tolist()) for side in (-1.0, 1.0))
        yield less, more


def _curve(values: Values, scores: Array) -> Array:
    """Return the curve through values at scores."""
    shape = Measured(values)
    edge = float(ndtri((len(values) - 0.375) / (len(values) + 0.25)))
    curve = shape.standard_at(np.clip(scores, -edge, edge))
    for side in (-1.0, 1.0):
        inner, outer = shape.standard_at(np.array([edge - _SLOPE_OVER, edge]) * side).tolist()
        curve = curve + (outer - inner) / _SLOPE_OVER * np.maximum(side * scores - edge, 0.0)
    return curve


def _errors(values: Values) -> tuple[float, float]:
    """Return the standard errors of skewness and excess kurtosis: a normal's, or what the values show if more."""
    count = len(values)
    deviation = np.array(values) - math.fsum(values) / count
    score = deviation / math.sqrt(math.fsum((deviation**2).tolist()) / count)
    third, fourth = (math.fsum((score**power).tolist()) / count for power in (3, 4))
    skewness = score**3 - 3 * score - third - 1.5 * third * (score**2 - 1)
    kurtosis = score**4 - fourth - 4 * third * score - 2 * fourth * (score**2 - 1)
    shown = (math.sqrt(math.fsum((influence**2).tolist())) / count for influence in (skewness, kurtosis))
    least = math.sqrt(6 / count), math.sqrt(24 / count)
    first, second = (max(pair) for pair in zip(shown, least, strict=True))
    return first, second
