"""The Results sheet: every number of every variant, labels above keys, filtered and frozen."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from flexlash.columns import Column
from flexlash.outcome import Outcome
from flexlash.report.links import FIRST_ROW, finding_rows, name_cell, result_rows, write_link
from flexlash.report.raw_cells import write_raw
from flexlash.report.styles import PALETTE, Book, decimals_of, percent_of
from flexlash.result_columns import RESULTS, result_columns

if TYPE_CHECKING:
    import polars as pl

__all__ = [
    "AS_SUBMITTED",
    "ERROR_DIGITS",
    "FIRST_ROW",
    "SHARE_DECIMALS",
    "column_place",
    "stored_values",
    "write_results",
]

AS_SUBMITTED = "as submitted"
"""What stands in the place of the key above a column that the submission has and flexlash does not use."""

ERROR_DIGITS = 4
"""Digits of a standard error that the workbook holds; an estimate of an error has two or three."""

SHARE_DECIMALS = 4
"""Decimals of an estimated share that the workbook holds, as many as it shows; it is good to the third."""

_ESTIMATED_SHARES = frozenset({"main_contributor_share", "interaction_share"})
_PLACES = {column.key: place for place, column in enumerate(RESULTS)}
_UNITS = {"rad": "rad", "arcmin": "arcmin", "arcsec": "arcsec", "MPa": "stress", "ppm": "count"}
_DETAILS = ("_low", "_high", "_shear_radius_mm", "_range", "_points")
"""Ends of keys whose columns can be folded away, beside standard errors, radians, seconds and plain draws."""

_BARS = {"probability_over_limit": "orange", "disk_share": "sky", "main_contributor_share": "sky"}
_WIDTHS = {"variant": 24.0, "main_contributor": 20.0, "findings": 40.0, "notes": 30.0, "spread_note": 30.0}


def column_place(key: str) -> int:
    """Return the place of a Results column, from 0."""
    return _PLACES[key]


def _number_format(column: Column) -> str:
    if column.key.startswith("stiffness"):
        return "stiffness"
    if "share" in column.key or "probability" in column.key:
        return "share"
    return _UNITS.get(column.unit, "plain")


def _is_detail(column: Column) -> bool:
    """Whether a column can be folded away without loss to who only reads the result."""
    key = column.key
    if key.startswith(("coverage", "worst_case")) and "standard_error" not in key:
        return False
    return "standard_error" in key or key.startswith("random_") or key.endswith(("_rad", "_arcsec", *_DETAILS))


def write_results(book: Book, outcome: Outcome) -> None:
    """Write the Results sheet; columns of the submission that flexlash does not use stand at its right end."""
    sheet = book.sheet("Results")
    results = outcome.results
    columns = [column for column in result_columns(cross_check=True, elasticity=True) if column.key in results.columns]
    for place, column in enumerate(columns):
        number = _number_format(column) if column.is_number else ""
        options = {"level": 1} if _is_detail(column) else {}
        sheet.set_column(place, place, _WIDTHS.get(column.key, 16.0), book.format("text", number), options)
        _write_heading(book, sheet, place, (column.label, column.key, column.help))
    _write_cells(book, sheet, results, columns)
    _write_links(book, sheet, outcome, columns)
    right = _write_passed(book, sheet, outcome, len(columns))
    last = FIRST_ROW + max(results.height, 1) - 1
    sheet.set_row(0, 48)
    sheet.set_row(1, 32)
    sheet.freeze_panes(FIRST_ROW, 1)
    sheet.autofilter(1, 0, last, right - 1)
    sheet.repeat_rows(0, 1)
    sheet.repeat_columns(0)
    sheet.fit_to_pages(4, 0)
    _write_conditions(book, sheet, columns, last)


def _write_heading(book: Book, sheet: Any, place: int, texts: tuple[str, str, str]) -> None:
    """Write label and key of a column and say in a comment what it holds."""
    label, key, text = texts
    sheet.write_string(0, place, label, book.format("header"))
    sheet.write_comment(0, place, text)
    sheet.write_string(1, place, key, book.format("key"))


def _write_cells(book: Book, sheet: Any, results: pl.DataFrame, columns: Sequence[Column]) -> None:
    """Write the table row by row, in which order XlsxWriter is quickest."""
    lists = [stored_values(results, column) for column in columns]
    styles = [_styles(book, results, column) for column in columns]
    write_number, write_string = sheet.write_number, sheet.write_string
    for row, (values, formats) in enumerate(
        zip(zip(*lists, strict=True), zip(*styles, strict=True), strict=True), start=FIRST_ROW
    ):
        for place, value in enumerate(values):
            if value is None:
                continue
            if isinstance(value, str):
                write_string(row, place, value, formats[place])
            else:
                write_number(row, place, value, formats[place])


def stored_values(results: pl.DataFrame, column: Column) -> list[Any]:
    """Return the numbers of a column as the workbook holds them: errors and estimated shares rounded."""
    values = results[column.key].to_list()
    if "standard_error" in column.key:
        return [None if one is None else float(f"{one:.{ERROR_DIGITS}g}") for one in values]
    if column.key in _ESTIMATED_SHARES:
        return [None if one is None else round(one, SHARE_DECIMALS) for one in values]
    return values


def _styles(book: Book, results: pl.DataFrame, column: Column) -> list[Any]:
    """Return a format for each cell of a column, its digits limited by the number's standard error if it has one."""
    usual = book.format("text", _number_format(column) if column.is_number else "")
    return _styles_by_error(book, results, column) or [usual] * results.height


