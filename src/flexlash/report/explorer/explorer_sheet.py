"""The Explorer sheet: the reader picks a variant, types any limit, and plain formulas answer.

Answers are read off the percentiles stored in Curves. Every formula is stored with its value; what stands behind
figures and charts is worked out to the right of the printed page.
"""

from __future__ import annotations

from typing import Any

from flexlash.report.explorer.curves_sheet import FIGURE_ERRORS
from flexlash.report.explorer.explorer_charts import CHART_ROWS, FIRST_CHART, write_charts
from flexlash.report.explorer.explorer_choice import NONE, Choice
from flexlash.report.explorer.explorer_limits import write_limits
from flexlash.report.explorer.explorer_working import Read, Working
from flexlash.report.extent import Extent
from flexlash.report.formula.functions import (
    AND,
    CONCATENATE,
    FIXED,
    IF,
    ISNUMBER,
    MAX,
    MIN,
    NORM_S_DIST,
    NORM_S_INV,
    SQRT,
    decimals_to,
)
from flexlash.report.formula.live import Live, live, put
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.styles import Book
from flexlash.schema.limit_verdict import MARGINAL, VerdictBounds
from flexlash.schema.number_words import INTERVAL

__all__ = ["EXPLORER_PLACES", "write_explorer"]

_WIDTHS = (29, 19, 30, 3, 31, 15, 11)
_USUAL = 4.0
"""Decimals of a number that has no error."""

_MOST = 12.0
"""Decimals of per cent at most."""

_FINEST = 1e-4
"""Part of a share, or of what it leaves, that is not told, however well it is known: it is read off a curve."""

_PPK_DECIMALS = 3.0
"""Decimals of a Ppk at most."""

_PPM_DECIMALS = 4.0
"""Decimals of per cent that make a millionth."""

_NEARLY = 1.000001
"""Room for rounding where a share meets the rarest that is told."""

_SECTIONS = ((2, 0, "Your choice"), (8, 0, "Answer"), (2, 4, "Figures of this variant"))
_ANSWERS = (
    "Limit",
    "Units over the limit",
    "    95 % interval from",
    "    to",
    "    in ppm",
    "Verdict",
    "Limit for the wanted share",
    "    ± (95 %)",
    "Left open by measured parts",
)
_FIRST_ANSWER, _FIRST_FIGURE = 9, 3
_USED, _SHARE, _LOW, _HIGH, _PPM, _VERDICT, _FOUND, _FOUND_ERROR, _LEFT_OPEN = range(
    _FIRST_ANSWER, _FIRST_ANSWER + len(_ANSWERS)
)
"""Rows, from 0, of the answers."""

_FIGURES = {
    "Nominal": "Nominal",
    "Mean": "Mean",
    "sd": "Standard deviation",
    "P2.5": "P2.5",
    "P50": "P50",
    "P97.5": "P97.5",
    "P99.865": "P99.865",
    "Worst case low": "Worst case, lowest",
    "Worst case high": "Worst case, highest",
    "Cylinder only": "Nominal by cylinder-only formula",
}


_RAREST_LOTS = 1e-7
"""Per cent of lots below which none is told to fail."""

_UNSETTLED_LOTS = 5.0
"""Standard error [%] of none or all from which that is not known of lots that are all alike."""

_LOTS = ("Within-lot sd", "Between-lots sd")
"""Figures of lots and parts, below the others."""

_CAPABILITY = _FIRST_FIGURE + len(_FIGURES)
_FIRST_LOTS, _FAILING_LOTS = _CAPABILITY + 1, _CAPABILITY + 1 + len(_LOTS)
_STRENGTH = _FAILING_LOTS + 1
"""Rows, from 0, of what stands below the figures."""

_LIMITS_ROW = FIRST_CHART + 2 * CHART_ROWS + 1

