"""Lots and parts of one model: by lines through the inputs of both, or by lots and parts drawn at points."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from flexlash.tolerance.engine.line_direction import Inputs, RowModel
from flexlash.tolerance.engine.line_spread import LinesUnsuitable
from flexlash.tolerance.engine.line_tables import FAULTS
from flexlash.tolerance.engine.lot_inputs import LotsAndParts
from flexlash.tolerance.engine.lot_statistics import LotPrecision, LotStatistics, lot_statistics
from flexlash.tolerance.lots import AllLots, AllParts, Division, Lots, OverLimit
from flexlash.tolerance.point_lots import PointLots, division_of
from flexlash.tolerance.spread import Method

__all__ = ["NOT_LINES", "lots_of", "require_lots_apart"]

NOT_LINES = "Lots by points instead of lines"

_WANTED_DIVISION = LotPrecision(sd=2e-4, failing=np.inf, most_pairs=1 << 16)
_WANTED_FAILING = replace(_WANTED_DIVISION, sd=np.inf, failing=0.01)


def lots_of(
    model: RowModel,
    inputs: Inputs,
    between: Collection[str],
    method: Method,
    *,
    samples: int | None,
    seed: int,
) -> tuple[Lots, tuple[str, ...]]:
    """Return how lots and parts divide a spread, and the notes that say why it is not by lines.

    Arguments: the model of one row, its inputs, the names of those that are one value for a lot; method, lines or
        points in all, and seed as of the spread.
    """
    if not between:
        return AllParts(), ()
    if len(between) == len(inputs.names):
        return AllLots(), ()
    split = LotsAndParts(model, inputs, between)
    if method != "line":
        return PointLots(split, method, samples, seed), ()
    points = PointLots(split, "sobol", None, seed)
    try:
        return LineLots(split, samples, seed, points), ()
    except LinesUnsuitable as reason:
        return points, (f"{NOT_LINES}: {reason}.",)


def require_lots_apart(inputs: Inputs, between: Collection[str]) -> None:
    """Raise ValueError where an input that is one value for a lot is correlated with one that is not."""
    if inputs.factor is None:
        return
    for lot, part in np.argwhere(inputs.factor @ inputs.factor.T).tolist():
        if inputs.names[lot] in between and inputs.names[part] not in between:
            raise ValueError(
                f"correlation ties {inputs.names[lot]}, which is one value for a lot, to {inputs.names[part]}, which "
                "differs from part to part: inputs that both differ between lots or both do not are required"
            )


class LineLots(Lots):
    """Lots and parts of one row by lines; a question that they cannot answer goes to the points.

    Raises LinesUnsuitable where lines serve for none.
    """

    def __init__(self, split: LotsAndParts, samples: int | None, seed: int, points: Lots) -> None:
        self._split = split
        self._samples = samples
        self._seed = seed
        self._points = points
        with np.errstate(all="ignore"):
            middle = float(split.at_medians()[0])
        # Half of the parts over the middle: a question that any lines which serve can answer.
        found = self._statistics(middle, 0.5, _WANTED_DIVISION)
        if found.faults[0]:
            raise LinesUnsuitable(FAULTS[found.faults[0]])
        self._division = division_of(found)

    def _statistics(self, limit: float, acceptable: float, wanted: LotPrecision) -> LotStatistics:
        return lot_statistics(
            self._split, np.array([limit]), acceptable, seed=self._seed, samples=self._samples, precision=wanted
        )

    @property
    def division(self) -> Division:
        """How the standard deviation is divided."""
        return self._division

    def failing(self, limit: float, acceptable: float, over: OverLimit) -> tuple[float, float]:
        """Return the share of lots with more than the acceptable share over a limit, and its standard error."""
        if acceptable >= 1:
            return 0.0, 0.0
        found = self._statistics(limit, acceptable, _WANTED_FAILING)
        if found.faults[0]:
            return self._points.failing(limit, acceptable, over)
        return float(found.failing[0]), float(found.failing_error[0])
