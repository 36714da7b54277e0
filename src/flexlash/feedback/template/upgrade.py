"""A filled file of any earlier version → a filled template of this version, and what could not be carried over."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from flexlash.feedback.template.cell_writer import Formula, writable
from flexlash.feedback.template.entry_rules import FIRST_ROW
from flexlash.feedback.template.filling import Entries, Filling
from flexlash.feedback.template.leftovers import Leftovers, leftovers_of
from flexlash.feedback.template.sketch_sheet import SKETCH
from flexlash.feedback.template.template_workbook import LEGEND, LINKS, TITLES, template_bytes
from flexlash.reading.limited_process import ask
from flexlash.reading.raw import ErrorCell, RawSheet, RawValue, Submission, Unstored
from flexlash.reading.read import Source, submission_of
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.schema.cell_addresses import CellAddress
from flexlash.schema.columns import ENTRY_SHEETS, SETTINGS, Column
from flexlash.schema.spellings import plain
from flexlash.validation.cell_values import as_number
from flexlash.validation.entry_sheets import entry_sheets
from flexlash.validation.headers import find_headings
from flexlash.validation.ledger import Ledger
from flexlash.validation.template_versions import template_version
from flexlash.validation.validate import validate
from flexlash.validation.validated import Heading

__all__ = ["Upgrade", "refilled", "upgraded"]

_MADE_ANEW = (SKETCH, "Dictionary", "Lists")
_ABOVE = re.compile(
    r"Template version \d+|\d+ of \d+ rows complete|No row entered yet"
    r"|Yellow columns are required\. Each header has a note; each cell says what it takes\."
    r"|One row per class and dimension: a grade, or lower and upper deviation\. No row: exact(\.|, or that of the "
    r"class which it is based on\.)|Blank values take the default\."
    r"|flexlash: one row per flexspline variant"
    r"|Fill the yellow cells of a row: its type decides which\..* Help: the note on a header, the sheet Sketch\.",
    re.IGNORECASE,
)
"""What this and former versions of the template write above a header row beside title and hint."""

_ARITHMETIC = re.compile(r"[-+*/^() \d.]+", re.ASCII)
_NO_RESULT = "=NA()"
"""What stands for a formula without a result: it never turns into a number that nobody entered."""

_LISTED = 5
_LAST_ROW = 1_048_576
_WITHOUT_FORMAT = "Colours, number formats, widths, filters and rules of your own are those of the new template."


@dataclass(frozen=True, kw_only=True)
class Upgrade:
    """The new template, the old one's version if it says one, how many rows of Variants moved, and what to look at.

    `remarks` say in sentences what was not carried over as it was.
    """

    data: bytes
    version: int | None
    rows: int
    remarks: tuple[str, ...]


def upgraded(path: Path, limits: ReadingLimits | None = None, optional: Collection[str] = ()) -> Upgrade:
    """Return a template of this version, filled with everything that a template, workbook or table holds.

    It has the optional sheets of the file and those named `optional`. Raises OSError when the file cannot be opened and
    Refusal when it is no readable submission or a newer template.
    """
    limits = limits or ReadingLimits()
    return ask(_upgraded, limits, Source.at(path, limits), limits, tuple(optional))


def _upgraded(source: Source, limits: ReadingLimits, optional: Collection[str]) -> Upgrade:
    submission = submission_of(source, limits)
    if submission.role.startswith(("report", "checked")):
        raise Refusal("E101", found="it is a report or a marked copy made by flexlash")
    if submission.kind != "workbook":
        return refilled(submission, limits, optional=optional)
    upgrade = refilled(submission, limits, leftovers_of(source.data, limits, _MADE_ANEW), optional)
    return replace(upgrade, remarks=(*upgrade.remarks, _WITHOUT_FORMAT))


def refilled(
    submission: Submission,
    limits: ReadingLimits,
    leftovers: Leftovers | None = None,
    optional: Collection[str] = (),
) -> Upgrade:
    """Return a template of this version, filled with what was read and with what else the file held.

    Raises Refusal when there is no header row, or a newer template's.
    """
    leftovers = leftovers or Leftovers()
    validated = validate(submission, limits)
    if validated.table is None:
        raise Refusal("E109", sheet="Variants", cell="A1")
    filled: dict[str, Entries] = {}
    remarks: list[str] = []
    sheets = _entry_sheets(submission, limits, remarks)
    for schema, sheet in sheets.items():
        carried = _Carried(sheet, schema, leftovers, limits)
        filled |= {schema: carried.entries} if carried.entries else {}
        remarks += carried.remarks
    remarks += _left_behind(submission, [sheet.name for sheet in sheets.values()], leftovers)
    return Upgrade(
        data=template_bytes(Filling(sheets=filled, optional=optional)),
        version=template_version(submission),
        rows=validated.table.frame.height,
        remarks=tuple(remarks),
    )


def _entry_sheets(submission: Submission, limits: ReadingLimits, remarks: list[str]) -> dict[str, RawSheet]:
    """Return the entry sheets by schema, one of another name as the one that was meant."""
    sheets = entry_sheets(submission, limits)
    for schema, sheet in sheets.items():
        if submission.kind == "workbook" and plain(sheet.name) != plain(schema):
            remarks.append(f"The sheet {sheet.name} was taken as {schema}.")
    return sheets


class _Carried:
    """One entry sheet of the old file as the new template takes it; `entries` is None when it has no header row."""

    def __init__(self, sheet: RawSheet, schema: str, leftovers: Leftovers, limits: ReadingLimits) -> None:
        limits.require("rows", len(sheet.rows))
        limits.require("columns", max((max(cells) for cells in sheet.rows.values()), default=0))
        self.sheet = sheet
        self.schema = schema
        self.formulas = leftovers.formulas.get(sheet.name, {})
        self.notes = leftovers.notes.get(sheet.name, ())
        self.remarks: list[str] = []
        self.entries: Entries | None = None
        ledger = Ledger("")
        heading = find_headings(sheet, schema, ledger)
        if heading is None:
            self._remark(f"{len(sheet.rows)} rows have no header row above them and were left behind", ())
            return
        reported = {finding.address for finding in ledger.findings}
        self.heading = heading
        self.keys = _keys(heading)
        self.own = self._own_columns()
        self.entries = Entries(
            rows=self._rows(),
            columns=[self._column(column, reported) for column in ENTRY_SHEETS[schema]],
            own=[sheet.rows[heading.row].get(column) for column in self.own],
        )
        self._remark_losses()

    def _remark(self, text: str, addresses: Iterable[CellAddress]) -> None:
        """Add a remark on cells, naming the first few."""
        self.remarks.append(f"{_addresses(self.sheet.name, list(addresses))}: {text}.")

    def _own_columns(self) -> list[int]:
        """Return the columns of the user, in order: unknown or doubled headers, and values without a header."""
        below = {column for row, cells in self.sheet.rows.items() if row >= self.heading.row for column in cells}
        explained = {self.heading.columns.get("value", 0) + 1} - self.sheet.rows[self.heading.row].keys()
        meanings = explained if self.schema == "Settings" else set()
        return sorted(below - self.keys.keys() - self.heading.ignored - meanings)

    def _column(self, column: Column, reported: set[CellAddress | None]) -> Column:
        """Return a column under the user's header, with the unit of that header, where it differs from ours."""
        number = next((number for number, key in self.keys.items() if key == column.key), 0)
        header = CellAddress(self.heading.row, number)
        if header not in reported:
            return column
        label = str(self.sheet.rows[self.heading.row][number])
        factor = self.heading.factors.get(column.key, 1.0)
        low, high = (None if bound is None else bound / factor for bound in (column.minimum, column.maximum))
        unit = label.rpartition("[")[2].rstrip("] ") if "[" in label and factor != 1 else column.unit
        self._remark(f'the header "{label.strip()}" and the values below it are kept as they are', [header])
        return replace(column, label=label, unit=unit, minimum=low, maximum=high)

    def _rows(self) -> list[dict[str | int, Any]]:
        """Return the rows below the header at their distance from it; those of Settings in the template's order.

        Rows of a table that lie beyond the end of a worksheet stand close below each other instead, as far as they fit.
        """
        carried = {*self.keys, *self.own}
        filled_rows = [
            row for row, cells in self.sheet.rows.items() if row > self.heading.row and carried & cells.keys()
        ]
        most = _LAST_ROW - FIRST_ROW
        places = {row: row - self.heading.row - 1 for row in filled_rows}
        if max(places.values(), default=0) >= most:
            self._remark(
                "these rows stand close below each other, since they reach beyond the last row of a sheet",
                [CellAddress(row, 1) for row in filled_rows],
            )
            places = {row: place for place, row in enumerate(filled_rows)}
        rows: list[dict[str | int, Any]] = [{}] * min(most, max(places.values(), default=-1) + 1)
        self.values: list[CellAddress] = []
        self.unstored: list[CellAddress] = []
        self.texts: list[CellAddress] = []
        for row in filled_rows[:most]:
            rows[places[row]] = self._row(row)
        if beyond := [CellAddress(row, 1) for row in filled_rows[most:]]:
            self._remark("beyond the last row of the new sheet, and left behind", beyond)
        return _settings_in_order(rows) if self.schema == "Settings" else rows

    def _row(self, row_number: int) -> dict[str | int, Any]:
        """Return a row's values under the keys of their columns, or under the number of the user's own column."""
        own = {column: count for count, column in enumerate(self.own)}
        row: dict[str | int, Any] = {}
        for column, value in self.sheet.rows[row_number].items():
            key = self.keys.get(column, own.get(column))
            if key is not None:
                row[key] = self._value(CellAddress(row_number, column), key, value)
        return row

    def _value(self, address: CellAddress, key: str | int, value: RawValue) -> Any:
        """Return a cell's value as the new one holds it, and note what it loses."""
        text = self.formulas.get(address)
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if text and _ARITHMETIC.fullmatch(text) and (is_number or isinstance(value, Unstored)):
            return Formula(text=f"={text}", result=value if isinstance(value, int | float) else None)
        if isinstance(value, Unstored):
            self.unstored.append(address)
            return Formula(text=_NO_RESULT)
        if text is not None and not isinstance(value, ErrorCell):
            self.values.append(address)
        columns = {column.key: column for column in ENTRY_SHEETS[self.schema]}
        if self.sheet.numbers_are_texts and isinstance(key, str) and columns[key].is_number:
            number = as_number(value, from_text=True)
            return number if isinstance(number, float) else value
        kept = writable(value)
        if type(kept) is not type(value) or kept != value:
            self.texts.append(address)
        return kept

    def _remark_losses(self) -> None:
        """Remark what the cells of the sheet lost."""
        sheet, first = self.sheet, self.heading.row + 1
        above = [
            CellAddress(row, column)
            for row, cells in sheet.rows.items()
            for column, value in cells.items()
            if row < self.heading.row and not _is_ours(value, self.schema)
        ]
        empty = {cell for cell in self.formulas if cell.row >= first and cell.column in {*self.keys, *self.own}}
        empty -= {CellAddress(row, column) for row, cells in sheet.rows.items() for column in cells}
        hidden = [CellAddress(row, 1) for row in sorted(sheet.hidden_rows) if row >= first]
        merged = [CellAddress(row, column) for row, column, *_ in sheet.merged]
        notes = [cell for cell in self.notes if cell.row != self.heading.row or cell.column in self.own]
        for addresses, text in (
            (self.values, "formulas became the values that they showed"),
            (self.unstored, "formulas that never stored a result show #N/A until you enter their values"),
            (sorted(empty), "formulas that showed nothing were left behind"),
            (self.texts, "what no cell can hold became a text, or was cut to a cell's length"),
            (notes, "notes were left behind"),
            (above, "what stands above the header row was left behind"),
            (hidden, "hidden rows are shown"),
            (merged, "merged cells are apart"),
        ):
            if addresses:
                self._remark(text, addresses)


