"""How often the numbers of a report's rows lie within 1.96 of their standard errors of the truth.

    python tests/benchmarks/coverage_rows.py [--rows ROWS] [--seed SEED] [--jobs JOBS]

Rows are drawn at random as engineers might enter them: cups, plain or with fillets, taper and rim, and cylinders, with
tolerances of all sizes and distributions, some three times as wide. They go through the spread stage of a report. The
truth is the mean over scrambled Sobol' points of all dimensions but Young's modulus, given which the distribution is
exact, since the backlash is inverse to it; its own error is combined with the one tested. Listed are rows that lie more
than `FAR` errors off, which chance does to one number in 30,000, and what each row has cost.
"""

from __future__ import annotations

import argparse
import math
import os
import random
from concurrent.futures import ProcessPoolExecutor
from functools import partial

import numpy as np
from exact_laws import sobol_scores, values_at
from scipy.optimize import brentq
from scipy.special import ndtr, ndtri
from wind_up_law import above_of

from flexlash.analysis.tolerance_spread import row_statistics
from flexlash.mechanics.flexspline import backlash
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.variant import Limits
from flexlash.tolerance import TruncatedNormal
from flexlash.tolerance.dimension_limits import distributions
from flexlash.tolerance.row_batches import TolerancedRow
from flexlash.tolerance.sampling import SamplingPlan

PROBABILITIES = {"p0_135": 0.00135, "p2_5": 0.025, "p50": 0.5, "p97_5": 0.975, "p99_865": 0.99865}
TESTED = (*PROBABILITIES, "mean", "sd", "probability_over_limit")
FAR = 4.2
RAREST = 1e-6
"""Probability over the limit below which the points do not know it well enough."""
LOG2_POINTS, REPLICATES = 15, 16
WIDTHS = {
    "cylinder_length": (1e-3, 1e-2),
    "mean_radius": (1e-4, 2e-3),
    "wall_thickness": (5e-3, 6e-2),
    "disk_thickness": (5e-3, 6e-2),
    "disk_hub_thickness": (5e-3, 6e-2),
    "disk_inner_radius": (1e-3, 1e-2),
    "rim_length": (5e-3, 5e-2),
    "rim_thickness": (5e-3, 5e-2),
    "hub_fillet_radius": (2e-2, 2e-1),
    "junction_fillet_radius": (2e-2, 2e-1),
    "youngs_modulus": (5e-3, 4e-2),
    "poisson_ratio": (1e-2, 7e-2),
    "cylinder_calibration": (5e-3, 4e-2),
    "disk_calibration": (5e-3, 4e-2),
}
"""Half of a tolerance as part of the size, from and to."""
KINDS = ("normal", "truncated normal", "uniform", "triangular")


def drawn_row(number, seed):
    """Return a row at random."""
    source = random.Random(f"{seed} {number}")  # noqa: S311
    radius = source.uniform(0.015, 0.125)
    wall = radius * source.uniform(0.02, 0.03)
    sizes = {
        "torque": radius**3 * 1.6e6,
        "cylinder_length": radius * source.uniform(1, 2),
        "mean_radius": radius,
        "wall_thickness": wall,
        "youngs_modulus": source.uniform(190e9, 215e9),
        "poisson_ratio": source.uniform(0.27, 0.31),
        "cylinder_calibration": 1.0,
    }
    kind = source.choice(("cup", "cup", "cylinder"))
    if kind == "cup":
        sizes |= {"disk_inner_radius": radius * source.uniform(0.35, 0.6), "disk_outer_radius": radius}
        sizes |= {"disk_thickness": wall * source.uniform(1, 1.5), "disk_calibration": 1.0}
        if source.random() < 1 / 3:
            sizes |= {"rim_length": radius / 5, "rim_thickness": 2 * wall, "junction_fillet_radius": wall}
            sizes |= {"hub_fillet_radius": wall, "disk_hub_thickness": 1.5 * sizes["disk_thickness"]}
    wide = 3 if source.random() < 1 / 8 else 1
    shared = source.choice((*KINDS, None, None))
    limits = {}
    for name, (least, most) in WIDTHS.items():
        if name in sizes and (name == "youngs_modulus" or source.random() < 3 / 4):
            half = sizes[name] * min(wide * math.exp(source.uniform(math.log(least), math.log(most))), 0.3)
            distribution = shared or source.choice(KINDS)
            shift = half * source.choice((0, 0, 0.2, -0.3)) if "normal" in distribution else 0.0
            limits[name] = Limits(
                low=sizes[name] - half, high=sizes[name] + half, distribution=distribution, mean_shift=shift
            )
    ordered = {name: limits[name] for name in DIMENSIONS if name in limits}
    model = MODELS[kind]
    middle = float(model(sizes))
    return TolerancedRow(model=model, nominal=sizes, limits=ordered, upper_limit=middle * source.uniform(1.01, 1.15))


MODELS = {kind: partial(backlash, kind) for kind in ("cup", "cylinder")}
"""One of a kind, since rows are alike only where they have the same."""


def above_modulus(one, value):
    """Return the probability that Young's modulus lies above values."""
    if isinstance(one, TruncatedNormal):
        low, high, at = ((end - one.mean) / one.sd for end in (one.low, one.high, np.clip(value, one.low, one.high)))
        return (ndtr(high) - ndtr(at)) / (ndtr(high) - ndtr(low))
    return above_of(one, value)


