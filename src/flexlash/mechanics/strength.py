"""Shear stresses of wall and disk and the von Mises stress they make."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from flexlash.arrays import Array

__all__ = ["hub_shear", "shear_stress", "von_mises_stress"]

_STATIONS = 41
_PASSES = 3


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


def hub_shear(
    *,
    torque: Array | float,
    inner_radius: Array | float,
    outer_radius: Array | float,
    hub_thickness: Array | float,
    thickness: Array | float,
    fillet_radius: Array | float,
) -> Array:
    """Greatest shear stress in the disk [Pa].

    Equation: max over r of T / (2π r² t), t linear from hub_thickness to thickness plus the hub fillet
    Arguments: torque [N·m]; inner_radius, outer_radius, hub_thickness, thickness and fillet_radius (0: none)
        [m], of shape (variants,).
    Valid: thin disk; found within 1e-6 by three passes over ever finer stations.
    Source: equilibrium of a ring.

    >>> stress = hub_shear(torque=800.0, inner_radius=0.04, outer_radius=0.08, hub_thickness=0.0016,
    ...                    thickness=0.0016, fillet_radius=0.0)
    >>> f"{stress / 1e6:.3f}"
    '49.736'
    """
    width = np.atleast_1d(np.asarray(outer_radius) - inner_radius)
    fillet = np.minimum(fillet_radius, width)

    def in_fillet(fraction: Array) -> Array:
        angle = fraction * np.pi / 2
        return at(fillet * (1 - np.cos(angle)), fillet * (1 - np.sin(angle)))

    def in_body(fraction: Array) -> Array:
        return at(fillet + (width - fillet) * fraction, 0.0)

    def at(advance: Array, added: Array | float) -> Array:
        linear = hub_thickness + (np.asarray(thickness) - hub_thickness) * advance / width
        return shear_stress(torque, inner_radius + advance, linear + added)

    greatest = np.maximum(_greatest(in_fillet, width.shape), _greatest(in_body, width.shape))
    return greatest.reshape(np.shape(torque * np.asarray(inner_radius)))


def _greatest(curve: Callable[[Array], Array], shape: tuple[int, ...]) -> Array:
    """Return the greatest value of smooth curves over [0, 1], each narrowed down between its best stations."""
    low, high = np.zeros(shape), np.ones(shape)
    stations = np.linspace(0, 1, _STATIONS).reshape(-1, *(1 for _ in shape))
    for _ in range(_PASSES):
        places = low + (high - low) * stations
        values = curve(places)
        best = np.argmax(values, axis=0)
        step = (high - low) / (_STATIONS - 1)
        centre = np.take_along_axis(places, best[np.newaxis], axis=0)[0]
        low, high = np.maximum(centre - step, 0.0), np.minimum(centre + step, 1.0)
    return np.asarray(values.max(axis=0))


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
