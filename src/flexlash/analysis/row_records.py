"""Records by row number that are held as columns: each is made when it is asked for."""

from __future__ import annotations

from abc import abstractmethod
from bisect import bisect_left
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    import polars as pl

__all__ = ["RowRecords"]

Record = TypeVar("Record")


class RowRecords(Mapping[int, Record]):
    """Records by the row number that stands in the rising column `row` of a frame; None stands for no row."""

    @property
    @abstractmethod
    def columns(self) -> pl.DataFrame | None:
        """The frame."""

    @abstractmethod
    def at(self, place: int) -> Record:
        """Return the record of a row of the frame, counted from 0."""

    @property
    def _rows(self) -> pl.Series:
        if self.columns is not None:
            return self.columns["row"]
        import polars as pl

        return pl.Series("row", dtype=pl.Int64)

    def __len__(self) -> int:
        """Return how many records there are."""
        return len(self._rows)

    def __iter__(self) -> Iterator[int]:
        """Yield the row numbers."""
        return iter(self._rows.to_list())

    def __getitem__(self, row: int) -> Record:
        """Return the record of a row; raise KeyError where there is none."""
        rows = self._rows.to_numpy()
        place = bisect_left(rows, row)
        if place == len(rows) or rows[place] != row:
            raise KeyError(row)
        return self.at(place)
