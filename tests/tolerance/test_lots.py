"""Lots and parts: how the spread divides, and the share of lots that fail, against closed forms and brute force."""

import math
from dataclasses import fields
from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from line_models import row_model
from scipy import stats
from scipy.integrate import quad
from scipy.optimize import brentq

from flexlash.tolerance import Normal, Triangular, TruncatedNormal, Uniform, propagate
from flexlash.tolerance.engine.entangled_lots import EntangledLots
from flexlash.tolerance.engine.line_direction import Inputs
from flexlash.tolerance.engine.line_lots import LineNumbers, SeparableLots
from flexlash.tolerance.engine.line_tables import FAULTS
from flexlash.tolerance.engine.lot_inputs import PRODUCT, LotsAndParts
from flexlash.tolerance.engine.lot_inputs import SUM as SUM_OF_BOTH
from flexlash.tolerance.engine.lot_statistics import lot_statistics
from flexlash.tolerance.nested_lots import NOT_LINES

thorough = settings(deadline=None, max_examples=25, derandomize=True)

each_method = pytest.mark.parametrize("method", ["line", "sobol", "random"])

PPM = 1350.0
SCORE = float(stats.norm.isf(PPM / 1e6))


def total(a, b, c):
    """Return the sum of a lot input and two part inputs."""
    return a + b + c


SUM = {"a": Normal(0, 2), "b": Normal(0, 1), "c": Normal(0, 0.5)}


def product(a, b):
    """Return the product of two lognormal factors."""
    return np.exp(a) * np.exp(b)


def crossed(a, b, c, d):
    """Return a sum of products, each of a lot input and a part input: neither a sum nor a product of the two."""
    return a * b + c * d


CROSSED = {"a": Normal(10, 1), "b": Normal(5, 0.3), "c": Normal(4, 0.5), "d": Normal(3, 0.2)}


def crossed_failing(limit):
    """Return the share of lots of `CROSSED` that fail: parts are normal in each lot, the rest is one integral."""

    def beyond(a, c):
        return 5 * a + 3 * c + SCORE * math.hypot(0.3 * a, 0.2 * c) - limit

    def part(c):
        return stats.norm.pdf(c, 4, 0.5) * stats.norm.sf(brentq(beyond, 0, 40, args=(c,)), 10, 1)

    return quad(part, 0.5, 7.5, epsabs=1e-13)[0]


def corner(a, e, b, c):
    """Return a lot's sum of two uniform parts, one of a width that is the lot's own."""
    return e + a * b + c


CORNER = {"a": Uniform(0.5, 1.5), "e": Normal(0, 0.2), "b": Uniform(0, 1), "c": Uniform(0, 0.4)}


def corner_failing(limit):
    """Return the share of lots of `CORNER` that fail, by the triangle in which both parts are near their ends."""

    def part(a):
        return stats.norm.sf((limit - a - 0.4 + math.sqrt(2 * a * 0.4 * PPM / 1e6)) / 0.2)

    return quad(part, 0.5, 1.5, epsabs=1e-13)[0]


def weighed_failing(limit):
    """Return the share of lots that fail whose two uniform weights of normal parts lie in a square."""

    def beyond(c, a):
        return a + c + SCORE * math.hypot(a, c) - limit

    def part(a):
        if beyond(2.0, a) <= 0:
            return 0.0
        return (2.0 - brentq(beyond, 0.2, 2.0, args=(a,))) / 1.8**2 if beyond(0.2, a) < 0 else 1 / 1.8

    edge = brentq(lambda a: beyond(2.0, a), 0.2, 2.0)
    return quad(part, edge, 2.0, epsabs=1e-13)[0]


THREE = {name: Uniform(0, 1) for name in ("b", "c", "d")}
"""Parts whose sum S lies over 3 − x with the probability x³/6 for x up to 1."""

TOP = 3 - (6 * PPM / 1e6) ** (1 / 3)


def shifted(e, b, c, d):
    """Return a lot's shift of three uniform parts."""
    return e + b + c + d


def scaled(a, e, b, c, d):
    """Return a lot's scale and shift of three uniform parts."""
    return e + a * (b + c + d)


