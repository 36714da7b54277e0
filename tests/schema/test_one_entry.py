"""One column is one entry: a copy of the package with one more entry knows the field everywhere it should."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from functools import cached_property
from pathlib import Path

import openpyxl
import polars as pl
import pytest

import flexlash
from flexlash.schema.columns import VARIANTS

SOURCE = Path(flexlash.__file__).parent
REQUIREMENT = (
    """    _requirement("peak_torque_Nm", "Peak torque [N·m]", "Greatest torque that may occur.", **TORQUE),\n"""
)
DIMENSION = """    _dimension("boss_width_mm", "Boss width [mm]", "Width of the boss behind the disk.", **LENGTH),\n"""
SOUND = {
    "variant": "A",
    "material": "20Cr2Ni4",
    "torque_Nm": 800,
    "cylinder_length_mm": 160,
    "mean_radius_mm": 80,
    "wall_thickness_mm": 1.6,
    "disk_inner_radius_mm": 40,
    "backlash_limit_arcmin": 3.8,
}


class Copy:
    """A copy of the package with one more entry in the Variants, run as its own program in a folder."""

    def __init__(self, folder: Path, entry: str) -> None:
        self.folder = folder
        shutil.copytree(SOURCE, folder / "src" / "flexlash", ignore=shutil.ignore_patterns("__pycache__"))
        columns = folder / "src" / "flexlash" / "schema" / "variant_columns.py"
        before, mark, after = columns.read_text(encoding="utf-8").partition('    _identity(\n        "tolerance_class"')
        columns.write_text(before + entry + mark + after, encoding="utf-8")

    def run(self, *arguments: str, code: int = 0) -> str:
        """Return what a command prints."""
        environment = {**os.environ, "PYTHONPATH": str(self.folder / "src")}
        command = [sys.executable, "-m", "flexlash", *arguments]
        done = subprocess.run(
            command, cwd=self.folder, env=environment, capture_output=True, encoding="utf-8", check=False
        )
        assert done.returncode == code, done.stdout + done.stderr
        return done.stdout

    @cached_property
    def dictionary(self) -> dict[str, dict[str, dict[str, object]]]:
        """The entries of `flexlash schema --json` by sheet and key."""
        by_sheet: dict[str, dict[str, dict[str, object]]] = {}
        for entry in json.loads(self.run("schema", "--json")):
            by_sheet.setdefault(entry["sheet"], {})[entry["key"]] = entry
        return by_sheet

    @cached_property
    def template(self) -> Path:
        """The empty template."""
        self.run("template", "-o", "template.xlsx")
        return self.folder / "template.xlsx"

    def submission(self, name: str, *tolerances: tuple[str, float, float], **values: object) -> str:
        """Return a filled template with one variant and rows for its tolerance class."""
        book = openpyxl.load_workbook(self.template)
        sheet = book["Variants"]
        places = {cell.value: cell.column for cell in sheet[4]}
        for key, value in {**SOUND, **values, "tolerance_class": "own" if tolerances else None}.items():
            sheet.cell(5, places[self.dictionary["Variants"][key]["label"]], value)
        for dimension, low, high in tolerances:
            book["Tolerances"].append(["own", dimension, low, high])
        book.save(self.folder / name)
        return name

    def errors(self, submission: str) -> list[tuple[str, str]]:
        """Return code and column of the errors of a submission that cannot be computed."""
        told = json.loads(self.run("check", submission, "--json", code=4))
        return [(found["code"], found["column"]) for found in told["findings"] if found["level"] == "error"]

    def results(self, submission: str) -> dict[str, object]:
        """Return the Results of the one variant."""
        self.run("run", submission, "-o", "results.csv")
        return pl.read_csv(self.folder / "results.csv").row(0, named=True)

    def report(self, submission: str) -> dict[str, set[object]]:
        """Return what the cells of each sheet of the report hold."""
        self.run("run", submission, "-o", "report.xlsx")
        return _texts(self.folder / "report.xlsx")


def _texts(path: Path) -> dict[str, set[object]]:
    book = openpyxl.load_workbook(path)
    return {sheet.title: {cell.value for row in sheet.iter_rows() for cell in row} for sheet in book.worksheets}


@pytest.fixture(scope="module")
def requirement(tmp_path_factory):
    """Return a copy that knows one more numeric requirement."""
    return Copy(tmp_path_factory.mktemp("requirement"), REQUIREMENT)


@pytest.fixture(scope="module")
def dimension(tmp_path_factory):
    """Return a copy that knows one more dimension."""
    return Copy(tmp_path_factory.mktemp("dimension"), DIMENSION)


@pytest.mark.slow
def test_a_requirement_is_read_checked_and_shown(requirement):
    """One more requirement stands in the template, is checked, and reaches the report as entered, nothing else."""
    assert "peak_torque_Nm" in _texts(requirement.template)["Dictionary"]
    assert requirement.errors(requirement.submission("low.xlsx", peak_torque_Nm=-1)) == [("E207", "peak_torque_Nm")]
    report = requirement.report(requirement.submission("right.xlsx", peak_torque_Nm=1234))
    assert {"Peak torque [N·m]", 1234} <= report["Submission"]
    naming = {sheet for sheet, texts in report.items() if any("eak torque" in str(text) for text in texts)}
    assert naming == {"Submission", "Carried"}


@pytest.mark.slow
def test_a_requirement_reaches_neither_mechanics_nor_tolerances(requirement):
    """No number depends on one more requirement, and it can have no tolerance."""
    without = requirement.results(requirement.submission("without.xlsx"))
    assert requirement.results(requirement.submission("with.xlsx", peak_torque_Nm=1234)) == without
    assert "peak_torque" not in requirement.dictionary["Tolerances"]["dimension"]["choices"]
    assert "peak_torque" not in _texts(requirement.template)["Lists"]
    scattered = requirement.submission("scattered.xlsx", ("peak_torque", -1, 1), peak_torque_Nm=1234)
    assert requirement.errors(scattered) == [("E209", "dimension")]


@pytest.mark.slow
def test_a_dimension_is_read_checked_toleranced_and_shown(dimension):
    """One more dimension stands in the template, is checked, may have a tolerance, and reaches the report."""
    assert "boss_width_mm" in _texts(dimension.template)["Dictionary"]
    assert "boss_width" in _texts(dimension.template)["Lists"]
    assert "boss_width" in dimension.dictionary["Tolerances"]["dimension"]["choices"]
    narrow = dimension.submission("narrow.xlsx", boss_width_mm=0)
    assert dimension.errors(narrow) == [("E207", "boss_width_mm")]
    deviations = ("boss_width", -0.1, 0.1), ("wall_thickness", -0.01, 0.01)
    report = dimension.report(dimension.submission("right.xlsx", *deviations, boss_width_mm=30))
    assert {"Boss width [mm]", 30} <= report["Submission"]
    assert "Variants: Boss width [mm]" in report["About"]


def test_the_entry_is_all_that_differs(requirement, dimension):
    """The dictionary of each copy has one object more than ours, and every other one is ours."""
    ours = {column.key: column.as_dictionary() for column in VARIANTS}
    for copy, key in ((requirement, "peak_torque_Nm"), (dimension, "boss_width_mm")):
        theirs = dict(copy.dictionary["Variants"])
        assert theirs.pop(key)["role"] == copy.folder.name.removesuffix("0")
        assert theirs == ours
