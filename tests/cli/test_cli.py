"""The command line as its user meets it: words, exit codes, never a traceback."""

from __future__ import annotations

import csv
import json
import os
import re
import subprocess
import sys

import openpyxl
import pytest
import regenerate
from click.testing import CliRunner

from flexlash import __version__
from flexlash.cli import cli, main
from flexlash.schema.columns import ENTRY_SHEETS, OPTIONAL_SHEETS
from flexlash.schema.decision_results import LEVERS_TABLE
from flexlash.schema.finding_catalogue import CATALOGUE
from flexlash.validation.template_versions import TEMPLATE_VERSION

SHAPE = [
    "submission", "path", "sha256", "version", "seed", "method", "seconds", "exit_code", "error", "counts", "findings",
    "outputs",
]  # fmt: skip
"""Fields of the object that --json prints for every submission."""


def _flexlash(*arguments, **environment):
    """Run the command as a user would, in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "flexlash", *map(str, arguments)],
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
        env={**os.environ, "PYTHONPATH": str(regenerate.ROOT / "src"), "PYTHONIOENCODING": "utf-8", **environment},
    )


@pytest.fixture
def main_in(monkeypatch):
    """Return a function that runs `main` in this process and gives its exit code."""

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["flexlash", *map(str, arguments)])
        try:
            main()
        except SystemExit as stop:
            return stop.code or 0
        return 0

    return call


@pytest.mark.slow
def test_run_computes_and_says_what_it_wrote(table, sound):
    """A sound submission ends with 0, a report beside it, and its path on stdout."""
    path = table([sound])
    done = _flexlash("run", path, "--samples", 512)
    report = path.with_name("submission-report.xlsx")
    assert done.returncode == 0
    assert done.stderr == ""
    assert done.stdout.splitlines()[0] == f"{path}: 1 of 1 rows computed."
    assert done.stdout.splitlines()[-1] == f"Written: {report}"
    assert report.exists()


@pytest.mark.slow
@pytest.mark.parametrize("ending", [".xlsx", ".csv", ".parquet", ".json"])
def test_run_writes_the_form_that_the_ending_names(table, sound, tmp_path, ending, main_in):
    """-o decides the form of the output by its ending."""
    target = tmp_path / f"out{ending}"
    assert main_in("run", table([sound]), "-o", target, "--samples", 256, "--quiet") == 0
    assert target.stat().st_size > 100


@pytest.mark.slow
def test_check_prints_findings_and_the_next_command(table, sound, capsys, main_in):
    """Check prints each finding with its place, what is required and the fix, then what to do next."""
    path = table([sound, {**sound, "variant": "b", "wall_thickness_mm": "1,6"}])
    assert main_in("check", path) == 3
    lines = capsys.readouterr().out.splitlines()
    assert lines == [
        "error E202 text instead of a number, 1 cell: Variants!G3",
        '    Variants!G3 Wall thickness Δ = "1,6": a length in mm above 0 is required; did you mean 1.6?',
        "    Fix: Type the number alone, without unit, with the decimal sign that your program uses.",
        f"{path}: 1 of 2 rows ready; 1 cell to fix.",
        f"Next: fix that and check again, or compute the 1 row: flexlash run {path}",
    ]


@pytest.mark.slow
def test_findings_of_one_rule_are_drawn_together(table, sound, capsys, main_in):
    """Five hundred rows with the same fault print one heading with their range, not five hundred messages."""
    rows = [{**sound, "variant": f"v{number}", "torque_Nm": ""} for number in range(500)]
    assert main_in("check", table([*rows, sound])) == 3
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "error E201 required cell empty, 500 cells: Variants!D2:D501"
    assert "    … and 497 more of the same kind; the marked copy (check --annotate) lists them all" in lines
    assert len(lines) < 10


def test_repairs_of_one_kind_are_one_line(table, sound, capsys, main_in):
    """Information of one kind is drawn together without its messages, which are in the report."""
    rows = [{**sound, "variant": f"v{number}", "flexspline_type": "Cup"} for number in range(4)]
    assert main_in("check", table(rows)) == 0
    assert capsys.readouterr().out.splitlines()[0] == "info I504 spelling repaired, 4 cells: Variants!B2:B5"


@pytest.mark.slow
def test_run_keeps_results_and_messages_apart(table, sound, capsys, main_in):
    """Run prints findings on stderr and the summary on stdout."""
    path = table([sound, {**sound, "variant": "b", "torque_Nm": -1}])
    assert main_in("run", path, "--samples", 256) == 3
    streams = capsys.readouterr()
    assert "E207" in streams.err
    assert "E207" not in streams.out
    assert "1 of 2 rows computed; 1 cell to fix." in streams.out


@pytest.mark.slow
def test_run_names_the_worst_variants(table, sound, capsys, main_in):
    """Run says how many variants are over their limit and names the worst with its probability."""
    rows = [{**sound, "variant": f"v{number}", "backlash_limit_arcmin": 3.0 + number / 2} for number in range(4)]
    assert main_in("run", table(rows)) == 0
    out = capsys.readouterr().out
    assert (
        "Of 4 variants with a limit 2 fail, 0 are marginal and 2 meet it: 2U at full torque, with at most 0.135 %"
        in out
    )
    assert "  v0: practically all units are over 3′." in out
    assert "  v1: practically all units are over 3.5′." in out


@pytest.mark.slow
def test_run_with_one_scattering_dimension_tells_its_share(table, sound, tmp_path, capsys, main_in):
    """Where but one dimension scatters, the share over the limit is told to its digits, not as all or none."""
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(
        "tolerance_class,dimension,lower_deviation,upper_deviation,deviation_unit\nstandard,youngs_modulus,-3,3,%\n",
        encoding="utf-8",
    )
    rows = [sound, {**sound, "variant": "tight", "backlash_limit_arcmin": 3.65}]
    assert main_in("run", table(rows), "--tolerances", tolerances) == 0
    out = capsys.readouterr().out
    assert re.search(r"^  tight: 84\.\d+ %.* of units are over 3\.65′; 84\.\d+ % of lots fail\.$", out, re.MULTILINE)
    assert re.search(r"^  B3-160: 4\.6\d* %.* of units are over 3\.75′; 4\.6\d* % of lots fail\.$", out, re.MULTILINE)


@pytest.mark.slow
def test_cross_check_says_whether_both_agree(table, sound, tmp_path, capsys, main_in):
    """--cross-check says for how many variants plain Monte Carlo agrees, and puts its columns into the output."""
    rows = [{**sound, "variant": f"v{number}", "torque_Nm": 700.0 + number} for number in range(3)]
    target = tmp_path / "out.csv"
    assert main_in("run", table(rows), "--cross-check", "-o", target) == 0
    said = (
        r"^Plain Monte Carlo agrees for 3 of 3 variants; the greatest difference is [0-3]\.\d combined standard errors"
    )
    assert re.search(said, capsys.readouterr().out, re.MULTILINE)
    with target.open(encoding="utf-8", newline="") as file:
        assert [row["cross_check"] for row in csv.DictReader(file)] == ["agrees"] * 3
    assert main_in("run", table(rows), "-o", target) == 0
    assert "Plain Monte Carlo" not in capsys.readouterr().out
    assert "cross_check" not in target.read_text(encoding="utf-8").splitlines()[0]


@pytest.mark.slow
def test_cross_check_of_plain_monte_carlo_says_nothing(table, sound, capsys, main_in):
    """Plain Monte Carlo is not checked against itself, and nothing is said of agreement."""
    assert main_in("run", table([sound]), "--cross-check", "--method", "random", "--samples", 256) == 0
    assert "agrees" not in capsys.readouterr().out


@pytest.mark.slow
def test_json_names_the_method_that_was_set(table, sound, capsys, main_in):
    """--json names the method of the settings, line unless told otherwise."""
    for options, method in (([], "line"), (["--method", "sobol"], "sobol")):
        assert main_in("run", table([sound]), "--json", "--samples", 256, *options) == 0
        assert json.loads(capsys.readouterr().out)["method"] == method


@pytest.mark.parametrize("jobs", [0, -1])
def test_jobs_must_be_at_least_one(table, sound, main_in, capsys, jobs):
    """A number of jobs below 1 is a usage error."""
    assert main_in("run", table([sound]), "--jobs", jobs) == 2
    assert "--jobs" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize(
    ("content", "code"),
    [("not a table", 4), ("variant,material\n", 4), ("%PDF-1.7", 4)],
)
def test_unreadable_submissions_end_with_four(tmp_path, content, code, main_in, capsys):
    """A file that is no submission ends with 4 and one sentence."""
    path = tmp_path / "x.xlsx"
    path.write_text(content, encoding="utf-8")
    assert main_in("run", path) == code
    assert "Traceback" not in capsys.readouterr().err
    assert main_in("check", path) == code


def test_a_missing_file_ends_with_five(tmp_path, capsys, main_in):
    """A file that cannot be opened ends with 5, by name."""
    assert main_in("check", tmp_path / "none.xlsx") == 5
    assert "none.xlsx could not be opened: there is no such file" in capsys.readouterr().err


def test_an_unwritable_output_ends_with_five(table, sound, tmp_path, capsys, main_in):
    """An output whose folder does not exist ends with 5, by name."""
    target = tmp_path / "none" / "out.csv"
    assert main_in("run", table([sound]), "-o", target, "--samples", 256) == 5
    assert f"{target} could not be opened or written: there is no folder {target.parent}" in capsys.readouterr().err


@pytest.mark.slow
def test_several_submissions_need_a_folder_and_get_distinct_names(table, sound, tmp_path, main_in, capsys):
    """Several submissions go to a folder; equal names are numbered; the most severe exit code wins."""
    first = table([sound])
    (tmp_path / "other").mkdir()
    second = tmp_path / "other" / "submission.csv"
    second.write_bytes(first.read_bytes())
    assert main_in("run", first, second, "-o", tmp_path / "one.xlsx") == 2
    assert "need a folder" in capsys.readouterr().err
    folder = tmp_path / "reports"
    code = main_in("run", first, second, tmp_path / "none.csv", "-o", folder, "--samples", 256)
    assert code == 5
    names = sorted(path.name for path in folder.iterdir() if "report" in path.name)
    assert names == ["submission-report (2).xlsx", "submission-report.xlsx"]


@pytest.mark.slow
def test_the_most_severe_exit_code_wins(table, sound, tmp_path, main_in):
    """Of 3 and 4 the submission that could not be computed decides."""
    some = table([sound, {**sound, "variant": "b", "torque_Nm": ""}], "some.csv")
    none = table([{**sound, "torque_Nm": ""}], "none.csv")
    assert main_in("check", some, none) == 4
    assert main_in("check", some) == 3
    assert main_in("check", none, tmp_path / "missing.csv", some) == 5


@pytest.mark.slow
def test_reports_among_submissions_are_skipped(table, sound, tmp_path, main_in, capsys):
    """A report in a submitted folder is named and skipped; alone, there is nothing to compute."""
    path = table([sound])
    assert main_in("run", path, "-o", tmp_path / "report.xlsx", "--samples", 256, "--quiet") == 0
    assert main_in("check", path, tmp_path / "report.xlsx") == 0
    assert "report.xlsx is a report of flexlash" in capsys.readouterr().out
    assert main_in("check", tmp_path / "report.xlsx") == 4


def test_the_output_may_not_be_the_submission(table, sound, main_in, capsys):
    """A submission is never overwritten, however its path is spelt."""
    path = table([sound])
    before = path.read_bytes()
    assert main_in("run", path, "-o", path.parent / "." / path.name) == 2
    assert "never overwrites" in capsys.readouterr().err
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    "arguments",
    [["run"], ["run", "x.csv", "--method", "magic"], ["run", "x.csv", "-o", "x.txt"], ["explain", "E999"], ["fly"]],
)
def test_usage_errors_end_with_two(arguments, main_in, capsys):
    """A wrong call ends with 2 and says what is wrong."""
    assert main_in(*arguments) == 2
    assert "Error" in capsys.readouterr().err


@pytest.mark.slow
def test_strict_ends_with_four(table, sound, main_in, tmp_path):
    """--strict with a bad row ends with 4 and writes nothing, for check and run alike."""
    path = table([sound, {**sound, "variant": "b", "torque_Nm": ""}])
    assert main_in("check", path, "--strict") == 4
    assert main_in("run", path, "--strict", "-o", tmp_path / "out.csv") == 4
    assert not (tmp_path / "out.csv").exists()


@pytest.mark.slow
def test_json_is_one_object_per_submission(table, sound, tmp_path):
    """--json prints the contract's object for each submission on a line of its own, and nothing else."""
    good = table([sound], "good.csv")
    bad = table([{**sound, "torque_Nm": "x"}], "bad.csv")
    done = _flexlash("run", good, bad, "-o", tmp_path / "out", "--json", "--samples", 256)
    first, second, last = map(json.loads, done.stdout.splitlines())
    assert list(first) == list(second) == SHAPE
    assert first["counts"] == {
        "rows": 1, "computed": 1, "errors": 0, "warnings": 0, "meets": 0, "marginal": 1, "fails": 0,
    }  # fmt: skip
    assert last == {"total": {"submissions": 2, "computed": 1, "partly": 0, "not": 1, "exit_code": 4}}
    assert first["version"] == __version__
    assert first["outputs"] == [str(tmp_path / "out" / "good-report.xlsx")]
    assert second["outputs"] == [str(tmp_path / "out" / "bad-checked.xlsx")]
    assert [(one["code"], one["cell"], one["value"]) for one in second["findings"]] == [("E202", "D2", "x")]
    assert set(second["findings"][0]) == {
        "level", "code", "sheet", "cell", "variant", "column", "value", "message", "fix", "suggestion",
    }  # fmt: skip
    assert done.returncode == 4


