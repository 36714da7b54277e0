"""Delimited text → a sheet of raw cells: delimiter, encoding and decimal sign are recognised and told."""

from __future__ import annotations

import csv
import io
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from itertools import islice

from flexlash.reading.decimal_signs import Settled, settle_numbers
from flexlash.reading.encodings import WINDOWS, decoded
from flexlash.reading.raw import ERROR_WORDS, CsvDialect, ErrorCell, RawSheet, RawValue
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.sample_of_file import add_sample
from flexlash.schema.columns import ENTRY_SHEETS, columns_of
from flexlash.schema.header_names import LAST_HEADER_ROW, columns_named, known_names

__all__ = [
    "DELIMITERS",
    "SEPARATOR_LINE",
    "WINDOWS",
    "TooLong",
    "delimiter_of",
    "mark_errors",
    "number_columns",
    "read_table",
    "records_of",
]

DELIMITERS = ",;\t|"
_TOP = 15
"""Rows by which the delimiter is told."""

SEPARATOR_LINE = re.compile(r'"?sep=([,;\t|])"?(?:\r\n|\r|\n|$)', re.IGNORECASE)
"""First line by which a table tells Excel its delimiter; Excel does not show it as a row."""

_WIDEST = 100_000
"""Delimiters in one record, those inside of quoted texts included, beyond which it is not taken apart."""

_SHARED = 50_000
"""Different texts that are held once however often they stand in a table."""

_Rows = dict[int, dict[int, RawValue]]


def read_table(data: bytes, name: str, file: str = "", limits: ReadingLimits | None = None) -> RawSheet:
    """Return a delimited text as a sheet that knows how it was written; `file` is the name its findings give it.

    `name` is the entry sheet that the table stands for. Rows, columns and cells are counted while they are read.
    Raises Refusal when the encoding cannot be told, when it is no table, or when it exceeds a limit.
    """
    limits = limits or ReadingLimits()
    text, encoding = decoded(data)
    text = text.replace("\r\n", "\n").replace("\r", "\n").rstrip("\n")
    separator_line = SEPARATOR_LINE.match(text)
    text = text[separator_line.end() :] if separator_line else text
    if '"' not in text:
        limits.require("table_rows", text.count("\n") + 1)
    delimiter = delimiter_of(
        lambda: io.StringIO(text, newline="\n"), separator_line[1] if separator_line else DELIMITERS, limits
    )
    read = _rows(records_of(io.StringIO(text, newline="\n"), delimiter, limits), limits)
    if "#" in text:
        mark_errors(read.rows)
    sample_column = add_sample(read.rows, file) if name == "Measurements" and file else 0
    header, columns, others = number_columns(read.rows, name)
    longer = read.longer_than(header) if delimiter == "," and header else frozenset()
    # Without a quote no cell of a table that is separated by commas holds one.
    is_settled = delimiter == "," and '"' not in text and not longer
    settled = Settled() if is_settled else settle_numbers(read.rows, columns, others, delimiter=delimiter)
    dialect = CsvDialect(
        delimiter=delimiter,
        encoding=encoding,
        file=file,
        comma_number=settled.comma_number,
        foreign_text=_first_foreign(read.rows) if encoding == WINDOWS else None,
        longer=frozenset() if settled.has_decimal_point else longer,
        sample_column=sample_column,
    )
    return RawSheet(name=name, rows=read.rows, numbers_are_texts=True, dialect=dialect)


class TooLong(csv.Error):
    """A cell without end."""


def records_of(texts: Iterable[str], delimiter: str, limits: ReadingLimits) -> Iterator[list[str]]:
    """Yield the records of the lines of a text; raises csv.Error where its quotes do not close.

    A record of too many cells is refused before it is taken apart.
    """
    lines = delimiters = 0

    def counted() -> Iterator[str]:
        nonlocal lines, delimiters
        for line in texts:
            lines += 1
            delimiters += line.count(delimiter)
            if delimiters > _WIDEST:
                raise limits.exceeded("columns", delimiters + 1)
            yield line

    try:
        for record in csv.reader(counted(), delimiter=delimiter, strict=True):
            lines = delimiters = 0
            yield record
    except csv.Error as fault:
        if lines == 1 and "field limit" in str(fault):
            raise TooLong from fault
        raise


