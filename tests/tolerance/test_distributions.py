"""Distributions against scipy.stats: quantiles, moments, shares below, cuts in both tails, and what they refuse."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats
from scipy.special import ndtr, ndtri

from flexlash.tolerance import Lognormal, Normal, Student, Triangular, TruncatedNormal, Uniform
from flexlash.tolerance.placed import Placed

thorough = settings(deadline=None, max_examples=80, derandomize=True)

PROBABILITIES = np.array([2.0**-53, 1e-9, 0.00135, 0.025, 0.3, 0.5, 0.7, 0.975, 0.99865, 1 - 1e-9, 1 - 2.0**-53])


def truncated(mean, sd, low, high):
    """Return scipy's truncated normal of the same four numbers."""
    return stats.truncnorm((low - mean) / sd, (high - mean) / sd, loc=mean, scale=sd)


def lognormal(mean, sd, low=0.0):
    """Return scipy's lognormal of this mean and sd above a low end, by its own parameters."""
    square = math.log(1 + (sd / (mean - low)) ** 2)
    return stats.lognorm(math.sqrt(square), low, math.exp(math.log(mean - low) - square / 2))


CASES = {
    "normal": (Normal(mean=80.0, sd=0.02), stats.norm(80.0, 0.02)),
    "uniform": (Uniform(low=1.55, high=1.65), stats.uniform(1.55, 0.1)),
    "uniform across zero": (Uniform(low=-3.0, high=1.0), stats.uniform(-3.0, 4.0)),
    "triangular": (Triangular(low=-1.0, high=3.0), stats.triang(0.5, -1.0, 4.0)),
    "triangular skewed": (Triangular(low=0.0, high=4.0, mode=1.0), stats.triang(0.25, 0.0, 4.0)),
    "triangular falling": (Triangular(low=1.0, high=2.0, mode=1.0), stats.triang(0.0, 1.0, 1.0)),
    "triangular rising": (Triangular(low=1.0, high=2.0, mode=2.0), stats.triang(1.0, 1.0, 1.0)),
    "cut at 3 sigma": (TruncatedNormal(5.0, 2.0, -1.0, 11.0), truncated(5.0, 2.0, -1.0, 11.0)),
    "cut at half a sigma": (TruncatedNormal(5.0, 2.0, 4.0, 6.0), truncated(5.0, 2.0, 4.0, 6.0)),
    "cut off centre": (TruncatedNormal(0.0, 1.0, -0.5, 3.0), truncated(0.0, 1.0, -0.5, 3.0)),
    "cut to the upper tail": (TruncatedNormal(0.0, 1.0, 4.0, 5.0), truncated(0.0, 1.0, 4.0, 5.0)),
    "cut to the lower tail": (TruncatedNormal(0.0, 1.0, -5.0, -4.0), truncated(0.0, 1.0, -5.0, -4.0)),
    "cut to the far upper tail": (TruncatedNormal(0.0, 1.0, 12.0, 13.0), truncated(0.0, 1.0, 12.0, 13.0)),
    "cut to the far lower tail": (TruncatedNormal(0.0, 1.0, -13.0, -12.0), truncated(0.0, 1.0, -13.0, -12.0)),
    "cut below alone": (TruncatedNormal(1.0, 2.0, 0.0, math.inf), truncated(1.0, 2.0, 0.0, math.inf)),
    "cut above alone": (TruncatedNormal(1.0, 2.0, -math.inf, 0.0), truncated(1.0, 2.0, -math.inf, 0.0)),
    "cut above zero in the tail": (TruncatedNormal(0.0, 1.0, 2.0, math.inf), truncated(0.0, 1.0, 2.0, math.inf)),
    "lognormal": (Lognormal(mean=2.0, sd=0.5), lognormal(2.0, 0.5)),
    "lognormal far from its low end": (Lognormal(mean=80.0, sd=0.02, low=10.0), lognormal(80.0, 0.02, 10.0)),
    "lognormal above a low end below zero": (Lognormal(mean=1.0, sd=2.0, low=-3.0), lognormal(1.0, 2.0, -3.0)),
    "student of 5 degrees": (Student(mean=80.0, scale=0.02, degrees=5), stats.t(5, 80.0, 0.02)),
    "student of 18.5 degrees": (Student(mean=-1.0, scale=3.0, degrees=18.5), stats.t(18.5, -1.0, 3.0)),
    "not cut": (TruncatedNormal(1.0, 2.0, -math.inf, math.inf), stats.norm(1.0, 2.0)),
}
each_case = pytest.mark.parametrize(("own", "reference"), CASES.values(), ids=list(CASES))


