"""The charts of the page: true to scale, within their frame, told in words, whatever the numbers and names are."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import pytest
from grids import for_each

from flexlash.report.pictures.chart import Cause, Spread, causes_chart, density_chart, shares_chart, spread_chart
from flexlash.report.pictures.drawing import Scale, number

SVG = "{http://www.w3.org/2000/svg}"
WHERE = {"rect": ("x", "width"), "line": ("x1", "x2"), "text": ("x",)}


def spread(variant="cup", *, low=3.0, median=3.5, high=4.0, limit=3.8, verdict="fails"):
    """Return a variant as the chart takes it."""
    return Spread(variant=variant, low=low, median=median, high=high, limit=limit, verdict=verdict)


def _wide(above, width):
    """Return a variant from so much above 3 on, so wide."""
    return spread(f"at {3 + above:g}", low=3 + above, median=3 + above + width / 2, high=3 + above + width)


def drawn(markup):
    """Return the elements of a picture."""
    return list(ElementTree.fromstring(markup.inline()).iter())  # noqa: S314  # our own


def parts(markup, tag):
    """Return the elements of one kind, without the namespace."""
    return [one for one in drawn(markup) if one.tag == SVG + tag]


def per_cent(one, name):
    """Return a coordinate that is in per cent of the width."""
    value = one.get(name)
    assert value.endswith("%") or value == "0", f"{name}={value} is not in per cent"
    return float(value.rstrip("%"))


def texts(markup):
    """Return what is written in a picture, without what is told where one points."""
    return [one.text for one in parts(markup, "text")]


def faults(markup):
    """Return what is beyond the frame, or by what a strict policy would not show the picture."""
    found = []
    root = drawn(markup)[0]
    for one in drawn(markup):
        found += [f"{one.tag} has {name}" for name in one.attrib if name == "style" or name.startswith("on")]
        tag = one.tag.removeprefix(SVG)
        at = [per_cent(one, name) for name in WHERE.get(tag, ())]
        ends = [at[0], sum(at)] if tag == "rect" else at
        found += [f"{tag} at {end} %" for end in ends if not -0.51 <= end <= 100.51]
        for name in ("y", "y1", "y2"):
            if name in one.attrib and not 0 <= float(one.get(name)) <= float(root.get("height")):
                found.append(f"{tag} at {name}={one.get(name)} of {root.get('height')}")
        if tag == "polygon":
            values = [float(value) for value in re.split(r"[ ,]", one.get("points"))]
            found += [f"polygon at {value}" for value in values if not 0 <= value <= 1000]
    return found


CASES = {
    "one": [spread()],
    "eleven": [_wide(index / 5, 0.2) for index in range(11)],
    "sixty": [_wide(index / 50, 1.0) for index in range(60)],
    "none": [],
    "all equal": [spread(low=3.8, median=3.8, high=3.8)] * 3,
    "all zero": [spread(low=0.0, median=0.0, high=0.0, limit=None, verdict="")] * 2,
    "no limit": [spread(limit=None, verdict="")] * 4,
    "limits of their own": [spread(limit=3.8), spread(limit=9.0, verdict="meets")],
    "huge": [spread(low=1e12, median=2e12, high=3e12, limit=2.5e12)],
    "tiny": [spread(low=1e-12, median=2e-12, high=3e-12, limit=2.5e-12)],
    "far from zero, close together": [spread(low=1000.00001, median=1000.00002, high=1000.00003, limit=1000.00002)],
    "long names": [spread("a very long name of a variant " * 20)] * 2,
    "no numbers": [spread(low=float("nan")), spread(high=float("inf")), spread()],
}


@for_each("case", CASES)
def test_the_chart_of_all_variants_stays_within_its_frame(case):
    """Nothing is drawn beyond the frame and nothing by inline style, from none to sixty variants of any size."""
    assert not faults(spread_chart("c", CASES[case], "′"))


@for_each("case", CASES)
def test_numbers_of_an_axis_are_few_and_differ(case):
    """The axis has two to twelve round numbers that differ and have room beside one another on a telephone."""
    scale = Scale([value for one in CASES[case] for value in (one.low, one.high) if abs(value) < 1e300])
    words = [word for _, word in scale.ticks if word]
    assert 2 <= len(words) <= 12
    assert len(set(words)) == len(words)
    assert sum(len(word) + 1 for word in words) * 8 <= 330


def test_bars_are_true_to_scale():
    """Bar, median and limit stand where their numbers are on the axis."""
    markup = spread_chart("c", [spread(low=3.0, median=3.5, high=4.0, limit=3.8)], "′")
    (bar,) = parts(markup, "rect")
    scale = Scale([3.0, 4.0, 3.8])
    assert per_cent(bar, "x") == pytest.approx(scale.per_cent(3.0), abs=0.01)
    assert per_cent(bar, "x") + per_cent(bar, "width") == pytest.approx(scale.per_cent(4.0), abs=0.02)
    lines = {one.get("stroke-width"): per_cent(one, "x1") for one in parts(markup, "line") if "%" in one.get("x1", "")}
    assert lines["2"] == pytest.approx(scale.per_cent(3.5), abs=0.01)
    assert lines["1.5"] == pytest.approx(scale.per_cent(3.8), abs=0.01)


def test_colours_do_not_stand_alone():
    """Beside every bar the verdict is written, and the limit is told in words."""
    kinds = ("fails", "marginal", "meets")
    markup = spread_chart("c", [spread(f"v{index}", verdict=kind) for index, kind in enumerate(kinds)], "′")
    assert [text for text in texts(markup) if text in kinds] == list(kinds)
    assert "limit 3.8′" in texts(markup)
    assert len({one.get("fill") for one in parts(markup, "rect")}) == 3


def test_limits_of_their_own_are_drawn_at_each_variant():
    """Where limits differ each variant has its own line, and no single one goes through all."""
    markup = spread_chart("c", CASES["limits of their own"], "′")
    dashed = [one for one in parts(markup, "line") if one.get("stroke-dasharray")]
    assert len(dashed) == 2
    assert len({one.get("x1") for one in dashed}) == 2
    assert "dashed: each variant's limit" in texts(markup)


def test_long_names_are_cut_and_told_whole():
    """A long name is cut on the chart and whole where one points at it."""
    name = "a very long name of a variant, number 17, with a rim"
    markup = spread_chart("c", [spread(name)], "′")
    (text,) = [one for one in parts(markup, "text") if one.text.startswith("a very")]
    assert len(text.text) <= 26
    assert text[0].text == name


def test_the_chart_is_told_in_words():
    """A reader by ear hears how many variants, between which numbers, which limit and how many fail."""
    root = drawn(spread_chart("c", CASES["eleven"], "′", of=500))[0]
    assert root.get("role") == "img"
    named = {one.get("id"): one.text for one in root.iter() if one.get("id")}
    assert [*named] == root.get("aria-labelledby").split()
    assert named["c-title"] == "Backlash of the 11 variants that are worst, of 500"
    for words in ("between 3′ and 5.2′", "The limit is 3.8′", "11 of them fail"):
        assert words in named["c-words"]


def test_hostile_names_stay_names():
    """A name of elements is written, never drawn."""
    evil = '"><script>alert(1)</script>'
    for markup in (spread_chart("c", [spread(evil)], "′"), shares_chart("s", "Shares", [(evil, 0.5)])):
        assert evil in "".join(text.text or "" for text in drawn(markup))
        assert not parts(markup, "script")
        assert "<script" not in markup.inline()


def density(limit, heights=(0.1, 0.4, 0.4, 0.1), start=3.0, width=0.25):
    """Return a density as the facts have it."""
    return {"start": start, "width": width, "heights": list(heights), "nominal": start + 2 * width, "limit": limit}


def test_what_is_over_the_limit_has_its_own_colour_and_its_true_area():
    """The density is parted at the limit, also within a bin, and both parts have the area of their units."""
    markup = density_chart("d", density(limit=3.625), "′")
    areas = {one.get("fill"): _area(one.get("points")) for one in parts(markup, "polygon")}
    assert areas["#d55e00"] / sum(areas.values()) == pytest.approx(0.2 + 0.1, abs=1e-3)
    assert "limit 3.625′" in texts(markup)
    assert not faults(markup)


def _area(points):
    pairs = [tuple(map(float, pair.split(","))) for pair in points.split()]
    return abs(sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in zip(pairs, pairs[1:] + pairs[:1], strict=True))) / 2


@for_each("limit, colours, words", [
    (None, ["#0072b2"], "No limit is given."),
    (9.0, ["#0072b2"], "All of it is within the limit of 9′."),
    (1.0, ["#d55e00"], "All of it is over the limit of 1′."),
    (1e9, ["#0072b2"], "All of it is within the limit of 1e+09′."),
])  # fmt: skip
def test_a_density_on_one_side_of_its_limit_has_one_colour(limit, colours, words):
    """Without a limit, or with one beyond the density, there is one colour, and the words say so."""
    markup = density_chart("d", density(limit), "′")
    assert [one.get("fill") for one in parts(markup, "polygon")] == colours
    assert words in parts(markup, "desc")[0].text
    assert not faults(markup)


def test_a_far_limit_does_not_squeeze_the_density():
    """A limit far beside the density is told at the edge on its side, and the density keeps its width."""
    for limit, words in ((1.0, "← limit 1′, far below"), (9.0, "limit 9′, far above →")):
        markup = density_chart("d", density(limit), "′")
        assert words in texts(markup)
        across = [float(pair.split(",")[0]) for one in parts(markup, "polygon") for pair in one.get("points").split()]
        assert max(across) - min(across) > 500


@for_each("heights, width", [((), 0.25), ((0.0, 0.0), 0.25), ((1.0,), 0.0), ((1e-300, 2e-300), 1e-9)])
def test_a_density_of_little_is_drawn_all_the_same(heights, width):
    """No bin, empty bins, a single value and tiny shares make a picture within its frame."""
    assert not faults(density_chart("d", density(3.1, heights, width=width), "′"))


def test_causes_are_drawn_from_the_nominal_backlash():
    """Each cause has a bar to either side of the nominal backlash, as far as it moves it, with its share in words."""
    causes = [Cause(name="Young's modulus", share=0.69, words="69 %", low=6.29, high=6.04),
              Cause(name="wall", share=0.31, words="31 %", low=None, high=None)]  # fmt: skip
    markup = causes_chart("t", causes, 6.16, "′")
    first, second = parts(markup, "rect")
    meeting = per_cent(first, "x"), per_cent(second, "x") + per_cent(second, "width")
    assert meeting[0] == pytest.approx(meeting[1], abs=0.02)
    assert {"Young's modulus", "69 %", "wall", "31 %"} <= set(texts(markup))
    assert not faults(markup)


def test_shares_are_parts_of_the_whole_width():
    """A share of a half is half as wide as the frame."""
    markup = shares_chart("s", "Where the wind-up arises", [("wall", 0.5), ("disk", 0.00001)])
    widths = [per_cent(one, "width") for one in parts(markup, "rect")]
    assert widths[:2] == [100, 50]
    assert "less than 0.1 %" in texts(markup)
    assert not faults(markup)


def test_numbers_keep_the_digits_of_their_step():
    """A number of an axis has the decimals of the axis's step."""
    assert [number(value, 0.05) for value in (3.6, 3.65)] == ["3.60", "3.65"]
    assert number(0.30000000000000004) == "0.3"
