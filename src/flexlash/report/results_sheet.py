"""The Results sheet: every number of every variant, labels above keys, filtered and frozen."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import polars as pl

from flexlash.analysis.outcome import Outcome
from flexlash.report.extent import extent_of
from flexlash.report.failing.failing_places import variant_targets
from flexlash.report.layout.given_rows import GivenRows
from flexlash.report.layout.links import FIRST_ROW, finding_rows, first_result, result_rows, write_link
from flexlash.report.layout.paper import Listed, print_one_page
from flexlash.report.layout.raw_cells import write_raw
from flexlash.report.layout.result_formats import ESTIMATED_SHARES, number_formats, usual_format
from flexlash.report.layout.styles import PALETTE, Book
from flexlash.report.layout.wrapping import LINE_HEIGHT, lines_of
from flexlash.report.report_data import Drawn
from flexlash.report.wording.verdict import NO_VERDICT, UNSETTLED
from flexlash.schema.columns import Column
from flexlash.schema.result_columns import result_columns

__all__ = [
    "AS_SUBMITTED",
    "ERROR_DIGITS",
    "FIRST_ROW",
    "SHARE_DECIMALS",
    "stored_values",
    "write_results",
]

AS_SUBMITTED = "as submitted"
"""What stands in the place of the key above a column that the submission has and flexlash does not use."""

ERROR_DIGITS = 4
"""Digits of a standard error that the workbook holds; an estimate of an error has two or three."""

SHARE_DECIMALS = 4
"""Decimals of an estimated share that the workbook holds, as many as it shows; it is good to the third."""

_FIRST = (
    "variant",
    "verdict",
    "backlash_arcmin",
    "p97_5_arcmin",
    "p99_865_arcmin",
    "backlash_limit_arcmin",
    "ppm_over_limit",
    "sd_arcmin",
    "main_contributor",
    "main_contributor_share",
    "von_mises_MPa",
    "status",
)
_LAST = ("notes", "findings")
"""Columns that stand before and behind all others, which are folded away."""

_VERDICT = Column(
    sheet="Results",
    key="verdict",
    label="Verdict",
    help="By the share of units over the limit; About has the rule. A ? says that more samples may turn it.",
    type="text",
    role="result",
)
"""A column of the sheet alone: files of Results leave the rule to who reads them."""

_BARS = {"probability_over_limit": "orange", "disk_share": "sky", "main_contributor_share": "sky"}
_NUMBER, _WORDS, _PASSED = 11.0, 14.0, 16.0
_WIDTHS = {"status": 11.0, "main_contributor": 20.0, "first_order_valid": 11.0}
_NAMES = (16, 60)
_TEXTS = (16, 90)
"""Least and greatest width of the variants' names, and of columns whose longer texts are wrapped."""

_WRAPPED = ("spread_note", "notes", "findings")

_KEY_HEIGHT = 3 * LINE_HEIGHT
_REMARKS = {
    "main_contributor": "Named by its key in the template's sheet Tolerances; About lists the keys in words.",
    "probability_over_limit_sample_low": "Blank where nothing was measured; About says how it is found.",
    "p99_865_sample_low_arcmin": "Blank where nothing was measured; About says how it is found.",
}
"""What the comments of some columns say besides."""


