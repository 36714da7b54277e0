"""What the charts of sweeps draw: the course between the points on an even grid, stored on a sheet behind them.

Charts whose areas can be filled have categories, not numbers, below: only an even grid of them puts every value where
it belongs. Between two computed points each level goes straight, as a line through the points does.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from flexlash.decisions.sweep import Study
from flexlash.report.formula.stored import Row, Stored
from flexlash.schema.angle_unit import AngleUnit

__all__ = ["LEVELS", "SWEPT", "SWEPT_NOTE", "Grid", "crossing_heading", "grid_of", "heading_of", "stored_sweeps"]

SWEPT = "Swept"
SWEPT_NOTE = "Stored curve of each level of each sweep, behind its chart; straight between two computed points."

LEVELS = {"P2.5": "p2_5_arcmin", "P50": "p50_arcmin", "P97.5": "p97_5_arcmin", "P99.865": "p99_865_arcmin"}
"""The levels that are drawn, with their columns of Results."""

_POINTS = 120
"""About how many places a grid has."""

_LABELS = 10
"""About how many labels an axis has."""

_EVEN = 1e-9


@dataclass(frozen=True, kw_only=True)
class Grid:
    """Even places from the least value to the greatest; every `labelled` one has a label below the axis.

    The others have none as a text: LibreOffice does not know how often a label is wanted.
    """

    places: Sequence[float]
    labelled: int


def grid_of(study: Study) -> Grid:
    """Return the grid of a study over at least two values: its points are on it where they are even themselves."""
    values = sorted(set(study.first.values))
    steps = [high - low for low, high in pairwise(values)]
    span, count = values[-1] - values[0], len(steps)
    is_even = max(steps) - min(steps) <= _EVEN * span
    each = max(1, _POINTS // count) if is_even else 1
    total = count * each if is_even else _POINTS
    labelled = each * math.ceil(count / _LABELS) if is_even else _POINTS // _LABELS
    places = [float(f"{values[0] + span * place / total:.12g}") for place in range(total + 1)]
    return Grid(places=places, labelled=labelled)


def heading_of(number: int, what: str) -> str:
    """Return the heading of a column of the study of a number, from 0."""
    return f"{number + 1} {what}"


def crossing_heading(percent: float | None) -> str:
    """Return what a column of crossings is called."""
    return "nominal crosses" if percent is None else f"P{percent:.10g} crosses"


def stored_sweeps(studies: Sequence[Study], angles: AngleUnit) -> Stored:
    """Return the data sheet of the studies that are drawn, each with columns of its own."""
    columns: dict[str, Sequence[str | float | None]] = {}
    for number, study in enumerate(studies):
        if study.second is None and len(set(study.first.values)) > 1:
            for what, values in _columns(study, angles):
                columns[heading_of(number, what)] = values
    longest = max(map(len, columns.values()), default=0)
    rows: list[Row] = [
        {heading: values[place] if place < len(values) else None for heading, values in columns.items()}
        for place in range(longest)
    ]
    return Stored(SWEPT, rows)


def _columns(study: Study, angles: AngleUnit) -> Iterator[tuple[str, Sequence[str | float | None]]]:
    """Yield the columns of a study: its grid, what is stacked, the lines and the marks."""
    grid = grid_of(study)
    places = grid.places
    points = {row[study.first.key]: row for row in study.results.iter_rows(named=True)}
    course = {
        name: [None if angle is None else angles.of(angle) for angle in _along(points, key, places)]
        for name, key in (*LEVELS.items(), ("Nominal", "backlash_arcmin"))
    }
    yield "value", places
    yield "label", [f"{value:.10g}" if place % grid.labelled == 0 else "" for place, value in enumerate(places)]
    base = _without_gaps(course["P2.5"])
    yield "P2.5", base
    for low, high in (("P2.5", "P97.5"), ("P97.5", "P99.865")):
        yield f"{low} to {high}", [_between(*ends) for ends in zip(course[low], course[high], strict=True)]
    yield "P50", course["P50"]
    yield "Nominal", course["Nominal"]
    nearest = {_nearest(places, value) for value, row in points.items() if row["p50_arcmin"] is not None}
    yield "points", [value if place in nearest else None for place, value in enumerate(course["P50"])]
    limit = None if study.limit is None else angles.of(study.limit)
    if limit is not None:
        yield "Limit", [limit] * len(places)
    for percent in dict.fromkeys(one.percent for one in study.crossings):
        marked = {_nearest(places, one.value) for one in study.crossings if one.percent == percent}
        yield crossing_heading(percent), [limit if place in marked else None for place in range(len(places))]


def _along(points: dict[float, dict[str, Any]], key: str, places: Sequence[float]) -> list[float | None]:
    """Return a level at the places, None where a neighbouring point has no number."""
    values = sorted(points)
    found: list[float | None] = []
    upper = 1
    for place in places:
        while upper < len(values) - 1 and place > values[upper]:
            upper += 1
        low, high = values[upper - 1], values[upper]
        at_low, at_high = points[low][key], points[high][key]
        part = (place - low) / (high - low)
        if part <= _EVEN or part >= 1 - _EVEN:
            found.append(at_low if part <= _EVEN else at_high)
        else:
            found.append(None if at_low is None or at_high is None else at_low + part * (at_high - at_low))
    return found


def _without_gaps(values: Sequence[float | None]) -> list[float | None]:
    """Return the values with each gap filled by its neighbour, since an area without a number falls to 0."""
    known = next((value for value in values if value is not None), None)
    filled = []
    for value in values:
        known = value if value is not None else known
        filled.append(known)
    return filled


def _between(low: float | None, high: float | None) -> float:
    return 0.0 if low is None or high is None else high - low


def _nearest(places: Sequence[float], value: float) -> int:
    span = places[-1] - places[0]
    return round((value - places[0]) / span * (len(places) - 1))
