"""A row with measured dimensions → the parameters that its sample leaves uncertain, and the row at their ends.

parameter       mean, standard deviation or shape of a measured dimension, or the correlation of two
errors          what chance made of the estimates; those of dimensions measured on the same parts are correlated
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.schema.variant import FAR, Limits, MeasuredDimension
from flexlash.tolerance.combined_uncertainty import standard_scores
from flexlash.tolerance.correlation import Entry, correlated_scores, score_factor
from flexlash.tolerance.nearest_correlation import admissible_interval
from flexlash.tolerance.row_batches import TolerancedRow
from flexlash.tolerance.sample_statistics import MeasuredCorrelation, measured_correlation
from flexlash.tolerance.sample_uncertainty import UPPER_SCORE, SampleUncertainty
from flexlash.tolerance.shape_uncertainty import BENDS, bent_values

__all__ = ["EndRows", "ends_of", "moves_of", "products_of"]

_MOST_REACH = 0.5
"""Part of a size that a normal process may reach to either side; what goes further is cut where it ended before."""

_AS_MEASURED = "measured"
"""Distribution of a dimension that is taken as its values are, not as normal with their mean and sd."""

_SAME = 1e-9
"""Part within which a correlation of the row is that of the sample, and not one that was entered in its place."""

_LEAST_MOVE = 1e-6
"""Least distance between a correlation and the end of its interval; what is nearer to its bound is taken as known."""


@dataclass(frozen=True, kw_only=True)
class EndRows:
    """A parameter at the lower and the upper end of its interval: how far these are, and the row there.

    A mean is told in standard deviations of the sample, a standard deviation by the growth of its square, a shape by
    the normal score of its bend.
    """

    low: float
    high: float
    at_low: TolerancedRow
    at_high: TolerancedRow
    scatters: bool


def ends_of(row: TolerancedRow) -> list[EndRows]:
    """Return the parameters of a row that its samples leave uncertain; none where nothing that scatters was measured.

    Mean and standard deviation of each measured dimension come first, then the correlations of measured pairs, last the
    shapes of dimensions that are taken as they were measured.
    """
    alone = replace(row, between=None)
    found = [end for name, limit in _measured(row).items() for end in _of_dimension(alone, name, limit)]
    found += [_of_pair(alone, tie, pair) for tie, pair in _measured_ties(row)]
    found += [end for name, limit in _measured(row).items() for end in _of_shape(alone, name, limit)]
    return found


def moves_of(row: TolerancedRow) -> list[Array]:
    """Return the moves of the same parameters in sets that chance makes, as many of each."""
    measured = _measured(row)
    matrix = _error_correlations(row)
    bends = BENDS * sum(limit.distribution == _AS_MEASURED for limit in measured.values())
    independent = list(standard_scores(len(matrix) + bends))
    factor = score_factor(matrix, range(len(matrix)))
    scores = independent if factor is None else correlated_scores(factor, independent[: len(matrix)])
    moves = []
    for place, limit in enumerate(measured.values()):
        uncertainty = _uncertainty(limit)
        ratios = uncertainty.sd_ratios(scores[2 * place + 1])
        moves += [ratios * scores[2 * place] / math.sqrt(uncertainty.size), ratios**2 - 1]
    for (_, pair), score in zip(_measured_ties(row), scores[2 * len(measured) : len(matrix)], strict=True):
        centre, error = math.atanh(pair.correlation), 1 / math.sqrt(pair.count - 3)
        moves.append(np.tanh(centre + error * score) - pair.correlation)
    return [*moves, *independent[len(matrix) :]]


def products_of(row: TolerancedRow) -> list[tuple[int, int, int, float]]:
    """Return the places, among the parameters, of the standard deviations and the correlation of measured pairs.

    The last number of each is the correlation as estimated.
    """
    names = list(_measured(row))
    return [
        (2 * names.index(first) + 1, 2 * names.index(second) + 1, place, correlation)
        for place, ((first, second, correlation), _) in enumerate(_measured_ties(row), start=2 * len(names))
    ]


def _measured(row: TolerancedRow) -> dict[str, Limits]:
    """Return the limits of the dimensions that scatter as measured parts do."""
    return {name: limit for name, limit in row.limits.items() if limit.sample is not None and limit.low < limit.high}


def _uncertainty(limit: Limits) -> SampleUncertainty:
    """Return what the sample of a dimension leaves open; its shape matters where it is taken as it was measured."""
    values = limit.sample.values if limit.sample else ()
    return _of_values(values) if limit.distribution == _AS_MEASURED else SampleUncertainty(size=len(values))


# What many rows share is worked out once: a sample may have thousands of values.
_of_values = lru_cache(maxsize=256)(SampleUncertainty.of_values)
_pair_of = lru_cache(maxsize=256)(measured_correlation)


def _of_dimension(row: TolerancedRow, name: str, limit: Limits) -> Iterator[EndRows]:
    """Yield mean and standard deviation of a measured dimension."""
    uncertainty, sd = _uncertainty(limit), limit.standard_deviation

    def moved(offset: float, ratio: float) -> TolerancedRow:
        process = replace(limit, mean_shift=limit.mean_shift + offset * sd, sd=ratio * sd)
        if limit.distribution == "normal" and FAR * process.standard_deviation > _MOST_REACH * abs(process.mean):
            process = replace(process, cut=limit.cut or limit.reach)
        return replace(row, limits={**row.limits, name: process})

    off, (low, high) = uncertainty.offset_end, uncertainty.sd_ends
    yield EndRows(low=-off, high=off, at_low=moved(-off, 1.0), at_high=moved(off, 1.0), scatters=False)
    rows = moved(0.0, low), moved(0.0, high)
    yield EndRows(low=low**2 - 1, high=high**2 - 1, at_low=rows[0], at_high=rows[1], scatters=True)


def _of_shape(row: TolerancedRow, name: str, limit: Limits) -> Iterator[EndRows]:
    """Yield the skewness and the length of tails of a dimension that is taken as it was measured."""
    sample = limit.sample
    if sample is None or limit.distribution != _AS_MEASURED:
        return

    def bent(values: tuple[float, ...]) -> TolerancedRow:
        shape = replace(sample, values=values, parts=tuple(range(len(values))))
        process = replace(limit, sample=shape, sd=limit.standard_deviation)
        return replace(row, limits={**row.limits, name: process})

    for less, more in bent_values(sample.values):
        yield EndRows(low=-UPPER_SCORE, high=UPPER_SCORE, at_low=bent(less), at_high=bent(more), scatters=False)


def _of_pair(row: TolerancedRow, tie: Entry, pair: MeasuredCorrelation) -> EndRows:
    """Return the correlation of two dimensions that were measured on the same parts, as far as the others let it go."""
    names = list(row.distributions)
    matrix = np.eye(len(names))
    for first, second, correlation in row.ties:
        places = names.index(first), names.index(second)
        matrix[places] = matrix[places[::-1]] = correlation
    bounds = admissible_interval(matrix, names.index(tie[0]), names.index(tie[1])) or (tie[2], tie[2])
    ends = [
        min(max(end, bounds[0] + _LEAST_MOVE), bounds[1] - _LEAST_MOVE) if bounds[0] < bounds[1] else tie[2]
        for end in (pair.low, pair.high)
    ]

    def moved(correlation: float) -> TolerancedRow:
        ties = tuple((*other[:2], correlation) if other[:2] == tie[:2] else other for other in row.correlation)
        return replace(row, correlation=ties)

    low, high = min(ends[0] - tie[2], -_LEAST_MOVE), max(ends[1] - tie[2], _LEAST_MOVE)
    return EndRows(low=low, high=high, at_low=moved(ends[0]), at_high=moved(ends[1]), scatters=True)


def _measured_ties(row: TolerancedRow) -> list[tuple[Entry, MeasuredCorrelation]]:
    """Return the correlations of a row that are those of its samples, with their intervals."""
    found = []
    for tie in row.ties:
        first, second = (row.limits[name] for name in tie[:2])
        if first.sample is None or second.sample is None:
            continue
        by_scores = _AS_MEASURED in {first.distribution, second.distribution}
        pair = _pair_of(first.sample, second.sample, by_scores=by_scores)
        if pair is not None and abs(pair.correlation - tie[2]) <= _SAME and pair.low < pair.high:
            found.append((tie, pair))
    return found


def _error_correlations(row: TolerancedRow) -> Array:
    """Return how the errors of the parameters are correlated, in their order.

    Equation: of two means ρ m/√(n₁ n₂), of two variances ρ² m/√(n₁ n₂), m parts of which both were measured; of a
        variance and the correlation ρ/√2
    Arguments: a row of which something was measured.
    Valid: normal values; large samples.
    Source: Anderson, An Introduction to Multivariate Statistical Analysis, section 4.2 (asymptotic distribution of r).
    """
    measured = _measured(row)
    names, pairs = list(measured), [tie for tie, _ in _measured_ties(row)]
    matrix = np.eye(2 * len(names) + len(pairs))

    def tied(one: int, other: int, correlation: float) -> None:
        matrix[one, other] = matrix[other, one] = correlation

    for place, limit in enumerate(measured.values()):
        tied(2 * place, 2 * place + 1, _uncertainty(limit).tie)
    for first, second, correlation in row.ties:
        if first in measured and second in measured:
            one, other = 2 * names.index(first), 2 * names.index(second)
            common = _common(measured[first].sample, measured[second].sample)
            tied(one, other, correlation * common)
            tied(one + 1, other + 1, correlation**2 * common)
    for place, (first, second, correlation) in enumerate(pairs, start=2 * len(names)):
        for name in (first, second):
            tied(2 * names.index(name) + 1, place, correlation / math.sqrt(2))
    return matrix


@lru_cache(maxsize=256)
def _common(first: MeasuredDimension | None, second: MeasuredDimension | None) -> float:
    """Return the number of parts of which both were measured over the root of the product of their numbers."""
    if first is None or second is None or first.sample != second.sample:
        return 0.0
    return len({*first.parts} & {*second.parts}) / math.sqrt(len(first.parts) * len(second.parts))
