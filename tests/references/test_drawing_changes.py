"""Single changes of the published study, by the command line alone: case 3 misses 3.8′, case 1 meets it.

The numbers were worked out apart from flexlash: roots of the share over the limit in one dimension, the mass of wall
and disk, the shear stress T/(2π r² t).
"""

from __future__ import annotations

import math
import shutil
import sys

import numpy as np
import polars as pl
import pytest
import regenerate
from filled import filled
from numpy.polynomial.hermite_e import hermegauss
from numpy.polynomial.legendre import leggauss
from scipy.special import ndtr

from flexlash.cli import main
from flexlash.feedback.template.template_workbook import study
from flexlash.pipeline import run

STUDY = regenerate.ROOT / "data" / "b3-160-study.xlsx"
CASES = {row["variant"]: row for row in study().variants}
CASE_1, CASE_3 = CASES["B3-160 case 1"], CASES["B3-160 case 3"]
GRINDING = tuple(study().tolerances)

CHANGES = {
    ("disk_inner_radius", None): (45.42, 45.84, 46, 320, -1.4, 65),
    ("cylinder_length", None): (164.1, 161.9, 161.5, 769, -16.7, 86),
    ("wall_thickness", "disk_thickness"): (1.802, 1.817, 1.82, 566, 13.75, 76),
    ("disk_thickness", None): (2.283, 2.3455, 2.35, 1052, 6.1, 59),
    ("wall_thickness", None): (1.950, 1.977, 1.98, 910, 20.7, 86),
    ("mean_radius", "disk_outer_radius"): (86.48, 86.96, 87, 1032, 10.8, 86),
}
"""Of case 3, by dimension and what moves with it: the value for 97.5 % and for 99.865 %, as drawn, ppm, mass %, MPa."""

DIGITS = {45.42: 2, 164.1: 1, 1.802: 3, 2.283: 3, 1.950: 3, 86.48: 2}


@pytest.fixture
def called(tmp_path, monkeypatch):
    """Return a function that calls a command on a submission and returns the table that it writes."""
    monkeypatch.chdir(tmp_path)

    def table(data, *arguments):
        submission = tmp_path / "study.xlsx"
        if data is None:
            shutil.copy(STUDY, submission)
        else:
            submission.write_bytes(data)
        out = tmp_path / "out.parquet"
        out.unlink(missing_ok=True)
        monkeypatch.setattr(sys, "argv", ["flexlash", *arguments, "-o", str(out)])
        with pytest.raises(SystemExit):
            main()
        return pl.read_parquet(out)

    return table


@pytest.fixture
def changes(called):
    """Return a function that gives the changes of a variant of the study at a target, by dimension and what moves."""

    def of(variant, **settings):
        data = None
        if settings:
            data = filled(list(CASES.values()), tolerances=GRINDING, settings=settings)
        rows = called(data, "levers", "study.xlsx").filter(pl.col("variant") == variant)
        return list(rows.iter_rows(named=True))

    return of


def over_limit_ppm(wall_micrometres):
    """Return the ppm of case 1 over 3.8′ with the wall at ± so many µm: Gauss quadrature over all but the modulus.

    E alone is normal with 2/3 % and 2U goes as 1/E, so that the share over the limit is one normal tail for each node.
    """
    nodes, weights = hermegauss(12)
    weights = weights / weights.sum()
    ratios, shares = leggauss(12)
    scales = {"wall": wall_micrometres * 1e-6, "radius": 2.5e-6, "hub": 2.5e-6, "length": 50e-6}
    middle = {"wall": 1.6e-3, "radius": 80e-3, "hub": 40e-3, "length": 160e-3}
    sizes = [middle[name] + half / 3 * nodes for name, half in scales.items()]
    wall, radius, hub, length = np.meshgrid(*sizes, indexing="ij")
    of_node = np.einsum("i,j,k,l->ijkl", *[weights] * 4)
    meridian = length / (radius**3 * wall) + (1 / hub**2 - 1 / radius**2) / (2 * wall)
    total = 0.0
    for ratio, share in zip(0.3 + 0.01 * ratios, shares / 2, strict=True):
        backlash = 2 * 800 * (1 + ratio) / (math.pi * 211e9) * meridian / (math.pi / 10800)
        total += share * float((of_node * ndtr((backlash / 3.8 - 1) / (0.02 / 3))).sum())
    return 1e6 * total