def test_json_of_a_missing_file_is_an_object_too(tmp_path, capsys, main_in):
    """--json keeps one object per submission even when a file cannot be opened."""
    assert main_in("check", "--json", tmp_path / "none.csv") == 5
    assert "none.csv" in json.loads(capsys.readouterr().out)["error"]


@pytest.mark.slow
def test_quiet_prints_nothing_when_all_is_well(table, sound, capsys, main_in):
    """--quiet is silent on success and speaks when something failed."""
    assert main_in("run", table([sound]), "--quiet", "--samples", 256) == 0
    assert capsys.readouterr().out == ""
    assert main_in("run", table([{**sound, "torque_Nm": ""}]), "--quiet") == 4
    assert "E201" in capsys.readouterr().err


@pytest.mark.slow
def test_template_never_overwrites_a_filled_one(tmp_path, capsys, main_in):
    """An existing template may be filled, so it is only replaced when told to."""
    path = tmp_path / "mine.xlsx"
    assert main_in("template", "-o", path) == 0
    assert path.read_bytes() == (regenerate.ROOT / "templates" / "flexlash-template.xlsx").read_bytes()
    path.write_bytes(b"filled")
    assert main_in("template", "-o", path) == 2
    assert path.read_bytes() == b"filled"
    assert "--force" in capsys.readouterr().err
    assert main_in("template", "--example", "-o", path, "--force") == 0
    assert path.read_bytes() == (regenerate.ROOT / "data" / "b3-160-study.xlsx").read_bytes()


