"""The values of a sweep: decimal arithmetic, so that 0.1 and three steps of 0.1 end at 0.4 and nowhere near it."""

from __future__ import annotations

from collections.abc import Iterator
from decimal import Decimal
from itertools import islice

__all__ = ["MOST_POINTS", "swept_values"]

MOST_POINTS = 2000
"""Most points of all sweeps of a submission, which take about ten seconds."""


def swept_values(first: float, last: float, step: float, most: int = MOST_POINTS) -> tuple[float, ...]:
    """Return the values from the first to the last, `step` apart, the last one where a step ends on it.

    A first value above the last one counts down. Of more than `most` values so many and one more are returned, so that
    whoever asks can tell. Numbers count as they are written, in decimal digits.

    >>> swept_values(100, 200, 20)
    (100.0, 120.0, 140.0, 160.0, 180.0, 200.0)
    >>> swept_values(0.1, 0.4, 0.1), swept_values(2, 1, 0.4)
    ((0.1, 0.2, 0.3, 0.4), (2.0, 1.6, 1.2))
    """
    if not step > 0:
        raise ValueError(f"the step must be greater than 0, not {step:g}")
    return tuple(islice(_values(*(Decimal(repr(float(one))) for one in (first, last, step))), most + 1))


def _values(first: Decimal, last: Decimal, step: Decimal) -> Iterator[float]:
    """Yield the values without an end to how many."""
    way = step if first <= last else -step
    for number in range(int((last - first) / way) + 1):
        yield float(first + number * way)
