"""Formulas of the report that carry their own value: written once, evaluated as they are built.

A `Live` is an Excel expression with what it comes to. Arithmetic on Lives gives Lives, so that a sheet's numbers are
worked out by the very operations that its cells show, and every cell is stored with its result.
"""

from __future__ import annotations

import bisect
import math
import operator
import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from scipy.special import ndtr, ndtri
from xlsxwriter.utility import xl_rowcol_to_cell

__all__ = [
    "MISSING",
    "Live",
    "Operand",
    "Value",
    "both",
    "call",
    "cosine",
    "count_up_to",
    "decimal_logarithm",
    "entry_of",
    "exponential",
    "fill",
    "first_of",
    "fixed",
    "greatest",
    "is_number",
    "joined",
    "least",
    "live",
    "logarithm",
    "middle",
    "normal_score",
    "normal_share",
    "place_of_name",
    "put",
    "root",
    "sine",
    "when",
    "whole",
]

Value: TypeAlias = float | str | bool
Operand: TypeAlias = "Live | float | str"

MISSING = "#N/A"
"""What a cell shows that has nothing to draw: charts leave a gap."""

_ATOM, _POWER, _PRODUCT, _SUM, _TEXT, _COMPARISON = range(6)
"""Kinds of expression; one needs parentheses inside a kind that binds closer."""


@dataclass(frozen=True)
class Live:
    """An Excel expression without its equals sign, what it comes to, and how loosely its last operation binds."""

    text: str
    value: Value
    kind: int = _ATOM

    def __add__(self, other: Operand) -> Live:
        return _both(self, "+", other, _SUM, operator.add)

    def __radd__(self, other: Operand) -> Live:
        return live(other) + self

    def __sub__(self, other: Operand) -> Live:
        return _both(self, "-", other, _SUM, operator.sub)

    def __rsub__(self, other: Operand) -> Live:
        return live(other) - self

    def __mul__(self, other: Operand) -> Live:
        return _both(self, "*", other, _PRODUCT, operator.mul)

    def __rmul__(self, other: Operand) -> Live:
        return live(other) * self

    def __truediv__(self, other: Operand) -> Live:
        return _both(self, "/", other, _PRODUCT, _ratio)

    def __rtruediv__(self, other: Operand) -> Live:
        return live(other) / self

    def __pow__(self, other: Operand) -> Live:
        return _both(self, "^", other, _POWER, _power)

    def __neg__(self) -> Live:
        return live(0.0) - self

    def __lt__(self, other: Operand) -> Live:
        return _both(self, "<", other, _COMPARISON, operator.lt)

    def __le__(self, other: Operand) -> Live:
        return _both(self, "<=", other, _COMPARISON, operator.le)

    def __gt__(self, other: Operand) -> Live:
        return _both(self, ">", other, _COMPARISON, operator.gt)

    def __ge__(self, other: Operand) -> Live:
        return _both(self, ">=", other, _COMPARISON, operator.ge)

    def equals(self, other: Operand) -> Live:
        """Return whether both are the same, as Excel compares them: letter case does not count."""
        return _both(self, "=", other, _COMPARISON, operator.eq)

    @property
    def number(self) -> float:
        """The value of an expression that is a number; raise TypeError for others."""
        if isinstance(self.value, bool) or not isinstance(self.value, int | float):
            raise TypeError(f"{self.text} is {self.value!r}, not a number")
        return float(self.value)


def live(operand: Operand) -> Live:
    """Return a constant as an expression.

    >>> live(2.0) * (live(3.0) + 1)
    Live(text='2*(3+1)', value=8.0, kind=2)
    """
    if isinstance(operand, Live):
        return operand
    if isinstance(operand, str):
        doubled = operand.replace('"', '""')
        return Live(f'"{doubled}"', operand)
    return Live(_digits(operand), float(operand), _ATOM if operand >= 0 else _SUM)


def _digits(number: float) -> str:
    """Return a number with as many digits as make it what it is, within what Excel reads."""
    return f"{number:.0f}" if number == int(number) and abs(number) < 1e15 else repr(float(number)).replace("e", "E")  # noqa: PLR2004


def _both(one: Live, sign: str, other: Operand, kind: int, work: Callable[[Any, Any], Any]) -> Live:
    """Return two expressions joined by a sign; errors of either pass through, and a text is no number."""
    second = live(other)
    values = one.value, second.value
    if failed := [value for value in values if _is_error(value)]:
        value = failed[0]
    elif kind == _COMPARISON:
        value = work(*map(_rank, values))
    else:
        value = "#VALUE!" if any(isinstance(value, str) for value in values) else work(*values)
    return Live(f"{_within(one, kind)}{sign}{_within(second, kind - 1)}", value, kind)


