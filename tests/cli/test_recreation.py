"""A report alone gives back the submission and, byte for byte, itself."""

from __future__ import annotations

import datetime
import os

import openpyxl
import pytest
import regenerate
from decided_drives import drive
from finding_examples import SUBMISSIONS
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from made_up_parts import measured_parts

from flexlash.cli.recreation import recreate
from flexlash.comparison.difference import difference
from flexlash.comparison.sides import side_of
from flexlash.feedback.template import entry_rules
from flexlash.feedback.template.template_workbook import template_bytes
from flexlash.pipeline import check, run
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.schema.result_columns import CROSS_CHECK

GERMAN = (
    "variant;material;torque_Nm;cylinder_length_mm;mean_radius_mm;wall_thickness_mm;disk_inner_radius_mm;notes\n"
    "Größe 1;20Cr2Ni4;800;160;80;1,6;40;für Müller\nGröße 2;20Cr2Ni4;800,5;160;80;1,65;40;\n"
)
TABLE = GERMAN.replace(";", "|").replace(",", ".").replace("|", ",")


def _german(folder, sound):  # noqa: ARG001
    (folder / "deutsch.csv").write_bytes(GERMAN.encode("cp1252"))
    return folder / "deutsch.csv", {}


def _table(folder, sound):  # noqa: ARG001
    (folder / "table.csv").write_text(TABLE, encoding="utf-8")
    return folder / "table.csv", {"method": "sobol", "seed": 5, "cross_check": True}


def _parquet(folder, sound):
    import polars as pl

    pl.DataFrame([sound, {**sound, "variant": "b", "wall_thickness_mm": 0.1 + 1.5}]).write_parquet(folder / "t.parquet")
    return folder / "t.parquet", {}


def _years_from_1904(folder, sound):
    book = openpyxl.Workbook()
    book.epoch = datetime.datetime(1904, 1, 1)  # noqa: DTZ001
    book.active.title = "Variants"
    book.active.append(list(sound))
    book.active.append(list(sound.values()))
    book.active.append([*list(sound.values())[:-2], datetime.datetime(2026, 4, 1), 3.5])  # noqa: DTZ001
    book.active["A3"] = "dated"
    book.properties.modified = datetime.datetime(2026, 5, 6, 7, 8, 9)  # noqa: DTZ001
    book.save(folder / "mac.xlsx")
    return folder / "mac.xlsx", {}


def _percentages(folder, sound):
    book = openpyxl.Workbook()
    book.active.title = "Variants"
    for row in (list(sound), list(sound.values())):
        book.active.append(row)
    sheet = book.create_sheet("Tolerances")
    for row in (
        ["Tolerance class", "Dimension", "Lower deviation", "Upper deviation", "Deviation unit"],
        ["standard", "wall_thickness", -0.05, 0.05, "%"],
    ):
        sheet.append(row)
    sheet["C2"].number_format = sheet["D2"].number_format = "0%"
    book.save(folder / "percent.xlsx")
    return folder / "percent.xlsx", {}


def _example(name):
    return lambda folder, sound: SUBMISSIONS[name](folder)  # noqa: ARG005


def _data(name, **options):
    return lambda folder, sound: (regenerate.ROOT / "data" / f"{name}.xlsx", options)  # noqa: ARG005


def _measured_tables(folder, sound):  # noqa: ARG001
    import polars as pl

    filling, paths = measured_parts(), {}
    for name in ("variants", "tolerances", "measurements", "correlations"):
        paths[name] = folder / f"{name}.csv"
        pl.DataFrame(list(getattr(filling, name)), infer_schema_length=None).write_csv(paths[name])
    return paths.pop("variants"), paths


def _drive(folder, sound):  # noqa: ARG001
    (folder / "drive.xlsx").write_bytes(template_bytes(drive()))
    return folder / "drive.xlsx", {}


MADE = {
    "the study": _data("b3-160-study", strict=True),
    "faults": _data("needs-fixing"),
    "calibrated, other seed": _data("b3-160-calibrated", seed=7, method="random"),
    "elasticity": lambda folder, sound: (_table(folder, sound)[0], {"elasticity": True}),
    "a table": _table,
    "a German table": _german,
    "Parquet": _parquet,
    "years from 1904": _years_from_1904,
    "percentages": _percentages,
    "tables beside": _example("tables"),
    "a copied sheet": _example("a copied sheet"),
    "hidden and merged": _example("overlooked"),
    "a later sheet": _example("calibrated"),
    "measured parts": _data("measured-parts"),
    "tables of measured parts": _measured_tables,
    "a whole drive": _drive,
    "faults of a drive": _example("decided"),
}


@pytest.fixture(autouse=True)
def _few_rows(monkeypatch):
    """Few prepared rows, for speed."""
    monkeypatch.setattr(entry_rules, "PREPARED_ROWS", 8)


