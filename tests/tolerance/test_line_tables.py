"""Lines along which the output only rises: their table, where they pass an output, and when they do not serve."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from line_models import MIXED, NORMALS, curved, linear, lines_of
from scipy.special import ndtr, ndtri

from flexlash.tolerance import Normal, TruncatedNormal, Uniform
from flexlash.tolerance.engine.line_crossings import FAR, NODES
from flexlash.tolerance.engine.line_direction import Inputs, direction_of
from flexlash.tolerance.engine.line_points import LINE_REPLICATES, line_net
from flexlash.tolerance.engine.line_tables import FAULTS, REACH, Lines

thorough = settings(deadline=None, max_examples=40, derandomize=True)


@pytest.mark.parametrize("row", [NORMALS, MIXED], ids=["normal", "mixed"])
@pytest.mark.parametrize("function", [linear, lambda a, b, c: -linear(a, b, c), lambda a, b, c: np.arctan(a + b + c)])
def test_table_rises(row, function):
    """Outputs rise from node to node along every line, whichever way the model turns, and no fault is found."""
    lines = lines_of(function, row)
    assert lines.faults.tolist() == [0]
    assert lines.table.shape == (len(NODES), 64)
    assert (np.diff(lines.table, axis=0) >= 0).all()
    assert lines.table[-1].min() > lines.table[0].max()


def test_outputs_are_the_model_along_the_lines():
    """Of a linear model of normals the output along a line is the median plus place times sd, whichever line."""
    lines = lines_of(linear, NORMALS)
    middle, sd = linear(1, -3, 0), np.sqrt(4**2 + 1.5**2 + 0.5**2)
    places = np.linspace(-3, 3, 7)[:, None]
    assert lines.outputs(places) == pytest.approx(np.broadcast_to(middle + sd * places, (7, 64)), rel=1e-12)
    own = np.linspace(-3, 3, 64)[None]
    assert lines.outputs(own) == pytest.approx(middle + sd * own, rel=1e-12)
    assert lines.scale == pytest.approx([sd], rel=1e-12)


def test_lines_never_leave_the_reach():
    """However far a line goes, the model meets no input beyond ±8.3 scores, and none outside its limits."""
    seen = {name: [] for name in MIXED}

    def watched(a, b, c):
        for name, values in (("a", a), ("b", b), ("c", c)):
            seen[name] += [values.min(), values.max()]
        return a + b + c

    lines = lines_of(watched, MIXED, lines=256)
    lines.outputs(np.full((1, 256), FAR))
    lines.outputs(np.full((1, 256), -FAR))
    assert min(seen["a"]) >= 1 - 2 * REACH - 1e-12
    assert max(seen["a"]) <= 1 + 2 * REACH + 1e-12
    assert min(seen["b"]) >= 0
    assert max(seen["b"]) <= 4
    assert min(seen["c"]) >= -1
    assert max(seen["c"]) <= 1


def test_means_over_lines_weigh_every_line():
    """The mean over lines is the mean of the replicates' means, weighted as the net says, row by row."""
    for row in (MIXED, {"a": Normal(0, 1), "b": Uniform(0, 1), "c": Normal(0, 1)}):
        lines = lines_of(curved, row, row)
        net = line_net(0, 2, 64, single_curved=Inputs.of([row]).single_curved)
        values = np.random.default_rng(1).random((3, 128))
        by_row = values.reshape(3, 2, 64)
        assert lines.mean_over_lines(values) == pytest.approx((by_row * net.weights).sum(axis=2) / LINE_REPLICATES)
        replicates = lines.replicate_means(values)
        assert replicates.shape == (3, 2, LINE_REPLICATES)
        assert replicates.mean(axis=2) == pytest.approx(lines.mean_over_lines(values), rel=1e-14)
        assert replicates[:, :, 0] == pytest.approx((by_row * net.weights)[:, :, : 64 // LINE_REPLICATES].sum(axis=2))
        assert lines.mean_over_lines(np.ones((1, 128))) == pytest.approx(np.ones((1, 2)), rel=1e-14)


def test_each_repeats_a_row_for_its_lines():
    """A value per row is repeated for each line of the row."""
    lines = lines_of(linear, NORMALS, NORMALS, lines=16)
    found = lines.each(np.array([[1.0, 2.0]]))
    assert found.tolist() == [[1.0] * 16 + [2.0] * 16]


def test_what_an_even_row_leaves_out_is_told():
    """A net leaves out nothing, an even row something that grows with how far its ends are from the mean."""
    values = np.arange(64.0)[None]
    assert lines_of(linear, MIXED).left_out(values).tolist() == [[0.0]]
    lines = lines_of(lambda a, b: a + b, {"a": Normal(0, 1), "b": Uniform(0, 1)})
    assert lines.left_out(np.ones((1, 64))) == pytest.approx(np.zeros((1, 1)), abs=1e-15)
    assert 0 < lines.left_out(values)[0, 0] < 0.1
    assert lines.left_out(2 * values) == pytest.approx(2 * lines.left_out(values), rel=1e-12)


@pytest.mark.parametrize(
    ("function", "inverse", "slope"),
    [
        (lambda a: 2 * a + 1, lambda y: (y - 1) / 2, lambda t: 2 + 0 * t),
        (lambda a: -3 * a, lambda y: y / 3, lambda t: 3 + 0 * t),
        (lambda a: np.exp(a / 5), lambda y: 5 * np.log(y), lambda t: np.exp(t / 5) / 5),
        (lambda a: a**3 + 40 * a, None, lambda t: 3 * t * t + 40),
    ],
    ids=["rising", "falling", "exponential", "cubic"],
)
def test_places_invert_known_functions(function, inverse, slope):
    """Where a line passes an output, and how steeply, is the inverse of the function to the table's precision."""
    lines = lines_of(function, {"a": Normal(0, 1)}, lines=8)
    wanted = np.linspace(-7.9, 7.9, 80)[:, None] * np.ones(8)
    outputs = lines.outputs(wanted)
    if inverse:
        assert inverse(outputs) == pytest.approx(wanted, abs=1e-9)
    found, steepness = lines.crossings(outputs)
    assert found == pytest.approx(wanted, abs=1e-4)
    assert steepness == pytest.approx(slope(wanted), rel=5e-3)


def test_places_invert_a_bounded_input():
    """The place at which a line through a uniform input passes a probability is its score."""
    lines = lines_of(lambda a: a, {"a": Uniform(0, 1)}, lines=8)
    wanted = np.linspace(-2, 2, 41)[:, None] * np.ones(8)
    found, slopes = lines.crossings(ndtr(wanted))
    assert found == pytest.approx(wanted, abs=5e-3)
    assert slopes == pytest.approx(np.exp(-wanted * wanted / 2) / np.sqrt(2 * np.pi), rel=0.05)


def test_places_beyond_the_table_are_far():
    """An output that no line reaches is passed at ±8.5, one at a node at the node."""
    lines = lines_of(linear, NORMALS, lines=8)
    below, above = lines.table[0].min() - 1, lines.table[-1].max() + 1
    places, slopes = lines.crossings(np.array([[below], [above]]) * np.ones(8))
    assert (places[0] == -FAR).all()
    assert (places[1] == FAR).all()
    assert (slopes > 0).all()
    assert lines.crossings(lines.table[5:-5])[0] == pytest.approx(NODES[5:-5, None] * np.ones(8), abs=1e-9)


@thorough
@given(power=st.floats(0.3, 3.0), first=st.floats(-7, 7), second=st.floats(-7, 7))
def test_places_rise_with_the_output(power, first, second):
    """A greater output is never passed earlier."""
    lines = lines_of(lambda a, b: np.exp(a * power / 4) + b, {"a": Normal(0, 1), "b": Uniform(0, 1)})
    low, high = sorted([first, second])
    outputs = np.exp(np.array([[low], [high]]) * power / 4) * np.ones(64)
    places, slopes = lines.crossings(outputs)
    assert (places[1] >= places[0] - 1e-9).all()
    assert (slopes > 0).all()


def fault_of(function, row):
    """Return why lines do not serve a row."""
    (fault,) = lines_of(function, row).faults
    return FAULTS[fault]


TWO = {"a": Normal(0, 1), "b": Normal(0, 1)}
NO_GRADIENT, NOT_FINITE, NOT_RISING, STEPS, BENDS, STEEP = FAULTS[1:]


@pytest.mark.parametrize(
    ("function", "fault"),
    [
        (lambda a, b: 0 * a + 0 * b + 5.0, NO_GRADIENT),
        (lambda a, b: a * b, NO_GRADIENT),
        (lambda a, b: (a + b) ** 2, NO_GRADIENT),
        (lambda a, b: np.where(a > 7, np.nan, a + b), NOT_FINITE),
        (lambda a, b: np.where(a + b > 8, np.inf, a + b), NOT_FINITE),
        (lambda a, b: np.where(a < -7, -np.inf, a + b), NOT_FINITE),
        (lambda a, b: np.where(abs(a + 1.75 / np.sqrt(2)) < 0.05, np.nan, a + b), NOT_FINITE),
        (lambda a, b: np.sin(a + b), NOT_RISING),
        (lambda a, b: a + b - 0.01 * (a + b) ** 3, NOT_RISING),
        (lambda a, b: a + b + 2e-2 * np.where(a + b > 4, 4 - a - b, 0) * 100, NOT_RISING),
        (lambda a, b: np.floor(a + b), STEPS),
        (lambda a, b: np.sign(a + b), STEPS),
        (lambda a, b: a + b + 0.2 * np.sin(2 * np.pi * (a + b) / np.sqrt(2)), STEEP),
    ],
)
def test_fault_is_detected(function, fault):
    """Each way in which lines do not serve is found and named."""
    assert fault_of(function, TWO) == fault


@pytest.mark.parametrize(
    ("function", "row"),
    [
        (lambda a, b: a + b, TWO),
        (lambda a, b: 1e6 + a + b, TWO),
        (lambda a, b: 1e9 * (a + b), TWO),
        (lambda a, b: 1e-100 * (a + b), TWO),
        (lambda a, b: (a + b) * (1 + 1e-13 * np.sin(1e6 * a)), TWO),
        (lambda a, b: np.round(a + b, 10), TWO),
        (
            lambda a, b: 1e6 * (1 + 2e-15 * np.sin(1e11 * a)) + 1e-5 * (a + b),
            {"a": Uniform(0, 1), "b": Uniform(0, 1)},
        ),
        (lambda a, b: np.arctan(a + b), TWO),
        (lambda a, b: a + b, {"a": Uniform(0, 1), "b": Uniform(0, 1)}),
        (lambda a, b: 80 + 1e-3 * (a + b), {"a": Uniform(0, 1), "b": TruncatedNormal(0, 1, -3, 3)}),
    ],
)
def test_rounding_and_plateaus_at_rounding_level_are_no_fault(function, row):
    """Lines serve rising models whatever their size or offset; dips of rounding and flat far tails do not matter."""
    assert fault_of(function, row) == ""


def test_faults_are_told_row_by_row():
    """Each row has its own fault, first come first named, and sound rows keep the numbers that they have alone."""
    kinds = [
        lambda a, b: a + 2 * b,
        lambda a, b: 0 * a * b,
        lambda a, b: np.where(a > 7, np.nan, a + b),
        lambda a, b: np.sin(a + b),
        lambda a, b: np.floor(a + b),
        lambda a, b: np.exp(a / 4) + b,
    ]

    def model(arguments, rows):
        values = [np.broadcast_to(kind(**arguments), (len(arguments["a"]), len(rows))) for kind in kinds]
        return np.choose(np.broadcast_to(rows, values[0].shape), values)

    inputs = Inputs.of([TWO] * len(kinds))
    net = line_net(0, 1, 64, single_curved=False)
    together = Lines(model, inputs, direction_of(model, inputs), net)
    assert [FAULTS[fault] for fault in together.faults] == ["", NO_GRADIENT, NOT_FINITE, NOT_RISING, STEPS, ""]
    for row in (0, 5):
        alone = lines_of(kinds[row], TWO)
        assert np.array_equal(together.table[:, 64 * row : 64 * (row + 1)], alone.table)
        assert together.scale[row] == alone.scale[0]


def test_one_bad_line_is_enough():
    """A model that is not finite on a single line only is not served."""
    assert fault_of(lambda a, b: np.where(b - a > 5.5, np.nan, a + b), TWO) == NOT_FINITE
    assert fault_of(lambda a, b: np.where(b - a > 50, np.nan, a + b), TWO) == ""


def test_median_passes_through_the_origin_of_scores():
    """The middle node of a table holds outputs around the median, and their mean is that of the plane across."""
    lines = lines_of(lambda a, b: a + b**2 / 50, TWO, lines=1024)
    middle = lines.table[len(NODES) // 2]
    assert lines.mean_over_lines(middle[None])[0, 0] == pytest.approx(1 / 50, rel=0.05)
    assert NODES[len(NODES) // 2] == 0 == ndtri(0.5)
