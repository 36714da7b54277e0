"""Tolerance rows of a class → limits of many variants at once, and of which of them there is surely nothing to say."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.tolerance_grades import deviations_of
from flexlash.schema.variant import FAR, ToleranceRow
from flexlash.tolerance.dimension_limits import ROUNDING, bounds_of
from flexlash.tolerance.gaps import gaps
from flexlash.tolerance.processes import Output, measured_ends, process_of, sides_of

__all__ = ["LimitArrays", "beyond_doubt", "limits_alike", "varying"]

_DOUBT = 1e3 * ROUNDING
"""Part of the numbers of a comparison within which its outcome is in doubt."""


class LimitArrays(NamedTuple):
    """The limits of a dimension of many variants [SI], each of shape (variants,).

    `mean` and `sd` are those of a normal or measured process, before any cut; `least` and `most` the ends of what the
    limits and the parts reach. What a grade does not tabulate is NaN.
    """

    low: Array
    high: Array
    mean: Array
    sd: Array
    least: Array
    most: Array


def limits_alike(
    sizes: Mapping[str, Array], rows: Iterable[ToleranceRow], output: Output | None = None
) -> dict[str, LimitArrays]:
    """Return the limits of variants that have the same dimensions, given by name, in one class; else as `limits_of`."""
    limits = {}
    for row in rows:
        if (nominal := sizes.get(row.dimension)) is None:
            continue
        lower, upper = _deviations_alike(row, nominal)
        low, high = nominal + lower, nominal + upper
        shift, own_sd = process_of(row, nominal, low, high, sides_of(row, sizes, low, high, output))
        mean = (low + high) / 2 + shift
        sd = np.broadcast_to((high - low) / (2 * row.limits_sigma) if own_sd is None else own_sd, low.shape)
        least, most = _reached(row, low, high, mean, sd)
        limits[row.dimension] = LimitArrays(low, high, mean, sd, least, most)
    return limits


def _deviations_alike(row: ToleranceRow, nominal: Array) -> tuple[Array, Array]:
    """Lower and upper deviations [SI] from many entered values, as `_deviations`; NaN where a grade has no entry."""
    if row.grade:
        parts = 2 if DIMENSIONS[row.dimension].grade_at == "diameter" else 1
        lower, upper = (found / parts for found in deviations_of(row.grade, parts * nominal))
        return lower, upper
    lower, upper = (side * nominal if row.relative else np.full(len(nominal), side) for side in (row.lower, row.upper))
    return lower, upper


@np.errstate(over="ignore")
def varying(sizes: Mapping[str, Array], rows: Iterable[ToleranceRow]) -> set[str]:
    """Return the dimensions that a class gives limits in one of some variants alike, whatever their process is."""
    found = set()
    for row in rows:
        if row.dimension in sizes:
            lower, upper = _deviations_alike(row, sizes[row.dimension])
            if ((lower < upper) | (abs(lower) > 0)).any():
                found.add(row.dimension)
    return found


def _reached(row: ToleranceRow, low: Array, high: Array, mean: Array, sd: Array) -> tuple[Array, Array]:
    """Return the least and greatest of the limits and of what a normal or measured process produces."""
    if row.distribution == "measured" and row.sample is not None:
        first, last = measured_ends(row.sample)
    elif row.distribution == "normal":
        first, last = -FAR, FAR
    else:
        return low, high
    return np.minimum(low, mean + first * sd), np.maximum(high, mean + last * sd)


def beyond_doubt(
    flexspline_type: str, sizes: Mapping[str, Array], limits: Mapping[str, LimitArrays]
) -> npt.NDArray[np.bool_]:
    """Return which of some variants alike `shape_problems` surely leaves alone; of the others it may have to say.

    What comes near to a bound within a thousand times the rounding of numbers is in doubt.
    """
    reach = {name: (one.least, one.most) for name, one in limits.items()}
    sure = np.ones(len(sizes["torque"]), dtype=bool)
    for name, (low, high) in reach.items():
        least, most = bounds_of(name)
        slack = _DOUBT * (abs(low) + abs(high))
        sure &= (low > least + slack) & (high < most - slack)
    for gap in gaps(flexspline_type, sizes):
        ends = [factor * reach.get(name, (sizes[name],) * 2)[factor < 0] for name, factor in gap.factors.items()]
        sure &= sum(ends) > _DOUBT * sum(map(abs, ends))
    return sure
