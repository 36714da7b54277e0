"""What a common fault costs an honest large table: processor time of `check` beside the same rows without it.

    python tests/benchmarks/honest_tables.py [ROWS]

Each table is checked in a process of its own, with the lines and the JSON that a command prints; its time is that of
this process and of the limited one, less what a table of one row takes. Every ratio should be at most 1.5.
"""

from __future__ import annotations

import csv
import json
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

KEYS = (
    "variant", "material", "torque_Nm", "cylinder_length_mm", "mean_radius_mm", "wall_thickness_mm",
    "disk_inner_radius_mm", "tolerance_class",
)  # fmt: skip
MATERIALS = 3000
ONE = """
import json, sys
from pathlib import Path
from flexlash.pipeline import check
from flexlash.analysis.run_summary import finding_lines
outcome = check(Path(sys.argv[1]), materials=Path(sys.argv[2]))
list(finding_lines(outcome.findings))
json.dumps(outcome.as_dictionary())
if not outcome.validated: sys.exit(outcome.findings[0].message)
print(json.dumps([len(outcome.findings), outcome.counts["computed"]]))
"""


def _row(number: int) -> list[object]:
    return [f"V{number}", f"Steel {number % MATERIALS} X", 800, 160, 80, 1.6, 40, ""]


def _other_case(number: int) -> list[object]:
    return [*_row(number)[:1], f"STEEL {number % MATERIALS} x", *_row(number)[2:]]


def _unknown(number: int) -> list[object]:
    return [*_row(number)[:1], f"Stahl {number} Y", *_row(number)[2:]]


def _text(number: int) -> list[object]:
    return [*_row(number)[:2], "800 Nm", *_row(number)[3:]]


def _twice(number: int) -> list[object]:
    return [f"V{number // 2}", *_row(number)[1:]]


def _written(path: Path, headers: tuple[str, ...], rows: int, row: Callable[[int], list[object]]) -> Path:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(headers)
        writer.writerows(map(row, range(rows)))
    return path


def _checked(*paths: Path) -> tuple[float, int, int]:
    """Return seconds of processor time, number of findings, and rows that can be computed."""
    before = _used()
    told = subprocess.run([sys.executable, "-c", ONE, *map(str, paths)], check=True, stdout=subprocess.PIPE, text=True)
    findings, computed = json.loads(told.stdout)
    return _used() - before, int(findings), int(computed)


def _used() -> float:
    """Return the processor time [s] of all processes that this one, or one of them, has started and that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main() -> None:
    """Print how long each table takes beside the sound one."""
    rows = int(sys.argv[1]) if len(sys.argv) > 1 else 0
    cases = {
        "materials in other letter case": (rows or 20_000, _other_case),
        "unknown materials": (rows or 20_000, _unknown),
        "names twice": (rows or 20_000, _twice),
        "a torque with its unit": (rows or 100_000, _text),
    }
    with tempfile.TemporaryDirectory() as folder:
        steel = _written(
            Path(folder, "materials.csv"),
            ("material", "shear_modulus_GPa"),
            MATERIALS,
            lambda number: [f"Steel {number} X", 80],
        )
        start = _checked(_written(Path(folder, "one.csv"), KEYS, 1, _row), steel)[0]
        sound: dict[int, float] = {}
        for name, (count, row) in cases.items():
            if count not in sound:
                sound[count] = _checked(_written(Path(folder, "sound.csv"), KEYS, count, _row), steel)[0] - start
            seconds, findings, computed = _checked(_written(Path(folder, "faulty.csv"), KEYS, count, row), steel)
            print(
                f"{name}: {count} rows, {findings} findings, {computed} rows ready: {seconds - start:.1f} s, "
                f"{(seconds - start) / sound[count]:.2f} times the sound rows' {sound[count]:.1f} s",
                flush=True,
            )


if __name__ == "__main__":
    main()
