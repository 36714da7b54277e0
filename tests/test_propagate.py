"""The Monte Carlo engine on models of any kind: statistics, their standard errors, shares, and what it refuses."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from flexlash.tolerance import Normal, Triangular, TruncatedNormal, Uniform, propagate
from flexlash.tolerance.propagate import Spread
from flexlash.tolerance.sampling import REPLICATES, UnitPoints

thorough = settings(deadline=None, max_examples=30, derandomize=True)

each_method = pytest.mark.parametrize("method", ["line", "sobol", "random"])

TWO = {"a": Normal(mean=1.0, sd=3.0), "b": Uniform(low=0.0, high=4.0)}
ISHIGAMI = {name: Uniform(low=-math.pi, high=math.pi) for name in ("a", "b", "c")}


def total(a, b):
    """Return the sum of two inputs."""
    return a + b


def ishigami(a, b, c):
    """Return the Ishigami function with a = 7 and b = 0.1."""
    return np.sin(a) + 7 * np.sin(b) ** 2 + 0.1 * c**4 * np.sin(a)


def test_line_answers_with_sobol_points_and_says_so():
    """Where line sampling does not apply, scrambled Sobol' points answer; method and notes tell."""
    line = propagate(ishigami, ISHIGAMI, method="line", seed=4)
    sobol = propagate(ishigami, ISHIGAMI, method="sobol", seed=4)
    assert line.method == "sobol"
    assert any("Sobol" in note for note in line.notes)
    assert line.mean == sobol.mean


def test_line_is_the_default():
    """Without a method propagate takes line, with a seed of 0."""
    plain = propagate(total, TWO, samples=1024)
    line = propagate(total, TWO, method="line", samples=1024, seed=0)
    assert (plain.method, plain.notes, plain.mean) == (line.method, line.notes, line.mean)


@pytest.mark.parametrize("method", ["sobol", "random"])
def test_sobol_and_random_have_nothing_to_note(method):
    """A method that applies answers under its own name without a note."""
    spread = propagate(total, TWO, method=method, samples=1024)
    assert spread.method == method
    assert spread.notes == ()


@pytest.mark.parametrize("method", ["sobol", "random"])
def test_points_drawn_before_stand_for_method_samples_and_seed(method):
    """Points that are handed in give the same spread as drawing them, and no note on another method."""
    points = UnitPoints(list(TWO), method=method, samples=2048, seed=9)
    handed = propagate(total, TWO, points=points)
    drawn = propagate(total, TWO, method=method, samples=2048, seed=9)
    assert np.array_equal(handed.values, drawn.values)
    assert handed.shares == drawn.shares
    assert handed.method == method
    assert handed.notes == ()


@each_method
def test_same_seed_same_numbers(method):
    """The same seed gives the same numbers bit for bit, another seed others within their standard errors."""
    first, again, other = (propagate(total, TWO, method=method, samples=4096, seed=seed) for seed in (5, 5, 6))
    assert np.array_equal(first.values, again.values)
    assert first.mean != other.mean
    assert abs(first.mean - other.mean) <= 6 * math.hypot(first.mean_standard_error, other.mean_standard_error)


