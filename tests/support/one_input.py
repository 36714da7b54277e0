"""Distributions beside the same ones of scipy, for what is exact with a single input."""

import math

import numpy as np
from scipy import stats

from flexlash.tolerance import Normal, Triangular, TruncatedNormal, Uniform

PROBABILITIES = np.array([1e-6, 0.00135, 0.025, 0.1, 0.5, 0.9, 0.975, 0.99865, 1 - 1e-6])

ONE_INPUT = {
    "normal": (Normal(80, 0.02), stats.norm(80, 0.02)),
    "uniform": (Uniform(1.55, 1.65), stats.uniform(1.55, 0.1)),
    "triangular": (Triangular(-1, 3), stats.triang(0.5, -1, 4)),
    "skewed": (Triangular(0, 4, 1), stats.triang(0.25, 0, 4)),
    "falling": (Triangular(1, 2, 1), stats.triang(0, 1, 1)),
    "rising": (Triangular(1, 2, 2), stats.triang(1, 1, 1)),
    "cut at 3 sigma": (TruncatedNormal(5, 2, -1, 11), stats.truncnorm(-3, 3, 5, 2)),
    "cut at half a sigma": (TruncatedNormal(5, 2, 4, 6), stats.truncnorm(-0.5, 0.5, 5, 2)),
    "cut off centre": (TruncatedNormal(0, 1, -0.5, 3), stats.truncnorm(-0.5, 3)),
    "cut to a tail": (TruncatedNormal(0, 1, 4, 5), stats.truncnorm(4, 5)),
    "cut below alone": (TruncatedNormal(1, 2, 0, math.inf), stats.truncnorm(-0.5, math.inf, 1, 2)),
}
