"""The Ranking sheet: the drawn variants worst first, and how each differs from a base that the reader picks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from xlsxwriter.utility import xl_col_to_name, xl_rowcol_to_cell

from flexlash.analysis.outcome import Outcome
from flexlash.analysis.run_summary import share_words
from flexlash.report.extent import extent_of
from flexlash.report.failing.failing_places import variant_targets
from flexlash.report.formula.functions import IF, ISNUMBER, MAX, match_exactly
from flexlash.report.formula.live import Live, fill, put
from flexlash.report.formula.stored import Row, Stored
from flexlash.report.layout.links import write_link
from flexlash.report.layout.styles import Book, decimals_of
from flexlash.report.report_data import ROW, Drawn
from flexlash.report.wording.labels import distinct_labels
from flexlash.report.wording.verdict import COLOURS, verdict_rules, verdict_word
from flexlash.schema.angle_unit import AngleUnit
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.lot_words import lots_words

__all__ = ["BASE_ROW", "DIFFERENCES", "FIRST_ROW", "HEADER", "column_of", "write_ranking"]

BASE_ROW = 4
HEADER = 6
FIRST_ROW = 7
"""Rows, from 0, of the base variant, of the headings and of the worst variant."""

_WORDS = (("Rank", 6), ("Variant", 27), ("Verdict", 8), ("Units over the limit", 31), ("Lots failing", 22))
_FIGURES = {
    "P2.5": "p2_5_standard_error_arcmin",
    "P25": "p50_standard_error_arcmin",
    "P50": "p50_standard_error_arcmin",
    "P75": "p50_standard_error_arcmin",
    "P97.5": "p97_5_standard_error_arcmin",
    "P99.865": "p99_865_standard_error_arcmin",
    "Limit": "",
    "Margin": "p97_5_standard_error_arcmin",
    "sd": "sd_standard_error_arcmin",
}
"""Headings of Compared in the order of this sheet, each with the standard error that limits its digits."""

DIFFERENCES = ("P50", "P97.5", "sd")
"""Figures of which the difference to the base variant is given."""

_NAME = 28
_FIGURE_WIDTH, _CAUSE_WIDTH = 8.1, 20
_CAUSE = len(_WORDS) + len(_FIGURES)
_SHAPE = _CAUSE + 2
_FIRST_DIFFERENCE = _SHAPE + 2
_COLUMNS = _FIRST_DIFFERENCE + 2 * len(DIFFERENCES)
_USUAL, _FINEST = 3, 4
"""Decimals of an angle [arcmin] without a standard error, and the most that any has."""

_LIMIT = "0.00##"
_SIGNED_PERCENT = "+0.0%;-0.0%;0.0%"


def column_of(heading: str) -> int:
    """Return the place of a figure's column, from 0."""
    return len(_WORDS) + list(_FIGURES).index(heading)


def write_ranking(book: Book, outcome: Outcome, drawn: Sequence[Drawn], compared: Stored) -> None:
    """Write the Ranking sheet; the base is the first variant submitted, if it is drawn."""
    sheet = book.sheet("Ranking", tab="entry")
    sheet.write_string(0, 0, "Ranking, worst first, and difference to a base variant", book.format("title"))
    sheet.set_row(0, 28)
    count, extent = len(drawn), extent_of(outcome)
    total = f"{extent.total:,}"
    which = f"the {count} worst of {total}; {extent.elsewhere}" if extent.is_part else f"all {total} computed"
    bounds = outcome.settings.verdict_bounds
    verdicts = "; ".join(f"{verdict}, {rule}" for verdict, rule in verdict_rules(bounds).items())
    notes = (
        f"Variants by share of units over the limit: {which}. Verdict: {verdicts}.",
        "Margin: limit less P97.5, negative when over. Differences: variant less base; orange, more backlash or "
        "scatter than the base; blue, less. Pick the base in the yellow cell.",
        f"A lot fails with more than {outcome.settings.acceptable_ppm:,g} ppm of its units over the limit.",
    )
    for row, note in enumerate(notes, start=1):
        sheet.write_string(row, 0, note, book.format("quiet"))
    _write_headings(book, sheet)
    if drawn:
        first = min(range(count), key=lambda index: drawn[index].computed.variant.row)
        base = _write_base(book, sheet, compared, first)
        targets = variant_targets(drawn, outcome.settings.verdict_bounds)
        labels = distinct_labels([variant.row["variant"] for variant in drawn], _NAME)
        for rank, variant in enumerate(drawn):
            _write_words(
                book,
                sheet,
                rank,
                (variant, verdict_word(variant.row, bounds)),
                (labels[rank], targets[variant.row[ROW]]),
            )
            _write_figures(book, sheet, rank, variant, compared)
            _write_differences(book, sheet, rank, (variant, compared), base)
        _colour(book, sheet, FIRST_ROW + count - 1)
    last = FIRST_ROW + max(count, 1) - 1
    sheet.autofilter(HEADER, 0, last, _COLUMNS - 1)
    sheet.freeze_panes(FIRST_ROW, 2)
    sheet.repeat_rows(BASE_ROW, HEADER)
    sheet.print_area(0, 0, last, _COLUMNS - 1)


