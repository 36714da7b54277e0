"""The Monte Carlo engine on models of any kind: statistics, their standard errors, shares, and what it refuses."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from line_models import probability_below
from one_input import ONE_INPUT, PROBABILITIES
from scipy import stats
from scipy.optimize import brentq

from flexlash.tolerance import Normal, Triangular, TruncatedNormal, Uniform, propagate
from flexlash.tolerance.engine.line_points import LINE_REPLICATES
from flexlash.tolerance.sampled_spread import SampledSpread
from flexlash.tolerance.sampling import REPLICATES, UnitPoints
from flexlash.tolerance.spread import Spread

thorough = settings(deadline=None, max_examples=30, derandomize=True)

each_method = pytest.mark.parametrize("method", ["line", "sobol", "random"])
each_point_method = pytest.mark.parametrize("method", ["sobol", "random"])

TWO = {"a": Normal(mean=1.0, sd=3.0), "b": Uniform(low=0.0, high=4.0)}
ISHIGAMI = {name: Uniform(low=-math.pi, high=math.pi) for name in ("a", "b", "c")}


def total(a, b):
    """Return the sum of two inputs."""
    return a + b


def ishigami(a, b, c):
    """Return the Ishigami function with a = 7 and b = 0.1."""
    return np.sin(a) + 7 * np.sin(b) ** 2 + 0.1 * c**4 * np.sin(a)


@pytest.mark.parametrize(
    ("model", "reason"),
    [
        (lambda a, b: np.full_like(a + b, 3.0), "the output has no gradient at the median"),
        (lambda a, b: (a - 1) * (b - 2), "the output has no gradient at the median"),
        (lambda a, b: np.where(a > 19, np.nan, a + b), "the model is not finite within 8 standard deviations"),
        (
            lambda a, b: np.sin(a) + b,
            "the output does not rise everywhere along its gradient at the median",
        ),
        (lambda a, b: np.floor(a) + 0 * b, "the output rises in steps"),
    ],
)
@pytest.mark.parametrize("samples", [None, 2048])
def test_sobol_points_answer_where_lines_do_not_serve(model, reason, samples):
    """Where lines do not serve, scrambled Sobol' points answer; method and one note tell, without a warning."""
    line = propagate(model, TWO, method="line", samples=samples, seed=4)
    sobol = propagate(model, TWO, method="sobol", samples=samples, seed=4)
    assert line.method == "sobol"
    assert line.notes == (f"Sobol' points instead of lines: {reason}.",)
    assert np.array_equal(line.values, sobol.values)
    assert line.quantile(0.9) == sobol.quantile(0.9)
    assert line.shares == sobol.shares


def test_lines_answer_under_their_own_name():
    """Where lines serve, they answer with nothing to note, and hold no values."""
    spread = propagate(total, TWO, method="line")
    assert spread.method == "line"
    assert spread.notes == ()
    assert not isinstance(spread, SampledSpread)
    assert not hasattr(spread, "values")
    assert isinstance(spread, Spread)


def test_line_is_the_default():
    """Without a method propagate takes line, with a seed of 0."""
    plain = propagate(total, TWO, samples=1024)
    line = propagate(total, TWO, method="line", samples=1024, seed=0)
    assert (plain.method, plain.notes, plain.mean) == (line.method, line.notes, line.mean)


@each_point_method
def test_sobol_and_random_have_nothing_to_note(method):
    """A method that applies answers under its own name without a note."""
    spread = propagate(total, TWO, method=method, samples=1024)
    assert spread.method == method
    assert spread.notes == ()


@each_point_method
def test_values_are_the_model_at_the_points(method):
    """The values of sampled spreads are the model at the points of that method, size and seed."""
    points = UnitPoints(list(TWO), method=method, samples=2048, seed=9)
    spread = propagate(total, TWO, method=method, samples=2048, seed=9)
    at_points = [one.location + one.scale * points.standard(name, one) for name, one in TWO.items()]
    assert isinstance(spread, SampledSpread)
    assert np.array_equal(spread.values, sum(at_points))


def numbers(spread):
    """Return all kinds of numbers of a spread."""
    probabilities = [0.00135, 0.025, 0.5, 0.975, 0.99865]
    single = [spread.mean, spread.sd, spread.skewness, spread.mean_standard_error, spread.sd_standard_error]
    several = [spread.quantile(probabilities), spread.standard_error(probabilities), spread.histogram()[1]]
    shares = [*spread.shares.values(), *spread.total_shares.values()]
    return [*single, spread.size, *np.concatenate(several), *shares, *spread.probability_interval(5.0)]