def write_results(book: Book, outcome: Outcome, drawn: Sequence[Drawn]) -> None:
    """Write the Results sheet; columns of the submission that flexlash does not use stand at its right end."""
    results, first, extent = _with_verdicts(outcome), first_result(outcome), extent_of(outcome)
    sheet = book.sheet("Results", kind=GivenRows) if extent.large else book.sheet("Results")
    labels = first - FIRST_ROW
    if labels:
        sheet.write_string(0, 0, extent.note, book.format("quiet"))
    columns = _in_order(results)
    widths = [_width(results, column) for column in columns]
    folded = range(len(_FIRST), len(columns) - len(_LAST))
    for index, (column, width) in enumerate(zip(columns, widths, strict=True)):
        options = {"level": 1, "hidden": True} if index in folded else {"collapsed": index == folded.stop}
        number = usual_format(column) if column.is_number else ""
        sheet.set_column(index, index, width, book.format("text", number), options)
        text = f"{column.help} {_REMARKS.get(column.key, '')}".strip()
        _write_heading(book, sheet, (labels, index), (column.label, column.key, text))
    _write_cells(book, sheet, results, columns, first)
    _write_links(book, sheet, outcome, columns, drawn)
    own = _write_passed(book, sheet, outcome, len(columns))
    last = first + max(results.height, 1) - 1
    lines = max(lines_of(column.label, width) for column, width in zip(columns, widths, strict=True))
    sheet.set_row(labels, LINE_HEIGHT * lines)
    sheet.set_row(labels + 1, _KEY_HEIGHT)
    sheet.freeze_panes(first, 1)
    sheet.autofilter(labels + 1, 0, last, len(columns) + len(own) - 1)
    sheet.repeat_rows(labels, labels + 1)
    names = ["" if index in folded else _printed_name(results, column) for index, column in enumerate(columns)]
    seen = [0.0 if index in folded else width for index, width in enumerate(widths)]
    listed = Listed(noun="variants", first=first, columns=[*names, *own])
    print_one_page(sheet, [*seen, *[_PASSED] * len(own)], last, listed=listed)
    _write_conditions(book, sheet, columns, (first, last))


def _printed_name(results: pl.DataFrame, column: Column) -> str:
    """Return what the head of the page names a column, a blank for one that nobody misses."""
    return column.label if results[column.key].is_not_null().any() else ""


def _with_verdicts(outcome: Outcome) -> pl.DataFrame:
    """Return Results with the verdict on each variant in words."""
    bounds, words = outcome.settings.verdict_bounds, []
    for over, *ends in outcome.results.select(
        "probability_over_limit", "probability_over_limit_low", "probability_over_limit_high"
    ).iter_rows():
        verdict = bounds.verdict(over)
        words.append(f"{verdict}{UNSETTLED if bounds.straddled(*ends) else ''}" if verdict else NO_VERDICT)
    return outcome.results.with_columns(pl.Series(_VERDICT.key, words, dtype=pl.String))


def _in_order(results: pl.DataFrame) -> list[Column]:
    """Return the columns in the order in which a reader wants them; the others stand in that of the contract."""
    known = {column.key: column for column in (_VERDICT, *result_columns(cross_check=True, elasticity=True))}
    others = [key for key in known if key in results.columns and key not in {*_FIRST, *_LAST}]
    return [known[key] for key in (*_FIRST, *others, *_LAST)]


def _width(results: pl.DataFrame, column: Column) -> float:
    """Return the width of a column."""
    if column.key not in ("variant", *_WRAPPED):
        return _WIDTHS.get(column.key, _NUMBER if column.is_number else _WORDS)
    least, most = _TEXTS if column.key in _WRAPPED else _NAMES
    longest = results[column.key].str.len_chars().max()
    return float(min(max(int(str(longest or 0)) + 2, least), most))


def _write_heading(book: Book, sheet: Any, cell: tuple[int, int], texts: tuple[str, str, str]) -> None:
    """Write label and key of a column and say in a comment what it holds."""
    (row, index), (label, key, text) = cell, texts
    sheet.write_string(row, index, label, book.format("header"))
    sheet.write_comment(row, index, text)
    sheet.write_string(row + 1, index, key, book.format("key"))


def _write_cells(book: Book, sheet: Any, results: pl.DataFrame, columns: Sequence[Column], first: int) -> None:
    """Write the table: all rows of a large one at once, else row by row, in which order XlsxWriter is quickest."""
    lists = [stored_values(results, column) for column in columns]
    styles = [_styles(book, results, column) for column in columns]
    heights = _heights(results, first)
    if isinstance(sheet, GivenRows):
        sheet.give(first, list(zip(lists, styles, strict=True)), heights)
        return
    write_number, write_string = sheet.write_number, sheet.write_string
    for row, (values, formats) in enumerate(
        zip(zip(*lists, strict=True), zip(*styles, strict=True), strict=True), start=first
    ):
        if row in heights:
            sheet.set_row(row, heights[row])
        for index, value in enumerate(values):
            if value is None:
                continue
            if isinstance(value, str):
                write_string(row, index, value, formats[index])
            else:
                write_number(row, index, value, formats[index])


