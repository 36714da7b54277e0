"""Formulas of the report that carry their own value: written once, evaluated as they are built.

A `Live` is an Excel expression with what it comes to. Arithmetic on Lives gives Lives, so that a sheet's numbers are
worked out by the very operations that its cells show, and every cell is stored with its result.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from xlsxwriter.utility import xl_rowcol_to_cell

__all__ = ["PI", "Live", "Operand", "Range", "Value", "call", "fill", "is_error", "live", "put"]

Value: TypeAlias = float | str | bool
Operand: TypeAlias = "Live | float | str"

_ATOM, _POWER, _PRODUCT, _SUM, _TEXT, _COMPARISON = range(6)
"""Kinds of expression; one needs parentheses inside a kind that binds closer."""

_DIGITS = 15
"""Digits of a constant that Excel keeps."""


@dataclass(frozen=True)
class Live:
    """An Excel expression without its equals sign, what it comes to, and how loosely its last operation binds."""

    text: str
    value: Value
    kind: int = _ATOM

    __array_ufunc__ = None
    """NumPy's numbers and arrays leave arithmetic with a formula to the formula."""

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

    def followed_by(self, other: Operand) -> Live:
        """Return the text of both, joined by Excel's sign &."""
        return _both(self, "&", other, _TEXT, lambda text, end: f"{text}{end}")

    @property
    def number(self) -> float:
        """The value of an expression that is a number; raise TypeError for others."""
        if isinstance(self.value, bool) or not isinstance(self.value, int | float):
            raise TypeError(f"{self.text} is {self.value!r}, not a number")
        return float(self.value)


@dataclass(frozen=True)
class Range:
    """A range of cells as a formula writes it, and what they hold; "" is a blank."""

    text: str
    values: Sequence[Value]


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
    return _notation(operand) or Live(_digits(operand), float(operand), _ATOM if operand >= 0 else _SUM)


PI = Live("PI()", math.pi)

_NOTATIONS: tuple[tuple[Callable[[float], float], Callable[[Live], Live]], ...] = (
    (lambda number: number / math.pi, lambda plain: plain * PI),
    (lambda number: number / math.pi**2, lambda plain: plain * PI**2.0),
    (lambda number: number * number, lambda plain: call("SQRT", [plain], math.sqrt(plain.number))),
    (lambda number: number**0.75, lambda plain: plain ** (live(4.0) / 3.0)),
)
"""Ways to write a constant, each with how its plain number is found."""


def _notation(number: float) -> Live | None:
    """Return a constant of more digits than Excel keeps by way of a plain number, where one comes to the very same.

    >>> live(2 * math.pi), live(math.sqrt(3)).text, live(0.67 ** (4 / 3)).text
    (Live(text='2*PI()', value=6.283185307179586, kind=2), 'SQRT(3)', '0.67^(4/3)')
    """
    if number <= 0 or float(f"{number:.{_DIGITS}g}") == number:
        return None
    ways = (write(live(float(f"{plain(number):.6g}"))) for plain, write in _NOTATIONS)
    return next((formula for formula in ways if formula.value == number), None)


def _digits(number: float) -> str:
    """Return a number with as many digits as make it what it is, within what Excel reads."""
    return f"{number:.0f}" if number == int(number) and abs(number) < 1e15 else repr(float(number)).replace("e", "E")  # noqa: PLR2004


def _both(left: Live, sign: str, other: Operand, kind: int, work: Callable[[Any, Any], Any]) -> Live:
    """Return two expressions joined by a sign; errors of either pass through, and a text is no number."""
    right = live(other)
    values = left.value, right.value
    if failed := [value for value in values if is_error(value)]:
        value = failed[0]
    elif kind == _COMPARISON:
        value = work(*map(_rank, values))
    elif kind == _TEXT:
        value = work(*values)
    else:
        value = "#VALUE!" if any(isinstance(value, str) for value in values) else work(*values)
    # Programs differ in which power of several comes first.
    first = _within(left, kind - 1 if kind == _POWER else kind)
    return Live(f"{first}{sign}{_within(right, kind - 1)}", value, kind)


def _rank(value: Value) -> tuple[int, Value]:
    """Return what Excel compares: any text is more than any number, letter case does not count."""
    if isinstance(value, str):
        return 1, value.casefold()
    return (2 if isinstance(value, bool) else 0), value


def _within(side: Live, kind: int) -> str:
    """Return an expression as it stands inside another kind of expression."""
    return f"({side.text})" if side.kind > kind else side.text


def is_error(value: Value) -> bool:
    """Return whether a value is one of Excel's error words."""
    return isinstance(value, str) and value.startswith("#")


def _ratio(dividend: float, divisor: float) -> Value:
    return dividend / divisor if divisor else "#DIV/0!"


def _power(base: float, exponent: float) -> Value:
    try:
        power = base**exponent
    except (ZeroDivisionError, OverflowError):
        return "#NUM!"
    return power if isinstance(power, float) else "#NUM!"


def call(name: str, arguments: Sequence[Operand], value: Value) -> Live:
    """Return a worksheet function of expressions with the value it has."""
    return Live(f"{name}({','.join(live(argument).text for argument in arguments)})", value)


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
