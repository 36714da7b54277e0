"""Elementary functions for the mechanics: of numbers, of arrays, and of operands that print their own formula.

NumPy's exp, log and sin may round otherwise at another place of an array; SciPy's special functions do not. With these,
the four operations and nothing else, a variant's numbers do not depend on its neighbours. Whoever brings another kind
of operand registers what each function does with it (`functools.singledispatch`, by the first argument); the report's
live formulas do, in `report/formula/closed_forms.py`.
"""

from __future__ import annotations

from functools import singledispatch

import numpy as np
from scipy.special import boxcox, expm1, sindg, tandg, xlogy

from flexlash.schema.arrays import Array, Condition, Quantity

__all__ = ["absolute", "box_cox", "exp", "log", "maximum", "minimum", "power", "sin", "sqrt", "tan", "where"]


@singledispatch
def absolute(number: Quantity) -> Array:
    """Absolute value |x|."""
    return np.asarray(np.abs(number))


@singledispatch
def sqrt(number: Quantity) -> Array:
    """Square root √x."""
    return np.asarray(np.sqrt(number))


@singledispatch
def exp(number: Quantity) -> Array:
    """Exponential e^x."""
    return np.asarray(expm1(number) + 1)


@singledispatch
def log(number: Quantity) -> Array:
    """Natural logarithm ln x."""
    return np.asarray(boxcox(number, 0.0))


@singledispatch
def power(base: Quantity, exponent: Quantity) -> Array:
    """Power x^p of a positive base; 0^0 is 1. It is exact to its last digits where it is above 1."""
    return exp(np.asarray(xlogy(exponent, base), np.float64))


@singledispatch
def box_cox(base: Quantity, exponent: Quantity) -> Array:
    """Box–Cox function (x^p − 1)/p, ln x at p = 0, steady as p vanishes."""
    return np.asarray(boxcox(base, exponent))


@singledispatch
def sin(angle: Quantity) -> Array:
    """Sine of an angle [rad]."""
    return np.asarray(sindg(np.asarray(angle) * (180 / np.pi)))


@singledispatch
def tan(angle: Quantity) -> Array:
    """Tangent of an angle [rad]."""
    return np.asarray(tandg(np.asarray(angle) * (180 / np.pi)))


@singledispatch
def maximum(first: Quantity, second: Quantity) -> Array:
    """Greater of two numbers."""
    return np.asarray(np.maximum(first, second))


@singledispatch
def minimum(first: Quantity, second: Quantity) -> Array:
    """Lesser of two numbers."""
    return np.asarray(np.minimum(first, second))


@singledispatch
def where(condition: Condition, then: Quantity, otherwise: Quantity) -> Array:
    """First of two numbers where a condition holds, else the second."""
    return np.asarray(np.where(condition, then, otherwise))