def scaled_failing(limit):
    """Return the share of lots that fail whose scale is uniform about 1 and whose shift is normal."""
    return quad(lambda a: stats.norm.sf((limit - a * TOP) / 0.1) / 0.1, 0.95, 1.05, epsabs=1e-13)[0]


SPREAD = {
    "shifted": (
        shifted,
        {"e": Normal(0, 0.1), **THREE},
        {"e"},
        2.9,
        stats.norm.sf((2.9 - TOP) / 0.1),
        0.5,
        0.1,
    ),
    "scaled": (
        scaled,
        {"a": Uniform(0.95, 1.05), "e": Normal(0, 0.1), **THREE},
        {"a", "e"},
        2.9,
        scaled_failing(2.9),
        math.sqrt((1 + 0.01 / 12) / 4),
        math.sqrt(0.01 + 2.25 * 0.01 / 12),
    ),
    "sum": (total, SUM, {"a"}, 7.0, stats.norm.sf((7 - SCORE * math.sqrt(1.25)) / 2), math.sqrt(1.25), 2.0),
    "product": (
        product,
        {"a": Normal(0, 0.5), "b": Normal(0, 0.3)},
        {"a"},
        6.0,
        stats.norm.sf((math.log(6) - SCORE * 0.3) / 0.5),
        math.sqrt(math.exp(0.5 + 0.09) * (math.exp(0.09) - 1)),
        math.sqrt(math.exp(0.25 + 0.09) * (math.exp(0.25) - 1)),
    ),
    "crossed": (
        crossed,
        CROSSED,
        {"a", "c"},
        85.0,
        crossed_failing(85.0),
        math.sqrt(0.3**2 * 101 + 0.2**2 * 16.25),
        math.sqrt(25 + 9 * 0.25),
    ),
    "weighed": (
        crossed,
        {"a": Uniform(0.2, 2), "c": Uniform(0.2, 2), "b": Normal(1, 1), "d": Normal(1, 1)},
        {"a", "c"},
        10.0,
        weighed_failing(10.0),
        math.sqrt(2 * (1.1**2 + 1.8**2 / 12)),
        math.sqrt(2 * 1.8**2 / 12),
    ),
    "corner": (
        corner,
        CORNER,
        {"a", "e"},
        2.05,
        corner_failing(2.05),
        math.sqrt((1 + 1 / 12) / 12 + 0.4**2 / 12),
        math.sqrt(1 / 48 + 0.04),
    ),
}
"""Model, inputs, those between lots, limit; exactly: the share of lots that fail, the sds within and between lots."""


@pytest.mark.slow
@each_method
@pytest.mark.parametrize("case", SPREAD)
def test_lots_and_parts_are_those_of_the_closed_form(case, method):
    """The sds within and between lots and the share of lots that fail are right within four standard errors."""
    model, inputs, between, limit, failing, within, among = SPREAD[case]
    spread = propagate(model, inputs, method=method, between=between, seed=3)
    assert abs(spread.within_lot_sd - within) <= 4 * spread.within_lot_sd_standard_error
    assert abs(spread.between_lots_sd - among) <= 4 * spread.between_lots_sd_standard_error
    found, error = spread.lots_failing(limit, PPM), spread.lots_failing_standard_error(limit, PPM)
    assert abs(found - failing) <= 4 * error
    assert math.hypot(spread.within_lot_sd, spread.between_lots_sd) == pytest.approx(spread.sd, rel=1e-12)
    if spread.method == "line":
        assert error <= 0.02 * failing
        assert max(spread.within_lot_sd_standard_error, spread.between_lots_sd_standard_error) <= 1e-3 * spread.sd


