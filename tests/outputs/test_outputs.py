"""Where outputs go: planned before anything is computed, stamped, written whole, never over a file of the user's."""

from __future__ import annotations

import contextlib
import errno
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import warnings
from pathlib import Path

import openpyxl
import polars as pl
import pytest
import regenerate

from flexlash.cli import cli
from flexlash.cli.recreation import recreate
from flexlash.outputs import plan as plan_module
from flexlash.outputs import writing
from flexlash.outputs.naming import (
    fixed_outputs,
    marked_outputs,
    recreated_outputs,
    report_outputs,
    summary_outputs,
    template_output,
)
from flexlash.outputs.plan import Plan
from flexlash.pipeline import check, fix, run
from flexlash.schema.stamps import placeholder, stamp_at, stamped

FEW = {"samples": 16, "method": "random"}
FOREIGN = b"PK\x03\x04 a report of somebody else"
OURS = stamped(json.dumps({"stamp": placeholder("results")}).encode(), "results")


def _call(*arguments):
    """Run the command line in this process; return its exit code."""
    try:
        cli.main(list(map(str, arguments)), standalone_mode=False)
    except SystemExit as stop:
        return stop.code or 0
    except Exception as fault:
        if getattr(fault, "exit_code", None) == 2:
            return f"usage: {fault.message}"
        raise
    return 0


def _run(*arguments):
    return _call("run", *arguments, "--samples", 16, "--method", "random", "--jobs", 1)


def _contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def _names(outputs, folder):
    return [str(output.path.relative_to(folder)) for output in outputs]


def _worked_in(path):
    """Open a workbook, enter something and save it, as an engineer does."""
    book = openpyxl.load_workbook(path)
    book.worksheets[0]["A1"] = "my remark"
    book.save(path)
    return path.read_bytes()


# What outputs are called

PLANS = {
    "beside the submission": (["a.xlsx"], None, ["a-report.xlsx"], ["a-autofixed.xlsx"], ["a-checked.xlsx"]),
    "into a folder": (
        ["a.xlsx", "b.csv"],
        "out",
        ["out/a-report.xlsx", "out/b-report.xlsx"],
        ["out/a-autofixed.xlsx", "out/b-autofixed.csv"],
        ["out/a-checked.xlsx", "out/b-checked.xlsx"],
    ),
    "equal names": (
        ["a.xlsx", "in/a.xlsx", "in/a.csv"],
        "out",
        ["out/a-report.xlsx", "out/a-report (2).xlsx", "out/a-report (3).xlsx"],
        ["out/a-autofixed.xlsx", "out/a-autofixed (2).xlsx", "out/a-autofixed.csv"],
        ["out/a-checked.xlsx", "out/a-checked (2).xlsx", "out/a-checked (3).xlsx"],
    ),
    "an input at the place of an output": (
        ["a.xlsx", "a.csv", "a-report (2).xlsx", "a-checked.xlsx"],
        None,
        ["a-report.xlsx", "a-report (3).xlsx", "a-report (2)-report.xlsx", "a-checked-report.xlsx"],
        ["a-autofixed.xlsx", "a-autofixed.csv", "a-report (2)-autofixed.xlsx", "a-checked-autofixed.xlsx"],
        ["a-checked (2).xlsx", "a-checked (3).xlsx", "a-report (2)-checked.xlsx", "a-checked (4).xlsx"],
    ),
    "what seems to be ours comes last": (
        ["a-autofixed.xlsx", "a.xlsx"],
        None,
        ["a-autofixed-report.xlsx", "a-report.xlsx"],
        ["a-autofixed (3).xlsx", "a-autofixed (2).xlsx"],
        ["a-autofixed-checked.xlsx", "a-checked.xlsx"],
    ),
    "a file": (["a.xlsx"], "x.xlsx", ["x.xlsx"], ["x.xlsx"], ["a-checked.xlsx"]),
}


@pytest.mark.parametrize("what", PLANS)
def test_where_outputs_go(what, tmp_path):
    """Reports, fixed files and marked copies get names that say what they are, each its own, none an input's."""
    names, output, *expected = PLANS[what]
    paths = [tmp_path / name for name in names]
    for path in paths:
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(FOREIGN)
    out = tmp_path / output if output else None
    for plans, wanted in zip((report_outputs, fixed_outputs, marked_outputs), expected, strict=True):
        plan = Plan(inputs=paths, submissions=paths)
        assert _names(plans(plan, paths, out), tmp_path) == wanted


def test_sub_folders_are_kept_in_the_folder_of_outputs(tmp_path):
    """What lay below the given folder keeps its sub-folder in OUT, made if absent; names are numbered in each alone."""
    paths = [tmp_path / "in" / name for name in ("a.xlsx", "a.csv", "sub/a.xlsx", "sub/deep/a.xlsx")]
    below = {paths[2]: Path("sub"), paths[3]: Path("sub/deep")}
    plan = Plan(inputs=paths, submissions=paths)
    reports = report_outputs(plan, paths, tmp_path / "out", below=below)
    assert _names(reports, tmp_path / "out") == [
        "a-report.xlsx", "a-report (2).xlsx", "sub/a-report.xlsx", "sub/deep/a-report.xlsx",
    ]  # fmt: skip
    assert (tmp_path / "out/sub/deep").is_dir()
    summary = summary_outputs(plan, tmp_path / "out")
    assert [output.path.name for output in summary] == ["flexlash-summary.xlsx", "flexlash-summary.jsonl"]
    assert summary_outputs(plan, tmp_path / "out.xlsx") is summary_outputs(plan, None) is None


