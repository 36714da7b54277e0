"""What differs between two files: nothing that only looks different, and nothing left out."""

from __future__ import annotations

import csv
from dataclasses import replace

import pytest

from flexlash import __version__
from flexlash.comparison.changed_value import Change
from flexlash.comparison.changed_value import equal as is_equal
from flexlash.comparison.difference import changed_results, difference
from flexlash.comparison.sides import side_of
from flexlash.pipeline import check, run
from flexlash.reading.reading_limits import ReadingLimits

LIMITS = ReadingLimits()


def _between(old, new, **options):
    return difference(side_of(old, LIMITS), side_of(new, LIMITS), **options)


def _told(changes):
    return [(change.key, change.old, change.new) for change in changes]


def _spelt(path, header, row):
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, delimiter=";").writerows([header, row])
    return path


@pytest.mark.slow
def test_other_spellings_are_equal(table, sound, tmp_path):
    """Other units, a decimal comma, another order, other letters of a material and blank defaults are no difference."""
    old = table([sound | {"hub_fillet_radius_mm": 0}])
    header = ["notes", "Wall thickness [µm]", *(key for key in sound if key not in {"wall_thickness_mm", "torque_Nm"})]
    values = {key: str(value).replace(".", ",") for key, value in sound.items()}
    values |= {"material": "20CR2NI4", "flexspline_type": "", "cylinder_length_mm": "160,0"}
    row = ["", "1600", *(values[key] for key in header[2:]), "0,8"]
    new = _spelt(tmp_path / "new.csv", [*header, "Torque [kN·m]"], row)
    found = _between(old, new)
    assert found.is_none
    assert (found.common, found.has_results) == (1, False)


ENTERED = [
    ({"wall_thickness_mm": 1.7}, ("wall_thickness_mm", 1.6, 1.7)),
    ({"backlash_limit_arcmin": ""}, ("backlash_limit_arcmin", 3.75, None)),
    ({"rim_length_mm": 20.0, "rim_thickness_mm": 3.2}, ("rim_length_mm", None, 20.0)),
    ({"notes": "new"}, ("notes", None, "new")),
    ({"flexspline_type": "cylinder", "disk_inner_radius_mm": ""}, ("flexspline_type", "cup", "cylinder")),
    ({"material": "40CrNiMoA"}, ("material", "20Cr2Ni4", "40CrNiMoA")),
    ({"torque_Nm": "much"}, ("torque_Nm", 800.0, "much")),
]


@pytest.mark.slow
@pytest.mark.parametrize(("change", "expected"), ENTERED)
def test_what_was_entered_is_told(table, sound, change, expected):
    """Each changed cell of a row is told by its key, old and new in printed units; other rows are not."""
    other = sound | {"variant": "other"}
    found = _between(table([sound, other], "a.csv"), table([sound | change, other], "b.csv"))
    (one,) = found.variants
    assert one.name.text == "B3-160"
    assert expected in _told(one.entered)
    assert not one.used


@pytest.mark.slow
def test_a_row_that_cannot_be_computed_any_more_says_why(table, sound):
    """A cell that says the same but stops its row is told by the row's error."""
    found = _between(table([sound], "a.csv"), table([sound | {"wall_thickness_mm": "1,6 mm"}], "b.csv"))
    (one,) = found.variants
    assert (one.entered, _told(one.results)) == ([], [("status", "yes", "no, E202 G2")])


@pytest.mark.slow
def test_a_row_that_its_tolerances_stop_says_why(workbook, sound):
    """Limits that make no part stop a row as well, though each of its cells is sound."""
    wide = {"tolerance_class": "wide", "dimension": "wall_thickness", "lower_deviation": -2, "upper_deviation": 2}
    rows = [sound | {"tolerance_class": "wide"}]
    narrow = workbook(rows, "a.xlsx", tolerances=[wide | {"lower_deviation": -0.1, "upper_deviation": 0.1}])
    (one,) = _between(narrow, workbook(rows, "b.xlsx", tolerances=[wide])).variants
    (told,) = one.results
    assert (told.old, told.new[:4]) == ("yes", "no, ")
    assert check(workbook(rows, "b.xlsx", tolerances=[wide])).counts["computed"] == 0


@pytest.mark.slow
def test_tolerances_of_dimensions_that_a_variant_lacks_do_not_matter(workbook, sound):
    """A row for a rim changes nothing for a variant without one."""
    rows = [sound | {"tolerance_class": "fine"}]
    rim = {"tolerance_class": "fine", "dimension": "rim_length", "grade": "IT12"}
    old, new = (workbook(rows, f"{grade}.xlsx", tolerances=[rim | {"grade": grade}]) for grade in ("IT12", "IT11"))
    assert _between(old, new).is_none


