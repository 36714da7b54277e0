"""The spread of values at points: type-7 quantiles, counted shares, and standard errors of each kind of point."""

import math

import numpy as np
import pytest
from scipy import stats

from flexlash.tolerance import Normal, Uniform, propagate
from flexlash.tolerance.capability import clopper_pearson
from flexlash.tolerance.sampled_spread import SampledSpread
from flexlash.tolerance.sampling import REPLICATES, UnitPoints, standard_error

each_method = pytest.mark.parametrize("method", ["sobol", "random"])

INPUTS = {"a": Normal(mean=1, sd=3), "b": Uniform(low=0, high=4)}


def spread_of(model, inputs, *, method="sobol", samples=4096, seed=0, notes=()):
    """Return the spread of a model at points of its own."""
    points = UnitPoints(list(inputs), method=method, samples=samples, seed=seed)
    return SampledSpread(model=model, inputs=inputs, points=points, notes=notes)


def total(a, b):
    """Return the sum of two inputs."""
    return a + b


@each_method
def test_spread_says_what_it_is(method):
    """A spread has the method and size of its points, and the notes it was given."""
    spread = spread_of(total, INPUTS, method=method, samples=100, notes=("why",))
    assert (spread.method, spread.notes, spread.size) == (method, ("why",), 128)
    assert spread.values.shape == (REPLICATES, 8)


@each_method
def test_quantiles_do_not_depend_on_what_was_asked_before(method):
    """Quantiles and shares are those of all values sorted, in whichever order and company they are asked for."""
    spread = spread_of(total, INPUTS, method=method)
    every = spread.values.copy().ravel()
    generator = np.random.default_rng(3)
    for _ in range(20):
        wanted = generator.random(generator.integers(1, 5))
        assert spread.quantile(wanted) == pytest.approx(np.quantile(every, wanted), rel=1e-13)
        value = float(generator.choice(every))
        assert spread.probability_above(value) == pytest.approx((every > value).mean(), abs=1e-15)
        assert spread.standard_error(wanted).shape == wanted.shape
    assert np.array_equal(spread.values.ravel(), every)


@each_method
def test_quantile_errors_are_told_together_or_alone(method):
    """The standard error of a quantile is the same alone and among others."""
    spread = spread_of(total, INPUTS, method=method)
    wanted = np.array([0.00135, 0.3, 0.5, 0.99865])
    together = spread.standard_error(wanted)
    assert together.tolist() == [spread.standard_error(float(one)) for one in wanted]
    assert (together > 0).all()


def test_random_quantiles_have_the_textbook_standard_error():
    """Of plain Monte Carlo of a normal the median errs by 1.253 s/√M and the 97.5 % quantile by 2.671 s/√M."""
    spreads = [spread_of(lambda a: a, {"a": Normal(0, 1)}, method="random", seed=seed) for seed in range(40)]
    for probability, factor in ((0.5, 1.253), (0.95, 2.113), (0.975, 2.671)):
        stated = np.mean([spread.standard_error(probability) for spread in spreads]) * math.sqrt(4096)
        assert stated == pytest.approx(factor, rel=0.15)


@pytest.mark.parametrize("probability", [1e-5, 1e-7, 1 - 1e-7])
def test_quantiles_beyond_the_points_have_large_errors(probability):
    """A quantile rarer than one point in all is known no better than its distance from the last point."""
    spread = spread_of(lambda a: a, {"a": Normal(0, 1)}, samples=1024)
    off = abs(spread.quantile(probability) - stats.norm.ppf(probability))
    assert off <= 4 * spread.standard_error(probability)


@each_method
def test_skewness_and_its_error(method):
    """The skewness of a lognormal agrees within four standard errors, and is that of the values."""
    spread = spread_of(lambda a: np.exp(a / 4), {"a": Normal(0, 1)}, method=method, samples=2**15)
    exact = float(stats.lognorm(0.25).stats("s"))
    assert 0 < spread.skewness_standard_error < 0.2
    assert abs(spread.skewness - exact) <= 4 * spread.skewness_standard_error
    assert spread.skewness == pytest.approx(float(stats.skew(spread.values.ravel())), rel=1e-9)


@pytest.mark.slow
@each_method
def test_kurtosis_and_its_error(method):
    """The kurtosis is that of the values, and of 200 seeds at least 180 hold the exact one within 1.96 errors."""
    inputs, exact = {"a": Normal(0, 1), "b": Uniform(-2, 2)}, -1.2 * (16 / 12) ** 2 / (1 + 16 / 12) ** 2
    held, seeds = 0, 200
    for seed in range(seeds):
        spread = spread_of(total, inputs, method=method, samples=2048, seed=seed)
        held += abs(spread.kurtosis - exact) <= 1.96 * spread.kurtosis_standard_error
    assert spread.kurtosis == pytest.approx(float(stats.kurtosis(spread.values.ravel())), rel=1e-9)
    assert held >= 0.9 * seeds
    assert spread.kurtosis_standard_error < 0.15


