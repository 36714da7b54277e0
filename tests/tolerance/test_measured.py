"""The distribution through measured values: the sample's numbers, a smooth curve, ends where n values tell no more."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy import stats
from scipy.interpolate import BSpline
from scipy.optimize import lsq_linear
from scipy.special import ndtr, ndtri

from flexlash.tolerance import Measured, Normal, TruncatedNormal, Uniform, propagate
from flexlash.tolerance.distributions import Distribution
from flexlash.tolerance.measured import _curve_through

thorough = settings(deadline=None, max_examples=60, derandomize=True)

SCORES = np.linspace(-12, 12, 9601)
WEIGHTS = np.exp(-SCORES * SCORES / 2) / np.exp(-SCORES * SCORES / 2).sum()


def drawn(kind, count, seed=1):
    """Return values of a process of some kind."""
    draw = np.random.default_rng([count, seed])
    return {
        "normal": lambda: draw.normal(1.6, 0.004, count),
        "uniform": lambda: draw.random(count),
        "skewed": lambda: np.exp(0.5 * draw.standard_normal(count)),
        "two clusters": lambda: np.where(draw.random(count) < 0.5, -3, 3) + 0.6 * draw.standard_normal(count),
        "rounded": lambda: np.round(2 * draw.standard_normal(count)) / 2,
        "outlier": lambda: np.append(draw.standard_normal(count - 1), 40.0),
        "two values": lambda: np.arange(count) % 2 * 1.0,
        "all but one the same": lambda: np.append(np.zeros(count - 1), 1.0),
    }[kind]()


KINDS = ["normal", "uniform", "skewed", "two clusters", "rounded", "outlier", "two values", "all but one the same"]
each_sample = pytest.mark.parametrize(
    "values",
    [drawn(kind, count) for kind in KINDS for count in (5, 60)],
    ids=[f"{k} {n}" for k in KINDS for n in (5, 60)],
)
samples = st.lists(st.floats(-1e3, 1e3).map(lambda value: round(value, 3)), min_size=5, max_size=40)


def end_of(count):
    """Return the score of the ends: all of so many values lie within them in 95 of 100 samples."""
    return float(-ndtri((1 - 0.95 ** (1 / count)) / 2))


def inner(scores, count):
    """Return the scores of the normal cut at the ends that have the probabilities of scores."""
    beyond = ndtr(-end_of(count))
    tail = -ndtri(beyond + ndtr(-np.abs(scores)) * (1 - 2 * beyond))
    return np.copysign(tail, scores)


def plotting_positions(count):
    """Return Blom's scores of so many values in order."""
    return ndtri((np.arange(1, count + 1) - 0.375) / (count + 0.25))


@each_sample
def test_mean_and_sd_are_the_samples(values):
    """Mean and sd (n − 1) are the sample's, as told and by quadrature of the standard values over the scores."""
    own = Measured(values)
    assert own.expectation == own.location == pytest.approx(np.mean(values), rel=1e-13, abs=1e-13)
    assert own.standard_deviation == own.scale == pytest.approx(np.std(values, ddof=1), rel=1e-12)
    standard = own.standard_at(SCORES)
    mean = float(WEIGHTS @ standard)
    assert mean == pytest.approx(0, abs=1e-12)
    assert math.sqrt(WEIGHTS @ (standard - mean) ** 2) == pytest.approx(1, abs=1e-12)
    assert isinstance(own, Distribution)


@pytest.mark.slow
@thorough
@given(samples)
def test_curve_rises_smoothly(values):
    """Values rise strictly with the score between ± 6, never fall further out, and slope and bend have no jump."""
    assume(min(values) < max(values))
    own = Measured(values)
    assert (np.diff(own.standard_at(np.linspace(-6, 6, 2001))) > 0).all()
    assert (np.diff(own.standard_at(np.linspace(-8.3, 8.3, 1001))) >= -1e-14).all()
    jumps = []
    for step in (4e-3, 2e-3):
        curve = own.standard_at(np.arange(-3, 3 + step / 2, step))
        jumps.append([np.abs(np.diff(curve, 2 + order)).max() / step ** (1 + order) for order in (0, 1)])
    # What has no jump changes half as much over half the step; 1e-3 is the rounding of third differences.
    for wide, narrow in zip(*jumps, strict=True):
        assert narrow <= 0.75 * wide + 1e-3


