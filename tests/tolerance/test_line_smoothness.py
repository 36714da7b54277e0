"""Steps between the points of a table are found, and what is only steep is not taken for them."""

import math

import numpy as np
import pytest
from flexsplines import SHAPES
from line_models import lines_of
from scipy import stats

from flexlash.mechanics.flexspline import backlash
from flexlash.tolerance import Normal, Triangular, Uniform, propagate
from flexlash.tolerance.engine.line_direction import Inputs, direction_of
from flexlash.tolerance.engine.line_points import line_net
from flexlash.tolerance.engine.line_tables import FAULTS, Lines

NORMAL = Normal(0, 1)
TWO = {"a": NORMAL, "b": NORMAL}
STEPPED = "the output rises in steps"
BENDS = "the output bends sharply or stays the same over a part of its range"
STEEP = "the output jumps, or rises too steeply for the points looked at"
WIDTHS = [1.0, 0.5, 0.3, 0.2, 0.1, 0.05, 0.03, 0.02, 0.01, 0.005, 0.002, 0.001]


def fault_of(function, inputs):
    """Return why lines do not serve a model."""
    return FAULTS[lines_of(function, inputs, lines=8 if len(inputs) == 1 else 64).faults[0]]


@pytest.mark.parametrize("width", WIDTHS)
def test_steps_are_found_down_to_a_thousandth(width):
    """Steps of an output, of a part of it or of an input alone are found, whatever their width and their height."""
    stepped = {
        "sum": (lambda a, b: np.round((a + b) / width) * width, TWO),
        "single": (lambda a: np.floor(a / width) * width, {"a": NORMAL}),
        "bounded": (lambda a: 5e4 * np.round(a / width) * width, {"a": Uniform(-1, 1)}),
        "one of two": (lambda a, b: np.round(a / width) * width + b, TWO),
        "curved": (lambda a, b: np.round(np.exp(0.3 * (a + b)) / width) * width, TWO),
        "far away": (lambda a, b: 1e6 + np.ceil((a + 0.3 * b) / width) * width, TWO),
    }
    missed = {name: fault for name, one in stepped.items() if (fault := fault_of(*one)) not in {STEPPED, STEEP}}
    assert missed == {}
    assert fault_of(*stepped["sum"]) == fault_of(*stepped["single"]) == STEPPED


@pytest.mark.slow
def test_no_stepped_model_is_taken_for_a_smooth_one():
    """Of 300 sums in steps of 0.001 to 1 standard deviation, of any inputs and weights, lines serve none."""
    draw = np.random.default_rng(11)
    served = []
    for _ in range(300):
        count = int(draw.integers(1, 6))
        weights = draw.uniform(0.2, 1, count) * draw.choice([-1, 1], count)
        inputs = {f"x{place}": NORMAL if draw.random() < 0.6 else Uniform(-1.7, 1.7) for place in range(count)}
        width, offset = 10 ** draw.uniform(-3, 0) * float(np.hypot.reduce(weights)), draw.uniform(0, 1)

        def model(weights=weights, width=width, offset=offset, **varied):
            sums = sum(weight * values for weight, values in zip(weights, varied.values(), strict=True))
            return np.floor((sums + offset) / width) * width

        if propagate(model, inputs, samples=64).method == "line":
            served.append(width)
    assert served == []


@pytest.mark.parametrize("width", [0.1, 0.05, 0.02])
def test_rounded_sums_have_their_own_distribution(width):
    """A rounded sum of two normals has the share above a value, and the sd, of a rounded one: not those of the sum."""
    spread = propagate(lambda a, b: np.round((a + b) / width) * width, TWO)
    assert spread.method == "sobol"
    assert spread.notes == (f"Sobol' points instead of lines: {STEPPED}.",)
    sum_ = stats.norm(0, math.sqrt(2))
    low, high = spread.probability_interval(2.8 + width / 1e8)
    assert low < sum_.sf((round(2.8 / width) + 0.5) * width) < high
    # Sheppard: the rounding adds a twelfth of its squared width.
    assert abs(spread.sd - math.sqrt(2 + width**2 / 12)) <= 3 * spread.sd_standard_error


SMOOTH = {
    "exp 2(a + b)": (lambda s: np.exp(2 * s), TWO),
    "exp 1.5(a + b)": (lambda s: np.exp(1.5 * s), TWO),
    "exp 3a": (lambda s: np.exp(3 * s), {"a": NORMAL}),
    "logistic": (lambda s: 1 / (1 + np.exp(-8 * s)), {"a": NORMAL}),
    "steeper logistic": (lambda s: 1 / (1 + np.exp(-14 * s)), {"a": NORMAL}),
    "cubic": (lambda s: s**3, TWO),
}


