"""Where lines pass: standard normal scores whose weights sum to 1, as a scrambled net or an evenly spaced row."""

import numpy as np
import pytest
from scipy.special import ndtr
from scipy.stats import kstest

from flexlash.tolerance.engine.line_points import LINE_REPLICATES, line_net, mirrored_net
from flexlash.tolerance.sampling import standard_error

each_kind = pytest.mark.parametrize("single_curved", [False, True])


def means(net, values):
    """Return the weighted mean of each replicate, (replicates,)."""
    return (net.weights * values).reshape(LINE_REPLICATES, -1).sum(axis=1)


@each_kind
@pytest.mark.parametrize("width", [0, 1, 2, 5, 70])
@pytest.mark.parametrize("lines", [8, 64, 128, 1024])
def test_shape_and_weights(width, lines, single_curved):
    """A net has a finite score per coordinate and line, and weights above 0 that sum to 1 in each replicate."""
    net = line_net(0, width, lines, single_curved=single_curved)
    assert net.scores.shape == (width, lines)
    assert net.weights.shape == (lines,)
    assert net.lines == lines
    assert np.isfinite(net.scores).all()
    assert net.weights.min() > 0
    assert means(net, np.ones(lines)) == pytest.approx(np.ones(LINE_REPLICATES), rel=1e-14)


@each_kind
@pytest.mark.parametrize("width", [1, 3])
def test_weighted_scores_are_standard_normal(width, single_curved):
    """Over many seeds each coordinate has mean 0, variance 1 and fourth moment 3, and no two correlate."""
    found = []
    for seed in range(60):
        net = line_net(seed, width, 256, single_curved=single_curved)
        found.append([means(net, row**power).mean() for row in net.scores for power in (1, 2, 3, 4)])
        found[-1] += [means(net, net.scores[0] * row).mean() for row in net.scores[1:]]
    found = np.array(found)
    exact = np.array([0.0, 1.0, 0.0, 3.0] * width + [0.0] * (width - 1))
    assert (np.abs(found.mean(axis=0) - exact) <= 4 * found.std(axis=0, ddof=1) / np.sqrt(60) + 1e-3).all()


@pytest.mark.parametrize(("width", "single_curved"), [(1, False), (1, True), (4, True)])
@pytest.mark.parametrize("lines", [64, 128, 1024])
def test_first_coordinate_is_an_even_row(width, single_curved, lines):
    """A coordinate that is alone, or serves the only bent input, is evenly spaced and weighted by the density."""
    net = line_net(3, width, lines, single_curved=single_curved)
    assert net.spaced == (8 if lines == 64 else 16)
    rows = net.scores[0].reshape(LINE_REPLICATES, net.spaced, -1)
    assert np.array_equal(rows, np.broadcast_to(rows[:, :, :1], rows.shape))
    steps = np.diff(rows[:, :, 0], axis=1)
    assert steps == pytest.approx(steps[0, 0], rel=1e-12)
    density = np.exp(-(net.scores[0] ** 2) / 2)
    assert (net.weights / density).reshape(LINE_REPLICATES, -1).std(axis=1) == pytest.approx(0, abs=1e-12)
    assert net.beyond == pytest.approx(2 * ndtr(-steps[0, 0] * net.spaced / 2), rel=1e-9)


@pytest.mark.parametrize(
    ("width", "lines", "single_curved"), [(0, 64, True), (2, 64, False), (1, 8, True), (3, 32, True)]
)
def test_other_nets_weigh_all_lines_alike(width, lines, single_curved):
    """Where no coordinate is apart, or lines are too few for a row, all lines weigh the same and none is left out."""
    net = line_net(0, width, lines, single_curved=single_curved)
    assert net.spaced == net.beyond == 0
    assert np.array_equal(net.weights, np.full(lines, LINE_REPLICATES / lines))


@pytest.mark.parametrize("lines", [64, 128])
def test_even_row_integrates_smooth_functions_far_better_than_a_net(lines):
    """An even row finds the mean of a cosine to what it leaves out, a net ten times worse."""
    row, plain = line_net(1, 1, lines, single_curved=True), line_net(1, 2, lines, single_curved=False)
    exact = np.exp(-0.5)
    off = np.abs(means(row, np.cos(row.scores[0])) - exact).max()
    assert off <= 4 * row.beyond
    assert off < 0.1 * np.abs(means(plain, np.cos(plain.scores[0])) - exact).max()


def test_replicates_and_seeds_differ():
    """Replicates differ from one another, seeds and numbers of lines from each other, and a seed is repeatable."""
    for single_curved in (False, True):
        net = line_net(0, 2, 64, single_curved=single_curved)
        replicates = net.scores.reshape(2, LINE_REPLICATES, -1)
        assert len({tuple(one.ravel()) for one in replicates.swapaxes(0, 1)}) == LINE_REPLICATES
        line_net.cache_clear()
        assert np.array_equal(line_net(0, 2, 64, single_curved=single_curved).scores, net.scores)
        assert not np.array_equal(line_net(1, 2, 64, single_curved=single_curved).scores, net.scores)
        assert not np.isin(line_net(0, 2, 128, single_curved=single_curved).scores, net.scores).any()


@pytest.mark.parametrize("width", [1, 2, 7])
def test_mirrored_net_cancels_linear_effects(width):
    """Half of the scores mirror the other half, so that every odd effect has the mean 0."""
    scores = mirrored_net(0, width, 64)
    assert scores.shape == (width, 64)
    assert scores.mean(axis=1) == pytest.approx(np.zeros(width), abs=1e-14)
    assert (scores**3).mean(axis=1) == pytest.approx(np.zeros(width), abs=1e-13)
    assert {tuple(point) for point in scores.T} == {tuple(point) for point in -scores.T}
    assert not np.array_equal(mirrored_net(1, width, 64), scores)


@pytest.mark.parametrize("points", [16, 64, 1024])
def test_mirrored_net_has_replicates_of_its_own(points):
    """Each replicate, one after the other, is mirrored in itself and has points that no other has."""
    scores = mirrored_net(0, 2, points).reshape(2, LINE_REPLICATES, -1)
    half = scores.shape[2] // 2
    assert np.array_equal(scores[:, :, :half], -scores[:, :, half:])
    assert len(np.unique(scores[0])) == points


def test_replicates_of_a_mirrored_net_see_interactions_from_different_sides():
    """The mean of a product of two small coordinates is off by no more than its error lets expect, over 400 seeds."""
    off, told = [], []
    for seed in range(400):
        points = ndtr(mirrored_net(seed, 3, 64).reshape(3, LINE_REPLICATES, -1)) - 0.5
        products = (points[1] * points[2]).mean(axis=1)
        off.append(abs(products.mean()))
        told.append(standard_error(products))
    ratio = np.array(off) / told
    assert (ratio <= 1.96).mean() >= 0.9
    assert ratio.max() <= 6


def test_mirrored_net_is_standard_normal():
    """Over many seeds the mirrored scores are those of a standard normal."""
    scores = np.concatenate([mirrored_net(seed, 2, 64).ravel() for seed in range(40)])
    assert kstest(scores, "norm").pvalue > 1e-4
