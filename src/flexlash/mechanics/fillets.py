"""Integrals of the two rings that a fillet thickens, by quadrature along its arc.

Usual fillets take few points over the angle of the arc. Where an end of the arc is steep beside what it joins, graded
points follow: m is the tangent of half the angle from the end where the fillet adds nothing, 0 there and 1 at the
steep end, so that a = 2 R m²/(1 + m²) is added at the distance R (1 − m)²/(1 + m²) from the steep end. Near either end
the integrand changes over a width w that its thickness, or radius, gives, and m = w sinh v, v even, follows it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import TypeAlias

import numpy as np

from flexlash.mechanics.elementary import exp, log
from flexlash.schema.arrays import Array, Quantity

__all__ = [
    "ARC_RULE",
    "GRADED_RULE",
    "JUNCTION_RULE",
    "UNLIKE",
    "WIDE",
    "added_thickness",
    "arc_radius",
    "hub_fillet_integral",
    "junction_fillet_integral",
]

Rule: TypeAlias = tuple[tuple[float, float, float], ...]
"""Sine, cosine and weight of angles from 0 to π/2."""


def _rule(angles_and_weights: Iterable[tuple[float, float]]) -> Rule:
    return tuple((math.sin(angle), math.cos(angle), weight) for angle, weight in angles_and_weights)


def _gauss(points: int) -> list[tuple[float, float]]:
    """Return nodes and weights of the Gauss–Legendre rule from 0 to 1."""
    nodes, weights = np.polynomial.legendre.leggauss(points)
    return list(zip(((nodes + 1) / 2).tolist(), (weights / 2).tolist(), strict=True))


ARC_RULE = _rule((node * math.pi / 2, weight * math.pi / 2) for node, weight in _gauss(12))

GRADED_RULE = tuple(_gauss(32))
"""Nodes and weights between either end of an arc and its middle, in the variable that follows the integrand."""

WIDE = 19.7
"""Fillet radius over the least thickness above which graded points follow the arc; no ratio of round dimensions."""

UNLIKE = 4.87
"""Greatest ratio of a hub fillet's radius to that of the hub, and of the thicknesses at its ends, without them."""

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

_LEAST = 1e-30
"""Thickness over fillet radius that a ring is taken to have at least."""


def hub_fillet_integral(
    inner_radius: Quantity, fillet_radius: Quantity, thickness_at: Callable[[Array], Quantity]
) -> Array:
    """Integral of the disk's inmost ring, thickened by the hub fillet [1/m³].

    Equation: I = ∫ dr/(r³ (t + a)), r from r_ci to r_ci + R, a = R (1 − sin q), r = r_ci + R (1 − cos q)
    Arguments: inner_radius r_ci and fillet_radius R [m], of any one shape; thickness_at gives the thickness t of
        the disk itself [m] at radii of that shape, rising or falling all the way.
    Valid: R up to the width of the disk; error below 3e-7 of I up to R = 1000 r_ci, for any thickness (t_i at r_ci,
        t_o at r_ci + R). Twelve Gauss–Legendre points in q, below 1e-10 at R = 2t; graded points where R > 19.7 t_i
        or 19.7 t_o, R > 4.87 r_ci, or one of t_i and t_o is more than 4.87 times the other.
    Source: the meridian integral with the fillet on the inner face; the substitution tames the steep end.

    >>> f"{hub_fillet_integral(0.04, 0.0035, lambda _: 0.0016):.6e}"
    '2.202297e+04'
    """
    inner, fillet = np.asarray(inner_radius), np.asarray(fillet_radius)
    first, last = thickness_at(inner), thickness_at(inner + fillet)
    least = np.minimum(first, last)
    graded = (fillet > WIDE * least) | (fillet > UNLIKE * inner) | (np.maximum(first, last) > UNLIKE * least)

    def at_angle(sine: float, cosine: float) -> Array:
        radius = inner + fillet * (1 - cosine)
        return np.asarray(sine / (radius * radius * radius * (thickness_at(radius) + fillet * (1 - sine))))

    def radius_at(along: Array, back: Array) -> Array:
        return np.asarray(arc_radius(inner, fillet, along, back))

    def at_tangent(along: Array, back: Array) -> Array:
        radius = radius_at(along, back)
        return np.asarray(1 / (radius * radius * radius * (thickness_at(radius) + added_thickness(fillet, along))))

    def widths() -> tuple[Array, Array]:
        # A far draw of the tolerances may let the fillet pass the edge of a taper, where nothing is left of it.
        edge = np.maximum(last, _LEAST * fillet)
        even = np.sqrt(edge / (edge + 2 * fillet))
        rise = np.maximum(thickness_at(radius_at(even / 2, 1 - even / 2)) - edge, 0) / even
        outer = edge / (edge + rise + np.sqrt(rise * rise + 2 * fillet * edge))
        whole = first + fillet
        steep = np.minimum(inner / (inner + fillet / 2), whole / (whole + np.abs(last - first) / 2))
        return np.asarray(outer), np.asarray(np.sqrt(steep))

    usual = sum((weight * at_angle(sine, cosine) for sine, cosine, weight in ARC_RULE), np.zeros(()))
    integral = np.where(graded, _graded(at_tangent, widths()), usual) if np.any(graded) else usual
    return np.asarray(integral * fillet)


