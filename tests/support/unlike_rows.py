"""Rows of several batches: alike ones, bare tubes, two cuts, and some without scatter."""

from __future__ import annotations

from b3_160 import CUP, NOMINAL, TUBE
from toleranced import plan, row

from flexlash.tolerance.dimension_limits import Limits

__all__ = ["LINES", "ROWS"]

ALIKE = {
    "wall_thickness": Limits(low=0.00155, high=0.00165),
    "disk_inner_radius": Limits(low=0.0398, high=0.0402),
    "poisson_ratio": Limits(low=0.28, high=0.32, distribution="uniform"),
}
BARE = {name: limits for name, limits in ALIKE.items() if name != "disk_inner_radius"}
WIDE_CUT = {"wall_thickness": Limits(low=0.00155, high=0.00165, distribution="truncated normal")}
NARROW_CUT = {"wall_thickness": Limits(low=0.00155, high=0.00165, distribution="truncated normal", sigma=2.0)}
SHIFTED = {"disk_inner_radius": Limits(low=0.0402, high=0.0402)}
LINES = plan(seed=3)


def _row(model, limits, number=0, limit=None):
    return row(model, NOMINAL | {"torque": 700.0 + number}, limits, limit)


ROWS = [
    *(_row(CUP, ALIKE, number, 1e-3 if number % 2 else None) for number in range(12)),
    *(_row(TUBE, BARE, number) for number in range(3)),
    _row(CUP, WIDE_CUT), _row(CUP, NARROW_CUT), _row(CUP, WIDE_CUT, 1),
    _row(CUP, ALIKE | SHIFTED), _row(CUP, {}), _row(CUP, SHIFTED), _row(CUP, {}, 1),
]  # fmt: skip