EXPLORER_PLACES = {
    "another limit": "Explorer!B6",
    "verdict": f"Explorer!B{_VERDICT + 1}",
    "interval": f"Explorer!B{_SHARE + 1}",
    "left open": f"Explorer!B{_LEFT_OPEN + 1}",
    "worst case": f"Explorer!F{_FIRST_FIGURE + list(_FIGURES).index('Worst case high') + 1}",
    "cylinder only": f"Explorer!F{_FIRST_FIGURE + list(_FIGURES).index('Cylinder only') + 1}",
    "lots": f"Explorer!F{_FIRST_LOTS + 1}",
    "strength": f"Explorer!F{_STRENGTH + 1}",
    "limits": f"Explorer!A{_LIMITS_ROW + 1}",
}
"""The cells that answer a reviewer's questions about the picked variant."""


def write_explorer(
    book: Book, stored: tuple[Stored, Stored], extent: Extent, bounds: VerdictBounds, unit: Live | None = None
) -> None:
    """Write the Explorer of the stored variants, the worst one picked, in the unit of another cell if one is given.

    Its figures come from the sheets Curves and Scatter.
    """
    curves, scatter = stored
    sheet = book.sheet("Explorer", landscape=False, pages_tall=1, tab="entry")
    for column, width in enumerate(_WIDTHS):
        sheet.set_column(column, column, width)
    sheet.write_string(0, 0, "Explorer: one variant, any limit", book.format("title"))
    sheet.set_row(0, 28)
    if not curves.rows:
        sheet.write_string(1, 0, "Nothing was computed, see Findings.", book.format("quiet"))
        return
    note = "Change the five yellow cells; figures and charts follow."
    if extent.is_part:
        note += f" The {extent.words} variants can be picked; {extent.elsewhere}."
    sheet.write_string(1, 0, note, book.format("quiet"))
    for row, first_column, text in _SECTIONS:
        for column in range(first_column, first_column + 3):
            sheet.write_blank(row, column, None, book.format("section"))
        sheet.write_string(row, first_column, text, book.format("section"))
    choice = Choice(book, sheet, curves, bounds, unit)
    working = Working(book, sheet, choice)
    limit = _write_answers(book, sheet, choice, working)
    _write_figures(book, sheet, choice, working, limit)
    write_charts(book, sheet, choice, working, limit)
    last = write_limits(book, sheet, (choice, working), scatter, _LIMITS_ROW)
    sheet.print_area(0, 0, last, len(_WIDTHS) - 1)
    sheet.freeze_panes(_FIRST_ANSWER - 1, 0)


def _write_answers(book: Book, sheet: Any, choice: Choice, working: Working) -> Live:
    """Write what the curve says of the limit and of the wanted share; return the limit, an empty text for none."""
    for row, words in enumerate(_ANSWERS, start=_FIRST_ANSWER):
        sheet.write_string(row, 0, words, book.format("text" if words.startswith(" ") else "label"))
    used = IF(choice.known, IF(choice.is_blank, choice.angle("Limit"), choice.other), "")
    limit = working.cell("limit that counts", used)
    put(sheet, _USED, 1, IF(limit.equals(""), NONE, limit), book.format("figure", "arcmin"))
    read = working.read_share(IF(limit.equals(""), choice.angle("P50"), limit))
    _write_share(book, sheet, choice, (working, read), limit)
    backlash, error = working.read_output(live(0.0) - NORM_S_INV(choice.wanted))
    decimals = working.cell("its decimals", decimals_to(error, _USUAL))
    put(sheet, _FOUND, 1, IF(choice.wants, FIXED(backlash, decimals), NONE), book.format("figure"))
    put(sheet, _FOUND_ERROR, 1, IF(choice.wants, FIXED(error * INTERVAL, decimals), NONE), book.format("figure"))
    for row in (_USED, _FOUND, _FOUND_ERROR):
        put(sheet, row, 2, choice.unit, book.format("quiet"))
    left_open = choice.text("Left open")
    put(sheet, _LEFT_OPEN, 1, choice.figure(IF(left_open.equals(""), "–", left_open)), book.format("figure"))
    sheet.write_string(_LEFT_OPEN, 2, "over its own limit (95 %)", book.format("quiet"))
    return limit


