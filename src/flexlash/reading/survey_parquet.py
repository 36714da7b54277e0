"""A large Parquet file → its survey, and the rows of an excerpt: one group of rows is decoded at a time."""

from __future__ import annotations

import hashlib
import io
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from flexlash.reading.parquet import is_inexact, values_of
from flexlash.reading.parquet_file import RowGroup, check_group, row_groups
from flexlash.reading.raw import RawValue
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.survey import CHANGED, MOST_ROWS, RowBlock, Survey, survey_of, too_many_rows
from flexlash.schema.header_names import LAST_HEADER_ROW

if TYPE_CHECKING:
    import polars as pl

    from flexlash.validation.whole_tables import Gatherer

__all__ = ["cells_of", "of_parquet", "rows_of"]

_MEBI = 2**20
_SLICE = 5000
"""Rows that become Python's values at a time."""

_HEADER = 1


def of_parquet(file: BinaryIO, path: Path, size: int, name: str, limits: ReadingLimits) -> Survey:
    """Return the survey of a Parquet file.

    Raises Refusal when it is damaged, differs from its checksums, or has a group of rows that memory cannot hold.
    """
    from flexlash.validation.whole_tables import Assumed, Gatherer

    groups = row_groups(file, limits)
    blocks = [*_checked(file, groups, limits)]
    file.seek(0)
    digest = hashlib.sha256()
    while chunk := file.read(_MEBI):
        digest.update(chunk)
    frames = _Frames(path, groups)
    limits.require("characters", max(map(len, frames.names), default=0))
    inexact = frames.inexact()
    top = _top(frames, limits, inexact)
    assumed = Assumed(filled=frozenset(range(1, len(frames.names) + 1)))
    while True:
        gatherer = Gatherer(top, None, assumed)
        last = _pass(frames, gatherer, limits, inexact)
        assumed = Assumed(filled=frozenset(gatherer.filled))
        if gatherer.holds(Gatherer(top, None, assumed)):
            break
    gathered = gatherer.gathered({}, ())
    return survey_of(
        gathered,
        top,
        last,
        name=name,
        kind="parquet",
        sha256=digest.hexdigest(),
        size=size,
        blocks=tuple(blocks),
        inexact=tuple(sorted(inexact)),
    )


