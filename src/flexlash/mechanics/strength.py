"""Shear stresses of wall and disk and the von Mises stress they make."""

from __future__ import annotations

import numpy as np

from flexlash.arrays import Array

__all__ = ["hub_shear", "shear_stress", "von_mises_stress"]

_STATIONS = 400


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
    Valid: thin disk; searched at 400 stations, so low by less than 1e-5 where the greatest lies in between.
    Source: equilibrium of a ring.

    >>> stress = hub_shear(torque=800.0, inner_radius=0.04, outer_radius=0.08, hub_thickness=0.0016,
    ...                    thickness=0.0016, fillet_radius=0.0)
    >>> f"{stress / 1e6:.3f}"
    '49.736'
    """
    fraction = np.linspace(0, 1, _STATIONS)[:, np.newaxis]
    width = np.atleast_1d(np.asarray(outer_radius) - inner_radius)
    fillet = np.minimum(fillet_radius, width)
    angle = fraction * np.pi / 2
    arc = (fillet * (1 - np.cos(angle)), fillet * (1 - np.sin(angle)))
    body = (fillet + (width - fillet) * fraction, np.zeros_like(fraction) * width)
    greatest = np.zeros(width.shape)
    for advance, added in (arc, body):
        linear = hub_thickness + (np.asarray(thickness) - hub_thickness) * advance / width
        greatest = np.maximum(greatest, shear_stress(torque, inner_radius + advance, linear + added).max(axis=0))
    return greatest.reshape(np.shape(torque * np.asarray(inner_radius)))


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
