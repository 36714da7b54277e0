"""A table of variants, block by block → the facts of all its rows that a few of them would not show.

Each is found by the function that judges a table read at once, or by a quick test for rows beyond doubt.
"""

from __future__ import annotations

from array import array
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import polars as pl

from flexlash.reading.decimal_signs import Marks, sign_of
from flexlash.reading.delimited import mark_errors
from flexlash.reading.own_columns import is_number, is_whole, number_of
from flexlash.reading.raw import ERROR_WORDS, CommaNumber, CsvDialect, DoubtfulNumber, RawSheet, RawValue
from flexlash.reading.refusal import Refusal
from flexlash.reading.whole_table import DoubledNames, OwnKind, WholeTable
from flexlash.schema.cell_addresses import CellAddress, cell_ranges
from flexlash.schema.columns import columns_of, naming_column
from flexlash.schema.header_names import BLANK
from flexlash.schema.spellings import plain
from flexlash.validation.cell_values import Fault, as_text
from flexlash.validation.headers import find_headings
from flexlash.validation.hidden_content import DIGITS
from flexlash.validation.ledger import Ledger
from flexlash.validation.meant_names import MOST_NAMES
from flexlash.validation.typed_columns import entries_of, longest_text, surplus_of
from flexlash.validation.units_row import take_units_row
from flexlash.validation.validated import MANY, Heading, Table

__all__ = ["Assumed", "Block", "Gathered", "Gatherer"]

_SCHEMA = "Variants"
_NAMES = ("material", "tolerance_class")
_MOST_CLASSES = MOST_NAMES
"""Most tolerance classes that a table may name: each excerpt carries all of them."""

_ALL = 2**64 - 1
_NOTHING = pl.DataFrame()
_MOST_KINDS = 4 * 7 * 4
"""More kinds of numbers than there can be."""

_SHAPE = str.maketrans("23456789", "11111111")
"""Digits but 0 are alike to every rule that tells numbers."""


@dataclass(frozen=True, kw_only=True)
class Block:
    """Consecutive rows as columns from the first on: a blank cell is None or a text of spaces."""

    first: int
    columns: Sequence[Sequence[RawValue | None]]
    height: int


@dataclass(frozen=True, kw_only=True)
class Assumed:
    """What a whole table settles only at its end and yet decides how its rows are read."""

    filled: frozenset[int] = frozenset()
    longer_count: bool = False


@dataclass(frozen=True, kw_only=True)
class Gathered:
    """The facts of a whole table; `entries` has a bit for each row number from 0 on, `count` is how many are set."""

    whole: WholeTable
    header_row: int
    units_row: int
    entries: bytes
    count: int
    doubles: DoubledNames


class _Own:
    """What a column holds that flexlash does not use: kinds of its texts, or whether its values are numbers."""

    def __init__(self, *, is_text: bool) -> None:
        self.is_text = is_text
        self.kinds: set[tuple[str, str, str]] = set()
        self.values: set[str] = set()

    def take(self, column: Sequence[RawValue | None]) -> None:
        """Take entries."""
        entries = [value for value in column if value is not None and not _is_blank(value, is_text=self.is_text)]
        if not self.is_text:
            self.values.update("text" if not is_number(one) else _whole_or_not(one) for one in entries)
        elif len(self.kinds) < _MOST_KINDS:
            # Texts with a power of ten are judged themselves, since it may be too great for a number.
            texts = map(str, entries)
            shapes = {text if "e" in text or "E" in text else text.translate(_SHAPE) for text in texts}
            self.kinds.update(map(_kinds, shapes))

    def kind(self, marks: Marks) -> OwnKind:
        """Return what the whole column holds, once it is known what its points and commas are."""
        found = set(self.values)
        for sign, with_point, with_comma in self.kinds:
            mark = marks.get(sign)
            found.add("text" if mark is DoubtfulNumber else with_comma if mark is CommaNumber else with_point)
        if not found or "text" in found:
            return "text"
        return "endless" if "endless" in found else "whole" if found == {"whole"} else "number"


