"""What changed of classes, samples and correlations is told in words, once for all variants that use it."""

from __future__ import annotations

from dataclasses import replace

import pytest
from made_up_parts import LIMIT, SAMPLE, measured_parts

from flexlash.comparison.difference import difference
from flexlash.comparison.difference_lines import difference_lines
from flexlash.comparison.sides import side_of
from flexlash.feedback.template import entry_rules
from flexlash.feedback.template.template_workbook import template_bytes
from flexlash.pipeline import run
from flexlash.reading.reading_limits import ReadingLimits

LIMITS = ReadingLimits()
FILLING = measured_parts()
WALLS = "Wall thickness: ± 0.02 mm"
DRAWN = f"Tolerances drawing, {WALLS} → ± 0.02 mm"
OF_SIXTY = f"sample {SAMPLE} of 60 parts (mean 1.607 mm, s 0.0041 mm)"


@pytest.fixture(autouse=True)
def _few_rows(monkeypatch):
    """Few prepared rows, for speed."""
    monkeypatch.setattr(entry_rules, "PREPARED_ROWS", 8)
    monkeypatch.setattr(entry_rules, "SIDE_ROWS", 8)


def _lines(tmp_path, new):
    """Return what is told of the example and a filling that was made of it."""
    paths = [tmp_path / "old.xlsx", tmp_path / "new.xlsx"]
    for path, filling in zip(paths, (FILLING, new), strict=True):
        path.write_bytes(template_bytes(filling))
    return list(difference_lines(difference(*(side_of(path, LIMITS) for path in paths))))


def _with_wall(**process):
    """Return the example whose drawn wall has a process."""
    base, wall, *rest = FILLING.tolerances
    return replace(FILLING, tolerances=[base, {**wall, **process}, *rest])


PROCESSES = {
    "Cp": ({"cp": 1.1}, "limits at ± 3.3 sigma"),
    "Cpk at three sigma": ({"cp": 1.0, "cpk": 0.9}, "Cp 1, Cpk 0.9"),
    "Cp and Cpk": ({"cp": 1.1, "cpk": 0.9}, "Cp 1.1, Cpk 0.9"),
    "mean and deviation": (
        {"mean_shift": -0.003, "standard_deviation": 0.004},
        "sd 0.004 mm, mean shifted by −0.003 mm",
    ),
}


@pytest.mark.parametrize("what", PROCESSES)
def test_a_process_is_told_in_words(tmp_path, what):
    """A process that a class gained is told behind its limits, with who uses it."""
    process, words = PROCESSES[what]
    assert f"{DRAWN}, {words}, used by as drawn" in _lines(tmp_path, _with_wall(**process))


def test_who_scatters_between_lots_is_told(tmp_path):
    """A dimension that became one value for a lot is told as that; what said so already by default is no difference."""
    lots = _with_wall(scatters_between="lots")
    disk = {**lots.tolerances[2], "scatters_between": "lots"}
    rest = [{**row, "scatters_between": "parts"} if "dimension" in row else row for row in lots.tolerances[3:]]
    lines = _lines(tmp_path, replace(lots, tolerances=[*lots.tolerances[:2], disk, *rest]))
    assert f"{DRAWN}, one value a lot, used by as drawn" in lines
    assert not [line for line in lines if line.startswith("Tolerances measured")]


def test_a_part_that_was_left_out_is_told(tmp_path):
    """A sample of one part less is told by its number, mean and standard deviation, and so is the correlation."""
    lines = _lines(tmp_path, replace(FILLING, measurements=FILLING.measurements[1:]))
    (wall,) = [line for line in lines if line.startswith("Tolerances measured, Wall thickness")]
    assert wall.startswith(f"Tolerances measured, {WALLS}, {OF_SIXTY} → ± 0.02 mm, sample {SAMPLE} of 59 parts (mean ")
    (tie,) = [line for line in lines if line.startswith("Correlations")]
    assert tie.startswith("Correlations measured, Wall thickness with Disk thickness: 0.60")
    assert tie.endswith(", used by as measured")


def test_another_name_and_order_of_a_sample_are_no_difference(tmp_path):
    """A sample renamed, and parts in another order, give the same numbers: nothing is told."""
    named = [{**row, "sample": "lot 7"} for row in reversed(FILLING.measurements)]
    classes = [{**row, "sample": "lot 7"} if "sample" in row else row for row in FILLING.tolerances]
    assert _lines(tmp_path, replace(FILLING, measurements=named, tolerances=classes)) == ["No difference in inputs."]


def test_a_correlation_that_went_is_one_of_zero(tmp_path):
    """Without its row of Correlations the class has independent dimensions."""
    lines = _lines(tmp_path, replace(FILLING, correlations=()))
    assert "Correlations drawing, Wall thickness with Disk thickness: 0.5 → 0, used by as drawn" in lines


def test_rows_taken_over_are_as_good_as_own_ones(tmp_path):
    """A class that holds a row itself, which it took over before, is the same class."""
    own = {"tolerance_class": "drawing", "dimension": "mean_radius", "grade": "IT7"}
    assert _lines(tmp_path, replace(FILLING, tolerances=[own, *FILLING.tolerances])) == ["No difference in inputs."]
    other = _lines(tmp_path, replace(FILLING, tolerances=[{**own, "grade": "IT8"}, *FILLING.tolerances]))
    assert "Tolerances drawing, Mean radius: IT7 → IT8, used by as drawn" in other


@pytest.mark.slow
def test_another_seed_differs_within_the_error(tmp_path):
    """Reports that differ by their seed alone agree within the error of the calculation, samples and lots included."""
    path = tmp_path / "parts.xlsx"
    path.write_bytes(template_bytes(FILLING))
    reports = [tmp_path / f"{seed}.xlsx" for seed in (0, 5)]
    for seed, report in zip((0, 5), reports, strict=True):
        run(path, report, seed=seed)
    found = difference(*(side_of(report, LIMITS) for report in reports))
    assert (found.differing, len(found.within_error)) == ([], 2)
    assert any("_sample_" in change.key for one in found.variants for change in one.results)
    assert found.new.results[next(iter(found.new.records))]["backlash_limit_arcmin"] == LIMIT
