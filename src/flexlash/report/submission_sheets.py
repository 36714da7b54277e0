"""The submission as read: every cell at its own address, so that findings link to it and say there what is wrong.

Of a large submission the drawn variants alone stand here, worst first, each behind its row number.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeGuard

from flexlash.analysis.outcome import Outcome
from flexlash.feedback.template.template_workbook import TITLES
from flexlash.reading.raw import RawSheet, RawValue, Submission, Unstored
from flexlash.report.extent import extent_of
from flexlash.report.failing.failing_places import variant_targets
from flexlash.report.layout.links import Mirrored, finding_list, mirrored, write_link
from flexlash.report.layout.paper import Listed, print_one_page
from flexlash.report.layout.raw_cells import raw_text, write_raw
from flexlash.report.layout.styles import Book
from flexlash.report.layout.wrapping import LINE_HEIGHT, lines_of
from flexlash.report.report_data import Drawn
from flexlash.schema.cell_addresses import CellAddress, column_letters
from flexlash.schema.columns import ENTRY_SHEETS
from flexlash.schema.number_words import grouped
from flexlash.validation.entry_sheets import sheet_names
from flexlash.validation.headers import STATUS_HEADER, plain
from flexlash.validation.materials_and_classes import BUILT_IN_SHEETS, built_in_sheet

__all__ = ["MOST_COMMENTS", "SUBMISSION", "mirrored_schema", "titles_of", "write_submission"]

MOST_COMMENTS = 2000
"""Most guilty cells that say in a comment what is wrong; Findings lists all."""

_COMMENT_WIDTH, _COMMENT_LINE, _PER_LINE = 320, 18, 48
_MOST_LINES = 14
_NAME, _LEAST, _MOST = 16.0, 9.0, 90.0
"""Least widths of the first column and the others, and the greatest; longer texts are wrapped."""

_FOLDED = {"level": 1, "hidden": True}
_HEADER_LINES = 3
"""Least lines of the header row."""

_BOLD = 1.05
"""How much wider bold letters are."""

_ROW_HEADER = "Row"
"""Heading of the row numbers before variants that do not stand in their own rows."""

_TEMPLATE_TITLES = frozenset(title for title, _ in TITLES.values())
SUBMISSION = "Submission"
"""The sheet of the report that mirrors Variants."""

_RESULT_SHEETS = frozenset({"Levers", "Sweep"})
"""Entry sheets whose names are those of sheets of the report, which say what comes of them."""

_TITLES = {name: f"{name} entered" if name in _RESULT_SHEETS else name for name in ENTRY_SHEETS} | {
    "Variants": SUBMISSION
}


def mirrored_schema(title: str) -> str:
    """Return the entry sheet that a sheet of the report mirrors, the title itself for one that mirrors none.

    >>> mirrored_schema("Submission"), mirrored_schema("Levers entered")
    ('Variants', 'Levers')
    """
    return next((schema for schema, mirror in _TITLES.items() if mirror == title), title)


def titles_of(submission: Submission) -> dict[str, str]:
    """Return the sheets of the report that mirror sheets of the submission, by the names of these."""
    return {name: _TITLES[schema] for schema, name in sheet_names(submission).items()}


@dataclass(kw_only=True)
class _Guilt:
    """What is wrong with a cell: the worst level, and what its comment says."""

    level: str
    messages: list[str] = field(default_factory=list)


@dataclass(frozen=True, kw_only=True)
class _Mirror:
    """A sheet to repeat: its cells, its header row (0: none) and its guilty cells by address.

    `linked` is the column whose cells lead where `targets` says by row number; `told` are columns with a cell that has
    findings. Where cells are moved, `note` says at the top what is left out.
    """

    raw: RawSheet
    title: str
    header: int
    guilty: Mapping[CellAddress, _Guilt]
    told: frozenset[int] = frozenset()
    linked: int = 0
    targets: Mapping[int, str] = field(default_factory=dict)
    places: Mirrored = field(default_factory=Mirrored)
    note: str = ""


def write_submission(book: Book, outcome: Outcome, drawn: Sequence[Drawn]) -> None:
    """Write each entry sheet of the submission as read, guilty cells coloured, or the built-in table used instead."""
    guilty, told = _guilty(outcome), _told(outcome)
    extent = extent_of(outcome)
    validated = outcome.validated
    headers = validated.header_rows if validated else {}
    table = validated.table if validated else None
    by_title = {title: outcome.submission.sheets[name] for name, title in titles_of(outcome.submission).items()}
    for schema, title in _TITLES.items():
        raw = by_title.get(title)
        if raw:
            of_sheet = {address: guilt for (name, address), guilt in guilty.items() if name == raw.name}
            header, of_columns = headers.get(schema, 0), frozenset(told[raw.name])
            mirror = _Mirror(raw=raw, title=title, header=header, guilty=of_sheet, told=of_columns)
            if schema == "Variants" and table is not None:
                linked = table.heading.columns.get("variant", 0)
                targets = variant_targets(drawn, outcome.settings.verdict_bounds)
                mirror = replace(mirror, linked=linked, targets=targets, places=mirrored(outcome, drawn))
                if extent.large:
                    note = f"{extent.note or f'All {grouped(extent.total)} variants'} Worst first, as read."
                    mirror = replace(mirror, note=note)
            _write_mirror(book, mirror)
        elif schema in BUILT_IN_SHEETS:
            _write_mirror(book, _Mirror(raw=built_in_sheet(schema), title=title, guilty={}, header=1))


def _guilty(outcome: Outcome) -> dict[tuple[str, CellAddress], _Guilt]:
    """Return what is wrong with each cell, by sheet and address, errors first; the first alone have messages."""
    guilty: dict[tuple[str, CellAddress], _Guilt] = {}
    for finding in finding_list(outcome):
        if finding.level != "info" and (address := finding.address):
            guilt = guilty.setdefault((finding.sheet, address), _Guilt(level=finding.level))
            guilt.messages.append(f"{finding.code} {finding.message}")
    for guilt in list(guilty.values())[MOST_COMMENTS:]:
        guilt.messages.clear()
    return guilty


def _told(outcome: Outcome) -> Mapping[str, set[int]]:
    """Return the columns with a cell that has findings, by sheet: links lead there."""
    told: dict[str, set[int]] = defaultdict(set)
    for finding in outcome.findings:
        if address := finding.address:
            told[finding.sheet].add(address.column)
    return told


def _write_mirror(book: Book, mirror: _Mirror) -> None:
    """Write a sheet's cells in their places, its header row as such."""
    raw, places = mirror.raw, mirror.places
    sheet = book.sheet(mirror.title)
    rows = raw.rows if places.rows is None else {row: raw.rows[row] for row in places.rows if row in raw.rows}
    ignored = {
        column
        for column, value in raw.rows.get(mirror.header, {}).items()
        if isinstance(value, str) and plain(value) == plain(STATUS_HEADER)
    }
    addresses = [
        place
        for row, cells in rows.items()
        for column in cells
        if column not in ignored and (place := places.place(CellAddress(row=row, column=column)))
    ]
    bottom = max((row for row, _ in addresses), default=1)
    last = max((column for _, column in addresses), default=1)
    widths, headings = _widths(mirror, rows, last), _headings(mirror, rows, last)
    _set_columns(sheet, widths, headings)
    sheet.ignore_errors({"number_stored_as_text": f"A1:XFD{bottom}"})
    if header := mirror.header and mirror.header + places.shift:
        texts = raw.rows.get(mirror.header, {})
        below = enumerate(widths[places.shift :], start=1)
        lines = max(lines_of(str(texts.get(column, "")), width / _BOLD) for column, width in below)
        sheet.set_row(header - 1, LINE_HEIGHT * max(lines, _HEADER_LINES) + 3)
        sheet.freeze_panes(header, 1 + places.shift)
        sheet.repeat_rows(header - 1)
        sheet.autofilter(header - 1, 0, bottom - 1, last - 1)
    if mirror.note:
        sheet.write_string(0, 0, mirror.note, book.format("quiet"))
    for row, cells in rows.items():
        place = places.place(CellAddress(row=row, column=1))
        if place is None:
            continue
        if places.shift and row >= mirror.header:
            write_raw(book, sheet, (place.row - 1, 0), *((row,) if row > mirror.header else (_ROW_HEADER, "header")))
        if row > mirror.header:
            below = enumerate(widths[places.shift :], start=1)
            _set_height(sheet, place.row, [(cells[column], width) for column, width in below if column in cells])
        for column, value in cells.items():
            if column not in ignored and not (isinstance(value, Unstored) and row < mirror.header):
                _write_value(book, sheet, mirror, CellAddress(row=row, column=column), value)
    _write_guilt(book, sheet, mirror)
    seen = [width if heading else 0.0 for width, heading in zip(widths, headings, strict=True)]
    print_one_page(sheet, seen, bottom - 1, listed=Listed(noun="rows", first=header, columns=headings))