@each_method
@pytest.mark.parametrize("samples", [None, 1024])
def test_same_seed_same_numbers(method, samples):
    """The same seed gives the same numbers bit for bit, another seed others within their standard errors."""
    given = {"method": method, "samples": samples}
    first, again, other = (propagate(bent, BENT, **given, seed=seed) for seed in (5, 5, 6))
    assert numbers(first) == numbers(again)
    assert first.quantile(0.9) != other.quantile(0.9)
    combined = math.hypot(first.standard_error(0.9), other.standard_error(0.9))
    assert abs(first.quantile(0.9) - other.quantile(0.9)) <= 6 * combined


@each_point_method
@pytest.mark.parametrize(("samples", "size"), [(1, 16), (1000, 1024), (1025, 2048)])
def test_samples_are_rounded_up(method, samples, size):
    """The number of samples is rounded up to replicates times a power of two."""
    spread = propagate(total, TWO, method=method, samples=samples)
    assert spread.size == size
    assert spread.values.shape == (REPLICATES, size // REPLICATES)
    assert math.isfinite(spread.standard_error(0.975))
    assert spread.sd_standard_error > 0


@pytest.mark.parametrize(("samples", "size"), [(1, 8), (1000, 1024), (1025, 2048)])
def test_lines_are_rounded_up(samples, size):
    """The number of lines is rounded up to replicates times a power of two."""
    spread = propagate(total, TWO, samples=samples)
    assert LINE_REPLICATES == 8
    assert spread.size == size
    assert math.isfinite(spread.standard_error(0.975))
    assert spread.sd_standard_error > 0


@each_point_method
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
@pytest.mark.parametrize(("method", "samples"), [("line", 64), ("sobol", 1024)])
def test_array_in_array_out(method, samples, shape):
    """Quantile, standard error and probability take a scalar or an array and return one of its shape."""
    spread = propagate(total, TWO, method=method, samples=samples)
    probabilities = np.linspace(0.1, 0.9, math.prod(shape)).reshape(shape)
    for function, arguments in (
        (spread.quantile, probabilities),
        (spread.standard_error, probabilities),
        (spread.probability_above, 5 * probabilities),
    ):
        values = function(arguments)
        assert values.shape == shape
        assert values.ravel().tolist() == [function(float(argument)) for argument in arguments.ravel()]
        assert type(function(0.5)) is float
    assert spread.quantile([0.1, 0.9]).shape == (2,)


def test_ties_with_a_value_are_not_above_it():
    """Probability above counts what is greater, not what is equal."""
    spread = propagate(lambda a: np.floor(a + 0.5), {"a": Uniform(low=-0.5, high=3.5)}, method="sobol", samples=4096)
    assert spread.probability_above(1.0) == pytest.approx(0.5, abs=1e-3)
    assert spread.probability_above(0.999) == pytest.approx(0.75, abs=1e-3)
    assert spread.probability_above(3.0) == 0


@each_method
def test_interval_of_a_probability_holds_it(method):
    """The interval of a probability holds the probability and widens with its confidence."""
    spread = propagate(lambda a, b: a * (b + 4), TWO, method=method, samples=4096)
    low, high = spread.probability_interval(5.0)
    assert low < spread.probability_above(5.0) < high
    wide = spread.probability_interval(5.0, 0.999)
    assert wide[0] < low < high < wide[1]


@each_point_method
def test_none_of_all_points_is_not_a_probability_of_none(method):
    """Where no point is above a value its probability may still be a few in as many as there are points."""
    spread = propagate(total, TWO, method=method, samples=4096)
    assert spread.probability_interval(1e9) == pytest.approx((0.0, 1 - 0.025 ** (1 / 4096)), rel=1e-9)
    assert spread.probability_interval(-1e9) == pytest.approx((0.025 ** (1 / 4096), 1.0), rel=1e-9)


@pytest.mark.parametrize("probability", [-0.001, 1.001, math.nan, [0.5, 2.0]])
def test_probabilities_outside_0_to_1_are_refused(probability):
    """A probability outside 0 to 1 is refused in one sentence."""
    spread = propagate(total, TWO, method="sobol", samples=64)
    with pytest.raises(ValueError, match=r"^probability = .*: numbers between 0 and 1 are required$"):
        spread.quantile(probability)
    with pytest.raises(ValueError, match=r"^probability = .*: numbers between 0 and 1 are required$"):
        spread.standard_error(probability)


def test_unknown_method_is_refused():
    """A method that does not exist is refused by name with those that do."""
    with pytest.raises(ValueError, match=r"^method = 'latin': one of line, sobol, random is required$"):
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


REFUSED = [
    (ValueError, {"method": "sobl"}, "method = 'sobl': one of line, sobol, random is required; did you mean sobol?"),
    (TypeError, {"method": None}, "method = None: one of line, sobol, random is required"),
    (TypeError, {"samples": 1.5}, "samples = 1.5: a whole number of at least 1 is required"),
    (TypeError, {"samples": True}, "samples = True: a whole number of at least 1 is required"),
    (TypeError, {"samples": "64"}, "samples = '64': a whole number of at least 1 is required"),
    (ValueError, {"seed": -1}, "seed = -1: a whole number of at least 0 is required"),
    (TypeError, {"seed": None}, "seed = None: a whole number of at least 0 is required"),
    (TypeError, {"sample": 64}, "propagate() takes no argument sample; did you mean samples?"),
    (TypeError, {"model": 3}, "model = 3: a function of the inputs by name is required"),
    (TypeError, {"inputs": [1]}, "inputs = [1]: a mapping of names to distributions is required"),
    (TypeError, {"inputs": {1: Normal(0, 1)}}, "a name of inputs = 1: a text is required"),
    (TypeError, {"inputs": {"a": 3}}, "inputs['a'] = 3: a distribution such as Normal(0, 1) is required"),
]


@pytest.mark.parametrize(("fault", "given", "message"), REFUSED)
def test_wrong_arguments_are_refused_by_name(fault, given, message):
    """An argument of another kind or out of range is refused with its name, what was given and what is required."""
    with pytest.raises(fault) as refusal:
        propagate(**{"model": total, "inputs": TWO} | given)
    assert str(refusal.value) == message


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda spread: spread.quantile("0.5"), "probability = '0.5': numbers between 0 and 1 are required"),
        (
            lambda spread: spread.quantile([0.5, None]),
            "probability = [0.5, None]: numbers between 0 and 1 are required",
        ),
        (lambda spread: spread.standard_error(True), "probability = True: numbers between 0 and 1 are required"),
        (lambda spread: spread.probability_above("3"), "value = '3': numbers are required"),
        (lambda spread: spread.probability_interval([1.0, 2.0]), "value = [1.0, 2.0]: a number is required"),
        (lambda spread: spread.probability_interval(1.0, "x"), "confidence = 'x': a finite number is required"),
        (lambda spread: spread.histogram(bins=2.5), "bins = 2.5: a whole number of at least 1 is required"),
    ],
)
def test_what_is_no_number_is_refused_by_name(ask, message):
    """A spread asked with what is no number says which argument that is."""
    with pytest.raises(TypeError) as refusal:
        ask(propagate(total, TWO, method="sobol", samples=64))
    assert str(refusal.value) == message


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda spread: spread.probability_above([1.0, math.nan]), "value = [1.0, nan]: numbers are required"),
        (lambda spread: spread.probability_interval(math.nan), "value = nan: a number is required"),
        (
            lambda spread: spread.probability_interval(1.0, 1.0),
            "confidence = 1.0: a number between 0 and 1 is required",
        ),
    ],
)
def test_numbers_out_of_range_are_refused_by_name(ask, message):
    """Not-a-number, and a confidence that is certainty, are refused with the argument's name."""
    with pytest.raises(ValueError) as refusal:  # noqa: PT011
        ask(propagate(total, TWO, method="sobol", samples=64))
    assert str(refusal.value) == message


