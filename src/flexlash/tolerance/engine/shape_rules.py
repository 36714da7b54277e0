"""What is known of a distribution's shape once for all rows: the variable polynomials are in, and how to integrate it.

variable            v, the standard value mapped to −1 … 1 between the scores ±6
rule                nodes of v with weights: Σ w f(v) is the expectation of f
bounded             a shape whose standard value no longer moves at great scores
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.tolerance.distributions import Distribution

__all__ = ["ShapeRule", "gauss_rule", "pulled_in", "shape_rule"]

_FITTED, _HEAVY_FITTED = 6.0, 4.0
"""Scores between which the variable runs from −1 to 1; the latter for shapes with heavy tails."""

_REACH = 1.5
"""Tails that go further than this, in half ranges, are heavy: no polynomial is to be asked so far from its nodes."""

_PULL = float(np.tanh(1.0))
"""What makes −1 and 1 stay where heavy tails are pulled in."""

_OUTER = 8.0
"""Scores at which the trapezoidal rule ends; beyond lies 1e-15."""

_SETTLED = 1e-3
"""Part of its range by which a bounded shape still moves beyond the fitted scores."""

_PANELS, _PER_PANEL = 249, 16
"""Panels and nodes in each of the fine rule that stands for a shape's measure."""

_RULES: dict[tuple[object, ...], ShapeRule | tuple[Array, Array]] = {}
_MOST_RULES = 512
"""Rules that are kept for the next rows of their shapes; more are made anew."""

_FEW_NODES = 100
"""Nodes up to which one thread serves NumPy's own linear algebra; SciPy's takes 0.1 s and 20 MB to load."""


@dataclass(frozen=True, kw_only=True)
class ShapeRule:
    """A rule of a shape: `variables` and `weights` (nodes,); v = x = (standard value − `middle`)/`half`.

    `median` is the variable of the median. `resolved` is the greatest frequency, in radians per unit of v, of a wave
    whose expectation the rule gives to 1e-8; for a shape that is not bounded the wave's own decay has to do its part.
    Where tails are `heavy` v = tanh(x)/tanh(1), which is as smooth and has an end.
    """

    middle: float
    half: float
    median: float
    variables: Array
    weights: Array
    resolved: float
    heavy: bool

    def variable(self, standard: Array) -> Array:
        """Return the variables of standard values, in their shape."""
        variable = (standard - self.middle) / self.half
        return pulled_in(variable) if self.heavy else variable

    def standard(self, variable: Array) -> Array:
        """Return the standard values of variables, in their shape."""
        return self.middle + self.half * (np.arctanh(variable * _PULL) if self.heavy else variable)


def shape_rule(distribution: Distribution, nodes: int) -> ShapeRule:
    """Return the rule of so many nodes for a distribution's shape.

    Equation: E f(v) = Σ w_q f(v_q): Gauss's rule of the shape's own measure where it is bounded, which kinks of the
        density do not disturb; else the trapezoidal rule in the score
    Arguments: a distribution, whose shape alone matters; an odd number of nodes.
    Valid: e^{iωv} of a bounded shape for ω up to 1.1 × nodes, of a normal one where
        ω dv/dscore stays below 2π/h − 6, the step h = 16/(nodes − 1).
    Source: Golub and Welsch 1969; Trefethen and Weideman 2014 (trapezoidal rule).

    >>> from flexlash.tolerance.distributions import Uniform
    >>> rule = shape_rule(Uniform(0, 1), 41)
    >>> round(float((rule.weights * np.cos(30 * rule.variables)).sum() - np.sin(30) / 30), 9) == 0
    True
    """
    key = (distribution.shape, nodes)
    rule = _RULES.get(key)
    if not isinstance(rule, ShapeRule):
        rule = _made(distribution, nodes)
        if len(_RULES) < _MOST_RULES:
            _RULES[key] = rule
    return rule


def pulled_in(variable: Array) -> Array:
    """Return variables whose heavy tails are pulled in: −1, 0 and 1 stay."""
    return np.asarray(np.tanh(variable) / _PULL)


