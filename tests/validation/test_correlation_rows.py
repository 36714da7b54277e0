"""Rows of Correlations: every fault at its cell, its class waits, and nothing sound is blamed."""

from __future__ import annotations

from itertools import combinations

import pytest
from entry_books import CUP, UNIFORM_CUP, correlations, entry_book

from flexlash.pipeline import check

FINE = [row | {"tolerance_class": "Fine"} for row in UNIFORM_CUP]
VARIANTS = [CUP, CUP | {"variant": "finer", "tolerance_class": "Fine"}]
WALL, DISK, LENGTH = "wall_thickness", "disk_thickness", "cylinder_length"
SCATTERING = [row["dimension"] for row in UNIFORM_CUP if row["dimension"] not in {"youngs_modulus", "poisson_ratio"}]


@pytest.fixture
def judged(tmp_path):
    """Return a function that checks rows of Correlations beside two variants of two classes."""

    def of(*rows):
        sheets = {"variants": VARIANTS, "tolerances": [*UNIFORM_CUP, *FINE], "correlations": rows}
        return check(entry_book(tmp_path / "study.xlsx", **sheets))

    return of


def _found(outcome):
    """Return code and place of what was found, built-in tables aside."""
    return [(found.code, found.place) for found in outcome.findings if found.code != "I505"]


def test_every_pair_of_scattering_dimensions_is_sound(judged):
    """All pairs at small correlations, in two classes and spelt as people spell them, give no finding."""
    rows = correlations(*((*pair, 0.1) for pair in combinations(SCATTERING, 2)))
    rows += correlations((" Wall thickness ", "DISK_THICKNESS", -0.25, "Fine"), (WALL, LENGTH, 0, "Fine"))
    outcome = judged(*rows)
    assert {code for code, _ in _found(outcome)} <= {"I504", "I506"}
    read = [(row.tolerance_class, row.first, row.second, row.correlation) for row in outcome.validated.correlation_rows]
    assert len(read) == len(rows)
    assert read[-2:] == [("Fine", WALL, DISK, -0.25), ("Fine", LENGTH, WALL, 0.0)]


def test_an_empty_sheet_says_nothing(judged):
    """Headers alone tie nothing and are no fault."""
    outcome = judged({"tolerance_class": None, "dimension_1": None, "dimension_2": None, "correlation": None})
    assert _found(outcome) == []
    assert outcome.validated.correlation_rows == ()


@pytest.mark.parametrize(
    ("row", "found"),
    [
        pytest.param((WALL, DISK, 1.01), ("E208", "D2"), id="above 1"),
        pytest.param((WALL, DISK, -1.01), ("E207", "D2"), id="below -1"),
        pytest.param((WALL, DISK, "half"), ("E202", "D2"), id="no number"),
        pytest.param((WALL, DISK, None), ("E201", "D2"), id="no correlation"),
        pytest.param((WALL, None, 0.5), ("E201", "C2"), id="no second dimension"),
        pytest.param((None, WALL, 0.5), ("E201", "B2"), id="no first dimension"),
        pytest.param(("wal_thickness", DISK, 0.5), ("E209", "B2"), id="misspelt"),
        pytest.param((WALL, "backlash_limit", 0.5), ("E209", "C2"), id="a requirement"),
        pytest.param((WALL, WALL, 0.5), ("E346", "C2"), id="with itself"),
        pytest.param((WALL, "torque", 0.5), ("E347", "C2"), id="second exact"),
        pytest.param(("rim_length", WALL, 0.5), ("E347", "B2"), id="first exact"),
    ],
)
def test_a_fault_is_told_at_its_cell_and_its_class_waits(judged, row, found):
    """One fault gives one finding, and the variant of the other class alone is computed."""
    keys = ("tolerance_class", "dimension_1", "dimension_2", "correlation")
    outcome = judged(dict(zip(keys, ("shop", *row), strict=True)))
    code, cell = found
    assert _found(outcome) == [(code, f"Correlations!{cell}")]
    assert outcome.results["status"].to_list() == ["error", "ok"]
    assert "Row 2 of Variants waits for class shop." in next(
        one.message for one in outcome.findings if one.code == code
    )


def test_two_exact_dimensions_are_both_told(judged):
    """Where neither dimension of a pair scatters each of their cells has its finding."""
    outcome = judged(*correlations(("torque", "rim_length", 0.5)))
    assert _found(outcome) == [("E347", "Correlations!B2"), ("E347", "Correlations!C2")]


