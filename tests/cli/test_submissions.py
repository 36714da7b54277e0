"""Several submissions: each ends for itself, says so under its own name and in one shape, and none stops the others."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import openpyxl
import polars as pl
import pytest
import regenerate
from click.testing import CliRunner

import flexlash
from flexlash.cli import cli
from flexlash.cli.terminal import internal_error
from flexlash.reading.libraries import ChangedLibrary
from flexlash.reading.limited_process import ProcessFaultError

SHAPE = [
    "submission", "path", "sha256", "version", "seed", "method", "seconds", "exit_code", "error", "counts", "findings",
    "outputs",
]  # fmt: skip
COUNTS = ["rows", "computed", "errors", "warnings", "meets", "marginal", "fails"]

no_utf_8 = pytest.mark.skipif(sys.platform in {"win32", "darwin"}, reason="file names are Unicode there")


def _call(*arguments):
    return CliRunner().invoke(cli, list(map(str, arguments)))


def _flexlash(*arguments):
    """Run the command in a process of its own; names need not be UTF-8."""
    return subprocess.run(
        [sys.executable, "-m", "flexlash", *map(os.fsencode, map(str, arguments))],
        capture_output=True,
        check=False,
        env={**os.environ, "PYTHONPATH": str(regenerate.ROOT / "src"), "PYTHONIOENCODING": "utf-8"},
    )


@pytest.fixture
def every_kind(table, sound, tmp_path):
    """Return a submission of every end by its exit code: fine, in part, nothing, refused, missing, failing, skipped."""
    bad = {**sound, "variant": "b", "torque_Nm": ""}
    paths = {
        "fine": table([sound], "fine.csv"),
        "partly": table([sound, bad], "partly.csv"),
        "nothing": table([bad], "nothing.csv"),
        "refused": tmp_path / "refused.xlsx",
        "missing": tmp_path / "missing.csv",
        "failing": table([sound], "failing.csv"),
        "skipped": tmp_path / "skipped.xlsx",
    }
    paths["refused"].write_text("{\n", encoding="utf-8")
    flexlash.run(paths["fine"], paths["skipped"], samples=64)
    return paths


CODES = {"fine": 0, "partly": 3, "nothing": 4, "refused": 4, "missing": 5, "failing": 1, "skipped": 0}


@pytest.fixture
def _fails(monkeypatch):
    """Let the submission failing.csv meet an internal error."""
    from flexlash.validation import validate as validation

    validate = validation.validate

    def failing(submission, limits):
        if submission.name == "failing.csv":
            raise ZeroDivisionError("secret")
        return validate(submission, limits)

    monkeypatch.setattr(validation, "validate", failing)


@pytest.mark.usefixtures("_fails")
@pytest.mark.parametrize("command", [["check"], ["run", "--samples", "64"]], ids=" ".join)
def test_every_submission_has_one_object_of_one_shape(every_kind, command):
    """Whatever becomes of a submission, --json says the same fields of it, and of several the total at the end."""
    done = _call(*command, "--json", *every_kind.values())
    *objects, last = map(json.loads, done.stdout.splitlines())
    assert [list(one) for one in objects] == [SHAPE] * len(CODES)
    assert [list(one["counts"]) for one in objects] == [COUNTS] * len(CODES)
    assert [one["path"] for one in objects] == [str(path) for path in every_kind.values()]
    assert [one["submission"] for one in objects] == [path.name for path in every_kind.values()]
    assert {kind: one["exit_code"] for kind, one in zip(every_kind, objects, strict=True)} == CODES
    errors = {kind: one["error"] for kind, one in zip(every_kind, objects, strict=True)}
    assert [kind for kind, error in errors.items() if error] == ["refused", "missing", "failing"]
    assert "missing.csv could not be opened" in errors["missing"]
    assert "refused.xlsx" in errors["refused"]
    assert "ZeroDivisionError" in errors["failing"]
    assert "secret" not in done.output
    assert all(one["seconds"] >= 0 and isinstance(one["seed"], int) and one["method"] for one in objects)
    total = {"submissions": 6, "computed": 1, "partly": 1, "not": 4, "exit_code": 1}
    assert last == {"total": total}
    assert done.exit_code == 1


@pytest.mark.usefixtures("_fails")
@pytest.mark.parametrize("kind", CODES)
def test_alone_its_code_is_that_of_the_command(every_kind, kind):
    """Of a single submission the object's code is the command's, there is no total, and a skipped one is nothing."""
    done = _call("check", "--json", every_kind[kind])
    (found,) = map(json.loads, done.stdout.splitlines())
    assert found["exit_code"] == done.exit_code == (4 if kind == "skipped" else CODES[kind])


@pytest.mark.usefixtures("_fails")
def test_messages_carry_the_name_of_their_submission(every_kind):
    """Of several submissions every line on standard error names its own; the last line on the screen is the total."""
    done = _call("run", "--samples", 64, *every_kind.values())
    names = [str(path) for path in every_kind.values()]
    assert [line for line in done.stderr.splitlines() if not line.startswith(tuple(names))] == []
    assert done.stdout.splitlines()[-1] == "Total of 6 submissions: 1 computed, 1 computed in part, 4 not; 1 skipped."
    checked = _call("check", *every_kind.values()).stdout.splitlines()
    assert checked[-1] == "Total of 6 submissions: 1 ready, 1 ready in part, 4 not; 1 skipped."
    assert [line for line in checked if line.lstrip().startswith(("error", "Variants!"))] == []


def test_a_single_submission_has_no_name_before_its_messages_and_no_total(every_kind):
    """Where there is one submission only, nobody needs to be told which."""
    done = _call("check", every_kind["partly"])
    assert done.stdout.startswith("error E201")
    assert "Total" not in done.stdout


@pytest.mark.parametrize("command", ["check", "run"])
def test_quiet_is_silent_unless_something_failed(every_kind, command):
    """--quiet prints nothing where all is fine, what failed else; --json still answers."""
    done = _call(command, "--quiet", every_kind["fine"], every_kind["fine"])
    assert (done.exit_code, done.output) == (0, "")
    failed = _call(command, "--quiet", every_kind["fine"], every_kind["partly"])
    assert f"{every_kind['partly']}: 1 of 2 rows" in failed.output
    assert "E201" in _call(command, "--quiet", "-v", every_kind["fine"], every_kind["partly"]).output
    assert str(every_kind["fine"]) not in failed.output
    assert failed.stdout.splitlines()[-1].startswith("Total of 2 submissions")
    assert json.loads(_call(command, "--quiet", "--json", every_kind["fine"]).stdout)["exit_code"] == 0


def test_nothing_but_skipped_files_is_nothing(every_kind):
    """Where every file is skipped, there was nothing to compute."""
    again = every_kind["skipped"].with_name("again.xlsx")
    again.write_bytes(every_kind["skipped"].read_bytes())
    done = _call("check", every_kind["skipped"], again, "--json")
    *objects, last = map(json.loads, done.stdout.splitlines())
    assert [one["exit_code"] for one in objects] == [0, 0]
    assert last["total"] == {"submissions": 0, "computed": 0, "partly": 0, "not": 0, "exit_code": 4}
    assert done.exit_code == 4


class Panic(BaseException):
    """What polars raises where it panics: no Exception."""


FAULTS = [ZeroDivisionError(), RecursionError(), MemoryError(), Panic(), UnicodeEncodeError("utf-8", "x", 0, 1, "no")]


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: type(fault).__name__)
def test_whatever_happens_to_one_the_others_are_computed(table, sound, tmp_path, monkeypatch, fault):
    """Any exception ends the one submission that met it, with its name and code 1; the others get their reports."""
    paths = [table([sound], f"{name}.csv") for name in "abc"]
    from flexlash import pipeline

    examined = pipeline.examined

    def failing(source, *more):
        if source.name == "b.csv":
            raise fault
        return examined(source, *more)

    monkeypatch.setattr(pipeline, "examined", failing)
    done = _call("run", "--samples", 64, *paths)
    assert done.exit_code == 1
    assert [line for line in done.stderr.splitlines() if "Internal error" in line] == [
        f"{paths[1]}: Internal error ({type(fault).__name__}): this is a fault of flexlash, not of your file. "
        "Set FLEXLASH_DEBUG=1 for details."
    ]
    assert {path.name for path in tmp_path.glob("*.xlsx")} == {"a-report.xlsx", "c-report.xlsx"}


@no_utf_8
@pytest.mark.parametrize("kind", ["csv", "xlsx"])
def test_a_name_that_is_no_utf_8_is_computed_like_any_other(table, workbook, sound, tmp_path, kind):
    """Such a file is computed, its name shown escaped, and the JSON about it is UTF-8; the others are computed too."""
    odd = tmp_path / os.fsdecode(f"caf\xe9 .{kind}".encode("latin-1"))
    made = table([sound], "plain.csv") if kind == "csv" else workbook([sound], "plain.xlsx")
    odd.write_bytes(made.read_bytes())
    done = _flexlash("run", odd, made, "--samples", 64)
    assert (done.returncode, done.stderr) == (0, b"")
    assert f"caf\\xe9 .{kind}: 1 of 1 rows computed." in done.stdout.decode()
    report = tmp_path / os.fsdecode(b"caf\xe9 -report.xlsx")
    plain = tmp_path / "plain-report.xlsx"
    assert report.read_bytes().startswith(b"PK")
    about = openpyxl.load_workbook(report)["About"]
    assert f"caf\\xe9 .{kind}" in {cell.value for row in about.iter_rows() for cell in row}
    done = _flexlash("check", odd, made, "--json")
    first = json.loads(done.stdout.decode("utf-8").splitlines()[0])
    assert first["submission"] == f"caf\\xe9 .{kind}"
    assert first["path"] == f"{tmp_path}/caf\\xe9 .{kind}"
    assert plain.exists()


@pytest.mark.long
@pytest.mark.slow
@no_utf_8
def test_the_other_commands_take_such_names_too(table, sound, tmp_path):
    """Marked, fixed, upgraded, compared, computed anew: a name that is no UTF-8 stops nothing."""
    odd = tmp_path / os.fsdecode(b"caf\xe9.csv")
    odd.write_bytes(table([{**sound, "wall_thickness_mm": "1,6 mm"}]).read_bytes())
    done = _flexlash("check", odd, "--annotate", "--apply-fixes")
    assert (done.returncode, done.stderr) == (0, b"")
    fixed = tmp_path / os.fsdecode(b"caf\xe9-autofixed.csv")
    assert fixed.exists()
    assert _flexlash("check", odd, "--annotate").returncode == 4
    assert (tmp_path / os.fsdecode(b"caf\xe9-checked.xlsx")).exists()
    assert _flexlash("template", "--upgrade", odd).returncode == 0
    assert _flexlash("run", fixed, "--samples", 64).returncode == 0
    again = _flexlash("run", "--from-report", tmp_path / os.fsdecode(b"caf\xe9-autofixed-report.xlsx"))
    assert (again.returncode, again.stderr) == (0, b"")
    assert _flexlash("diff", fixed, odd).returncode == 0
    missing = _flexlash("diff", fixed, tmp_path / os.fsdecode(b"\xff.csv"), "--json")
    assert missing.returncode == 5
    assert "\\xff.csv could not be opened" in json.loads(missing.stdout.decode())["error"]


@no_utf_8
def test_the_python_function_takes_such_names_too(table, sound, tmp_path):
    """`flexlash.run` computes a file whose name is no UTF-8 and writes every form of output."""
    odd = tmp_path / os.fsdecode(b"\xe9\xff.csv")
    odd.write_bytes(table([sound]).read_bytes())
    for ending in ("xlsx", "csv", "parquet", "json"):
        outcome = flexlash.run(odd, tmp_path / f"out.{ending}", samples=64)
        assert outcome.submission.name == "\\xe9\\xff.csv"
        assert outcome.exit_code == 0
    assert pl.read_parquet(tmp_path / "out.parquet")["status"].to_list() == ["ok"]


@pytest.mark.skipif(os.name == "nt", reason="links need a privilege on Windows")
@pytest.mark.parametrize("command", ["check", "run"])
def test_a_link_to_itself_stops_nobody_else(table, sound, tmp_path, command):
    """A link that leads to itself cannot be opened, is named, and the others are computed."""
    loop = tmp_path / "loop.csv"
    loop.symlink_to(loop)
    done = _call(command, loop, table([sound]), *(["--samples", 64] if command == "run" else []))
    assert done.exit_code == 5
    assert f"{loop} could not be opened or written: this is a link; give the file itself" in done.stderr
    assert "1 of 1 rows" in done.stdout
    with pytest.raises(OSError, match="link"):
        flexlash.run(loop)


def test_a_table_beside_is_named_with_the_submission_that_needs_it(table, sound, tmp_path):
    """Where a table given beside cannot be opened, the message names that table, and the submission it was for."""
    path = table([sound])
    done = _call("check", path, "--tolerances", tmp_path / "none.csv")
    assert done.exit_code == 5
    assert done.stderr.startswith(f"{path}: {tmp_path / 'none.csv'} could not be opened: there is no")


def test_a_workbook_that_is_open_in_excel_is_told(table, sound, tmp_path):
    """Excel's lock file beside a submission says that it may hold more than was saved; nobody else hears of it."""
    path, said = table([sound]), "it seems to be open in Excel: what is not saved there was not read"
    assert said not in _call("check", path).stderr
    (tmp_path / f"~${path.name}").touch()
    done = _call("check", path)
    assert (done.exit_code, done.stderr.count(f"{path}: {said}")) == (0, 1)
    assert said not in _call("check", path, "--quiet").stderr