def _write_headings(book: Book, sheet: Any) -> None:
    """Write the headings and, above them, what each group of columns is about."""
    style = book.format("header")
    unit = book.angles.name
    units = [f"{name} [{unit}]" if name != "Margin" else f"Margin of P97.5 [{unit}]" for name in _FIGURES]
    changes = [f"{name} [{of}]" for name in DIFFERENCES for of in (unit, "%")]
    shape = ["Main contributor", "Its share of variance", "Disk share of wind-up", "l/r"]
    headings = [*(name for name, _ in _WORDS), *units, *shape, *changes]
    sheet.write_row(HEADER, 0, headings, style)
    sheet.set_row(HEADER, 48)
    for column, (_, width) in enumerate(_WORDS):
        sheet.set_column(column, column, width)
    sheet.set_column(len(_WORDS), _COLUMNS - 1, _FIGURE_WIDTH)
    sheet.set_column(_CAUSE, _CAUSE, _CAUSE_WIDTH)
    for first, last, text in (
        (len(_WORDS), _CAUSE - 1, "Backlash over the tolerances"),
        (_CAUSE, _CAUSE + 1, "Cause"),
        (_SHAPE, _SHAPE + 1, "Shape (l/r: length over mean radius)"),
        (_FIRST_DIFFERENCE, _COLUMNS - 1, "Difference to the base variant"),
    ):
        sheet.merge_range(HEADER - 1, first, HEADER - 1, last, text, style)
    sheet.set_row(HEADER - 1, 32)


def _write_base(book: Book, sheet: Any, compared: Stored, first: int) -> dict[str, Live]:
    """Write the drop-down and what the picked base variant has; return its cells by heading."""
    names = compared.cells("Variant")
    sheet.write_string(BASE_ROW, 0, "Base ►", book.format("label"))
    picked = fill(sheet, BASE_ROW, 1, str(names.values[first]), book.format("input"))
    sheet.data_validation(BASE_ROW, 1, BASE_ROW, 1, {
        "validate": "list",
        "source": f"={names.text}",
        "input_title": "Base variant",
        "input_message": "All differences are to this variant.",
        "error_title": "Base variant",
        "error_message": "Pick a variant from the list.",
    })  # fmt: skip
    rank = match_exactly(picked, names)
    rank = put(sheet, BASE_ROW, 2, rank, book.format("quiet"))
    is_listed = rank > 0.0
    remark = IF(is_listed, "◄ its rank", "◄ not on the list: pick one")
    put(sheet, BASE_ROW, 3, remark, book.format("quiet"))

    def write(heading: str, column: int, number: str) -> Live:
        figure = compared.pick(MAX(rank, 1.0), heading)
        return put(sheet, BASE_ROW, column, IF(is_listed, figure, ""), book.format("base", number))

    write("Disk share", _SHAPE, "0%")
    write("l/r", _SHAPE + 1, "0.00")
    finest = book.angles.decimals(_FINEST)
    figures = {**dict.fromkeys(_FIGURES, finest), "Limit": _LIMIT, "Margin": _signed(finest)}
    return {heading: write(heading, column_of(heading), number) for heading, number in figures.items()}


