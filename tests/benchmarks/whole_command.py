"""Time and peak memory of whole commands, beside a floor that merely reads and writes the same cells.

    python tests/benchmarks/whole_command.py [ROWS ...]

For each number of rows a submission is made from the template. Every command runs in a process of its own,
once after one warm-up; the floor reads the submission's cells with openpyxl and, for `run`, copies every cell
of the report with openpyxl and XlsxWriter. Quote the ratios, those of
processor time where the machine has other work: absolute times differ from machine to machine.
"""

from __future__ import annotations

import os
import random
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

READ = """
import openpyxl, sys
book = openpyxl.load_workbook(sys.argv[1], read_only=True, data_only=True)
cells = {}
for sheet in book.worksheets:
    sheet.reset_dimensions()
    cells[sheet.title] = [row for row in sheet.iter_rows(values_only=True)]
"""
WRITE = """
import pickle, sys, xlsxwriter
with open(sys.argv[2], "rb") as file:
    cells = pickle.load(file)
book = xlsxwriter.Workbook(sys.argv[3], {"in_memory": True})
for title, rows in cells.items():
    sheet = book.add_worksheet(title)
    for row, values in enumerate(rows):
        for column, value in enumerate(values):
            if isinstance(value, str):
                sheet.write_string(row, column, value)
            elif isinstance(value, (int, float)):
                sheet.write_number(row, column, value)
book.close()
"""


def make_submission(rows: int, path: Path) -> None:
    """Write a submission of plausible cups, every fifth with fillets and rim."""
    from flexlash.feedback.template.template_workbook import Filling, template_bytes

    source = random.Random(1)  # noqa: S311
    variants = []
    for number in range(rows):
        diameter = source.uniform(35, 250)
        wall = diameter * source.uniform(0.01, 0.015)
        row = {
            "variant": f"V{number:05d}",
            "material": "42CrMo4 (Q+T)",
            "torque_Nm": round(diameter**3 / 5e3, 2),
            "cylinder_length_mm": round(diameter * source.uniform(0.5, 1), 2),
            "mean_radius_mm": round(diameter / 2, 3),
            "wall_thickness_mm": round(wall, 3),
            "disk_inner_radius_mm": round(diameter / 4, 2),
            "backlash_limit_arcmin": round(source.uniform(1, 5), 2),
        }
        if number % 5 == 0:
            row |= {"hub_fillet_radius_mm": 2.0, "junction_fillet_radius_mm": 2.0}
            row |= {"rim_length_mm": round(diameter / 10, 2), "rim_thickness_mm": round(2 * wall, 3)}
        variants.append(row)
    path.write_bytes(template_bytes(Filling(variants=variants)))


@dataclass(frozen=True)
class Cost:
    """What a command cost: wall and processor time [s], the latter with its children's, and peak memory [MiB]."""

    wall: float
    processor: float
    memory: float = 0.0

    def __add__(self, other: Cost) -> Cost:
        """Return what two commands cost one after the other."""
        return Cost(self.wall + other.wall, self.processor + other.processor, max(self.memory, other.memory))


def measured(command: list[str]) -> Cost:
    """Return what the second run of a command cost.

    A child inherits the peak of its parent, so this process must stay small: it imports nothing heavy.
    """
    for _ in range(2):
        start = time.perf_counter()
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, _, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - start
        process.returncode = 0
    return Cost(wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024)


def told(label: str, cost: Cost, floor: Cost) -> None:
    """Print the line of a command beside its floor."""
    times = f"{cost.wall:9.2f}{cost.processor:9.2f}{cost.memory:7.0f}{floor.wall:9.2f}{floor.processor:9.2f}"
    print(f"{label:28}{times}{cost.wall / floor.wall:7.1f}{cost.processor / floor.processor:7.1f}")


def main() -> None:
    """Print a table of commands, each with its ratio to the floor."""
    flexlash = [sys.executable, "-m", "flexlash"]
    started = measured([*flexlash, "--help"])
    headings = f"{'wall s':>9}{'proc s':>9}{'MiB':>7}{'floor':>9}{'proc s':>9}{'ratio':>7}{'proc':>7}"
    print(f"{'command':28}{headings}")
    print(f"{'--help':28}{started.wall:9.2f}{started.processor:9.2f}{started.memory:7.0f}")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for rows in [int(argument) for argument in sys.argv[1:]] or [6, 1000, 10_000]:
            path = folder / f"{rows}.xlsx"
            subprocess.run([sys.executable, __file__, "--make", str(rows), str(path)], check=True)
            report, copy, pickled = folder / "report.xlsx", folder / "copy.xlsx", folder / "cells.pickle"
            read = measured([sys.executable, "-c", READ, str(path)])
            told(f"check {rows:,} rows", measured([*flexlash, "check", str(path)]), read)
            for jobs in (1, 2):
                ran = measured([*flexlash, "run", str(path), "-o", str(report), "--jobs", str(jobs)])
                if jobs == 1:
                    dump = READ + "\nimport pickle\nwith open(sys.argv[2], 'wb') as f: pickle.dump(cells, f)"
                    subprocess.run([sys.executable, "-W", "ignore", "-c", dump, report, pickled], check=True)
                    write = measured([sys.executable, "-c", WRITE, "", str(pickled), str(copy)])
                told(f"run {rows:,} rows, {jobs} job{'s' if jobs > 1 else ''}", ran, read + write)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--make"]:
        make_submission(int(sys.argv[2]), Path(sys.argv[3]))
    else:
        main()
