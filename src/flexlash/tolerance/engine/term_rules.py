"""How expectations over the terms of a surrogate are taken: input by input, and over correlated inputs together.

term                what is independent of all other terms: one input's polynomial, or the sum of a cluster's
axis                one of the independent scores that move a cluster
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array
from flexlash.tolerance.correlation import clusters_of
from flexlash.tolerance.distributions import Distribution
from flexlash.tolerance.engine.line_direction import Inputs
from flexlash.tolerance.engine.shape_rules import shape_rule

__all__ = ["TermRule", "polynomial", "serves", "term_rules"]

_OUTER = 8.0
"""Distance from the medians at which the rule of a cluster ends; beyond lies 1e-14."""

_FINE = np.linspace(-_OUTER, _OUTER, 1601)
"""Scores between which the steepest rise of a variable is looked for."""

_DENSITY = 6.0
"""Frequency up to which the normal density itself has waves, to 1e-8."""

_MOST_NODES = {1: 769, 2: 145}
"""Most nodes of an axis, by the axes of a cluster; three take more time than the lines that they save."""

_RULES: dict[tuple[object, ...], tuple[TermRule, ...]] = {}
_MOST_RULES = 64
"""Rules that are kept for the next rows of their inputs; the oldest makes room."""


@dataclass(frozen=True, kw_only=True)
class TermRule:
    """A rule for inputs that are independent, each a term by itself, or for a cluster, which is one term.

    `members` are the inputs' indices; `variables` (members, 1, nodes) and `weights` (members, 1, nodes), those of a
    cluster (1, 1, nodes). `resolved` (members, 1) is the greatest frequency, in radians per unit of each variable, of a
    wave whose expectation the rule gives to 1e-8. No rule of a cluster has more nodes than its `finest`.
    """

    members: npt.NDArray[np.intp]
    variables: Array
    weights: Array
    resolved: Array
    finest: bool = False

    @property
    def clustered(self) -> bool:
        """Whether the members are one term."""
        return len(self.weights) < len(self.members)

    def parts(self, coefficients: Array) -> Array:
        """Return what each member adds (members, rows, nodes), of coefficients (degree + 1, inputs, rows)."""
        return polynomial(coefficients[:, self.members, :, None], self.variables)

    def terms(self, parts: Array) -> Array:
        """Return the terms (terms, rows, nodes) of parts."""
        return np.asarray(np.add.reduce(parts, axis=0, keepdims=True)) if self.clustered else parts

    def waves_resolved(self, parts: Array, frequency: Array) -> Array:
        """Return how many multiples (rows,) of a frequency (rows,) the rule resolves."""
        swing = (parts.max(axis=2) - parts.min(axis=2)) / 2
        rate = swing * frequency / self.resolved
        rate = np.add.reduce(rate, axis=0) if self.clustered else rate.max(axis=0)
        return np.asarray(1 / np.maximum(rate, np.finfo(float).tiny))


def polynomial(coefficients: Array, variable: Array) -> Array:
    """Return polynomials by Horner's rule: coefficients (degree + 1, ...) at variables that go with (...)."""
    value = coefficients[-1] * variable
    for coefficient in coefficients[-2:0:-1]:
        value += coefficient
        value *= variable
    value += coefficients[0]
    return np.asarray(value)


def serves(inputs: Inputs) -> bool:
    """Return whether there are rules for the inputs: no cluster of more than two axes, nor with a kink."""
    return all(
        factor.shape[1] in _MOST_NODES and not any(inputs.shapes[index].breaks for index in cluster)
        for cluster, factor in _clusters(inputs)
    )


def term_rules(inputs: Inputs, nodes: int) -> tuple[TermRule, ...]:
    """Return the rules of inputs with so many nodes.

    Equation: E f(v) = Σ w_q f(v_q), by `shape_rule` for inputs by themselves; for a cluster by the trapezoidal rule
        over its axes z, v = v(L z)
    Arguments: inputs that `serves` accepts; nodes of an input by itself, an axis has twice as many.
    Valid: waves as fast as `resolved` says; smooth shapes in clusters.
    Source: Trefethen and Weideman 2014.
    """
    key = (*(shape.shape for shape in inputs.shapes), nodes, b"" if inputs.factor is None else inputs.factor.tobytes())
    rules = _RULES.get(key)
    if rules is None:
        clusters = _clusters(inputs)
        tied = {index for cluster, _ in clusters for index in cluster}
        alone = [index for index in range(len(inputs.shapes)) if index not in tied]
        rules = tuple(_joint(inputs.shapes, *cluster, nodes) for cluster in clusters)
        if alone:
            rules = (_independent(inputs.shapes, alone, nodes), *rules)
        if len(_RULES) >= _MOST_RULES:
            del _RULES[next(iter(_RULES))]
        _RULES[key] = rules
    return rules


def _clusters(inputs: Inputs) -> list[tuple[list[int], Array]]:
    """Return each cluster of correlated inputs with its factor (members, axes)."""
    if inputs.factor is None:
        return []
    clusters = clusters_of(inputs.factor @ inputs.factor.T)
    factors = [inputs.factor[cluster] for cluster in clusters]
    return [(cluster, factor[:, factor.any(axis=0)]) for cluster, factor in zip(clusters, factors, strict=True)]


def _independent(shapes: Sequence[Distribution], members: Sequence[int], nodes: int) -> TermRule:
    """Return the rule of inputs that are independent."""
    rules = [shape_rule(shapes[index], nodes) for index in members]
    return TermRule(
        members=np.array(members),
        variables=np.array([rule.variables for rule in rules])[:, None],
        weights=np.array([rule.weights for rule in rules])[:, None],
        resolved=np.array([[rule.resolved] for rule in rules]),
    )


def _joint(shapes: Sequence[Distribution], members: Sequence[int], factor: Array, nodes: int) -> TermRule:
    """Return the rule of a cluster."""
    axes = factor.shape[1]
    count = min(2 * nodes - 1, _MOST_NODES[axes])
    axis = np.linspace(-_OUTER, _OUTER, count)
    scores = np.stack(np.meshgrid(*[axis] * axes, indexing="ij")).reshape(axes, -1)
    distance = np.add.reduce(scores * scores, axis=0)
    scores, weights = scores[:, distance <= _OUTER**2], np.exp(-distance[distance <= _OUTER**2] / 2)
    fastest = 2 * np.pi * (count - 1) / (2 * _OUTER) - _DENSITY
    variables, resolved = [], []
    for index, row in zip(members, factor, strict=True):
        rule = shape_rule(shapes[index], nodes)
        variables.append(rule.variable(shapes[index].standard_at(np.add.reduce(row[:, None] * scores, axis=0))))
        slope = np.abs(np.gradient(rule.variable(shapes[index].standard_at(_FINE)), _FINE)).max()
        resolved.append([fastest / (slope * np.abs(row).max())])
    return TermRule(
        members=np.array(members),
        variables=np.array(variables)[:, None],
        weights=(weights / weights.sum())[None, None],
        resolved=np.array(resolved),
        finest=count == _MOST_NODES[axes],
    )
