"""Integrals of the two rings that a fillet thickens, by quadrature over the angle of its arc."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from flexlash.arrays import Array

__all__ = ["ARC_RULE", "FINE_RULE", "JUNCTION_RULE", "WIDE", "hub_fillet_integral", "junction_fillet_integral"]

Rule: TypeAlias = tuple[tuple[float, float, float], ...]
"""Sine, cosine and weight of angles from 0 to π/2."""


def _rule(angles_and_weights: Iterable[tuple[float, float]]) -> Rule:
    return tuple((math.sin(angle), math.cos(angle), weight) for angle, weight in angles_and_weights)


def _quarter(points: int) -> Rule:
    """Return the Gauss–Legendre rule from 0 to π/2."""
    nodes, weights = np.polynomial.legendre.leggauss(points)
    return _rule(zip(((nodes + 1) * np.pi / 4).tolist(), (weights * np.pi / 4).tolist(), strict=True))


ARC_RULE, FINE_RULE = _quarter(12), _quarter(48)

WIDE = 20.0
"""Fillet radius over thickness above which an arc takes the fine rule."""

JUNCTION_RULE = _rule(
    (
        (0.0814393410996599, 0.16529866972037566),
        (0.25821157583711407, 0.19208838252972127),
        (0.47109223622392854, 0.23505735771838746),
        (0.7274664878100502, 0.2750983196290333),
        (1.0111507847150607, 0.28485302680318736),
        (1.279446758070356, 0.24240361387908071),
        (1.4792660625622378, 0.15055964925008272),
    )
)
"""Angles p from the wall and weights of a rule from 0 to π/2 fitted to the junction fillet's integrands."""


def hub_fillet_integral(
    inner_radius: Array | float, fillet_radius: Array | float, thickness_at: Callable[[Array], Array | float]
) -> Array:
    """Integral of the disk's inmost ring, thickened by the hub fillet [1/m³].

    Equation: I = ∫ dr/(r³ (t + a)), r from r_ci to r_ci + R, a = R (1 − sin q), r = r_ci + R (1 − cos q)
    Arguments: inner_radius r_ci and fillet_radius R [m], of any one shape; thickness_at gives the thickness t of
        the disk itself [m] at radii of that shape.
    Valid: R up to the width of the disk; twelve Gauss–Legendre points in q, error below 1e-10 at R = 2t and below
        2e-7 up to R = 20t, t at the hub; from there on 48 points.
    Source: the meridian integral with the fillet on the inner face; the substitution tames the steep end.

    >>> f"{hub_fillet_integral(0.04, 0.0035, lambda _: 0.0016):.6e}"
    '2.202297e+04'
    """

    def by(rule: Rule) -> Array:
        total: Array | float = 0.0
        for sine, cosine, weight in rule:
            radius = np.asarray(inner_radius + fillet_radius * (1 - cosine))
            thickness = thickness_at(radius) + fillet_radius * (1 - sine)
            total = total + weight * sine / (radius * radius * radius * thickness)
        return np.asarray(total * fillet_radius)

    wide = np.asarray(fillet_radius > WIDE * thickness_at(np.asarray(inner_radius)))
    return _either(by, wide, ARC_RULE, FINE_RULE)


def junction_fillet_integral(
    mean_radius: Array | float, thickness: Array | float, fillet_radius: Array | float
) -> Array:
    """Integral of the wall's first ring, thickened inwards by the fillet in the corner [1/m³].

    Equation: I = ∫ dz/((r_m − a/2)³ (Δ + a)), z from 0 to R, a = R (1 − cos p), z = R (1 − sin p)
    Arguments: mean_radius r_m, thickness Δ and fillet_radius R [m], of any one shape.
    Valid: R up to the radius of the bore; error below 1e-9 up to R = 3Δ and below 1e-6 up to R = 20Δ, by seven
        points and weights fitted to integrands 1/((r_m − a/2)³ (Δ + a)) of this range; from there on 48 points.
    Source: the meridian integral; the middle of the wall moves inwards by half of what the fillet adds.

    >>> f"{junction_fillet_integral(0.0808, 0.0016, 0.0035):.6e}"
    '3.119550e+03'
    """

    def by(rule: Rule) -> Array:
        total: Array | float = 0.0
        for _, cosine, weight in rule:
            added = fillet_radius * (1 - cosine)
            radius = mean_radius - added * 0.5
            total = total + weight * cosine / (radius * radius * radius * (thickness + added))
        return np.asarray(total * fillet_radius)

    return _either(by, np.asarray(fillet_radius > WIDE * thickness), JUNCTION_RULE, FINE_RULE)


def _either(by: Callable[[Rule], Array], wide: npt.NDArray[np.bool_], usual: Rule, fine: Rule) -> Array:
    """Return a quadrature by the usual rule, or by the fine one where a fillet is wide."""
    found = by(usual)
    return np.where(wide, by(fine), found) if np.any(wide) else found
