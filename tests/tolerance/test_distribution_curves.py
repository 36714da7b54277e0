"""The stored curve of a row: the very distribution that its spread was read from, far into both tails."""

from __future__ import annotations

import math

import numpy as np
import pytest
from b3_160 import CUP, NOMINAL
from scipy.special import ndtr, ndtri
from toleranced import SUM, plan, row, statistics_of_row

from flexlash.tolerance.dimension_limits import Limits
from flexlash.tolerance.distribution_curves import CURVE_SCORES, HISTOGRAM_BINS, curve_of, curves_of
from flexlash.tolerance.spread_statistics import PERCENTILES

SCORES = np.array(CURVE_SCORES)
MIDDLE = len(SCORES) // 2
METHODS = ("line", "sobol", "random")
LIMITS = {
    "cylinder_length": Limits(low=0.1598, high=0.1602, distribution="uniform"),
    "wall_thickness": Limits(low=0.00155, high=0.00165),
    "youngs_modulus": Limits(low=207e9, high=215e9),
}


def _both(toleranced, **options):
    """Return a row's statistics and its curve."""
    sampling = plan(**options)
    statistics = statistics_of_row(toleranced, sampling)
    return statistics, curve_of(toleranced, statistics, sampling)


CUP_ROW = row(CUP, NOMINAL, LIMITS, 1.08e-3)


def test_scores_reach_beyond_one_in_a_million():
    """The scores rise from −5 to 5 through 0, alike on both sides, and 1 ppm lies two steps inside both ends."""
    assert set(np.diff(SCORES).round(12).tolist()) == {0.1, 0.2}
    assert SCORES[MIDDLE] == 0
    assert (-SCORES[::-1] == SCORES).all()
    assert (SCORES[0], SCORES[-1]) == (-5, 5)
    assert ndtr(SCORES[2]) < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_a_normal_has_a_straight_curve(method):
    """The curve of a sum of normals is mean + score × sd, by lines to 1e-8, by points within their errors."""
    _, curve = _both(SUM, method=method, samples=2**14)
    off = np.abs(curve.outputs - (10.0 + 3.0 * SCORES))
    if method == "line":
        assert off.max() <= 1e-7
        assert curve.score_errors.max() <= 1e-6
    inside = np.minimum(ndtr(SCORES), ndtr(-SCORES)) >= 1 / 2**14
    assert (off <= 4 * 3.0 * curve.score_errors + 1e-7)[inside].all()
    heights = np.diff(ndtr((curve.edges - 10.0) / 3.0))
    assert np.abs(curve.heights - heights).max() <= {"line": 1e-6, "sobol": 0.01, "random": 0.02}[method]
    least = 10.0 + 3.0 * float(ndtri(0.0005))
    assert curve.edges[0] == pytest.approx(least, abs={"line": 1e-6, "sobol": 0.3, "random": 1.0}[method])


@pytest.mark.parametrize("method", METHODS)
def test_the_curve_is_that_of_the_spread(method):
    """The curve passes through the spread's percentiles with their standard errors, and rises."""
    statistics, curve = _both(CUP_ROW, method=method)
    assert (np.diff(curve.outputs) > 0).all()
    sd = statistics.numbers["sd"]
    for name, share in PERCENTILES.items():
        read = np.interp(ndtri(share), SCORES, curve.outputs)
        assert read == pytest.approx(statistics.numbers[name], abs=2e-3 * sd if method == "line" else 0.02 * sd)
    assert curve.outputs[MIDDLE] == pytest.approx(statistics.numbers["p50"], rel=1e-12)
    slope = (curve.outputs[MIDDLE + 1] - curve.outputs[MIDDLE - 1]) / (SCORES[MIDDLE + 1] - SCORES[MIDDLE - 1])
    told = statistics.numbers["p50_standard_error"]
    assert curve.score_errors[MIDDLE] * slope == pytest.approx(told, rel=1e-6 if method == "line" else 0.05)
    assert curve.heights.shape == (HISTOGRAM_BINS,)
    assert curve.edges.shape == (HISTOGRAM_BINS + 1,)
    assert curve.heights.sum() == pytest.approx(0.999, abs=1e-3)
    assert (curve.heights >= 0).all()


def test_one_scattering_dimension_is_the_model_itself():
    """With one normal dimension every percentile of the curve is the model at that percentile of the dimension."""
    middle, sd = 211e9, 8e9 / 6
    _, curve = _both(row(CUP, NOMINAL, {"youngs_modulus": LIMITS["youngs_modulus"]}))
    exact = [float(CUP(NOMINAL | {"youngs_modulus": middle - sd * score})) for score in CURVE_SCORES]
    assert curve.outputs == pytest.approx(exact, rel=1e-9)
    shares = [0.5 * math.erfc((exact[MIDDLE] * middle / edge - middle) / sd / math.sqrt(2)) for edge in curve.edges]
    assert curve.heights == pytest.approx(np.diff(shares), abs=1e-4)


@pytest.mark.parametrize(("method", "samples"), [("sobol", 1024), ("random", 64), ("random", 1)])
def test_points_go_on_in_a_straight_line_beyond_their_rarest(method, samples):
    """Beyond one in all points the curve of points is straight, and it says how rare a share it can tell."""
    statistics, curve = _both(SUM, method=method, samples=samples)
    assert curve.rarest == pytest.approx(1 / statistics.numbers["spread_points"])
    beyond = (np.diff(curve.outputs) / np.diff(SCORES))[ndtr(SCORES[1:]) < curve.rarest]
    assert beyond == pytest.approx(beyond[0])
    assert (np.diff(curve.outputs) > 0).all()


def test_without_scatter_the_curve_is_level():
    """A row that does not scatter has its backlash everywhere and no errors."""
    statistics, curve = _both(row(CUP, NOMINAL, {}))
    assert set(curve.outputs.tolist()) == set(curve.edges.tolist()) == {statistics.numbers["p50"]}
    assert curve.score_errors.max() == curve.rarest == 0
    assert curve.heights.sum() == 1


def test_a_curve_does_not_depend_on_the_rows_beside_it():
    """Rows alike have together the very curves that each has alone, however many lines each takes."""
    rows = [
        row(CUP, NOMINAL | {"cylinder_length": 0.16 * (1 + place / 50)}, LIMITS | {"wall_thickness": limits}, 1.08e-3)
        for place, limits in enumerate(
            [
                Limits(low=0.0016 - off, high=0.0016 + off, distribution="uniform")
                for off in (1e-5, 1e-4, 3e-4, 5e-4, 9e-4)
            ]
        )
    ]
    sampling = plan()
    statistics = [statistics_of_row(one, sampling) for one in rows]
    assert len({one.numbers["spread_points"] for one in statistics}) > 1
    for one, found, curve in zip(rows, statistics, curves_of(rows, statistics, sampling), strict=True):
        alone = curve_of(one, found, sampling)
        for part in ("outputs", "score_errors", "edges", "heights"):
            assert (getattr(curve, part) == getattr(alone, part)).all()
        assert curve.rarest == alone.rarest
