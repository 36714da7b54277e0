"""The sketch on the page of a variant: the drawing of its part, whatever its name."""

import json

import pytest

from flexlash.mechanics.sketch.part_sketch import part_sketch
from flexlash.mechanics.sketch.sketch_svg import svg
from flexlash.report.page.sketch_facts import sketch_facts
from flexlash.schema.variant import Variant
from flexlash.service.web.variant_page import sketch_picture

CUP = {"cylinder_length": 0.16, "mean_radius": 0.08, "wall_thickness": 0.0016, "disk_inner_radius": 0.04,
       "hub_fillet_radius": 0.0035, "rim_length": 0.025, "rim_thickness": 0.0032}  # fmt: skip


@pytest.mark.parametrize("name", ["B3-160", '<script>alert("1")</script>&'])
def test_the_page_draws_what_was_drawn(name):
    """Told as JSON and drawn by the page, a sketch is the SVG of the drawing itself."""
    variant = Variant(row=7, name=name, flexspline_type="cup", material="", tolerance_class="", dimensions=CUP)
    told = json.loads(json.dumps(sketch_facts(variant, name)))
    drawn = svg(part_sketch("cup", CUP, name=name))
    assert sketch_picture(told) == drawn
    assert "<script" not in drawn
