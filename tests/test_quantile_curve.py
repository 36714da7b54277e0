"""A curve through a few quantiles on the normal scale: straight for a normal, monotone for all, and back again."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from flexlash.tolerance.quantile_curve import QuantileCurve

thorough = settings(deadline=None, max_examples=60, derandomize=True)

KNOTS = np.array([-3.3, -3.0, -2.0, -1.65, -0.8, 0.0, 0.8, 1.65, 2.0, 3.0, 3.3])


def curve_of(*quantile_and_rise, knots=KNOTS):
    """Return the curve of rows from their quantile at a score and its slope."""
    outputs = np.stack([quantile(knots) for quantile, _ in quantile_and_rise], axis=1)
    rises = np.stack([rise(knots) for _, rise in quantile_and_rise], axis=1)
    return QuantileCurve(scores=knots, outputs=outputs, rises=rises)


def normal(mean, sd):
    """Return quantile and rise of a normal."""
    return lambda score: mean + sd * score, lambda score: np.full_like(score, sd)


def lognormal(sigma):
    """Return quantile and rise of a lognormal."""
    return lambda score: np.exp(sigma * score), lambda score: sigma * np.exp(sigma * score)


UNIFORM = (stats.norm.cdf, stats.norm.pdf)


def test_normal_curve_is_straight():
    """The curve of a normal is exact everywhere, beyond its knots too, in both directions."""
    curve = curve_of(normal(3.0, 0.5), normal(-1.0, 20.0))
    scores = np.linspace(-6, 6, 61)
    outputs = curve.outputs_at(scores)
    assert outputs[:, 0] == pytest.approx(3 + 0.5 * scores, abs=1e-12)
    assert outputs[:, 1] == pytest.approx(-1 + 20 * scores, abs=1e-11)
    assert curve.scores_at(outputs) == pytest.approx(np.stack([scores, scores], axis=1), abs=1e-10)


@pytest.mark.parametrize(("row", "slack"), [(lognormal(0.1), 1e-5), (lognormal(0.3), 5e-4), (UNIFORM, 2e-3)])
def test_other_curves_are_close(row, slack):
    """Between the knots the curve errs by a small part of the spread."""
    curve = curve_of(row)
    scores = np.linspace(-3.3, 3.3, 101)
    exact = row[0](scores)
    spread = row[0](1.0) - row[0](-1.0)
    assert curve.outputs_at(scores)[:, 0] == pytest.approx(exact, abs=slack * spread)
    inner = np.linspace(-2, 2, 41)
    assert curve.scores_at(row[0](inner)[:, None])[:, 0] == pytest.approx(inner, abs=15 * slack)


def test_curve_passes_its_knots():
    """At a knot the curve has the quantile given, and its inverse the score."""
    curve = curve_of(lognormal(0.4), UNIFORM)
    assert curve.outputs_at(KNOTS) == pytest.approx(curve.outputs, rel=1e-12)
    assert curve.scores_at(curve.outputs) == pytest.approx(np.stack([KNOTS, KNOTS], axis=1), abs=1e-12)


def test_beyond_the_knots_scores_go_on_straight():
    """Outputs beyond the outermost knots have the scores of straight lines with the rises there."""
    curve = curve_of(lognormal(0.4))
    far = np.array([[curve.outputs[0, 0] - 0.1], [curve.outputs[-1, 0] + 2.0]])
    wanted = [-3.3 - 0.1 / curve.rises[0, 0], 3.3 + 2.0 / curve.rises[-1, 0]]
    assert curve.scores_at(far)[:, 0] == pytest.approx(wanted, rel=1e-12)


def test_rows_are_independent():
    """Each row has the numbers that it has alone."""
    rows = [normal(1, 2), lognormal(0.3), UNIFORM]
    together = curve_of(*rows)
    scores = np.linspace(-3, 3, 13)
    outputs = together.outputs_at(scores)
    for place, row in enumerate(rows):
        alone = curve_of(row)
        assert np.array_equal(outputs[:, [place]], alone.outputs_at(scores))
        assert np.array_equal(together.scores_at(outputs)[:, [place]], alone.scores_at(outputs[:, [place]]))


@thorough
@given(
    steps=st.lists(st.floats(1e-3, 10), min_size=10, max_size=10),
    rises=st.lists(st.floats(1e-3, 100), min_size=11, max_size=11),
)
def test_curve_never_turns_back(steps, rises):
    """Whatever the rises, a greater score never has a smaller quantile, nor a greater output a smaller score."""
    outputs = np.concatenate([[0.0], np.cumsum(steps)])
    curve = QuantileCurve(scores=KNOTS, outputs=outputs[:, None], rises=np.array(rises)[:, None])
    found = curve.outputs_at(np.linspace(-3.3, 3.3, 201))[:, 0]
    assert (np.diff(found) >= -1e-12 * outputs[-1]).all()
    scores = curve.scores_at(np.linspace(-1, outputs[-1] + 1, 201)[:, None])[:, 0]
    assert (np.diff(scores) >= -1e-9).all()


def test_knots_of_one_value_do_no_harm():
    """Knots that share an output, as at a limit that cannot be passed, give finite numbers that still rise."""
    outputs = np.array([0.0, 1.0, 1.0, 1.0])[:, None]
    curve = QuantileCurve(scores=np.array([-1.0, 0.0, 1.0, 2.0]), outputs=outputs, rises=np.full((4, 1), 0.5))
    found = curve.outputs_at(np.linspace(-1, 2, 31))[:, 0]
    assert np.isfinite(found).all()
    assert (np.diff(found) >= -1e-12).all()
    assert np.isfinite(curve.scores_at(np.linspace(-1, 2, 31)[:, None])).all()
