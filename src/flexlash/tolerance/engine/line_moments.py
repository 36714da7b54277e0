"""Mean, sd, skewness and kurtosis of the output: along the lines by quadrature, over the lines by their mean.

Arrays of a rule are (nodes, rows × lines); results are (rows,).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import TypeAlias

import numpy as np
from scipy.special import ndtr

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_control import LineControl
from flexlash.tolerance.engine.line_crossings import NODES, STEP
from flexlash.tolerance.engine.line_drawing import DrawnLines
from flexlash.tolerance.engine.line_points import normal_density
from flexlash.tolerance.engine.line_tables import REACH, Lines

__all__ = ["Moments", "moments_of"]

_FINE = 192, 128
"""Nodes between two breaks of the two rules for a single input."""

_ROUNDING = 1e-9
"""Part of the scale of an output below which its numbers are rounding."""

_END_DENSITY = float(normal_density(NODES[-1]))
"""What is left beyond an end of a line, at most, of an output that grows there by less than e⁷ a score."""

_MOST_RISE = 30.0
"""Greatest rise of what is integrated, in powers of e a score, that is followed beyond a line's end."""


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


def moments_of(drawn: DrawnLines) -> Moments:
    """Return the moments of each row, in the unit of the output; skewness and kurtosis have none.

    Equation: E[(Y − c)ᵏ] = mean over lines of ∫ (y(t) − c)ᵏ φ(t) dt about the mean c; with a surrogate its own exact
        moment, and the mean over lines of the difference
    Arguments: lines of rows alike without faults.
    Valid: outputs that are smooth between the nodes; with a single input also kinks at its breaks.
    Source: trapezoidal rule under the normal density, Gauss–Legendre between breaks; half as many nodes tell the error.
    """
    lines = drawn.lines
    rules = _rules(lines)
    origin = lines.table[len(NODES) // 2].reshape(lines.rows, -1)[:, 0]
    (shift, *_), _ = _moments(drawn, rules[0], origin)
    mean = origin + shift
    (off, variance, cube, square), lined = _moments(drawn, rules[0], mean)
    coarse = _moments(drawn, rules[1], mean)[1]
    # A third of what twice the spacing changes is the error of a kink, and more than that of a smooth output.
    steps = [
        (np.abs(lines.mean_over_lines(fine - wide)) / 3 + lines.mean_over_lines(beyond))[0]
        for fine, wide, beyond in zip(lined, coarse, _beyond(lines, rules[0], lines.each(mean[None])), strict=True)
    ]
    sd = np.sqrt(np.maximum(variance, 0.0))
    scale = np.where(sd > 0, sd, 1.0)
    skewness, peak = cube / scale**3, square / scale**4
    standardised = _standardised(lined, *(lines.each(one[None]) for one in (scale, skewness, peak)))
    errors = [lines.standard_error(one)[0] for one in (*lined[:2], *standardised)]
    return Moments(
        mean=mean + off,
        sd=sd,
        skewness=skewness,
        kurtosis=peak - 3,
        mean_error=errors[0] + steps[0] + _ROUNDING * sd,
        sd_error=(errors[1] + steps[1]) / (2 * scale) + _ROUNDING * sd,
        skewness_error=errors[2] + steps[2] / scale**3 + _ROUNDING,
        kurtosis_error=errors[3] + steps[3] / scale**4 + 2 * peak * steps[1] / scale**2 + _ROUNDING,
    )


def _standardised(lined: list[Array], scale: Array, skewness: Array, peak: Array) -> tuple[Array, Array]:
    """Return what each line adds to skewness and kurtosis, (1, rows × lines) each.

    Equation: δγ = δm₃/σ³ − 3 δm₁/σ − 3/2 γ δm₂/σ²; δκ = δm₄/σ⁴ − 4 γ δm₁/σ − 2 κ δm₂/σ²
    Arguments: what each line adds to the first four moments mₖ about the mean; sd σ, skewness γ and fourth moment κ
        over σ⁴ of its row, (1, rows × lines) each.
    Valid: changes that are small beside the moments: the delta rule.
    Source: derivatives of m₃/m₂^(3/2) and m₄/m₂² with moments about a mean that moves.
    """
    first, second, third, fourth = lined
    skewing = third / scale**3 - 3 * first / scale
    skewing -= 1.5 * skewness * second / scale**2
    peaking = fourth / scale**4 - 4 * skewness * first / scale
    peaking -= 2 * peak * second / scale**2
    return skewing, peaking


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


def _beyond(lines: Lines, rule: Rule, centre: Array) -> list[Array]:
    """Return about what the first four moments miss beyond the ends of each line, (1, rows × lines) each.

    Equation: d^k φ(8) ∫ e^{rs − s²/2} ds over s > 0, r = k g − 8: a deviation d that goes on growing by e^g a score
    Arguments: lines of rows alike, the outputs of a rule along them, the centres (1, rows × lines).
    Valid: at least d^k φ(8), which is enough unless what is integrated still rises at the end.
    Source: completing the square.
    """
    ends, before = np.abs(rule[0][[0, -1]] - centre), np.abs(lines.table[[1, -2]] - centre)
    outer = np.abs(lines.table[[0, -1]] - centre)
    growth = np.log(np.where((before > 0) & (outer > 0), outer / np.where(before > 0, before, 1.0), 1.0)) / STEP
    power, moments = np.full(ends.shape, _END_DENSITY), []
    for order in range(1, 5):
        power = power * ends
        rise = np.minimum(order * growth + NODES[0], _MOST_RISE)
        going_on = np.where(rise > 0, ndtr(rise) / normal_density(rise), 1.0)
        moments.append(np.add.reduce(power * going_on, axis=0, keepdims=True))
    return moments


def _moments(drawn: DrawnLines, rule: Rule, about: Array) -> tuple[list[Array], list[Array]]:
    """Return the first four moments about values (rows,), and what each line adds to them, (1, rows × lines) each."""
    lines, control = drawn.lines, drawn.control
    centre = lines.each(about[None])
    lined = _integrals(rule, centre)
    if control is None:
        return [lines.mean_over_lines(one)[0] for one in lined], lined
    every = (len(NODES) - 1) // (len(rule[0]) - 1)
    used = lines.each(control.used[None])
    lined = [
        model - np.where(used, surrogate, 0.0)
        for model, surrogate in zip(
            lined, _integrals((_outputs(control, lines)[::every], rule[1]), centre), strict=True
        )
    ]
    exact = control.surrogate.moments(about)
    return [
        lines.mean_over_lines(one)[0] + np.where(control.used, own, 0.0) for one, own in zip(lined, exact, strict=True)
    ], lined


def _outputs(control: LineControl, lines: Lines) -> Array:
    """Return the surrogates' outputs at the nodes of the table, (nodes, rows × lines)."""
    by_line = np.moveaxis(control.table.reshape(len(NODES), lines.rows, -1), 1, 2)
    outputs = control.surrogate.output(by_line)
    return np.moveaxis(outputs, 2, 1).reshape(control.table.shape)


def _integrals(rule: Rule, centre: Array) -> list[Array]:
    """Return the first four moments about a centre (1, rows × lines) along each line."""
    values, weight = rule
    deviation = values - centre
    power = weight * deviation
    moments = [np.add.reduce(power, axis=0, keepdims=True)]
    for _ in range(3):
        power *= deviation
        moments.append(np.add.reduce(power, axis=0, keepdims=True))
    return moments
