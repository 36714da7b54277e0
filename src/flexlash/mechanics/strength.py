"""Shear stresses of wall, rim and disk, the von Mises stress they make, and the torque at which a thin wall buckles."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.special import cosdg, sindg

from flexlash.schema.arrays import Array

__all__ = [
    "GREATEST_SLENDERNESS",
    "KNOCK_DOWN",
    "LEAST_CURVATURE",
    "PASSES",
    "STATIONS",
    "buckling_range",
    "buckling_shear",
    "disk_shear",
    "elastic_limit_torque",
    "shear_stress",
    "von_mises_stress",
    "wall_buckling_shear",
]

STATIONS = 41
PASSES = 3

KNOCK_DOWN = 0.67
"""γ^¾ of NASA SP-8007 for cylinders in torsion."""

LEAST_CURVATURE = 50.0
"""γZ above which a cylinder counts as moderately long."""

GREATEST_SLENDERNESS = 6.5
"""(l/r)/√(r/t) above which a long tube buckles in two waves around, whatever its length."""


def shear_stress(torque: Array | float, radius: Array | float, thickness: Array | float) -> Array:
    """Shear stress in a thin shell of revolution under torque [Pa].

    Equation: τ = T / (2π r² t)
    Arguments: torque T [N·m], radius r and thickness t [m], of any one shape.
    Valid: thin wall, away from notches; the peak at a sharp corner is higher.
    Source: equilibrium of a ring; B3-160 article.

    >>> f"{shear_stress(800.0, 0.08, 0.0016) / 1e6:.3f}"
    '12.434'
    """
    return np.asarray(torque / (2 * np.pi * radius * radius * thickness))


def disk_shear(
    *,
    torque: Array | float,
    inner_radius: Array | float,
    outer_radius: Array | float,
    fillet_radius: Array | float,
    thickness_at: Callable[[Array], Array | float],
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

    def at(advance: Array, added: Array | float) -> tuple[Array, Array]:
        radius = inner_radius + advance
        return shear_stress(torque, radius, thickness_at(radius) + added), radius

    shape = np.shape(torque * np.asarray(inner_radius))
    ring, body = _greatest(in_fillet, width.shape), _greatest(in_body, width.shape)
    in_ring = ring[0] > body[0]
    stress, radius = (np.where(in_ring, one, other).reshape(shape) for one, other in zip(ring, body, strict=True))
    return stress, radius


def _greatest(curve: Callable[[Array], tuple[Array, Array]], shape: tuple[int, ...]) -> tuple[Array, Array]:
    """Return the greatest stress of smooth curves over [0, 1] and its radius, narrowed down to the best stations."""
    low, high = np.zeros(shape), np.ones(shape)
    stations = np.linspace(0, 1, STATIONS).reshape(-1, *(1 for _ in shape))
    for _ in range(PASSES):
        places = low + (high - low) * stations
        stresses, radii = curve(places)
        best = np.argmax(stresses, axis=0)[np.newaxis]
        step = (high - low) / (STATIONS - 1)
        centre = np.take_along_axis(places, best, axis=0)[0]
        low, high = np.maximum(centre - step, 0.0), np.minimum(centre + step, 1.0)
    return np.take_along_axis(stresses, best, axis=0)[0], np.take_along_axis(radii, best, axis=0)[0]


def von_mises_stress(shear: Array | float) -> Array:
    """Equivalent stress of pure shear [Pa].

    Equation: σ = √3 τ
    Arguments: shear τ [Pa], of any shape.
    Valid: pure shear, ductile material.
    Source: von Mises yield criterion.

    >>> f"{von_mises_stress(49.736e6) / 1e6:.3f}"
    '86.145'
    """
    return np.asarray(np.sqrt(3) * shear)


def elastic_limit_torque(torque: Array | float, stress: Array | float, yield_strength: Array | float) -> Array:
    """Torque at which the governing section begins to yield [N·m].

    Equation: T_el = T σ_y / σ
    Arguments: torque T [N·m], its greatest von Mises stress σ [Pa], yield_strength σ_y [Pa], of any one shape.
    Valid: stress proportional to torque; without notch factors.
    Source: von Mises yield criterion.

    >>> round(float(elastic_limit_torque(800.0, 86.145e6, 1080e6)))
    10030
    """
    return np.asarray(torque * np.asarray(yield_strength) / stress)


def buckling_shear(
    youngs_modulus: Array | float, radius: Array | float, thickness: Array | float, length: Array | float
) -> Array:
    """Shear stress at which a thin cylinder under torque buckles [Pa].

    Equation: τ_cr = 0.747 γ^¾ E (r/t)^(−5/4) (l/r)^(−½), γ^¾ = 0.67
    Arguments: youngs_modulus E [Pa]; radius r, thickness t and length l [m], of any one shape.
    Valid: moderately long cylinders with simply supported ends, see `buckling_range`; for shorter ones it is low.
    Source: NASA SP-8007, torsion of isotropic cylinders, with its knock-down factor.

    >>> f"{buckling_shear(211e9, 0.08, 0.0016, 0.16) / 1e6:.1f}"
    '561.6'
    """
    slender = np.sqrt(np.asarray(radius) / thickness)
    return np.asarray(
        0.747
        * KNOCK_DOWN
        * youngs_modulus
        / (slender * slender * np.sqrt(slender))
        / np.sqrt(length / np.asarray(radius))
    )


def wall_buckling_shear(
    youngs_modulus: Array | float,
    poisson_ratio: Array | float,
    radius: Array | float,
    thickness: Array | float,
    length: Array | float,
) -> Array:
    """Shear stress at which the wall buckles under torque, for cylinders of any length [Pa].

    Equation: `buckling_shear`; where the cylinder is shorter at least the long plate's 5.35 π² E/(12 (1 − ν²)) (t/l)²;
        where it is longer 0.67 · 0.272 E (1 − ν²)^(−¾) (t/r)^(3/2), whatever the length
    Arguments: youngs_modulus E [Pa]; poisson_ratio ν [-]; radius r, thickness t and length l [m], of any one shape.
    Valid: thin cylinders; for shorter ones it is a lower bound, since curvature and edges both stiffen them.
    Source: NASA SP-8007; Timoshenko and Gere, shear of a long plate; Donnell, torsion of a long tube.

    >>> [f"{wall_buckling_shear(211e9, 0.3, 0.08, 0.0016, length) / 1e6:.1f}" for length in (0.08, 0.16, 5.0)]
    ['794.3', '561.6', '116.7']
    """
    within = buckling_range(poisson_ratio, radius, thickness, length)
    usual = buckling_shear(youngs_modulus, radius, thickness, length)
    flexible = 1 - np.asarray(poisson_ratio) * poisson_ratio
    plate = 5.35 * np.pi**2 * youngs_modulus / (12 * flexible) * np.square(np.asarray(thickness) / length)
    slender = np.asarray(thickness) / radius
    root = np.sqrt(flexible)
    tube = KNOCK_DOWN * 0.272 * youngs_modulus / (root * np.sqrt(root)) * slender * np.sqrt(slender)
    return np.asarray(np.where(within < 0, np.maximum(usual, plate), np.where(within > 0, tube, usual)))


def buckling_range(
    poisson_ratio: Array | float, radius: Array | float, thickness: Array | float, length: Array | float
) -> Array:
    """Whether the buckling formula is meant for a cylinder [-]: −1 it is shorter, 0 yes, 1 it is longer.

    Equation: γZ > 50 with Z = l² √(1 − ν²)/(r t), γ = 0.67^(4/3); and l/r < 6.5 √(r/t)
    Arguments: poisson_ratio ν [-]; radius r, thickness t and length l [m], of any one shape.
    Valid: any tube.
    Source: NASA SP-8007; the upper end is where Donnell's long tube buckles at the same stress.

    >>> int(buckling_range(0.3, 0.08, 0.0016, 0.16)), int(buckling_range(0.3, 0.08, 0.0016, 0.08))
    (0, -1)
    """
    curvature = (
        np.asarray(length)
        * length
        * np.sqrt(1 - np.asarray(poisson_ratio) * poisson_ratio)
        / (radius * np.asarray(thickness))
    )
    short = curvature * KNOCK_DOWN ** (4 / 3) <= LEAST_CURVATURE
    long = np.asarray(length) / radius >= GREATEST_SLENDERNESS * np.sqrt(np.asarray(radius) / thickness)
    return np.asarray(np.where(short, -1, np.where(long, 1, 0)))
