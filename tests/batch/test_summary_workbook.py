"""The summary of all submissions: a workbook that says what the lines say, the same bytes for the same ends."""

from __future__ import annotations

import io
import json
from dataclasses import replace
from pathlib import Path

import openpyxl
import pytest

from flexlash.analysis.outcome import Written
from flexlash.batch.answer import WorstVariant
from flexlash.batch.ended import Ended
from flexlash.batch.summary_workbook import SUMMARY, summary_lines_file, summary_workbook
from flexlash.reading.refusal import Refusal
from flexlash.schema.exit_codes import ExitCode
from flexlash.schema.findings import finding
from flexlash.schema.stamps import stamp_at, stamped

OUT = Path("out")


def _computed(name, **changed):
    facts = {"variant": "v", "name": "Torque", "value": "", "requirement": "a number is required"}
    found = [finding("E201", sheet="Variants", cell=f"D{row}", **facts) for row in (7, 9)]
    counts = {"rows": 5, "computed": 3, "errors": 2, "warnings": 0, "meets": 1, "marginal": 1, "fails": 1}
    fields = {
        "path": Path("in") / name,
        "code": ExitCode.SOME_ROWS,
        "told": {"submission": name, "counts": counts, "findings": [one.as_dictionary() for one in found]},
        "words": "3 of 5 rows computed",
        "by_rule": {"E201": 2},
        "worst": (WorstVariant(variant="=worst", p99_865_arcmin=4.0, backlash_limit_arcmin=3.0,
                               probability_over_limit=0.4, over_limit="40 % (39 to 41 %)"),),
        "written": Written(paths=(OUT / f"{Path(name).stem}-report.xlsx",)),
    }  # fmt: skip
    return Ended(**fields | changed)


@pytest.fixture
def ended():
    """Return how submissions ended, one of each kind."""
    return [
        _computed("a.xlsx"),
        replace(
            _computed("b #1 50%.xlsx"), below=Path("sub"), written=Written(paths=(OUT / "sub/b #1 50%-report.xlsx",))
        ),
        Ended.refusing(Path("in/c.xlsx"), Refusal("E118"), several=True),
        Ended.refusing(Path("in/d-report.xlsx"), Refusal("I508"), several=True),
        Ended.failing(Path("in/e.xlsx"), ExitCode.NO_FILE, "in/e.xlsx could not be opened: no permission"),
    ]


def _rows(ended, sheet):
    loaded = openpyxl.load_workbook(io.BytesIO(summary_workbook(ended, OUT)))
    assert loaded.sheetnames == ["Submissions", "Findings"]
    rows = [list(row) for row in loaded[sheet].iter_rows(min_row=4)]
    header = [cell.value for cell in rows[0]]
    return [dict(zip(header, row, strict=True)) for row in rows[1:]]


def test_every_submission_has_a_line(ended):
    """State, counts, the worst variant with its share, why not, and a link to the report; a skipped file has none."""
    rows = _rows(ended, "Submissions")
    told = {row["Submission"].value: row for row in rows}
    assert list(told) == ["a.xlsx", "sub/b #1 50%.xlsx", "c.xlsx", "e.xlsx"]
    first = {key: cell.value for key, cell in told["a.xlsx"].items()}
    assert first["State"] == "computed in part"
    assert [first[key] for key in ("Rows", "Computed", "Errors", "Warnings", "Meets", "Marginal", "Fails")] == [
        5, 3, 2, 0, 1, 1, 1,
    ]  # fmt: skip
    assert (first["Worst variant"], first["Units over its limit"]) == ("=worst", "40 % (39 to 41 %)")
    assert told["a.xlsx"]["Worst variant"].data_type == "s"
    assert told["a.xlsx"]["Report"].hyperlink.target == "a-report.xlsx"
    assert told["sub/b #1 50%.xlsx"]["Report"].hyperlink.target == r"sub\b%20%231%2050%25-report.xlsx"
    assert "stopped the program" in told["c.xlsx"]["Reason"].value
    assert told["e.xlsx"]["State"].value == "a file could not be opened or written"
    assert told["e.xlsx"]["Report"].value is None


def test_every_rule_has_a_line(ended):
    """How many findings of a rule, in how many submissions, and where first."""
    rows = {row["Code"].value: {key: cell.value for key, cell in row.items()} for row in _rows(ended, "Findings")}
    assert set(rows) == {"E118", "E201"}
    assert (rows["E201"]["Findings"], rows["E201"]["Submissions"]) == (4, 2)
    assert rows["E201"]["First places"].startswith("a.xlsx Variants!D7, a.xlsx Variants!D9, b #1 50%.xlsx Variants!D7")
    assert rows["E201"]["First places"].endswith(", …")
    assert rows["E118"]["Level"] == "error"


def test_the_lines_are_those_of_json_without_the_time(ended):
    """Each line is what --json prints but `seconds`; the last is the total, in which skipped files do not count."""
    *lines, last = map(json.loads, summary_lines_file(ended).splitlines())
    for line, one in zip(lines, ended, strict=True):
        assert {**line, "seconds": 0.0} == one.as_dictionary()
    assert last["total"] == {"submissions": 4, "computed": 0, "partly": 2, "not": 2, "exit_code": 5}


def test_the_same_ends_give_the_same_bytes_whatever_time_they_took(ended):
    """Neither time nor whether an earlier run had done it changes a byte."""
    others = [replace(one, seconds=9.0, done_before=True) for one in ended]
    assert summary_workbook(ended, OUT) == summary_workbook(others, OUT)
    assert summary_lines_file(ended) == summary_lines_file(others)


def test_both_say_that_flexlash_wrote_them_until_somebody_changes_them(ended, tmp_path):
    """A later run may replace them, and not what somebody has edited."""
    for name, data in (("s.xlsx", summary_workbook(ended, OUT)), ("s.jsonl", summary_lines_file(ended))):
        path = tmp_path / name
        path.write_bytes(stamped(data, SUMMARY))
        assert stamp_at(path) == SUMMARY
        path.write_bytes(path.read_bytes().replace(b"a", b"b", 1))
        assert stamp_at(path) == ""


def test_a_summary_of_nothing_is_a_workbook():
    """A folder with nothing but skipped files has a summary that says so."""
    assert _rows([], "Submissions") == _rows([], "Findings") == []
    assert json.loads(summary_lines_file([]))["total"]["exit_code"] == 4
