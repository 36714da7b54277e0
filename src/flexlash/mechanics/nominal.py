"""All variants at their entered dimensions, in groups of the same shape so that each group is one call."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from flexlash.arrays import Array
from flexlash.mechanics import flexspline, strength, windup
from flexlash.variant import Variant

__all__ = ["nominal_numbers"]


def nominal_numbers(variants: Sequence[Variant], lost_motion_share: float) -> list[dict[str, float | None]]:
    """Nominal results of each variant [SI] by result key without unit.

    Equation: as in `flexspline.windups`, `windup.wall_integral`, `strength`; lost motion 2 p T_rated / K
    Arguments: variants, and lost_motion_share p [-] of the rated torque at which lost motion is stated.
    Valid: as for the functions it calls; absurd dimensions give infinite numbers or NaN, without a warning.
    Source: as for the functions it calls.

    >>> b3_160 = {"torque": 800.0, "cylinder_length": 0.16, "mean_radius": 0.08, "wall_thickness": 0.0016,
    ...           "disk_inner_radius": 0.04, "youngs_modulus": 211e9, "poisson_ratio": 0.3}
    >>> variant = Variant(row=5, name="B3-160", flexspline_type="cup", material="20Cr2Ni4",
    ...                   tolerance_class="standard", dimensions=b3_160)
    >>> f"{nominal_numbers([variant], 0.04)[0]['stiffness']:.7g}"
    '1491835'
    """
    groups: dict[tuple[str, frozenset[str]], list[int]] = defaultdict(list)
    for place, variant in enumerate(variants):
        groups[variant.flexspline_type, frozenset(variant.dimensions)].append(place)
    numbers: list[dict[str, float | None]] = [{} for _ in variants]
    for (flexspline_type, _), places in groups.items():
        first = variants[places[0]]
        dimensions = {
            name: np.array([variants[place].dimensions[name] for place in places]) for name in first.dimensions
        }
        with np.errstate(all="ignore"):
            columns = _group(flexspline_type, dimensions)
        for offset, place in enumerate(places):
            numbers[place] = {key: float(values[offset]) for key, values in columns.items()}
            rated = variants[place].rated_torque
            if rated is not None:
                stiffness = columns["stiffness"][offset]
                numbers[place]["lost_motion"] = float(2 * lost_motion_share * rated / stiffness)
    return numbers


def _group(flexspline_type: str, dimensions: dict[str, Array]) -> dict[str, Array]:
    """Return the nominal results of variants of one shape, each of shape (variants,)."""
    segments = flexspline.windups(flexspline_type, dimensions)
    torque, radius = dimensions["torque"], flexspline.radius_of(dimensions)
    nothing = np.zeros(len(torque))
    cylinder = sum((segments[name] for name in flexspline.CYLINDER_SEGMENTS if name in segments), nothing)
    disk = sum((segments[name] for name in flexspline.DISK_SEGMENTS if name in segments), nothing)
    total = cylinder + disk
    plain_wall = windup.wall_integral(dimensions["cylinder_length"], radius, dimensions["wall_thickness"])
    modulus = flexspline.modulus_of(dimensions)
    wall_shear = strength.shear_stress(torque, radius, dimensions["wall_thickness"])
    columns = {
        "cylinder_windup": cylinder,
        "disk_windup": disk,
        "windup": total,
        "backlash": flexspline.backlash(flexspline_type, dimensions),
        "disk_share": disk / total,
        "cylinder_only_backlash": 2 * windup.segment_windup(torque, modulus, plain_wall),
        "stiffness": torque / total,
        "wall_shear": wall_shear,
        **{f"{name}_windup": angle for name, angle in segments.items()},
    }
    greatest = wall_shear
    if flexspline_type != "cylinder":
        columns["hub_shear"] = _hub_shear(dimensions, radius)
        greatest = np.maximum(wall_shear, columns["hub_shear"])
    return columns | {"von_mises": strength.von_mises_stress(greatest)}


def _hub_shear(dimensions: dict[str, Array], radius: Array) -> Array:
    """Greatest shear stress in the disk [Pa], of shape (variants,)."""
    thickness = dimensions.get("disk_thickness", dimensions["wall_thickness"])
    return strength.hub_shear(
        torque=dimensions["torque"],
        inner_radius=dimensions.get("disk_inner_radius", radius),
        outer_radius=dimensions.get("disk_outer_radius", radius),
        hub_thickness=dimensions.get("disk_hub_thickness", thickness),
        thickness=thickness,
        fillet_radius=dimensions.get("hub_fillet_radius", np.zeros(len(radius))),
    )