def test_arguments_of_numpy_serve():
    """Numbers of NumPy and arrays of any shape give what Python's own give."""
    spread = propagate(total, TWO, method="sobol", samples=np.int32(64), seed=np.uint8(0))
    own = propagate(total, TWO, method="sobol", samples=64)
    assert spread.quantile(np.float32(0.5)) == own.quantile(0.5)
    assert spread.probability_above(np.array([[1, 2]])).tolist() == [own.probability_above([1, 2]).tolist()]
    assert spread.quantile([]).shape == (0,)


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
    inputs = {"a": normal, "b": normal}
    spread = propagate(lambda a, b: (a > seen) + 0.0 * b, inputs, method="random", samples=2**17)
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


@each_point_method
@pytest.mark.parametrize("probability", [0.025, 0.5, 0.975, 0.99865])
def test_standard_errors_are_honest(method, probability):
    """Over 100 seeds quantiles scatter about as much as their standard errors say, never far beyond them."""
    spreads = [propagate(total, TWO, method=method, samples=1024, seed=seed) for seed in range(100)]
    scatter = np.std([spread.quantile(probability) for spread in spreads], ddof=1)
    stated = math.sqrt(np.mean([spread.standard_error(probability) ** 2 for spread in spreads]))
    assert 0.5 <= scatter / stated <= 1.35


