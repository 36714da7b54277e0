"""The Drive sheet: wind-up and other sources of one picked variant in formulas, by every rule; then all variants."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flexlash.analysis.drive_budget import WINDUP, budget_of
from flexlash.analysis.outcome import Outcome
from flexlash.report.drive.catalogue_block import write_catalogue
from flexlash.report.drive.combinations import write_combinations
from flexlash.report.drive.drive_page import BESIDE, COLUMNS, LETTERS, SHEET, DrivePage
from flexlash.report.drive.sources_table import Chain, write_sources
from flexlash.report.drive.stored_drives import drive_ratio, stored_drives
from flexlash.report.extent import extent_of
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.paper import Listed, print_one_page
from flexlash.report.layout.styles import GRID, OUTLINE, PALETTE, Book, literal
from flexlash.report.report_data import Drawn
from flexlash.report.wording.drive_sentences import drives_over_limit
from flexlash.report.wording.labels import distinct_labels
from flexlash.schema.findings import shown

__all__ = ["DRIVE_NOTES", "write_drive"]

DRIVE_NOTES = (
    "Average: mean of the wind-up's spread, and of each source the middle between its deviations; the value of a "
    "random source takes no part. T: three standard deviations of the wind-up, of a source half the width of its "
    "deviations.",
    "c = 3σ/T: 1 where limits lie at three standard deviations, 3/k at k of them, √1.5 triangular, √3 uniform; the "
    "worst case has none. η: the part of T by which means may lie off (Settings: mean_shift_factor).",
    "Normal units can lie beyond the worst case; where few uniform sources count, √Σ (c T)² exceeds Σ T.",
    "Monte Carlo: the engine of the wind-up with every play as a further input, independent of all others. Verdicts, "
    "counts and --fail-over-limit judge the backlash limit of the flexspline alone, not the system limit.",
)
_PINNED = 3
"""Rows that stay in sight."""

_NAME = 22
_COLOURS = ("blue", "orange", "green", "sky", "red", "ink", "grey", "pale")
_ALL = (
    ("system_mean_arcmin", "Average [{angle}]"),
    ("system_rss_high_arcmin", "RSS [{angle}]"),
    ("system_bender_high_arcmin", "Bender [{angle}]"),
    ("system_mean_shift_high_arcmin", "Mean shift [{angle}]"),
    ("system_worst_case_high_arcmin", "Worst case [{angle}]"),
    ("system_p99_865_arcmin", "P99.865 [{angle}]"),
    ("system_p99_865_standard_error_arcmin", "Its standard error"),
    ("system_limit_arcmin", "System limit [{angle}]"),
)
_CHART, _CHART_ROWS = (460, 330), 13
"""Size of a chart [px], and the rows that it takes beside a table with high headings."""


def write_drive(book: Book, outcome: Outcome, drawn: Sequence[Drawn]) -> Stored | None:
    """Write the sheet, and return the sheet of numbers behind it; nothing where no budget is to be had."""
    validated = outcome.validated
    budget = None if validated is None else budget_of(validated, outcome.settings)
    if validated is None or budget is None or not drawn:
        return None
    sources = validated.other_sources
    page = DrivePage(book, stored_drives(drawn, sources, book.angles), budget.shift)
    sheet = page.sheet
    sheet.write_string(0, 0, "The whole drive: wind-up and other sources of backlash", book.format("title"))
    sheet.set_row(0, 28)
    chain = write_sources(page, list(zip(sources, budget.plays, strict=True)))
    top = chain.last_row + 3
    below = page.notes(write_combinations(page, top, chain), *DRIVE_NOTES)
    text = "What wind-up and each source have of the average, the variance and the worst case, as stacked bars; "
    text += (
        f"wind-up beside {len(sources)} sources: {', '.join(shown(source.name, longest=30) for source in sources[:8])}"
    )
    shares = _contributions(book, chain, [WINDUP, *(source.name for source in sources)])
    book.insert(sheet, top, BESIDE, shares, size=_CHART, text=text)
    end = max(below, top + _CHART_ROWS)
    after = write_catalogue(page, end + 1, drive_ratio(sources))
    last = _write_all(page, after + 1, drawn, extent_of(outcome).note)
    sheet.freeze_panes(_PINNED, 1)
    print_one_page(sheet, [width for _, width in COLUMNS], last, ends=[end, after], listed=Listed(noun="parts"))
    return page.stored


def _contributions(book: Book, chain: Chain, names: Sequence[str]) -> Any:
    """Return the shares of the wind-up and of every source as stacked bars."""
    chart = book.chart("bar", "Contributions to the whole drive", subtype="percent_stacked")
    for place, (name, row) in enumerate(zip(names, range(chain.first_row, chain.last_row + 1), strict=True)):
        chart.add_series({
            "name": literal(shown(name, longest=_NAME)),
            "categories": [SHEET, *chain.series(chain.first_row - 1)],
            "values": [SHEET, *chain.series(row)],
            "fill": {"color": PALETTE[_COLOURS[place % len(_COLOURS)]]},
            "border": OUTLINE,
            "gap": 50,
        })  # fmt: skip
    chart.set_x_axis({"num_format": "0%", "major_gridlines": GRID, "num_font": LETTERS})
    chart.set_y_axis({"reverse": True, "num_font": LETTERS})
    chart.set_legend({"position": "bottom", "font": LETTERS})
    return chart


def _write_all(page: DrivePage, top: int, drawn: Sequence[Drawn], note: str) -> int:
    """Write the rules of all drawn variants, worst first, from row `top` on; return the last row."""
    book, sheet = page.book, page.sheet
    page.section(top, "All variants, by the program")
    top = page.notes(top + 1, note) - 1 if note else top
    headings = book.headings(
        "Variant",
        *(heading for _, heading in _ALL),
        "P99.865 below limit by [{angle}]",
        "Drives over the limit",
    )
    sheet.write_row(top + 1, 0, headings, book.format("header"))
    sheet.set_row(top + 1, 64)
    labels = distinct_labels([variant.row["variant"] for variant in drawn], _NAME)
    row, plain = top + 1, book.angles.decimals(3)
    for row, (variant, label) in enumerate(zip(drawn, labels, strict=True), start=top + 2):
        sheet.write_string(row, 0, label, book.format("text"))
        numbers = variant.row
        for column, (key, _) in enumerate(_ALL, start=1):
            if numbers[key] is not None:
                look = "0.0E+00" if "standard_error" in key else plain
                sheet.write_number(row, column, book.angles.of(numbers[key]), book.format("text", look))
        limit, high = numbers["system_limit_arcmin"], numbers["system_p99_865_arcmin"]
        if limit is not None:
            sheet.write_number(row, len(_ALL) + 1, book.angles.of(limit - high), book.format("text", plain))
            sheet.write_string(row, len(_ALL) + 2, drives_over_limit(numbers), book.format("indented"))
    return row
