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
from numpy.typing import NDArray

from flexlash.schema.arrays import Array
from flexlash.tolerance.distributions import Distribution
from flexlash.tolerance.engine.line_direction import Indices
from flexlash.tolerance.engine.line_surrogate import AdditiveSurrogate, polynomial
from flexlash.tolerance.engine.shape_rules import shape_rule

__all__ = ["SurrogateLaw"]

_LEVELS = ((40, 41), (64, 97), (128, 193), (256, 385))
"""Terms of the series and nodes of the rules, tried in turn."""

_CONVERGED = 1e-9
"""Residual from which on more terms are not tried."""

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


Waves = NDArray[np.complex128]


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
    Arguments: surrogates of rows alike and the shapes of their inputs, which are independent.
    Valid: to `residual` (rows,), an error of a probability.
    Source: Fang and Oosterlee 2008 (COS method).
    """

    residual: Array
    series: tuple[_Series, ...]

    @classmethod
    def of(cls, surrogate: AdditiveSurrogate, shapes: Sequence[Distribution]) -> SurrogateLaw:
        """Return the laws of surrogates of rows alike, whose inputs have these shapes."""
        residual, series = np.full(len(surrogate.centre), np.inf), []
        pending = np.flatnonzero(surrogate.fitted)
        for terms, nodes in _LEVELS:
            if not len(pending):
                break
            expanded, left = _expanded_in_blocks(surrogate, _Rules.of(shapes, nodes), pending, terms)
            done = (left <= _CONVERGED) | ((terms, nodes) == _LEVELS[-1])
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


@dataclass(frozen=True, kw_only=True)
class _Rules:
    """The rules of all inputs: `variables` and `weights` (inputs, 1, nodes), `resolved` (inputs, 1)."""

    variables: Array
    weights: Array
    resolved: Array

    @classmethod
    def of(cls, shapes: Sequence[Distribution], nodes: int) -> _Rules:
        """Return the rules of shapes."""
        rules = [shape_rule(shape, nodes) for shape in shapes]
        return cls(
            variables=np.array([rule.variables for rule in rules])[:, None],
            weights=np.array([rule.weights for rule in rules])[:, None],
            resolved=np.array([[rule.resolved] for rule in rules]),
        )


def _expanded_in_blocks(
    surrogate: AdditiveSurrogate, rules: _Rules, rows: Indices, terms: int
) -> tuple[_Series, Array]:
    """Return the series of so many terms of some rows, and their residuals."""
    step = max(_TOGETHER // (terms * rules.variables.size), 1)
    blocks = [rows[start : start + step] for start in range(0, len(rows), step)]
    found = [_expanded(surrogate.take(block), rules, block, terms) for block in blocks]
    return _Series.joined([series for series, _ in found]), np.concatenate([residual for _, residual in found])


def _expanded(surrogate: AdditiveSurrogate, rules: _Rules, rows: Indices, terms: int) -> tuple[_Series, Array]:
    """Return the series of so many terms, and its residual (rows,)."""
    values = polynomial(surrogate.coefficients[..., None], rules.variables)
    low, width, outside = _range(values, rules.weights)
    frequency = np.pi / width
    number = np.arange(1, terms + 1)[:, None]
    factor = np.exp(-1j * number * (frequency * low))
    for one in np.moveaxis(_characteristic(frequency[:, None] * values, rules.weights, terms), 1, 0):
        factor *= one
    swing = (values.max(axis=2) - values.min(axis=2)) / 2
    count = np.floor((rules.resolved / np.maximum(swing * frequency, rules.resolved / terms)).min(axis=0))
    kept = number <= count
    tail = kept & (number > count * (1 - 1 / _TAIL))
    residual = _LOBES * 2 / np.pi * np.where(tail, np.abs(factor), 0.0).max(axis=0) + outside
    residual = np.where(count < _FEWEST, np.inf, residual)
    coefficients = np.where(kept, factor.real, 0.0) * (2 / np.pi) / number
    return _Series(index=rows, low=low, width=width, coefficients=np.ascontiguousarray(coefficients.T)), residual


def _characteristic(phase: Array, weights: Array, terms: int) -> Waves:
    """Return the expectations of e^{ik·phase}, k from 1 to `terms`, (terms, inputs, rows), of (inputs, rows, nodes)."""
    waves = _waves(phase, terms)
    waves *= weights
    return np.asarray(np.add.reduce(waves, axis=3))


def _waves(phase: Array, terms: int) -> Waves:
    """Return e^{ik·phase} for k from 1 to `terms`, (terms, ...), of phases (...)."""
    waves = np.empty((terms, *phase.shape), dtype=complex)
    waves[0] = np.exp(1j * phase)
    filled = 1
    while filled < terms:
        more = min(filled, terms - filled)
        np.multiply(waves[:more], waves[filled - 1], out=waves[filled : filled + more])
        filled += more
    return waves


def _range(values: Array, weights: Array) -> tuple[Array, Array, Array]:
    """Return low end and width of the range of S, and about the probability that it leaves out, (rows,) each.

    A single term that reaches most of the way out would make S leave the range by itself.
    """
    first = np.add.reduce(weights * values, axis=2)
    deviation = values - first[:, :, None]
    squares = deviation * deviation
    second = np.add.reduce(weights * squares, axis=2)
    fourth = np.add.reduce(weights * squares * squares, axis=2) - 3 * second * second
    mean, variance, fourth, least, greatest = (
        _total(one) for one in (first, second, fourth, values.min(axis=2), values.max(axis=2))
    )
    reach = _REACH * np.sqrt(variance + np.sqrt(np.abs(fourth)))
    low, high = np.maximum(mean - reach, least), np.minimum(mean + reach, greatest)
    far = np.abs(deviation) > _FAR * reach[:, None]
    outside = _total(np.add.reduce(np.where(far, weights, 0.0), axis=2))
    return low, np.where(high > low, high - low, 1.0), outside


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
    waves = np.ascontiguousarray(np.moveaxis(_waves(np.pi * inside, terms), 0, -1))
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
