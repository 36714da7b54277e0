"""A task with pages: what it tells and when, and an answer that offers what the commands would have written."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path

import pytest
from finding_examples import SUBMISSIONS
from grids import for_each
from here import heard_here

from flexlash.analysis.examination import opened
from flexlash.analysis.options import Options
from flexlash.batch import telling
from flexlash.batch.answer import Answer, Task, Told
from flexlash.batch.compute import compute
from flexlash.batch.telling import Telling
from flexlash.feedback.returned_files import fixed
from flexlash.pipeline import check, run
from flexlash.reading.read import Source

DATA = Path(__file__).resolve().parents[2] / "data"
STUDY, FAULTY = DATA / "b3-160-study.xlsx", DATA / "needs-fixing.xlsx"


def _task(path, command="run", **wanted):
    options = Options(**wanted)
    report = ".xlsx" if command == "run" else ""
    source = opened(path, options)
    return Task(command=command, source=source, options=options, report=report, copy=".xlsx", pages=True)


def _answered(task):
    """Return the answer to a task and what was told meanwhile."""
    heard = []
    with heard_here(lambda message: heard.append(Told.of(message))):
        answer = Answer.of(compute(task.as_bytes()))
    assert answer.fault is None, answer.fault.trace
    return answer, heard


def _numbers_only(outcome):
    return {key: value for key, value in outcome.as_dictionary().items() if key != "outputs"}


@pytest.mark.slow
def test_findings_are_told_before_rows_and_rows_before_the_answer():
    """First that it checks, then the findings with how many rows follow, then rows to the last, then that it writes."""
    answer, heard = _answered(_task(FAULTY))
    assert heard[0] == Told(stage="checking")
    found = heard[1]
    assert (found.stage, found.rows_done, found.rows) == ("computing", 0, 3)
    told, last = json.loads(found.page), json.loads(answer.page)
    assert not told["ran"]
    assert last["ran"]
    assert told["cards"] == last["cards"]
    assert found.counts == told["counts"]
    assert sum(bool(one.page) for one in heard) == 1
    assert (heard[-1].stage, heard[-1].rows_done, heard[-1].rows) == ("writing", 3, 3)
    assert (heard[-2].stage, heard[-2].rows_done) == ("computing", 3)
    done = [one.rows_done for one in heard]
    assert done == sorted(done)


def test_rows_are_told_a_few_times_a_second_and_to_the_last(monkeypatch):
    """The first at once, then one every quarter second, and the end always; steps of one row are parts of it."""
    clock = iter([10.0 + 0.01 * step for step in range(200)])
    monkeypatch.setattr(telling.time, "monotonic", lambda: next(clock))
    heard = []
    with heard_here(lambda message: heard.append(Told.of(message))):
        one = Telling()
        one.checked(b"{}", {}, 50)
        for done in range(1, 101):
            one.advance(done, 100)
    told = [message.rows_done for message in heard[2:]]
    assert told == [0, 13, 25, 38, 50]
    assert {message.rows for message in heard[1:]} == {50}


@pytest.mark.slow
def test_the_answer_is_that_without_a_page_and_more(tmp_path):
    """Report, marked copy and words are those of a task without pages; Results are the bytes that `-o x.csv` writes."""
    answer, _ = _answered(_task(FAULTY))
    plain = _task(FAULTY)
    without = Answer.of(compute(Task(**{**vars(plain), "pages": False}).as_bytes()))
    for name in ("exit_code", "told", "finding_lines", "words", "details", "by_rule", "worst", "file", "copy"):
        assert getattr(answer, name) == getattr(without, name), name
    assert (without.page, without.results, without.fixed, without.rules) == (b"", None, None, ())
    run(FAULTY, tmp_path / "x.csv")
    assert answer.results.data == (tmp_path / "x.csv").read_bytes()


@pytest.mark.slow
@for_each("name", ["needs fixing", "tables", "headers", "percentages", "German", "no rows", "other columns"])
def test_the_fixed_file_is_that_of_the_command(name, tmp_path):
    """It has the bytes and the fixes of `fix`, though what came of fixing is not computed; else there is none."""
    path, _ = SUBMISSIONS[name](tmp_path)
    answer, _ = _answered(_task(path, "check"))
    made = fixed(opened(path, Options()), Options())
    assert (answer.fixed is not None) == bool(made.fixes)
    assert json.loads(answer.page)["fixable"] == len(made.fixes)
    if answer.fixed is not None:
        assert (answer.fixed.data, answer.fixed.role) == (made.data, made.role)


@pytest.mark.slow
def test_what_a_fix_uncovers_is_fixed_as_well(book):
    """Below a misspelt header stands a number with its unit: the page offers a file in which both are fixed."""
    keys = ("variant", "material", "torque_Nm", "cylinder_length_mm", "mean_radius_mm")
    row = ["C-1", "20Cr2Ni4", 800, 160, 80, "1,6 mm", 40]
    path = book({"Variants": [[*keys, "Wall thicknes [mm]", "disk_inner_radius_mm"], row]})
    answer, _ = _answered(_task(path, "check"))
    made = fixed(opened(path, Options()), Options())
    assert {fix.cell for fix in made.fixes} == {"F1", "F2"}
    assert answer.fixed.data == made.data
    assert json.loads(answer.page)["fixable"] == 2


@pytest.mark.slow
def test_a_check_has_a_page_and_no_results():
    """Where nothing is computed there are findings, a marked copy and what can be fixed."""
    answer, heard = _answered(_task(FAULTY, "check"))
    told = json.loads(answer.page)
    assert (told["ran"], told["variants"], answer.results, answer.file) == (False, [], None, None)
    assert answer.copy is not None
    assert answer.fixed is not None
    assert {one.rows for one in heard} == {0}
    assert answer.told == _numbers_only(check(FAULTY))


@pytest.mark.slow
def test_rules_count_each_cell_once():
    """Cells by rule, sheet and column add up to those of the findings, and the first is named."""
    answer, _ = _answered(_task(FAULTY, "check"))
    outcome = check(FAULTY)
    cells = {(found.level, found.code, found.sheet, found.column, found.cell) for found in outcome.findings}
    expected = Counter(cell[:4] for cell in cells)
    assert {(r.level, r.code, r.sheet, r.column): r.cells for r in answer.rules} == expected
    assert all((r.level, r.code, r.sheet, r.column, r.first) in cells for r in answer.rules)


def test_what_is_no_submission_has_a_page_and_tells_nothing_of_rows():
    """A refused file says why on its page."""
    source = Source(name="x.xlsx", data=b"PK\x03\x04 nothing")
    task = Task(command="run", source=source, options=Options(), report=".xlsx", copy=".xlsx", pages=True)
    answer, heard = _answered(task)
    assert answer.refused
    assert json.loads(answer.page)["refused"]["code"] == answer.told["findings"][0]["code"]
    assert not any(one.page for one in heard)
    assert (answer.results, answer.fixed) == (None, None)


@pytest.mark.slow
def test_the_same_task_gives_the_same_bytes_told_or_not():
    """Neither a listener nor the clock changes an answer."""
    task = _task(FAULTY).as_bytes()
    with heard_here(lambda _: None):
        told = compute(task)
    assert compute(task) == told


def test_progress_of_the_elasticity_check_is_told_in_rows(monkeypatch):
    """A row counts as done once both its steps are."""
    monkeypatch.setattr(telling, "_APART", 0.0)
    heard = []
    with heard_here(lambda message: heard.append(Told.of(message))):
        one = Telling()
        one.checked(b"{}", {}, 4)
        for done in range(1, 9):
            one.advance(done, 8)
    assert [message.rows_done for message in heard[2:]] == [0, 1, 1, 2, 2, 3, 3, 4]
