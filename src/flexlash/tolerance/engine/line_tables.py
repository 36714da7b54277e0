"""Lines through the space of the inputs along which the output only rises.

Every input is a function of a standard normal score. Lines run parallel to the direction in which the output
rises fastest at the median; a scrambled net places them in the directions across. Where a line passes an
output y at the position t, the part Φ(−t) of the line lies above y: the mean over lines is P(Y > y).

Equation: P(Y > y) = E[Φ(−t(y))], the mean over lines of a net
Valid: an output that only rises along every line; what keeps lines from a row is told by `FAULTS`.
Source: Koutsourelakis, Pradlwarter and Schuëller 2004 (line sampling); L'Ecuyer and others (conditional Monte Carlo
    with randomized quasi-Monte Carlo).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array
from flexlash.tolerance.distributions import Distribution, Normal
from flexlash.tolerance.engine.line_crossings import FAR, NODES, STEP, crossings
from flexlash.tolerance.engine.line_direction import Indices, Inputs, LineDirection, RowModel, scores_across
from flexlash.tolerance.engine.line_points import LINE_REPLICATES, Net
from flexlash.tolerance.engine.line_smoothness import ALMOST_STRAIGHT, is_stepped, looked_closely
from flexlash.tolerance.sampling import standard_error

__all__ = ["FAULTS", "REACH", "STEPS", "Lines", "bounds_of"]

REACH = 8.3
"""Scores beyond ±8.3 have no weight in double precision and are not visited."""

FAULTS = (
    "",
    "the output has no gradient at the median",
    "the model is not finite within 8 standard deviations",
    "the output does not rise everywhere along its gradient at the median",
    "the output rises in steps",
    "the output bends sharply or stays the same over a part of its range",
    "the output jumps, or rises too steeply for the points looked at",
)
"""Why lines do not serve a row."""

_NO_GRADIENT, _NOT_FINITE, _FALLS, _STEPPED, _BENDS, STEPS = range(1, len(FAULTS))

_PROBED = np.array([-2.0, -1.0, 1.0])
"""Nodes after which the model is looked at once more."""

_ASIDE = (3 - 5**0.5) / 2
"""How far after them, in steps; not halfway, where a wave of the nodes' own length would hide, nor at a round number,
where steps of one would."""

_CUBIC = np.array([
    -_ASIDE * (_ASIDE - 1) * (_ASIDE - 2) / 6,
    (_ASIDE + 1) * (_ASIDE - 1) * (_ASIDE - 2) / 2,
    -(_ASIDE + 1) * _ASIDE * (_ASIDE - 2) / 2,
    (_ASIDE + 1) * _ASIDE * (_ASIDE - 1) / 6,
])  # fmt: skip
"""Weights of the four nodes around of the cubic through them."""

_DIP = 1e-9
"""A fall along a line smaller than this part of its range is rounding."""

_ROUGH = 0.05
"""A model that lies this part of a step off the cubic through its neighbours may have steps of its own."""

_LONE, _LONE_PART = 1.5, 0.01
"""A step along a line may be a jump if it is this much greater than both its neighbours, and this part of the range."""

_FLAT, _HIGH = 1e-12, 0.05
"""A line is flat where it rises less than the one part of its range, and has an edge where two positions on it rises
more than the other: limits that are approached smoothly take longer."""

_BEYOND, _MOST_BEYOND = 2.0, 8.0
"""How many times further from the mean lines beyond an evenly spaced coordinate may be than its last: at least the one
number, as many as the last is beyond the one before it, at most the other."""

_LOOKED_AT = 64
"""Lines of a row that are looked at closely where its table is uneven."""

_BLOCK = 1 << 13
"""Numbers of one input that are modelled together, so that what is made of all inputs stays in the cache."""

Number = TypeVar("Number", bound=np.generic)


class Lines:
    """Lines through rows alike, tabulated at nodes: `table` (nodes, rows × lines) of outputs that only rise.

    `lines` is the number per row, LINE_REPLICATES times a power of two. `faults` (rows,) holds 0, or the index in
    `FAULTS` of what keeps line sampling from a row; what else is read of the lines holds for the other rows. `scale`
    (rows,) is about the standard deviation of the output, `roughness` (rows,) how far the model lies off its table.
    """

    def __init__(self, model: RowModel, inputs: Inputs, direction: LineDirection, net: Net) -> None:
        self._model = model
        self.inputs = inputs
        self.rows = inputs.count
        self.lines = net.lines
        self._net = net
        self._row_of = np.repeat(np.arange(self.rows), self.lines)
        # What is straight in independent scores is straight in correlated ones.
        self._origin = inputs.correlated(scores_across(direction, net.scores).reshape(len(inputs.names), -1))
        self._direction = inputs.correlated(direction.vector[:, self._row_of])
        reach = np.abs(self._origin).max(axis=1) + FAR * np.abs(self._direction).max(axis=1)
        self._far = np.flatnonzero(reach > REACH)
        self._location = inputs.location[:, self._row_of]
        self._scale = inputs.scale[:, self._row_of]
        self._alike = _alike(inputs.shapes)
        outputs = self.outputs(np.concatenate([NODES, _PROBED + _ASIDE * STEP])[:, None])
        table, probes = outputs[: len(NODES)], outputs[len(NODES) :]
        self.faults = self._faults(direction.vector, table, probes)
        self.table = table if (np.diff(table, axis=0) >= 0).all() else np.maximum.accumulate(table, axis=0)
        down, up = np.searchsorted(NODES, [-2.0, 2.0])
        self.scale = self.mean_over_lines(self.table[up : up + 1] - self.table[down : down + 1])[0] / 4

    def _faults(self, vector: Array, table: Array, probes: Array) -> Indices:
        """Return what keeps line sampling from each row, by its index in `FAULTS`."""
        step = np.diff(table, axis=0)
        faults = np.where((vector != 0).any(axis=0), 0, _NO_GRADIENT)
        if not (step.min() >= 0 and np.isfinite(probes).all()):
            # The usual table rises outright; only others are looked at more closely.
            finite = np.isfinite(table).all(axis=0) & np.isfinite(probes).all(axis=0)
            faults = np.where(self._all_lines(finite) | (faults > 0), faults, _NOT_FINITE)
            rises = (step >= -_slack(table)).all(axis=0)
            faults = np.where(self._all_lines(rises) | (faults > 0), faults, _FALLS)
        before = table[np.add.outer(np.arange(-1, 3), np.searchsorted(NODES, _PROBED))]
        between = sum(weight * values for weight, values in zip(_CUBIC, before, strict=True))
        off = np.abs(probes - between)
        around = self.mean_over_lines(before[2] - before[1]).sum(axis=0)
        self.roughness = self.mean_over_lines(off).sum(axis=0) / np.where(around > 0, around, 1.0)
        look = np.flatnonzero((self.roughness > ALMOST_STRAIGHT) & (faults == 0))
        faults[look[self._stepped(look, table)]] = _STEPPED
        even = self._even(step)
        for row in np.flatnonzero(((self.roughness > _ROUGH) | ~self._all_lines(even)) & (faults == 0)):
            own = slice(row * self.lines, (row + 1) * self.lines)
            worst = np.argsort(-off[:, own].sum(axis=0) - np.where(even[own], 0.0, np.inf), kind="stable")
            faults[row] = self._uneven(own.start + worst[:_LOOKED_AT], table)
        return faults

    def _stepped(self, rows: Indices, table: Array) -> npt.NDArray[np.bool_]:
        """Return which of these rows rise in steps, by one line of each replicate."""
        if not len(rows):
            return np.zeros(0, dtype=bool)
        lines = np.add.outer(rows * self.lines, np.arange(LINE_REPLICATES) * (self.lines // LINE_REPLICATES))
        return is_stepped(self._outputs_on, lines, NODES, table[:, lines.ravel()])

    def _uneven(self, lines: Indices, table: Array) -> int:
        """Return what keeps a row from these lines of its, whose tables are uneven; steep ones may still be smooth."""
        own = table[:, lines]
        # A single input has a quadrature of its own, finer than the table.
        integrated = own if len(self.inputs.names) > 1 else None
        found = looked_closely(self._outputs_on, lines, NODES, integrated, _slack(own))
        faults = {_FALLS: found.falls, _STEPPED: found.jumps, _BENDS: found.bends, STEPS: found.steep}
        return next((fault for fault, is_found in faults.items() if is_found), 0)

    def _outputs_on(self, lines: Indices, positions: Array) -> Array:
        """Return the outputs (k, n) on some n lines at positions (k, 1) or (k, n)."""
        return self._modelled(self._values(positions, lines), lines)

    def _even(self, step: Array) -> npt.NDArray[np.bool_]:
        """Return which lines have neither a lone step, far above both its neighbours, nor an edge to a flat part."""
        inner = step[1:-1]
        lone = (inner > _LONE * np.maximum(step[:-2], step[2:])) & (inner >= _LONE_PART * step.sum(axis=0))
        apart = round(2 / STEP)
        flat = step <= _FLAT * step.sum(axis=0)
        high = step >= _HIGH * step.sum(axis=0)
        edge = (flat[:-apart] & high[apart:]) | (high[:-apart] & flat[apart:])
        return np.asarray(~(lone.any(axis=0) | edge.any(axis=0)))

    def _all_lines(self, sound: npt.NDArray[np.bool_] | np.bool_) -> npt.NDArray[np.bool_]:
        """Return whether every line (rows × lines,) of a row is sound."""
        return np.asarray(sound.reshape(self.rows, -1).all(axis=1))

    def outputs(self, positions: Array) -> Array:
        """Return the outputs (k, rows × lines) at positions (k, 1) or (k, rows × lines) along the lines."""
        return self.along(positions, self._modelled)

    def _modelled(self, values: Array, lines: slice | Indices) -> Array:
        return self._model(dict(zip(self.inputs.names, values, strict=True)), self._row_of[lines])

    def outputs_at(self, values: Array) -> Array:
        """Return the outputs (k, rows) at values (inputs, k, rows) of the inputs."""
        return self._model(dict(zip(self.inputs.names, values, strict=True)), np.arange(self.rows))

    def along(self, positions: Array, function: Callable[[Array, slice], Array]) -> Array:
        """Return a function of the inputs (inputs, k, columns), and of the columns they are, along the lines."""
        width = self._origin.shape[1]
        output = np.empty((len(positions), width))
        step = max(_BLOCK // len(positions), 1)
        for start in range(0, width, step):
            block = slice(start, min(start + step, width))
            cut = positions if positions.shape[1] == 1 else positions[:, block]
            output[:, block] = function(self._values(cut, block), block)
        return output

    def _values(self, along: Array, lines: slice | Indices) -> Array:
        """Return the inputs (inputs, k, lines) at positions (k, 1) or (k, lines) along some lines."""
        values = self._direction[:, None, lines] * along
        values += self._origin[:, None, lines]
        for index in self._far:
            np.minimum(np.maximum(values[index], -REACH, out=values[index]), REACH, out=values[index])
        for shape, chosen in self._alike:
            values[chosen] = shape.standard_at(values[chosen])
        values *= self._scale[:, None, lines]
        values += self._location[:, None, lines]
        return values

    def matched(self, output: Array) -> tuple[Array, Array]:
        """Return what stands for outputs (levels, rows) on lines, these themselves, and how it rises with them."""
        return output, np.ones_like(output)

    def crossings(self, outputs: Array) -> tuple[Array, Array]:
        """Return where lines cross outputs (levels, rows × lines) by the table, and their slopes there."""
        return crossings(self.table, outputs)

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Least and greatest output in the table of each row, (rows,) each."""
        return bounds_of(self.table, self.rows)

    def each(self, values: npt.NDArray[Number]) -> npt.NDArray[Number]:
        """Return values (k, rows) once for every line, (k, rows × lines)."""
        return np.repeat(values, self.lines, axis=1)

    def mean_over_lines(self, values: Array) -> Array:
        """Return the means (k, rows) of values (k, rows × lines)."""
        weighted = values.reshape(-1, self.rows, self.lines) * self._net.weights
        return np.asarray(np.add.reduce(weighted, axis=2) / LINE_REPLICATES)

    def replicate_means(self, values: Array) -> Array:
        """Return the means (k, rows, replicates) of values (k, rows × lines)."""
        weighted = values.reshape(-1, self.rows, self.lines) * self._net.weights
        return np.asarray(np.add.reduce(weighted.reshape(len(weighted), self.rows, LINE_REPLICATES, -1), axis=3))

    def standard_error(self, values: Array) -> Array:
        """Return the standard errors (k, rows) of the means over lines of values (k, rows × lines)."""
        return standard_error(self.replicate_means(values)) + self.left_out(values)

    def left_out(self, values: Array) -> Array:
        """Return how far means (k, rows) of values may be off for want of lines beyond an evenly spaced coordinate."""
        spaced = self._net.spaced
        if not spaced:
            return np.zeros((len(values), self.rows))
        mean = self.mean_over_lines(values)
        by_point = values.reshape(
            -1, self.rows, LINE_REPLICATES, spaced, values.shape[1] // (self.rows * LINE_REPLICATES * spaced)
        )
        beyond = np.zeros(mean.shape)
        for end, inner in ((0, 1), (-1, -2)):
            off, before = (np.abs(by_point[:, :, :, point].mean(axis=(2, 3)) - mean) for point in (end, inner))
            growth = off / np.where(before > 0, before, np.inf)
            beyond += off * np.minimum(np.maximum(growth, _BEYOND), _MOST_BEYOND)
        return np.asarray(self._net.beyond * beyond)


def _alike(shapes: Sequence[Distribution]) -> list[tuple[Distribution, slice | list[int]]]:
    """Return each shape that is not normal with the inputs that have it, as a slice where they follow one another."""
    groups: dict[tuple[str | float, ...], list[int]] = {}
    for index, shape in enumerate(shapes):
        if shape.shape != Normal.shape:
            groups.setdefault(shape.shape, []).append(index)
    return [
        (shapes[group[0]], slice(group[0], group[-1] + 1) if group[-1] - group[0] + 1 == len(group) else group)
        for group in groups.values()
    ]


def _slack(table: Array) -> Array:
    """Return within what a fall along each line is rounding, (lines,)."""
    size = np.abs(table).max(axis=0)
    return np.asarray(_DIP * (table.max(axis=0) - table.min(axis=0)) + 64 * np.finfo(float).eps * size)


def bounds_of(table: Array, rows: int) -> tuple[Array, Array]:
    """Return least and greatest output of rows in a table (nodes, rows × lines) of rising curves, (rows,) each."""
    return table[0].reshape(rows, -1).min(axis=1), table[-1].reshape(rows, -1).max(axis=1)
