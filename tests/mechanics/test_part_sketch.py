"""The sketch of a part: the half-section that elasticity computes, each symbol once, and its SVG."""

import numpy as np
import pytest
from defusedxml import ElementTree
from half_sections import CONE, CUP, FILLETS, HAT, RIM, TAPER, TUBE, WEIGHTS, jacobians, random_shapes

from flexlash.mechanics.elasticity.half_section import half_section
from flexlash.mechanics.elasticity.part import part_of
from flexlash.mechanics.sketch.drawing_marks import Area, Label, Stroke, hatching
from flexlash.mechanics.sketch.half_outline import outlines
from flexlash.mechanics.sketch.part_sketch import part_sketch
from flexlash.mechanics.sketch.sketch_svg import svg

FACE = {"tooth_face_width": 0.15}
SHAPES = {
    "cup": ("cup", CUP),
    "cup with everything": ("cup", CUP | FILLETS | RIM | FACE | {"disk_thickness": 0.05, "disk_outer_radius": 1.0}),
    "tapered cup": ("cup", CUP | TAPER),
    "conical cup": ("cup", CUP | CONE),
    "cup whose disk misses the wall": ("cup", CUP | {"disk_outer_radius": 1.3}),
    "hat": ("hat", HAT | RIM),
    "cylinder": ("cylinder", TUBE | FACE),
}
SVG = "{http://www.w3.org/2000/svg}"


def _shoelace(points):
    x, y = np.array(points).T
    return abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1))) / 2


@pytest.mark.slow
def test_the_outline_is_the_half_section():
    """The outline of random parts encloses the area of the mesh that elasticity computes, but for its round edges."""
    for kind, dimensions in random_shapes(300, 2):
        part, section = part_of(kind, dimensions), half_section(kind, dimensions)
        (outline,) = outlines(part, dimensions.get("disk_outer_radius", part.mean))
        mesh = float(jacobians(section).sum(axis=0) @ WEIGHTS @ WEIGHTS)
        assert _shoelace(outline) == pytest.approx(mesh, rel=0.01), (kind, dimensions)
        for places, nodes in zip(np.array(outline).T, (section.height, section.radius), strict=True):
            assert (places.min(), places.max()) == pytest.approx((np.nanmin(nodes), np.nanmax(nodes)), abs=1e-9)


@pytest.mark.parametrize("shape", SHAPES)
def test_it_is_to_scale(shape):
    """Lengths and radii have one scale: cylinder length and wall thickness, as drawn, are in their true ratio."""
    kind, dimensions = SHAPES[shape]
    drawing = part_sketch(kind, dimensions)
    outline = max((mark.points for mark in drawing.marks if isinstance(mark, Stroke) and mark.width > 1), key=max)
    end = max(x for x, _ in outline)
    bore = max(y for x, y in outline if x == end)
    part = part_of(kind, dimensions)
    axis = next(mark.points[0][1] for mark in drawing.marks if isinstance(mark, Stroke) and mark.dashed)
    scale = (axis - bore) / part.bore
    thickness = part.rim_outside - part.bore if part.has_step else part.wall
    assert bore - min(y for x, y in outline if x == end) == pytest.approx(scale * thickness)
    assert drawing.width > end > scale * part.length


SAID = {
    "cup": {"l 1200", "r_m 1000", "Δ 30", "t = Δ", "r_ci 400"},
    "cup with everything": {"l 1200", "r_m 1000", "Δ 30", "t 50", "r_ci 400", "r_co 1000", "rim length 200", "rim 70",
                            "tooth face 150", "hub fillet R 50", "junction fillet R 150"},
    "tapered cup": {"l 1200", "r_m 1000", "Δ 30", "t_hub 100 … 50", "r_ci 400"},
    "conical cup": {"l 1200", "r_m 1000", "Δ 30", "t = Δ", "r_ci 400", "cone 30°"},
    "cup whose disk misses the wall": {"l 1200", "r_m 1000", "Δ 30", "t = Δ", "r_ci 400", "r_co 1300"},
    "hat": {"l 1200", "r_m 1000", "Δ 30", "t 50", "r_co 1500", "rim length 200", "rim 70"},
    "cylinder": {"l 1200", "r_m 1000", "Δ 30", "tooth face 150"},
}  # fmt: skip


@pytest.mark.parametrize("shape", SHAPES)
def test_every_dimension_is_named_once_within_the_picture(shape):
    """Each dimension that was entered stands in the sketch with its size in mm, inside it and in its words."""
    kind, dimensions = SHAPES[shape]
    drawing = part_sketch(kind, dimensions, name="A & B")
    said = [mark.words for mark in drawing.marks if isinstance(mark, Label)]
    assert sorted(said) == sorted(SAID[shape])
    assert all(words in drawing.description for words in said)
    for mark in drawing.marks:
        for x, y in [(mark.x, mark.y)] if isinstance(mark, Label) else mark.points:
            assert 0 <= x <= drawing.width
            assert 0 <= y <= drawing.height
    assert drawing.title == "Half-section of A & B"


def test_a_bore_is_drawn_as_entered():
    """Where the bore was entered it is the bore that the sketch names, and no mean radius."""
    drawing = part_sketch("cylinder", {"bore_diameter": 0.16, "wall_thickness": 0.0016, "cylinder_length": 0.1})
    said = {mark.words for mark in drawing.marks if isinstance(mark, Label)}
    assert said == {"bore ø 160", "l 100", "Δ 1.6"}


def test_symbols_stand_without_sizes():
    """What explains the template shows its symbols alone."""
    kind, dimensions = SHAPES["cup with everything"]
    drawing = part_sketch(kind, dimensions, with_sizes=False)
    said = {mark.words for mark in drawing.marks if isinstance(mark, Label)}
    assert said == {"l", "r_m", "Δ", "t", "r_ci", "r_co", "rim length", "rim", "tooth face", "hub fillet R",
                    "junction fillet R"}  # fmt: skip


@pytest.mark.parametrize("shape", SHAPES)
def test_svg_has_every_mark_and_no_style(shape):
    """The SVG can be parsed, has an element for each mark, words instead of it, and attributes that a policy allows."""
    kind, dimensions = SHAPES[shape]
    drawing = part_sketch(kind, dimensions, name='<script>"&')
    root = ElementTree.fromstring(svg(drawing, "part"))
    assert root.find(f"{SVG}title").text == drawing.title
    assert root.find(f"{SVG}desc").text == drawing.description
    for kind_of_mark, tag in ((Area, "polygon"), (Stroke, "polyline"), (Label, "text")):
        hatches = [line for mark in drawing.marks if isinstance(mark, Area) for line in hatching(mark)]
        marks = [mark for mark in (*drawing.marks, *hatches) if isinstance(mark, kind_of_mark)]
        assert len(root.findall(f"{SVG}{tag}")) == len(marks), tag
    names = {name for element in root.iter() for name in element.attrib}
    assert not {name for name in names if name == "style" or name.startswith("on")}