def test_a_constant_has_no_kurtosis():
    """A model that does not vary has kurtosis 0, known exactly: not the −3 of no fourth moment."""
    for method in ("line", "sobol", "random"):
        spread = propagate(lambda a: 0 * a + 0.3, {"a": Normal(0, 1)}, method=method)
        assert (spread.kurtosis, spread.kurtosis_standard_error) == (0.0, 0.0)


LEVELS = np.array([0.01, 0.025, 0.25, 0.3085, 0.5, stats.norm.cdf(0.5), 0.75, 0.975, 0.99])
NORMALS, UNIFORMS = {"a": Normal(0, 1), "b": Normal(0, 1)}, {"a": Uniform(0, 1), "b": Uniform(0, 1)}
LOWER = stats.norm.cdf(0.5)
KINDS = {
    "smooth": (total, NORMALS, math.sqrt(2) * stats.norm.ppf(LEVELS)),
    "a gap at the median": (lambda a, b: a + 10 * (b > 0.5), UNIFORMS, 2 * LEVELS + 9 * (LEVELS > 0.5)),
    "a gap elsewhere": (
        lambda a, b: a + 10 * (b > 0.5),
        {"a": Uniform(0, 1), "b": Normal(0, 1)},
        np.where(LEVELS <= LOWER, LEVELS / LOWER, 10 + (LEVELS - LOWER) / (1 - LOWER)),
    ),
    "steps": (lambda a, b: np.round(a + b, 1), NORMALS, np.round(math.sqrt(2) * stats.norm.ppf(LEVELS), 1)),
    "two values": (lambda a, b: 1.0 * (a > 0.5) + 0 * b, UNIFORMS, 1.0 * (LEVELS > 0.5)),
    "two values of a sum": (lambda a, b: 1.0 * (a + b > 0), NORMALS, 1.0 * (LEVELS > 0.5)),
    "three values": (lambda a, b: 1.0 * (a > 0.25) + (b > 0.75), UNIFORMS, None),
}


@pytest.mark.slow
@each_method
@pytest.mark.parametrize("kind", KINDS)
def test_quantile_errors_cover_at_gaps_and_steps(kind, method):
    """Of 200 seeds 95 % hold each percentile within 1.96 errors, be the output smooth, with gaps, or of few values."""
    model, inputs, exact = KINDS[kind]
    if exact is None:
        exact = np.searchsorted([0.25 * 0.75, 0.25 * 0.75 + 0.75 * 0.75 + 0.25 * 0.25], LEVELS).astype(float)
    held = np.zeros(len(LEVELS))
    for seed in range(200):
        spread = spread_of(model, inputs, method=method, samples=4096, seed=seed)
        held += np.abs(spread.quantile(LEVELS) - exact) <= 1.96 * spread.standard_error(LEVELS)
    assert held.mean() >= 0.945 * 200
    # 171 of 200 fail by chance once in 10⁶ where 95 % hold.
    assert held.min() >= 172


@pytest.mark.slow
def test_errors_cover_where_a_step_is_wider_than_they_are():
    """Far out, where steps are rare and points are many, an interval still reaches the next step in 190 of 200."""
    model, inputs, _ = KINDS["steps"]
    held = 0
    for seed in range(200):
        spread = spread_of(model, inputs, samples=2**14, seed=seed)
        exact = np.round(math.sqrt(2) * stats.norm.ppf([0.00135, 0.99865]), 1)
        errors = spread.standard_error([0.00135, 0.99865])
        held += bool((np.abs(spread.quantile([0.00135, 0.99865]) - exact) <= 1.96 * errors).all())
    assert held >= 190


@each_method
def test_a_median_on_a_gap_is_told_as_wide_as_the_gap(method):
    """Where half of the values lie on either side of a gap, the median's interval spans it; elsewhere it is narrow."""
    spread = spread_of(*KINDS["a gap at the median"][:2], method=method)
    assert 4.5 / 1.96 <= spread.standard_error(0.5) <= 10 / 1.96
    assert spread.standard_error(0.25) < 0.02
    assert spread.standard_error(0.75) < 0.02


SHARES = np.array([0.5, 0.1, 0.025, 0.01, 0.00135, 1e-4])
INTERVALS = {
    "one input": (lambda a: a, {"a": Normal(0, 1)}, stats.norm.isf(SHARES)),
    "a sum": (total, NORMALS, math.sqrt(2) * stats.norm.isf(SHARES)),
    "the greater": (lambda a, b: np.where(a > b, a, b), UNIFORMS, np.sqrt(1 - SHARES)),
    "squares": (lambda a, b: a * a + b * b, NORMALS, -2 * np.log(SHARES)),
}