def _heights(results: pl.DataFrame, first: int) -> dict[int, float]:
    """Return the heights of rows with a text that is longer than its column is wide."""
    lines: dict[int, int] = {}
    for key in ("variant", *_WRAPPED):
        most = _TEXTS[1] if key in _WRAPPED else _NAMES[1]
        for row, text in enumerate(results[key].to_list()):
            if text is not None and len(text) > most - 2:
                lines[row] = max(lines.get(row, 1), lines_of(text, most - 1))
    return {first + row: LINE_HEIGHT * count for row, count in lines.items()}


def stored_values(results: pl.DataFrame, column: Column) -> list[Any]:
    """Return the numbers of a column as the workbook holds them: errors and estimated shares rounded."""
    values = results[column.key].to_list()
    if "standard_error" in column.key:
        return [None if value is None else float(f"{value:.{ERROR_DIGITS}g}") for value in values]
    if column.key in ESTIMATED_SHARES:
        return [None if value is None else round(value, SHARE_DECIMALS) for value in values]
    return values


def _styles(book: Book, results: pl.DataFrame, column: Column) -> list[Any]:
    """Return a format for each cell of a column."""
    if column.is_number:
        return number_formats(book, results, column)
    wraps = column.key in ("variant", *_WRAPPED)
    return [book.format("indented wrap" if wraps else "indented")] * results.height


def _write_links(book: Book, sheet: Any, outcome: Outcome, columns: Sequence[Column], drawn: Sequence[Drawn]) -> None:
    """Lead from each drawn variant to its page or to Explorer, and from its findings to the first of them."""
    style, targets = book.format("wrap link"), variant_targets(drawn, outcome.settings.verdict_bounds)
    findings = finding_rows(outcome)
    findings_index = [column.key for column in columns].index("findings")
    rows = result_rows(outcome)
    texts = outcome.results.select("variant", "findings").iter_rows()
    for (number, row), (name, listed) in zip(rows.items(), texts, strict=False):
        if name and number in targets:
            write_link(sheet, row, 0, targets[number], name, style=style)
        if listed and number in findings:
            write_link(sheet, row, findings_index, f"Findings!A{findings[number] + 1}", listed, style=style)


def _write_passed(book: Book, sheet: Any, outcome: Outcome, first: int) -> list[str]:
    """Write the columns of the submission that flexlash does not use from a column on; return their headers."""
    table = outcome.validated.table if outcome.validated else None
    rows = result_rows(outcome)
    own = sorted(table.heading.extra.items()) if table is not None else []
    for index, (column, header) in enumerate(own, start=first):
        sheet.set_column(index, index, _PASSED)
        text = f"Column {header} of the submission as read; nothing is computed from it."
        _write_heading(book, sheet, (first_result(outcome) - FIRST_ROW, index), (header, AS_SUBMITTED, text))
        for number, row in rows.items():
            value = table.cells[number].get(column) if table is not None else None
            if value is not None:
                write_raw(book, sheet, (row, index), value)
    return [header for _, header in own]


def _write_conditions(book: Book, sheet: Any, columns: Sequence[Column], rows: tuple[int, int]) -> None:
    """Colour the status and draw shares as bars from 0 to 1, from the first of these rows to the last."""
    first, last = rows
    keys = [column.key for column in columns]
    for verdict, look in (("fails", "error"), ("marginal", "warning"), ("meets", "ok")):
        rule = {"type": "text", "criteria": "begins with", "value": verdict, "format": book.format(look)}
        sheet.conditional_format(first, 1, last, 1, rule)
    index = keys.index("status")
    for status in ("error", "warning", "ok"):
        rule = {"type": "cell", "criteria": "==", "value": f'"{status}"', "format": book.format(status)}
        sheet.conditional_format(first, index, last, index, rule)
    ends = {"min_type": "num", "max_type": "num", "min_value": 0, "max_value": 1}
    for key, colour in _BARS.items():
        index = keys.index(key)
        bar = {"type": "data_bar", "bar_color": PALETTE[colour], **ends}
        sheet.conditional_format(first, index, last, index, bar)
