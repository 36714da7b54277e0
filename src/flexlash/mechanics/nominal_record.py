"""The nominal numbers of one variant as a record, apart from the code that makes them."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["WORDS", "NominalNumbers"]

WORDS = {"governing_section": ("wall", "tooth rim", "disk"), "buckling_range": ("shorter", "yes", "longer")}
"""The fields that are words, with what they can be."""


@dataclass(frozen=True, kw_only=True)
class NominalNumbers:
    """What follows from the entered dimensions of a variant; None for what it does not have.

    Wind-ups and backlash [rad], the former also by segment; stiffness [N·m/rad]; stresses [Pa] by section: wall, tooth
    rim, hub of the disk; torques [N·m]; natural frequency [Hz]; resonance speed [rad/s], the lower one that of the
    whole drive; catalogue size [-]. The elastic limit needs a yield strength, buckling E and ν, lost motion a rated
    torque, resonance a load inertia, the catalogue a listed size, bending E, ν and a radial deflection.
    """

    backlash: float
    windup: float
    cylinder_windup: float
    disk_windup: float
    tooth_band_windup: float | None = None
    rim_windup: float | None = None
    wall_windup: float | None = None
    junction_fillet_windup: float | None = None
    disk_body_windup: float | None = None
    hub_fillet_windup: float | None = None
    disk_share: float
    cylinder_only_backlash: float
    two_term_backlash: float
    stiffness: float
    mean_radius: float
    wall_ratio: float
    wall_shear: float
    rim_shear: float | None = None
    hub_shear: float | None = None
    hub_shear_radius: float | None = None
    wall_von_mises: float
    rim_von_mises: float | None = None
    hub_von_mises: float | None = None
    von_mises: float
    governing_section: str
    elastic_limit_torque: float | None = None
    buckling_shear: float | None = None
    buckling_torque: float | None = None
    buckling_range: str | None = None
    lost_motion: float | None = None
    drive_lost_motion: float | None = None
    catalogue_size: float | None = None
    catalogue_stiffness: float | None = None
    least_stiffness: float | None = None
    natural_frequency: float | None = None
    resonance_speed: float | None = None
    resonance_speed_low: float | None = None
    bending_stress: float | None = None
    rim_bending_stress: float | None = None
    alternating_stress: float | None = None
    combined_stress: float | None = None
