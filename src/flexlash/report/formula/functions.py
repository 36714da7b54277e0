"""Excel's worksheet functions under Excel's names, of formulas that carry their value, evaluated as Excel would.

Arguments and results are `Live` formulas; ranges are `Range`. An error among the arguments passes through, and a text
where a number is needed gives #VALUE!, as in a sheet.
"""

from __future__ import annotations

import bisect
import math
import statistics
from collections.abc import Callable
from functools import reduce
from typing import Any

from scipy.special import ndtr, ndtri
from xlsxwriter.utility import quote_sheetname

from flexlash.report.formula.live import PI, Live, Operand, Range, Value, call, is_error, live

__all__ = [
    "ABS",
    "AND",
    "CONCATENATE",
    "COS",
    "COUNTA",
    "EXP",
    "FIXED",
    "IF",
    "IFERROR",
    "INDEX",
    "INT",
    "ISNUMBER",
    "LN",
    "LOG10",
    "MATCH",
    "MAX",
    "MEDIAN",
    "MIN",
    "NORM_S_DIST",
    "NORM_S_INV",
    "NOT",
    "OR",
    "PI",
    "SIN",
    "SQRT",
    "SUM",
    "TAN",
    "N",
    "decimals_to",
    "match_exactly",
    "on_sheet",
]


def ABS(number: Operand) -> Live:
    """Return a number without its sign."""
    return _of_number("ABS", number, abs)


def SQRT(number: Operand) -> Live:
    """Return a square root."""
    return _of_number("SQRT", number, math.sqrt)


def SIN(angle: Operand) -> Live:
    """Return the sine of an angle in radians."""
    return _of_number("SIN", angle, math.sin)


def COS(angle: Operand) -> Live:
    """Return the cosine of an angle in radians."""
    return _of_number("COS", angle, math.cos)


def TAN(angle: Operand) -> Live:
    """Return the tangent of an angle in radians."""
    return _of_number("TAN", angle, math.tan)


def EXP(number: Operand) -> Live:
    """Return e to the power of a number."""
    return _of_number("EXP", number, math.exp)


def LN(number: Operand) -> Live:
    """Return a natural logarithm."""
    return _of_number("LN", number, math.log)


def LOG10(number: Operand) -> Live:
    """Return a logarithm to the base of ten."""
    return _of_number("LOG10", number, math.log10)


def INT(number: Operand) -> Live:
    """Return the whole number at or below a number."""
    return _of_number("INT", number, math.floor)


def NORM_S_DIST(score: Operand) -> Live:
    """Return the share of a standard normal distribution below a score."""
    share = _of_number("", score, ndtr).value
    return call("_xlfn.NORM.S.DIST", [score, Live("TRUE", value=True)], share)


def NORM_S_INV(share: Operand) -> Live:
    """Return the score that this share of a standard normal distribution stays below."""
    return _of_number("_xlfn.NORM.S.INV", share, ndtri)


def MIN(*numbers: Operand | Range) -> Live:
    """Return the least of numbers and ranges of numbers."""
    return _of_numbers("MIN", numbers, min)


def MAX(*numbers: Operand | Range) -> Live:
    """Return the greatest of numbers and ranges of numbers."""
    return _of_numbers("MAX", numbers, max)


def MEDIAN(*numbers: Operand | Range) -> Live:
    """Return the middle one of an odd number of numbers."""
    return _of_numbers("MEDIAN", numbers, statistics.median)


def SUM(*numbers: Operand | Range) -> Live:
    """Return the sum of numbers and ranges of numbers."""
    return _of_numbers("SUM", numbers, math.fsum)


def _of_number(name: str, argument: Operand, work: Callable[[float], float]) -> Live:
    return _of_numbers(name, [argument], lambda numbers: work(*numbers))


def _of_numbers(name: str, operands: Any, work: Callable[[list[float]], float]) -> Live:
    """Return a function of numbers, each given by itself or within a range, where texts do not count."""
    arguments = [operand if isinstance(operand, Range) else live(operand) for operand in operands]
    values: list[Value] = []
    for argument in arguments:
        if isinstance(argument, Range):
            values += (value for value in argument.values if not isinstance(value, str) or is_error(value))
        else:
            values.append(argument.value)
    texts = [value for value in values if isinstance(value, str)]
    text = f"{name}({','.join(argument.text for argument in arguments)})"
    if texts:
        return Live(text, next(filter(is_error, texts), "#VALUE!"))
    return Live(text, float(work(list(map(float, values or [0.0])))))


