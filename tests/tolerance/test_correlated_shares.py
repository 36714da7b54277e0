"""Shares of correlated inputs: Shapley's value of clusters in closed form, and Sobol' indices of all others."""

import math
from itertools import permutations

import numpy as np
import pytest
from line_models import row_model

from flexlash.tolerance import Normal, Uniform, propagate
from flexlash.tolerance.correlation import CorrelationMatrix, score_factor
from flexlash.tolerance.engine.correlated_line_shares import correlated_line_shares
from flexlash.tolerance.engine.line_direction import Inputs
from flexlash.tolerance.shapley_weights import EXACT_SIZE

each_method = pytest.mark.parametrize("method", ["line", "sobol", "random"])


def matrix_of(pairs, names):
    """Return the correlations of names by their pairs."""
    return CorrelationMatrix.of([(*pair, value) for pair, value in pairs.items()], names).scores


def shapley_of_linear(slopes, matrix):
    """Return Shapley's shares of Σ slope · u with these correlations: what each adds in the mean over all orders.

    Var(E[y | u_S]) = c_Sᵀ R_SS⁻¹ c_S with c = R · slopes (Owen and Prieur 2017, section 4).
    """
    common = matrix @ slopes

    def known(members):
        inside = list(members)
        return common[inside] @ np.linalg.pinv(matrix[np.ix_(inside, inside)]) @ common[inside] if inside else 0.0

    shares = np.zeros(len(slopes))
    orders = list(permutations(range(len(slopes))))
    for order in orders:
        for count, member in enumerate(order):
            shares[member] += (known(order[: count + 1]) - known(order[:count])) / len(orders)
    return shares / (slopes @ common)


def linear(slopes):
    """Return a linear model of inputs by name."""
    return lambda **inputs: sum(slope * values for slope, values in zip(slopes, inputs.values(), strict=True))


def held(spread, exact, of=("shares", "total_shares")):
    """Assert that shares are the exact ones within four standard errors, and that these are small."""
    for name in of:
        values, errors = getattr(spread, name), getattr(spread, f"{name}_standard_error")
        for key, value in exact.items():
            assert abs(values[key] - value) <= 4 * errors[key] + 1e-9, (name, key, values[key], value, errors[key])
            assert errors[key] <= 0.025, (name, key)


@each_method
@pytest.mark.parametrize(
    "pairs",
    [
        {("a", "b"): 0.5, ("a", "c"): 0.2, ("b", "c"): -0.3},
        {("a", "b"): 0.9, ("b", "c"): 0.9, ("a", "c"): 0.7},
        {("a", "b"): -0.6},
        {("a", "b"): 0.6, ("c", "d"): -0.8},
        {("a", "b"): 1.0, ("b", "c"): -0.4, ("a", "c"): -0.4},
        {("a", "b"): 1.0, ("b", "c"): 1.0, ("a", "c"): 1.0},
    ],
    ids=["three", "chain", "two", "two clusters", "one follows", "all follow one"],
)
def test_linear_models_of_normals_in_closed_form(method, pairs):
    """In a linear model of correlated normals shares are the closed form's, first-order and total, and sum to 1."""
    slopes = np.array([1.0, 2.0, -1.0, 0.5])
    inputs = {name: Normal(0, 1) for name in "abcd"}
    spread = propagate(linear(slopes), inputs, method=method, correlation=pairs, samples=2**15)
    exact = shapley_of_linear(slopes, matrix_of(pairs, list(inputs)))
    held(spread, dict(zip(inputs, exact, strict=True)))
    assert sum(spread.shares.values()) == pytest.approx(1, abs=0.03)


@pytest.mark.parametrize("correlation", [-0.9, 0.3, 1.0])
def test_two_normals_as_printed(correlation):
    """Of two normals Owen and Prieur 2017, section 4.1, print σ₁²(1 − ρ²/2) + ρσ₁σ₂ + ρ²σ₂²/2 for the first."""
    first, second = 1.0, 2.0
    pair = {"a": Normal(5, first), "b": Normal(0, second)}
    spread = propagate(lambda a, b: a + b, pair, correlation={("b", "a"): correlation})
    variance = first**2 + second**2 + 2 * correlation * first * second
    cross = correlation * first * second
    own = first**2 * (1 - correlation**2 / 2) + cross + correlation**2 * second**2 / 2
    held(spread, {"a": own / variance, "b": 1 - own / variance})