def quantiles(distribution, probabilities):
    """Return the values of a distribution at these probabilities."""
    return distribution.location + distribution.scale * distribution.standard(probabilities)


@each_case
def test_quantiles(own, reference):
    """The values at probabilities down to 2⁻⁵³ from both ends are scipy's quantiles."""
    spread = reference.ppf(0.75) - reference.ppf(0.25)
    inside = PROBABILITIES[1:-1]
    assert quantiles(own, inside) == pytest.approx(reference.ppf(inside), rel=1e-9, abs=1e-7 * spread)
    ends = quantiles(own, PROBABILITIES[[0, -1]])
    assert np.isfinite(ends).all()
    assert reference.support()[0] <= ends[0] < reference.ppf(1e-9)
    assert reference.ppf(1 - 1e-9) < ends[1] <= reference.support()[1]


@each_case
def test_mean(own, reference):
    """The expectation is the distribution's mean after any cut."""
    assert own.expectation == pytest.approx(float(reference.mean()), rel=1e-9, abs=1e-12)


@each_case
def test_standard_deviation(own, reference):
    """The standard deviation is the distribution's after any cut."""
    assert own.standard_deviation == pytest.approx(float(reference.std()), rel=1e-6)


@each_case
def test_moments_follow_from_the_quantiles(own, reference):
    """Mean and standard deviation are those of the values that the distribution itself produces."""
    del reference
    probabilities = (np.arange(200_000) + 0.5) / 200_000
    values = quantiles(own, probabilities)
    assert own.expectation == pytest.approx(values.mean(), abs=1e-4 * values.std())
    assert own.standard_deviation == pytest.approx(values.std(), rel=1e-3)


@each_case
def test_shares_below_are_the_distribution_function(own, reference):
    """The share below a standard value is scipy's, 0 and 1 at and beyond ends, and that of the value's own score."""
    ends = np.array(reference.support())
    spread = reference.std()
    values = np.concatenate([reference.mean() + spread * np.linspace(-9, 9, 181), ends[np.isfinite(ends)]])
    found = own.probability_below((values - own.location) / own.scale)
    assert found == pytest.approx(reference.cdf(values), rel=1e-8, abs=1e-12)
    assert own.probability_below(np.full((3, 4), 0.3)).shape == (3, 4)
    # The difference of the values near a far cut from the cut itself is what rounding leaves of it.
    scores = np.linspace(-8, 3, 111)
    assert own.probability_below(own.standard_at(scores)) == pytest.approx(ndtr(scores), rel=1e-9, abs=1e-12)


@each_case
def test_bits_do_not_depend_on_the_place(own, reference):
    """Each number of an array has the bits that it has alone, in all three functions."""
    del reference
    probabilities = np.random.default_rng(1).random(200)
    for function, arguments in (
        (own.standard, probabilities),
        (own.standard_at, ndtri(probabilities)),
        (own.probability_below, own.standard(probabilities)),
    ):
        alone = [function(arguments[index : index + 1])[0] for index in range(len(arguments))]
        assert np.array_equal(function(arguments), alone)


def rise_within(values, support):
    """Whether values never fall and never leave a support by more than rounding."""
    slack = 1e-12 * (values[-1] - values[0])
    return (np.diff(values) >= 0).all() and support[0] - slack <= values[0] and values[-1] <= support[1] + slack


@each_case
def test_values_rise_with_the_probability(own, reference):
    """A greater probability never has a smaller value, and none leaves the support."""
    values = quantiles(own, np.linspace(2.0**-53, 1 - 2.0**-53, 5001))
    assert rise_within(values, reference.support())


@each_case
def test_shape_of_the_points_is_kept(own, reference):
    """Standard values have the shape of their probabilities."""
    del reference
    assert own.standard(np.full((3, 4), 0.3)).shape == (3, 4)


