"""Points in the unit cube: whose coordinate is whose, how many there are, and that replicates are independent."""

import numpy as np
import pytest

from flexlash.tolerance import Normal, Triangular, Uniform
from flexlash.tolerance.sampling import DEFAULT_SAMPLES, REPLICATES, UnitPoints

NAMES = ("torque", "wall_thickness", "disk_thickness")
UNIT = Uniform(low=0, high=1)

each_method = pytest.mark.parametrize("method", ["sobol", "random"])


def points_of(method, *, names=NAMES, samples=4096, seed=0):
    """Return points of a method."""
    return UnitPoints(names, method=method, samples=samples, seed=seed)


@each_method
@pytest.mark.parametrize(
    ("samples", "size"),
    [(1, 16), (16, 16), (17, 32), (32, 32), (33, 64), (48, 64), (1000, 1024), (1024, 1024), (1025, 2048)],
)
def test_sizes_are_rounded_up(method, samples, size):
    """The points in all are rounded up to replicates times a power of two."""
    points = points_of(method, samples=samples)
    assert REPLICATES == 16
    assert points.size == size == REPLICATES * points.count
    assert points.standard("torque", UNIT).shape == (REPLICATES, size // REPLICATES)


@each_method
def test_default_size(method):
    """Without a number of samples each method takes its own."""
    points = points_of(method, names=["torque"], samples=None)
    assert points.size == DEFAULT_SAMPLES[method]
    assert points.method == method


@each_method
def test_points_lie_inside_the_cube(method):
    """No point touches a face of the cube, so that no quantile is infinite."""
    values = points_of(method, samples=2**15).standard("torque", UNIT)
    assert values.min() >= 2.0**-53
    assert values.max() <= 1 - 2.0**-53
    assert np.isfinite(points_of(method, samples=2**15).standard("torque", Normal(mean=0, sd=1))).all()


@each_method
def test_same_seed_same_points(method):
    """The same seed gives the same points bit for bit, another seed other points."""
    first, again, other = (points_of(method, seed=seed) for seed in (3, 3, 4))
    for name in NAMES:
        assert np.array_equal(first.standard(name, UNIT), again.standard(name, UNIT))
        assert np.array_equal(first.standard(name, UNIT, "second"), again.standard(name, UNIT, "second"))
        assert not np.array_equal(first.standard(name, UNIT), other.standard(name, UNIT))


@each_method
def test_a_coordinate_belongs_to_a_name(method):
    """A name keeps its coordinate whichever other names are asked for, and in whichever order."""
    first, second = points_of(method), points_of(method)
    forward = {name: first.standard(name, UNIT) for name in NAMES}
    backward = {name: second.standard(name, UNIT) for name in NAMES[::-1]}
    alone = points_of(method).standard("disk_thickness", UNIT)
    for name in NAMES:
        assert np.array_equal(forward[name], backward[name])
    assert np.array_equal(alone, forward["disk_thickness"])
    assert not np.array_equal(forward["wall_thickness"], forward["disk_thickness"])


@each_method
def test_names_are_uncorrelated(method):
    """Coordinates of different names, and the two point sets of one name, do not correlate."""
    points = points_of(method, samples=2**13)
    columns = [points.standard(name, UNIT, "leading").ravel() for name in NAMES]
    columns += [points.standard(name, UNIT, "second").ravel() for name in NAMES]
    correlation = np.corrcoef(columns) - np.eye(len(columns))
    assert np.abs(correlation).max() < 5 / np.sqrt(columns[0].size)


@each_method
def test_replicates_are_independent(method):
    """Replicates are different points whose averages err independently: sixteen err by a quarter of one."""
    normal = Normal(mean=0, sd=1)
    errors = np.array(
        [(points_of(method, samples=256, seed=seed).standard("torque", normal) ** 3).mean(axis=1) for seed in range(80)]
    )
    assert all(len(set(row)) == REPLICATES for row in errors)
    together, alone = (errors.mean(axis=1) ** 2).mean(), (errors**2).mean()
    assert together / alone == pytest.approx(1 / REPLICATES, rel=0.5)


@each_method
def test_replicate_means_scatter_around_a_half(method):
    """The replicates' means are unbiased: their mean is a half within four of its own standard errors."""
    means = points_of(method, samples=2**14).standard("torque", Normal(mean=0, sd=1)).mean(axis=1)
    assert abs(means.mean()) <= 4 * means.std(ddof=1) / np.sqrt(REPLICATES)


def test_sobol_points_are_balanced():
    """Each replicate of 2^m Sobol' points has one point in each 2^-m of every coordinate; random points do not."""
    for name in NAMES:
        values = points_of("sobol").standard(name, UNIT)
        count = values.shape[1]
        strata = np.sort(np.floor(values * count), axis=1)
        assert np.array_equal(strata, np.tile(np.arange(count), (REPLICATES, 1)))
        drawn = points_of("random").standard(name, UNIT)
        assert not np.array_equal(np.sort(np.floor(drawn * count), axis=1), strata)


@each_method
@pytest.mark.parametrize(("samples", "length"), [(64, 4), (2**13, 512), (2**16, 2048)])
def test_leading_and_second_sets(method, samples, length):
    """The shares' first set is the leading part of all points, their second as long, and other points."""
    points = points_of(method, samples=samples)
    every = points.standard("torque", UNIT)
    leading, second = (points.standard("torque", UNIT, which) for which in ("leading", "second"))
    assert points.share_count == length
    assert np.array_equal(leading, every[:, :length])
    assert second.shape == leading.shape
    assert not np.array_equal(second, leading)


def test_standard_values_are_kept_for_a_shape():
    """Distributions of one shape are given the same array, of another shape other values."""
    points = points_of("sobol")
    first = points.standard("torque", Normal(mean=0, sd=1))
    assert points.standard("torque", Normal(mean=80, sd=0.02)) is first
    assert points.standard("wall_thickness", Normal(mean=0, sd=1)) is not first
    assert np.array_equal(points.standard("torque", UNIT, "all"), points.standard("torque", Uniform(1, 2), "all"))


def test_values_are_right_when_the_memory_is_full():
    """With more shapes than are kept, every one still has its own values."""
    points = points_of("sobol", samples=16)
    uniform = points.standard("torque", UNIT)
    modes = np.linspace(0.1, 0.9, 300)
    found = [points.standard("torque", Triangular(low=0, high=1, mode=mode)) for mode in modes]
    again = [points.standard("torque", Triangular(low=0, high=1, mode=mode)) for mode in modes]
    assert len(points._standard) <= 256
    for mode, first, second in zip(modes, found, again, strict=True):
        assert np.array_equal(first, second)
        assert np.array_equal(first, Triangular(low=0, high=1, mode=mode).standard(uniform))


def test_unknown_name_is_refused():
    """A name that the points were not drawn for has no coordinate."""
    with pytest.raises(KeyError):
        points_of("sobol").standard("bore_diameter", UNIT)


@each_method
def test_a_number_of_points_below_one_is_refused(method):
    """At least one point must be asked for."""
    with pytest.raises(ValueError, match="at least 1"):
        points_of(method, samples=0)


@pytest.mark.parametrize("method", ["sobol", "random"])
def test_names_that_came_later_leave_the_others_alone(method):
    """A dimension that a later version brings changes no point of those that there were."""
    alone = UnitPoints(["a", "b"], method=method, samples=1024, seed=3)
    more = UnitPoints(["a", "b"], method=method, samples=1024, seed=3, later=["c"])
    inputs = {"a": Uniform(0, 1), "b": Uniform(0, 1)}
    for points in ("all", "leading", "second"):
        ours, theirs = alone.standards(inputs, points=points), more.standards(inputs, points=points)
        assert all(np.array_equal(ours[name], theirs[name]) for name in inputs), points
    first, second = (more.standard("c", Uniform(0, 1), points) for points in ("leading", "second"))
    assert abs(np.corrcoef(first.ravel(), second.ravel())[0, 1]) < 0.2
