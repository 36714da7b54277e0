"""The widths of a tolerance class that an allocation may change, each in the form in which Tolerances holds it.

deviations     ± in the unit of the dimension, also of a grade where all variants have the same deviations by it
per cent       ± of the entered value
grade          a grade of ISO 286 for variants of different sizes: whole grades, so that it can be entered
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from flexlash.decisions.drawing_steps import on_drawing, tolerance_step
from flexlash.decisions.lever import Terms
from flexlash.decisions.tolerance_widths import GRADE, greatest_factor, is_made
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.tolerance_grades import is_grade
from flexlash.schema.units import as_entered
from flexlash.schema.variant import Limits, ToleranceRow, Variant

__all__ = ["MOST_GRADES", "ClassWidth", "Member", "class_widths"]

MOST_GRADES = 5
"""Most IT grades by which a tolerance gets wider or finer: a factor of ten."""

_PERCENT_STEP = 0.01
"""Step of a width in per cent of the value."""

_HOPELESS = 0.9999
"""Share over the limit that no narrower tolerances bring below a half."""

_SAME = 1e-10
"""Deviations [m] that differ by less are the same."""

_ISO_286 = re.compile(r"(IT|js|JS|h|H)(\d+)")

Kind = Literal["deviations", "per cent", "grade"]


@dataclass(frozen=True, kw_only=True)
class Member:
    """A variant of a class with a limit [rad], the share of its units over it, and its limits as they are."""

    variant: Variant
    limit: float
    over: float
    limits: Mapping[str, Limits]

    @property
    def is_hopeless(self) -> bool:
        """Whether its units are over the limit however narrow they are made about the same middle."""
        return self.over > _HOPELESS and not any(limits.mean_shift for limits in self.limits.values())


@dataclass(frozen=True, kw_only=True)
class ClassWidth:
    """The width of a row of a class: half of it in `unit`, or the number of a grade.

    `least` and `most` are the factors between which it may change; they are both 1 where it is `fixed`, for the reason
    given. `bound` says what keeps it from more than `most`.
    """

    row: ToleranceRow
    kind: Kind
    unit: str
    value: float
    step: float
    cost: float
    least: float = 1.0
    most: float = 1.0
    bound: str = ""
    fixed: str = ""

    @property
    def dimension(self) -> str:
        """The dimension of the row."""
        return self.row.dimension

    def factor(self, value: float) -> float:
        """Return how many times as wide the limits are with another value."""
        if self.fixed:
            return 1.0
        return GRADE ** (value - self.value) if self.kind == "grade" else value / self.value

    def drawn(self, factor: float, *, upwards: bool = False) -> float:
        """Return the next value in whole steps at or below a factor, or at or above it, within what is allowed."""
        wanted = self.value + math.log(factor, GRADE) if self.kind == "grade" else self.value * factor
        return on_drawing(wanted, self.step, upwards=upwards)

    def changed(self, value: float) -> ToleranceRow:
        """Return the row with another value, about the same middle and with as capable a process."""
        factor, row = self.factor(value), self.row
        kept = replace(row, mean_shift=row.mean_shift * factor, sd=None if row.sd is None else row.sd * factor)
        if grade := _grade(row):
            return replace(kept, grade=f"{grade[0]}{value:.0f}")
        middle, half = (row.lower + row.upper) / 2, (row.upper - row.lower) / 2 * factor
        return replace(kept, grade=None, lower=middle - half, upper=middle + half)


def class_widths(rows: Sequence[ToleranceRow], members: Sequence[Member], terms: Terms) -> Iterator[ClassWidth]:
    """Yield the widths of a class that its variants have, in the order of its rows."""
    for row in rows:
        having = [one for one in members if _scatters(one, row.dimension)]
        if having and is_made(row.dimension):
            yield _bounded(_width(row, having, terms), having, terms)


def _scatters(one: Member, name: str) -> bool:
    return name in one.limits and one.limits[name].low < one.limits[name].high


def _width(row: ToleranceRow, having: Sequence[Member], terms: Terms) -> ClassWidth:
    """Return the width of a row in the form in which it can be entered."""
    lever = terms.rows.get(row.dimension)
    cost = 1.0 if lever is None else lever.cost_per_grade
    column = DIMENSIONS[row.dimension]
    if row.grade:
        same, grade = _same_deviations(row, having), _grade(row)
        if same is None:
            number = math.nan if grade is None else float(grade[1])
            return ClassWidth(row=row, kind="grade", unit="IT grade", value=number, step=1.0, cost=cost)
        row = replace(row, grade=None, lower=same[0], upper=same[1])
    half = (row.upper - row.lower) / 2
    if row.relative:
        value = float(f"{100 * half:.11g}")
        return ClassWidth(row=row, kind="per cent", unit="%", value=value, step=_PERCENT_STEP, cost=cost)
    value = as_entered(float(f"{half:.11g}"), column.si_unit.si)
    return ClassWidth(
        row=row, kind="deviations", unit=column.unit, value=value, step=tolerance_step(row.dimension), cost=cost
    )


def _same_deviations(row: ToleranceRow, having: Sequence[Member]) -> tuple[float, float] | None:
    """Return the deviations [m] that all of some variants have by a grade, None where they differ."""
    name = row.dimension
    pairs = [
        (one.limits[name].low - one.variant.dimensions[name], one.limits[name].high - one.variant.dimensions[name])
        for one in having
    ]
    first = round(pairs[0][0], 10), round(pairs[0][1], 10)
    return first if all(math.dist(first, pair) < _SAME for pair in pairs) else None


def _grade(row: ToleranceRow) -> tuple[str, str] | None:
    """Return letters and number of a grade of ISO 286; None of a general tolerance, which has no finer steps."""
    found = _ISO_286.fullmatch(row.grade or "")
    return (found[1], found[2]) if found else None


def _bounded(width: ClassWidth, having: Sequence[Member], terms: Terms) -> ClassWidth:
    """Return a width with how far it may change."""
    lever = terms.rows.get(width.dimension)
    if lever is not None and lever.tolerance_may_change is False:
        return replace(width, fixed="Levers says that it may not change")
    if width.row.sample is not None:
        return replace(width, fixed="its parts were measured")
    if width.kind == "grade":
        return _graded(width)
    bounds = [greatest_factor(one.variant, one.limits, (width.dimension,)) for one in having]
    usual, by_shape = min(bounds)
    widest = GRADE**MOST_GRADES
    bound = f"{MOST_GRADES} IT grades wider"
    if usual < widest:
        bound = "as far as the shape allows" if by_shape else "as far as is usual, ± 10 % of the value"
    most = max(min(usual, widest), 1.0)
    return replace(width, least=min(max(1 / widest, width.step / width.value), 1.0), most=most, bound=bound)


def _graded(width: ClassWidth) -> ClassWidth:
    """Return a grade with the finest and coarsest that the tables of all sizes hold."""
    parts = _grade(width.row)
    if parts is None:
        return replace(width, fixed="a general tolerance of different sizes: enter deviations to have it allocated")
    numbers = [
        number
        for number in range(round(width.value) - MOST_GRADES, round(width.value) + MOST_GRADES + 1)
        if is_grade(f"{parts[0]}{number}")
    ]
    bound = f"grade {max(numbers)}, the coarsest there is"
    return replace(width, least=width.factor(min(numbers)), most=width.factor(max(numbers)), bound=bound)
