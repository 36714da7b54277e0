"""Correlated inputs of `propagate`: what it accepts and refuses, and what of correlated outputs is known exactly."""

import math

import numpy as np
import pytest
from grids import for_each
from scipy import integrate, special, stats

from flexlash.tolerance import Normal, Triangular, TruncatedNormal, Uniform, propagate
from flexlash.tolerance.correlated_inputs import correlation_factor, correlation_matrix

each_method = pytest.mark.parametrize("method", ["line", "sobol", "random"])

THREE = {"a": Uniform(0, 1), "b": Normal(1, 2), "c": Triangular(0, 1, 0.0)}


def lesser(a, b):
    """Return the lesser of two inputs."""
    return np.minimum(a, b)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"correlation": [("a", "b")]}, r"correlation = \[\('a', 'b'\)\]: a mapping of pairs of names to numbers is"),
        ({"correlation": {"ab": 0.5}}, "correlation has the pair 'ab': a tuple of two names is required"),
        ({"correlation": {("a", "b", "c"): 0.5}}, "a tuple of two names is required"),
        ({"correlation": {("a", 1): 0.5}}, "a tuple of two names is required"),
        ({"correlation": {("a", "b"): "x"}}, r"correlation\[\('a', 'b'\)\] = 'x': a finite number is required"),
        ({"correlation": {}, "correlation_of": 3}, "correlation_of = 3: one of scores, ranks, values is required"),
    ],
)
def test_other_kinds_of_arguments_are_refused(given, message):
    """An argument of another kind is a TypeError with its name and what is required."""
    with pytest.raises(TypeError, match=message):
        propagate(lambda a, b, c: a + b + c, THREE, **given)


@pytest.mark.parametrize(
    ("given", "of", "message"),
    [
        ({("a", "b"): math.nan}, "scores", "a finite number is required"),
        ({("a", "b"): 1.2}, "scores", r"correlation\[\('a', 'b'\)\] = 1.2: a number from -1 to 1 is required"),
        ({("a", "x"): 0.5}, "ranks", "x is none of the inputs that vary, which are a, b, c"),
        ({("a", "a"): 1.0}, "scores", "two different inputs are required"),
        ({("a", "b"): 0.5, ("b", "a"): 0.5}, "values", "each pair is required once, in either order"),
        ({("a", "b"): 0.5}, "rank", "one of scores, ranks, values is required; did you mean ranks?"),
        ({("a", "b"): 0.99}, "values", "can be correlated from -0.9772 to 0.9772"),
        (
            {("a", "b"): 0.9, ("b", "c"): 0.9, ("a", "c"): 0.5},
            "scores",
            r"correlation\[\('a', 'b'\)\] = 0.9 contradicts the other correlations; the nearest admissible .* 0.8274$",
        ),
        (
            {("a", "b"): 1, ("b", "c"): 0.123456789, ("a", "c"): 0.9},
            "scores",
            r"nearest admissible value is 0.5436",
        ),
    ],
)
def test_correlations_that_cannot_be_are_refused(given, of, message):
    """A correlation that cannot be is a ValueError with the pair, what was entered and what is required."""
    with pytest.raises(ValueError, match=message):
        propagate(lambda a, b, c: a + b + c, THREE, correlation=given, correlation_of=of)


@for_each("of", ["scores", "ranks", "values"])
def test_the_nearest_value_that_is_told_is_accepted(of):
    """Entered as it is told, the nearest admissible value is one, for each kind of correlation."""
    given = {("a", "b"): 0.8, ("b", "c"): 0.8, ("a", "c"): -0.2}
    with pytest.raises(ValueError, match="nearest admissible") as refusal:
        correlation_matrix(given, of, THREE)
    told = float(str(refusal.value).rpartition(" ")[2])
    changed = next(pair for pair in given if repr(pair) in str(refusal.value))
    assert correlation_matrix(given | {changed: told}, of, THREE).faults() == []


def test_where_an_input_follows_another_the_one_value_is_told_in_full():
    """Where rounding would leave the only admissible value, it is told with all its digits, and is accepted."""
    names = "abcd"
    inputs = {name: Normal(0, 1) for name in names}
    follow = {("a", "b"): 1, ("a", "d"): 1, ("b", "d"): 1}
    given = {**follow, ("a", "c"): 0.2, ("b", "c"): 0.123456789, ("d", "c"): 0.123456789}
    with pytest.raises(ValueError, match=r"\('a', 'c'\)\] = 0.2 .* is 0.123456") as refusal:
        correlation_matrix(given, "scores", inputs)
    told = float(str(refusal.value).rpartition(" ")[2])
    assert correlation_matrix(given | {("a", "c"): told}, "scores", inputs).faults() == []


