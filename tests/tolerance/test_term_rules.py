"""Rules for terms of the surrogate: expectations over correlated inputs in closed form, and laws of their sums."""

import math

import numpy as np
import pytest
from grids import for_each
from line_models import row_model
from scipy import integrate, stats

from flexlash.tolerance import Normal, Triangular, TruncatedNormal, Uniform, propagate
from flexlash.tolerance.correlation import CorrelationMatrix, score_factor
from flexlash.tolerance.engine.line_crossings import NODES
from flexlash.tolerance.engine.line_direction import Inputs, direction_of
from flexlash.tolerance.engine.line_statistics import line_statistics
from flexlash.tolerance.engine.line_surrogate import fitted_surrogate
from flexlash.tolerance.engine.surrogate_law import SurrogateLaw
from flexlash.tolerance.engine.term_rules import serves, term_rules
from flexlash.tolerance.sampling import SamplingPlan
from flexlash.tolerance.spread_statistics import SpreadStatistics


def tied(inputs, *entries):
    """Return inputs of one row with these correlations."""
    names = list(inputs)
    matrix = CorrelationMatrix.of(entries, names).scores
    return Inputs.of([inputs], score_factor(matrix, range(len(names))))


@for_each("correlation", [-1.0, -0.8, 0.3, 0.99, 1.0])
def test_waves_of_correlated_normals_in_closed_form(correlation):
    """E e^{i(αa + βb)} of correlated normals is the exponential of half the variance, at all frequencies resolved."""
    inputs = tied({"a": Normal(3, 2), "b": Normal(0, 1)}, ("a", "b", correlation))
    (rule,) = term_rules(inputs, 41)
    scores = 6 * rule.variables[:, 0]
    assert rule.clustered
    for first, second in ((0.5, 0.5), (2.0, -1.0), (4.0, 4.0)):
        found = (rule.weights[0, 0] * np.exp(1j * (first * scores[0] + second * scores[1]))).sum()
        exact = math.exp(-(first**2 + second**2 + 2 * correlation * first * second) / 2)
        assert abs(found - exact) <= 3e-9


@for_each("correlation", [-0.9, 0.5])
def test_products_of_correlated_uniforms_in_closed_form(correlation):
    """Uniforms from −1 to 1 have E[v₁ v₂] = 2/π · asin(ρ/2), and keep their own moments."""
    inputs = tied({"a": Uniform(0, 1), "b": Uniform(0, 4)}, ("a", "b", correlation))
    for nodes in (41, 97):
        (rule,) = term_rules(inputs, nodes)
        first, second = rule.variables[:, 0]
        weight = rule.weights[0, 0]
        assert (weight * first * second).sum() == pytest.approx(2 / math.pi * math.asin(correlation / 2), abs=1e-8)
        assert (weight * first**2).sum() == pytest.approx(1 / 3, abs=1e-8)
        assert (weight * second**4).sum() == pytest.approx(1 / 5, abs=1e-8)


def test_waves_of_correlated_uniforms_as_fast_as_told():
    """The expectation of a wave as fast as the rule resolves is that of a quadrature, to 1e-7."""
    rho = 0.6
    inputs = tied({"a": Uniform(0, 1), "b": Uniform(0, 1)}, ("a", "b", rho))
    (rule,) = term_rules(inputs, 41)
    frequency = float(rule.resolved.min()) / 2
    first, second = rule.variables[:, 0]
    found = (rule.weights[0, 0] * np.cos(frequency * (first + second))).sum()
    step = 0.02
    score = np.arange(-7, 7 + step / 2, step)
    pair = rho * score[:, None] + math.sqrt(1 - rho**2) * score
    wave = np.cos(frequency * (2 * stats.norm.cdf(score)[:, None] - 1 + 2 * stats.norm.cdf(pair) - 1))
    exact = stats.norm.pdf(score) @ wave @ stats.norm.pdf(score) * step * step
    assert found == pytest.approx(exact, abs=1e-7)
    assert frequency > 10


