"""The status of Tolerances and Correlations says what a row lacks, and is complete where nothing is wrong."""

from __future__ import annotations

import openpyxl
import pytest
from filled import SOUND, filled
from libreoffice import convert_all, needs_libreoffice

from flexlash.feedback.template.entry_rules import FIRST_ROW
from flexlash.pipeline import check
from flexlash.reading.raw import ErrorCell
from flexlash.schema.columns import ENTRY_SHEETS

_STANDARD = 14
"""Rows of class standard, before all others."""

_ROW = {"tolerance_class": "mine", "dimension": "wall_thickness", "lower_deviation": -0.02, "upper_deviation": 0.02}
_GRADE = {"lower_deviation": None, "upper_deviation": None, "grade": "IT9"}
_BASE = {"dimension": None, "lower_deviation": None, "upper_deviation": None, "based_on": "standard"}
_ONE = "only one of limits at ± sigma, standard deviation, Cp and sample counts"
_NO_PROCESS = "a uniform or triangular distribution has no process of its own"

TOLERANCE_ROWS = [
    ({}, "complete"),
    ({"tolerance_class": None}, "tolerance class missing"),
    ({"dimension": None}, "dimension missing"),
    ({"dimension": "wall"}, "dimension is not in its list"),
    ({"dimension": " Wall_thickness "}, "complete"),
    (_GRADE, "complete"),
    (_GRADE | {"dimension": "cylinder_length", "grade": "JS9"}, "complete"),
    (_GRADE | {"grade": "h7"}, "complete"),
    (_GRADE | {"grade": "it9"}, "grade is not in its list"),
    (_GRADE | {"grade": "IT13"}, "grade is not in its list"),
    (_GRADE | {"dimension": "youngs_modulus"}, "a grade for a dimension that has none"),
    (_GRADE | {"dimension": "hub_fillet_radius"}, "a grade for a dimension that has none"),
    ({"grade": "IT9"}, "grade and deviations are both given"),
    (_GRADE | {"upper_deviation": 0.0}, "grade and deviations are both given"),
    (_GRADE | {"grade": None}, "neither grade nor deviations are given"),
    ({"lower_deviation": None}, "lower deviation missing"),
    ({"upper_deviation": None}, "upper deviation missing"),
    ({"lower_deviation": 0.03}, "lower deviation is above upper deviation"),
    ({"lower_deviation": "-0,02"}, "lower deviation is not a number"),
    ({"lower_deviation": 0.02}, "complete"),
    ({"upper_deviation": ErrorCell("#REF!")}, "a cell holds an error"),
    ({"distribution": "gauss"}, "distribution is not in its list"),
    ({"distribution": "Uniform"}, "complete"),
    ({"scatters_between": "batches"}, "scatters between is not in its list"),
    ({"scatters_between": "lots"}, "complete"),
    ({"limits_sigma": 0.4}, "limits at ± sigma is not a number from 0.5 to 100"),
    ({"standard_deviation": 0.0}, "standard deviation is not a number above 0"),
    ({"cp": 101.0}, "Cp is not a number above 0, at most 100"),
    ({"cp": 1.0, "cpk": 101.0}, "Cpk is not a number of at most 100"),
    ({"mean_shift": True}, "mean shift is not a number"),
    ({"mean_shift": -0.005, "standard_deviation": 0.004}, "complete"),
    ({"cp": 1.1, "cpk": 0.9}, "complete"),
    ({"cp": 1.1, "cpk": 1.1}, "complete"),
    ({"cp": 1.1, "cpk": -0.2}, "complete"),
    ({"cpk": 0.9}, "Cpk without Cp"),
    ({"cp": 0.8, "cpk": 0.9}, "Cpk is above Cp"),
    ({"cp": 1.1, "limits_sigma": 3.0}, _ONE),
    ({"cp": 1.1, "sample": "lot 12"}, _ONE),
    ({"distribution": "uniform", "cp": 1.1}, _NO_PROCESS),
    ({"distribution": "Triangular ", "mean_shift": 0.1}, _NO_PROCESS),
    ({"distribution": "uniform", "sample": "lot 12"}, _NO_PROCESS),
    ({"distribution": "uniform", "limits_sigma": 3.0}, "complete"),
    ({"lower_deviation": 0.02, "cp": 1.0}, "both deviations are equal: no process scatters between them"),
    ({"sample": "lot 12", "mean_shift": 0.001}, "a sample has its own mean: no mean shift, no Cpk"),
    ({"sample": "lot 12", "cpk": 1.0}, "Cpk without Cp"),
    ({"distribution": "truncated normal", "mean_shift": 0.001}, "complete"),
    ({"distribution": "measured"}, "a measured distribution without a sample"),
    ({"distribution": "measured", "sample": "lot 12"}, "complete"),
    ({"sample": "Lot 12"}, "complete"),
    ({"sample": "lot 13"}, "sample not in Measurements"),
    (_BASE, "complete"),
    (_BASE | {"based_on": "row 0"}, "complete"),
    (_BASE | {"grade": "IT9"}, "based on class stands alone: nothing else in its row"),
    (_BASE | {"tolerance_class": "two"}, "class is based on another twice"),
    (_BASE | {"tolerance_class": "Two", "based_on": "row 0"}, "class is based on another twice"),
    (_BASE | {"based_on": "nothing"}, "based on class not in Tolerances"),
    (_BASE | {"based_on": "MINE", "tolerance_class": "mine"}, "a class based on itself"),
    ({"based_on": "standard"}, "based on class needs a row without a dimension"),
]