def test_limits_that_coincide_do_not_scatter(tmp_path):
    """A row whose deviations are equal leaves its dimension exact; a grade scatters it."""
    exact = {"tolerance_class": "shop", "dimension": "torque", "lower_deviation": 1, "upper_deviation": 1}
    graded = {"tolerance_class": "shop", "dimension": "disk_outer_radius", "grade": "IT7"}
    rows = correlations((WALL, "torque", 0.5), (WALL, "disk_outer_radius", 0.5))
    sheets = {"variants": [CUP], "tolerances": [*UNIFORM_CUP, exact, graded], "correlations": rows}
    outcome = check(entry_book(tmp_path / "study.xlsx", **sheets))
    assert [place for code, place in _found(outcome) if code == "E347"] == ["Correlations!C2"]


def test_a_pair_that_stands_twice_is_told_at_both_rows(judged):
    """The order of the two dimensions does not make another pair, nor letter case another class; a class does."""
    outcome = judged(*correlations((WALL, DISK, 0.5), (DISK, WALL, 0.6, "SHOP"), (WALL, DISK, 0.5, "Fine")))
    told = [(found.code, found.place) for found in outcome.findings if found.code == "E345"]
    assert told == [("E345", "Correlations!C2"), ("E345", "Correlations!C3")]
    assert "is also in C3" in next(found.message for found in outcome.findings if found.code == "E345")
    assert outcome.results["status"].to_list() == ["error", "ok"]


@pytest.mark.parametrize(
    ("name", "suggestion", "statuses"),
    [("shopp", "shop", ["error", "ok"]), ("Fnie", "Fine", ["ok", "error"]), ("press", "", ["ok", "ok"])],
)
def test_an_unknown_class_is_told_and_the_one_it_may_mean_waits(judged, name, suggestion, statuses):
    """A class that Tolerances lacks is an error; what resembles it is suggested, and its variants wait."""
    outcome = judged(*correlations((WALL, DISK, 0.5, name)))
    assert _found(outcome) == [("E309", "Correlations!A2")]
    assert next(found.suggestion for found in outcome.findings if found.code == "E309") == suggestion
    assert outcome.results["status"].to_list() == statuses


def test_another_spelling_of_a_class_is_repaired(judged):
    """Letter case and spaces of a class do not matter, which is told."""
    outcome = judged(*correlations((WALL, DISK, 0.5, " FINE")))
    assert _found(outcome) == [("I504", "Correlations!A2")]
    assert [row.tolerance_class for row in outcome.validated.correlation_rows] == ["Fine"]


@pytest.mark.parametrize("name", [None, "n/a"])
def test_a_row_without_a_class_is_told(judged, name):
    """Without a class nobody knows which variants a row is about: none is computed where it is blank."""
    outcome = judged({"tolerance_class": name, "dimension_1": WALL, "dimension_2": DISK, "correlation": 0.5})
    assert [code for code, _ in _found(outcome)] == ["E201" if name is None else "E221"]
    assert outcome.results["status"].to_list() == (["error", "error"] if name is None else ["ok", "ok"])


def test_a_class_with_faults_of_its_own_is_not_said_to_be_exact(tmp_path):
    """Where a row of Tolerances is faulty it may have been that of the dimension: nothing is said of the pair."""
    broken = [UNIFORM_CUP[0] | {"lower_deviation": "x"}, *UNIFORM_CUP[1:]]
    sheets = {"variants": [CUP], "tolerances": broken, "correlations": correlations((LENGTH, WALL, 0.5))}
    outcome = check(entry_book(tmp_path / "study.xlsx", **sheets))
    assert _found(outcome) == [("E202", "Tolerances!C2")]


@pytest.mark.parametrize("row", [(WALL, DISK, 2.0), (WALL, "torque", 0.5), (WALL, WALL, 0.5)])
def test_what_is_based_on_a_class_with_a_faulty_pair_waits_too(tmp_path, row):
    """A class takes over the pairs of its base: without the faulty one its spread would be that of others."""
    based = [{"tolerance_class": "own", "based_on": "Mid"}, {"tolerance_class": "mid", "based_on": "SHOP"}]
    torque = {"tolerance_class": "own", "dimension": "torque", "lower_deviation": -1, "upper_deviation": 1}
    variants = [
        CUP,
        CUP | {"variant": "own", "tolerance_class": "own"},
        CUP | {"variant": "f", "tolerance_class": "Fine"},
    ]
    sheets = {"variants": variants, "tolerances": [*UNIFORM_CUP, *FINE, *based, torque]}
    outcome = check(entry_book(tmp_path / "study.xlsx", **sheets, correlations=correlations(row)))
    assert outcome.results["status"].to_list() == ["error", "error", "ok"]
    assert "Row 3 of Variants waits for class own." in " ".join(one.message for one in outcome.findings)