def _write_share(book: Book, sheet: Any, choice: Choice, reading: tuple[Working, Read], limit: Live) -> None:
    """Write the share over the limit with its interval and the verdict."""
    working, read = reading
    quiet, figure = book.format("quiet"), book.format("figure")
    none = limit.equals("")
    rarest = working.cell("rarest share told", choice.text("Rarest share"))
    share_told = working.cell("share told", MIN(MAX(read.share, rarest), live(1.0) - rarest))
    few, many = read.share < rarest * _NEARLY, read.share > live(1.0) - rarest * _NEARLY
    bound = IF(few, "at most: rarer than computed", IF(many, "at least: rarer than computed", ""))
    put(sheet, _SHARE, 2, IF(none, "◄ no limit: type one above", IF(working.is_level, "", bound)), quiet)
    ends = []
    for sign, beyond in ((1.0, IF(few, 0.0, share_told)), (-1.0, IF(many, 1.0, share_told))):
        end = NORM_S_DIST(live(0.0) - (read.score + read.error * (sign * INTERVAL)))
        kept = (MIN if sign > 0 else MAX)(end, beyond)
        ends.append(working.cell("end of its interval", IF(working.is_level, share_told, kept)))
    error = working.cell("its standard error in %", (ends[1] - ends[0]) * (50 / INTERVAL))
    finest = working.cell("least of it that is shown", MIN(share_told, 1 - share_told) * (100 * _FINEST))
    decimals = working.cell("decimals of per cent", decimals_to(MAX(error, finest), _USUAL, most=_MOST))
    narrow = working.cell("interval inside the last digit", decimals_to(error, 0.0, most=2 * _MOST) > decimals)
    for row, share in ((_SHARE, share_told), (_LOW, ends[0]), (_HIGH, ends[1])):
        words = CONCATENATE(FIXED(share * 100, decimals), " %")
        put(sheet, row, 1, IF(none, NONE, IF(narrow, "–", words) if row > _SHARE else words), figure)
    put(sheet, _LOW, 2, IF(narrow, "narrower than the last digit", "from the spread's standard errors"), quiet)
    put(sheet, _PPM, 1, IF(none, NONE, FIXED(share_told * 1e6, decimals - _PPM_DECIMALS)), figure)
    allowed = working.cell("share over a limit that meets it", choice.allowed)
    put(sheet, _VERDICT, 1, IF(none, "–", _verdict(allowed, read.share, *ends)), figure)
    rule = CONCATENATE("meets to ", FIXED(allowed * 100, 4.0), f" %, marginal to {100 * MARGINAL:g} %")
    remark = IF(none, rule, IF(_settled(allowed, read.share, *ends), rule, "◄ the interval reaches another"))
    put(sheet, _VERDICT, 2, remark, quiet)
    for word, style in (("meets", "ok"), ("marginal", "warning"), ("fails", "error")):
        colour = {"type": "text", "criteria": "begins with", "value": word, "format": book.format(style)}
        sheet.conditional_format(_VERDICT, 1, _VERDICT, 1, colour)


def _verdict(allowed: Live, share: Live, low: Live, high: Live) -> Live:
    """Return the verdict on a share where so much is allowed, with ? where its interval reaches another one."""
    word = IF(share <= allowed, "meets", IF(share <= MARGINAL, "marginal", "fails"))
    return CONCATENATE(word, IF(_settled(allowed, share, low, high), "", "?"))


def _settled(allowed: Live, share: Live, low: Live, high: Live) -> Live:
    """Return whether the whole interval of a share has the same verdict."""
    marginal = AND(low > allowed, high <= MARGINAL)
    return IF(share <= allowed, high <= allowed, IF(share <= MARGINAL, marginal, low > MARGINAL))


