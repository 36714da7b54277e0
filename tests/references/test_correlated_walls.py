"""The B3-160 flexspline with wall and disk thickness correlated: references of 3e-9 rad.

Source: the model of `test_tolerance_model.py` with Pearson's correlation 0, 0.5, 0.8 and 1 between the two uniform
thicknesses, that of their normal scores being 2 sin(π ρ/6). Backlash 2U: sd in 1e-5 rad, percentiles in 1e-3 rad.
"""

import math

import pytest
from reference_inputs import CORRELATED_WALLS, REFERENCE_ERROR, SCATTER

from flexlash.mechanics.flexspline import backlash
from flexlash.tolerance import propagate

PAIR = ("wall_thickness", "disk_thickness")


def model(**dimensions):
    """Return the backlash [rad] of the cup at 800 N·m."""
    return backlash("cup", {"torque": 800.0, **dimensions})


@pytest.mark.parametrize("method", ["line", "sobol"])
@pytest.mark.parametrize("of", ["values", "scores", "ranks"])
@pytest.mark.parametrize("correlation", CORRELATED_WALLS)
def test_published_spread_of_correlated_thicknesses(correlation, of, method):
    """sd, P97.5 and P99.865 are the references' within four combined standard errors, however ρ is entered.

    Uniform values are their own ranks, so both are one number.
    """
    entered = 2 * math.sin(math.pi * correlation / 6) if of == "scores" else correlation
    spread = propagate(model, SCATTER, method=method, correlation={PAIR: min(entered, 1.0)}, correlation_of=of, seed=1)
    sd, p97_5, p99_865 = CORRELATED_WALLS[correlation]
    assert spread.method == method
    assert method == "sobol" or spread.size <= 512
    assert abs(spread.sd - sd * 1e-5) <= 4 * math.hypot(spread.sd_standard_error, REFERENCE_ERROR)
    for probability, value in ((0.975, p97_5), (0.99865, p99_865)):
        error = spread.standard_error(probability)
        assert abs(spread.quantile(probability) - value * 1e-3) <= 4 * math.hypot(error, REFERENCE_ERROR)
        assert error <= (1e-3 if method == "line" else 0.05) * spread.sd


def test_one_thickness_is_the_limit_of_correlation_1():
    """With ρ = 1 the spread is that of a part whose wall and disk are one dimension."""
    tied = propagate(model, SCATTER, correlation={PAIR: 1.0}, seed=1)
    rest = {name: values for name, values in SCATTER.items() if name != "disk_thickness"}
    one = propagate(lambda **given: model(**given, disk_thickness=given["wall_thickness"]), rest, seed=2)
    for probability in (0.00135, 0.025, 0.5, 0.975, 0.99865):
        error = math.hypot(tied.standard_error(probability), one.standard_error(probability))
        assert abs(tied.quantile(probability) - one.quantile(probability)) <= 4 * error
    assert tied.shares["wall_thickness"] == pytest.approx(one.shares["wall_thickness"] / 2, abs=4e-3)