@each_method
def test_inputs_outside_clusters_keep_their_sobol_indices(method):
    """Of an additive model an input outside clusters causes its variance, what is in them the rest by halves."""
    inputs = {name: Uniform(0, 1) for name in "abc"}
    spread = propagate(
        lambda a, b, c: a + 2 * b + 2 * c, inputs, method=method, correlation={("b", "c"): 0.7}, correlation_of="values"
    )
    total = 1 + 4 + 4 + 2 * 0.7 * 4
    held(spread, {"a": 1 / total, "b": (1 - 1 / total) / 2, "c": (1 - 1 / total) / 2})


@each_method
def test_interaction_is_what_first_order_shares_leave(method):
    """In (a + b) · c with a, b tied and all centred nothing causes anything by itself, and each total is exact."""
    inputs = {name: Normal(0, 1) for name in "abc"}
    model = lambda a, b, c: (a + b) * c  # noqa: E731
    spread = propagate(model, inputs, method=method, correlation={("a", "b"): 0.5}, samples=2**15)
    held(spread, {"a": 0.0, "b": 0.0, "c": 0.0}, of=["shares"])
    held(spread, {"a": 0.5, "b": 0.5, "c": 1.0}, of=["total_shares"])


def test_product_of_correlated_lognormals():
    """In exp(0.3 (a + b) + 0.2 c) a and b have equal shares, and c its closed Sobol' index."""
    inputs = {name: Normal(0, 1) for name in "abc"}
    spread = propagate(lambda a, b, c: np.exp(0.3 * (a + b) + 0.2 * c), inputs, correlation={("a", "b"): 0.6})
    cluster, alone = math.expm1(0.09 * 3.2), math.expm1(0.04)
    both = (1 + cluster) * (1 + alone) - 1
    held(spread, {"a": cluster / both / 2, "b": cluster / both / 2, "c": alone / both}, of=["shares"])
    together = cluster * (1 + alone) / both
    held(spread, {"a": together / 2, "b": together / 2, "c": alone * (1 + cluster) / both}, of=["total_shares"])


@each_method
def test_curved_effects_of_a_single_cluster(method):
    """In exp(a/2) + b² both shares are those of the Hermite series, and the total ones the same: all is one cluster.

    exp(a/2) is e^(1/8) Σ 2⁻ⁿ/√n! hₙ, b² is 1 + √2 h₂, and what is expected of h₂ of the other input is ρ² h₂.
    """
    rho = 0.6
    spread = propagate(
        lambda a, b: np.exp(0.5 * a) + b**2,
        {"a": Normal(0, 1), "b": Normal(0, 1)},
        method=method,
        correlation={("a", "b"): rho},
        samples=2**15,
    )
    common = math.exp(0.125) / 4 * 2 * rho**2
    of_a = math.exp(0.25) * math.expm1(0.25) + 2 * rho**4 + common
    of_b = math.exp(0.25) * math.expm1(0.25 * rho**2) + 2 + common
    both = math.exp(0.25) * math.expm1(0.25) + 2 + common
    first = (of_a + both - of_b) / 2 / both
    held(spread, {"a": first, "b": 1 - first})


@pytest.mark.slow
def test_an_event_that_no_point_of_the_shares_meets_has_unknown_shares():
    """Where the points behind shares see nothing of what varies, the told errors say that nothing is known."""
    inputs = {"a": Normal(0, 1), "b": Normal(0, 1)}
    rare = lambda a, b: np.where(a + b > 6.5, 1.0, 0.0)  # noqa: E731
    spread = propagate(rare, inputs, method="random", samples=2**20, correlation={("a", "b"): 0.2})
    assert spread.sd > 0
    assert spread.total_shares_standard_error == {"a": 1.0, "b": 1.0}