def IF(condition: Live, then: Operand, otherwise: Operand) -> Live:
    """Return one of two formulas; an error in the other one does no harm."""
    chosen = live(then if condition.value else otherwise).value
    return call("IF", [condition, then, otherwise], condition.value if is_error(condition.value) else chosen)


def AND(*conditions: Live) -> Live:
    """Return whether all conditions hold."""
    return call("AND", conditions, all(condition.value for condition in conditions))


def OR(*conditions: Live) -> Live:
    """Return whether at least one condition holds."""
    return call("OR", conditions, any(condition.value for condition in conditions))


def NOT(condition: Live) -> Live:
    """Return whether a condition does not hold."""
    return call("NOT", [condition], not condition.value)


def IFERROR(formula: Live, otherwise: Operand) -> Live:
    """Return a formula, or another one where that is an error."""
    return call("IFERROR", [formula, otherwise], live(otherwise).value if is_error(formula.value) else formula.value)


def ISNUMBER(formula: Live) -> Live:
    """Return whether a formula is a number; a blank cell is none."""
    return call("ISNUMBER", [formula], isinstance(formula.value, int | float) and not isinstance(formula.value, bool))


def N(cell: Live) -> Live:
    """Return the number that a cell holds, 0 for a text."""
    return call("N", [cell], 0.0 if isinstance(cell.value, str) else cell.number)


def FIXED(number: Operand, decimals: Operand) -> Live:
    """Return a number as a text; TEXT would take other letters in other languages of Excel.

    Fewer than no decimals round to tens, hundreds, and so on.
    """
    shown, digits = live(number), int(live(decimals).number)
    value = shown.value
    if not is_error(value):
        value = f"{round(shown.number, digits) if digits < 0 else shown.number:.{max(digits, 0)}f}"
    return call("FIXED", [shown, decimals, Live("TRUE", value=True)], value)


def CONCATENATE(first: Operand, *others: Operand) -> Live:
    """Return texts one after the other, joined by Excel's sign &; FIXED makes a text of a number."""
    return reduce(Live.followed_by, others, live(first))


def INDEX(cells: Range, number: Operand) -> Live:
    """Return the entry of a range by its number, from 1."""
    entry = live(number)
    return Live(f"INDEX({cells.text},{entry.text})", cells.values[int(entry.number) - 1])


def MATCH(wanted: Operand, cells: Range, kind: int) -> Live:
    """Return the number, from 1, of the first entry that is wanted (kind 0) or of the last not above it (kind 1).

    The numbers of the range rise for kind 1.
    """
    entry, entries = live(wanted), list(cells.values)
    first = entries.index(entry.value) + 1 if entry.value in entries else 0
    number = bisect.bisect_right(entries, entry.number, key=float) if kind else first
    return Live(f"MATCH({entry.text},{cells.text},{kind})", float(number) if number else "#N/A")


def COUNTA(cells: Range) -> Live:
    """Return how many cells of a range are not blank."""
    return Live(f"COUNTA({cells.text})", float(sum(value != "" for value in cells.values)))


def match_exactly(name: Live, names: Range) -> Live:
    """Return the number, from 1, of a name in a range, 0 for none: MATCH alone takes * and ? for any letters.

    A range is to be looked up at a number of at least 1, since INDEX returns all of it at 0.
    """
    value = float(list(names.values).index(name.value) + 1) if name.value in names.values else 0.0
    return Live(f'IFERROR(MATCH(TRUE,INDEX(EXACT({names.text},{name.text}&""),0),0),0)', value)


def decimals_to(error: Live, otherwise: float, most: float = 8.0) -> Live:
    """Return to how many decimals a number is told with this standard error; `otherwise` where it has none.

    The formula of `number_words.places`.
    """
    known = IF(ISNUMBER(error), IF(error > 0.0, error, 0.0), 0.0)
    told = MIN(most, 0.0 - INT(LOG10(IF(error.equals(0.0), 1.0, error))))
    return IF(known > 0.0, told, otherwise)


def on_sheet(sheet: str, cell: Live) -> Live:
    """Return a reference to a cell as another sheet writes it.

    >>> on_sheet("Trace steps", Live("$B$4", 2.0)).text
    "'Trace steps'!$B$4"
    """
    return Live(f"{quote_sheetname(sheet)}!{cell.text}", cell.value)