@each_point_method
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


@each_point_method
def test_another_input_leaves_a_shared_draw_alone(method):
    """Two models that share points by name meet the same draws, whatever else and in whichever order varies."""
    points = UnitPoints(["a", "b", "c"], method=method, samples=1024, seed=0)
    first = SampledSpread(model=lambda a, b: a + 0 * b, inputs={"a": Normal(0, 1), "b": Normal(0, 1)}, points=points)
    second = SampledSpread(model=lambda c, a: a + 0 * c, inputs={"c": Uniform(0, 1), "a": Normal(0, 1)}, points=points)
    assert np.array_equal(first.values, second.values)


each_distribution = pytest.mark.parametrize(("distribution", "reference"), ONE_INPUT.values(), ids=list(ONE_INPUT))


def bent(a, b, c):
    """Return a product that rises with each of three inputs, unevenly."""
    return a * np.exp(b / 4) + c**1.5


BENT = {"a": Normal(10, 1), "b": Triangular(-1, 1), "c": Uniform(4, 9)}


@each_distribution
def test_lines_are_exact_for_one_input(distribution, reference):
    """Of a single input passed through, mean, sd and quantiles are exact to 1e-9 standard deviations."""
    spread = propagate(lambda a: a, {"a": distribution})
    sd = distribution.standard_deviation
    assert spread.method == "line"
    assert spread.mean == pytest.approx(distribution.expectation, rel=0, abs=1e-9 * sd)
    assert spread.sd == pytest.approx(sd, rel=1e-9)
    assert spread.quantile(PROBABILITIES) == pytest.approx(reference.ppf(PROBABILITIES), rel=0, abs=1e-9 * sd)
    assert spread.probability_above(reference.isf(PROBABILITIES)) == pytest.approx(PROBABILITIES, rel=1e-8)
    assert spread.shares == pytest.approx({"a": 1.0}, abs=1e-8)
    assert spread.total_shares == pytest.approx({"a": 1.0}, abs=1e-8)


@each_distribution
def test_lines_are_exact_for_a_falling_function_of_one_input(distribution, reference):
    """Quantiles of one input that the output falls with, and is not straight in, are exact too."""
    spread = propagate(lambda a: 1 / (a + 20), {"a": distribution})
    exact = 1 / (reference.isf(PROBABILITIES) + 20)
    assert spread.quantile(PROBABILITIES) == pytest.approx(exact, rel=0, abs=1e-9 * spread.sd)


@pytest.mark.slow
@thorough
@given(
    slopes=st.lists(
        st.floats(0.1, 10).map(lambda one: one - 5).filter(lambda one: abs(one) > 0.01), min_size=1, max_size=6
    ),
    shift=st.floats(-100, 100),
    seed=st.integers(0, 100),
)
def test_lines_are_exact_for_linear_functions_of_normals(slopes, shift, seed):
    """A linear function of normals has exactly the mean, sd, quantiles and shares of its normal."""
    inputs = {f"x{place}": Normal(mean=place, sd=1 + place) for place in range(len(slopes))}
    spread = propagate(
        lambda **x: shift + sum(s * v for s, v in zip(slopes, x.values(), strict=True)), inputs, seed=seed
    )
    parts = np.array([slope * one.sd for slope, one in zip(slopes, inputs.values(), strict=True)])
    mean, sd = shift + sum(slope * place for place, slope in enumerate(slopes)), math.sqrt((parts**2).sum())
    assert spread.method == "line"
    assert spread.mean == pytest.approx(mean, rel=0, abs=1e-9 * sd + 1e-13 * abs(shift))
    assert spread.sd == pytest.approx(sd, rel=1e-9)
    assert spread.skewness == pytest.approx(0, abs=1e-8)
    exact = mean + sd * stats.norm.ppf(PROBABILITIES)
    assert spread.quantile(PROBABILITIES) == pytest.approx(exact, rel=0, abs=1e-9 * sd + 1e-12 * abs(shift))
    assert list(spread.shares.values()) == pytest.approx(list(parts**2 / sd**2), abs=2e-8)


