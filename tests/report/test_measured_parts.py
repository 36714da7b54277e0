"""What the Summary and the pages say of what measured parts leave open."""

from __future__ import annotations

import re
from types import SimpleNamespace

import numpy as np
import openpyxl
import polars as pl
import pytest
from grids import for_each
from said import said_of

from flexlash.analysis.run_summary import limit_lines
from flexlash.pipeline import run
from flexlash.report.page.page_facts import Found, page_facts
from flexlash.report.report_data import report_data
from flexlash.report.results_sheet import FIRST_ROW
from flexlash.report.wording.measured_parts import PARTS, how_left_open, left_open_by, left_open_words
from flexlash.schema.angle_unit import ARC_MINUTES
from flexlash.schema.limit_verdict import VerdictBounds
from flexlash.schema.variant import Limits, MeasuredDimension

CLASS = """tolerance_class,dimension,lower_deviation,upper_deviation,deviation_unit,sample
standard,wall_thickness,-0.02,0.02,mm,lot
standard,youngs_modulus,-0.5,0.5,%,
"""


@pytest.fixture
def told(table, sound, tmp_path):
    """Return a function that spreads variants with these limits by so many measured walls, and gives the outcome."""

    def tell(count, *limits, sample="lot", output=None):
        wall = float(sound["wall_thickness_mm"])
        values = np.random.default_rng(4).standard_normal(count)
        values = wall + 0.004 * (values - values.mean()) / values.std(ddof=1)
        lines = [f"lot,{part},{value:.6f}" for part, value in enumerate(values, start=1)]
        measurements, tolerances = tmp_path / "measured.csv", tmp_path / "classes.csv"
        measurements.write_text("\n".join(["sample,part,wall_thickness_mm", *lines]), encoding="utf-8")
        tolerances.write_text(CLASS.replace(",lot", f",{sample}"), encoding="utf-8")
        rows = [{**sound, "variant": f"v{place}", "backlash_limit_arcmin": limit} for place, limit in enumerate(limits)]
        for row in rows:
            row.pop("tolerance_class", None)
        return run(table(rows), output, tolerances=tolerances, measurements=measurements)

    return tell


def facts_of(*counts):
    """Return facts of a variant of which these numbers of parts were measured, by dimension."""
    limits = {}
    for name, count in zip(("wall_thickness", "disk_thickness"), counts, strict=False):
        sample = MeasuredDimension(
            sample="s", dimension=name, values=tuple(map(float, range(count))), parts=tuple(range(count))
        )
        limits[name] = Limits(low=0.0, high=1.0, sd=1.0, sample=sample)
    return SimpleNamespace(
        computed=lambda _: SimpleNamespace(limits=limits), bounds=VerdictBounds(), angles=ARC_MINUTES
    )


def row(share, low, high, limit=3.8):
    """Return a Results row with a share over the limit and what measured parts leave open of it."""
    return {
        "backlash_limit_arcmin": limit,
        "probability_over_limit": share,
        "probability_over_limit_low": share * 0.999,
        "probability_over_limit_high": share * 1.001,
        "probability_over_limit_sample_low": low,
        "probability_over_limit_sample_high": high,
        "p99_865_arcmin": 3.71,
        "p99_865_standard_error_arcmin": 1e-5,
        "p99_865_sample_low_arcmin": 3.69,
        "p99_865_sample_high_arcmin": 3.74,
    }


def test_a_verdict_that_holds_at_both_ends_is_told_so():
    """Where the whole interval has one verdict, nothing is left open of it."""
    assert " ".join(left_open_by(facts_of(60, 60), row(118e-6, 12e-6, 8e-4))) == (
        "Units over the limit are 118 ppm by calculation; 60 measured parts (wall thickness and disk thickness) leave "
        "open 12 to 800 ppm (95 %). At either end the verdict is “meets”."
    )


def test_a_verdict_that_is_left_open_says_what_it_may_be_and_how_many_parts_would_settle_it():
    """The other verdicts are named, and the parts are those that draw the score's interval in to the bound."""
    said = " ".join(left_open_by(facts_of(60, 24), row(118e-6, 2e-6, 4e-3)))
    assert "60 measured parts (wall thickness) and 24 measured parts (disk thickness) leave open 2 ppm to 0.4 %" in said
    assert "So the verdict “meets” may as well be “marginal”." in said
    # Scores 3.6777 now, 2.6521 at the end and 3.0000 where “meets” ends: (1.0256/0.6777)² = 2.29.
    assert said.endswith("About 2.3 times as many parts would settle it, if they scatter as these do.")


@for_each(
    "case",
    [
        (0.01, 1e-3, 0.04, "may as well be “meets” or “fails”."),
        (0.01, 3e-3, 0.04, "may as well be “fails”."),
        (1e-5, 0.0, 0.03, "may as well be “marginal” or “fails”."),
    ],
)
def test_every_verdict_within_the_interval_is_named(case):
    """A verdict between the ends is named, too."""
    share, low, high, words = case
    assert words in " ".join(left_open_by(facts_of(60), row(share, low, high)))


