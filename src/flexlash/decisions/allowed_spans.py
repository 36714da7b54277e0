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
    Between two computed points the backlash is taken to cross the limit once at most.
    """
    spans: list[AllowedSpan] = []
    last: tuple[float, bool] | None = None
    for value, margin in _margins(study, percent, second):
        if margin is None:
            last = None
            continue
        within = margin <= 0
        if last is None or within == last[1]:
            if within and last is not None:
                spans[-1] = replace(spans[-1], high=value)
            elif within:
                spans.append(AllowedSpan(low=value, high=value))
        else:
            end = _crossing(study, percent, second, last[0], value)
            if within:
                spans.append(AllowedSpan(low=value if end is None else end, high=value, low_crosses=True))
            else:
                spans[-1] = replace(spans[-1], high=last[0] if end is None else end, high_crosses=True)
        last = (value, within)
    return spans


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


def _crossing(study: Study, percent: float | None, second: float | None, low: float, high: float) -> float | None:
    """Return where a level crosses the limit between two neighbouring values."""
    return next(
        (
            one.value
            for one in study.crossings
            if one.percent == percent and one.second == second and low <= one.value <= high
        ),
        None,
    )
