"""All variants at their entered dimensions, in groups of the same shape so that each group is one call."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from functools import partial
from typing import TypeAlias

import numpy as np

from flexlash.mechanics import flexspline, strength, windup
from flexlash.mechanics.nominal_record import NominalNumbers
from flexlash.mechanics.stiffness import (
    catalogue_stiffness,
    drive_lost_motion,
    lost_motion,
    natural_frequency,
    resonance_speed,
    torsional_stiffness,
)
from flexlash.schema.arrays import Array, Quantity
from flexlash.schema.variant import Variant

__all__ = ["nominal_numbers"]

_Numbers: TypeAlias = dict[str, float | str | None]
"""Numbers [SI] and words of one variant by result key without unit."""


def nominal_numbers(variants: Sequence[Variant], lost_motion_share: float) -> list[NominalNumbers]:
    """Nominal results of each variant [SI].

    Equation: as in `flexspline.windups`, `strength`, `stiffness`; lost motion of the flexspline 2 p T_rated / K
    Arguments: variants, and lost_motion_share p [-] of the rated torque at which lost motion is stated.
    Valid: as for the functions it calls; absurd dimensions give infinite numbers or NaN, without a warning.
    Source: as for the functions it calls.

    >>> b3_160 = {"torque": 800.0, "cylinder_length": 0.16, "mean_radius": 0.08, "wall_thickness": 0.0016,
    ...           "disk_inner_radius": 0.04, "youngs_modulus": 211e9, "poisson_ratio": 0.3}
    >>> variant = Variant(row=5, name="B3-160", flexspline_type="cup", material="20Cr2Ni4",
    ...                   tolerance_class="standard", dimensions=b3_160)
    >>> f"{nominal_numbers([variant], 0.04)[0].stiffness:.7g}"
    '1491835'
    """
    groups: dict[tuple[str, frozenset[str]], list[int]] = defaultdict(list)
    for index, variant in enumerate(variants):
        groups[variant.flexspline_type, frozenset(variant.dimensions)].append(index)
    numbers: dict[int, NominalNumbers] = {}
    for (flexspline_type, _), indices in groups.items():
        first = variants[indices[0]]
        dimensions = {
            name: np.array([variants[index].dimensions[name] for index in indices]) for name in first.dimensions
        }
        with np.errstate(all="ignore"):
            columns = _windups(flexspline_type, dimensions) | _stresses(flexspline_type, dimensions)
            rows = zip(*(np.asarray(column).tolist() for column in columns.values()), strict=True)
            for index, row in zip(indices, rows, strict=True):
                known: _Numbers = dict(zip(columns, row, strict=True))
                known |= _beside(variants[index], known, lost_motion_share)
                numbers[index] = NominalNumbers(**known)  # type: ignore[arg-type]
    return [numbers[index] for index in range(len(variants))]


def _windups(flexspline_type: str, dimensions: dict[str, Array]) -> dict[str, Quantity]:
    """Return wind-ups and what follows from them for variants of one shape, each of shape (variants,)."""
    segments = flexspline.windups(flexspline_type, dimensions)
    torque, radius = dimensions["torque"], flexspline.radius_of(dimensions)
    nothing = np.zeros(len(torque))
    cylinder = sum((segments[name] for name in flexspline.CYLINDER_SEGMENTS if name in segments), nothing)
    disk = sum((segments[name] for name in flexspline.DISK_SEGMENTS if name in segments), nothing)
    total = cylinder + disk
    plain_wall = windup.wall_integral(dimensions["cylinder_length"], radius, dimensions["wall_thickness"])
    modulus = flexspline.modulus_of(dimensions)
    cylinder_only = 2 * windup.segment_windup(torque, modulus, plain_wall)
    two_term = cylinder_only
    if flexspline_type != "cylinder":
        inner, outer = flexspline.disk_radii(dimensions)
        even_disk = windup.annulus_integral(inner, outer, flexspline.disk_thickness(dimensions, outer))
        two_term = cylinder_only + 2 * windup.segment_windup(torque, modulus, even_disk)
    return {
        "cylinder_windup": cylinder,
        "disk_windup": disk,
        "windup": total,
        "backlash": flexspline.backlash(flexspline_type, dimensions),
        "disk_share": disk / total,
        "cylinder_only_backlash": cylinder_only,
        "two_term_backlash": two_term,
        "stiffness": torsional_stiffness(torque, total),
        "mean_radius": radius,
        "wall_ratio": dimensions["wall_thickness"] / radius,
        **{f"{name}_windup": angle for name, angle in segments.items()},
    }


def _stresses(flexspline_type: str, dimensions: dict[str, Array]) -> dict[str, Quantity]:
    """Return the greatest shear and von Mises stress of each section for variants of one shape."""
    torque, radius, wall = dimensions["torque"], flexspline.radius_of(dimensions), dimensions["wall_thickness"]
    shear = {"wall": strength.shear_stress(torque, radius, wall)}
    numbers: dict[str, Quantity] = {}
    if "rim_length" in dimensions:
        rim = dimensions["rim_thickness"]
        shear["rim"] = strength.shear_stress(torque, windup.rim_radius(radius, wall, rim), rim)
    if flexspline_type != "cylinder":
        inner, outer = flexspline.disk_radii(dimensions)
        shear["hub"], numbers["hub_shear_radius"] = strength.disk_shear(
            torque=torque,
            inner_radius=inner,
            outer_radius=outer,
            fillet_radius=dimensions.get("hub_fillet_radius", np.zeros(len(torque))),
            thickness_at=partial(flexspline.disk_thickness, dimensions),
        )
    stress = {section: strength.von_mises_stress(values) for section, values in shear.items()}
    numbers |= {f"{section}_shear": values for section, values in shear.items()}
    numbers |= {f"{section}_von_mises": values for section, values in stress.items()}
    return numbers | {"von_mises": np.max(np.array(list(stress.values())), axis=0)}


_SECTIONS = {"wall": "wall", "rim": "tooth rim", "hub": "disk"}
_TUBE = ("wall_thickness", "cylinder_length")
_RANGES = {-1: "shorter", 0: "yes", 1: "longer"}


def _beside(variant: Variant, numbers: _Numbers, lost_motion_share: float) -> _Numbers:
    """Return what asks for more than dimensions and torque: material strength, rated torque, inertia, catalogue."""
    beside: _Numbers = {}
    stiffness, torque = _of(numbers, "stiffness"), variant.dimensions["torque"]
    stress = {section: numbers.get(f"{section}_von_mises") or 0.0 for section in _SECTIONS}
    beside["governing_section"] = _SECTIONS[max(stress, key=lambda section: stress[section])]
    if variant.yield_strength is not None:
        limit = strength.limit_torque(torque, np.float64(_of(numbers, "von_mises")), variant.yield_strength)
        beside["elastic_limit_torque"] = float(limit)
    radius = _of(numbers, "mean_radius")
    if variant.youngs_modulus is not None and variant.poisson_ratio is not None:
        young, poisson = variant.youngs_modulus, np.float64(variant.poisson_ratio)
        # As numbers of NumPy, which divide by nothing without raising.
        tube = [np.float64(size) for size in (radius, *(variant.dimensions[name] for name in _TUBE))]
        buckling = strength.wall_buckling_shear(young, poisson, *tube)
        torque_there = strength.limit_torque(torque, np.float64(_of(numbers, "wall_shear")), buckling)
        beside |= {"buckling_shear": float(buckling), "buckling_torque": float(torque_there)}
        beside["buckling_range"] = _RANGES[int(strength.buckling_range(poisson, *tube))]
    if variant.rated_torque is not None:
        lost_at = lost_motion_share * variant.rated_torque
        beside["lost_motion"] = float(lost_motion(np.float64(stiffness), lost_at))
        beside["drive_lost_motion"] = drive_lost_motion(radius, lost_at)
    listed = catalogue_stiffness(radius)
    if listed and variant.flexspline_type != "cylinder":
        beside |= {"catalogue_size": float(listed.size), "catalogue_stiffness": listed.stiffness}
        beside["least_stiffness"] = listed.at_radius(radius)
    if variant.load_inertia is not None:
        frequency = natural_frequency(stiffness, variant.load_inertia)
        beside |= {"natural_frequency": frequency, "resonance_speed": resonance_speed(frequency)}
        of_drive = min(stiffness, listed.at_radius(radius)) if listed else stiffness
        beside["resonance_speed_low"] = resonance_speed(natural_frequency(of_drive, variant.load_inertia))
    return beside


def _of(numbers: _Numbers, key: str) -> float:
    """Return a number that every variant has."""
    value = numbers[key]
    if not isinstance(value, float):
        raise TypeError(key)
    return value
