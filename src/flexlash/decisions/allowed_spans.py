"""Which values of a swept dimension keep a share of units within the limit, as spans between points and crossings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from flexlash.decisions.sweep import Study, level_margin

__all__ = ["AllowedSpan", "allowed_spans", "computed_values"]


@dataclass(frozen=True, kw_only=True)
class AllowedSpan:
    """Values from `low` to `high`; whether each end is a crossing, or merely where the computed points end."""

    low: float
    high: float
    low_crosses: bool = False
    high_crosses: bool = False


def allowed_spans(study: Study, percent: float | None, second: float | None = None) -> list[AllowedSpan]:
    """Return the spans of the first dimension in which a level of the backlash is within the limit, rising.

    `percent` is the level's share of units, None for the nominal backlash; `second` the value of the second dimension.
    """
    spans: list[AllowedSpan] = []
    last: tuple[float, bool] | None = None
    for value, margin in _margins(study, percent, second):
        if margin is None:
            last = None
            continue
        within = margin <= 0
        if last is None:
            spans += [AllowedSpan(low=value, high=value)] if within else []
        else:
            _go_on(spans, last, (value, within), _crossings(study, percent, second, last[0], value))
        last = (value, within)
    return spans


def _go_on(spans: list[AllowedSpan], last: tuple[float, bool], now: tuple[float, bool], found: Sequence[float]) -> None:
    """Go on from one point to the next, each a value and whether it is within, by the crossings between them."""
    (before, was_within), (value, within) = last, now
    if was_within != within:
        end = found[0] if found else value if within else before
        if within:
            spans.append(AllowedSpan(low=end, high=value, low_crosses=True))
        else:
            spans[-1] = replace(spans[-1], high=end, high_crosses=True)
        return
    inner = [one for one in found if before < one < value]
    turns = len(inner) > 1
    if within and turns:
        spans[-1] = replace(spans[-1], high=inner[0], high_crosses=True)
        spans.append(AllowedSpan(low=inner[-1], high=value, low_crosses=True))
    elif within:
        spans[-1] = replace(spans[-1], high=value)
    elif turns:
        spans.append(AllowedSpan(low=inner[0], high=inner[-1], low_crosses=True, high_crosses=True))


def computed_values(study: Study, second: float | None = None) -> list[float]:
    """Return the values of the first dimension that were computed, rising."""
    rows = _line(study, second)
    return [value for value, row in rows if row["backlash_arcmin"] is not None]


def _margins(study: Study, percent: float | None, second: float | None) -> list[tuple[float, float | None]]:
    return [(value, level_margin(row, percent)) for value, row in _line(study, second)]


def _line(study: Study, second: float | None) -> Sequence[tuple[float, dict[str, float | None]]]:
    """Return the points with a value of the second dimension by the value of the first, rising, each value once."""
    rows = {
        row[study.first.key]: row
        for row in study.results.iter_rows(named=True)
        if study.second is None or row[study.second.key] == second
    }
    return sorted(rows.items())


def _crossings(study: Study, percent: float | None, second: float | None, low: float, high: float) -> list[float]:
    """Return where a level crosses the limit from one value to its neighbour, rising."""
    return sorted(
        one.value
        for one in study.crossings
        if one.percent == percent and one.second == second and low <= one.value <= high
    )