def _made(distribution: Distribution, nodes: int) -> ShapeRule:
    score = np.linspace(-_OUTER, _OUTER, nodes)
    ends = np.array([-_OUTER, -_FITTED, -_HEAVY_FITTED, 0.0, _HEAVY_FITTED, _FITTED, _OUTER])
    lowest, low, low_heavy, median, high_heavy, high, highest = distribution.standard_at(ends).tolist()
    middle, half = (low + high) / 2, (high - low) / 2
    heavy = max(highest - middle, middle - lowest) > _REACH * half
    if heavy:
        middle, half = (low_heavy + high_heavy) / 2, (high_heavy - low_heavy) / 2
    bare = ShapeRule(
        middle=middle, half=half, median=0.0, variables=score, weights=score, resolved=1.1 * nodes, heavy=heavy
    )
    bare = replace(bare, median=float(bare.variable(np.array(median))))
    if max(highest - high, low - lowest) <= _SETTLED * half:
        standard, weights = gauss_rule(distribution, nodes)
        return replace(bare, variables=bare.variable(standard), weights=weights)
    variables, weights = bare.variable(distribution.standard_at(score)), np.exp(-score * score / 2)
    step = float(score[1] - score[0])
    # What is pulled in has waves of its own.
    resolved = (
        (0.5 if heavy else 1.0) * (2 * np.pi / step - _FITTED) / float(np.abs(np.gradient(variables, step)).max())
    )
    return replace(bare, variables=variables, weights=weights / weights.sum(), resolved=resolved)


def gauss_rule(distribution: Distribution, nodes: int) -> tuple[Array, Array]:
    """Return the nodes and weights of the Gauss rule for a distribution's standard shape, (nodes,) each.

    Equation: ∫ f(x) dF(x) = Σ wᵢ f(xᵢ)
    Arguments: a distribution, whose shape alone matters.
    Valid: exact for a polynomial of degree 2 nodes − 1.
    Source: Stieltjes' recurrence on a fine rule in the score; Golub and Welsch 1969.

    >>> from flexlash.tolerance.distributions import Normal
    >>> found, weights = gauss_rule(Normal(0, 1), 5)
    >>> round(float((weights * found**8).sum()), 6)
    105.0
    """
    key = ("gauss", distribution.shape, nodes)
    rule = _RULES.get(key)
    if not isinstance(rule, tuple):
        scores, mass = _fine_rule(distribution.breaks)
        rule = _stieltjes(distribution.standard_at(scores), mass, nodes)
        if len(_RULES) < _MOST_RULES:
            _RULES[key] = rule
    return rule


def _fine_rule(breaks: tuple[float, ...]) -> tuple[Array, Array]:
    """Return scores and the normal mass at each: Gauss–Legendre in panels that end at the breaks."""
    reach = 8.3
    ends = np.unique([*np.linspace(-reach, reach, _PANELS + 1), *breaks])
    inside, weights = np.polynomial.legendre.leggauss(_PER_PANEL)
    half = np.diff(ends)[:, None] / 2
    scores = (ends[:-1, None] + half * (1 + inside)).ravel()
    mass = (half * weights).ravel() * np.exp(-scores * scores / 2)
    return scores, mass / mass.sum()


def _stieltjes(values: Array, mass: Array, nodes: int) -> tuple[Array, Array]:
    """Return the Gauss rule of a discrete measure by its three-term recurrence."""
    middle, half = (values.max() + values.min()) / 2, (values.max() - values.min()) / 2
    values = (values - middle) / half
    before, now = np.zeros_like(values), np.ones_like(values) / np.sqrt(mass.sum())
    diagonal: list[float] = []
    beside: list[float] = []
    for order in range(nodes):
        centre = float((mass * values * now * now).sum())
        diagonal.append(centre)
        after = (values - centre) * now - (beside[-1] if order else 0.0) * before
        size = float(np.sqrt((mass * after * after).sum()))
        if order < nodes - 1:
            beside.append(size)
            before, now = now, after / size
    found, vectors = _eigen(diagonal, beside)
    return middle + half * found, vectors[0] ** 2


def _eigen(diagonal: list[float], beside: list[float]) -> tuple[Array, Array]:
    """Return eigenvalues and eigenvectors of a symmetric tridiagonal matrix."""
    if len(diagonal) <= _FEW_NODES:
        return np.linalg.eigh(np.diag(diagonal) + np.diag(beside, 1) + np.diag(beside, -1))
    from scipy.linalg import eigh_tridiagonal

    # Implicit QL, the only driver whose bits do not depend on how many threads the linear algebra has.
    return cast("tuple[Array, Array]", eigh_tridiagonal(diagonal, beside, lapack_driver="stev"))