@pytest.mark.slow
def test_large_clusters_by_orders_drawn():
    """A cluster too large for all its coalitions has the closed form's shares within their told errors."""
    size = EXACT_SIZE + 1
    names = [f"x{index}" for index in range(size)]
    pairs = {
        (one, other): 0.5 ** (place - index)
        for place, other in enumerate(names)
        for index, one in enumerate(names[:place])
    }
    slopes = np.linspace(-1, 2, size)
    matrix = matrix_of(pairs, names)
    inputs = {name: Normal(0, 1) for name in names}
    spread = propagate(linear(slopes), inputs, method="sobol", samples=2**12, correlation=pairs)
    by_subsets = np.zeros(size)
    common = matrix @ slopes
    for mask in range(1, 2**size):
        inside = [index for index in range(size) if mask >> index & 1]
        known = common[inside] @ np.linalg.solve(matrix[np.ix_(inside, inside)], common[inside])
        joining = 1 / (size * math.comb(size - 1, len(inside) - 1))
        staying = -1 / (size * math.comb(size - 1, len(inside))) if len(inside) < size else 0.0
        by_subsets += [known * (joining if index in inside else staying) for index in range(size)]
    held(spread, dict(zip(names, by_subsets / (slopes @ common), strict=True)))
    assert max(spread.shares_standard_error.values()) > 1e-4


@pytest.mark.slow
def test_told_errors_of_shares_are_honest():
    """Over 40 seeds shares lie within 1.96 told errors of their mean over 40 others in 90 to 100 % of all cases."""
    inputs = {"a": Uniform(1, 2), "b": Uniform(1, 2), "c": Normal(3, 0.4)}
    model = lambda a, b, c: a * b**2 / c  # noqa: E731
    for method, samples in (("line", 256), ("sobol", 2**12)):
        spreads = [
            propagate(model, inputs, method=method, samples=samples, seed=seed, correlation={("a", "b"): 0.6})
            for seed in range(80)
        ]
        shares = np.array([list(spread.shares.values()) for spread in spreads])
        errors = np.array([list(spread.shares_standard_error.values()) for spread in spreads])
        inside = np.abs(shares[:40] - shares[40:].mean(axis=0)) <= 1.96 * errors[:40]
        assert 0.9 <= inside.mean() <= 1, method


@pytest.mark.slow
def test_rows_keep_their_bits_beside_others():
    """The shares of a row are the same to the bit alone, with others, and in another order."""
    rows = [{"a": Uniform(1, 2 + step), "b": Normal(5, 0.1 + step), "c": Uniform(0, 1)} for step in (0.0, 0.5, 1.0)]
    factor = score_factor(matrix_of({("a", "b"): 0.6}, ["a", "b", "c"]), [0, 2, 1])
    model = row_model(lambda a, b, c: a * b + np.exp(c))
    variance = np.ones(3), np.zeros(3)
    together = correlated_line_shares(model, Inputs.of(rows, factor), variance, 3)
    for order in ([0], [2], [2, 0, 1]):
        chosen = Inputs.of([rows[index] for index in order], factor)
        found = correlated_line_shares(model, chosen, (variance[0][order], variance[1][order]), 3)
        assert np.array_equal(found, together[:, :, order])


def test_a_model_that_refuses_points_far_out_still_has_shares():
    """A model that cannot answer where none of its points lies has shares all the same."""

    def model(a, b):
        if np.abs(a).max() > 4.7:
            raise ValueError("too far")
        return a + b

    inputs = {"a": Normal(0, 1), "b": Normal(0, 1)}
    spread = propagate(model, inputs, method="sobol", samples=2**13, correlation={("a", "b"): 0.5})
    held(spread, {"a": 0.5, "b": 0.5})


def test_nothing_is_shared_out_of_an_output_that_does_not_vary():
    """Inputs of a constant model cause nothing, by every method."""
    inputs = {"a": Normal(0, 1), "b": Normal(0, 1)}
    for method in ("line", "sobol", "random"):
        spread = propagate(lambda a, b: 0 * a + 0 * b + 3, inputs, method=method, correlation={("a", "b"): 0.5})
        assert spread.shares == spread.total_shares == {"a": 0.0, "b": 0.0}
