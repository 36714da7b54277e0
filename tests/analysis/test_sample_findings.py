"""Samples that tell little, or that no normal process makes: a warning at each row that uses them."""

from __future__ import annotations

import pytest
from measured_parts import HEADERS, measured_rows, scattered

from flexlash.analysis.examination import examined
from flexlash.analysis.options import Options
from flexlash.analysis.sample_findings import report_samples
from flexlash.pipeline import check
from flexlash.reading.read import Source
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.schema.columns import columns_of
from flexlash.validation.ledger import Ledger

_HEADERS = [
    "Tolerance class",
    "Dimension",
    "Lower deviation",
    "Upper deviation",
    "Deviation unit",
    "Distribution",
    "Sample",
]


@pytest.fixture
def warned(book, sound):
    """Return a function that gives code, cell and message of the warnings of samples."""

    def read(values, distribution=None, classes=("shop",)):
        label = {key: column.label for key, column in columns_of("Variants").items()}
        variants = [sound | {"variant": name, "tolerance_class": name} for name in classes]
        sheet = [[label[key] for key in variants[0]], *(list(row.values()) for row in variants)]
        tolerances = [_HEADERS, *([name, "wall_thickness", -0.1, 0.1, "mm", distribution, "wall"] for name in classes)]
        rows = [["wall", number, None, value] for number, value in enumerate(values)]
        outcome = check(book({"Variants": sheet, "Tolerances": tolerances, "Measurements": [HEADERS, *rows]}))
        return [(one.code, one.cell, one.message) for one in outcome.findings if one.code in {"W445", "W447"}]

    return read


def _lopsided(count):
    """Return values of which the logarithm of the deviation is normal."""
    from math import exp

    return [1.6 + 0.004 * exp(0.8 * score) for score in scattered(count, 0.0, 1.0)]


def test_few_parts_are_told_with_what_they_leave_open(warned):
    """Ten parts leave the standard deviation between 0.69 and 1.83 times what they show."""
    ((code, cell, message),) = warned(scattered(10))
    assert (code, cell) == ("W445", "G2")
    assert "10 values of wall thickness" in message
    assert "between 0.69 and 1.83 times" in message


def test_values_that_are_not_normal(warned):
    """A lopsided sample is told where it is taken as normal, cut or not, and not where it is taken as measured."""
    for distribution, told in ((None, True), ("normal", True), ("truncated normal", True), ("measured", False)):
        found = warned(_lopsided(60), distribution)
        assert [one[:2] for one in found] == ([("W447", "G2")] if told else [])
    assert "p below 0.0001" in warned(_lopsided(60))[0][2]
    assert warned(scattered(60)) == []


def test_a_coarse_gauge_is_named(warned):
    """Values of three steps fit no curve because of the gauge, which the message says."""
    found = warned([round(value, 2) for value in scattered(60)])
    assert [one[:2] for one in found] == [("W447", "G2")]
    assert "only 3 different values" in found[0][2]


def test_each_row_of_a_class_is_told(warned):
    """Two classes that use one sample are told at their rows."""
    assert [one[:2] for one in warned(scattered(10), classes=("shop", "other"))] == [("W445", "G2"), ("W445", "G3")]


def test_a_sample_with_errors_is_not_judged(warned):
    """What is left of a sample with an error says nothing of it."""
    values = _lopsided(60)
    values[3] = "x"
    assert warned(values) == []


def test_measured_rows_are_sound():
    """The helper's rows have the issue's mean and standard deviation."""
    from statistics import mean, stdev

    walls = [row[3] for row in measured_rows()]
    assert (mean(walls), stdev(walls)) == (pytest.approx(1.607, abs=1e-12), pytest.approx(0.0041, rel=1e-12))


def test_a_row_that_classes_take_over_is_told_once(book, sound):
    """Few parts are told at the row that takes them, however many classes are based on its own."""
    entered = {columns_of("Variants")[key].label: value for key, value in (sound | {"tolerance_class": "new"}).items()}
    classes = [
        [*_HEADERS, "Based on class"],
        ["shop", "wall_thickness", -0.1, 0.1, "mm", None, "wall", None],
        *([name, None, None, None, None, None, None, "shop"] for name in ("new", "newer")),
    ]
    rows = [["wall", number, None, value] for number, value in enumerate(scattered(10))]
    sheets = {"Variants": [list(entered), list(entered.values())], "Tolerances": classes}
    source = Source.at(book({**sheets, "Measurements": [HEADERS, *rows]}), ReadingLimits())
    validated = examined(source, Options()).validated
    ledger = Ledger.after(validated)
    report_samples(validated, ledger)
    assert [(found.code, found.cell) for found in ledger.findings] == [("W445", "G2")]
