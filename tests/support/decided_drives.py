"""Case 3 of the published study in its drive: rows of Other sources, Levers and Sweep without a fault."""

from __future__ import annotations

from typing import Any

from flexlash.feedback.template.template_workbook import Filling

__all__ = ["CASE_3", "CYLINDER", "LEVERS", "SOURCES", "SWEEPS", "drive"]

CASE_3: dict[str, Any] = {
    "variant": "case 3",
    "flexspline_type": "cup",
    "material": "20Cr2Ni4",
    "torque_Nm": 800.0,
    "cylinder_length_mm": 200.0,
    "mean_radius_mm": 80.0,
    "wall_thickness_mm": 1.6,
    "disk_inner_radius_mm": 40.0,
    "backlash_limit_arcmin": 3.8,
    "system_limit_arcmin": 5.5,
}
CYLINDER: dict[str, Any] = {
    "variant": "pinned",
    "flexspline_type": "cylinder",
    "material": "40CrNiMoA",
    "torque_Nm": 600.0,
    "cylinder_length_mm": 160.0,
    "bore_diameter_mm": 158.4,
    "wall_thickness_mm": 1.6,
}
SOURCES: tuple[dict[str, Any], ...] = (
    {
        "source": "tooth clearance", "enter_as": "mm at radius", "value_arcmin": 0.01, "radius_mm": 80.0,
        "lower_deviation": -0.01, "upper_deviation": 0.01,
    },
    {
        "source": "output bearing", "enter_as": "mm radial play", "value_arcmin": 0.0025, "radius_mm": 80.0,
        "lower_deviation": -0.0025, "upper_deviation": 0.0025, "distribution": "uniform",
    },
    {
        "source": "coupling", "value_arcmin": 10.0, "lower_deviation": -10.0, "upper_deviation": 10.0,
        "side": "input", "ratio": 100.0, "limits_sigma": 2.0,
    },
    {"source": "runout", "lower_deviation": -0.1, "upper_deviation": 0.1, "kind": "random"},
)  # fmt: skip
LEVERS: tuple[dict[str, Any], ...] = (
    {"dimension": "cylinder_length", "lowest": 120.0, "highest": 220.0, "step": 0.5, "cost_per_step": 2.0},
    {"dimension": "wall_thickness", "may_change": "yes", "tolerance_may_change": "no", "step": 0.02},
    {"dimension": "mean_radius", "may_change": "no", "cost_per_grade": 4.0},
    {"dimension": "material", "cost_per_step": 300.0},
)
SWEEPS: tuple[dict[str, Any], ...] = (
    {"variant": "case 3", "dimension": "cylinder_length", "from": 100.0, "to": 200.0, "step": 20.0},
    {
        "variant": "case 3", "dimension": "wall_thickness", "from": 2.0, "to": 1.4, "step": 0.2,
        "second_dimension": "disk_inner_radius", "second_from": 40.0, "second_to": 50.0, "second_step": 5.0,
    },
    {"dimension": "wall_thickness", "from": 1.5, "to": 1.7, "step": 0.1},
)  # fmt: skip


def drive(**changes: Any) -> Filling:
    """Return a filling with all three sheets; `changes` are other fields of it."""
    rows = {"variants": [CASE_3, CYLINDER], "other_sources": SOURCES, "levers": LEVERS, "sweep": SWEEPS}
    return Filling(**rows | changes)
