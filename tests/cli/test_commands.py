"""`run --from-report` and `diff` as their user meets them: words, exit codes, files."""

from __future__ import annotations

import json

import pytest
from click.testing import CliRunner

from flexlash.cli import cli, main
from flexlash.feedback.template import entry_rules
from flexlash.mechanics import elasticity
from flexlash.pipeline import run


@pytest.fixture(autouse=True)
def _few_rows(monkeypatch):
    """Few prepared rows, for speed."""
    monkeypatch.setattr(entry_rules, "PREPARED_ROWS", 8)


@pytest.fixture
def report(table, sound, tmp_path):
    """Return the report of two variants."""
    path = table([sound, {**sound, "variant": "b"}], "study.csv")
    run(path, tmp_path / "report.xlsx", samples=64)
    return tmp_path / "report.xlsx"


def _call(*arguments):
    return CliRunner().invoke(cli, list(map(str, arguments)))


@pytest.mark.slow
def test_a_report_is_computed_anew(report, tmp_path):
    """Beside the report stand its submission and the same report; the last line says that the numbers are the same."""
    done = _call("run", "--from-report", report)
    assert done.exit_code == 0
    lines = done.stdout.splitlines()
    assert lines[0] == f"{report}: 2 of 2 rows computed."
    assert lines[-3] == f"Written: {tmp_path / 'study-recreated.xlsx'}"
    assert lines[-2] == f"Written: {tmp_path / 'study-recreated-report.xlsx'}"
    assert lines[-1].startswith("Every number of Results equals that of report.xlsx (")
    assert (tmp_path / "study-recreated-report.xlsx").read_bytes() == report.read_bytes()
    assert not (tmp_path / "report-checked.xlsx").exists()


@pytest.mark.slow
def test_options_win_and_differences_are_counted(report, tmp_path):
    """An option on the command line holds; what differs then is counted, and diff tells it."""
    done = _call("run", "--from-report", report, "--seed", 8, "-o", tmp_path / "new.xlsx")
    assert "numbers of Results differ from report.xlsx" in done.stdout.splitlines()[-1]
    lines = _call("diff", report, tmp_path / "new.xlsx").stdout.splitlines()
    assert lines[0] == "0 of 2 variants differ beyond the error of the calculation, 2 within it."
    assert lines[1] == "Settings, seed: 0 → 8, used by all 2 variants"
    assert lines[-1] == "No difference beyond the error of the calculation."


@pytest.mark.slow
def test_json_says_how_many_numbers_were_compared(report):
    """With --json the comparison is a field of the one object."""
    found = json.loads(_call("run", "--from-report", "--json", report).stdout)
    assert found["compared"]["different"] == 0
    assert found["compared"]["numbers"] > 50
    assert len(found["outputs"]) == 2


@pytest.mark.slow
def test_several_reports_of_one_name_into_a_folder(report, tmp_path):
    """Each report gets files of its own, and a file that cannot be opened stops only itself."""
    second = report.with_name("second.xlsx")
    second.write_bytes(report.read_bytes())
    done = _call("run", "--from-report", "--quiet", report, tmp_path / "no.xlsx", second, "-o", tmp_path / "out")
    assert done.exit_code == 5
    names = sorted(path.name for path in (tmp_path / "out").iterdir())
    assert names == ["study-recreated (2).xlsx", "study-recreated-report (2).xlsx", "study-recreated-report.xlsx",
                     "study-recreated.xlsx"]  # fmt: skip


def test_a_submission_is_no_report(table, sound):
    """Given a submission, --from-report says so and computes nothing."""
    done = _call("run", "--from-report", table([sound]))
    assert done.exit_code == 4
    assert "E120" in done.stderr


@pytest.mark.slow
def test_elasticity_of_a_report_can_be_left_out(table, sound, tmp_path, monkeypatch):
    """Where its libraries are missing, the way without them is said."""
    run(table([sound]), tmp_path / "r.xlsx", samples=64, elasticity=True)
    monkeypatch.setattr("flexlash.mechanics.elasticity.is_available", lambda: False)
    done = _call("run", "--from-report", tmp_path / "r.xlsx")
    assert (done.exit_code, "--no-elasticity" in done.stderr) == (2, True)
    assert elasticity.MISSING in done.stderr
    assert _call("run", "--from-report", tmp_path / "r.xlsx", "--no-elasticity").exit_code == 0


