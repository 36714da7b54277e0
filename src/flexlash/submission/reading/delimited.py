"""Delimited text → a sheet of raw cells: delimiter, encoding and decimal sign are recognised and told."""

from __future__ import annotations

import codecs
import csv
import io
import re
from collections import Counter
from collections.abc import Iterator

from flexlash.submission.reading.raw import (
    ERROR_WORDS,
    CommaNumber,
    DoubtfulNumber,
    ErrorCell,
    Manner,
    RawSheet,
    RawValue,
)
from flexlash.submission.reading.refusal import Refusal

__all__ = ["WINDOWS", "read_table"]

WINDOWS = "Windows-1252"
"""The encoding that is taken when a text is no Unicode; only its reader can tell whether that was right."""

_DELIMITERS = ",;\t|"
_MARKED = (
    (codecs.BOM_UTF8, "utf-8-sig", "UTF-8"),
    (codecs.BOM_UTF16_LE, "utf-16", "UTF-16"),
    (codecs.BOM_UTF16_BE, "utf-16", "UTF-16"),
)
_NO_TEXT = re.compile(r"[\x00-\x08\x0e-\x19\x1b-\x1f]")
"""Control characters that no program writes into a table; 1A ended the files of DOS."""

_TOP = 15
"""Rows among which the header, and so the widest row of a table, is looked for."""

_SEPARATOR_LINE = re.compile(r'"?sep=([,;\t|])"?(?:\r\n|\r|\n|$)', re.IGNORECASE)
"""First line by which a table tells Excel its delimiter; Excel does not show it as a row."""

_SIGNED = r"[+-]?"
_POWER = r"(?:[eE][+-]?\d{1,3})?"
_EITHER = r"(?!" + _SIGNED + r"[1-9]\d{0,2}[.,]\d{3}$)"
"""No number whose one sign may be that of decimals or of thousands."""

_COMMA = re.compile(_EITHER + _SIGNED + r"\d*,\d+" + _POWER, re.ASCII)
_SIGNS = {
    "decimal comma": re.compile(_COMMA.pattern + "|" + _SIGNED + r"[1-9]\d{0,2}(?:\.\d{3})+,\d+", re.ASCII),
    "decimal point": re.compile(
        _EITHER + _SIGNED + r"(?:\d+\.\d*|\.\d+)" + _POWER + "|" + _SIGNED + r"[1-9]\d{0,2}(?:,\d{3})+\.\d+", re.ASCII
    ),
    "any comma": re.compile(_SIGNED + r"[1-9]\d{0,2},\d{3}", re.ASCII),
    "any point": re.compile(_SIGNED + r"[1-9]\d{0,2}\.\d{3}", re.ASCII),
}
"""Numbers by what their sign can be: 1,6 and 1.200,5 have a decimal comma, 1.200 may be 1.2 or 1200."""

_PREVAILING = 3
"""So many times more numbers with one decimal sign than with the other make the others the odd ones."""

_Rows = dict[int, dict[int, RawValue]]


def read_table(data: bytes, name: str, file: str = "") -> RawSheet:
    """Return a delimited text as a sheet that knows how it was written; `file` is the name its findings give it.

    Raises Refusal when its encoding cannot be told or it is no table.
    """
    text, encoding = _decoded(data)
    told = _SEPARATOR_LINE.match(text)
    text = text[told.end() :] if told else text
    delimiter, records = _table(text, told[1] if told else _DELIMITERS)
    rows: _Rows = {}
    for number, values in enumerate(records, start=1):
        cells: dict[int, RawValue] = {
            place: ErrorCell(cell.strip()) if cell.strip() in ERROR_WORDS else cell
            for place, cell in enumerate(values, start=1)
            if cell.strip()
        }
        if cells:
            rows[number] = cells
    manner = Manner(
        delimiter=delimiter,
        encoding=encoding,
        file=file,
        comma_number=_settle_numbers(rows) if delimiter != "," else None,
        foreign_text=_first_foreign(rows) if encoding == WINDOWS else None,
    )
    return RawSheet(name=name, rows=rows, numbers_are_texts=True, manner=manner)


