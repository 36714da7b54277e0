"""The Sweep sheet: one block for each study and variant, with sentences, charts and a table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from flexlash.analysis.outcome import Outcome
from flexlash.decisions.sweep import Study
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.paper import Listed, print_one_page
from flexlash.report.layout.styles import Book
from flexlash.report.layout.wrapping import LINE_HEIGHT, lines_of, merged_width
from flexlash.report.sweeps.point_table import LAST_COLUMN, SHARE, STRESS, VALUE_WIDTH, WIDTH, write_points
from flexlash.report.sweeps.sweep_charts import SMALLEST, backlash_chart, share_chart
from flexlash.report.sweeps.two_way_table import write_two_way
from flexlash.report.wording.chart_words import ends_of
from flexlash.report.wording.sweep_words import study_sentences, study_title
from flexlash.schema.limit_verdict import VerdictBounds

__all__ = ["MOST_STUDIES", "SHEET", "write_sweep"]

SHEET = "Sweep"
MOST_STUDIES = 40
"""Most studies that are drawn; more can neither be read nor opened quickly."""

_FIRST = 4
"""Row, from 0, of the first block."""

_CHART_ROWS, _HEIGHT = 18, 350
_WIDTHS = (660, 420)
"""Rows that charts take, their height and widths [px]."""

_SHARE_COLUMN = 8
"""Column, from 0, at which the second chart begins."""

_NOTES = (
    "Each point is computed as a submission with its value would be; crossings are computed exactly, not interpolated "
    "between points.",
    "Other dimensions stay as entered; a blank one that is the same as the swept one goes with it.",
)


def write_sweep(book: Book, outcome: Outcome, studies: Sequence[Study], stored: Stored) -> None:
    """Write the sheet, where a study was asked for; the data of its charts are `stored`."""
    if not studies:
        return
    sheet = book.sheet(SHEET)
    sheet.write_string(0, 0, "Parametric studies", book.format("title"))
    sheet.set_row(0, 28)
    sheet.set_column(0, 0, VALUE_WIDTH)
    sheet.set_column(1, LAST_COLUMN, WIDTH)
    for row, note in enumerate(_NOTES, start=1):
        sheet.write_string(row, 0, note, book.format("quiet"))
    if len(studies) > MOST_STUDIES:
        text = f"The first {MOST_STUDIES} of {len(studies):,} studies; flexlash sweep … -o NAME.csv has all points."
        sheet.write_string(3, 0, text, book.format("quiet"))
    blocks = _Blocks(book=book, sheet=sheet, stored=stored, target=outcome.settings.target_percent)
    row, breaks = _FIRST, []
    for number, study in enumerate(studies[:MOST_STUDIES]):
        breaks.append(row)
        row = blocks.write(row, study, number) + 2
    letters = [xl_col_to_name(column) for column in range(LAST_COLUMN + 1, _columns(studies[:MOST_STUDIES]))]
    widths = [VALUE_WIDTH, *[WIDTH] * (LAST_COLUMN + len(letters))]
    listed = Listed(noun="studies", columns=[*[""] * (LAST_COLUMN + 1), *letters])
    ends = [one - 2 for one in breaks[1:]]
    print_one_page(sheet, widths, row - 2, smallest=SMALLEST, ends=ends, listed=listed)


def _columns(studies: Sequence[Study]) -> int:
    """Return how many columns the widest table over two dimensions has, with that of the limit."""
    return max(study.results[study.second.key].n_unique() + 2 if study.second else 0 for study in studies)


@dataclass(frozen=True, kw_only=True)
class _Blocks:
    """Where blocks are written: the data of their charts are `stored`, `target` is the share of units in per cent."""

    book: Book
    sheet: Any
    stored: Stored
    target: float

    def write(self, row: int, study: Study, number: int) -> int:
        """Write the block of the study of a number, from 0, from a row on; return the row below it."""
        title = study_title(study)
        self._write_across(row, title, "section")
        row += 1
        for sentence in study_sentences(study, self.target, self.book.angles):
            self._write_sentence(row, sentence)
            row += 1
        if study.second is not None:
            return write_two_way(self.book, self.sheet, row, study, self.target)
        is_drawn = len(set(study.first.values)) > 1 and study.results["backlash_arcmin"].is_not_null().any()
        top = row + (_CHART_ROWS if is_drawn else 0)
        last = write_points(self.book, self.sheet, top, study, VerdictBounds.of(self.target))
        if is_drawn:
            self._insert_charts(row, study, number, (top + 1, last - 1))
        return last

    def _insert_charts(self, row: int, study: Study, number: int, rows: tuple[int, int]) -> None:
        """Put the charts of a study, whose points stand in these rows, side by side."""
        title = study_title(study)
        chart = backlash_chart(self.book, study, number, self.stored)
        angles = self.book.angles
        nominal = [None if angle is None else angles.of(angle) for angle in study.results["backlash_arcmin"]]
        text = f"{title}: band of 95 % of units, P50, nominal, limit and crossings; "
        text += f"the nominal backlash goes {ends_of(nominal, angles.sign)}"
        self.book.insert(self.sheet, row, 0, chart, size=(_WIDTHS[0], _HEIGHT), text=text)
        chart = share_chart(self.book, study, rows, (SHARE, STRESS))
        text = f"{title}: share of the disk in the backlash, and von Mises stress; "
        text += f"the stress goes {ends_of(study.results['von_mises_MPa'].to_list(), ' MPa')}"
        self.book.insert(self.sheet, row, _SHARE_COLUMN, chart, size=(_WIDTHS[1], _HEIGHT), text=text)

    def _write_across(self, row: int, text: str, look: str) -> None:
        """Write a text across the columns; the name of a variant at its beginning never becomes a formula."""
        self.sheet.merge_range(row, 0, row, LAST_COLUMN, "", self.book.format(look))
        self.sheet.write_string(row, 0, text, self.book.format(look))

    def _write_sentence(self, row: int, sentence: str) -> None:
        """Write a sentence across the columns."""
        self._write_across(row, sentence, "wrap")
        width = merged_width([VALUE_WIDTH, *[WIDTH] * LAST_COLUMN])
        self.sheet.set_row(row, LINE_HEIGHT * lines_of(sentence, width))