@pytest.mark.slow
def test_template_upgrade_moves_an_old_file(table, sound, capsys, main_in):
    """--upgrade writes a filled template beside the old file, says how many rows moved, and ends with the next step."""
    old = table([{**sound, "day": "1"}, {**sound, "variant": "b", "torque_Nm": ""}])
    new = old.with_name(f"submission-v{TEMPLATE_VERSION}.xlsx")
    assert main_in("template", "--upgrade", old) == 0
    said = capsys.readouterr()
    assert said.out.splitlines() == [f"{old}: 2 rows of Variants carried over.", f"Template written: {new}"]
    assert said.err.splitlines() == [f"Look it over, then: flexlash check {new}"]
    assert main_in("check", new) == 3
    assert "Variants!D6" in capsys.readouterr().out


@pytest.mark.slow
def test_template_upgrade_says_what_could_not_move(tmp_path, capsys, main_in):
    """What the new template cannot hold is listed, one line each."""
    old = tmp_path / "old.xlsx"
    book = openpyxl.load_workbook(regenerate.ROOT / "data" / "b3-160-study.xlsx")
    book.create_sheet("Drawings")["A1"] = "x"
    book["Variants"]["H5"] = "=H6"
    book.save(old)
    assert main_in("template", "--upgrade", old, "-o", tmp_path / "new.xlsx") == 0
    said = capsys.readouterr()
    assert (
        said.out.splitlines()[0]
        == f"{old}, made from template version {TEMPLATE_VERSION}: 11 rows of Variants carried over."
    )
    assert said.err.splitlines()[:2] == [
        "  Variants!H5: formulas that never stored a result show #N/A until you enter their values.",
        "  The sheet Drawings with 1 row was left behind.",
    ]


