"""The Explorer sheet: the reader picks a variant, types any limit, and plain formulas answer.

Answers are read off the percentiles stored in Curves. Every formula is stored with its value; what stands behind
figures and charts is worked out to the right of the printed page.
"""

from __future__ import annotations

from typing import Any

from flexlash.report.explorer.explorer_charts import write_charts
from flexlash.report.explorer.explorer_choice import NONE, USUAL_SHARE, Choice
from flexlash.report.explorer.explorer_working import Read, Working
from flexlash.report.functions import all_of, greatest, least, normal_score, normal_share
from flexlash.report.live import Live, joined, live, put, when
from flexlash.report.stored import Stored
from flexlash.report.styles import Book
from flexlash.report.verdict import BOUNDS

__all__ = ["write_explorer"]

_WIDTHS = (29, 19, 30, 3, 31, 15, 11)
_INTERVAL = 1.96
_AMBER = BOUNDS["amber"]
_NEARLY = 1.000001
"""Room for rounding where a share meets the rarest that is told."""

_RULE = "green to 0.135 %, amber to 2.5 %"
_LAST_ROW = 60
_SECTIONS = ((2, 0, "Your choice"), (7, 0, "Answer"), (2, 4, "Figures of this variant"))
_ANSWERS = (
    "Limit",
    "Units over the limit",
    "    95 % interval from",
    "    to",
    "    in ppm",
    "Verdict",
    "Limit for the wanted share",
    "    ± (95 %)",
)
_FIRST_ANSWER, _FIRST_FIGURE = 8, 3
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


def write_explorer(book: Book, curves: Stored, total: int) -> None:
    """Write the Explorer of the stored variants, the worst one picked; `total` counts all computed ones."""
    sheet = book.sheet("Explorer", landscape=False, pages_tall=1, tab="entry")
    for place, width in enumerate(_WIDTHS):
        sheet.set_column(place, place, width)
    sheet.write_string(0, 0, "Explorer: one variant, any limit", book.format("title"))
    sheet.set_row(0, 28)
    if not curves.rows:
        sheet.write_string(1, 0, "Nothing was computed, see Findings.", book.format("quiet"))
        return
    note = "Change the four yellow cells; figures and charts follow."
    if len(curves.rows) < total:
        note += f" The {len(curves.rows)} worst of {total} variants can be picked; all are in Results."
    sheet.write_string(1, 0, note, book.format("quiet"))
    for row, column, text in _SECTIONS:
        for place in range(column, column + 3):
            sheet.write_blank(row, place, None, book.format("section"))
        sheet.write_string(row, column, text, book.format("section"))
    choice = Choice(book, sheet, curves)
    working = Working(book, sheet, choice)
    limit = _write_answers(book, sheet, choice, working)
    _write_figures(book, sheet, choice, limit)
    write_charts(book, sheet, choice, working, limit)
    sheet.print_area(0, 0, _LAST_ROW, len(_WIDTHS) - 1)
    sheet.freeze_panes(_FIRST_ANSWER - 1, 0)


def _write_answers(book: Book, sheet: Any, choice: Choice, working: Working) -> Live:
    """Write what the curve says of the limit and of the wanted share; return the limit, an empty text for none."""
    for row, words in enumerate(_ANSWERS, start=_FIRST_ANSWER):
        sheet.write_string(row, 0, words, book.format("text" if words.startswith(" ") else "label"))
    used = when(choice.known, when(choice.is_blank, choice.angle("Limit"), choice.other), "")
    limit = working.cell("limit that counts", used)
    put(sheet, 8, 1, when(limit.equals(""), NONE, limit), book.format("figure", "arcmin"))
    read = working.read_share(when(limit.equals(""), choice.angle("P50"), limit))
    _write_share(book, sheet, choice, (working, read), limit)
    found, error = working.read_output(live(0.0) - normal_score(choice.wanted))
    put(sheet, 14, 1, when(choice.wants, found, NONE), book.format("figure", "arcmin"))
    put(sheet, 15, 1, when(choice.wants, error * _INTERVAL, NONE), book.format("figure", "0.00000"))
    for row in (8, 14, 15):
        put(sheet, row, 2, choice.unit, book.format("quiet"))
    return limit


