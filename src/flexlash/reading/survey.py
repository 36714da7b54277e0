"""A large table → its survey: where its rows are found again, and what only all of them together show.

The file is streamed: no more of it is held than a block of rows, and a few bytes for each row.
"""

from __future__ import annotations

import csv
import hashlib
import os
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

from flexlash.reading.decimal_signs import Marks, numbers_of, settled_marks, sign_of
from flexlash.reading.delimited import (
    DELIMITERS,
    SEPARATOR_LINE,
    TooLong,
    delimiter_of,
    mark_errors,
    number_columns,
    records_of,
)
from flexlash.reading.encodings import WINDOWS
from flexlash.reading.gate import kind_of, opened_file
from flexlash.reading.parquet_file import row_groups
from flexlash.reading.raw import CommaNumber, CsvDialect, RawValue
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.text_lines import Lines, TextForm, text_form
from flexlash.reading.whole_table import DoubledNames, WholeTable
from flexlash.schema.findings import readable
from flexlash.schema.header_names import LAST_HEADER_ROW

if TYPE_CHECKING:
    from flexlash.validation.whole_tables import Gathered, Gatherer

__all__ = [
    "CHANGED",
    "LARGE_ROWS",
    "MOST_ROWS",
    "RowBlock",
    "Survey",
    "TextFacts",
    "is_large",
    "limits_of_survey",
    "survey",
    "survey_of",
    "too_many_rows",
]

LARGE_ROWS = 20_000
"""Rows from which on a table is large."""

_HEAD = 2**20
_ROWS, _BYTES = 1000, 2**20
"""Rows, or bytes, after which a block ends."""

MOST_ROWS = 9_999_999
"""Rows of the longest table: an address has seven digits."""

CHANGED = "it has changed since its first reading"
"""What is said of a file that is no longer the one that was surveyed."""

_FIXED = "; an address has no more, whatever the setting"
_SECONDS = 86_400
_SHAPE = str.maketrans("23456789", "11111111")


class RowBlock(NamedTuple):
    """Where consecutive rows stand: number of the first, how many there are, first byte, length, and its digest.

    In a Parquet file a block is a group of rows, `start` the number of the group and `size` 0.
    """

    first: int
    rows: int
    start: int
    size: int
    digest: bytes


@dataclass(frozen=True, kw_only=True)
class TextFacts:
    """How a delimited text is read: its bytes, the signs of its numbers, and how many cells its header row has.

    `marks` say what takes the place of numbers by their kind, but in the columns `others`; `header_width` is 0 where
    no row can have a cell too many.
    """

    form: TextForm
    dialect: CsvDialect
    marks: Marks
    others: frozenset[int]
    header_width: int


@dataclass(frozen=True, kw_only=True)
class Survey:
    """A large table after the first pass over it.

    `kind` is csv or parquet, `size` its length in bytes, `rows` how many entries it has. `head` are the rows up to that
    of the headers, which is 0 where there is none, and the row of units. `first` and `last` are the numbers of the
    first and the last row below; `blocks` say where they stand. `entries` has a bit for each row number from 0 on.
    `whole` is what an excerpt is told of all rows; `inexact` are columns of a Parquet file whose whole numbers are read
    as doubles.
    """

    name: str
    kind: str
    sha256: str
    size: int
    rows: int
    header_row: int
    units_row: int
    first: int
    last: int
    head: Mapping[int, Mapping[int, RawValue]]
    blocks: tuple[RowBlock, ...]
    whole: WholeTable
    entries: bytes = field(repr=False)
    doubles: DoubledNames = field(repr=False)
    text: TextFacts | None = None
    inexact: tuple[str, ...] = ()

    def chunks(self, rows: int) -> Iterator[range]:
        """Yield the row numbers of excerpts, so many each; one without a row where the table has none below its head.

        All rows are in one of them, also those that are no entries.
        """
        if self.first > self.last:
            yield range(self.first, self.first)
        for start in range(self.first, self.last + 1, rows):
            yield range(start, min(start + rows, self.last + 1))


