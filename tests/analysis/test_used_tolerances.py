"""Tolerances used says of every dimension between which limits and how it scatters, and from where that is known."""

from __future__ import annotations

import math
import statistics

import pytest
from entry_books import CUP, UNIFORM_CUP, correlations, entry_book
from filled import SOUND

from flexlash.analysis.used_tolerances import used_tolerances
from flexlash.pipeline import check, run
from flexlash.schema.used_columns import TOLERANCES_USED

HEADS = "tolerance_class,dimension,lower_deviation,upper_deviation,grade,distribution,limits_sigma\n"


@pytest.fixture
def used_of(tmp_path):
    """Return what is used of a variant with rows of Tolerances in a file beside it, by dimension."""

    def used_of(rows="", **cells):
        row = {**SOUND, **cells}
        path, beside = tmp_path / "table.csv", tmp_path / "tolerances.csv"
        path.write_text(",".join(row) + "\n" + ",".join(str(cell) for cell in row.values()) + "\n", encoding="utf-8")
        beside.write_text(HEADS + rows, encoding="utf-8")
        options = {"tolerances": beside} if rows else {}
        outcome = run(path, samples=64, **options)
        frame = used_tolerances(outcome.computed.values())
        assert frame.columns == [column.key for column in TOLERANCES_USED]
        return {one["dimension"]: one for one in frame.to_dicts()}, outcome

    return used_of


def test_every_distribution_has_its_true_mean_and_sd(used_of):
    """Mean and standard deviation are those of the parts in the column's own unit, whatever the distribution."""
    rows = (
        "a,cylinder_length,-0.1,0.3,,normal,4\na,wall_thickness,-0.02,0.02,,uniform,\n"
        "a,disk_inner_radius,-0.03,0.01,,triangular,\na,youngs_modulus,-3,3,,truncated normal,1\n"
    )
    used, outcome = used_of(rows, tolerance_class="a")
    assert list(used) == ["cylinder_length", "wall_thickness", "disk_inner_radius", "youngs_modulus"]
    entered = outcome.computed[2].variant.dimensions["cylinder_length"] * 1000
    length = used["cylinder_length"]
    assert [length[key] for key in ("unit", "distribution", "scatters_between")] == ["mm", "normal", "parts"]
    expected = (entered, entered - 0.1, entered + 0.3, entered + 0.1, 0.4 / 8)
    keys = ("nominal", "lower", "upper", "mean", "standard_deviation")
    assert [length[key] for key in keys] == pytest.approx(expected, rel=1e-12)
    assert used["wall_thickness"]["standard_deviation"] == pytest.approx(0.04 / math.sqrt(12), rel=1e-9)
    assert used["disk_inner_radius"]["standard_deviation"] == pytest.approx(0.04 / math.sqrt(24), rel=1e-9)
    # Two ends four standard deviations off the middle; nothing beyond the ends of the others.
    assert length["outside_limits_ppm"] == pytest.approx(1e6 * math.erfc(4 / math.sqrt(2)), rel=1e-9)
    assert [used[name]["outside_limits_ppm"] for name in list(used)[1:]] == [0.0, 0.0, 0.0]
    # Variance of a normal that is cut one standard deviation either side: 1 − 2φ(1)/(2Φ(1) − 1).
    cut = 1 - 2 * math.exp(-0.5) / math.sqrt(2 * math.pi) / math.erf(math.sqrt(0.5))
    assert used["youngs_modulus"]["unit"] == "GPa"
    assert used["youngs_modulus"]["standard_deviation"] == pytest.approx(3 * math.sqrt(cut), rel=1e-9)


def test_shares_are_those_of_the_spread(used_of):
    """Shares are first-order shares of the variance as Sensitivity has them; the greatest is the main contributor's."""
    used, outcome = used_of()
    main = outcome.results["main_contributor"][0]
    assert max(used, key=lambda name: used[name]["share"]) == main
    assert used[main]["share"] == outcome.results["main_contributor_share"][0]


