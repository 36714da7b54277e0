"""The metalog: a quantile function as a short sum, by which other programs take over a distribution."""

from __future__ import annotations

import numpy as np

from flexlash.schema.arrays import Array

__all__ = ["TERMS", "metalog_coefficients", "metalog_quantile"]

TERMS = 11
"""Most terms that are fitted: a normal is then followed to 0.004 sd between 0.135 and 99.865 %, with nine to 0.012."""

_CHECKED = np.linspace(1e-6, 1 - 1e-6, 2001)


def metalog_quantile(coefficients: Array, levels: Array) -> Array:
    """Return the quantiles of a metalog.

    Equation: M(y) = a₁ + a₂ L + a₃ h L + a₄ h + a₅ h² + a₆ h² L + a₇ h³ + …, L = ln(y/(1 − y)), h = y − ½
    Arguments: coefficients a (terms,), in the unit of the result; levels y, of any one shape with it.
    Valid: 0 < y < 1.
    Source: Keelin 2016, The Metalog Distributions, equation 6; Metalog_1_0 of the SIPmath 3.0 standard.

    >>> metalog_quantile(np.array([3.0, 1.0]), np.array([0.5, 0.75])).round(6).tolist()
    [3.0, 4.098612]
    """
    levels = np.asarray(levels, dtype=float)
    return np.asarray(np.add.reduce(_terms(levels, len(coefficients)) * coefficients, axis=-1))


def metalog_coefficients(levels: Array, quantiles: Array, most: int = TERMS) -> Array:
    """Return the coefficients of the metalog that fits quantiles best and rises throughout.

    Equation: least squares of M(yᵢ) − qᵢ, with the most terms for which dM/dy > 0 between 1e-6 and 1 − 1e-6
    Arguments: levels y and quantiles q (points,), at least as many as terms, q in the unit of the result.
    Valid: quantiles that do not fall; where they are all equal, that value alone.
    Source: Keelin 2016, equation 7.

    >>> level = np.linspace(0.01, 0.99, 99)
    >>> (metalog_coefficients(level, 3 + np.log(level / (1 - level)), 4).round(6) + 0.0).tolist()
    [3.0, 1.0, 0.0, 0.0]
    """
    scale = float(quantiles[-1] - quantiles[0])
    if scale <= 0:
        return np.array([float(quantiles[0])])
    middle = float(quantiles[len(quantiles) // 2])
    for terms in range(min(most, len(levels)), 2, -1):
        found = _fitted(levels, (quantiles - middle) / scale, terms)
        if np.all(np.diff(metalog_quantile(found, _CHECKED)) > 0):
            break
    else:
        found = _fitted(levels, (quantiles - middle) / scale, 2)
    found = found * scale
    found[0] += middle
    return found


def _fitted(levels: Array, quantiles: Array, terms: int) -> Array:
    return np.asarray(np.linalg.lstsq(_terms(levels, terms), quantiles, rcond=None)[0], dtype=np.float64)


def _terms(levels: Array, count: int) -> Array:
    """Return the terms of a metalog (..., count) without their coefficients."""
    odds, half = np.log(levels / (1 - levels)), levels - 0.5
    terms = [np.ones_like(levels), odds, half * odds, half]
    for power in range(2, count):
        terms += [half**power, half**power * odds]
    return np.stack(terms[:count], axis=-1)
