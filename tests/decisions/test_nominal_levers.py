"""Single changes of nominal values: the worked example, and every value fed back as a submission of its own."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from lever_rows import CLASSES, changed_rows, drawn_rows, write_rows

import flexlash
from flexlash.analysis.options import Options
from flexlash.decisions import levers as levers_module
from flexlash.decisions.levers import levers_of
from flexlash.schema.decision_results import LEVERS_TABLE
from flexlash.schema.decision_rows import LeverRow

STUDY = Path(__file__).parents[2] / "data" / "b3-160-study.xlsx"
INTERVAL = 2 * 1.96
"""Standard errors that a 95 % interval spans."""

CASE_3 = {
    ("disk_inner_radius", None): (45.42, 45.84, 46.0, 320, -1.4, 65),
    ("cylinder_length", None): (164.1, 161.9, 161.5, 769, -16.7, 86),
    ("wall_thickness", "disk_thickness"): (1.802, 1.817, 1.82, 566, 13.75, 76),
    ("disk_thickness", None): (2.283, 2.346, 2.35, 1052, 6.1, 59),
    ("wall_thickness", None): (1.950, 1.977, 1.98, 910, 20.7, 86),
    ("mean_radius", "disk_outer_radius"): (86.48, 86.96, 87.0, 1032, 10.8, 86),
}
"""By dimension and what moves with it: what meets 97.5 and 99.865 %, as drawn, ppm, mass in per cent, stress in MPa."""


@pytest.fixture(scope="module")
def study():
    """Return the outcome of the published study."""
    return flexlash.run(STUDY)


def levers(outcome, rows=None, **settings):
    """Return the levers of an outcome as dictionaries."""
    return levers_of(outcome.computed, replace(outcome.settings, **settings), rows or {}).to_dicts()


def nominal(outcome, variant, rows=None, **settings):
    """Return the nominal levers of a variant by dimension and what moves with it."""
    of_variant = [one for one in levers(outcome, rows, **settings) if one["variant"] == variant]
    return {(one["dimension"], one["moves"]): one for one in of_variant if one["what"] == "nominal"}


def only(outcome, *names):
    """Return an outcome with some of its variants computed alone."""
    return replace(outcome, computed={row: one for row, one in outcome.computed.items() if one.variant.name in names})


def as_printed(value, example):
    """Return whether a value is an example that was rounded to its digits, one of them twice: 2.34547 to 2.346."""
    digits = len(f"{example}".partition(".")[2])
    return abs(value - example) <= 0.55 * 10**-digits


@pytest.mark.slow
def test_what_alone_brings_case_3_within_its_limit(study):
    """All six changes of B3-160 case 3: exact, as drawn, the share over the limit then, mass and stress."""
    case = only(study, "B3-160 case 3")
    at_97_5, found = nominal(case, "B3-160 case 3", target_percent=97.5), nominal(case, "B3-160 case 3")
    assert found.keys() == at_97_5.keys() == CASE_3.keys()
    for change, (first, second, drawn, ppm, mass, stress) in CASE_3.items():
        lever = found[change]
        assert as_printed(at_97_5[change]["to_value"], first), change
        assert as_printed(lever["to_value"], second), change
        assert lever["drawing_value"] == drawn, change
        assert lever["ppm_after"] == pytest.approx(ppm, abs=1), change
        assert as_printed(lever["mass_change_percent"], mass), change
        assert round(lever["von_mises_MPa_after"]) == stress, change
        assert (lever["direction"], lever["possible"], lever["in_range"]) == ("meet", "yes", "yes"), change
    assert found["disk_inner_radius", None]["rank"] == 1
    assert {one["rank"] for one in found.values()} == {1, 2, 3, 4, 5, 6}
    assert "tolerance class grinding has no row" in found["disk_thickness", None]["range_note"]
    assert found["wall_thickness", "disk_thickness"]["range_note"] is None
    assert "coned more steeply" in found["cylinder_length", None]["range_note"]


@pytest.mark.slow
def test_bending_follows_wall_and_radius(study):
    """At equal deflection the bending stress goes as Δ/r_m²: a thicker wall raises it, a greater radius lowers it."""
    found = nominal(only(study, "B3-160 case 3"), "B3-160 case 3")
    bent = {change: one["bending_stress_change_percent"] for change, one in found.items()}
    assert bent["wall_thickness", None] == pytest.approx(100 * (1.98 / 1.6 - 1), rel=1e-9)
    assert bent["mean_radius", "disk_outer_radius"] == pytest.approx(100 * ((80 / 87) ** 2 - 1), rel=1e-9)
    assert bent["disk_inner_radius", None] == bent["disk_thickness", None] == 0


@pytest.fixture
def submitted(tmp_path):
    """Return a function that runs rows of Variants with the classes of every kind."""
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(CLASSES, encoding="utf-8")

    def run(rows, **options):
        path = write_rows(tmp_path / f"rows-{len(list(tmp_path.iterdir()))}.csv", rows)
        return flexlash.run(path, tolerances=tolerances, **options)

    return run


def fed_back(submitted, rows, target, **options):
    """Check every possible lever of rows by the submissions of its two values; return how many there were."""
    found = levers(submitted(rows, **options), target_percent=target)
    allowed = 1 - target / 100
    drawn = submitted(changed_rows(rows, found, "drawing_value"), **options).results
    for one in drawn.iter_rows(named=True):
        lever = found[int(one["variant"][1:])]
        assert one["status"] != "error", lever
        # To the last bit: the very number that the submission gets.
        assert one["probability_over_limit"] == lever["probability_over_limit_after"] <= allowed, lever
        assert one["stiffness_Nm_per_rad"] > 0
    exact = submitted(changed_rows(rows, found, "to_value"), **options).results
    for one in exact.iter_rows(named=True):
        lever = found[int(one["variant"][1:])]
        error = (one["probability_over_limit_high"] - one["probability_over_limit_low"]) / INTERVAL
        # An error of the search about as great as the told one lies beside it; one of 0 leaves rounding.
        assert abs(one["probability_over_limit"] - allowed) <= 2 * error + 1e-8 * allowed, lever
    return drawn.height


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "target"),
    [(1, 99.865), *(pytest.param(*more, marks=pytest.mark.long) for more in ((2, 97.5), (3, 99.99), (4, 99.865)))],
)
def test_every_value_fed_back_meets_the_limit(submitted, seed, target):
    """50 random variants each: the exact value meets the target within the told error, the drawn one's share is told.

    They are cups, hats and cylinders of four classes, refined and plain, whose limits lie anywhere.
    """
    assert fed_back(submitted, drawn_rows(50, seed), target) > 100


@pytest.mark.slow
def test_points_give_the_share_that_a_submission_by_points_gets(submitted):
    """By another method the value is found by lines, and what the drawing value does is told by that method."""
    rows = [row for row in drawn_rows(30, 5) if row["tolerance_class"] == "grades"][:4]
    found = levers(submitted(rows, method="sobol", samples=512), method="sobol", samples=512)
    drawn = submitted(changed_rows(rows, found, "drawing_value"), method="sobol", samples=512).results
    told = [found[int(name[1:])]["probability_over_limit_after"] for name in drawn["variant"]]
    assert drawn["probability_over_limit"].to_list() == told


@pytest.mark.slow
def test_exact_values_are_those_of_halving(submitted):
    """Halving on whole submissions, which knows nothing of the search, finds the same values to a millionth."""
    rows = drawn_rows(12, 6)
    found = levers(submitted(rows))
    ends = [[{**one, "to_value": one["to_value"] and part * one["to_value"]} for one in found] for part in (0.99, 1.01)]
    keys = [int(row["variant"][1:]) for row in changed_rows(rows, found, "to_value")]

    def over(values):
        results = submitted(changed_rows(rows, values, "to_value")).results
        return dict(zip((int(name[1:]) for name in results["variant"]), results["probability_over_limit"], strict=True))

    at_ends = [over(end) for end in ends]
    low, high = ({key: end[key]["to_value"] for key in keys} for end in ends)
    told = [key for key in keys if None not in {at_ends[0][key], at_ends[1][key]}]
    falls = {key: at_ends[0][key] > 0.00135 > at_ends[1][key] for key in told}
    rises = {key: at_ends[0][key] < 0.00135 < at_ends[1][key] for key in told}
    for _ in range(16):
        middle = {key: (low[key] + high[key]) / 2 for key in keys}
        shares = over([{**one, "to_value": middle.get(key)} for key, one in enumerate(found)])
        for key in told:
            ends_here = high if (shares[key] > 0.00135) == rises[key] else low
            ends_here[key] = middle[key]
    monotone = [key for key in told if falls[key] or rises[key]]
    assert len(monotone) > 20
    for key in monotone:
        assert (low[key] + high[key]) / 2 == pytest.approx(found[key]["to_value"], rel=1e-6), found[key]


@pytest.mark.slow
def test_neighbours_and_processes_change_no_bit(study, monkeypatch):
    """A variant's levers are the same alone, among others, in another order, and by several processes."""
    whole = levers(study)
    for name in ("B3-160 case 3", "B3-160 hat"):
        assert [one for one in whole if one["variant"] == name] == levers(only(study, name)), name
    turned = replace(study, computed=dict(reversed([*study.computed.items()])))
    order = [one.variant.name for one in turned.computed.values()]
    assert levers(turned) == sorted(whole, key=lambda one: order.index(one["variant"]))
    monkeypatch.setattr(levers_module, "_TOGETHER", 3)
    monkeypatch.setattr(levers_module, "_PER_WORKER", 1)
    assert levers_of(study.computed, study.settings, {}, Options(jobs=2)).to_dicts() == whole