WRONG = {
    "several submissions, one file": (["a.xlsx", "b.xlsx"], "x.xlsx", "folder"),
    "an unknown ending": (["a.xlsx"], "x.pdf", r"\.pdf"),
    "the submission itself": (["a.xlsx"], "a.xlsx", "never overwrites"),
    "a file for a folder": (["a.xlsx"], "afile", "a file that is no folder"),
    "a file in a path": (["a.xlsx"], "afile/out", "a file that is no folder"),
    "standard output": (["a.xlsx"], "-", "not .*-: only --json writes to standard output"),
    "another text": (["a.xlsx"], "x.txt", r"or be a folder, not in \.txt"),
    "an ending and a space": (["a.xlsx"], "x.xlsx ", r"or be a folder, not in \.xlsx "),
    "a point without an ending": (["a.xlsx"], "results.", r"ends in a point without an ending: write results\.xlsx"),
    "an ending alone": (["a.xlsx"], ".xlsx", r"an ending without a name: write a name before \.xlsx"),
    "another ending alone": (["a.xlsx"], ".CSV", r"an ending without a name"),
}


@pytest.mark.parametrize("what", WRONG)
@pytest.mark.parametrize("plans", [report_outputs, fixed_outputs])
def test_outputs_that_cannot_be_meant(plans, what, tmp_path):
    """An output that would overwrite a submission, or that no form or folder fits, is refused with a reason."""
    names, output, words = WRONG[what]
    (tmp_path / "afile").touch()
    paths = [tmp_path / name for name in names]
    with pytest.raises(ValueError, match=words):
        plans(Plan(inputs=paths), paths, tmp_path / output)


def test_a_report_may_be_parquet_and_a_fixed_file_not(tmp_path):
    """Results take forms that a fixed submission cannot have."""
    paths = [tmp_path / "a.xlsx"]
    assert report_outputs(Plan(inputs=paths), paths, tmp_path / "x.parquet")[0].path == tmp_path / "x.parquet"
    with pytest.raises(ValueError, match="parquet"):
        fixed_outputs(Plan(inputs=paths), paths, tmp_path / "x.parquet")


@pytest.mark.parametrize("name", ["reports", "study-2.1", "v1.0b", "Wall 1.6", "a.b c", "of the month.february"])
def test_without_a_known_ending_out_is_a_folder(name, tmp_path):
    """A name that ends as no kind of file does is that of a folder, made if it is absent; so is any folder there is."""
    paths = [tmp_path / "a.xlsx"]
    (output,) = report_outputs(Plan(inputs=paths), paths, tmp_path / name)
    assert output.path == tmp_path / name / "a-report.xlsx"
    (tmp_path / "there.txt").mkdir()
    assert report_outputs(Plan(inputs=paths), paths, tmp_path / "there.txt")[0].path.parent == tmp_path / "there.txt"


@pytest.mark.parametrize("output", ["-", "results.", "afile", ".xlsx", "x.txt"])
@pytest.mark.parametrize("command", [["run"], ["check", "--annotate"], ["check", "--apply-fixes"]], ids=" ".join)
def test_an_out_that_cannot_be_meant_is_said_before_computing(command, output, tmp_path, table, sound, monkeypatch):  # noqa: PLR0917
    """It is a usage error that names OUT; nothing is computed, made or changed."""
    monkeypatch.chdir(tmp_path)
    Path("afile").touch()
    table([{**sound, "torque_Nm": ""}])
    said = _call(*command, "submission.csv", "-o", output)
    assert str(said).startswith("usage: ")
    assert output.removeprefix("x") in said
    assert sorted(_contents(tmp_path)) == ["afile", "submission.csv"]
    assert not Path(output).is_dir()


def test_a_folder_is_made(tmp_path):
    """A folder that does not exist is made; one that a file's name leads through is not."""
    report_outputs(Plan(inputs=[]), [Path("a.xlsx")], tmp_path / "new" / "deep")
    assert (tmp_path / "new" / "deep").is_dir()
    (output,) = report_outputs(Plan(inputs=[]), [Path("a.xlsx")], tmp_path / "none" / "out.csv")
    with pytest.raises(FileNotFoundError, match="there is no folder"):
        output.require()
    assert not (tmp_path / "none").exists()


@pytest.mark.parametrize("name", ["t.csv", "t", "t.xls"])
def test_a_template_is_a_workbook(tmp_path, name):
    """A template is not written under another ending than .xlsx, which Excel would refuse to open."""
    with pytest.raises(ValueError, match=r"must end in \.xlsx"):
        template_output(tmp_path / name, None, force=True)
    assert template_output(tmp_path / "t.XLSX", None, force=False).path == tmp_path / "t.XLSX"


NAMES = {
    "a file": ("study.xlsx", ["study-recreated.xlsx", "study-recreated-report.xlsx"]),
    "a path": ("../../study.csv", [".._.._study-recreated.xlsx", ".._.._study-recreated-report.xlsx"]),
    "another system's path": ("C:\\x.csv", ["C__x-recreated.xlsx", "C__x-recreated-report.xlsx"]),
    "a device": ("a:b|c\0", ["a_b_c_-recreated.xlsx", "a_b_c_-recreated-report.xlsx"]),
}


@pytest.mark.parametrize("what", NAMES)
def test_a_name_that_a_report_carries_leads_nowhere_else(what, tmp_path):
    """What is made anew stands beside the report, whatever the submission is said to be called."""
    name, expected = NAMES[what]
    outputs = recreated_outputs(Plan(inputs=[]), tmp_path / "r.xlsx", None, name)
    assert _names(outputs, tmp_path) == expected


