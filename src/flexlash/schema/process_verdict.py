"""Whether a process can be meant beside the limits that its drawing has."""

from __future__ import annotations

import math
import sys
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array
from flexlash.schema.findings import spelled_out

__all__ = ["ProcessVerdict", "is_usual_process", "process_verdict"]

_FEWEST, _MOST = 1.0, 12.0
"""Standard deviations between the middle of the limits and either of them that processes have."""

_LEAST, _GREATEST = 0.5, 300.0001
"""The same that can be meant: the least that Limits at ± sigma may be, at which hardly a part in three is within the
limits, and three times the greatest Cp."""

_LEAST_FOUND = 0.1
"""The same of a process that was measured, or told by Cp, which may be as bad as it is."""

_FARTHEST = 2.0
"""Widths of the limits beyond them from which on a mean is that of another size; parts made wrong lie nearer."""

_FARTHEST_CUT = 5.0
"""Standard deviations from the limits to the mean of a truncated process, which keeps no part in a million there."""

_HUNDREDTH = 0.0051
"""Difference of two Cpk from which on they are not one number in two decimals."""

_ROUNDING = 1e-9


class ProcessVerdict(NamedTuple):
    """What is wrong with a process: the code of the finding, which of mean, scatter and cpk is to blame, the words."""

    code: str
    blamed: str
    words: str


def process_verdict(
    low: float,
    high: float,
    mean: float,
    sd: float,
    *,
    is_entered: bool,
    cpk: float | None = None,
    is_truncated: bool = False,
) -> ProcessVerdict | None:
    """Return what is wrong with a process of this mean and sd between limits that differ, None where it can be meant.

    All four in one unit. A standard deviation that is itself entered must also be a usual one, since it may be in
    another unit; `cpk` is one that is told beside the mean. A truncated process must have parts within the limits.
    Numbers may be too large or too small to divide.

    >>> process_verdict(-2.0, 2.0, 12.0, 1.0, is_entered=True).words
    'the mean lies 2.5 widths of the limits beyond them; 2 are possible'
    """
    sigma, beyond = (high - low) / 2 / sd if sd > 0 else math.inf, max(low - mean, mean - high)
    least, most = (_LEAST, _GREATEST) if is_entered else (_LEAST_FOUND, sys.float_info.max)
    if not least * (1 - _ROUNDING) <= sigma <= most:
        words = f"{spelled_out(sigma)} standard deviations off their middle; {least:g} to 300 are possible"
        return ProcessVerdict("E339", "scatter", f"the limits lie {words}")
    if beyond > _ROUNDING * (high - low):
        return _outside(beyond, high - low, sd if is_truncated else math.inf)
    given = min(high - mean, mean - low) / (3 * sd)
    if cpk is not None and abs(given - cpk) > _HUNDREDTH:
        return ProcessVerdict("W443", "cpk", f"with this Mean shift Cpk is {spelled_out(given)}")
    if is_entered and not _FEWEST * (1 - _ROUNDING) <= sigma <= _MOST * (1 + _ROUNDING):
        return ProcessVerdict("W444", "scatter", f"it puts the limits at ± {spelled_out(sigma)}")
    return None


def _outside(beyond: float, width: float, sd: float) -> ProcessVerdict:
    """Return what is said of a mean so far beyond limits of this width; `sd` is that of a truncated process."""
    if beyond > _FARTHEST * width * (1 + _ROUNDING):
        words = f"{spelled_out(beyond / width)} widths of the limits beyond them; {_FARTHEST:g} are possible"
        return ProcessVerdict("E339", "mean", f"the mean lies {words}")
    if beyond > _FARTHEST_CUT * sd:
        words = f"{spelled_out(beyond / sd)} standard deviations beyond the limits, which keep no part in a million"
        return ProcessVerdict("E339", "mean", f"the mean lies {words}")
    return ProcessVerdict("W442", "mean", "the mean lies")


def is_usual_process(low: Array, high: Array, mean: Array, sd: Array) -> npt.NDArray[np.bool_]:
    """Return of which of many processes `process_verdict` surely says nothing."""
    half, slack = (high - low) / 2, 1 - 2 * _ROUNDING
    within = abs(mean - (low + high) / 2) <= half * slack
    return within & (half >= _FEWEST * sd) & (half <= _MOST * sd)
