"""Outputs and the probabilities above them, by the positions where lines cross the outputs.

    level               one wanted probability or one output; arrays are (levels, rows)
    front               where curves of one kind, model or surrogate, cross the outputs of all levels

Crossings found in the table are corrected on the curves themselves until nothing is left to correct, so the table's
spacing leaves no bias.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
import numpy.typing as npt
from scipy.special import ndtr, ndtri

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_control import LineControl
from flexlash.tolerance.engine.line_crossings import FAR, NODES, STEP
from flexlash.tolerance.engine.line_drawing import DrawnLines
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

_APART = 1e-6
"""Least distance of two positions between which a slope is taken."""

_NEWTON = 8
_SEARCHES = 40
_ROUNDS = 12

Bools = npt.NDArray[np.bool_]


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
    estimator = _Estimator(lines, control, trusted)
    output, fronts = estimator.in_table(np.clip(output, *estimator.bounds), level)
    return estimator.corrected(output, fronts, level)


def quantiles_at(drawn: DrawnLines, output: Array) -> LineQuantiles:
    """Return the probabilities above outputs.

    Equation: P(Y > y) as in `line_tables` and `line_control`
    Arguments: lines of rows alike without faults; output (levels, rows) in the unit of the model's.
    Valid: any output; one out of reach has the probability 0 or 1.
    Source: line sampling, as in `line_tables`; control variates, as in `line_control`.
    """
    lines, control = drawn.lines, drawn.control
    low, high = _bounds(lines, control)
    # An output out of reach is crossed as one just beyond it.
    output = np.clip(output, low - lines.scale, high + lines.scale)
    trusted = None
    if control is not None:
        seen = lines.mean_over_lines(ndtr(-lines.crossings(lines.each(output))[0])), control.above(output)[0]
        trusted = control.trusted(np.maximum(*(np.minimum(above, 1 - above) for above in seen)))
    estimator = _Estimator(lines, control, trusted)
    quantiles = estimator.corrected(output, estimator.fronts(output), None)
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


def _bounds(lines: Lines, control: LineControl | None) -> tuple[Array, Array]:
    """Return least and greatest output (rows,) in the tables of the model and of the surrogates used."""
    low, high = lines.bounds
    if control is None:
        return low, high
    lower, higher = control.bounds
    return np.where(control.used, np.minimum(low, lower), low), np.where(control.used, np.maximum(high, higher), high)


class _Curves(Protocol):
    """Curves along lines: those of the model, and those of the surrogate."""

    def target(self, output: Array) -> Array: ...

    def crossings(self, outputs: Array) -> tuple[Array, Array]: ...

    def outputs(self, positions: Array) -> Array: ...


@dataclass(frozen=True, kw_only=True)
class _Front:
    """Where curves cross what stands for outputs: target, positions and slopes (levels, rows × lines), the last try."""

    curves: _Curves
    target: Array
    position: Array
    slope: Array
    before: tuple[Array, Array] | None = None
    gap: Array | float = 0.0

    def tried(self, live: Bools) -> _Front:
        """Return the front corrected by what the curves themselves say; `gap` is the correction."""
        reached = self.curves.outputs(self.position)
        slope = self.slope
        if self.before is not None:
            slope = np.where(live, _secant(self.before, (self.position, reached), slope), slope)
        gap = _within((self.target - reached) / slope, STEP)
        position = _within(self.position + gap, FAR)
        return replace(self, position=position, slope=slope, before=(self.position, reached), gap=gap)

    def moved(self, output: Array) -> _Front:
        """Return the front after it moved to other outputs (levels, rows)."""
        target = self.curves.target(output)
        step = _within((target - self.target) / self.slope, STEP)
        return replace(self, target=target, position=_within(self.position + step, FAR))

    def settled(self, before: _Front, live: Bools) -> _Front:
        """Return the front that stays where it was before, but for what is live."""
        position = np.where(live, self.position, before.position)
        return replace(self, position=position, target=np.where(live, self.target, before.target))


class _Estimator:
    """The estimate of probabilities above outputs from the fronts of the model and, where trusted, the surrogate."""

    def __init__(self, lines: Lines, control: LineControl | None, trusted: Bools | None) -> None:
        self._lines = lines
        self._control = control if trusted is not None and trusted.any() else None
        self._trusted: Bools = np.zeros((1, lines.rows), dtype=bool) if trusted is None else trusted
        self.bounds = _bounds(lines, control)

    def fronts(self, output: Array) -> list[_Front]:
        """Return the fronts at outputs by the tables."""
        kinds: list[_Curves] = [self._lines, *([self._control] if self._control else [])]
        found = []
        for curves in kinds:
            target = curves.target(output)
            position, slope = curves.crossings(target)
            found.append(_Front(curves=curves, target=target, position=position, slope=slope))
        return found

    def crossed(self, fronts: Sequence[_Front]) -> Array:
        """Return what each line adds, (levels, rows × lines)."""
        crossed = ndtr(-fronts[0].position)
        if self._control is None:
            return np.asarray(crossed)
        return crossed - np.where(self._lines.each(self._trusted), ndtr(-fronts[1].position), 0.0)

    def above(self, output: Array, fronts: Sequence[_Front]) -> tuple[Array, Array]:
        """Return the probabilities above outputs (levels, rows), and the densities there."""
        above = self._lines.mean_over_lines(self.crossed(fronts))
        density = self._lines.mean_over_lines(normal_density(fronts[0].position) / fronts[0].slope)
        if self._control is None:
            return above, density
        exact, exact_density = self._control.above(output)
        return np.where(self._trusted, above + exact, above), np.where(self._trusted, exact_density, density)

    def moved(self, output: Array, fronts: Sequence[_Front], level: Array) -> tuple[Array, list[_Front], Array]:
        """Return outputs nearer to the wanted level of Φ by Newton's rule, the fronts there, and what was missing."""
        above, density = self.above(output, fronts)
        now = -ndtri(np.clip(above, LEAST_PROBABILITY / 10, 1 - LEAST_PROBABILITY / 10))
        scale = self._lines.scale
        step = np.clip((level - now) * normal_density(now) / _positive(density), -scale, scale)
        target = output + step
        return target, [front.moved(target) for front in fronts], np.abs(level - now)

    def in_table(self, output: Array, level: Array) -> tuple[Array, list[_Front]]:
        """Return outputs near the wanted level of Φ, and the fronts there, by the tables alone."""
        low, high = self.bounds
        near = np.zeros(output.shape, dtype=bool)
        for search in range(_SEARCHES):
            moved, fronts, missing = self.moved(output, self.fronts(output), level)
            near = near | ((np.abs(moved - output) <= _NEAR * self._lines.scale) & (missing <= _NEAR))
            if near.all():
                break
            low = np.where(moved > output, output, low)
            high = np.where(moved < output, output, high)
            outside = (moved <= low) | (moved >= high) | (search >= _NEWTON)
            moved = np.where(outside, (low + high) / 2, moved)
            output = np.where(near, output, moved)
        return np.clip(moved, *self.bounds), fronts

    def corrected(self, output: Array, fronts: Sequence[_Front], level: Array | None) -> LineQuantiles:
        """Return the quantiles at outputs, which move to the wanted level of Φ if there is one.

        Each pair of level and row stops by itself, so that its numbers do not depend on its neighbours.
        """
        lines = self._lines
        settled = np.zeros(output.shape, dtype=bool)
        residual = np.zeros(output.shape)
        start = output
        exact = _ROUNDING if len(lines.inputs.names) == 1 else _EXACT
        for _ in range(_ROUNDS):
            live = lines.each(~settled)
            tried = [front.tried(live) for front in fronts]
            left = self._left(fronts, tried)
            target, sure = output, np.ones(output.shape, dtype=bool)
            if level is not None:
                target, tried, missing = self.moved(output, tried, level)
                target = np.clip(target, *self.bounds)
                left = np.maximum(left, np.maximum(np.abs(target - output), missing * exact * lines.scale / _EXACT))
            else:
                above, density = self.above(output, tried)
                rarer = np.minimum(above, 1 - above)
                left = np.where(rarer <= LEAST_PROBABILITY, 0.0, left)
                # A steep output may be followed to a small part of its scale, and its rare values not.
                sure = left * density <= _EXACT_PART * rarer
            output = np.where(settled, output, target)
            fronts = [now.settled(before, live) for now, before in zip(tried, fronts, strict=True)]
            residual = np.where(settled, residual, left)
            settled = settled | ((left <= exact * lines.scale) & sure)
            if settled.all():
                break
        if level is not None:
            # What cannot be followed on the model stays what the table says.
            residual = np.where(settled, residual, np.maximum(residual, np.abs(output - start)))
            output = np.where(settled, output, start)
        above, density = self.above(output, fronts)
        error = self._error(output, fronts)
        residual = np.where(settled, _SLOPE_ERROR * residual, residual)
        if level is None:
            error = error + residual * density
        residual = np.maximum(residual, _ROUNDING * lines.scale)
        return LineQuantiles(output=output, above=above, above_error=error, density=density, residual=residual)

    def _error(self, output: Array, fronts: Sequence[_Front]) -> Array:
        """Return the standard errors of the probabilities above outputs (levels, rows) for want of lines."""
        error = self._lines.standard_error(self.crossed(fronts))
        if self._control is None:
            return error
        unseen = self._control.unseen(output, self._lines.mean_over_lines(ndtr(-fronts[1].position)))
        return np.where(self._trusted, np.maximum(error, unseen) + self._control.law.residual, error)

    def _left(self, fronts: Sequence[_Front], tried: Sequence[_Front]) -> Array:
        """Return about how far outputs (levels, rows) are off for what the fronts had to be corrected by."""
        mean = self._lines.mean_over_lines
        density = _positive(mean(normal_density(fronts[0].position) / tried[0].slope))
        off = [mean(normal_density(was.position) * np.abs(now.gap)) for was, now in zip(fronts, tried, strict=True)]
        if self._control is None:
            return off[0] / density
        return np.where(self._trusted, np.maximum(*off), off[0]) / density


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
