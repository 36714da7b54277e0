"""What the first pass over a large table and its excerpts cost beside a reader that merely goes through the cells.

    python tests/benchmarks/surveys.py [ROWS]

A text and a Parquet file of twelve columns are surveyed, then excerpted 5,000 rows at a time, each in a process of its
own; the floor is csv.reader, or polars with a list of each column. Quote the ratios and the memory: absolute times
differ from machine to machine.
"""

from __future__ import annotations

import random
import subprocess
import sys
import tempfile
from pathlib import Path

KEYS = (
    "variant,material,torque_Nm,cylinder_length_mm,mean_radius_mm,wall_thickness_mm,disk_thickness_mm,"
    "disk_inner_radius_mm,backlash_limit_arcmin,hub_fillet_radius_mm,rim_length_mm,rim_thickness_mm"
)

CONVERT = "import sys, polars; polars.read_csv(sys.argv[1]).write_parquet(sys.argv[2])"
WORK = """
import csv, resource, sys, time
from pathlib import Path
import polars as pl
import flexlash.validation.whole_tables
from flexlash.reading.excerpt import excerpt
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.survey import survey
path, work = Path(sys.argv[1]), sys.argv[2]
found = survey(path, ReadingLimits()) if work == "excerpts" else None
start = time.process_time()
if work == "floor":
    if path.suffix == ".csv":
        sum(len(row) for row in csv.reader(path.open(newline="", encoding="utf-8")))
    else:
        [column.to_list() for column in pl.read_parquet(path).get_columns()]
elif work == "survey":
    survey(path, ReadingLimits())
else:
    for rows in found.chunks(5000):
        excerpt(path, found, rows)
spent = time.process_time() - start
print(spent, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
"""


def _make(rows: int, path: Path) -> None:
    """Write a text table of so many rows."""
    draw = random.Random(1)  # noqa: S311
    with path.open("w", encoding="utf-8") as file:
        file.write(f"{KEYS}\n")
        for number in range(rows):
            radius = draw.uniform(20, 120)
            lengths = (radius * share for share in (1.6, 1.0, 0.02, 0.03, 0.5))
            numbers = ",".join(f"{length:.3f}" for length in lengths)
            file.write(f"V{number},20Cr2Ni4,{radius**3 / 600:.2f},{numbers},2.5,1,{radius / 3:.2f},{radius / 25:.3f}\n")


def main(rows: int) -> None:
    """Print processor time and greatest memory of each step."""
    with tempfile.TemporaryDirectory() as folder:
        text, parquet = Path(folder) / "rows.csv", Path(folder) / "rows.parquet"
        _make(rows, text)
        # A process begins with the greatest memory of the one that started it, so that this one loads nothing.
        subprocess.run([sys.executable, "-c", CONVERT, text, parquet], check=True)
        for path in (text, parquet):
            floor = 0.0
            for work in ("floor", "survey", "excerpts"):
                done = subprocess.run(
                    [sys.executable, "-c", WORK, path, work], check=True, capture_output=True, text=True
                )
                seconds, memory = map(float, done.stdout.split())
                floor = floor or seconds
                print(f"{path.suffix} {work}: {seconds:.2f} s, {seconds / floor:.1f} times the floor, {memory:.0f} MiB")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000)
