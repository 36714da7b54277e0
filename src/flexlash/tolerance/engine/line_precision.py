"""How well lines know a row: how many it needs, and what is said where they do not do."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_direction import Indices
from flexlash.tolerance.engine.line_drawing import SD_PRECISION
from flexlash.tolerance.engine.line_points import LINE_REPLICATES
from flexlash.tolerance.engine.line_quantiles import LineQuantiles, probability_interval
from flexlash.tolerance.engine.line_tables import Lines
from flexlash.tolerance.sampling import stopping_margin

__all__ = [
    "DECISIVE",
    "FEWEST_LINES",
    "FEWEST_ROW_LINES",
    "MOST_LINES",
    "PROBABILITY_PRECISION",
    "RAREST_PROBABILITY",
    "SD_PRECISION",
    "initial_lines",
    "lines_needed",
    "precision_notes",
    "unresolved",
]

FEWEST_LINES, FEWEST_ROW_LINES = 64, 32
"""Fewest lines of a model, and of rows of a table: their model is known, that of a single call may hold surprises."""

MOST_LINES = 1 << 14
"""Most lines of a row; what they do not reach is told by its errors and a note."""

DECISIVE = (0.00135, 0.025, 0.5, 0.975, 0.99865)
"""Probabilities whose quantiles decide how many lines are enough."""

PROBABILITY_PRECISION = 0.05
"""Standard error wanted of the probability over a limit, as a part of itself, down to `RAREST_PROBABILITY`."""

RAREST_PROBABILITY = 1e-9
"""Rarer probabilities need not be known to a part of themselves."""

_MARGIN = 1.5
"""How much better than wanted the next number of lines should be, since errors are only estimated."""

Bools = npt.NDArray[np.bool_]


def initial_lines(inputs: int, samples: int | None, fewest: int = FEWEST_LINES) -> int:
    """Return how many lines a row starts with; one input alone has but one line, the same in each replicate.

    Raises ValueError for less than one sample.

    >>> initial_lines(3, None), initial_lines(3, 100), initial_lines(1, None)
    (64, 128, 8)
    """
    if samples is not None and samples < 1:
        raise ValueError(f"samples = {samples} must be at least 1")
    if inputs == 1:
        return LINE_REPLICATES
    total = fewest if samples is None else samples
    return LINE_REPLICATES << max(0, -(-total // LINE_REPLICATES) - 1).bit_length()


def lines_needed(
    lines: Lines,
    decisive: LineQuantiles,
    over: LineQuantiles | None = None,
    limited: Bools | None = None,
    bounds: Sequence[float] = (),
) -> tuple[Indices, Array]:
    """Return how many lines the precision of each row takes, those it has where they are enough, and a margin.

    Where lines were found enough by an error that came out small by chance, it looks too small: errors are to be
    multiplied by the margin (rows,).

    Arguments: lines of rows alike; `decisive` quantiles at `DECISIVE`; `over` the probabilities (1, rows) over the
        limits of the rows `limited`; `bounds` are shares over a limit at which a verdict changes.
    Valid: errors fall at least as the root of the number of lines; never more than `MOST_LINES`.
    """
    excess = (decisive.output_error / np.where(lines.scale > 0, lines.scale, 1.0)).max(axis=0) / SD_PRECISION
    if over is not None:
        rarer = np.minimum(over.above, 1 - over.above)[0]
        counts = (rarer >= RAREST_PROBABILITY) & (True if limited is None else limited)
        error = over.above_error[0] - np.where(_left_open(over, bounds), 0.0, over.blunt[0])
        relative = error / np.where(counts, rarer, 1.0) / PROBABILITY_PRECISION
        excess = np.maximum(excess, np.where(counts, relative, 0.0))
    margin = stopping_margin(excess)
    excess = excess * margin
    further = 2.0 ** np.ceil(np.log2(np.maximum(excess * _MARGIN, 2.0)))
    needed = np.where(excess <= 1, lines.lines, np.minimum(lines.lines * further, MOST_LINES))
    return needed.astype(np.intp), margin


def _left_open(over: LineQuantiles, bounds: Sequence[float]) -> Bools:
    """Return of which rows (rows,) the error of the probability leaves a verdict open and is beyond what is wanted.

    Many lines carry a tail by themselves, so that nothing of its error is blunt: worth it where a verdict hangs on it.
    """
    above, error = over.above[0], over.above_error[0]
    low, high = probability_interval(above, error)
    straddled = np.zeros(above.shape, dtype=bool)
    for bound in bounds:
        straddled |= (low <= bound) & (bound < high)
    return np.asarray(straddled & (error > PROBABILITY_PRECISION * above))


def unresolved(lines: Lines, decisive: LineQuantiles) -> Bools:
    """Return of which rows (rows,) the quantiles could not be found, since the output jumps or is too steep."""
    return np.asarray((decisive.residual > SD_PRECISION * lines.scale).any(axis=0))


def precision_notes(decisive: LineQuantiles, sd: Array) -> list[str]:
    """Return for each row the note that its precision was not reached, empty where it was."""
    errors = (decisive.output_error / np.where(sd > 0, sd, 1.0)).max(axis=0).tolist()
    return [
        ""
        if error <= SD_PRECISION
        else f"standard errors reach {error:.2g} standard deviations, {SD_PRECISION:g} was wanted"
        for error in errors
    ]
