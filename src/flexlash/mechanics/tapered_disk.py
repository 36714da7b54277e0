"""Integral of a disk that thins in a straight line: a closed form and, where that cancels, ten points.

Over v = 1/r the thickness t = a + b r makes t v = a v + b a straight line. Each function is one line of the working.
"""

from __future__ import annotations

import numpy as np

from flexlash.mechanics.elementary import absolute, log, where
from flexlash.schema.arrays import Condition, Quantity

__all__ = [
    "TAPER_NODES",
    "TAPER_WEIGHTS",
    "axis_thickness",
    "closed_integral",
    "is_nearly_proportional",
    "relative_slope",
    "summand",
    "tapered_disk_integral",
]

_NEARLY = 0.5
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(10)
TAPER_NODES, TAPER_WEIGHTS = (_NODES + 1) / 2, _WEIGHTS / 2
"""Nodes and weights of the Gauss–Legendre rule from 0 to 1."""


def is_nearly_proportional(outer_product: Quantity, inner_product: Quantity) -> Condition:
    """Whether the thickness is so nearly proportional to the radius that the closed form would cancel [-].

    Equation: |t_i v_i − t_o v_o| < t_o v_o / 2
    Arguments: outer_product t_o v_o and inner_product t_i v_i [-], of any one shape.
    Valid: any taper.
    Source: trial; either way keeps 14 digits there.

    >>> bool(is_nearly_proportional(0.02, 0.025)), bool(is_nearly_proportional(0.02, 0.1))
    (True, False)
    """
    return absolute(inner_product - outer_product) < _NEARLY * outer_product


def axis_thickness(outer_product: Quantity, inner_product: Quantity, reach: Quantity) -> Quantity:
    """Thickness that the straight line would have on the axis [m]; 1 where it is not used.

    Equation: a = (t_i v_i − t_o v_o) / (v_i − v_o)
    Arguments: outer_product t_o v_o and inner_product t_i v_i [-], reach v_i − v_o [1/m], of any one shape.
    Valid: thickness not nearly proportional to the radius.
    Source: geometry.

    >>> float(axis_thickness(1.0, 3.0, 4.0))
    0.5
    """
    growth = inner_product - outer_product
    divisor = where(absolute(reach) > 0, reach, 1.0)
    return where(is_nearly_proportional(outer_product, inner_product), 1.0, growth / divisor)


def relative_slope(inner_radius: Quantity, inner_thickness: Quantity, on_axis: Quantity) -> Quantity:
    """Slope of the thickness over that on the axis [1/m].

    Equation: b/a = (t_i − a) / (r_i a)
    Arguments: inner_radius r_i, inner_thickness t_i and thickness on_axis a [m], of any one shape.
    Valid: thickness not nearly proportional to the radius.
    Source: geometry.

    >>> relative_slope(2.0, 3.0, 1.0)
    1.0
    """
    return (inner_thickness - on_axis) / (inner_radius * on_axis)


def closed_integral(  # noqa: PLR0917
    outer_curvature: Quantity,
    inner_curvature: Quantity,
    outer_product: Quantity,
    inner_product: Quantity,
    on_axis: Quantity,
    slope: Quantity,
) -> Quantity:
    """Integral in closed form [1/m³].

    Equation: I = ((v_i − v_o) ((v_i + v_o)/2 − b/a) + (b/a)² ln(t_i v_i / t_o v_o)) / a
    Arguments: outer_curvature v_o and inner_curvature v_i [1/m], outer_product t_o v_o and inner_product t_i v_i [-],
        thickness on_axis a [m] and slope b/a [1/m], of any one shape.
    Valid: thickness not nearly proportional to the radius.
    Source: ∫ v dv/t in closed form.

    >>> f"{closed_integral(1.0, 2.0, 2.0, 3.0, 1.0, 1.0) - np.log(1.5):.12f}"
    '0.500000000000'
    """
    reach = inner_curvature - outer_curvature
    logarithm = log(inner_product / outer_product)
    return (reach * ((inner_curvature + outer_curvature) / 2 - slope) + slope * slope * logarithm) / on_axis


def summand(weight: float, curvature: Quantity, product: Quantity) -> Quantity:
    """One point of ∫ v² dv/(t v) over a reach of 1 [1/m²].

    Equation: w v²/(t v)
    Arguments: weight w [-], curvature v [1/m] and product t v [-] at the point, of any one shape.
    Valid: any taper.
    Source: Gauss–Legendre quadrature.

    >>> summand(0.5, 2.0, 4.0)
    0.5
    """
    return weight * (curvature * curvature) / product


def tapered_disk_integral(
    inner_radius: Quantity,
    outer_radius: Quantity,
    inner_thickness: Quantity,
    outer_thickness: Quantity,
) -> Quantity:
    """Integral of a disk that thins in a straight line [1/m³].

    Equation: I = ∫ v dv/t from v_o to v_i, v = 1/r, t = a + b r: `closed_integral`
    Arguments: inner_radius, outer_radius, inner_thickness, outer_thickness [m], of any one shape.
    Valid: thin disk; error below 1e-14. Where t is nearly proportional to r, so that a vanishes and the closed form
        cancels, ten Gauss–Legendre points of ∫ v² dv/(t v) take its place.
    Source: the meridian integral in closed form.

    >>> f"{tapered_disk_integral(0.04, 0.08, 0.004, 0.0016):.10e}"
    '7.7033906879e+04'
    """
    outer, inner = 1 / outer_radius, 1 / inner_radius
    reach = inner - outer
    start, end = outer * outer_thickness, inner * inner_thickness
    on_axis = axis_thickness(start, end, reach)
    closed = closed_integral(outer, inner, start, end, on_axis, relative_slope(inner_radius, inner_thickness, on_axis))
    growth = end - start
    total: Quantity = 0.0
    for node, weight in zip(TAPER_NODES, TAPER_WEIGHTS, strict=True):
        total = total + summand(weight, outer + reach * node, start + growth * node)
    return where(is_nearly_proportional(start, end), total * reach, closed)
