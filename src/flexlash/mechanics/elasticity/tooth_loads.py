"""How the teeth share the torque around the axis, and what their shares do to the wind-up.

A flexspline on a wave generator is loaded in two opposite arcs, so that only even harmonics n count. A load is known
by their ratios q_n/q₀, a flexspline by its compliances ρ_n, how much more the face gives way to the load cos nθ than to
the even one. The wind-up is then 1 + ½ Σ ρ_n (q_n/q₀)² times that of the even load.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from flexlash.schema.arrays import Array, Quantity

__all__ = [
    "HARMONICS",
    "all_compliances",
    "engaged_arc",
    "half_sine_ratios",
    "lobe_factor",
    "rigid_contact_factor",
    "single_tooth_ratios",
    "uniform_ratios",
]

HARMONICS = np.arange(2.0, 402.0, 2.0)
"""Harmonics that count: to where a wave is two teeth long on a flexspline with 200 teeth and a tooth is no line."""

_PIECES = 32
"""Pieces of half an arc over each of which the load of a rigid contact is even; 64 lower the factor by 1e-4."""


def engaged_arc(engaged_share: float) -> float:
    """Half the angle of each of the two arcs in which teeth are engaged [rad].

    Equation: a = p π/2
    Arguments: engaged_share p of all teeth [-].
    Valid: 0 < p ≤ 1; two opposite arcs.
    Source: geometry.

    >>> round(math.degrees(engaged_arc(0.25)), 9)
    22.5
    """
    return engaged_share * math.pi / 2


def uniform_ratios(harmonics: Array, arc: float) -> Array:
    """Ratios q_n/q₀ of a load that is even within two arcs [-].

    Equation: 2 sin(na)/(na)
    Arguments: even harmonics n; arc a, half the angle of each arc [rad].
    Valid: 0 < a ≤ π/2.
    Source: Fourier's coefficients.

    >>> uniform_ratios(np.array([2.0, 4.0]), math.pi / 4).round(6).tolist()
    [1.27324, 0.0]
    """
    return np.asarray(2 * np.sinc(harmonics * arc / np.pi))


def half_sine_ratios(harmonics: Array, arc: float) -> Array:
    """Ratios q_n/q₀ of a load that goes as half a sine wave over each of two arcs [-].

    Equation: 2 cos(na)/(1 − (2na/π)²), π/2 where that is 0/0
    Arguments: even harmonics n; arc a, half the angle of each arc [rad].
    Valid: 0 < a ≤ π/2.
    Source: Fourier's coefficients.

    >>> half_sine_ratios(np.array([2.0, 4.0]), math.pi / 4).round(6).tolist()
    [1.570796, 0.666667]
    """
    waves = 2 * harmonics * arc / np.pi
    # cos(πx/2) = sin(π(1 − x)/2), which leaves nothing to divide by 0 at x = 1.
    return np.asarray(np.pi * np.sinc((1 - waves) / 2) / (1 + waves))


def single_tooth_ratios(harmonics: Array) -> Array:
    """Ratios q_n/q₀ of two opposite teeth that carry everything [-].

    Equation: 2
    Arguments: even harmonics n.
    Valid: as long as a tooth is narrow beside a wave.
    Source: Fourier's coefficients.

    >>> single_tooth_ratios(np.array([2.0, 4.0])).tolist()
    [2.0, 2.0]
    """
    return np.full_like(harmonics, 2.0)


def lobe_factor(compliances: Quantity, ratios: Array) -> float:
    """Wind-up under an uneven load over that under the even one [-].

    Equation: 1 + ½ Σ ρ_n (q_n/q₀)²
    Arguments: compliances ρ_n and ratios q_n/q₀ [-] of the same harmonics.
    Valid: linear elasticity; wind-up is the work of the load over half the torque.
    Source: orthogonality of harmonics.

    >>> lobe_factor(np.array([0.1, 0.02]), np.array([1.0, 0.5]))
    1.0525
    """
    return float(1 + 0.5 * np.sum(compliances * ratios * ratios))


def rigid_contact_factor(harmonics: Array, compliances: Array, arc: float) -> float:
    """Wind-up over that under the even load where all teeth of two arcs turn by the same angle, and none pulls [-].

    Equation: least 1 + ½ Σ ρ_n (q_n/q₀)² over loads q ≥ 0 within the arcs
    Arguments: even harmonics n with their compliances ρ_n [-]; arc a, half the angle of each arc [rad].
    Valid: 0 < a ≤ π/2; teeth rigid beside the flexspline, no clearance between them.
    Source: least work; the load is even over each of 32 pieces of half an arc, finer towards its end.

    >>> compliances = 0.2 / HARMONICS**1.5
    >>> [round(rigid_contact_factor(HARMONICS, compliances, engaged_arc(share)), 3) for share in (0.25, 1.0)]
    [1.115, 1.0]
    """
    from scipy.optimize import nnls

    # The load rises as steeply towards the ends of the arc as the pressure under a rigid punch.
    edges = arc * np.sin(np.linspace(0.0, np.pi / 2, _PIECES + 1))
    ratios = 2 * np.diff(np.sin(harmonics[:, None] * edges) / harmonics[:, None], axis=1) / np.diff(edges)
    # Least squares hold the sum near 1 at no cost to the shares, which the energy alone decides.
    equations = np.vstack([np.sqrt(compliances / 2)[:, None] * ratios, np.ones(_PIECES)])
    loads, _ = nnls(equations, np.append(np.zeros(len(harmonics)), 1.0))
    return lobe_factor(compliances, ratios @ loads / loads.sum())


def all_compliances(harmonics: Sequence[int], compliances: Array) -> Array:
    """Compliances ρ_n of all `HARMONICS`, from those of a few [-].

    Equation: a cubic spline of ln ρ over ln n, beyond the last n the line through the last two
    Arguments: harmonics n in rising order from 2, with their compliances ρ_n.
    Valid: ρ_n smooth and above 0; from 2, 4, 6, 8, 12, 18, 26, 40 within 5e-5 of a wind-up.
    Source: interpolation.

    >>> all_compliances([2, 4, 8], np.array([0.16, 0.04, 0.01]))[[2, 24]].round(9).tolist()
    [0.017777778, 0.000256]
    """
    from scipy.interpolate import CubicSpline

    places, heights = np.log(harmonics), np.log(compliances)
    slope = (heights[-1] - heights[-2]) / (places[-1] - places[-2])
    wanted = np.log(HARMONICS)
    within, beyond = CubicSpline(places, heights)(wanted), heights[-1] + slope * (wanted - places[-1])
    return np.asarray(np.exp(np.where(wanted <= places[-1], within, beyond)))
