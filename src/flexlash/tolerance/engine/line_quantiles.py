"""Outputs and the probabilities above them, by the positions where lines cross the outputs.

Arrays are (levels, rows): a level is one wanted probability or one limit. Crossings found in the table are
corrected on the model itself until nothing is left to correct, so the table's spacing leaves no bias.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtr, ndtri

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_points import normal_density
from flexlash.tolerance.engine.line_tables import FAR, NODES, STEP, Lines

__all__ = ["LEAST_PROBABILITY", "LineQuantiles", "probability_interval", "quantiles_at", "quantiles_of"]

LEAST_PROBABILITY = 1e-15
"""Probabilities below are not told from none."""

_ROUNDING = 1e-9
"""Part of the scale of an output below which its numbers are rounding."""

_EXACT = 1e-4
"""Part of the scale by which a quantile may still move; the correction then leaves a small part of that."""

_SLOPE_ERROR = 0.1
"""How well the slope of a line is known; a correction leaves at most this part of itself."""

_NEAR = 5e-3
"""Part of the scale, and of the normal scale, from which the model itself takes over from the table."""

_APART = 1e-6
"""Least distance of two positions between which a slope is taken."""

_NEWTON = 8
_SEARCHES = 40
_ROUNDS = 12


@dataclass(frozen=True, kw_only=True)
class LineQuantiles:
    """Outputs (levels, rows), the probability `above` each, its standard error, and the density there.

    `residual` is the part of the outputs' error that more lines would not remove.
    """

    output: Array
    above: Array
    above_error: Array
    density: Array
    residual: Array

    @property
    def output_error(self) -> Array:
        """Standard errors of the outputs as quantiles: that of the probability over the density."""
        return self.above_error / _positive(self.density) + self.residual

    def take(self, levels: int) -> LineQuantiles:
        """Return the first levels."""
        return LineQuantiles(**{name: values[:levels] for name, values in vars(self).items()})

    def widened(self, margin: Array) -> LineQuantiles:
        """Return the same with standard errors times a margin (rows,)."""
        return replace(self, above_error=self.above_error * margin)


def quantiles_of(lines: Lines, probability: Array) -> LineQuantiles:
    """Return the outputs that each row stays below with these probabilities.

    Equation: y with Φ⁻¹(mean over lines of Φ(t(y))) = Φ⁻¹(p), by Newton's rule
    Arguments: lines of rows alike without faults; probability (levels,).
    Valid: p from `LEAST_PROBABILITY` to 1 − `LEAST_PROBABILITY`; others are taken as these.
    Source: line sampling, as in `line_tables`.
    """
    level = ndtri(np.clip(probability, LEAST_PROBABILITY, 1 - LEAST_PROBABILITY))[:, None]
    scaled = (level - NODES[0]) / STEP
    node = np.clip(scaled.astype(int), 0, len(NODES) - 2)
    start = lines.table[node[:, 0]] * (1 - (scaled - node)) + lines.table[node[:, 0] + 1] * (scaled - node)
    return _corrected(lines, *_in_table(lines, lines.mean_over_lines(start) + level * _wider(lines), level), level)


def quantiles_at(lines: Lines, output: Array) -> LineQuantiles:
    """Return the probabilities above outputs.

    Equation: P(Y > y) = mean over lines of Φ(−t(y))
    Arguments: lines of rows alike without faults; output (levels, rows) in the unit of the model's.
    Valid: any output; one out of reach has the probability 0 or 1.
    Source: line sampling, as in `line_tables`.
    """
    low, high = lines.bounds
    # An output out of reach is crossed as one just beyond it.
    output = np.clip(output, low - lines.scale, high + lines.scale)
    position, slope = lines.crossings(lines.each(output))
    quantiles = _corrected(lines, output, position, slope, None)
    above = np.where(quantiles.above >= 1 - LEAST_PROBABILITY, 1.0, quantiles.above)
    return replace(quantiles, above=np.where(quantiles.above <= LEAST_PROBABILITY, 0.0, above))


def probability_interval(probability: Array, error: Array, factor: float = 1.96) -> tuple[Array, Array]:
    """Return the ends of intervals of probabilities, `factor` standard errors to both sides.

    Equation: Φ(Φ⁻¹(p) ∓ factor · error/φ(Φ⁻¹(p))): even on the normal scale, so that it stays above 0
    Arguments: probability and its standard error, of any one shape.
    Valid: a probability not told from 0 or 1 keeps that end.
    Source: the delta rule on the normal scale.
    """
    inside = np.clip(probability, LEAST_PROBABILITY, 1 - LEAST_PROBABILITY)
    score = ndtri(inside)
    reach = factor * error / normal_density(score)
    low, high = ndtr(score - reach), ndtr(score + reach)
    none, all_ = probability <= LEAST_PROBABILITY, probability >= 1 - LEAST_PROBABILITY
    return np.where(none, 0.0, low), np.where(all_, 1.0, high)


def _wider(lines: Lines) -> Array:
    """Return by how much more than along a line the output scatters, (rows,): the lines are not quite alike."""
    middle = lines.table[len(NODES) // 2][None]
    apart = middle - lines.each(lines.mean_over_lines(middle))
    return np.asarray(np.sqrt(lines.scale**2 + lines.mean_over_lines(apart * apart)[0]) - lines.scale)


def _in_table(lines: Lines, output: Array, level: Array) -> tuple[Array, Array, Array]:
    """Return outputs near the wanted level of Φ, the positions and the slopes there, by the table alone."""
    low, high = lines.bounds
    near = np.zeros(output.shape, dtype=bool)
    for search in range(_SEARCHES):
        position, slope = lines.crossings(lines.each(output))
        moved, corrected, missing = _moved(lines, output, position, slope, level)
        near = near | ((np.abs(moved - output) <= _NEAR * lines.scale) & (missing <= _NEAR))
        if near.all():
            break
        low = np.where(moved > output, output, low)
        high = np.where(moved < output, output, high)
        outside = (moved <= low) | (moved >= high) | (search >= _NEWTON)
        moved = np.where(outside, (low + high) / 2, moved)
        output = np.where(near, output, moved)
    return np.clip(moved, *lines.bounds), corrected, slope


def _corrected(lines: Lines, output: Array, position: Array, slope: Array, level: Array | None) -> LineQuantiles:
    """Return the quantiles at outputs, which move to the wanted level of Φ if there is one.

    Each pair of level and row stops by itself, so that its numbers do not depend on its neighbours.
    """
    settled = np.zeros(output.shape, dtype=bool)
    residual = np.zeros(output.shape)
    low, high = lines.bounds
    start = output
    before: tuple[Array, Array] | None = None
    exact = _ROUNDING if len(lines.inputs.names) == 1 else _EXACT
    for _ in range(_ROUNDS):
        live = lines.each(~settled)
        reached = lines.outputs(position)
        if before is not None:
            slope = np.where(live, _secant(before, (position, reached), slope), slope)
        gap = _within((lines.each(output) - reached) / slope, STEP)
        weight = normal_density(position)
        left = lines.mean_over_lines(weight * np.abs(gap)) / _positive(lines.mean_over_lines(weight / slope))
        target, corrected = output, _within(position + gap, FAR)
        if level is not None:
            target, corrected, missing = _moved(lines, output, corrected, slope, level)
            target = np.clip(target, low, high)
            left = np.maximum(left, np.maximum(np.abs(target - output), missing * exact * lines.scale / _EXACT))
        else:
            above = lines.mean_over_lines(ndtr(-corrected))
            left = np.where((above <= LEAST_PROBABILITY) | (above >= 1 - LEAST_PROBABILITY), 0.0, left)
        before = position, reached
        output = np.where(settled, output, target)
        position = np.where(live, corrected, position)
        residual = np.where(settled, residual, left)
        settled = settled | (left <= exact * lines.scale)
        if settled.all():
            break
    if level is not None:
        # What cannot be followed on the model stays what the table says.
        residual = np.where(settled, residual, np.maximum(residual, np.abs(output - start)))
        output = np.where(settled, output, start)
    crossed = ndtr(-position)
    return LineQuantiles(
        output=output,
        above=lines.mean_over_lines(crossed),
        above_error=lines.standard_error(crossed),
        density=lines.mean_over_lines(normal_density(position) / slope),
        residual=np.maximum(np.where(settled, _SLOPE_ERROR * residual, residual), _ROUNDING * lines.scale),
    )


def _secant(before: tuple[Array, Array], now: tuple[Array, Array], slope: Array) -> Array:
    """Return the slopes between two positions of each line where they are far enough apart, within a factor of 5."""
    moved = now[0] - before[0]
    apart = np.abs(moved) > _APART
    secant = (now[1] - before[1]) / np.where(apart, moved, 1.0)
    return np.where(apart, np.clip(secant, 0.2 * slope, 5 * slope), slope)


def _within(values: Array, most: float) -> Array:
    """Return values cut at ± most."""
    return np.minimum(np.maximum(values, -most), most)


def _positive(density: Array) -> Array:
    """Return densities that one can divide by."""
    return np.maximum(density, np.finfo(float).tiny)


def _moved(lines: Lines, output: Array, position: Array, slope: Array, level: Array) -> tuple[Array, Array, Array]:
    """Return outputs nearer to the wanted level of Φ by Newton's rule, the positions there, and what was missing."""
    above = np.clip(lines.mean_over_lines(ndtr(-position)), LEAST_PROBABILITY / 10, 1 - LEAST_PROBABILITY / 10)
    density = _positive(lines.mean_over_lines(normal_density(position) / slope))
    now = -ndtri(above)
    step = np.clip((level - now) * normal_density(now) / density, -lines.scale, lines.scale)
    shift = _within(lines.each(step) / slope, STEP)
    return output + step, _within(position + shift, FAR), np.abs(level - now)
