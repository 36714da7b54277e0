"""The law of a sum of independent terms: its distribution function as a Fourier series.

    characteristic function     φ(ω) = Π E e^{iωsᵢ}, each factor by the rule of its input's shape
    series                      F(s) on [low, low + width] by the cosines that the density has there
    residual                    how far F may be off: what the series leaves out, and what lies beyond its range

Rows take as many terms as their own characteristic function needs; a row's numbers do not depend on others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_direction import Indices, Inputs
from flexlash.tolerance.engine.line_surrogate import AdditiveSurrogate
from flexlash.tolerance.engine.term_rules import TermRule, term_rules

__all__ = ["SurrogateLaw"]

_LEVELS = ((40, 41), (64, 97), (128, 193), (256, 385))
"""Terms of the series and nodes of the rules, tried in turn."""

_CONVERGED, _CONVERGED_TOGETHER = 1e-8, 1e-6
"""Residual from which on more terms are not tried: without clusters, and with them, whose rules have many nodes."""

_REACH = 8.5
"""Half the width of the range, in standard deviations of a sum that is nearly normal."""

_LOBES = 4.0
"""How many times greater than the last terms those left out may be: bounded terms have waves with lobes."""

_FEWEST = 8
"""Terms that the rules must resolve, or nothing is told of the law."""

_TAIL = 8
"""The last of so many parts of the terms tells what those left out would add."""

_TOGETHER = 1 << 17
"""Complex numbers looked at together, so that they fit the cache."""

_FAR = 0.9
"""Part of the way out of the range beyond which a single term counts as having left it."""

_CELLS = 64
"""Cells of the grid from which quantiles start."""

_NEWTON = 1
"""Newton steps from the grid to a quantile from which a search starts."""


Waves = npt.NDArray[np.complex128]
Bools = npt.NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True)
class _Series:
    """The series of the rows `index`: low and width (rows,), coefficients (rows, terms) of the sines of F."""

    index: Indices
    low: Array
    width: Array
    coefficients: Array

    def take(self, chosen: Indices) -> _Series:
        """Return the series of some of its rows."""
        return _Series(**{name: values[chosen] for name, values in vars(self).items()})

    @classmethod
    def joined(cls, parts: Sequence[_Series]) -> _Series:
        """Return the series of all rows of some."""
        return cls(**{name: np.concatenate([getattr(part, name) for part in parts]) for name in vars(parts[0])})


@dataclass(frozen=True, kw_only=True)
class SurrogateLaw:
    """The distribution of S in rows alike.

    Equation: F(s) = (s − a)/w + Σ 2/(kπ) Re(φ(kπ/w) e^{−ikπa/w}) sin(kπ(s − a)/w), a the low end, w the width
    Arguments: surrogates of rows alike and their inputs, which `serves` accepts.
    Valid: to `residual` (rows,), an error of a probability.
    Source: Fang and Oosterlee 2008 (COS method).
    """

    residual: Array
    series: tuple[_Series, ...]

    @classmethod
    def of(cls, surrogate: AdditiveSurrogate, inputs: Inputs) -> SurrogateLaw:
        """Return the laws of surrogates of rows alike."""
        residual, series = np.full(len(surrogate.centre), np.inf), []
        pending = np.flatnonzero(surrogate.fitted)
        for terms, nodes in _LEVELS:
            if not len(pending):
                break
            rules = term_rules(inputs, nodes)
            expanded, left, limited = _expanded_in_blocks(surrogate, rules, pending, terms)
            wanted = _CONVERGED_TOGETHER if any(rule.clustered for rule in rules) else _CONVERGED
            done = (left <= wanted) | limited | ((terms, nodes) == _LEVELS[-1])
            residual[pending[done]] = left[done]
            if done.any():
                series.append(expanded.take(np.flatnonzero(done)))
            pending = pending[~done]
        return cls(residual=residual, series=tuple(series))

    def take(self, rows: Indices) -> SurrogateLaw:
        """Return some of the rows."""
        place = np.full(len(self.residual), -1)
        place[rows] = np.arange(len(rows))
        chosen = [(series, np.flatnonzero(place[series.index] >= 0)) for series in self.series]
        series = [replace(one.take(found), index=place[one.index[found]]) for one, found in chosen if len(found)]
        return SurrogateLaw(residual=self.residual[rows], series=tuple(series))

    def below(self, total: Array) -> tuple[Array, Array]:
        """Return the probability that S stays below values (levels, rows), and the density there."""
        probability, density = np.zeros(total.shape), np.zeros(total.shape)
        for series in self.series:
            probability[:, series.index], density[:, series.index] = _summed(series, total[:, series.index])
        return probability, density

    def quantiles(self, probability: Array) -> Array:
        """Return about which values (levels, rows) S stays below with probabilities (levels,); NaN without a law."""
        total = np.full((len(probability), len(self.residual)), np.nan)
        for series in self.series:
            total[:, series.index] = _quantiles(series, probability)
        return total


def _expanded_in_blocks(
    surrogate: AdditiveSurrogate, rules: Sequence[TermRule], rows: Indices, terms: int
) -> tuple[_Series, Array, Bools]:
    """Return what `_expanded` does of some rows, as many together as fit the cache."""
    step = max(_TOGETHER // (terms * sum(rule.variables.size for rule in rules)), 1)
    blocks = [rows[start : start + step] for start in range(0, len(rows), step)]
    series, *found = zip(*(_expanded(surrogate.take(block), rules, block, terms) for block in blocks), strict=True)
    residual, limited = (np.concatenate(one) for one in found)
    return _Series.joined(series), residual, limited


def _expanded(
    surrogate: AdditiveSurrogate, rules: Sequence[TermRule], rows: Indices, terms: int
) -> tuple[_Series, Array, Bools]:
    """Return the series of so many terms, its residual (rows,), and whether no rule resolves as many terms (rows,)."""
    parts = [rule.parts(surrogate.coefficients) for rule in rules]
    values = [rule.terms(part) for rule, part in zip(rules, parts, strict=True)]
    low, width, outside = _range(values, [rule.weights for rule in rules])
    frequency = np.pi / width
    number = np.arange(1, terms + 1)[:, None]
    factor = np.exp(-1j * number * (frequency * low))
    count = np.full(len(rows), float(terms))
    limited = np.zeros(len(rows), dtype=bool)
    for rule, part, value in zip(rules, parts, values, strict=True):
        for one in np.moveaxis(_characteristic(frequency[:, None] * value, rule.weights, terms), 1, 0):
            factor *= one
        resolved = np.floor(rule.waves_resolved(part, frequency))
        count = np.minimum(count, resolved)
        limited |= (resolved < terms) & rule.finest
    kept = number <= count
    tail = kept & (number > count * (1 - 1 / _TAIL))
    residual = _LOBES * 2 / np.pi * np.where(tail, np.abs(factor), 0.0).max(axis=0) + outside
    residual = np.where(count < _FEWEST, np.inf, residual)
    coefficients = np.where(kept, factor.real, 0.0) * (2 / np.pi) / number
    series = _Series(index=rows, low=low, width=width, coefficients=np.ascontiguousarray(coefficients.T))
    return series, residual, limited


def _characteristic(phase: Array, weights: Array, terms: int) -> Waves:
    """Return the expectations of e^{ik·phase}, k from 1 to `terms`, (terms, inputs, rows), of (inputs, rows, nodes)."""
    waves = _waves(phase, terms)
    waves *= weights
    return np.asarray(np.add.reduce(waves, axis=3))


def _waves(phase: Array, terms: int) -> Waves:
    """Return e^{ik·phase} for k from 1 to `terms`, (terms, ...), of phases (...)."""
    if phase.size == 1:
        # Complex numbers by themselves are multiplied with other roundings than several side by side.
        return _waves(np.repeat(phase[None], 2, axis=0), terms)[:, 0]
    waves = np.empty((terms, *phase.shape), dtype=complex)
    waves[0] = np.exp(1j * phase)
    filled = 1
    while filled < terms:
        more = min(filled, terms - filled)
        np.multiply(waves[:more], waves[filled - 1], out=waves[filled : filled + more])
        filled += more
    return waves


def _range(values: Sequence[Array], weights: Sequence[Array]) -> tuple[Array, Array, Array]:
    """Return low end and width of the range of S, and about the probability that it leaves out, (rows,) each.

    A single term that reaches most of the way out would make S leave the range by itself.
    """
    found = [_moments(value, weight) for value, weight in zip(values, weights, strict=True)]
    mean, variance, fourth, least, greatest = (_total(np.concatenate(one)) for one in zip(*found, strict=True))
    reach = _REACH * np.sqrt(variance + np.sqrt(np.abs(fourth)))
    low, high = np.maximum(mean - reach, least), np.minimum(mean + reach, greatest)
    outside = [
        np.add.reduce(np.where(np.abs(value - first[:, :, None]) > _FAR * reach[:, None], weight, 0.0), axis=2)
        for value, weight, (first, *_) in zip(values, weights, found, strict=True)
    ]
    return low, np.where(high > low, high - low, 1.0), _total(np.concatenate(outside))


def _moments(values: Array, weights: Array) -> tuple[Array, ...]:
    """Return mean, variance and fourth cumulant of terms, their least and greatest value, (terms, rows) each."""
    first = np.add.reduce(weights * values, axis=2)
    deviation = values - first[:, :, None]
    squares = deviation * deviation
    second = np.add.reduce(weights * squares, axis=2)
    fourth = np.add.reduce(weights * squares * squares, axis=2) - 3 * second * second
    return first, second, fourth, values.min(axis=2), values.max(axis=2)


def _total(values: Array) -> Array:
    """Return the sums (rows,) over the inputs of (inputs, rows), one after the other however many rows there are."""
    total = values[0].copy()
    for one in values[1:]:
        total += one
    return np.asarray(total)


def _summed(series: _Series, total: Array) -> tuple[Array, Array]:
    """Return F and its density at values (levels, rows)."""
    part = (total - series.low) / series.width
    inside = np.minimum(np.maximum(part, 0.0), 1.0)
    terms = series.coefficients.shape[1]
    # The terms lie last, so that they add up in the same order however many levels and rows there are.
    waves = np.moveaxis(_waves(np.pi * inside, terms), 0, -1).copy()
    probability = inside + np.add.reduce(series.coefficients * waves.imag, axis=2)
    density = 1 + np.add.reduce(series.coefficients * (np.pi * np.arange(1, terms + 1)) * waves.real, axis=2)
    density = np.where((part > 0) & (part < 1), np.maximum(density, 0.0) / series.width, 0.0)
    return np.minimum(np.maximum(probability, 0.0), 1.0), density


@cache
def _sines(terms: int) -> Array:
    """Return the sines (cells + 1, terms) of the series at the grid, which is the same part of every row's range."""
    return np.asarray(np.sin(np.pi * (np.arange(_CELLS + 1) / _CELLS)[:, None] * np.arange(1, terms + 1)))


def _quantiles(series: _Series, probability: Array) -> Array:
    """Return about which values (levels, rows) have these probabilities (levels,) below them, on a grid."""
    grid = np.arange(_CELLS + 1) / _CELLS
    table = grid + np.add.reduce(series.coefficients[:, None] * _sines(series.coefficients.shape[1]), axis=2)
    table = np.maximum.accumulate(table, axis=1)
    cell = np.minimum(np.maximum((table[None] <= probability[:, None, None]).sum(axis=2) - 1, 0), _CELLS - 1)
    rows = np.arange(len(table))
    below, above = table[rows, cell], table[rows, cell + 1]
    step = np.where(above > below, above - below, 1.0)
    part = np.minimum(np.maximum((probability[:, None] - below) / step, 0.0), 1.0)
    low, high = series.low + grid[cell] * series.width, series.low + grid[cell + 1] * series.width
    total = low + part * (high - low)
    for _ in range(_NEWTON):
        found, density = _summed(series, total)
        moved = (probability[:, None] - found) / np.where(density > 0, density, np.inf)
        total = np.minimum(np.maximum(total + moved, low), high)
    return np.asarray(total)
