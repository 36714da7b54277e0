"""The sheet Drives: what the sheet Drive looks up of a variant, its spread, its whole drive, the catalogue's curve."""

from __future__ import annotations

from collections.abc import Sequence

from flexlash.mechanics.catalogue_curve import CatalogueCurve, catalogue_curve
from flexlash.report.formula.stored import Stored
from flexlash.report.report_data import Drawn
from flexlash.schema.angle_unit import ARC_MINUTES, AngleUnit
from flexlash.schema.decision_rows import OtherSource
from flexlash.schema.result_columns import result_columns

__all__ = ["DRIVES_NOTE", "FIGURES", "drive_ratio", "result_label", "stored_drives"]

DRIVES_NOTE = "The spread of each variant, its whole drive by the program, and the catalogue's; Drive looks it up."

_RESULTS = {column.key: column.label for column in result_columns()}
FIGURES = tuple(
    key for key in _RESULTS if key in {"mean_arcmin", "sd_arcmin", "stiffness_Nm_per_rad"} or key.startswith("system_")
)
"""Results that are looked up, each under its own heading."""

_CURVE = ("Size", "Ratio from", "T1 [N·m]", "T2 [N·m]", "K1 [N·m/rad]", "K2 [N·m/rad]", "K3 [N·m/rad]")
"""Headings of what the catalogue lists, in the order of its record."""


def stored_drives(drawn: Sequence[Drawn], sources: Sequence[OtherSource], angles: AngleUnit) -> Stored:
    """Return what is looked up of the drawn variants, in their order."""
    ratio = drive_ratio(sources)
    return Stored("Drives", [_row(variant, ratio, angles) for variant in drawn])


def drive_ratio(sources: Sequence[OtherSource]) -> float | None:
    """Return the ratio of the drive as its input side has it; None where none is given, or several differ."""
    ratios = {source.ratio for source in sources if source.side == "input"}
    return ratios.pop() if len(ratios) == 1 else None


def _row(variant: Drawn, ratio: float | None, angles: AngleUnit) -> dict[str, str | float | None]:
    computed = variant.computed
    curve = catalogue_curve(computed.nominal.mean_radius, ratio)
    listed = (None,) * len(_CURVE) if curve is None else _floats(curve)
    return {
        "Variant": variant.row["variant"],
        **{result_label(key, angles): _figure(variant.row[key], key, angles) for key in FIGURES},
        "Torque [N·m]": computed.variant.dimensions["torque"],
        **dict(zip(_CURVE, listed, strict=True)),
    }


def result_label(key: str, angles: AngleUnit) -> str:
    """Return the heading of a column of Results, angles in a unit."""
    return _RESULTS[key].replace(f"[{ARC_MINUTES.name}]", f"[{angles.name}]")


def _figure(value: float | None, key: str, angles: AngleUnit) -> float | None:
    return angles.of(value) if value is not None and key.endswith(f"_{ARC_MINUTES.name}") else value


def _floats(curve: CatalogueCurve) -> tuple[float | None, ...]:
    return tuple(None if number is None else float(number) for number in curve)
