"""The mechanics' closed forms worked with live operands: the formula that a sheet shows is the program's own.

They are written with operators and the functions of `mechanics/elementary.py`, which are told here what to do with a
formula. Lengths go in as mm, moduli and stresses as MPa or GPa: each form says in its line which unit comes out.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any, cast

from flexlash.mechanics import elementary
from flexlash.report.formula.functions import ABS, IF, LN, MAX, MIN, SIN, SQRT, TAN
from flexlash.report.formula.live import Live, Operand, live

__all__ = ["worked"]


def worked(closed_form: Callable[..., Any], *operands: Operand, **named: Operand) -> Live:
    """Return what a closed form of the mechanics comes to, as the formula that it works with these operands.

    >>> from flexlash.mechanics.windup import wall_integral
    >>> worked(wall_integral, Live("B1", 8.0), Live("B2", 2.0), 0.5)
    Live(text='B1/(B2*B2*B2*0.5)', value=2.0, kind=2)
    """
    return cast("Live", closed_form(*map(live, operands), **{name: live(operand) for name, operand in named.items()}))


def _box_cox(base: Live, exponent: Live) -> Live:
    """Return (x^p − 1)/p as Kahan writes it, which keeps its digits as p vanishes."""
    power, logarithm = base**exponent, LN(base)
    return IF(power.equals(1.0), logarithm, (power - 1) * logarithm / LN(power))


for _function, _answer in (
    (elementary.absolute, ABS),
    (elementary.sqrt, SQRT),
    (elementary.log, LN),
    (elementary.sin, SIN),
    (elementary.tan, TAN),
    (elementary.power, operator.pow),
    (elementary.box_cox, _box_cox),
    (elementary.maximum, MAX),
    (elementary.minimum, MIN),
    (elementary.where, IF),
):
    _function.register(Live, cast("Any", _answer))
