"""ISO 286 and ISO 2768 grades as limit deviations."""

from __future__ import annotations

import math
import re
from bisect import bisect_left
from collections.abc import Callable
from functools import cache
from typing import TypeVar

import numpy as np

from flexlash.schema import tables
from flexlash.schema.arrays import Array

__all__ = ["deviations", "deviations_of", "is_grade"]

_GRADE = re.compile(r"(IT|js|JS|h|H)(5|6|7|8|9|10|11|12)")
_GENERAL = re.compile(r"2768-([fmcv])")


def is_grade(text: str) -> bool:
    """Whether a text is a grade that the tables can hold.

    >>> is_grade("h7"), is_grade("IT13"), is_grade("2768-m")
    (True, False, True)
    """
    return bool(_GRADE.fullmatch(text) or _GENERAL.fullmatch(text))


@cache
def _entries(table: str, column: str) -> tuple[list[float], list[float], list[float]]:
    """Return the bounds of a table's sizes [mm], over the first and up to the second, and the entries between them.

    The last, without end, stands for what is beyond the table; an entry that is not there is NaN.
    """
    rows = [(float(row["over_mm"]), float(row["up_to_mm"]), float(row[column] or "nan")) for row in tables.rows(table)]
    over, up_to, entries = zip(*rows, (math.inf, math.inf, math.nan), strict=True)
    return [*over], [*up_to], [*entries]


def _cell(table: str, column: str, size: float) -> float:
    """Entry for a size [mm] over one bound, up to and including the next; NaN where there is none."""
    over, up_to, entries = _entries(table, column)
    place = bisect_left(up_to, size)
    return entries[place] if over[place] < size or over[place] == size > 0 else math.nan


def _cells(table: str, column: str, sizes: Array) -> Array:
    """Entries for many sizes [mm], as `_cell`."""
    over, up_to, entries = (np.array(bounds) for bounds in _entries(table, column))
    place = np.searchsorted(up_to, sizes)
    return np.where((over[place] < sizes) | ((over[place] == sizes) & (sizes > 0)), entries[place], np.nan)


def deviations(grade: str, size: float) -> tuple[float, float] | None:
    """Return lower and upper deviation [m] of a diameter or length of this size [m], or None if untabulated.

    ITn and jsn share the width evenly, hn takes it downwards, Hn upwards; 2768-x is ± its entry.

    >>> deviations("H7", 0.160)
    (0.0, 4e-05)
    >>> deviations("2768-m", 0.0016)
    (-0.0001, 0.0001)
    """
    lower, upper = _between(grade, _cell, round(size * 1e3, 9))
    return None if math.isnan(lower + upper) else (lower, upper)


def deviations_of(grade: str, sizes: Array) -> tuple[Array, Array]:
    """Return lower and upper deviations [m] of many diameters or lengths [m], as `deviations`; NaN if untabulated.

    >>> deviations_of("H7", np.array([0.160, 99.0]))
    (array([ 0., nan]), array([4.e-05,    nan]))
    """
    # Not by NumPy, which rounds a half otherwise.
    return _between(grade, _cells, np.array([round(size, 9) for size in (sizes * 1e3).tolist()]))


_Sizes = TypeVar("_Sizes", float, Array)


def _between(grade: str, entries: Callable[[str, str, _Sizes], _Sizes], millimetres: _Sizes) -> tuple[_Sizes, _Sizes]:
    """Return lower and upper deviations [m] at sizes [mm], NaN if untabulated."""
    if general := _GENERAL.fullmatch(grade):
        half = entries("iso2768", general[1], millimetres) / 1e3
        return -half, half
    fundamental = _GRADE.fullmatch(grade)
    if fundamental is None:
        raise ValueError(f"{grade!r} is not a tolerance grade")
    width = entries("iso286", f"IT{fundamental[2]}", millimetres) / 1e6
    nothing = 0 * width
    if fundamental[1] == "h":
        return -width, nothing
    return (nothing, width) if fundamental[1] == "H" else (-width / 2, width / 2)