def test_all_nearest_values_that_are_told_are_accepted():
    """Where no single pair fixes, all told values entered together are admissible, rounded as they are."""
    names = "abcd"
    inputs = {name: Uniform(0, 1) for name in names}
    given = {(one, other): -0.8 for index, one in enumerate(names) for other in names[:index]}
    with pytest.raises(ValueError, match="more than one pair; the nearest admissible values are") as refusal:
        correlation_matrix(given, "scores", inputs)
    for pair in given:
        assert f"{pair!r}: -0.333" in str(refusal.value)
    told = dict.fromkeys(given, -0.3331)
    assert correlation_matrix(told, "scores", inputs).faults() == []


@for_each("pair", [("a", "b"), ("a", "c"), ("b", "c")])
def test_ranks_and_values_correlate_as_was_asked(pair):
    """Of 2¹⁷ points Spearman's correlation, and Pearson's of the values, are those that were entered."""
    seen = {}

    def model(a, b, c):
        seen.update(a=a, b=b, c=c)
        return a + b + c

    for of, measured in (("ranks", stats.spearmanr), ("values", stats.pearsonr)):
        columns = {name: [] for name in pair}

        def collecting(columns=columns, **inputs):
            for name, values in columns.items():
                values.append(inputs[name])
            return sum(inputs.values())

        propagate(collecting, THREE, method="sobol", samples=2**15, correlation={pair: -0.6}, correlation_of=of)
        first, second = (np.concatenate(values) for values in columns.values())
        assert measured(first, second).statistic == pytest.approx(-0.6, abs=2e-3)


@each_method
@for_each("of", ["scores", "ranks", "values"])
def test_correlation_0_is_independence_to_the_bit(of, method):
    """With a correlation of 0 every number is that of independent inputs, bit for bit."""
    plain = propagate(lambda a, b, c: np.exp(a) + b + a * c, THREE, method=method, samples=512)
    given = {("a", "b"): 0.0, ("c", "a"): 0}
    tied = propagate(
        lambda a, b, c: np.exp(a) + b + a * c, THREE, method=method, samples=512, correlation=given, correlation_of=of
    )
    assert tied.method == plain.method
    assert np.array_equal(tied.quantile([0.01, 0.5, 0.99]), plain.quantile([0.01, 0.5, 0.99]))
    assert (tied.mean, tied.sd, tied.skewness, tied.shares) == (plain.mean, plain.sd, plain.skewness, plain.shares)


def test_factor_begins_with_what_is_not_normal():
    """A single input that is not normal keeps a score of its own, whatever it is tied to and where it stands."""
    inputs = {"b": Normal(0, 1), "c": Normal(0, 1), "a": Uniform(0, 1)}
    factor = correlation_factor({("a", "b"): 0.5, ("b", "c"): 0.5, ("a", "c"): 0.3}, "scores", inputs)
    assert factor[2].tolist() == [0, 0, 1]
    assert correlation_factor({("a", "b"): 0.0}, "scores", inputs) is None


@each_method
@for_each("correlation", [-1.0, -0.7, 0.4, 1.0])
def test_sum_of_correlated_normals(correlation, method):
    """A sum of correlated normals is normal with the variance s₁² + s₂² + 2 ρ s₁ s₂; lines are exact."""
    sd = math.sqrt(9 + 16 + 2 * correlation * 12)
    inputs = {"a": Normal(1, 3), "b": Normal(-2, 4)}
    spread = propagate(lambda a, b: a + b, inputs, method=method, correlation={("a", "b"): correlation})
    exact = stats.norm(-1, sd)
    assert abs(spread.mean + 1) <= 4 * spread.mean_standard_error + 1e-9 * sd
    assert abs(spread.sd - sd) <= 4 * spread.sd_standard_error + 1e-9 * sd
    for probability in (0.00135, 0.5, 0.975, 0.99865):
        allowed = 4 * spread.standard_error(probability) + 1e-9 * sd
        assert abs(spread.quantile(probability) - exact.ppf(probability)) <= allowed
    if method == "line":
        assert spread.method == "line"
        assert spread.quantile(0.99865) == pytest.approx(exact.ppf(0.99865), abs=1e-7 * sd)
        assert spread.probability_above(exact.isf(1e-9)) == pytest.approx(1e-9, rel=1e-6)