@pytest.mark.slow
def test_renamed_rows_are_removed_and_added(table, sound):
    """Variants are matched by name, case as written."""
    rows = [sound | {"variant": name} for name in ("a", "b")]
    found = _between(table(rows, "a.csv"), table([rows[0], sound | {"variant": "B"}], "b.csv"))
    assert ([name.text for name in found.removed], [name.text for name in found.added]) == (["b"], ["B"])
    assert (found.common, found.variants, found.is_none) == (1, [], False)


STEEL = {"material": "mine", "youngs_modulus_GPa": 210.0, "poisson_ratio": 0.3, "yield_MPa": 900.0}
WALL = {"tolerance_class": "fine", "dimension": "wall_thickness", "lower_deviation": -0.05, "upper_deviation": 0.05}
SHARED = {
    "material": ({"materials": [STEEL | {"youngs_modulus_GPa": 206.0}]}, ("youngs_modulus", 210.0, 206.0)),
    "strength": ({"materials": [STEEL | {"yield_MPa": None}]}, ("yield", 900.0, None)),
    "tolerance": (
        {"tolerances": [WALL | {"upper_deviation": 0.1}]},
        ("wall_thickness", "± 0.05 mm", "−0.05 to +0.1 mm"),
    ),
    "grade": (
        {"tolerances": [WALL | {"lower_deviation": None, "upper_deviation": None, "grade": "IT8"}]},
        ("wall_thickness", "± 0.05 mm", "IT8"),
    ),
    "setting": ({"settings": {"disk_calibration": 0.9}}, ("disk_calibration", 1.0, 0.9)),
    "seed": ({"settings": {"seed": 4}}, ("seed", 0, 4)),
}


@pytest.mark.slow
@pytest.mark.parametrize("what", SHARED)
def test_tables_and_settings_are_told_with_who_uses_them(workbook, sound, what):
    """A changed table is one change with the variants that use it; a variant that does not is unchanged."""
    rows = [sound | {"variant": "user", "material": "mine", "tolerance_class": "fine"}, sound]
    filling = {"materials": [STEEL, STEEL | {"material": "20Cr2Ni4"}], "tolerances": [WALL]}
    change, expected = SHARED[what]
    new = filling | change
    new["materials"] = [*new["materials"][:1], STEEL | {"material": "20Cr2Ni4"}]
    found = _between(workbook(rows, "a.xlsx", **filling), workbook(rows, "b.xlsx", **new))
    ((told, names),) = found.shared.items()
    assert (told.key, told.old, told.new) == expected
    assert [name.text for name in names] == (["user", "B3-160"] if told.sheet == "Settings" else ["user"])
    assert not any(one.entered or one.results for one in found.variants)


@pytest.mark.slow
def test_tolerances_in_other_units_are_equal(workbook, sound):
    """Deviations in µm and mm that are the same are no difference, nor is sigma where it has no meaning."""
    rows = [sound | {"tolerance_class": "fine"}]
    flat = WALL | {"distribution": "uniform"}
    other = flat | {"lower_deviation": -50.0, "upper_deviation": 50.0, "deviation_unit": "µm", "limits_sigma": 2}
    old, new = workbook(rows, "a.xlsx", tolerances=[flat]), workbook(rows, "b.xlsx", tolerances=[other])
    assert _between(old, new).is_none


@pytest.fixture
def reports(table, tmp_path):
    """Return a function that makes a report of rows."""

    def make(name, rows, **options):
        run(table(rows, f"{name}.csv"), tmp_path / f"{name}.xlsx", samples=64, **options)
        return tmp_path / f"{name}.xlsx"

    return make


@pytest.mark.slow
def test_two_reports_of_one_submission_do_not_differ(reports, sound):
    """The same rows in another order give no difference, in inputs or results."""
    rows = [sound, sound | {"variant": "b", "wall_thickness_mm": 1.7}]
    found = _between(reports("a", rows), reports("b", rows[::-1]))
    assert (found.is_none, found.has_results, found.common) == (True, True, 2)


@pytest.mark.slow
def test_another_cheapest_change_is_told(sound, workbook, tmp_path):
    """Where the hub may no longer change, the cheapest change that meets the limit is another one, of both in words."""
    sides = []
    for name, levers in (("a", []), ("b", [{"dimension": "disk_inner_radius", "may_change": "no"}])):
        rows = [{**sound, "backlash_limit_arcmin": 3.6}, {**sound, "variant": "fine", "backlash_limit_arcmin": 3.9}]
        run(workbook(rows, f"{name}.xlsx", levers=levers), tmp_path / f"{name}-report.xlsx", samples=64)
        sides.append(side_of(tmp_path / f"{name}-report.xlsx", LIMITS))
    soft, *_ = difference(*sides).variants
    (change,) = soft.results
    assert (soft.name.text, change.label) == (sound["variant"], "Cheapest single change")
    assert change.old.startswith("Hub radius 40 → ")
    assert change.new.startswith(("Cylinder length 160 → ", "Disk thickness", "Wall and disk", "Mean radius 80 → "))
    assert sides[0].changes.keys() == {sound["variant"]}
    assert difference(sides[0], replace(sides[1], changes={})).variants[0].results == []


