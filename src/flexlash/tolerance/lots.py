"""Lots and parts: how a spread divides where some inputs are one value for a whole lot.

lot                 parts that share the values of the inputs `between` lots
within a lot        how its parts scatter: within² = E[Var(Y | lot)]
between lots        how their means scatter: between² = Var(E[Y | lot]), so that within² + between² = sd²
a lot fails         where more than an acceptable share of its parts lies above a limit
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from flexlash.schema.arrays import Array

__all__ = ["AllLots", "AllParts", "Division", "Lots", "OverLimit", "step_at"]

OverLimit = Callable[[float], tuple[float, float]]
"""The probability above a limit, and its standard error."""


@dataclass(frozen=True, kw_only=True)
class Division:
    """Standard deviations within lots and between them, and their standard errors, as parts of the whole sd."""

    within: float
    between: float
    within_error: float = 0.0
    between_error: float = 0.0


class Lots(ABC):
    """How lots and parts divide a spread."""

    @property
    @abstractmethod
    def division(self) -> Division:
        """How the standard deviation is divided."""

    @abstractmethod
    def failing(self, limit: float, acceptable: float, over: OverLimit) -> tuple[float, float]:
        """Return the share of lots with more than the acceptable share of parts over a limit, and its standard error.

        `over` gives the probability over a limit of all parts together.
        """


class AllParts(Lots):
    """Every part draws all inputs: all lots are alike, and fail together or not at all."""

    division = Division(within=1.0, between=0.0)

    def failing(self, limit: float, acceptable: float, over: OverLimit) -> tuple[float, float]:
        """Return 1 or 0: whether more than the acceptable share of all parts lies over the limit."""
        probability, error = over(limit)
        share, unsure = step_at(np.array(probability - acceptable), np.array(error))
        return float(share), float(unsure)


class AllLots(Lots):
    """All inputs are one value for a whole lot: its parts are alike."""

    division = Division(within=0.0, between=1.0)

    def failing(self, limit: float, acceptable: float, over: OverLimit) -> tuple[float, float]:
        """Return the probability over the limit: all parts of a lot lie over it, or none."""
        return over(limit) if acceptable < 1 else (0.0, 0.0)


def step_at(apart: Array, error: Array) -> tuple[Array, Array]:
    """Return 1 where a difference is above 0, else 0, and how unsure that is: the sd of a step known with this error.

    Equation: √(Φ(z) Φ(−z)), z = difference/error
    Arguments: difference and its standard error, of one shape and unit.
    Valid: a normal error; with none the step is sure.
    Source: variance of a Bernoulli variable.

    >>> [float(each) for each in step_at(np.array(0.1), np.array(0.0))]
    [1.0, 0.0]
    """
    sure = np.copysign(np.inf, apart)
    score = np.where(error > 0, apart / np.where(error > 0, error, 1.0), sure)
    return (apart > 0).astype(float), np.sqrt(ndtr(score) * ndtr(-score))
