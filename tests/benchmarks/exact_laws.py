"""Exact laws of sums, slow and obvious: masses on a lattice, convolved; and what a mean over points leaves to know.

    term        what one input adds: an increasing or decreasing function of it
    law         distribution of a sum of terms, as probabilities below the edges of many narrow cells
    score       quantile of the standard normal with the same probability

A cell is about four millionths of the law's width, so that percentiles are good to 1e-8 standard deviations.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.fft import irfft, rfft
from scipy.optimize import brentq
from scipy.special import ndtr, ndtri
from scipy.stats import qmc

CELLS = 1 << 18
SCORES = np.linspace(-8.5, 8.5, CELLS + 1)
"""Where the values of an input are tabulated; beyond these scores it has no weight in double precision."""
WEIGHTS = np.exp(-(SCORES**2) / 2)
WEIGHTS /= WEIGHTS.sum()

EXACT = 1e-7
"""Error of what is called exact, in standard deviations of the output."""


@dataclass(frozen=True, kw_only=True)
class Truth:
    """What is known of an output without the engine; `error` is that of all of it, in standard deviations.

    `quantile` takes probabilities. Moments, shares and lots are left out where they are not known. `lots_failing` takes
    a limit and parts per million.
    """

    quantile: object
    mean: float
    sd: float
    skewness: float | None = None
    kurtosis: float | None = None
    shares: dict[str, float] = field(default_factory=dict)
    total_shares: dict[str, float] = field(default_factory=dict)
    within_lot_sd: float | None = None
    between_lots_sd: float | None = None
    lots_failing: object = None
    error: float = EXACT


class Law:
    """The law of a random number: masses in cells of one width, spread evenly within each."""

    def __init__(self, low, step, masses):
        self.edges = low + step * np.arange(len(masses) + 1)
        self._middles = self.edges[:-1] + step / 2
        self._masses = np.maximum(masses, 0)
        self._below = np.concatenate([[0.0], np.cumsum(self._masses)])
        self._above = np.concatenate([np.cumsum(self._masses[::-1])[::-1], [0.0]])

    @classmethod
    def of_sum(cls, terms):
        """Return the law of a sum of independent terms, each given by its values at `SCORES`."""
        rising = [values if values[-1] > values[0] else values[::-1] for values in terms]
        step = sum(values[-1] - values[0] for values in rising) / CELLS
        size = CELLS + 2 * len(rising)
        transform = 1.0
        for values in rising:
            edges = values[0] + step * np.arange(math.ceil((values[-1] - values[0]) / step) + 1)
            masses = np.diff(ndtr(np.interp(edges, values, SCORES)))
            transform = transform * rfft(masses, size)
        # The middles of cells add up: the sum's lie half a step off the edges once for each term.
        low = sum(values[0] for values in rising) + (len(rising) - 1) * step / 2
        return cls(low, step, irfft(transform, size))

    def below(self, value):
        """Return the probability below a value."""
        return np.interp(value, self.edges, self._below)

    def above(self, value):
        """Return the probability above a value, small ones as exactly as a sum of masses can be."""
        return np.interp(value, self.edges, self._above)

    def quantile(self, probability):
        """Return the values that the number stays below with these probabilities."""
        return np.interp(probability, self._below, self.edges)

    def moments(self, function):
        """Return mean, standard deviation, skewness and excess kurtosis of a function of the number."""
        used = self._masses > 0
        return moments(function(self._middles[used]), self._masses[used])


def moments(values, weights):
    """Return mean, standard deviation, skewness and excess kurtosis of values with these weights."""
    weights = weights / weights.sum()
    mean = weights @ values
    second, third, fourth = (weights @ (values - mean) ** power for power in (2, 3, 4))
    return mean, math.sqrt(second), third / second**1.5, fourth / second**2 - 3


def values_at(distribution, scores=SCORES):
    """Return the values of an input at scores."""
    return distribution.location + distribution.scale * distribution.standard_at(scores)


def identity(value):
    """Return the value itself."""
    return value


def additive(inputs, terms=identity, outer=identity, *, between=(), known=None, error=EXACT):
    """Return the truth of outer(Σ term(input)): outer rises, and shares are known where it is `identity` or `np.exp`.

    `terms` are one function for all inputs or a mapping of them by name; `known` are moments that replace those of the
    law, where tails beyond its range count.
    """
    tables = {name: (terms[name] if isinstance(terms, dict) else terms)(values_at(one)) for name, one in inputs.items()}
    law = Law.of_sum(list(tables.values()))
    mean, sd, skewness, kurtosis = known or (
        _product_moments(tables.values()) if outer is np.exp else law.moments(outer)
    )
    found = {"mean": mean, "sd": sd, "skewness": skewness, "kurtosis": kurtosis, "error": error}
    if outer is identity or outer is np.exp:
        found |= _shares({name: moments(outer(values), WEIGHTS)[:2] for name, values in tables.items()}, outer)
    if between:
        found |= _lots(tables, outer, between)
    return Truth(quantile=lambda probability: outer(law.quantile(probability)), **found)


def _product_moments(tables):
    """Return mean, standard deviation, skewness and excess kurtosis of e^Σ from the moments of each e^term.

    With e^term = mean · (1 + d) the raw moments of a product are products of those of 1 + d; what they leave of a
    narrow one is lost in rounding, but for the second.
    """
    each = [np.exp(values) for values in tables]
    means = [WEIGHTS @ values for values in each]
    scaled = [values / mean - 1 for values, mean in zip(each, means, strict=True)]
    mean = math.prod(means)
    logs = {power: sum(math.log1p(WEIGHTS @ ((1 + d) ** power - 1)) for d in scaled) for power in (2, 3, 4)}
    second, third, fourth = (math.expm1(logs[power]) for power in (2, 3, 4))
    third_central = third - 3 * second
    fourth_central = fourth - 4 * third + 6 * second
    return mean, mean * math.sqrt(second), third_central / second**1.5, fourth_central / second**2 - 3


def _shares(each, outer):
    """Return the Sobol' indices of a sum, or of a product, from mean and standard deviation of its terms."""
    if outer is identity:
        parts = {name: sd**2 for name, (_, sd) in each.items()}
        shares = {name: part / sum(parts.values()) for name, part in parts.items()}
        return {"shares": shares, "total_shares": shares}
    parts = {name: (sd / mean) ** 2 for name, (mean, sd) in each.items()}
    whole = math.prod(1 + part for part in parts.values())
    first = {name: part / (whole - 1) for name, part in parts.items()}
    return {
        "shares": first,
        "total_shares": {name: share * whole / (1 + parts[name]) for name, share in first.items()},
    }


