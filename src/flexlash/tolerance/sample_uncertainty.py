"""What n measured values leave open of a process: its mean and its standard deviation.

score           standard normal number that says where in its fiducial distribution a parameter lies
offset          mean of the process less that of the sample, in standard deviations of the sample
growth          square of the process's standard deviation over that of the sample's, less 1
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.special import chdtri, ndtr, ndtri, stdtrit

from flexlash.schema.arrays import Array
from flexlash.schema.variant import FEWEST_PARTS

__all__ = ["CONFIDENCE", "UPPER_SCORE", "SampleUncertainty"]

CONFIDENCE = 0.95
"""Confidence of every interval."""

UPPER_SCORE = float(ndtri((1 + CONFIDENCE) / 2))
"""Normal score of the upper end of an interval."""

_SCORES = np.linspace(-5.0, 5.0, 1001)
"""Scores between which the chi-square quantiles of a normal process are straight to 1e-5; 1.96 need not be one."""


@lru_cache(maxsize=256)
def _normal_ratios(size: int) -> Array:
    """Return the standard deviation of a normal process over that of so many values, at `_SCORES`."""
    return np.asarray(np.sqrt((size - 1) / chdtri(size - 1, ndtr(_SCORES))))


@dataclass(frozen=True, kw_only=True)
class SampleUncertainty:
    """What `size` independent values leave open of the mean and standard deviation of their process.

    Of a normal process all of it follows from the number of values. Otherwise `kurtosis` is the fourth central moment
    over the square of the variance (3 for a normal), and `tie` the correlation of the errors of mean and variance,
    which skewness brings about.

    Equation: offset = growth factor · b/√n. Normal: σ²/s² = (n − 1)/χ², χ² with n − 1 degrees at the score −a; other:
        ln σ²/s² = ln c + c a √((γ − (n − 3)/n)/(n − 1)), c = n/(n − 1.96), γ the kurtosis about the trimmed mean; a and
        b are standard normal. So the interval of the mean is Student's and that of σ chi-square's or Bonett's.
    Arguments: size ≥ 2, and ≥ 5 with a kurtosis, a plain number.
    Valid: independent parts of one process that stays as it was. Bonett's interval holds for distributions with tails
        that the sample shows; very long ones take 100 values and more.
    Source: Fisher 1935 (normal); Bonett 2006, Computational Statistics & Data Analysis 50, 775 (other).

    >>> normal = SampleUncertainty(size=60)
    >>> [round(end, 4) for end in (normal.offset_end, *normal.sd_ends)]
    [0.2583, 0.8476, 1.2197]
    """

    size: int
    kurtosis: float | None = None
    tie: float = 0.0

    @classmethod
    def of_values(cls, values: Sequence[float]) -> SampleUncertainty:
        """Return what values of a process that need not be normal leave open.

        Source: Bonett 2006: the fourth moment is taken about the mean without the outermost 1/(2 √(n − 4)) of each end.

        >>> values = [15.83, 16.01, 16.24, 16.42, 15.33, 15.44, 16.88, 16.31]
        >>> [round(end, 4) for end in SampleUncertainty.of_values(values).sd_ends]
        [0.6314, 2.0977]
        """
        count = len(values)
        if count < FEWEST_PARTS:
            raise ValueError(f"values are {count}: at least {FEWEST_PARTS} are required")
        ordered = sorted(values)
        trimmed = int(count / (2 * math.sqrt(count - 4)))
        kept = ordered[trimmed : count - trimmed]
        mean = math.fsum(ordered) / count
        middle = math.fsum(kept) / len(kept)
        squares = math.fsum((value - mean) ** 2 for value in ordered)
        kurtosis = count * math.fsum((value - middle) ** 4 for value in ordered) / squares**2
        skewness = math.sqrt(count) * math.fsum((value - mean) ** 3 for value in ordered) / squares**1.5
        plain = count * math.fsum((value - mean) ** 4 for value in ordered) / squares**2
        return cls(size=count, kurtosis=kurtosis, tie=skewness / math.sqrt(plain - 1) if plain > 1 else 0.0)

    @property
    def offset_end(self) -> float:
        """How far the mean may lie from the sample's, in standard deviations of the sample: half of Student's interval.

        >>> round(SampleUncertainty(size=10).offset_end, 4)
        0.7154
        """
        return float(stdtrit(self.size - 1, (1 + CONFIDENCE) / 2)) / math.sqrt(self.size)

    @property
    def sd_ends(self) -> tuple[float, float]:
        """Ends of the interval of the standard deviation, over that of the sample.

        >>> [round(end, 4) for end in SampleUncertainty(size=10).sd_ends]
        [0.6878, 1.8256]
        """
        if self.kurtosis is None:
            tail = (1 - CONFIDENCE) / 2
            low, high = (math.sqrt((self.size - 1) / float(chdtri(self.size - 1, end))) for end in (tail, 1 - tail))
        else:
            low, high = self.sd_ratios(np.array([-UPPER_SCORE, UPPER_SCORE])).tolist()
        return low, high

    def sd_ratios(self, scores: Array) -> Array:
        """Return the standard deviation over that of the sample, at scores."""
        if self.kurtosis is None:
            return np.interp(scores, _SCORES, _normal_ratios(self.size))
        enlarged = self.size / (self.size - UPPER_SCORE)
        error = math.sqrt(max(self.kurtosis - (self.size - 3) / self.size, 0.0) / (self.size - 1))
        return np.asarray(np.sqrt(enlarged) * np.exp(enlarged * error / 2 * scores))
