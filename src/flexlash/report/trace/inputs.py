"""The Inputs sheet: what was entered for each drawn variant, in printed units, and what the program made of it."""

from __future__ import annotations

from collections.abc import Sequence

from flexlash.analysis.computed import Computed
from flexlash.report.formula.stored import Stored
from flexlash.schema.columns import DIMENSIONS, MATERIALS, SETTINGS, VARIANTS, Column
from flexlash.schema.units import ARCMIN, as_entered
from flexlash.schema.variant import Variant

__all__ = ["ENTERED", "INPUTS_NOTE", "PROGRAM", "SPREAD", "stored_inputs"]

INPUTS_NOTE = "What was entered, and the program's numbers for it; the sheet Trace looks both up."

_BESIDE = {
    "yield_strength": next(column for column in MATERIALS if column.key == "yield_MPa"),
    "rated_torque": next(column for column in VARIANTS if column.key == "rated_torque_Nm"),
    "backlash_limit": next(column for column in VARIANTS if column.key == "backlash_limit_arcmin"),
    "lost_motion_percent": next(column for column in SETTINGS if column.key == "lost_motion_percent"),
}
ENTERED: dict[str, Column] = {**DIMENSIONS, **_BESIDE}
"""Every number that a trace starts from, with the column it was entered in; its label is the heading of Inputs."""

_MEGAPASCAL = 1e6
PROGRAM: dict[str, tuple[str, float]] = {
    **{
        f"{name}_windup": (f"{words} wind-up, program [rad]", 1.0)
        for name, words in (
            ("tooth_band", "Tooth face"),
            ("rim", "Rim"),
            ("wall", "Wall"),
            ("junction_fillet", "Junction fillet"),
            ("disk_body", "Disk body"),
            ("hub_fillet", "Hub fillet"),
            ("cylinder", "Cylinder"),
            ("disk", "Disk"),
        )
    },
    "windup": ("Wind-up, program [rad]", 1.0),
    "backlash": ("Backlash, program [rad]", 1.0),
    "disk_share": ("Disk share, program", 1.0),
    "stiffness": ("Stiffness, program [N·m/rad]", 1.0),
    "cylinder_only_backlash": ("Cylinder-only backlash, program [rad]", 1.0),
    "two_term_backlash": ("Two-term backlash, program [rad]", 1.0),
    "lost_motion": ("Lost motion of the flexspline, program [arcmin]", ARCMIN),
    **{
        f"{name}_shear": (f"{words} shear, program [MPa]", _MEGAPASCAL)
        for name, words in (("wall", "Wall"), ("rim", "Rim"), ("hub", "Disk"))
    },
    **{
        f"{name}von_mises": (f"{words} stress, program [MPa]", _MEGAPASCAL)
        for name, words in (
            ("wall_", "Wall von Mises"),
            ("rim_", "Rim von Mises"),
            ("hub_", "Disk von Mises"),
            ("", "Greatest von Mises"),
        )
    },
    "governing_section": ("Governing section, program", 1.0),
    "elastic_limit_torque": ("Elastic limit torque, program [N·m]", 1.0),
    "buckling_range": ("Buckling formula applies, program", 1.0),
    "buckling_shear": ("Buckling shear, program [MPa]", _MEGAPASCAL),
    "buckling_torque": ("Buckling torque, program [N·m]", 1.0),
}
"""Nominal number → its heading on Inputs and the size of its printed unit."""

SPREAD = {
    "first_order_sd": "First-order sd, program [arcmin]",
    "sd": "Standard deviation, program [arcmin]",
    "within_lot_sd": "Within-lot sd, program [arcmin]",
    "between_lots_sd": "Between-lots sd, program [arcmin]",
}
"""Number of the spread → its heading on Inputs."""


def stored_inputs(computed: Sequence[Computed], lost_motion_percent: float) -> Stored:
    """Return the Inputs of variants in their order."""
    return Stored("Inputs", [_row(variant, lost_motion_percent) for variant in computed])


def _row(computed: Computed, lost_motion_percent: float) -> dict[str, str | float | None]:
    variant = computed.variant
    sizes = _sizes(variant, lost_motion_percent)
    row: dict[str, str | float | None] = {
        "Variant": variant.name,
        "Flexspline type": variant.flexspline_type,
        "Material": variant.material,
    }
    row |= {column.label: _printed(sizes.get(name), column) for name, column in ENTERED.items()}
    for key, (heading, size) in PROGRAM.items():
        number = getattr(computed.nominal, key) or None
        row[heading] = number / size if isinstance(number, float) else number
    for key, heading in SPREAD.items():
        angle = computed.spread.numbers.get(key) if computed.spread else None
        row[heading] = None if angle is None else angle / ARCMIN
    return row


def _sizes(variant: Variant, lost_motion_percent: float) -> dict[str, float | None]:
    """Return everything that was entered in SI, by name; None for a blank."""
    return {
        **variant.dimensions,
        "youngs_modulus": variant.youngs_modulus,
        "poisson_ratio": variant.poisson_ratio,
        "yield_strength": variant.yield_strength,
        "rated_torque": variant.rated_torque,
        "backlash_limit": variant.backlash_limit,
        "lost_motion_percent": lost_motion_percent / 100,
    }


def _printed(size: float | None, column: Column) -> float | None:
    """Return a size as it was entered, or None for a blank."""
    return None if size is None else as_entered(size, column.si_unit.si)