def test_inputs_by_themselves_stay_terms_of_their_own():
    """Inputs outside clusters are terms by themselves, a cluster is one, and every input is in one rule."""
    inputs = tied({"a": Uniform(0, 1), "b": Normal(0, 1), "c": Uniform(0, 1), "d": Uniform(0, 1)}, ("a", "c", 0.5))
    alone, cluster = term_rules(inputs, 41)
    assert (alone.members.tolist(), cluster.members.tolist()) == ([1, 3], [0, 2])
    assert (alone.clustered, cluster.clustered) == (False, True)
    assert term_rules(inputs, 41) is term_rules(inputs, 41)
    coefficients = np.zeros((2, 4, 1))
    coefficients[1] = [[1.0], [2.0], [3.0], [4.0]]
    assert alone.terms(alone.parts(coefficients)).shape == (2, 1, 41)
    terms = cluster.terms(cluster.parts(coefficients))
    assert terms[0, 0] == pytest.approx(cluster.variables[0, 0] + 3 * cluster.variables[1, 0])


def test_waves_of_a_cluster_are_those_of_all_its_members_together():
    """A rule resolves half as many waves of two equal members as of one, and of a far slower member no fewer."""
    inputs = tied({"a": Uniform(0, 1), "b": Uniform(0, 1)}, ("a", "b", 1.0))
    (rule,) = term_rules(inputs, 41)

    def resolved(*slopes):
        coefficients = np.zeros((2, 2, 1))
        coefficients[1] = np.array(slopes)[:, None]
        return float(rule.waves_resolved(rule.parts(coefficients), np.array([1.0]))[0])

    assert resolved(1.0, 1.0) == pytest.approx(resolved(1.0, 0.0) / 2)
    assert resolved(1.0, 0.0) == pytest.approx(float(rule.resolved[0, 0]))
    assert resolved(0.0, 0.0) > 1e100


def test_the_line_through_the_medians_is_one_of_correlated_scores():
    """Model and surrogate are compared on a line along which correlated scores move as they do on all others."""
    inputs = tied({"a": Normal(5, 1), "b": Uniform(0, 1)}, ("a", "b", 0.8))
    model = row_model(lambda a, b: a + b)
    direction = direction_of(model, inputs).vector
    surrogate = fitted_surrogate(model, inputs, direction)
    scores = inputs.correlated(direction)[:, 0]
    assert surrogate.output(surrogate.risen)[:, 0] == pytest.approx(
        5 + scores[0] * NODES + stats.norm.cdf(scores[1] * NODES)
    )
    assert surrogate.output(surrogate.totals)[:, 0] == pytest.approx(surrogate.output(surrogate.risen)[:, 0], abs=5e-3)


@pytest.mark.slow
def test_rows_with_correlated_inputs_keep_their_bits_beside_others():
    """Every number of a row with correlated inputs is the same alone, with others, and in another order."""
    rows = [{"a": Uniform(1, 2 + step), "b": Uniform(3, 3.5), "c": Normal(5, 0.1 + step)} for step in (0.0, 0.5, 1.0)]
    factor = score_factor(CorrelationMatrix.of([("a", "b", 0.6)], ["a", "b", "c"]).scores, [0, 1, 2])
    model = row_model(lambda a, b, c: a * b * c)
    plan = SamplingPlan(method="line", inputs=("a", "b", "c"))
    limit = np.array([np.nan, 45.0, 60.0])
    together = dict(line_statistics(model, Inputs.of(rows, factor), limit, plan))
    assert sorted(together) == [0, 1, 2]
    assert all(isinstance(statistics, SpreadStatistics) for statistics in together.values())
    for order in ([0], [2], [2, 0, 1]):
        chosen = Inputs.of([rows[index] for index in order], factor)
        for place, statistics in line_statistics(model, chosen, limit[order], plan):
            assert statistics == together[order[place]]
    one = propagate(lambda a, b, c: a * b * c, rows[2], correlation={("a", "b"): 0.6})
    error = math.hypot(one.standard_error(0.975), together[2].numbers["p97_5_standard_error"])
    assert abs(one.quantile(0.975) - together[2].numbers["p97_5"]) <= 4 * error


def test_clusters_that_have_no_rule():
    """Clusters of three axes, and those with a kink, have no rule; followers add no axis."""
    three = {"a": Uniform(0, 1), "b": Uniform(0, 1), "c": Uniform(0, 1)}
    assert serves(tied(three, ("a", "b", 0.5)))
    assert serves(tied(three, ("a", "b", 1.0), ("b", "c", 0.5), ("a", "c", 0.5)))
    assert not serves(tied(three, ("a", "b", 0.5), ("b", "c", 0.5)))
    assert not serves(tied({"a": Uniform(0, 1), "b": Triangular(0, 1)}, ("a", "b", 0.5)))
    assert serves(Inputs.of([{"a": Triangular(0, 1), "b": Triangular(0, 1)}]))