def test_what_is_made_anew_replaces_no_given_report(tmp_path):
    """A report made anew from a report made anew gets a number; so do two of one name; a given path is taken."""
    plan = Plan(inputs=[tmp_path / "a-recreated-report.xlsx"])
    first = recreated_outputs(plan, tmp_path / "a-recreated-report.xlsx", None, "a.csv")
    second = recreated_outputs(plan, tmp_path / "other.xlsx", tmp_path, "a.csv")
    assert _names(first, tmp_path) == ["a-recreated.xlsx", "a-recreated-report (2).xlsx"]
    assert _names(second, tmp_path) == ["a-recreated (2).xlsx", "a-recreated-report (3).xlsx"]
    (tmp_path / "new").mkdir()
    third = recreated_outputs(plan, tmp_path / "r.xlsx", tmp_path / "new" / "x.csv", "a.csv")
    assert _names(third, tmp_path) == ["new/a-recreated.xlsx", "new/x.csv"]


# No input is ever an output


def _as_named(folder):
    return folder / "in.csv"


def _dotted(folder):
    return folder / "." / "in.csv"


def _linked(folder):
    os.link(folder / "in.csv", folder / "other.csv")
    return folder / "other.csv"


def _through_a_linked_folder(folder):
    (folder / "elsewhere").symlink_to(folder, target_is_directory=True)
    return folder / "elsewhere" / "in.csv"


def _symbolic(folder):
    (folder / "link.csv").symlink_to(folder / "in.csv")
    return folder / "link.csv"


def _relative(folder):
    return Path(os.path.relpath(folder / "in.csv"))


SPELLINGS = (_as_named, _dotted, _linked, _through_a_linked_folder, _symbolic, _relative)
INPUTS = {
    "the submission": (),
    "--tolerances": ("tolerances",),
    "--materials": ("materials",),
}


@pytest.mark.parametrize("what", INPUTS)
@pytest.mark.parametrize("spelt", SPELLINGS)
def test_no_input_is_ever_an_output(what, spelt, tmp_path, table, sound):
    """Submission, tolerances and materials are never replaced, however their path is spelt, from Python and shell."""
    given = table([sound], "in.csv")
    other = table([sound], "s.csv")
    submission, options = (other if INPUTS[what] else given), dict.fromkeys(INPUTS[what], given)
    named = spelt(tmp_path)
    before = _contents(tmp_path)
    with pytest.raises(ValueError, match="never overwrites"):
        run(submission, named, **options, **FEW)
    words = [f"--{name}={path}" for name, path in options.items()]
    assert "never overwrites" in _run(submission, "-o", named, *words)
    assert _contents(tmp_path) == before


def test_no_input_is_a_marked_or_a_fixed_file(tmp_path, workbook, sound):
    """Marked copies and fixed files spare the submission as reports do; two outputs never share a name."""
    path = workbook([{**sound, "wall_thickness_mm": "1,6 mm"}])
    before = _contents(tmp_path)
    for call in (
        lambda: check(path, marked_copy=path),
        lambda: fix(path, path),
        lambda: fix(path, tmp_path / "new.xlsx", marked_copy=path),
        lambda: run(path, tmp_path / "new.xlsx", marked_copy=tmp_path / "new.xlsx"),
    ):
        with pytest.raises(ValueError, match=r"never overwrites|two outputs"):
            call()
    for arguments in (["--apply-fixes"], ["--annotate"]):
        assert "never overwrites" in _call("check", path, *arguments, "-o", path)
    assert _contents(tmp_path) == before


def test_an_input_in_other_letters(tmp_path, monkeypatch):
    """Where letter case does not count, a path in other letters is the same file: what counts is the file's number."""
    path = tmp_path / "in.csv"
    path.touch()
    real = Path.stat
    monkeypatch.setattr(Path, "stat", lambda self, **how: real(path if self.name == "IN.CSV" else self, **how))
    with pytest.raises(ValueError, match="never overwrites"):
        Plan(inputs=[path]).claim(tmp_path / "IN.CSV", named=True)


def test_outputs_in_other_letters_do_not_replace_each_other(tmp_path):
    """Where letter case does not count, the second of two outputs finds the first one written, and gets a number."""
    plan = Plan(inputs=[])
    upper, lower = plan.claim(tmp_path / "A.json"), plan.claim(tmp_path / "a.json")
    assert upper.write(OURS).path == tmp_path / "A.json"
    os.link(tmp_path / "A.json", tmp_path / "a.json")
    assert lower.write(OURS).path == tmp_path / "a (2).json"


@pytest.mark.slow
def test_a_third_submission_is_not_replaced(tmp_path, table, workbook, sound):
    """`run a.xlsx a.csv "a-report (2).xlsx"`: the second report takes the next number."""
    workbook([sound], "a.xlsx")
    table([sound], "a.csv")
    third = workbook([sound], "a-report (2).xlsx")
    before = third.read_bytes()
    assert _run(tmp_path / "a.xlsx", tmp_path / "a.csv", third) == 0
    assert third.read_bytes() == before
    assert {"a-report.xlsx", "a-report (3).xlsx", "a-report (2)-report.xlsx"} <= set(_contents(tmp_path))


@pytest.mark.slow
def test_a_report_that_is_computed_anew_is_not_replaced(tmp_path, table, sound):
    """The report given to --from-report, and the tolerances beside it, are inputs as well."""
    run(table([sound]), tmp_path / "r.xlsx", **FEW)
    before = (tmp_path / "r.xlsx").read_bytes()
    with pytest.raises(ValueError, match="never overwrites"):
        recreate(tmp_path / "r.xlsx", tmp_path / "r.xlsx")
    assert "never overwrites" in _call("run", "--from-report", tmp_path / "r.xlsx", "-o", tmp_path / "r.xlsx")
    (tmp_path / "t.csv").write_text("x", encoding="utf-8")
    done = _call(
        "run", "--from-report", tmp_path / "r.xlsx", "-o", tmp_path / "t.csv", "--tolerances", tmp_path / "t.csv"
    )
    assert "never overwrites" in done
    assert (tmp_path / "r.xlsx").read_bytes() == before


