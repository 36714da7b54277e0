"""The Summary sheet: one printed page that says what was found, in words, numbers and one chart."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from flexlash.analysis.outcome import Outcome
from flexlash.analysis.run_summary import counted, points_words
from flexlash.report.extent import extent_of
from flexlash.report.failing.failing_places import variant_targets
from flexlash.report.formula.live import Live, fill
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.links import write_link
from flexlash.report.layout.styles import Book
from flexlash.report.layout.wrapping import LINE_HEIGHT, fitted, lines_of, merged_width
from flexlash.report.report_data import ROW, Drawn, ReportData
from flexlash.report.summary.relative_bars import scale_end
from flexlash.report.summary.summary_chart import CHARTED, chart_words, variants_chart
from flexlash.report.summary.summary_links import topic_targets
from flexlash.report.summary.summary_table import WIDTHS, SummaryTable
from flexlash.report.wording.review_sentences import COMPARED
from flexlash.report.wording.sentences import sentences
from flexlash.report.wording.summary_facts import labels_of
from flexlash.report.wording.sweep_words import summary_sentence
from flexlash.report.wording.verdict import (
    COLOURS,
    NO_VERDICT,
    UNSETTLED,
    verdict_counts,
    verdict_rules,
    verdict_verb,
)
from flexlash.schema.angle_unit import ANGLE_UNITS
from flexlash.schema.findings import shown
from flexlash.schema.limit_verdict import VERDICTS, Verdict
from flexlash.schema.number_words import grouped

__all__ = ["write_summary"]

_LISTED = (3, 12)
"""Fewest and most variants in the table."""

_FIGURES = ((0, 0), (1, 4), (5, 7), (8, 9), (10, 11))
"""First and last column of each key figure."""

_UNIT = (1, 11)
"""Row and column, from 0, of the cell that names the unit of angles."""

_PAGE = 1085.0
"""Height [pt] of what fits on a Letter page in letters of 7 pt; A4 is higher."""

_CHART, _USUAL_CHART = (185.0, 340.0), 215.0
"""Least and greatest height [pt] of the chart, and what the table leaves it where sentences are not too long."""

_CHART_WIDTH = sum(7 * width + 5 for width in WIDTHS)
_LINES = 5
"""Lines below the chart: provenance, and one to sign above which there is room to write."""

_SIGNED = "Reviewed by ______________________________   Date ____________________"


def write_summary(book: Book, outcome: Outcome, data: ReportData, bars: Stored) -> Live | None:
    """Write the Summary sheet; its chart draws on the data sheet of the bars.

    Return the cell that names the unit of angles, for other sheets that follow it; None where nothing was computed.
    """
    page = _Page(book, outcome)
    page.heading()
    said = dict(sentences(outcome, data.levers, data.allocation))
    said["Sweep"] = summary_sentence(data.studies, outcome.settings.target_percent, book.angles)
    targets = topic_targets(book, outcome, data)
    page.sentence(COMPARED, said.pop(COMPARED, ""), targets)
    page.key_figures()
    for topic, text in said.items():
        page.sentence(topic, text, targets)
    unit = None
    if data.drawn:
        unit = page.unit()
        page.table(data.drawn, unit)
        page.chart(data.drawn, bars)
    page.provenance()
    page.signature()
    page.sheet.print_area(0, 0, page.row - 1, len(WIDTHS) - 1)
    page.sheet.activate()
    return unit and Live(f"Summary!{unit.text}", unit.value)


class _Page:
    """The sheet as it grows: the next row, and how high what stands above it is [pt]."""

    def __init__(self, book: Book, outcome: Outcome) -> None:
        self.book = book
        self.outcome = outcome
        self.sheet = book.sheet("Summary", landscape=False, pages_tall=1)
        for column, width in enumerate(WIDTHS):
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

    def key_figures(self) -> None:
        """Write how many were computed, have which verdict by which rule, and how much was found."""
        self._end_row(6)
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
            lines = max(lines, lines_of(caption, merged_width(WIDTHS[first : last + 1])))
        self._end_row(lines * LINE_HEIGHT)
        self._end_row(8)

    def sentence(self, topic: str, text: str, targets: Mapping[str, str]) -> None:
        """Write the answer to a question, if there is one, beside it, wrapped; a topic with a target leads there."""
        if not text:
            return
        if topic in targets:
            write_link(self.sheet, self.row, 0, targets[topic], topic, style=self.book.format("topic link"))
        else:
            self.sheet.write_string(self.row, 0, topic, self.book.format("topic"))
        self._across(1, len(WIDTHS) - 1, text, self.book.format("said"))
        self._end_row(LINE_HEIGHT * lines_of(text, merged_width(WIDTHS[1:])) + 2)

    def unit(self) -> Live:
        """Write the cell that names the unit of angles, which the reader may change, with its label."""
        row, column = _UNIT
        self.sheet.write_string(row, column - 1, "Angles in ►", self.book.format("label"))
        cell = fill(self.sheet, row, column, self.book.angles.name, self.book.format("input"))
        self.sheet.data_validation(row, column, row, column, {
            "validate": "list",
            "source": list(ANGLE_UNITS),
            "input_title": "Unit of angles",
            "input_message": "The table below and the Explorer follow. All else is in "
            f"{self.book.angles.name}, by the setting angle_unit; the columns of Results keep their units.",
            "error_title": "Unit of angles",
            "error_message": "arcmin or arcsec, nothing else.",
        })  # fmt: skip
        return cell

    def table(self, drawn: Sequence[Drawn], unit: Live) -> None:
        """Write as many of the worst variants as the page has room for, each leading to its page or to Explorer."""
        self._end_row(8)
        table = SummaryTable(self.book, self.sheet, self.outcome.settings.verdict_bounds, unit)
        table.write_headings(self.row)
        self._end_row(3 * LINE_HEIGHT + 2)
        targets = variant_targets(drawn, self.outcome.settings.verdict_bounds)
        labels = labels_of(self.outcome, [variant.row["variant"] for variant in drawn])
        room = _PAGE - self.height - _USUAL_CHART - (_LINES + 5) * LINE_HEIGHT
        listed, first = drawn[: max(_LISTED[0], min(_LISTED[1], int(room / LINE_HEIGHT)))], self.row
        for variant in listed:
            name = _fitted(labels[variant.row["variant"]], merged_width(WIDTHS[:1]))
            target = targets[variant.row[ROW]]
            self._end_row(LINE_HEIGHT * table.write(self.row, variant.row, name, target))
        table.finish(first, self.row - 1)
        self._notes(len(listed), drawn)
        self._further()

    def _notes(self, listed: int, drawn: Sequence[Drawn]) -> None:
        """Write what the table lists and what its columns say."""
        extent = extent_of(self.outcome)
        more = f"The {listed} worst of {grouped(extent.total)} are listed; {extent.elsewhere}. "
        is_judged = any(one.row["backlash_limit_arcmin"] is not None for one in drawn)
        order = "share over the limit" if is_judged else "P99.865"
        note = f"Worst first: by {order}. The verdict judges the backlash alone, over the units of all lots."
        columns = (
            "Beside the computed percentiles: mean + 3 sd by first order (RSS), and every dimension at its worst "
            "limit; by normal theory: from mean and sd alone."
        )
        for text in ((more if len(drawn) > listed else "") + note, columns):
            self.sheet.write_string(self.row, 0, text, self.book.format("quiet"))
            self._end_row()

    def _further(self) -> None:
        """Write where a variant can be looked into, with links to these sheets."""
        link = self.book.format("link")
        self.sheet.write_string(self.row, 0, "Pick a variant in", self.book.format("figure"))
        write_link(self.sheet, self.row, 1, "Explorer!A1", "Explorer", style=link)
        if self.book.shows("Trace"):
            write_link(self.sheet, self.row, 2, "Trace!A1", "or Trace", style=link)
        self.sheet.write_string(self.row, 3, "to look into it further.", self.book.format("text"))
        self._end_row()

    def chart(self, drawn: Sequence[Drawn], bars: Stored) -> None:
        """Draw the chart as high as the page has room."""
        self._end_row(8)
        least, greatest = _CHART
        height = min(greatest, max(least, _PAGE - self.height - (_LINES + 1) * LINE_HEIGHT))
        rows = math.ceil(height / LINE_HEIGHT)
        size = (round(_CHART_WIDTH), round(rows * LINE_HEIGHT / 0.75) - 4)
        chart = variants_chart(self.book, bars, scale_end(drawn[:CHARTED]), extent_of(self.outcome).total)
        self.book.insert(self.sheet, self.row, 0, chart, size=size, text=chart_words(drawn, self.book.angles))
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
