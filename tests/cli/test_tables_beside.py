"""Measured parts and correlations from files beside a submission, of the template or a table."""

from __future__ import annotations

import csv
import json
import sys
from dataclasses import replace

import pytest
from measured_parts import scattered

from flexlash.analysis.options import TABLES, Options
from flexlash.batch.manifest import options_digest
from flexlash.cli import cli, main
from flexlash.pipeline import check, levers, run
from flexlash.reading.read import Source
from flexlash.report.carried_sheet import carried_text

_LIMITS = {"tolerance_class": "shop", "dimension": "wall_thickness", "lower_deviation": -0.02, "upper_deviation": 0.02}


@pytest.fixture
def beside(table):
    """Return the files of tolerances and of sixty measured walls."""
    rows = [{"Sample": "wall", "Part": part, "Wall thickness [mm]": value} for part, value in enumerate(scattered(60))]
    tolerances = table([_LIMITS | {"sample": "wall"}], name="tolerances.csv")
    return {"tolerances": tolerances, "measurements": table(rows, name="measured.csv")}


@pytest.fixture
def main_in(monkeypatch):
    """Return a function that runs `main` in this process and gives its exit code."""

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["flexlash", *map(str, arguments)])
        with pytest.raises(SystemExit) as stop:
            main()
        return stop.value.code or 0

    return call


