"""How often the interval that n measured parts leave holds the true share over the limit and the true P99.865.

    python tests/benchmarks/measured_coverage.py [--repeats REPEATS] [--jobs JOBS] [--parts N …]

A process is known: one or two measured dimensions, normal, skewed (gamma, skewness 1) or uniform, beside others that
are known. Again and again n parts of it are measured, and the row is spread as a report would: with the sample taken as
normal or as measured. Listed is for each case how often in a hundred the interval held the truth, how often the truth
was worse than told (the side that harms) and better, and how wide the interval is at the middle of all repeats, in
normal scores of the share and in true standard deviations of the backlash. The truth comes from quadrature over the
measured dimensions. By 1,000 repeats a coverage of 95 % is known to 0.7.
"""

from __future__ import annotations

import argparse
import os
from dataclasses import replace
from functools import partial

import numpy as np
from scipy import stats
from scipy.optimize import brentq
from scipy.special import ndtri

from flexlash.analysis.tolerance_spread import row_statistics
from flexlash.mechanics.flexspline import backlash
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.variant import Limits, MeasuredDimension
from flexlash.tolerance.row_batches import TolerancedRow, batch_statistics
from flexlash.tolerance.sampling import SamplingPlan

PARTS = (10, 20, 60, 200)
SHARES = (0.02, 0.00135, 1e-4)
"""True shares over the limit; at the middle one the limit is P99.865."""
PROCESSES = {
    "normal": stats.norm(),
    "skewed": stats.gamma(4.0, loc=-2.0, scale=0.5),
    "skewed down": stats.gamma(4.0, loc=-2.0, scale=0.5),
    "uniform": stats.uniform(-(3**0.5), 2 * 3**0.5),
}
"""Processes with the mean 0 and the standard deviation 1; the third is taken the other way round."""
PLAN = SamplingPlan(method="line", inputs=tuple(DIMENSIONS))
SIDES = ("low", "high")
NODES = 80


def summed(dimensions):
    """Return a sum of dimensions, in standard deviations of a measured one."""
    return 20.0 + dimensions["wall_thickness"] + dimensions["disk_thickness"] + dimensions["cylinder_length"]


def sum_of_three(measured):
    """Return a sum of which one or two dimensions are measured and the rest is known."""
    limits = {
        name: Limits(low=-4.0 * sd, high=4.0 * sd, sd=sd)
        for name, sd in (("cylinder_length", 0.5), ("wall_thickness", 1.0), ("disk_thickness", 1.0))
        if name in measured or name == "cylinder_length"
    }
    return TolerancedRow(
        model=summed, nominal=dict.fromkeys(("cylinder_length", "wall_thickness", "disk_thickness"), 0.0), limits=limits
    )


def flexspline(measured):
    """Return a cup of which wall, or wall and disk, are measured, with tolerances of 2.5 % that curve the backlash."""
    nominal = {
        "torque": 800.0,
        "cylinder_length": 0.16,
        "mean_radius": 0.08,
        "wall_thickness": 1.6e-3,
        "youngs_modulus": 209e9,
        "poisson_ratio": 0.29,
        "disk_inner_radius": 0.037,
        "disk_outer_radius": 0.08,
        "disk_thickness": 1.6e-3,
        "cylinder_calibration": 1.0,
        "disk_calibration": 1.0,
    }
    spreads = {"cylinder_length": 1e-4, "youngs_modulus": 209e9 * 0.004} | dict.fromkeys(measured, 1.6e-3 * 0.025)
    limits = {
        name: Limits(low=nominal[name] - 4 * spreads[name], high=nominal[name] + 4 * spreads[name], sd=spreads[name])
        for name in nominal
        if name in spreads
    }
    return TolerancedRow(model=partial(backlash, "cup"), nominal=nominal, limits=limits)


MODELS = {"sum": sum_of_three, "cup": flexspline}
MEASURED = (("wall_thickness",), ("wall_thickness", "disk_thickness"))


def drawn(process, scores):
    """Return standardised values of a process at probabilities."""
    law = PROCESSES[process]
    return -law.ppf(1 - scores) if process == "skewed down" else law.ppf(scores)


