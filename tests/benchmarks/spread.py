"""Time to an accurate tail percentile beside plain Monte Carlo, and rows per second of the spread stage.

    python tests/benchmarks/spread.py [--openturns PYTHON] [--seeds SEEDS]
    python tests/benchmarks/spread.py --rows [ROWS ...]

The first form asks each tool for P99.865 of the reversal wind-up of one flexspline, seven inputs varying, and finds
how many samples bring its standard error to a thousandth of the standard deviation. Errors are measured against a
quadrature, as root mean square over seeds. Plain Monte Carlo would take too long for that at its full size: there
the error is measured at two smaller sizes, which must confirm the law 1/√n, and the full size is then run for its
time. OpenTURNS runs in the interpreter named, on one thread, or not at all. A peer's time is its best of two, that of
flexlash the median of many calls in one process, each with a seed not met before unless said otherwise.

The second form spreads variants of the standard class in one process, and times a floor that merely reads and
writes the cells of their submission and report. Quote the ratios: absolute times differ from machine to machine.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import random
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from whole_command import READ, WRITE, measured

WANTED = 1e-3
"""Standard error wanted, in standard deviations of the output."""
PROBABILITY = 0.99865
SIZES = (1 << 18, 1 << 20)
PEER_SEEDS = 160
"""SamplingPlan and seeds by which the error of plain Monte Carlo is measured."""
CALLS = 300

TORQUE = 800.0
NOMINAL = {"l": 0.16, "wall": 1.6e-3, "disk": 1.6e-3, "r_m": 0.08, "r_ci": 0.04, "E": 211e9, "nu": 0.3}
HALF_WIDTH = {"l": 2e-4, "wall": 5e-5, "disk": 5e-5, "r_m": 6e-5, "r_ci": 1.5e-4, "E": 6.33e9, "nu": 0.02}
"""Half of each tolerance: all of a uniform distribution's, three standard deviations of a normal one's."""
CASES = ("normal", "uniform")

OPENTURNS = """
import json, sys, time
import numpy as np
import openturns as ot
ot.TBB.SetThreadsNumber(1)
ot.Log.Show(ot.Log.NONE)
case, torque, nominal, half, probability, runs = json.loads(sys.argv[1])
formula = f"{torque}*2*(1+nu)/(pi_*E)*(l/(r_m*r_m*r_m*wall)+(1/(r_ci*r_ci)-1/(r_m*r_m))/(2*disk))"
model = ot.SymbolicFunction(list(nominal), [formula])
one = ot.Normal if case == "normal" else ot.Uniform
ends = lambda name: (nominal[name], half[name] / 3) if case == "normal" else (
    nominal[name] - half[name], nominal[name] + half[name])
output = ot.CompositeRandomVector(model, ot.RandomVector(ot.JointDistribution([one(*ends(name)) for name in nominal])))
for size, seed in runs:
    ot.RandomGenerator.SetSeed(seed)
    start, cpu = time.perf_counter(), time.process_time()
    kept, drawn, floor = [], 0, None
    while drawn < size:
        block = np.asarray(output.getSample(min(1 << 14, size - drawn))).ravel()
        floor = np.quantile(block, 0.99) if floor is None else floor
        kept.append(block[block > floor])
        drawn += len(block)
    above = size - int(probability * size)
    quantile = np.partition(np.concatenate(kept), -above)[-above]
    print(json.dumps([float(quantile), time.perf_counter() - start, time.process_time() - cpu]), flush=True)