@each_case
def test_values_at_scores_are_those_at_their_probabilities(own, reference):
    """The value at a standard normal score is the value at its probability, and scipy's quantile from both ends."""
    scores = np.linspace(-5.5, 5.5, 221)
    found, at_probability = own.standard_at(scores), own.standard(ndtr(scores))
    assert found.shape == scores.shape
    size = own.standard_deviation / own.scale
    assert found == pytest.approx(at_probability, rel=0, abs=1e-6 * size)
    inner = np.abs(scores) <= 3
    assert found[inner] == pytest.approx(at_probability[inner], rel=0, abs=1e-9 * size)
    exact = np.where(scores < 0, reference.ppf(ndtr(scores)), reference.isf(ndtr(-scores)))
    values = own.location + own.scale * found
    assert values == pytest.approx(exact, rel=0, abs=1e-7 * own.standard_deviation)


@each_case
def test_values_rise_with_the_score_into_both_tails(own, reference):
    """Out to 8.3 scores on both sides values are finite, never fall, and never leave the support."""
    values = own.location + own.scale * own.standard_at(np.linspace(-8.3, 8.3, 3321))
    assert np.isfinite(values).all()
    assert rise_within(values, reference.support())


@each_case
def test_values_at_scores_keep_their_shape(own, reference):
    """Values at scores have the shape of the scores."""
    del reference
    assert own.standard_at(np.full((3, 4), 0.3)).shape == (3, 4)


@pytest.mark.parametrize("score", [-8.2, -7.0, -6.0, 6.0, 7.0, 8.2])
def test_scores_keep_their_digits_in_both_tails(score):
    """Far out, where probabilities near 1 have run out of digits, the share beyond a value is still the score's."""
    at, share = np.array([score]), ndtr(-abs(score))
    assert Normal(0, 1).standard_at(at)[0] == score
    below, above = TruncatedNormal(1, 2, 0, math.inf), TruncatedNormal(1, 2, -math.inf, 2)
    uncut = above if score < 0 else below
    beyond = ndtr(-abs(uncut.standard_at(at)[0])) / ndtr(0.5)
    assert beyond == pytest.approx(share, rel=1e-9)
    from_low, from_high = (Triangular(0, 1).standard_at(side)[0] for side in (at, -at))
    assert from_low == pytest.approx(1 - from_high, abs=1e-15)
    near = min(from_low, from_high)
    assert near == pytest.approx(math.sqrt(share / 2), rel=1e-9)
    assert Uniform(0, 1).standard_at(-np.abs(at))[0] == pytest.approx(share, rel=1e-12)


@pytest.mark.parametrize(
    "mirrored",
    [Normal(0, 1), Uniform(-1, 1), Triangular(-1, 1), TruncatedNormal(0, 1, -3, 3), TruncatedNormal(0, 1, -0.3, 0.3)],
)
def test_symmetric_distributions_have_symmetric_values(mirrored):
    """The values of a symmetric distribution at opposite scores are opposite, out to both ends."""
    scores = np.linspace(0, 8.3, 84)
    low, high = (mirrored.location + mirrored.scale * mirrored.standard_at(side) for side in (-scores, scores))
    assert low == pytest.approx(-high, rel=0, abs=1e-14)


@pytest.mark.parametrize(
    ("distribution", "breaks"),
    [
        (Normal(0, 1), ()),
        (Uniform(0, 1), ()),
        (TruncatedNormal(0, 1, -1, 3), ()),
        (Triangular(-1, 3), (0.0,)),
        (Triangular(0, 4, 1), (float(ndtri(0.25)),)),
        (Triangular(0, 4, 0), ()),
        (Triangular(0, 4, 4), ()),
    ],
)
def test_breaks_are_where_the_curve_has_a_kink(distribution, breaks):
    """A triangle has one break, at the score of a peak inside it; the curvature jumps there and nowhere else."""
    assert distribution.breaks == pytest.approx(breaks, abs=1e-12)
    step = 1e-3
    places = np.linspace(-2, 2, 1601)
    ends = [distribution.standard_at(places + shift * step) for shift in (-2, -1, 0, 1, 2)]
    # The second differences before and after a place are far apart where the curvature jumps.
    jump = np.abs((ends[0] - 2 * ends[1] + ends[2]) - (ends[2] - 2 * ends[3] + ends[4])) / step**2
    jumped = places[jump > 20 * np.median(jump) + 1e-6]
    assert bool(len(jumped)) is bool(breaks)
    assert all(np.abs(place - np.array(breaks)).min() <= 3 * step for place in jumped)