@each_sample
def test_any_order_gives_the_same_bits(values):
    """Values in another order, or as a list, make an equal distribution with the same bits and the same shape."""
    own = Measured(values)
    for other in (Measured(values[::-1].tolist()), Measured(np.random.default_rng(3).permutation(values))):
        assert other == own
        assert other.shape == own.shape
        assert hash(other) == hash(own)
        assert (other.location, other.scale) == (own.location, own.scale)
        assert np.array_equal(other.standard_at(SCORES), own.standard_at(SCORES))


def test_zeros_of_either_sign_are_one():
    """Zeros with a sign change no bit of the shape, whichever comes first."""
    signed = []
    for values in ([-0.0, 0.0, -1.0, 1.0, 0.0], [0.0, -0.0, 1.0, 0.0, -1.0]):
        _curve_through.cache_clear()
        signed.append(Measured(values))
    assert signed[0].shape == signed[1].shape
    assert signed[0] == signed[1]
    assert hash(signed[0]) == hash(signed[1])


def test_rows_with_their_own_nominal_share_the_shape():
    """Deviations from several nominal sizes have one shape, as have values twice as large; others have another one."""
    deviations = drawn("normal", 60) - 1.6
    own = Measured(deviations)
    for other in (Measured(deviations, shift=80.0), Measured(2 * deviations)):
        assert other.shape == own.shape
        assert np.array_equal(other.standard_at(SCORES), own.standard_at(SCORES))
    assert Measured(deviations, shift=80.0).expectation == own.expectation + 80
    assert Measured(deviations, shift=80.0).scale == own.scale
    assert Measured(deviations, shift=80.0) != own
    assert Measured(deviations**3).shape != own.shape
    assert Measured(np.append(deviations, deviations)).shape != own.shape


def test_bits_do_not_depend_on_the_place():
    """Each number of an array has the bits that it has alone."""
    own = Measured(drawn("two clusters", 30))
    scores = np.random.default_rng(1).normal(size=(40, 5))
    for function, arguments in (
        (own.standard_at, scores),
        (own.standard, ndtr(scores)),
        (own.probability_below, own.standard_at(scores)),
    ):
        found = function(arguments)
        alone = [function(arguments.ravel()[index : index + 1])[0] for index in range(scores.size)]
        assert found.shape == scores.shape
        assert np.array_equal(found.ravel(), alone)


@pytest.mark.parametrize("count", [5, 20, 300])
def test_values_of_a_normal_give_a_cut_normal(count):
    """Values that lie at the scores of a normal give that normal cut at the ends, at its values' mean and sd."""
    own = Measured(80 + 0.02 * plotting_positions(count))
    cut = TruncatedNormal(0, 1, -end_of(count), end_of(count))
    expected = cut.standard_at(SCORES) / cut.standard_deviation
    assert own.standard_at(SCORES) == pytest.approx(expected, abs=1e-9)
    assert own.expectation == pytest.approx(80, rel=1e-14)


@pytest.mark.parametrize("kind", KINDS)
def test_curve_is_the_one_that_its_equation_describes(kind):
    """The curve minimises misfit and bending, by another solver on the whole problem with numerical integrals."""
    values = np.sort(drawn(kind, 30))
    end, count = end_of(30), math.ceil(2 * end_of(30) / 0.5)
    step = 2 * end / count
    fine = np.linspace(-end, end, 8001)
    columns = []
    for index in range(count + 2):
        element = BSpline.basis_element(step * (np.arange(4) + index - 2) - end, extrapolate=False)
        height = np.nan_to_num(element(fine))
        columns.append(np.append(0, np.cumsum((height[1:] + height[:-1]) / 2 * np.diff(fine))))
    positions = plotting_positions(30)
    weights = stats.norm.pdf(positions) / np.sqrt(ndtr(positions) * ndtr(-positions))
    at_values = np.array([np.interp(positions, fine, column) for column in columns]).T
    rows = np.column_stack([np.ones(30), at_values]) * weights[:, None]
    bends = np.column_stack([np.zeros(count + 1), np.diff(np.eye(count + 2), axis=0)]) * math.sqrt(0.1 / step)
    standardised = (values - values.mean()) / values.std(ddof=1)
    solved = lsq_linear(
        np.vstack([rows, bends]),
        np.append(weights * standardised, np.zeros(count + 1)),
        bounds=(np.append(-np.inf, np.full(count + 2, 0.02)), np.inf),
        tol=1e-14,
    )
    curve = solved.x[1:] @ np.array(columns)
    density = stats.norm.pdf(fine)
    density[[0, -1]] /= 2
    density /= density.sum()
    curve = (curve - density @ curve) / math.sqrt(density @ (curve - density @ curve) ** 2)
    scores = np.linspace(-4, 4, 161)
    expected = np.interp(inner(scores, 30), fine, curve)
    assert Measured(values).standard_at(scores) == pytest.approx(expected, abs=2e-5)


