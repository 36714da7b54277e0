"""Worksheet functions over ranges, and questions to cells, for formulas that carry their value."""

from __future__ import annotations

import math
from collections.abc import Sequence

from xlsxwriter.utility import quote_sheetname

from flexlash.report.live import Live, Operand, Value, call, live

__all__ = [
    "PI",
    "all_of",
    "any_of",
    "elsewhere",
    "filled",
    "greatest_in",
    "is_number",
    "least_in",
    "magnitude",
    "negation",
    "number_in",
    "place_of_first",
    "place_of_greatest",
    "total",
]

PI = Live("PI()", math.pi)


def elsewhere(sheet: str, cell: Live) -> Live:
    """Return a reference to a cell as another sheet writes it.

    >>> elsewhere("Trace steps", Live("$B$4", 2.0)).text
    "'Trace steps'!$B$4"
    """
    return Live(f"{quote_sheetname(sheet)}!{cell.text}", cell.value)


def total(cells: str, values: Sequence[float]) -> Live:
    """Return the sum of a range that holds these values."""
    return Live(f"SUM({cells})", math.fsum(values))


def greatest_in(cells: str, values: Sequence[float]) -> Live:
    """Return the greatest number of a range that holds these values."""
    return Live(f"MAX({cells})", max(values))


def least_in(cells: str, values: Sequence[float]) -> Live:
    """Return the least number of a range that holds these values."""
    return Live(f"MIN({cells})", min(values))


def place_of_greatest(cells: str, values: Sequence[float]) -> Live:
    """Return the place, from 1, of the first greatest number of a range that holds these values."""
    return Live(f"MATCH(MAX({cells}),{cells},0)", float(1 + max(range(len(values)), key=lambda place: values[place])))


def filled(cells: str, values: Sequence[Value]) -> Live:
    """Return how many cells of a range that holds these values are not blank."""
    return Live(f"COUNTA({cells})", float(sum(value != "" for value in values)))


def magnitude(operand: Operand) -> Live:
    """Return a number without its sign."""
    one = live(operand)
    return call("ABS", [one], one.value if isinstance(one.value, str) else abs(one.number))


def is_number(operand: Live) -> Live:
    """Return whether a cell holds a number."""
    return call("ISNUMBER", [operand], isinstance(operand.value, float | int))


def number_in(cell: Live) -> Live:
    """Return the number that a cell holds, 0 for a text."""
    return call("N", [cell], 0.0 if isinstance(cell.value, str) else cell.number)


def place_of_first(wanted: float, cells: str, values: Sequence[float]) -> Live:
    """Return the place, from 1, of the first such number of a range that holds these values, 0 for none."""
    place = values.index(wanted) + 1 if wanted in values else 0
    return Live(f"IFERROR(MATCH({live(wanted).text},{cells},0),0)", float(place))


def negation(condition: Live) -> Live:
    """Return whether a condition does not hold."""
    return call("NOT", [condition], not condition.value)


def all_of(*conditions: Live) -> Live:
    """Return whether all conditions hold."""
    return call("AND", conditions, all(one.value for one in conditions))


def any_of(*conditions: Live) -> Live:
    """Return whether at least one condition holds."""
    return call("OR", conditions, any(one.value for one in conditions))
