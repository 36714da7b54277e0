"""Where a number crosses 0 between two values, found for many numbers at once: each step is one batch of the engine."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

__all__ = ["Bracket", "Turn", "closed", "crossings", "past_turns"]

Whose = TypeVar("Whose")

_STEPS = 100
"""Most evaluations of a bracket, which close it whatever the number does; a smooth one takes three to six."""

_LOOKS = 12
"""Most values at which it is looked where a number turns."""

_NEAR = 1e-8
"""Width of a bracket, as a part of its values, at which it has closed."""


@dataclass(frozen=True, kw_only=True)
class Bracket(Generic[Whose]):
    """Two values between which a number changes its sign, with the number at each; `whose` number it is."""

    whose: Whose
    low: float
    high: float
    at_low: float
    at_high: float

    @property
    def nearer(self) -> float:
        """The end at which the number is nearer to 0."""
        return self.low if abs(self.at_low) <= abs(self.at_high) else self.high


@dataclass(frozen=True, kw_only=True)
class Turn(Generic[Whose]):
    """Three values, in their order, at which a number has one sign, and is nearest to 0 at the middle one."""

    whose: Whose
    values: tuple[float, float, float]
    numbers: tuple[float, float, float]


def past_turns(
    turns: Sequence[Turn[Whose]], evaluate: Callable[[Sequence[tuple[Whose, float]]], Sequence[float | None]]
) -> list[Bracket[Whose]]:
    """Return the brackets of the two zeros of each turn whose number changes its sign between the values after all.

    `evaluate` is as of `crossings`. Where the number turns is found by parabolas through three values; one that turns
    too far from 0 is left alone. Each turn goes its own way.

    >>> turn = Turn(whose=0.5, values=(0.0, 2.0, 3.0), numbers=(4.0, 0.5, 3.5))
    >>> past_turns([turn], lambda asked: [2 * (value - 1.6) ** 2 - whose for whose, value in asked])[0].high
    1.5...
    """
    found: list[Bracket[Whose]] = []
    open_ones = list(turns)
    for _ in range(_LOOKS):
        asked = [(turn, value) for turn in open_ones if (value := _extreme(turn)) is not None]
        if not asked:
            break
        open_ones = []
        numbers = evaluate([(turn.whose, value) for turn, value in asked])
        for (turn, value), number in zip(asked, numbers, strict=True):
            if number is None:
                continue
            if (number > 0) != (turn.numbers[1] > 0):
                found += _both_sides(turn, value, number)
            else:
                open_ones.append(_nearer(turn, value, number))
    return found


def _extreme(turn: Turn[Whose]) -> float | None:
    """Return where the parabola through a turn is nearest to 0, or past it; None where that is far from 0, or known."""
    (low, middle, high), (at_low, at_middle, at_high) = turn.values, map(abs, turn.numbers)
    if at_middle > max(at_low, at_high) - at_middle:
        return None
    left, right = (at_low - at_middle) / (low - middle), (at_high - at_middle) / (high - middle)
    bend = (right - left) / (high - low)
    if not bend > 0:
        return None
    value = (middle + low) / 2 - left / (2 * bend)
    if abs(value - middle) <= _NEAR**0.5 * abs(high - low):
        return None
    return value if min(low, high) < value < max(low, high) else None


def _both_sides(turn: Turn[Whose], value: float, number: float) -> list[Bracket[Whose]]:
    """Return the brackets between a value of the other sign and its neighbours of a turn."""
    before = max(place for place in (0, 1) if (turn.values[place] < value) == (turn.values[0] < turn.values[2]))
    return [
        Bracket(whose=turn.whose, low=turn.values[before], high=value, at_low=turn.numbers[before], at_high=number),
        Bracket(
            whose=turn.whose, low=value, high=turn.values[before + 1], at_low=number, at_high=turn.numbers[before + 1]
        ),
    ]


def _nearer(turn: Turn[Whose], value: float, number: float) -> Turn[Whose]:
    """Return the three of four points about the one that is nearest to 0."""
    points = sorted([*zip(turn.values, turn.numbers, strict=True), (value, number)])
    middle = min((1, 2), key=lambda place: abs(points[place][1]))
    values, numbers = zip(*points[middle - 1 : middle + 2], strict=True)
    return replace(turn, values=values, numbers=numbers)


def crossings(
    brackets: Sequence[Bracket[Whose]],
    evaluate: Callable[[Sequence[tuple[Whose, float]]], Sequence[float | None]],
    small: float,
) -> list[float | None]:
    """Return the value at which each bracket's number is 0, None where the number is missing on the way.

    >>> line = Bracket(whose=2.0, low=1.0, high=3.0, at_low=-1.0, at_high=7.0)
    >>> crossings([line], lambda asked: [value**2 - whose for whose, value in asked], 1e-12)
    [1.414213562373...]
    """
    return [None if one is None else one.nearer for one in closed(brackets, evaluate, small)]


def closed(
    brackets: Sequence[Bracket[Whose]],
    evaluate: Callable[[Sequence[tuple[Whose, float]]], Sequence[float | None]],
    small: float,
) -> list[Bracket[Whose] | None]:
    """Return brackets so narrow that nothing more is told, or an end of which is on 0; None where a number is missing.

    `evaluate` returns the numbers at values, None where there is none; a number of at most `small` counts as 0. Found
    by false position with the Illinois rule, by halves where a number is infinite or three steps did not halve the
    bracket; each bracket goes its own way, so that none depends on the others.
    """
    open_ones = {place: _Open(bracket) for place, bracket in enumerate(brackets)}
    found: list[Bracket[Whose] | None] = [None] * len(brackets)
    for steps in range(_STEPS + 1):
        for place, one in list(open_ones.items()):
            if one.has_ended(small):
                found[place] = open_ones.pop(place).bracket
        if not open_ones or steps == _STEPS:
            break
        asked = [(one.bracket.whose, one.next_value()) for one in open_ones.values()]
        for (place, one), (_, value), number in zip(list(open_ones.items()), asked, evaluate(asked), strict=True):
            if number is None:
                del open_ones[place]
            else:
                one.narrow(value, number)
    return found


class _Open(Generic[Whose]):
    """A bracket that is being narrowed.

    `kept` is the end that stayed last time, whose weight the Illinois rule halves; `widths` are those before the last
    three steps, one each.
    """

    def __init__(self, bracket: Bracket[Whose]) -> None:
        self.bracket = bracket
        self.weights = (bracket.at_low, bracket.at_high)
        self.kept = ""
        self.widths = (math.inf,) * 3

    @property
    def width(self) -> float:
        """How far its ends are apart."""
        return abs(self.bracket.high - self.bracket.low)

    def next_value(self) -> float:
        """Return the value to look at next, within the bracket."""
        low, high = self.bracket.low, self.bracket.high
        at_low, at_high = self.weights
        is_slow = 2 * self.width > self.widths[0]
        if not is_slow and math.isfinite(at_low) and math.isfinite(at_high):
            value = (low * at_high - high * at_low) / (at_high - at_low)
            if min(low, high) < value < max(low, high):
                return value
        return (low + high) / 2

    def narrow(self, value: float, number: float) -> None:
        """Let a value take the place of the end whose number has its sign."""
        bracket, (at_low, at_high) = self.bracket, self.weights
        self.widths = (*self.widths[1:], self.width)
        if (number > 0) == (bracket.at_low > 0):
            self.bracket = replace(bracket, low=value, at_low=number)
            self.weights = (number, at_high / 2 if self.kept == "high" else at_high)
            self.kept = "high"
        else:
            self.bracket = replace(bracket, high=value, at_high=number)
            self.weights = (at_low / 2 if self.kept == "low" else at_low, number)
            self.kept = "low"

    def has_ended(self, small: float) -> bool:
        """Return whether the number is known to be 0 at an end, or the ends are as near as they need be."""
        bracket = self.bracket
        if min(abs(bracket.at_low), abs(bracket.at_high)) <= small:
            return True
        return self.width <= _NEAR * max(abs(bracket.low), abs(bracket.high))