@each_sample
def test_tail_goes_on_with_the_last_slope(values):
    """Beyond the least and greatest value the curve over the scores of the cut normal is straight to 3 %."""
    count = len(values)
    own = Measured(values)
    for side in (-1, 1):
        first, last = plotting_positions(count)[-1], end_of(count)
        within = first + (last - first) * np.linspace(0, 1, 5)
        scores = side * -ndtri((ndtr(-within) - ndtr(-last)) / (1 - 2 * ndtr(-last)))
        slopes = np.diff(own.standard_at(np.clip(scores, -40, 40))) / np.diff(side * within)
        assert slopes == pytest.approx(np.full(4, slopes[-1]), rel=0.03, abs=0.01)


@pytest.mark.parametrize("count", [5, 60, 500])
def test_ends_are_what_so_many_values_can_tell(count):
    """The curve of a normal process ends at scores between which all of n values lie in 95 of 100 samples."""
    own = Measured(80 + 0.02 * plotting_positions(count))
    ends = own.standard(np.array([0.0, 1.0]))
    assert np.array_equal(own.standard_at(np.array([-40.0, 40.0])), ends)
    beyond = (own.location + own.scale * ends - 80) / 0.02
    # The curve keeps mean and sd of the values, so that its slope is a little off theirs.
    slope = own.scale / 0.02 / TruncatedNormal(0, 1, -end_of(count), end_of(count)).standard_deviation
    low, high = ndtr(beyond / slope)
    assert (high - low) ** count == pytest.approx(0.95, rel=1e-9)


@each_sample
def test_share_below_inverts_the_values(values):
    """The share below the value at a score is the score's, in both tails; beyond the ends it is 0 and 1."""
    own = Measured(values)
    scores = np.linspace(-8, 8, 321)
    below = own.probability_below(own.standard_at(scores))
    assert below == pytest.approx(ndtr(scores), abs=1e-12)
    assert own.probability_below(np.array([-1e3, 1e3])) == pytest.approx([0, 1], abs=1e-15)


@pytest.mark.parametrize("kind", KINDS)
def test_mirrored_values_give_the_mirrored_distribution(kind):
    """Values of the opposite sign have the opposite curve."""
    values = drawn(kind, 40)
    assert Measured(-values).standard_at(SCORES) == pytest.approx(-Measured(values).standard_at(-SCORES), abs=1e-9)


def test_rounding_of_a_gauge_moves_the_curve_less_than_itself():
    """Values rounded to a third of their sd give a curve within half of that step of the one before rounding."""
    values = drawn("normal", 200)
    step = 0.004 / 3
    fine, rounded = Measured(values), Measured(np.round(values / step) * step)
    scores = np.linspace(-8, 8, 161)
    off = (rounded.location + rounded.scale * rounded.standard_at(scores)) - (
        fine.location + fine.scale * fine.standard_at(scores)
    )
    assert np.abs(off).max() <= step / 2


PROCESSES = {
    "uniform": (lambda draw, count: draw.random(count), stats.uniform()),
    "skewed": (lambda draw, count: np.exp(0.5 * draw.standard_normal(count)), stats.lognorm(0.5)),
    "normal": (lambda draw, count: draw.standard_normal(count), stats.norm()),
    "triangular": (lambda draw, count: draw.triangular(0, 0.2, 1, count), stats.triang(0.2)),
}


