"""The values of a sweep: decimal arithmetic, so that 0.1 and three steps of 0.1 end at 0.4 and nowhere near it."""

from __future__ import annotations

from collections.abc import Iterator
from decimal import Decimal
from itertools import islice

__all__ = ["MOST_POINTS", "swept_count", "swept_values"]

MOST_POINTS = 2000
"""Most points of all sweeps of a submission, which take about ten seconds."""

_REACHED = Decimal("1e-9")
"""Part of a step by which the last value may be missed and counts as reached: a third has no end as a decimal."""


def swept_values(first: float, last: float, step: float, most: int = MOST_POINTS) -> tuple[float, ...]:
    """Return the values from the first to the last, `step` apart, the last one where a step ends on it.

    A first value above the last one counts down. Of more than `most` values so many and one more are returned, so that
    whoever asks can tell. Numbers count as they are written, in decimal digits.

    >>> swept_values(100, 200, 20)
    (100.0, 120.0, 140.0, 160.0, 180.0, 200.0)
    >>> swept_values(0.1, 0.4, 0.1), swept_values(2, 1, 0.4)
    ((0.1, 0.2, 0.3, 0.4), (2.0, 1.6, 1.2))
    """
    return tuple(islice(_values(first, last, step), most + 1))


def swept_count(first: float, last: float, step: float) -> int:
    """Return how many values there are from the first to the last, however many.

    >>> swept_count(100, 200, 20), swept_count(0.1, 0.3, 0.1), swept_count(1, 0, 0.3), swept_count(5, 5, 1)
    (6, 3, 4, 1)
    """
    if not step > 0:
        raise ValueError(f"the step must be greater than 0, not {step:g}")
    return int(abs(_decimal(last) - _decimal(first)) / _decimal(step) + _REACHED) + 1


def _values(first: float, last: float, step: float) -> Iterator[float]:
    """Yield the values without an end to how many."""
    count, start, end, way = swept_count(first, last, step), *map(_decimal, (first, last, step))
    for number in range(count):
        value = start + number * (way if start <= end else -way)
        yield float(end if number == count - 1 and abs(value - end) <= _REACHED * way else value)


def _decimal(value: float) -> Decimal:
    """Return the decimal number that a double is written as."""
    return Decimal(repr(float(value)))