def of_values(rows, what="nominal"):
    """Return rows by dimension and what moves with it."""
    return {(row["dimension"], row["moves"]): row for row in rows if row["what"] == what}


def test_six_single_changes_of_case_3(changes):
    """Each of the six alone meets 99.865 % at the published value, with the published share, mass and stress."""
    found = of_values(changes("B3-160 case 3"))
    for key, (at_97_5, exact, drawn, ppm, mass, stress) in CHANGES.items():
        row, digits = found[key], DIGITS[at_97_5]
        assert round(row["to_value"], digits) == pytest.approx(exact, abs=0.51 * 10**-digits), key
        assert row["drawing_value"] == drawn, key
        assert row["ppm_after"] == pytest.approx(ppm, rel=3e-3), key
        assert round(row["mass_change_percent"], 1) == pytest.approx(mass, abs=0.051), key
        assert round(row["von_mises_MPa_after"]) == stress, key
        assert (row["direction"], row["possible"], row["in_range"]) == ("meet", "yes", "yes"), key
    assert found["disk_inner_radius", None]["rank"] == min(row["rank"] for row in found.values() if row["rank"])


def test_a_target_of_97_5_percent_is_met_earlier(changes):
    """With target_percent 97.5 the same changes are smaller, as published."""
    found = of_values(changes("B3-160 case 3", target_percent=97.5))
    for key, (at_97_5, *_) in CHANGES.items():
        digits = DIGITS[at_97_5]
        assert found[key]["to_value"] == pytest.approx(at_97_5, abs=0.51 * 10**-digits), key


def test_no_tolerance_alone_brings_case_3_within(changes):
    """Its nominal backlash is over the limit: every tolerance says that it cannot, and no modulus has a row."""
    rows = [row for row in changes("B3-160 case 3") if row["what"] == "tolerance"]
    assert {row["dimension"] for row in rows} >= {
        "wall_thickness",
        "disk_inner_radius",
        "mean_radius",
        "cylinder_length",
    }
    assert not {row["dimension"] for row in rows} & {"youngs_modulus", "poisson_ratio", "shear_modulus", "torque"}
    assert {row["possible"] for row in rows} == {"no"}
    assert all(row["reason"] and row["to_value"] is None and row["drawing_value"] is None for row in rows)


def test_the_wall_of_case_1_need_not_be_ground(changes, workbook):
    """It may go from ± 2.5 to ± 29 µm, which keeps 1,239 ppm; ± 30 µm has 1,416; half of it gains nothing."""
    row = of_values(changes("B3-160 case 1"), "tolerance")["wall_thickness", "disk_thickness"]
    assert (row["direction"], row["possible"], row["unit"]) == ("relax", "yes", "mm")
    assert row["from_value"] == pytest.approx(0.0025, rel=1e-9)
    assert 0.029 <= row["to_value"] < 0.030
    assert row["drawing_value"] == 0.029
    assert row["ppm_after"] == pytest.approx(over_limit_ppm(29.0), rel=1e-6)
    others = [one for one in GRINDING if one["tolerance_class"] == "grinding" and one["dimension"] != "wall_thickness"]
    classes = {f"wall {half}": half for half in (1.25, 29.0, 30.0)}
    tolerances = [one | {"tolerance_class": name} for name in classes for one in others] + [
        {"tolerance_class": name, "dimension": "wall_thickness", "deviation_unit": "µm"}
        | {"lower_deviation": -half, "upper_deviation": half}
        for name, half in classes.items()
    ]
    variants = [CASE_1 | {"variant": name, "tolerance_class": name} for name in classes]
    results = run(workbook(variants, tolerances=tolerances)).results
    ppm = dict(zip(results["variant"], results["ppm_over_limit"], strict=True))
    # As told to the last digits: 1.6 mm - 29 µm rounds otherwise than the middle of the limits less half their width.
    assert ppm["wall 29.0"] == pytest.approx(row["ppm_after"], rel=1e-9)
    assert ppm["wall 30.0"] == pytest.approx(over_limit_ppm(30.0), rel=1e-6)
    assert ppm["wall 1.25"] == pytest.approx(over_limit_ppm(1.25), rel=1e-6)
    p99_865 = dict(zip(results["variant"], results["p99_865_arcmin"], strict=True))
    assert p99_865["wall 29.0"] == pytest.approx(3.7990, abs=5e-5)