def test_what_was_left_alone_is_said_under_its_submission(table, sound, tmp_path):
    """Of several submissions, the remark that a report took another name says whose report it is, even with --quiet."""
    paths = [table([{**sound, "torque_Nm": 8000}], name) for name in ("a.csv", "b.csv")]
    (tmp_path / "a-report.xlsx").write_bytes(b"somebody else's")
    done = _call("run", "--samples", 64, "--quiet", *paths)
    assert done.exit_code == 0
    (said,) = done.stderr.splitlines()
    assert said.startswith(f"{paths[0]}: {tmp_path / 'a-report.xlsx'} was left alone")


def test_diff_says_which_of_both_is_none(table, sound, tmp_path):
    """Both lines about a file that cannot be compared name it, and --json says them in the shape of a submission."""
    other = tmp_path / "other.txt"
    other.write_bytes(b"%PDF-1.7")
    done = _call("diff", table([sound]), other)
    assert done.exit_code == 4
    assert [line.startswith(str(other)) for line in done.stderr.splitlines()] == [True, True]
    found = json.loads(_call("diff", table([sound]), other, "--json").stdout)
    assert list(found) == SHAPE
    assert (found["exit_code"], found["findings"][0]["code"], found["counts"]["errors"]) == (4, "E101", 1)


def test_an_internal_error_says_what_is_known_of_it():
    """A changed library is told in its own words, a fault of the limited process by what it was."""
    changed = ChangedLibrary("openpyxl 9.9 reads a workbook as something else. Your file is not to blame")
    assert internal_error(changed) == f"Internal error: {changed}."
    fault = ProcessFaultError("ZeroDivisionError in the limited process\nTraceback")
    assert internal_error(fault).startswith(
        "Internal error (ZeroDivisionError in the limited process): this is a fault"
    )
