"""ISO 286 and ISO 2768 grades as limit deviations."""

from __future__ import annotations

import re

from flexlash.schema import tables

__all__ = ["deviations", "is_grade"]

_GRADE = re.compile(r"(IT|js|JS|h|H)(5|6|7|8|9|10|11|12)")
_GENERAL = re.compile(r"2768-([fmcv])")


def is_grade(text: str) -> bool:
    """Whether a text is a grade that the tables can hold.

    >>> is_grade("h7"), is_grade("IT13"), is_grade("2768-m")
    (True, False, True)
    """
    return bool(_GRADE.fullmatch(text) or _GENERAL.fullmatch(text))


def _cell(table: str, column: str, size: float) -> float | None:
    """Entry for a size [mm] over one bound, up to and including the next; None where there is none."""
    for row in tables.rows(table):
        if float(row["over_mm"]) < size <= float(row["up_to_mm"]) or size == float(row["over_mm"]) > 0:
            return float(row[column]) if row[column] else None
    return None


def deviations(grade: str, size: float) -> tuple[float, float] | None:
    """Return lower and upper deviation [m] of a diameter or length of this size [m], or None if untabulated.

    ITn and jsn share the width evenly, hn takes it downwards, Hn upwards; 2768-x is ± its entry.

    >>> deviations("H7", 0.160)
    (0.0, 4e-05)
    >>> deviations("2768-m", 0.0016)
    (-0.0001, 0.0001)
    """
    millimetres = round(size * 1e3, 9)
    if general := _GENERAL.fullmatch(grade):
        half = _cell("iso2768", general[1], millimetres)
        return None if half is None else (-half / 1e3, half / 1e3)
    fundamental = _GRADE.fullmatch(grade)
    if fundamental is None:
        raise ValueError(f"{grade!r} is not a tolerance grade")
    width = _cell("iso286", f"IT{fundamental[2]}", millimetres)
    if width is None:
        return None
    metres = width / 1e6
    if fundamental[1] == "h":
        return -metres, 0.0
    return (0.0, metres) if fundamental[1] == "H" else (-metres / 2, metres / 2)
