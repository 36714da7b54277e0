"""Levers of tolerances: how far each alone may be relaxed, or must be tightened, for a variant to keep its target."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from flexlash.analysis.backlash_models import BACKLASH_OF
from flexlash.decisions.changes import changes_of
from flexlash.decisions.found_widths import ALL, FoundWidth, Width, found_widths
from flexlash.decisions.lever import Lever, Present, Terms
from flexlash.decisions.tolerance_widths import grades_finer
from flexlash.decisions.why_not import share_of_units
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.findings import spelled_out
from flexlash.schema.variant import Variant

__all__ = ["tolerance_levers"]

_DIGITS, _HALF = 3, 0.5

FACTOR = "×"
"""The unit of the factor by which all tolerances change."""


def tolerance_levers(presents: Sequence[Present], terms: Terms) -> Iterator[tuple[int, Lever, Variant | None]]:
    """Yield the levers of tolerances: the index of the variant, the lever, the variant as drawn with it.

    Half the width of the limits is the value; middle, distribution and capability of the process stay. A variant with
    several tolerances that may change has one more lever, `all`: the factor by which they change together.
    """
    places = {present.variant.row: index for index, present in enumerate(presents)}
    for found in found_widths(presents, terms):
        lever, variant = _lever(found, terms), found.width.present.variant
        yield places[variant.row], lever, None if lever.drawing_value is None else variant


def _lever(found: FoundWidth, terms: Terms) -> Lever:
    width = found.width
    direction = width.present.direction(terms.target)
    reason = _reason(found, meets=direction == "meet")
    exact = None if reason or found.root is None or found.root.factor is None else found.root.factor * width.half
    return Lever(
        variant=width.present.variant,
        dimension=width.name,
        moves=_moves(width),
        what="tolerance",
        direction=direction,
        unit=FACTOR if width.name == ALL else DIMENSIONS[width.name].unit,
        from_value=width.half,
        to_value=exact,
        drawing_value=None if reason else found.drawn,
        reason=reason,
        over=None if reason else found.over,
        notes=() if reason else tuple(_notes(found)),
        relative_cost=None if reason or found.drawn is None else _cost(width, found.drawn / width.half, terms),
    )


def _moves(width: Width) -> tuple[str, ...]:
    """Return what has the same tolerance: of all those that change together, of a wall the disk that is as thick."""
    if width.name == ALL:
        return width.dimensions
    changes = changes_of(width.present.variant, lambda _: True)
    return next((change.moves for change in changes if change.dimension == width.name), ())


def _cost(width: Width, factor: float, terms: Terms) -> float:
    """Return what it costs to have tolerances so many times as wide: less than nothing where they are relaxed."""
    rows = (terms.rows.get(name) for name in width.dimensions)
    cost = math.fsum(1.0 if row is None else row.cost_per_grade for row in rows) * grades_finer(factor)
    return float(f"{cost:.12g}")


def _notes(found: FoundWidth) -> Sequence[str]:
    if found.root is None or not found.root.bounded:
        return []
    if found.width.farthest[1]:
        return ["as far as the shape allows"]
    return ["as far as is usual, ± 10 % of the value"]


def _reason(found: FoundWidth, *, meets: bool) -> str:
    """Return why tolerances cannot do it, empty where they can."""
    width = found.width
    if width.is_measured:
        return "its parts were measured: other limits do not change how they scatter"
    if found.over_best is not None:
        return _helpless(found, found.over_best)
    return "" if found.drawn is not None else _not_drawn(found, meets=meets)


def _not_drawn(found: FoundWidth, *, meets: bool) -> str:
    """Return why no width on the drawing does it, though one would."""
    width, root = found.width, found.root
    step = f"{width.step:g}{'' if width.name == ALL else DIMENSIONS[width.name].unit_behind}"
    if meets and root is not None and (root.factor or 0.0) * width.half >= width.step:
        return f"{_half(width, root.factor)} would do, but beside it no multiple of the drawing step {step} does"
    if meets:
        return f"it would have to be finer than the drawing step of {step}"
    if root is not None and root.bounded:
        return "the shape allows no more" if width.farthest[1] else "it is as wide as is usual, ± 10 % of the value"
    return f"not by a drawing step of {step}"


def _half(width: Width, factor: float | None) -> str:
    """Return half the width times a factor, of all the factor."""
    half = spelled_out((factor or 0.0) * width.half, _DIGITS)
    return f"× {half}" if width.name == ALL else f"± {half}{DIMENSIONS[width.name].unit_behind}"


def _helpless(found: FoundWidth, over: float) -> str:
    """Return why no width helps, with what the best that was found leaves over the limit."""
    width, limit = found.width, found.width.present.limit
    narrower = "narrower " if width.likely_best > 1 else ""
    if width.name == ALL:
        who = f"not even {narrower or 'all '}tolerances together are enough"
    else:
        who = f"no single {narrower}tolerance is enough"
    nominal = float(BACKLASH_OF[width.present.variant.flexspline_type](width.present.variant.dimensions))
    if over >= _HALF and nominal > limit:
        return f"{who}: the nominal is over the limit"
    share = share_of_units(over)
    are = "is" if share.endswith("unit") else "are"
    if found.best:
        return f"{who}: at {_half(width, found.best)}, the best that was tried, {share} {are} over the limit"
    without = "it" if found.alone and width.name != ALL else "any of them"
    return f"{who}: even without any scatter of {without}, {share} {are} over the limit"
