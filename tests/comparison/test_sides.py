"""What is compared of a file: the meaning of its cells, in the template's units, whatever their spelling."""

from __future__ import annotations

import openpyxl
import pytest
import regenerate

from flexlash.comparison.sides import Name, by_variant, result_rows, side_of
from flexlash.pipeline import run
from flexlash.reading.raw import Percentage, RawSheet
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal

LIMITS = ReadingLimits()
STUDY = regenerate.ROOT / "data" / "b3-160-study.xlsx"


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """Return the study's outcome and the path of its report."""
    path = tmp_path_factory.mktemp("study") / "r.xlsx"
    return run(STUDY, path, samples=64), path


@pytest.mark.slow
def test_a_report_and_its_submission_say_the_same(study):
    """Read back from the report, entries, materials, tolerances and settings are those of the submission."""
    report, submission = side_of(study[1], LIMITS), side_of(STUDY, LIMITS)
    assert (report.is_report, submission.is_report) == (True, False)
    assert report.entries() == submission.entries()
    for name in report.records:
        assert report.material(name) == submission.material(name)
        assert report.tolerances(name) == submission.tolerances(name)
    assert report.settings == submission.settings | {"samples": 64}


@pytest.mark.slow
def test_results_of_a_report_are_those_of_its_run(study):
    """Every number of Results comes back by key, to the digits that the sheet keeps of it."""
    outcome, path = study
    found = side_of(path, LIMITS).results
    assert [name.text for name in found] == outcome.results["variant"].to_list()
    for name, row in zip(found, outcome.results.iter_rows(named=True), strict=True):
        assert found[name].keys() == row.keys()
        for key, value in row.items():
            shortened = "standard_error" in key or "share" in key
            close = {"rel": 1e-3, "abs": 0.51e-4} if shortened else {"rel": 1e-14, "abs": 0}
            assert found[name][key] == (pytest.approx(value, **close) if isinstance(value, float) else value)


def test_defaults_and_faults(table, sound):
    """Blank cells have their default, a fillet of 0 is none, faulty cells stand as entered or as they must be meant."""
    changes = {"flexspline_type": "", "hub_fillet_radius_mm": 0, "wall_thickness_mm": "1,6 mm", "torque_Nm": "much"}
    (found,) = side_of(table([sound | changes]), LIMITS).entries().values()
    assert found["flexspline_type"] == "cup"
    assert found["tolerance_class"] == "standard"
    assert found["hub_fillet_radius_mm"] is None
    assert found["wall_thickness_mm"] == 1.6
    assert found["torque_Nm"] == "much"


def test_rows_of_one_name_stay_apart(table, sound):
    """Rows of one name, and rows without one, are counted."""
    side = side_of(table([sound, sound, sound | {"variant": ""}]), LIMITS)
    assert list(side.records) == [Name(text="B3-160"), Name(text="B3-160", occurrence=2), Name(text="")]
    assert [bool(side.hindrance(name)) for name in side.records] == [True, True, True]
    assert side.hindrance(Name(text="B3-160")) == "E308 A2"


def test_a_variant_has_the_dimensions_of_its_record(table, sound):
    """A sound variant has those dimensions that it does not take from another; a faulty one none."""
    side = side_of(table([sound, sound | {"variant": "b", "torque_Nm": "much"}]), LIMITS)
    own = side.dimensions(Name(text="B3-160"))
    assert {"wall_thickness", "mean_radius", "youngs_modulus"} <= own
    assert not own & {"disk_thickness", "bore_diameter", "rim_length"}
    assert side.dimensions(Name(text="b")) == frozenset()


