"""Limits of many variants at once are those of each, to the bit."""

from __future__ import annotations

import math

import numpy as np
from grids import for_each

from flexlash.schema.variant import ToleranceRow, Variant
from flexlash.tolerance.dimension_limits import limits_of
from flexlash.tolerance.limit_arrays import limits_alike, varying

ROWS = {
    "a grade on a radius": {"dimension": "mean_radius", "grade": "h7"},
    "a grade on a thickness": {"dimension": "wall_thickness", "grade": "IT9"},
    "a general tolerance": {"dimension": "wall_thickness", "grade": "2768-m"},
    "per cent": {"dimension": "wall_thickness", "relative": True, "lower": -0.01, "upper": 0.02, "mean_shift": 0.001},
    "a shift alone": {"dimension": "wall_thickness", "lower": 1e-5, "upper": 1e-5},
}


@for_each("case", ROWS)
def test_many_have_the_limits_of_each(case):
    """Grades of each one's own diameter, per cent of its size; NaN where no table has the grade."""
    row = ToleranceRow(row=3, tolerance_class="own", **ROWS[case])
    sizes = np.array([0.0002, 0.0016, 0.0031, 0.0799, 0.0251, 2.4, 40.0])
    together = limits_alike({row.dimension: sizes}, [row])[row.dimension]
    assert varying({row.dimension: sizes}, [row]) == {row.dimension}
    for place, size in enumerate(sizes.tolist()):
        variant = Variant(
            row=2,
            name="V",
            flexspline_type="cup",
            material="m",
            tolerance_class="own",
            dimensions={row.dimension: size},
        )
        limits, problems = limits_of(variant, [row])
        found = together.low[place], together.high[place], together.mean[place], together.sd[place]
        if problems:
            assert all(map(math.isnan, found))
        else:
            alone = limits[row.dimension]
            sd = alone.standard_deviation if alone.low < alone.high else 0.0
            assert found == (alone.low, alone.high, alone.mean, sd)