@for_each("correlation", [-0.5, 0.8, 1.0])
def test_product_of_correlated_lognormals(correlation):
    """A product of correlated lognormals is lognormal, its percentiles and mean those of the closed form."""
    inputs = {"a": Normal(0, 0.3), "b": Normal(0, 0.4)}
    spread = propagate(lambda a, b: np.exp(a) * np.exp(b), inputs, correlation={("a", "b"): correlation})
    sd = math.sqrt(0.09 + 0.16 + 2 * correlation * 0.12)
    exact = stats.lognorm(sd)
    assert spread.method == "line"
    assert spread.quantile(0.99865) == pytest.approx(exact.ppf(0.99865), rel=1e-6)
    assert abs(spread.mean - exact.mean()) <= 4 * spread.mean_standard_error + 1e-9
    assert abs(spread.sd - exact.std()) <= 4 * spread.sd_standard_error + 1e-9


@each_method
@for_each("correlation", [-0.6, 0.5, 0.9])
def test_probabilities_of_an_orthant(correlation, method):
    """P(min(a, b) > t) of correlated normals is scipy's bivariate normal probability."""
    pair = {"a": Normal(0, 1), "b": Normal(0, 1)}
    spread = propagate(lesser, pair, method=method, correlation={("a", "b"): correlation}, samples=2**14)
    law = stats.multivariate_normal([0, 0], [[1, correlation], [correlation, 1]])
    for limit in (-0.5, 0.0, 1.0):
        exact = law.cdf([-limit, -limit])
        low, high = spread.probability_interval(limit, confidence=0.9999)
        assert low <= exact <= high


@pytest.mark.slow
@for_each("correlation", [-0.9, 0.3, 0.95, 1.0])
def test_sum_of_correlated_uniforms_by_quadrature(correlation):
    """P(a + b > y) of two tied uniforms by lines is the integral over one score, within four errors of at most 1e-3."""
    inputs = {"a": Uniform(0, 1), "b": Uniform(0, 2)}
    spread = propagate(lambda a, b: a + b, inputs, correlation={("a", "b"): correlation})
    side = math.sqrt(1 - correlation**2)
    for output in (0.3, 1.4, 2.5):

        def above(score, output=output):
            wanted = (output - special.ndtr(score)) / 2
            density = math.exp(-score * score / 2) / math.sqrt(2 * math.pi)
            if side == 0:
                return density * (special.ndtr(correlation * score) > wanted)
            reach = special.ndtri(min(max(wanted, 0.0), 1.0))
            return density * special.ndtr((correlation * score - reach) / side)

        exact = integrate.quad(above, -9, 9, limit=400, points=(-2, 0, 2))[0]
        low, high = spread.probability_interval(output, confidence=0.99994)
        assert low - 1e-7 <= exact <= high + 1e-7
        assert high - low <= 8e-3


@each_method
@for_each("sign", [1.0, -1.0])
def test_an_input_that_follows_another(sign, method):
    """With ρ = ±1 two inputs are one: the spread is that of the model with the second put in as the first's."""
    inputs = {"a": Uniform(1, 2), "b": Triangular(0, 3, 1.0), "c": Normal(0, 0.2)}
    model = lambda a, b, c: a * (3 + b) + c  # noqa: E731
    tied = propagate(model, inputs, method=method, correlation={("a", "b"): sign}, seed=3)

    def of_one(a, c):
        return model(a, inputs["b"].standard(a - 1 if sign > 0 else 2 - a) * 3, c)

    alone = propagate(of_one, {"a": inputs["a"], "c": inputs["c"]}, method=method, seed=4)
    for probability in (0.00135, 0.025, 0.5, 0.975, 0.99865):
        error = math.hypot(tied.standard_error(probability), alone.standard_error(probability))
        assert abs(tied.quantile(probability) - alone.quantile(probability)) <= 4 * error + 1e-9
    assert abs(tied.sd - alone.sd) <= 4 * math.hypot(tied.sd_standard_error, alone.sd_standard_error) + 1e-9


def test_a_chain_of_followers_is_one_input():
    """Three inputs in a chain of ρ = 1 and −1 have the spread of one, and none is left over."""
    inputs = {"a": Uniform(0, 1), "b": Uniform(0, 1), "c": Uniform(0, 1)}
    given = {("a", "b"): 1, ("b", "c"): -1, ("a", "c"): -1}
    spread = propagate(lambda a, b, c: 2 * a + b + c, inputs, correlation=given)
    assert spread.method == "line"
    assert spread.quantile([0.00135, 0.3, 0.99865]) == pytest.approx([1.0027, 1.6, 2.9973], abs=1e-6)
    assert spread.sd == pytest.approx(2 / math.sqrt(12), rel=1e-3)


