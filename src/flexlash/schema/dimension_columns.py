"""The fields of Materials and Settings, and all dimensions: those of Variants and the ones that stand there.

What is usual: foam rubber to osmium, makers' lost motion at 3 to 4 % of the rated torque. Fillets, rims and other
refinements lower a wind-up by less than a half; play under the teeth raises it to at most 2.3 times, which bounds a
calibration.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from flexlash.schema.column import FACTOR, PERCENT, POSITIVE, STRESS, Column
from flexlash.schema.variant_columns import VARIANTS

__all__ = ["DIMENSIONS", "LOT_DIMENSIONS", "MATERIALS", "SETTINGS"]

_material: Callable[..., Column] = partial(Column.entry, "Materials")
_setting: Callable[..., Column] = partial(Column.entry, "Settings")

MATERIALS = (
    _material(
        "identity",
        "material",
        "Material",
        "Name that the Variants sheet refers to, used once.",
        type="text",
        required=True,
        also_called="werkstoff matériau materiau matière materiale steel steelgrade stahl",
    ),
    _material(
        "dimension",
        "youngs_modulus_GPa",
        "Young's modulus E [GPa]",
        "Gives the shear modulus E/(2(1 + ν)) together with Poisson's ratio.",
        **STRESS,
        usual=(0.001, 1500),
        also_called="emodul elastizitätsmodul elasticmodulus youngmodulus modulusofelasticity e",
    ),
    _material(
        "dimension",
        "poisson_ratio",
        "Poisson's ratio ν [-]",
        "Gives the shear modulus together with Young's modulus.",
        quantity="ratio",
        minimum=0,
        maximum=0.5,
        usual=(0.1, 0.5),
        also_called="querkontraktionszahl poissonzahl poisson nu ν",
    ),
    _material(
        "dimension",
        "shear_modulus_GPa",
        "Shear modulus G [GPa]",
        "Optional. When given it is used instead of E and ν, and their tolerances do not apply.",
        **STRESS,
        usual=(0.0003, 600),
        also_called="schubmodul gmodul modulusofrigidity g",
    ),
    _material(
        "requirement",
        "density_kg_m3",
        "Density [kg/m³]",
        "Optional. Shown in the report.",
        quantity="density",
        **POSITIVE,
        usual=(10, 25000),
    ),
    _material(
        "requirement",
        "yield_MPa",
        "Yield strength [MPa]",
        "Optional. A von Mises stress above it is flagged.",
        **STRESS,
        usual=(1, 10000),
        also_called="streckgrenze yieldstress yield rp02 re",
    ),
    _material("remark", "source", "Source", "Where the values come from. Shown in the report.", type="text"),
)

SETTINGS = (
    _setting(
        "requirement",
        "seed",
        "seed",
        "Start of the random numbers. The same seed gives the same report.",
        type="integer",
        minimum=0,
        maximum=2**32 - 1,
        default=0,
    ),
    _setting(
        "requirement",
        "coverage_percent",
        "coverage_percent",
        "Share of units between both ends of the coverage interval in the report.",
        **PERCENT | {"minimum": 50, "exclusive_minimum": False},
        maximum=99.99,
        default=95,
    ),
    _setting(
        "requirement",
        "method",
        "method",
        "How the spread is sampled: line (sharp in the tails), sobol, or random (plain Monte Carlo).",
        type="choice",
        choices=("line", "sobol", "random"),
        default="line",
    ),
    _setting(
        "requirement",
        "samples",
        "samples",
        "Lines or points per variant. Blank: as many lines as the precision needs.",
        type="integer",
        minimum=1,
        maximum=2**22,
    ),
    _setting(
        "requirement",
        "lost_motion_percent",
        "lost_motion_percent",
        "Share of the rated torque at which lost motion is stated, for the flexspline alone and for a catalogue drive.",
        **PERCENT | {"minimum": 0.1, "exclusive_minimum": False},
        maximum=100,
        default=4,
        usual=(1, 10),
    ),
    _setting(
        "dimension",
        "cylinder_calibration",
        "cylinder_calibration",
        "Factor on the cylinder wind-up, from your own tests or FEA; 1 changes nothing.",
        **FACTOR,
        usual=(0.5, 2.5),
    ),
    _setting(
        "dimension",
        "disk_calibration",
        "disk_calibration",
        "Factor on the disk wind-up, from your own tests or FEA; 1 changes nothing.",
        **FACTOR,
        usual=(0.5, 2.5),
    ),
    _setting(
        "requirement",
        "acceptable_ppm",
        "acceptable_ppm",
        "A lot fails where more of its units than this, per million, are over the limit.",
        **POSITIVE,
        maximum=999_999,
        default=1350,
        usual=(1, 100_000),
        since=4,
    ),
    _setting(
        "requirement",
        "target_percent",
        "target_percent",
        "A variant meets its backlash limit where at least this share of its units does.",
        **PERCENT | {"minimum": 97.5, "exclusive_minimum": False},
        maximum=99.9999,
        default=99.865,
        usual=(99, 99.9999),
        since=6,
    ),
    _setting(
        "requirement",
        "mean_shift_factor",
        "mean_shift_factor",
        "Whole drive, combination with mean shift: the part of each tolerance by which all means may drift at once.",
        quantity="ratio",
        minimum=0,
        maximum=1,
        default=0.3,
        since=6,
    ),
    _setting(
        "requirement",
        "angle_unit",
        "angle_unit",
        "Unit in which report, page and screen give angles: arcmin or arcsec. The columns of Results keep theirs.",
        type="choice",
        choices=("arcmin", "arcsec"),
        default="arcmin",
        since=7,
    ),
)

DIMENSIONS: dict[str, Column] = {
    column.dimension: column for column in (*VARIANTS, *MATERIALS, *SETTINGS) if column.role == "dimension"
}
"""Every dimension that may have a tolerance, with the column its nominal value stands in."""

LOT_DIMENSIONS = frozenset(name for name, column in DIMENSIONS.items() if column.sheet != "Variants")
"""Dimensions that are one value for a whole lot of parts unless Tolerances says otherwise: elastic constants, which a
heat of steel shares, and calibrations, which are one unknown number."""
