"""The table of a sweep over two dimensions, coloured by the verdict, with the contour of the limit drawn around it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from flexlash.decisions.sweep import Study, percentile_key, sweep_levels
from flexlash.report.layout.axes import axis_over
from flexlash.report.layout.styles import GRID, LINES, PALETTE, Book
from flexlash.report.sweeps.sweep_charts import SMALLEST
from flexlash.report.wording.sweep_words import allowed_words, level_title, shown_level, swept_title
from flexlash.report.wording.verdict import COLOURS, verdict_word
from flexlash.schema.column import Column
from flexlash.schema.columns import columns_of
from flexlash.schema.limit_verdict import VerdictBounds

__all__ = ["write_two_way"]

_CONTOUR = 5
"""Excel's thick border."""

_SIDES = {"top": (-1, 0), "bottom": (1, 0), "left": (0, -1), "right": (0, 1)}
_COLOURS = tuple(colour for colour in LINES if colour != "red")
"""Red is the limit's."""

"""Colours of the lines in the chart; so many values of the second dimension have one."""

_WIDTH, _HEIGHT, _CHART_ROWS = 900, 370, 19
_SMALL = {"name_font": {"size": SMALLEST, "bold": False}, "num_font": {"size": SMALLEST}}
_SCALE = {"type": "3_color_scale", "min_color": "#C6E5D8", "mid_color": "#FFFFFF", "max_color": "#F8CBAD"}


def write_two_way(book: Book, sheet: Any, top: int, study: Study, target: float) -> int:
    """Write the table, below it what is allowed of the first dimension, and a chart; return the row below."""
    if study.second is None:
        raise LookupError("a study over one dimension")
    return _Table(book=book, sheet=sheet, top=top, study=study, second=study.second.key, target=target).written()