@pytest.mark.slow
def test_template_upgrade_overwrites_neither_old_nor_new(tmp_path, table, sound, capsys, main_in):
    """An existing file is replaced when told to, the old one never."""
    old = table([sound])
    before = old.read_bytes()
    new = tmp_path / f"submission-v{TEMPLATE_VERSION}.xlsx"
    new.write_bytes(b"filled")
    assert main_in("template", "--upgrade", old) == 2
    assert new.read_bytes() == b"filled"
    assert main_in("template", "--upgrade", old, "-o", old, "--force") == 2
    assert old.read_bytes() == before
    assert "never overwrites" in capsys.readouterr().err
    assert main_in("template", "--upgrade", old, "--force") == 0
    assert new.read_bytes().startswith(b"PK")


@pytest.mark.parametrize(
    ("content", "code", "words"),
    [
        (b"PK\x03\x04 damaged", 4, "E102 old.xlsx is damaged"),
        (b"%PDF-1.4", 4, "E101 old.xlsx cannot be read as a submission"),
        (None, 5, "old.xlsx: there is no such file"),
    ],
)
def test_template_upgrade_refuses_in_words(tmp_path, capsys, main_in, content, code, words):  # noqa: PLR0917
    """What is no template ends with 4 and what is not there with 5; nothing is written."""
    old = tmp_path / "old.xlsx"
    if content is not None:
        old.write_bytes(content)
    assert main_in("template", "--upgrade", old, "-o", tmp_path / "new.xlsx") == code
    said = capsys.readouterr().err
    assert words in said
    assert code == 5 or said.splitlines()[-1].startswith("Fix: ")
    assert not (tmp_path / "new.xlsx").exists()


