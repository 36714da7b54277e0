"""The Results sheet: every number of every variant, labels above keys, filtered and frozen."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flexlash.columns import Column
from flexlash.report.styles import PALETTE, Book, decimals_of, percent_of
from flexlash.result_columns import RESULTS, result_columns

if TYPE_CHECKING:
    import polars as pl

__all__ = ["FIRST_ROW", "column_place", "write_results"]

FIRST_ROW = 2
_PLACES = {column.key: place for place, column in enumerate(RESULTS)}
_UNITS = {"rad": "rad", "arcmin": "arcmin", "arcsec": "arcsec", "MPa": "stress", "ppm": "count"}


def column_place(key: str) -> int:
    """Return the place of a Results column, from 0."""
    return _PLACES[key]


def _number_format(column: Column) -> str:
    if column.key.startswith("stiffness"):
        return "stiffness"
    if "share" in column.key or "probability" in column.key:
        return "share"
    return _UNITS.get(column.unit, "plain")


def write_results(book: Book, results: pl.DataFrame) -> None:
    """Write the Results sheet."""
    sheet = book.sheet("Results")
    columns = [column for column in result_columns(cross_check=True, elasticity=True) if column.key in results.columns]
    last = FIRST_ROW + results.height - 1
    for place, column in enumerate(columns):
        number = _number_format(column) if column.is_number else ""
        sheet.set_column(place, place, _width(column), book.format("text", number))
        sheet.write_string(0, place, column.label, book.format("header"))
        sheet.write_comment(0, place, column.help)
        sheet.write_string(1, place, column.key, book.format("key"))
        style = book.format("text", number)
        values = results[column.key].to_list()
        styles = _styles_by_error(book, results, column) or [style] * len(values)
        for row, value in enumerate(values, start=FIRST_ROW):
            if isinstance(value, str):
                sheet.write_string(row, place, value, style)
            elif value is not None:
                sheet.write_number(row, place, value, styles[row - FIRST_ROW])
    sheet.set_row(0, 48)
    sheet.set_row(1, 32)
    sheet.freeze_panes(FIRST_ROW, 1)
    sheet.autofilter(1, 0, last, len(columns) - 1)
    sheet.repeat_rows(0, 1)
    sheet.repeat_columns(0)
    sheet.fit_to_pages(4, 0)
    for status in ("error", "warning", "ok"):
        place = column_place("status")
        rule = {"type": "cell", "criteria": "==", "value": f'"{status}"', "format": book.format(status)}
        sheet.conditional_format(FIRST_ROW, place, last, place, rule)
    place = column_place("probability_over_limit")
    bar = {"type": "data_bar", "bar_color": PALETTE["orange"], "min_type": "num", "max_type": "num"}
    sheet.conditional_format(FIRST_ROW, place, last, place, bar | {"min_value": 0, "max_value": 1})


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


def _width(column: Column) -> float:
    return {"variant": 24.0, "main_contributor": 20.0, "findings": 40.0}.get(column.key, 16.0)