def _numbers(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.slow
def test_a_table_with_measured_parts(table, sound, beside, tmp_path, main_in):
    """A CSV submission takes mean and standard deviation of the walls from --measurements, as if they were entered."""
    submission = table([sound | {"tolerance_class": "shop"}])
    options = [one for name, path in beside.items() for one in (f"--{name}", path)]
    assert main_in("run", submission, *options, "-o", tmp_path / "measured-results.csv") == 0
    entered = table([_LIMITS | {"mean_shift": 0.007, "standard_deviation": 0.0041}], name="entered.csv")
    assert main_in("run", submission, "--tolerances", entered, "-o", tmp_path / "entered-results.csv") == 0
    (measured,), (known,) = (_numbers(tmp_path / f"{name}-results.csv") for name in ("measured", "entered"))
    assert float(measured["mean_arcmin"]) == pytest.approx(float(known["mean_arcmin"]), rel=1e-9)
    assert float(measured["sd_arcmin"]) == pytest.approx(float(known["sd_arcmin"]), rel=1e-6)
    assert f"{float(measured['p50_arcmin']):.4f}" == "3.6709"
    assert float(measured["mean_arcmin"]) == pytest.approx(3.670938 * (1 + (0.0041 / 1.607) ** 2), rel=2e-6)


def test_findings_of_a_file_beside(table, sound, beside, capsys, main_in):
    """What is wrong in the file is told at its cell, as it stands in that file."""
    rows = _numbers(beside["measurements"])
    rows[4]["Wall thickness [mm]"] = "16.05"
    rows[9]["Wall thickness [mm]"] = "x"
    table(rows, name="measured.csv")
    options = [one for name, path in beside.items() for one in (f"--{name}", path)]
    submission = table([sound | {"tolerance_class": "shop"}])
    assert main_in("check", submission, *options, "--json") == 4
    found = json.loads(capsys.readouterr().out)["findings"]
    assert [(one["code"], one["sheet"], one["cell"]) for one in found if one["sheet"] == "Measurements"] == [
        ("W446", "Measurements", "C6"),
        ("E202", "Measurements", "C11"),
    ]


def test_a_file_goes_before_the_sheet(book, sound, beside):
    """Parts of a file take the place of a workbook's own."""
    variant = sound | {"tolerance_class": "shop"}
    own = [["Sample", "Wall thickness [mm]"], ["wall", 5.0]]
    sheets = {"Variants": [list(variant), list(variant.values())], "Measurements": own}
    outcome = check(book(sheets), **beside)
    assert [one for one in outcome.findings if one.level == "error"] == []
    assert len(outcome.validated.measured["wall"]["wall_thickness"].values) == 60


def test_correlations_beside(table, sound, beside):
    """--correlations is read as the sheet Correlations."""
    rows = [
        {"tolerance_class": "shop", "dimension_1": "wall_thickness", "dimension_2": "disk_thicknes", "correlation": 0.5}
    ]
    outcome = check(table([sound | {"tolerance_class": "shop"}]), **beside, correlations=table(rows, name="tied.csv"))
    assert [(one.sheet, one.cell) for one in outcome.findings if one.code == "E209"] == [("Correlations", "C2")]


@pytest.mark.parametrize("name", ["measurements", "correlations"])
def test_a_file_that_is_not_there(table, sound, tmp_path, main_in, name):
    """A file that cannot be opened ends the run with code 5."""
    assert main_in("check", table([sound]), f"--{name}", tmp_path / "none.csv") == 5
    with pytest.raises(OSError, match="none"):
        run(table([sound]), **{name: tmp_path / "none.csv"})


def test_what_was_measured_counts_among_what_outputs_depend_on(tmp_path):
    """--resume computes anew where the measured parts are others; where they lie does not matter."""
    tables = {"Measurements": Source(name="a.csv", data=b"1")}
    digest = options_digest(Options(measurements="x/a.csv"), tables, marked=False)
    assert digest == options_digest(Options(measurements=tmp_path / "a.csv"), tables, marked=False)
    assert digest != options_digest(Options(), {"Measurements": Source(name="a.csv", data=b"2")}, marked=False)
    assert set(Options(**dict.fromkeys(TABLES, "a.csv")).without_tables(jobs=3).tables) == set()


def test_a_file_without_samples_is_one_by_its_name(table, sound, tmp_path):
    """What a machine writes of one sample needs no column for it; lines around the parts are none of them."""
    lines = ["Protocol 7;;", "Part;Wall thickness;Disk thickness", ";mm;mm"]
    lines += [f"{part};{value:.6f};{value:.6f}".replace(".", ",") for part, value in enumerate(scattered(60), start=1)]
    (tmp_path / "lathe 3.csv").write_text("\n".join([*lines, ";;", "measured by hand;;"]), encoding="utf-8")
    tolerances = table([_LIMITS | {"sample": "Lathe 3"}], name="tolerances.csv")
    files = {"tolerances": tolerances, "measurements": tmp_path / "lathe 3.csv"}
    outcome = check(table([sound | {"tolerance_class": "shop"}]), **files)
    assert [one for one in outcome.findings if one.level == "error"] == []
    (told,) = (one for one in outcome.findings if one.code == "I532")
    assert told.message == "lathe 3.csv has no column Sample: its parts are the sample lathe 3."
    measured = outcome.validated.measured
    assert list(measured) == ["lathe3"]
    assert len(measured["lathe3"]["wall_thickness"].values) == 60
    assert outcome.counts["computed"] == 1


def test_headers_in_other_words_are_questions(table, sound, tmp_path):
    """A machine's own headers are asked for one by one, and nothing else of the file is blamed."""
    lines = ["Protocol;;", "Teil;Wanddicke;Bodendicke", ";mm;mm", *(f"{part};1,607;1,6" for part in range(9))]
    (tmp_path / "lathe 3.csv").write_text("\n".join(lines), encoding="utf-8")
    tolerances = table([_LIMITS | {"sample": "lathe 3"}], name="tolerances.csv")
    files = {"tolerances": tolerances, "measurements": tmp_path / "lathe 3.csv"}
    outcome = check(table([sound | {"tolerance_class": "shop"}]), **files)
    errors = [one for one in outcome.findings if one.level == "error"]
    assert [(one.code, one.cell, one.suggestion) for one in errors] == [
        ("E112", "B2", "Wall thickness Δ [mm]"),
        ("E112", "C2", "Disk thickness [mm]"),
    ]


def test_a_sheet_of_a_workbook_must_name_its_samples(book, sound):
    """The name of a workbook is that of a submission; its sheet Measurements says which sample a part is of."""
    rows = [["Part", "Wall thickness [mm]"], *([part, value] for part, value in enumerate(scattered(60)))]
    outcome = check(book({"Variants": [list(sound), list(sound.values())], "Measurements": rows}))
    assert [one.code for one in outcome.findings if one.sheet == "Measurements"] == ["E111"]


@pytest.mark.slow
def test_the_target_of_a_table_is_an_option(table, workbook, sound, main_in):
    """--target-percent is to a table what the setting is to a workbook, and the report carries it."""
    row = {**sound, "backlash_limit_arcmin": 3.75}
    entered = run(workbook([row], settings={"target_percent": 97.5}), samples=64)
    submission = table([row])
    given = run(submission, target_percent=97.5, samples=64)
    assert given.settings == replace(entered.settings, samples=64)
    assert [outcome.counts["meets"] for outcome in (given, entered, run(submission, samples=64))] == [1, 1, 0]
    assert json.loads(carried_text(given))["options"]["target_percent"] == 97.5
    _, changes = levers(submission, target_percent=97.5, samples=64)
    assert set(changes["direction"]) == {"relax"}
    for command in ("run", "levers", "sweep", "distribution"):
        assert "--target-percent" in [name for one in cli.commands[command].params for name in one.opts]
    with pytest.raises(ValueError, match=r"target_percent = 90: a number from 97\.5 to 99\.9999 is required"):
        run(submission, target_percent=90)
    assert main_in("run", submission, "--target-percent", "100") == 2
