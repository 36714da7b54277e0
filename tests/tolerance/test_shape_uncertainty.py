"""What measured values leave open of the shape of their distribution."""

from __future__ import annotations

import numpy as np
import pytest
from grids import for_each
from scipy import stats

from flexlash.tolerance.measured import Measured
from flexlash.tolerance.shape_uncertainty import bent_values

NORMAL = tuple(np.random.default_rng(1).standard_normal(60).tolist())


def moments(values):
    """Return skewness and excess kurtosis of the distribution through values."""
    standard = Measured(values).standard(np.linspace(5e-5, 1 - 5e-5, 10_000))
    return stats.skew(standard), stats.kurtosis(standard)


def test_bends_change_skewness_and_tails():
    """The first pair differs in skewness to both sides of the sample, the second in the length of the tails."""
    own = moments(NORMAL)
    (less, more), (short, long) = (tuple(map(moments, pair)) for pair in bent_values(NORMAL))
    assert less[0] < own[0] - 0.3 < own[0] + 0.3 < more[0]
    assert short[1] < own[1] < own[1] + 1 < long[1]
    assert abs(short[0] - own[0]) < abs(less[0] - own[0])


def test_bends_mirror_with_their_values():
    """Values the other way round have the same bends the other way round."""
    values = tuple(np.random.default_rng(2).gamma(4.0, size=40).tolist())
    (less, more), (short, long) = bent_values(values)
    (first, second), (third, fourth) = bent_values(tuple(-value for value in values))
    for one, other in ((less, second), (more, first), (short, third), (long, fourth)):
        assert np.allclose(sorted(-np.array(other)), one, atol=1e-6)


def test_more_values_bend_less():
    """The bends shrink as the root of the number of values does."""
    ranges = []
    for count in (50, 200):
        values = tuple(stats.norm.ppf((np.arange(count) + 0.5) / count).tolist())
        (less, more), _ = bent_values(values)
        ranges.append(more[-1] - less[-1])
    assert ranges[0] / ranges[1] == pytest.approx(2, rel=0.15)


@pytest.mark.slow
@for_each("shape", (2.0, 4.0))
def test_true_tails_of_skewed_processes_lie_between_the_bends(shape):
    """Of sixty values of a skewed process the true 99.865th percentile lies between those of the bends, as a rule."""
    generator, inside = np.random.default_rng(3), 0
    for _ in range(100):
        values = (generator.gamma(shape, size=60) - shape) / shape**0.5
        (less, more), (short, long) = bent_values(tuple(values.tolist()))
        centre = Measured(values).standard(np.array([0.99865]))[0]
        ends = [Measured(one).standard(np.array([0.99865]))[0] - centre for one in (less, more, short, long)]
        low, high = (centre + sign * np.hypot(*pair) for sign, pair in ((-1, ends[::2]), (1, ends[1::2])))
        true = (stats.gamma.ppf(0.99865, shape) - shape) / shape**0.5
        inside += values.mean() + values.std(ddof=1) * low <= true <= values.mean() + values.std(ddof=1) * high
    assert inside >= 75
