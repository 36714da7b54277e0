"""The text that a sender finds beside, or in place of, a report."""

from dataclasses import replace
from pathlib import Path

from flexlash.batch.answer import Answer, FileBytes
from flexlash.batch.large_apart import LargeAnswer
from flexlash.schema.exit_codes import ExitCode
from flexlash.service.reasons import answered_again_text, reasons_text
from flexlash.service.records import StoredSubmission

ID = "0123456789abcdef0123456789abcdef"
PARTLY = Answer(
    exit_code=ExitCode.SOME_ROWS,
    words="3 of 4 rows computed; 1 cell to fix",
    told={"counts": {"rows": 4, "computed": 3}, "sha256": "ab" * 32},
    finding_lines=(
        ("error", "error E201 required cell empty, 1 cell: Variants!D8"),
        ("", "    Variants!D8 Torque T is empty: a torque in N·m above 0 is required."),
        ("", "    Fix: Fill in the cell."),
        ("info", "info I501 a column of your own"),
        ("", "    It passes through."),
    ),
    file=FileBytes(data=b"", role="report"),
    copy=FileBytes(data=b"", role="checked"),
)
REPEATED = StoredSubmission(
    id="f" * 32, number=2, name="a.xlsx", sha256="", size=1, options="", door="folder", sender="", received_at=0.0,
    state="done", same_as=ID,
)  # fmt: skip


def said(text: bytes) -> str:
    """Return a text as Notepad shows it."""
    return text.decode("utf-8-sig").replace("\r\n", "\n")


def test_a_partly_computed_submission_is_told_what_where_required_fix_copy_and_id():
    """Who handed in a file with a fault reads all that is needed to fix it, without the program or its page."""
    text = said(reasons_text(PARTLY, "study A.xlsx", submission=ID))
    for needed in (
        "study A.xlsx: 3 of 4 rows computed", "study A-report.xlsx", "Variants!D8", "above 0 is required",
        "Fill in the cell", "study A-checked.xlsx", "hand the file in again", ID, "ab" * 32,
    ):  # fmt: skip
        assert needed in text
    assert "I501" not in text
    assert "passes through" not in text


def test_who_handed_in_a_large_table_is_told_where_all_rows_are():
    """The report of a large table holds its worst rows alone: the text names the file that has all."""
    large = LargeAnswer.with_files(PARTLY, {"results": Path("a-results.parquet"), "report": Path("a-report.xlsx")})
    text = said(reasons_text(large, "a.csv"))
    assert "are in a-results.parquet, the worst of them also in a-report.xlsx. Fix this in the others" in text
    assert "are in a-report.xlsx. Fix this in the others" in said(reasons_text(PARTLY, "a.csv"))


def test_a_rejected_submission_is_told_why():
    """Also where no worker ever answered there is a reason, what to do, and the ID, with no report."""
    lost = Answer(exit_code=ExitCode.NOTHING)
    text = said(reasons_text(lost, "a.xlsx", submission=ID, reason="It stopped the worker 3 times."))
    assert "It stopped the worker 3 times." in text
    assert ID in text
    assert "Hand the file in again" in text
    assert "a-report.xlsx" not in text


def test_r8_what_a_submission_says_is_inert_in_the_text():
    """A name or cell with line ends, escapes or a turn of direction makes no line of its own and turns nothing."""
    hostile = "a\r\nSubmission 666\x1b[2J\u202ereversed\x00.xlsx"
    text = reasons_text(replace(PARTLY, words=hostile, finding_lines=(("error", hostile),)), hostile)
    lines = said(text).splitlines()
    assert not any(line.startswith("Submission 666") for line in lines)
    assert all(line.isprintable() for line in lines)


def test_bytes_are_those_that_every_notepad_shows():
    """A byte order mark and CRLF alone: an old Notepad would run all lines together and spoil every ′."""
    text = reasons_text(PARTLY, "a.xlsx")
    assert text.startswith(b"\xef\xbb\xbf")
    assert text.count(b"\n") == text.count(b"\r\n") > 10


def test_the_same_submission_again_is_told_so_in_the_same_words():
    """The second and the third time give the same bytes, which name the first and its files."""
    text = answered_again_text(REPEATED, ["a-report.xlsx"])
    assert text == answered_again_text(replace(REPEATED, id="e" * 32, number=3), ["a-report.xlsx"])
    for needed in ("handed in before", "a-report.xlsx", ID):
        assert needed in said(text)
