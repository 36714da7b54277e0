"""The goals of the spread engine side by side: time to accuracy beside its peers, and rows per second.

    python tests/benchmarks/spread.py [--openturns PYTHON] [--seeds SEEDS] [--parts PART ...] [--rows ROWS ...]

`percentile` asks each tool for P99.865 of the reversal wind-up of one flexspline, seven inputs varying, to a thousandth
of its standard deviation. Errors are measured against a quadrature, as root mean square over seeds. Plain Monte Carlo
would take too long for that at its full size: there the error is measured at two smaller sizes, which must confirm the
law 1/√n, and the full size is then run for its time.

`probability` asks for the probability over a limit, 1.35e-3 and 1e-5, to 1 % of itself. The peer is OpenTURNS: FORM
from the mean (Abdo-Rackwitz) and importance sampling about the design point, with blocks of one as it comes and with
blocks of 1,000; and the variance-reduced form of it, which is quicker where the limit is smooth.

`rows` spreads variants of two classes in one process.

Seconds are processor time of whole calls, the median of flexlash's and of OpenTURNS' many, the best of plain Monte
Carlo's two. Every call of flexlash has a seed not met before. OpenTURNS runs in the interpreter named, on one thread,
or not at all: `python -m venv VENV && VENV/bin/pip install openturns numpy`. Quote the ratios: absolute times differ
from machine to machine.
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from spread_rows import spread_once, throughput
from wind_up_law import FORMULA, HALF_WIDTH, NOMINAL, WindUpLaw, inputs_of, wind_up

from flexlash.tolerance import propagate

PROBABILITY = 0.99865
WANTED = 1e-3
"""Error wanted of the percentile, in standard deviations of the output."""
RELATIVE = 1e-2
"""Error wanted of a probability, as a part of itself."""
SIZES = (1 << 18, 1 << 20)
"""Points by which the error of plain Monte Carlo is measured, with `PER_SEED` seeds for each of flexlash's."""
PER_SEED = 4
IMPORTANCE = 20_000
"""Points by which that of importance sampling is."""
CALLS = 300
MOST = 1 << 15
GOALS = {"normal": 20_000, "uniform": 500, "triangular": 4_000}
"""Times that flexlash is to be faster than plain numpy."""
RARE = (1.35e-3, 1e-5)
RARE_GOALS = {"normal": 150, "uniform": 100}
"""Times that it is to be faster than OpenTURNS' FORM and importance sampling."""
PEERS = (("importance", 1), ("importance", 1000), ("controlled", 1000))
PEER_NAMES = {"importance": "FORM + importance sampling", "controlled": "FORM + controlled importance sampling"}
HOPELESS = 10_000_000
"""Points beyond which a peer's way is left out."""


def root_mean_square(values):
    """Return the root of the mean square."""
    return math.sqrt(statistics.fmean(value * value for value in values))


def numpy_runs(kind, runs):
    """Return percentile and processor time of plain Monte Carlo for each (seed, points)."""
    middle, half = (np.array(list(values.values()))[:, None] for values in (NOMINAL, HALF_WIDTH))
    points = np.empty((len(NOMINAL), 1 << 14))
    other = np.empty_like(points)
    found = []
    for seed, size in runs:
        start = time.process_time()
        generator = np.random.default_rng(seed)
        kept, drawn, floor = [], 0, None
        while drawn < size:
            if kind == "normal":
                generator.standard_normal(out=points)
                points *= half / 3
                points += middle
            else:
                generator.random(out=points)
                if kind == "triangular":
                    generator.random(out=other)
                    points += other
                    points *= half
                else:
                    points *= 2 * half
                points += middle - half
            outputs = wind_up(*points)[: size - drawn]
            floor = np.quantile(outputs, 0.99) if floor is None else floor
            kept.append(outputs[outputs > floor])
            drawn += len(outputs)
        above = size - int(PROBABILITY * size)
        quantile = np.partition(np.concatenate(kept), -above)[-above]
        found.append((float(quantile), time.process_time() - start))
    return found


def openturns_runs(python, kind, what, runs, **more):
    """Return answer and processor time of OpenTURNS for each run, a seed and what `openturns_peers` is asked."""
    asked = {"kind": kind, "what": what, "formula": FORMULA, "nominal": NOMINAL, "half": HALF_WIDTH, "runs": runs}
    command = [python, Path(__file__).with_name("openturns_peers.py"), json.dumps(asked | more)]
    printed = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
    return [json.loads(line) for line in printed.stdout.splitlines()]