def _keys(heading: Heading) -> dict[int, str]:
    """Return the key of each column that fills one of the template; a doubtful header fills the one it meant."""
    keys = {column: key for key, column in heading.columns.items()}
    for column, key in heading.doubtful.items():
        if key not in keys.values() and column not in heading.diameters:
            keys[column] = key
    return keys


def _settings_in_order(rows: Sequence[dict[str | int, Any]]) -> list[dict[str | int, Any]]:
    """Return the settings in the template's order, then every other row; a setting that is absent has its default."""
    rest = [row for row in rows if row]
    ordered: list[dict[str | int, Any]] = []
    for column in SETTINGS:
        entered = next((row for row in rest if plain(str(row.get("setting", ""))) == plain(column.key)), None)
        ordered.append({"setting": column.key, "value": column.default} if entered is None else entered)
        rest = [row for row in rest if row is not entered]
    return ordered + rest


def _is_ours(value: RawValue, schema: str) -> bool:
    """Whether the template itself wrote a cell above the header."""
    if not isinstance(value, str):
        return isinstance(value, Unstored)
    groups = {column.group for column in ENTRY_SHEETS[schema]}
    return (
        not value.strip()
        or value in {*TITLES[schema], *groups, *LEGEND.values(), *LINKS.values()}
        or bool(_ABOVE.fullmatch(value))
    )