def limits_of_survey(limits: ReadingLimits, size: int = 0) -> ReadingLimits:
    """Return limits in which a file of any size can be surveyed and excerpted; `size` is its length in bytes.

    Memory beyond the file's own pages, which a Parquet file's reader addresses, stays as it is.
    """
    memory = min(limits.memory_mebibytes + size // 2**20 + 1, 2**20)
    return replace(limits, seconds=_SECONDS, processor_seconds=_SECONDS, memory_mebibytes=memory)


def is_large(path: Path, limits: ReadingLimits) -> bool:  # noqa: ARG001
    """Whether a path leads to a text or Parquet file of more than LARGE_ROWS rows; False for whatever it cannot tell.

    Nothing is parsed but the length of a Parquet file's footer and its count of rows. Raises OSError when the file
    cannot be opened.
    """
    with opened_file(path) as file:
        head = file.read(_HEAD)
        try:
            kind = kind_of(head)
        except Refusal:
            return False
        if kind == "parquet":
            try:
                return sum(group.rows for group in row_groups(file)) > LARGE_ROWS
            except Refusal:
                return False
        if kind != "csv":
            return False
        ends = 0
        while head:
            # A line may end with both; a quoted text may hold some, which does no harm here.
            ends += max(head.count(b"\n"), head.count(b"\r"))
            if ends > LARGE_ROWS:
                return True
            head = file.read(_HEAD)
    return False


def survey(path: Path, limits: ReadingLimits, name: str = "") -> Survey:
    """Return the survey of a text table or a Parquet file of any size; `name` is its own where its path has another.

    To be asked of the limited process, within `limits_of_survey`. Raises OSError when the file cannot be opened,
    Refusal when it is no table, or holds what no table of variants can.
    """
    with opened_file(path) as file:
        status = os.fstat(file.fileno())
        head = file.read(_HEAD)
        if not head:
            raise Refusal("E101", found="the file is empty")
        kind = kind_of(head)
        name = name or readable(path.name)
        if kind == "csv":
            found = _of_text(file, status.st_size, name, limits)
        elif kind == "parquet":
            from flexlash.reading.survey_parquet import of_parquet

            found = of_parquet(file, path, status.st_size, name, limits)
        else:
            raise Refusal("E101", found="a table as .csv or .parquet is required here")
        if not _is_unchanged(status, os.fstat(file.fileno())) or not _is_unchanged(status, path.stat()):
            raise Refusal("E101", found=CHANGED)
        return found


def _is_unchanged(one: os.stat_result, other: os.stat_result) -> bool:
    """Whether a file is still the one that it was."""
    return os.path.samestat(one, other) and (one.st_size, one.st_mtime_ns) == (other.st_size, other.st_mtime_ns)


def _of_text(file: BinaryIO, size: int, name: str, limits: ReadingLimits) -> Survey:
    """Return the survey of a delimited text."""
    try:
        return _Text(file, size, name, limits).survey()
    except TooLong as fault:
        raise limits.exceeded("characters") from fault
    except (csv.Error, UnicodeDecodeError) as fault:
        raise Refusal("E102") from fault


@dataclass(kw_only=True)
class _Pass:
    """What one pass over all records of a text found; `told` are the rows of cells that are told of the whole text."""

    sha256: str = ""
    blocks: list[RowBlock] = field(default_factory=list)
    last: int = 0
    counts: Counter[str] = field(default_factory=Counter)
    comma_number: tuple[int, int] | None = None
    foreign_text: tuple[int, int] | None = None
    has_longer: bool = False
    told: dict[int, dict[int, RawValue]] = field(default_factory=dict)


class _Text:
    """A delimited text while it is surveyed."""

    def __init__(self, file: BinaryIO, size: int, name: str, limits: ReadingLimits) -> None:
        self.file = file
        self.size = size
        self.name = name
        self.limits = limits
        self.form = text_form(file, size)
        first = Lines(file, self.form, limits)
        separator = SEPARATOR_LINE.match(next(iter(first), ""))
        self.start = first.position if separator else self.form.start
        self.delimiter = delimiter_of(self._lines, separator[1] if separator else DELIMITERS, limits)
        self.top: dict[int, dict[int, RawValue]] = {}
        widths: dict[int, int] = {}
        for row, values in enumerate(records_of(self._lines(), self.delimiter, limits), start=1):
            if row > MOST_ROWS:
                raise too_many_rows()
            if cells := _cells(values):
                self._require(values)
                self.top[row], widths[row] = cells, len(values)
                if row > LAST_HEADER_ROW:
                    break
        mark_errors(self.top)
        beginning = {row: cells for row, cells in self.top.items() if row <= LAST_HEADER_ROW}
        header, self.columns, self.others = number_columns(beginning, "Variants")
        self.header = header
        self.header_width = widths.get(header, 0) if self.delimiter == "," else 0

    def _lines(self) -> Lines:
        return Lines(self.file, self.form, self.limits, self.start)

    def survey(self) -> Survey:
        """Return the survey."""
        from flexlash.validation.whole_tables import Assumed, Gatherer

        dialect = CsvDialect(delimiter=self.delimiter, encoding=self.form.encoding, file=self.name)
        assumed = Assumed(filled=frozenset(range(1, self.limits.columns + 1)))
        while True:
            gatherer = Gatherer(self.top, dialect, assumed)
            found = self._pass(gatherer)
            marks, has_decimal_point = settled_marks(found.counts, self.delimiter)
            assumed = Assumed(
                filled=frozenset(gatherer.filled), longer_count=found.has_longer and not has_decimal_point
            )
            if gatherer.holds(Gatherer(self.top, dialect, assumed)):
                break
        comma_number = found.comma_number if marks.get("comma") is CommaNumber else None
        dialect = replace(dialect, comma_number=comma_number, foreign_text=found.foreign_text)
        gathered = gatherer.gathered(marks, self.others)
        text = TextFacts(
            form=self.form,
            dialect=dialect,
            marks=marks,
            others=self.others,
            header_width=0 if has_decimal_point else self.header_width,
        )
        return survey_of(
            gathered,
            found.told | self.top,
            found.last,
            name=self.name,
            kind="csv",
            sha256=found.sha256,
            size=self.size,
            blocks=tuple(found.blocks),
            text=text,
        )

    def _pass(self, gatherer: Gatherer) -> _Pass:
        """Go through all records, block by block."""
        self.file.seek(0)
        digest = hashlib.sha256(self.file.read(self.start))
        lines = self._lines()
        records = records_of(lines, self.delimiter, self.limits)
        found, first = _Pass(), 1
        while True:
            begin = lines.position
            block = []
            for record in records:
                block.append(record)
                if len(block) >= _ROWS or lines.position - begin >= _BYTES:
                    break
            data = lines.taken()
            if not data:
                break
            digest.update(data)
            if not block:
                continue
            own = hashlib.blake2b(data, digest_size=16).digest()
            found.blocks.append(RowBlock(first, len(block), begin, len(data), own))
            if first + len(block) - 1 > MOST_ROWS:
                raise too_many_rows()
            self._take(gatherer, found, first, block, is_ascii=data.isascii())
            first += len(block)
        found.sha256 = digest.hexdigest()
        return found

    def _take(self, gatherer: Gatherer, found: _Pass, first: int, block: list[list[str]], *, is_ascii: bool) -> None:
        """Take a block of records."""
        from flexlash.validation.whole_tables import Block

        widths = [*map(len, block)]
        widest = max(widths)
        longer = []
        if self.header_width and widest > self.header_width:
            longer = [
                first + number
                for number, width in enumerate(widths)
                if width > self.header_width and first + number > self.header and _has_cells(block[number])
            ]
            found.has_longer = found.has_longer or bool(longer)
        if widest > self.limits.columns:
            for number, values in enumerate(block):
                self._require(values)
                block[number] = values[: self.limits.columns]
        columns = [*zip(*block, strict=True)] if min(widths) == widest else [*zip_longest(*block, fillvalue="")]
        if any(max(map(len, column)) > self.limits.characters for column in columns):
            for values in block:
                self._require(values)
        self._count_signs(found, first, block, columns)
        if self.form.encoding == WINDOWS and found.foreign_text is None and not is_ascii:
            rows = dict(_numbered(block, first))
            texts = ((row, column, text) for row, cells in rows.items() for column, text in cells.items())
            found.foreign_text = next(((row, column) for row, column, text in texts if not str(text).isascii()), None)
            found.told |= {row: rows[row] for row in rows if found.foreign_text and row == found.foreign_text[0]}
        last = next((number for number in reversed(range(len(block))) if _has_cells(block[number])), None)
        found.last = found.last if last is None else first + last
        gatherer.take(
            Block(first=first, columns=columns, height=len(block)), longer if gatherer.assumed.longer_count else ()
        )

    def _count_signs(self, found: _Pass, first: int, block: list[list[str]], columns: list[tuple[str, ...]]) -> None:
        """Count the numbers with a sign, by their kinds; note the first with a decimal comma."""
        if self.delimiter == "," and not self.form.has_quotes and found.counts["point"]:
            # No cell holds a comma, so that one point settles all.
            return
        before = found.counts["comma"]
        for index in range(1, len(columns) + 1) if self.columns is None else self.columns:
            joined = "\0".join(columns[index - 1]) if index <= len(columns) else ""
            if "." in joined or "," in joined:
                for shape, count in Counter(joined.translate(_SHAPE).split("\0")).items():
                    if kind := sign_of(shape):
                        found.counts[kind] += count
        if found.comma_number is None and found.counts["comma"] > before:
            rows = dict(_numbered(block, first))
            found.comma_number = next(
                (row, column) for row, column, _, kind in numbers_of(rows, self.columns) if kind == "comma"
            )
            found.told[found.comma_number[0]] = rows[found.comma_number[0]]

    def _require(self, values: list[str]) -> None:
        """Refuse a row that is too wide, or a text that is too long."""
        if cells := _cells(values):
            self.limits.require("columns", max(cells) if len(values) > self.limits.columns else 0)
            self.limits.require("characters", max(map(len, values)))


def _cells(values: Iterable[str]) -> dict[int, RawValue]:
    """Return the cells of a record that are not blank."""
    return {column: text for column, text in enumerate(values, start=1) if text and not text.isspace()}


def _has_cells(values: Iterable[str]) -> bool:
    """Whether a record holds anything."""
    return any(text and not text.isspace() for text in values)


def _numbered(block: Iterable[list[str]], first: int) -> Iterator[tuple[int, dict[int, RawValue]]]:
    """Yield the rows of a block that hold anything, with their numbers."""
    for row, values in enumerate(block, start=first):
        if cells := _cells(values):
            yield row, cells


def too_many_rows() -> Refusal:
    """Return the refusal of a table whose rows have no address."""
    limit = f"{MOST_ROWS:,}"
    facts = {"what": "the number of rows of a table", "limit": limit, "found": f"more than {limit}", "detail": _FIXED}
    return Refusal("E110", setting="table_rows", **facts)


def survey_of(gathered: Gathered, top: Mapping[int, Mapping[int, RawValue]], last: int, **known: Any) -> Survey:
    """Return the survey of a table from what was gathered of it and what else is `known`.

    `top` are at least its rows up to the one below the headers, `last` is its last row that holds anything.
    """
    header = gathered.header_row
    head = {row: cells for row, cells in top.items() if row <= header or row == gathered.units_row}
    return Survey(
        rows=gathered.count,
        header_row=header,
        units_row=gathered.units_row,
        first=gathered.whole.head + 1,
        last=last if header else 0,
        head=head if header else top,
        whole=gathered.whole,
        entries=gathered.entries,
        doubles=gathered.doubles,
        **known,
    )