@pytest.mark.slow
def test_the_sheet_levers_says_what_may_change(study):
    """A dimension that may not change has no row, the torque only where told so; steps, costs and ranges are kept."""
    case = only(study, "B3-160 case 3")
    rows = {
        "mean_radius": LeverRow(row=2, dimension="mean_radius", may_change=False),
        "disk_thickness": LeverRow(row=3, dimension="disk_thickness", may_change=False),
        "torque": LeverRow(row=4, dimension="torque", may_change=True, step=10.0),
        "disk_inner_radius": LeverRow(row=5, dimension="disk_inner_radius", step=1e-4, cost_per_step=0.25),
        "cylinder_length": LeverRow(row=6, dimension="cylinder_length", lowest=0.17),
        "material": LeverRow(row=7, dimension="material", may_change=False),
    }
    found = nominal(case, "B3-160 case 3", rows)
    assert {name for name, _ in found} == {"torque", "cylinder_length", "wall_thickness", "disk_inner_radius"}
    assert ("wall_thickness", "disk_thickness") not in found
    torque = found["torque", None]
    assert torque["drawing_value"] == 700.0
    assert 700 < torque["to_value"] < 710
    hub = found["disk_inner_radius", None]
    assert (hub["drawing_value"], hub["relative_cost"]) == (45.9, 14.75)
    length = found["cylinder_length", None]
    assert (length["possible"], length["in_range"], length["rank"]) == ("yes", "no", None)
    assert "below the lowest value of Levers, 170 mm" in length["range_note"]
    assert not [one for one in levers(case, rows) if one["what"] == "material"]


