"""Processes whose mean lies outside their limits: where it makes no part that is said, elsewhere something is left."""

from __future__ import annotations

import math

import numpy as np
from b3_160 import NOMINAL
from grids import for_each

from flexlash.schema.variant import Limits, Variant
from flexlash.tolerance.dimension_limits import distributions, shape_problems

PART = Variant(
    row=2, name="B3-160", flexspline_type="cup", material="20Cr2Ni4", tolerance_class="own", dimensions=NOMINAL
)


def _around(dimension, half, shift, sd):
    size = NOMINAL[dimension]
    return {dimension: Limits(low=size - half, high=size + half, mean_shift=shift, sd=sd)}


IMPOSSIBLE = {
    "a wall of less than nothing": _around("wall_thickness", 1e-3, -3e-3, 3e-6),
    "a hub at the rim": _around("disk_inner_radius", 15e-3, 41e-3, 1e-4),
    "a Poisson's ratio above a half": _around("poisson_ratio", 0.15, 0.25, 0.003),
    "both radii of the disk past one another": _around("disk_inner_radius", 15e-3, 25e-3, 1e-4)
    | _around("mean_radius", 10e-3, -15.1e-3, 1e-4),
}


@for_each("case", IMPOSSIBLE)
def test_a_mean_that_makes_no_part_is_impossible(case):
    """Limits alone would pass; a normal around such a mean has next to nothing where parts are."""
    problems = shape_problems(PART, IMPOSSIBLE[case])[1]
    assert [problem.kind for problem in problems] == ["impossible"]


@for_each("sd", [1e-6, 1e-4, 5e-3])
@for_each("shift", [-24e-3, -14e-3, 0.0, 14e-3, 39e-3, 39.99e-3])
def test_what_is_cut_off_leaves_the_mean(shift, sd):
    """Wherever a mean makes a part the tail beyond it is cut, never the mean itself."""
    kept, problems = shape_problems(PART, _around("disk_inner_radius", 15e-3, shift, sd))
    assert {problem.kind for problem in problems} <= {"cut"}
    law = distributions(kept)["disk_inner_radius"]
    middle = law.location + law.scale * law.standard(np.array([0.05, 0.5, 0.95]))
    assert np.all((middle > 0) & (middle < NOMINAL["mean_radius"]))
    assert math.isclose(middle[1], NOMINAL["disk_inner_radius"] + shift, abs_tol=2 * sd)
