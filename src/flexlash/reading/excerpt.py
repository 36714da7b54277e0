"""Rows of a surveyed table → bytes that stand for them alone, and back: a submission with these rows at their places.

An excerpt holds the head of its table, the rows, and what only the whole table shows, so that every judgement of a row
is that of the whole table. Nothing in it can be executed.
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
import os
import zlib
from bisect import bisect_right
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, replace
from functools import lru_cache
from itertools import groupby
from pathlib import Path
from typing import Any

from flexlash.reading.cells_json import cells_from_json, cells_to_json, dialect_of
from flexlash.reading.decimal_signs import mark
from flexlash.reading.delimited import mark_errors, records_of
from flexlash.reading.gate import EXCERPT, opened_file
from flexlash.reading.raw import CommaNumber, DoubtfulNumber, RawSheet, RawValue, Submission
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.survey import CHANGED, RowBlock, Survey, TextFacts
from flexlash.reading.whole_table import DoubledNames, WholeTable
from flexlash.reading.xlsx import Cells
from flexlash.schema.cell_addresses import CellAddress, cell_ranges

__all__ = ["excerpt", "is_excerpt", "submission_of_excerpt"]

_LENGTH = 8
"""Bytes that tell how long the facts are, which stand before the rows of a Parquet file."""

_LEVEL = 1
_SHEET = "Variants"
_MARKS: dict[str, type[CommaNumber | DoubtfulNumber]] = {"comma": CommaNumber, "doubtful": DoubtfulNumber}
_MARK_NAMES = {kind: name for name, kind in _MARKS.items()}


def excerpt(path: Path, survey: Survey, rows: range | Sequence[int]) -> bytes:
    """Return the rows of a surveyed table with these numbers, together with its head and the facts of all its rows.

    To be asked of the limited process, within `limits_of_survey`. The same bytes for the same rows. Raises OSError when
    the file cannot be opened, Refusal when what is read of it is not what was surveyed.
    """
    wanted = sorted({row for row in rows if survey.first <= row <= survey.last})
    facts: dict[str, Any] = {
        "name": survey.name,
        "kind": survey.kind,
        "sha256": survey.sha256,
        "spans": [*_spans(wanted)],
        "whole": _whole_to_json(survey, wanted),
    }
    content = b""
    with opened_file(path) as file:
        if os.fstat(file.fileno()).st_size != survey.size:
            raise Refusal("E101", found=CHANGED)
        if survey.text:
            facts["text"] = _text_to_json(survey.text)
            pieces = []
            for block in _blocks(survey.blocks, wanted):
                file.seek(block.start)
                data = file.read(block.size)
                if hashlib.blake2b(data, digest_size=len(block.digest)).digest() != block.digest:
                    raise Refusal("E101", found=CHANGED)
                text = data.decode(survey.text.form.codec)
                pieces.append((block.first, text.replace("\r\n", "\n").replace("\r", "\n")))
            facts["pieces"] = pieces
        elif wanted:
            from flexlash.reading.survey_parquet import rows_of

            content = rows_of(path, file, survey, wanted)
    facts["head"] = cells_to_json(
        Cells(sheets=[RawSheet(name=_SHEET, rows={row: dict(cells) for row, cells in survey.head.items()})])
    )
    written = zlib.compress(json.dumps(facts, ensure_ascii=False, separators=(",", ":")).encode(), _LEVEL)
    return EXCERPT + len(written).to_bytes(_LENGTH, "little") + written + content


def _blocks(blocks: Sequence[RowBlock], wanted: Sequence[int]) -> list[RowBlock]:
    """Return the blocks in which rows stand."""
    firsts = _firsts(tuple(blocks))
    return [blocks[number] for number in dict.fromkeys(bisect_right(firsts, row) - 1 for row in wanted)]


@lru_cache(maxsize=2)
def _firsts(blocks: tuple[RowBlock, ...]) -> list[int]:
    return [block.first for block in blocks]


def _spans(rows: Iterable[int]) -> Iterator[tuple[int, int]]:
    """Yield the ends of each run of rows."""
    for _, run in groupby(enumerate(rows), key=lambda pair: pair[1] - pair[0]):
        numbers = [row for _, row in run]
        yield numbers[0], numbers[-1]


def _whole_to_json(survey: Survey, wanted: Sequence[int]) -> dict[str, Any]:
    """Return the facts of the whole table, and of these rows in it, as JSON holds them."""
    whole = asdict(replace(survey.whole, above=_above(survey, wanted), partners=_partners(survey.doubles, wanted)))
    return {
        key: sorted(value) if isinstance(value, frozenset) else [*value.items()] if isinstance(value, dict) else value
        for key, value in whole.items()
    }


def _whole_from_json(written: Mapping[str, Any]) -> WholeTable:
    """Return the facts that `_whole_to_json` has written."""
    known = {key: dict(value) if key in _MAPPINGS else value for key, value in written.items()}
    return WholeTable(**known | {"filled": frozenset(known["filled"]), "classes": tuple(known["classes"])})


_MAPPINGS = frozenset({"nameless", "digits", "named", "own", "above", "partners"})


def _above(survey: Survey, wanted: Sequence[int]) -> dict[int, int]:
    """Return the last entry before each row where that is not the next row above."""
    import numpy as np

    if not wanted:
        return {}
    bits = np.unpackbits(np.frombuffer(survey.entries, dtype=np.uint8, count=wanted[-1] // 8 + 1))
    rows = np.array(wanted)
    strange = rows[bits[rows - 1] == 0]
    if not len(strange):
        return {}
    entries = np.flatnonzero(bits)
    places = np.searchsorted(entries, strange) - 1
    return {int(row): int(entries[place]) if place >= 0 else 0 for row, place in zip(strange, places, strict=True)}


def _partners(doubles: DoubledNames, wanted: Sequence[int]) -> dict[int, str]:
    """Return the other cells of the same name for those rows whose name is used more than once."""
    import numpy as np

    if not doubles.rows:
        return {}
    places = np.flatnonzero(np.isin(np.frombuffer(doubles.rows, dtype=np.int64), np.array(wanted, dtype=np.int64)))
    names = np.searchsorted(np.frombuffer(doubles.starts, dtype=np.int64), places, side="right") - 1
    partners = {}
    for place, name in zip(places.tolist(), names.tolist(), strict=True):
        row = doubles.rows[place]
        same = doubles.rows[doubles.starts[name] : doubles.starts[name + 1]]
        partners[row] = doubles.ranges.get(name) or cell_ranges(
            CellAddress(other, doubles.column) for other in same if other != row
        )
    return partners


def _text_to_json(text: TextFacts) -> dict[str, Any]:
    """Return how a text is read, as JSON holds it."""
    return {
        "dialect": asdict(replace(text.dialect, longer=frozenset())) | {"longer": []},
        "marks": {kind: _MARK_NAMES[as_what] for kind, as_what in text.marks.items()},
        "others": sorted(text.others),
        "header_width": text.header_width,
    }


def is_excerpt(data: bytes) -> bool:
    """Whether bytes are those of an excerpt."""
    return data.startswith(EXCERPT)


def submission_of_excerpt(data: bytes, limits: ReadingLimits) -> Submission:
    """Return the submission whose Variants holds the rows of an excerpt, each at its own address.

    Name, digest and kind are those of the whole file. Raises Refusal where a limit is exceeded.
    """
    start = len(EXCERPT) + _LENGTH
    end = start + int.from_bytes(data[len(EXCERPT) : start], "little")
    facts = json.loads(zlib.decompress(data[start:end]))
    (head,) = cells_from_json(facts["head"]).sheets
    whole = _whole_from_json(facts["whole"])
    if facts["kind"] == "csv":
        sheet = _text_sheet(facts, head, limits)
    else:
        from flexlash.reading.survey_parquet import cells_of

        wanted = [row for first, last in facts["spans"] for row in range(first, last + 1)]
        sheet = replace(head, rows=head.rows | (cells_of(data[end:], wanted, limits) if wanted else {}))
    return Submission(
        name=facts["name"],
        sha256=facts["sha256"],
        kind=facts["kind"],
        sheets={sheet.name: replace(sheet, whole=whole)},
    )


def _text_sheet(facts: Mapping[str, Any], head: RawSheet, limits: ReadingLimits) -> RawSheet:
    """Return the rows of a delimited text below its head."""
    text = facts["text"]
    dialect = dialect_of(text["dialect"])
    wanted = {row for first, last in facts["spans"] for row in range(first, last + 1)}
    rows: dict[int, dict[int, RawValue]] = {}
    longer = set()
    for first, piece in facts["pieces"]:
        try:
            records = records_of(io.StringIO(piece, newline="\n"), dialect.delimiter, limits)
            for row, values in enumerate(records, start=first):
                if row not in wanted:
                    continue
                if cells := _cells(values):
                    rows[row] = cells
                    if text["header_width"] and len(values) > text["header_width"]:
                        longer.add(row)
        except csv.Error as fault:
            raise Refusal("E102") from fault
    rows = head.rows | rows
    mark_errors(rows)
    mark(rows, frozenset(text["others"]), {kind: _MARKS[name] for kind, name in text["marks"].items()})
    return replace(head, rows=rows, numbers_are_texts=True, dialect=replace(dialect, longer=frozenset(longer)))


def _cells(values: Collection[str]) -> dict[int, RawValue]:
    """Return the cells of a record that are not blank."""
    return {column: text for column, text in enumerate(values, start=1) if text and not text.isspace()}