@pytest.mark.slow
def test_a_sum_is_known_far_into_the_tail():
    """One lot in two thousand million that fails is found as surely as one in thirty."""
    for limit in (5.0, 9.0, 17.0):
        spread = propagate(total, SUM, between={"a"})
        exact = stats.norm.sf((limit - stats.norm.isf(1e-5) * math.sqrt(1.25)) / 2)
        assert spread.lots_failing(limit, 10) == pytest.approx(exact, rel=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize("case", ["crossed", "weighed", "corner", "shifted", "scaled"])
def test_told_errors_hold_the_truth(case):
    """± 1.96 of the told errors hold the exact share of failing lots, and sds, in at least 115 of 128 seeds."""
    model, inputs, between, limit, *exact = SPREAD[case]
    held = np.zeros(3)
    for seed in range(128):
        spread = propagate(model, inputs, between=between, seed=seed, samples=16)
        found = spread.lots_failing(limit, PPM), spread.within_lot_sd, spread.between_lots_sd
        errors = (
            spread.lots_failing_standard_error(limit, PPM),
            spread.within_lot_sd_standard_error,
            spread.between_lots_sd_standard_error,
        )
        held += [abs(one - truth) <= 1.96 * error for one, truth, error in zip(found, exact, errors, strict=True)]
    # Of 128 intervals of 95 %, 115 and fewer hold in one trial in 600.
    assert held.min() >= 115


@pytest.mark.slow
def test_told_errors_hold_where_few_lots_are_corrected():
    """Few lines through the lots, and many through the parts, tell how far off they are."""
    model, inputs, between, limit, exact, *_ = SPREAD["weighed"]
    split = LotsAndParts(row_model(model), Inputs.of([inputs]), between)
    held = 0
    with np.errstate(all="ignore"):
        for seed in range(128):
            lots = EntangledLots(split, seed, LineNumbers(16, 64))
            failing = lots.failing(np.array([limit]), PPM / 1e6)
            assert failing.lots_error[0] > 3 * failing.parts_error[0]
            held += abs(failing.share[0] - exact) <= 1.96 * failing.error[0]
    assert held >= 115


@pytest.mark.slow
@pytest.mark.parametrize("case", ["shifted", "scaled"])
def test_many_lines_take_their_surrogates(case):
    """Of uniform parts 256 lines with their surrogates know the share of failing lots to half a per cent."""
    model, inputs, between, limit, exact, *_ = SPREAD[case]
    split = LotsAndParts(row_model(model), Inputs.of([inputs]), between)
    statistics = EntangledLots if case == "scaled" else partial(SeparableLots, relation=SUM_OF_BOTH)
    with np.errstate(all="ignore"):
        lots = statistics(split, seed=0, lines=LineNumbers(64, 256))
        failing = lots.failing(np.array([limit]), PPM / 1e6)
    assert failing.error[0] <= 0.005 * exact
    assert abs(failing.share[0] - exact) <= 4 * failing.error[0]


def test_lots_of_a_row_do_not_see_other_rows():
    """A row beside one that takes more rounds of correction has to the last bit the numbers that it has alone."""
    model, wide, between, limit, *_ = SPREAD["weighed"]
    narrow = {**wide, "a": Uniform(1.09, 1.11), "c": Uniform(1.0, 1.2)}
    limits = np.array([limit, 6.95])

    def found(rows, limit):
        split = LotsAndParts(row_model(model), Inputs.of(rows), between)
        statistics = lot_statistics(split, limit, PPM / 1e6, seed=0)
        return np.stack([getattr(statistics, field.name) for field in fields(statistics)])

    together = found([wide, narrow], limits)
    for index, row in enumerate((wide, narrow)):
        assert np.array_equal(found([row], limits[[index]])[:, 0], together[:, index])


def random_case(generator):
    """Return a model, inputs and those between lots, drawn at random: products, sums, powers, bounded and unbounded."""
    weights = generator.uniform(0.2, 2, 4)
    power = generator.choice([0.5, 1.0, 2.0])
    shapes = [
        lambda middle, half: Normal(middle, half / 3),
        lambda middle, half: Uniform(middle - half, middle + half),
        lambda middle, half: Triangular(middle - half, middle + half),
        lambda middle, half: TruncatedNormal(middle, half / 2, middle - half, middle + half),
    ]
    inputs = {
        name: shapes[generator.integers(len(shapes))](1.0, generator.uniform(0.02, 0.3))
        for name in ("a", "b", "c", "d")
    }

    def model(a, b, c, d):
        return weights[0] * a**power * b + weights[1] * b * c + weights[2] * np.sqrt(c * d) + weights[3] * a / d

    between = {str(name) for name in generator.choice(list(inputs), generator.integers(1, 4), replace=False)}
    return model, inputs, between


@pytest.mark.long
@pytest.mark.slow
@thorough
@given(seed=st.integers(0, 10_000))
def test_failing_lots_lie_between_what_the_whole_allows(seed):
    """(P − a)/(1 − a) ≤ share of failing lots ≤ P/a: lots that fail hold at least a of their parts over the limit."""
    generator = np.random.default_rng(seed)
    model, inputs, between = random_case(generator)
    spread = propagate(model, inputs, between=between)
    limit = spread.quantile(generator.uniform(0.5, 0.9999))
    ppm = 10 ** generator.uniform(1, 5.5)
    whole, acceptable = spread.probability_above(limit), ppm / 1e6
    found, slack = spread.lots_failing(limit, ppm), 4 * spread.lots_failing_standard_error(limit, ppm) + 1e-9
    assert (whole - acceptable) / (1 - acceptable) - slack <= found <= whole / acceptable * 1.02 + slack


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_random_models_agree_with_lots_that_were_made(seed):
    """The share of failing lots and the sds are those of 4,000 lots of 4,000 parts each, within what these can tell."""
    generator = np.random.default_rng(seed)
    model, inputs, between = random_case(generator)
    ppm, lots, parts = 50_000, 4_000, 4_000
    spread = propagate(model, inputs, between=between)
    limit = spread.quantile(0.95)
    values = {}
    for name, distribution in inputs.items():
        count = (lots, 1) if name in between else (lots, parts)
        values[name] = distribution.location + distribution.scale * distribution.standard(generator.random(count))
    made = model(**values)
    over = (made > limit).mean(axis=1)
    found, error = spread.lots_failing(limit, ppm), spread.lots_failing_standard_error(limit, ppm)
    # Lots within three errors of a share of 4,000 parts may be on either side.
    doubtful = (np.abs(over - 0.05) < 3 * math.sqrt(0.05 * 0.95 / parts)).mean()
    counted = (over > 0.05).mean()
    noise = math.sqrt(max(counted * (1 - counted), 1 / lots) / lots)
    assert abs(found - counted) <= 4 * math.hypot(error, noise) + doubtful / 2
    assert spread.within_lot_sd == pytest.approx(math.sqrt(made.var(axis=1).mean()), rel=0.05)
    assert spread.between_lots_sd == pytest.approx(made.mean(axis=1).std(), rel=0.06)


@each_method
def test_without_lot_inputs_all_lots_fail_or_none(method):
    """Parts that draw everything make lots alike: the whole sd is within them, and 0 or 1 of them fails."""
    for spread in (propagate(total, SUM, method=method), propagate(total, SUM, method=method, between=())):
        assert spread.within_lot_sd == spread.sd
        assert spread.within_lot_sd_standard_error == spread.sd_standard_error
        assert (spread.between_lots_sd, spread.between_lots_sd_standard_error) == (0.0, 0.0)
        for limit in (2.0, 5.0, 9.0):
            assert spread.lots_failing(limit, 1e4) == float(spread.probability_above(limit) > 0.01)
            assert spread.lots_failing_standard_error(limit, 1e4) < 1e-6
        near = float(spread.quantile(0.99)) * (1 + 1e-12)
        assert spread.lots_failing_standard_error(near, 1e4) == pytest.approx(0.5, abs=0.1) or method == "line"


@each_method
def test_without_part_inputs_lots_fail_as_parts_do(method):
    """A lot whose parts are alike fails where they lie over the limit, whatever share is acceptable."""
    spread = propagate(total, SUM, method=method, between=set(SUM))
    assert (spread.within_lot_sd, spread.between_lots_sd) == (0.0, spread.sd)
    for ppm in (0, 1350, 999_999):
        assert spread.lots_failing(3.0, ppm) == spread.probability_above(3.0)
        assert spread.lots_failing_standard_error(3.0, ppm) <= 0.02
    assert spread.lots_failing(3.0, 1e6) == 0.0


@pytest.mark.parametrize("between", [{"a"}, {"b"}])
def test_inputs_without_effect_scatter_nothing(between):
    """Where the lot inputs or the part inputs have no effect the other ones do everything."""
    spread = propagate(lambda a, b: a + 0 * b, {"a": Normal(0, 1), "b": Normal(0, 1)}, between=between)
    kept = spread.between_lots_sd if between == {"a"} else spread.within_lot_sd
    assert kept == spread.sd
    assert min(spread.between_lots_sd, spread.within_lot_sd) == 0.0
    exact = stats.norm.sf(2.5) if between == {"a"} else 1.0
    assert spread.lots_failing(2.5, PPM) == pytest.approx(exact, rel=1e-6)


@each_method
def test_limits_out_of_reach_fail_all_lots_or_none(method):
    """A limit far below every part fails all lots, one far above none; a million parts in a million are never more."""
    spread = propagate(crossed, CROSSED, method=method, between={"a", "c"})
    assert spread.lots_failing(-1000.0, PPM) == 1.0
    assert spread.lots_failing(1000.0, PPM) == 0.0
    assert spread.lots_failing(-1000.0, 1e6) == 0.0


def test_a_factor_may_change_its_sign():
    """A product whose lot factor is negative once in three million lots is told as surely as another one."""
    spread = propagate(lambda a, b: a * b, {"a": Normal(10, 2), "b": Normal(5, 0.1)}, between={"a"})
    assert spread.notes == ()
    exact = stats.norm.sf((80 / (5 + 0.1 * SCORE) - 10) / 2)
    assert spread.lots_failing(80.0, PPM) == pytest.approx(exact, rel=1e-4)
    for sd, fault in ((1.0, ""), (3.0, "the output does not rise everywhere along its gradient at the median")):
        split = LotsAndParts(
            row_model(lambda a, b: a * b), Inputs.of([{"a": Normal(10, sd), "b": Normal(5, 0.1)}]), "a"
        )
        assert FAULTS[SeparableLots(split, PRODUCT, 0, LineNumbers(64, 64)).faults[0]] == fault


@pytest.mark.slow
@pytest.mark.parametrize("method", ["sobol", "random"])
def test_points_of_a_factor_that_changes_its_sign_are_nested(method):
    """In a lot with a negative factor the greatest outputs are those of the least parts."""
    inputs = {"a": Normal(-1, 1), "b": TruncatedNormal(5, 1, 1, 9)}
    spread = propagate(lambda a, b: a * b, inputs, method=method, between={"a"})
    parts = stats.truncnorm(-4, 4, 5, 1)
    for limit, quantile in ((-4.0, parts.ppf(0.2)), (4.0, parts.ppf(0.8))):
        exact = stats.norm.sf(limit / quantile + 1)
        assert abs(spread.lots_failing(limit, 2e5) - exact) <= 4 * spread.lots_failing_standard_error(limit, 2e5)


def test_fewer_lots_fail_where_more_is_acceptable():
    """The share of failing lots falls as the acceptable share or the limit rises."""
    spread = propagate(crossed, CROSSED, between={"a", "c"})
    shares = [spread.lots_failing(70.0, ppm) for ppm in (0, 1, 100, 1e4, 3e5)]
    assert shares == sorted(shares, reverse=True)
    assert [spread.lots_failing(limit, 100) for limit in (60.0, 75.0, 90.0)] == sorted(
        (spread.lots_failing(limit, 100) for limit in (60.0, 75.0, 90.0)), reverse=True
    )


@pytest.mark.slow
def test_points_answer_where_lines_do_not_serve():
    """Lots drawn at points answer for a wave, and for lot inputs without a gradient, as many lots made by hand do."""

    def late(a, b):
        return b + np.maximum(a - 2.0, 0.0) ** 2

    inputs = {"a": Normal(0, 1), "b": Normal(0, 0.2)}
    spread = propagate(late, inputs, between={"a"})
    assert spread.method == "line"
    assert spread.notes[-1] == f"{NOT_LINES}: the output has no gradient at the median."
    exact = stats.norm.sf(2 + math.sqrt(1.0 - SCORE * 0.2))
    assert abs(spread.lots_failing(1.0, PPM) - exact) <= 4 * spread.lots_failing_standard_error(1.0, PPM)
    assert spread.within_lot_sd == pytest.approx(0.2, rel=0.02)

    hidden = propagate(lambda a, b: 3 * b + 0.3 * np.sin(6 * a), {"a": Normal(0, 1), "b": Normal(0, 1)}, between={"a"})
    assert hidden.method == "line"
    assert hidden.notes == (f"{NOT_LINES}: the output does not rise everywhere along its gradient at the median.",)
    found, error = (ask(3 * SCORE + 0.2, PPM) for ask in (hidden.lots_failing, hidden.lots_failing_standard_error))
    assert abs(found - (math.pi - 2 * math.asin(2 / 3)) / (2 * math.pi)) <= 4 * error
    assert abs(hidden.between_lots_sd - 0.3 / math.sqrt(2)) <= 4 * hidden.between_lots_sd_standard_error

    wave = propagate(lambda a, b: np.sin(a) + b, {"a": Uniform(-3, 3), "b": Normal(0, 0.1)}, between={"a"})
    assert wave.method == "sobol"
    exact = (math.pi - 2 * math.asin(0.5)) / 6
    assert abs(wave.lots_failing(0.5 + SCORE * 0.1, PPM) - exact) <= 4 * wave.lots_failing_standard_error(0.8, PPM)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["sobol", "random"])