def _styles_by_error(book: Book, results: pl.DataFrame, column: Column) -> list[Any]:
    """Return a format for each number of a column whose digits its standard error limits; none for other columns."""
    stem, _, unit = column.key.rpartition("_")
    if column.key.startswith(("probability", "ppm")):
        stem = column.key.removesuffix("_low").removesuffix("_high")
        ends = zip(results[f"{stem}_low"].to_list(), results[f"{stem}_high"].to_list(), strict=True)
        halves = [None if low is None else (high - low) / 2 for low, high in ends]
        if column.key.startswith("ppm"):
            return [book.format("text", decimals_of(half, "count")) for half in halves]
        return [book.format("text", percent_of(half)) for half in halves]
    error = next(
        (key for key in (f"{stem}_standard_error_{unit}", f"{column.key}_standard_error") if key in results), ""
    )
    if not error:
        return []
    return [book.format("text", decimals_of(one, "arcmin" if unit else "plain")) for one in results[error].to_list()]


def _write_links(book: Book, sheet: Any, outcome: Outcome, columns: Sequence[Column]) -> None:
    """Lead from each variant to its row of the submission, and from its findings to the first of them."""
    style, letters = book.format("link"), name_cell(outcome)
    findings = finding_rows(outcome)
    place = [column.key for column in columns].index("findings")
    rows = result_rows(outcome)
    texts = outcome.results.select("variant", "findings").iter_rows()
    for (number, row), (name, listed) in zip(rows.items(), texts, strict=False):
        if name:
            write_link(sheet, row, 0, f"Submission!{letters}{number}", name, style=style)
        if listed and number in findings:
            write_link(sheet, row, place, f"Findings!A{findings[number] + 1}", listed, style=style)


def _write_passed(book: Book, sheet: Any, outcome: Outcome, place: int) -> int:
    """Write the columns of the submission that flexlash does not use; return the place after the last."""
    table = outcome.validated.table if outcome.validated else None
    rows = result_rows(outcome)
    for column, header in sorted(table.heading.extra.items()) if table is not None else ():
        sheet.set_column(place, place, 16.0)
        text = f"Column {header} of the submission as read; nothing is computed from it."
        _write_heading(book, sheet, place, (header, AS_SUBMITTED, text))
        for number, row in rows.items():
            value = table.cells[number].get(column) if table is not None else None
            if value is not None:
                write_raw(book, sheet, (row, place), value)
        place += 1
    return place


def _write_conditions(book: Book, sheet: Any, columns: Sequence[Column], last: int) -> None:
    """Colour the status and draw shares as bars from 0 to 1."""
    keys = [column.key for column in columns]
    place = keys.index("status")
    for status in ("error", "warning", "ok"):
        rule = {"type": "cell", "criteria": "==", "value": f'"{status}"', "format": book.format(status)}
        sheet.conditional_format(FIRST_ROW, place, last, place, rule)
    ends = {"min_type": "num", "max_type": "num", "min_value": 0, "max_value": 1}
    for key, colour in _BARS.items():
        place = keys.index(key)
        bar = {"type": "data_bar", "bar_color": PALETTE[colour], **ends}
        sheet.conditional_format(FIRST_ROW, place, last, place, bar)