@pytest.mark.slow
@each_method
@pytest.mark.parametrize(("kind", "samples"), [("one input", 2**15), *((kind, 4096) for kind in INTERVALS)])
def test_the_interval_of_a_share_covers(kind, samples, method):
    """Of 200 seeds 95 % hold the share above a value, be it half or one in ten thousand; narrower by Sobol' points."""
    model, inputs, values = INTERVALS[kind]
    held, widths = np.zeros(len(SHARES)), np.zeros(len(SHARES))
    for seed in range(200):
        spread = spread_of(model, inputs, method=method, samples=samples, seed=seed)
        low, high = np.transpose([spread.probability_interval(value) for value in values])
        held += (low <= SHARES) & (high >= SHARES)
        widths += (high - low) / 200
    assert held.mean() >= 0.945 * 200
    assert held.min() >= 172
    plain = 2 * 1.96 * np.sqrt(SHARES * (1 - SHARES) / samples)
    if method == "sobol":
        assert (widths[:3] <= 0.7 * plain[:3]).all()
    assert (widths[:5] <= 1.5 * plain[:5]).all()


def test_the_interval_of_a_share_widens_with_confidence():
    """A surer interval holds the less sure one, also beyond 95 %, where Student's is wider still."""
    spread = spread_of(total, NORMALS)
    ends = [spread.probability_interval(2.0, confidence) for confidence in (0.5, 0.683, 0.95, 0.99, 0.999)]
    lows, highs = zip(*ends, strict=True)
    assert lows == tuple(sorted(lows, reverse=True))
    assert highs == tuple(sorted(highs))
    # Student's factor of 15 degrees of freedom at 99 % over the normal one at 95 %.
    assert (highs[3] - lows[3]) / (highs[2] - lows[2]) == pytest.approx(2.947 / 2.131, rel=0.02)


def test_shares_that_no_replicate_disputes_are_not_taken_for_certain():
    """Where each replicate counts as many points above a value, a few points stay open; none or all, as counted."""
    spread = spread_of(lambda a: a, {"a": Uniform(0, 1)})
    assert np.unique((spread.values > 0.5).mean(axis=1)).tolist() == [0.5]
    low, high = spread.probability_interval(0.5)
    assert (high - low) / 2 == pytest.approx(3 / 4096, rel=0.05)
    second, last = np.sort(spread.values, axis=None)[-2:]
    assert spread.probability_interval((second + last) / 2) == pytest.approx(clopper_pearson(1, 4096), rel=1e-12)
    assert spread.probability_interval(2.0) == clopper_pearson(0, 4096)
    assert spread.probability_interval(-1.0) == clopper_pearson(4096, 4096)


@each_method
def test_large_offsets_keep_the_spread(method):
    """A constant a billion times the spread costs the standard deviation no more than its rounding."""
    near = spread_of(total, INPUTS, method=method)
    far = spread_of(lambda a, b: 1e9 + a + b, INPUTS, method=method)
    assert far.sd == pytest.approx(near.sd, rel=1e-6)
    assert far.mean - 1e9 == pytest.approx(near.mean, abs=1e-6)


def test_standard_error_is_students():
    """The standard error of replicates is s/√n, widened so that ± 1.96 of it is Student's 95 % interval."""
    replicates = np.array([[1.0, 2.0, 4.0, 7.0], [3.0, 3.0, 3.0, 3.0]])
    found = standard_error(replicates)
    plain = replicates.std(axis=1, ddof=1) / 2
    assert found == pytest.approx(plain * stats.t(3).ppf(0.975) / stats.norm.ppf(0.975), rel=1e-12)
    assert found[1] == 0


@pytest.mark.parametrize("count", [8, 16])
def test_standard_error_covers(count):
    """Of normal replicates 95 of 100 means lie within 1.96 standard errors of the truth."""
    replicates = np.random.default_rng(count).standard_normal((20_000, count))
    held = np.abs(replicates.mean(axis=1)) <= 1.96 * standard_error(replicates)
    assert held.mean() == pytest.approx(0.95, abs=0.008)


def test_a_model_of_another_shape_or_without_a_number_is_refused():
    """A model that loses its shape, or is not finite once, is refused in a sentence."""
    with pytest.raises(ValueError, match=r"^the model returned shape \(\), not that of its inputs$"):
        spread_of(lambda a, b: (a + b).mean(), INPUTS)
    with pytest.raises(ValueError, match=r"^the model returned a number that is not finite"):
        spread_of(lambda a, b: np.where(b > 3.99, np.nan, a), INPUTS)


def test_total_shares_count_interaction():
    """Total shares of a product of centred inputs are 1 each, its shares 0."""
    spread = spread_of(lambda a, b: a * b, {"a": Normal(0, 1), "b": Uniform(-1, 1)}, samples=2**15)
    assert spread.total_shares == pytest.approx({"a": 1.0, "b": 1.0}, abs=0.03)
    assert spread.shares == pytest.approx({"a": 0.0, "b": 0.0}, abs=0.03)
    alone = spread_of(lambda a: a, {"a": Normal(0, 1)})
    assert alone.shares == alone.total_shares == {"a": 1.0}