def test_template_upgrade_usage(main_in):
    """The example is no place for an old file."""
    assert main_in("template", "--upgrade", "x.xlsx", "--example") == 2


@pytest.mark.slow
@pytest.mark.parametrize(
    ("named", "sheets"),
    [
        (["--with", "measurements"], ["Measurements"]),
        (["--with", " Correlations ,measurements"], ["Measurements", "Correlations"]),
        (["--with", "measurements", "--with", "correlations"], ["Measurements", "Correlations"]),
        (["--with", "all", "--example"], [*OPTIONAL_SHEETS]),
        (["--example"], []),
    ],
)
def test_template_with_optional_sheets(tmp_path, main_in, named, sheets):
    """--with adds the sheets that it names, with commas or one by one; all adds each that there is."""
    assert main_in("template", "-o", tmp_path / "new.xlsx", *named) == 0
    written = openpyxl.load_workbook(tmp_path / "new.xlsx").sheetnames
    assert written == ["Variants", "Sketch", "Materials", "Tolerances", "Settings", *sheets, "Dictionary", "Lists"]


@pytest.mark.slow
def test_template_upgrade_with_optional_sheets(tmp_path, table, sound, main_in):
    """--upgrade and --with go together."""
    assert main_in("template", "--upgrade", table([sound]), "--with", "all", "-o", tmp_path / "new.xlsx") == 0
    assert {"Measurements", "Correlations"} < {*openpyxl.load_workbook(tmp_path / "new.xlsx").sheetnames}


