"""Lines drawn through rows alike, each with its direction and its surrogate: the same for whoever asks again."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from flexlash.tolerance.distributions import Normal
from flexlash.tolerance.engine.line_control import LineControl
from flexlash.tolerance.engine.line_crossings import NODES
from flexlash.tolerance.engine.line_direction import Indices, Inputs, RowModel, direction_of
from flexlash.tolerance.engine.line_points import line_net
from flexlash.tolerance.engine.line_surrogate import AdditiveSurrogate, fitted_surrogate
from flexlash.tolerance.engine.line_tables import Lines
from flexlash.tolerance.engine.surrogate_law import SurrogateLaw
from flexlash.tolerance.engine.term_rules import serves

__all__ = ["SD_PRECISION", "DrawnLines", "LineDrawing"]

SD_PRECISION = 1e-3
"""Standard error wanted of the usual quantiles, in standard deviations of the output."""

_ALONE = 64
"""Lines from which on their errors are believed to say that lines do without a surrogate."""

_ENDS = [int(np.flatnonzero(score == NODES)[0]) for score in (-3.0, 0.0, 3.0)]
"""Nodes by which it is seen whether lines do without a surrogate."""

Bools = npt.NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True)
class DrawnLines:
    """Lines through rows alike, and their surrogates where these help at least one of the rows."""

    lines: Lines
    control: LineControl | None = None


class LineDrawing:
    """Lines drawn through some of the rows at a time; another net for each number of lines."""

    def __init__(self, model: RowModel, inputs: Inputs, seed: int) -> None:
        self._model = model
        self._inputs = inputs
        self._seed = seed
        self._direction = direction_of(model, inputs)
        self._law: SurrogateLaw | None = None

    def model(self, rows: Indices) -> RowModel:
        """Return the model of some rows."""
        return lambda arguments, chosen: self._model(arguments, rows[chosen])

    @cached_property
    def _fitted(self) -> AdditiveSurrogate:
        return fitted_surrogate(self._model, self._inputs, self._direction.vector)

    def surrogate(self, rows: Indices) -> AdditiveSurrogate | None:
        """Return the surrogates of some rows; None of a single input and of correlated ones."""
        alone = len(self._inputs.names) == 1 or self._inputs.factor is not None
        return None if alone else self._fitted.take(rows)

    def drawn(self, rows: Indices, number: int) -> DrawnLines:
        """Return this number of lines through each of some rows."""
        inputs = self._inputs.take(rows)
        net = line_net(self._seed, len(inputs.names) - 1, number, single_curved=inputs.single_curved)
        lines = Lines(self.model(rows), inputs, self._direction.take(rows), net)
        needed = _unsettled(lines) & (lines.faults == 0)
        if len(inputs.names) == 1 or not serves(inputs) or not needed.any():
            return DrawnLines(lines=lines)
        if self._law is None:
            self._law = SurrogateLaw.of(self._fitted, self._inputs)
        control = LineControl(lines, self._fitted.take(rows), self._law.take(rows), needed)
        return DrawnLines(lines=lines, control=control if control.used.any() else None)


def _unsettled(lines: Lines) -> Bools:
    """Return which rows (rows,) take a surrogate: of normal inputs those that lines alone do not know as wanted."""
    if lines.lines < _ALONE or any(shape.shape != Normal.shape for shape in lines.inputs.shapes):
        return np.ones(lines.rows, dtype=bool)
    ends = lines.table[_ENDS]
    return np.asarray((lines.standard_error(ends) > SD_PRECISION * lines.scale).any(axis=0))
