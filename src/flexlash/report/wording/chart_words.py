"""Alternative texts: what a chart shows, in numbers, for whoever hears the report instead of seeing it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from flexlash.report.report_data import Drawn
from flexlash.schema.angle_unit import AngleUnit
from flexlash.schema.findings import shown

__all__ = ["ends_of", "largest_of", "limits_over", "medians_of", "named_shares", "spans_of"]

_TOLD = 3
"""Most variants, dimensions or segments that a text names."""

_NAME = 40


def _number(value: float) -> str:
    return f"{value:.4g}"


def _some(parts: Sequence[str], of: int | None = None) -> str:
    """Return the first of some parts, and how many more there are."""
    more = (len(parts) if of is None else of) - min(len(parts), _TOLD)
    return "; ".join(parts[:_TOLD]) + (f"; and {more} more" if more else "")


def spans_of(drawn: Sequence[Drawn], angles: AngleUnit) -> str:
    """Return what 95 % of units have, the median and the limit, of the first variants by name."""
    return _some([_span(variant.row, angles) for variant in drawn[:_TOLD]], len(drawn))


def _span(row: Mapping[str, Any], angles: AngleUnit) -> str:
    low, middle, high, limit = (
        row.get(key) for key in ("p2_5_arcmin", "p50_arcmin", "p97_5_arcmin", "backlash_limit_arcmin")
    )
    name = shown(row["variant"], longest=_NAME)
    if low is None or middle is None or high is None:
        return f"{name}, without a spread"
    low, middle, high = (_number(angles.of(angle)) for angle in (low, middle, high))
    told = f"{name} from {low} to {high}{angles.sign}, median {middle}{angles.sign}"
    return told + ("" if limit is None else f", limit {_number(angles.of(limit))}{angles.sign}")


def limits_over(drawn: Sequence[Drawn]) -> str:
    """Return how many variants have more than 2.5 % of units over their limit, as a sentence."""
    limits = [(row, row.get("backlash_limit_arcmin")) for row in (variant.row for variant in drawn)]
    limited = [(row, limit) for row, limit in limits if limit is not None]
    if not limited:
        return "None has a limit."
    over = sum((row.get("p97_5_arcmin") or 0.0) > limit for row, limit in limited)
    which = f"{over or 'none'} of {len(limited)} with a limit"
    return f"More than 2.5 % of units are over it for {which}."


def medians_of(drawn: Sequence[Drawn], angles: AngleUnit) -> str:
    """Return how far the middle half of the units of the first variants lies from their median."""
    told = []
    for row in (variant.row for variant in drawn[:_TOLD]):
        low, middle, high = (row.get(key) for key in ("p2_5_arcmin", "p50_arcmin", "p97_5_arcmin"))
        if low is not None and middle is not None and high is not None:
            below, above = (float(f"{angles.of(end - middle):.2g}") for end in (low, high))
            width = f"{below:+.15g} to {above:+.15g}{angles.sign}"
            told.append(f"{shown(row['variant'], longest=_NAME)} {width} for 95 % of units")
    return _some(told, len(drawn))


def largest_of(numbers: Mapping[str, float], unit: str = "", *, per_cent: bool = False) -> str:
    """Return the greatest of some named numbers, the first first.

    >>> largest_of({"wall": 2.6, "disk": 1.5, "rim": 0.0}, "′"), largest_of({"wall": 0.25}, per_cent=True)
    ('wall 2.6′; disk 1.5′; rim 0′', 'wall 25 %')
    """
    ordered = sorted(numbers.items(), key=lambda item: -abs(item[1]))
    scale, behind = (100.0, " %") if per_cent else (1.0, unit)
    return _some([f"{shown(name, longest=_NAME)} {_number(scale * value)}{behind}" for name, value in ordered])


def named_shares(drawn: Sequence[Drawn], key: str) -> str:
    """Return the least and the greatest of a share of Results with their variants; empty where none has it."""
    known = sorted((variant.row[key], variant.row["variant"]) for variant in drawn if variant.row.get(key))
    if not known:
        return ""
    ends = [known[0], known[-1]] if len(known) > 1 else known
    return " to ".join(f"{100 * share:.3g} % ({shown(name, longest=_NAME)})" for share, name in ends)


def ends_of(numbers: Sequence[float | None], unit: str) -> str:
    """Return from where to where numbers go in their order; what is not known is left out.

    >>> ends_of([2.897, None, 4.214], "′"), ends_of([None], "′")
    ('from 2.897 to 4.214′', 'unknown')
    """
    known = [number for number in numbers if number is not None]
    if not known:
        return "unknown"
    return f"from {_number(known[0])} to {_number(known[-1])}{unit}"