class Ours:
    """Calls of flexlash for one kind of inputs, and what they ask of the spread."""

    def __init__(self, kind, ask):
        self._inputs = inputs_of(kind)
        self._ask = ask

    def answer(self, lines, seed):
        """Return what a whole call answers."""
        return self._ask(propagate(wind_up, self._inputs, samples=lines, seed=seed))

    def size(self, seed):
        """Return how many lines the engine takes of itself."""
        return propagate(wind_up, self._inputs, seed=seed).size

    def needed(self, error, wanted, seeds):
        """Return the lines, doubled from 8, that are quickest among those enough, their error, and the median time.

        Enough is a root mean square error over seeds as wanted. More lines than the fewest may be quicker: the engine
        has two ways.
        """

        def error_of(lines):
            return root_mean_square([error(self.answer(lines, seed)) for seed in range(seeds)])

        lines = 8
        while (found := error_of(lines)) > wanted:
            if lines == MOST:
                raise SystemExit(f"{MOST} lines leave an error of {found:.1e}, {wanted:g} was wanted")
            lines *= 2
        enough = {lines: found} | {lines << more: error_of(lines << more) for more in (1, 2, 3)}
        times = dict(zip(enough, self.timed(*enough), strict=True))
        quickest = min((lines for lines, found in enough.items() if found <= wanted), key=times.__getitem__)
        return quickest, enough[quickest], times[quickest]

    def timed(self, *ways):
        """Return the median processor time of several numbers of lines, called in turn."""
        times = [[] for _ in ways]
        for call in range(CALLS):
            for place, lines in enumerate(ways):
                start = time.process_time()
                self.answer(lines, 1000 + call)
                times[place].append(time.process_time() - start)
        return [statistics.median(one) for one in times]


def percentile_part(openturns, seeds):
    """Print the table of time to an accurate percentile."""
    print("\n## P99.865 to 1e-3 sd\n")
    print("| inputs | tool | lines or points | error/sd | s | numpy / this | goal | |")
    print("|---|---|---:|---:|---:|---:|---:|---|")
    notes = []
    for kind, goal in GOALS.items():
        law, finer = (WindUpLaw(inputs_of(kind), fine=fine) for fine in (1, 2))
        (coarse,), (truth,) = (one.quantile([PROBABILITY]) for one in (law, finer))
        sd = finer.moments[1]
        notes.append(
            f"{kind}: P99.865 = {truth:.10e}, sd = {sd:.6e}; twice the nodes move it {(truth - coarse) / sd:+.0e} sd"
        )
        peers = {"numpy": lambda runs, kind=kind: numpy_runs(kind, runs)}
        if openturns:
            peers["OpenTURNS Monte Carlo"] = lambda runs, kind=kind: openturns_runs(
                openturns, kind, "percentile", runs, probability=PROBABILITY
            )
        rows, told = plain(peers, truth, sd, PER_SEED * seeds)
        notes += [f"{kind}, {line}" for line in told]
        ours = Ours(kind, lambda spread: spread.quantile(PROBABILITY))
        lines, error, fixed = ours.needed(lambda value, truth=truth, sd=sd: (value - truth) / sd, WANTED, seeds)
        (adaptive,) = ours.timed(None)
        taken = statistics.median(ours.size(seed) for seed in range(seeds))
        own = root_mean_square([(ours.answer(None, seed) - truth) / sd for seed in range(seeds)])
        rows = {"flexlash": (lines, error, fixed), "flexlash, lines of itself": (taken, own, adaptive), **rows}
        base = rows["numpy"][2]
        for label, (number, off, seconds) in rows.items():
            verdict = f"{goal:,} | {'met' if base / fixed >= goal else 'missed'}" if label == "flexlash" else " | "
            print(
                f"| {kind} | {label} | {number:,.0f} | {off:.1e} | {seconds:.4g} | {base / seconds:,.3g} | {verdict} |",
                flush=True,
            )
    print("\nPoints of the peers are extrapolated by 1/√n from the errors measured below, then run in full.")
    print(*notes, sep="\n")