def test_what_is_shifted_alone_does_not_scatter(used_of):
    """Limits that coincide beside the entered value are told with a standard deviation of 0, and of no distribution."""
    used, outcome = used_of("a,wall_thickness,0.01,0.01,,,\na,cylinder_length,0,0,,,\n", tolerance_class="a")
    assert list(used) == ["wall_thickness"]
    wall, entered = used["wall_thickness"], outcome.computed[2].variant.dimensions["wall_thickness"] * 1000
    assert wall["lower"] == wall["upper"] == wall["mean"] == pytest.approx(entered + 0.01, rel=1e-12)
    assert wall["standard_deviation"] == 0
    assert [wall[key] for key in ("distribution", "scatters_between", "share")] == [None] * 3


def test_the_source_is_the_row(used_of):
    """A class that was read is told with the row; the built-in one as built in."""
    used, _ = used_of("Shop,wall_thickness,-0.02,0.02,,,\n", tolerance_class="shop")
    assert used["wall_thickness"]["source"] == "class shop, row 2"
    used, _ = used_of()
    assert {one["source"] for one in used.values()} == {"class standard, built in"}


def test_what_scatters_together_is_told_of_both(tmp_path):
    """Each dimension of a pair names the other with its correlation; a variant without the pair has a blank."""
    rows = correlations(("disk_thickness", "wall_thickness", 0.5), ("mean_radius", "wall_thickness", -0.125))
    variants = [CUP, {**CUP, "variant": "one thickness", "disk_thickness_mm": None}]
    path = entry_book(tmp_path / "s.xlsx", variants=variants, tolerances=UNIFORM_CUP, correlations=rows)
    frame = used_tolerances(check(path).computed.values())
    told = {row["variant"] + " " + row["dimension"]: row["scatters_with"] for row in frame.to_dicts()}
    assert {name: text for name, text in told.items() if text} == {
        "B3-160 wall_thickness": "Mean radius -0.125; Disk thickness 0.5",
        "B3-160 disk_thickness": "Wall thickness 0.5",
        "B3-160 mean_radius": "Wall thickness -0.125",
        "one thickness wall_thickness": "Mean radius -0.125",
        "one thickness mean_radius": "Wall thickness -0.125",
    }


@pytest.mark.slow
def test_bases_samples_and_lots_are_told(workbook):
    """A row that is taken over says from which class, a sample its parts and what they come to, lots that they are."""
    values = (1.6031, 1.6112, 1.6054, 1.6097, 1.6081, 1.6045)
    path = workbook(
        [{**SOUND, "tolerance_class": "shop"}],
        tolerances=[
            {"tolerance_class": "shop", "based_on": "full"},
            {"tolerance_class": "shop", "dimension": "wall_thickness", "lower_deviation": -0.02,
             "upper_deviation": 0.02, "sample": "W"},
            {"tolerance_class": "full", "dimension": "cylinder_length", "grade": "IT11"},
            {"tolerance_class": "full", "dimension": "youngs_modulus", "lower_deviation": -4, "upper_deviation": 4},
            {"tolerance_class": "full", "dimension": "torque", "lower_deviation": -4, "upper_deviation": 4,
             "scatters_between": "lots"},
        ],
        measurements=[{"sample": "W", "part": place, "wall_thickness_mm": value} for place, value in enumerate(values)],
    )  # fmt: skip
    outcome = run(path, samples=64)
    used = {row["dimension"]: row for row in used_tolerances(outcome.computed.values()).to_dicts()}
    (first,) = {row.row for row in outcome.validated.classes["shop"] if row.dimension == "wall_thickness"}
    assert used["wall_thickness"]["source"] == f"class shop, row {first}, sample W (6 parts)"
    assert used["wall_thickness"]["mean"] == pytest.approx(statistics.mean(values), rel=1e-12)
    assert used["wall_thickness"]["standard_deviation"] == pytest.approx(statistics.stdev(values), rel=1e-9)
    process = statistics.NormalDist(statistics.mean(values), statistics.stdev(values))
    outside = process.cdf(1.58) + 1 - process.cdf(1.62)
    assert used["wall_thickness"]["outside_limits_ppm"] == pytest.approx(1e6 * outside, rel=1e-6)
    assert used["cylinder_length"]["source"] == f"class shop, taken over from class full, row {first + 1}"
    between = {name: row["scatters_between"] for name, row in used.items()}
    assert between == {
        "torque": "lots", "cylinder_length": "parts", "wall_thickness": "parts", "youngs_modulus": "lots"
    }  # fmt: skip
