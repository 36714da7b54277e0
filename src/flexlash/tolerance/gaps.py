"""The book of rules at the tolerance limits: what must stay above 0, as a sum of dimensions each with its factor."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache

from flexlash.schema.part_row import PartRow, PartRule, Reached
from flexlash.schema.part_rules import PART_RULES

__all__ = ["Gap", "gaps"]


@dataclass(frozen=True, kw_only=True)
class Gap:
    """A sum of dimensions that must stay above 0, or at it where it `may_close`; the first of `factors` is to blame."""

    factors: Mapping[str, float]
    may_close: bool
    reached: Reached

    @property
    def dimension(self) -> str:
        """The dimension to blame."""
        return next(iter(self.factors))


@dataclass(frozen=True, kw_only=True)
class _Comparison:
    """A condition that holds where `small` reaches `large`, or exceeds it where it `may_close`."""

    small: _Sum
    large: _Sum
    may_close: bool

    def gap(self, rule: PartRule, reached: Reached) -> Gap:
        """Return what must stay open; the rule's dimension comes first, else the first of the smaller side."""
        first = (
            rule.dimension
            if rule.dimension in self.small.factors | self.large.factors
            else next(iter(self.small.factors))
        )
        factors = {first: 0.0} | (self.large - self.small).factors
        return Gap(
            factors={name: factor for name, factor in factors.items() if factor},
            may_close=self.may_close,
            reached=reached,
        )


@dataclass(frozen=True)
class _Sum:
    """Dimensions with their factors as an operand; a plain number stands for a dimension that the part has not."""

    factors: dict[str, float]

    def __add__(self, other: _Sum | float) -> _Sum:
        return self._with(other, 1.0)

    __radd__ = __add__

    def __sub__(self, other: _Sum | float) -> _Sum:
        return self._with(other, -1.0)

    def _with(self, other: _Sum | float, sign: float) -> _Sum:
        factors = dict(self.factors)
        for name, factor in other.factors.items() if isinstance(other, _Sum) else ():
            factors[name] = factors.get(name, 0.0) + sign * factor
        return _Sum(factors)

    def __truediv__(self, divisor: float) -> _Sum:
        return _Sum({name: factor / divisor for name, factor in self.factors.items()})

    def __gt__(self, other: _Sum | float) -> _Comparison | bool:
        return not isinstance(other, _Sum) or _Comparison(small=self, large=other, may_close=True)

    def __ge__(self, other: _Sum | float) -> _Comparison | bool:
        return not isinstance(other, _Sum) or _Comparison(small=self, large=other, may_close=False)

    def __lt__(self, other: _Sum | float) -> _Comparison | bool:
        return isinstance(other, _Sum) and _Comparison(small=other, large=self, may_close=True)

    def __le__(self, other: _Sum | float) -> _Comparison | bool:
        return isinstance(other, _Sum) and _Comparison(small=other, large=self, may_close=False)


class _SumRow(PartRow):
    """The dimensions of a variant as operands; what is on an edge is told by the rounding of the limits."""

    edge = _Sum({})

    def __init__(self, flexspline_type: str, names: frozenset[str]) -> None:
        self._type, self._names = flexspline_type, names

    def given(self, name: str) -> bool:
        """Return whether the variant has a dimension."""
        return name in self._names

    def blank(self, name: str) -> bool:
        """Return whether the variant has not a dimension."""
        return name not in self._names

    def entered(self, name: str) -> _Sum:
        """Return a dimension."""
        return _Sum({name: 1.0})

    def is_type(self, *types: str) -> bool:
        """Return whether the flexspline is of one of these types."""
        return self._type in types

    def when(self, condition: bool, then: _Sum | float, otherwise: _Sum | float) -> _Sum | float:  # noqa: FBT001
        """Return one of two operands."""
        return then if condition else otherwise

    def all_of(self, *conditions: _Comparison | bool) -> _Comparison | bool:
        """Return the comparison on which it depends whether all conditions hold, if it does."""
        open_ones = [condition for condition in conditions if isinstance(condition, _Comparison)]
        return False if False in conditions else open_ones[0] if open_ones else True

    def any_of(self, *conditions: _Comparison | bool) -> _Comparison | bool:
        """Return the comparison on which it depends whether a condition holds, if it does."""
        open_ones = [condition for condition in conditions if isinstance(condition, _Comparison)]
        return True if True in conditions else open_ones[0] if open_ones else False


def gaps(flexspline_type: str, names: Iterable[str]) -> Sequence[Gap]:
    """Return what the rules let stand open in a part with these dimensions; one alone is kept by its own bounds."""
    return _gaps(flexspline_type, frozenset(names))


@cache
def _gaps(flexspline_type: str, names: frozenset[str]) -> Sequence[Gap]:
    """Return the gaps of all parts of one type that have the same dimensions."""
    return tuple(_open_gaps(_SumRow(flexspline_type, names)))


def _open_gaps(row: _SumRow) -> Iterator[Gap]:
    for rule in PART_RULES:
        if rule.reached and isinstance(comparison := row.all_of(*rule.broken(row)), _Comparison):
            gap = comparison.gap(rule, rule.reached)
            if len(gap.factors) > 1:
                yield gap
