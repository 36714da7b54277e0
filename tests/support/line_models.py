"""Models and inputs of the line engine's tests: functions of keyword arrays as models of rows, and their lines."""

from __future__ import annotations

import math
from itertools import product

import numpy as np

from flexlash.tolerance import Normal, Triangular, Uniform
from flexlash.tolerance.engine.line_direction import Inputs, direction_of
from flexlash.tolerance.engine.line_points import line_net
from flexlash.tolerance.engine.line_tables import Lines

__all__ = ["MIXED", "NORMALS", "curved", "linear", "lines_of", "probability_below", "row_model", "total"]

NORMALS = {"a": Normal(mean=1, sd=2), "b": Normal(mean=-3, sd=0.5), "c": Normal(mean=0, sd=1)}
MIXED = {"a": Normal(mean=1, sd=2), "b": Uniform(low=0, high=4), "c": Triangular(low=-1, high=1)}


def row_model(function):
    """Return a function of keyword arrays as a model of rows, all alike."""

    def model(arguments, rows):
        shape = np.broadcast_shapes(*map(np.shape, arguments.values()), rows.shape)
        return np.broadcast_to(function(**arguments), shape)

    return model


def lines_of(function, *rows, lines=64, seed=0):
    """Return lines through rows whose distributions have the same names and shapes."""
    model, inputs = row_model(function), Inputs.of(rows)
    with np.errstate(all="ignore"):
        net = line_net(seed, len(inputs.names) - 1, lines, single_curved=inputs.single_curved)
        return Lines(model, inputs, direction_of(model, inputs), net)


def linear(a, b, c):
    """Return a linear function with a weight of either sign."""
    return 2 * a - 3 * b + 0.5 * c


def curved(a, b, c):
    """Return a function that rises everywhere, but not evenly."""
    return np.exp(0.1 * a) + 0.3 * b**1.5 + c


def total(**inputs):
    """Return the sum of all inputs."""
    return sum(inputs.values())


def probability_below(value, widths):
    """Return the exact probability below a value of a sum of uniforms between 0 and these widths (Irwin–Hall)."""
    subsets = np.array(list(product([0, 1], repeat=len(widths))))
    powers = np.maximum(value - subsets @ np.array(widths), 0.0) ** len(widths)
    signs = (-1.0) ** subsets.sum(axis=1)
    return float((signs * powers).sum()) / (math.factorial(len(widths)) * math.prod(widths))
