"""Results in pieces: what some rows of a submission add to Results in each form, and how the pieces become one file.

JSON also has Tolerances used, in pieces of its own beside those of Results.

A file that is joined from pieces has the bytes that it would have in one piece, whatever the pieces are.
"""

from __future__ import annotations

import io
import json
import shutil
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import polars as pl

from flexlash.report.output import ROLE, ROWS_TOGETHER
from flexlash.report.results_table import csv_header, csv_rows
from flexlash.schema.stamps import placeholder

__all__ = ["PIECES", "blank_piece", "joined", "piece"]

_BEFORE_ROWS, _AFTER_ROWS = '{\n "results": [\n', "\n ]\n}"
"""What stands before and after the rows of an object of JSON that holds Results alone."""

_USED = ' "tolerances": '


def piece(table: pl.DataFrame, ending: str) -> bytes:
    """Return what some rows of Results add to the file of all: Parquet, or lines of CSV or JSON; nothing for none."""
    return PIECES[ending](table) if table.height else b""


def blank_piece(known: Mapping[str, str], columns: Sequence[str], ending: str) -> bytes:
    """Return a row of Results of which these texts alone are known."""
    names = [name for name in columns if name in known or ending != ".parquet"]
    schema = dict.fromkeys(names, pl.String)
    return piece(pl.DataFrame({name: [known.get(name)] for name in names}, schema=schema), ending)


def joined(
    ending: str,
    pieces: Sequence[Path],
    model: Path,
    columns: Sequence[str],
    *,
    used: Sequence[Path] = (),
    further: Mapping[str, Any],
) -> Callable[[BinaryIO], None]:
    """Return what writes the pieces in order as one file, piece by piece.

    `model` is a piece that has all `columns`; in JSON the rows are followed by those of Tolerances used, of which
    `used` are the pieces, and by what is `further`.
    """

    def fill(file: BinaryIO) -> None:
        if ending == ".parquet":
            _write_parquet(file, pieces, model)
        elif ending == ".csv":
            file.write(csv_header(columns).encode())
            _copy(file, pieces, b"")
        else:
            rest = json.dumps({**further, "stamp": placeholder(ROLE)}, ensure_ascii=False, indent=1)
            file.write(_BEFORE_ROWS.encode())
            _copy(file, pieces, b",\n")
            file.write(f"{_AFTER_ROWS[:-2]},\n{_USED}[".encode())
            _copy_used(file, used)
            file.write(f"],\n{rest[2:]}\n".encode())

    return fill


def _as_parquet(table: pl.DataFrame) -> bytes:
    buffer = io.BytesIO()
    table.write_parquet(buffer)
    return buffer.getvalue()


def _as_csv(table: pl.DataFrame) -> bytes:
    return csv_rows(table).encode()


def _as_json(table: pl.DataFrame) -> bytes:
    text = json.dumps({"results": table.to_dicts()}, ensure_ascii=False, indent=1)
    return text[len(_BEFORE_ROWS) : -len(_AFTER_ROWS)].encode()


PIECES: Mapping[str, Callable[[pl.DataFrame], bytes]] = {
    ".csv": _as_csv,
    ".parquet": _as_parquet,
    ".json": _as_json,
}
"""Forms in which Results can be joined from pieces."""


def _write_parquet(file: BinaryIO, pieces: Sequence[Path], model: Path) -> None:
    """Write pieces as one table, with room for the stamp in the metadata; columns that a piece lacks are blank."""
    rows = pl.scan_parquet([*pieces], schema=pl.read_parquet_schema(model), missing_columns="insert")
    rows.sink_parquet(file, row_group_size=ROWS_TOGETHER, metadata={"flexlash": placeholder(ROLE)})


def _copy_used(file: BinaryIO, used: Sequence[Path]) -> None:
    """Write the pieces of Tolerances used between the brackets of their list, which is empty without any."""
    if used:
        file.write(b"\n")
        _copy(file, used, b",\n")
        file.write(b"\n ")


def _copy(file: BinaryIO, pieces: Sequence[Path], between: bytes) -> None:
    for number, path in enumerate(pieces):
        file.write(between if number else b"")
        with path.open("rb") as rows:
            shutil.copyfileobj(rows, file)