def delimiter_of(lines: Callable[[], Iterable[str]], delimiters: str, limits: ReadingLimits) -> str:
    """Return the delimiter that makes the most even rows of the first ones; `lines` begins at the first again.

    Raises Refusal when there is none.
    """
    evenness: dict[str, int] = {}
    is_endless = True
    for sign in delimiters:
        try:
            evenness[sign] = _evenness(list(islice(records_of(lines(), sign, limits), _TOP)))
        except csv.Error as fault:
            is_endless = is_endless and isinstance(fault, TooLong)
    if not evenness and is_endless:
        raise limits.exceeded("characters")
    delimiter = max(evenness, key=lambda sign: evenness[sign], default="")
    if not delimiter or (len(evenness) < len(delimiters) and not evenness[delimiter]):
        raise Refusal("E102")
    return delimiter


def _evenness(records: list[list[str]]) -> int:
    """Return how many cells stand in rows of the commonest width: high for the true delimiter."""
    widths = Counter(len(values) for values in records if len(values) > 1)
    return max((width * count for width, count in widths.items()), default=0)


@dataclass(kw_only=True)
class _Read:
    """The rows with data, and how many cells a row has where that is not `width`, blank ones included."""

    rows: _Rows = field(default_factory=dict)
    width: int = 0
    widths: dict[int, int] = field(default_factory=dict)

    def add(self, row: int, cells: dict[int, RawValue], width: int) -> None:
        """Add a row."""
        self.rows[row] = cells
        self.width = self.width or width
        if width != self.width:
            self.widths[row] = width

    def longer_than(self, header: int) -> frozenset[int]:
        """Return the rows below a header row that have more cells than it has."""
        width = self.widths.get(header, self.width)
        return frozenset(row for row in self.rows if row > header and self.widths.get(row, self.width) > width)


def _rows(records: Iterator[list[str]], limits: ReadingLimits) -> _Read:
    """Return the rows that hold anything, numbered as Excel shows them; each is counted before the next is read."""
    read = _Read()
    shared: dict[str, str] = {}
    once = shared.setdefault
    count = 0
    try:
        for row, values in enumerate(records, start=1):
            if row > limits.table_rows:
                raise limits.exceeded("table_rows")
            cells: dict[int, RawValue] = {
                column: once(text, text) for column, text in enumerate(values, start=1) if text and not text.isspace()
            }
            if cells:
                count += len(cells)
                _count(values, cells, count, limits)
                read.add(row, cells, len(values))
            if len(shared) > _SHARED:
                shared.clear()
    except TooLong as fault:
        raise limits.exceeded("characters") from fault
    except csv.Error as fault:
        raise Refusal("E102") from fault
    return read


def _count(values: list[str], cells: dict[int, RawValue], count: int, limits: ReadingLimits) -> None:
    """Refuse a row that is too wide, a text that is too long, or a table of too many cells."""
    if len(values) > limits.columns:
        limits.require("columns", next(reversed(cells)))
    if (longest := max(map(len, values))) > limits.characters:
        limits.require("characters", longest)
    if count > limits.table_cells:
        raise limits.exceeded("table_cells")


def mark_errors(rows: _Rows) -> None:
    """Put errors in the place of Excel's words for them."""
    for cells in rows.values():
        for column, text in cells.items():
            if isinstance(text, str) and "#" in text and text.strip() in ERROR_WORDS:
                cells[column] = ErrorCell(text.strip())


def number_columns(rows: _Rows, schema: str) -> tuple[int, frozenset[int] | None, frozenset[int]]:
    """Return the row of the headers and the columns that hold numbers and texts by them.

    Where no header is known, the row is 0 and every column may hold numbers, which None stands for.
    """
    columns = columns_of(schema) if schema in ENTRY_SHEETS else {}
    names = known_names(columns)
    top = {row: rows[row] for row in range(1, LAST_HEADER_ROW + 1) if row in rows}
    known = {row: columns_named(cells, names) for row, cells in top.items()}
    best = max(known, key=lambda row: len(known[row]), default=0)
    if not best or len(known[best]) < min(2, len(columns)):
        return 0, None, frozenset()
    numbers = frozenset(column for column, key in known[best].items() if columns[key].is_number)
    return best, numbers, frozenset(known[best]) - numbers


def _first_foreign(rows: _Rows) -> tuple[int, int] | None:
    """Return where the first text stands that not every encoding shows alike."""
    texts = ((row, column, cell) for row, cells in rows.items() for column, cell in cells.items())
    return next(((row, column) for row, column, cell in texts if isinstance(cell, str) and not cell.isascii()), None)
