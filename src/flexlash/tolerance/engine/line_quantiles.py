"""Outputs and the probabilities above them, by the positions where lines cross the outputs.

    level               one wanted probability or one output; arrays are (levels, rows)

Crossings found in the table are corrected on the curves themselves until nothing is left to correct, so the table's
spacing leaves no bias.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtr, ndtri

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_crossings import NODES, STEP
from flexlash.tolerance.engine.line_drawing import DrawnLines
from flexlash.tolerance.engine.line_fronts import Estimator, Front, positive
from flexlash.tolerance.engine.line_points import normal_density
from flexlash.tolerance.engine.line_tables import Lines

__all__ = ["LEAST_PROBABILITY", "LineQuantiles", "probability_interval", "quantiles_at", "quantiles_of"]

LEAST_PROBABILITY = 1e-15
"""Probabilities below are not told from none."""

_ROUNDING = 1e-9
"""Part of the scale of an output below which its numbers are rounding."""

_EXACT = 1e-4
"""Part of the scale by which a quantile may still move; the correction then leaves a small part of that."""

_EXACT_PART = 1e-3
"""Part of itself by which a probability may still move, likewise."""

_SLOPE_ERROR = 0.1
"""How well the slope of a line is known; a correction leaves at most this part of itself."""

_NEAR = 5e-3
"""Part of the scale, and of the normal scale, from which the model itself takes over from the table."""

_FAR_LEVEL = 3.5
"""Levels of Φ beyond which lines may end before an output does."""

_NEWTON, _SEARCHES = 8, 40
"""Steps of a search in the tables: by Newton's rule, then halvings, which leave 1e-9 of the range."""

_ROUNDS = 12
"""Most corrections on the model itself; what they leave is told."""


@dataclass(frozen=True, kw_only=True)
class LineQuantiles:
    """Outputs (levels, rows), the probability `above` each, its standard error, and the density there.

    `blunt` is the part of the probabilities' error that more lines would not remove, `residual` that of the outputs'.
    """

    output: Array
    above: Array
    above_error: Array
    blunt: Array
    density: Array
    residual: Array

    @property
    def output_error(self) -> Array:
        """Standard errors of the outputs as quantiles: that of the probability over the density."""
        return self.above_error / positive(self.density) + self.residual

    def take(self, levels: int) -> LineQuantiles:
        """Return the first levels."""
        return LineQuantiles(**{name: values[:levels] for name, values in vars(self).items()})

    def widened(self, margin: Array) -> LineQuantiles:
        """Return the same with standard errors times a margin (rows,)."""
        return replace(self, above_error=self.above_error * margin)


def quantiles_of(drawn: DrawnLines, probability: Array) -> LineQuantiles:
    """Return the outputs that each row stays below with these probabilities.

    Equation: y with Φ⁻¹(P(Y ≤ y)) = Φ⁻¹(p), by Newton's rule
    Arguments: lines of rows alike without faults; probability (levels,).
    Valid: p from `LEAST_PROBABILITY` to 1 − `LEAST_PROBABILITY`; others are taken as these.
    Source: line sampling, as in `line_tables`; control variates, as in `line_control`.
    """
    lines, control = drawn.lines, drawn.control
    probability = np.clip(probability, LEAST_PROBABILITY, 1 - LEAST_PROBABILITY)
    level = ndtri(probability)[:, None]
    scaled = (level - NODES[0]) / STEP
    node = np.clip(scaled.astype(int), 0, len(NODES) - 2)
    start = lines.table[node[:, 0]] * (1 - (scaled - node)) + lines.table[node[:, 0] + 1] * (scaled - node)
    output = lines.mean_over_lines(start) + level * _wider(lines)
    trusted = None
    if control is not None:
        trusted = control.trusted(np.minimum(probability, 1 - probability)[:, None])
        output = np.where(trusted, control.quantiles(probability), output)
    bounds = _bounds(drawn)
    search = _Search(Estimator(drawn, trusted), lines, level, bounds)
    return search.corrected(*search.in_table(np.clip(output, *bounds), level))


def quantiles_at(drawn: DrawnLines, output: Array) -> LineQuantiles:
    """Return the probabilities above outputs.

    Equation: P(Y > y) as in `line_tables` and `line_control`
    Arguments: lines of rows alike without faults; output (levels, rows) in the unit of the model's.
    Valid: any output; one out of reach has the probability 0 or 1.
    Source: line sampling, as in `line_tables`; control variates, as in `line_control`.
    """
    lines, control = drawn.lines, drawn.control
    bounds = _bounds(drawn)
    # An output out of reach is crossed as one just beyond it.
    output = np.clip(output, *_reach(drawn, bounds, output))
    trusted = None
    if control is not None:
        seen = lines.mean_over_lines(ndtr(-lines.crossings(lines.each(output))[0])), control.above(output)
        trusted = control.trusted(np.maximum(*(np.minimum(above, 1 - above) for above in seen)))
    estimator = Estimator(drawn, trusted)
    quantiles = _Search(estimator, lines, None, bounds).corrected(output, estimator.fronts(output))
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


def _bounds(drawn: DrawnLines) -> tuple[Array, Array]:
    """Return least and greatest output (rows,) in the tables of the model and of the surrogates used."""
    low, high = drawn.lines.bounds
    if drawn.control is None:
        return low, high
    used, (lower, higher) = drawn.control.used, drawn.control.bounds
    return np.where(used, np.minimum(low, lower), low), np.where(used, np.maximum(high, higher), high)