def test_the_old_file_of_an_upgrade_is_not_replaced(tmp_path, workbook, sound):
    """The old template is spared, also by a hard link to it, whatever --force says."""
    old = workbook([sound], "old.xlsx")
    os.link(old, tmp_path / "other.xlsx")
    before = old.read_bytes()
    assert "never overwrites" in _call("template", "--upgrade", old, "-o", tmp_path / "other.xlsx", "--force")
    assert old.read_bytes() == before


@pytest.mark.parametrize("what", ["a link", "a pipe", "a folder"])
def test_a_template_is_written_to_a_file_alone(what, tmp_path):
    """Where a pipe, a link or a folder stands no template is written, whatever --force says, and nothing hangs."""
    IN_THE_WAY[what][0](tmp_path / "t.xlsx")
    before = (tmp_path / "t.xlsx").lstat()
    with pytest.raises(ValueError, match=IN_THE_WAY[what][1]):
        template_output(tmp_path / "t.xlsx", None, force=True)
    assert (tmp_path / "t.xlsx").lstat().st_ino == before.st_ino
    assert not (tmp_path / "nothing").exists()


# Only what flexlash wrote and nobody changed is replaced


@pytest.mark.slow
@pytest.mark.parametrize("ending", ["xlsx", "parquet", "json"])
def test_a_foreign_or_changed_file_is_left_alone(ending, tmp_path, table, sound, capsys):
    """Its own unchanged output is replaced by the same bytes; any other file stays, and the screen names it."""
    path, target = table([sound]), tmp_path / f"out.{ending}"
    assert _run(path, "-o", target) == 0
    first = target.read_bytes()
    assert _run(path, "-o", target, "--quiet") == 0
    assert _contents(tmp_path) == {"submission.csv": path.read_bytes(), target.name: first}
    for other in (FOREIGN, first[:-1], first + b"\n", first.replace(b"flexlash", b"flexlasH", 1)):
        target.write_bytes(other)
        capsys.readouterr()
        assert _run(path, "-o", target, "--quiet") == 0
        assert f"{target} was left alone: flexlash did not write it, or somebody has" in capsys.readouterr().err
        assert target.read_bytes() == other
        assert (tmp_path / f"out (2).{ending}").read_bytes() == first
    assert len(_contents(tmp_path)) == 3


@pytest.mark.slow
def test_work_in_a_report_is_kept(tmp_path, table, sound):
    """A report in which somebody worked stays; the new one is ` (2)`, which is replaced from then on."""
    path, report = table([sound]), tmp_path / "submission-report.xlsx"
    assert _run(path) == 0
    theirs = _worked_in(report)
    for _ in range(2):
        outcome = run(path, report, **FEW)
        assert outcome.outputs == (tmp_path / "submission-report (2).xlsx",)
        assert "was left alone" in outcome.remarks[0]
    assert report.read_bytes() == theirs


@pytest.mark.slow
def test_a_csv_is_replaced_only_by_name_and_header(tmp_path, table, sound):
    """A table has no stamp: it gives way where -o names it and its header row is that of Results."""
    path, target = table([sound]), tmp_path / "out.csv"
    for _ in range(2):
        assert run(path, target, **FEW).outputs == (target,)
    own = target.read_text(encoding="utf-8")
    target.write_text(own.replace(",", ";"), encoding="utf-8")
    assert run(path, target, **FEW).outputs == (tmp_path / "out (2).csv",)
    assert run(path, target, **FEW).outputs == (tmp_path / "out (2).csv",), "the same bytes need no number"
    assert run(path, target, samples=32, method="random").outputs == (tmp_path / "out (3).csv",), "nobody named (2)"
    assert target.read_text(encoding="utf-8") == own.replace(",", ";")


@pytest.mark.slow
def test_own_columns_keep_a_csv_ours(tmp_path, table, sound):
    """Further columns behind those of Results do not make a table foreign."""
    path = table([{**sound, "Drawing": "D-17"}])
    for _ in range(2):
        assert run(path, tmp_path / "out.csv", **FEW).outputs == (tmp_path / "out.csv",)


def test_json_is_one_object_with_a_stamp(tmp_path, table, sound):
    """JSON holds rows, the tolerances used for them and findings; the stamp says what it is."""
    run(table([sound, {**sound, "variant": "b", "torque_Nm": ""}]), tmp_path / "x.json", **FEW)
    found = json.loads((tmp_path / "x.json").read_text(encoding="utf-8"))
    assert list(found) == ["results", "tolerances", "findings", "stamp"]
    assert [row["backlash_rad"] is None for row in found["results"]] == [False, True]
    assert {row["variant"] for row in found["tolerances"]} == {found["results"][0]["variant"]}
    assert [one["code"] for one in found["findings"]] == ["E201"]
    assert stamp_at(tmp_path / "x.json") == "results"


def test_parquet_says_what_it_is(tmp_path, table, sound):
    """The stamp of a Parquet file is in its metadata, and no reader minds it."""
    outcome = run(table([sound]), tmp_path / "x.parquet", **FEW)
    assert pl.read_parquet_metadata(tmp_path / "x.parquet")["flexlash"].startswith("flexlash stamp results ")
    assert pl.read_parquet(tmp_path / "x.parquet").equals(outcome.results)