print(json.dumps(ot.__version__))
""".replace("pi_", repr(math.pi))


def wind_up(l, wall, disk, r_m, r_ci, E, nu):  # noqa: E741, N803, PLR0917
    """Return twice the wind-up [rad] of a cup: cylinder and disk."""
    square = r_m * r_m
    return (
        (2 * TORQUE / math.pi)
        * (1 + nu)
        / E
        * (l / (square * r_m * wall) + (1 / (r_ci * r_ci) - 1 / square) / (2 * disk))
    )


class Truth:
    """P99.865, standard deviation and error·√n of plain draws, by Gauss quadrature.

    The distribution of (1 + ν)/E at each node of the five other inputs is a closed form, or nearly.
    """

    def __init__(self, case, *, fine=1):
        import numpy as np
        from scipy.optimize import brentq

        self._case = case
        counts = {"l": 3, "wall": 16, "disk": 16, "r_m": 3, "r_ci": 8, "E": 16, "nu": 16}
        nodes = {name: self._nodes(name, fine * count) for name, count in counts.items()}
        self._nu = nodes["nu"]
        shape, weight = [], np.ones(1)
        for name in ("l", "wall", "disk", "r_m", "r_ci"):
            shape = [np.repeat(values, len(nodes[name][0])) for values in shape]
            shape.append(np.tile(nodes[name][0], len(weight)))
            weight = np.outer(weight, nodes[name][1]).ravel()
        self._weight, self._shape = weight, wind_up(*shape, E=1.0, nu=0.0)
        ratio = [nodes["nu"][1] @ (1 + nodes["nu"][0]) ** k * (nodes["E"][1] @ nodes["E"][0] ** -k) for k in (1, 2)]
        mean, square = (ratio[k - 1] * (weight @ self._shape**k) for k in (1, 2))
        self.sd = math.sqrt(square - mean * mean)
        self.quantile = brentq(
            lambda output: self._below(output) - PROBABILITY, mean, mean + 5 * self.sd, xtol=1e-7 * self.sd
        )
        step = 1e-3 * self.sd
        density = (self._below(self.quantile + step) - self._below(self.quantile - step)) / (2 * step)
        self.constant = math.sqrt(PROBABILITY * (1 - PROBABILITY)) / (density * self.sd)

    def _nodes(self, name, count):
        """Return nodes and weights of an input."""
        import numpy as np

        if self._case == "normal":
            nodes, weights = np.polynomial.hermite_e.hermegauss(count)
            nodes /= 3
        else:
            nodes, weights = np.polynomial.legendre.leggauss(count)
        return NOMINAL[name] + HALF_WIDTH[name] * nodes, weights / weights.sum()

    def _below(self, output):
        """Return the share of the output below a value."""
        import numpy as np
        from scipy.special import ndtr

        ratio = output / self._shape
        if self._case == "normal":
            sd = HALF_WIDTH["E"] / 3
            share = sum(
                weight * ndtr((NOMINAL["E"] - (1 + nu) / ratio) / sd) for nu, weight in zip(*self._nu, strict=True)
            )
        else:
            # ν lies below ratio·E − 1: that share rises from 0 to 1, and this is its mean over E.
            low, high = (NOMINAL["E"] + sign * HALF_WIDTH["E"] for sign in (-1, 1))
            start, width = 1 + NOMINAL["nu"] - HALF_WIDTH["nu"], 2 * HALF_WIDTH["nu"]
            ends = [(ratio * modulus - start) / width for modulus in (low, high)]
            area = [np.where(end < 1, np.maximum(end, 0) ** 2 / 2, end - 0.5) for end in ends]
            share = (area[1] - area[0]) / (ends[1] - ends[0])
        return self._weight @ share


def numpy_runs(case, runs):
    """Yield quantile, wall time and processor time of plain Monte Carlo for each (draws, seed)."""
    import numpy as np

    middle, half = (np.array(list(values.values()))[:, None] for values in (NOMINAL, HALF_WIDTH))
    points = np.empty((len(NOMINAL), 1 << 14))
    for size, seed in runs:
        start, cpu = time.perf_counter(), time.process_time()
        generator = np.random.default_rng(seed)
        kept, drawn, floor = [], 0, None
        while drawn < size:
            if case == "normal":
                generator.standard_normal(out=points)
                points *= half / 3
                points += middle
            else:
                generator.random(out=points)
                points *= 2 * half
                points += middle - half
            outputs = wind_up(*points)[: size - drawn]
            floor = np.quantile(outputs, 0.99) if floor is None else floor
            kept.append(outputs[outputs > floor])
            drawn += len(outputs)
        above = size - int(PROBABILITY * size)
        quantile = np.partition(np.concatenate(kept), -above)[-above]
        yield float(quantile), time.perf_counter() - start, time.process_time() - cpu


def openturns_runs(python, case, runs):
    """Return the same of OpenTURNS."""
    settings = json.dumps([case, TORQUE, NOMINAL, HALF_WIDTH, PROBABILITY, runs])
    printed = subprocess.run([python, "-c", OPENTURNS, settings], check=True, stdout=subprocess.PIPE, text=True)
    return [json.loads(line) for line in printed.stdout.splitlines()[:-1]]


def root_mean_square(quantiles, truth):
    """Return the error of quantiles in standard deviations of the output."""
    return math.sqrt(statistics.fmean(((one - truth.quantile) / truth.sd) ** 2 for one in quantiles))


def constant_of(runs_of, truth):
    """Return error·√n of a peer from both sizes, and what was measured."""
    told, constants = [], []
    for size in SIZES:
        runs = runs_of([(size, seed) for seed in range(1, PEER_SEEDS + 1)])
        error = root_mean_square([run[0] for run in runs], truth)
        constants.append(error * math.sqrt(size))
        told.append(f"{error:.2e} at n = {size:,} (error·√n = {constants[-1]:.2f})")
    return constants, "; ".join(told)


def plain(peers, truth):
    """Return the rows of the peers by label: draws needed, error there, threads kept busy, best time; and notes.

    Both are the same estimator, so that what all their runs say of error·√n counts for both.
    """
    found = {label: constant_of(runs_of, truth) for label, runs_of in peers.items()}
    constant = math.sqrt(statistics.fmean(one * one for constants, _ in found.values() for one in constants))
    needed = math.ceil((constant / WANTED) ** 2)
    rows, notes = {}, [f"error·√n {constant:.2f} of all peers, {truth.constant:.2f} by the density"]
    for label, runs_of in peers.items():
        full = list(runs_of([(needed, 10_001), (needed, 10_002)]))
        best = min(full, key=lambda run: run[1])
        rows[label] = (needed, constant / math.sqrt(needed), best[2] / best[1], best[1])
        ends = ", ".join(f"{(run[0] - truth.quantile) / truth.sd:+.1e}" for run in full)
        notes.append(f"{label}: error in sd {found[label][1]} ({PEER_SEEDS} seeds); of the full runs {ends}")
    return rows, notes


def ours(case, truth, seeds):
    """Return the rows of flexlash by label, and what was measured."""
    from flexlash.tolerance import Normal, Uniform, propagate

    inputs = {
        name: Normal(middle, HALF_WIDTH[name] / 3)
        if case == "normal"
        else Uniform(middle - HALF_WIDTH[name], middle + HALF_WIDTH[name])
        for name, middle in NOMINAL.items()
    }

    def spread(samples, seed):
        return propagate(wind_up, inputs, method="line", samples=samples, seed=seed)

    def error(samples):
        return root_mean_square([spread(samples, seed).quantile(PROBABILITY) for seed in range(seeds)], truth)

    def timed(*ways):
        """Time several ways of choosing (samples, seed) in turn, so that a noisy minute tells on all."""
        walls, busy = [[] for _ in ways], [0.0 for _ in ways]
        for call in range(CALLS):
            for place, way in enumerate(ways):
                start, cpu = time.perf_counter(), time.process_time()
                spread(*way(call)).quantile(PROBABILITY)
                walls[place].append(time.perf_counter() - start)
                busy[place] += time.process_time() - cpu
        return [(cpu / sum(wall), statistics.median(wall)) for wall, cpu in zip(walls, busy, strict=True)]

    errors, samples = {}, 4
    while not errors or errors[samples] > WANTED:
        samples *= 2
        errors[samples] = error(samples)
    reached = errors[samples]
    errors[2 * samples] = error(2 * samples)
    size = int(statistics.median(spread(None, seed).size for seed in range(seeds)))
    fresh, met, adaptive = timed(
        lambda call: (samples, 1000 + call), lambda _: (samples, 0), lambda call: (None, 2000 + call)
    )
    rows = {
        "flexlash": (samples, reached, *fresh),
        "flexlash, seed met before": (samples, reached, *met),
        "flexlash, samples=None": (size, error(None), *adaptive),
    }
    return rows, "; ".join(f"{found:.2e} at n = {number:,}" for number, found in errors.items())


def accuracy(openturns, seeds):
    """Print a table of tools with their time to accuracy, each with its ratio to the faster peer."""
    heading = f"{'case':9}{'tool':27}{'n':>12}{'s.e./sd':>10}{'CPU/wall':>10}{'seconds':>11}{'faster peer / this':>20}"
    table, notes = [heading], []
    for case in CASES:
        truth, finer = Truth(case), Truth(case, fine=2)
        off = abs(finer.quantile - truth.quantile) / truth.sd
        notes.append(
            f"{case}: P99.865 = {finer.quantile:.10e}, sd = {finer.sd:.6e}; twice the nodes move it {off:.0e} sd"
        )
        rows, told = ours(case, finer, seeds)
        notes.append(f"{case}, flexlash: root mean square error in sd {told} ({seeds} seeds)")
        peers = {"numpy": lambda runs, case=case: numpy_runs(case, runs)}
        if openturns:
            peers["OpenTURNS"] = lambda runs, case=case: openturns_runs(openturns, case, runs)
        theirs, summary_facts = plain(peers, finer)
        rows |= theirs
        notes += [f"{case}, {told}" for told in summary_facts]
        faster = min(rows[label][-1] for label in peers)
        table += [
            f"{case:9}{label:27}{n:12,}{error:10.1e}{busy:10.2f}{seconds:11.4g}{faster / seconds:20,.3g}"
            for label, (n, error, busy, seconds) in rows.items()
        ]
    print(*table, sep="\n", end="\n\n")
    print("n of the peers is extrapolated by 1/√n from the errors measured below, then run in full.")
    print(f"CPU/wall counts the threads kept busy, of {os.cpu_count()} processors; below 1 they were shared.")
    print(*notes, sep="\n")
    if not openturns:
        print("OpenTURNS skipped: name an interpreter that has it by --openturns.")


def drawn_rows(rows):
    """Return plausible cups of the standard class, every fifth with fillets and rim."""
    from dataclasses import replace
    from functools import partial

    from flexlash import pipeline
    from flexlash.mechanics.flexspline import backlash
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
    model = partial(backlash, "cup")
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
        template = simple if number % 5 else refined
        if template is refined:
            dimensions |= {"rim_length": diameter / 10, "rim_thickness": 2 * wall}
        variant = replace(template, row=number, dimensions=template.dimensions | dimensions)
        limits, _ = shape_problems(variant, limits_of(variant, standard)[0])
        limit = math.radians(source.uniform(1, 5) / 60)
        toleranced.append(TolerancedRow(model=model, nominal=variant.dimensions, limits=limits, upper_limit=limit))
    return toleranced


def spread_once(rows):
    """Print seconds, peak memory [MiB] before and after, and by which methods rows were answered, as JSON."""
    from collections import Counter

    from flexlash.analysis.tolerance_spread import row_statistics
    from flexlash.schema.columns import DIMENSIONS
    from flexlash.tolerance.sampling import SamplingPlan

    toleranced = drawn_rows(rows)
    plan = SamplingPlan(method="line", inputs=tuple(DIMENSIONS))
    list(row_statistics(toleranced[:200], plan, 1))
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    start = time.perf_counter()
    found = list(row_statistics(toleranced, plan, 1))
    wall = time.perf_counter() - start
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    lines = Counter(f"{one.texts['spread_method']} {one.numbers['spread_points']:.0f}" for _, one in found)
    print(json.dumps([wall, before, after, dict(lines.most_common(4))]))


def floor(rows, folder):
    """Return the times to read the cells of a submission and to write those of its report."""
    path, report, copy, pickled = (folder / name for name in ("in.xlsx", "out.xlsx", "copy.xlsx", "cells.pickle"))
    make = [sys.executable, Path(__file__).with_name("whole_command.py"), "--make", str(rows), path]
    subprocess.run(make, check=True)
    read, _ = measured([sys.executable, "-c", READ, str(path)])
    flexlash = [sys.executable, "-m", "flexlash", "run", path, "-o", report]
    subprocess.run(flexlash, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    dump = READ + "\nimport pickle\nwith open(sys.argv[2], 'wb') as f: pickle.dump(cells, f)"
    subprocess.run([sys.executable, "-W", "ignore", "-c", dump, report, pickled], check=True)
    write, _ = measured([sys.executable, "-c", WRITE, "", str(pickled), str(copy)])
    return read, write


def throughput(counts):
    """Print a table of rows per second; this process stays small, since a child inherits its parent's peak."""
    print(f"{'rows':>9}{'seconds':>10}{'rows/s':>9}{'MiB before':>12}{'MiB peak':>10}  lines (commonest)")
    best = {}
    for rows in counts:
        runs = []
        for _ in range(3 if rows <= 10_000 else 1):
            command = [sys.executable, __file__, "--spread", str(rows)]
            printed = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
            runs.append(json.loads(printed.stdout))
        wall, before, after, lines = min(runs)
        best[rows] = wall
        told = ", ".join(f"{name}: {number:,}" for name, number in lines.items())
        print(f"{rows:9,}{wall:10.2f}{rows / wall:9.0f}{before:12.0f}{after:10.0f}  {told}", flush=True)
    rows = 10_000 if 10_000 in best else min(best)
    with tempfile.TemporaryDirectory() as name:
        read, write = floor(rows, Path(name))
    print(f"floor of {rows:,} rows: read {read:.2f} s (openpyxl) + write {write:.2f} s (XlsxWriter)", end="; ")
    print(f"spread / floor = {best[rows] / (read + write):.2f}")


def main():
    """Measure what the options ask for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--openturns", metavar="PYTHON", help="interpreter that has OpenTURNS and numpy")
    parser.add_argument("--seeds", type=int, default=40, help="seeds behind each error measured")
    parser.add_argument("--rows", type=int, nargs="*", help="rows per second and peak memory instead")
    parser.add_argument("--spread", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.spread is not None:
        spread_once(options.spread)
    elif options.rows is not None:
        throughput(options.rows or [1000, 10_000, 100_000])
    else:
        accuracy(options.openturns, options.seeds)


if __name__ == "__main__":
    main()
