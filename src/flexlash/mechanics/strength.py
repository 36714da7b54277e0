"""Shear stresses of wall, rim and disk, the von Mises stress they make, and the torque at which a thin wall buckles."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from scipy.special import cosdg, sindg

from flexlash.mechanics.elementary import maximum, sqrt, where
from flexlash.schema.arrays import Array, Quantity

__all__ = [
    "GREATEST_SLENDERNESS",
    "KNOCK_DOWN",
    "LEAST_CURVATURE",
    "PASSES",
    "STATIONS",
    "buckling_range",
    "buckling_shear",
    "by_buckling_range",
    "curvature_parameter",
    "disk_shear",
    "limit_torque",
    "plate_buckling_shear",
    "shear_stress",
    "slenderness",
    "tube_buckling_shear",
    "von_mises_stress",
    "wall_buckling_shear",
]

STATIONS = 41
PASSES = 3

KNOCK_DOWN = 0.67
"""γ^¾ of NASA SP-8007 for cylinders in torsion."""

_CURVATURE_KNOCK_DOWN: float = KNOCK_DOWN ** (4 / 3)
"""γ."""

LEAST_CURVATURE = 50.0
"""γZ above which a cylinder counts as moderately long."""

GREATEST_SLENDERNESS = 6.5
"""(l/r)/√(r/t) above which a long tube buckles in two waves around, whatever its length."""


def shear_stress(torque: Quantity, radius: Quantity, thickness: Quantity) -> Quantity:
    """Shear stress in a thin shell of revolution under torque [Pa].

    Equation: τ = T / (2π r² t)
    Arguments: torque T [N·m], radius r and thickness t [m], of any one shape.
    Valid: thin wall, away from notches; the peak at a sharp corner is higher.
    Source: equilibrium of a ring; B3-160 article.

    >>> f"{shear_stress(800.0, 0.08, 0.0016) / 1e6:.3f}"
    '12.434'
    """
    return torque / (2 * np.pi * radius * radius * thickness)


def disk_shear(
    *,
    torque: Quantity,
    inner_radius: Quantity,
    outer_radius: Quantity,
    fillet_radius: Quantity,
    thickness_at: Callable[[Array], Quantity],
) -> tuple[Array, Array]:
    """Greatest shear stress in the disk [Pa] and the radius where it acts [m].

    Equation: max over r of T / (2π r² t), t the disk's own thickness plus the hub fillet
    Arguments: torque [N·m]; inner_radius, outer_radius and fillet_radius (0: none) [m], of shape (variants,);
        thickness_at gives the disk's own thickness [m] at radii of shape (stations, variants).
    Valid: thin disk; the stress is found within 1e-6 by three passes over ever finer stations.
    Source: equilibrium of a ring.

    >>> stress, radius = disk_shear(torque=800.0, inner_radius=0.04, outer_radius=0.08, fillet_radius=0.0,
    ...                             thickness_at=lambda _: 0.0016)
    >>> f"{stress / 1e6:.3f} at {radius:.3f}"
    '49.736 at 0.040'
    """
    width = np.atleast_1d(np.asarray(outer_radius) - inner_radius)
    fillet = np.minimum(fillet_radius, width)

    def in_fillet(fraction: Array) -> tuple[Array, Array]:
        # Sine and cosine of SciPy, since NumPy's may round otherwise at another place of an array.
        return at(fillet * (1 - cosdg(90 * fraction)), fillet * (1 - sindg(90 * fraction)))

    def in_body(fraction: Array) -> tuple[Array, Array]:
        return at(fillet + (width - fillet) * fraction, 0.0)

    def at(advance: Array, added: Quantity) -> tuple[Array, Array]:
        radius = inner_radius + advance
        return np.asarray(shear_stress(torque, radius, thickness_at(radius) + added)), radius

    shape = np.shape(torque * np.asarray(inner_radius))
    ring, body = _greatest(in_fillet, width.shape), _greatest(in_body, width.shape)
    in_ring = ring[0] > body[0]
    stress, radius = (np.where(in_ring, *pair).reshape(shape) for pair in zip(ring, body, strict=True))
    return stress, radius


def _greatest(curve: Callable[[Array], tuple[Array, Array]], shape: tuple[int, ...]) -> tuple[Array, Array]:
    """Return the greatest stress of smooth curves over [0, 1] and its radius, narrowed down to the best stations."""
    low, high = np.zeros(shape), np.ones(shape)
    stations = np.linspace(0, 1, STATIONS).reshape(-1, *(1 for _ in shape))
    for _ in range(PASSES):
        fractions = low + (high - low) * stations
        stresses, radii = curve(fractions)
        best = np.argmax(stresses, axis=0)[np.newaxis]
        step = (high - low) / (STATIONS - 1)
        centre = np.take_along_axis(fractions, best, axis=0)[0]
        low, high = np.maximum(centre - step, 0.0), np.minimum(centre + step, 1.0)
    return np.take_along_axis(stresses, best, axis=0)[0], np.take_along_axis(radii, best, axis=0)[0]


def von_mises_stress(shear: Quantity) -> Quantity:
    """Equivalent stress of pure shear [Pa].

    Equation: σ = √3 τ
    Arguments: shear τ [Pa], of any shape.
    Valid: pure shear, ductile material.
    Source: von Mises yield criterion.

    >>> f"{von_mises_stress(49.736e6) / 1e6:.3f}"
    '86.145'
    """
    return math.sqrt(3.0) * shear


def limit_torque(torque: Quantity, stress: Quantity, limit: Quantity) -> Quantity:
    """Torque at which a stress reaches its limit: the wall buckles, or the governing section begins to yield [N·m].

    Equation: T_lim = T σ_lim / σ
    Arguments: torque T [N·m], the stress σ at it [Pa], and the limit σ_lim of that stress [Pa], of any one shape.
    Valid: stress proportional to torque; without notch factors.
    Source: linear elasticity.

    >>> round(limit_torque(800.0, 86.145e6, 1080e6))
    10030
    """
    return torque * limit / stress


def curvature_parameter(poisson_ratio: Quantity, radius: Quantity, thickness: Quantity, length: Quantity) -> Quantity:
    """Curvature of a cylinder, by which short ones buckle like plates [-].

    Equation: γZ, Z = l² √(1 − ν²)/(r t), γ = 0.67^(4/3)
    Arguments: poisson_ratio ν [-]; radius r, thickness t and length l [m], of any one shape.
    Valid: any tube.
    Source: NASA SP-8007.

    >>> f"{curvature_parameter(0.3, 0.08, 0.0016, 0.16):.1f}"
    '111.9'
    """
    flexible = sqrt(1 - poisson_ratio * poisson_ratio)
    return length * length * flexible / (radius * thickness) * _CURVATURE_KNOCK_DOWN


def slenderness(radius: Quantity, thickness: Quantity, length: Quantity) -> Quantity:
    """Slenderness of a cylinder, from which long ones buckle whatever their length [-].

    Equation: (l/r) / √(r/t)
    Arguments: radius r, thickness t and length l [m], of any one shape.
    Valid: any tube.
    Source: NASA SP-8007.

    >>> f"{slenderness(0.08, 0.0016, 0.16):.4f}"
    '0.2828'
    """
    return length / radius / sqrt(radius / thickness)


def by_buckling_range(
    curvature: Quantity, slender: Quantity, *, shorter: Quantity, usual: Quantity, longer: Quantity
) -> Quantity:
    """Whichever is meant for a cylinder as short, usual or long as this, such as a formula's stress [-].

    Equation: shorter up to γZ = 50; else longer from (l/r)/√(r/t) = 6.5; else usual
    Arguments: curvature γZ and slenderness (l/r)/√(r/t) [-]; what is meant for each range, of any one shape.
    Valid: any tube.
    Source: NASA SP-8007; the upper end is where Donnell's long tube buckles at the same stress.

    >>> float(by_buckling_range(111.9, 0.2828, shorter=1.0, usual=2.0, longer=3.0))
    2.0
    """
    beyond = where(slender >= GREATEST_SLENDERNESS, longer, usual)
    return where(curvature <= LEAST_CURVATURE, shorter, beyond)


def buckling_range(poisson_ratio: Quantity, radius: Quantity, thickness: Quantity, length: Quantity) -> Quantity:
    """Whether the buckling formula is meant for a cylinder [-]: −1 it is shorter, 0 yes, 1 it is longer.

    Equation: as of `by_buckling_range`
    Arguments: poisson_ratio ν [-]; radius r, thickness t and length l [m], of any one shape.
    Valid: any tube.
    Source: NASA SP-8007.

    >>> int(buckling_range(0.3, 0.08, 0.0016, 0.16)), int(buckling_range(0.3, 0.08, 0.0016, 0.08))
    (0, -1)
    """
    curvature = curvature_parameter(poisson_ratio, radius, thickness, length)
    return by_buckling_range(curvature, slenderness(radius, thickness, length), shorter=-1, usual=0, longer=1)


def buckling_shear(youngs_modulus: Quantity, radius: Quantity, thickness: Quantity, length: Quantity) -> Quantity:
    """Shear stress at which a thin cylinder under torque buckles [Pa].

    Equation: τ_cr = 0.747 γ^¾ E (r/t)^(−5/4) (l/r)^(−½), γ^¾ = 0.67
    Arguments: youngs_modulus E [Pa]; radius r, thickness t and length l [m], of any one shape.
    Valid: moderately long cylinders with simply supported ends, see `buckling_range`; for shorter ones it is low.
    Source: NASA SP-8007, torsion of isotropic cylinders, with its knock-down factor.

    >>> f"{buckling_shear(211e9, 0.08, 0.0016, 0.16) / 1e6:.1f}"
    '561.6'
    """
    slender = sqrt(radius / thickness)
    return 0.747 * KNOCK_DOWN * youngs_modulus / (slender * slender * sqrt(slender)) / sqrt(length / radius)


def plate_buckling_shear(
    youngs_modulus: Quantity, poisson_ratio: Quantity, thickness: Quantity, length: Quantity
) -> Quantity:
    """Shear stress at which a long plate buckles, as a very short cylinder does at least [Pa].

    Equation: τ_cr = 5.35 π² E/(12 (1 − ν²)) (t/l)²
    Arguments: youngs_modulus E [Pa]; poisson_ratio ν [-]; thickness t and length l [m], of any one shape.
    Valid: a lower bound for cylinders, since curvature and edges both stiffen them.
    Source: Timoshenko and Gere, shear of a long plate.

    >>> f"{plate_buckling_shear(211e9, 0.3, 0.0016, 0.03) / 1e6:.1f}"
    '2902.1'
    """
    share = thickness / length
    return 5.35 * np.pi**2 * youngs_modulus / (12 * (1 - poisson_ratio * poisson_ratio)) * (share * share)


def tube_buckling_shear(
    youngs_modulus: Quantity, poisson_ratio: Quantity, radius: Quantity, thickness: Quantity
) -> Quantity:
    """Shear stress at which a long tube buckles in two waves around, whatever its length [Pa].

    Equation: τ_cr = 0.67 · 0.272 E (1 − ν²)^(−¾) (t/r)^(3/2)
    Arguments: youngs_modulus E [Pa]; poisson_ratio ν [-]; radius r and thickness t [m], of any one shape.
    Valid: long thin tubes.
    Source: Donnell, torsion of a long tube, with the knock-down factor of NASA SP-8007.

    >>> f"{tube_buckling_shear(211e9, 0.3, 0.08, 0.0016) / 1e6:.1f}"
    '116.7'
    """
    slender, flexible = thickness / radius, sqrt(1 - poisson_ratio * poisson_ratio)
    return KNOCK_DOWN * 0.272 * youngs_modulus / (flexible * sqrt(flexible)) * slender * sqrt(slender)


def wall_buckling_shear(
    youngs_modulus: Quantity,
    poisson_ratio: Quantity,
    radius: Quantity,
    thickness: Quantity,
    length: Quantity,
) -> Quantity:
    """Shear stress at which the wall buckles under torque, for cylinders of any length [Pa].

    Equation: `buckling_shear`; where the cylinder is shorter at least `plate_buckling_shear`; where it is longer
        `tube_buckling_shear`
    Arguments: youngs_modulus E [Pa]; poisson_ratio ν [-]; radius r, thickness t and length l [m], of any one shape.
    Valid: thin cylinders; for shorter ones it is a lower bound.
    Source: NASA SP-8007; the range as of `by_buckling_range`.

    >>> [f"{wall_buckling_shear(211e9, 0.3, 0.08, 0.0016, length) / 1e6:.1f}" for length in (0.08, 0.16, 5.0)]
    ['794.3', '561.6', '116.7']
    """
    usual = buckling_shear(youngs_modulus, radius, thickness, length)
    return by_buckling_range(
        curvature_parameter(poisson_ratio, radius, thickness, length),
        slenderness(radius, thickness, length),
        shorter=maximum(usual, plate_buckling_shear(youngs_modulus, poisson_ratio, thickness, length)),
        usual=usual,
        longer=tube_buckling_shear(youngs_modulus, poisson_ratio, radius, thickness),
    )
