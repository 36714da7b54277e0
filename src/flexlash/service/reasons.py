"""Why a submission was not, or not wholly, computed, as a text beside its report, for the engineer who handed it in.

UTF-8 with a byte order mark and CRLF, so that every Notepad shows it as it is. Whatever stands in it is on one line and
without control characters.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import PurePath

from flexlash import __version__
from flexlash.batch.answer import Answer
from flexlash.batch.ended import fault_words
from flexlash.batch.large_apart import LargeAnswer
from flexlash.reading.products import CHECKED_NAME, REPORT_NAME
from flexlash.schema.findings import shown
from flexlash.service.records import StoredSubmission

__all__ = ["answered_again_text", "reasons_text"]

_MARK = b"\xef\xbb\xbf"
_LONGEST = 4096
_ALL_LISTED = " (check --annotate)"
"""What the terminal says of the marked copy, which here lies beside the text."""

_AGAIN = "hand the file in again, under the same name or another"
_NUMBER = (
    "If a number stands behind the name of this text, the same stands behind those of the report and the marked copy."
)


def reasons_text(answer: Answer, name: str, *, submission: str = "", reason: str = "") -> bytes:
    """Return the text about a submission of this name that was rejected or computed in part.

    `submission` is its ID. `reason` is the sentence that says why where the answer does not: an `Answer` of an exit
    code alone stands for one that there never was.
    """
    return _as_bytes(_lines(answer, shown(name, 255), submission, reason))


def answered_again_text(submission: StoredSubmission, names: Sequence[str]) -> bytes:
    """Return the text for who hands in again what was answered before: where the answer is.

    `names` are those of the files of the answer. The same submission gets the same text however often it is handed in.
    """
    name = shown(submission.name, 255)
    lines = [
        f"{name}: this file was handed in before; that answer still holds.",
        "",
        "Name, content and options are the same, so nothing was computed again. The answer:",
        *([f"    {one}" for one in names] or ["    none: nothing of it was computed"]),
        f"It was given to submission {submission.same_as}.",
        "",
        f"If you have changed it, save it, and {_AGAIN}.",
    ]
    return _as_bytes(lines)


def _lines(answer: Answer, name: str, submission: str, reason: str) -> Iterator[str]:
    stem, computed = PurePath(name).stem, answer.file is not None
    counts = answer.told.get("counts") or {}
    yield f"{name}: {answer.words or 'nothing was computed'}."
    yield ""
    if computed and counts.get("computed") == counts.get("rows"):
        yield f"All rows are in {_place(answer, stem)}. Please check:"
    elif computed:
        yield f"The rows that could be computed are in {_place(answer, stem)}. Fix this in the others:"
    else:
        yield "No report was written. This is why:"
    yield ""
    yield from _why(answer, reason)
    yield ""
    yield "What to do now"
    yield from (f"  {number}. {step}" for number, step in enumerate(_steps(answer, stem), 1))
    if computed or answer.copy is not None:
        yield ""
        yield _NUMBER
    yield ""
    if submission:
        yield f"Submission {submission}, under which your file is kept as it was"
    if not answer.refused and (sha256 := answer.told.get("sha256")):
        yield f"SHA-256 of the file: {sha256}"
    yield f"flexlash {__version__}"


def _place(answer: Answer, stem: str) -> str:
    """Return where the rows are that were computed: of a large table the report holds the worst alone."""
    report = f"{stem}{REPORT_NAME}.xlsx"
    if isinstance(answer, LargeAnswer) and (results := answer.files.get("results")):
        return f"{stem}-results{results.suffix}, the worst of them also in {report}"
    return report


def _why(answer: Answer, reason: str) -> Iterator[str]:
    if reason:
        yield reason
    if answer.fault is not None:
        yield fault_words(answer.fault.kind)
    is_told = True
    for level, line in answer.finding_lines:
        if level:
            is_told = level != "info" or answer.skipped
        if is_told:
            if level and line != answer.finding_lines[0][1]:
                yield ""
            yield line.replace(_ALL_LISTED, "")


def _steps(answer: Answer, stem: str) -> Iterator[str]:
    has_errors = any(level == "error" for level, _ in answer.finding_lines)
    if answer.copy is not None and not answer.refused:
        copy = f"{stem}{CHECKED_NAME}.xlsx"
        if answer.copy.not_carried is None:
            yield f"Open {copy} beside this text: it lists all of this."
        else:
            without = f", without its {', '.join(answer.copy.not_carried)}" if answer.copy.not_carried else ""
            yield f"Open {copy} beside this text: a copy of your file{without} in which each of these cells is marked."
        where = "" if has_errors else ", where they are not as they should be,"
        yield f"Fix the cells in your own file{where} and save it."
    elif has_errors:
        yield "Fix this as described."
    if has_errors:
        yield f"Then {_AGAIN}."
    elif answer.file is not None:
        yield f"If you have changed it, {_AGAIN}."
    else:
        yield f"{_AGAIN[0].upper()}{_AGAIN[1:]}."


def _as_bytes(lines: Iterable[str]) -> bytes:
    return _MARK + "".join(f"{shown(line, _LONGEST)}\r\n" for line in lines).encode()