@pytest.mark.slow
@for_each("rho", [0.9, 0.5])
def test_lines_agree_with_brute_force(rho):
    """For a chain of four shapes lines agree with 10⁶ plain draws of a Cholesky factor, within four errors."""
    inputs = {"a": Uniform(1, 2), "b": Normal(5, 0.4), "c": Triangular(0, 1), "d": TruncatedNormal(3, 0.5, 2, 4)}
    names = list(inputs)
    matrix = np.array([[rho ** abs(row - column) for column in range(4)] for row in range(4)])
    given = {(names[i], names[j]): matrix[i, j] for i in range(4) for j in range(i)}
    model = lambda a, b, c, d: a * b / (1 + c) + d**2  # noqa: E731
    spread = propagate(model, inputs, correlation=given)
    assert spread.method == "line"
    generator = np.random.default_rng(11)
    draws = np.linalg.cholesky(matrix) @ generator.normal(size=(4, 1_000_000))
    values = [
        one.location + one.scale * one.standard_at(score) for one, score in zip(inputs.values(), draws, strict=True)
    ]
    output = model(*values)
    for probability in (0.00135, 0.025, 0.5, 0.975, 0.99865):
        low, high = max(probability - 1e-3, probability / 2), min(probability + 1e-3, (1 + probability) / 2)
        slope = (np.quantile(output, high) - np.quantile(output, low)) / (high - low)
        error = math.sqrt(probability * (1 - probability) / output.size) * slope
        allowed = 4 * math.hypot(error, spread.standard_error(probability))
        assert abs(spread.quantile(probability) - np.quantile(output, probability)) <= allowed
    assert abs(spread.mean - output.mean()) <= 4 * math.hypot(spread.mean_standard_error, output.std() / 1000)


@each_method
def test_lots_and_parts_that_are_correlated_among_themselves(method):
    """With correlated lots, and correlated parts, the split and the share of lots that fail are those of the integral.

    In a lot with a and c the output a b + c d is normal about 5 a + 3 c with the variance of its correlated parts.
    """
    inputs = {"a": Normal(10, 1), "b": Normal(5, 0.3), "c": Normal(4, 0.5), "d": Normal(3, 0.2)}
    lots, parts = 0.5, -0.4
    spread = propagate(
        lambda a, b, c, d: a * b + c * d,
        inputs,
        method=method,
        samples=2**14 if method == "line" else 2**17,
        correlation={("a", "c"): lots, ("d", "b"): parts},
        between={"a", "c"},
    )
    within = math.sqrt(0.09 * 101 + 0.04 * 16.25 + 2 * parts * 0.06 * (40 + lots * 0.5))
    between = math.sqrt(25 + 9 * 0.25 + 2 * lots * 5 * 3 * 0.5)
    assert abs(spread.within_lot_sd - within) <= 4 * spread.within_lot_sd_standard_error
    assert abs(spread.between_lots_sd - between) <= 4 * spread.between_lots_sd_standard_error
    assert spread.within_lot_sd_standard_error < 0.1
    nodes = np.linspace(-8, 8, 2001)
    mass = stats.norm.pdf(nodes)
    first = 10 + nodes[:, None]
    limit, score = 76.0, stats.norm.isf(0.00135)

    def beyond(second):
        scatter = np.sqrt((0.3 * first) ** 2 + (0.2 * second) ** 2 + 2 * parts * 0.06 * first * second)
        return 5 * first + 3 * second + score * scatter - limit

    low, high = np.zeros_like(first), np.full_like(first, 40.0)
    for _ in range(60):
        middle = (low + high) / 2
        low, high = np.where(beyond(middle) < 0, middle, low), np.where(beyond(middle) < 0, high, middle)
    shifted = 4 + lots * 0.5 * nodes[:, None]
    share = (mass[:, None] * stats.norm.sf((low - shifted) / (0.5 * math.sqrt(1 - lots**2)))).sum() / mass.sum()
    error = spread.lots_failing_standard_error(limit=limit, ppm=1350)
    assert abs(spread.lots_failing(limit=limit, ppm=1350) - share) <= 4 * error
    assert error < 0.03


def test_no_lot_is_correlated_with_a_part():
    """A correlation between a lot input and a part input is refused with both names, also with one of 1."""
    for value in (0.5, -1.0):
        with pytest.raises(ValueError, match="correlation ties a, which is one value for a lot, to c, which differs"):
            propagate(lambda a, b, c: a + b + c, THREE, correlation={("a", "c"): value}, between={"a", "b"})
    spread = propagate(lambda a, b, c: a + b + c, THREE, correlation={("a", "c"): 0.0}, between={"a"})
    assert spread.within_lot_sd > 0