def _rank(value: Value) -> tuple[int, Value]:
    """Return what Excel compares: any text is more than any number, letter case does not count."""
    if isinstance(value, str):
        return 1, value.casefold()
    return (2 if isinstance(value, bool) else 0), value


def _within(side: Live, kind: int) -> str:
    """Return an expression as it stands inside another kind of expression."""
    return f"({side.text})" if side.kind > kind else side.text


def _is_error(value: Value) -> bool:
    return isinstance(value, str) and value.startswith("#")


def _ratio(one: float, two: float) -> Value:
    return one / two if two else "#DIV/0!"


def _power(one: float, two: float) -> Value:
    try:
        found = one**two
    except (ZeroDivisionError, OverflowError):
        return "#NUM!"
    return found if isinstance(found, float) else "#NUM!"


def call(name: str, arguments: Sequence[Operand], value: Value) -> Live:
    """Return a worksheet function of expressions with the value it has."""
    return Live(f"{name}({','.join(live(one).text for one in arguments)})", value)


def _of_number(name: str, argument: Operand, work: Callable[[float], float]) -> Live:
    one = live(argument)
    if isinstance(one.value, str):
        return call(name, [one], one.value if _is_error(one.value) else "#VALUE!")
    return call(name, [one], work(one.number))


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


def _of_numbers(name: str, operands: Sequence[Operand], work: Callable[[list[Any]], float]) -> Live:
    values = [live(one).value for one in operands]
    texts = [value for value in values if isinstance(value, str)]
    if texts:
        return call(name, operands, next(filter(_is_error, texts), "#VALUE!"))
    return call(name, operands, float(work(values)))


def joined(*texts: Live | str) -> Live:
    """Return texts one after the other; `fixed` makes a text of a number."""
    parts = [live(one) for one in texts]
    failed = next((one.value for one in parts if _is_error(one.value)), None)
    value = "".join(str(one.value) for one in parts) if failed is None else failed
    return Live("&".join(_within(one, _SUM) for one in parts), value, _TEXT)


def fixed(number: Operand, decimals: Operand) -> Live:
    """Return a number as a text: FIXED, since the letters of TEXT differ between languages of Excel."""
    one, places = live(number), live(decimals)
    value = one.value if _is_error(one.value) else f"{one.number:.{int(places.number)}f}"
    return call("FIXED", [one, places, Live("TRUE", value=True)], value)


def is_number(what: Live) -> Live:
    """Return whether an expression is a number; a blank cell is none."""
    number = isinstance(what.value, int | float) and not isinstance(what.value, bool)
    return call("ISNUMBER", [what], number)


def both(one: Live, other: Live) -> Live:
    """Return whether two conditions hold."""
    return call("AND", [one, other], bool(one.value) and bool(other.value))


def whole(number: Live) -> Live:
    """Return the whole number at or below a number."""
    return _of_number("INT", number, lambda value: float(math.floor(value)))


def when(condition: Live, then: Operand, otherwise: Operand) -> Live:
    """Return one of two expressions."""
    one, two = live(then), live(otherwise)
    value = condition.value if _is_error(condition.value) else (one if condition.value else two).value
    return call("IF", [condition, one, two], value)


def first_of(wanted: Live, otherwise: Operand) -> Live:
    """Return an expression, or another one where it is an error."""
    two = live(otherwise)
    return call("IFERROR", [wanted, two], two.value if _is_error(wanted.value) else wanted.value)


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


def put(sheet: Any, row: int, column: int, what: Live, style: Any) -> Live:
    """Write an expression into a cell with its value and return a reference to that cell."""
    value = what.value
    sheet.write_formula(row, column, f"={what.text}", style, float(value) if isinstance(value, bool) else value)
    return Live(xl_rowcol_to_cell(row, column, row_abs=True, col_abs=True), value)


def fill(sheet: Any, row: int, column: int, entry: float | str, style: Any) -> Live:
    """Write what a reader may change, or a constant, into a cell and return a reference to it; blank for no text."""
    if isinstance(entry, str):
        sheet.write_string(row, column, entry, style) if entry else sheet.write_blank(row, column, None, style)
    else:
        sheet.write_number(row, column, entry, style)
    return Live(xl_rowcol_to_cell(row, column, row_abs=True, col_abs=True), entry)
