"""The reversal wind-up of one flexspline, written out once more, and its law by Gauss quadrature.

The model is the plain cup of domain.md: twice the torsion of cylinder and disk. Its law follows from the distribution
of (1 + ν)/E, a closed form or nearly, at each node of the five other inputs.
"""

from __future__ import annotations

import math
from functools import cached_property
from itertools import pairwise

import numpy as np
from exact_laws import EXACT, Truth, grid_of_two, inverse, values_at
from scipy.special import ndtr

from flexlash.tolerance import Normal, Triangular, Uniform

TORQUE = 800.0
NOMINAL = {"l": 0.16, "wall": 1.6e-3, "disk": 1.6e-3, "r_m": 0.08, "r_ci": 0.04, "E": 211e9, "nu": 0.3}
HALF_WIDTH = {"l": 2e-4, "wall": 5e-5, "disk": 5e-5, "r_m": 6e-5, "r_ci": 1.5e-4, "E": 6.33e9, "nu": 0.02}
"""Half of each tolerance: all of a bounded distribution's, three standard deviations of a normal one's."""
KINDS = {
    "normal": lambda middle, half: Normal(middle, half / 3),
    "uniform": lambda middle, half: Uniform(middle - half, middle + half),
    "triangular": lambda middle, half: Triangular(middle - half, middle + half),
}
FORMULA = f"{TORQUE}*2*(1+nu)/({math.pi!r}*E)*(l/(r_m*r_m*r_m*wall)+(1/(r_ci*r_ci)-1/(r_m*r_m))/(2*disk))"
"""The wind-up in the words of OpenTURNS."""

SHAPE = ("l", "wall", "disk", "r_m", "r_ci")
_COUNTS = {"l": 4, "wall": 16, "disk": 16, "r_m": 4, "r_ci": 8, "nu": 24}


def shape_of(l, wall, disk, r_m, r_ci):  # noqa: E741
    """Return what the wind-up is proportional to beside (1 + ν)/E."""
    square = r_m * r_m
    return l / (square * r_m * wall) + (1 / (r_ci * r_ci) - 1 / square) / (2 * disk)


def wind_up(l, wall, disk, r_m, r_ci, E, nu):  # noqa: E741, N803, PLR0917
    """Return twice the wind-up [rad] of a cup: cylinder and disk."""
    return (2 * TORQUE / math.pi) * (1 + nu) / E * shape_of(l, wall, disk, r_m, r_ci)


def inputs_of(kind):
    """Return all seven inputs with one kind of distribution."""
    return {name: KINDS[kind](middle, HALF_WIDTH[name]) for name, middle in NOMINAL.items()}


