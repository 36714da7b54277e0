"""Which sheets of a submission are its entry sheets: by their names, else by their headers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flexlash.reading.raw import RawSheet, Submission
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.schema.cell_addresses import CellAddress
from flexlash.schema.columns import ENTRY_SHEETS, OPTIONAL_SHEETS, columns_of
from flexlash.schema.spellings import closest, plain
from flexlash.validation.headers import known_headings
from flexlash.validation.ledger import Ledger

__all__ = ["entry_sheets", "report_other_names", "report_second_tables", "sheet_names", "with_tables"]

_RESEMBLING = 0.75
"""Likeness of names from which on a sheet with headers of a missing one is taken for it."""

_TELLING = 4
"""Headers by which a sheet is recognised whatever its name."""

_OWN = {
    "Variants": frozenset({"variant", "material", "flexspline_type"}),
    "Measurements": frozenset({"sample"}),
    "Correlations": frozenset({"dimension_1", "dimension_2", "correlation"}),
    "Other sources": frozenset({"source", "enter_as"}),
    "Levers": frozenset({"dimension", "may_change"}),
    "Sweep": frozenset({"dimension", "from", "to", "step"}),
}
"""Headers that tell sheets apart which share the others: dimensions stand in Variants and in Measurements."""

_FEWEST = 2
"""Headers without which a sheet holds no table."""

_LISTED = 5


def entry_sheets(submission: Submission, limits: ReadingLimits) -> dict[str, RawSheet]:
    """Return the entry sheets by schema: by name, letter case and spaces apart, else the only one with its headers.

    Raises Refusal when there is no Variants sheet, two of one name, or more in one than a submission can mean.
    """
    names: dict[str, str] = {}
    for name in submission.sheets:
        if plain(name) in names and plain(name) in map(plain, ENTRY_SHEETS):
            raise Refusal("E117", found=name, other=names[plain(name)])
        names[plain(name)] = name
    sheets = {schema: submission.sheets[name] for schema, name in sheet_names(submission).items()}
    if "Variants" not in sheets:
        raise _without_variants(submission)
    if submission.kind == "workbook":
        for sheet in sheets.values():
            limits.require("rows", len(sheet.rows))
            limits.require("columns", max((max(cells) for cells in sheet.rows.values()), default=0))
    return sheets


def sheet_names(submission: Submission) -> dict[str, str]:
    """Return the name of each entry sheet that a submission has, by schema, in the order of the template."""
    names = {plain(name): name for name in submission.sheets}
    chosen = {schema: names[plain(schema)] for schema in ENTRY_SHEETS if plain(schema) in names}
    for schema in ENTRY_SHEETS.keys() - chosen.keys():
        meant = [name for name in _meant(submission, schema) if name not in chosen.values()]
        if len(meant) == 1:
            chosen[schema] = meant[0]
    return {schema: chosen[schema] for schema in ENTRY_SHEETS if schema in chosen}


def _without_variants(submission: Submission) -> Refusal:
    """Return the refusal of a file without Variants; it names the sheets that were probably meant."""
    names = list(submission.sheets)
    listed = f"the sheets {', '.join(names[:_LISTED])}" if names else "no sheet"
    if meant := _meant(submission, "Variants"):
        return Refusal("E127", sheet=meant[0], **_several(meant, "Variants"))
    return Refusal("E108", found=listed, suggestion=closest("Variants", names))


def _several(names: list[str], schema: str) -> dict[str, Any]:
    """Return what the message says of sheets that may all be meant."""
    return {"found": ", ".join(names[:_LISTED]), "other": schema}


def _meant(submission: Submission, schema: str) -> list[str]:
    """Return the sheets of other names that hold nearly all of a schema's headers, or some and a like name."""
    if submission.kind != "workbook":
        return []
    others = [name for name in submission.sheets if plain(name) not in map(plain, ENTRY_SHEETS)]
    counts = {name: _headings(submission.sheets[name], schema) for name in others}
    sure = [name for name in others if counts[name] >= _telling(schema)]
    like = closest(schema, [name for name in others if counts[name] > 1], _RESEMBLING)
    return sure or [like] * bool(like)


def _telling(schema: str) -> int:
    """Return how many headers tell a sheet of another name; of an optional one those of its own are among them."""
    return _TELLING - 1 if schema in OPTIONAL_SHEETS else min(_TELLING, len(columns_of(schema)))


def _headings(sheet: RawSheet, schema: str) -> int:
    """Return how many headers of a schema a sheet has, none where they belong to a table of another kind.

    Dimensions beside a sample, without variants and materials, are measurements; what has neither, as a table that lost
    its first columns, may be variants alone.
    """
    known = known_headings(sheet, schema)
    if schema == "Variants" and not known & _OWN[schema]:
        return 0 if "sample" in known_headings(sheet, "Measurements") else len(known)
    if schema in OPTIONAL_SHEETS:
        is_own = known >= _OWN[schema] and not known_headings(sheet, "Variants") & _OWN["Variants"]
        return len(known) if is_own else 0
    return len(known)


def report_other_names(submission: Submission, present: dict[str, RawSheet], ledger: Ledger) -> set[str]:
    """Tell sheets that were read under another name, and several that may be meant; return the schemas of the latter.

    No built-in table may take the place of a sheet that is there twice.
    """
    for schema, sheet in present.items():
        if submission.kind == "workbook" and plain(sheet.name) != plain(schema):
            ledger.add("I520", sheet=sheet.name, value=sheet.name, other=schema)
    unclear = set()
    for schema in ENTRY_SHEETS.keys() - present.keys():
        read = {sheet.name for sheet in present.values()}
        if meant := [name for name in _meant(submission, schema) if name not in read]:
            ledger.add("E127", sheet=meant[0], **_several(meant, schema))
            ledger.everything |= schema not in OPTIONAL_SHEETS
            unclear.add(schema)
    return unclear


def report_second_tables(submission: Submission, present: dict[str, RawSheet], ledger: Ledger) -> None:
    """Warn of sheets that hold the table of an entry sheet once more, such as the copy `Variants (2)`."""
    read = {sheet.name for sheet in present.values()}
    for name, sheet in submission.sheets.items():
        if name in read or submission.kind != "workbook":
            continue
        for schema in present:
            if _headings(sheet, schema) >= _telling(schema):
                ledger.add("W428", sheet=name, cell=CellAddress(row=min(sheet.rows), column=1), other=schema)
                break


def with_tables(sheets: Mapping[str, RawSheet], ledger: Ledger) -> dict[str, RawSheet]:
    """Return the entry sheets without optional ones that have no more than the name of one, with a warning of each.

    Before these sheets were read, engineers could have sheets of their own under such names. A file that was given as
    a table is one.
    """
    left = dict(sheets)
    for schema in OPTIONAL_SHEETS:
        sheet = sheets.get(schema)
        if sheet and sheet.dialect is None and len(known_headings(sheet, schema)) < _FEWEST:
            del left[schema]
            if sheet.rows:
                cell = CellAddress(row=min(sheet.rows), column=1)
                ledger.add("W452", sheet=sheet.name, cell=cell, other=schema)
    return left