IN_THE_WAY = {
    "a link": (lambda path: path.symlink_to(path.parent / "nothing"), "it is a link"),
    "a pipe": (os.mkfifo, "it is a pipe") if hasattr(os, "mkfifo") else None,
    "a folder": (lambda path: path.mkdir(), "it is a folder"),
    "a file": (lambda path: path.write_bytes(FOREIGN), "flexlash did not write it"),
}


@pytest.mark.slow
@pytest.mark.parametrize("what", [what for what, made in IN_THE_WAY.items() if made])
@pytest.mark.parametrize("name", ["submission-report.xlsx", "submission-checked.xlsx", "submission-autofixed.xlsx"])
def test_whatever_stands_there_is_neither_followed_nor_waited_for(what, name, tmp_path, workbook, sound, capsys):  # noqa: PLR0917
    """A pipe, a link, a folder or a foreign file stays as it is; the output gets a number, and nothing hangs."""
    make, words = IN_THE_WAY[what]
    path = workbook([sound, {**sound, "variant": "b", "wall_thickness_mm": "1,6 mm"}])
    make(tmp_path / name)
    before = (tmp_path / name).lstat()
    clock = threading.Timer(60, lambda: os.kill(os.getpid(), signal.SIGINT))
    clock.start()
    code = _call("check", path, "--apply-fixes") if "fixed" in name else _run(path)
    clock.cancel()
    assert code in {0, 3}
    assert (tmp_path / name).lstat().st_ino == before.st_ino
    assert not (tmp_path / "nothing").exists()
    assert stamp_at(tmp_path / f"{Path(name).stem} (2).xlsx")
    assert f"{tmp_path / name} was left alone: {words}" in capsys.readouterr().err


# Once more, with everything that is in the folder


def _all(folder, pattern="*.xlsx"):
    return sorted(folder.glob(pattern))


def test_a_second_run_of_the_whole_folder(tmp_path, workbook, sound, capsys):
    """Reports, marked and fixed copies are skipped with an info, the rest is computed, with the same bytes."""
    workbook([sound, {**sound, "variant": "b", "torque_Nm": None}], "a.xlsx")
    workbook([sound], "b.xlsx")
    (tmp_path / "~$a.xlsx").write_bytes(b"\x05Anna " + b" " * 49)
    assert _run(*_all(tmp_path)) == 3
    first = _contents(tmp_path)
    assert {"a-report.xlsx", "a-checked.xlsx", "b-report.xlsx"} < set(first)
    for _ in range(2):
        capsys.readouterr()
        assert _run(*_all(tmp_path)) == 3
        assert _contents(tmp_path) == first
    said = capsys.readouterr().err
    for code, count in (("I508", 2), ("I513", 1), ("I525", 1)):
        assert said.count(f"info {code}") == count
    assert "left alone" not in said


def test_a_second_fixing_of_the_whole_folder(tmp_path, workbook, table, sound, capsys):
    """Fixed workbooks and tables are skipped beside their originals, and fixed again to the same bytes."""
    rows = [{**sound, "wall_thickness_mm": "1,6 mm"}]
    workbook(rows, "a.xlsx")
    table(rows, "b.csv")
    for _ in range(3):
        assert _call("check", "--apply-fixes", "--annotate", *_all(tmp_path, "*.*")) == 0
    assert sorted(_contents(tmp_path)) == ["a-autofixed.xlsx", "a.xlsx", "b-autofixed.csv", "b.csv"]
    assert capsys.readouterr().out.count("info I526") == 4


def test_what_somebody_worked_in_is_skipped_and_kept(tmp_path, workbook, sound):
    """Reports, marked and fixed copies are known by what flexlash wrote in them, also when they were saved since."""
    path = workbook([sound, {**sound, "variant": "b", "wall_thickness_mm": "1,6 mm"}], "a.xlsx")
    assert _run(path) == 3
    assert _call("check", path, "--apply-fixes") == 0
    theirs = {name: _worked_in(tmp_path / f"a-{name}.xlsx") for name in ("report", "checked", "autofixed")}
    for _ in range(2):
        assert _run(*_all(tmp_path)) == 3
        assert _call("check", "--apply-fixes", *_all(tmp_path)) == 0
    assert {name: (tmp_path / f"a-{name}.xlsx").read_bytes() for name in theirs} == theirs
    numbered = {f"a-{name} (2).xlsx" for name in theirs}
    assert set(_contents(tmp_path)) == {"a.xlsx", *(f"a-{name}.xlsx" for name in theirs), *numbered}


def test_a_fixed_file_is_a_submission_without_its_original(tmp_path, workbook, table, sound):
    """An engineer fixes and then runs the fixed file: it is computed, alone and beside other files."""
    rows = [{**sound, "wall_thickness_mm": "1,6 mm"}]
    original, other = workbook(rows, "a.xlsx"), table([sound], "other.csv")
    fix(original, tmp_path / "a-autofixed.xlsx")
    fix(table(rows, "t.csv"), tmp_path / "t-autofixed.csv")
    for name in ("a-autofixed.xlsx", "t-autofixed.csv"):
        fixed = tmp_path / name
        assert run(fixed, **FEW).exit_code == 0
        assert run(fixed, given=[fixed, other], **FEW).exit_code == 0
    _worked_in(tmp_path / "a-autofixed.xlsx")
    assert check(tmp_path / "a-autofixed.xlsx").counts["computed"] == 1


