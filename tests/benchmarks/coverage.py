"""How often 1.96 standard errors to both sides cover the truth.

    python tests/benchmarks/coverage.py [--seeds SEEDS] [--jobs JOBS] [CASE ...]

Every case is a model with its inputs, spread with each of many seeds by 64 lines, by 256 lines, and by as many as
the engine takes of itself. Covered should be 95 %: of the mean, the standard deviation, five percentiles, and the
probability over P99.865, which comes with its interval. The truth of a sum is exact, from the characteristic
function, as are mean and standard deviation of a product; other truths are the means of several runs with very many
lines, and their own error is combined with the one tested.
"""

from __future__ import annotations

import argparse
import math
import os
from concurrent.futures import ProcessPoolExecutor

import numpy as np
from scipy.optimize import brentq
from scipy.special import ndtr, ndtri, wofz

from flexlash.tolerance import Normal, Triangular, TruncatedNormal, Uniform, propagate

PROBABILITIES = np.array([0.00135, 0.025, 0.5, 0.975, 0.99865])
TESTED = ("P0.135", "P2.5", "P50", "P97.5", "P99.865", "mean", "sd", "prob.")
SAMPLES = (64, 256, None)
TRUE_LINES, TRUE_RUNS = 1 << 15, 4
LOW = 0.91
"""Shares covered below this are listed."""
ROUNDING = 1e-10
"""Error of an exact truth, in standard deviations."""

_TERMS = 1 << 17
_FIRST_SEED = 10_000_000
"""Of the runs for the truth; those tested count from 0."""


def total(**inputs):
    """Return the sum."""
    first, *others = inputs.values()
    return sum(others, first)


def product(**inputs):
    """Return the product of 1 + 0.02 x."""
    return math.prod(1 + 0.02 * one for one in inputs.values())


def wind_up(l, wall, disk, r_m, r_ci, E, nu):  # noqa: E741, N803, PLR0917
    """Return twice the wind-up [rad] of a cup at 800 N·m."""
    square = r_m * r_m
    shape = l / (square * r_m * wall) + (1 / (r_ci * r_ci) - 1 / square) / (2 * disk)
    return 1600 / math.pi * (1 + nu) / E * shape


def alike(count, one):
    """Return inputs of one kind, `one` of them by its place."""
    return {f"x{place}": one(place) for place in range(count)}


def normal(_):
    """Return a standard normal."""
    return Normal(0, 1)


def uniform(_):
    """Return a uniform distribution of half width 1."""
    return Uniform(-1, 1)


def triangular(_):
    """Return a triangle of half width 1."""
    return Triangular(-1, 1)


def truncated(_):
    """Return a normal cut at two standard deviations."""
    return TruncatedNormal(0, 1, -2, 2)


MIXED = {
    "x0": Normal(0, 1),
    "x1": Uniform(-2, 2),
    "x2": Triangular(-2, 2),
    "x3": TruncatedNormal(0, 1, -1, 1),
    "x4": Normal(0, 0.5),
}
REFERENCE = {
    "l": Uniform(0.1598, 0.1602),
    "wall": Uniform(0.00155, 0.00165),
    "disk": Uniform(0.00155, 0.00165),
    "r_m": Normal(0.08, 2e-5),
    "r_ci": Uniform(0.03985, 0.04015),
    "E": Normal(211e9, 2.11e9),
    "nu": Uniform(0.28, 0.32),
}
CASES = {
    "product of 2 normal": (product, alike(2, normal)),
    "product of 7 normal": (product, alike(7, normal)),
    "product of 14 normal": (product, alike(14, normal)),
    "sum of 2 uniform": (total, alike(2, uniform)),
    "sum of 4 uniform": (total, alike(4, uniform)),
    "sum of 14 uniform": (total, alike(14, uniform)),
    "sum of 3 triangular": (total, alike(3, triangular)),
    "product of 8 triangular": (product, alike(8, triangular)),
    "sum of 5 truncated": (total, alike(5, truncated)),
    "sum, mixed": (total, MIXED),
    "product, mixed": (product, MIXED),
    "uniform 100:1 to 4 uniform": (total, {"y": Uniform(-100, 100), **alike(4, uniform)}),
    "triangular 100:1 to 4": (total, {"y": Triangular(-100, 100), **alike(4, triangular)}),
    "uniform 100:1 to 4 normal": (total, {"y": Uniform(-100, 100), **alike(4, normal)}),
    "normal 100:1 to 4 uniform": (total, {"y": Normal(0, 100), **alike(4, uniform)}),
    "product, 1 uniform of 6": (product, {"y": Uniform(-2, 2), **alike(5, normal)}),
    "product, 1 triangular of 4": (product, {"y": Triangular(-4, 4), **alike(3, normal)}),
    "sum, 1 skew truncated of 3": (total, {"y": TruncatedNormal(0, 1, -0.5, 3), **alike(2, normal)}),
    "wind-up, 5 uniform of 7": (wind_up, REFERENCE),
}


def characteristic(one, at):
    """Return the characteristic function of a distribution about its expectation."""
    if isinstance(one, Normal):
        return np.exp(-((one.sd * at) ** 2) / 2)
    if isinstance(one, Uniform):
        return np.sinc((one.high - one.low) / (2 * np.pi) * at)
    if isinstance(one, Triangular):
        return np.sinc((one.high - one.low) / (4 * np.pi) * at) ** 2
    tail = np.exp(-((one.sd * at) ** 2) / 2)
    cuts = [(end - one.mean) / one.sd for end in (one.low, one.high)]
    below = []
    for cut in cuts:
        # exp(−s²/2)·Φ(cut − i·s), by the Faddeeva function of the upper half plane.
        turned = np.exp(-cut * cut / 2 + 1j * cut * one.sd * at) / 2
        root = (one.sd * at + 1j * abs(cut)) / math.sqrt(2)
        below.append(turned * wofz(-root.conj()) if cut < 0 else tail - turned * wofz(root))
    share = ndtr(cuts[1]) - ndtr(cuts[0])
    return (below[1] - below[0]) / share * np.exp(1j * (one.mean - one.expectation) * at)


