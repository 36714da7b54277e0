"""Mean, sd, skewness and kurtosis of the output: along the lines by quadrature, over the lines by their mean.

Arrays of a rule are (nodes, rows × lines); results are (rows,).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import TypeAlias

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_points import normal_density
from flexlash.tolerance.engine.line_tables import NODES, REACH, Lines

__all__ = ["Moments", "moments_of"]

_FINE = 192, 128
"""Nodes between two breaks of the two rules for a single input."""

_ROUNDING = 1e-9
"""Part of the scale of an output below which its numbers are rounding."""


_END_DENSITY = float(normal_density(NODES[-1]))
"""What is left beyond an end of a line, at most, of an output that grows there by less than e⁷ a score."""


@dataclass(frozen=True, kw_only=True)
class Moments:
    """Mean, standard deviation, skewness and excess kurtosis of each row with their standard errors, (rows,) each."""

    mean: Array
    sd: Array
    skewness: Array
    kurtosis: Array
    mean_error: Array
    sd_error: Array
    skewness_error: Array
    kurtosis_error: Array

    def widened(self, margin: Array) -> Moments:
        """Return the same with standard errors times a margin (rows,)."""
        errors = {name: values * margin for name, values in vars(self).items() if name.endswith("_error")}
        return replace(self, **errors)


def moments_of(lines: Lines) -> Moments:
    """Return the moments of each row, in the unit of the output; skewness and kurtosis have none.

    Equation: E[(Y − c)ᵏ] = mean over lines of ∫ (y(t) − c)ᵏ φ(t) dt about the mean c
    Arguments: lines of rows alike without faults.
    Valid: outputs that are smooth between the nodes; with a single input also kinks at its breaks.
    Source: trapezoidal rule under the normal density, Gauss–Legendre between breaks; half as many nodes tell the error.
    """
    rules = _rules(lines)
    origin = lines.each(rules[0][0][len(rules[0][0]) // 2].reshape(lines.rows, -1)[:, :1].T)
    shift = lines.mean_over_lines(_integrals(rules[0], origin)[0])
    centre = origin + lines.each(shift)
    (first, second, third, fourth), coarse = (_integrals(rule, centre) for rule in rules)
    # A third of what twice the spacing changes is the error of a kink, and more than that of a smooth output.
    steps = [
        np.abs(lines.mean_over_lines(fine - wide)) / 3 + lines.mean_over_lines(beyond)
        for fine, wide, beyond in zip((first, second, third, fourth), coarse, _beyond(rules[0], centre), strict=True)
    ]
    sd = np.sqrt(lines.mean_over_lines(second))
    scale = np.where(sd > 0, sd, 1.0)
    skewness = lines.mean_over_lines(third) / scale**3
    # The skewness moves with mean and sd as well as with the third moment.
    skewing = third / lines.each(scale**3) - 3 * first / lines.each(scale)
    skewing -= 1.5 * lines.each(skewness) * second / lines.each(scale**2)
    peak = lines.mean_over_lines(fourth) / scale**4
    # So does the kurtosis, and with the skewness where mean and third moment meet.
    peaking = fourth / lines.each(scale**4) - 4 * lines.each(skewness) * first / lines.each(scale)
    peaking -= 2 * lines.each(peak) * second / lines.each(scale**2)
    peak_step = steps[3] / scale**4 + 2 * peak * steps[1] / scale**2
    return Moments(
        mean=(lines.mean_over_lines(origin) + shift)[0],
        sd=sd[0],
        skewness=skewness[0],
        kurtosis=(peak - 3)[0],
        mean_error=(lines.standard_error(first) + steps[0])[0] + _ROUNDING * sd[0],
        sd_error=((lines.standard_error(second) + steps[1]) / (2 * scale))[0] + _ROUNDING * sd[0],
        skewness_error=(lines.standard_error(skewing) + steps[2] / scale**3)[0] + _ROUNDING,
        kurtosis_error=(lines.standard_error(peaking) + peak_step)[0] + _ROUNDING,
    )


Rule: TypeAlias = tuple[Array, Array]
"""Outputs (nodes, rows × lines) along lines, and the weights (nodes, 1) that integrate them."""


def _rules(lines: Lines) -> tuple[Rule, Rule]:
    """Return a rule and one of half as many nodes: the table, or for a single input one that knows its kinks."""
    if len(lines.inputs.names) > 1:
        return (lines.table, _trapezoid(1)), (lines.table[::2], _trapezoid(2))
    rules = [_fine_rule(lines.inputs.shapes[0].breaks, count) for count in _FINE]
    return (lines.outputs(rules[0][0]), rules[0][1]), (lines.outputs(rules[1][0]), rules[1][1])


@cache
def _trapezoid(every: int) -> Array:
    """Return the weights (k, 1) of every so many nodes under the normal density, nearly exact if all is smooth."""
    weights = normal_density(NODES[::every, None])
    return np.asarray(weights / weights.sum())


@cache
def _legendre(count: int) -> tuple[Array, Array]:
    """Return the nodes and weights of a Gauss–Legendre rule, whose eigenvalues take longer than all lines of a row."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return nodes, weights


def _fine_rule(breaks: tuple[float, ...], count: int) -> tuple[Array, Array]:
    """Return positions and weights (k, 1) that integrate under the normal density between breaks."""
    nodes, weights = _legendre(count)
    # A line may run either way through its one input.
    ends = np.unique([-REACH, *breaks, *(-score for score in breaks), REACH])
    half = np.diff(ends)[:, None] / 2
    positions = (half * nodes + ends[:-1, None] + half).reshape(-1, 1)
    products = (half * weights).reshape(-1, 1) * normal_density(positions)
    return positions, products / products.sum()


def _beyond(rule: Rule, centre: Array) -> list[Array]:
    """Return about what the first four moments miss beyond the ends of each line, (1, rows × lines) each."""
    ends = np.abs(rule[0][[0, -1]] - centre)
    power, moments = np.full(ends.shape, _END_DENSITY), []
    for _ in range(4):
        power = power * ends
        moments.append(np.add.reduce(power, axis=0, keepdims=True))
    return moments


def _integrals(rule: Rule, centre: Array) -> tuple[Array, Array, Array, Array]:
    """Return the first four moments about a centre (1, rows × lines) along each line."""
    values, weight = rule
    deviation = values - centre
    power = weight * deviation
    moments = [np.add.reduce(power, axis=0, keepdims=True)]
    for _ in range(3):
        power *= deviation
        moments.append(np.add.reduce(power, axis=0, keepdims=True))
    return moments[0], moments[1], moments[2], moments[3]
