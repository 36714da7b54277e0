"""The sheet Failing variants: one printed page for each of the worst variants that miss their limit."""

from __future__ import annotations

from collections.abc import Sequence

from flexlash.analysis.outcome import Outcome
from flexlash.report.failing.failing_page import COLUMN_WIDTHS, PAGE_SCALE, FailingPage
from flexlash.report.failing.failing_places import FAILING, PAGE_ROWS, failing_variants
from flexlash.report.failing.stored_pages import stored_pages
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.styles import Book
from flexlash.report.report_data import ReportData
from flexlash.report.wording.labels import distinct_labels
from flexlash.report.wording.summary_facts import summary_facts

__all__ = ["write_failing"]

_NAME = 46
"""Characters of a name in the heading of a page."""


def write_failing(book: Book, outcome: Outcome, data: ReportData) -> Stored | None:
    """Write the sheet and return the sheet of numbers behind it; nothing where no variant misses its limit."""
    variants = failing_variants(data.drawn, outcome.settings.verdict_bounds)
    if not variants:
        return None
    sheet = book.sheet(FAILING, landscape=False)
    for column, pixels in enumerate(COLUMN_WIDTHS):
        sheet.set_column_pixels(column, column, pixels)
    facts, pages = summary_facts(outcome, data.levers), stored_pages(variants, book.angles)
    labels: Sequence[str] = distinct_labels([variant.row["variant"] for variant in variants], _NAME)
    for place, (variant, label) in enumerate(zip(variants, labels, strict=True)):
        page = FailingPage(book, sheet, facts, variant=variant, pages=pages, place=place)
        page.write(label, len(variants))
    # A sheet that is fitted to pages knows no breaks of its own.
    sheet.set_print_scale(PAGE_SCALE)
    sheet.set_h_pagebreaks([place * PAGE_ROWS for place in range(1, len(variants))])
    sheet.print_area(0, 0, len(variants) * PAGE_ROWS - 1, len(COLUMN_WIDTHS) - 1)
    return pages
