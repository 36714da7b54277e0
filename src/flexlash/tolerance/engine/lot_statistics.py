"""What lots and parts have of each row's spread, by as many lines as its precision takes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, fields

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.entangled_lots import EntangledLots
from flexlash.tolerance.engine.line_crossings import NODES
from flexlash.tolerance.engine.line_direction import Indices
from flexlash.tolerance.engine.line_lots import FailingLots, LineNumbers, LotLines, SeparableLots
from flexlash.tolerance.engine.line_precision import (
    PROBABILITY_PRECISION,
    RAREST_PROBABILITY,
    SD_PRECISION,
    initial_lines,
)
from flexlash.tolerance.engine.lot_inputs import OTHERWISE, LotsAndParts
from flexlash.tolerance.engine.lot_variance import VarianceSplit
from flexlash.tolerance.sampling import stopping_margin

__all__ = ["LotPrecision", "LotStatistics", "lot_statistics"]

_SEPARABLE, _ENTANGLED = LineNumbers(64, 32), LineNumbers(16, 16)
"""Lines to begin with; where each through the lots meets all those through the parts, far fewer."""

_MOST_LINES, _FURTHER = 1 << 12, 4
"""Most lines of either kind, and how many times more are taken where they are not enough."""

_HALF = 0.7
"""Part of the wanted error, of two that are added as squares, from which more lines are taken of one kind."""

_BLOCK = 1 << 18
"""Numbers of an array that leave room in the cache for a few others."""


@dataclass(frozen=True, kw_only=True)
class LotPrecision:
    """The standard errors wanted: of sds as a part of the whole sd, of the failing share as a part of itself.

    With an endless error of sds they are not asked for.

    Where every line through the lots meets all those through the parts, `most_pairs` bounds their product.
    """

    sd: float = SD_PRECISION
    failing: float = PROBABILITY_PRECISION
    most_pairs: int = 1 << 14


@dataclass(frozen=True, kw_only=True)
class LotStatistics:
    """Of each row: sds within and between lots as parts of the whole sd, and the share of lots that fail; (rows,) each.

    The share is NaN without a limit. `faults` holds 0, or the index in `FAULTS` of what keeps lines from a row, whose
    other numbers are NaN.
    """

    within: Array
    within_error: Array
    between: Array
    between_error: Array
    failing: Array
    failing_error: Array
    faults: Indices

    @classmethod
    def unknown(cls, rows: int) -> LotStatistics:
        """Return statistics to be filled in."""
        empty = {field.name: np.full(rows, np.nan) for field in fields(cls)}
        return cls(**{**empty, "faults": np.zeros(rows, dtype=np.intp)})

    def divide(self, rows: Indices, split: VarianceSplit, margin: Array) -> None:
        """Fill in how the variance of some rows is divided, errors times a margin."""
        for name in ("within", "between"):
            getattr(self, name)[rows] = getattr(split, name)
            getattr(self, f"{name}_error")[rows] = getattr(split, f"{name}_error") * margin

    def fail(self, rows: Indices, failing: FailingLots, margin: Array) -> None:
        """Fill in the share of lots that fail in some rows, its error times a margin."""
        self.failing[rows], self.failing_error[rows] = failing.share, failing.error * margin


def lot_statistics(
    split: LotsAndParts,
    limit: Array,
    acceptable: float,
    *,
    seed: int,
    samples: int | None = None,
    precision: LotPrecision | None = None,
) -> LotStatistics:
    """Return what lots and parts have of the spread of rows alike; what a row gets does not depend on the others.

    Arguments: rows alike with lot inputs and part inputs; limit (rows,) in the unit of the output, NaN for none; the
        acceptable share of parts over it within a lot; lines a row, as many as the precision takes where it is None.
    Valid: outputs that only rise along lines through the lot inputs, and along lines through the part inputs in each
        lot; what keeps lines from a row is told.
    Source: contract of lots and parts: within² = E[Var(Y | lot)], between² = Var(E[Y | lot]).
    """
    search = _Search(split, limit, acceptable, (seed, samples), precision or LotPrecision())
    with np.errstate(all="ignore"):
        search.run(split.relation())
    return search.found


class _Search:
    """The search for rows alike: more lines for the rows that want them, the next way for those that a way loses."""

    def __init__(
        self,
        split: LotsAndParts,
        limit: Array,
        acceptable: float,
        sampling: tuple[int, int | None],
        wanted: LotPrecision,
    ) -> None:
        self._split = split
        self._limit = limit
        self._acceptable = acceptable
        self._seed, self._samples = sampling
        self._precision = wanted
        self._undivided = np.full(split.rows, np.isfinite(wanted.sd))
        self.found = LotStatistics.unknown(split.rows)

    def run(self, relation: Indices) -> None:
        """Find the statistics of all rows."""
        pending = [(int(each), self._initial(each), np.flatnonzero(relation == each)) for each in np.unique(relation)]
        while pending:
            way, numbers, rows = pending.pop()
            lost, wanting = self._tried(way, numbers, rows)
            if len(lost) and way != OTHERWISE:
                pending.append((OTHERWISE, self._initial(OTHERWISE), lost))
            pending += [(way, more, some) for more, some in wanting if len(some)]

    def _initial(self, way: int) -> LineNumbers:
        """Return the lines that a way starts with."""
        fewest = _ENTANGLED if way == OTHERWISE else _SEPARABLE
        if self._samples is None:
            return fewest
        number = initial_lines(2, self._samples)
        most = max(_SEPARABLE) if way == OTHERWISE else _MOST_LINES
        return LineNumbers(min(number, most), min(number, most))

    def _tried(
        self, way: int, numbers: LineNumbers, rows: Indices
    ) -> tuple[Indices, list[tuple[LineNumbers, Indices]]]:
        """Fill in what these lines find; return the rows that are lost, and those that want more, with how many."""
        lost, wanting = [np.empty(0, dtype=np.intp)], []
        # Lots are corrected in rounds, of which a row beside others may see more: there each row is alone.
        for block in _blocks(rows, _BLOCK if way == OTHERWISE else max(numbers) * len(NODES)):
            lines = self._lines(way, numbers, block)
            sound = np.flatnonzero(lines.faults == 0)
            own = block[sound]
            faults = lines.faults.copy()
            if len(own):
                lines = lines if len(own) == len(block) else self._lines(way, numbers, own)
                failing = self._failing(lines, own)
                faults[sound] = failing.faults
                wanting += self._judged(way, numbers, own, self._divided(lines, own), failing)
            self.found.faults[block] = faults
            lost.append(block[faults > 0])
        return np.concatenate(lost), wanting

    def _judged(
        self, way: int, numbers: LineNumbers, rows: Indices, divided: Array, failing: FailingLots
    ) -> list[tuple[LineNumbers, Indices]]:
        """Fill in rows, and return those that want more lines of either kind; `divided` is the excess of their sds."""
        rarer = np.minimum(failing.share, 1 - failing.share)
        wanted = np.where(rarer >= RAREST_PROBABILITY, self._precision.failing * rarer, np.inf)
        excess = np.nan_to_num(failing.error / wanted)
        self.found.fail(rows, failing, stopping_margin(excess))
        if self._samples is not None:
            return []
        short = ((divided > 1) | (excess * stopping_margin(excess) > 1)) & (failing.faults == 0)
        lots, parts = (np.fmax(divided, error / wanted) > _HALF for error in (failing.lots_error, failing.parts_error))
        grown = []
        for more_lots, more_parts in ((True, True), (True, False), (False, True)):
            further = LineNumbers(numbers.lots * _FURTHER**more_lots, numbers.parts * _FURTHER**more_parts)
            if max(further) <= _MOST_LINES and (way != OTHERWISE or math.prod(further) <= self._precision.most_pairs):
                grown.append((further, rows[short & (lots == more_lots) & (parts == more_parts)]))
        return grown

    def _lines(self, way: int, numbers: LineNumbers, rows: Indices) -> LotLines:
        split = self._split.take(rows)
        if way == OTHERWISE:
            return EntangledLots(split, self._seed, numbers)
        return SeparableLots(split, way, self._seed, numbers)

    def _divided(self, lines: LotLines, rows: Indices) -> Array:
        """Fill in how the variance of rows is divided that want it; return by how much their errors exceed the wanted.

        Rows that have it well enough from fewer lines keep it.
        """
        excess = np.zeros(len(rows))
        wanting = self._undivided[rows]
        if wanting.any():
            split = lines.variance()
            excess = np.maximum(split.within_error, split.between_error) / self._precision.sd
            margin = stopping_margin(excess)
            excess = np.where(wanting, excess * margin, 0.0)
            chosen = VarianceSplit(**{name: values[wanting] for name, values in vars(split).items()})
            self.found.divide(rows[wanting], chosen, margin[wanting])
            self._undivided[rows] = excess > 1
        return excess

    def _failing(self, lines: LotLines, rows: Indices) -> FailingLots:
        """Return the share of lots that fail, NaN for rows without a limit."""
        limit = self._limit[rows]
        limited = np.isfinite(limit)
        nothing = np.full(len(rows), np.nan)
        if not limited.any():
            return FailingLots(share=nothing, lots_error=nothing, parts_error=nothing, faults=lines.faults)
        failing = lines.failing(np.where(limited, limit, lines.centre), self._acceptable)
        return FailingLots(
            share=np.where(limited, failing.share, np.nan),
            lots_error=np.where(limited, failing.lots_error, np.nan),
            parts_error=np.where(limited, failing.parts_error, np.nan),
            faults=np.where(limited, failing.faults, lines.faults),
        )


def _blocks(rows: Indices, size: int) -> Iterator[Indices]:
    """Yield rows in blocks that fit the cache, `size` numbers a row."""
    step = max(_BLOCK // size, 1)
    for start in range(0, len(rows), step):
        yield rows[start : start + step]
