"""The Allocation table → sentences: how wide the tolerances of a class may be, and what that saves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import polars as pl

from flexlash.analysis.run_summary import grouped, listed
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.findings import shown, spelled_out

__all__ = ["CLASSES", "allocation_lines", "class_tolerances", "width_words"]

CLASSES = "Tolerance classes"
"""The topic of the sentence that leads to the sheet Allocation."""

_NAMED, _BRIEFLY = 3, 2
"""Most dimensions that a sentence names, and on the Summary."""

_NAME = 40
_DIGITS = 3

_FINE = 1000.0
"""Micrometres in a millimetre: widths of less are told in them."""

_GRADE = "IT grade"


def class_tolerances(allocation: pl.DataFrame | None, target_percent: float) -> Iterator[str]:
    """Yield for the Summary what the tolerances of one class may be: of that which changes most in cost."""
    if allocation is None or allocation.is_empty():
        return
    cost = pl.col("relative_cost").fill_null(0.0).sum().over("tolerance_class").abs()
    first = allocation.with_columns(cost.alias("_cost")).sort("_cost", descending=True, maintain_order=True)
    names = allocation["tolerance_class"].unique(maintain_order=True).to_list()
    rows = allocation.filter(pl.col("tolerance_class") == first["tolerance_class"][0])
    yield _line(
        rows, f"{target_percent:.10g} %", _BRIEFLY, without="; the hidden sheet Allocation lists which stay over"
    )
    if (more := len(names) - 1) > 0:
        yield f"{grouped(more)} more {'class is' if more == 1 else 'classes are'} on the hidden sheet Allocation."


def allocation_lines(allocation: pl.DataFrame, target_percent: float, most: int) -> Iterator[str]:
    """Yield for each of the first classes what its tolerances may be."""
    for rows in allocation.partition_by("tolerance_class", maintain_order=True)[:most]:
        yield _line(rows, f"{target_percent:.10g} %", _NAMED)


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


def _line(rows: pl.DataFrame, target: str, most: int, without: str = "") -> str:
    """Return what the tolerances of one class may be, naming so many; `without` stands for the reason where one is."""
    name = shown(rows["tolerance_class"][0], longest=_NAME)
    reason, cost = rows["reason"][0], float(rows["relative_cost"].sum())
    if rows["to_value"].is_null().all():
        return f"Class {name}: no tolerances keep its variants within their limits{without or f': {reason}'}."
    but = without or f". Note: {reason}" if reason else ""
    kept = f"{target} of units of every {'other ' if reason else ''}variant within"
    changed = rows.filter(pl.col("to_value") != pl.col("from_value")).to_dicts()
    if not changed:
        return f"Class {name} has the widest tolerances that keep {kept}{but}."
    told, amount = _changes(changed, most), f"{spelled_out(abs(cost), _DIGITS)} in relative cost"
    if cost < 0:
        return f"Class {name} may have {told}: that saves {amount} and keeps {kept}{but}."
    return f"Class {name} needs {told} to keep {kept}: that takes {amount}{but}."


def _changes(rows: Sequence[Mapping[str, Any]], most: int) -> str:
    """Return which widths change to what, those that change most first."""
    ranked = sorted(rows, key=lambda row: -abs(row["grade_steps"]))
    return listed([_change(row) for row in ranked[:most]], most, len(ranked))


def _change(row: Mapping[str, Any]) -> str:
    now, then = (width_words(row, key) for key in ("from_value", "to_value"))
    return f"{dimension_words(row['dimension'])} {then} instead of {now}"