@pytest.mark.slow
@thorough
@given(
    mean=st.floats(-100, 100),
    sd=st.floats(0.01, 10),
    first=st.floats(-6, 6),
    width=st.floats(0.05, 12),
    probability=st.floats(1e-6, 1 - 1e-6),
)
def test_cut_normal_inverts_its_own_share(mean, sd, first, width, probability):
    """The share of a cut normal below its own quantile is the probability, wherever both cuts lie."""
    low, high = mean + first * sd, mean + (first + width) * sd
    own = TruncatedNormal(mean=mean, sd=sd, low=low, high=high)
    value = float(quantiles(own, np.array(probability)))
    assert low - 1e-9 * sd <= value <= high + 1e-9 * sd
    reached = truncated(mean, sd, low, high).cdf(value)
    assert reached == pytest.approx(probability, rel=1e-6, abs=1e-7)


@thorough
@given(sigma=st.floats(0.05, 8), sd=st.floats(1e-6, 1e3))
def test_cut_never_scatters_more(sigma, sd):
    """A cut normal scatters less than uncut and less than uniform between the same cuts."""
    cut = TruncatedNormal(mean=1.0, sd=sd, low=1.0 - sigma * sd, high=1.0 + sigma * sd)
    assert cut.standard_deviation <= sd
    assert cut.standard_deviation <= 2 * sigma * sd / math.sqrt(12) * (1 + 1e-9)
    assert cut.expectation == pytest.approx(1.0, abs=1e-12 * max(1, sd))


@pytest.mark.parametrize("half", [1e-2, 1e-4, 1e-6, 1e-8])
@pytest.mark.parametrize("centre", [0.0, 1.0, -2.0])
def test_sliver_of_a_normal_is_uniform(half, centre):
    """A normal cut to a sliver scatters as the uniform distribution between its cuts does."""
    sliver = TruncatedNormal(mean=0.0, sd=1.0, low=centre - half, high=centre + half)
    assert sliver.expectation == pytest.approx(centre, abs=half / 50)
    assert sliver.standard_deviation == pytest.approx(half / math.sqrt(3), rel=1e-3)


def test_triangle_peaks_in_the_middle_unless_told():
    """A triangle without a mode is symmetric: the same numbers as with its mode in the middle."""
    plain, told = Triangular(low=-0.3, high=0.3), Triangular(low=-0.3, high=0.3, mode=0.0)
    assert plain.expectation == told.expectation == 0
    assert plain.standard_deviation == told.standard_deviation == pytest.approx(0.3 / math.sqrt(6), rel=1e-15)
    assert plain.shape == told.shape


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (Normal(mean=0, sd=1), Normal(mean=80, sd=0.02)),
        (Uniform(low=0, high=1), Uniform(low=1.55, high=1.65)),
        (Triangular(low=0, high=4, mode=1), Triangular(low=0, high=8, mode=2)),
        (Lognormal(mean=2, sd=1), Lognormal(mean=6, sd=2, low=2)),
        (Student(mean=0, scale=1, degrees=7), Student(mean=5, scale=2, degrees=7)),
        (TruncatedNormal(0, 1, -3, 3), TruncatedNormal(10, 2, 4, 16)),
    ],
)
def test_same_shape_has_the_same_standard_values(first, second):
    """Distributions that differ in location and scale alone share their shape and its standard values."""
    assert first.shape == second.shape
    assert hash(first.shape) == hash(second.shape)
    assert np.array_equal(first.standard(PROBABILITIES), second.standard(PROBABILITIES))
    assert first != second


