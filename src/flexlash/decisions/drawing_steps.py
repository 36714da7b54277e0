"""What a drawing says: values in decimal steps, and what steps cost."""

from __future__ import annotations

import math
from decimal import Decimal

from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.decision_rows import LeverRow
from flexlash.schema.units import as_entered

__all__ = ["drawing_step", "on_drawing", "relative_cost", "tolerance_step"]

_THICKNESSES = frozenset({"wall_thickness", "disk_thickness", "disk_hub_thickness", "rim_thickness"})
_LENGTH, _THICKNESS, _ANGLE, _EXPONENT, _TORQUE = 0.5, 0.01, 0.5, 0.05, 1.0
_TOLERANCE = 0.001

_ROUNDING = 1e-9
"""Part of a step by which a value may miss a multiple of it and still be one."""


def drawing_step(dimension: str, row: LeverRow | None) -> float:
    """Return the step of the drawing's values of a dimension, in the unit of its column.

    >>> drawing_step("disk_inner_radius", None), drawing_step("hub_fillet_radius", None)
    (0.5, 0.01)
    """
    column = DIMENSIONS[dimension]
    if row is not None and row.step is not None:
        return as_entered(row.step, column.si_unit.si)
    if dimension in _THICKNESSES or column.zero_is_blank:
        return _THICKNESS
    return {"length": _LENGTH, "angle": _ANGLE, "torque": _TORQUE}.get(column.quantity, _EXPONENT)


def tolerance_step(dimension: str) -> float:
    """Return the step of half the width of a dimension's limits, in the unit of its column: 1 µm of a length.

    >>> tolerance_step("wall_thickness"), tolerance_step("disk_cone_angle")
    (0.001, 0.05)
    """
    quantity = DIMENSIONS[dimension].quantity
    return {"length": _TOLERANCE, "angle": _ANGLE / 10, "torque": _TORQUE / 10}.get(quantity, _EXPONENT / 10)


def on_drawing(value: float, step: float, *, upwards: bool) -> float:
    """Return the next multiple of a step at or above a value, or at or below it, as a decimal number.

    >>> on_drawing(45.84, 0.5, upwards=True), on_drawing(1.817, 0.01, upwards=True), on_drawing(1.6, 0.01, upwards=True)
    (46.0, 1.82, 1.6)
    """
    steps = value / step
    count = math.ceil(steps - _ROUNDING) if upwards else math.floor(steps + _ROUNDING)
    return float(count * Decimal(repr(step)))


def relative_cost(from_value: float, to_value: float, step: float, row: LeverRow | None) -> float:
    """Return what it costs to go from one value to another, in steps of the drawing.

    >>> relative_cost(40.0, 46.0, 0.5, None)
    12.0
    """
    steps = abs(to_value - from_value) / step
    return float(f"{steps:.12g}") * (1.0 if row is None else row.cost_per_step)
