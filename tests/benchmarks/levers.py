"""What levers cost beside the run without them.

    python tests/benchmarks/levers.py [ROWS ...]

For each number of rows a table of plausible cups, each with a limit, is given to `flexlash run`, for its Results and
for its report, and to `flexlash levers`, each in a process of its own after one that warms up. Printed are the wall
time and the processor time of each command, and both as parts of those of the run. Quote the ratios of a quiet machine.
"""

from __future__ import annotations

import argparse
import os
import random
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HEADERS = (
    "Variant,Flexspline type,Material,Torque T [N·m],Cylinder length l [mm],Mean radius r_m [mm],Wall thickness Δ [mm],"
    "Disk inner radius r_ci [mm],Backlash limit [arcmin]"
)


def write_cups(rows: int, path: Path) -> None:
    """Write cups of half to once and a quarter the size of the B3-160, of which about a third are over their limit."""
    source = random.Random(1)  # noqa: S311
    lines = [HEADERS]
    for number in range(rows):
        size = source.uniform(0.5, 1.2)
        numbers = (
            round(800 * size**3 * source.uniform(0.8, 1.2), 1),
            round(source.uniform(1.2, 2.6) * 80 * size, 1),
            round(80 * size, 1),
            round(1.6 * size, 2),
            round(40 * size * source.uniform(0.9, 1.1), 1),
            round(3.8 * source.uniform(0.8, 1.3), 2),
        )
        lines.append(",".join([f"V{number:05d},cup,20Cr2Ni4", *map(str, numbers)]))
    path.write_text("\n".join(lines), encoding="utf-8")


def timed(*arguments: object) -> tuple[float, float]:
    """Return wall and processor time [s] of a command with all of its processes."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    command = [sys.executable, "-m", "flexlash", *map(str, arguments)]
    subprocess.run(command, check=True, capture_output=True)
    wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    """Time the commands and print what they take."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("rows", type=int, nargs="*", default=[1000])
    print(f"{os.cpu_count()} cores")
    for rows in parser.parse_args().rows:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            table = folder / "cups.csv"
            write_cups(rows, table)
            timed("check", table)
            run = timed("run", table, "-o", folder / "results.csv")
            found = {
                "run, Results": run,
                "run, report": timed("run", table, "-o", folder / "report.xlsx"),
                "levers": timed("levers", table, "-o", folder / "levers.csv"),
                "levers, one process": timed("levers", table, "-o", folder / "levers.csv", "--jobs", 1),
            }
        print(f"{rows} rows             wall s      ×   processor s      ×")
        for what, (wall, processor) in found.items():
            print(f"{what:20} {wall:8.2f} {wall / run[0]:6.2f} {processor:13.2f} {processor / run[1]:6.2f}")


if __name__ == "__main__":
    main()