@pytest.mark.parametrize("case", SMOOTH)
def test_steep_is_not_stepped(case):
    """Lines serve smooth models however steep: percentiles as of their sum to 1e-9, mean and sd within their errors."""
    shape, inputs = SMOOTH[case]
    spread = propagate(lambda **varied: shape(sum(varied.values())), inputs)
    assert (spread.method, spread.notes) == ("line", ())
    probability = np.array([0.00135, 0.025, 0.3, 0.7, 0.975, 0.99865])
    exact = shape(math.sqrt(len(inputs)) * stats.norm.ppf(probability))
    assert spread.quantile(probability) == pytest.approx(exact, rel=1e-9)
    score = np.linspace(-14, 14, 200_001)
    weight, values = stats.norm.pdf(score) / stats.norm.pdf(score).sum(), shape(math.sqrt(len(inputs)) * score)
    mean = float((weight * values).sum())
    sd = math.sqrt(float((weight * (values - mean) ** 2).sum()))
    assert abs(spread.mean - mean) <= 1.96 * spread.mean_standard_error
    assert abs(spread.sd - sd) <= 1.96 * spread.sd_standard_error


@pytest.mark.parametrize("power", [0.3, 1.0, 1.5, 2.0])
@pytest.mark.parametrize("score", [-3.53, -3.0902, -2.2, -1.13, 1.27, 3.09])
def test_probabilities_above_values_of_steep_models_hold(power, score):
    """The probability above a value of a steep model is good to 1e-5 of itself, within the interval that is told."""
    spread = propagate(lambda a, b: np.exp(power * (a + b)), TWO)
    value, exact = math.exp(power * math.sqrt(2) * score), float(stats.norm.sf(score))
    low, high = spread.probability_interval(value)
    room = 1e-12 * min(exact, 1 - exact)
    assert low - room <= exact <= high + room
    assert abs(spread.probability_above(value) - exact) <= 1e-5 * min(exact, 1 - exact)


@pytest.mark.parametrize(
    ("function", "inputs", "fault"),
    [
        (lambda a: np.maximum(a, 0.3), {"a": NORMAL}, BENDS),
        (lambda a, b: np.minimum(a + b, 1.0), TWO, BENDS),
        (lambda a, b: a + b + (a + b > 0.1), TWO, STEPPED),
        (lambda a, b: np.sign(a + b), TWO, STEPPED),
        (lambda a, b: 1 / (1 + np.exp(-8 * (a + b))), TWO, STEEP),
        (lambda a: 1 / (1 + np.exp(-60 * a)), {"a": NORMAL}, STEEP),
        (lambda a, b: a + b + 0.2 * np.sin(2 * np.pi * (a + b) / np.sqrt(2)), TWO, STEEP),
        (lambda a, b: a + b + 0.4 * np.sin(2 * np.pi * (a + b) / np.sqrt(2)), TWO, FAULTS[3]),
    ],
    ids=["flat below", "flat above", "one jump", "two values", "steep", "steeper", "wave that rises", "wave with dips"],
)
def test_what_is_uneven_is_named(function, inputs, fault):
    """A bend, a jump, a steep rise and dips between the points looked at are told apart."""
    assert fault_of(function, inputs) == fault


def test_steps_are_told_row_by_row():
    """Among smooth rows the stepped one is found, and what is found of a row does not depend on the others."""
    inputs = {"a": Uniform(-1, 1), "b": Triangular(-1, 1)}

    def model(arguments, rows):
        sums = np.broadcast_to(arguments["a"] + arguments["b"], (len(arguments["a"]), len(rows)))
        return np.where(np.isin(rows, [1, 4]), np.round(20 * sums) / 20, sums)

    alike = Inputs.of([inputs] * 6)
    net = line_net(0, 1, 64, single_curved=False)
    together = Lines(model, alike, direction_of(model, alike), net)
    assert [FAULTS[fault] for fault in together.faults] == ["", STEPPED, "", "", STEPPED, ""]


@pytest.mark.slow
def test_no_flexspline_is_taken_for_stepped():
    """Of 600 flexsplines of every shape, with tolerances of all kinds up to ± 12 %, lines serve every one."""
    draw = np.random.default_rng(3)
    found = set()
    for number in range(600):
        kind, base = list(SHAPES.values())[number % len(SHAPES)]
        names = [name for name in base if draw.random() < 0.7] or ["torque"]
        size = draw.choice([0.3, 1.0, 6.0])

        def limits(middle, half, kinds=draw):
            width = abs(middle) * half or 1e-3
            low, high = middle - width, middle + width
            return [Uniform(low, high), Triangular(low, high), Normal(middle, width / 3)][kinds.integers(3)]

        inputs = {name: limits(base[name], size * draw.uniform(0.002, 0.02)) for name in names}
        found.add(fault_of(lambda kind=kind, base=base, **varied: backlash(kind, base | varied), inputs))
    assert found == {""}