@each_method
@pytest.mark.parametrize(("samples", "size"), [(1, 16), (1000, 1024), (1025, 2048)])
def test_samples_are_rounded_up(method, samples, size):
    """The number of samples is rounded up to replicates times a power of two."""
    spread = propagate(total, TWO, method=method, samples=samples)
    assert spread.size == size
    assert spread.values.shape == (REPLICATES, size // REPLICATES)
    assert math.isfinite(spread.standard_error(0.975))
    assert spread.sd_standard_error > 0


@each_method
def test_statistics_are_numpys(method):
    """Mean, sd and quantiles of type 7 are numpy's, probabilities the counted shares."""
    spread = propagate(total, TWO, method=method, samples=4096, seed=1)
    every = spread.values.ravel()
    assert spread.mean == pytest.approx(every.mean(), rel=1e-14)
    assert spread.sd == pytest.approx(every.std(), rel=1e-12)
    assert spread.skewness == pytest.approx(float(stats.skew(every)), rel=1e-3)
    probabilities = np.array([0, 0.00135, 0.025, 0.1, 1 / 3, 0.5, 0.975, 0.99865, 1])
    assert spread.quantile(probabilities) == pytest.approx(np.quantile(every, probabilities), rel=1e-13)
    for value in (every.min(), 0.0, 3.0, every.max(), 100.0, -100.0):
        assert spread.probability_above(value) == pytest.approx((every > value).mean(), abs=1e-15)


def test_scalar_in_scalar_out():
    """Quantile, standard error and probability take a scalar and return a float."""
    spread = propagate(total, TWO, method="sobol", samples=1024)
    for found in (spread.quantile(0.9), spread.standard_error(0.9), spread.probability_above(3.0)):
        assert type(found) is float
    assert type(spread.quantile(np.float64(0.9))) is float
    assert type(spread.mean) is type(spread.sd) is type(spread.skewness) is float


@pytest.mark.parametrize("shape", [(0,), (1,), (4,), (2, 3)])
def test_array_in_array_out(shape):
    """Quantile, standard error and probability take an array and return one of its shape."""
    spread = propagate(total, TWO, method="sobol", samples=1024)
    probabilities = np.linspace(0.1, 0.9, math.prod(shape)).reshape(shape)
    for function, wanted in (
        (spread.quantile, probabilities),
        (spread.standard_error, probabilities),
        (spread.probability_above, 5 * probabilities),
    ):
        found = function(wanted)
        assert found.shape == shape
        assert found.ravel().tolist() == [function(float(one)) for one in wanted.ravel()]
    assert spread.quantile([0.1, 0.9]).shape == (2,)


def test_ties_with_a_value_are_not_above_it():
    """Probability above counts what is greater, not what is equal."""
    spread = propagate(lambda a: np.floor(a + 0.5), {"a": Uniform(low=-0.5, high=3.5)}, method="sobol", samples=4096)
    assert spread.probability_above(1.0) == pytest.approx(0.5, abs=1e-3)
    assert spread.probability_above(0.999) == pytest.approx(0.75, abs=1e-3)
    assert spread.probability_above(3.0) == 0


@each_method
def test_interval_of_a_probability_holds_it(method):
    """The interval of a probability holds the probability; 0 of all is not 0 but at most a few per size."""
    spread = propagate(total, TWO, method=method, samples=4096)
    low, high = spread.probability_interval(5.0)
    assert low < spread.probability_above(5.0) < high
    wide = spread.probability_interval(5.0, 0.999)
    assert wide[0] < low < high < wide[1]
    assert spread.probability_interval(1e9) == pytest.approx((0.0, 1 - 0.025 ** (1 / 4096)), rel=1e-9)
    assert spread.probability_interval(-1e9) == pytest.approx((0.025 ** (1 / 4096), 1.0), rel=1e-9)


@pytest.mark.parametrize("probability", [-0.001, 1.001, math.nan, [0.5, 2.0]])
def test_probabilities_outside_0_to_1_are_refused(probability):
    """A probability outside 0 to 1 is refused in one sentence."""
    spread = propagate(total, TWO, method="sobol", samples=64)
    with pytest.raises(ValueError, match=r"^a probability must lie between 0 and 1$"):
        spread.quantile(probability)
    with pytest.raises(ValueError, match=r"^a probability must lie between 0 and 1$"):
        spread.standard_error(probability)


def test_unknown_method_is_refused():
    """A method that does not exist is refused by name with those that do."""
    with pytest.raises(ValueError, match=r"^method 'latin' is not one of line, sobol, random$"):
        propagate(total, TWO, method="latin")


def test_no_inputs_are_refused():
    """A model of which nothing varies is refused."""
    with pytest.raises(ValueError, match=r"^at least one input must vary$"):
        propagate(lambda: 1.0, {})


@pytest.mark.parametrize("model", [lambda a: a.mean(), lambda a: a[:-1], lambda a: np.stack([a, a])])
def test_model_of_another_shape_is_refused(model):
    """A model that does not return its inputs' shape is refused with the shape it returned."""
    with pytest.raises(ValueError, match=r"^the model returned shape \(.*\), not that of its inputs$"):
        propagate(model, {"a": Normal(mean=0, sd=1)}, samples=64)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_model_that_is_not_finite_is_refused(bad):
    """A model that returns a number that is not finite, be it once, is refused."""
    with pytest.raises(ValueError, match=r"^the model returned a number that is not finite"):
        propagate(lambda a: np.where(a > 2.5, bad, a), {"a": Normal(mean=0, sd=1)}, samples=4096)


@pytest.mark.parametrize("samples", [0, -5])
def test_number_of_samples_must_be_positive(samples):
    """A number of samples below 1 is refused, not replaced by another one."""
    with pytest.raises(ValueError, match="samples"):
        propagate(total, TWO, samples=samples)


def test_model_meets_keyword_arrays_of_one_shape():
    """The model is called with the inputs as keyword arrays of one shape within their distributions."""
    shapes, names = set(), set()

    def model(**inputs):
        names.add(tuple(inputs))
        shapes.update(values.shape for values in inputs.values())
        assert all(values.dtype == float for values in inputs.values())
        assert inputs["b"].min() >= 0
        assert inputs["b"].max() <= 4
        return inputs["a"] * 1

    propagate(model, TWO, method="random", samples=2**15)
    assert names == {("a", "b")}
    assert all(len(shape) == 1 for shape in shapes)


def test_model_may_return_a_list_or_integers():
    """A model that returns a list or whole numbers is taken as numbers."""
    as_list = propagate(lambda a: [float(one) for one in a], {"a": Uniform(0, 1)}, samples=64)
    as_array = propagate(lambda a: a, {"a": Uniform(0, 1)}, samples=64)
    assert as_list.mean == as_array.mean
    whole = propagate(lambda a: (a > 0.5).astype(int), {"a": Uniform(0, 1)}, samples=64)
    assert whole.mean == pytest.approx(0.5, abs=0.1)


@pytest.mark.parametrize("value", [0.0, 1.0, 0.1, 1e-3 / 7, -3.7e5])
def test_constant_model_has_no_spread(value):
    """A model that ignores its inputs has no spread, no skewness, no errors, and nobody causes anything."""
    spread = propagate(lambda a, b: np.full_like(a + b, value), TWO)
    assert spread.mean == pytest.approx(value, rel=1e-14)
    assert spread.sd == pytest.approx(0, abs=1e-14 * abs(value))
    assert spread.skewness == 0
    assert spread.shares == {"a": 0.0, "b": 0.0}
    assert spread.quantile(0.01) == spread.quantile(0.99) == value
    assert spread.standard_error(0.5) == spread.mean_standard_error == spread.sd_standard_error == 0
    assert spread.probability_above(value) == 0
    assert spread.probability_above(value - 1) == 1


def test_constant_model_of_one_input_has_no_share():
    """A single input that causes nothing has a share of 0, one that causes all a share of 1."""
    assert propagate(lambda a: 3 * a, {"a": Normal(mean=0, sd=1)}, samples=64).shares == {"a": 1.0}
    assert propagate(lambda a: np.full_like(a, 2.0), {"a": Normal(mean=0, sd=1)}, samples=64).shares == {"a": 0.0}


@each_method
def test_shares_of_an_additive_model(method):
    """In a + 2b + 3c with equal sds the shares are 1/14, 4/14 and 9/14 and leave no interaction."""
    inputs = {"a": Normal(0, 2), "b": Normal(5, 2), "c": Normal(-1, 2)}
    shares = propagate(lambda a, b, c: a + 2 * b + 3 * c, inputs, method=method).shares
    tolerance = 0.05 if method == "random" else 0.005
    assert shares == pytest.approx({"a": 1 / 14, "b": 4 / 14, "c": 9 / 14}, abs=tolerance)
    assert list(shares) == list(inputs)
    assert sum(shares.values()) == pytest.approx(1, abs=2 * tolerance)


@each_method
def test_shares_of_the_ishigami_function(method):
    """The Ishigami function has shares 0.3139, 0.4424 and 0, and leaves the rest to interaction."""
    spread = propagate(ishigami, ISHIGAMI, method=method)
    assert spread.shares == pytest.approx({"a": 0.3139, "b": 0.4424, "c": 0.0}, abs=0.04)
    assert spread.mean == pytest.approx(3.5, abs=4 * spread.mean_standard_error + 1e-12)
    variance = 7**2 / 8 + 0.1 * math.pi**4 / 5 + 0.1**2 * math.pi**8 / 18 + 0.5
    assert abs(spread.sd - math.sqrt(variance)) <= 4 * spread.sd_standard_error


@each_method
def test_shares_of_pure_interaction(method):
    """In a product of centred inputs none causes anything by itself, and shares stay within 0 and 1."""
    shares = propagate(lambda a, b: a * b, {"a": Normal(0, 1), "b": Uniform(-1, 1)}, method=method).shares
    assert all(0 <= share <= 0.08 for share in shares.values())


def test_shares_of_an_event_too_rare_for_their_points():
    """An output that differs in none of the points that make the shares has finite shares between 0 and 1."""
    points = UnitPoints(["a", "b"], method="random", samples=2**17, seed=0)
    normal = Normal(mean=0, sd=1)
    seen = max(points.standard("a", normal, which).max() for which in ("leading", "second"))
    spread = propagate(lambda a, b: (a > seen) + 0.0 * b, {"a": normal, "b": normal}, points=points)
    assert spread.sd > 0
    assert all(0 <= share <= 1 for share in spread.shares.values())


def test_shares_do_not_depend_on_a_shift_of_the_output():
    """A large constant added to the output changes no share beyond rounding."""
    plain = propagate(ishigami, ISHIGAMI, method="sobol")
    shifted = propagate(lambda a, b, c: ishigami(a, b, c) + 1e6, ISHIGAMI, method="sobol")
    assert shifted.shares == pytest.approx(plain.shares, abs=1e-6)


@each_method
@pytest.mark.parametrize(
    "distribution",
    [Normal(10, 2), Uniform(-1, 3), Triangular(0, 4), Triangular(0, 4, 1), TruncatedNormal(0, 1, -1, 2)],
    ids=["normal", "uniform", "triangular", "skewed", "cut"],
)
def test_identity_returns_the_distribution(method, distribution):
    """Passing one input through gives its mean, sd and quantiles within four standard errors."""
    spread = propagate(lambda a: a, {"a": distribution}, method=method, seed=2)
    assert abs(spread.mean - distribution.expectation) <= 4 * spread.mean_standard_error
    assert abs(spread.sd - distribution.standard_deviation) <= 4 * spread.sd_standard_error
    for probability in (0.025, 0.5, 0.975):
        exact = distribution.location + distribution.scale * float(distribution.standard(np.array(probability)))
        slack = 4 * spread.standard_error(probability) + 1e-3 * distribution.standard_deviation
        assert abs(spread.quantile(probability) - exact) <= slack


@pytest.mark.parametrize("method", ["sobol", "random"])
@pytest.mark.parametrize("probability", [0.025, 0.5, 0.975, 0.99865])
def test_standard_errors_are_honest(method, probability):
    """Over 100 seeds quantiles scatter about as much as their standard errors say, never far beyond them."""
    spreads = [propagate(total, TWO, method=method, samples=1024, seed=seed) for seed in range(100)]
    scatter = np.std([spread.quantile(probability) for spread in spreads], ddof=1)
    stated = math.sqrt(np.mean([spread.standard_error(probability) ** 2 for spread in spreads]))
    assert 0.5 <= scatter / stated <= 1.35


@pytest.mark.parametrize("method", ["sobol", "random"])
def test_standard_errors_of_moments_are_honest(method):
    """Over 100 seeds mean and sd scatter about as much as their standard errors say."""
    spreads = [propagate(total, TWO, method=method, samples=1024, seed=seed) for seed in range(100)]
    for statistic in ("mean", "sd"):
        scatter = np.std([getattr(spread, statistic) for spread in spreads], ddof=1)
        stated = math.sqrt(np.mean([getattr(spread, f"{statistic}_standard_error") ** 2 for spread in spreads]))
        assert scatter / stated == pytest.approx(1, abs=0.35)


def test_random_points_have_the_textbook_standard_error():
    """Plain Monte Carlo of a normal has s/√M as the standard error of its mean and s/√(2M) of its sd."""
    spreads = [propagate(lambda a: a, {"a": Normal(0, 1)}, method="random", samples=4096, seed=s) for s in range(60)]
    for name, expected in (("mean", 1 / 64), ("sd", 1 / math.sqrt(2 * 4096))):
        stated = math.sqrt(np.mean([getattr(spread, f"{name}_standard_error") ** 2 for spread in spreads]))
        assert stated == pytest.approx(expected, rel=0.2)


def test_skewness_of_an_exponential_shape():
    """The negative logarithm of a uniform input has a skewness of 2."""
    spread = propagate(lambda a: -np.log(a), {"a": Uniform(low=0, high=1)}, method="sobol")
    assert spread.skewness == pytest.approx(2, abs=0.05)


def test_histogram_holds_all_but_the_far_tails():
    """The histogram's edges rise evenly between two tail quantiles and its heights are shares of all."""
    spread = propagate(total, TWO, method="sobol", samples=2**14)
    edges, heights = spread.histogram(bins=20, cut=0.001)
    assert edges.shape == (21,)
    assert heights.shape == (20,)
    assert (edges[0], edges[-1]) == pytest.approx((spread.quantile(0.001), spread.quantile(0.999)), rel=1e-12)
    assert np.diff(edges) == pytest.approx(edges[1] - edges[0], rel=1e-9)
    assert heights.sum() == pytest.approx(0.998, abs=2e-4)
    counted = [((spread.values > low) & (spread.values <= high)).mean() for low, high in pairwise(edges)]
    assert heights == pytest.approx(counted, abs=1e-12)
    assert spread.histogram()[1].shape == (40,)


@thorough
@given(
    sd=st.floats(0.01, 5),
    factor=st.floats(1.0, 4.0),
    half=st.floats(0.01, 5),
    method=st.sampled_from(["sobol", "random"]),
)
def test_wider_input_never_narrows_the_spread(sd, factor, half, method):
    """Widening one input's tolerance with the same draws never narrows sd or the 95 % interval."""
    narrow, wide = (
        propagate(total, {"a": Normal(0, one), "b": Uniform(-half, half)}, method=method, samples=2048, seed=3)
        for one in (sd, sd * factor)
    )
    slack = 1 + (0.05 if method == "random" else 0.01)
    assert wide.sd * slack >= narrow.sd
    assert (wide.quantile(0.975) - wide.quantile(0.025)) * slack >= narrow.quantile(0.975) - narrow.quantile(0.025)


@thorough
@given(factor=st.floats(1.0, 10.0))
def test_scaling_every_tolerance_scales_the_spread(factor):
    """All tolerances wider by one factor widen a linear model's spread by just that factor."""
    narrow, wide = (
        propagate(total, {"a": Normal(0, scale), "b": Triangular(-scale, scale)}, method="sobol", samples=1024)
        for scale in (1.0, factor)
    )
    assert wide.sd == pytest.approx(factor * narrow.sd, rel=1e-12)
    assert wide.quantile(0.975) == pytest.approx(factor * narrow.quantile(0.975), rel=1e-9)


def test_another_input_leaves_a_shared_draw_alone():
    """Two models that share an input by name meet the same draws of it at the same points."""
    points = UnitPoints(["a", "b", "c"], method="sobol", samples=1024, seed=0)
    first = propagate(lambda a, b: a + 0 * b, {"a": Normal(0, 1), "b": Normal(0, 1)}, points=points)
    second = propagate(lambda c, a: a + 0 * c, {"c": Uniform(0, 1), "a": Normal(0, 1)}, points=points)
    assert isinstance(first, Spread)
    assert np.array_equal(first.values, second.values)