class Gatherer:
    """Gathers the facts of a table of which it is given all rows, in order, in blocks.

    `top` are the rows from the first to the first that holds anything below the header rows.
    """

    def __init__(self, top: Mapping[int, dict[int, RawValue]], dialect: CsvDialect | None, assumed: Assumed) -> None:
        self.dialect = dialect
        self.assumed = assumed
        self.is_text = dialect is not None
        sheet = self._sheet(dict(top), WholeTable(filled=assumed.filled))
        self.heading = find_headings(sheet, _SCHEMA, Ledger("")) or Heading(row=0)
        below = min((row for row in top if row > self.heading.row), default=0)
        self.first_row = below
        self.head = {row: cells for row, cells in top.items() if row <= self.heading.row}
        self.units_row = 0
        if self.heading.row:
            sheet = self._sheet(dict(top), WholeTable(first_row=below))
            self.units_row = take_units_row(sheet, self.heading, _SCHEMA, Ledger(""))
            if self.units_row:
                self.head[self.units_row] = top[self.units_row]
        self.filled: set[int] = set()
        self.nameless: dict[int, int] = {}
        self.above: dict[int, dict[int, RawValue]] = {}
        self.bits = bytearray()
        self.count = 0
        self.hashes = (array("Q"), array("Q"))
        self.rows = array("Q")
        self.named: dict[str, set[str]] = {key: set() for key in _NAMES}
        self.classes: dict[str, str] = {}
        self.own = {index: _Own(is_text=self.is_text) for index in self.heading.extra}
        columns = columns_of(_SCHEMA)
        indices = self.heading.columns
        is_comma = dialect is not None and dialect.delimiter == ","
        remarks = [key for key, column in columns.items() if column.role == "remark" and key in indices]
        self.remarks = dict.fromkeys(remarks, 0) if is_comma else {}
        self.first = indices.get(naming_column(_SCHEMA).key, 0)
        self.texts = {
            indices[key]
            for key, column in columns.items()
            if key in indices and column.required and not column.is_number and indices[key] != self.first
        }
        self.numbers = {indices[key] for key, column in columns.items() if key in indices and column.is_number}
        self.with_header = {*indices.values(), *self.heading.extra, *self.heading.doubtful}
        self.last_header = max(self.head.get(self.heading.row, {0: ""}))

    def holds(self, other: Gatherer) -> bool:
        """Whether what was assumed leads to the same headers as what was found, which another one was told."""
        same = self.heading == other.heading and self.units_row == other.units_row
        return same and self.assumed.longer_count == other.assumed.longer_count

    def _sheet(self, rows: dict[int, dict[int, RawValue]], whole: WholeTable | None = None) -> RawSheet:
        return RawSheet(name=_SCHEMA, rows=rows, numbers_are_texts=self.is_text, dialect=self.dialect, whole=whole)

    def take(self, block: Block, longer: Collection[int] = ()) -> None:
        """Take the next rows; `longer` are those with more cells than the header row, where that may count."""
        if not self.heading.row:
            return
        if self._is_plain(block, longer):
            rows: Sequence[int] = range(block.first, block.first + block.height)
            columns: Mapping[int, Sequence[RawValue | None]] = dict(enumerate(block.columns, start=1))
            self._fill(block.columns)
            self.above = {rows[-1]: _cells(block.columns, block.height - 1, is_text=self.is_text)}
        else:
            rows, columns = self._judged(block, longer)
        self._set_bits(block.first + block.height - 1, rows)
        if rows:
            self._take_entries(rows, columns)

    def _fill(self, columns: Sequence[Sequence[RawValue | None]]) -> None:
        """Find out which columns hold anything."""
        for index, column in enumerate(columns, start=1):
            if index not in self.filled and any(not _is_blank(value, is_text=self.is_text) for value in column):
                self.filled.add(index)

    def _is_plain(self, block: Block, longer: Collection[int]) -> bool:
        """Whether every row of a block is an entry beyond doubt, with nothing beyond its headers that is to be told."""
        if block.first <= self.heading.row or block.first <= self.units_row or longer or not self.first:
            return False
        columns = block.columns
        if len(columns) < max(self.first, *self.texts, 1):
            return False
        if any(any(columns[index - 1]) for index in range(self.last_header + 1, len(columns) + 1)):
            return False
        unnamed = set(range(1, min(self.last_header, len(columns)) + 1)) - self.with_header - self.nameless.keys()
        if any(not _is_blank(value, is_text=self.is_text) for index in unnamed for value in columns[index - 1]):
            return False
        numbers = (index for index in sorted(self.numbers) if index <= len(columns))
        return (
            _is_solid(columns[self.first - 1])
            and any(index > self.first and _is_solid(columns[index - 1]) for index in self.texts)
            and any(_is_solid(columns[index - 1]) for index in numbers)
        )

    def _judged(self, block: Block, longer: Collection[int]) -> tuple[list[int], dict[int, list[RawValue | None]]]:
        """Return the entries of a block with their cells by column, as a table read at once has them."""
        below = {
            block.first + number: cells
            for number in range(block.height)
            if (cells := _cells(block.columns, number, is_text=self.is_text))
        }
        if self.is_text:
            mark_errors(below)
        for cells in (cells for row, cells in below.items() if row > self.heading.row):
            self.filled.update(index for index, value in cells.items() if not _is_blank(value, is_text=False))
        rows = {**self.head, **self.above, **below}
        sheet = self._sheet(rows)
        if self.dialect and longer:
            sheet = replace(sheet, dialect=replace(self.dialect, longer=frozenset(longer)))
        table = Table(sheet=_SCHEMA, schema=_SCHEMA, heading=self.heading, frame=_NOTHING)
        ledger = Ledger("")
        entries = {row: cells for row, cells, _ in entries_of(table, sheet, self.units_row, ledger) if row in below}
        for found in ledger.findings:
            if found.code == "I509" and found.address:
                self.nameless.setdefault(found.address.column, found.address.row)
        if entries:
            last = max(entries)
            self.above = {last: rows[last]}
        for row, cells in entries.items():
            if surplus_of(sheet, self.heading, row):
                entries[row] = {index: cells[index] for index in cells if index in {self.first, *self.own}}
        wanted = {*self.heading.columns.values(), *self.own}
        return [*entries], {index: [cells.get(index) for cells in entries.values()] for index in wanted}

    def _set_bits(self, last: int, rows: Sequence[int]) -> None:
        """Note which rows are entries, up to the last one of a block."""
        self.bits.extend(bytes(last + 1 - len(self.bits)))
        if isinstance(rows, range):
            self.bits[rows.start : rows.stop] = b"\1" * len(rows)
        else:
            for row in rows:
                self.bits[row] = 1
        self.count += len(rows)

    def _take_entries(self, rows: Sequence[int], columns: Mapping[int, Sequence[RawValue | None]]) -> None:
        """Take what the cells of entries say, by column."""
        blank = [None] * len(rows)
        names = _texts(columns.get(self.first, blank), "variant", is_text=self.is_text)
        for row, name in zip(rows, names, strict=True):
            if name is not None:
                folded = name.casefold()
                self.hashes[0].append(hash(folded) & _ALL)
                self.hashes[1].append(hash(f"\0{folded}") & _ALL)
                self.rows.append(row)
        for key in _NAMES:
            self._take_names(columns.get(self.heading.columns.get(key, 0), blank), key)
        for index, own in self.own.items():
            own.take(columns.get(index, ()))
        for key, first in [*self.remarks.items()]:
            texts = _texts(columns.get(self.heading.columns[key], blank), key, is_text=self.is_text)
            for row, text in zip(rows, texts, strict=True):
                if text is None:
                    continue
                if not DIGITS.fullmatch(text):
                    del self.remarks[key]
                    break
                first = first or row  # noqa: PLW2901
                self.remarks[key] = first

    def _take_names(self, column: Sequence[RawValue | None], key: str) -> None:
        """Take which materials or classes a column names."""
        missing = "standard" if key == "tolerance_class" else ""
        different = list(dict.fromkeys(column))
        for text in _texts(different, key, is_text=self.is_text):
            if text is None:
                if missing:
                    self.classes.setdefault(missing, missing)
                continue
            if text in self.named[key]:
                continue
            if missing:
                self.classes.setdefault(plain(text), text)
            if len(self.named[key]) <= MOST_NAMES:
                self.named[key].add(text)
        if len(self.classes) > _MOST_CLASSES:
            raise Refusal(
                "E110",
                what="the number of tolerance classes",
                limit=f"{_MOST_CLASSES:,}",
                found=f"more than {_MOST_CLASSES:,}",
                setting="table_rows",
                detail="",
            )

    def gathered(self, marks: Marks, others: Collection[int]) -> Gathered:
        """Return the facts; `marks` say what takes the place of numbers, but in the columns `others`."""
        whole = WholeTable(
            head=max(self.heading.row, self.units_row),
            filled=frozenset(self.filled),
            first_row=self.first_row,
            is_empty=not self.count,
            nameless=self.nameless,
            digits={key: row for key, row in self.remarks.items() if row},
            named={key: len(names) for key, names in self.named.items()},
            classes=tuple(self.classes.values()),
            own={index: own.kind({} if index in others else marks) for index, own in self.own.items()},
        )
        return Gathered(
            whole=whole,
            header_row=self.heading.row,
            units_row=self.units_row,
            entries=np.packbits(np.frombuffer(bytes(self.bits), dtype=np.uint8)).tobytes(),
            count=self.count,
            doubles=_doubles(self.hashes, self.rows, self.heading.columns.get(naming_column(_SCHEMA).key, 1)),
        )