@pytest.mark.slow
def test_what_cannot_be_done_says_why(study):
    """Case 5 is far over its limit: no disk alone saves it, and the reason names the best that was tried."""
    found = nominal(only(study, "B3-160 case 5"), "B3-160 case 5")
    disk = found["disk_thickness", None]
    assert (disk["possible"], disk["to_value"], disk["drawing_value"], disk["rank"]) == ("no", None, None, None)
    assert disk["reason"].startswith("even at 30 mm, the greatest value tried, ")
    assert disk["reason"].endswith(" are still over the limit")


@pytest.mark.slow
def test_a_stiffer_material_is_a_lever(submitted):
    """A titanium cup that a steel one would keep within its limit is told so, the heavier mass with it."""
    row = {
        "variant": "cup",
        "material": "Ti-6Al-4V",
        "torque_Nm": 800.0,
        "cylinder_length_mm": 160.0,
        "mean_radius_mm": 80.0,
        "wall_thickness_mm": 1.6,
        "disk_inner_radius_mm": 40.0,
        "tolerance_class": "grades",
        "backlash_limit_arcmin": 4.2,
    }
    found = [one for one in levers(submitted([row])) if one["what"] == "material"]
    steel = next(one for one in found if one["to_material"] == "20Cr2Ni4")
    assert (steel["possible"], steel["in_range"]) == ("yes", "yes")
    assert steel["mass_change_percent"] == pytest.approx(100 * (7850 / 4430 - 1))
    plates = [young / (1 - poisson**2) for young, poisson in ((211, 0.30), (110, 0.34))]
    assert steel["bending_stress_change_percent"] == pytest.approx(100 * (plates[0] / plates[1] - 1))
    alone = submitted([row | {"material": "20Cr2Ni4"}]).results
    assert alone["probability_over_limit"].item() == steel["probability_over_limit_after"]
    assert len(found) == 12


def test_no_limit_no_levers(submitted):
    """A variant without a limit has no row, and the table keeps its columns."""
    rows = [{key: value for key, value in row.items() if key != "backlash_limit_arcmin"} for row in drawn_rows(2, 1)]
    outcome = submitted(rows)
    table = levers_of(outcome.computed, outcome.settings, {})
    assert table.height == 0
    assert table.columns == [column.key for column in LEVERS_TABLE]
