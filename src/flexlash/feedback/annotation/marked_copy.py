"""Submission + findings → a workbook with its guilty cells marked, or with the findings alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from openpyxl import Workbook

from flexlash.feedback.annotation.added_findings_sheet import counted, write_findings
from flexlash.feedback.annotation.loading import fresh, load, usual
from flexlash.feedback.annotation.marks import MOST_NOTES, guilty_cells, mark, unmark
from flexlash.feedback.annotation.packing import pack
from flexlash.feedback.annotation.record import Record, take_record, write_record
from flexlash.feedback.annotation.table_sheets import add_table
from flexlash.feedback.annotation.unsupported_content import losses
from flexlash.reading.libraries import require_known_libraries
from flexlash.reading.raw import RawSheet
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.schema.findings import Finding

__all__ = ["MarkedCopy", "findings_workbook", "marked_copy", "marked_table"]

_TO_DO = "Mend the coloured cells in your own file and submit that; flexlash skips this copy without --marked-copies."


@dataclass(frozen=True, kw_only=True)
class MarkedCopy:
    """A marked workbook, and what of the submission it does not hold."""

    data: bytes
    lost: tuple[str, ...]


def marked_copy(data: bytes, findings: Sequence[Finding], name: str, limits: ReadingLimits | None = None) -> MarkedCopy:
    """Return the user's own workbook with its guilty cells marked; marks of an earlier copy give way to the new ones.

    Raises Refusal for a workbook that is refused, ChangedLibrary when none could be marked, and whatever openpyxl
    raises on one that it cannot read or write.
    """
    try:
        return _copied(usual(data, limits or ReadingLimits()), findings, name)
    except (MemoryError, Refusal):
        raise
    except Exception:
        require_known_libraries()
        raise


def _copied(data: bytes, findings: Sequence[Finding], name: str) -> MarkedCopy:
    workbook = load(data)
    earlier = take_record(workbook)
    unmark(workbook, earlier.marks)
    lost = tuple(dict.fromkeys([*earlier.lost, *losses(data, workbook)]))
    lines = [_TO_DO]
    if lost:
        lines.append(f"Your own file holds what this copy could not take over: {', '.join(lost)}.")
    _mark(workbook, findings, name, lines, lost)
    return MarkedCopy(data=pack(workbook), lost=lost)


def marked_table(sheets: Mapping[str, RawSheet], findings: Sequence[Finding], name: str) -> bytes:
    """Return a submission that is no workbook as one, with its guilty cells marked."""
    workbook = fresh()
    for title, raw in sheets.items():
        add_table(workbook, title, raw)
    _mark(workbook, findings, name, [_TO_DO], ())
    return pack(workbook)


def findings_workbook(findings: Sequence[Finding], name: str, why: str) -> bytes:
    """Return the findings alone, for a submission that cannot be marked; `why` is the first line."""
    workbook = fresh()
    lines = [f"{name} has {counted(findings)}.", "Mend the cells listed here in your own file and submit it again."]
    write_findings(workbook, findings, why, lines)
    return pack(workbook)


def _mark(
    workbook: Workbook, findings: Sequence[Finding], name: str, lines: Sequence[str], lost: Sequence[str]
) -> None:
    """Mark the guilty cells, list the findings, and leave the record for the next marking."""
    guilty = guilty_cells(workbook, findings)
    marks = mark(workbook, guilty)
    first = (
        f"{counted(findings).capitalize()}. Cells with an error are red, cells with a warning yellow; "
        "each has a note that says how to mend it."
    )
    capped = [f"Notes are on the first {MOST_NOTES:,} of {len(guilty):,} coloured cells; the list has them all."]
    explained = [first, *lines, *(capped if len(guilty) > MOST_NOTES else [])]
    title = write_findings(workbook, findings, f"flexlash: what to mend in {name}", explained)
    write_record(workbook, title, Record(marks=marks, lost=lost))
