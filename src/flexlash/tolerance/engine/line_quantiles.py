"""What lines say about the output: quantiles, shares above a limit, moments, each with its standard error.

Arrays are (levels, rows): a level is one wanted probability or one limit. Crossings found in the table are
corrected on the model itself until nothing is left to correct, so the table's spacing leaves no bias.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import TypeAlias

import numpy as np
from scipy.special import ndtr, ndtri

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_tables import FAR, NODES, REACH, STEP, Lines
from flexlash.tolerance.sampling import standard_error

__all__ = ["LineQuantiles", "Moments", "moments_of", "normal_density", "quantiles_at", "quantiles_of"]

LEAST = 1e-15
"""Shares below are not told from none."""

_FINE = 192, 128

_ROUNDING = 1e-9
"""Part of the scale of an output below which its numbers are rounding."""

_EXACT = 1e-4
"""Part of the scale by which a crossing may still move; the correction then leaves a small part of that."""

_SLOPE_ERROR = 0.1
"""How well the slope of a line is known; a correction leaves at most this part of itself."""

_NEAR = 5e-3
"""Part of the scale, and of the normal scale, from which the model itself takes over from the table."""


_APART = 1e-6
_NEWTON = 8
_SEARCHES = 40
_ROUNDS = 12


def normal_density(score: Array) -> Array:
    """Return the standard normal density."""
    return np.asarray(np.exp(score * score * -0.5) * (1 / np.sqrt(2 * np.pi)))


@dataclass(frozen=True, kw_only=True)
class LineQuantiles:
    """Outputs (levels, rows), the share `above` each, its standard error, and the density there.

    `residual` is the part of the outputs' error that more lines would not remove.
    """

    output: Array
    above: Array
    above_error: Array
    density: Array
    residual: Array

    @property
    def output_error(self) -> Array:
        """Standard errors of the outputs as quantiles: that of the share over the density."""
        return self.above_error / _positive(self.density) + self.residual

    def take(self, levels: int) -> LineQuantiles:
        """Return the first levels."""
        return LineQuantiles(**{name: values[:levels] for name, values in vars(self).items()})

    def widened(self, margin: Array) -> LineQuantiles:
        """Return the same with standard errors times a margin (rows,)."""
        return replace(self, above_error=self.above_error * margin)


@dataclass(frozen=True, kw_only=True)
class Moments:
    """Mean, standard deviation and skewness of each row with their standard errors, (rows,) each."""

    mean: Array
    sd: Array
    skewness: Array
    mean_error: Array
    sd_error: Array
    skewness_error: Array

    def widened(self, margin: Array) -> Moments:
        """Return the same with standard errors times a margin (rows,)."""
        errors = {name: values * margin for name, values in vars(self).items() if name.endswith("_error")}
        return replace(self, **errors)


def moments_of(lines: Lines) -> Moments:
    """Return the moments: along the lines by quadrature, over the lines by their mean."""
    rules = _rules(lines)
    origin = lines.each(rules[0][0][len(rules[0][0]) // 2].reshape(lines.rows, -1)[:, :1].T)
    shift = lines.mean_over_lines(_integrals(rules[0], origin)[0])
    centre = origin + lines.each(shift)
    (first, second, third), coarse = (_integrals(rule, centre) for rule in rules)
    # A third of what twice the spacing changes is the error of a kink, and more than that of a smooth output.
    steps = [
        np.abs(lines.mean_over_lines(fine - wide)) / 3
        for fine, wide in zip((first, second, third), coarse, strict=True)
    ]
    sd = np.sqrt(lines.mean_over_lines(second))
    scale = np.where(sd > 0, sd, 1.0)
    skewness = lines.mean_over_lines(third) / scale**3
    # The skewness moves with mean and sd as well as with the third moment.
    skewing = third / lines.each(scale**3) - 3 * first / lines.each(scale)
    skewing -= 1.5 * lines.each(skewness) * second / lines.each(scale**2)
    return Moments(
        mean=(lines.mean_over_lines(origin) + shift)[0],
        sd=sd[0],
        skewness=skewness[0],
        mean_error=(_error(lines, first) + steps[0])[0] + _ROUNDING * sd[0],
        sd_error=((_error(lines, second) + steps[1]) / (2 * scale))[0] + _ROUNDING * sd[0],
        skewness_error=(_error(lines, skewing) + steps[2] / scale**3)[0] + _ROUNDING,
    )


Rule: TypeAlias = tuple[Array, Array]
"""Outputs (nodes, rows × lines) along lines, and the weights (nodes, 1) that integrate them."""


def _rules(lines: Lines) -> tuple[Rule, Rule]:
    """Return a rule and one of half as many nodes: the table, or for a single input one that knows its kinks."""
    if len(lines.inputs.names) > 1:
        return (lines.table, _trapezoid(1)), (lines.table[::2], _trapezoid(2))
    rules = [_fine_rule(lines.inputs.shapes[0].breaks, count) for count in _FINE]
    return (lines.outputs(rules[0][0]), rules[0][1]), (lines.outputs(rules[1][0]), rules[1][1])


@cache
def _trapezoid(every: int) -> Array:
    """Return the weights (k, 1) of every so many nodes under the normal density, nearly exact if all is smooth."""
    weights = normal_density(NODES[::every, None])
    return np.asarray(weights / weights.sum())


def _integrals(rule: Rule, centre: Array) -> tuple[Array, Array, Array]:
    """Return the first three moments about a centre (1, rows × lines) along each line."""
    values, weight = rule
    deviation = values - centre
    power = weight * deviation
    moments = [np.add.reduce(power, axis=0, keepdims=True)]
    for _ in range(2):
        power *= deviation
        moments.append(np.add.reduce(power, axis=0, keepdims=True))
    return moments[0], moments[1], moments[2]


def _error(lines: Lines, values: Array) -> Array:
    """Return the standard errors (k, rows) of means over lines."""
    return standard_error(lines.replicate_means(values)) + lines.left_out(values)


def _fine_rule(breaks: tuple[float, ...], count: int) -> tuple[Array, Array]:
    """Return nodes and weights (k, 1) that integrate under the normal density between breaks."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    # A line may run either way through its one input.
    ends = np.unique([-REACH, *breaks, *(-one for one in breaks), REACH])
    half = np.diff(ends)[:, None] / 2
    places = (half * nodes + ends[:-1, None] + half).reshape(-1, 1)
    shares = (half * weights).reshape(-1, 1) * normal_density(places)
    return places, shares / shares.sum()