@pytest.mark.parametrize("score", [-7.0, -5.997807, 3.0, 4.5, 5.997807, 7.0, 7.5])
def test_deep_tail_of_a_linear_normal_is_exact(score):
    """The probability above a value out to 1e-9 and beyond is that of the normal, in both tails."""
    spread = propagate(lambda a, b: a - 2 * b, {"a": Normal(1, 3), "b": Normal(0, 2)})
    value = 1 + 5 * score
    exact = stats.norm.sf(score)
    assert spread.probability_above(value) == pytest.approx(exact, rel=1e-8)
    low, high = spread.probability_interval(value)
    assert low * (1 - 1e-8) <= exact <= high * (1 + 1e-8)
    assert high / low == pytest.approx(1, abs=1e-3)


@pytest.mark.parametrize(
    ("inputs", "reach"),
    [
        ({"a": Uniform(0, 1)}, 1.0),
        ({"a": Uniform(0, 1), "b": Uniform(0, 2)}, 3.0),
        ({"a": Triangular(0, 1), "b": Uniform(0, 2), "c": TruncatedNormal(0, 1, -3, 3)}, 6.0),
    ],
)
def test_nothing_is_above_the_reach_of_bounded_inputs(inputs, reach):
    """Above what bounded inputs can reach is less than 1e-15 of the output, with an interval from 0."""
    spread = propagate(lambda **given: sum(given.values()), inputs, samples=64)
    for value in (reach * (1 + 1e-9), reach * 1.5, 1e9):
        assert spread.probability_above(value) < 1e-15
        low, high = spread.probability_interval(value)
        assert low == 0
        assert 0 < high < 1e-14
    assert spread.probability_above(-1e9) > 1 - 1e-15
    assert 0 < spread.probability_above(0.9 * reach) < 1


@pytest.mark.parametrize("high", [2.9, 2.99, 2.997])
def test_rare_events_of_bounded_inputs(high):
    """A rare share of a sum of three uniforms is within four of its half-intervals' standard errors."""
    spread = propagate(lambda a, b, c: a + b + c, {name: Uniform(0, 1) for name in "abc"}, samples=4096)
    exact = (3 - high) ** 3 / 6
    low, above = spread.probability_interval(high, 1 - 6.3e-5)
    assert low <= exact <= above
    assert above / low < 1.5


@pytest.mark.slow
@thorough
@given(
    first=st.floats(1e-6, 1 - 1e-6),
    second=st.floats(1e-6, 1 - 1e-6),
    seed=st.integers(0, 3),
    which=st.sampled_from(["bent", "two", "uniforms", "one"]),
)
def test_percentiles_rise_with_the_probability(first, second, seed, which):
    """A greater probability never has a smaller quantile, nor a greater value a greater probability above it.

    The probability above a quantile is that of the quantile within a standard error of it.
    """
    model, inputs = {
        "bent": (bent, BENT),
        "two": (total, TWO),
        "uniforms": (total, {"a": Uniform(0, 1), "b": Uniform(0, 3)}),
        "one": (lambda a: np.exp(a), {"a": Triangular(0, 2, 0.3)}),  # noqa: PLW0108
    }[which]
    spread = propagate(model, inputs, samples=64, seed=seed)
    low, high = sorted([first, second])
    slack = 1e-8 * spread.sd
    one, other = spread.quantile([low, high])
    assert one <= other + slack
    above = spread.probability_above(np.array([one, other + slack]))
    assert above[0] >= above[1] - 1e-12
    for value, probability, found in zip((one, other), (low, high), above, strict=True):
        ends = spread.probability_interval(value)
        assert abs(found - (1 - probability)) <= 1e-6 + (ends[1] - ends[0]) / 3.92


@pytest.mark.slow
@thorough
@given(
    factor=st.floats(1.0, 4.0),
    place=st.sampled_from(["a", "b", "c"]),
    kind=st.sampled_from([total, bent]),
)
def test_wider_tolerance_never_narrows_the_spread_of_lines(factor, place, kind):
    """Widening one input never narrows sd or 95 % interval by more than a few standard errors."""
    wider = {
        "a": Normal(10, factor),
        "b": Triangular(-factor, factor),
        "c": Uniform(6.5 - 1.5 * factor / 2, 6.5 + 1.5 * factor / 2),
    }
    base = {"a": Normal(10, 1), "b": Triangular(-1, 1), "c": Uniform(5.75, 7.25)}

    def model(a, b, c):
        return kind(a, b) + c if kind is total else kind(a, b, c)

    narrow, wide = (propagate(model, one, seed=2) for one in (base, base | {place: wider[place]}))
    assert narrow.method == wide.method == "line"
    slack = 4 * math.hypot(narrow.sd_standard_error, wide.sd_standard_error)
    assert wide.sd >= narrow.sd - slack
    ends = [spread.quantile([0.025, 0.975]) for spread in (narrow, wide)]
    slack = 4 * np.hypot(*(spread.standard_error([0.025, 0.975]) for spread in (narrow, wide))).sum()
    assert ends[1][1] - ends[1][0] >= ends[0][1] - ends[0][0] - slack