def _checked(file: BinaryIO, groups: Sequence[RowGroup], limits: ReadingLimits) -> Iterator[RowBlock]:
    """Yield where the rows of each group stand, after its pages were held against their checksums."""
    checked: set[bool] = set()
    first = _HEADER + 1
    # A group is decoded as a whole, beside what is made of it.
    most = replace(limits, unpacked_mebibytes=max(limits.unpacked_mebibytes, limits.memory_mebibytes // 2))
    for number, group in enumerate(groups):
        most.require("unpacked_mebibytes", group.unpacked / _MEBI)
        found, digest = check_group(file, group)
        checked |= found
        if len(checked) > 1 or group.rows < 0:
            raise Refusal("E102")
        if first + group.rows - 1 > MOST_ROWS:
            raise too_many_rows()
        yield RowBlock(first, group.rows, number, 0, digest)
        first += group.rows


class _Frames:
    """The groups of rows of a Parquet file as frames, one at a time."""

    def __init__(self, path: Path, groups: Sequence[RowGroup]) -> None:
        import polars as pl

        self.path = path
        self.rows = [group.rows for group in groups]
        self.schema = _decoded(lambda: pl.read_parquet_schema(path))
        self.names = [*self.schema]

    def frame(self, number: int, columns: Sequence[str] | None = None) -> pl.DataFrame:
        """Return a group of rows, or these columns of it."""
        return _group(self.path, sum(self.rows[:number]), self.rows[number], columns)

    def slices(self) -> Iterator[tuple[int, pl.DataFrame]]:
        """Yield all rows piece by piece, each with the row number of its first."""
        row = _HEADER + 1
        for number, rows in enumerate(self.rows):
            frame = self.frame(number)
            for start in range(0, rows, _SLICE):
                yield row + start, frame.slice(start, _SLICE)
            row += rows

    def inexact(self) -> frozenset[str]:
        """Return the columns of whole numbers that hold one beyond those that are doubles."""
        import polars as pl

        wide = [name for name, kind in self.schema.items() if kind in {pl.Int64, pl.UInt64, pl.Int128}]
        found: set[str] = set()
        for number in range(len(self.rows)) if wide else ():
            frame = self.frame(number, wide)
            found |= {name for name in wide if is_inexact(frame[name])}
        return frozenset(found)


def _group(path: Path, start: int, rows: int, columns: Sequence[str] | None = None) -> pl.DataFrame:
    """Return so many rows of a file, of which no other group of rows is decoded."""
    import polars as pl

    scan = pl.scan_parquet(path, glob=False)
    scan = scan if columns is None else scan.select(columns)
    frame: pl.DataFrame = _decoded(lambda: scan.slice(start, rows).collect())
    if frame.height != rows:
        raise Refusal("E102")
    return frame


def _decoded(read: Callable[[], Any]) -> Any:
    """Return what polars reads; raise Refusal for a file that it cannot."""
    try:
        return read()
    except (MemoryError, Refusal, KeyboardInterrupt, SystemExit):
        raise
    except BaseException as fault:
        # On damaged files polars panics, which is no Exception.
        raise Refusal("E102") from fault


def _columns(frame: pl.DataFrame, limits: ReadingLimits, inexact: Collection[str]) -> list[list[Any]]:
    """Return the values of a piece of a file by columns, as they are read in the whole of it."""
    return [values_of(series, limits) for series in _exact(frame, inexact).get_columns()]


def _exact(frame: pl.DataFrame, inexact: Collection[str]) -> pl.DataFrame:
    """Return a piece of a file with those columns as doubles that hold more than whole numbers can, somewhere."""
    import polars as pl

    return frame.with_columns(pl.col([name for name in frame.columns if name in inexact]).cast(pl.Float64))


def _top(frames: _Frames, limits: ReadingLimits, inexact: Collection[str]) -> dict[int, dict[int, RawValue]]:
    """Return the rows from the first to the first that holds anything below those in which the headers may be."""
    top: dict[int, dict[int, RawValue]] = {_HEADER: dict(enumerate(frames.names, start=1))}
    for first, frame in frames.slices():
        for row, cells in _rows(_columns(frame, limits, inexact), range(first, first + frame.height)):
            top[row] = cells
            if row > LAST_HEADER_ROW:
                return top
    return top


def _rows(columns: Sequence[Sequence[Any]], numbers: Iterable[int]) -> Iterator[tuple[int, dict[int, RawValue]]]:
    """Yield the rows that hold anything, with their numbers."""
    for row, values in zip(numbers, zip(*columns, strict=True), strict=True):
        cells = {column: value for column, value in enumerate(values, start=1) if value is not None}
        if cells:
            yield row, cells


def _pass(frames: _Frames, gatherer: Gatherer, limits: ReadingLimits, inexact: Collection[str]) -> int:
    """Go through all rows; return the number of the last that holds anything."""
    import polars as pl

    from flexlash.validation.whole_tables import Block

    last = _HEADER
    for first, frame in frames.slices():
        filled = frame.select(pl.any_horizontal(pl.all().is_not_null()).arg_true().max()).item()
        last = last if filled is None else first + filled
        gatherer.take(Block(first=first, columns=_columns(frame, limits, inexact), height=frame.height))
    return last


@lru_cache(maxsize=1)
def _kept(path: Path, sha256: str, digest: bytes, start: int, rows: int) -> pl.DataFrame:  # noqa: ARG001
    """Return a group of rows, which is kept until another is asked for."""
    return _group(path, start, rows)


def rows_of(path: Path, file: BinaryIO, survey: Survey, wanted: Sequence[int]) -> bytes:
    """Return rows of a surveyed file as Arrow's bytes; raise Refusal when they are no longer the surveyed ones."""
    import polars as pl

    groups = row_groups(file)
    pieces = []
    for block in survey.blocks:
        own = [row - block.first for row in wanted if block.first <= row < block.first + block.rows]
        if own:
            frame = _kept(path, survey.sha256, block.digest, block.first - _HEADER - 1, block.rows)
            # What was decoded is what is there: a file that changed meanwhile is told afterwards.
            if len(groups) != len(survey.blocks) or check_group(file, groups[block.start])[1] != block.digest:
                _kept.cache_clear()
                raise Refusal("E101", found=CHANGED)
            whole = own[-1] - own[0] == len(own) - 1
            pieces.append(_plain(frame.slice(own[0], len(own)) if whole else frame[own], survey.inexact))
    buffer = io.BytesIO()
    pl.concat(pieces).write_ipc(buffer, compression="zstd")
    return buffer.getvalue()


def _plain(frame: pl.DataFrame, inexact: Collection[str]) -> pl.DataFrame:
    """Return rows without what only the groups of a file know."""
    import polars as pl

    return _exact(frame, inexact).with_columns(
        pl.col(name).cast(pl.String)
        for name, kind in frame.schema.items()
        if isinstance(kind, pl.Categorical | pl.Enum)
    )


def cells_of(data: bytes, wanted: Sequence[int], limits: ReadingLimits) -> dict[int, dict[int, RawValue]]:
    """Return the cells of an excerpt's rows by their numbers."""
    import polars as pl

    frame = pl.read_ipc(io.BytesIO(data))
    return dict(_rows([values_of(series, limits) for series in frame.get_columns()], wanted))
