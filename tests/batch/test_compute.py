"""The function that workers carry out gives what the pipeline gives, as bytes, and writes nothing."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from flexlash.analysis.examination import opened
from flexlash.analysis.options import Options
from flexlash.analysis.run_summary import worst_first
from flexlash.batch.answer import Answer, Task
from flexlash.batch.compute import compute
from flexlash.pipeline import check, fix, run
from flexlash.reading.read import Source
from flexlash.schema.exit_codes import ExitCode

DATA = Path(__file__).resolve().parents[2] / "data"
STUDY, FAULTY = DATA / "b3-160-study.xlsx", DATA / "needs-fixing.xlsx"


def _task(path, command, **wanted):
    options = Options()
    return Task(command=command, source=opened(path, options), options=options, **wanted)


def _answer(task):
    return Answer.of(compute(task.as_bytes()))


def _told(outcome):
    return {key: value for key, value in outcome.as_dictionary().items() if key != "outputs"}


def test_a_run_gives_the_report_of_the_pipeline(tmp_path):
    """Report and words are those of `flexlash.run`, byte for byte but for the stamp, which the writer sets."""
    answer = _answer(_task(STUDY, "run", report=".json"))
    outcome = run(STUDY, tmp_path / "report.json")
    assert answer.told == _told(outcome)
    assert answer.exit_code == outcome.exit_code
    stamped = (tmp_path / "report.json").read_bytes()
    assert answer.file.data[:-100] == stamped[:-100]
    assert answer.file.role == "results"
    assert [one.variant for one in answer.worst] == [row["variant"] for row in worst_first(outcome)[:3]]


def test_the_same_task_gives_the_same_bytes():
    """An answer depends on the task alone."""
    task = _task(FAULTY, "run", report=".csv", copy=".xlsx").as_bytes()
    assert compute(task) == compute(task)


def test_a_check_gives_findings_and_the_marked_copy(tmp_path):
    """What is marked is what `check` marks."""
    answer = _answer(_task(FAULTY, "check", copy=".xlsx"))
    outcome = check(FAULTY, marked_copy=tmp_path / "copy.xlsx")
    assert answer.told == _told(outcome)
    assert answer.copy.role == "checked"
    assert (tmp_path / "copy.xlsx").read_bytes().startswith(answer.copy.data[:-2])
    assert sum(answer.by_rule.values()) == len(outcome.findings)
    assert answer.file is None


def test_a_fixed_submission_comes_with_its_fixes(tmp_path):
    """Bytes and fixes are those of `fix`."""
    answer = _answer(_task(FAULTY, "fix"))
    outcome, fixes = fix(FAULTY, tmp_path / "fixed.xlsx")
    assert list(answer.fixes) == fixes
    assert answer.told["counts"] == outcome.counts
    assert (tmp_path / "fixed.xlsx").read_bytes().startswith(answer.file.data[:-2])


def test_what_is_no_submission_is_an_answer():
    """A refused file says why, and is not computed."""
    source = Source(name="x.xlsx", data=b"PK\x03\x04 nothing")
    answer = _answer(Task(command="run", source=source, options=Options(), report=".csv"))
    assert answer.refused
    assert answer.exit_code == ExitCode.NOTHING
    assert answer.file is None
    assert answer.told["findings"][0]["level"] == "error"


def test_a_fault_of_the_program_is_an_answer():
    """Nothing that goes wrong in a worker raises: its sender could not read every exception."""
    broken = replace(_task(STUDY, "run"), source=None)
    answer = _answer(broken)
    assert answer.exit_code == ExitCode.INTERNAL
    assert answer.fault is not None
    assert "Traceback" in answer.fault.trace


@pytest.mark.slow
def test_an_answer_is_read_without_the_libraries_that_made_it():
    """The process that prints and writes needs neither polars nor NumPy."""
    data = compute(_task(STUDY, "run").as_bytes())
    script = (
        "import sys; from flexlash.batch.answer import Answer; Answer.of(sys.stdin.buffer.read());"
        "print([name for name in ('polars', 'numpy', 'scipy', 'pandera', 'openpyxl') if name in sys.modules])"
    )
    found = subprocess.run([sys.executable, "-c", script], input=data, capture_output=True, check=True)
    assert found.stdout.decode().strip() == "[]"