def plain(peers, truth, sd, seeds):
    """Return the rows of plain Monte Carlo by label: points needed, error there, best time; and notes.

    All are the same estimator, so that what all their runs say of error·√n counts for each.
    """
    constants, notes = [], []
    for label, runs_of in peers.items():
        for size in SIZES:
            answers = runs_of([(seed, size) for seed in range(1, seeds + 1)])
            error = root_mean_square([(answer - truth) / sd for answer, _ in answers])
            constants.append(error * math.sqrt(size))
            notes.append(
                f"{label}: error {error:.2e} sd at n = {size:,} (error·√n = {constants[-1]:.2f}, {seeds} seeds)"
            )
    needed = math.ceil((root_mean_square(constants) / WANTED) ** 2)
    rows = {}
    for label, runs_of in peers.items():
        full = runs_of([(10_001, needed), (10_002, needed)])
        rows[label] = (needed, WANTED, min(seconds for _, seconds in full))
        notes.append(
            f"{label}: the full runs are off by {', '.join(f'{(one - truth) / sd:+.1e}' for one, _ in full)} sd"
        )
    return rows, notes


def probability_part(openturns, seeds):
    """Print the table of time to an accurate probability."""
    print("\n## P(over) to 1 %\n")
    print("| inputs | P | tool | lines or points | error/P | ms | this / flexlash | goal | |")
    print("|---|---:|---|---:|---:|---:|---:|---:|---|")
    for kind, goal in RARE_GOALS.items():
        law = WindUpLaw(inputs_of(kind), fine=2)
        for share, limit in zip(RARE, law.quantile(1 - np.array(RARE)), strict=True):
            ours = Ours(kind, lambda spread, limit=limit: spread.probability_above(limit))
            lines, error, own = ours.needed(lambda value, share=share: value / share - 1, RELATIVE, seeds)
            start = f"| {kind} | {share:g} |"
            print(f"{start} flexlash | {lines:,} | {error:.2%} | {own * 1e3:.3g} | 1 | | |", flush=True)
            for method, block in PEERS if openturns else ():
                label = f"OpenTURNS {PEER_NAMES[method]}, blocks of {block:,}"
                needed, reached, seconds = form_and_sampling(openturns, kind, method, block, limit, share, seeds)
                if seconds is None:
                    print(f"{start} {label} | {needed:,} | {reached:.2%} | | | | left out |")
                    continue
                ratio = seconds / own
                verdict = f"{goal} | {'met' if ratio >= goal else 'missed'}" if method == "importance" else " | "
                numbers = f"{needed:,} | {reached:.2%} | {seconds * 1e3:.3g} | {ratio:.3g} | {verdict}"
                print(f"{start} {label} | {numbers} |", flush=True)


def form_and_sampling(openturns, kind, method, block, limit, share, seeds):  # noqa: PLR0917
    """Return points needed by a peer, the error that they leave, and the median time of whole calls with them."""

    def runs(first, count, block, size):
        wanted = [(seed, method, block, size) for seed in range(first, first + count)]
        return openturns_runs(openturns, kind, "probability", wanted, limit=limit)

    def error(answers):
        return root_mean_square([answer / share - 1 for answer, _ in answers])

    few = error(runs(1, PER_SEED * seeds, 1000, IMPORTANCE))
    needed = math.ceil(IMPORTANCE * (few / RELATIVE) ** 2)
    if needed > HOPELESS:
        return needed, few, None
    full = runs(1001, seeds, min(block, needed), needed)
    return needed, error(full), statistics.median(seconds for _, seconds in full)


def main():
    """Measure what the options ask for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--openturns", metavar="PYTHON", help="interpreter that has OpenTURNS and numpy")
    parser.add_argument("--seeds", type=int, default=40, help="seeds behind each error measured")
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=PARTS, help="parts to run")
    parser.add_argument("--rows", type=int, nargs="+", default=[1000, 10_000, 100_000], help="numbers of rows")
    parser.add_argument("--one", nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        spread_once(int(options.one[1]), options.one[0])
        return
    if len(options.parts) > 1:
        # Each in a process of its own: memory that a part has used would be told of the next one's.
        more = ["--openturns", options.openturns] if options.openturns else []
        more += ["--seeds", str(options.seeds), "--rows", *map(str, options.rows)]
        for part in options.parts:
            subprocess.run([sys.executable, __file__, "--parts", part, *more], check=True)
    elif options.parts == ["rows"]:
        throughput(options.rows, __file__)
    else:
        one = percentile_part if options.parts == ["percentile"] else probability_part
        one(options.openturns, options.seeds)
        if not options.openturns:
            print("\nOpenTURNS skipped: name an interpreter that has it by --openturns.")


PARTS = ("percentile", "probability", "rows")


if __name__ == "__main__":
    main()