TOLERANCES = [
    ({"grade": "IT9"}, "IT9"),
    ({"lower_deviation": -0.05, "upper_deviation": 0.05}, "± 0.05 mm"),
    ({"lower_deviation": -50, "upper_deviation": 100, "deviation_unit": "µm"}, "−0.05 to +0.1 mm"),
    ({"lower_deviation": 0, "upper_deviation": 2, "deviation_unit": "%"}, "0 to +2 %"),
    ({"grade": "h9", "distribution": "uniform", "limits_sigma": 2}, "h9, uniform"),
    ({"grade": "h9", "limits_sigma": 2}, "h9, limits at ± 2 sigma"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("row", "words"), TOLERANCES)
def test_tolerances_are_shown_as_a_drawing_gives_them(workbook, sound, row, words):
    """Grades by name, deviations signed in the dimension's unit, other than usual distributions in words."""
    rows = [{"tolerance_class": "fine", "dimension": "wall_thickness", **row}]
    side = side_of(workbook([sound | {"tolerance_class": "fine"}], tolerances=rows), LIMITS)
    assert side.tolerances(Name(text="B3-160")).values["wall_thickness"].shown == words


def test_unknown_names_use_nothing(table, sound):
    """A material or class that is unknown has no values to compare."""
    side = side_of(table([sound | {"material": "cheese", "tolerance_class": "loose"}]), LIMITS)
    assert side.material(Name(text="B3-160")) is None
    assert side.tolerances(Name(text="B3-160")) is None


NO_RESULTS = {
    "no sheet": None,
    "no keys": RawSheet(name="Results", rows={1: {1: "Variant", 2: "Status"}}),
    "keys far below": RawSheet(name="Results", rows={16: {1: "variant", 2: "status"}}),
}


@pytest.mark.parametrize("what", NO_RESULTS)
def test_results_that_cannot_be_read(what):
    """A Results sheet without its row of keys is a refusal."""
    with pytest.raises(Refusal) as refusal:
        result_rows(NO_RESULTS[what])
    assert refusal.value.code == "E122"


def test_cells_of_results_are_taken_by_their_column():
    """A percentage is a number, a text in a column of numbers is nothing, unknown columns are left out."""
    rows = {2: {1: "variant", 2: "status", 3: "disk_share", 4: "mean_arcmin", 5: "mine"}}
    rows[3] = {1: 7, 2: "ok", 3: Percentage(0.25), 4: "x", 5: 1}
    assert result_rows(RawSheet(name="Results", rows=rows)) == {
        Name(text="7"): {"variant": "7", "status": "ok", "disk_share": 0.25, "mean_arcmin": None}
    }


@pytest.mark.slow
def test_a_table_that_is_none_is_refused(study, tmp_path):
    """A text without the template's headers is refused, and so is a report whose inputs were taken out."""
    (tmp_path / "letter.csv").write_text("Dear Sir,\nthe gear, it broke\n", encoding="utf-8")
    with pytest.raises(Refusal) as refusal:
        side_of(tmp_path / "letter.csv", LIMITS)
    assert refusal.value.code == "E109"
    with study[1].open("rb") as file:
        book = openpyxl.load_workbook(file)
    del book["Carried"]
    book.save(tmp_path / "without.xlsx")
    with pytest.raises(Refusal) as refusal:
        side_of(tmp_path / "without.xlsx", LIMITS)
    assert refusal.value.code == "E121"


BACK = {
    "as it was": (["a", "b"], ["a", "b"]),
    "escapes come back as letters": (["a_x0041_", "_x005F_x000D_", "x005F_"], ["aA", "\r", ""]),
    "escapes come back as they were": (["a_x0041_", "_x005F_x000D_", "x005F_"],) * 2,
    "sorted since": (["a", "b", "A"], ["b", "A", "a"]),
    "equal names": (["a", "a", "aA", "a_x0041_"], ["a", "a", "aA", "aA"]),
}


@pytest.mark.parametrize("what", BACK)
def test_rows_of_results_find_their_variants(what):
    """Rows belong to the variant of their name, though a sheet may give back some names changed."""
    names, read = BACK[what]
    places = [read.index(name) if sorted(names) == sorted(read) else place for place, name in enumerate(names)]
    rows = {Name(text=text, occurrence=read[:at].count(text) + 1): {"at": at} for at, text in enumerate(read)}
    wanted = [Name(text=text, occurrence=names[:at].count(text) + 1) for at, text in enumerate(names)]
    found = by_variant(rows, wanted)
    expected = list(range(len(names))) if what == "equal names" else places
    assert [found[name]["at"] for name in wanted] == expected


def test_rows_of_no_variant_keep_their_name():
    """A row whose name somebody changed belongs to no variant."""
    rows = {Name(text="mine"): {"at": 0}}
    assert by_variant(rows, [Name(text="a")]) == rows