def test_points_answer_within_lots_where_lines_do_not_serve(method):
    """Where the output waves with the part inputs the parts of a lot are points too."""
    inner = np.sort(np.sin(5 * np.linspace(-3, 3, 2_000_001)))
    quantile = inner[int(0.9 * len(inner))]
    # Lots that hardly differ are as unsure as their parts are few.
    for seed, sd in ((0, 1.0), (0, 0.005), (1, 0.005), (2, 0.005), (3, 0.005)):
        inputs = {"a": Normal(0, sd), "b": Uniform(-3, 3)}
        spread = propagate(lambda a, b: a + np.sin(5 * b), inputs, method=method, between={"a"}, seed=seed)
        limit = quantile + 0.5 * sd
        assert abs(spread.lots_failing(limit, 1e5) - stats.norm.sf(0.5)) <= 4 * spread.lots_failing_standard_error(
            limit, 1e5
        )


@pytest.mark.parametrize(
    ("between", "error", "said"),
    [
        ({"a", "d"}, ValueError, "a name of between = 'd': one of a, b, c is required"),
        (["aa"], ValueError, "a name of between = 'aa'"),
        ("a", TypeError, "between = 'a': a collection of names of inputs is required"),
        (5, TypeError, "between = 5: a collection of names of inputs is required"),
        ([1], TypeError, "a name of between = 1"),
    ],
)
def test_names_between_lots_are_inputs(between, error, said):
    """What is between lots are names of inputs in a collection; another one is refused by name."""
    with pytest.raises(error, match=said):
        propagate(total, SUM, between=between)


