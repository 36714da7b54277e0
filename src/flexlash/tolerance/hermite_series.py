"""Standard values as series of Hermite polynomials in the normal score, and what two of them have in common.

Normalised Hermite polynomials hₙ are orthonormal under the standard normal density, and for two scores with the
correlation ρ, E[hₘ(u) hₙ(w)] is ρⁿ where m = n, and else 0 (Mehler 1866). So whatever is a series in scores that are
tied by a Gaussian copula has its covariances in closed form.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.tolerance.distributions import Distribution

__all__ = ["hermite_polynomials", "score_correlation", "value_correlation"]

_TERMS = 160
"""Terms of a series; what the later ones come to at the ends is added there."""

_REACH = 12.0
"""Scores beyond which no polynomial of the series is above 1e-15, times the normal density."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)
_WIDTH = 1.0
"""Widest piece between two breaks that the nodes integrate; the fastest polynomial has two waves in it."""

_EXACT = 1e-14
_ROUNDING = 1e-12
"""An end is reached by what is this near to it."""


def hermite_polynomials(score: Array, terms: int) -> Array:
    """Return the normalised Hermite polynomials h₀, h₁, … at scores, (terms, …).

    Equation: √(n + 1) hₙ₊₁(u) = u hₙ(u) − √n hₙ₋₁(u), with h₀ = 1
    Arguments: standard normal scores of any shape.
    Valid: any score; for |u| ≫ 2√n the polynomials grow as uⁿ/√n!.
    Source: the recurrence of the probabilists' Hermite polynomials, Abramowitz and Stegun 22.7.14.

    >>> hermite_polynomials(np.array(2.0), 3).round(9).tolist()
    [1.0, 2.0, 2.121320344]
    """
    values = np.empty((terms, *score.shape))
    values[0] = 1.0
    for index in range(1, terms):
        values[index] = score * values[index - 1]
        if index > 1:
            values[index] -= np.sqrt(index - 1) * values[index - 2]
        values[index] /= np.sqrt(index)
    return values


def value_correlation(first: Distribution, second: Distribution) -> Callable[[float], float]:
    """Return the function that gives Pearson's correlation of the values for that of their normal scores.

    Equation: ρ_x = Σ aₙ bₙ ρⁿ/√(Σ aₙ² Σ bₙ²), n ≥ 1, with aₙ, bₙ the coefficients of the two series
    Arguments: two distributions, whose shapes alone matter; the function takes ρ from −1 to 1.
    Valid: distributions with a variance; it rises with ρ, and is exact at −1, 0 and 1.
    Source: Mehler 1866; Nataf 1962, Liu and Der Kiureghian 1986 (the same integral by tables).

    >>> from flexlash.tolerance.distributions import Normal, Uniform
    >>> pair = value_correlation(Uniform(0, 1), Normal(5, 2))
    >>> f"{pair(0.5) * (np.pi / 3) ** 0.5:.9f}"
    '0.500000000'
    """
    breaks = {*first.breaks, *second.breaks}
    score, weight = _rule({*breaks, *(-score for score in breaks)})
    one, other, turned = (_standardised(values, weight) for values in _values(first, second, score))
    root = np.sqrt(weight)
    basis = hermite_polynomials(score, _TERMS) * root
    products = (basis @ (root * one)) * (basis @ (root * other))
    signs = (-1.0) ** np.arange(_TERMS)
    together = float((weight * one * other).sum()) - float(products.sum())
    opposite = float((weight * one * turned).sum()) - float((products * signs).sum())
    # The terms left out, even and odd ones, as if they came at once.
    even, odd = (together + opposite) / 2, (together - opposite) / 2

    def correlation(of_scores: float) -> float:
        left_out = of_scores**_TERMS * (even + odd * of_scores)
        return float(np.polynomial.polynomial.polyval(of_scores, products) + left_out)

    return correlation


def score_correlation(first: Distribution, second: Distribution, of_values: float) -> float | None:
    """Return the correlation of normal scores that gives the values this Pearson's correlation, None if there is none.

    Equation: the root ρ of ρ_x(ρ) = ρ_x, by Brent's method
    Arguments: two distributions, whose shapes alone matter; a correlation of their values.
    Valid: correlations that a Gaussian copula reaches: those of scores from −1 to 1.
    Source: Nataf 1962; for uniform values 2 sin(π ρ_x/6) in closed form (Pearson 1907).

    >>> from flexlash.tolerance.distributions import Uniform
    >>> round(score_correlation(Uniform(0, 1), Uniform(2, 5), 0.5), 6)
    0.517638
    """
    from scipy.optimize import brentq

    if of_values == 0:
        return 0.0
    if first.shape == second.shape == ("normal",):
        return of_values if abs(of_values) <= 1 else None
    correlation = value_correlation(first, second)
    for end in (-1.0, 1.0):
        if abs(of_values - correlation(end)) <= _ROUNDING:
            return end
    if not correlation(-1.0) < of_values < correlation(1.0):
        return None
    root = brentq(lambda score: correlation(score) - of_values, -1.0, 1.0, xtol=_EXACT, rtol=4 * np.finfo(float).eps)
    return float(root)


def _values(first: Distribution, second: Distribution, score: Array) -> tuple[Array, Array, Array]:
    """Return the standard values at scores, those of the second also at the scores turned round."""
    return first.standard_at(score), second.standard_at(score), second.standard_at(-score)


def _standardised(values: Array, weight: Array) -> Array:
    """Return values less their mean, over their standard deviation."""
    centred = values - (weight * values).sum()
    return np.asarray(centred / np.sqrt((weight * centred * centred).sum()))


def _rule(breaks: set[float]) -> tuple[Array, Array]:
    """Return scores and weights that integrate under the normal density between breaks."""
    steps = np.arange(-_REACH, _REACH + _WIDTH / 2, _WIDTH)
    ends = np.unique([*steps, *(score for score in breaks if abs(score) < _REACH)])
    half = np.diff(ends)[:, None] / 2
    score = (half * _NODES + ends[:-1, None] + half).ravel()
    weight = (half * _WEIGHTS).ravel() * np.exp(-score * score / 2)
    return score, weight / weight.sum()
