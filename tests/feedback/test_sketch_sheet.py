"""The template's sheet Sketch: every symbol of its drawings has its column, every drawing its words."""

from __future__ import annotations

import io
import math
import zipfile

import openpyxl
import pytest
from defusedxml import ElementTree

from flexlash.feedback.template.sketch_sheet import SKETCH, SYMBOLS, sketches
from flexlash.feedback.template.template_workbook import Filling, template_bytes
from flexlash.feedback.template.upgrade import upgraded
from flexlash.mechanics.sketch.drawing_marks import Label
from flexlash.pipeline import check
from flexlash.schema.columns import DIMENSIONS

C = "{http://schemas.openxmlformats.org/drawingml/2006/chart}"
CUP = {"variant": "A", "material": "20Cr2Ni4", "torque_Nm": 800.0, "cylinder_length_mm": 160.0,
       "mean_radius_mm": 80.0, "wall_thickness_mm": 1.6, "disk_inner_radius_mm": 40.0}  # fmt: skip


@pytest.fixture(scope="module")
def parts():
    """Return the parts of the empty template by name."""
    with zipfile.ZipFile(io.BytesIO(template_bytes())) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def _numbers(series, axis):
    """Return the stored numbers of a series by their place."""
    points = series.find(f"{C}{axis}").iter(f"{C}pt")
    return {int(point.get("idx")): float(point.find(f"{C}v").text) for point in points}


def _charts(parts):
    return [ElementTree.fromstring(parts[f"xl/charts/chart{number}.xml"]) for number in (1, 2, 3)]


def test_every_symbol_of_the_sketches_is_explained():
    """What the three sketches call a dimension stands in the table beneath, beside the label of its column."""
    drawn = {mark.words for drawing in sketches().values() for mark in drawing.marks if isinstance(mark, Label)}
    assert drawn - {*sketches()} <= set(SYMBOLS.values())
    assert {*sketches()} <= drawn
    assert set(SYMBOLS) <= {name for name, column in DIMENSIONS.items() if column.sheet == "Variants"}
    sheet = openpyxl.load_workbook(io.BytesIO(template_bytes()))[SKETCH]
    told = {row[0]: row[1] for row in sheet.iter_rows(min_row=21, values_only=True) if row[0]}
    assert told == {symbol: DIMENSIONS[name].label for name, symbol in SYMBOLS.items()}


def test_what_each_type_asks_of_a_symbol():
    """A cup needs r_ci, a hat r_co, a cylinder no disk at all; mean radius and bore stand for each other."""
    sheet = openpyxl.load_workbook(io.BytesIO(template_bytes()))[SKETCH]
    told = {row[0]: row[2:5] for row in sheet.iter_rows(min_row=21, values_only=True) if row[0]}
    assert told["r_ci"] == ("fill in", "may stay blank", "leave blank")
    assert told["r_co"] == ("may stay blank", "fill in", "leave blank")
    assert told["hub fillet R"] == ("may stay blank", "leave blank", "leave blank")
    assert told["r_m"] == ("this or bore diameter",) * 3
    assert told["Δ"] == ("fill in",) * 3


def test_each_chart_shows_its_drawing(parts):
    """Each chart has the words of its drawing and as many points as axes of equal scale need, stored for viewers."""
    for chart, drawing in zip(_charts(parts), sketches().values(), strict=True):
        series = [*chart.iter(f"{C}ser")]
        words = [one.find(f"{C}tx/{C}v").text for one in series if one.find(f"{C}tx") is not None]
        assert sorted(words) == sorted(mark.words for mark in drawing.marks if isinstance(mark, Label))
        ends = [float(one.get("val")) for scaling in chart.iter(f"{C}scaling") for one in scaling.iter(f"{C}max")]
        assert ends == [round(drawing.width), round(drawing.height)]
        stored = [float(one.text) for cache in chart.iter(f"{C}numCache") for one in cache.iter(f"{C}v")]
        assert len(stored) > 100
        assert 0 <= min(stored) <= max(stored) <= max(ends)


def test_no_series_joins_what_a_corner_parts(parts):
    """Within a series no line begins where the one before it ends, and none turns sharply: smoothed it looks alike."""
    for chart in _charts(parts):
        for series in chart.iter(f"{C}ser"):
            x, y = _numbers(series, "xVal"), _numbers(series, "yVal")
            for place in x:
                if place + 1 not in x and place + 2 in x:
                    assert (x[place], y[place]) != (x[place + 2], y[place + 2])
                if place + 2 in x and place + 1 in x:
                    (a, b), (c, d) = ((x[at + 1] - x[at], y[at + 1] - y[at]) for at in (place, place + 1))
                    assert abs(math.atan2(a * d - b * c, a * c + b * d)) < math.radians(25)


def test_each_sketch_has_words_for_who_cannot_see_it(parts):
    """The alternative text of each chart is the drawing's own title and description."""
    drawing = ElementTree.fromstring(parts["xl/drawings/drawing1.xml"])
    told = [one.get("descr") for one in drawing.iter() if one.get("descr")]
    assert told == [f"{one.title}. {one.description}" for one in sketches().values()]


def test_an_upgrade_makes_it_anew(tmp_path):
    """A filled template upgraded is the same template, and nobody is told that its sketches were left behind."""
    path = tmp_path / "filled.xlsx"
    path.write_bytes(template_bytes(Filling(variants=[CUP])))
    upgrade = upgraded(path)
    assert not [remark for remark in upgrade.remarks if "chart" in remark or SKETCH in remark]
    assert upgrade.data == path.read_bytes()


def test_it_is_no_finding(tmp_path):
    """A sheet Sketch in a submission is neither taken for another sheet nor told of."""
    path = tmp_path / "filled.xlsx"
    path.write_bytes(template_bytes(Filling(variants=[CUP])))
    assert [one.code for one in check(path).findings] == []