def test_other_shapes_are_told_apart():
    """Distributions whose standard values differ have different shapes."""
    different = [
        Normal(0, 1),
        Uniform(0, 1),
        Triangular(0, 1),
        Triangular(0, 1, 0.25),
        TruncatedNormal(0, 1, -3, 3),
        TruncatedNormal(0, 1, -2, 3),
        TruncatedNormal(0, 1, -3, 2),
        Lognormal(2, 1),
        Lognormal(2, 1, 0.5),
        Student(0, 1, 4),
        Student(0, 1, 5),
    ]
    assert len({one.shape for one in different}) == len(different)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Normal(mean=0, sd=0), "sd = 0 must be a finite number greater than 0"),
        (lambda: Normal(mean=0, sd=-1), "sd = -1 must be a finite number greater than 0"),
        (lambda: Normal(mean=0, sd=math.inf), "sd = inf: a finite number is required"),
        (lambda: Normal(mean=0, sd=math.nan), "sd = nan: a finite number is required"),
        (lambda: TruncatedNormal(0, 0, -1, 1), "sd = 0 must be a finite number greater than 0"),
        (lambda: TruncatedNormal(0, 1, 1, 1), "low = 1 must be less than high = 1"),
        (lambda: TruncatedNormal(0, 1, math.nan, 1), "low = nan: a number is required"),
        (lambda: TruncatedNormal(0, 1, 50, 51), "low and high leave no part of the normal distribution"),
        (lambda: TruncatedNormal(0, 1, -51, -50), "low and high leave no part of the normal distribution"),
        (lambda: Uniform(low=1, high=1), "low = 1 must be less than high = 1"),
        (lambda: Uniform(low=2.5, high=-1), "low = 2.5 must be less than high = -1"),
        (lambda: Triangular(low=1, high=0), "low = 1 must be less than high = 0"),
        (lambda: Triangular(low=0, high=1, mode=2), "mode = 2 must lie between low = 0 and high = 1"),
        (lambda: Triangular(low=0, high=1, mode=-0.5), "mode = -0.5 must lie between low = 0 and high = 1"),
        (lambda: Triangular(low=0, high=1, mode=math.nan), "mode = nan: a finite number is required"),
        (lambda: Lognormal(mean=1, sd=0), "sd = 0 must be a finite number greater than 0"),
        (lambda: Lognormal(mean=0, sd=1), "low = 0 must be less than mean = 0"),
        (lambda: Lognormal(mean=1, sd=1, low=math.nan), "low = nan: a finite number is required"),
        (lambda: Lognormal(mean=1, sd=1e7), "sd = 1e+07 must be at most 1e+06 times mean less low"),
        (lambda: Student(mean=0, scale=0, degrees=5), "scale = 0 must be a finite number greater than 0"),
        (lambda: Student(mean=0, scale=1, degrees=2.9), "degrees = 2.9 must be at least 3"),
    ],
)
def test_impossible_distributions_are_refused(make, message):
    """A distribution that cannot be is refused with the value found and what is required."""
    with pytest.raises(ValueError) as refusal:  # noqa: PT011
        make()
    assert str(refusal.value) == message


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Normal("0", 1), "mean = '0': a finite number is required"),
        (lambda: Normal(0, True), "sd = True: a finite number is required"),
        (lambda: TruncatedNormal(0, 1, None, 1), "low = None: a number is required"),
        (lambda: Uniform(0, [1, 2]), "high = [1, 2]: a number is required"),
        (lambda: Triangular(0, 1, "0.5"), "mode = '0.5': a finite number is required"),
        (lambda: Lognormal(1, 1, None), "low = None: a finite number is required"),
        (lambda: Student(0, 1, "5"), "degrees = '5': a finite number is required"),
        (lambda: Placed(Normal(0, 1), 0, "1"), "sd = '1': a finite number is required"),
    ],
)
def test_what_is_no_number_is_refused(make, message):
    """An argument of a distribution that is no number is refused with its name."""
    with pytest.raises(TypeError) as refusal:
        make()
    assert str(refusal.value) == message


def test_numbers_of_numpy_serve():
    """Whole and other numbers of NumPy make the same distribution as Python's own."""
    assert Uniform(np.int64(0), np.float32(1)) == Uniform(0, 1)
    assert TruncatedNormal(0, 1, -math.inf, np.float64(2)).high == 2


@pytest.mark.parametrize(
    "make", [lambda: Uniform(-math.inf, 1), lambda: Triangular(0, math.inf), lambda: Normal(math.nan, 1)]
)
def test_endless_distributions_are_refused(make):
    """A uniform or triangular distribution without end, or a normal without a mean, is refused."""
    with pytest.raises(ValueError):  # noqa: PT011
        make()