def _decoded(data: bytes) -> tuple[str, str]:
    """Return a text and the name of its encoding."""
    codec, encoding = next(
        ((codec, name) for mark, codec, name in _MARKED if data.startswith(mark)), ("utf-8", "UTF-8")
    )
    try:
        text = data.decode(codec)
    except UnicodeDecodeError as fault:
        if codec != "utf-8":
            raise Refusal("E107") from fault
        text, encoding = _as_windows(data), WINDOWS
    if "\0" in text:
        raise Refusal("E102")
    return text, encoding


def _as_windows(data: bytes) -> str:
    """Return a text in the encoding of Excel's plain CSV, when every byte has a meaning there."""
    try:
        text = data.decode("cp1252")
    except UnicodeDecodeError as fault:
        raise Refusal("E107") from fault
    if _NO_TEXT.search(text):
        raise Refusal("E107")
    return text


def _table(text: str, delimiters: str) -> tuple[str, list[list[str]]]:
    """Return the delimiter that makes the most even rows, and the records that it makes."""
    tables = {sign: records for sign in delimiters if (records := _records(text, sign)) is not None}
    delimiter = max(tables, key=lambda sign: _evenness(tables[sign]), default="")
    if not delimiter or (len(tables) < len(delimiters) and not _evenness(tables[delimiter])):
        raise Refusal("E102")
    return delimiter, tables[delimiter]


def _evenness(records: list[list[str]]) -> int:
    """Return how many cells of the top rows stand in rows of the commonest width: high for the true delimiter."""
    widths = Counter(len(values) for values in records[:_TOP] if len(values) > 1)
    return max((width * count for width, count in widths.items()), default=0)


def _records(text: str, delimiter: str) -> list[list[str]] | None:
    """Return the records of a CSV text; None where its quotes do not close."""
    try:
        return list(csv.reader(io.StringIO(text, newline=None), delimiter=delimiter, strict=True))
    except csv.Error:
        return None


def _texts(rows: _Rows) -> Iterator[tuple[int, int, str]]:
    """Yield row, column and text of every cell that may be a number."""
    for number, cells in rows.items():
        for place, cell in cells.items():
            if isinstance(cell, str):
                yield number, place, cell.strip()


def _settle_numbers(rows: _Rows) -> tuple[int, int] | None:
    """Mark the numbers with a decimal comma; return the first, or None where commas are not settled as decimal.

    Commas and points that can be nothing but decimal signs are counted. Where commas prevail, numbers with a point
    are in doubt; elsewhere those whose point may separate thousands, as soon as one comma must be decimal.
    """
    found = {sign: [cell for cell in _texts(rows) if kind.fullmatch(cell[2])] for sign, kind in _SIGNS.items()}
    commas, points = found["decimal comma"], found["decimal point"]
    open_commas, open_points = found["any comma"], found["any point"]
    plain = [(number, place) for number, place, text in commas if _COMMA.fullmatch(text)]
    if plain and len(commas) >= _PREVAILING * len(points):
        _mark(rows, [cell for cell in commas if _COMMA.fullmatch(cell[2])], CommaNumber)
        _mark(rows, open_commas, DoubtfulNumber if points or open_points else CommaNumber)
        _mark(rows, points + open_points, DoubtfulNumber)
        return plain[0]
    if commas and open_points:
        # The commas are the only sign of the doubt: mended, they would leave 1.200 behind as an ordinary number.
        _mark(rows, commas + open_points, DoubtfulNumber)
    return None


def _mark(rows: _Rows, cells: list[tuple[int, int, str]], kind: type[CommaNumber | DoubtfulNumber]) -> None:
    """Put numbers of a kind in the place of texts."""
    for number, place, text in cells:
        rows[number][place] = kind(text)


def _first_foreign(rows: _Rows) -> tuple[int, int] | None:
    """Return where the first text stands that not every encoding shows alike."""
    return next(((number, place) for number, place, text in _texts(rows) if not text.isascii()), None)
