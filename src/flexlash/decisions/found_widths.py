"""The widths of tolerances that just keep the target, each alone and all together, of many variants at once."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

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
from flexlash.tolerance.row_batches import RowBatch, TolerancedRow, batches_alike

__all__ = ["ALL", "FoundWidth", "Width", "found_widths"]

ALL = "all"
"""What all tolerances of a variant are called where they change by one factor."""

_UPPER = 0.975
"""The quantile by which the scatter of a variant is told for a first guess."""

_HALF = 0.5
"""Share of units over the limit from which no narrower tolerance can help, if that of no tolerance is as great."""


@dataclass(frozen=True, kw_only=True)
class Width:
    """Tolerances of a variant that change together: one alone by its name, or all.

    `half` is half the width and `step` the drawing's, in the unit of the dimension's column; of all the half is 1, a
    factor. `variance` is what they have of the variance of the backlash to first order [rad²].
    """

    present: Present
    limits: Mapping[str, Limits] = field(repr=False)
    name: str
    dimensions: tuple[str, ...]
    half: float
    step: float
    variance: float

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

    def drawn(self, factor: float) -> float:
        """Return half the width times a factor, rounded down to whole steps of the drawing."""
        return on_drawing(self.half * factor, self.step, upwards=False)


@dataclass(frozen=True, kw_only=True)
class FoundWidth:
    """A width with its root, None where none was looked for.

    `drawn` is half the width in whole steps of the drawing and `over` the share over the limit there, None where there
    is no such width. `over_narrow` is the share over the limit that the narrowest leaves, where none helps: without
    this tolerance, or without any where `alone` is False.
    """

    width: Width
    root: Root | None = None
    drawn: float | None = None
    over: float | None = None
    over_narrow: float | None = None
    alone: bool = True


def found_widths(presents: Sequence[Present], terms: Terms) -> list[FoundWidth]:
    """Return the widths of the tolerances of variants that scatter, in the order of these."""
    every = [_widths_of(present, limits, slopes, terms) for present, limits, slopes in _sloped(presents, terms)]
    narrow = _over_without_any(every, terms)
    widths = [width for some in every for width in some]
    looked = [index for index, width in enumerate(widths) if id(width.present) not in narrow and not width.is_measured]
    roots = dict(zip(looked, _roots([widths[index] for index in looked], terms), strict=True))
    drawn = {index: half for index, root in roots.items() if (half := _drawn(widths[index], root))}
    known = {index: roots[index].over for index in drawn if roots[index].bounded and terms.plan.method == "line"}
    asked = [index for index in drawn if index not in known]
    overs = _over([(widths[index], drawn[index] / widths[index].half) for index in asked], terms, by_lines=False)
    over = known | dict(zip(asked, overs, strict=True))
    return [
        _found(width, roots.get(index), drawn.get(index), over.get(index), narrow.get(id(width.present)))
        for index, width in enumerate(widths)
    ]


def _found(
    width: Width, root: Root | None, drawn: float | None, over: float | None, narrow: float | None
) -> FoundWidth:
    if narrow is not None:
        return FoundWidth(width=width, over_narrow=narrow, alone=width.name == ALL)
    if root is None or root.factor is None:
        return FoundWidth(width=width, root=root, over_narrow=None if root is None else root.over)
    return FoundWidth(width=width, root=root, drawn=drawn, over=over)


def _sloped(
    presents: Sequence[Present], terms: Terms
) -> Iterator[tuple[Present, Mapping[str, Limits], Mapping[str, float]]]:
    """Yield each variant with its limits and the slopes of its backlash at the middle of these."""
    rows = [toleranced(one.variant, limits_as_submitted(one.variant, terms)[0], one.limit, terms) for one in presents]
    slopes: dict[int, Mapping[str, float]] = {}
    for batch in batches_alike(rows):
        orders = RowBatch([rows[index] for index in batch]).first_order()
        slopes |= {index: order.slopes for index, order in zip(batch, orders, strict=True)}
    return ((one, row.limits, slopes[index]) for index, (one, row) in enumerate(zip(presents, rows, strict=True)))


def _widths_of(
    present: Present, limits: Mapping[str, Limits], slopes: Mapping[str, float], terms: Terms
) -> list[Width]:
    """Return what may change of a variant: each tolerance alone, then all of them together."""

    def width(name: str, dimensions: tuple[str, ...], half: float, step: float) -> Width:
        parts = (slopes[one] * distribution_of(limits[one]).standard_deviation for one in dimensions)
        variance = math.fsum(part * part for part in parts)
        return Width(
            present=present, limits=limits, name=name, dimensions=dimensions, half=half, step=step, variance=variance
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

    Of these so great a share is over the limit with all of the tolerances and with none that it is with some of them.
    """
    asked = [
        widest
        for widths in every
        if widths and widths[0].present.over >= _HALF
        for widest in [max(widths, key=lambda width: len(width.dimensions))]
        if not widest.is_measured
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
        return narrowed(target, over)
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
    return math.sqrt(1 + max(spare, 0.0) / width.variance) if width.variance and score > 0 else math.inf


def _drawn(width: Width, root: Root) -> float | None:
    """Return half the width in whole steps of the drawing, on the safe side; None where that leaves no change."""
    if root.factor is None:
        return None
    half = width.drawn(root.factor)
    return half if half > (width.half if root.factor >= 1 else 0.0) else None