def test_what_lies_at_the_bound_is_never_settled():
    """No number of parts is named where the share lies within a thousandth of the bound."""
    said = " ".join(left_open_by(facts_of(60), row(0.001351, 1e-4, 1e-2)))
    assert said.endswith("no number of parts would settle it.")


def test_an_interval_without_units_is_told_as_such():
    """Where the calculation finds no unit over the limit and measured parts leave none open, both are said at once."""
    assert " ".join(left_open_by(facts_of(60), row(1e-13, 0.0, 1e-11))) == (
        "Units over the limit are practically none by calculation, and whatever 60 measured parts (wall thickness) "
        "leave open (95 %). At either end the verdict is “meets”."
    )


def test_without_a_limit_the_percentile_is_told():
    """A variant without a limit has no verdict, its P99.865 has an interval."""
    none = {**row(0.1, None, None, limit=None), "probability_over_limit": None}
    assert " ".join(left_open_by(facts_of(60), none)) == (
        "99.865 % of units stay below 3.710′ by calculation; 60 measured parts (wall thickness) leave open 3.690′ to "
        "3.740′ (95 %)."
    )
    assert not left_open_words(none)


def test_what_was_not_measured_is_not_spoken_of(study):
    """The study has no measured parts: neither Summary nor About speak of them."""
    outcome, _ = study
    assert PARTS not in said_of(outcome)
    assert not list(how_left_open(outcome.results))
    assert not list(left_open_by(facts_of(60), {"p99_865_sample_low_arcmin": None}))


def test_verdicts_left_open_come_first(told):
    """Of several variants that is told whose verdict may change; the numbers are those of Results."""
    outcome = told(20, 4.0, 3.723, 3.75)
    ends = ["probability_over_limit_sample_low", "probability_over_limit_sample_high"]
    assert outcome.results.select(pl.all_horizontal(pl.col(ends).is_not_null())).to_series().all()
    said = said_of(outcome)[PARTS]
    doubtful = outcome.results.filter((pl.col(ends[0]) <= 0.00135) & (pl.col(ends[1]) > 0.00135))["variant"].to_list()
    named = re.findall(r"“(v\d)”", said)
    assert named == doubtful == ["v1"]
    assert said.endswith("More lines or points do not narrow this; more measured parts do.")
    assert len(list(how_left_open(outcome.results))) == 3


def test_a_class_without_its_sample_has_no_interval(told):
    """The same class with an ordinary row for the wall tells no interval."""
    outcome = told(20, 3.75, sample="")
    assert outcome.results["p99_865_sample_low_arcmin"].null_count() == 1
    assert PARTS not in said_of(outcome)


def test_explorer_and_results_show_what_is_left_open(told, tmp_path):
    """The Explorer tells it of the picked variant, the worst; Results shows the ends in digits that tell them apart."""
    report = tmp_path / "report.xlsx"
    outcome = told(20, 3.723, output=report)
    (found,) = outcome.results.to_dicts()
    book = openpyxl.load_workbook(report, data_only=True)
    assert book["Explorer"]["A18"].value == "Left open by measured parts"
    assert book["Explorer"]["B18"].value == left_open_words(found)
    keys = {cell.value: cell.column for cell in book["Results"][2]}
    for key in ("probability_over_limit_sample_low", "probability_over_limit_sample_high"):
        cell = book["Results"].cell(row=FIRST_ROW + 1, column=keys[key])
        assert cell.value == pytest.approx(found[key])
        decimals = len(cell.number_format.rstrip("%").partition(".")[2])
        assert 0.01 < 10.0**-decimals / (100 * found[key]) <= 0.1


def test_the_terminal_and_the_page_tell_it_of_a_variant_that_fails(told):
    """The line of a failing variant ends with it; the page of a variant has it as a sentence and as numbers."""
    outcome = told(20, 3.7)
    (found,) = outcome.results.to_dicts()
    assert list(limit_lines(outcome))[1].endswith(f"; its measured parts leave open {left_open_words(found)}.")
    facts = page_facts(outcome, Found.of(outcome, ran=True), ran=True, data=report_data(outcome))
    (page,) = facts["variants"]
    sentences = {one["topic"]: one["text"] for one in page["sentences"]}
    assert f"leave open {left_open_words(found)} (95 %)" in sentences[PARTS]
    assert {key for key in found if "_sample_" in key} <= {one["key"] for one in page["numbers"]}
    assert {one["topic"]: one["text"] for one in facts["sentences"]}[PARTS] == said_of(outcome)[PARTS]


def test_the_only_variant_has_no_others(told):
    """Of one variant it is not said that the same holds for all."""
    said = said_of(told(60, 3.9))[PARTS]
    assert "verdict is" in said
    assert "The same holds" not in said
