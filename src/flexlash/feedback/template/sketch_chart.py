"""A drawing as a chart of lines: vector in every program that shows charts, and kept by those that save workbooks."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, TypeAlias

from flexlash.mechanics.sketch.drawing_marks import LETTER, Area, Drawing, Label, Point, Stroke, hatching

__all__ = ["drawn_chart"]

_FIRST_COLUMN = 40
"""Column of the sheet Lists behind all lists, from which on the points of charts stand."""

_LETTERS = 9.5
"""Size of words [pt], just short of what LibreOffice breaks into two lines."""

_CORNER = math.radians(20)
"""By how much a line turns at a corner at least."""

_SIDES = {"start": "right", "end": "left", "middle": "center"}
"""Where words stand beside their point, by the end of theirs that lies there."""

_Look: TypeAlias = tuple[str, float, bool]


def drawn_chart(workbook: Any, lists: Any, name: str, drawing: Drawing) -> Any:
    """Return a chart that shows a drawing in its size; its points are written into columns of the sheet `lists`.

    Lines end at their corners, and the next begins in another series, since openpyxl forgets that lines are not smooth
    and LibreOffice joins what meets. Words are names of series, since openpyxl forgets labels of other words.
    """
    chart = workbook.add_chart({"type": "scatter", "subtype": "straight"})
    points = _Points(lists, name, drawing.height)
    for (colour, width, dashed), strokes in _strokes(drawing).items():
        line = {"color": colour, "width": width} | ({"dash_type": "long_dash_dot"} if dashed else {})
        runs = [_runs(stroke.points) for stroke in strokes]
        for turn in (0, 1):
            some = [run for of_one in runs for run in of_one[turn::2]]
            if some:
                chart.add_series({**points.written(some), "line": line, "marker": _NONE})
    for label in (mark for mark in drawing.marks if isinstance(mark, Label)):
        font = {"name": "Calibri", "size": _LETTERS, "color": label.colour}
        words = {"series_name": True, "position": _SIDES[label.anchor], "font": font}
        place = points.written([[(label.x, label.y - LETTER / 3)]])
        series = {"name": label.words, "line": {"none": True}, "marker": _NONE, "data_labels": words}
        chart.add_series({**place, **series})
    _plain(chart, drawing)
    return chart


_NONE = {"type": "none"}


def _runs(line: Sequence[Point]) -> list[list[Point]]:
    """Return a line in runs that end at its corners."""
    runs = [[line[0]]]
    for before, at, after in zip(line, line[1:], line[2:], strict=False):
        runs[-1].append(at)
        if _turn(before, at, after) > _CORNER:
            runs.append([at])
    runs[-1].append(line[-1])
    return runs


def _turn(before: Point, at: Point, after: Point) -> float:
    """Return by how much a line turns at a point [rad]."""
    (x1, y1), (x2, y2) = ((end[0] - start[0], end[1] - start[1]) for start, end in ((before, at), (at, after)))
    return abs(math.atan2(x1 * y2 - y1 * x2, x1 * x2 + y1 * y2))


def _plain(chart: Any, drawing: Drawing) -> None:
    """Leave nothing of a chart but its lines, one unit of both axes as long as a pixel."""
    for axis, most in ((chart.set_x_axis, drawing.width), (chart.set_y_axis, drawing.height)):
        axis({"min": 0, "max": round(most), "visible": False, "major_gridlines": {"visible": False}})
    chart.set_legend({"none": True})
    chart.set_chartarea({"border": {"none": True}, "fill": {"color": "#FFFFFF"}})
    chart.set_plotarea({"layout": {"x": 0.0, "y": 0.0, "width": 1.0, "height": 1.0}})
    chart.set_size({"width": round(drawing.width), "height": round(drawing.height)})


class _Points:
    """Columns of points on a sheet, two for each series; a blank row parts two lines."""

    def __init__(self, sheet: Any, name: str, height: float) -> None:
        self.sheet = sheet
        self.height = height
        self.name = name

    def written(self, lines: Sequence[Sequence[Point]]) -> Mapping[str, Any]:
        """Write lines into the next two columns; return where they stand."""
        column = max(_FIRST_COLUMN, self.sheet.dim_colmax + 1)
        self.sheet.write_string(0, column, f"sketch of a {self.name}")
        row = 1
        for line in lines:
            for x, y in line:
                self.sheet.write_number(row, column, round(x, 2))
                self.sheet.write_number(row, column + 1, round(self.height - y, 2))
                row += 1
            row += 1
        return {
            "categories": ["Lists", 1, column, row - 2, column],
            "values": ["Lists", 1, column + 1, row - 2, column + 1],
        }


def _strokes(drawing: Drawing) -> dict[_Look, list[Stroke]]:
    """Return the lines of a drawing by their look, those of areas with them."""
    found: dict[_Look, list[Stroke]] = {}
    for stroke in _all_strokes(drawing):
        found.setdefault((stroke.colour, stroke.width, stroke.dashed), []).append(stroke)
    return found


def _all_strokes(drawing: Drawing) -> Iterator[Stroke]:
    for mark in drawing.marks:
        if isinstance(mark, Stroke):
            yield mark
        elif isinstance(mark, Area):
            yield from hatching(mark)
            if not mark.hatch:
                yield Stroke(points=(*mark.points, mark.points[0]), colour=mark.fill)
