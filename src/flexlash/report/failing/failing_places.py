"""Which variants have a page of their own, and where links lead that a variant's name carries."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from flexlash.report.report_data import ROW, Drawn
from flexlash.schema.limit_verdict import VerdictBounds

__all__ = ["EXPLORER_CHOICE", "FAILING", "MOST_PAGES", "PAGE_ROWS", "failing_variants", "variant_targets"]

FAILING = "Failing variants"
MOST_PAGES = 10
"""Most variants that have a page."""

PAGE_ROWS = 80
"""Rows of a page; those that it does not need are hidden, so that every page begins at a place known beforehand."""

EXPLORER_CHOICE = "Explorer!B4"
"""Where a reader picks a variant that has no page."""


def failing_variants(drawn: Sequence[Drawn], bounds: VerdictBounds) -> list[Drawn]:
    """Return the variants that have a page: those that miss their limit, marginal ones too, the first of them."""
    return [variant for variant in drawn if bounds.misses(variant.row["probability_over_limit"])][:MOST_PAGES]


def variant_targets(drawn: Sequence[Drawn], bounds: VerdictBounds) -> Mapping[int, str]:
    """Return where the name of each drawn variant leads, by row number: to its page, else to the list of Explorer."""
    pages = {variant.row[ROW]: place for place, variant in enumerate(failing_variants(drawn, bounds))}
    return {
        row: f"{FAILING}!A{pages[row] * PAGE_ROWS + 1}" if row in pages else EXPLORER_CHOICE
        for row in (variant.row[ROW] for variant in drawn)
    }