def junction_fillet_integral(mean_radius: Quantity, thickness: Quantity, fillet_radius: Quantity) -> Array:
    """Integral of the wall's first ring, thickened inwards by the fillet in the corner [1/m³].

    Equation: I = ∫ dz/((r_m − a/2)³ (Δ + a)), z from 0 to R, a = R (1 − cos p), z = R (1 − sin p)
    Arguments: mean_radius r_m, thickness Δ and fillet_radius R [m], of any one shape.
    Valid: R up to the radius of the bore; error below 1e-9 of I up to R = 3Δ and below 1e-6 at any R, by seven
        points and weights fitted to integrands 1/((r_m − a/2)³ (Δ + a)) up to R = 19.7Δ; graded points from there on.
    Source: the meridian integral; the middle of the wall moves inwards by half of what the fillet adds.

    >>> f"{junction_fillet_integral(0.0808, 0.0016, 0.0035):.6e}"
    '3.119550e+03'
    """
    wall, fillet = np.asarray(thickness), np.asarray(fillet_radius)
    graded = fillet > WIDE * wall

    def of_added(added: Quantity) -> Array:
        radius = mean_radius - added * 0.5
        return np.asarray(1 / (radius * radius * radius * (wall + added)))

    usual = sum(
        (weight * cosine * of_added(fillet * (1 - cosine)) for _, cosine, weight in JUNCTION_RULE),
        np.zeros(()),
    )
    if np.any(graded):
        widths = np.sqrt(wall / (wall + 2 * fillet)), np.ones(())
        usual = np.where(graded, _graded(lambda along, _: of_added(added_thickness(fillet, along)), widths), usual)
    return np.asarray(usual * fillet)


def added_thickness(fillet_radius: Quantity, along: Quantity) -> Quantity:
    """Thickness that a fillet adds at a point of its arc [m].

    Equation: a = 2 R m²/(1 + m²)
    Arguments: fillet_radius R [m] and m along the arc [-], the tangent of half the angle from where it adds nothing.
    Valid: 0 ≤ m ≤ 1.
    Source: geometry.

    >>> added_thickness(3.0, 1.0)
    3.0
    """
    square = along * along
    return 2 * fillet_radius * square / (1 + square)


def arc_radius(inner_radius: Quantity, fillet_radius: Quantity, along: Quantity, back: Quantity) -> Quantity:
    """Radius at a point of the hub fillet's arc [m].

    Equation: r = r_ci + R (1 − m)²/(1 + m²)
    Arguments: inner_radius r_ci and fillet_radius R [m]; m along the arc and 1 − m back from its steep end [-].
    Valid: 0 ≤ m ≤ 1.
    Source: geometry.

    >>> arc_radius(40.0, 3.0, 0.0, 1.0)
    43.0
    """
    return inner_radius + fillet_radius * (back * back) / (1 + along * along)


def _graded(integrand: Callable[[Array, Array], Array], widths: tuple[Array, Array]) -> Array:
    """Return the integral along an arc of radius 1 of a function of m and of 1 − m, to the widths of both its ends."""
    total = np.zeros(())
    for thin, width in zip((True, False), widths, strict=True):
        half = 0.5 / width
        reach = log(half + np.sqrt(half * half + 1))
        for node, weight in GRADED_RULE:
            growth = exp(reach * node)
            near, pace = width * (growth - 1 / growth) / 2, width * (growth + 1 / growth) / 2
            along, back = (near, 1 - near) if thin else (1 - near, near)
            square = 1 + along * along
            arc = 2 * back * (1 + along) / (square * square)
            total = total + weight * reach * pace * arc * integrand(along, back)
    return np.asarray(total)
