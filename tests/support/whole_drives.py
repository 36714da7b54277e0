"""Submissions with other sources of backlash: the worked example, and one source of every kind."""

from __future__ import annotations

from typing import Any

__all__ = ["CASE_3", "EVERY_KIND", "EXAMPLE", "GRINDING"]

CASE_3: dict[str, Any] = {
    "variant": "B3-160 case 3",
    "flexspline_type": "cup",
    "material": "20Cr2Ni4",
    "torque_Nm": 800,
    "cylinder_length_mm": 200,
    "mean_radius_mm": 80,
    "wall_thickness_mm": 1.6,
    "disk_inner_radius_mm": 40,
    "tolerance_class": "grinding",
    "backlash_limit_arcmin": 3.8,
    "system_limit_arcmin": 5.3,
}

GRINDING: list[dict[str, Any]] = [
    {"tolerance_class": "grinding", "dimension": name, "lower_deviation": -half, "upper_deviation": half,
     "deviation_unit": unit, **rest}
    for name, half, unit, rest in (
        ("mean_radius", 2.5, "µm", {}),
        ("wall_thickness", 2.5, "µm", {}),
        ("disk_inner_radius", 2.5, "µm", {}),
        ("youngs_modulus", 2, "%", {}),
        ("poisson_ratio", 0.01, "-", {"distribution": "uniform"}),
    )
] + [{"tolerance_class": "grinding", "dimension": "cylinder_length", "grade": "IT9"}]  # fmt: skip
"""The study's class of ground cups."""

EXAMPLE = [
    {"source": "tooth clearance", "enter_as": "mm at radius", "upper_deviation": 0.02, "radius_mm": 80},
    {"source": "bearing", "enter_as": "mm radial play", "upper_deviation": 0.005, "radius_mm": 80},
    {"source": "coupling", "upper_deviation": 20, "side": "input", "ratio": 100},
]
for _source in EXAMPLE:
    _source["lower_deviation"] = 0
"""The sources of the worked example, whose values are blank."""

EVERY_KIND: list[dict[str, Any]] = [
    *EXAMPLE,
    {"source": "flanks", "enter_as": "mm at radius", "value_arcmin": 0.004, "lower_deviation": -0.003,
     "upper_deviation": 0.001, "radius_mm": 78, "distribution": "uniform"},
    {"source": "keyway", "enter_as": "mm at radius", "value_arcmin": 0.03, "lower_deviation": -0.02,
     "upper_deviation": 0.02, "radius_mm": 9, "distribution": "triangular", "side": "input", "ratio": 100},
    {"source": "runout", "lower_deviation": -0.2, "upper_deviation": 0.1, "kind": "random", "limits_sigma": 2},
    {"source": "sorted bearing", "enter_as": "mm radial play", "value_arcmin": 0.002, "lower_deviation": -0.001,
     "upper_deviation": 0.001, "radius_mm": 60, "pressure_angle_deg": 25, "distribution": "truncated normal",
     "limits_sigma": 1.5},
    {"source": "hysteresis", "value_arcmin": 0.25},
]  # fmt: skip
