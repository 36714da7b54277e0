"""The outcome → a file, whole or not at all: report workbook, or Results as CSV, Parquet or JSON."""

from __future__ import annotations

import io
import json
import os
import tempfile
from pathlib import Path

from flexlash.outcome import Outcome
from flexlash.report.results_table import csv_text, results_table

__all__ = ["ENDINGS", "write_bytes", "write_outcome"]

ENDINGS = (".xlsx", ".csv", ".parquet", ".json")

_COPIES = 100
_LOCKS = os.name == "nt"
"""Whether this system refuses to replace a file that another program holds open."""


def write_outcome(outcome: Outcome, path: Path) -> Path:
    """Write the outcome in the form that the path's ending names and return where it was written.

    A report that is open in another program is not touched: the new one gets ` (2)`. Raises OSError when
    nothing can be written, ValueError for an unknown ending.
    """
    ending = path.suffix.lower()
    if ending == ".xlsx":
        from flexlash.report.workbook import report_bytes

        data = report_bytes(outcome)
    elif ending == ".csv":
        data = csv_text(results_table(outcome)).encode()
    elif ending == ".parquet":
        buffer = io.BytesIO()
        results_table(outcome).write_parquet(buffer)
        data = buffer.getvalue()
    elif ending == ".json":
        data = (json.dumps(results_table(outcome).to_dicts(), ensure_ascii=False, indent=1) + "\n").encode()
    else:
        raise ValueError(f"the output must end in {', '.join(ENDINGS)}, not {path.suffix or 'nothing'}")
    return write_bytes(data, path)


def write_bytes(data: bytes, path: Path) -> Path:
    """Write a file by way of a temporary one beside it, so that it is whole or absent."""
    try:
        handle, name = tempfile.mkstemp(prefix=".flexlash-", suffix=".tmp", dir=path.parent)
    except OSError as fault:
        raise OSError(fault.errno, fault.strerror, str(path)) from fault
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(0o666 & ~_umask())
        return _move(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _move(temporary: Path, path: Path) -> Path:
    """Put the temporary file in its place, or beside a file that another program holds open."""
    for copy in range(1, _COPIES):
        target = path if copy == 1 else path.with_name(f"{path.stem} ({copy}){path.suffix}")
        if copy > 1 and target.exists():
            continue
        try:
            temporary.replace(target)
        except PermissionError:
            if not _LOCKS:
                raise
            continue
        _sync_folder(target.parent)
        return target
    raise PermissionError(f"{path.name} and its copies cannot be replaced")


def _sync_folder(folder: Path) -> None:
    """Make the rename durable where folders can be synchronised."""
    if _LOCKS:
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
