"""Worksheet functions of expressions that carry their value: each is evaluated as Excel would."""

from __future__ import annotations

import bisect
import math
import statistics
from collections.abc import Callable, Sequence
from typing import Any

from scipy.special import ndtr, ndtri
from xlsxwriter.utility import quote_sheetname

from flexlash.report.formula.live import Live, Operand, Value, call, is_error, live, when

__all__ = [
    "PI",
    "all_of",
    "any_of",
    "cosine",
    "count_up_to",
    "decimal_logarithm",
    "decimals_to",
    "elsewhere",
    "entry_of",
    "exponential",
    "filled",
    "fixed",
    "greatest",
    "greatest_in",
    "is_number",
    "least",
    "least_in",
    "logarithm",
    "magnitude",
    "middle",
    "negation",
    "normal_score",
    "normal_share",
    "number_in",
    "place_of_first",
    "place_of_greatest",
    "place_of_name",
    "root",
    "sine",
    "total",
    "whole",
]

PI = Live("PI()", math.pi)


def root(argument: Operand) -> Live:
    """Return a square root."""
    return _of_number("SQRT", argument, math.sqrt)


def sine(argument: Operand) -> Live:
    """Return a sine."""
    return _of_number("SIN", argument, math.sin)


def cosine(argument: Operand) -> Live:
    """Return a cosine."""
    return _of_number("COS", argument, math.cos)


def exponential(argument: Operand) -> Live:
    """Return a power of e."""
    return _of_number("EXP", argument, math.exp)


def decimal_logarithm(argument: Operand) -> Live:
    """Return a logarithm to the base of ten."""
    return _of_number("LOG10", argument, math.log10)


def logarithm(argument: Operand) -> Live:
    """Return a natural logarithm."""
    return _of_number("LN", argument, math.log)


def normal_share(score: Operand) -> Live:
    """Return the share of a standard normal below a score."""
    one = _of_number("", score, lambda number: float(ndtr(number)))
    return call("_xlfn.NORM.S.DIST", [score, Live("TRUE", value=True)], one.value)


def normal_score(share: Operand) -> Live:
    """Return the score that this share of a standard normal stays below."""
    return _of_number("_xlfn.NORM.S.INV", share, lambda one: float(ndtri(one)))


def least(*operands: Operand) -> Live:
    """Return the least of numbers."""
    return _of_numbers("MIN", operands, min)


def greatest(*operands: Operand) -> Live:
    """Return the greatest of numbers."""
    return _of_numbers("MAX", operands, max)


def middle(*operands: Operand) -> Live:
    """Return the middle one of an odd number of numbers."""
    return _of_numbers("MEDIAN", operands, statistics.median)


def _of_number(name: str, argument: Operand, work: Callable[[float], float]) -> Live:
    one = live(argument)
    if isinstance(one.value, str):
        return call(name, [one], one.value if is_error(one.value) else "#VALUE!")
    return call(name, [one], work(one.number))


def _of_numbers(name: str, operands: Sequence[Operand], work: Callable[[list[Any]], float]) -> Live:
    values = [live(one).value for one in operands]
    texts = [value for value in values if isinstance(value, str)]
    if texts:
        return call(name, operands, next(filter(is_error, texts), "#VALUE!"))
    return call(name, operands, float(work(values)))


def fixed(number: Operand, decimals: Operand) -> Live:
    """Return a number as a text: FIXED, since the letters of TEXT differ between languages of Excel.

    Fewer than no decimals round to tens, hundreds, and so on.
    """
    one, places = live(number), live(decimals)
    digits = int(places.number)
    value = (
        one.value
        if is_error(one.value)
        else f"{round(one.number, digits) if digits < 0 else one.number:.{max(digits, 0)}f}"
    )
    return call("FIXED", [one, places, Live("TRUE", value=True)], value)


def decimals_to(error: Live, otherwise: float, most: float = 8.0) -> Live:
    """Return to how many decimals a number is told with this standard error; `otherwise` where it has none.

    The formula of `number_words.places`.
    """
    known = when(is_number(error), when(error > 0.0, error, 0.0), 0.0)
    told = least(most, 0.0 - whole(decimal_logarithm(when(error.equals(0.0), 1.0, error))))
    return when(known > 0.0, told, otherwise)


def is_number(what: Live) -> Live:
    """Return whether an expression is a number; a blank cell is none."""
    number = isinstance(what.value, int | float) and not isinstance(what.value, bool)
    return call("ISNUMBER", [what], number)


def whole(number: Live) -> Live:
    """Return the whole number at or below a number."""
    return _of_number("INT", number, lambda value: float(math.floor(value)))


def entry_of(cells: str, place: Live, values: Sequence[Value]) -> Live:
    """Return the entry at a place, from 1, of a range that holds these values."""
    return Live(f"INDEX({cells},{place.text})", values[int(place.number) - 1])


def count_up_to(wanted: Live, cells: str, values: Sequence[float]) -> Live:
    """Return how many numbers of a rising range, which holds these values, do not exceed the wanted one."""
    count = float(bisect.bisect_right(values, wanted.number))
    return Live(f"IFERROR(MATCH({wanted.text},{cells},1),0)", count)


def place_of_name(name: Live, names: str, all_names: Sequence[str]) -> Live:
    """Return the place, from 1, of a name in a range, 0 for none: MATCH alone takes * and ? for any letters.

    A range is to be looked up at a place of at least 1, since INDEX returns all of it at 0.
    """
    value = float(all_names.index(str(name.value)) + 1) if name.value in all_names else 0.0
    return Live(f'IFERROR(MATCH(TRUE,INDEX(EXACT({names},{name.text}&""),0),0),0)', value)


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
