"""Time and peak memory of whole commands, beside a floor that merely reads and writes the same cells.

    python tests/benchmarks/whole_command.py [ROWS ...]

For each number of rows a submission is made from the template. Every command runs in a process of its own,
once after one warm-up; the floor reads the submission's cells with openpyxl and, for `run`, copies every cell
of the report with openpyxl and XlsxWriter. Quote the ratios: absolute times differ from machine to machine.
"""

from __future__ import annotations

import os
import random
import subprocess
import sys
import tempfile
import time
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


def measured(command: list[str]) -> tuple[float, float]:
    """Return wall time [s] and peak memory [MiB] of a command's second run.

    A child inherits the peak of its parent, so this process must stay small: it imports nothing heavy.
    """
    for _ in range(2):
        start = time.perf_counter()
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, _, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - start
        process.returncode = 0
    return wall, usage.ru_maxrss / 1024


def main() -> None:
    """Print a table of commands, each with its ratio to the floor."""
    flexlash = [sys.executable, "-m", "flexlash"]
    wall, memory = measured([*flexlash, "--help"])
    print(f"{'command':28}{'wall s':>9}{'MiB':>7}{'floor s':>9}{'ratio':>7}")
    print(f"{'--help':28}{wall:9.2f}{memory:7.0f}")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for rows in [int(argument) for argument in sys.argv[1:]] or [6, 1000, 10_000]:
            path = folder / f"{rows}.xlsx"
            subprocess.run([sys.executable, __file__, "--make", str(rows), str(path)], check=True)
            report, copy, pickled = folder / "report.xlsx", folder / "copy.xlsx", folder / "cells.pickle"
            read, _ = measured([sys.executable, "-c", READ, str(path)])
            checked, memory = measured([*flexlash, "check", str(path)])
            print(f"{f'check {rows:,} rows':28}{checked:9.2f}{memory:7.0f}{read:9.2f}{checked / read:7.1f}")
            for jobs in (1, 2):
                ran, memory = measured([*flexlash, "run", str(path), "-o", str(report), "--jobs", str(jobs)])
                if jobs == 1:
                    dump = READ + "\nimport pickle\nwith open(sys.argv[2], 'wb') as f: pickle.dump(cells, f)"
                    subprocess.run([sys.executable, "-W", "ignore", "-c", dump, report, pickled], check=True)
                    write, _ = measured([sys.executable, "-c", WRITE, "", str(pickled), str(copy)])
                label = f"run {rows:,} rows, {jobs} job{'s' if jobs > 1 else ''}"
                print(f"{label:28}{ran:9.2f}{memory:7.0f}{read + write:9.2f}{ran / (read + write):7.1f}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--make"]:
        make_submission(int(sys.argv[2]), Path(sys.argv[3]))
    else:
        main()
