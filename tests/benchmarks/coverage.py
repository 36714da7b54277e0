"""How often 1.96 standard errors to both sides cover the truth.

    python tests/benchmarks/coverage.py [--seeds SEEDS] [--lines LINES ...] [--jobs JOBS] [CASE ...]

Every case of `coverage_cases` is spread with each of many seeds by 16 lines, by 64 lines, and by as many as the engine
takes of itself (0). Covered should be 95 %: of percentiles, mean, standard deviation, skewness, kurtosis, the
probability over P99.865 and over the value that one in 100,000 exceeds, the shares of variance, and what is said of
lots. Truths come from closed forms, characteristic functions and quadrature, none from the engine; what they are
uncertain by is combined with the error tested. A probability is compared on the normal scale, as its interval is made.

Listed at the end is what lies below 91 % or above 99 %, and every mean over the seeds that lies off the truth by more
than chance does once in a thousand tests.
"""

from __future__ import annotations

import argparse
import math
import os
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass

import numpy as np
from coverage_cases import cases
from exact_laws import EXACT
from scipy.special import ndtri

from flexlash.tolerance import propagate

PROBABILITIES = np.array([0.00135, 0.025, 0.5, 0.975, 0.99865])
RARE = (0.00135, 1e-5)
"""Probabilities to be found over the values that have them."""
ACCEPTABLE = 1350.0
"""Parts per million over the limit that a lot may have."""
LINES = (16, 64, 0)
LOW, HIGH = 0.91, 0.99
BIASED = 3.3
"""Standard errors of a mean over seeds beyond which it is listed."""
NOTABLE = 0.3
"""And the part of the told error that it must reach, since that covers it anyway."""
WIDE = 0.7
"""Errors found over errors told: below this the told ones are too large."""
MANY = 100
"""Seeds that it takes to say so."""
SHARP = 1e-6
"""A told error below this, in standard deviations, is not blamed for being too large."""
COLUMNS = ("P0.135", "P2.5", "P50", "P97.5", "P99.865", "mean", "sd", "skew", "kurt", "p 1e-3", "p 1e-5")
GROUPS = (*COLUMNS, "shares", "total", "within", "between", "lots")


@dataclass(frozen=True, kw_only=True)
class Found:
    """What was found of a case: by statistic the deviations and told errors of all seeds (seeds, statistics)."""

    case: str
    lines: int
    names: list[str]
    groups: list[str]
    deviations: np.ndarray
    errors: np.ndarray
    sizes: list[int]
    methods: list[str]
    seconds: list[float]

    @property
    def covered(self):
        """The share of seeds that cover the truth, by statistic."""
        return (abs(self.deviations) <= 1.96 * self.errors).mean(axis=0)

    @property
    def bias(self):
        """The mean deviation and its standard error, by statistic."""
        count = len(self.deviations)
        return self.deviations.mean(axis=0), self.deviations.std(axis=0, ddof=1) / math.sqrt(count)

    def by_group(self):
        """Return the mean share covered of each group of statistics, NaN where there are none."""
        groups, covered = np.array(self.groups), self.covered
        return np.array([covered[groups == group].mean() if group in groups else np.nan for group in GROUPS])

    def line(self):
        """Return the line to print."""
        mean, _ = self.bias
        percentiles = slice(0, len(PROBABILITIES))
        told = self.errors[:, percentiles].max(axis=1).mean()
        off = abs(mean[percentiles]).max()
        kinds = max(set(self.methods), key=self.methods.count)
        numbers = f"{np.median(self.sizes):7,.0f}{np.median(self.seconds) * 1e3:7.1f}{told:9.1e}{off:9.1e}"
        return f"{self.case:34}{self.lines or 'auto':>5} {kinds:6}{numbers}{cells(self.by_group())}"

    def doubtful(self):
        """Yield what is to be listed."""
        mean, error = self.bias
        for place, name in enumerate(self.names):
            share, told = self.covered[place], self.errors[:, place].mean()
            off = min(abs(mean[place]) / max(error[place], 1e-300), 999)
            ratio = min(math.sqrt((self.deviations[:, place] ** 2).mean()) / max(told, 1e-300), 999)
            low = share < min(LOW, 0.95 - 2.5 * chance(len(self.deviations)))
            high = share > HIGH and told > SHARP and ratio < WIDE and len(self.deviations) >= MANY
            biased = off > BIASED and abs(mean[place]) > NOTABLE * told
            if low or high or biased:
                signs = [sign for sign, wanted in (("LOW", low), ("HIGH", high), ("BIAS", biased)) if wanted]
                yield (
                    f"{'+'.join(signs):10}{self.case:34}{self.lines or 'auto':>5} {name:18}covered {share:6.1%}, "
                    f"told {told:.1e}, rms error / told {ratio:.2f}, bias {mean[place]:+.1e} ({off:.1f} of its errors)"
                )


def cells(shares):
    """Return the cells of shares covered, a dot where nothing is known."""
    return "".join("      ·" if math.isnan(share) else f"{share:7.1%}" for share in shares)


def chance(seeds):
    """Return the standard error of a share covered."""
    return math.sqrt(0.05 * 0.95 / seeds)


