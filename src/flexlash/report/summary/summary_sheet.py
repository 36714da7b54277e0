"""The Summary sheet: one printed page that says what was found, in words, numbers and one chart."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from typing import Any

from flexlash.analysis.outcome import Outcome
from flexlash.analysis.run_summary import counted, points_words
from flexlash.report.allocation_sheet import ALLOCATED
from flexlash.report.drive.drive_page import SHEET as DRIVE_SHEET
from flexlash.report.extent import extent_of
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.links import result_rows, write_link
from flexlash.report.layout.styles import Book, decimals_of
from flexlash.report.layout.wrapping import LINE_HEIGHT, fitted, lines_of, merged_width
from flexlash.report.levers_sheet import LEVERS, lever_places
from flexlash.report.report_data import Drawn, ReportData
from flexlash.report.summary.summary_chart import chart_words, variants_chart
from flexlash.report.wording.allocation_sentences import CLASSES
from flexlash.report.wording.distances import distance, distance_format
from flexlash.report.wording.drive_sentences import DRIVE
from flexlash.report.wording.lever_sentences import CHANGE, LENGTH, RELAX
from flexlash.report.wording.lever_words import shown_levers
from flexlash.report.wording.sentences import FINDINGS, sentences
from flexlash.report.wording.summary_facts import labels_of, main_cause
from flexlash.report.wording.sweep_words import summary_sentence
from flexlash.report.wording.verdict import (
    COLOURS,
    NO_VERDICT,
    UNSETTLED,
    verdict_counts,
    verdict_rules,
    verdict_verb,
    verdict_word,
)
from flexlash.schema.findings import shown
from flexlash.schema.limit_verdict import VERDICTS, Verdict
from flexlash.schema.number_words import glance, grouped, share_words

__all__ = ["write_summary"]

_LISTED = 12
"""Most variants in the table."""

_COLUMNS = (
    ("Variant", 26),
    ("Verdict", 8),
    ("Nominal [arcmin]", 9),
    ("P50 [arcmin]", 9),
    ("P97.5 [arcmin]", 9),
    ("Limit [arcmin]", 9),
    ("P97.5 over limit by [arcmin]", 9),
    ("Units over the limit", 29),
    ("Main contributor", 23),
)
_WIDTHS = [width for _, width in _COLUMNS]
_FIGURES = ((0, 0), (1, 3), (4, 6), (7, 7), (8, 8))
"""First and last column of each key figure."""

_PAGE = 940.0
"""Height [pt] of what fits on a Letter page when it is as wide as the table; A4 is higher."""

_CHART = (170.0, 340.0)
"""Least and greatest height [pt] of the chart."""

_CHART_WIDTH = sum(7 * width + 5 for width in _WIDTHS)
_LINES = 5
"""Lines below the chart: provenance, and one to sign above which there is room to write."""

_SIGNED = "Reviewed by ______________________________   Date ____________________"


def write_summary(book: Book, outcome: Outcome, data: ReportData, curves: Stored) -> None:
    """Write the Summary sheet; its chart draws on the data sheet of the curves."""
    page = _Page(book, outcome)
    page.heading()
    page.key_figures()
    targets = _targets(data)
    for topic, text in sentences(outcome, data.levers, data.allocation):
        page.sentence(topic, text, targets.get(topic, ""))
    if swept := summary_sentence(data.studies, outcome.settings.target_percent):
        page.sentence("Sweep", swept, "Sweep!A1")
    if data.drawn:
        page.table(data.drawn)
        page.chart(data.drawn, curves)
    page.provenance()
    page.signature()
    page.sheet.print_area(0, 0, page.row - 1, len(_COLUMNS) - 1)
    page.sheet.activate()


class _Page:
    """The sheet as it grows: the next row, and how high what stands above it is [pt]."""

    def __init__(self, book: Book, outcome: Outcome) -> None:
        self.book = book
        self.outcome = outcome
        self.sheet = book.sheet("Summary", landscape=False, pages_tall=1)
        for column, width in enumerate(_WIDTHS):
            self.sheet.set_column(column, column, width)
        self.row = 0
        self.height = 0.0

    def _end_row(self, height: float = LINE_HEIGHT) -> None:
        """Set the height of the present row and go to the next one."""
        self.sheet.set_row(self.row, height)
        self.height += height
        self.row += 1

    def _across(self, first: int, last: int, text: str, style: Any) -> None:
        """Write a text across columns of the present row; a text is never taken for a formula."""
        if last > first:
            self.sheet.merge_range(self.row, first, self.row, last, "", style)
        self.sheet.write_string(self.row, first, text, style)

    def heading(self) -> None:
        """Write title and submission."""
        self.sheet.write_string(
            self.row, 0, "Backlash from torsional wind-up: tolerance spread", self.book.format("title")
        )
        self._end_row(28)
        name = shown(self.outcome.submission.name, longest=100)
        self.sheet.write_string(self.row, 0, f"Submission {name}", self.book.format("quiet"))
        self._end_row()
        self._end_row(6)

    def key_figures(self) -> None:
        """Write how many were computed, have which verdict by which rule, and how much was found."""
        counts, verdicts = self.outcome.counts, verdict_counts(self.outcome)
        judged = sum(verdicts.values()) - verdicts[NO_VERDICT]
        rules = verdict_rules(self.outcome.settings.verdict_bounds)
        level = "error" if counts["errors"] else "warning"
        without = f", {grouped(verdicts[NO_VERDICT])} without a limit" if verdicts[NO_VERDICT] else ""
        others = f"and {counted(counts['warnings'], 'warning')}; " if counts["errors"] and counts["warnings"] else ""
        figures = [
            (f"{grouped(counts['computed'])} of {grouped(counts['rows'])}", f"variants computed{without}", ""),
            *(
                _verdict_figure(verdict, rules[verdict], verdicts)
                if judged
                else (f"{NO_VERDICT} {verdict_verb(verdict, 0)}", rules[verdict], "")
                for verdict in reversed(VERDICTS)
            ),
            (
                counted(counts[f"{level}s"], level),
                f"{others}see Findings" if counts["errors"] or counts["warnings"] else "and no errors",
                "",
            ),
        ]
        for (value, _, verdict), (first, last) in zip(figures, _FIGURES, strict=True):
            style = f"big {COLOURS[verdict]}" if verdict else "big"
            self._across(first, last, value, self.book.format(style))
        self._end_row(30)
        lines = 2
        for (_, caption, _), (first, last) in zip(figures, _FIGURES, strict=True):
            self._across(first, last, caption, self.book.format("caption"))
            lines = max(lines, lines_of(caption, merged_width(_WIDTHS[first : last + 1])))
        self._end_row(lines * LINE_HEIGHT)
        self._end_row(8)

    def sentence(self, topic: str, text: str, target: str) -> None:
        """Write the answer to a question beside it, wrapped; a topic with a target leads there."""
        if target:
            write_link(self.sheet, self.row, 0, target, topic, style=self.book.format("topic link"))
        else:
            self.sheet.write_string(self.row, 0, topic, self.book.format("topic"))
        self._across(1, len(_COLUMNS) - 1, text, self.book.format("said"))
        self._end_row(LINE_HEIGHT * lines_of(text, merged_width(_WIDTHS[1:])) + 2)

    def table(self, drawn: Sequence[Drawn]) -> None:
        """Write the worst variants, each leading to its row of Results."""
        self._end_row(8)
        for column, (heading, _) in enumerate(_COLUMNS):
            self.sheet.write_string(self.row, column, heading, self.book.format("header"))
        self._end_row(3 * LINE_HEIGHT + 2)
        targets = result_rows(self.outcome)
        labels = labels_of(self.outcome, [variant.row["variant"] for variant in drawn])
        for variant in drawn[:_LISTED]:
            name = _fitted(labels[variant.row["variant"]], merged_width(_WIDTHS[:1]))
            self._variant(variant.row, name, targets[variant.computed.variant.row])
        extent = extent_of(self.outcome)
        more = f"The {_LISTED} worst of {grouped(extent.total)} are listed; {extent.elsewhere}. "
        note = (
            "Worst first: by share over the limit. The verdict judges the backlash alone, over the units of all lots."
        )
        if len(drawn) > _LISTED:
            note = more + note
        self.sheet.write_string(self.row, 0, note, self.book.format("quiet"))
        self._end_row()
        self._further()

    def _further(self) -> None:
        """Write where a variant can be looked into, with links to these sheets."""
        link = self.book.format("link")
        self.sheet.write_string(self.row, 0, "Pick a variant in", self.book.format("figure"))
        write_link(self.sheet, self.row, 1, "Explorer!A1", "Explorer", style=link)
        write_link(self.sheet, self.row, 2, "Trace!A1", "or Trace", style=link)
        self.sheet.write_string(self.row, 3, "to look into it further.", self.book.format("text"))
        self._end_row()

    def _variant(self, row: dict[str, Any], name: str, target: int) -> None:
        """Write a variant's row of the table."""
        verdict = verdict_word(row, self.outcome.settings.verdict_bounds)
        link = self.book.format("link")
        write_link(self.sheet, self.row, 0, f"Results!A{target + 1}", name, style=link)
        self.sheet.write_string(self.row, 1, verdict, self.book.format(COLOURS[verdict]))
        for column, key in enumerate(("backlash", "p50", "p97_5", "backlash_limit"), start=2):
            value, error = row[f"{key}_arcmin"], row.get(f"{key}_standard_error_arcmin")
            if value is not None:
                self.sheet.write_number(self.row, column, value, self.book.format("text", _glance(value, error)))
        lines = 1
        if row["backlash_limit_arcmin"] is not None:
            style = self.book.format("text", distance_format(row, "p97_5"))
            self.sheet.write_number(self.row, 6, distance(row, "p97_5"), style)
            share = share_words(row)
            lines = lines_of(share, merged_width(_WIDTHS[7:8]) - 1)
            self.sheet.write_string(self.row, 7, share, self.book.format("indented wrap"))
        if row["main_contributor"]:
            cause = main_cause(row)
            lines = max(lines, lines_of(cause, merged_width(_WIDTHS[8:])))
            self.sheet.write_string(self.row, 8, cause, self.book.format("wrap"))
        self._end_row(LINE_HEIGHT * lines)

    def chart(self, drawn: Sequence[Drawn], curves: Stored) -> None:
        """Draw the chart as high as the page has room."""
        self._end_row(8)
        least, greatest = _CHART
        height = min(greatest, max(least, _PAGE - self.height - (_LINES + 1) * LINE_HEIGHT))
        rows = math.ceil(height / LINE_HEIGHT)
        size = (_CHART_WIDTH, round(rows * LINE_HEIGHT / 0.75) - 4)
        chart = variants_chart(self.book, drawn, curves, self.outcome)
        self.book.insert(self.sheet, self.row, 0, chart, size=size, text=chart_words(drawn))
        for _ in range(rows):
            self._end_row()

    def provenance(self) -> None:
        """Write where the numbers come from."""
        from flexlash import __version__

        submission, settings = self.outcome.submission, self.outcome.settings
        shown_here = " shown" if self.outcome.whole else ""
        changed = f"; last changed {submission.modified:%Y-%m-%d}" if submission.modified else ""
        facts = (
            f"Submission {shown(submission.name, longest=100)}{changed}",
            f"sha256 {submission.sha256}",
            f"flexlash {__version__}, method {settings.method}, seed {settings.seed}, "
            f"{points_words(self.outcome)} per variant{shown_here}. Method and limits of the model: sheet About.",
        )
        for fact in facts:
            self.sheet.write_string(self.row, 0, fact, self.book.format("quiet"))
            self._end_row()

    def signature(self) -> None:
        """Write the line on which a review is signed, blank, with room above it."""
        self._end_row()
        self.sheet.write_string(self.row, 0, _SIGNED, self.book.format("text"))
        self._end_row()