@pytest.mark.slow
@pytest.mark.parametrize(("count", "most"), [(20, 0.37), (60, 0.25), (200, 0.15), (500, 0.11)])
@pytest.mark.parametrize("process", PROCESSES)
def test_curve_comes_close_to_the_process(process, count, most):
    """Percentiles lie nearer to the process's than the values in order do, and than a normal unless it is one."""
    draw, (make, truth) = np.random.default_rng(count), PROCESSES[process]
    probability = (np.arange(400) + 0.5) / 400
    exact = truth.ppf(probability)
    off = []
    for _ in range(60):
        values = np.sort(make(draw, count))
        own = Measured(values)
        found = own.location + own.scale * own.standard(probability)
        normal = own.location + own.scale * ndtri(probability)
        ordered = np.interp(ndtri(probability), plotting_positions(count), values)
        off.append([math.sqrt(np.mean((one - exact) ** 2)) / truth.std() for one in (found, normal, ordered)])
    own_off, normal_off, ordered_off = np.mean(off, axis=0)
    assert own_off <= most
    assert own_off <= 1.01 * ordered_off
    assert own_off <= (1.35 if process == "normal" else 1.0) * normal_off


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_lines_agree_with_points(kind):
    """A model of measured inputs has by lines the percentiles that Sobol' points give, within four standard errors."""
    inputs = {
        "a": Measured(drawn(kind, 60)),
        "b": Measured(drawn("rounded", 30)),
        "c": Uniform(0.0, 3.0),
        "d": Normal(10.0, 0.5),
    }

    def model(a, b, c, d):
        return (a + b) + c * d / 5

    lines, points = propagate(model, inputs), propagate(model, inputs, method="sobol")
    assert lines.method == "line"
    for level in (0.00135, 0.025, 0.5, 0.975, 0.99865):
        errors = math.hypot(float(lines.standard_error(level)), float(points.standard_error(level)))
        assert float(lines.quantile(level)) == pytest.approx(float(points.quantile(level)), abs=4 * errors)
    variance = inputs["a"].scale ** 2 + inputs["b"].scale ** 2 + (stats.uniform(0, 3).var() * 100.25 + 0.25 * 2.25) / 25
    assert lines.sd == pytest.approx(math.sqrt(variance), abs=4 * lines.sd_standard_error)


@pytest.mark.parametrize("kind", KINDS)
def test_one_measured_input_alone_is_exact(kind):
    """Percentiles of a single measured input, by lines, are its own to a millionth of its sd, moments to rounding."""
    own = Measured(drawn(kind, 60))
    spread = propagate(lambda a: 3 - 2 * a, {"a": own})
    levels = np.array([1e-6, 0.00135, 0.025, 0.5, 0.975, 0.99865])
    exact = 3 - 2 * (own.location + own.scale * own.standard(1 - levels))
    assert spread.quantile(levels) == pytest.approx(exact, abs=1e-6 * own.scale)
    assert spread.mean == pytest.approx(3 - 2 * own.expectation, abs=1e-10 * own.scale)
    assert spread.sd == pytest.approx(2 * own.standard_deviation, rel=1e-10)


@pytest.mark.slow
def test_sum_with_plain_numpy():
    """The share of a sum over a limit is that of two million draws of the values' own curve by numpy."""
    first, second = Measured(drawn("two clusters", 60)), Measured(drawn("skewed", 40))
    draw = np.random.default_rng(5)
    table = np.linspace(-8, 8, 4001)
    total = sum(
        one.location + one.scale * np.interp(draw.standard_normal(2_000_000), table, one.standard_at(table))
        for one in (first, second)
    )
    spread = propagate(lambda a, b: a + b, {"a": first, "b": second})
    limit = float(np.quantile(total, 0.99))
    assert float(spread.probability_above(limit)) == pytest.approx(0.01, abs=5 * math.sqrt(0.01 / 2e6) + 5e-5)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ([1.0, 2.0, 3.0, 4.0], "values have the shape (4,): at least 5 in a row are required"),
        (np.ones((5, 2)), "values have the shape (5, 2): at least 5 in a row are required"),
        (3.0, "values have the shape (): at least 5 in a row are required"),
        ([2.5] * 8, "values are all 2.5: at least two that differ are required"),
        ([1, 2, 3, 4, math.inf], "values must be finite"),
        ([1, 2, 3, 4, math.nan], "values = [1, 2, 3, 4, nan]: numbers are required"),
    ],
)
def test_samples_without_a_shape_are_refused(values, message):
    """Too few values, a table, values that are all the same or not finite are refused with what is required."""
    with pytest.raises(ValueError) as refusal:  # noqa: PT011
        Measured(values)
    assert str(refusal.value) == message


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Measured(["1", "2", "3", "4", "5"]), "values = ['1', '2', '3', '4', '5']: numbers are required"),
        (lambda: Measured([1.0, 2.0, None, 3.0, 4.0]), "values = [1.0, 2.0, None, 3.0, 4.0]: numbers are required"),
        (lambda: Measured([1, 2, 3, 4, 5], shift="0"), "shift = '0': a finite number is required"),
    ],
)
def test_what_is_no_number_is_refused(make, message):
    """Values or a shift that are no numbers are refused by name."""
    with pytest.raises(TypeError) as refusal:
        make()
    assert str(refusal.value) == message
