"""The data sheet Bars: how far each variant's percentiles are from its limit, in per cent of it, for one chart."""

from __future__ import annotations

from collections.abc import Sequence

from flexlash.report.formula.stored import Stored
from flexlash.report.report_data import Drawn
from flexlash.report.wording.labels import distinct_labels
from flexlash.report.wording.verdict import NO_VERDICT
from flexlash.schema.limit_verdict import VERDICTS, VerdictBounds

__all__ = ["BARS_NOTE", "KINDS", "relative_bars", "scale_end"]

BARS_NOTE = (
    "Behind the chart of the Summary: percentiles less the limit, in per cent of the limit; of variants without any "
    "limit less the median, in per cent of it. Beyond the chart's scale stand its end and the figure."
)
KINDS = (*reversed(VERDICTS), NO_VERDICT)
"""Columns of medians by verdict, the worst first."""

_REACHES = (1.0, 2.0, 5.0, 10.0)
"""Ends [%] that the scale may have, unless a spread is wider."""

_FEW, _LABEL, _SHORT = 12, 24, 16
"""Most characters of a name under the chart, of more than a few variants, whose names stand upright, less."""


def relative_bars(drawn: Sequence[Drawn], bounds: VerdictBounds, most: int) -> Stored:
    """Return the bars of the worst variants that have a limit, or, where none has one, about their medians."""
    limited = [one for one in drawn if one.row["backlash_limit_arcmin"] is not None]
    shown = (limited or list(drawn))[:most]
    names = [one.row["variant"] for one in shown]
    labels = distinct_labels(names, _LABEL if len(names) <= _FEW else _SHORT)
    reach = scale_end(shown)
    rows = [_entries(one, label, bounds, reach) for one, label in zip(shown, labels, strict=True)]
    return Stored("Bars", rows)


def scale_end(drawn: Sequence[Drawn]) -> float:
    """Return where the scale ends [%]: where all bars do, unless variants are far off and the spread would not show."""
    limited = [one for one in drawn if one.row["backlash_limit_arcmin"] is not None]
    figures = [_percents(one) for one in limited or drawn]
    farthest = max((abs(figure) for low, _, _, top in figures for figure in (low, top)), default=0.0)
    widest = max((top - low for low, _, _, top in figures), default=0.0)
    least = min(farthest, max(_REACHES[-1], 1.5 * widest))
    power = next((reach for reach in _REACHES if reach >= least), None)
    return power or float(10 * -(-least // 10))


def _percents(one: Drawn) -> tuple[float, float, float, float]:
    """Return P2.5, P50, P97.5 and P99.865 less the limit or, without one, the median, in per cent of it."""
    base = one.row["backlash_limit_arcmin"] or one.row["p50_arcmin"]
    low, median, high, top = (
        100 * (one.row[f"{key}_arcmin"] / base - 1) for key in ("p2_5", "p50", "p97_5", "p99_865")
    )
    return low, median, high, top


def _entries(one: Drawn, label: str, bounds: VerdictBounds, reach: float) -> dict[str, str | float | None]:
    """Return a variant's headings and values in order; what is beyond the scale stands at its end."""
    low, median, high, top = _percents(one)
    verdict = bounds.verdict(one.row["probability_over_limit"]) or NO_VERDICT
    inside = -reach <= median <= reach
    return {
        "Variant": one.row["variant"],
        "Label": label,
        **{kind: median if kind == verdict and inside else None for kind in KINDS},
        "down": median - max(low, -reach) if inside else 0.0,
        "up": min(high, reach) - median if inside else 0.0,
        "P99.865": top if inside and top <= reach else None,
        "above": reach if median > reach else None,
        "below": -reach if median < -reach else None,
        "off": round(median, 1) if not inside else None,
    }