def _set_columns(sheet: Any, widths: Sequence[float], headings: Sequence[str]) -> None:
    """Set the widths of columns, those without a heading folded away."""
    for column, width in enumerate(widths):
        options = {"collapsed": column > 0 and not headings[column - 1]} if headings[column] else _FOLDED
        sheet.set_column(column, column, width, None, options)


def _write_value(book: Book, sheet: Any, mirror: _Mirror, address: CellAddress, value: RawValue) -> None:
    """Write one cell of the submission, its variant's name with a link to its page."""
    row, column = address
    place, guilt = mirror.places.place(address), mirror.guilty.get(address)
    if place is None:
        return
    cell = (place.row - 1, place.column - 1)
    style = guilt.level if guilt else _style(mirror, row, column, value)
    if column == mirror.linked and row in mirror.targets and isinstance(value, str):
        link = book.format(style if guilt else "wrap link")
        write_link(sheet, *cell, mirror.targets[row], raw_text(value), style=link)
    else:
        write_raw(book, sheet, cell, value, style)


def _headings(mirror: _Mirror, rows: Mapping[int, Mapping[int, RawValue]], last: int) -> list[str]:
    """Return the headings of so many columns, blank for one in which no row below has an entry or a finding."""
    shift, header = mirror.places.shift, mirror.header
    used = mirror.told.union(*(cells for row, cells in rows.items() if row > header))
    texts = mirror.raw.rows.get(header, {})
    return [_ROW_HEADER] * shift + [
        str(texts.get(column) or column_letters(column)) if column in used or not header else ""
        for column in range(1, last + 1 - shift)
    ]