@pytest.mark.slow
@thorough
@given(factor=st.floats(1e-6, 1e6), shift=st.floats(-10, 10), sign=st.sampled_from([1, -1]))
def test_lines_follow_scale_and_shift_of_the_output(factor, shift, sign):
    """An output scaled, shifted or turned has its numbers scaled, shifted or turned, and the same shares."""
    plain = propagate(bent, BENT, samples=128)
    turned = propagate(lambda a, b, c: sign * factor * (bent(a, b, c) + shift), BENT, samples=128)
    probabilities = np.array([0.00135, 0.3, 0.975])
    mapped = probabilities if sign > 0 else 1 - probabilities
    size = factor * plain.sd
    # Turned lines pass the same points in the other direction; only rounding and the corrections differ.
    assert turned.mean == pytest.approx(sign * factor * (plain.mean + shift), rel=0, abs=1e-7 * size)
    assert turned.sd == pytest.approx(size, rel=1e-7)
    assert turned.skewness == pytest.approx(sign * plain.skewness, abs=1e-6)
    exact = sign * factor * (plain.quantile(mapped) + shift)
    assert np.abs(turned.quantile(probabilities) - exact).max() <= (1e-6 if sign > 0 else 1e-4) * size
    assert turned.shares == pytest.approx(plain.shares, abs=1e-6)


@pytest.mark.slow
def test_order_of_inputs_does_not_matter():
    """The same inputs in another order give the same numbers within their standard errors."""
    forward = propagate(bent, BENT, seed=1)
    backward = propagate(bent, dict(reversed(BENT.items())), seed=1)
    for name in ("mean", "sd", "skewness", "kurtosis"):
        errors = math.hypot(*(getattr(one, f"{name}_standard_error") for one in (forward, backward)))
        assert abs(getattr(forward, name) - getattr(backward, name)) <= 4 * errors
    errors = np.hypot(forward.standard_error(PROBABILITIES), backward.standard_error(PROBABILITIES))
    assert (np.abs(forward.quantile(PROBABILITIES) - backward.quantile(PROBABILITIES)) <= 4 * errors).all()
    assert backward.shares == pytest.approx(forward.shares, abs=5e-3)
    assert list(backward.shares) == ["c", "b", "a"]


@thorough
@given(
    slopes=st.lists(st.floats(-3, 3).filter(lambda one: abs(one) > 0.05), min_size=3, max_size=3),
    bend=st.floats(-0.05, 0.05),
    samples=st.sampled_from([8, 64, 256]),
)
def test_shares_lie_within_0_and_1(slopes, bend, samples):
    """Shares of smooth models lie within 0 and 1, no greater than the total share of their input."""
    one, two, three = slopes
    model = lambda a, b, c: one * a + two * b + three * c + bend * (a - 10) * (c - 6)  # noqa: E731
    spread = propagate(model, BENT, samples=samples)
    shares, totals = spread.shares, spread.total_shares
    assert list(shares) == list(totals) == list(BENT)
    for name, share in shares.items():
        assert 0 <= share <= 1
        assert share <= totals[name] + 1e-9


@pytest.mark.slow
@pytest.mark.parametrize(
    ("model", "inputs"),
    [
        (lambda a: -np.log(a), {"a": Uniform(0, 1)}),
        (lambda a, b: np.log(a) + b, {"a": Uniform(0, 1), "b": Triangular(0, 1)}),
        (lambda a, b: np.arctan(5 * (a + b)), {"a": Normal(0, 1), "b": Normal(0, 1)}),
        (lambda a, b: np.minimum(a + b, 1.0), {"a": Normal(0, 1), "b": Normal(0, 1)}),
        (lambda a, b: np.clip(a + b, -1.0, 1.0), {"a": Uniform(-1, 1), "b": Uniform(-1, 1)}),
        (lambda a, b: np.maximum(a, b), {"a": Uniform(0, 1), "b": Uniform(0, 1)}),  # noqa: PLW0108
        (lambda a, b: np.exp(30 * (a + b)), {"a": Normal(0, 1), "b": Normal(0, 1)}),
        (lambda a, b: a + b, {"a": TruncatedNormal(0, 1, -0.01, 9), "b": TruncatedNormal(0, 1, 12, 13)}),
        (lambda a, b: 1e-50 * (a + b), {"a": Normal(0, 1), "b": Uniform(0, 1)}),
        (lambda a, b: 1e50 * (a + b), {"a": Normal(0, 1), "b": Uniform(0, 1)}),
    ],
)
@pytest.mark.parametrize("samples", [None, 8])
def test_bounds_and_saturation_give_no_warning(model, inputs, samples):
    """Every number of bounded inputs, saturating lines, and extreme magnitudes is finite and without a warning."""
    spread = propagate(model, inputs, samples=samples)
    found = numbers(spread)
    far = [spread.mean - 1e9 * spread.sd, spread.mean + 1e9 * spread.sd]
    found += [spread.probability_above(value) for value in (-1.0, 0.0, 1.0, spread.mean, *far)]
    found += [*spread.quantile([1e-6, 1 - 1e-6]), *spread.standard_error([1e-6, 1 - 1e-6])]
    found += [*spread.probability_interval(far[0]), *spread.probability_interval(far[1])]
    assert np.isfinite(found).all()