class Truth:
    """The law of a row whose measured dimensions follow a process."""

    def __init__(self, row, measured, process):
        self._row, self._measured = row, measured
        # By scores, so that the tails of the process have nodes of their own.
        nodes = np.linspace(-6.0, 6.0, NODES)
        weights = stats.norm.pdf(nodes)
        self._weights = weights / weights.sum()
        self._values = drawn(process, stats.norm.cdf(nodes))

    def above(self, limit):
        """Return the true share above a limit."""
        grids = np.meshgrid(*[self._values] * len(self._measured), indexing="ij")
        weights = np.ones(())
        for _ in self._measured:
            weights = np.multiply.outer(weights, self._weights)
        rows = []
        for values in zip(*(grid.ravel() for grid in grids), strict=True):
            exact = {}
            for name, value in zip(self._measured, values, strict=True):
                one = self._row.limits[name]
                exact[name] = one.mean + value * one.standard_deviation
            limits = {name: limit for name, limit in self._row.limits.items() if name not in exact}
            rows.append(replace(self._row, nominal={**self._row.nominal, **exact}, limits=limits, upper_limit=limit))
        over = np.array([one.numbers["probability_over_limit"] for one in batch_statistics(rows, PLAN)])
        return float((weights.ravel() * over).sum())

    def limit(self, share, low, high):
        """Return the limit that so many units exceed."""
        return brentq(lambda limit: ndtri(self.above(limit)) - ndtri(share), low, high, rtol=1e-7)


def sampled(row, case, generator):
    """Return a row as it is known from measured parts."""
    _, measured, process, taken, parts = case
    limits = dict(row.limits)
    for name in measured:
        true = limits[name]
        values = true.mean + true.standard_deviation * drawn(process, generator.random(parts))
        sample = MeasuredDimension(sample=name, dimension=name, values=tuple(values), parts=tuple(range(parts)))
        limits[name] = replace(
            true, distribution=taken, mean_shift=values.mean() - true.middle, sd=values.std(ddof=1), sample=sample
        )
    return replace(row, limits=limits)


def told(case, limits, sd, repeats, jobs):
    """Print the coverage of one case."""
    model, measured, process, taken, parts = case
    row = MODELS[model](measured)
    generator = np.random.default_rng(parts)
    known = [sampled(row, case, generator) for _ in range(repeats)]
    rows = [replace(one, upper_limit=limit) for one in known for limit in limits.values()]
    found = dict(row_statistics(rows, PLAN, jobs))
    lines = []
    for place, (share, limit) in enumerate(limits.items()):
        numbers = [found[index].numbers for index in range(place, len(rows), len(limits))]
        low, high = (np.array([one[f"probability_over_limit_sample_{end}"] for one in numbers]) for end in SIDES)
        width = np.median(np.diff(ndtri(np.clip([low, high], 1e-14, 1 - 1e-14)), axis=0))
        lines.append((f"P = {share:g}", high < share, low > share, width))
        if share == SHARES[1]:
            low, high = (np.array([one[f"p99_865_sample_{end}"] for one in numbers]) for end in SIDES)
            lines.append(("P99.865", high < limit, low > limit, np.median(high - low) / sd))
    for what, worse, better, width in lines:
        held = 100 * (1 - worse.mean() - better.mean())
        print(
            f"{model:5} {len(measured)} {process:12} {taken:9} {parts:4} {what:11} {held:6.1f} "
            f"{100 * worse.mean():7.1f} {100 * better.mean():7.1f} {width:7.2f}",
            flush=True,
        )


def main():
    """Print the coverage of every case."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=1000, help="samples of each case")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="processes")
    parser.add_argument("--parts", type=int, nargs="+", default=PARTS, help="parts measured")
    parser.add_argument("--processes", nargs="+", default=list(PROCESSES), help="of these processes")
    parser.add_argument("--taken", nargs="+", default=["normal", "measured"], help="samples taken as")
    parser.add_argument("--dimensions", type=int, nargs="+", default=[1, 2], help="measured dimensions")
    parser.add_argument("--models", nargs="+", default=list(MODELS), help="of these models")
    options = parser.parse_args()
    print("model dims process   taken as  parts             held %  worse  better   width")
    for model in options.models:
        for measured in (MEASURED[number - 1] for number in options.dimensions):
            for process in options.processes:
                row = MODELS[model](measured)
                plain = batch_statistics([row], PLAN)[0].numbers
                truth = Truth(row, measured, process)
                mean, sd = plain["mean"], plain["sd"]
                limits = {share: truth.limit(share, mean + sd / 2, mean + 7 * sd) for share in SHARES}
                for taken in options.taken:
                    for parts in options.parts:
                        told((model, measured, process, taken, parts), limits, sd, options.repeats, options.jobs)


if __name__ == "__main__":
    main()
