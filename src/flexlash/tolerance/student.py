"""Student's t: an input that is the mean of a few observations, as the GUM's type A evaluation gives it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr, stdtr, stdtrit

from flexlash.schema.argument_checks import number
from flexlash.schema.arrays import Array

__all__ = ["Student"]

_FEWEST = 3.0
"""Fewest degrees of freedom; with two there is no standard deviation."""


@dataclass(frozen=True)
class Student:
    """Student's t distribution about a mean.

    For the mean of n observations with the standard deviation s: `Student(mean, scale=s / √n, degrees=n − 1)`.

    Equation: x = mean + scale · t⁻¹(p; degrees)
    Arguments: mean and scale > 0 in the unit of the input; degrees of freedom ≥ 3, fractions too.
    Valid: below 3 degrees too much of the variance lies in tails that nobody samples, and at 2 it is infinite.
    Source: JCGM 101 6.4.9.

    >>> round(Student(mean=0.0, scale=1.0, degrees=18).standard_deviation ** 2, 12)
    1.125
    """

    mean: float
    scale: float
    degrees: float

    def __post_init__(self) -> None:
        number("mean", self.mean)
        if not number("scale", self.scale) > 0:
            raise ValueError(f"scale = {self.scale:g} must be a finite number greater than 0")
        if not number("degrees", self.degrees) >= _FEWEST:
            raise ValueError(f"degrees = {self.degrees:g} must be at least {_FEWEST:g}")

    breaks = ()

    @property
    def shape(self) -> tuple[str | float, ...]:
        """The degrees of freedom."""
        return ("student", self.degrees)

    @property
    def location(self) -> float:
        """The mean."""
        return self.mean

    @property
    def expectation(self) -> float:
        """The mean."""
        return self.mean

    @property
    def standard_deviation(self) -> float:
        """The scale times √(degrees/(degrees − 2))."""
        return self.scale * math.sqrt(self.degrees / (self.degrees - 2))

    def standard(self, probability: Array) -> Array:
        """Return quantiles of Student's t."""
        return np.asarray(stdtrit(self.degrees, probability))

    def standard_at(self, score: Array) -> Array:
        """Return quantiles of Student's t, counted from the nearer end."""
        return np.copysign(stdtrit(self.degrees, ndtr(-np.abs(score))), score)

    def probability_below(self, standard: Array) -> Array:
        """Return the probabilities of lesser standard values."""
        return np.asarray(stdtr(self.degrees, standard))