def _is_blank(value: RawValue | None, *, is_text: bool) -> bool:
    """Whether a cell counts as blank where rows are judged; readers of texts leave out more spaces than others."""
    if not isinstance(value, str):
        return value is None
    return not value.strip(BLANK) or (is_text and value.isspace())


def _is_solid(column: Sequence[RawValue | None]) -> bool:
    """Whether a column holds numbers, or texts that are beyond doubt no blanks."""
    kinds = set(map(type, column))
    if kinds == {str}:
        texts: Sequence[str] = column  # type: ignore[assignment]
        return all(texts) and "".join(texts).isascii() and not any(map(str.isspace, texts))
    return kinds <= {int, float}


def _cells(columns: Sequence[Sequence[RawValue | None]], number: int, *, is_text: bool) -> dict[int, RawValue]:
    """Return the cells of one row as a reader gives them."""
    cells: dict[int, RawValue] = {}
    for index, column in enumerate(columns, start=1):
        value = column[number]
        if value is not None and not (is_text and isinstance(value, str) and (not value or value.isspace())):
            cells[index] = value
    return cells


def _texts(column: Sequence[RawValue | None], key: str, *, is_text: bool) -> Sequence[str | None]:
    """Return the entries of a column of texts as the typed table has them."""
    longest = longest_text(columns_of(_SCHEMA)[key])
    if set(map(type, column)) == {str}:
        texts: Sequence[str] = column  # type: ignore[assignment]
        joined = f"|{'|'.join(texts)}|"
        is_plain = joined.isascii() and joined.isprintable() and all(texts) and max(map(len, texts)) <= longest
        if is_plain and not any(sign in joined for sign in ("  ", "| ", " |", "#")):
            return texts
    return [_text(value, longest, is_text=is_text) for value in column]


