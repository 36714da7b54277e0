"""Many files and folders: side by side, told in order, summed up, taken up again where a run was stopped."""

from __future__ import annotations

import json
import os
import shutil
import signal
import sys
import time
from concurrent.futures import Future
from contextlib import contextmanager
from pathlib import Path

import pytest
import xlsxwriter
from batch_runs import begun, done, ended, none_left, outputs, parts, processes_of, stopped
from click.testing import CliRunner
from here import WORKERS, HereExecutor

from flexlash.batch.answer import Task
from flexlash.batch.executor import WorkerLostError
from flexlash.cli import cli

POSIX = pytest.mark.skipif(os.name == "nt", reason="signals and limits are those of POSIX systems")
LINUX = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks at /proc")


def _call(*arguments):
    return CliRunner().invoke(cli, list(map(str, arguments)))


@pytest.fixture
def folder(table, sound, tmp_path, monkeypatch):
    """Return the present folder, with `in`: two sound tables, one in part, one that is none, one in a sub-folder."""
    bad = {**sound, "variant": "bad", "torque_Nm": ""}
    sub = tmp_path / "in" / "sub"
    sub.mkdir(parents=True)
    for place, rows in {
        "in/a.csv": [sound],
        "in/b.csv": [sound, bad],
        "in/d.csv": [sound],
        "in/sub/a.csv": [bad],
    }.items():
        table(rows, "written.csv").rename(tmp_path / place)
    (tmp_path / "in" / "c.xlsx").write_text("{\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


RUN = ("run", "in", "--samples", 64, "-o", "out")


@pytest.mark.usefixtures("folder")
def test_a_folder_has_a_line_a_submission_and_a_total():
    """Each in order of name, with what was written; what could not be read on standard error; then the summary."""
    said = _call(*RUN)
    assert said.exit_code == 4
    assert said.stdout.splitlines() == [
        "in/a.csv: 1 of 1 rows computed. Limit not met by 1 of 1 variant. Written: out/a-report.xlsx",
        "in/b.csv: 1 of 2 rows computed; 1 cell to fix. Limit not met by 1 of 1 variant. "
        "Written: out/b-report.xlsx, out/b-checked.xlsx",
        "in/d.csv: 1 of 1 rows computed. Limit not met by 1 of 1 variant. Written: out/d-report.xlsx",
        "Total of 4 submissions: 2 computed, 1 computed in part, 1 not.",
        "Written: out/flexlash-summary.xlsx, out/flexlash-summary.jsonl",
    ]
    assert said.stderr.startswith("in/c.xlsx: E101 c.xlsx cannot be read as a submission")
    verbose = _call(*RUN, "-v")
    assert "in/b.csv: error E201" in verbose.stderr
    assert "No report was written" in verbose.stdout


def test_an_empty_folder_is_told_what_would_help(tmp_path):
    """--recursive is advised where it was not given."""
    for option, told in (((), "in this folder, no workbook"), (("--recursive",), "in this folder or below it, no")):
        said = _call("check", tmp_path, *option)
        assert said.exit_code == 4
        assert told in said.stderr
        assert ("--recursive" in said.stderr) is not bool(option)


@pytest.mark.usefixtures("folder")
def test_whatever_is_written_is_told():
    """The copy that says what a foreign workbook lacks is named, too, where each submission has one line."""
    xlsxwriter.Workbook("in/c.xlsx").close()
    said = _call(*RUN)
    (line,) = (line for line in said.stderr.splitlines() if line.startswith("in/c.xlsx"))
    assert line.startswith("in/c.xlsx: E108 ")
    assert line.endswith("Written: out/c-checked.xlsx")
    assert Path("out/c-checked.xlsx").exists()


@pytest.mark.usefixtures("folder")
def test_json_has_an_object_a_submission_and_a_total():
    """The lines of the summary are those on standard output but for the time, and so is the total."""
    *objects, last = map(json.loads, _call(*RUN, "--json").stdout.splitlines())
    *lines, total = map(json.loads, Path("out/flexlash-summary.jsonl").read_text(encoding="utf-8").splitlines())
    assert [one["path"] for one in objects] == ["in/a.csv", "in/b.csv", "in/c.xlsx", "in/d.csv"]
    assert [{key: value for key, value in one.items() if key != "seconds"} for one in objects] == lines
    assert last["total"] == total["total"] == {
        "submissions": 4, "computed": 2, "partly": 1, "not": 1, "exit_code": 4,
    }  # fmt: skip


@pytest.mark.usefixtures("folder")
def test_sub_folders_are_kept_and_quiet_is_quiet():
    """With --recursive a report lies where its submission lay; --quiet prints what failed and the total alone."""
    said = _call(*RUN, "--recursive", "--quiet")
    assert sorted(path.as_posix() for path in Path("out").rglob("*.xlsx")) == [
        "out/a-report.xlsx", "out/b-checked.xlsx", "out/b-report.xlsx", "out/c-checked.xlsx", "out/d-report.xlsx",
        "out/flexlash-summary.xlsx", "out/sub/a-checked.xlsx",
    ]  # fmt: skip
    assert [line.split(":")[0] for line in said.stdout.splitlines()[:-1]] == [
        "in/b.csv",
        "in/sub/a.csv",
        "Total of 5 submissions",
    ]


@pytest.mark.usefixtures("folder")
def test_outputs_in_the_folder_itself_are_skipped_the_next_time():
    """Reports, marked copies and the summary beside the submissions are told by number, never marked, and replaced."""
    arguments = ("run", "in", "--samples", 64, "-o", "in")
    _call(*arguments)
    before = {path.name: path.read_bytes() for path in Path("in").iterdir() if path.suffix == ".xlsx"}
    again = _call(*arguments)
    assert again.stdout.splitlines()[-2] == "Total of 4 submissions: 2 computed, 1 computed in part, 1 not; 6 skipped."
    assert "4 files, report skipped: in/a-report.xlsx" in again.stderr
    assert "2 files, marked copy skipped: in/b-checked.xlsx" in again.stderr
    after = {path.name: path.read_bytes() for path in Path("in").iterdir() if path.suffix == ".xlsx"}
    assert after == before
    told = [json.loads(line) for line in _call(*arguments, "--json").stdout.splitlines()[:-1]]
    codes = [
        one["findings"][0]["code"] for one in told if one["submission"].endswith(("-report.xlsx", "-checked.xlsx"))
    ]
    assert codes == ["I508", "I513", "I508", "I513", "I508"]


def test_a_check_takes_folders(folder):
    """Check looks at all of a folder, writes nothing but what is asked for, and no summary."""
    said = _call("check", "in", "--recursive")
    assert said.exit_code == 4
    assert said.stdout.splitlines()[-1] == "Total of 5 submissions: 2 ready, 1 ready in part, 2 not."
    assert not Path("out").exists()
    _call("check", "in", "--recursive", "--annotate", "-o", "out")
    assert sorted(outputs(folder)) == ["out/b-checked.xlsx", "out/c-checked.xlsx", "out/sub/a-checked.xlsx"]


@pytest.mark.parametrize("workers", [1, 3])
def test_the_order_is_that_of_the_names_whoever_ends_first(folder, monkeypatch, workers):
    """Answers that come in any order are told in order, and give the same bytes."""
    _call(*RUN)
    straight = outputs(folder)
    shutil.rmtree("out")

    class Backwards(HereExecutor):
        """Answers the last task first."""

        def __init__(self):
            self.workers, self.tasks = workers, []

        def submit(self, work, data):
            future = Future()
            self.tasks.append((future, work, data))
            if len(self.tasks) >= min(2 * workers, 3):
                for waiting, its_work, its_data in reversed(self.tasks):
                    waiting.set_result(its_work(its_data))
                self.tasks.clear()
            elif workers == 1:
                self.tasks.pop()
                future.set_result(work(data))
            return future

    @contextmanager
    def backwards(*_):
        yield Backwards()

    monkeypatch.setattr(WORKERS, backwards)
    (folder / "in" / "c.xlsx").rename(folder / "c.xlsx")
    said = _call(*RUN)
    assert [line[:8] for line in said.stdout.splitlines()[:3]] == ["in/a.csv", "in/b.csv", "in/d.csv"]
    changed = {"out/c-checked.xlsx", "out/flexlash-summary.xlsx", "out/flexlash-summary.jsonl"}
    assert {name: data for name, data in outputs(folder).items() if name not in changed} == {
        name: data for name, data in straight.items() if name not in changed
    }


def test_resume_computes_what_is_not_done(folder, monkeypatch):
    """A file that is gone, changed or new is computed, the others are not; what is printed and written is the same."""
    whole = _call(*RUN)
    straight = outputs(folder)
    asked = []

    class Asked(HereExecutor):
        """Knows what it was asked."""

        @staticmethod
        def submit(work, data):
            asked.append(Task.of(data).source.name)
            return HereExecutor.submit(work, data)

    @contextmanager
    def here(*_):
        yield Asked()

    monkeypatch.setattr(WORKERS, here)
    again = _call(*RUN, "--resume")
    assert asked == ["c.xlsx"]
    assert "3 submissions done by an earlier run, not computed again." in again.stderr
    Path("out/a-report.xlsx").unlink()
    Path("out/flexlash-summary.xlsx").unlink()
    asked.clear()
    once_more = _call(*RUN, "--resume")
    assert asked == ["a.csv", "c.xlsx"]
    assert again.stdout == once_more.stdout == whole.stdout
    assert outputs(folder) == straight
    asked.clear()
    Path("in/d.csv").write_bytes(Path("in/b.csv").read_bytes())
    _call(*RUN, "--resume")
    assert asked == ["c.xlsx", "d.csv"]
    asked.clear()
    _call(*RUN, "--seed", 7, "--resume")
    assert asked == ["a.csv", "b.csv", "c.xlsx", "d.csv"]
    asked.clear()
    _call(*RUN, "--seed", 7)
    assert asked == ["a.csv", "b.csv", "c.xlsx", "d.csv"]


@pytest.mark.usefixtures("folder")
def test_resume_skips_a_fixed_file_whose_original_came_later():
    """What is skipped beside its original is so on --resume, although it was computed while it stood alone."""
    Path("in/d.csv").rename("in/b-autofixed.csv")
    Path("in/b.csv").rename("b.csv")
    assert "in/b-autofixed.csv: 1 of 1 rows computed" in _call(*RUN).stdout
    Path("b.csv").rename("in/b.csv")
    resumed = _call(*RUN, "--resume")
    assert "1 file, fixed file skipped: in/b-autofixed.csv" in resumed.stderr
    assert "b-autofixed-report" not in resumed.stdout
    assert resumed.stdout == _call(*RUN).stdout


@pytest.mark.usefixtures("folder")
def test_resume_needs_a_folder():
    """Where no manifest can be, --resume is a usage error that says so."""
    for submissions in (["in"], ["in/a.csv", "in/b.csv"]):
        said = _call("run", *submissions, "--resume")
        assert (said.exit_code, "--resume needs a folder as OUT" in said.stderr) == (2, True)


@pytest.mark.usefixtures("folder")
def test_a_file_that_costs_its_workers_is_refused_by_name(monkeypatch):
    """What stops every worker or exceeds a limit is no submission, and the others are computed."""

    class Poisoned(HereExecutor):
        """Loses its workers over two submissions."""

        @staticmethod
        def submit(work, data):
            future = Future()
            name = Task.of(data).source.name
            if name == "a.csv":
                future.set_exception(WorkerLostError("stopped three times"))
            elif name == "b.csv":
                future.set_exception(WorkerLostError("too long", "seconds"))
            else:
                return HereExecutor.submit(work, data)
            return future

    @contextmanager
    def poisoned(*_):
        yield Poisoned()

    monkeypatch.setattr(WORKERS, poisoned)
    said = _call(*RUN)
    assert "in/a.csv: E118 a.csv stopped the program that reads it" in said.stderr
    assert "in/b.csv: E110" in said.stderr
    assert "in/d.csv: 1 of 1 rows computed" in said.stdout
    assert said.exit_code == 4


@pytest.mark.usefixtures("folder")
def test_a_summary_that_somebody_edited_stays():
    """The next run leaves it alone, says so, and writes beside it."""
    _call(*RUN)
    mine = Path("out/flexlash-summary.jsonl").read_bytes() + b"my note\n"
    Path("out/flexlash-summary.jsonl").write_bytes(mine)
    said = _call(*RUN)
    assert "flexlash-summary.jsonl was left alone" in said.stderr
    assert Path("out/flexlash-summary.jsonl").read_bytes() == mine
    assert Path("out/flexlash-summary (2).jsonl").exists()


def test_a_large_table_is_one_submission_among_others(folder, table, sound, monkeypatch):
    """It goes in chunks through the same workers, has its line, its files and its place in what --resume believes."""
    monkeypatch.setattr("flexlash.reading.survey.LARGE_ROWS", 5)
    monkeypatch.setattr("flexlash.batch.side_by_side._LEAST_OF_LARGE", 0)
    table([{**sound, "variant": f"v{row}"} for row in range(8)], "large.csv").rename("in/a.csv")
    whole = _call(*RUN)
    assert whole.stdout.startswith("in/a.csv: 8 of 8 rows computed. Limit not met by 8 of 8 variants. Written: ")
    straight = outputs(folder)
    assert {"out/a-report.xlsx", "out/a-results.parquet", "out/b-report.xlsx"} <= set(straight)
    again = _call(*RUN, "--resume")
    assert "3 submissions done by an earlier run" in again.stderr
    assert (again.stdout, outputs(folder)) == (whole.stdout, straight)
    Path("out/a-results.parquet").unlink()
    once_more = _call(*RUN, "--resume")
    assert "2 submissions done by an earlier run" in once_more.stderr
    assert (once_more.stdout, outputs(folder)) == (whole.stdout, straight)


@pytest.fixture
def all_large(monkeypatch):
    """Every table of more than five rows is computed in chunks."""
    monkeypatch.setattr("flexlash.reading.survey.LARGE_ROWS", 5)
    monkeypatch.setattr("flexlash.batch.side_by_side._LEAST_OF_LARGE", 0)


@pytest.mark.usefixtures("all_large")
def test_resume_leaves_the_files_beside_a_report_to_a_large_table_of_the_same_stem(folder, table, sound):
    """A table that came later writes its Results under another name, as in one run of both."""
    for torque, name in ((100, "a.csv"), (200, "a.tsv")):
        rows = [{**sound, "variant": f"v{row}", "torque_Nm": torque + row} for row in range(8)]
        table(rows, "large.csv").rename(folder / "in" / name)
    straight = _call(*RUN), outputs(folder)
    assert {"out/a-results.parquet", "out/a-results (2).parquet"} <= set(straight[1])
    shutil.rmtree("out")
    Path("in/a.tsv").rename("a.tsv")
    _call(*RUN)
    Path("a.tsv").rename("in/a.tsv")
    resumed = _call(*RUN, "--resume"), outputs(folder)
    assert "3 submissions done by an earlier run" in resumed[0].stderr
    assert resumed[0].stdout == straight[0].stdout
    assert resumed[1] == straight[1]


@pytest.mark.usefixtures("all_large")
def test_what_stands_before_a_large_table_is_written_before_it_is_begun(folder, table, sound, monkeypatch):
    """A small submission does not wait for all large tables behind it to be told."""
    for name in ("b.csv", "d.csv"):
        rows = [{**sound, "variant": f"v{row}"} for row in range(8)]
        table(rows, "large.csv").rename(folder / "in" / name)
    there = []

    class Noting(HereExecutor):
        """Notes which reports are there when it is given something."""

        @staticmethod
        def submit(work, data):
            there.append(sorted(path.name for path in Path("out").glob("*-report.xlsx")))
            return HereExecutor.submit(work, data)

    @contextmanager
    def noting(*_):
        yield Noting()

    monkeypatch.setattr(WORKERS, noting)
    _call(*RUN)
    assert there[:2] == [[], ["a-report.xlsx"]]
    assert there[-1] == ["a-report.xlsx", "b-report.xlsx"]


@pytest.fixture(scope="module")
def many(tmp_path_factory):
    """Return a folder with eight tables and what an undisturbed run of them prints and writes."""
    from filled import SOUND

    folder = tmp_path_factory.mktemp("many")
    (folder / "in").mkdir()
    header = ",".join(SOUND)
    for number in range(8):
        rows = [{**SOUND, "variant": f"v{number}-{row}", "torque_Nm": 100 + number + row} for row in range(3)]
        lines = [header, *(",".join(map(str, row.values())) for row in rows)]
        (folder / "in" / f"s{number}.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    code, out, err = ended(begun(folder))
    assert (code, err) == (0, "")
    return folder, out, outputs(folder)


def _beside(many, tmp_path):
    """Return a folder with the same submissions, in which nothing has been done."""
    shutil.copytree(many[0] / "in", tmp_path / "in")
    return tmp_path


@POSIX
@pytest.mark.slow
@pytest.mark.parametrize("after", [pytest.param(0, marks=pytest.mark.long), 2, pytest.param(5, marks=pytest.mark.long)])
def test_a_killed_run_is_taken_up(many, tmp_path, after):
    """Killed without warning: what is there is whole, no process stays, and --resume gives the undisturbed bytes."""
    folder = _beside(many, tmp_path)
    run = begun(folder)
    stopped(run, folder, after=after)
    assert ended(run)[0] == -signal.SIGKILL
    assert parts(folder) == []
    assert not sys.platform.startswith("linux") or none_left(run.pid)
    code, out, err = ended(begun(folder, "--resume"))
    assert (code, out) == (0, many[1])
    assert "done by an earlier run" in err or not after
    assert outputs(folder) == many[2]
    assert [path.name for path in (folder / "out").iterdir() if path.name.endswith(".tmp")] == []


@LINUX
@pytest.mark.slow
def test_an_interrupted_run_ends_at_once_and_is_taken_up(many, tmp_path):
    """Ctrl-C: exit code 130 and a word, whole files alone, no process left; --resume goes on."""
    folder = _beside(many, tmp_path)
    run = begun(folder)
    stopped(run, folder, after=2, how=signal.SIGINT)
    code, _, err = ended(run)
    assert (code, err.strip()) == (130, "Interrupted.")
    assert none_left(run.pid, seconds=1)
    assert parts(folder) == []
    assert not (folder / "out/flexlash-summary.xlsx").exists()
    code, out, _ = ended(begun(folder, "--resume"))
    assert (code, out) == (0, many[1])
    assert outputs(folder) == many[2]


@LINUX
@pytest.mark.slow
def test_a_killed_worker_costs_nothing(many, tmp_path):
    """A worker that the system stops in mid-run is replaced, and what it had is done by another."""
    folder = _beside(many, tmp_path)
    run = begun(folder)
    while not done(folder):
        time.sleep(0.01)
    os.kill(max(processes_of(run.pid)), signal.SIGKILL)
    code, out, _ = ended(run)
    assert (code, out, outputs(folder)) == (0, many[1], many[2])


@POSIX
@pytest.mark.slow
def test_a_full_disk_is_told_and_taken_up(many, tmp_path):
    """What no longer fits is told by its name with code 5, nothing is half written; with room, --resume goes on."""
    folder = _beside(many, tmp_path)
    limit = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, 50_000)); "
    code, _, err = ended(begun(folder, code=f"{limit}from flexlash.cli import main; main()"))
    assert code == 5
    assert "out/s0-report.xlsx could not be opened or written: the file becomes larger than this system allows" in err
    assert "Traceback" not in err
    assert parts(folder) == []
    code, out, _ = ended(begun(folder, "--resume"))
    assert (code, out, outputs(folder)) == (0, many[1], many[2])


