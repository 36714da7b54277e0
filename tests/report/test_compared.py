"""The data sheet behind the comparison: the figures of Results, and boxes whose parts add up."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import ndtri

from flexlash.pipeline import run
from flexlash.report.compare.compared import compared_variants, percentile_between, share_heading
from flexlash.report.report_data import drawn_variants
from flexlash.schema.angle_unit import ARC_MINUTES
from flexlash.schema.units import ARCMIN
from flexlash.tolerance.distribution_curves import CURVE_SCORES

RESULTS = {
    "Variant": "variant", "P2.5": "p2_5_arcmin", "P50": "p50_arcmin", "P97.5": "p97_5_arcmin",
    "P99.865": "p99_865_arcmin", "Limit": "backlash_limit_arcmin", "sd": "sd_arcmin", "Disk share": "disk_share",
}  # fmt: skip


@pytest.fixture
def drawn(study):
    """Return the drawn variants of the study."""
    return drawn_variants(study[0])


def test_figures_are_those_of_results(drawn):
    """Every figure is the variant's own number in Results, bit for bit."""
    for one, stored in zip(drawn, compared_variants(drawn, ARC_MINUTES).rows, strict=True):
        assert {heading: stored[heading] for heading in RESULTS} == {
            heading: one.row[key] for heading, key in RESULTS.items()
        }
        assert stored["Margin"] == stored["Limit"] - stored["P97.5"]


def test_the_parts_of_a_box_add_up(drawn):
    """Whiskers and halves of a box lead from P2.5 to P97.5, none of them negative."""
    for stored in compared_variants(drawn, ARC_MINUTES).rows:
        parts = [stored[part] for part in ("P2.5 to P25", "P25 to P50", "P50 to P75", "P75 to P97.5")]
        assert min(parts) > 0
        assert stored["P2.5"] + sum(parts) == pytest.approx(stored["P97.5"], rel=1e-14)
        assert stored["P75 less P50"] - stored["P25 less P50"] == pytest.approx(parts[1] + parts[2], rel=1e-14)


def test_quartiles_are_the_curve_between_its_points(drawn):
    """P25 and P75 lie on the stored distribution, where its scores are ∓ 0.6745."""
    for one, stored in zip(drawn, compared_variants(drawn, ARC_MINUTES).rows, strict=True):
        for heading, share in (("P25", 0.25), ("P75", 0.75)):
            line = np.interp(ndtri(share), CURVE_SCORES, one.curve.outputs) / ARCMIN
            assert stored[heading] == pytest.approx(line, abs=2e-3 * stored["sd"])


@pytest.mark.parametrize("power", [0.1, 0.5])
def test_a_percentile_between_stored_ones_is_close(power):
    """The percentile of a skew distribution between stored ones is right to 3e-5 of its sd."""
    scores = np.array(CURVE_SCORES)
    found = percentile_between(ndtri(0.75), scores, np.exp(power * scores))
    assert found == pytest.approx(np.exp(power * ndtri(0.75)), abs=3e-5 * power)


def test_a_percentile_stays_between_its_neighbours():
    """Steps of a rough distribution are not overshot."""
    scores = np.arange(-3.0, 4.0)
    assert percentile_between(0.9, scores, np.where(scores < 1, 0.0, 1.0)) <= 1.0
    assert percentile_between(0.1, scores, np.where(scores < 1, 0.0, 1.0)) >= 0.0


def test_points_of_the_disk_share_stand_under_their_type(drawn):
    """A cup's disk share stands under cups, a hat's under hats, a cylinder's under neither; l/r is length by radius."""
    compared = compared_variants(drawn, ARC_MINUTES)
    by_name = {row["Variant"]: row for row in compared.rows}
    cups, hats = (share_heading(kind) for kind in ("cup", "hat"))
    assert (by_name["B3-160 hat"][cups], by_name["B3-160 hat"][hats]) == (None, by_name["B3-160 hat"]["Disk share"])
    assert by_name["B3-160 case 1"][cups] == by_name["B3-160 case 1"]["Disk share"]
    assert by_name["B3-160 cylinder"][cups] is by_name["B3-160 cylinder"][hats] is None
    assert by_name["B3-160 case 1"]["l/r"] == pytest.approx(2.0, rel=1e-15)
    assert by_name["B3-160 bore"]["l/r"] == pytest.approx(160 / 80.8, rel=1e-12)


@pytest.mark.slow
def test_without_scatter_a_box_is_a_line(table, sound, tmp_path):
    """Of a variant whose dimensions are exact all percentiles are one number and there is no margin without limit."""
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(
        "tolerance_class,dimension,lower_deviation,upper_deviation\nstandard,rim_length,-1,1\n", encoding="utf-8"
    )
    path = table([{**sound, "backlash_limit_arcmin": ""}])
    (row,) = compared_variants(
        drawn_variants(run(path, tmp_path / "report.xlsx", tolerances=tolerances)), ARC_MINUTES
    ).rows
    assert row["P2.5"] == row["P25"] == row["P75"] == row["P97.5"]
    assert row["Limit"] is row["Margin"] is None