class RowTruth:
    """The law of one row's backlash."""

    def __init__(self, row):
        inputs = distributions(row.limits)
        self._modulus = inputs["youngs_modulus"]
        middle = self._modulus.expectation
        others = [name for name in inputs if name != "youngs_modulus"]
        scores = sobol_scores(max(len(others), 1), LOG2_POINTS, REPLICATES)
        sizes = {name: np.full(scores.shape[:2], size) for name, size in row.nominal.items()}
        sizes |= {name: values_at(inputs[name], scores[..., place]) for place, name in enumerate(others)}
        sizes["youngs_modulus"] = np.full(scores.shape[:2], middle)
        self._factor = row.model(sizes) * middle
        nodes = np.linspace(-8.5, 8.5, 4001)
        weights = np.exp(-(nodes**2) / 2)
        inverse = 1 / values_at(self._modulus, nodes)
        self._inverse = [weights @ inverse**power / weights.sum() for power in (1, 2)]

    def below(self, value):
        """Return the probability below a value by each replicate."""
        return above_modulus(self._modulus, self._factor / value).mean(axis=1)

    def statistics(self, limit):
        """Return the statistics tested and their standard errors, the probability on the normal scale."""
        raw = [inverse * (self._factor**power).mean(axis=1) for power, inverse in enumerate(self._inverse, start=1)]
        sds = np.sqrt(raw[1] - raw[0] ** 2)
        mean, sd = raw[0].mean(), sds.mean()
        found = [self._quantile(share, mean, sd) for share in PROBABILITIES.values()]
        found += [(one.mean(), one.std(ddof=1) / math.sqrt(REPLICATES)) for one in (raw[0], sds)]
        above = 1 - self.below(limit)
        if RAREST < above.mean() < 1 - RAREST and above.std() < 0.1 * min(above.mean(), 1 - above.mean()):
            scores = ndtri(above)
            found.append((scores.mean(), scores.std(ddof=1) / math.sqrt(REPLICATES)))
        else:
            found.append((np.nan, np.nan))
        return np.array(found).T

    def _quantile(self, share, mean, sd):
        low, high = mean - 9 * sd, mean + 9 * sd
        root = brentq(lambda value: self.below(value).mean() - share, low, high, xtol=1e-9 * sd)
        ends = [self.below(root + side * 1e-3 * sd).mean() for side in (-1, 1)]
        density = (ends[1] - ends[0]) / (2e-3 * sd)
        return root, self.below(root).std(ddof=1) / math.sqrt(REPLICATES) / density


def told(statistics):
    """Return the same of a row's statistics."""
    numbers = statistics.numbers
    pairs = [(numbers[name], numbers[f"{name}_standard_error"]) for name in TESTED[:-1]]
    ends = [numbers[f"probability_over_limit_{end}"] for end in ("low", "high")]
    low, high = ndtri(np.clip(ends, 1e-300, 1 - 1e-16))
    return np.array([*pairs, ((low + high) / 2, (high - low) / (2 * 1.96))]).T


def deviations(row, statistics):
    """Return deviations over errors, and the errors told in standard deviations."""
    value, own = RowTruth(row).statistics(row.upper_limit)
    found, error = told(statistics)
    scale = np.array([*(7 * [value[6]]), 1.0])
    return (found - value) / np.hypot(np.hypot(error, own), 1e-7 * scale), error / scale, own / scale


def main():
    """Print the shares covered over all rows, and the rows that are far off."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rows", type=int, default=200, help="rows to draw")
    parser.add_argument("--seed", default="1", help="seed they are drawn with")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="processes")
    options = parser.parse_args()
    rows = [drawn_row(number, options.seed) for number in range(options.rows)]
    statistics = dict(row_statistics(rows, SamplingPlan(method="line", inputs=tuple(DIMENSIONS)), 1))
    with ProcessPoolExecutor(options.jobs) as pool:
        found = list(pool.map(deviations, rows, [statistics[index] for index in range(len(rows))], chunksize=8))
    off, errors, own = (np.array(part) for part in zip(*found, strict=True))
    print("".join(f"{name[:12]:>13}" for name in TESTED))
    known = ~np.isnan(off)
    covered = (abs(off) <= 1.96).sum(axis=0) / known.sum(axis=0)
    print("".join(f"{share:13.1%}" for share in covered), " covered")
    print("".join(f"{error:13.1e}" for error in np.nanmedian(errors, axis=0)), " error told / sd, median")
    print("".join(f"{error:13.1e}" for error in np.nanmedian(own, axis=0)), " the truth's, median")
    print("".join(f"{mean:13.2f}" for mean in np.nanmean(off, axis=0)), " mean deviation / error")
    print(f"{(abs(off) <= 1.96).sum() / known.sum():.2%} of all; greatest deviation {np.nanmax(abs(off)):.1f} errors")
    for index in np.flatnonzero((abs(off) > FAR).any(axis=1)):
        kinds = {name: limits.distribution for name, limits in rows[index].limits.items()}
        numbers = statistics[index].numbers
        print(f"row {index}: {dict(zip(TESTED, off[index].round(1).tolist(), strict=True))}")
        print(f"    {numbers['spread_points']:.0f} {statistics[index].texts}, {kinds}")
    sizes = [f"{one.texts['spread_method']} {one.numbers['spread_points']:.0f}" for one in statistics.values()]
    print("taken:", ", ".join(f"{size}: {sizes.count(size)}" for size in sorted(set(sizes))))


if __name__ == "__main__":
    main()
