"""Random rows of Variants, many of them on the edge of a rule or beyond."""

from __future__ import annotations

import random

__all__ = ["rows"]

_CUP_ALONE = ("disk_hub_thickness_mm", "disk_thickness_exponent", "hub_fillet_radius_mm", "junction_fillet_radius_mm")
_OF_DISK = ("disk_thickness_mm", "disk_inner_radius_mm", "disk_outer_radius_mm", "disk_cone_angle_deg")


def rows(count: int, seed: int) -> list[dict[str, str | float | None]]:
    """Return rows whose numbers are within the bounds of their columns; None is a blank."""
    draw = random.Random(seed)  # noqa: S311
    return [_tidied(draw, _row(draw)) for _ in range(count)]


def _row(draw: random.Random) -> dict[str, str | float | None]:
    mean = draw.choice([80.0, 80.3, 40.3, round(draw.uniform(5, 120), 2)])
    wall = draw.choice([1.6, 1.2, 0.5, mean * 0.1, mean * 0.2, 2 * mean, 450.0, round(draw.uniform(0.3, 300), 1)])
    bore, length = max(mean - wall / 2, 0.1), draw.choice([160.0, 0.3, 30.0, round(draw.uniform(5, 200), 1)])
    disk = [40.2, mean * 0.5, 0.7 * bore, bore, mean - 0.1, mean, mean + wall / 2, round(draw.uniform(2, 130), 1)]
    edge = [mean, bore, mean + wall / 2, mean + 0.001, 120.0, round(draw.uniform(10, 200), 1)]
    rim = draw.choice([0.2, 10.0, length / 2, length, round(draw.uniform(1, 200), 1)])
    inner = draw.choice(disk)
    fillets = [0.0, 0.0, 1.0, 3.0, bore / 2, bore, length, max(length - rim, 0.0), max(mean - inner, 0.0), 90.0]
    draws = {
        "mean_radius_mm": (0.7, [mean]),
        "bore_diameter_mm": (0.4, [2 * bore, 158.4]),
        "wall_thickness_mm": (1.0, [wall]),
        "cylinder_length_mm": (1.0, [length]),
        "disk_thickness_mm": (0.3, [1.6]),
        "disk_inner_radius_mm": (0.75, [inner]),
        "disk_outer_radius_mm": (0.4, edge),
        "disk_hub_thickness_mm": (0.3, [4.0]),
        "disk_thickness_exponent": (0.1, [0.0, 2.0]),
        "disk_cone_angle_deg": (0.15, [30.0, 60.0, 89.999, 89.9999, 90.0]),
        "hub_fillet_radius_mm": (0.3, fillets),
        "junction_fillet_radius_mm": (0.35, fillets),
        "rim_length_mm": (0.3, [rim]),
        "rim_thickness_mm": (0.3, [1.0, wall, 3.2]),
        "tooth_face_width_mm": (0.2, [rim, length / 3, length, 1.1 * length]),
    }
    kind = draw.choice(["cup", "cup", "cup", "hat", "hat", "cylinder", None])
    return {"flexspline_type": kind} | {
        key: draw.choice(numbers) if draw.random() < share else None for key, (share, numbers) in draws.items()
    }


def _tidied(draw: random.Random, row: dict[str, str | float | None]) -> dict[str, str | float | None]:
    """Return most rows without what their type has not, and with what it needs."""
    if draw.random() < 0.2:
        return row
    kind = row["flexspline_type"]
    foreign = {"hat": _CUP_ALONE, "cylinder": _CUP_ALONE + _OF_DISK}.get(kind, ())
    row |= dict.fromkeys(foreign)
    needed = {"hat": ("disk_outer_radius_mm", 120.0), "cylinder": ("torque_Nm", 800.0)}
    key, number = needed.get(kind, ("disk_inner_radius_mm", 40.2))
    row[key] = row.get(key) or number
    if row["rim_length_mm"] is None or row["rim_thickness_mm"] is None:
        row |= dict.fromkeys(("rim_length_mm", "rim_thickness_mm"))
    if row["mean_radius_mm"] is not None:
        row["bore_diameter_mm"] = None
    elif row["bore_diameter_mm"] is None:
        row["mean_radius_mm"] = 80.0
    return row
