"""Models whose Sobol' indices are known in closed form: of two and more inputs, additive, products, heavy tails."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from flexlash.tolerance import Normal, Triangular, Uniform
from flexlash.tolerance.distributions import Distribution
from flexlash.tolerance.spread import Spread
from flexlash.tolerance.student import Student

__all__ = ["KNOWN", "KnownShares", "errors_of"]


@dataclass(frozen=True, kw_only=True)
class KnownShares:
    """A model with its inputs, its first-order indices and its total ones."""

    model: Callable[..., np.ndarray]
    inputs: Mapping[str, Distribution]
    first: tuple[float, ...]
    total: tuple[float, ...]


def errors_of(spread: Spread, known: KnownShares) -> tuple[np.ndarray, np.ndarray]:
    """Return by how much first-order and total indices are off, and their standard errors."""
    found = [*spread.shares.values(), *spread.total_shares.values()]
    told = [*spread.shares_standard_error.values(), *spread.total_shares_standard_error.values()]
    assert list(spread.shares) == list(spread.total_shares) == list(spread.shares_standard_error) == list(known.inputs)
    return np.abs(np.array(found) - (*known.first, *known.total)), np.array(told)


def _additive(model, inputs, parts):
    """Return what is known of a sum whose terms have these variances."""
    shares = tuple(np.array(parts) / sum(parts))
    return KnownShares(model=model, inputs=dict(zip("abcdefg", inputs, strict=False)), first=shares, total=shares)


def _product(model, inputs):
    """Return what is known of a product of factors, each with its squared coefficient of variation."""
    squares = np.array([square for _, square in inputs])
    whole = (1 + squares).prod()
    named = dict(zip("abcdefg", (distribution for distribution, _ in inputs), strict=False))
    return KnownShares(
        model=model,
        inputs=named,
        first=tuple(squares / (whole - 1)),
        total=tuple(squares / (1 + squares) * whole / (whole - 1)),
    )


_TWELFTH = 1 / 12
"""Variance of a uniform of width 1, such as b in the bilinear model; that of (b − E b)² is 1/180."""

_BILINEAR = np.array([9, 36, 9]) * _TWELFTH + np.array([0, 1, 0]) / 180
_PAIRED = _TWELFTH**2

_FACTORS = [(Normal(10, 0.5), 0.0025), (Normal(10, 1), 0.01), (Uniform(8, 12), 4 / 300)]
_SEVEN = [(Normal(0, 0.5), math.exp(0.25) - 1)] * 7

KNOWN = {
    "linear": _additive(lambda a, b: a + 2 * b, [Normal(0, 1), Triangular(-1, 1)], [1, 4 / 6]),
    "reciprocals": _additive(lambda a, b: 1 / a + 1 / b, [Uniform(0.05, 1)] * 2, [1, 1]),
    "heavy tails": _additive(lambda a, b: 2 * a + b, [Student(0.0, 1.0, 5.0)] * 2, [4, 1]),
    "product": _product(lambda a, b, c: a * b * c, _FACTORS),
    "two exponentials": _product(lambda a, b: np.exp(a) * np.exp(b), [(Normal(0, 1), math.e - 1)] * 2),
    "seven exponentials": _product(lambda **all_: np.exp(sum(all_.values())), _SEVEN),
    "bilinear": KnownShares(
        model=lambda a, b, c: (a + b) * (b + c),
        inputs=dict.fromkeys("abc", Uniform(1, 2)),
        first=tuple(_BILINEAR / (_BILINEAR.sum() + 3 * _PAIRED)),
        total=tuple((_BILINEAR + 2 * _PAIRED) / (_BILINEAR.sum() + 3 * _PAIRED)),
    ),
}