@pytest.mark.parametrize("name", ["lots_failing", "lots_failing_standard_error"])
def test_limit_and_ppm_are_numbers(name):
    """A limit is a finite number, ppm one between 0 and a million; others are refused by name."""
    ask = getattr(propagate(total, SUM, between={"a"}), name)
    for limit, ppm, error, said in (
        ("3", 10, TypeError, "limit = '3'"),
        (math.nan, 10, ValueError, "limit = nan"),
        (3, -1, ValueError, "ppm = -1"),
        (3, 1.1e6, ValueError, "ppm = 1100000"),
        (3, "many", TypeError, "ppm = 'many'"),
    ):
        with pytest.raises(error, match=said):
            ask(limit, ppm)


@each_method
def test_lots_leave_the_rest_alone(method):
    """The spread of all parts together is to the last bit that without lots."""
    with_lots = propagate(crossed, CROSSED, method=method, between={"a", "c"})
    without = propagate(crossed, CROSSED, method=method)
    with_lots.lots_failing(80.0, PPM)
    assert (with_lots.mean, with_lots.sd, with_lots.notes) == (without.mean, without.sd, without.notes)
    assert np.array_equal(with_lots.quantile([0.01, 0.5, 0.99]), without.quantile([0.01, 0.5, 0.99]))