def exact_quantiles(inputs):
    """Return quantiles of a sum: its distribution function as a Fourier series over a range that holds it all."""
    mean, sd = exact_moments(total, inputs)
    reach = sum(9 * one.sd if isinstance(one, Normal) else one.high - one.low for one in inputs.values())
    at = np.arange(1, _TERMS) * (np.pi / reach)
    factor = math.prod((characteristic(one, at) for one in inputs.values()), start=1 / (at * reach))

    def above_share(output, share):
        return 0.5 + output / (2 * reach) - (factor * np.exp(-1j * at * output)).imag.sum() - share

    return [mean + brentq(above_share, -reach, reach, args=(share,), xtol=1e-13 * sd) for share in PROBABILITIES]


def exact_moments(model, inputs):
    """Return mean and standard deviation of a sum or product."""
    moments = [(one.expectation, one.standard_deviation) for one in inputs.values()]
    if model is total:
        return sum(mean for mean, _ in moments), math.hypot(*(sd for _, sd in moments))
    mean = math.prod(1 + 0.02 * one for one, _ in moments)
    return mean, mean * math.sqrt(math.prod(1 + (0.02 * sd / (1 + 0.02 * one)) ** 2 for one, sd in moments) - 1)


def statistics_of(spread, limit):
    """Return what is tested and its standard errors; the probability on the normal scale, as its interval is."""
    low, high = ndtri(np.maximum(spread.probability_interval(limit), 1e-300))
    values = [*spread.quantile(PROBABILITIES), spread.mean, spread.sd, (low + high) / 2]
    errors = [*spread.standard_error(PROBABILITIES), spread.mean_standard_error, spread.sd_standard_error]
    return np.array(values), np.array([*errors, (high - low) / (2 * 1.96)])


def truth_of(model, inputs):
    """Return limit, true values of what is tested, their standard errors, and the standard deviation."""
    runs = [propagate(model, inputs, samples=TRUE_LINES, seed=_FIRST_SEED + run) for run in range(TRUE_RUNS)]
    limit = float(exact_quantiles(inputs)[-1] if model is total else np.mean([run.quantile(0.99865) for run in runs]))
    values, errors = (np.array(found) for found in zip(*(statistics_of(run, limit) for run in runs), strict=True))
    value, error = values.mean(axis=0), np.sqrt((errors**2).sum(axis=0)) / TRUE_RUNS
    sd = value[6]
    rounding = ROUNDING * np.array([*(7 * [sd]), 1.0])
    if model is not wind_up:
        value[5:7], error[5:7] = exact_moments(model, inputs), 0
    if model is total:
        value[:5], value[7], error[:] = exact_quantiles(inputs), ndtri(1 - PROBABILITIES[-1]), 0
    return limit, value, np.maximum(error, rounding), sd


def covered(name, seeds):
    """Return the lines to print of a case and, for each number of lines, the shares covered."""
    model, inputs = CASES[name]
    limit, truth, own, sd = truth_of(model, inputs)
    told, shares = [], []
    for samples in SAMPLES:
        hits, sizes, precision = np.zeros(len(TESTED)), [], []
        for seed in range(seeds):
            spread = propagate(model, inputs, samples=samples, seed=seed)
            values, errors = statistics_of(spread, limit)
            hits += np.abs(values - truth) <= 1.96 * np.hypot(errors, own)
            sizes.append(spread.size)
            precision.append(errors[:5].max() / sd)
        shares.append(hits / seeds)
        numbers = "".join(f"{share:8.1%}" for share in shares[-1])
        told.append(f"{name:28}{samples or 'auto':>5}{np.median(sizes):7,.0f}{np.mean(precision):9.1e}{numbers}")
    return told, np.array(shares)


def main():
    """Print the shares covered of each case and of all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="CASE", help="all of them unless named")
    parser.add_argument("--seeds", type=int, default=400, help="seeds of each case")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="processes")
    options = parser.parse_args()
    print(f"{'case':28}{'lines':>12}{'s.e./sd':>9}" + "".join(f"{name:>8}" for name in TESTED))
    every = []
    names = options.cases or list(CASES)
    with ProcessPoolExecutor(options.jobs) as pool:
        for told, shares in pool.map(covered, names, [options.seeds] * len(names)):
            print(*told, sep="\n", flush=True)
            every.append(shares)
    for place, samples in enumerate(SAMPLES):
        found = np.array(every)[:, place]
        numbers = "".join(f"{share:8.1%}" for share in found.mean(axis=0))
        print(f"{'all cases':28}{samples or 'auto':>5}{'':16}{numbers}")
        print(f"{'':28}{found.mean():.2%} of all, {found.min():.1%} of the least")
    low = np.argwhere(np.array(every) < LOW)
    for case, place, tested in low:
        share = every[case][place, tested]
        print(f"below {LOW:.0%}: {TESTED[tested]} of {names[case]} by {SAMPLES[place] or 'auto'} lines, {share:.1%}")
    print(f"A share found is uncertain by {math.sqrt(0.05 * 0.95 / options.seeds):.1%} (one standard error).")


if __name__ == "__main__":
    main()