def _write_figures(book: Book, sheet: Any, choice: Choice, working: Working, limit: Live) -> None:
    """Write the figures of the picked variant beside the answers."""
    figure, quiet = book.format("figure", "arcmin"), book.format("quiet")
    rows = dict(enumerate(_FIGURES.items(), start=_FIRST_FIGURE))
    rows |= dict(enumerate(zip(_LOTS, _LOTS, strict=True), start=_FIRST_LOTS))
    for row, (heading, words) in rows.items():
        sheet.write_string(row, 4, words, book.format("label"))
        value, shown = choice.angle(heading), figure
        if heading in FIGURE_ERRORS:
            decimals = decimals_to(choice.angle(FIGURE_ERRORS[heading][0]), _USUAL, most=_USUAL)
            value, shown = FIXED(value, decimals), book.format("figure")
        put(sheet, row, 5, choice.figure(value), shown)
        put(sheet, row, 6, choice.unit, quiet)
    _write_capability(book, sheet, choice, working, limit)
    _write_failing_lots(book, sheet, choice, working)
    _write_strength(book, sheet, choice)


def _write_capability(book: Book, sheet: Any, choice: Choice, working: Working, limit: Live) -> None:
    """Write the Ppk at the limit that counts, below the figures."""
    row, quiet = _CAPABILITY, book.format("quiet")
    sheet.write_string(row, 4, "Ppk upper at this limit", book.format("label"))
    median = choice.angle("P50")
    reach = working.cell("P99.865 - P50", choice.angle("P99.865") - median)
    has = AND(ISNUMBER(limit), reach > 0.0)
    capability = working.cell("Ppk upper", IF(has, (limit - median) / reach, 0.0))
    of_median, of_tail = (choice.angle(FIGURE_ERRORS[heading][0]) for heading in ("P50", "P99.865"))
    squares = ((capability - 1) * of_median) ** 2 + (capability * of_tail) ** 2
    error = working.cell("its standard error", IF(has, SQRT(squares) / reach, 0.0))
    words = FIXED(capability, decimals_to(error, _PPK_DECIMALS, most=_PPK_DECIMALS))
    put(sheet, row, 5, IF(has, words, NONE), book.format("figure"))
    sheet.write_string(row, 6, "ISO 22514-2", quiet)


def _write_failing_lots(book: Book, sheet: Any, choice: Choice, working: Working) -> None:
    """Write how many lots fail at the variant's own limit, the only one of which that is known."""
    row = _FAILING_LOTS
    sheet.write_string(row, 4, "Lots failing at its own limit", book.format("label"))
    share, error = choice.text("Lots failing"), choice.text("error of Lots failing")
    has = ISNUMBER(share)
    percent = working.cell("lots failing in %", IF(has, share * 100, 0.0))
    rest = working.cell("or not failing, what is less", MIN(percent, live(100.0) - percent))
    unsure = working.cell("its standard error in %", IF(has, error * 100, 0.0))
    decimals = decimals_to(MAX(unsure, rest * _FINEST), _USUAL, most=_MOST)
    counted = CONCATENATE(FIXED(percent, decimals), " %")
    end = IF(percent <= rest, "practically none", "practically all")
    words = IF(rest < _RAREST_LOTS, IF(unsure > _UNSETTLED_LOTS, "not settled", end), counted)
    put(sheet, row, 5, choice.figure(IF(has, words, NONE)), book.format("figure"))
    sheet.write_string(row, 6, "of lots", book.format("quiet"))


def _write_strength(book: Book, sheet: Any, choice: Choice) -> None:
    """Write the greatest stress of torsion and how far it is from yield; nothing of it follows the limit."""
    for row, words, heading, unit, decimals in (
        (_STRENGTH, "Von Mises, torsion only", "Von Mises", "MPa", 1),
        (_STRENGTH + 1, "Yields at", "Times to yield", "× the torque", 2),
    ):
        value = choice.text(heading)
        known = AND(choice.known, ISNUMBER(value))
        sheet.write_string(row, 4, words, book.format("label"))
        put(sheet, row, 5, IF(known, FIXED(IF(known, value, 0.0), decimals), NONE), book.format("figure"))
        sheet.write_string(row, 6, unit, book.format("quiet"))