def test_a_fixed_workbook_knows_its_original_by_content(tmp_path, workbook, sound):
    """Under another name or in another folder it is skipped as well while its original is unchanged."""
    original = workbook([{**sound, "wall_thickness_mm": "1,6 mm"}], "a.xlsx")
    (tmp_path / "out").mkdir()
    fixed = tmp_path / "out" / "fixed.xlsx"
    fix(original, fixed)
    given = [original, fixed]
    assert [found.code for found in check(fixed, given=given).findings] == ["I526"]
    _worked_in(fixed)
    assert check(fixed, given=given).skipped
    _worked_in(original)
    assert not check(fixed, given=given).skipped


def test_results_are_no_submission(tmp_path, table, sound):
    """Results as CSV, Parquet or JSON are skipped by what stands in them; nothing but skipped files ends with 4."""
    path = table([{**sound, "Drawing": "D-17"}])
    for ending in ("csv", "parquet", "json"):
        run(path, tmp_path / f"r.{ending}", **FEW)
        assert [found.code for found in check(tmp_path / f"r.{ending}").findings] == ["I527"]
    assert _call("check", path, tmp_path / "r.csv") == 0
    assert _call("check", tmp_path / "r.csv", tmp_path / "r.parquet") == 4
    for name in ("r.json", "~$t.csv"):
        (tmp_path / "~$t.csv").write_bytes(b"x")
        found = check(path, tolerances=tmp_path / name)
        assert (found.skipped, [one.code for one in found.findings]) == (False, ["E101"]), "a table that is none"


def test_marked_copies_can_still_be_submitted(tmp_path, workbook, sound):
    """With --marked-copies a marked copy is computed; its own marked copy never replaces it."""
    path = workbook([sound, {**sound, "variant": "b", "torque_Nm": None}], "a.xlsx")
    check(path, marked_copy=tmp_path / "a-checked.xlsx")
    before = (tmp_path / "a-checked.xlsx").read_bytes()
    for _ in range(2):
        assert _run(tmp_path / "a-checked.xlsx", "--marked-copies") == 3
        assert _call("check", "--annotate", tmp_path / "a-checked.xlsx") == 3
    assert sorted(_contents(tmp_path)) == [
        "a-checked (2).xlsx", "a-checked-report.xlsx", "a-checked.xlsx", "a.xlsx",
    ]  # fmt: skip
    assert (tmp_path / "a-checked.xlsx").read_bytes() == before


def test_marking_the_whole_folder_again(tmp_path, workbook, sound):
    """`check --annotate *.xlsx` again and again makes no marked copies of marked copies."""
    workbook([{**sound, "torque_Nm": None}], "a.xlsx")
    workbook([sound], "b.xlsx")
    for _ in range(3):
        assert _call("check", "--annotate", *_all(tmp_path)) == 4
    assert sorted(_contents(tmp_path)) == ["a-checked.xlsx", "a.xlsx", "b.xlsx"]


# What another program does meanwhile


def test_a_file_that_came_meanwhile_is_left_alone(tmp_path):
    """What another program put at the place of an output after the plan was made stays; the output gets a number."""
    output = Plan(inputs=[]).claim(tmp_path / "out.json")
    (tmp_path / "out.json").write_bytes(FOREIGN)
    written = output.write(OURS)
    assert written.path == tmp_path / "out (2).json"
    assert "was left alone" in written.remark
    assert (tmp_path / "out.json").read_bytes() == FOREIGN


def test_a_file_that_comes_at_the_last_moment_is_left_alone(tmp_path, monkeypatch):
    """Between looking and writing there is no gap: a new name is taken only where there is none."""
    output = Plan(inputs=[]).claim(tmp_path / "out.json")
    link = writing._link

    def late(file, place):
        if place.name == "out.json":
            place.write_bytes(FOREIGN)
        link(file, place)

    monkeypatch.setattr(writing, "_link", late)
    assert output.write(OURS).path == tmp_path / "out (2).json"
    assert (tmp_path / "out.json").read_bytes() == FOREIGN


def test_a_report_changed_at_the_last_moment_is_left_alone(tmp_path, monkeypatch):
    """A file that changes while its stamp is looked at is not replaced."""
    (tmp_path / "out.json").write_bytes(OURS)
    output = Plan(inputs=[]).claim(tmp_path / "out.json")
    real = plan_module.stamp_at

    def slow(path):
        found = real(path)
        path.write_bytes(FOREIGN)
        return found

    monkeypatch.setattr(plan_module, "stamp_at", slow)
    assert output.write(OURS).path == tmp_path / "out (2).json"
    assert (tmp_path / "out.json").read_bytes() == FOREIGN


def test_where_a_file_can_have_one_name_only(tmp_path, monkeypatch):
    """A file system without hard links keeps the promises: a new name only where there is none, no scrap left."""

    def refuse(*_):
        raise OSError(errno.EPERM, "Operation not permitted")

    monkeypatch.setattr(Path, "hardlink_to", refuse)
    output = Plan(inputs=[]).claim(tmp_path / "out.json")
    assert output.write(OURS).path == tmp_path / "out.json"
    (tmp_path / "other.json").write_bytes(FOREIGN)
    assert Plan(inputs=[]).claim(tmp_path / "other.json").write(OURS).path == tmp_path / "other (2).json"
    assert _contents(tmp_path) == {"out.json": OURS, "other.json": FOREIGN, "other (2).json": OURS}


def test_a_report_open_in_excel_is_left_alone(tmp_path, monkeypatch):
    """On Windows a report that is open stays, and the new one is written beside it as ` (2)`, which is told."""
    for name in ("out.json", "out (2).json"):
        (tmp_path / name).write_bytes(OURS)
    replace, rename = Path.replace, Path.rename

    def locked(self, target):
        if target.name == "out.json":
            raise PermissionError(13, "in use")
        return replace(self, target)

    def as_windows_does(self, target):
        if target.exists():
            raise FileExistsError(17, "exists")
        return rename(self, target)

    monkeypatch.setattr(writing, "_HOLDS_OPEN_FILES", True)
    monkeypatch.setattr(Path, "replace", locked)
    monkeypatch.setattr(Path, "rename", as_windows_does)
    written = Plan(inputs=[]).claim(tmp_path / "out.json").write(OURS)
    assert written.path == tmp_path / "out (2).json"
    assert "another program" in written.remark


