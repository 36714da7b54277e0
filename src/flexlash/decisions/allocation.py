"""Allocation: for each class that a variant with a limit names, what its tolerances may be at least relative cost."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import polars as pl

from flexlash.analysis.computed import Computed
from flexlash.analysis.options import Options
from flexlash.decisions.changed_rows import limits_as_submitted
from flexlash.decisions.class_allocation import Allocation, allocated, cost_of
from flexlash.decisions.class_widths import ClassWidth, Member, class_widths
from flexlash.decisions.lever import Present, Terms
from flexlash.decisions.levers import present_of, terms_of
from flexlash.decisions.why_not import share_of_units
from flexlash.schema.decision_results import ALLOCATION
from flexlash.schema.decision_rows import LeverRow
from flexlash.schema.findings import shown
from flexlash.schema.spellings import plain
from flexlash.schema.variant import Settings

__all__ = ["MOST_MEMBERS", "allocation_of"]

MOST_MEMBERS = 1000
"""Variants of a class that an allocation looks at: those that come nearest to their limit."""

_NAMED = 3
"""Most variants that a sentence names."""


def allocation_of(
    computed: Mapping[int, Computed], settings: Settings, levers: Mapping[str, LeverRow], options: Options | None = None
) -> pl.DataFrame:
    """Return the Allocation table: a row for each tolerance of each class that a variant with a limit names.

    `levers` are the rows of the sheet Levers by dimension, `options` those of the run. Classes come in the order of
    their first variant, dimensions in that of the class.
    """
    of_class: dict[str, list[Present]] = defaultdict(list)
    for one in computed.values():
        if (present := present_of(one)) is not None:
            of_class[plain(present.variant.tolerance_class)].append(present)
    rows: list[dict[str, Any]] = []
    if of_class:
        terms = terms_of(next(iter(computed.values())), settings, levers, options or Options())
        rows = [row for owner, presents in of_class.items() for row in _of_class(owner, presents, terms)]
    types = {column.key: pl.Float64() if column.is_number else pl.String() for column in ALLOCATION}
    return pl.DataFrame(rows, schema=types, orient="row")


def _of_class(owner: str, presents: Sequence[Present], terms: Terms) -> Iterator[dict[str, Any]]:
    """Yield the rows of one class."""
    nearest = sorted(presents, key=lambda one: (-one.quantiles.get(_TAIL, 0.0) / one.limit, one.variant.row))
    members = [
        Member(variant=one.variant, limit=one.limit, over=one.over, limits=limits_as_submitted(one.variant, terms)[0])
        for one in nearest[:MOST_MEMBERS]
    ]
    widths = list(class_widths(terms.classes[owner], members, terms))
    if not widths:
        return
    allocation = allocated(widths, members, terms)
    for index, width in enumerate(widths):
        value = None if allocation.values is None else allocation.values[index]
        grades, cost = (None, None) if value is None else cost_of(width, value)
        yield {
            "tolerance_class": presents[0].variant.tolerance_class,
            "dimension": width.dimension,
            "unit": width.unit,
            "from_value": _number(width.value),
            "to_value": _number(value),
            "grade_steps": None if grades is None else 0.0 - grades,
            "relative_cost": cost,
            "limited_by": None if value is None else _limited_by(width, value, allocation, members),
            "possible": "no" if allocation.helpless or value is None else "yes",
            "reason": _reason(allocation, members) or None,
        }


def _number(value: float | None) -> float | None:
    """Return a width; None of a general tolerance, which has no number."""
    return None if value is None or math.isnan(value) else value


_TAIL = 0.99865
"""The quantile by which variants are ordered."""


def _limited_by(width: ClassWidth, value: float, allocation: Allocation, members: Sequence[Member]) -> str:
    """Return what keeps a tolerance from being wider: that it is fixed, its bound, or variants at their limit."""
    if width.fixed:
        return width.fixed
    if value >= width.drawn(width.most) - width.step / 2:
        return width.bound
    having = [place for place, member in enumerate(members) if width.dimension in member.limits]
    tight = [members[place].variant.name for place in allocation.tight if place in having]
    if tight:
        return _names(tight)
    kept = [place for place in having if place not in allocation.helpless]
    if not kept:
        return "steps of the drawing"
    nearest = max(kept, key=lambda place: allocation.over[place])
    return f"steps of the drawing; nearest to its limit: {_names([members[nearest].variant.name])}"


def _reason(allocation: Allocation, members: Sequence[Member]) -> str:
    """Return which variants stay over their limit whatever the tolerances, and by how much at least."""
    if not allocation.helpless:
        return "" if allocation.values is not None else "no widths were found that keep all of its variants"
    named: dict[str, list[str]] = defaultdict(list)
    for place in allocation.helpless[:_NAMED]:
        named[share_of_units(allocation.over[place])].append(shown(members[place].variant.name))
    parts = [f"{share} of {' and '.join(names)}" for share, names in named.items()]
    more = len(allocation.helpless) - _NAMED
    rest = f" and of {more} more variants" if more > 0 else ""
    kept = "; the others are kept with these" if allocation.values is not None else ""
    return f"even with the narrowest widths {', '.join(parts)}{rest} stay over the limit{kept}"


def _names(names: Sequence[str]) -> str:
    more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
    return ", ".join(shown(name) for name in names[:_NAMED]) + more
