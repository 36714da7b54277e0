"""Processor time and memory of batches: small workbooks side by side, and large tables in chunks.

    python tests/benchmarks/batches.py [--workbooks N] [--rows N ...] [--dask]

Runs `flexlash run` with one worker and with two, and with `--dask` once more by a Dask cluster of two. Every process of
a run is watched in /proc (Linux only) for its processor time and its peak memory: the one that was started, which hands
over and writes, and all others, which compute. Printed are the time of each run, the ratio from one to two workers, the
share of the first process in the processor time of the others, and both peaks. Quote the ratios of a quiet machine; for
a million rows expect 15 minutes of processor time and 3 GB of disk for each run.
"""

from __future__ import annotations

import argparse
import random
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

TICKS = 100
"""Parts of a second in which /proc counts processor time."""

LOOK = 0.1
"""Seconds between two looks at the processes."""

KINDS = 5
"""Small workbooks that differ."""


@dataclass
class Watched:
    """Processor time [s] and peak memory [MiB] of each process of a run, by number; `first` is that of the first."""

    first: int
    seconds: dict[int, float] = field(default_factory=dict)
    mebibytes: dict[int, float] = field(default_factory=dict)
    wall: float = 0.0

    def look(self) -> None:
        """Note what every living process of the run has used."""
        family = {self.first}
        parents = dict(parent_and_time())
        grown = True
        while grown:
            more = {number for number, (parent, _) in parents.items() if parent in family} - family
            family, grown = family | more, bool(more)
        for number in family & parents.keys():
            self.seconds[number] = parents[number][1]
            self.mebibytes[number] = max(self.mebibytes.get(number, 0.0), peak(number))

    def others(self, of: dict[int, float]) -> list[float]:
        """Return a figure of all processes but the first."""
        return [value for number, value in of.items() if number != self.first]


def parent_and_time() -> Iterator[tuple[int, tuple[int, float]]]:
    """Yield the number of each process, with that of its parent and the processor time it has used [s]."""
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                fields = (entry / "stat").read_text().rpartition(")")[2].split()
            except OSError:
                continue
            yield int(entry.name), (int(fields[1]), (int(fields[11]) + int(fields[12])) / TICKS)


def peak(number: int) -> float:
    """Return the peak memory of a process [MiB], 0 for one that has ended."""
    try:
        status = (Path("/proc") / str(number) / "status").read_text()
    except OSError:
        return 0.0
    return next((int(line.split()[1]) / 1024 for line in status.splitlines() if line.startswith("VmHWM")), 0.0)


def watched(command: list[str]) -> Watched:
    """Return what the processes of a command used."""
    start = time.perf_counter()
    with subprocess.Popen(command, stdout=subprocess.DEVNULL) as process:
        figures = Watched(first=process.pid)
        while process.poll() is None:
            figures.look()
            time.sleep(LOOK)
    figures.wall = time.perf_counter() - start
    if process.returncode not in {0, 3, 6}:
        sys.exit(f"{' '.join(command)} ended with {process.returncode}")
    return figures


def make_table(rows: int, path: Path) -> None:
    """Write so many plausible cups as Parquet, every fifth with a fillet and a rim."""
    import polars as pl

    source, made = random.Random(1), []  # noqa: S311
    for number in range(rows):
        diameter = source.uniform(35, 250)
        wall = diameter * source.uniform(0.01, 0.015)
        row = {
            "variant": f"V{number:07d}",
            "material": "42CrMo4 (Q+T)",
            "torque_Nm": round(diameter**3 / 5e3, 2),
            "cylinder_length_mm": round(diameter * source.uniform(0.5, 1), 2),
            "mean_radius_mm": round(diameter / 2, 3),
            "wall_thickness_mm": round(wall, 3),
            "disk_thickness_mm": round(wall * source.uniform(1, 2), 3),
            "disk_inner_radius_mm": round(diameter * source.uniform(0.2, 0.3), 2),
            "backlash_limit_arcmin": round(source.uniform(2, 4), 2),
            "hub_fillet_radius_mm": None,
            "rim_length_mm": None,
            "rim_thickness_mm": None,
        }
        if number % 5 == 0:
            row |= {"hub_fillet_radius_mm": round(diameter / 60, 2), "rim_length_mm": round(diameter / 6, 2)}
            row |= {"rim_thickness_mm": round(wall * 1.5, 3)}
        made.append(row)
    pl.DataFrame(made, infer_schema_length=None).write_parquet(path)


def make_workbooks(count: int, folder: Path) -> None:
    """Write so many small workbooks into a folder, the study's rows in a few orders."""
    from flexlash.feedback.template.template_workbook import Filling, study, template_bytes

    filling = study()
    rows = [*filling.variants]
    kinds = [
        template_bytes(Filling(variants=rows[turn:] + rows[:turn], tolerances=filling.tolerances))
        for turn in range(KINDS)
    ]
    for number in range(count):
        (folder / f"gear-{number:04d}.xlsx").write_bytes(kinds[number % KINDS])


def compare(label: str, given: Path, output: Path, *, dask: bool) -> None:
    """Run with one worker and with two, maybe by Dask as well, and print a line for each."""
    before = None
    for words, options in (("1 worker", ["--jobs", "1"]), ("2 workers", ["--jobs", "2"])):
        figures = watched([sys.executable, "-m", "flexlash", "run", str(given), "-o", str(output), "--quiet", *options])
        show(f"{label}, {words}", figures, before)
        before = before or figures
        clear(output)
    if dask:
        options = ["--jobs", "2", "--scheduler", "local"]
        figures = watched([sys.executable, "-m", "flexlash", "run", str(given), "-o", str(output), "--quiet", *options])
        show(f"{label}, Dask of 2", figures, before)
        clear(output)


def show(label: str, figures: Watched, before: Watched | None) -> None:
    """Print the figures of a run, the ratio to the one before it among them."""
    seconds = sum(figures.others(figures.seconds))
    driver = figures.seconds.get(figures.first, 0.0)
    ratio = f"{before.wall / figures.wall:8.2f}" if before else " " * 8
    print(
        f"{label:34}{figures.wall:9.1f}{ratio}{seconds:10.1f}{driver:9.1f}{100 * driver / max(seconds, 1e-9):8.1f}"
        f"{max(figures.others(figures.mebibytes), default=0.0):11.0f}{figures.mebibytes.get(figures.first, 0.0):10.0f}",
        flush=True,
    )


def clear(output: Path) -> None:
    """Remove what a run has written."""
    if output.is_dir():
        shutil.rmtree(output)
    for path in output.parent.glob(f"{output.stem.removesuffix('-report')}-*"):
        path.unlink()


def main() -> None:
    """Print a table of batches."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--workbooks", type=int, default=500)
    options.add_argument("--rows", type=int, nargs="*", default=[100_000])
    options.add_argument("--dask", action="store_true")
    chosen = options.parse_args()
    print(
        f"{'batch':34}{'wall s':>9}{'ratio':>8}{'workers s':>10}{'first s':>9}{'share %':>8}"
        f"{'worker MiB':>11}{'first MiB':>10}"
    )
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if chosen.workbooks:
            given = folder / "workbooks"
            given.mkdir()
            make_workbooks(chosen.workbooks, given)
            compare(f"{chosen.workbooks} workbooks", given, folder / "reports", dask=chosen.dask)
        for rows in chosen.rows:
            path = folder / f"{rows}.parquet"
            make_table(rows, path)
            compare(f"{rows:,} rows, report", path, folder / f"out-{rows}-report.xlsx", dask=chosen.dask)


if __name__ == "__main__":
    main()