def _addresses(sheet: str, addresses: Sequence[CellAddress]) -> str:
    """Return cells as Excel writes them, the first few by name."""
    named = ", ".join(map(str, addresses[:_LISTED]))
    more = f" and {len(addresses) - _LISTED} more" if len(addresses) > _LISTED else ""
    return f"{sheet}!{named}{more}" if addresses else sheet


def _left_behind(submission: Submission, carried: Sequence[str], leftovers: Leftovers) -> list[str]:
    """Say what stands beside the entry sheets and was left behind."""
    ours = {plain(name) for name in (*carried, *_MADE_ANEW)}
    remarks = [
        f"The sheet {name} with {len(sheet.rows)} {'row' if len(sheet.rows) == 1 else 'rows'} was left behind."
        for name, sheet in submission.sheets.items()
        if plain(name) not in ours
    ]
    objects = [f"{count} {name if count == 1 else _plural(name)}" for name, count in leftovers.objects.items()]
    return remarks + ([f"Left behind: {', '.join(objects)}."] if objects else [])


def _plural(name: str) -> str:
    """Return an object's name for several of them."""
    irregular = {
        "text box or shape": "text boxes or shapes",
        "link to another workbook": "links to other workbooks",
        "set of macros": "sets of macros",
    }
    return irregular.get(name, f"{name}s")
