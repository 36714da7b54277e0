"""Single dimensions that would bring variants within their limit, or that may go further and keep them there."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from flexlash.decisions.changes import Change, changes_of, with_sizes
from flexlash.decisions.drawing_steps import drawing_step, on_drawing, relative_cost
from flexlash.decisions.known_tail import tail_of
from flexlash.decisions.lever import Lever, Present, Terms
from flexlash.decisions.limit_search import LimitSearch, Solution
from flexlash.decisions.predicted_scores import ChangedAlike
from flexlash.decisions.why_not import always_kept, never_met, no_step, unmoved
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.spellings import plain
from flexlash.schema.units import as_entered
from flexlash.schema.variant import Variant

__all__ = ["changed_alike", "nominal_levers", "presents_alike"]


def nominal_levers(presents: Sequence[Present], terms: Terms) -> Iterator[tuple[int, Lever, Variant | None]]:
    """Yield the levers of single dimensions: the index of the variant, the lever, the variant as drawn with it."""
    for indices in presents_alike(presents):
        group = [presents[index] for index in indices]
        unchanged = changed_alike(group, Change(dimension="wall_thickness"), terms)
        tail = tail_of(group, unchanged, terms.level)
        for change in changes_of(group[0].variant, terms.may_change):
            alike = changed_alike(group, change, terms)
            step = drawing_step(change.dimension, terms.rows.get(change.dimension))
            rounded = partial(_rounded, step=step)
            solution = LimitSearch(alike, group, terms, tail).solution(rounded)
            for place, index in enumerate(indices):
                lever = _lever(group[place], alike, solution, place, terms)
                yield index, lever, _as_drawn(group[place].variant, change, lever)


def _rounded(value: float, upwards: bool, *, step: float) -> float:  # noqa: FBT001
    return on_drawing(value, step, upwards=upwards)


def presents_alike(presents: Sequence[Present]) -> list[list[int]]:
    """Return the indices of variants of one type and one class that have the same dimensions, each index once."""
    alike: dict[tuple[str, str, tuple[str, ...]], list[int]] = defaultdict(list)
    for index, present in enumerate(presents):
        variant = present.variant
        alike[variant.flexspline_type, plain(variant.tolerance_class), tuple(variant.dimensions)].append(index)
    return [*alike.values()]


def changed_alike(group: Sequence[Present], change: Change, terms: Terms) -> ChangedAlike:
    """Return one change of variants alike."""
    first = group[0].variant
    owner = plain(first.tolerance_class)
    return ChangedAlike(
        kind=first.flexspline_type,
        change=change,
        sizes={name: np.array([one.variant.dimensions[name] for one in group]) for name in first.dimensions},
        limit=np.array([one.limit for one in group]),
        rows=terms.classes[owner],
        target=terms.level,
        ties=terms.correlations.get(owner, {}),
    )


def _as_drawn(variant: Variant, change: Change, lever: Lever) -> Variant | None:
    """Return a variant with the drawing value of a lever."""
    if lever.drawing_value is None:
        return None
    value = lever.drawing_value * DIMENSIONS[change.dimension].si_unit.si
    return with_sizes(variant, change.sizes(variant.dimensions, value))


def _lever(present: Present, alike: ChangedAlike, solution: Solution, place: int, terms: Terms) -> Lever:
    """Return the lever of one variant; what it does beside the backlash is found for all together."""
    change = alike.change
    column = DIMENSIONS[change.dimension]
    entered = as_entered(change.before(present.variant.dimensions), column.si_unit.si)
    lever = Lever(
        variant=present.variant,
        dimension=change.dimension,
        moves=change.moves,
        what="nominal",
        direction=present.direction(terms.target),
        unit=column.unit,
        from_value=entered,
    )
    value, drawing, over = (float(one[place]) for one in (solution.value, solution.drawing, solution.over))
    if math.isnan(value) or math.isnan(drawing):
        return replace(lever, reason=_reason(lever, alike, solution, place, terms))
    row = terms.rows.get(change.dimension)
    cost = relative_cost(entered, drawing, drawing_step(change.dimension, row), row)
    exact = value / column.si_unit.si
    return replace(lever, to_value=exact, drawing_value=drawing, over=over, relative_cost=cost)


def _reason(lever: Lever, alike: ChangedAlike, solution: Solution, place: int, terms: Terms) -> str:
    """Return why a lever cannot do it."""
    name = lever.dimension
    if not math.isnan(solution.value[place]):
        return no_step(name, float(solution.value[place]), drawing_step(name, terms.rows.get(name)))
    if any(row.dimension == name and row.sample and not row.sample.are_deviations for row in alike.rows):
        return unmoved(name)
    low, high = (float(end[place]) for end in alike.ends)
    if lever.direction == "relax":
        return always_kept(name, (low, high))
    return never_met(name, float(solution.extreme[place]), (low, high), float(solution.over[place]))
