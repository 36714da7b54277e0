"""The widths of tolerances that just keep the target, each alone and all together, of many variants at once."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple, TypeAlias

import numpy as np
from scipy.special import ndtri

from flexlash.decisions.changed_rows import limits_as_submitted, over_limit, toleranced
from flexlash.decisions.drawing_steps import on_drawing, tolerance_step
from flexlash.decisions.lever import Present, Terms
from flexlash.decisions.tolerance_widths import FACTOR_STEP, greatest_factor, half_width, shop_tolerances, with_widths
from flexlash.decisions.width_roots import Root, Search, narrowed, widened
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.units import as_entered
from flexlash.schema.variant import Limits
from flexlash.tolerance.dimension_limits import distribution_of
from flexlash.tolerance.row_batches import FirstOrder, RowBatch, TolerancedRow, batches_alike

__all__ = ["ALL", "FoundWidth", "Width", "found_widths"]

_Drawn: TypeAlias = tuple[float, float]
"""Half a width as drawn, and the share over the limit there."""

ALL = "all"
"""What all tolerances of a variant are called where they change by one factor."""

_UPPER = 0.975
"""The quantile by which the scatter of a variant is told for a first guess."""

_NO_VARIANCE = 1e-12
"""Part of its own variance that is added to what a width leaves, lest it be none."""

_MORE_STEPS = 3
"""Steps of the drawing by which a width may be finer than the first one on the safe side."""

_HALF = 0.5
"""Share of units over the limit from which no narrower tolerance can help, if that of no tolerance is as great."""


class Parts(NamedTuple):
    """The variance of the backlash [rad²] that some tolerances have, and what all the others have, to first order.

    `shared` is what both have by correlation, `shift` how far the mean shifts of their processes raise the backlash
    [rad]; of tolerances k times as wide the variance is k² own + k shared + others, the shift k times as great.
    """

    own: float
    shared: float
    others: float
    shift: float


@dataclass(frozen=True, kw_only=True)
class Width:
    """Tolerances of a variant that change together: one alone by its name, or all.

    `half` is half the width and `step` the drawing's, in the unit of the dimension's column; of all the half is 1, a
    factor. `parts` say how the backlash scatters with them to first order.
    """

    present: Present
    limits: Mapping[str, Limits] = field(repr=False)
    name: str
    dimensions: tuple[str, ...]
    half: float
    step: float
    parts: Parts

    def at(self, factor: float) -> dict[str, Limits]:
        """Return the limits of the variant with these widths times a factor."""
        return with_widths(self.present.variant, self.limits, dict.fromkeys(self.dimensions, factor))

    @property
    def is_measured(self) -> bool:
        """Whether parts were measured, so that the limits do not change how they scatter."""
        return len(self.dimensions) == 1 and self.limits[self.name].sample is not None

    @property
    def farthest(self) -> tuple[float, bool]:
        """How many times as wide they may be in whole steps of the drawing, and whether a shape sets that."""
        most, by_shape = greatest_factor(self.present.variant, self.limits, self.dimensions)
        return self.drawn(most) / self.half, by_shape

    def drawn(self, factor: float, less: int = 0) -> float:
        """Return half the width times a factor, rounded down to whole steps of the drawing, so many steps less."""
        return on_drawing(self.half * factor - less * self.step, self.step, upwards=False)

    @cached_property
    def likely_best(self) -> float:
        """How many times as wide they leave the least over the limit, were the backlash normal: 0 where no width helps.

        Equation: the k up to 3 with the greatest (limit − median + shift (1 − k))/σ, σ² = own k² + shared k + others
        """
        own, shared, others, shift = self.parts
        if shared >= 0 and shift >= 0:
            return 0.0
        factor = np.linspace(0.0, 3.0, 97)
        sd = np.sqrt(np.maximum(own * factor**2 + shared * factor + others, 0.0) + _NO_VARIANCE * own)
        room = self.present.limit - self.present.quantiles[0.5] + shift * (1 - factor)
        return float(factor[np.argmax(room / sd)])


@dataclass(frozen=True, kw_only=True)
class FoundWidth:
    """A width with its root, None where none was looked for.

    `drawn` is half the width in whole steps of the drawing and `over` the share over the limit there, None where there
    is no such width. `over_best` is the least share over the limit that was found, where none helps: with the width
    times `best`, or without any tolerance where `alone` is False.
    """

    width: Width
    root: Root | None = None
    drawn: float | None = None
    over: float | None = None
    over_best: float | None = None
    best: float = 0.0
    alone: bool = True


def found_widths(presents: Sequence[Present], terms: Terms) -> list[FoundWidth]:
    """Return the widths of the tolerances of variants that scatter, in the order of these."""
    every = [_widths_of(present, limits, order, terms) for present, limits, order in _sloped(presents, terms)]
    narrow = _over_without_any(every, terms)
    widths = [width for some in every for width in some]
    looked = [index for index, width in enumerate(widths) if id(width.present) not in narrow and not width.is_measured]
    roots = dict(zip(looked, _roots([widths[index] for index in looked], terms), strict=True))
    drawn = _drawn(widths, roots, terms)
    return [
        _found(width, roots.get(index), drawn.get(index), narrow.get(id(width.present)))
        for index, width in enumerate(widths)
    ]


def _found(width: Width, root: Root | None, drawn: _Drawn | None, narrow: float | None) -> FoundWidth:
    if narrow is not None:
        return FoundWidth(width=width, over_best=narrow, alone=width.name == ALL)
    if root is not None and root.factor is None:
        return FoundWidth(width=width, root=root, over_best=root.over, best=root.best)
    half, over = drawn or (None, None)
    return FoundWidth(width=width, root=root, drawn=half, over=over)


def _sloped(presents: Sequence[Present], terms: Terms) -> Iterator[tuple[Present, Mapping[str, Limits], FirstOrder]]:
    """Yield each variant with its limits and what its backlash does to first order at the middle of these."""
    rows = [toleranced(one.variant, limits_as_submitted(one.variant, terms)[0], one.limit, terms) for one in presents]
    orders: dict[int, FirstOrder] = {}
    for batch in batches_alike(rows):
        orders |= zip(batch, RowBatch([rows[index] for index in batch]).first_order(), strict=True)
    return ((one, row.limits, orders[index]) for index, (one, row) in enumerate(zip(presents, rows, strict=True)))


def _parts(limits: Mapping[str, Limits], order: FirstOrder, names: Sequence[str]) -> Parts:
    """Return what dimensions have of the variance of the backlash, and what the others have."""
    deviations = {
        name: order.slopes[name] * distribution_of(one).standard_deviation
        for name, one in limits.items()
        if name in order.slopes
    }
    sums = [0.0, 0.0, 0.0]
    for name, deviation in deviations.items():
        sums[0 if name in names else 2] += deviation * deviation
    for first, second, tie in order.ties:
        moved = (first in names) + (second in names)
        sums[2 - moved] += 2 * tie * deviations[first] * deviations[second]
    others, shared, own = sums[2], sums[1], sums[0]
    shift = math.fsum(order.slopes[name] * limits[name].mean_shift for name in names)
    return Parts(own=own, shared=shared, others=others, shift=shift)


def _widths_of(present: Present, limits: Mapping[str, Limits], order: FirstOrder, terms: Terms) -> list[Width]:
    """Return what may change of a variant: each tolerance alone, then all of them together."""

    def width(name: str, dimensions: tuple[str, ...], half: float, step: float) -> Width:
        parts = _parts(limits, order, dimensions)
        return Width(
            present=present, limits=limits, name=name, dimensions=dimensions, half=half, step=step, parts=parts
        )

    free = [name for name in shop_tolerances(limits) if _may_change(name, terms)]
    alone = [
        width(name, (name,), as_entered(half_width(limits[name]), DIMENSIONS[name].si_unit.si), tolerance_step(name))
        for name in free
    ]
    grows = present.direction(terms.target) == "relax"
    together = tuple(one.name for one in alone if not one.is_measured and not (grows and one.farthest[0] <= 1))
    return [*alone, width(ALL, together, 1.0, FACTOR_STEP)] if len(together) > 1 else alone


def _may_change(name: str, terms: Terms) -> bool:
    """Return whether the tolerance of a dimension may change: where Levers does not forbid it."""
    row = terms.rows.get(name)
    return row is None or row.tolerance_may_change is not False


def _over_without_any(every: Sequence[Sequence[Width]], terms: Terms) -> dict[int, float]:
    """Return the shares over the limit of variants that no tolerance can help, without any, by the id of the variant.

    Of these so great a share is over the limit with all of the tolerances and with none that it is with some of them,
    unless means lie off the middle: one to the good side may stay while another goes.
    """
    asked = [
        widest
        for widths in every
        if widths and widths[0].present.over >= _HALF
        for widest in [max(widths, key=lambda width: len(width.dimensions))]
        if not (widest.is_measured or any(one.mean_shift for one in widest.limits.values()))
    ]
    overs = _over([(width, 0.0) for width in asked], terms)
    return {id(width.present): over for width, over in zip(asked, overs, strict=True) if over >= _HALF}


def _roots(widths: Sequence[Width], terms: Terms) -> list[Root]:
    """Return the root of each width; searches that still ask are answered together."""
    asking = {index: _search(width, terms.target) for index, width in enumerate(widths)}
    roots, answers = dict[int, Root](), dict[int, float]()
    while asking:
        questions = dict[int, float]()
        for index, search in asking.items():
            try:
                questions[index] = search.send(answers[index]) if answers else next(search)
            except StopIteration as end:
                roots[index] = end.value
        asking = {index: asking[index] for index in questions}
        overs = _over([(widths[index], factor) for index, factor in questions.items()], terms)
        answers = dict(zip(questions, overs, strict=True))
    return [roots[index] for index in range(len(widths))]


def _over(asked: Sequence[tuple[Width, float]], terms: Terms, *, by_lines: bool = True) -> list[float]:
    """Return the share over the limit of the variant of each width with it times a factor."""
    return over_limit([_row(width, factor, terms) for width, factor in asked], terms, by_lines=by_lines)


def _row(width: Width, factor: float, terms: Terms) -> TolerancedRow:
    return toleranced(width.present.variant, width.at(factor), width.present.limit, terms)


def _search(width: Width, target: float) -> Search:
    """Return the search for the factor of a width, outwards where the variant keeps its target, else inwards."""
    over = width.present.over
    if width.present.direction(target) == "meet":
        return narrowed(target, over, best if (best := width.likely_best) < 1 else 0.0)
    return widened(target, over, _guess(width, target), width.farthest[0])


def _guess(width: Width, target: float) -> float:
    """Return about how many times as wide a tolerance may be, were the backlash normal and a sum of its inputs.

    Equation: k² = 1 + ((limit − median)²/z² − σ²)/v, σ from the quantiles, z that of the target, v the variance of
        these tolerances
    """
    present, score = width.present, -float(ndtri(target))
    quantiles = present.quantiles
    sd = (quantiles[_UPPER] - quantiles[0.5]) / -float(ndtri(1 - _UPPER))
    spare = ((present.limit - quantiles[0.5]) / score) ** 2 - sd**2
    return math.sqrt(1 + max(spare, 0.0) / width.parts.own) if width.parts.own and score > 0 else math.inf


def _drawn(widths: Sequence[Width], roots: Mapping[int, Root], terms: Terms) -> dict[int, _Drawn]:
    """Return half the width in whole steps of the drawing, on the safe side, and the share over the limit there.

    Those that leave no change, or do not keep the target after all, have none.
    """
    found: dict[int, _Drawn] = {}
    steps = {index: half for index, root in roots.items() if (half := _rounded(widths[index], root))}
    for index in [index for index in steps if roots[index].bounded and terms.plan.method == "line"]:
        found[index] = steps.pop(index), roots[index].over
    for _ in range(1 + _MORE_STEPS):
        asked = [(widths[index], half / widths[index].half) for index, half in steps.items()]
        overs = dict(zip(steps, _over(asked, terms, by_lines=False), strict=True))
        found |= {index: (steps[index], over) for index, over in overs.items() if over <= terms.target}
        missing = [index for index in steps if index not in found]
        steps = {index: half for index in missing if (half := _rounded(widths[index], roots[index], steps[index]))}
    return found


def _rounded(width: Width, root: Root, above: float | None = None) -> float | None:
    """Return half the width in whole steps of the drawing, on the safe side; None where that leaves no change.

    It is the next one below `above`, where that is given.
    """
    if root.factor is None:
        return None
    half = width.drawn(root.factor) if above is None else width.drawn(above / width.half, less=1)
    return half if half > (width.half if root.factor >= 1 else 0.0) else None
