"""The table of levers on the screen: every change within the width, aligned, with its reasons below."""

from __future__ import annotations

import re

import polars as pl
import pytest
from told_levers import CASE_1, CASE_3, CONES, NOMINAL_OVER, study_levers

from flexlash.cli.levers_lines import levers_lines
from flexlash.report.wording.lever_words import change_words, shown_levers
from flexlash.schema.angle_unit import ARC_MINUTES


@pytest.fixture
def results():
    """Return what is needed of the Results of the study."""
    row = {"p97_5_arcmin": 4.28, "backlash_limit_arcmin": 3.8, "probability_over_limit_low": None,
           "probability_over_limit_high": None}  # fmt: skip
    rows = [row | {"variant": CASE_1, "probability_over_limit": 5.07e-5},
            row | {"variant": CASE_3, "probability_over_limit": 1.0},
            row | {"variant": "free", "backlash_limit_arcmin": None, "probability_over_limit": None}]  # fmt: skip
    ends = dict.fromkeys(("probability_over_limit_low", "probability_over_limit_high"), pl.Float64)
    return pl.DataFrame(rows, schema_overrides=ends).with_columns(
        pl.col("probability_over_limit").alias("probability_over_limit_low"),
        pl.col("probability_over_limit").alias("probability_over_limit_high"),
    )


@pytest.mark.parametrize("width", [60, 80, 120, 200])
def test_every_change_is_on_the_screen_within_its_width(results, width):
    """Whatever the width, no line is longer; each change is there with its share, each reason once."""
    lines = [text for text, _ in levers_lines(results, study_levers(), width, ARC_MINUTES)]
    assert max(map(len, lines)) <= width
    whole = " ".join(" ".join(lines).split())
    for lever in shown_levers(study_levers()).to_dicts():
        words = change_words(lever)
        assert words[1:10] in whole
    assert whole.count(NOMINAL_OVER) == 1
    assert whole.count(f"note: {CONES}") == 1
    assert "1 variant has no backlash limit: there is nothing to meet." in whole


def test_numbers_stand_below_their_headings(results):
    """On a broad screen each number ends where its heading ends, with the digits of the report."""
    lines = [text for text, _ in levers_lines(results, study_levers(), 200, ARC_MINUTES)]
    heading = next(line for line in lines if "ppm over" in line)
    hub = next(line for line in lines if "Hub radius 40 → 46 mm" in line)
    for name, number in (("ppm over", "320"), ("mass %", "-1.4"), ("MPa", "65.0"), ("cost", "12.0")):
        end = heading.index(name) + len(name)
        assert re.search(r"\S+$", hub[:end])[0] == number


def test_colours_name_the_cheapest_and_what_cannot(results):
    """The cheapest change is green, what to mind yellow, what cannot do it pale."""
    looks = {look: text for text, look in levers_lines(results, study_levers(), 200, ARC_MINUTES)}
    assert "Hub radius" in looks["green"]
    assert CONES in looks["yellow"]
    assert NOMINAL_OVER in looks["bright_black"]


def test_a_narrow_screen_leaves_out_numbers_from_the_right(results):
    """At sixty characters costs and bending give way, the share over the limit and the rank stay."""
    lines = [text for text, _ in levers_lines(results, study_levers(), 60, ARC_MINUTES)]
    assert not any("cost" in line for line in lines)
    assert any(line.startswith("  1 Hub radius 40 → 46 mm") and "320" in line for line in lines)
