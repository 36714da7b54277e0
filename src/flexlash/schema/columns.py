"""The one truth about every field that is entered: what it is called, measured in, allowed to hold, good for.

Template, validation, data dictionary, report and the README's tables all derive from these records; the
fields of the report are in `result_columns`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from flexlash.schema.column import Column

__all__ = [
    "DIMENSIONS",
    "ENTRY_SHEETS",
    "MATERIALS",
    "SETTINGS",
    "SETTINGS_SHEET",
    "TOLERANCES",
    "VARIANTS",
    "Column",
    "columns_of",
]


def _entry(sheet: str, key: str, label: str, text: str, **rest: Any) -> Column:
    """Return a field; a unit at the end of its label is its unit."""
    unit = label.rpartition("[")[2].rstrip("]") if "[" in label else rest.pop("unit", "")
    return Column(sheet=sheet, key=key, label=label, help=text, unit=unit, **rest)


_variant: Callable[..., Column] = partial(_entry, "Variants")
_material: Callable[..., Column] = partial(_entry, "Materials")
_tolerance: Callable[..., Column] = partial(_entry, "Tolerances")
_setting: Callable[..., Column] = partial(_entry, "Settings")

_TEXT = {"type": "text"}
_CHOICE = {"type": "choice"}
_INTEGER = {"type": "integer"}
_POSITIVE = {"minimum": 0, "exclusive_minimum": True}
_LENGTH = {"quantity": "length", **_POSITIVE}
_FILLET = {"quantity": "length", "minimum": 0, "group": "Refinements"}
_TORQUE = {"quantity": "torque", **_POSITIVE}
_STRESS = {"quantity": "stress", **_POSITIVE}
_FACTOR = {"quantity": "ratio", "unit": "-", "minimum": 0.1, "maximum": 10, "default": 1}
_PERCENT = {"quantity": "ratio", "unit": "%", **_POSITIVE}

VARIANTS = (
    _variant(
        "variant",
        "Variant",
        "Name of the variant, used once. The report names each row by it.",
        **_TEXT,
        required=True,
        group="Variant",
    ),
    _variant(
        "flexspline_type",
        "Flexspline type",
        "cup: disk inwards to the hub. hat: flange outwards to the bolt circle. cylinder: pin, tooth or jaw "
        "connection, no disk. Blank means cup.",
        **_CHOICE,
        choices=("cup", "hat", "cylinder"),
        default="cup",
        group="Variant",
    ),
    _variant(
        "material",
        "Material",
        "A material of the Materials sheet. Add a row there for your own.",
        **_TEXT,
        required=True,
        group="Variant",
    ),
    _variant(
        "torque_Nm",
        "Torque T [N·m]",
        "Output torque at which the wind-up is wanted. The backlash is the lag when it reverses.",
        **_TORQUE,
        required=True,
        group="Load",
    ),
    _variant(
        "cylinder_length_mm",
        "Cylinder length l [mm]",
        "Inside depth: from the inner face of the disk to the open end, tooth rim included.",
        **_LENGTH,
        required=True,
        group="Cylinder",
    ),
    _variant(
        "mean_radius_mm",
        "Mean radius r_m [mm]",
        "Radius of the middle of the wall. Give this or the bore diameter, not both.",
        **_LENGTH,
        group="Cylinder",
    ),
    _variant(
        "bore_diameter_mm",
        "Bore diameter [mm]",
        "Inside diameter of the wall. The mean radius is then bore/2 + wall/2 and follows both tolerances.",
        **_LENGTH,
        group="Cylinder",
    ),
    _variant(
        "wall_thickness_mm",
        "Wall thickness Δ [mm]",
        "Thickness of the cylinder wall.",
        **_LENGTH,
        required=True,
        group="Cylinder",
    ),
    _variant(
        "disk_thickness_mm",
        "Disk thickness [mm]",
        "Thickness of the disk or flange. Blank: the same as the wall, cut in one pass, one tolerance for both.",
        **_LENGTH,
        group="Disk",
    ),
    _variant(
        "disk_inner_radius_mm",
        "Disk inner radius r_ci [mm]",
        "Cup: radius of the hub, where the disk is clamped; required. Hat: blank means the mean radius.",
        **_LENGTH,
        group="Disk",
    ),
    _variant(
        "disk_outer_radius_mm",
        "Disk outer radius r_co [mm]",
        "Cup: blank means the mean radius, as it should be. Hat: radius of the bolt circle; required.",
        **_LENGTH,
        group="Disk",
    ),
    _variant(
        "disk_hub_thickness_mm",
        "Disk thickness at hub [mm]",
        "Cup only. Disk that thins in a straight line from here to the disk thickness at its rim. Blank: even.",
        **_LENGTH,
        group="Refinements",
    ),
    _variant(
        "disk_thickness_exponent",
        "Disk thickness exponent n [-]",
        "Cup only. Disk that thins as t = t_hub (r_ci/r)^n from the thickness at hub; leave the disk thickness blank. "
        "2: the same shear stress at every radius.",
        quantity="ratio",
        minimum=0,
        maximum=10,
        group="Refinements",
        since=2,
    ),
    _variant(
        "disk_cone_angle_deg",
        "Disk cone angle [°]",
        "Angle between a conical disk or flange and the axis; it falls away from the open end. Thicknesses are normal "
        "to it. Blank or 90: flat.",
        quantity="angle",
        minimum=30,
        maximum=90,
        group="Refinements",
        since=2,
    ),
    _variant(
        "hub_fillet_radius_mm",
        "Hub fillet radius [mm]",
        "Cup only. Fillet between hub and inner face of the disk. Blank or 0: sharp corner.",
        **_FILLET,
    ),
    _variant(
        "junction_fillet_radius_mm",
        "Junction fillet radius [mm]",
        "Cup only. Fillet inside the corner of disk and wall. Blank or 0: sharp corner.",
        **_FILLET,
    ),
    _variant(
        "rim_length_mm",
        "Tooth rim length [mm]",
        "Length of the thicker toothed rim at the open end. Give length and thickness, or neither.",
        **_LENGTH,
        group="Refinements",
    ),
    _variant(
        "rim_thickness_mm",
        "Tooth rim thickness [mm]",
        "Total thickness of the rim over the same bore, teeth counted to their root or pitch circle.",
        **_LENGTH,
        group="Refinements",
    ),
    _variant(
        "rated_torque_Nm",
        "Rated torque [N·m]",
        "Gives the lost motion of the flexspline alone, and of a catalogue drive, at a few per cent of it (Settings: "
        "lost_motion_percent).",
        **_TORQUE,
        group="Requirements",
    ),
    _variant(
        "load_inertia_kg_m2",
        "Load inertia J [kg·m²]",
        "Moment of inertia on the output. Gives the natural frequency of the load on the flexspline.",
        quantity="inertia",
        **_POSITIVE,
        group="Requirements",
        since=2,
    ),
    _variant(
        "backlash_limit_arcmin",
        "Backlash limit [arcmin]",
        "Greatest backlash allowed. Gives probability over limit, ppm and Ppk.",
        quantity="angle",
        **_POSITIVE,
        group="Requirements",
    ),
    _variant(
        "tolerance_class",
        "Tolerance class",
        "A class of the Tolerances sheet. Blank means standard.",
        **_TEXT,
        default="standard",
        group="Requirements",
    ),
    _variant("notes", "Notes", "Free text; carried to the report.", **_TEXT, group="Requirements"),
)

MATERIALS = (
    _material("material", "Material", "Name that the Variants sheet refers to, used once.", **_TEXT, required=True),
    _material(
        "youngs_modulus_GPa",
        "Young's modulus E [GPa]",
        "Gives the shear modulus E/(2(1 + ν)) together with Poisson's ratio.",
        **_STRESS,
    ),
    _material(
        "poisson_ratio",
        "Poisson's ratio ν [-]",
        "Gives the shear modulus together with Young's modulus.",
        quantity="ratio",
        minimum=0,
        maximum=0.5,
    ),
    _material(
        "shear_modulus_GPa",
        "Shear modulus G [GPa]",
        "Optional. When given it is used instead of E and ν, and their tolerances do not apply.",
        **_STRESS,
    ),
    _material("density_kg_m3", "Density [kg/m³]", "Optional; carried to the report.", quantity="density", **_POSITIVE),
    _material("yield_MPa", "Yield strength [MPa]", "Optional. A von Mises stress above it is flagged.", **_STRESS),
    _material("source", "Source", "Where the values come from; carried to the report.", **_TEXT),
)

SETTINGS = (
    _setting(
        "seed",
        "seed",
        "Start of the random numbers. The same seed gives the same report.",
        **_INTEGER,
        minimum=0,
        maximum=2**32 - 1,
        default=0,
    ),
    _setting(
        "coverage_percent",
        "coverage_percent",
        "Share of units inside the coverage interval of the report.",
        **_PERCENT | {"minimum": 50, "exclusive_minimum": False},
        maximum=99.99,
        default=95,
    ),
    _setting(
        "method",
        "method",
        "How the spread is sampled: line (sharp in the tails), sobol, or random (plain Monte Carlo).",
        **_CHOICE,
        choices=("line", "sobol", "random"),
        default="line",
    ),
    _setting(
        "samples",
        "samples",
        "Lines or points per variant. Blank: as many lines as the precision needs.",
        **_INTEGER,
        minimum=1,
        maximum=2**22,
    ),
    _setting(
        "lost_motion_percent",
        "lost_motion_percent",
        "Share of the rated torque at which lost motion is stated, of the flexspline alone and of a catalogue drive.",
        **_PERCENT | {"minimum": 0.1, "exclusive_minimum": False},
        maximum=100,
        default=4,
    ),
    _setting(
        "cylinder_calibration",
        "cylinder_calibration",
        "Factor on the cylinder wind-up, from your own tests or FEA; 1 changes nothing.",
        **_FACTOR,
    ),
    _setting(
        "disk_calibration",
        "disk_calibration",
        "Factor on the disk wind-up, from your own tests or FEA; 1 changes nothing.",
        **_FACTOR,
    ),
)

DIMENSIONS: dict[str, Column] = {
    column.dimension: column
    for column in (*VARIANTS, *MATERIALS[1:4], *SETTINGS[-2:])
    if column.is_number and column.dimension not in {"rated_torque", "load_inertia_kg_m2", "backlash_limit"}
}
"""Every dimension that may have a tolerance, with the column its nominal value stands in."""

TOLERANCES = (
    _tolerance(
        "tolerance_class",
        "Tolerance class",
        "Name that the Variants sheet refers to; one row per class and dimension.",
        **_TEXT,
        required=True,
    ),
    _tolerance(
        "dimension",
        "Dimension",
        "The dimension that varies. A dimension without a row is exact.",
        **_CHOICE,
        required=True,
        choices=tuple(DIMENSIONS),
    ),
    _tolerance(
        "lower_deviation",
        "Lower deviation",
        "Signed: what the smallest part differs from the entered value. Numbers only, one per cell.",
    ),
    _tolerance("upper_deviation", "Upper deviation", "Signed: what the largest part differs from the entered value."),
    _tolerance(
        "deviation_unit",
        "Deviation unit",
        "Unit of both deviations: a length unit, % of the entered value, or the dimension's own (N·m, GPa, -). "
        "Blank: the dimension's own.",
        **_TEXT,
    ),
    _tolerance(
        "grade",
        "Grade",
        "Instead of deviations: IT5…IT12 or js5…js12 (± half), h5…h12 (minus), H5…H12 (plus), 2768-f, 2768-m, "
        "2768-c, 2768-v. On a radius: the grade of its diameter, halved.",
        **_TEXT,
    ),
    _tolerance(
        "distribution",
        "Distribution",
        "How parts scatter between the limits. Blank means normal.",
        **_CHOICE,
        choices=("normal", "truncated normal", "uniform", "triangular"),
        default="normal",
    ),
    _tolerance(
        "limits_sigma",
        "Limits at ± sigma",
        "Normal distributions: the limits lie this many standard deviations from the middle. Blank: 3.",
        minimum=0.5,
        maximum=100,
        default=3,
    ),
)

SETTINGS_SHEET = (
    _setting(
        "setting",
        "Setting",
        "Name of the setting.",
        **_CHOICE,
        required=True,
        choices=tuple(column.key for column in SETTINGS),
    ),
    _setting("value", "Value", "Its value. Blank: the default.", **_TEXT),
)

ENTRY_SHEETS = {
    "Variants": VARIANTS,
    "Materials": MATERIALS,
    "Tolerances": TOLERANCES,
    "Settings": SETTINGS_SHEET,
}


def columns_of(sheet: str) -> dict[str, Column]:
    """Return the columns of an entry sheet by key."""
    return {column.key: column for column in ENTRY_SHEETS[sheet]}