def _widths(mirror: _Mirror, rows: Mapping[int, Mapping[int, RawValue]], last: int) -> list[float]:
    """Return the widths of so many columns, each as wide as its longest entry and the longest word of its header."""
    shift = mirror.places.shift
    widths = [*[_LEAST] * shift, _NAME, *[_LEAST] * (last - 1 - shift)]
    for row, cells in rows.items():
        for column, value in cells.items() if row >= mirror.header else ():
            if column + shift <= last:
                text = raw_text(value)
                words = text.split() if row == mirror.header else [text]
                long = max(map(len, words), default=0) * (_BOLD if row == mirror.header else 1.0) + 2.5
                place = column + shift - 1
                widths[place] = min(max(widths[place], long), _MOST)
    return widths


def _set_height(sheet: Any, row: int, cells: Sequence[tuple[object, float]]) -> None:
    """Make a row high enough for its wrapped texts."""
    lines = max((lines_of(value, width) for value, width in cells if _is_wrapped(value)), default=1)
    if lines > 1:
        sheet.set_row(row - 1, LINE_HEIGHT * lines)


def _is_wrapped(value: object) -> TypeGuard[str]:
    """Whether a value is a text longer than the widest column."""
    return isinstance(value, str) and len(value) > _MOST - 2


def _style(mirror: _Mirror, row: int, column: int, value: object) -> str:
    """Return the format of a cell without fault; what stands above the header of our template looks as there."""
    if row == mirror.header:
        return "header"
    if row < mirror.header and mirror.raw.rows.get(1, {}).get(1) in _TEMPLATE_TITLES:
        return "title" if row == 1 and column == 1 else "label" if row == mirror.header - 1 else "quiet"
    # A text stands clear of the number at its left.
    return "wrap" if _is_wrapped(value) else "indented" if isinstance(value, str) and column > 1 else "text"


def _write_guilt(book: Book, sheet: Any, mirror: _Mirror) -> None:
    """Colour guilty cells that are blank and say at the guilty cells what is wrong."""
    for address, guilt in mirror.guilty.items():
        place = mirror.places.place(address)
        if place is None:
            continue
        row, column = place.row - 1, place.column - 1
        if address.column not in mirror.raw.rows.get(address.row, {}):
            sheet.write_blank(row, column, None, book.format(guilt.level))
        if guilt.messages:
            text = "\n".join(guilt.messages)
            lines = min(sum(1 + len(message) // _PER_LINE for message in guilt.messages), _MOST_LINES)
            size = {"width": _COMMENT_WIDTH, "height": _COMMENT_LINE * (lines + 1)}
            sheet.write_comment(row, column, text, {"font_size": 9, **size})
