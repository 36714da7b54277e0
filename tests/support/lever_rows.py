"""Random submissions with limits, and the same rows with the value of a lever, as files for the whole program."""

from __future__ import annotations

import csv
import random
from pathlib import Path

from flexlash.schema.columns import DIMENSIONS, columns_of

__all__ = ["CLASSES", "changed_rows", "drawn_rows", "write_rows"]

HEADER = (
    "tolerance_class,dimension,lower_deviation,upper_deviation,deviation_unit,grade,distribution,limits_sigma,cp,cpk\n"
)
CLASSES = (
    HEADER
    + """\
grades,cylinder_length,,,,js11,normal,3,,
grades,mean_radius,,,,IT7,normal,3,,
grades,bore_diameter,,,,H7,normal,3,,
grades,wall_thickness,,,,IT9,normal,3,,
grades,disk_thickness,,,,IT9,normal,3,,
grades,disk_hub_thickness,,,,IT9,normal,3,,
grades,rim_thickness,,,,IT9,normal,3,,
grades,disk_inner_radius,,,,IT9,normal,3,,
grades,disk_outer_radius,,,,IT9,normal,3,,
grades,youngs_modulus,-2,2,%,,normal,3,,
grades,poisson_ratio,-0.01,0.01,-,,uniform,,,
shares,cylinder_length,-0.5,0.5,%,,uniform,,,
shares,mean_radius,-0.1,0.1,%,,normal,3,,
shares,bore_diameter,-0.1,0.1,%,,normal,3,,
shares,wall_thickness,-1.5,2,%,,triangular,,,
shares,disk_thickness,-1.5,2,%,,triangular,,,
shares,disk_inner_radius,-0.3,0.3,%,,truncated normal,2,,
shares,youngs_modulus,-1,1,%,,normal,3,,
able,cylinder_length,-0.2,0.2,mm,,normal,,1.2,0.9
able,wall_thickness,-0.01,0.03,mm,,normal,,1.33,1.1
able,disk_thickness,-0.02,0.02,mm,,normal,3,,
able,disk_inner_radius,-0.1,0.1,mm,,normal,,1,0.8
able,poisson_ratio,-0.01,0.01,-,,uniform,,,
exact,youngs_modulus,-2,2,%,,normal,3,,
"""
)
"""Tolerance classes of every kind: grades, shares of the value, capabilities, hardly any."""

MATERIALS = ("20Cr2Ni4", "42CrMo4 (Q+T)", "17-4PH H1025", "Ti-6Al-4V")


def drawn_rows(count: int, seed: int) -> list[dict[str, str | float]]:
    """Return random rows of Variants by key, whose limits lie anywhere from far too low to far too high."""
    draw = random.Random(seed)  # noqa: S311
    return [_row(draw, number) for number in range(count)]


def _row(draw: random.Random, number: int) -> dict[str, str | float]:
    radius = draw.uniform(15, 120)
    wall = round(radius * draw.uniform(0.013, 0.03), 2)
    kind = draw.choice(["cup", "cup", "cup", "hat", "cylinder"])
    length = round(radius * draw.uniform(0.6, 2.5), 1)
    row: dict[str, str | float] = {
        "variant": f"R{number:03d}",
        "flexspline_type": kind,
        "material": draw.choice(MATERIALS),
        "torque_Nm": round(radius**3 * 1.5e-3 * draw.uniform(0.5, 1.5), 2),
        "cylinder_length_mm": length,
        "wall_thickness_mm": wall,
        "tolerance_class": draw.choice(["grades", "grades", "shares", "able", "exact"]),
    }
    row |= {"mean_radius_mm": round(radius, 1)} if draw.random() < 0.7 else {"bore_diameter_mm": round(2 * radius, 1)}
    if kind == "cup":
        row["disk_inner_radius_mm"] = round(radius * draw.uniform(0.35, 0.6), 1)
        row |= _disk(draw, radius, wall)
    elif kind == "hat":
        row["disk_outer_radius_mm"] = round(radius * draw.uniform(1.3, 1.8), 1)
        row |= {"disk_thickness_mm": round(wall * 1.3, 2)} if draw.random() < 0.5 else {}
    if draw.random() < 0.3:
        row |= {"rim_length_mm": round(length / 6, 1), "rim_thickness_mm": round(2 * wall, 2)}
    if draw.random() < 0.2:
        row["tooth_face_width_mm"] = round(length / 5, 1)
    # Of the usual cup about 4′ wind up; the limit lies from a fifth to thrice of that.
    row["backlash_limit_arcmin"] = round(4.0 * draw.uniform(0.2, 3.0), 2)
    return row


def _disk(draw: random.Random, radius: float, wall: float) -> dict[str, str | float]:
    """Return what else a cup's disk may have."""
    chance = draw.random()
    if chance < 0.2:
        return {"disk_thickness_mm": round(wall * draw.uniform(0.9, 1.5), 2)}
    if chance < 0.35:
        return {"disk_hub_thickness_mm": round(2.2 * wall, 2)}
    if chance < 0.45:
        return {"disk_hub_thickness_mm": round(2.2 * wall, 2), "disk_thickness_exponent": 1.2}
    if chance < 0.55:
        return {"disk_cone_angle_deg": draw.choice([60.0, 75.0])}
    if chance < 0.7:
        fillet = round(radius * 0.04, 1)
        return {"hub_fillet_radius_mm": fillet, "junction_fillet_radius_mm": fillet}
    return {}


def changed_rows(rows, levers, value: str) -> list[dict[str, str | float]]:
    """Return the row of each nominal lever that is possible, with one of its values, named by the lever's place."""
    of_name = {row["variant"]: row for row in rows}
    changed = []
    for place, lever in enumerate(levers):
        if lever["what"] != "nominal" or lever["possible"] != "yes":
            continue
        row = dict(of_name[lever["variant"]])
        if lever["dimension"] == "wall_thickness" and not lever["moves"] and _is_shared(row):
            row["disk_thickness_mm"] = row["wall_thickness_mm"]
        row[DIMENSIONS[lever["dimension"]].key] = lever[value]
        changed.append(row | {"variant": f"L{place:05d}"})
    return changed


def _is_shared(row) -> bool:
    """Return whether the disk of a row is as thick as its wall, being the same dimension."""
    return row["flexspline_type"] != "cylinder" and not {"disk_thickness_mm", "disk_thickness_exponent"} & row.keys()


def write_rows(path: Path, rows) -> Path:
    """Write rows of Variants to a CSV file, numbers with all their digits."""
    columns = columns_of("Variants")
    keys = [key for key in columns if any(key in row for row in rows)]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow([columns[key].label for key in keys])
        writer.writerows([row.get(key, "") for key in keys] for row in rows)
    return path