# Whole or not at all


def _piece_by_piece(data):
    """Return a function that writes these bytes in small pieces."""

    def fill(file):
        for start in range(0, len(data), 7):
            file.write(data[start : start + 7])

    return fill


def test_a_file_in_pieces_is_stamped_like_bytes(tmp_path):
    """A file that is written piece by piece has the bytes and the stamp of the same file written as a whole."""
    empty = json.dumps({"results": ["x" * 50] * 50_000, "stamp": placeholder("results")}).encode()
    Plan(inputs=[]).claim(tmp_path / "pieces.json").write(_piece_by_piece(empty), "results")
    Plan(inputs=[]).claim(tmp_path / "whole.json").write(empty, "results")
    assert (tmp_path / "pieces.json").read_bytes() == (tmp_path / "whole.json").read_bytes() != empty
    assert stamp_at(tmp_path / "pieces.json") == "results"


def test_a_file_in_pieces_replaces_nothing_of_the_users(tmp_path):
    """What is written in pieces leaves a file of the user's alone, and a table of ours with other rows as well."""
    (tmp_path / "out.json").write_bytes(FOREIGN)
    (tmp_path / "out.csv").write_bytes(b"a,b\n1,2\n")
    for name, again in (("out.json", "out (2).json"), ("out.csv", "out (2).csv")):
        written = Plan(inputs=[]).claim(tmp_path / name).write(_piece_by_piece(b"a,b\n1,3\n"))
        assert written.path == tmp_path / again
        assert "was left alone" in written.remark
    same = Plan(inputs=[]).claim(tmp_path / "out.csv").write(_piece_by_piece(b"a,b\n1,2\n"))
    assert (same.path, same.remark) == (tmp_path / "out.csv", "")


def test_a_file_in_pieces_is_whole_or_absent(tmp_path):
    """A fault in the middle of the pieces leaves the earlier file and no scrap."""
    (tmp_path / "out.json").write_bytes(OURS)

    def fill(file):
        file.write(b"half")
        raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(OSError, match="the disk is full") as caught:
        Plan(inputs=[]).claim(tmp_path / "out.json").write(fill)
    assert caught.value.filename == str(tmp_path / "out.json")
    assert _contents(tmp_path) == {"out.json": OURS}