def _reach(drawn: DrawnLines, bounds: tuple[Array, Array], output: Array) -> tuple[Array, Array]:
    """Return beyond which outputs (rows,) nothing lies: neither on lines, nor by the laws of the surrogates used."""
    lines, control = drawn.lines, drawn.control
    low, high = bounds[0] - lines.scale, bounds[1] + lines.scale
    if control is None or not ((output < low) | (output > high)).any():
        return low, high
    # Inputs that are bounded by themselves may leave lines short of where a steep output still goes.
    lowest, highest = control.quantiles(np.array([LEAST_PROBABILITY, 1 - LEAST_PROBABILITY]))
    used = control.used
    return np.where(used, np.minimum(low, lowest), low), np.where(used, np.maximum(high, highest), high)


class _Search:
    """The search for outputs at wanted levels of Φ (levels, 1); without these it only corrects crossings.

    Each pair of level and row stops by itself, so that its numbers do not depend on its neighbours.
    """

    def __init__(self, estimator: Estimator, lines: Lines, level: Array | None, bounds: tuple[Array, Array]) -> None:
        self._estimator = estimator
        self._lines = lines
        self._level = level
        self._bounds = bounds
        self._far = False if level is None else np.abs(level) > _FAR_LEVEL

    def in_table(self, output: Array, level: Array) -> tuple[Array, list[Front]]:
        """Return outputs near the wanted levels, and the fronts there, by the tables alone."""
        low, high = self._bounds
        near = np.zeros(output.shape, dtype=bool)
        for search in range(_SEARCHES):
            fronts = self._estimator.fronts(output)
            moved, missing, counts = self._moved(output, fronts, level)
            near = near | ((np.abs(moved - output) <= _NEAR * counts) & (np.abs(missing) <= _NEAR))
            if near.all():
                break
            low = np.where(moved > output, output, low)
            high = np.where(moved < output, output, high)
            outside = (moved <= low) | (moved >= high) | (search >= _NEWTON)
            moved = np.where(outside & ~near, (low + high) / 2, moved)
            output = np.where(near, output, moved)
        output = np.clip(moved, *self._bounds)
        return output, [front.moved(output, self._lines.lines) for front in fronts]

    def _moved(self, output: Array, fronts: Sequence[Front], level: Array) -> tuple[Array, Array, Array]:
        """Return outputs nearer to the wanted levels by Newton's rule, what was missing of these, and what counts.

        What counts is the scale, or how far a unit of the levels reaches at outputs that are steeper there: it is what
        steps are cut at, and what small ones are small beside.
        """
        above, density = self._estimator.above(fronts)
        now = -ndtri(np.clip(above, LEAST_PROBABILITY / 10, 1 - LEAST_PROBABILITY / 10))
        low, high = self._bounds
        rise = np.minimum(normal_density(now) / positive(density), high - low)
        counts = np.maximum(rise, self._lines.scale)
        return output + np.clip((level - now) * rise, -counts, counts), level - now, counts

    def corrected(self, output: Array, fronts: list[Front]) -> LineQuantiles:
        """Return the quantiles at outputs, which move to the wanted levels if there are any."""
        lines, start = self._lines, output
        settled, residual = np.zeros(output.shape, dtype=bool), np.zeros(output.shape)
        exact = _ROUNDING if len(lines.inputs.names) == 1 else _EXACT
        for _ in range(_ROUNDS):
            live = lines.each(~settled)
            tried = [front.tried(live, lines.lines) for front in fronts]
            left, sure = self._estimator.left(fronts, tried), np.ones(output.shape, dtype=bool)
            if self._level is not None:
                target, missing, counts = self._moved(output, tried, self._level)
                target = np.clip(target, *self._bounds)
                tried = [front.moved(target, lines.lines) for front in tried]
                short = np.abs(missing) * exact * lines.scale / _EXACT
                left = np.maximum(left, np.maximum(np.abs(target - output), short))
                off = np.abs(np.clip(output + missing * counts, *self._bounds) - output)
                # A law that is trusted goes on beyond the lines, where limits that outputs approach are not told apart.
                off = np.where(self._estimator.trusted & self._far, np.abs(missing) * counts, off)
                output = np.where(settled, output, target)
            else:
                above, density = self._estimator.above(tried)
                rarer = np.minimum(above, 1 - above)
                left = np.where(rarer <= LEAST_PROBABILITY, 0.0, left)
                # A steep output may be followed to a small part of its scale, and its rare values not.
                sure = left * density <= _EXACT_PART * rarer
            fronts = [now.settled(before, live, settled) for now, before in zip(tried, fronts, strict=True)]
            residual = np.where(settled, residual, left)
            settled = settled | ((left <= exact * lines.scale) & sure)
            if settled.all():
                break
        if self._level is not None:
            settled = settled | (left <= exact * counts)
            # What cannot be followed on the model stays what the table says.
            residual = np.where(settled, residual, np.maximum(residual, np.maximum(off, np.abs(output - start))))
            output = np.where(settled, output, start)
        found = self._estimator.estimate(fronts)
        residual = np.where(settled, _SLOPE_ERROR * residual, residual)
        return LineQuantiles(
            output=output,
            above=found.above,
            above_error=found.error + (residual * found.density if self._level is None else 0.0),
            blunt=found.blunt,
            density=found.density,
            residual=np.maximum(residual, _ROUNDING * lines.scale),
        )