@pytest.mark.parametrize(
    ("named", "words"),
    [
        (
            "measurement",
            "there is no optional sheet measurement. There are measurements, correlations, other-sources, levers, "
            "sweep and all.",
        ),
        ("all,sweeps", "there is no optional sheet sweeps."),
        ("other sources", "there is no optional sheet other sources."),
    ],
)
def test_template_says_which_optional_sheets_there_are(tmp_path, main_in, capsys, named, words):
    """A sheet that there is not is a mistake of usage; nothing is written."""
    assert main_in("template", "-o", tmp_path / "new.xlsx", "--with", named) == 2
    assert words in " ".join(capsys.readouterr().err.split())
    assert not (tmp_path / "new.xlsx").exists()


def test_schema_json_is_the_dictionary():
    """Schema --json lists every column of every sheet with the contract's fields."""
    columns = json.loads(CliRunner().invoke(cli, ["schema", "--json"]).stdout)
    fields = {"sheet", "key", "label", "unit", "type", "required", "minimum", "maximum", "choices", "default", "help"}
    assert all(fields <= set(column) for column in columns)
    keys = [column["key"] for column in columns if column["sheet"] == "Variants"]
    assert keys == [column.key for column in ENTRY_SHEETS["Variants"]]
    assert {column["sheet"] for column in columns} == {
        *ENTRY_SHEETS,
        "Results",
        "Tolerances used",
        "Levers table",
        "Allocation",
        "Findings",
    }
    assert [one["key"] for one in columns if one["sheet"] == "Levers table"] == [one.key for one in LEVERS_TABLE]
    places = [(column["sheet"], column["key"]) for column in columns]
    assert len(places) == len({*places})


def test_schema_in_words():
    """Schema without --json prints each key with its label and meaning."""
    out = CliRunner().invoke(cli, ["schema"]).stdout
    assert "  torque_Nm                        Torque T [N·m], required" in out


def test_explain_prints_meaning_and_fix():
    """Explain takes a code in any case and prints what it means; without a code it lists them."""
    out = CliRunner().invoke(cli, ["explain", "e303"]).stdout
    assert out.startswith("E303 error: hub outside the disk\n")
    assert "Fix: Check for a diameter" in out
    assert CliRunner().invoke(cli, ["explain", " 303"]).stdout == out
    for unknown in ("999", "30", "E", ""):
        assert CliRunner().invoke(cli, ["explain", unknown]).exit_code == 2
    for code in CATALOGUE:
        assert "{" not in CliRunner().invoke(cli, ["explain", code]).stdout
    assert "W402  warning  beyond yield" in CliRunner().invoke(cli, ["explain"]).stdout


def test_help_and_version():
    """Help leads with examples and tells the exit codes; --version names the program."""
    out = CliRunner().invoke(cli, ["--help"]).stdout
    assert "\b" not in out
    assert re.search(r"\n +flexlash run variants.xlsx +compute it", out)
    assert "Exit codes" in out
    assert CliRunner().invoke(cli, ["--version"]).stdout == f"flexlash, version {__version__}\n"


