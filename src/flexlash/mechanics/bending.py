"""Cyclic stress by the wave generator, which no torsion shows: it bends the wall out of round twice a turn."""

from __future__ import annotations

from flexlash.mechanics.elementary import sqrt
from flexlash.schema.arrays import Quantity

__all__ = ["ENDURANCE", "alternating_stress", "bending_stress", "combined_stress"]

ENDURANCE = 0.4
"""Alternating stress over yield strength from which a steel may tire: half the tensile strength, less a ground face."""


def bending_stress(
    *,
    youngs_modulus: Quantity,
    poisson_ratio: Quantity,
    radius: Quantity,
    thickness: Quantity,
    deflection: Quantity,
) -> Quantity:
    """Amplitude of the hoop stress at both faces of a ring that is bent to two lobes [Pa].

    Equation: σ_b = 1.5 E t w₀/(r² (1 − ν²))
    Arguments: youngs_modulus E [Pa]; poisson_ratio ν [-]; radius r of the middle of the ring, its thickness t and the
        radial deflection w₀ of w = w₀ cos 2θ [m], of any one shape.
    Valid: thin ring without stretch, w₀ small beside r, free to bend around the axis but not along it; at the wave
        generator: towards the disk the deflection falls off. Without notch factors of tooth roots.
    Source: change of curvature −(w″ + w)/r² = 3 w₀ cos 2θ/r² of a ring, at t/2 from its middle.

    >>> steel = {"youngs_modulus": 206e9, "poisson_ratio": 0.3}
    >>> f"{bending_stress(radius=0.025, thickness=0.55e-3, deflection=0.25e-3, **steel) / 1e6:.2f}"
    '74.70'
    """
    stiff = youngs_modulus / (1 - poisson_ratio * poisson_ratio)
    return 1.5 * stiff * thickness * deflection / (radius * radius)


def alternating_stress(bending: Quantity, poisson_ratio: Quantity) -> Quantity:
    """Equivalent amplitude of the stress that the wave generator reverses twice a turn [Pa].

    Equation: σ_a = σ_b √(1 − ν + ν²)
    Arguments: bending σ_b [Pa] as of `bending_stress`; poisson_ratio ν [-], of any one shape.
    Valid: σ_b around the axis and ν σ_b along it, since the wall cannot bend along it; both reverse together.
    Source: von Mises yield criterion.

    >>> float(alternating_stress(100.0, 0.0)), round(float(alternating_stress(100.0, 0.3)), 4)
    (100.0, 88.8819)
    """
    return bending * sqrt(1 - poisson_ratio + poisson_ratio * poisson_ratio)


def combined_stress(alternating: Quantity, torsional: Quantity) -> Quantity:
    """Greatest equivalent stress of a turn under torque [Pa].

    Equation: σ = √(σ_a² + σ_m²)
    Arguments: alternating σ_a [Pa] as of `alternating_stress`; torsional σ_m = √3 τ [Pa], which stands as long as the
        torque does and is the mean of the cycle, of any one shape.
    Valid: both at the same place of the wall; ductile material.
    Source: von Mises yield criterion: σ² + ν² σ² − ν σ² + 3 τ².

    >>> float(combined_stress(30.0, 40.0))
    50.0
    """
    return sqrt(alternating * alternating + torsional * torsional)
