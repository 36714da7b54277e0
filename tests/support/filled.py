"""A row without a fault, and the template filled with rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import pytest

from flexlash.feedback.template.template_workbook import Filling, template_bytes

__all__ = ["SOUND", "filled"]

SOUND: dict[str, Any] = {
    "variant": "B3-160",
    "flexspline_type": "cup",
    "material": "20Cr2Ni4",
    "torque_Nm": 800.0,
    "cylinder_length_mm": 160.0,
    "mean_radius_mm": 80.0,
    "wall_thickness_mm": 1.6,
    "disk_inner_radius_mm": 40.0,
    "backlash_limit_arcmin": 3.75,
}
"""A Variants row without a fault."""


def filled(rows: Sequence[Mapping[str, Any]], **filling: Any) -> bytes:
    """Return the template filled with rows, and other sheets by keyword.

    It has few prepared rows: writing and opening the usual two thousand takes seconds.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("flexlash.feedback.template.entry_rules.PREPARED_ROWS", 12)
        patch.setattr("flexlash.feedback.template.entry_rules.SIDE_ROWS", 12)
        return template_bytes(Filling(variants=rows, **filling))
