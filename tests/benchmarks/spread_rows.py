"""Rows per second and memory of the spread stage, for `spread.py`.

The classes are the standard one, without lots and with what they share, and one of eight uniform tolerances. A floor
merely reads and writes the cells of the standard class's submission and report.
"""

from __future__ import annotations

import json
import math
import random
import resource
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

GOALS = {"standard": 2500, "standard with lots": 1900, "eight uniform": 400}
"""Rows a second and process; with lots a row may take 1.3 times as long."""
UNIFORM = {
    "cylinder_length": 0.00125,
    "mean_radius": 0.00075,
    "wall_thickness": 0.03,
    "disk_thickness": 0.03,
    "disk_inner_radius": 0.00375,
    "youngs_modulus": 0.03,
    "poisson_ratio": 0.0667,
    "cylinder_calibration": 0.02,
}
"""Half of each tolerance of the second class, as part of the nominal size: the flexspline of `wind_up_law`, made up."""


def drawn_rows(rows, kind):
    """Return plausible cups of a class, every fifth of the standard one with fillets and rim."""
    from dataclasses import replace
    from functools import partial

    from flexlash import pipeline
    from flexlash.mechanics.flexspline import backlash
    from flexlash.schema.columns import LOT_DIMENSIONS
    from flexlash.schema.variant import Limits
    from flexlash.tolerance.dimension_limits import limits_of, shape_problems
    from flexlash.tolerance.row_batches import TolerancedRow

    with tempfile.TemporaryDirectory() as name:
        path = Path(name, "two.xlsx")
        make = [sys.executable, Path(__file__).with_name("whole_command.py"), "--make", "2", path]
        subprocess.run(make, check=True)
        outcome = pipeline.check(path)
    refined, simple = (one.variant for one in outcome.computed.values())
    standard = outcome.validated.classes["standard"]
    source = random.Random(1)  # noqa: S311
    model, is_standard = partial(backlash, "cup"), kind.startswith("standard")
    toleranced = []
    for number in range(rows):
        diameter = source.uniform(0.035, 0.25)
        wall = diameter * source.uniform(0.01, 0.015)
        dimensions = {
            "torque": diameter**3 * 2e5,
            "cylinder_length": diameter * source.uniform(0.5, 1),
            "mean_radius": diameter / 2,
            "wall_thickness": wall,
            "disk_inner_radius": diameter / 4,
        }
        template = simple if number % 5 or not is_standard else refined
        if template is refined:
            dimensions |= {"rim_length": diameter / 10, "rim_thickness": 2 * wall}
        if not is_standard:
            dimensions |= {"disk_thickness": wall, "cylinder_calibration": 1.0}
        variant = replace(template, row=number, dimensions=template.dimensions | dimensions)
        if is_standard:
            limits, _ = shape_problems(variant, limits_of(variant, standard)[0])
        else:
            sizes = variant.dimensions
            limits = {
                name: Limits(low=sizes[name] * (1 - part), high=sizes[name] * (1 + part), distribution="uniform")
                for name, part in UNIFORM.items()
            }
        limit = math.radians(source.uniform(1, 5) / 60)
        row = TolerancedRow(model=model, nominal=variant.dimensions, limits=limits, upper_limit=limit)
        with_lots = kind == "standard with lots"
        toleranced.append(replace(row, between=LOT_DIMENSIONS.intersection(limits)) if with_lots else row)
    return toleranced


def spread_once(rows, kind):
    """Print processor seconds, peak memory [MiB] before and after, and how rows were answered, as JSON."""
    from flexlash.analysis.tolerance_spread import row_statistics
    from flexlash.schema.columns import DIMENSIONS
    from flexlash.tolerance.sampling import SamplingPlan

    toleranced = drawn_rows(rows, kind)
    plan = SamplingPlan(method="line", inputs=tuple(DIMENSIONS))
    list(row_statistics(toleranced[:200], plan, 1))
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    start = time.process_time()
    found = list(row_statistics(toleranced, plan, 1))
    seconds = time.process_time() - start
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    lines = Counter(f"{one.texts['spread_method']} {one.numbers['spread_points']:.0f}" for _, one in found)
    print(json.dumps([seconds, before, after, dict(lines.most_common(4))]))


def floor(rows, folder):
    """Return the processor times to read the cells of a submission and to write those of its report."""
    from whole_command import READ, WRITE, measured

    path, report, copy, pickled = (folder / name for name in ("in.xlsx", "out.xlsx", "copy.xlsx", "cells.pickle"))
    make = [sys.executable, Path(__file__).with_name("whole_command.py"), "--make", str(rows), path]
    subprocess.run(make, check=True)
    read = measured([sys.executable, "-c", READ, str(path)])
    flexlash = [sys.executable, "-m", "flexlash", "run", path, "-o", report]
    subprocess.run(flexlash, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    dump = READ + "\nimport pickle\nwith open(sys.argv[2], 'wb') as f: pickle.dump(cells, f)"
    subprocess.run([sys.executable, "-W", "ignore", "-c", dump, report, pickled], check=True)
    write = measured([sys.executable, "-c", WRITE, "", str(pickled), str(copy)])
    return read.processor, write.processor


def throughput(counts, program):
    """Print a table of rows per second; this process stays small, since a child inherits its parent's peak."""
    print("\n## Rows\n")
    print("| class | rows | s | rows/s | goal | | MiB before | MiB peak | lines (commonest) |")
    print("|---|---:|---:|---:|---:|---|---:|---:|---|")
    best = {}
    for kind, goal in GOALS.items():
        for rows in counts:
            runs = []
            for _ in range(3 if rows <= 1000 else 2 if rows <= 10_000 else 1):
                command = [sys.executable, program, "--one", kind, str(rows)]
                printed = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
                runs.append(json.loads(printed.stdout))
            seconds, before, after, lines = min(runs)
            best[kind, rows] = seconds
            rate = rows / seconds
            told = ", ".join(f"{name}: {number:,}" for name, number in lines.items())
            verdict = "met" if rate >= goal else "missed"
            numbers = f"{seconds:.2f} | {rate:,.0f} | {goal:,} | {verdict} | {before:.0f} | {after:.0f}"
            print(f"| {kind} | {rows:,} | {numbers} | {told} |", flush=True)
    rows = min(max(counts), 10_000)
    if ("standard", rows) in best:
        with tempfile.TemporaryDirectory() as name:
            read, write = floor(rows, Path(name))
        ratio = best["standard", rows] / (read + write)
        print(f"\nfloor of {rows:,} rows: read {read:.2f} s (openpyxl) + write {write:.2f} s (XlsxWriter)", end="; ")
        print(f"spread / floor = {ratio:.2f}")