def _targets(data: ReportData) -> dict[str, str]:
    """Return the cells to which topics lead: sheets of their own, and the changes that a sentence tells first."""
    levers = shown_levers(data.levers)
    places, first = lever_places(levers), {CHANGE: "meet", RELAX: "relax", LENGTH: "relax"}
    targets = {FINDINGS: f"{FINDINGS}!A1", CLASSES: f"{ALLOCATED}!A1", DRIVE: f"{DRIVE_SHEET}!A1"}
    for topic, direction in first.items():
        for variant in levers.filter(levers["direction"] == direction)["variant"].head(1):
            targets[topic] = f"{LEVERS}!A{places[variant] + 1}"
    return targets


def _verdict_figure(verdict: Verdict, rule: str, counts: Counter[str]) -> tuple[str, str, str]:
    """Return how many have a verdict, its rule and what colours it; with ? where some of them are not settled."""
    doubtful = counts[f"{verdict}{UNSETTLED}"]
    count = counts[verdict] + doubtful
    mark = UNSETTLED if doubtful else ""
    doubt = f"; {grouped(doubtful)} not settled" if doubtful else ""
    return (
        f"{grouped(count)} {verdict_verb(verdict, count)}{mark}",
        f"{rule}{doubt}",
        f"{verdict}{mark}" if count else "",
    )


def _fitted(label: str, width: float) -> str:
    """Return a name on one line of a cell so many digits wide, its start and its end where it is longer."""
    if fitted(label, width) == label:
        return label
    start, cut, end = label.partition("…")
    if cut and not end:
        return fitted(label, width)
    if not cut:
        start, end = label[: len(label) // 2], label[len(label) // 2 :]
    while fitted(f"{start}…{end}", width) != f"{start}…{end}":
        start, end = (start[:-1], end) if len(start) > len(end) else (start, end[1:])
    return f"{start}…{end}"


def _glance(value: float, error: float | None) -> str:
    """Return the number format of an angle in four digits, or fewer where its standard error is greater."""
    return decimals_of(max(error or 0.0, glance(value)), "plain")