def quantiles_of(lines: Lines, probability: Array) -> LineQuantiles:
    """Return the outputs that these shares (levels,) of each row stay below."""
    level = ndtri(np.clip(probability, LEAST, 1 - LEAST))[:, None]
    scaled = (level - NODES[0]) / STEP
    node = np.clip(scaled.astype(int), 0, len(NODES) - 2)
    start = lines.table[node[:, 0]] * (1 - (scaled - node)) + lines.table[node[:, 0] + 1] * (scaled - node)
    return _settle(lines, *_in_table(lines, lines.mean_over_lines(start) + level * _wider(lines), level), level)


def _wider(lines: Lines) -> Array:
    """Return by how much more than along a line the output scatters, (rows,): the lines are not quite alike."""
    middle = lines.table[len(NODES) // 2][None]
    apart = middle - lines.each(lines.mean_over_lines(middle))
    return np.asarray(np.sqrt(lines.scale**2 + lines.mean_over_lines(apart * apart)[0]) - lines.scale)


def _in_table(lines: Lines, output: Array, level: Array) -> tuple[Array, Array, Array]:
    """Return outputs near the wanted level of Φ, the places and the slopes there, by the table alone."""
    low, high = lines.bounds
    near = np.zeros(output.shape, dtype=bool)
    for search in range(_SEARCHES):
        place, slope = lines.places(lines.each(output))
        moved, corrected, missing = _moved(lines, output, place, slope, level)
        near = near | ((np.abs(moved - output) <= _NEAR * lines.scale) & (missing <= _NEAR))
        if near.all():
            break
        low = np.where(moved > output, output, low)
        high = np.where(moved < output, output, high)
        outside = (moved <= low) | (moved >= high) | (search >= _NEWTON)
        moved = np.where(outside, (low + high) / 2, moved)
        output = np.where(near, output, moved)
    return np.clip(moved, *lines.bounds), corrected, slope


def quantiles_at(lines: Lines, output: Array) -> LineQuantiles:
    """Return the shares above outputs (levels, rows)."""
    low, high = lines.bounds
    # An output out of reach is crossed as one just beyond it.
    output = np.clip(output, low - lines.scale, high + lines.scale)
    place, slope = lines.places(lines.each(output))
    found = _settle(lines, output, place, slope, None)
    told = np.where(found.above <= LEAST, 0.0, np.where(found.above >= 1 - LEAST, 1.0, found.above))
    return replace(found, above=told)


def _settle(lines: Lines, output: Array, place: Array, slope: Array, level: Array | None) -> LineQuantiles:
    """Return the crossings of outputs, which move to the wanted level of Φ if there is one.

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
        reached = lines.outputs(place)
        if before is not None:
            slope = np.where(live, _secant(before, (place, reached), slope), slope)
        gap = _within((lines.each(output) - reached) / slope, STEP)
        weight = normal_density(place)
        left = lines.mean_over_lines(weight * np.abs(gap)) / _positive(lines.mean_over_lines(weight / slope))
        target, corrected = output, _within(place + gap, FAR)
        if level is not None:
            target, corrected, missing = _moved(lines, output, corrected, slope, level)
            target = np.clip(target, low, high)
            left = np.maximum(left, np.maximum(np.abs(target - output), missing * exact * lines.scale / _EXACT))
        else:
            share = lines.mean_over_lines(ndtr(-corrected))
            left = np.where((share <= LEAST) | (share >= 1 - LEAST), 0.0, left)
        before = place, reached
        output = np.where(settled, output, target)
        place = np.where(live, corrected, place)
        residual = np.where(settled, residual, left)
        settled = settled | (left <= exact * lines.scale)
        if settled.all():
            break
    above = ndtr(-place)
    lost = ~settled
    if level is not None:
        # What cannot be followed on the model stays what the table says.
        residual = np.where(lost, np.maximum(residual, np.abs(output - start)), residual)
        output = np.where(lost, start, output)
    return LineQuantiles(
        output=output,
        above=lines.mean_over_lines(above),
        above_error=_error(lines, above),
        density=lines.mean_over_lines(normal_density(place) / slope),
        residual=np.maximum(np.where(lost, residual, _SLOPE_ERROR * residual), _ROUNDING * lines.scale),
    )


def _secant(before: tuple[Array, Array], now: tuple[Array, Array], slope: Array) -> Array:
    """Return the slopes between two places of each line where they are far enough apart, within a factor of 5."""
    moved = now[0] - before[0]
    apart = np.abs(moved) > _APART
    found = (now[1] - before[1]) / np.where(apart, moved, 1.0)
    return np.where(apart, np.clip(found, 0.2 * slope, 5 * slope), slope)


def _within(values: Array, most: float) -> Array:
    """Return values cut at ± most."""
    return np.minimum(np.maximum(values, -most), most)


def _positive(density: Array) -> Array:
    """Return densities that one can divide by."""
    return np.maximum(density, np.finfo(float).tiny)


def _moved(lines: Lines, output: Array, place: Array, slope: Array, level: Array) -> tuple[Array, Array, Array]:
    """Return outputs nearer to the wanted level of Φ by Newton's rule, the places there, and what was missing."""
    above = np.clip(lines.mean_over_lines(ndtr(-place)), LEAST / 10, 1 - LEAST / 10)
    density = _positive(lines.mean_over_lines(normal_density(place) / slope))
    now = -ndtri(above)
    step = np.clip((level - now) * normal_density(now) / density, -lines.scale, lines.scale)
    shift = _within(lines.each(step) / slope, STEP)
    return output + step, _within(place + shift, FAR), np.abs(level - now)
