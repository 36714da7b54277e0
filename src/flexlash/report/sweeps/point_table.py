"""The table of a sweep over one dimension: a row for each value."""

from __future__ import annotations

from re import split
from typing import Any

from flexlash.decisions.sweep import Study
from flexlash.report.layout.result_formats import usual_format
from flexlash.report.layout.styles import Book
from flexlash.report.layout.wrapping import LINE_HEIGHT, lines_of, merged_width
from flexlash.report.wording.sweep_words import swept_title
from flexlash.report.wording.verdict import COLOURS, verdict_word
from flexlash.schema.limit_verdict import VerdictBounds
from flexlash.schema.result_columns import RESULTS

__all__ = ["LAST_COLUMN", "SHARE", "STRESS", "VALUE_WIDTH", "WIDTH", "write_points"]

VALUE_WIDTH, WIDTH = 24.0, 10.5
_COLUMNS = (
    ("backlash_arcmin", "Nominal [{angle}]"),
    ("p2_5_arcmin", "P2.5 [{angle}]"),
    ("p50_arcmin", "P50 [{angle}]"),
    ("p97_5_arcmin", "P97.5 [{angle}]"),
    ("p99_865_arcmin", "P99.865 [{angle}]"),
    ("probability_over_limit", "Over limit"),
    ("disk_share", "Disk share"),
    ("von_mises_MPa", "Von Mises [MPa]"),
)
"""What the table shows of Results."""

_FORMATS = {"probability_over_limit": "0.0000%"} | {key: "angle" for key, _ in _COLUMNS if key.endswith("_arcmin")}
"""Number formats that are not the usual ones; all are alike in all rows, so that numbers can be compared."""

_TOLD = "W423"
"""What the colour of the share over the limit says already."""

_KEYS = [key for key, _ in _COLUMNS]
_OVER = _KEYS.index("probability_over_limit") + 1
SHARE, STRESS = (_KEYS.index(key) + 1 for key in ("disk_share", "von_mises_MPa"))
_FINDINGS = len(_COLUMNS) + 1
LAST_COLUMN = _FINDINGS + 4
"""Column, from 0, at which findings end, which are as wide as several columns."""


def write_points(book: Book, sheet: Any, top: int, study: Study, bounds: VerdictBounds) -> int:
    """Write headings and points from a row on; return the row below them. The value as entered is bold."""
    header = book.format("header")
    sheet.write_row(top, 0, [swept_title(study.first.key), *book.headings(*(label for _, label in _COLUMNS))], header)
    sheet.merge_range(top, _FINDINGS, top, LAST_COLUMN, "Findings", header)
    sheet.set_row(top, 32)
    columns = {column.key: column for column in RESULTS}
    codes = {key: _FORMATS.get(key) or usual_format(columns[key]) for key in _KEYS}
    entered = study.entered.get(study.first.key)
    wide = merged_width([WIDTH] * (LAST_COLUMN - _FINDINGS + 1))
    for place, record in enumerate(study.results.iter_rows(named=True)):
        row = top + 1 + place
        value = record[study.first.key]
        sheet.write_number(row, 0, value, book.format("label" if value == entered else "text", "general"))
        for column, key in enumerate(_KEYS, start=1):
            if record[key] is not None:
                look = COLOURS[verdict_word(record, bounds)] if column == _OVER else "text"
                book.write_figure(sheet, row, column, record[key], codes[key], look=look)
        if findings := _findings(record["findings"]):
            sheet.merge_range(row, _FINDINGS, row, LAST_COLUMN, findings, book.format("indented wrap"))
            sheet.set_row(row, LINE_HEIGHT * lines_of(findings, wide))
    return top + 1 + study.results.height


def _findings(words: str | None) -> str:
    """Return what is found at a point, less what the row shows already."""
    return " ".join(one for one in split(r" (?=[EW]\d{3} )", words or "") if not one.startswith(_TOLD))
