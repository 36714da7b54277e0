"""All variants at their entered dimensions, in groups of the same shape so that each group is one call."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial
from typing import Any, TypeAlias

import numpy as np
import polars as pl

from flexlash.mechanics import bending, flexspline, strength, windup
from flexlash.mechanics.nominal_record import WORDS, NominalNumbers
from flexlash.mechanics.stiffness import (
    catalogue_stiffness,
    drive_lost_motion,
    lost_motion,
    natural_frequency,
    resonance_speed,
    torsional_stiffness,
)
from flexlash.schema.arrays import Array, Quantity
from flexlash.schema.variant_arrays import VariantArrays

__all__ = ["nominal_numbers"]

_Columns: TypeAlias = dict[str, Any]
"""Numbers [SI] of variants of one shape by result key without unit, masked where one has none; words by their place."""


def nominal_numbers(variants: VariantArrays, lost_motion_share: float) -> pl.DataFrame:
    """Nominal results of each variant [SI]: the fields of `NominalNumbers` as columns, null where one has none.

    Equation: as in `flexspline.windups`, `strength`, `stiffness`; lost motion of the flexspline 2 p T_rated / K
    Arguments: variants, and lost_motion_share p [-] of the rated torque at which lost motion is stated.
    Valid: as for the functions it calls; absurd dimensions give infinite numbers or NaN, without a warning.
    Source: as for the functions it calls.

    >>> b3_160 = {"torque": 800.0, "cylinder_length": 0.16, "mean_radius": 0.08, "wall_thickness": 0.0016,
    ...           "disk_inner_radius": 0.04, "youngs_modulus": 211e9, "poisson_ratio": 0.3}
    >>> sizes = {name: np.array([size]) for name, size in b3_160.items()}
    >>> variant = VariantArrays(flexspline_types=["cup"], dimensions=sizes, numbers={})
    >>> f"{nominal_numbers(variant, 0.04)['stiffness'][0]:.7g}"
    '1491835'
    """
    count = len(variants.flexspline_types)
    columns = {name: np.ma.array(np.full(count, np.nan), mask=True) for name in NominalNumbers.__dataclass_fields__}
    with np.errstate(all="ignore"):
        for flexspline_type, _, places, dimensions in variants.alike():
            asked = {name: values[places] for name, values in variants.numbers.items()}
            known = _windups(flexspline_type, dimensions) | _stresses(flexspline_type, dimensions)
            known |= _beside(flexspline_type, dimensions | asked, known, lost_motion_share)
            for name, values in known.items():
                columns[name][places] = values
    return pl.DataFrame([_series(name, values) for name, values in columns.items()])


def _series(name: str, values: Any) -> pl.Series:
    """Return a masked column with nulls instead; NaN stays a number."""
    if name in WORDS:
        words = [None if place is None else WORDS[name][int(place)] for place in values.tolist()]
        return pl.Series(name, words, dtype=pl.Enum(WORDS[name]))
    series = pl.Series(name, values.data)
    return series.set(pl.Series(values.mask), None) if values.mask.any() else series


def _windups(flexspline_type: str, dimensions: dict[str, Array]) -> _Columns:
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


def _stresses(flexspline_type: str, dimensions: dict[str, Array]) -> _Columns:
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


def _beside(flexspline_type: str, sizes: Mapping[str, Array], numbers: _Columns, lost_motion_share: float) -> _Columns:
    """Return what asks for more than dimensions and torque: material strength, rated torque, inertia, catalogue.

    `sizes` are dimensions, and what a variant has beside them, NaN where it has it not.
    """
    stiffness, torque, radius = numbers["stiffness"], sizes["torque"], numbers["mean_radius"]
    none = np.full(len(torque), np.nan)
    stress = [numbers.get(f"{section}_von_mises", np.zeros(len(torque))) for section in ("wall", "rim", "hub")]
    beside: _Columns = {"governing_section": np.argmax(stress, axis=0)}
    strong, young, poisson, rated, inertia = (sizes.get(name, none) for name in _BESIDE)
    beside["elastic_limit_torque"] = _where_given(strength.limit_torque(torque, numbers["von_mises"], strong), strong)
    tube = (radius, sizes["wall_thickness"], sizes["cylinder_length"])
    buckling = strength.wall_buckling_shear(young, poisson, *tube)
    of_buckling = {
        "buckling_shear": buckling,
        "buckling_torque": strength.limit_torque(torque, numbers["wall_shear"], buckling),
        "buckling_range": strength.buckling_range(poisson, *tube) + 1,
    }
    beside |= {name: _where_given(values, young, poisson) for name, values in of_buckling.items()}
    lost_at = lost_motion_share * rated
    beside["lost_motion"] = _where_given(lost_motion(stiffness, lost_at), rated)
    both = zip(radius.tolist(), lost_at.tolist(), strict=True)
    of_drive = [None if math.isnan(lost) else drive_lost_motion(size, lost) for size, lost in both]
    beside["drive_lost_motion"] = _optional(of_drive, rated)
    listed = [catalogue_stiffness(one) for one in radius.tolist()]
    least = np.array(
        [one.at_radius(size) if one else np.nan for one, size in zip(listed, radius.tolist(), strict=True)]
    )
    if flexspline_type != "cylinder":
        beside["catalogue_size"] = _optional([one and float(one.size) for one in listed])
        beside["catalogue_stiffness"] = _optional([one and one.stiffness for one in listed])
        beside["least_stiffness"] = np.ma.array(least, mask=[one is None for one in listed])
    frequency = natural_frequency(stiffness, inertia)
    slowest = natural_frequency(np.where(least < stiffness, least, stiffness), inertia)
    of_load = {
        "natural_frequency": frequency,
        "resonance_speed": resonance_speed(frequency),
        "resonance_speed_low": resonance_speed(slowest),
    }
    beside |= {name: _where_given(values, inertia) for name, values in of_load.items()}
    return beside | _bending(sizes, numbers)


_BESIDE = ("yield_strength", "youngs_modulus", "poisson_ratio", "rated_torque", "load_inertia")


def _bending(sizes: Mapping[str, Array], numbers: _Columns) -> _Columns:
    """Return the stresses of a wall, and of its rim, that the wave generator bends, beside those of torsion."""
    radius, wall = numbers["mean_radius"], sizes["wall_thickness"]
    given = [sizes.get(name, np.full(len(radius), np.nan)) for name in _BENT]
    young, poisson, deflection = given
    elastic = {"youngs_modulus": young, "poisson_ratio": poisson, "deflection": deflection}
    rings = {"": (radius, wall, numbers["wall_von_mises"])}
    if "rim_length" in sizes:
        rim = sizes["rim_thickness"]
        rings["rim_"] = windup.rim_radius(radius, wall, rim), rim, numbers["rim_von_mises"]
    found: _Columns = {}
    alternating: list[Any] = []
    combined: list[Any] = []
    for section, (middle, thickness, torsional) in rings.items():
        bent = bending.bending_stress(radius=middle, thickness=thickness, **elastic)
        found[f"{section}bending_stress"] = bent
        alternating.append(bending.alternating_stress(bent, poisson))
        combined.append(bending.combined_stress(alternating[-1], torsional))
    found |= {"alternating_stress": np.max(alternating, axis=0), "combined_stress": np.max(combined, axis=0)}
    return {name: _where_given(values, *given) for name, values in found.items()}


_BENT = ("youngs_modulus", "poisson_ratio", "radial_deflection")


def _where_given(values: Quantity, *asked: Array) -> Any:
    """Return numbers masked where one that they ask for is not given."""
    return np.ma.array(values, mask=np.any(np.isnan(asked), axis=0))


def _optional(values: list[float | None], *asked: Array) -> Any:
    """Return numbers masked where they are None, or where one that they ask for is not given."""
    found = np.array(values, dtype=float)
    missing = np.array([value is None for value in values])
    return np.ma.array(found, mask=missing | np.any(np.isnan(asked), axis=0) if asked else missing)
