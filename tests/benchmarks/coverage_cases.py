"""The cases of `coverage.py`: models with their inputs, and what is known of their output without the engine."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from coverage_truths import (
    CHAIN,
    GAUGE_BLOCK,
    HEAVY,
    SDS,
    UNIFORM,
    WIDE,
    gauge_block,
    gauge_block_truth,
    heavy_truth,
    lognormal_truth,
    normal_sum_truth,
    pair_truth,
    products_truth,
    rounded,
    rounded_truth,
    saddle_truth,
    sum_of_products,
)
from exact_laws import Truth, additive, identity
from wind_up_law import WindUpLaw, inputs_of, wind_up

from flexlash.tolerance import Lognormal, Measured, Normal, Triangular, TruncatedNormal, Uniform


@dataclass(frozen=True, kw_only=True)
class Case:
    """A model, its inputs, how they are correlated, which scatter between lots, and what gives the truth."""

    model: Callable
    inputs: Mapping[str, object]
    truth: Callable[[], Truth]
    correlation: Mapping[tuple[str, str], float] = field(default_factory=dict)
    correlation_of: str = "scores"
    between: tuple[str, ...] = ()


def total(**inputs):
    """Return the sum."""
    first, *others = inputs.values()
    return sum(others, first)


def product(**inputs):
    """Return the product of 1 + 0.02 x."""
    return math.prod(1 + 0.02 * one for one in inputs.values())


def plain_product(**inputs):
    """Return the product."""
    return math.prod(inputs.values())


def alike(count, one):
    """Return inputs of one kind."""
    return {f"x{place}": one for place in range(count)}


def summed(inputs, *, between=(), **known):
    """Return the case of a sum."""
    return Case(
        model=total,
        inputs=inputs,
        between=between,
        truth=lambda: additive(inputs, between=between, **known),
    )


def multiplied(inputs, *, between=()):
    """Return the case of a product of 1 + 0.02 x."""
    return Case(
        model=product,
        inputs=inputs,
        between=between,
        truth=lambda: additive(inputs, lambda value: np.log1p(0.02 * value), np.exp, between=between),
    )


def wound(inputs, *, correlation=0.0, of="scores", scores=0.0, error=1e-7):
    """Return the case of a wind-up; `scores` is the correlation of wall's and disk's scores."""
    return Case(
        model=wind_up,
        inputs=inputs,
        truth=lambda: WindUpLaw(inputs, correlation=scores).truth(shares=not scores, error=error),
        correlation={("wall", "disk"): correlation} if correlation else {},
        correlation_of=of,
    )


NORMAL, TRIANGULAR = Normal(0, 1), Triangular(-1, 1)
TRUNCATED = TruncatedNormal(0, 1, -2, 2)
MIXED = {
    "x0": Normal(0, 1),
    "x1": Uniform(-2, 2),
    "x2": Triangular(-2, 2),
    "x3": TruncatedNormal(0, 1, -1, 1),
    "x4": Normal(0, 0.5),
}
REFERENCE = {
    "l": Uniform(0.1598, 0.1602),
    "wall": Uniform(0.00155, 0.00165),
    "disk": Uniform(0.00155, 0.00165),
    "r_m": Normal(0.08, 2e-5),
    "r_ci": Uniform(0.03985, 0.04015),
    "E": Normal(211e9, 2.11e9),
    "nu": Uniform(0.28, 0.32),
}


def exponential(**inputs):
    """Return the exponential of the sum."""
    return np.exp(total(**inputs))


def inverse_sum(**inputs):
    """Return the sum of the inverse numbers."""
    return sum(1 / one for one in inputs.values())


def soft_maximum(**inputs):
    """Return twice the logarithm of the sum of exponentials of half the inputs, a soft maximum."""
    return 2 * np.log(sum(np.exp(one / 2) for one in inputs.values()))


def measured(count, seed):
    """Return a measured sample of a skew process."""
    return Measured(np.random.default_rng(seed).gamma(6.0, 0.4, count))


def cases():
    """Return the cases by name."""
    alike_14 = alike(14, UNIFORM)
    inverse_inputs = {name: Uniform(0.05, 1) for name in "ab"}
    steep = alike(2, Normal(0, 2))
    steep_uniform = alike(8, Uniform(-1.5, 1.5))
    soft = alike(4, NORMAL)
    lognormals = {"a": Lognormal(2.0, 0.4), "b": Lognormal(1.0, 0.1), "c": Lognormal(3.0, 0.9)}
    measured_inputs = {"a": measured(60, 1), "b": measured(25, 2), "c": measured(200, 3), **alike(2, NORMAL)}
    return {
        "product of 2 normal": multiplied(alike(2, NORMAL), between=("x0",)),
        "product of 7 normal": multiplied(alike(7, NORMAL), between=("x0", "x1")),
        "product of 14 normal": multiplied(alike(14, NORMAL)),
        "sum of 2 uniform": summed(alike(2, UNIFORM)),
        "sum of 4 uniform": summed(alike(4, UNIFORM), between=("x0",)),
        "sum of 14 uniform": summed(alike_14),
        "product of 14 uniform of 10 %": multiplied(alike(14, Uniform(-5, 5))),
        "product of 4 uniform of 20 %": multiplied(alike(4, Uniform(-10, 10)), between=("x0", "x1")),
        "sum of 3 triangular": summed(alike(3, TRIANGULAR)),
        "product of 8 triangular": multiplied(alike(8, TRIANGULAR)),
        "sum of 6 triangular, mode at 0.2": summed(alike(6, Triangular(0, 1, 0.2)), between=("x0", "x1", "x2")),
        "sum of 5 truncated": summed(alike(5, TRUNCATED)),
        "product of 5 truncated, shifted": multiplied(alike(5, TruncatedNormal(1, 1, -3, 3)), between=("x0",)),
        "sum, mixed": summed(MIXED, between=("x0", "x1")),
        "product, mixed": multiplied(MIXED, between=("x0", "x2")),
        "uniform 100:1 to 4 uniform": summed({"y": Uniform(-100, 100), **alike(4, UNIFORM)}),
        "triangular 100:1 to 4": summed({"y": Triangular(-100, 100), **alike(4, TRIANGULAR)}),
        "uniform 100:1 to 4 normal": summed({"y": Uniform(-100, 100), **alike(4, NORMAL)}),
        "normal 100:1 to 4 uniform": summed({"y": Normal(0, 100), **alike(4, UNIFORM)}),
        "product, 1 uniform of 6": multiplied({"y": Uniform(-2, 2), **alike(5, NORMAL)}),
        "product, 1 triangular of 4": multiplied({"y": Triangular(-4, 4), **alike(3, NORMAL)}),
        "sum, 1 skew truncated of 3": summed({"y": TruncatedNormal(0, 1, -0.5, 3), **alike(2, NORMAL)}),
        "wind-up, 5 uniform of 7": wound(REFERENCE),
        "wind-up, normal": wound(inputs_of("normal")),
        "wind-up, uniform": wound(inputs_of("uniform"), error=5e-6),
        "wind-up, triangular": wound(inputs_of("triangular"), error=5e-6),
        "wind-up, walls correlated": wound(REFERENCE, correlation=0.813473286, scores=0.813473286),
        "wind-up, walls' values correlated": wound(
            REFERENCE, correlation=0.5, of="values", scores=2 * math.sin(math.pi / 12)
        ),
        "normal sum, correlated": Case(
            model=total,
            inputs={f"x{place}": Normal(0, sd) for place, sd in enumerate(SDS)},
            truth=normal_sum_truth,
            correlation=CHAIN,
        ),
        "exp of 2 normal, correlated": Case(
            model=exponential,
            inputs=alike(2, Normal(0, 0.3)),
            truth=lambda: lognormal_truth(0.3 * math.sqrt(2 * 1.7), {}),
            correlation={("x0", "x1"): 0.7},
        ),
        "2 uniform, correlated, 1 normal": Case(
            model=total,
            inputs={"x0": UNIFORM, "x1": Uniform(-2, 2), "x2": Normal(0, 0.3)},
            truth=pair_truth,
            correlation={("x0", "x1"): -0.9},
        ),
        "lognormal product": Case(
            model=plain_product,
            inputs=lognormals,
            truth=lambda: additive(lognormals, np.log, np.exp, between=("c",)),
            between=("c",),
        ),
        "sum, 3 measured of 5": summed(measured_inputs, between=("a",)),
        "sum of 2 Student 5": Case(model=total, inputs=HEAVY, truth=heavy_truth),
        "steep: exp of 2 normal of sd 2": Case(
            model=exponential,
            inputs=steep,
            truth=lambda: lognormal_truth(2 * math.sqrt(2), {}),
        ),
        "steep: exp of 8 uniform": Case(
            model=exponential,
            inputs=steep_uniform,
            truth=lambda: additive(steep_uniform, identity, np.exp),
        ),
        "steep: 1/a + 1/b": Case(
            model=inverse_sum,
            inputs=inverse_inputs,
            truth=lambda: additive(inverse_inputs, lambda value: 1 / value, error=1e-7),
        ),
        "interacting: soft maximum of 4": Case(
            model=soft_maximum,
            inputs=soft,
            truth=lambda: additive(
                soft, lambda value: np.exp(value / 2), lambda value: 2 * np.log(np.maximum(value, 1e-9)), error=1e-6
            ),
        ),
        "interacting: ab + cd": Case(model=sum_of_products, inputs=WIDE, truth=products_truth),
        "interacting: ab of no mean": Case(model=plain_product, inputs=alike(2, NORMAL), truth=saddle_truth),
        "steps of a tenth": Case(model=rounded, inputs=alike(2, NORMAL), truth=rounded_truth),
        "gauge block, JCGM 101 9.5": Case(model=gauge_block, inputs=GAUGE_BLOCK, truth=gauge_block_truth),
    }
