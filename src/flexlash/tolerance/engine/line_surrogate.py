"""A stand-in for the model that is a sum over its inputs, fitted once a row: whatever is asked of it is known exactly.

    surrogate           h(output) ≈ h(output at the medians) + S, S = Σ sᵢ(vᵢ); h is the logarithm, or nothing
    term                sᵢ, a polynomial of one input's variable vᵢ (`shape_rules`), near 0 at its median
    total               a value of S

It need not be true. Lines average the difference between model and surrogate, whose own law is exact: what the
polynomials miss costs sharpness, never truth.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import comb

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_crossings import NODES, crossings, values_at
from flexlash.tolerance.engine.line_direction import Indices, Inputs, RowModel
from flexlash.tolerance.engine.shape_rules import ShapeRule, shape_rule
from flexlash.tolerance.engine.term_rules import TermRule, polynomial, term_rules

__all__ = ["DEGREE", "RULE_NODES", "AdditiveSurrogate", "fitted_surrogate"]

DEGREE = 6
"""Degree of each polynomial, which takes seven evaluations an input."""

RULE_NODES = 41
"""Nodes of the rule by which expectations of terms are taken."""

_CORNERS = [int(np.flatnonzero(score == NODES)[0]) for score in (-2.0, 2.0)]
"""Nodes at which logarithm and output are tried for which adds up better."""

_NODES = np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))
"""Chebyshev nodes, between −1 and 1, at which terms are fitted."""

_FIT = np.linalg.inv(np.vander(_NODES, increasing=True))
"""From values at the Chebyshev nodes to the coefficients of the polynomial through them."""

_LEAST = 1e-300
"""Part of the output at the medians that stands for an output without a logarithm."""

_MOMENTS = 4
"""Powers whose moments are told: those behind the kurtosis."""

Bools = npt.NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True)
class AdditiveSurrogate:
    """The surrogates of rows alike.

    `coefficients` (degree + 1, inputs, rows) of the powers of vᵢ; `centre` (rows,) the model's output at the medians;
    `logarithmic` (rows,) where h is the logarithm; `fitted` (rows,) where there is a surrogate at all. `risen`
    and `totals` (nodes, rows) are h(output) − h(output at the medians) and S on the line through the medians, made to
    rise.
    """

    rules: tuple[ShapeRule, ...]
    terms: tuple[TermRule, ...]
    coefficients: Array
    centre: Array
    logarithmic: Bools
    fitted: Bools
    risen: Array
    totals: Array

    def take(self, rows: Indices) -> AdditiveSurrogate:
        """Return some of the rows."""
        return AdditiveSurrogate(
            rules=self.rules,
            terms=self.terms,
            coefficients=self.coefficients[:, :, rows],
            centre=self.centre[rows],
            logarithmic=self.logarithmic[rows],
            fitted=self.fitted[rows],
            risen=self.risen[:, rows],
            totals=self.totals[:, rows],
        )

    def output(self, total: Array) -> Array:
        """Return the outputs (..., rows) that h has at values of S."""
        return np.where(
            self.logarithmic, np.exp(np.where(self.logarithmic, total, 0.0)) * self.centre, total + self.centre
        )

    def matched(self, output: Array) -> tuple[Array, Array]:
        """Return the values of S (levels, rows) that stand for outputs, and how they rise with these.

        Model and surrogate agree in them on the line through the medians, whatever bends the output: any threshold of
        the surrogate may stand for one of the model, and the nearer both lie, the sharper is their difference.
        """
        risen = _risen(output, self.centre, self.logarithmic)
        position, slope = crossings(self.risen, risen)
        total, rise = values_at(self.totals, position)
        beyond = risen - np.minimum(np.maximum(risen, self.risen[0]), self.risen[-1])
        rate = np.where((beyond == 0) & (rise > 0), rise / slope, 1.0)
        return total + beyond, rate * np.where(self.logarithmic, 1 / np.maximum(output, _LEAST * self.centre), 1.0)

    def unmatched(self, total: Array) -> Array:
        """Return about which outputs (levels, rows) values of S stand for."""
        risen = values_at(self.risen, crossings(self.totals, total)[0])[0]
        beyond = total - np.minimum(np.maximum(total, self.totals[0]), self.totals[-1])
        return self.output(risen + beyond)

    def moments(self, about: Array) -> tuple[Array, ...]:
        """Return the first four moments of the surrogate's output about a value (rows,), (rows,) each.

        Equation: with δᵢ = e^{sᵢ} − 1, X ← X (1 + δᵢ) + δᵢ from X = 0 makes output = centre · (1 + X);
            with δᵢ = sᵢ, X ← X + δᵢ makes output = centre + X; E Xᵏ follows from E δᵢʲ without cancelling
        Arguments: `about` (rows,) in the unit of the output.
        Valid: terms that are independent, those of a cluster being one; a rule that resolves e^{4 sᵢ}.
        Source: moments of sums and products of independent factors.
        """
        raw = [np.ones_like(self.centre), *(np.zeros_like(self.centre) for _ in range(_MOMENTS))]
        logarithmic = self.logarithmic[:, None]
        for rule in self.terms:
            for term, weights in zip(rule.terms(rule.parts(self.coefficients)), rule.weights, strict=True):
                risen = np.where(logarithmic, np.expm1(np.where(logarithmic, term, 0.0)), term)
                factor = 1 + np.where(logarithmic, risen, 0.0)
                raw = _with_term(raw, risen, factor, weights)
        unit = np.where(self.logarithmic, self.centre, 1.0)
        shift = (about - self.centre) / unit
        return tuple(
            unit**power * sum(comb(power, part) * raw[part] * (-shift) ** (power - part) for part in range(power + 1))
            for power in range(1, _MOMENTS + 1)
        )


def _with_term(raw: Sequence[Array], risen: Array, factor: Array, weights: Array) -> list[Array]:
    """Return the raw moments of X · factor + risen from those of X, which is independent of both (rows, nodes)."""
    powers = [weights * np.ones_like(risen)]
    for _ in range(_MOMENTS):
        powers.append(powers[-1] * risen)
    result = []
    for power in range(_MOMENTS + 1):
        moment = np.zeros_like(raw[0])
        for part in range(power + 1):
            mixed = powers[power - part] * factor**part
            moment = moment + comb(power, part) * raw[part] * np.add.reduce(mixed, axis=-1)
        result.append(moment)
    return result


def fitted_surrogate(model: RowModel, inputs: Inputs, vector: Array) -> AdditiveSurrogate:
    """Return the surrogates of rows alike.

    Equation: sᵢ through h(y(vᵢ)) − h(y(medians)) at Chebyshev nodes of vᵢ, the other inputs at their medians
    Arguments: model and inputs of rows alike; the directions `vector` (inputs, rows) of their lines.
    Valid: any model that is finite there; h is the logarithm where all outputs seen are positive and logarithms add
        up better than outputs two scores from the medians on the line through them.
    Source: control variates with known expectation; Chebyshev interpolation.
    """
    rules = tuple(shape_rule(shape, RULE_NODES) for shape in inputs.shapes)
    outputs, variables = _seen(model, inputs, vector, rules)
    centre = outputs[0]
    along, central = outputs[1 : -len(NODES)].reshape(len(rules), DEGREE + 1, -1), outputs[-len(NODES) :]
    fitted = np.asarray(np.isfinite(outputs).all(axis=0))
    positive = fitted & (outputs > 0).all(axis=0)

    def with_logarithm(logarithmic: Bools) -> AdditiveSurrogate:
        coefficients = _coefficients(along, centre, logarithmic, fitted)
        totals = np.zeros(central.shape)
        for index, variable in enumerate(variables):
            totals += polynomial(coefficients[:, index], variable)
        return AdditiveSurrogate(
            rules=rules,
            terms=term_rules(inputs, RULE_NODES),
            coefficients=coefficients,
            centre=centre,
            logarithmic=logarithmic,
            fitted=fitted,
            risen=_risen(central, centre, logarithmic),
            totals=totals,
        )

    logarithms, plain = with_logarithm(positive), with_logarithm(np.zeros_like(positive))
    off, plain_off = (np.abs(one.output(one.totals) - central)[_CORNERS].max(axis=0) for one in (logarithms, plain))
    return _chosen(positive & (off <= plain_off), logarithms, plain)


def _chosen(better: Bools, logarithms: AdditiveSurrogate, plain: AdditiveSurrogate) -> AdditiveSurrogate:
    """Return the surrogates by logarithms in the rows where these are better, with tables that only rise."""
    return replace(
        plain,
        coefficients=np.where(better, logarithms.coefficients, plain.coefficients),
        risen=np.maximum.accumulate(np.where(better, logarithms.risen, plain.risen), axis=0),
        totals=np.maximum.accumulate(np.where(better, logarithms.totals, plain.totals), axis=0),
        logarithmic=better,
    )


def _risen(output: Array, centre: Array, logarithmic: Bools) -> Array:
    """Return h(output) − h(output at the medians) of outputs (..., rows)."""
    ratio = np.where(logarithmic, np.maximum(output / centre, _LEAST), 1.0)
    return np.where(logarithmic, np.log(ratio), output - centre)


def _coefficients(along: Array, centre: Array, logarithmic: Bools, fitted: Bools) -> Array:
    """Return the coefficients (degree + 1, inputs, rows) through outputs (inputs, nodes, rows) at the nodes."""
    risen = np.where(fitted, _risen(along, centre, logarithmic), 0.0)
    coefficients = np.zeros((DEGREE + 1, len(along), len(centre)))
    for node in range(DEGREE + 1):
        coefficients += _FIT[:, node, None, None] * risen[:, node]
    return coefficients


def _seen(model: RowModel, inputs: Inputs, vector: Array, rules: Sequence[ShapeRule]) -> tuple[Array, list[Array]]:
    """Return outputs of rows (1 + inputs × nodes + line nodes, rows), and the variables of each input on that line.

    Outputs are those at the medians, at the nodes of each input, and on the line through the medians.
    """
    count, nodes = len(inputs.names), DEGREE + 1
    vector = inputs.correlated(vector)
    arguments, variables = {}, []
    for index, (name, rule) in enumerate(zip(inputs.names, rules, strict=True)):
        variable = np.full((1 + count * nodes + len(NODES), inputs.count), rule.median)
        variable[1 + index * nodes : 1 + (index + 1) * nodes] = _NODES[:, None]
        standard = inputs.shapes[index].standard_at(NODES[:, None] * vector[index])
        variable[-len(NODES) :] = rule.variable(standard)
        variables.append(variable[-len(NODES) :])
        arguments[name] = inputs.location[index] + inputs.scale[index] * rule.standard(variable)
    return model(arguments, np.arange(inputs.count)), variables