@pytest.mark.skipif(os.name == "nt", reason="POSIX permission bits")
def test_files_have_the_users_permissions(tmp_path):
    """A written file has the permissions that any new file of the user has."""
    (tmp_path / "plain").touch()
    written = Plan(inputs=[]).claim(tmp_path / "out.json").write(OURS)
    assert written.path.stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_a_failed_write_leaves_the_old_file(tmp_path, monkeypatch):
    """When the disk fails in the middle, the earlier file stays whole, no scrap remains, and the output is named."""
    (tmp_path / "out.json").write_bytes(OURS)

    def fail(_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(writing.os, "fsync", fail)
    with pytest.raises(OSError, match="the disk is full") as caught:
        Plan(inputs=[]).claim(tmp_path / "out.json").write(OURS + b" ")
    assert caught.value.filename == str(tmp_path / "out.json")
    assert _contents(tmp_path) == {"out.json": OURS}


_LIMITED = (
    "import resource, sys; resource.setrlimit(resource.RLIMIT_FSIZE, (40_000, 40_000)); "
    "sys.argv[0] = 'flexlash'; from flexlash.cli import main; main()"
)
_SOURCE = {**os.environ, "PYTHONPATH": str(regenerate.ROOT / "src")}


@pytest.mark.skipif(os.name == "nt", reason="POSIX limits of a process")
def test_a_disk_that_is_full_names_the_output(tmp_path, table, sound):
    """When no byte more can be written, the message names the report, not a temporary file or the submission."""
    path = table([sound])
    arguments = ["run", str(path), "--samples", "16", "--method", "random", "--jobs", "1"]
    done = subprocess.run(
        [sys.executable, "-c", _LIMITED, *arguments], env=_SOURCE, capture_output=True, text=True, check=False
    )
    assert done.returncode == 5
    report = tmp_path / "submission-report.xlsx"
    assert f"{report} could not be opened or written: the file becomes larger" in done.stderr
    assert "Traceback" not in done.stderr
    assert list(_contents(tmp_path)) == ["submission.csv"]


def _too_long(folder):
    return folder / f"{'x' * 251}.xlsx"


FAULTY = {
    "a name too long": (_too_long, "its name is too long"),
    "no folder": (lambda folder: folder / "none" / "out.xlsx", "there is no folder"),
    "a file for a folder": (lambda folder: folder / "submission.csv" / "out.xlsx", "is not a folder"),
}


@pytest.mark.parametrize("what", FAULTY)
def test_what_cannot_be_written_is_said_before_computing(what, tmp_path, table, sound, monkeypatch, capsys):  # noqa: PLR0917
    """The output and the reason are named before anything is computed."""
    where, words = FAULTY[what]
    path, target = table([sound]), where(tmp_path)

    def fail(*_):
        raise AssertionError("computed nevertheless")

    monkeypatch.setattr("flexlash.pipeline.examined", fail)
    with pytest.raises(OSError, match=words) as caught:
        run(path, target)
    assert caught.value.filename == str(target)
    assert _run(path, "-o", target) == 5
    assert f"{target} could not be opened or written: " in capsys.readouterr().err


_NOBODY = 65534


def _refused_by(folder):
    """Return why an output in a folder is refused, as an ordinary user sees it: the superuser may write everywhere."""
    read, write = os.pipe()
    with warnings.catch_warnings():
        # A process with threads is copied: the copy needs none of them.
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if not child:
        if os.geteuid() == 0:
            os.setuid(_NOBODY)
        try:
            Plan(inputs=[]).claim(folder / "out.json").require()
        except OSError as fault:
            os.write(write, str(fault).encode())
        os._exit(0)
    os.close(write)
    os.waitpid(child, 0)
    with os.fdopen(read, "rb") as told:
        return told.read().decode()


@pytest.mark.skipif(os.name == "nt", reason="POSIX permission bits")
def test_a_folder_without_permission_is_told():
    """A folder in which nothing may be written is named before computing."""
    with tempfile.TemporaryDirectory() as name:
        Path(name).chmod(0o555)
        told = _refused_by(Path(name))
        Path(name).chmod(0o700)
    assert "you have no permission to write in the folder" in told
    assert told.endswith(f"{name}/out.json'")


def test_a_missing_submission_is_told_first(tmp_path):
    """Where the submission itself is missing, that is said, not that its report has no folder."""
    with pytest.raises(FileNotFoundError) as caught:
        run(tmp_path / "none" / "s.csv", tmp_path / "none" / "out.xlsx")
    assert caught.value.filename == str(tmp_path / "none" / "s.csv")


def test_a_report_without_its_marked_copy(tmp_path, table, sound, capsys):
    """When the report was written and the marked copy was not, both are said, and the exit code is 5."""
    path = table([sound, {**sound, "variant": "b", "torque_Nm": ""}], f"{'x' * 243}.csv")
    report = tmp_path / f"{'x' * 243}-report.xlsx"
    copy = tmp_path / f"{'x' * 243}-checked.xlsx"
    assert _run(path, "--json") == 5
    streams = capsys.readouterr()
    assert f"{copy} could not be written: its name is too long" in streams.err
    assert json.loads(streams.out.splitlines()[0])["outputs"] == [str(report)]
    assert stamp_at(report) == "report"
    assert _run(path) == 5
    assert f"Written: {report}" in capsys.readouterr().out


# What killed runs leave behind

_WRITER = (
    "import sys, time; from pathlib import Path; from flexlash.outputs.writing import temporary\n"
    "with temporary(Path(sys.argv[1]), lambda file: file.write(b'half')):\n"
    "    print('here', flush=True); time.sleep(600)\n"
)
_STUCK = (
    "import os, sys, time; from flexlash.outputs import writing\n"
    "writing.os.fsync = lambda _: (print('here', flush=True), time.sleep(600))\n"
    "sys.argv[0] = 'flexlash'; from flexlash.cli import main; main()\n"
)


@contextlib.contextmanager
def _started(code, *arguments):
    """Start a process and wait until it says that it holds a temporary file; end it in the end."""
    command = [sys.executable, "-c", code, *map(str, arguments)]
    with subprocess.Popen(command, env=_SOURCE, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout.readline() == "here\n"
            yield process
        finally:
            process.kill()


def _leftovers(folder):
    return list(folder.glob(".flexlash-*.tmp"))


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
@pytest.mark.parametrize("sign", ["SIGKILL", "SIGTERM"])
def test_the_next_run_removes_what_a_killed_one_left(sign, tmp_path, table, sound):
    """A command killed while it writes leaves a temporary file; the next run in that folder removes it."""
    path = table([sound])
    with _started(_STUCK, "run", path, "--samples", 16, "--method", "random", "--jobs", 1) as process:
        assert len(_leftovers(tmp_path)) == 1
        assert not list(tmp_path.glob("*-report.xlsx"))
        process.send_signal(getattr(signal, sign))
        process.wait()
    assert len(_leftovers(tmp_path)) == 1
    assert run(path, tmp_path / "out.xlsx", **FEW).outputs == (tmp_path / "out.xlsx",)
    assert _leftovers(tmp_path) == []


def test_what_a_living_run_holds_stays(tmp_path):
    """A temporary file that somebody holds is nobody's leftover, however old it is; nor is a link or a folder one."""
    with _started(_WRITER, tmp_path):
        (held,) = _leftovers(tmp_path)
        os.utime(held, (0, 0))
        (tmp_path / ".flexlash-folder.tmp").mkdir()
        (tmp_path / ".flexlash-link.tmp").symlink_to(held)
        Plan(inputs=[]).claim(tmp_path / "out.json").write(OURS)
        assert len(_leftovers(tmp_path)) == 3
    Plan(inputs=[]).claim(tmp_path / "out.json")
    assert sorted(path.name for path in _leftovers(tmp_path)) == [".flexlash-folder.tmp", ".flexlash-link.tmp"]


def test_many_runs_at_once_take_nothing_from_each_other(tmp_path):
    """Runs that write into one folder, while others clean it, lose no output and replace none of the others'."""
    folder = tmp_path / "out"
    folder.mkdir()
    ends, faults = time.monotonic() + 2, []

    def write(name):
        try:
            while time.monotonic() < ends:
                assert Plan(inputs=[]).claim(folder / name).write(OURS).path == folder / name
        except BaseException as fault:  # noqa: BLE001
            faults.append(fault)

    threads = [threading.Thread(target=write, args=(f"{letter}.json",)) for letter in "abcd"]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert faults == []
    assert _contents(folder) == {f"{letter}.json": OURS for letter in "abcd"}