def _write_share(book: Book, sheet: Any, choice: Choice, reading: tuple[Working, Read], limit: Live) -> None:
    """Write the share over the limit with its interval and the verdict."""
    working, read = reading
    quiet, figure, percent = (book.format(*one) for one in (("quiet",), ("figure",), ("figure", "0.0000##%")))
    none = limit.equals("")
    rarest = working.cell("rarest share told", choice.text("Rarest share"))
    told = working.cell("share told", least(greatest(read.share, rarest), live(1.0) - rarest))
    few, many = read.share < rarest * _NEARLY, read.share > live(1.0) - rarest * _NEARLY
    bound = when(few, "at most: rarer than computed", when(many, "at least: rarer than computed", ""))
    put(sheet, 9, 1, when(none, NONE, told), percent)
    put(sheet, 9, 2, when(none, "◄ no limit: type one above", when(working.is_level, "", bound)), quiet)
    ends = []
    for row, sign, beyond in ((10, 1.0, when(few, 0.0, told)), (11, -1.0, when(many, 1.0, told))):
        end = normal_share(live(0.0) - (read.score + read.error * (sign * _INTERVAL)))
        kept = (least if sign > 0 else greatest)(end, beyond)
        ends.append(working.cell("end of its interval", when(working.is_level, told, kept)))
        put(sheet, row, 1, when(none, NONE, ends[-1]), percent)
    sheet.write_string(10, 2, "from the spread's standard errors", quiet)
    put(sheet, 12, 1, when(none, NONE, told * 1e6), book.format("figure", "#,##0.0"))
    put(sheet, 13, 1, when(none, "–", _verdict(read.share, *ends)), figure)
    told = when(none, _RULE, when(_settled(read.share, *ends), _RULE, "◄ the interval reaches another"))
    put(sheet, 13, 2, told, quiet)
    for word, style in (("green", "ok"), ("amber", "warning"), ("red", "error")):
        rule = {"type": "text", "criteria": "begins with", "value": word, "format": book.format(style)}
        sheet.conditional_format(13, 1, 13, 1, rule)


def _verdict(share: Live, low: Live, high: Live) -> Live:
    """Return the verdict on a share, with a question mark where its interval reaches another one."""
    word = when(share <= USUAL_SHARE, "green", when(share <= _AMBER, "amber", "red"))
    return joined(word, when(_settled(share, low, high), "", "?"))


def _settled(share: Live, low: Live, high: Live) -> Live:
    """Return whether the whole interval of a share has the same verdict."""
    amber = all_of(low > USUAL_SHARE, high <= _AMBER)
    return when(share <= USUAL_SHARE, high <= USUAL_SHARE, when(share <= _AMBER, amber, low > _AMBER))


def _write_figures(book: Book, sheet: Any, choice: Choice, limit: Live) -> None:
    """Write the figures of the picked variant beside the answers."""
    figure, quiet = book.format("figure", "arcmin"), book.format("quiet")
    for row, (heading, words) in enumerate(_FIGURES.items(), start=_FIRST_FIGURE):
        sheet.write_string(row, 4, words, book.format("label"))
        put(sheet, row, 5, choice.told(choice.angle(heading)), figure)
        put(sheet, row, 6, choice.unit, quiet)
    row = _FIRST_FIGURE + len(_FIGURES)
    sheet.write_string(row, 4, "Ppk upper at this limit", book.format("label"))
    median = choice.angle("P50")
    reach = choice.angle("P99.865") - median
    capability = when(reach > 0.0, (limit - median) / reach, NONE)
    put(sheet, row, 5, when(limit.equals(""), NONE, capability), book.format("figure", "plain"))
    sheet.write_string(row, 6, "ISO 22514-2", quiet)