def test_the_drawn_values_fed_back_are_what_was_told(changes, workbook):
    """Each of case 3's changes as a submission of its own has the very share over the limit that the table tells."""
    found = of_values(changes("B3-160 case 3"))
    asked = {
        "r_ci": ({"disk_inner_radius_mm": 46.0}, ("disk_inner_radius", None)),
        "l": ({"cylinder_length_mm": 161.5}, ("cylinder_length", None)),
        "both": ({"wall_thickness_mm": 1.82}, ("wall_thickness", "disk_thickness")),
        "r_m": ({"mean_radius_mm": 87.0}, ("mean_radius", "disk_outer_radius")),
    }
    variants = [CASE_3 | change | {"variant": name} for name, (change, _) in asked.items()]
    results = run(workbook(variants, tolerances=GRINDING)).results
    shares = dict(zip(results["variant"], results["probability_over_limit"], strict=True))
    for name, (_, key) in asked.items():
        assert shares[name] == found[key]["probability_over_limit_after"], name


def test_lengths_of_case_3(called):
    """Lengths of 100 to 200 mm gives the published backlash at each step."""
    table = called(None, "sweep", "study.xlsx", "--variant", "B3-160 case 3", "--vary", "cylinder_length_mm=100:200:20")
    assert table["cylinder_length_mm"].to_list() == [100, 120, 140, 160, 180, 200]
    expected = [2.897, 3.160, 3.424, 3.687, 3.950, 4.214]
    assert [round(value, 3) for value in table["backlash_arcmin"]] == expected


SOURCES = (
    {
        "source": "tooth clearance",
        "enter_as": "mm at radius",
        "value_arcmin": 0.01,
        "radius_mm": 80.0,
        "lower_deviation": -0.01,
        "upper_deviation": 0.01,
    },
    {
        "source": "output bearing",
        "enter_as": "mm radial play",
        "value_arcmin": 0.0025,
        "radius_mm": 80.0,
        "pressure_angle_deg": 20.0,
        "lower_deviation": -0.0025,
        "upper_deviation": 0.0025,
    },
    {
        "source": "Oldham coupling",
        "value_arcmin": 10.0,
        "lower_deviation": -10.0,
        "upper_deviation": 10.0,
        "side": "input",
        "ratio": 100.0,
    },
)


def test_the_whole_drive_of_case_3(workbook):
    """Clearance, bearing, coupling and wind-up: 4.822′ on average, RSS 5.281′, Bender 5.511′, at most 5.531′."""
    path = workbook([CASE_3], tolerances=GRINDING, other_sources=SOURCES)
    row = run(path).results.row(0, named=True)
    told = {"mean": 4.822, "rss_high": 5.281, "bender_high": 5.511, "worst_case_high": 5.531}
    for name, arcmin in told.items():
        assert row[f"system_{name}_arcmin"] == pytest.approx(arcmin, abs=1e-3), name
