"""A tooth face width in a submission: it scatters, causes spread, meets its cylinder's end, and is told by name."""

from __future__ import annotations

import math

import polars as pl
import pytest

from flexlash.mechanics.flexspline import backlash
from flexlash.pipeline import check, run
from flexlash.schema.units import ARCMIN

CUP = {
    "variant": "face", "material": "20Cr2Ni4", "torque_Nm": 60.0, "cylinder_length_mm": 25.0, "mean_radius_mm": 25.0,
    "wall_thickness_mm": 0.55, "disk_thickness_mm": 0.8, "disk_inner_radius_mm": 13.0, "rim_length_mm": 10.0,
    "rim_thickness_mm": 1.1, "tooth_face_width_mm": 9.0, "tolerance_class": "shop",
}  # fmt: skip
SIZES = {
    "torque": 60.0, "cylinder_length": 0.025, "mean_radius": 0.025, "wall_thickness": 0.55e-3, "disk_thickness": 0.8e-3,
    "disk_inner_radius": 0.013, "rim_length": 0.01, "rim_thickness": 1.1e-3, "youngs_modulus": 211e9,
    "poisson_ratio": 0.3,
}  # fmt: skip


@pytest.fixture
def submitted(tmp_path):
    """Return a function that writes a cup and the rows of its class, and gives the paths as options take them."""

    def made(*rows, **change):
        path, tolerances = tmp_path / "cup.csv", tmp_path / "tolerances.csv"
        pl.DataFrame([{**CUP, **change}]).write_csv(path)
        head = "tolerance_class,dimension,lower_deviation,upper_deviation,distribution"
        tolerances.write_text("\n".join([head, *(f"shop,{row}" for row in rows)]), encoding="utf-8")
        return path, {"tolerances": tolerances}

    return made


def nominal(face):
    """Return the backlash [arcmin] of the cup with a tooth face of so many metres."""
    return float(backlash("cup", SIZES | {"tooth_face_width": face})) / ARCMIN


def test_a_face_width_alone_causes_all_spread(submitted):
    """Uniform limits of ± 0.5 mm give the standard deviation of the slope, and every percentile is that of a width."""
    path, options = submitted("tooth_face_width,-0.5,0.5,uniform")
    row = run(path, **options).results.row(0, named=True)
    assert row["main_contributor"] == "tooth_face_width"
    assert row["main_contributor_share"] == pytest.approx(1, abs=1e-9)
    assert row["p2_5_arcmin"] == pytest.approx(nominal(0.0085 + 0.975e-3), rel=1e-7)
    assert row["p97_5_arcmin"] == pytest.approx(nominal(0.0085 + 0.025e-3), rel=1e-7)
    slope = (nominal(0.0091) - nominal(0.0089)) / 0.2
    assert row["first_order_sd_arcmin"] == pytest.approx(abs(slope) / math.sqrt(12), rel=1e-6)
    low, high = row["worst_case_low_arcmin"], row["worst_case_high_arcmin"]
    assert (low, high) == pytest.approx((nominal(0.0095), nominal(0.0085)), rel=1e-12)


def test_limits_beyond_the_cylinder_are_told(submitted):
    """A face that some units would have longer than the cylinder is warned of; the entered one fits."""
    path, options = submitted("tooth_face_width,-0.5,0.5,uniform", tooth_face_width_mm=24.8)
    found = [(one.code, one.column) for one in check(path, **options).findings if one.code != "W438"]
    assert found == [("W409", "tooth_face_width_mm")]
    path, options = submitted("cylinder_length,-0.5,0.5,uniform", tooth_face_width_mm=24.8)
    assert "W409" in {one.code for one in check(path, **options).findings}
    path, options = submitted("tooth_face_width,-0.1,0.1,uniform", tooth_face_width_mm=24.8)
    assert "W409" not in {one.code for one in check(path, **options).findings}


def test_requirements_of_the_wave_generator_have_no_tolerance(submitted):
    """Bearing width, engaged teeth and deflection are exact: a row of Tolerances for one of them is an error."""
    for name in ("bearing_width", "engaged_teeth_percent", "radial_deflection"):
        path, options = submitted(f"{name},-0.1,0.1,uniform")
        assert ("E209", "dimension") in {(one.code, one.column) for one in check(path, **options).findings}


@pytest.mark.parametrize(("header", "width"), [("Tooth face width [cm]", 0.9), ("tooth_face_width_mm", 9.0)])
def test_units_of_a_face_width(tmp_path, header, width):
    """A face width is read in the unit of its header."""
    row = {key: value for key, value in CUP.items() if key not in ("tooth_face_width_mm", "tolerance_class")}
    path = tmp_path / "cup.csv"
    pl.DataFrame([{**row, header: width}]).write_csv(path)
    assert run(path).results["backlash_arcmin"][0] == pytest.approx(nominal(0.009), rel=1e-12)
