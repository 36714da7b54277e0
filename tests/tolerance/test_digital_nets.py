"""Scrambled Sobol' nets: scipy's base net, even in every coordinate, unbiased, and better than independent points."""

import numpy as np
import pytest
from scipy.special import ndtri
from scipy.stats import kstest, qmc

from flexlash.tolerance.digital_nets import COORDINATES, _strata, scrambled_net

COUNT = 64


def net_of(width, replicates, count, seed=0):
    """Return a scrambled net of a seed."""
    return scrambled_net(width, replicates, count, np.random.default_rng(seed))


def smooth(points):
    """Return a smooth function (replicates, count) of points whose mean over the unit cube is 1."""
    values = np.ones(points.shape[1:])
    for place, coordinate in enumerate(points):
        values = values * (1 + np.sin(2 * np.pi * coordinate + place) / (place + 2))
    return values


@pytest.mark.parametrize("count", [1, 2, 8, 64, 1024])
def test_base_net_is_scipys(count):
    """Unscrambled, the points are those of scipy's Sobol' sequence in all 64 coordinates at once."""
    reference = qmc.Sobol(COORDINATES, scramble=False).random(count)
    own = _strata(count).T / count
    assert COORDINATES == 64
    assert {tuple(point) for point in own} == {tuple(point) for point in reference}
    assert len(own) == count


@pytest.mark.parametrize("count", [1, 2, 16, 256])
def test_every_coordinate_is_stratified(count):
    """Each replicate has one point in each 1/count of every coordinate with direction numbers."""
    places = np.sort(np.floor(net_of(COORDINATES, 3, count) * count), axis=2)
    assert np.array_equal(places, np.broadcast_to(np.arange(count), places.shape))


@pytest.mark.parametrize("bits", [4, 6])
def test_pairs_of_early_coordinates_fill_every_rectangle(bits):
    """Scrambling keeps the net: each 2^-a by 2^-b rectangle of the first pair holds its share of points."""
    first, second = net_of(2, 5, 1 << bits, seed=2)
    for wide in range(bits + 1):
        cells = np.floor(first * (1 << wide)) * (1 << (bits - wide)) + np.floor(second * (1 << (bits - wide)))
        assert np.array_equal(np.sort(cells, axis=1), np.tile(np.arange(1 << bits), (5, 1)))


def test_points_lie_inside_the_cube():
    """No point touches a face of the cube, so that no score is infinite."""
    points = net_of(COORDINATES + 2, 4, 256)
    assert points.shape == (COORDINATES + 2, 4, 256)
    assert points.min() >= 2.0**-53
    assert points.max() <= 1 - 2.0**-53
    assert np.isfinite(ndtri(points)).all()


def test_same_generator_same_points():
    """The same seed gives the same points bit for bit, another seed other points."""
    assert np.array_equal(net_of(3, 2, 32, seed=1), net_of(3, 2, 32, seed=1))
    assert not np.array_equal(net_of(3, 2, 32, seed=1), net_of(3, 2, 32, seed=2))


def test_no_coordinates_have_no_points():
    """A net of no coordinates is empty but keeps its replicates and points."""
    assert net_of(0, 8, 16).shape == (0, 8, 16)


def test_replicates_are_scrambled_apart():
    """Errors of replicates do not correlate, and the mean of eight errs by 1/√8 of one."""
    errors = np.array([smooth(net_of(3, 8, 32, seed)).mean(axis=1) - 1 for seed in range(300)])
    correlation = np.corrcoef(errors.T) - np.eye(8)
    assert np.abs(correlation).max() < 5 / np.sqrt(300)
    assert errors.mean(axis=1).std() / errors.std() == pytest.approx(1 / np.sqrt(8), rel=0.2)


def test_coordinates_are_scrambled_apart():
    """The places of one point in different coordinates do not correlate from one scrambling to the next."""
    points = np.array([net_of(6, 1, 8, seed)[:, 0, 3] for seed in range(1000)])
    correlation = np.corrcoef(points.T) - np.eye(6)
    assert np.abs(correlation).max() < 5 / np.sqrt(1000)


@pytest.mark.parametrize("place", [0, 1, 31])
def test_every_point_is_uniform(place):
    """Scrambling makes every single point uniform over the cube, the first one too."""
    points = np.array([net_of(2, 4, 32, seed)[:, :, place].ravel() for seed in range(250)]).ravel()
    assert kstest(points, "uniform").pvalue > 1e-4


def test_means_are_unbiased():
    """The mean of a smooth function errs around 0: within four of its own standard errors over 400 nets."""
    means = np.array([smooth(net_of(5, 4, 16, seed)).mean() for seed in range(400)])
    assert abs(means.mean() - 1) <= 4 * means.std(ddof=1) / np.sqrt(400)


def test_error_of_a_smooth_integral_falls_faster_than_one_over_n():
    """The error of a smooth integral falls steeper than N^-1.2, that of independent points as N^-0.5."""
    counts = np.array([16, 64, 256, 1024])
    scatter = [(smooth(net_of(3, 100, int(count))).mean(axis=1) - 1).std() for count in counts]
    generator = np.random.default_rng(0)
    drawn = [(smooth(generator.random((3, 100, int(count)))).mean(axis=1) - 1).std() for count in counts]
    slope, own = (np.polyfit(np.log(counts), np.log(errors), 1)[0] for errors in (scatter, drawn))
    assert slope < -1.2
    assert own == pytest.approx(-0.5, abs=0.12)


def test_coordinates_beyond_the_direction_numbers_are_independent_points():
    """Beyond 64 coordinates points are independent and uniform, and the first 64 stay stratified."""
    points = net_of(COORDINATES + 6, 8, COUNT)
    strata = np.floor(points * COUNT)
    single = np.array([[len(set(replicate)) == COUNT for replicate in coordinate] for coordinate in strata])
    assert single[:COORDINATES].all()
    assert not single[COORDINATES:].any()
    beyond = points[COORDINATES:].reshape(6, -1)
    assert kstest(beyond.ravel(), "uniform").pvalue > 1e-4
    correlation = np.corrcoef(beyond) - np.eye(6)
    assert np.abs(correlation).max() < 5 / np.sqrt(beyond.shape[1])


def test_later_coordinates_leave_the_others_alone():
    """Coordinates that are drawn later are part of one net with the others, which have the same points without them."""
    alone = scrambled_net(3, 2, 64, np.random.default_rng(5))
    points = scrambled_net(3, 2, 64, np.random.default_rng(5), later=2)
    assert np.array_equal(points[:3], alone)
    for pair in ((0, 3), (2, 4), (3, 4)):
        cells = np.floor(points[list(pair), 0] * 4)
        assert np.bincount((4 * cells[0] + cells[1]).astype(int), minlength=16).tolist() == [4] * 16, pair
