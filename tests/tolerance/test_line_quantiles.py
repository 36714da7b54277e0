"""What lines say about the output, against exact distributions: quantiles, shares, moments and their errors."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from line_models import lines_of, probability_below, total
from one_input import ONE_INPUT, PROBABILITIES
from scipy import integrate, stats
from scipy.special import ndtri

from flexlash.tolerance import Normal, Triangular, Uniform, propagate
from flexlash.tolerance.engine.line_drawing import DrawnLines
from flexlash.tolerance.engine.line_moments import moments_of
from flexlash.tolerance.engine.line_quantiles import probability_interval, quantiles_at, quantiles_of

thorough = settings(deadline=None, max_examples=100, derandomize=True)

each_input = pytest.mark.parametrize(("distribution", "reference"), ONE_INPUT.values(), ids=list(ONE_INPUT))


def sound_lines(function, *rows, **options):
    """Return lines through rows, none of which has a fault."""
    lines = lines_of(function, *rows, **options)
    assert (lines.faults == 0).all()
    return DrawnLines(lines=lines, control=None)


def uniforms(*widths):
    """Return uniform inputs between 0 and these widths."""
    return {f"u{place}": Uniform(0, width) for place, width in enumerate(widths)}


@each_input
def test_quantiles_of_one_input_are_exact(distribution, reference):
    """Quantiles of a single input of any distribution are exact to 1e-9 standard deviations."""
    found = quantiles_of(sound_lines(lambda a: a, {"a": distribution}, lines=8), PROBABILITIES)
    sd = distribution.standard_deviation
    assert found.output[:, 0] == pytest.approx(reference.ppf(PROBABILITIES), rel=0, abs=1e-9 * sd)
    assert (found.output_error <= 3e-9 * sd).all()
    assert (found.output_error > 0).all()


@each_input
def test_shares_of_one_input_are_exact(distribution, reference):
    """Shares above values of a single input are exact to 1e-9 of themselves, in both tails."""
    values = reference.ppf(PROBABILITIES)
    found = quantiles_at(sound_lines(lambda a: a, {"a": distribution}, lines=8), values[:, None])
    assert found.above[:, 0] == pytest.approx(reference.sf(values), rel=1e-9)


@each_input
def test_moments_of_one_input_are_exact(distribution, reference):
    """Mean, standard deviation, skewness and kurtosis of a single input are exact, with errors that say so."""
    moments = moments_of(sound_lines(lambda a: a, {"a": distribution}, lines=8))
    sd = distribution.standard_deviation
    assert moments.mean[0] == pytest.approx(distribution.expectation, rel=0, abs=1e-9 * sd)
    assert moments.sd[0] == pytest.approx(sd, rel=1e-9)
    assert moments.skewness[0] == pytest.approx(float(reference.stats("s")), abs=1e-8)
    assert 0 < moments.mean_error[0] <= 2e-9 * sd
    assert 0 < moments.sd_error[0] <= 2e-9 * sd
    assert moments.kurtosis[0] == pytest.approx(float(reference.stats("k")), abs=1e-7)
    assert 0 < moments.skewness_error[0] <= 2e-9
    assert 0 < moments.kurtosis_error[0] <= 2e-8


def test_moments_of_a_falling_output_are_exact():
    """Where the output falls with a skewed triangle, mean and standard deviation are exact all the same."""
    skewed = Triangular(0, 4, 1)
    moments = moments_of(sound_lines(lambda a: -a, {"a": skewed}, lines=8))
    sd = skewed.standard_deviation
    assert moments.mean[0] == pytest.approx(-skewed.expectation, rel=0, abs=1e-9 * sd)
    assert moments.sd[0] == pytest.approx(sd, rel=1e-9)


@pytest.mark.parametrize("lines", [8, 64, 256])
def test_linear_normal_is_exact(lines):
    """A linear function of normals is normal: moments, quantiles and shares to 1e-9, whatever the number of lines."""
    row = {"a": Normal(1, 2), "b": Normal(-3, 0.5), "c": Normal(0, 1e-3)}
    found = sound_lines(lambda a, b, c: a - 4 * b + c, row, lines=lines)
    mean, sd = 13.0, math.sqrt(8 + 1e-6)
    moments = moments_of(found)
    assert moments.mean[0] == pytest.approx(mean, rel=0, abs=1e-9 * sd)
    assert moments.sd[0] == pytest.approx(sd, rel=1e-9)
    assert moments.skewness[0] == pytest.approx(0, abs=1e-9)
    quantiles = quantiles_of(found, PROBABILITIES)
    assert quantiles.output[:, 0] == pytest.approx(mean + sd * ndtri(PROBABILITIES), rel=0, abs=1e-9 * sd)
    scores = np.array([-7.0, -3.0, 0.0, 1.0, 4.75, 6.0, 7.0])
    above = quantiles_at(found, mean + sd * scores[:, None]).above[:, 0]
    assert above == pytest.approx(stats.norm.sf(scores), rel=1e-9)


@pytest.mark.parametrize("widths", [(1, 1), (1, 1, 1), (1, 2, 0.5, 3), (1,) * 12], ids=["2", "3", "4 unlike", "12"])
def test_sums_of_uniforms_against_irwin_and_hall(widths):
    """Quantiles and shares of sums of uniforms agree with Irwin–Hall within four of their standard errors."""
    lines = sound_lines(total, uniforms(*widths), lines=512)
    quantiles = quantiles_of(lines, PROBABILITIES[1:-1])
    below = np.array([probability_below(value, widths) for value in quantiles.output[:, 0]])
    off = (below - PROBABILITIES[1:-1]) / quantiles.density[:, 0]
    assert (np.abs(off) <= 4 * quantiles.output_error[:, 0]).all()
    assert (quantiles.output_error[:, 0] <= 0.02 * lines.lines.scale[0]).all()
    values = np.array([0.2, 0.5, 0.7, 0.9]) * sum(widths)
    shares = quantiles_at(lines, values[:, None])
    exact = 1 - np.array([probability_below(value, widths) for value in values])
    assert (np.abs(shares.above[:, 0] - exact) <= 4 * shares.above_error[:, 0] + 1e-12).all()


def test_moments_of_sums_of_uniforms():
    """Mean, sd, skewness and kurtosis of a sum of uniforms agree within four of their standard errors."""
    widths = (1.0, 2.0, 0.5, 3.0)
    moments = moments_of(sound_lines(total, uniforms(*widths), lines=512))
    sd = math.sqrt(sum(width**2 for width in widths) / 12)
    assert abs(moments.mean[0] - sum(widths) / 2) <= 4 * moments.mean_error[0]
    assert abs(moments.sd[0] - sd) <= 4 * moments.sd_error[0]
    assert abs(moments.skewness[0]) <= 4 * moments.skewness_error[0]
    excess = -1.2 * sum(width**4 for width in widths) / sum(width**2 for width in widths) ** 2
    assert abs(moments.kurtosis[0] - excess) <= 4 * moments.kurtosis_error[0]
    assert moments.mean_error[0] <= 1e-2 * sd


def test_moments_of_a_lognormal():
    """The exponential of a normal sum has the moments of a lognormal within four of their tiny standard errors."""
    row = {"a": Normal(0, 0.3), "b": Normal(1, 0.4)}
    moments = moments_of(sound_lines(lambda a, b: np.exp(a + b), row))
    reference = stats.lognorm(0.5, scale=math.e)
    assert abs(moments.mean[0] - reference.mean()) <= 4 * moments.mean_error[0]
    assert abs(moments.sd[0] - reference.std()) <= 4 * moments.sd_error[0]
    assert abs(moments.skewness[0] - reference.stats("s")) <= 4 * moments.skewness_error[0]
    assert abs(moments.kurtosis[0] - reference.stats("k")) <= 4 * moments.kurtosis_error[0]
    assert moments.mean_error[0] <= 1e-4


@pytest.mark.parametrize("sd", [0.5, 1.0, 1.5])
def test_what_lies_beyond_the_lines_is_told(sd):
    """A long tail, part of whose fourth moment lies beyond the ends of the lines, has moments within their errors."""
    moments = moments_of(sound_lines(lambda x: np.exp(sd * x), {"x": Normal(0, 1)}, lines=8))
    for name, exact in zip(("skewness", "kurtosis"), stats.lognorm(sd).stats("sk"), strict=True):
        assert abs(getattr(moments, name)[0] - exact) <= getattr(moments, f"{name}_error")[0]


def test_quantiles_and_shares_are_each_others_inverse():
    """The share above a quantile is one less its probability, in both tails and within their errors."""
    row = {"a": Normal(10, 0.5), "b": Normal(1.6, 0.03), "c": Uniform(9, 11)}
    lines = sound_lines(lambda a, b, c: a * c / b**3, row, lines=256)
    quantiles = quantiles_of(lines, PROBABILITIES)
    shares = quantiles_at(lines, quantiles.output)
    assert (np.diff(quantiles.output[:, 0]) > 0).all()
    assert (np.abs(shares.above[:, 0] - (1 - PROBABILITIES)) <= 1e-2 * shares.above_error[:, 0] + 1e-9).all()
    assert shares.density[:, 0] == pytest.approx(quantiles.density[:, 0], rel=1e-2)


def test_density_is_the_slope_of_the_share():
    """The density at an output is how fast the share above falls there."""
    lines = sound_lines(total, uniforms(1, 1, 1), lines=512)
    values = np.array([0.5, 1.0, 1.5, 2.2])
    ends = [quantiles_at(lines, values[:, None] + end).above[:, 0] for end in (-1e-4, 1e-4)]
    assert quantiles_at(lines, values[:, None]).density[:, 0] == pytest.approx((ends[0] - ends[1]) / 2e-4, rel=1e-2)


def test_far_tails_keep_their_digits():
    """A share deep in the tail of a sum agrees within four of its standard errors, which stay a small part of it."""
    lines = sound_lines(total, uniforms(1, 1, 1), lines=1024)
    values = np.array([2.9, 2.97, 2.99, 2.997])
    found = quantiles_at(lines, values[:, None])
    exact = (3 - values) ** 3 / 6
    assert (np.abs(found.above[:, 0] - exact) <= 4 * found.above_error[:, 0]).all()
    assert (found.above_error[:, 0] <= 0.05 * exact).all()


def test_outputs_out_of_reach():
    """Beyond what bounded inputs can reach there is no share above, below it no share missing."""
    lines = sound_lines(total, uniforms(1, 2), lines=64)
    found = quantiles_at(lines, np.array([[3.0], [3.5], [1e9], [-1e-9], [-1e9]]))
    assert (found.above[:3] < 1e-15).all()
    assert (found.above[3:] > 1 - 1e-15).all()
    assert found.above[1:3].tolist() == [[0.0], [0.0]]
    assert found.above[4].tolist() == [1.0]
    assert (found.above_error <= 1e-15).all()
    assert np.isfinite(found.residual).all()
    assert np.isfinite(found.output_error).all()


@pytest.mark.parametrize("probability", [0.0, 1e-300, 1e-15, 1e-9, 1 - 1e-9, 1 - 1e-16, 1.0])
def test_extreme_probabilities_stay_within_reach(probability):
    """Quantiles at the ends are finite and within the limits of bounded inputs."""
    found = quantiles_of(sound_lines(total, uniforms(1, 2), lines=64), np.array([probability]))
    assert 0 <= found.output[0, 0] <= 3
    assert np.isfinite(found.output_error).all()


def test_table_spacing_leaves_no_bias():
    """A kink between the nodes of the table biases neither quantiles nor shares of a single input."""
    lines = sound_lines(lambda a: np.where(a > 0.83, 0.83 + 1.4 * (a - 0.83), a), {"a": Normal(0, 1)}, lines=8)
    scores = np.array([-1.0, 0.7, 0.8, 0.83, 0.9, 1.2, 3.0])
    exact = np.where(scores > 0.83, 0.83 + 1.4 * (scores - 0.83), scores)
    found = quantiles_of(lines, stats.norm.cdf(scores))
    assert found.output[:, 0] == pytest.approx(exact, abs=1e-8)
    assert quantiles_at(lines, exact[:, None]).above[:, 0] == pytest.approx(stats.norm.sf(scores), rel=1e-8)


def test_rows_do_not_depend_on_their_neighbours():
    """Every number of a row is the same bit for bit, alone or beside other rows."""

    def product_of(a, b, c):
        return a * b**2 * c

    rows = [
        {"a": Normal(10, 1), "b": Uniform(1, 2), "c": Triangular(3, 4)},
        {"a": Normal(10, 2), "b": Uniform(8, 9), "c": Triangular(1, 4)},
        {"a": Normal(50, 1), "b": Uniform(5, 9), "c": Triangular(1, 2)},
    ]
    limits = np.array([90.0, 2500.0, 5000.0])
    together = sound_lines(product_of, *rows)
    for place, row in enumerate(rows):
        alone = sound_lines(product_of, row)
        pairs = [
            (quantiles_of(together, PROBABILITIES), quantiles_of(alone, PROBABILITIES)),
            (quantiles_at(together, limits[None]), quantiles_at(alone, limits[None, place : place + 1])),
        ]
        for several, single in pairs:
            for name, values in vars(single).items():
                assert np.array_equal(vars(several)[name][:, place], values[:, 0]), name
        several, single = moments_of(together), moments_of(alone)
        for name, values in vars(single).items():
            assert vars(several)[name][place] == values[0], name


def test_levels_do_not_depend_on_one_another():
    """A quantile is the same bit for bit, asked for alone or among others."""
    lines = sound_lines(total, uniforms(1, 2, 3))
    every = quantiles_of(lines, PROBABILITIES)
    for place, probability in enumerate(PROBABILITIES):
        alone = quantiles_of(lines, np.array([probability]))
        assert alone.output[0, 0] == every.output[place, 0]
        assert alone.above_error[0, 0] == every.above_error[place, 0]


def test_crossings_are_cut_and_widened():
    """The first levels can be taken, and margins multiply standard errors alone."""
    found = quantiles_of(sound_lines(total, uniforms(1, 2), uniforms(2, 4)), PROBABILITIES)
    first = found.take(2)
    assert first.output.shape == (2, 2)
    assert np.array_equal(first.above_error, found.above_error[:2])
    wider = found.widened(np.array([1.0, 1.5]))
    assert np.array_equal(wider.output, found.output)
    assert np.array_equal(wider.above_error, found.above_error * [1.0, 1.5])
    assert (wider.output_error[:, 1] > found.output_error[:, 1]).all()
    moments = moments_of(sound_lines(total, uniforms(1, 2), uniforms(2, 4)))
    more = moments.widened(np.array([2.0, 1.0]))
    assert np.array_equal(more.mean, moments.mean)
    assert np.array_equal(more.sd_error, moments.sd_error * [2.0, 1.0])
    assert np.array_equal(more.skewness_error, moments.skewness_error * [2.0, 1.0])


def test_told_errors_of_moments_are_how_far_they_scatter():
    """Over many seeds moments scatter by what is told of them, which is widened by Student's t of seven degrees.

    Skewness and kurtosis go with mean and sd, so that they are known better than third and fourth moment.
    """

    def output(a, b, c):
        return np.exp(a) * (3 + b) + 0.3 * c * c + c

    inputs = {"a": Normal(0, 0.5), "b": Uniform(-1, 1), "c": Uniform(-1, 1)}
    found = [moments_of(sound_lines(output, inputs, lines=64, seed=seed)) for seed in range(240)]
    for name in ("mean", "sd", "skewness", "kurtosis"):
        scatter = np.std([getattr(one, name)[0] for one in found], ddof=1)
        told = np.sqrt(np.mean([getattr(one, f"{name}_error")[0] ** 2 for one in found]))
        assert 0.7 < scatter / told < 1.0, name


@pytest.mark.slow
def test_more_lines_err_less():
    """Errors of a sum of four uniforms fall faster than those of independent lines would."""
    probabilities = np.array([0.025, 0.5, 0.99865])
    scatter = []
    for count in (64, 1024):
        found = [
            quantiles_of(sound_lines(total, uniforms(1, 1, 1, 1), lines=count, seed=seed), probabilities).output[:, 0]
            for seed in range(24)
        ]
        scatter.append(np.std(found, axis=0, ddof=1))
    assert (scatter[1] < scatter[0] / 6).all()


@pytest.mark.parametrize("share", [0.5, 0.1, 1e-3, 1e-6])
@pytest.mark.parametrize("relative", [1e-6, 1e-3])
def test_narrow_interval_of_a_share_is_even(share, relative):
    """With a small error the interval is the share ± 1.96 standard errors."""
    error = relative * share
    low, high = probability_interval(np.array([share]), np.array([error]))
    assert low[0] == pytest.approx(share - 1.96 * error, abs=0.02 * error)
    assert high[0] == pytest.approx(share + 1.96 * error, abs=0.02 * error)


@thorough
@given(share=st.floats(1e-12, 1 - 1e-12), relative=st.floats(0, 10), factor=st.floats(0.1, 5))
def test_interval_of_a_share_holds_it_within_0_and_1(share, relative, factor):
    """The interval holds the share to rounding, stays within 0 and 1, and widens with the factor."""
    error = np.array([relative * min(share, 1 - share)])
    low, high = probability_interval(np.array([share]), error, factor)
    assert 0 <= low[0] <= share * (1 + 1e-9)
    assert share * (1 - 1e-9) <= high[0] <= 1
    wide_low, wide_high = probability_interval(np.array([share]), error, 2 * factor)
    assert wide_low[0] <= low[0]
    assert high[0] <= wide_high[0]


@thorough
@given(share=st.floats(0.01, 0.99), relative=st.floats(0.001, 1))
def test_interval_of_the_rest_is_the_rest_of_the_interval(share, relative):
    """The interval of one less a share is one less its interval."""
    error = np.array([relative * min(share, 1 - share)])
    low, high = probability_interval(np.array([share]), error)
    rest_low, rest_high = probability_interval(np.array([1 - share]), error)
    assert rest_low[0] == pytest.approx(1 - high[0], abs=1e-12)
    assert rest_high[0] == pytest.approx(1 - low[0], abs=1e-12)


def test_interval_of_no_share():
    """A share told from none by nothing has an interval from exactly 0 to almost 0, and so the rest of one."""
    low, high = probability_interval(np.array([0.0, 1e-17, 1.0]), np.zeros(3))
    assert low[:2].tolist() == [0.0, 0.0]
    assert (high[:2] <= 1e-14).all()
    assert low[2] >= 1 - 1e-14
    assert high[2] == 1.0


@pytest.mark.parametrize("inputs", [1, 2, 5])
def test_far_quantiles_of_a_steep_output_are_found(inputs):
    """Far out a steep output rises by many of its scales a score, and yet is followed: e^X of X ~ N(0, 3²)."""
    names = [f"x{index}" for index in range(inputs)]
    spread = propagate(
        lambda **values: np.exp(sum(values.values())), {name: Normal(0.0, 3 / np.sqrt(inputs)) for name in names}
    )
    rare = np.array([1e-4, 1e-6, 1e-9])
    np.testing.assert_allclose(np.log(spread.quantile(1 - rare)), -3 * ndtri(rare), rtol=0, atol=1e-6)
    assert np.all(spread.standard_error(1 - rare) <= 1e-6 * spread.quantile(1 - rare))


@pytest.mark.parametrize("seed", range(3))
def test_steep_outputs_beyond_all_lines_keep_their_probability(seed):
    """Where bounded inputs end lines early, a steep output goes on beyond them: e^(z + u + v), u and v uniform."""
    inputs = {"z": Normal(0.0, 0.3), "u": Uniform(-2.0, 2.0), "v": Uniform(-2.0, 2.0)}
    spread = propagate(lambda **each: np.exp(sum(each.values())), inputs, samples=32, seed=seed)
    for sum_ in (5.2, 5.4, 5.6):
        exact = integrate.quad(
            lambda z, sum_=sum_: stats.norm.pdf(z, scale=0.3) * stats.triang.sf(sum_ - z, 0.5, loc=-4, scale=8),
            sum_ - 4,
            sum_,
            epsabs=0,
        )[0]
        low, high = spread.probability_interval(math.exp(sum_))
        assert low < exact < high < 2 * exact
        quantile = spread.quantile(1 - exact)
        assert abs(quantile - math.exp(sum_)) <= 3 * spread.standard_error(1 - exact)


@pytest.mark.parametrize("sd", [1.0, 2.0])
def test_moments_of_a_steep_output_are_told_as_unsure_as_they_are(sd):
    """Of exp of two wide normals, whose fourth power still rises where lines end, no moment is told too surely."""
    row = {"a": Normal(0, sd), "b": Normal(0, sd)}
    moments = moments_of(sound_lines(lambda a, b: np.exp(a + b), row))
    growth = math.exp(2 * sd**2)
    exact = {
        "sd": math.sqrt(growth * (growth - 1)),
        "skewness": (growth + 2) * math.sqrt(growth - 1),
        "kurtosis": growth**4 + 2 * growth**3 + 3 * growth**2 - 6,
    }
    for name, value in exact.items():
        assert abs(getattr(moments, name)[0] - value) <= 1.96 * getattr(moments, f"{name}_error")[0], name