@pytest.mark.slow
@for_each("correlation", [-0.7, 0.5, 1.0])
def test_law_of_a_sum_with_a_correlated_pair(correlation):
    """Of a + b + c with a and b tied uniforms and c normal the law is the integral over both scores, as it tells."""
    inputs = tied({"a": Uniform(0, 1), "b": Uniform(0, 1), "c": Normal(0, 0.4)}, ("a", "b", correlation))
    model = row_model(lambda a, b, c: a + b + c)
    surrogate = fitted_surrogate(model, inputs, direction_of(model, inputs).vector)
    law = SurrogateLaw.of(surrogate, inputs)
    side = math.sqrt(1 - correlation**2)
    terms = np.array([[-1.5], [-0.6], [0.0], [1.2]])
    below, _ = law.below(terms)
    score = np.linspace(-8, 8, 801)
    first = stats.norm.cdf(score)[:, None] - 0.5
    second = stats.norm.cdf(correlation * score[:, None] + side * score) - 0.5
    weight = np.outer(stats.norm.pdf(score), stats.norm.pdf(score))
    weight /= weight.sum()
    for term, found in zip(terms[:, 0], below[:, 0], strict=True):
        exact = (weight * stats.norm.cdf((term - first - second) / 0.4)).sum()
        assert abs(found - exact) <= law.residual[0] + 2e-6
    assert law.residual[0] <= 1e-4


def test_moments_of_a_product_with_a_correlated_pair():
    """Moments of exp(a + b) · exp(c) by the rules are the lognormal's, a and b being one term."""
    inputs = tied({"a": Normal(0, 0.1), "b": Normal(0, 0.2), "c": Normal(0, 0.1)}, ("a", "b", 0.5))
    model = row_model(lambda a, b, c: np.exp(a + b) * np.exp(c))
    surrogate = fitted_surrogate(model, inputs, direction_of(model, inputs).vector)
    assert surrogate.logarithmic.all()
    exact = stats.lognorm(math.sqrt(0.01 + 0.04 + 2 * 0.5 * 0.02 + 0.01))
    moments = surrogate.moments(np.array([exact.mean()]))
    assert moments[0][0] == pytest.approx(0, abs=1e-7)
    assert moments[1][0] == pytest.approx(exact.var(), rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("correlation", [-0.6, 0.9])
def test_correlated_bounded_inputs_take_few_lines(correlation):
    """Eight uniforms, two of them tied, are known to 1e-3 standard deviations by at most 512 lines, and rightly."""
    inputs = {f"x{index}": Uniform(-1, 1) for index in range(8)}
    spread = propagate(
        lambda **given: np.exp(sum(0.02 * values for values in given.values())),
        inputs,
        correlation={("x0", "x1"): correlation},
    )
    assert spread.method == "line"
    assert spread.size <= 512
    law = np.random.default_rng(5)
    scores = law.normal(size=(8, 400_000))
    scores[1] = correlation * scores[0] + math.sqrt(1 - correlation**2) * scores[1]
    output = np.exp(0.02 * (2 * stats.norm.cdf(scores) - 1).sum(axis=0))
    for probability in (0.025, 0.5, 0.975):
        error = 2.7 * output.std() / math.sqrt(output.size)
        assert abs(spread.quantile(probability) - np.quantile(output, probability)) <= 4 * error
        assert spread.standard_error(probability) <= 1e-3 * spread.sd


def test_truncated_normals_in_a_pair():
    """A pair of truncated normals has the probability of a plane quadrature, within four told errors."""
    inputs = {"a": TruncatedNormal(0, 1, -2, 2), "b": TruncatedNormal(0, 1, -1, 3), "c": Normal(0, 1)}
    spread = propagate(lambda a, b, c: a + b + c, inputs, correlation={("a", "b"): 0.7})

    def above(score):
        first = float(inputs["a"].standard_at(np.array(score)))
        other = np.linspace(-8, 8, 801)
        second = inputs["b"].standard_at(0.7 * score + math.sqrt(0.51) * other)
        weight = stats.norm.pdf(other) / stats.norm.pdf(other).sum()
        return stats.norm.pdf(score) * (weight * stats.norm.sf(3.5 - first - second)).sum()

    exact = integrate.quad(above, -8, 8, limit=200)[0]
    low, high = spread.probability_interval(3.5, confidence=0.99994)
    assert low <= exact <= high
    assert high - low <= 2e-3
