"""The main job, command by command as a user gives them: also run with the lowest versions that pyproject allows."""

from __future__ import annotations

import io
import json
import re
import subprocess
import sys

import openpyxl
import polars as pl
import pytest
import regenerate
from page_requests import got, handed_in, shown_at_last

from flexlash.schema.columns import VARIANTS

KEPT = ("variant", "flexspline_type", "material", "torque_Nm", "cylinder_length_mm", "mean_radius_mm",
        "wall_thickness_mm", "disk_inner_radius_mm", "backlash_limit_arcmin")  # fmt: skip
CUP = "B3-160 case 1"
"""A variant of the study."""


def _flexlash(folder, *arguments):
    """Return what a command answers; a library's own warnings and tracebacks have no place in it."""
    done = subprocess.run(
        [sys.executable, "-m", "flexlash", *arguments], cwd=folder, capture_output=True, text=True, check=False,
        encoding="utf-8", timeout=300,
    )  # fmt: skip
    assert not re.search(r"site-packages|Traceback|\w+Warning:|Internal error", done.stdout + done.stderr), done.stderr
    return done


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return a folder with the study in it, as the command line writes it."""
    path = tmp_path_factory.mktemp("job")
    assert _flexlash(path, "template", "--example", "-o", "study.xlsx").returncode == 0
    return path


def _opened(path):
    """Return a workbook, its file closed."""
    return openpyxl.load_workbook(io.BytesIO(path.read_bytes()), read_only=True, data_only=True)


def _results(path):
    """Return the Results of any output as a frame."""
    if path.suffix == ".xlsx":
        rows = _opened(path)["Results"].iter_rows(min_row=2)
        keys, *rest = ([cell.value for cell in row] for row in rows)
        return pl.DataFrame([dict(zip(keys, row, strict=True)) for row in rest], infer_schema_length=None)
    if path.suffix == ".json":
        return pl.DataFrame(json.loads(path.read_text(encoding="utf-8"))["results"], infer_schema_length=None)
    return (pl.read_parquet if path.suffix == ".parquet" else pl.read_csv)(path)


def test_nothing_is_said_beside_the_answer(folder):
    """A sound submission gives its answer on stdout and nothing that a library has to say on stderr."""
    (folder / "one.csv").write_text(
        "variant,flexspline_type,material,torque_Nm,cylinder_length_mm,mean_radius_mm,wall_thickness_mm,"
        "disk_inner_radius_mm\nA,cup,20Cr2Ni4,800,160,80,1.6,40\n",
        encoding="utf-8",
    )
    done = _flexlash(folder, "run", "one.csv", "-o", "one-results.csv")
    assert (done.returncode, done.stderr) == (0, "")


def test_the_study_is_computed_in_every_form(folder):
    """The published study gives its known figures, the same ones in every form of output."""
    frames = []
    for ending in ("xlsx", "csv", "parquet", "json"):
        name = f"results.{ending}"
        assert _flexlash(folder, "run", "study.xlsx", "-o", name).returncode == 0
        frames.append(_results(folder / name).select("variant", "backlash_arcmin", "mean_arcmin", "p97_5_arcmin"))
    assert len(frames[0]) == 11
    for other in frames[1:]:
        assert other["variant"].to_list() == frames[0]["variant"].to_list()
        for key in other.columns[1:]:
            assert other[key].to_list() == pytest.approx(frames[0][key].to_list(), rel=1e-12)
    row = frames[0].row(0, named=True)
    assert row["variant"] == CUP
    assert row["backlash_arcmin"] == pytest.approx(3.687, abs=5e-4)
    assert row["mean_arcmin"] == pytest.approx(row["backlash_arcmin"], rel=0.01)
    assert 1.01 < row["p97_5_arcmin"] / row["mean_arcmin"] < 1.3


def test_tables_are_read_like_workbooks(folder):
    """A row from a text table and from Parquet gives the figures that it gives from the workbook."""
    sheet = _opened(folder / "study.xlsx")["Variants"]
    rows = [[cell.value for cell in row] for row in sheet.iter_rows()]
    head = next(place for place, row in enumerate(rows) if row[0] == VARIANTS[0].label)
    keys = [column.key for column in VARIANTS]
    cups = [dict(zip(keys, row, strict=False)) for row in rows[head + 1 :] if row[0] == CUP]
    table = pl.DataFrame([{key: row[key] for key in KEPT} for row in cups])
    table.write_csv(folder / "cups.csv")
    table.write_parquet(folder / "cups.parquet")
    known = _results_of(folder, "study.xlsx").filter(pl.col("variant") == CUP)
    text, parquet = (_results_of(folder, name) for name in ("cups.csv", "cups.parquet"))
    assert text["variant"].to_list() == parquet["variant"].to_list() == [CUP]
    # The study has tolerances of its own, so that only the nominal value is the same.
    assert text["backlash_arcmin"][0] == pytest.approx(known["backlash_arcmin"][0], rel=1e-12)
    assert text.select("backlash_arcmin", "p97_5_arcmin").equals(parquet.select("backlash_arcmin", "p97_5_arcmin"))


def _results_of(folder, name):
    """Return the Results of a submission."""
    assert _flexlash(folder, "run", name, "-o", f"{name}.parquet").returncode == 0
    return _results(folder / f"{name}.parquet")


def test_a_folder_and_a_large_table_in_it_are_computed(folder):
    """A table that is computed piece by piece gives each row the figures that it has alone, beside a workbook."""
    inbox = folder / "inbox"
    inbox.mkdir()
    (inbox / "study.xlsx").write_bytes((folder / "study.xlsx").read_bytes())
    row = {"material": "42CrMo4 (Q+T)", "torque_Nm": 800, "cylinder_length_mm": 160, "disk_inner_radius_mm": 40}
    numbers = pl.int_range(20_001, eager=True)
    many = pl.DataFrame({
        "variant": pl.Series([f"V{number}" for number in numbers]),
        "mean_radius_mm": 80 + (numbers % 97) / 100,
        "wall_thickness_mm": 1.6 + (numbers % 89) / 1000,
    }).with_columns(**{key: pl.lit(value) for key, value in row.items()})  # fmt: skip
    many.write_parquet(inbox / "many.parquet")
    many.slice(20_000).write_csv(folder / "last.csv")
    done = _flexlash(folder, "run", "inbox", "-o", "reports", "--samples", "8", "--no-annotate")
    assert done.returncode == 0, done.stderr
    found = _results(folder / "reports" / "many-results.parquet")
    assert found["variant"].equals(many["variant"])
    assert _flexlash(folder, "run", "last.csv", "-o", "last.parquet", "--samples", "8").returncode == 0
    assert found.slice(20_000).equals(_results(folder / "last.parquet").select(found.columns))
    assert {"study-report.xlsx", "many-report.xlsx", "flexlash-summary.xlsx"} <= {
        path.name for path in (folder / "reports").iterdir()
    }


def test_a_faulty_submission_is_checked_marked_and_fixed(folder):
    """Every fault of the faulty example is told by code; the marked copy and the fixed file can be opened."""
    path = regenerate.ROOT / "data" / "needs-fixing.xlsx"
    done = _flexlash(folder, "check", str(path), "--annotate", "--apply-fixes", "-o", ".")
    assert done.returncode == 3
    told = set(re.findall(r"[EW]\d{3}", done.stdout + done.stderr))
    assert {code for code, _, _ in regenerate.FAULTS} <= told
    assert "Findings" in _opened(folder / "needs-fixing-checked.xlsx").sheetnames
    assert "Variants" in _opened(folder / "needs-fixing-autofixed.xlsx").sheetnames


def test_the_study_is_checked_by_elasticity(folder):
    """The elasticity check and plain Monte Carlo agree with the formula on the study."""
    pytest.importorskip("skfem", reason="scikit-fem is not installed here")
    done = _flexlash(folder, "run", "study.xlsx", "--elasticity", "--cross-check", "-o", "verified.xlsx")
    assert done.returncode == 0
    assert "Monte Carlo agrees for 11 of 11 variants" in done.stdout
    row = _results(folder / "verified.xlsx").row(0, named=True)
    assert row["elasticity_windup_rad"] == pytest.approx(row["windup_rad"], rel=0.02)
    sheets = _opened(folder / "verified.xlsx").sheetnames
    assert {"Elasticity", "Stress"} <= set(sheets)


def test_a_file_in_the_folder_comes_back_with_its_report(folder):
    """`flexlash watch --once` computes what lies in INBOX, and the report is that of `flexlash run`, byte for byte."""
    (folder / "drop").mkdir()
    (folder / "drop" / "study.xlsx").write_bytes((folder / "study.xlsx").read_bytes())
    assert _flexlash(folder, "run", "study.xlsx", "-o", "by-command.xlsx").returncode == 0
    assert _flexlash(folder, "watch", "drop", "--out", "out", "--store", "store", "--once").returncode == 0
    assert (folder / "out" / "study-report.xlsx").read_bytes() == (folder / "by-command.xlsx").read_bytes()
    assert "done" in _flexlash(folder, "status", "--store", "store").stdout


def test_a_file_handed_in_on_the_page_gets_its_report(folder):
    """`flexlash serve` takes a file by the form of its page, shows findings and Summary and gives the report."""
    command = [sys.executable, "-m", "flexlash", "serve", "--store", "served", "--port", "0"]
    with subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, text=True) as server:
        try:
            address = server.stdout.readline().split()[1]
            place = handed_in(address, "study.xlsx", (folder / "study.xlsx").read_bytes())
            shown_at_last(place, "/files/report")
            assert got(f"{place}/files/results").startswith('"variant","status"')
        finally:
            server.terminate()
    assert server.returncode == 0
