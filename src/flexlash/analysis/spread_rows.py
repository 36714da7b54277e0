"""The spread of many rows as columns: what is kept of each is a row of numbers, its record is made when asked for."""

from __future__ import annotations

import math
from array import array
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import polars as pl

from flexlash.analysis.row_records import RowRecords
from flexlash.schema.columns import DIMENSIONS
from flexlash.tolerance.spread_statistics import SpreadStatistics

__all__ = ["SpreadRows"]

_TEXTS = ("spread_method", "spread_note", "first_order_valid", "cross_check")
_FIRST, _TOTAL, _LOW, _HIGH = ("first of ", "total of ", "low of ", "high of ")
"""What the names of the columns of a dimension begin with: its shares, and the ends of its swing."""


@dataclass(frozen=True, eq=False)
class SpreadRows(RowRecords[SpreadStatistics]):
    """Statistics by row number, which rises.

    `frame` has the column `row`, one for each number and text, and for each dimension those of its shares and of its
    swing; null is what a row has not. Of the errors of shares only that of the greatest is kept, among the numbers.
    """

    frame: pl.DataFrame

    @classmethod
    def of(cls, found: Iterable[tuple[int, SpreadStatistics]]) -> SpreadRows:
        """Return statistics, each given with its row number, as columns."""
        alike: dict[tuple[str, ...], tuple[list[int], array[float], list[tuple[str | None, ...]]]] = defaultdict(
            lambda: ([], array("d"), [])
        )
        for row, statistics in found:
            numbers = _flat(statistics)
            rows, values, texts = alike[tuple(numbers)]
            rows.append(row)
            values.extend(numbers.values())
            texts.append(tuple(statistics.texts.get(name) for name in _TEXTS))
        frames = [pl.DataFrame(schema={"row": pl.Int64} | dict.fromkeys(_TEXTS, pl.String))]
        for names, (rows, values, texts) in alike.items():
            own = pl.DataFrame(texts, schema=dict.fromkeys(_TEXTS, pl.String), orient="row")
            matrix = np.frombuffer(values).reshape(len(rows), len(names))
            frames.append(pl.DataFrame({"row": rows}).hstack(own).hstack(pl.DataFrame(matrix, schema=names)))
        frame = pl.concat(frames, how="diagonal").sort("row")
        ends = [f"{start}{name}" for start in (_FIRST, _TOTAL, _LOW, _HIGH) for name in DIMENSIONS]
        last = [name for name in ends if name in frame.columns]
        return cls(frame.select(pl.exclude(last), *last))

    def main_shares(self) -> pl.DataFrame:
        """Return by row the dimension with the greatest first-order share, that share, and that of interactions."""
        columns = [name for name in self.frame.columns if name.startswith(_FIRST)]
        names = [name.removeprefix(_FIRST) for name in columns]
        found = []
        for row, *shares in self.frame.select("row", *columns).iter_rows():
            given = {name: share for name, share in zip(names, shares, strict=True) if share is not None}
            main = max(given, key=lambda name: given[name], default=None)
            rest = max(1.0 - math.fsum(given.values()), 0.0) if given else None
            found.append((row, main, None if main is None else given[main], rest))
        numbers = ("main_contributor_share", "interaction_share")
        types = {"row": pl.Int64(), "main_contributor": pl.String()} | dict.fromkeys(numbers, pl.Float64())
        return pl.DataFrame(found, schema=types, orient="row")

    @property
    def columns(self) -> pl.DataFrame:
        """The frame."""
        return self.frame

    def at(self, place: int) -> SpreadStatistics:
        """Return the statistics at a place among all."""
        return _record(self.frame.row(place, named=True))


def _flat(statistics: SpreadStatistics) -> dict[str, float]:
    """Return every number of a record by the name of its column."""
    numbers = {name: value for name, value in statistics.numbers.items() if value is not None}
    numbers |= {f"{_FIRST}{name}": share for name, share in statistics.shares.items()}
    numbers |= {f"{_TOTAL}{name}": share for name, share in statistics.total_shares.items()}
    for place, end in enumerate((_LOW, _HIGH)):
        numbers |= {f"{end}{name}": swing[place] for name, swing in statistics.swings.items()}
    return numbers


def _record(columns: Mapping[str, Any]) -> SpreadStatistics:
    """Return the record of a row of the frame."""
    known = {name: value for name, value in columns.items() if isinstance(value, float)}

    def of(start: str) -> dict[str, float]:
        return {name.removeprefix(start): value for name, value in known.items() if name.startswith(start)}

    low, high = of(_LOW), of(_HIGH)
    return SpreadStatistics(
        numbers={name: value for name, value in known.items() if " of " not in name},
        texts={name: columns[name] for name in _TEXTS},
        shares=of(_FIRST),
        total_shares=of(_TOTAL),
        swings={name: (low[name], high[name]) for name in low},
    )