@pytest.mark.slow
def test_results_are_told_verdict_first(reports, sound):
    """Of two reports the results are compared, those of the verdict first, and a limit that was crossed is told."""
    old = reports("a", [sound | {"backlash_limit_arcmin": 3.9}])
    new = reports("b", [sound | {"backlash_limit_arcmin": 3.9, "wall_thickness_mm": 1.45}])
    (one,) = _between(old, new).variants
    assert _told(one.entered) == [("wall_thickness_mm", 1.6, 1.45)]
    keys = [change.key for change in one.results]
    assert keys[:4] == ["status", "backlash_arcmin", "p97_5_arcmin", "probability_over_limit"]
    assert "backlash_limit_arcmin" not in keys
    assert one.limit == "over"
    assert one.results[2].part == pytest.approx(1.6 / 1.45 - 1, rel=0.3)
    (back,) = _between(new, old).variants
    assert back.limit == "within"


@pytest.mark.slow
def test_another_seed_alone_changes_within_the_error(reports, sound):
    """Where only the seed is another, results are within their errors; where a wall is another, they are not."""
    rows = [sound, sound | {"variant": "b", "torque_Nm": 700.0}]
    old = reports("a", rows)
    found = _between(old, reports("b", rows, seed=9))
    assert [name.text for name in found.within_error] == ["B3-160", "b"]
    assert all(one.results for one in found.variants)
    assert (found.differing, found.is_none) == ([], False)
    changed = _between(old, reports("c", [sound | {"wall_thickness_mm": 1.601}, rows[1]], seed=9))
    assert [one.name.text for one in changed.differing] == ["B3-160"]


@pytest.mark.slow
def test_a_row_that_is_missing_from_results_is_a_difference(reports, sound):
    """A variant whose row somebody took out of Results is told, never equal."""
    old = side_of(reports("a", [sound]), LIMITS)
    (one,) = difference(old, replace(old, results={})).variants
    assert _told(one.results) == [("status", "there", "missing")]


@pytest.mark.slow
def test_tolerance_hides_small_differences(reports, sound):
    """Numbers that differ by less than the given part of themselves are equal; of inputs none is hidden."""
    old, new = reports("a", [sound]), reports("b", [sound], seed=9)
    assert _between(old, new).variants[0].results
    (one,) = _between(old, new, tolerance=0.99999).variants
    assert _told(one.used) == [("seed", 0, 9)]
    assert {change.key for change in one.results} <= {"ppm_over_limit", "probability_over_limit"}


def test_a_column_of_one_alone_is_no_difference():
    """A report of another version may have other columns, which are not compared."""
    old = {"p50_arcmin": 1.0, "mean_arcmin": 1.0, "status": "ok"}
    assert changed_results(old, {"p50_arcmin": 1.0 + 1e-13, "status": "ok"}) == []


PARTS = [(2.0, 3.0, 0.5), (0.0, 1.0, None), (None, 1.0, None), (1.0, None, None), ("a", "b", None)]


@pytest.mark.parametrize(("old", "new", "part"), PARTS)
def test_the_change_as_a_part(old, new, part):
    """A change in per cent needs two numbers, the old one not 0."""
    assert Change(sheet="Results", key="x", label="X", old=old, new=new).part == part


EQUAL = [
    (1.0, 1.0 + 1e-13, True), (1.0, 1.0 + 1e-11, False), (0.0, 1e-300, False), (1, 1.0, True), ("a", "a", True),
    (None, None, True), (None, 0.0, False), (("x", 1.0), ("x", 1.0), True), ((1.0,), (1.0, 2.0), False),
    (((0.1, 0.2), None), ((0.1, 0.2 + 1e-16), None), True),
]  # fmt: skip


@pytest.mark.parametrize(("one", "other", "expected"), EQUAL)
def test_when_values_are_equal(one, other, expected):
    """Numbers may differ by their rounding, alone or in a row; nothing is not 0."""
    assert is_equal(one, other) is expected


@pytest.mark.slow
def test_json_holds_everything(reports, sound):
    """The JSON form names both files, all counts and every change with its per cent."""
    old = reports("a", [sound, sound | {"variant": "gone"}])
    new = reports("b", [sound | {"torque_Nm": 880.0}], seed=1)
    found = _between(old, new).as_dictionary()
    counts = {"common": 1, "differing": 1, "within_error": 0, "equal": 0, "removed": 1, "added": 0}
    assert found["counts"] == counts
    assert (found["new"]["version"], found["new"]["options"]["seed"]) == (__version__, 1)
    assert (found["old"]["file"], found["old"]["kind"], found["new"]["submission"]) == ("a.xlsx", "report", "b.csv")
    assert found["removed"] == ["gone"]
    (one,) = found["variants"]
    assert one["entered"][0]["change_percent"] == pytest.approx(10)
    assert one["used"][0]["key"] == "seed"
    assert {change["key"] for change in one["results"]} > {"backlash_arcmin", "p97_5_arcmin"}