def expected(truth):
    """Return names, groups, true values, scales and the truth's own errors of the statistics known of a case."""
    own = truth.error
    rows = [
        (name, name, value, truth.sd, own) for name, value in zip(COLUMNS, truth.quantile(PROBABILITIES), strict=False)
    ]
    rows += [("mean", "mean", truth.mean, truth.sd, own), ("sd", "sd", truth.sd, truth.sd, own)]
    for name, value in (("skew", truth.skewness), ("kurt", truth.kurtosis)):
        rows += [(name, name, value, 1.0, 10 * own * max(1.0, abs(value)))] if value is not None else []
    rows += [(name, name, ndtri(share), 1.0, 10 * own) for name, share in zip(("p 1e-3", "p 1e-5"), RARE, strict=True)]
    for group, shares in (("shares", truth.shares), ("total", truth.total_shares)):
        rows += [(f"{group} {name}", group, share, 1.0, EXACT) for name, share in shares.items()]
    if truth.between_lots_sd is not None:
        rows += [("within", "within", truth.within_lot_sd, truth.sd, own)]
        rows += [("between", "between", truth.between_lots_sd, truth.sd, own)]
        limit = float(truth.quantile(PROBABILITIES)[-1])
        rows += [("lots", "lots", truth.lots_failing(limit, ACCEPTABLE), 1.0, EXACT)]
    return [list(column) for column in zip(*rows, strict=True)]


def told(spread, truth, limits):
    """Return what a spread says of the statistics that `expected` knows, and its standard errors."""
    pairs = list(zip(spread.quantile(PROBABILITIES), spread.standard_error(PROBABILITIES), strict=True))
    pairs += [(spread.mean, spread.mean_standard_error), (spread.sd, spread.sd_standard_error)]
    if truth.skewness is not None:
        pairs.append((spread.skewness, spread.skewness_standard_error))
    if truth.kurtosis is not None:
        pairs.append((spread.kurtosis, spread.kurtosis_standard_error))
    for limit in limits:
        low, high = ndtri(np.maximum(spread.probability_interval(limit), 1e-300))
        pairs.append(((low + high) / 2, (high - low) / (2 * 1.96)))
    pairs += [(spread.shares[name], spread.shares_standard_error[name]) for name in truth.shares]
    pairs += [(spread.total_shares[name], spread.total_shares_standard_error[name]) for name in truth.total_shares]
    if truth.between_lots_sd is not None:
        pairs += [(spread.within_lot_sd, spread.within_lot_sd_standard_error)]
        pairs += [(spread.between_lots_sd, spread.between_lots_sd_standard_error)]
        at = limits[0], ACCEPTABLE
        pairs += [(spread.lots_failing(*at), spread.lots_failing_standard_error(*at))]
    return np.array(pairs, dtype=float).T


def spread_of(case, samples, seed):
    """Return the spread of a case."""
    more = {"correlation": case.correlation, "correlation_of": case.correlation_of} if case.correlation else {}
    if case.between:
        more["between"] = case.between
    return propagate(case.model, case.inputs, samples=samples or None, seed=seed, **more)


def tested(name, lines, seeds):
    """Return what was found of a case."""
    case = cases()[name]
    truth = case.truth()
    names, groups, values, scales, own = expected(truth)
    limits = truth.quantile(1 - np.array(RARE)).tolist()
    found = []
    for samples in lines:
        deviations, errors, spreads, seconds = [], [], [], []
        for seed in range(seeds):
            start = time.process_time()
            spread = spread_of(case, samples, seed)
            spread.quantile(PROBABILITIES)
            seconds.append(time.process_time() - start)
            value, error = told(spread, truth, limits)
            deviations.append((value - values) / scales)
            errors.append(np.hypot(error / scales, own))
            spreads.append((spread.size, spread.method))
        sizes, methods = (list(column) for column in zip(*spreads, strict=True))
        found.append(
            Found(
                case=name,
                lines=samples,
                names=names,
                groups=groups,
                deviations=np.array(deviations),
                errors=np.array(errors),
                sizes=sizes,
                methods=methods,
                seconds=seconds,
            )
        )
    return found


def summary(found, lines):
    """Print the shares covered of all cases by each number of lines, and what is doubtful."""
    for samples in lines:
        chosen = [one for one in found if one.lines == samples]
        shares = np.array([one.by_group() for one in chosen])
        known = ~np.isnan(shares)
        means = [column[used].mean() if used.any() else np.nan for column, used in zip(shares.T, known.T, strict=True)]
        pooled = cells(means)
        every = np.concatenate([one.covered for one in chosen])
        print(f"{'all cases':34}{samples or 'auto':>5}{'':39}{pooled}")
        print(f"{'':34}{every.mean():.2%} of {len(every)} statistics, {every.min():.1%} of the least")
    doubtful = [line for one in found for line in one.doubtful()]
    print(*doubtful, sep="\n")
    tests = sum(len(one.names) for one in found)
    seeds = len(found[0].deviations)
    print(f"{len(doubtful)} of {tests} are doubtful; by chance {tests / 1000:.0f} of the biases would be.")
    print(f"A share of one statistic is uncertain by {chance(seeds):.1%} (one standard error).")


def main():
    """Print the shares covered of each case and of all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="CASE", help="all of them unless named")
    parser.add_argument("--seeds", type=int, default=400, help="seeds of each case")
    parser.add_argument("--lines", type=int, nargs="+", default=LINES, help="lines, 0 as many as the engine takes")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="processes")
    options = parser.parse_args()
    heading = f"{'case':34}{'lines':>5} {'method':6}{'taken':>7}{'ms':>7}{'told/sd':>9}{'bias/sd':>9}"
    print(heading + "".join(f"{name:>7}" for name in GROUPS))
    names, found = options.cases or list(cases()), []
    with ProcessPoolExecutor(options.jobs) as pool:
        for one in pool.map(tested, names, [options.lines] * len(names), [options.seeds] * len(names)):
            print(*(each.line() for each in one), sep="\n", flush=True)
            found += one
    summary(found, options.lines)


if __name__ == "__main__":
    main()
