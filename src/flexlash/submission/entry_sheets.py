"""Which sheets of a submission are its entry sheets, and which were meant to be."""

from __future__ import annotations

from flexlash.columns import ENTRY_SHEETS, columns_of
from flexlash.submission.headers import count_headings
from flexlash.submission.ledger import Ledger
from flexlash.submission.reading.limits import ReadingLimits
from flexlash.submission.reading.raw import RawSheet, Submission
from flexlash.submission.reading.refusal import Refusal
from flexlash.submission.spellings import closest, plain

__all__ = ["entry_sheets", "tell_misspelt_sheets", "tell_second_tables"]

_RESEMBLING = 0.75
"""Likeness of names from which on a sheet with headers of a missing one is taken for it."""

_TELLING = 4
"""Headers by which a sheet is recognised whatever its name."""

_LISTED = 5


def entry_sheets(submission: Submission, limits: ReadingLimits) -> dict[str, RawSheet]:
    """Return the entry sheets by schema; letter case and spaces of their names do not matter.

    Raises Refusal when there is no Variants sheet, two of one name, or more in one than a submission can mean.
    """
    by_plain: dict[str, RawSheet] = {}
    for name, sheet in submission.sheets.items():
        if plain(name) in by_plain and plain(name) in map(plain, ENTRY_SHEETS):
            raise Refusal("E117", found=name, other=by_plain[plain(name)].name)
        by_plain[plain(name)] = sheet
    if plain("Variants") not in by_plain:
        raise _without_variants(submission)
    found = {schema: by_plain[plain(schema)] for schema in ENTRY_SHEETS if plain(schema) in by_plain}
    if submission.kind == "workbook":
        for sheet in found.values():
            limits.require("rows", len(sheet.rows))
            limits.require("columns", max((max(cells) for cells in sheet.rows.values()), default=0))
    return found


def _without_variants(submission: Submission) -> Refusal:
    """Return the refusal of a file without Variants; it names the sheet that was probably meant."""
    names = list(submission.sheets)
    listed = f"the sheets {', '.join(names[:_LISTED])}" if names else "no sheet"
    meant = _meant(submission, "Variants")
    if meant:
        return Refusal("E108", found=listed, sheet=meant, suggestion=meant, repair="Variants")
    return Refusal("E108", found=listed, suggestion=closest("Variants", names))


def _meant(submission: Submission, schema: str) -> str:
    """Return the sheet that holds a schema's headers and has a like name, or nearly all of its headers."""
    others = [name for name in submission.sheets if plain(name) not in map(plain, ENTRY_SHEETS)]
    counts = {name: count_headings(submission.sheets[name], schema) for name in others}
    like = closest(schema, [name for name in others if counts[name] > 1], _RESEMBLING)
    best = max(others, key=lambda name: counts[name], default="")
    telling = min(_TELLING, len(columns_of(schema)))
    return like or (best if best and counts[best] >= telling else "")


def tell_misspelt_sheets(submission: Submission, present: dict[str, RawSheet], ledger: Ledger) -> set[str]:
    """Tell sheets that were meant for a missing one, which no built-in table may replace; return their schemas."""
    found = set()
    for schema in ENTRY_SHEETS.keys() - present.keys() if submission.kind == "workbook" else ():
        if meant := _meant(submission, schema):
            ledger.add("E119", sheet=meant, value=meant, suggestion=schema, repair=schema)
            ledger.everything = True
            found.add(schema)
    return found


def tell_second_tables(submission: Submission, present: dict[str, RawSheet], ledger: Ledger) -> None:
    """Warn of sheets that hold the table of an entry sheet once more, such as the copy `Variants (2)`."""
    read = {sheet.name for sheet in present.values()}
    for name, sheet in submission.sheets.items():
        if name in read or submission.kind != "workbook":
            continue
        for schema in present:
            if count_headings(sheet, schema) >= min(_TELLING, len(columns_of(schema))):
                ledger.add("W428", sheet=name, cell=f"A{min(sheet.rows)}", other=schema)
                break