def _write_words(book: Book, sheet: Any, rank: int, of: tuple[Drawn, str], link: tuple[str, str]) -> None:
    """Write what is said of a variant in words, with its verdict; its label leads to its page or to Explorer."""
    (variant, verdict), row = of, FIRST_ROW + rank
    sheet.write_number(row, 0, rank + 1, book.format("small figure", "0"))
    label, target = link
    write_link(sheet, row, 1, target, label, style=book.format("link"))
    sheet.write_string(row, 2, verdict, book.format(COLOURS[verdict]))
    if variant.row["probability_over_limit"] is not None:
        sheet.write_string(row, 3, share_words(variant.row), book.format("indented"))
        sheet.write_string(row, 4, lots_words(variant.row), book.format("indented"))
    if variant.row["main_contributor"]:
        sheet.write_string(row, _CAUSE, dimension_words(variant.row["main_contributor"]), book.format("indented"))
        sheet.write_number(row, _CAUSE + 1, variant.row["main_contributor_share"], book.format("text", "0%"))


def _decimals(variant: Drawn, heading: str, angles: AngleUnit) -> str:
    """Return the number format that shows a figure of a variant down to its standard error, within bounds."""
    if not _FIGURES[heading]:
        return _LIMIT
    error = angles.of(variant.row[_FIGURES[heading]] or 0.0)
    return min(decimals_of(error, angles.decimals(_USUAL)), angles.decimals(_FINEST), key=len)


def _signed(decimals: str) -> str:
    return f"+{decimals};-{decimals};{decimals}"


def _write_figures(book: Book, sheet: Any, rank: int, variant: Drawn, compared: Stored) -> None:
    """Write the figures of a variant; its margin is worked out in the cell."""
    row, figures = FIRST_ROW + rank, compared.rows[rank]
    for heading in _FIGURES:
        decimals = _decimals(variant, heading, book.angles)
        if heading == "Margin" and figures["Limit"] is not None:
            margin = _own(row, "Limit", figures) - _own(row, "P97.5", figures)
            put(sheet, row, column_of(heading), margin, book.format("text", _signed(decimals)))
        elif figures[heading] is not None:
            sheet.write_number(row, column_of(heading), figures[heading], book.format("text", decimals))
    sheet.write_number(row, _SHAPE, figures["Disk share"], book.format("text", "0%"))
    sheet.write_number(row, _SHAPE + 1, figures["l/r"], book.format("text", "0.00"))


def _own(row: int, heading: str, figures: Row) -> Live:
    """Return a reference to a figure of the same row, one that moves with it when the reader sorts."""
    return Live(xl_rowcol_to_cell(row, column_of(heading)), figures[heading] or 0.0)


def _write_differences(book: Book, sheet: Any, rank: int, of: tuple[Drawn, Stored], base: dict[str, Live]) -> None:
    """Write how a variant differs from the base, in the unit of angles and in per cent, as formulas."""
    variant, compared = of
    row = FIRST_ROW + rank
    for number, heading in enumerate(DIFFERENCES):
        column = _FIRST_DIFFERENCE + 2 * number
        is_known = ISNUMBER(base[heading])
        difference = IF(is_known, _own(row, heading, compared.rows[rank]) - base[heading], "")
        put(sheet, row, column, difference, book.format("text", _signed(_decimals(variant, heading, book.angles))))
        relative = Live(xl_rowcol_to_cell(row, column), difference.value) / base[heading]
        share = IF(is_known, IF(base[heading] > 0.0, relative, ""), "")
        put(sheet, row, column + 1, share, book.format("text", _SIGNED_PERCENT))


def _colour(book: Book, sheet: Any, last: int) -> None:
    """Colour differences by their sign, which the number has too, and margins that are negative."""
    for first, right, rules in (
        (_FIRST_DIFFERENCE, _COLUMNS - 1, ((">", "more"), ("<", "less"))),
        (column_of("Margin"), column_of("Margin"), (("<", "more"),)),
    ):
        cell = f"{xl_col_to_name(first)}{FIRST_ROW + 1}"
        for sign, look in rules:
            # A text is greater than any number to Excel.
            rule = {"type": "formula", "criteria": f"=AND(ISNUMBER({cell}),{cell}{sign}0)", "format": book.format(look)}
            sheet.conditional_format(FIRST_ROW, first, last, right, rule)