@POSIX
@pytest.mark.slow
def test_a_summary_that_cannot_be_written_is_no_submission(many, tmp_path):
    """Where nothing at all can be written the total counts the submissions alone."""
    folder = _beside(many, tmp_path)
    limit = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (5_000, 5_000)); "
    code, out, err = ended(begun(folder, "--json", code=f"{limit}from flexlash.cli import main; main()"))
    *submissions, total = map(json.loads, out.splitlines())
    assert "out/flexlash-summary.xlsx could not be written: the file becomes larger" in err
    assert (code, total["total"]["submissions"], total["total"]["not"]) == (5, len(submissions), len(submissions))


@pytest.mark.slow
def test_the_process_that_prints_stays_light(many, tmp_path):
    """Neither check nor run of one file load the libraries that read and compute into the process that prints."""
    heavy = "{'polars', 'scipy', 'pandera', 'numpy', 'openpyxl', 'skfem', 'matplotlib'}"
    code = (
        "from flexlash.cli import cli\n  try:\n    cli.main(['check', 'in/s0.csv'], standalone_mode=False)\n"
        f"  except SystemExit: pass\n  print('heavy', {heavy} & set(sys.modules))"
    )
    _, out, err = ended(begun(_beside(many, tmp_path), code=code))
    assert out.splitlines()[-1] == "heavy set()", err


@LINUX
@pytest.mark.slow
def test_one_submission_has_one_worker(many, tmp_path):
    """However many processes are allowed: this one, the worker, and the keeper of locks that Python starts."""
    folder = _beside(many, tmp_path)
    for path in sorted((folder / "in").iterdir())[1:]:
        path.unlink()
    run, most = begun(folder), 0
    while run.poll() is None:
        most = max(most, len(processes_of(run.pid)))
        time.sleep(0.02)
    assert ended(run)[0] == 0
    assert most in {2, 3}
