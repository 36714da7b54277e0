"""The Allocation table → sentences: how wide the tolerances of a class may be, what that saves, and what limits them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import polars as pl

from flexlash.analysis.run_summary import listed
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.findings import shown, spelled_out

__all__ = ["allocation_lines", "width_words"]

_CLASSES = 2
"""Most classes that the Summary tells of."""

_NAMED = 3
_NAME = 40
_DIGITS = 3

_FINE = 1000.0
"""Micrometres in a millimetre: widths of less are told in them."""

_GRADE = "IT grade"


def allocation_lines(allocation: pl.DataFrame, target_percent: float, most: int = _CLASSES) -> Iterator[str]:
    """Yield for each of the first classes what its tolerances may be; how many classes more there are, last."""
    classes = allocation.partition_by("tolerance_class", maintain_order=True)
    for rows in classes[:most]:
        yield _line(rows, f"{target_percent:.10g} %")
    if (more := len(classes) - most) > 0:
        yield f"{more} more {'class is' if more == 1 else 'classes are'} on Allocation."


def width_words(row: Mapping[str, Any], key: str) -> str:
    """Return a width of a row in words.

    >>> width_words({"unit": "mm", "to_value": 0.057}, "to_value")
    '± 57 µm'
    >>> width_words({"unit": "IT grade", "to_value": 9.0}, "to_value")
    'grade 9'
    """
    value, unit = row[key], row["unit"]
    if unit == _GRADE:
        return f"grade {value:.10g}"
    if unit == "mm" and value < 1:
        return f"± {value * _FINE:.10g} µm"
    return f"± {value:.10g}{'' if unit == '-' else f' {unit}'}"


def _line(rows: pl.DataFrame, target: str) -> str:
    """Return what the tolerances of one class may be."""
    name = shown(rows["tolerance_class"][0], longest=_NAME)
    reason, cost = rows["reason"][0], float(rows["relative_cost"].sum())
    changed = rows.filter(pl.col("to_value").is_not_null() & (pl.col("to_value") != pl.col("from_value"))).to_dicts()
    if rows["to_value"].is_null().all():
        return f"Class {name}: no tolerances keep its variants within their limits: {reason}."
    but = f" Mind: {reason}." if reason else ""
    kept = "every variant" if not reason else "every other variant"
    if not changed:
        return f"Class {name} can have no wider tolerances that keep {target} of units of {kept} within its limit.{but}"
    wider = f"{spelled_out(abs(cost), _DIGITS)} in relative cost"
    told = _changes(changed)
    if cost < 0:
        return f"Class {name} may have {told}: that saves {wider} and keeps {target} of units of {kept} within.{but}"
    return f"Class {name} needs {told} to keep {target} of units of {kept} within: that takes {wider}.{but}"


def _changes(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return which widths change to what, those that change most first."""
    ranked = sorted(rows, key=lambda row: -abs(row["grade_steps"]))
    parts = [
        f"{dimension_words(row['dimension'])} {width_words(row, 'to_value')} instead of {width_words(row, 'from_value')}"
        for row in ranked
    ]
    return listed(parts[:_NAMED], _NAMED, len(parts))