@pytest.mark.slow
def test_diff_ends_with_what_matters_and_with_0(report, table, sound):
    """The exit code is 0 whether or not there is a difference; a report is compared with a submission as well."""
    same = _call("diff", report, report)
    assert (same.exit_code, same.stdout) == (0, "No difference in inputs or results.\n")
    done = _call("diff", report, table([sound | {"wall_thickness_mm": 1.7}]))
    assert done.exit_code == 0
    assert done.stdout.splitlines() == [
        "1 of 1 variants differs, 0 are equal.",
        "Settings, samples: 64 → –, used by B3-160",
        "B3-160",
        "    Wall thickness Δ: 1.6 → 1.7 mm (+6.25 %)",
        "Only in report.xlsx: b",
        "1 of 1 variants differs: B3-160 (1 in inputs, 1 removed).",
    ]


@pytest.mark.slow
def test_diff_as_json(report):
    """With --json there is one object and nothing else."""
    found = json.loads(_call("diff", report, report, "--json").stdout)
    assert (found["counts"]["common"], found["variants"], found["results_compared"]) == (2, [], True)


FILES = {"missing": (None, 5), "unreadable": (b"%PDF-1.7", 4), "no table": (b"Dear Sir,\nit, broke\n", 4)}


@pytest.mark.slow
@pytest.mark.parametrize("what", FILES)
@pytest.mark.parametrize("as_json", [False, True])
def test_files_that_cannot_be_compared(what, as_json, report, tmp_path):
    """A missing file ends with 5, an unreadable one with 4, each with its name and without a traceback."""
    content, code = FILES[what]
    if content:
        (tmp_path / "x").write_bytes(content)
    done = _call("diff", report, tmp_path / "x", *["--json"] * as_json)
    assert done.exit_code == code
    assert "x" in done.stderr
    assert bool(done.stdout) is as_json
    assert not as_json or "error" in json.loads(done.stdout)
    missing = _call("diff", tmp_path / "x", tmp_path / "gone")
    assert missing.exit_code == 5


FOLDERS = (
    ["run", "--from-report", "."], ["template", "--upgrade", "."], ["template", "--upgrade", "/"], ["diff", ".", "/"],
)  # fmt: skip


@pytest.mark.parametrize("arguments", FOLDERS, ids=" ".join)
def test_folders_are_no_files(arguments, tmp_path, monkeypatch, capsys):
    """A command that takes files alone and is given a folder says so, ends with 5 and writes nothing."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", ["flexlash", *arguments])
    with pytest.raises(SystemExit) as stop:
        main()
    assert stop.value.code == 5
    assert "this is a folder; give the files in it" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("arguments", [["run"], ["run", "-o", "out"], ["check"], ["check", "--annotate"]], ids=" ".join)
def test_a_folder_without_a_submission_is_nothing(arguments, tmp_path, monkeypatch):
    """Run and check say that there is nothing in a folder to compute, and end with 4; with --json as well."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "letter.docx").touch()
    done = _call(*arguments, "in")
    assert done.exit_code == 4
    assert "in: not read: 1 file of other kinds (.docx)." in done.stderr
    assert "in: there is no submission in this folder" in done.stderr
    assert done.stdout.startswith("Total of 0 submissions")
    told = _call(*arguments, "in", "--json")
    assert json.loads(told.stdout)["total"]["exit_code"] == told.exit_code == 4


def test_an_empty_name_is_not_the_present_folder(tmp_path, monkeypatch):
    """A variable of a script that is not set does not compute whatever lies here."""
    monkeypatch.chdir(tmp_path)
    for command in ("run", "check"):
        done = _call(command, "")
        assert (done.exit_code, "a name is empty" in done.stderr) == (2, True)


@pytest.mark.slow
def test_a_library_that_is_missing_is_no_matter_of_elasticity(report, monkeypatch):
    """Only the elasticity check's own libraries are told with the way without them."""

    def missing(*_, **__):
        raise ModuleNotFoundError("No module named 'other'")

    monkeypatch.setattr("flexlash.cli.recreate_command.recreate", missing)
    done = _call("run", "--from-report", report)
    assert done.exit_code == 1
    assert "Internal error (ModuleNotFoundError)" in done.stderr
    assert "--no-elasticity" not in done.stderr