_NO_ROW = "dimension 2 has no row in the class"
_PAIR = {"tolerance_class": "standard", "dimension_1": "wall_thickness", "dimension_2": "disk_thickness"}
CORRELATION_ROWS = [
    (_PAIR | {"tolerance_class": "based", "correlation": 0.6}, "complete"),
    (_PAIR | {"tolerance_class": None, "correlation": 0.6}, "tolerance class missing"),
    (_PAIR | {"tolerance_class": "none", "correlation": 0.6}, "tolerance class not in Tolerances"),
    (_PAIR | {"dimension_1": None, "correlation": 0.6}, "dimension 1 missing"),
    (_PAIR | {"dimension_2": "disk", "correlation": 0.6}, "dimension 2 is not in its list"),
    (_PAIR | {"dimension_2": "Wall_thickness", "correlation": 0.6}, "a dimension with itself"),
    (_PAIR, "correlation missing"),
    (_PAIR | {"correlation": 1.01}, "correlation is not a number from -1 to 1"),
    (_PAIR | {"correlation": "0,6"}, "correlation is not a number from -1 to 1"),
    (_PAIR | {"tolerance_class": "pairs", "correlation": -1.0, "reason": "one set-up"}, "pair used twice"),
    (
        {
            "tolerance_class": "Pairs",
            "dimension_1": "disk_thickness",
            "dimension_2": "wall_thickness",
            "correlation": 0.0,
        },
        "pair used twice",
    ),
    (_PAIR | {"tolerance_class": "row 0", "dimension_2": "mean_radius", "correlation": 1.0}, _NO_ROW),
    (_PAIR | {"tolerance_class": "Based", "dimension_2": "mean_radius", "correlation": 0.5}, "complete"),
    (_PAIR | {"tolerance_class": "standard", "dimension_2": "mean_radius", "correlation": 0.8}, "complete"),
]


def _tolerances():
    rows = [_ROW | {"tolerance_class": f"row {number}"} | change for number, (change, _) in enumerate(TOLERANCE_ROWS)]
    twins = [{**_ROW, "tolerance_class": name} for name in ("twin", "Twin")]
    return [*rows, *twins, *({"tolerance_class": name, "based_on": "standard"} for name in ("based", "pairs"))]


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """Return a template with one row per status, and two of one class and dimension."""
    path = tmp_path_factory.mktemp("filled") / "filled.xlsx"
    measured = [{"sample": "lot 12", "part": str(part), "wall_thickness_mm": 1.6 + part / 1000} for part in range(6)]
    correlations = [row for row, _ in CORRELATION_ROWS]
    path.write_bytes(filled([SOUND], tolerances=_tolerances(), measurements=measured, correlations=correlations))
    return path


def _statuses(path, sheet, first, count):
    cells = openpyxl.load_workbook(path, data_only=True)[sheet]
    return [cells.cell(first + row, len(ENTRY_SHEETS[sheet]) + 1).value for row in range(count)]


def _of_tolerances(path):
    return _statuses(path, "Tolerances", FIRST_ROW + 1 + _STANDARD, len(_tolerances()))


def _of_correlations(path):
    return _statuses(path, "Correlations", FIRST_ROW + 1, len(CORRELATION_ROWS))


def test_stored_status_tells_what_a_row_lacks(path):
    """The stored status names the first thing that a row of Tolerances or Correlations lacks."""
    added = ["class and dimension used twice"] * 2 + ["complete"] * 2
    assert _of_tolerances(path) == [text for _, text in TOLERANCE_ROWS] + added
    assert _of_correlations(path) == [text for _, text in CORRELATION_ROWS]


def test_without_measurements_there_is_no_sample(tmp_path):
    """In a plain template a sample has no sheet to stand on."""
    file = tmp_path / "plain.xlsx"
    file.write_bytes(filled([SOUND], tolerances=[{**_ROW, "sample": "lot 12"}]))
    assert _statuses(file, "Tolerances", FIRST_ROW + 1 + _STANDARD, 2) == ["sample without a sheet Measurements", None]


def test_a_class_may_hold_nothing_but_its_base(tmp_path):
    """A variant may name a class that is only based on another, and a gap above it in Tolerances changes nothing."""
    file = tmp_path / "based.xlsx"
    rows = [SOUND | {"variant": name, "tolerance_class": name} for name in ("shop", "shoq")]
    file.write_bytes(filled(rows, tolerances=[{}, {"tolerance_class": "shop", "based_on": "standard"}]))
    assert _statuses(file, "Variants", FIRST_ROW + 1, 2) == ["complete", "tolerance class not in Tolerances"]
    assert _statuses(file, "Tolerances", FIRST_ROW + 1 + _STANDARD, 2) == [None, "complete"]


@pytest.mark.slow
@needs_libreoffice
def test_the_status_formula_calculates_what_is_stored(path, tmp_path):
    """Recalculated by a spreadsheet program, every status formula gives its stored text."""
    (recalculated,) = convert_all([path], "xlsx", tmp_path)
    assert _of_tolerances(recalculated) == _of_tolerances(path)
    assert _of_correlations(recalculated) == _of_correlations(path)


@pytest.mark.parametrize(("sheet", "statuses"), [("Tolerances", _of_tolerances), ("Correlations", _of_correlations)])
def test_the_status_agrees_with_check(path, sheet, statuses):
    """A row that is complete has no error for `flexlash check`, and every other row has one."""
    first = FIRST_ROW + 1 + (_STANDARD if sheet == "Tolerances" else 0)
    blamed = {finding.row for finding in check(path).findings if finding.level == "error" and finding.sheet == sheet}
    lacking = {first + row for row, text in enumerate(statuses(path)) if text != "complete"}
    assert lacking == blamed
