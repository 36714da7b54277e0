"""What the gate and the limited process cost, as a share of `flexlash check`, and where the time goes.

    python tests/benchmarks/reading.py [ROWS ...]

For each number of rows a submission is made from the template and read step by step in this process, then by the
limited process, then by the whole command; each is the least of five. The gate's and process's own cost is what
reading takes beyond openpyxl's own time. Quote the shares: absolute times differ from machine to machine.
"""

from __future__ import annotations

import pickle
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from whole_command import make_submission

REPEATS = 5


def least(work: Callable[[], object]) -> float:
    """Return the least time [s] of a few repeats."""
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def measure(rows: int, folder: Path) -> None:
    """Print the steps of reading a submission of so many rows, and their share of the whole command."""
    from flexlash.reading.archive import unpacked
    from flexlash.reading.limited_process import ask
    from flexlash.reading.package import open_package
    from flexlash.reading.read import Source, submission_of
    from flexlash.reading.reading_limits import ReadingLimits
    from flexlash.reading.xlsx import look_at, read_workbook

    path = folder / f"{rows}.xlsx"
    make_submission(rows, path)
    data, limits = path.read_bytes(), ReadingLimits()
    parts = unpacked(data, limits)
    package = open_package(parts, limits)
    cells = read_workbook(data, limits)
    source, wire = Source(name=path.name, data=data), pickle.dumps(cells)
    steps = {
        "unpack": least(lambda: unpacked(data, limits)),
        "package": least(lambda: open_package(parts, limits)),
        "walk through the sheets": least(lambda: look_at(package, limits)),
        "cells to bytes": least(lambda: pickle.dumps(cells)),
        "bytes to cells": least(lambda: pickle.loads(wire)),  # noqa: S301
    }
    read = least(lambda: read_workbook(data, limits))
    openpyxl = read - steps["unpack"] - steps["package"] - steps["walk through the sheets"]
    process = least(lambda: ask(submission_of, limits, source, limits))
    command = [sys.executable, "-m", "flexlash", "check", str(path)]
    whole = least(lambda: subprocess.run(command, check=False, capture_output=True))
    own = sum(steps.values())
    print(f"{rows} rows, {len(data) / 2**20:.1f} MiB")
    for name, seconds in {**steps, "openpyxl": openpyxl, "the process in all": process, "check": whole}.items():
        print(f"  {name:26}{seconds:7.2f} s")
    print(f"  gate and way back          {own / whole:7.0%} of check")
    print(f"  gate, way and process      {(process - openpyxl) / whole:7.0%} of check")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        for rows in [int(text) for text in sys.argv[1:]] or [6, 1_000, 10_000]:
            measure(rows, Path(name))
