"""A row of dimensions as operands of rules, and the record of one rule; the rules are in `part_rules`."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

from flexlash.schema.columns import DIMENSIONS

__all__ = ["NumberRow", "Operand", "PartRow", "PartRule", "Reached", "first_broken"]

Operand: TypeAlias = Any
"""A dimension or a condition on dimensions, in the notation of the row that answers."""


class PartRow(ABC):
    """A row of dimensions by name, in the units of the template unless it says otherwise.

    `edge` is what counts as on an edge, since sums of decimals miss it by their last binary digit; `flat` is the angle
    to the axis from which on a disk counts as flat, since 90° in radians rarely is 90.
    """

    edge: Operand = 1e-9
    flat: Operand = 89.9999

    @abstractmethod
    def given(self, name: str) -> Operand:
        """Return whether a dimension has an entry of its own."""

    @abstractmethod
    def blank(self, name: str) -> Operand:
        """Return whether a dimension has no entry of its own."""

    @abstractmethod
    def entered(self, name: str) -> Operand:
        """Return the entry of a dimension; a blank one satisfies no comparison, or counts as 0 in a worksheet."""

    @abstractmethod
    def is_type(self, *types: str) -> Operand:
        """Return whether the flexspline is of one of these types."""

    @abstractmethod
    def when(self, condition: Operand, then: Operand, otherwise: Operand) -> Operand:
        """Return one of two operands."""

    @abstractmethod
    def all_of(self, *conditions: Operand) -> Operand:
        """Return whether all conditions hold."""

    @abstractmethod
    def any_of(self, *conditions: Operand) -> Operand:
        """Return whether at least one condition holds."""

    def __getitem__(self, name: str) -> Operand:
        """Return the dimension that counts: its entry, or what a blank stands for."""
        blank = self._blank_value(name)
        return self.entered(name) if blank is None else self.when(self.given(name), self.entered(name), blank)

    def _blank_value(self, name: str) -> Operand | None:
        if name == "mean_radius":
            return (self.entered("bore_diameter") + self.entered("wall_thickness")) / 2
        if name in {"disk_inner_radius", "disk_outer_radius"}:
            return self["mean_radius"]
        if name == "disk_cone_angle":
            return self.flat
        return 0.0 if name in {"hub_fillet_radius", "junction_fillet_radius", "rim_length"} else None

    @property
    def bore(self) -> Operand:
        """Radius of the bore."""
        return self["mean_radius"] - self["wall_thickness"] / 2

    @property
    def wall_share(self) -> Operand:
        """Wall thickness over mean radius."""
        return self["wall_thickness"] / self["mean_radius"]

    def are_apart(self, one: Operand, other: Operand, distance: Operand) -> Operand:
        """Return whether two numbers differ by more than a distance."""
        return self.any_of(one - other > distance, other - one > distance)


@dataclass(frozen=True, kw_only=True)
class NumberRow(PartRow):
    """A row of plain numbers: the type and the entries by name, without blank ones."""

    type: str
    entries: Mapping[str, float]
    edge: float = PartRow.edge
    flat: float = PartRow.flat

    def given(self, name: str) -> bool:
        """Return whether a dimension has an entry."""
        return name in self.entries

    def blank(self, name: str) -> bool:
        """Return whether a dimension has no entry."""
        return name not in self.entries

    def entered(self, name: str) -> float:
        """Return the entry of a dimension; NaN for a blank, which satisfies no comparison."""
        return self.entries.get(name, math.nan)

    def is_type(self, *types: str) -> bool:
        """Return whether the flexspline is of one of these types."""
        return self.type in types

    def when(self, condition: bool, then: float, otherwise: float) -> float:  # noqa: FBT001
        """Return one of two numbers."""
        return then if condition else otherwise

    def all_of(self, *conditions: bool) -> bool:
        """Return whether all conditions hold."""
        return all(conditions)

    def any_of(self, *conditions: bool) -> bool:
        """Return whether at least one condition holds."""
        return any(conditions)


@dataclass(frozen=True, kw_only=True)
class Reached:
    """Where limits of tolerance break a rule: no part or an overlap of refinements, and what the dimension reaches."""

    kind: Literal["impossible", "overlap"]
    words: str


@dataclass(frozen=True, kw_only=True)
class PartRule:
    """A rule between dimensions: the code of its finding, the dimension to blame, the fault in words.

    `broken` returns conditions that all hold where the rule is broken; a comparison that a blank satisfies when it
    counts as 0 stands beside `given`. `after` are codes of rules that say it already when they are broken: they stand
    before this one, and it is silent. `facts` are what the finding names beside the entry; `compares_lengths` tells
    that a mistaken unit breaks it; `reached` is what the dimension reaches where limits of tolerance break it.
    `demands` tells a rule that an entry of the dimension fixes, or none of it; one in `instead` fixes it as well.
    """

    code: str
    dimension: str
    words: str
    broken: Callable[[PartRow], Iterable[Operand]]
    facts: Callable[[NumberRow], dict[str, Any]] = lambda _: {}
    after: tuple[str, ...] = ()
    compares_lengths: bool = False
    reached: Reached | None = None
    demands: Literal["entry", "none"] | None = None
    instead: str = ""

    @property
    def key(self) -> str:
        """The key of the column to blame."""
        return DIMENSIONS[self.dimension].key

    @property
    def id(self) -> str:
        """The name of the rule: column and code."""
        return f"{self.key}|{self.code}"

    @property
    def is_error(self) -> bool:
        """Whether the dimensions make no part."""
        return self.code[0] == "E"


def first_broken(rules: Iterable[PartRule], row: PartRow) -> PartRule | None:
    """Return the first rule that a row of plain numbers breaks."""
    return next((rule for rule in rules if row.all_of(*rule.broken(row))), None)
