"""Measured values that lie so far from the others of their sample that a slip is likelier than a part of that size."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

__all__ = ["Odd", "odd_values"]

_FEWEST = 5
"""Fewest values of which one can be told to be odd."""

_FAR = 12.0
"""Standard deviations from the median beyond which a value is odd. Of samples of a normal process fewer than one in a
thousand has one; of those with a tail as long as a lognormal one of the shape 0.5 has, one in a hundred."""

_ENOUGH = 20
"""Values whose middle half tells their scatter; of fewer it is far too small now and then."""

_MANY = 10
"""Of so many values at most one may be odd; where there are more, they are a second group and no slips."""

_OTHER_SIZE = 5.0
"""Times from which a size is another one, however the others scatter."""

_NORMAL = 1.4826
"""Standard deviation of a normal distribution over its median distance from the median."""

_UNITS = (10.0, 0.1, 100.0, 0.01, 1000.0, 0.001, 25.4, 1 / 25.4)
"""What a slipped point, or another unit, multiplies a value by."""


@dataclass(frozen=True, kw_only=True)
class Odd:
    """A value apart from the others, which lie between `least` and `most`; what was probably meant, if anything."""

    least: float
    most: float
    suggestion: str = ""


def odd_values(values: Sequence[float], *, are_sizes: bool) -> dict[int, Odd]:
    """Return which of a sample's values are odd, by their index, in time that grows with their number.

    Equation: |x − median| > 12 max(1, (20/n)^1.5) · 1.4826 · median |x − median|; a size also where it is five times
        the median or a fifth
    Arguments: values as entered, in one unit; `are_sizes` where all of them lie above 0 if they are sound.
    Valid: at least five values, of which at most one in ten is odd; otherwise none is told.

    >>> odd_values([1.607, 1.611, 16.07, 1.604, 1.609, 1.602], are_sizes=True)
    {2: Odd(least=1.602, most=1.611, suggestion='1.607')}
    """
    if len(values) < _FEWEST:
        return {}
    middle = _median(values)
    scale = _NORMAL * _median([abs(value - middle) for value in values])
    far = _FAR * max(1.0, (_ENOUGH / len(values)) ** 1.5) * scale
    odd = {
        index
        for index, value in enumerate(values)
        if (scale > 0 and abs(value - middle) > far) or (are_sizes and _is_other_size(value, middle))
    }
    if not odd or len(odd) > max(1, len(values) // _MANY):
        return {}
    rest = [value for index, value in enumerate(values) if index not in odd]
    least, most = min(rest), max(rest)
    digits = _decimals(rest)
    return {
        index: Odd(least=least, most=most, suggestion=_meant(values[index], least, most, digits))
        for index in sorted(odd)
    }


def _median(values: Sequence[float]) -> float:
    """Return the middle of values in order."""
    ordered, half = sorted(values), len(values) // 2
    return ordered[half] if len(values) % 2 else (ordered[half - 1] + ordered[half]) / 2


def _is_other_size(value: float, middle: float) -> bool:
    """Whether a size is many times another one."""
    return value > 0 and middle > 0 and not middle / _OTHER_SIZE < value < middle * _OTHER_SIZE


def _decimals(values: Sequence[float]) -> int:
    """Return how many decimals values were entered with, of the first hundred."""
    return max(len(f"{value:.10g}".partition(".")[2]) for value in values[:100])


def _meant(value: float, least: float, most: float, digits: int) -> str:
    """Return the one number among the others that a slip of the point, the unit or two digits made a value of."""
    near = (most - least) / 2
    found = {
        f"{candidate:.10g}"
        for candidate in (*(value * factor for factor in _UNITS), *_swapped(value, digits))
        if least - near <= candidate <= most + near
    }
    return found.pop() if len(found) == 1 else ""


def _swapped(value: float, digits: int) -> list[float]:
    """Return the numbers that differ from a value by two neighbouring digits that changed places."""
    text = f"{value:.{digits}f}"
    places = [index for index, letter in enumerate(text) if letter.isdigit()]
    candidates = []
    for first, second in pairwise(places):
        letters = list(text)
        letters[first], letters[second] = letters[second], letters[first]
        candidates.append(float("".join(letters)))
    return candidates