@pytest.mark.parametrize("what", MADE)
def test_the_report_is_made_anew_to_the_byte(what, tmp_path, sound):
    """From the report alone comes the same report, and from the recreated submission the same numbers."""
    path, options = MADE[what](tmp_path, sound)
    options = {"samples": 64, **options}
    original = run(path, tmp_path / "original.xlsx", **options)
    assert original.computed
    found = recreate(tmp_path / "original.xlsx", tmp_path / "anew.xlsx")
    assert (tmp_path / "anew.xlsx").read_bytes() == (tmp_path / "original.xlsx").read_bytes()
    assert found.different == 0
    assert found.numbers > 30
    assert found.outcome.outputs == (tmp_path / f"{path.stem}-recreated.xlsx", tmp_path / "anew.xlsx")
    kept = {
        key: value
        for key, value in options.items()
        if key not in {"tolerances", "materials", "measurements", "correlations", "other_sources"}
    }
    again = run(found.outcome.outputs[0], **kept)
    numbers = [name for name in original.results.columns if name not in {"findings", "status"}]
    assert again.results.select(numbers).equals(original.results.select(numbers))


@pytest.fixture
def report(table, sound, tmp_path):
    """Return the report of two variants, its submission gone."""
    path = table([sound, {**sound, "variant": "b", "wall_thickness_mm": 1.7}], "gone.csv")
    run(path, tmp_path / "report.xlsx", samples=64, seed=3, cross_check=True)
    path.unlink()
    return tmp_path / "report.xlsx"


def test_options_win_over_those_of_the_report(report):
    """What is said now holds, the rest is as it was; numbers that differ are counted."""
    found = recreate(report, None, seed=4, cross_check=False)
    assert found.outcome.settings.seed == 4
    assert found.outcome.settings.samples == 64
    assert "cross_check" not in found.outcome.results.columns
    assert 0 < found.different <= found.numbers
    assert found.outcome.submission.run_with["seed"] == 3


def test_an_option_can_be_taken_back(report):
    """Numbers of columns that one of the two lacks count as differing."""
    found = recreate(report, None, cross_check=False)
    lacking = [column for column in CROSS_CHECK if column.is_number]
    assert found.different == 2 * len(lacking)


def test_a_changed_number_of_the_report_is_counted(report, tmp_path):
    """A number altered in the given report's Results is told as one that differs."""
    with report.open("rb") as file:
        book = openpyxl.load_workbook(file)
    sheet = book["Results"]
    keys = next(row for row in sheet.iter_rows(max_row=15) if row[0].value == "variant")
    cell = sheet.cell(keys[0].row + 1, next(one.column for one in keys if one.value == "p50_arcmin"))
    cell.value += 1e-9
    book.save(tmp_path / "altered.xlsx")
    assert recreate(tmp_path / "altered.xlsx", None).different == 1


def test_nothing_of_the_engineer_is_overwritten(report, tmp_path):
    """A recreated submission in which somebody has worked since is left alone; the new one gets a number."""
    first = recreate(report, None).outcome.outputs[0]
    assert recreate(report, None).outcome.outputs[0] == first
    first.write_bytes(first.read_bytes() + b"worked on")
    worked_on = first.read_bytes()
    assert recreate(report, None).outcome.outputs[0] == tmp_path / "gone-recreated (2).xlsx"
    assert first.read_bytes() == worked_on


def test_there_is_no_file_to_mark(report, tmp_path):
    """A marked copy cannot be made of a report; asking for it is told at once."""
    with pytest.raises(ValueError, match="marked"):
        run(report, from_report=True, marked_copy=tmp_path / "c.xlsx")


def test_the_recreated_submission_checks(report):
    """The recreated submission is a filled template that checks without a fault."""
    outcome = check(recreate(report, None).outcome.outputs[0])
    assert [outcome.counts[one] for one in ("rows", "computed", "errors", "warnings")] == [2, 2, 0, 0]


def test_a_file_that_is_none(tmp_path):
    """A file that cannot be opened is an OSError, as it is for every run."""
    with pytest.raises(OSError, match=os.strerror(2)):
        recreate(tmp_path / "nothing.xlsx", None)


PIECES = ("a", "A", "b", " ", "\u00a0", "\x01", "_x000D_", "_x0041_", "x005F_", "_", "=", "'")
ODD = st.lists(st.sampled_from(PIECES), min_size=1, max_size=5).map("".join)


@settings(max_examples=3, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(ODD, min_size=6, max_size=6, unique=True))
@example(["a_x000D_b", "x005F_", " a ", "A", "aA", "a_x0041_", "a  b", "a\x01b", "=1+1", "#N/A"])
def test_numbers_of_odd_names_are_compared_with_their_own(tmp_path, table, sound, names):
    """Whatever the names, the numbers computed anew are those of the report, and each variant's row is found."""
    free = sound | {"backlash_limit_arcmin": ""}
    run(table([{**free, "variant": name} for name in [*names, "plain"]]), tmp_path / "r.xlsx", samples=64)
    found = recreate(tmp_path / "r.xlsx", tmp_path / "anew.xlsx")
    assert (found.different, found.numbers > 30) == (0, True)
    assert (tmp_path / "anew.xlsx").read_bytes() == (tmp_path / "r.xlsx").read_bytes()
    side = side_of(tmp_path / "r.xlsx", ReadingLimits())
    assert list(side.results) == list(side.records)
    assert difference(side, side_of(tmp_path / "anew.xlsx", ReadingLimits())).is_none