def _lots(tables, outer, between):
    """Return what is true of lots, of a sum or a product."""
    lots, parts = (
        Law.of_sum([values for name, values in tables.items() if (name in between) is wanted])
        for wanted in (True, False)
    )
    (lot_mean, lot_sd, *_), (part_mean, part_sd, *_) = lots.moments(outer), parts.moments(outer)
    inner = np.log if outer is np.exp else identity

    def failing(limit, ppm):
        return float(lots.above(inner(limit) - parts.quantile(1 - ppm / 1e6)))

    if outer is identity:
        return {"within_lot_sd": part_sd, "between_lots_sd": lot_sd, "lots_failing": failing}
    return {
        "within_lot_sd": math.hypot(lot_mean, lot_sd) * part_sd,
        "between_lots_sd": lot_sd * part_mean,
        "lots_failing": failing,
    }


def grid_of_two(correlation, step=0.1):
    """Return standard normal scores of two inputs with this correlation on a grid, and their weights."""
    scores = np.arange(-8.5, 8.5 + step / 2, step)
    first, other = (axis.ravel() for axis in np.meshgrid(scores, scores, indexing="ij"))
    weights = np.exp(-(first**2 + other**2) / 2)
    return first, correlation * first + math.sqrt(1 - correlation**2) * other, weights / weights.sum()


def lognormal_moments(sigma):
    """Return mean, standard deviation, skewness and excess kurtosis of e^X, X ~ N(0, sigma²)."""
    growth = math.exp(sigma**2)
    kurtosis = growth**4 + 2 * growth**3 + 3 * growth**2 - 6
    return math.sqrt(growth), math.sqrt(growth * (growth - 1)), (growth + 2) * math.sqrt(growth - 1), kurtosis


def inverse(below, low, high):
    """Return the quantiles, for probabilities in an array, of a distribution function that rises from low to high."""

    def found(share):
        return brentq(lambda value: below(value) - share, low, high, xtol=1e-11 * (high - low))

    def quantile(probability):
        return np.array([found(share) for share in probability])

    return quantile


def mixture(centres, weights, sd):
    """Return the truth of a normal number of this sd about centres that have these weights."""
    mean, spread, third, fourth = moments(centres, weights)
    variance = spread**2 + sd**2
    reach = 9 * sd
    return Truth(
        quantile=inverse(
            lambda value: weights @ ndtr((value - centres) / sd), centres.min() - reach, centres.max() + reach
        ),
        mean=mean,
        sd=math.sqrt(variance),
        skewness=third * spread**3 / variance**1.5,
        kurtosis=fourth * spread**4 / variance**2,
    )


def sobol_scores(inputs, log2_points, replicates, seed=1):
    """Return standard normal scores of scrambled Sobol' points, (replicates, points, inputs)."""
    engines = [qmc.Sobol(inputs, rng=seed + place, bits=52) for place in range(replicates)]
    points = np.array([engine.random_base2(log2_points) for engine in engines])
    return ndtri(np.clip(points, 1e-16, 1 - 1e-16))