@dataclass(frozen=True, kw_only=True)
class _Table:
    """A table whose headings stand in the row `top` and the next one; `target` is the share of units in per cent."""

    book: Book
    sheet: Any
    top: int
    study: Study
    second: str
    target: float

    @cached_property
    def firsts(self) -> list[float]:
        """The values of the first dimension, one a row."""
        return list(dict.fromkeys(self.study.first.values))

    @cached_property
    def seconds(self) -> list[float]:
        """The values of the second dimension, one a column."""
        return list(dict.fromkeys(self.study.results[self.second]))

    @cached_property
    def cells(self) -> list[list[dict[str, Any]]]:
        """The points, row by row."""
        points = {
            (point[self.study.first.key], point[self.second]): point
            for point in self.study.results.iter_rows(named=True)
        }
        return [[points[value, second] for second in self.seconds] for value in self.firsts]

    @cached_property
    def bounds(self) -> VerdictBounds:
        """The shares over the limit that verdicts allow."""
        return VerdictBounds.of(self.target)

    @property
    def limit(self) -> float | None:
        """The limit in the unit of angles."""
        return None if self.study.limit is None else self.book.angles.of(self.study.limit)

    @property
    def level(self) -> float:
        """The level that the cells show."""
        return shown_level(self.target)

    @property
    def key(self) -> str:
        """The column of Results that holds it."""
        return str(percentile_key(self.level))

    @property
    def rows(self) -> tuple[int, int]:
        """The first and the last row of the cells."""
        return self.top + 2, self.top + 1 + len(self.firsts)

    def written(self) -> int:
        """Write everything; return the row below it."""
        self._write_headings()
        self._write_cells()
        row = self.rows[1] + 1
        if self.study.limit is not None:
            row = self._write_allowed(row)
        numbers = [self.book.angles.of(angle) for angle in self.study.results[self.key].drop_nulls()]
        if len(self.firsts) == 1 or not numbers:
            return row
        title, first, second = level_title(self.level), swept_title(self.study.first.key), swept_title(self.second)
        sign = self.book.angles.sign
        text = f"{title} over {first}, a line for each {second}: "
        text += f"between {min(numbers):.4g} and {max(numbers):.4g}{sign}"
        self.book.insert(self.sheet, row + 1, 0, self._chart(numbers), size=(_WIDTH, _HEIGHT), text=text)
        return row + 1 + _CHART_ROWS

    def _write_headings(self) -> None:
        header, width = self.book.format("header"), len(self.seconds)
        text = f"{level_title(self.level)} [{self.book.angles.name}] at {swept_title(self.second)}"
        if width > 1:
            self.sheet.merge_range(self.top, 1, self.top, width, text, header)
        else:
            self.sheet.write_string(self.top, 1, text, header)
        self.sheet.write_row(self.top + 1, 0, [swept_title(self.study.first.key), *self.seconds], header)
        self.sheet.set_row(self.top + 1, 32)
        if self.study.limit is not None:
            self.sheet.write_string(self.top + 1, width + 1, f"Limit [{self.book.angles.name}]", header)

    def _write_cells(self) -> None:
        """Write the numbers, each in the colour of its verdict; without a limit by how great they are."""
        first, last = self.rows
        for row, (value, points) in enumerate(zip(self.firsts, self.cells, strict=True)):
            self.sheet.write_number(first + row, 0, value, self.book.format("label", "general"))
            for column, point in enumerate(points):
                look = self.book.workbook.add_format(self._look(row, column))
                if point[self.key] is None:
                    self.sheet.write_string(first + row, column + 1, "–", look)
                else:
                    self.sheet.write_number(first + row, column + 1, self.book.angles.of(point[self.key]), look)
            if self.limit is not None:
                quiet = self.book.format("quiet", "general")
                self.sheet.write_number(first + row, len(self.seconds) + 1, self.limit, quiet)
        if self.study.limit is None:
            self.sheet.conditional_format(first, 1, last, len(self.seconds), _SCALE)

    def _look(self, row: int, column: int) -> dict[str, Any]:
        """Return the format of a cell, with the contour where a neighbour is on the other side of it."""
        point = self.cells[row][column]
        look = self.book.properties(COLOURS[verdict_word(point, self.bounds)]) | {
            "align": "center",
            "num_format": self.book.angles.decimals(3),
        }
        meets = self._meets(point)
        for side, (down, right) in _SIDES.items():
            beside, along = row + down, column + right
            if 0 <= beside < len(self.firsts) and 0 <= along < len(self.seconds):
                other = self._meets(self.cells[beside][along])
                if None not in {meets, other} and meets != other:
                    look |= {side: _CONTOUR, f"{side}_color": PALETTE["ink"]}
        return look

    def _meets(self, point: dict[str, Any]) -> bool | None:
        """Return whether a point meets its limit, None where it has no number or no limit."""
        over = point["probability_over_limit"]
        return None if over is None else not self.bounds.misses(over)

    def _write_allowed(self, row: int) -> int:
        """Write below each column which values of the first dimension are allowed; return the row below."""
        unit = columns_of("Variants")[self.study.first.key].unit_behind.strip()
        for level in sweep_levels(self.target):
            text = f"{level_title(level)} within limit at{f' [{unit}]' if unit else ''}"
            self.sheet.write_string(row, 0, text, self.book.format("quiet"))
            for column, second in enumerate(self.seconds, start=1):
                words = allowed_words(self.study, level, second)
                self.sheet.write_string(row, column, words, self.book.format("small figure"))
            row += 1
        return row

    def _chart(self, numbers: Sequence[float]) -> Any:
        """Return the level over the first dimension, a line for each of some values of the second one."""
        second: Column = columns_of("Variants")[self.second]
        chart = self.book.chart(
            "scatter", f"{level_title(self.level)} of the backlash", subtype="straight_with_markers"
        )
        count, last = min(len(_COLOURS), len(self.seconds)), len(self.seconds) - 1
        places = dict.fromkeys(round(number * last / max(1, count - 1)) for number in range(count))
        for colour, place in zip(_COLOURS, places, strict=False):
            ink = {"color": PALETTE[colour]}
            label = f"{second.plain_name} {self.seconds[place]:.10g}{second.unit_behind}"
            marker = {"type": "circle", "size": 4, "fill": ink, "border": ink}
            chart.add_series({**self._series(place + 1, label), "line": {**ink, "width": 1.75}, "marker": marker})
        limit = self.limit
        if limit is not None:
            look = {"line": {"color": PALETTE["red"], "width": 2, "dash_type": "dash"}, "marker": {"type": "none"}}
            chart.add_series(
                {**self._series(len(self.seconds) + 1, f"Limit {limit:.6g}{self.book.angles.sign}"), **look}
            )
        below = axis_over(self.firsts)
        ends = {"min": below.low, "max": below.high, "major_unit": below.step, "major_gridlines": {"visible": False}}
        name = swept_title(self.study.first.key)
        chart.set_x_axis({**_SMALL, **ends, "name": name, "num_format": "General"})
        axis = axis_over([*numbers, *([] if limit is None else [limit])])
        name = f"Backlash [{self.book.angles.name}]"
        chart.set_y_axis({**axis.options(), **_SMALL, "name": name, "major_gridlines": GRID})
        chart.set_legend({"position": "right", "font": {"size": SMALLEST}})
        return chart

    def _series(self, column: int, name: str) -> dict[str, Any]:
        first, last = self.rows
        places = {"categories": [self.sheet.name, first, 0, last, 0]}
        return {"name": name, **places, "values": [self.sheet.name, first, column, last, column]}
