"""Where lines cross outputs, and what follows of the probabilities above these: of the model, and of its surrogate.

front               where curves of one kind, model or surrogate, cross the outputs of all levels
value               what stands for an output on these curves: itself, or a value of S
estimate            the probability above an output: lines alone, or what they add to the surrogate's own
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
import numpy.typing as npt
from scipy.special import ndtr

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_control import LineControl
from flexlash.tolerance.engine.line_crossings import FAR, STEP
from flexlash.tolerance.engine.line_drawing import DrawnLines
from flexlash.tolerance.engine.line_points import normal_density

__all__ = ["Estimate", "Estimator", "Front", "positive"]

_APART = 1e-6
"""Least distance of two positions between which a slope is taken."""

Bools = npt.NDArray[np.bool_]


class Curves(Protocol):
    """Curves along lines: those of the model, and those of the surrogate."""

    def matched(self, output: Array) -> tuple[Array, Array]: ...

    def crossings(self, values: Array) -> tuple[Array, Array]: ...

    def outputs(self, positions: Array) -> Array: ...


@dataclass(frozen=True, kw_only=True)
class Front:
    """Where curves cross values: positions and slopes (levels, rows × lines) of values and their rates (levels, rows).

    `before` are the positions tried last with what was reached there, `gap` how far they had to be corrected.
    """

    curves: Curves
    value: Array
    rate: Array
    position: Array
    slope: Array
    before: tuple[Array, Array] | None = None
    gap: Array | float = 0.0

    @classmethod
    def of(cls, curves: Curves, output: Array, lines: int) -> Front:
        """Return the front at outputs (levels, rows) by the table; rows have so many lines."""
        value, rate = curves.matched(output)
        position, slope = curves.crossings(np.repeat(value, lines, axis=1))
        return cls(curves=curves, value=value, rate=rate, position=position, slope=slope)

    def tried(self, live: Bools, lines: int) -> Front:
        """Return the front corrected by what the curves themselves say."""
        reached = self.curves.outputs(self.position)
        slope = self.slope
        if self.before is not None:
            slope = np.where(live, _secant(self.before, (self.position, reached), slope), slope)
        gap = _within((np.repeat(self.value, lines, axis=1) - reached) / slope, STEP)
        position = _within(self.position + gap, FAR)
        return replace(self, position=position, slope=slope, before=(self.position, reached), gap=gap)

    def moved(self, output: Array, lines: int) -> Front:
        """Return the front after it moved to other outputs (levels, rows)."""
        value, rate = self.curves.matched(output)
        step = _within(np.repeat(value - self.value, lines, axis=1) / self.slope, STEP)
        return replace(self, value=value, rate=rate, position=_within(self.position + step, FAR))

    def settled(self, before: Front, live: Bools, settled: Bools) -> Front:
        """Return the front that stays where it was before in what is settled."""
        return replace(
            self,
            value=np.where(settled, before.value, self.value),
            rate=np.where(settled, before.rate, self.rate),
            position=np.where(live, self.position, before.position),
        )


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """Probabilities above outputs, their densities and standard errors, (levels, rows) each.

    `blunt` is the part of the errors that more lines would not remove.
    """

    above: Array
    density: Array
    error: Array
    blunt: Array


class Estimator:
    """The estimate from the fronts of the model and, at the levels where it is `trusted`, of the surrogate."""

    def __init__(self, drawn: DrawnLines, trusted: Bools | None) -> None:
        self._lines = drawn.lines
        self._control: LineControl | None = drawn.control
        self.trusted: Bools = np.zeros((1, drawn.lines.rows), dtype=bool) if trusted is None else trusted

    def fronts(self, output: Array) -> list[Front]:
        """Return the fronts at outputs by the tables."""
        kinds: list[Curves] = [self._lines, *([self._control] if self._control else [])]
        return [Front.of(curves, output, self._lines.lines) for curves in kinds]

    def above(self, fronts: Sequence[Front]) -> tuple[Array, Array]:
        """Return the probabilities above the outputs of fronts (levels, rows), and the densities there."""
        return self._corrected(fronts, self._crossed(fronts), self._own(fronts))

    def estimate(self, fronts: Sequence[Front]) -> Estimate:
        """Return the probabilities above the outputs of fronts with all that is told of them."""
        crossed, own = self._crossed(fronts), self._own(fronts)
        above, density = self._corrected(fronts, crossed, own)
        error, blunt = self._lines.standard_error(crossed), np.zeros_like(above)
        if self._control is not None:
            on_lines = ndtr(-fronts[1].position)
            unseen = self._control.unseen(*own, self._lines.mean_over_lines(on_lines))
            unseen = np.maximum(unseen, self._control.unmet(fronts[1].value, own[0], on_lines))
            blunt = np.where(self.trusted, self._control.law.residual, self._control.untold(above))
            error = np.where(self.trusted, np.maximum(error, unseen), error) + blunt
        return Estimate(above=above, density=density, error=error, blunt=blunt)

    def left(self, fronts: Sequence[Front], tried: Sequence[Front]) -> Array:
        """Return about how far outputs (levels, rows) are off for what the fronts had to be corrected by."""
        mean = self._lines.mean_over_lines
        density = positive(mean(normal_density(fronts[0].position) / tried[0].slope))
        off = [mean(normal_density(was.position) * np.abs(now.gap)) for was, now in zip(fronts, tried, strict=True)]
        if self._control is None:
            return np.asarray(off[0] / density)
        return np.asarray(np.where(self.trusted, np.maximum(*off), off[0]) / density)

    def _crossed(self, fronts: Sequence[Front]) -> Array:
        """Return what each line adds, (levels, rows × lines)."""
        crossed = ndtr(-fronts[0].position)
        if self._control is None:
            return np.asarray(crossed)
        return np.asarray(crossed - np.where(self._lines.each(self.trusted), ndtr(-fronts[1].position), 0.0))

    def _own(self, fronts: Sequence[Front]) -> tuple[Array, Array]:
        """Return the surrogate's own exact probabilities above what stands for outputs, and its densities there."""
        if self._control is None:
            return np.zeros(1), np.zeros(1)
        below, density = self._control.law.below(fronts[1].value)
        return 1 - below, density

    def _corrected(self, fronts: Sequence[Front], crossed: Array, own: tuple[Array, Array]) -> tuple[Array, Array]:
        """Return what lines and surrogate together say of the probabilities above outputs, and of the densities."""
        above = self._lines.mean_over_lines(crossed)
        density = self._lines.mean_over_lines(normal_density(fronts[0].position) / fronts[0].slope)
        if self._control is None:
            return above, density
        return np.where(self.trusted, above + own[0], above), np.where(self.trusted, own[1] * fronts[1].rate, density)


def _secant(before: tuple[Array, Array], now: tuple[Array, Array], slope: Array) -> Array:
    """Return the slopes between two positions of each line where they are far enough apart, within a factor of 5."""
    moved = now[0] - before[0]
    apart = np.abs(moved) > _APART
    secant = (now[1] - before[1]) / np.where(apart, moved, 1.0)
    return np.where(apart, np.clip(secant, 0.2 * slope, 5 * slope), slope)


def _within(values: Array, most: float) -> Array:
    """Return values cut at ± most."""
    return np.minimum(np.maximum(values, -most), most)


def positive(density: Array) -> Array:
    """Return densities that one can divide by."""
    return np.maximum(density, np.finfo(float).tiny)