def test_an_internal_error_is_one_sentence(table, sound, monkeypatch, capsys, main_in):
    """A defect ends with 1 and one sentence; FLEXLASH_DEBUG=1 shows where it happened."""

    def fail(*_, **__):
        raise ZeroDivisionError

    monkeypatch.setattr("flexlash.batch.compute.examined", fail)
    path = table([sound])
    assert main_in("check", path) == 1
    err = capsys.readouterr().err
    assert err == (
        f"{path}: Internal error (ZeroDivisionError): this is a fault of flexlash, not of your file. "
        "Set FLEXLASH_DEBUG=1 for details.\n"
    )
    monkeypatch.setenv("FLEXLASH_DEBUG", "1")
    assert main_in("check", path) == 1
    assert "Traceback" in capsys.readouterr().err


def test_an_interrupt_ends_with_130(table, sound, monkeypatch, capsys, main_in):
    """Ctrl-C ends with 130 and says so."""

    def interrupt(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("flexlash.batch.side_by_side.wait", interrupt)
    assert main_in("check", table([sound])) == 130
    assert "Interrupted." in capsys.readouterr().err


@pytest.mark.slow
def test_a_closed_pipe_is_no_error():
    """Piping the dictionary into a program that stops reading prints no complaint."""
    command = f"'{sys.executable}' -m flexlash schema --json | head -c 100"
    environment = {**os.environ, "PYTHONPATH": str(regenerate.ROOT / "src")}
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, check=False, env=environment)
    assert done.stderr == ""


@pytest.mark.slow
def test_a_terminal_gets_a_progress_bar_and_a_pipe_none(table, sound, monkeypatch, capsys, main_in):
    """The progress bar is drawn on a terminal only."""
    path = table([{**sound, "variant": f"v{number}"} for number in range(10)])
    assert main_in("run", path, "--samples", 256) == 0
    assert "Computing" not in capsys.readouterr().err
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    assert main_in("run", path, "--samples", 256) == 0
    assert "Computing" in capsys.readouterr().err


@pytest.mark.slow
def test_no_color_is_honoured(table, sound):
    """With NO_COLOR, or into a pipe, no escape codes are printed."""
    done = _flexlash("check", table([{**sound, "torque_Nm": ""}]), NO_COLOR="1")
    assert "\x1b" not in done.stdout + done.stderr


@pytest.mark.slow
def test_where_check_writes(table, sound, tmp_path, main_in, capsys):
    """A marked copy goes where -o says, a workbook or a folder; -o without anything to write is a usage error."""
    path = table([{**sound, "torque_Nm": ""}])
    assert main_in("check", path, "--annotate", "-o", tmp_path / "marked.xlsx") == 4
    assert (tmp_path / "marked.xlsx").exists()
    assert main_in("check", path, "--annotate", "-o", tmp_path / "folder") == 4
    assert (tmp_path / "folder" / "submission-checked.xlsx").exists()
    capsys.readouterr()
    assert main_in("check", path, "-o", tmp_path / "x.xlsx") == 2
    assert "--apply-fixes or --annotate" in capsys.readouterr().err
    assert main_in("check", path, "--annotate", "-o", tmp_path / "x.csv") == 2
    assert "must end in .xlsx" in capsys.readouterr().err


@pytest.mark.slow
def test_the_next_command_names_the_fixed_file(table, sound, tmp_path, main_in, capsys):
    """After fixing, the closing lines speak of the new file, which is the one to run."""
    path = table([{**sound, "wall_thickness_mm": "1,6 mm"}])
    assert main_in("check", path, "--apply-fixes", "-o", tmp_path / "new.csv") == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "1 cell fixed:"
    assert lines[-1] == f"Next: flexlash run {tmp_path / 'new.csv'}"
    assert f"{tmp_path / 'new.csv'}: 1 of 1 rows ready." in lines
