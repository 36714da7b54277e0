"""A table of levers made by hand: the worked example of the published study, and what its first case leaves open."""

from __future__ import annotations

from typing import Any

import polars as pl

from flexlash.schema.decision_results import LEVERS_TABLE

__all__ = ["CASE_1", "CASE_3", "CONES", "NOMINAL_OVER", "lever", "levers_table", "study_levers"]

CASE_1, CASE_3 = "B3-160 case 1", "B3-160 case 3"
NOMINAL_OVER = "in the middle of all tolerances it is over the limit"
CONES = "a shorter cup bends more where its mouth cones"

_KEYS = ("from_value", "to_value", "drawing_value", "ppm_after", "mass_change_percent", "von_mises_MPa_after",
         "bending_stress_change_percent", "relative_cost", "rank")  # fmt: skip

_CHANGES = (
    ("wall_thickness", "disk_thickness", (1.6, 1.8169, 1.82, 566, 13.75, 76.1, 13.75, 22, 3)),
    ("disk_thickness", "", (1.6, 2.3457, 2.35, 1052, 6.1, 59.2, 0, 75, 5)),
    ("wall_thickness", "", (1.6, 1.9766, 1.98, 910, 20.7, 86.2, 23.75, 38, 4)),
    ("disk_inner_radius", "", (40, 45.8406, 46, 320, -1.4, 65.0, 0, 12, 1)),
    ("cylinder_length", "", (200, 161.913, 161.5, 769, -16.7, 86.2, 0, 77, 6)),
    ("mean_radius", "disk_outer_radius", (80, 86.9606, 87, 1032, 10.8, 86.2, -15.4, 14, 2)),
)
"""What alone meets the limit of case 3: dimension, what follows it, the numbers of `_KEYS`."""


def levers_table(*rows: dict[str, Any]) -> pl.DataFrame:
    """Return a table of levers of rows that give some of its columns."""
    schema = {column.key: pl.Float64 if column.is_number else pl.String for column in LEVERS_TABLE}
    return pl.DataFrame([{key: row.get(key) for key in schema} for row in rows], schema=schema, orient="row")


def lever(dimension: str, moves: str, numbers: tuple[float, ...], **rest: Any) -> dict[str, Any]:
    """Return a row of a nominal value of case 3 that meets its limit, with some columns changed."""
    known = dict(zip(_KEYS, map(float, numbers), strict=False))
    row = {
        "variant": CASE_3, "dimension": dimension, "moves": moves or None, "what": "nominal", "direction": "meet",
        "unit": "mm", "possible": "yes", "in_range": "yes", "stiffness_change_percent": 11.0, **known, **rest,
    }  # fmt: skip
    return row | {"probability_over_limit_after": row["ppm_after"] / 1e6}


def study_levers() -> pl.DataFrame:
    """Return the six changes that each bring case 3 within 3.8′, two that cannot, and what case 1 leaves open."""
    wall, disk, length = "wall_thickness", "disk_thickness", "cylinder_length"
    cannot = {"variant": CASE_3, "what": "tolerance", "direction": "meet", "unit": "mm", "possible": "no"}
    cannot |= {"reason": NOMINAL_OVER}
    changes = [
        lever(dimension, moves, numbers, range_note=CONES if dimension == length else None)
        for dimension, moves, numbers in _CHANGES
    ]
    relax = {"variant": CASE_1, "direction": "relax", "rank": None}
    wider = lever(wall, disk, (0.0025, 0.02966, 0.029, 1237, 0, 86.2, 0, -5.3, 0), what="tolerance", **relax)
    longer = lever(length, "", (160, 161.913, 161.5, 769, 0.7, 86.2, 0, 3, 0), **relax)
    return levers_table(
        {**cannot, "dimension": wall, "moves": disk, "from_value": 0.0025},
        *changes,
        {**cannot, "dimension": length, "from_value": 0.145},
        wider,
        longer,
    )