def nodes_of(one, count):
    """Return Gauss nodes and weights of a distribution; a triangle's halves have their own."""
    if isinstance(one, Normal):
        nodes, weights = np.polynomial.hermite_e.hermegauss(count)
        return one.mean + one.sd * nodes, weights / weights.sum()
    middle, half = (one.low + one.high) / 2, (one.high - one.low) / 2
    if isinstance(one, Uniform):
        nodes, weights = np.polynomial.legendre.leggauss(count)
        return middle + half * nodes, weights / 2
    nodes, weights = np.polynomial.legendre.leggauss(count // 2)
    part = (1 + nodes) / 2
    density = weights / 2 * (1 - part)
    return np.concatenate([middle - half * part, middle + half * part]), np.concatenate([density, density])


def above_of(one, value):
    """Return the probability that a distribution lies above a value, by its closed form."""
    if isinstance(one, Normal):
        return ndtr((one.mean - value) / one.sd)
    share = np.clip((value - one.low) / (one.high - one.low), 0, 1)
    if isinstance(one, Uniform):
        return 1 - share
    return np.where(share < 1 / 2, 1 - 2 * share**2, 2 * (1 - share) ** 2)


class WindUpLaw:
    """Distribution, moments and shares of the wind-up with independent inputs; `fine` multiplies the nodes.

    Where E is normal it is integrated exactly and ν by nodes; where both are bounded ν is, and E piece by piece.
    `correlation` is that of the scores of wall and disk.
    """

    def __init__(self, inputs, *, fine=1, correlation=0.0):
        self.inputs = inputs
        self._nodes = {name: nodes_of(inputs[name], fine * count) for name, count in _COUNTS.items()}
        axes = np.meshgrid(*(self._nodes[name][0] for name in SHAPE), indexing="ij", sparse=True)
        grids = dict(zip(SHAPE, axes, strict=True))
        self._weight = np.ones(1)
        for name in SHAPE:
            self._weight = np.multiply.outer(self._weight, self._nodes[name][1])
        self._weight = self._weight[0]
        if correlation:
            wall, disk, weight = grid_of_two(correlation, 0.5)
            size = math.isqrt(len(wall))
            grids["wall"] = values_at(inputs["wall"], wall).reshape(1, size, size, 1, 1)
            grids["disk"] = values_at(inputs["disk"], disk).reshape(1, size, size, 1, 1)
            others = [self._nodes[name][1] for name in ("l", "r_m", "r_ci")]
            self._weight = np.einsum("a,bc,d,e->abcde", others[0], weight.reshape(size, size), *others[1:])
        self._tensor = shape_of(**grids) * (2 * TORQUE / math.pi)

    @cached_property
    def _factor(self):
        """The powers' means of (1 + ν)/E, by name of the input and exponent."""
        moduli, weights = nodes_of(self.inputs["E"], 64)
        ratios, shares = self._nodes["nu"]
        return {power: ((weights @ moduli**-power), shares @ (1 + ratios) ** power) for power in (1, 2, 3, 4)}

    @cached_property
    def moments(self):
        """Mean, standard deviation, skewness and excess kurtosis."""
        raw = [math.prod(self._factor[p]) * (self._weight * self._tensor**p).sum() for p in (1, 2, 3, 4)]
        mean = raw[0]
        scaled = [moment / mean**power for power, moment in enumerate(raw, start=1)]
        second = scaled[1] - 1
        third = scaled[2] - 3 * scaled[1] + 2
        fourth = scaled[3] - 4 * scaled[2] + 6 * scaled[1] - 3
        return mean, mean * math.sqrt(second), third / second**1.5, fourth / second**2 - 3

    @cached_property
    def shares(self):
        """First-order and total Sobol' indices by input."""
        mean, sd, *_ = self.moments
        first, total = {}, {}
        (modulus, ratio), (modulus_2, ratio_2) = self._factor[1], self._factor[2]
        shape, shape_2 = (float((self._weight * self._tensor**power).sum()) for power in (1, 2))
        for axis, name in enumerate(SHAPE):
            others = tuple(other for other in range(len(SHAPE)) if other != axis)
            own = self._nodes[name][1]
            given = (self._weight * self._tensor).sum(axis=others) / own
            first[name] = (own @ (given - shape) ** 2) * (modulus * ratio / sd) ** 2
            kept = self._weight.sum(axis=axis)
            weights = own.reshape([-1 if place == axis else 1 for place in range(len(SHAPE))])
            part = (kept * ((weights * self._tensor).sum(axis=axis)) ** 2).sum()
            total[name] = (shape_2 - part) * modulus_2 * ratio_2 / sd**2
        for name, own, own_2, rest in (
            ("E", modulus, modulus_2, (ratio, ratio_2)),
            ("nu", ratio, ratio_2, (modulus, modulus_2)),
        ):
            first[name] = (own_2 / own**2 - 1) * (mean / sd) ** 2
            total[name] = (own_2 - own**2) * rest[1] * shape_2 / sd**2
        return first, total

    def above(self, output):
        """Return the probability above an output."""
        shape, weight = self._tensor.ravel(), self._weight.ravel()
        return float(weight @ self._factor_above(output / shape))

    def quantile(self, probability):
        """Return the outputs that are exceeded with the rest of these probabilities."""
        mean, sd, *_ = self.moments
        return inverse(lambda output: 1 - self.above(output), mean - 7 * sd, mean + 7 * sd)(probability)

    def truth(self, *, shares=True, error=EXACT, **more):
        """Return what is known of the wind-up."""
        mean, sd, skewness, kurtosis = self.moments
        if shares:
            more |= {"shares": self.shares[0], "total_shares": self.shares[1]}
        return Truth(
            quantile=self.quantile, mean=mean, sd=sd, skewness=skewness, kurtosis=kurtosis, error=error, **more
        )

    def _factor_above(self, limit):
        """Return the probability that (1 + ν)/E lies above limits."""
        nodes, weights = self._nodes["nu"]
        modulus, ratio = self.inputs["E"], self.inputs["nu"]
        if isinstance(modulus, Normal):
            return sum(w * (1 - above_of(modulus, (1 + nu) / limit)) for nu, w in zip(nodes, weights, strict=True))
        # E and ν bounded: the mean over E of P(ν > limit·E − 1), which has kinks where that leaves the range of ν.
        ends = np.array([modulus.low, (modulus.low + modulus.high) / 2, modulus.high])[:, None]
        kinks = (1 + np.array([ratio.low, (ratio.low + ratio.high) / 2, ratio.high])[:, None]) / limit
        edges = np.sort(np.concatenate([np.broadcast_to(ends, (3, limit.size)), kinks]), axis=0)
        edges = np.clip(edges, modulus.low, modulus.high)
        spots, shares = np.polynomial.legendre.leggauss(4)
        total = np.zeros_like(limit)
        for low, high in pairwise(edges):
            for spot, share in zip(spots, shares, strict=True):
                at = (low + high) / 2 + (high - low) / 2 * spot
                total += share * (high - low) / 2 * density_of(modulus, at) * above_of(ratio, limit * at - 1)
        return total


def density_of(one, value):
    """Return the density of a bounded distribution between its ends."""
    width = one.high - one.low
    if isinstance(one, Uniform):
        return np.full_like(value, 1 / width)
    return 4 / width**2 * np.minimum(value - one.low, one.high - value)