@pytest.mark.parametrize("kink", [0.6, 0.8, 1.0])
def test_quantiles_of_a_saturating_output_do_not_pass_its_limit(kink):
    """Of an output that saturates no percentile lies beyond its limit, and each is right within its error."""
    spread = propagate(lambda a: np.minimum(a, kink), {"a": Normal(0, 1)})
    inner = PROBABILITIES[1:-1]
    exact = np.minimum(stats.norm.ppf(inner), kink)
    found = spread.quantile(inner)
    assert found.max() <= kink
    assert np.all(np.abs(found - exact) <= 4 * spread.standard_error(inner) + 1e-12)


@pytest.mark.parametrize("kink", [0.6, 0.8])
def test_mean_and_far_tail_of_a_saturating_output(kink):
    """Of an output that saturates the mean is right within its error, and far quantiles stay at the limit."""
    spread = propagate(lambda a: np.minimum(a, kink), {"a": Normal(0, 1)})
    exact = -stats.norm.pdf(kink) + kink * stats.norm.sf(kink)
    assert abs(spread.mean - exact) <= 4 * spread.mean_standard_error
    assert spread.quantile([0.999999, 1.0]) == pytest.approx([kink, kink], abs=1e-6)


def test_nothing_is_above_infinity():
    """Nothing is above infinity, everything above minus infinity."""
    spread = propagate(total, TWO, samples=64)
    assert spread.probability_above([math.inf, -math.inf]) == pytest.approx([0, 1], abs=1e-15)
    assert spread.probability_interval(math.inf) == pytest.approx((0, 0), abs=1e-14)


def test_mean_of_a_falling_function_of_a_skewed_triangle():
    """Where the output falls with a skewed triangle its mean and sd are exact too."""
    skewed = Triangular(0, 4, 1)
    spread = propagate(lambda a: 7 - 3 * a, {"a": skewed})
    assert spread.mean == pytest.approx(7 - 3 * skewed.expectation, rel=0, abs=1e-9 * spread.sd)
    assert spread.sd == pytest.approx(3 * skewed.standard_deviation, rel=1e-9)


def test_single_input_causes_everything():
    """A single input causes all of the variance, however the output bends."""
    spread = propagate(lambda a: -np.log(a), {"a": Uniform(0, 1)})
    assert spread.shares == pytest.approx({"a": 1.0}, abs=1e-2)


@pytest.mark.slow
@pytest.mark.parametrize("samples", [64, None])
def test_standard_errors_of_lines_cover(samples):
    """Over many seeds of squared sums of uniforms ± 1.96 standard errors hold the exact quantile in about 95 of 100.

    Neither squares nor their logarithms add up, so that no surrogate is exact.
    """
    held = []
    for widths in ((1, 1, 1), (1, 2, 0.5, 3), (3, 1, 1, 1, 1)):
        inputs = {f"u{place}": Uniform(0, width) for place, width in enumerate(widths)}
        probabilities = np.array([0.00135, 0.025, 0.5, 0.975, 0.99865])
        exact = [
            brentq(lambda x, p, w: probability_below(x, w) - p, 0, sum(widths), args=(p, widths)) for p in probabilities
        ]
        for seed in range(60 if samples else 10):
            spread = propagate(lambda **u: sum(u.values()) ** 2, inputs, samples=samples, seed=seed)
            off = (spread.quantile(probabilities) - np.square(exact)) / spread.standard_error(probabilities)
            held += list(np.abs(off) <= 1.96)
            mean = sum(widths) ** 2 / 4 + sum(width**2 for width in widths) / 12
            held.append(abs(spread.mean - mean) <= 1.96 * spread.mean_standard_error)
    assert 0.90 <= np.mean(held) <= 0.99