def _text(value: RawValue | None, longest: int, *, is_text: bool) -> str | None:
    """Return one entry as the typed table has it."""
    if value is None or _is_blank(value, is_text=is_text):
        return None
    if is_text and isinstance(value, str) and value.strip() in ERROR_WORDS:
        return None
    text = as_text(value, longest)
    return None if isinstance(text, Fault) else text or None


def _kinds(text: str) -> tuple[str, str, str]:
    """Return the kind of a number by its sign, and what it is read as where that sign is a point and a comma."""
    return sign_of(text), _read_as(text), _read_as(CommaNumber(text))


def _read_as(text: str) -> str:
    number = number_of(text)
    if number is None:
        return "text"
    return _whole_or_not(number) if is_number(number) else "endless"


def _whole_or_not(number: RawValue) -> str:
    return "whole" if is_whole(number) else "number"


def _doubles(hashes: tuple[array[int], array[int]], rows: array[int], column: int) -> DoubledNames:
    """Return the rows of every name that more than one row has; names are alike whose two hashes of 64 bits are."""
    first, second = (np.frombuffer(one, dtype=np.uint64) for one in hashes)
    numbers = np.frombuffer(rows, dtype=np.uint64).astype(np.int64)
    order = np.argsort(first, kind="stable")
    ordered = first[order]
    same = ordered[1:] == ordered[:-1]
    repeated = np.zeros(len(order), dtype=bool)
    repeated[1:] |= same
    repeated[:-1] |= same
    chosen = np.sort(order[repeated])
    chosen = chosen[np.lexsort((second[chosen], first[chosen]))]
    one, other = first[chosen], second[chosen]
    is_start = np.ones(len(chosen), dtype=bool)
    is_start[1:] = (one[1:] != one[:-1]) | (other[1:] != other[:-1])
    sizes = np.diff(np.append(np.flatnonzero(is_start), len(chosen)))
    kept = np.repeat(sizes > 1, sizes)
    starts = np.append(0, np.cumsum(sizes[sizes > 1]))
    doubled = numbers[chosen][kept]
    ranges = {
        number: cell_ranges(CellAddress(row, column) for row in doubled[start:end].tolist())
        for number, (start, end) in enumerate(zip(starts[:-1].tolist(), starts[1:].tolist(), strict=True))
        if end - start > MANY
    }
    # Plain arrays: whoever receives a survey loads no library to hold it.
    own = (array("q", one.astype(np.int64).tobytes()) for one in (doubled, starts))
    return DoubledNames(rows=next(own), starts=next(own), ranges=ranges, column=column)
