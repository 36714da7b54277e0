"""The rules side by side on the sheet Drive: each with its equation, its value in formulas and the program's."""

from __future__ import annotations

from flexlash.report.drive.drive_page import DrivePage
from flexlash.report.drive.sources_table import Chain
from flexlash.report.formula.functions import IF, MIN, SQRT
from flexlash.report.formula.live import live, put
from flexlash.report.layout.styles import PALETTE
from flexlash.tolerance.tolerance_chains import BENDER

__all__ = ["HEADINGS", "write_combinations"]

HEADINGS = (
    (0, 0, "Rule"),
    (1, 4, "Equation"),
    (5, 5, "Deviation [{angle}]"),
    (6, 6, "Whole drive [{angle}]"),
    (7, 7, "System limit"),
    (8, 8, "Margin [{angle}]"),
    (9, 9, "By the program [{angle}]"),
    (10, 10, "Relative difference"),
)
"""First and last column of each heading."""

_MARGIN, _DIFFERENCE = 8, 10


def write_combinations(page: DrivePage, top: int, chain: Chain) -> int:
    """Write the rules below their headings in row `top`, from the sums of the chain; return the row after them."""
    book, sheet = page.book, page.sheet
    for first, last, name in HEADINGS:
        (heading,) = book.headings(name)
        if last > first:
            sheet.merge_range(top, first, top, last, heading, book.format("header"))
        else:
            sheet.write_string(top, first, heading, book.format("header"))
    sheet.set_row(top, 48)
    root = SQRT(chain.square)
    rules = (
        ("Average (systematic)", "Σ averages", live(0.0), "system_mean_arcmin"),
        ("Root sum of squares", "average + √Σ (c T)²", root, "system_rss_high_arcmin"),
        (
            f"Bender, {BENDER:g} times that",
            f"average + min({BENDER:g} √Σ (c T)², Σ T)",
            MIN(BENDER * root, chain.worst),
            "system_bender_high_arcmin",
        ),
        (
            "Mean shift",
            "average + η Σ T + √Σ ((1 − η) c T)²",
            page.shift * chain.worst + SQRT(chain.rest),
            "system_mean_shift_high_arcmin",
        ),
        ("Worst case", "average + Σ T", chain.worst, "system_worst_case_high_arcmin"),
        ("Monte Carlo, P99.865", "model of the wind-up + every play, drawn", None, "system_p99_865_arcmin"),
    )
    limit = page.result("system_limit_arcmin")
    style, words = book.format("text", book.angles.name), book.format("indented")
    for row, (rule, equation, deviation, key) in enumerate(rules, start=top + 1):
        sheet.write_string(row, 0, rule, book.format("text"))
        sheet.merge_range(row, 1, row, 4, equation, words)
        program = page.result(key)
        if deviation is None:
            high = put(sheet, row, 6, program, style)
        else:
            reach = put(sheet, row, 5, deviation, style)
            high = put(sheet, row, 6, chain.mean + reach, style)
            known = put(sheet, row, 9, program, style)
            put(sheet, row, _DIFFERENCE, high / known - 1, book.format("text", "0.0E+00"))
        own = put(sheet, row, 7, limit, book.format("text", "general"))
        put(sheet, row, _MARGIN, IF(own.equals(""), "", own - high), style)
    last = top + len(rules)
    red = book.workbook.add_format({"font_color": PALETTE["dark red"], "bold": True})
    over = {"type": "cell", "criteria": "<", "value": 0, "format": red}
    sheet.conditional_format(top + 1, _MARGIN, last, _MARGIN, over)
    changed = book.workbook.add_format({"num_format": "+0.00%;-0.00%", "font_color": PALETTE["dark orange"]})
    moved = {"type": "formula", "criteria": f"=ABS(N($K{top + 2}))>0.000001", "format": changed}
    sheet.conditional_format(top + 1, _DIFFERENCE, last, _DIFFERENCE, moved)
    return last + 1