@pytest.mark.slow
def test_error_of_lines_falls_faster_than_one_over_root_n():
    """Errors of quantiles by lines fall steeper than N^-0.8 as lines are added."""
    counts = [32, 128, 512]
    scatter = []
    for count in counts:
        found = [propagate(bent, BENT, samples=count, seed=seed).quantile([0.025, 0.5, 0.975]) for seed in range(30)]
        scatter.append(np.std(found, axis=0, ddof=1).mean())
    assert np.polyfit(np.log(counts), np.log(scatter), 1)[0] < -0.8


def test_all_methods_agree():
    """Lines, Sobol' points and plain Monte Carlo agree within four combined standard errors."""
    line, sobol, drawn = (propagate(bent, BENT, method=method, seed=8) for method in ("line", "sobol", "random"))
    probabilities = [0.025, 0.5, 0.975]
    for other in (sobol, drawn):
        for name in ("mean", "sd"):
            errors = math.hypot(*(getattr(one, f"{name}_standard_error") for one in (line, other)))
            assert abs(getattr(line, name) - getattr(other, name)) <= 4 * errors
        errors = np.hypot(line.standard_error(probabilities), other.standard_error(probabilities))
        assert (np.abs(line.quantile(probabilities) - other.quantile(probabilities)) <= 4 * errors).all()
        assert other.shares == pytest.approx(line.shares, abs=0.05)
        assert other.total_shares == pytest.approx(line.total_shares, abs=0.05)
        assert other.probability_above(30.0) == pytest.approx(line.probability_above(30.0), abs=0.01)
    assert (line.standard_error(probabilities) < sobol.standard_error(probabilities)).all()


@each_method
def test_total_shares_of_an_additive_model_are_its_shares(method):
    """Without interaction total shares are the shares; a product's total shares leave more than 1 together."""
    spread = propagate(lambda a, b: a + 2 * b, {"a": Normal(0, 1), "b": Uniform(-1, 1)}, method=method)
    slack = 0.05 if method == "random" else 0.01
    assert spread.total_shares == pytest.approx({"a": 3 / 7, "b": 4 / 7}, abs=slack)
    assert spread.total_shares == pytest.approx(spread.shares, abs=2 * slack)
    together = propagate(lambda a, b: a * b, {"a": Normal(0, 1), "b": Uniform(-1, 1)}, method=method).total_shares
    assert together == pytest.approx({"a": 1.0, "b": 1.0}, abs=0.1)


def test_histogram_of_lines_holds_all_but_the_far_tails():
    """The histogram of lines has even edges between two tail quantiles, and the exact share in each bin."""
    spread = propagate(lambda a, b: a + b, {"a": Normal(0, 3), "b": Normal(1, 4)})
    edges, heights = spread.histogram(bins=20, cut=0.001)
    assert (edges[0], edges[-1]) == pytest.approx(tuple(1 + 5 * stats.norm.ppf([0.001, 0.999])), rel=1e-9)
    assert heights == pytest.approx(np.diff(stats.norm.cdf((edges - 1) / 5)), abs=1e-9)
    assert heights.sum() == pytest.approx(0.998, abs=1e-9)


@pytest.mark.parametrize("model", [lambda a, b: (a + b).mean(), lambda a, b: (a + b)[:-1]])
def test_lines_refuse_a_model_of_another_shape(model):
    """A model of several inputs that does not return their shape is refused before any fallback."""
    with pytest.raises(ValueError, match=r"^the model returned shape \(.*\), not that of its inputs$"):
        propagate(model, TWO)


def test_lines_give_the_model_what_points_give_it():
    """Lines call the model with flat keyword arrays of one shape within the limits of their distributions."""
    shapes = set()

    def model(**inputs):
        shapes.update(values.shape for values in inputs.values())
        assert len({values.shape for values in inputs.values()}) == 1
        assert inputs["b"].min() >= 0
        assert inputs["b"].max() <= 4
        return inputs["a"] + inputs["b"]

    numbers(propagate(model, TWO))
    assert all(len(shape) == 1 for shape in shapes)


def test_sixty_inputs_and_more():
    """More inputs than there are direction numbers are no obstacle."""
    inputs = {f"x{place}": Normal(0, 1) if place % 2 else Uniform(-1, 1) for place in range(70)}
    spread = propagate(lambda **x: sum(x.values()), inputs, samples=256)
    assert spread.method == "line"
    assert abs(spread.mean) <= 4 * spread.mean_standard_error
    assert abs(spread.sd - math.sqrt(35 + 35 / 3)) <= 4 * spread.sd_standard_error
