"""The Inputs sheet: what was entered comes back in printed units, to the last digit."""

from __future__ import annotations

import pytest

from flexlash.pipeline import check
from flexlash.report.trace.inputs import ENTERED, PROGRAM, stored_inputs
from flexlash.schema.columns import DIMENSIONS


def _row(path, **options):
    outcome = check(path, **options)
    (row,) = stored_inputs(list(outcome.computed.values()), outcome.settings.lost_motion_percent).rows
    return row


ENTRIES = {
    "torque_Nm": 812.7, "cylinder_length_mm": 159.3, "bore_diameter_mm": 160.1, "wall_thickness_mm": 1.7,
    "disk_thickness_mm": 1.9, "disk_inner_radius_mm": 40.3, "disk_outer_radius_mm": 81.1,
    "disk_hub_thickness_mm": 2.3, "hub_fillet_radius_mm": 3.3, "junction_fillet_radius_mm": 2.9,
    "rim_length_mm": 20.7, "rim_thickness_mm": 3.1, "rated_torque_Nm": 701.3, "backlash_limit_arcmin": 3.7,
}  # fmt: skip


def test_entries_come_back_as_entered(table, sound):
    """A number that was entered in printed units stands there with the digits that were typed; a blank stays blank."""
    row = _row(table([{**sound, "mean_radius_mm": "", **ENTRIES}]))
    by_key = {column.key: row[column.label] for column in ENTERED.values()}
    assert {key: by_key[key] for key in ENTRIES} == ENTRIES
    assert {by_key[key] for key in ("mean_radius_mm", "disk_thickness_exponent", "disk_cone_angle_deg")} == {None}
    assert by_key["youngs_modulus_GPa"] == 211
    assert by_key["poisson_ratio"] == 0.3
    assert by_key["shear_modulus_GPa"] is None
    assert by_key["yield_MPa"] == 1080
    assert (by_key["cylinder_calibration"], by_key["disk_calibration"], by_key["lost_motion_percent"]) == (1, 1, 4)


@pytest.mark.parametrize("size", [1.6, 0.1 + 0.2, 100 / 63, 1.6000000000000003])
def test_no_digit_is_lost(table, sound, size):
    """Taken to SI again, a stored number is within half a unit of the last place of what the program computed with."""
    row = _row(table([{**sound, "wall_thickness_mm": size}]))
    assert row["Wall thickness Δ [mm]"] * 1e-3 == pytest.approx(size * 1e-3, rel=2.3e-16, abs=0)


def test_a_given_shear_modulus_keeps_the_other_constants(table, sound, tmp_path):
    """A material that gives G and E, ν too has all three, since buckling asks for E and ν."""
    materials = tmp_path / "materials.csv"
    materials.write_text(
        "material,youngs_modulus_GPa,poisson_ratio,shear_modulus_GPa\n20Cr2Ni4,206,0.29,80\n", encoding="utf-8"
    )
    row = _row(table([sound]), materials=materials)
    constants = [row[DIMENSIONS[name].label] for name in ("youngs_modulus", "poisson_ratio", "shear_modulus")]
    assert constants == [206, 0.29, 80]
    assert row["Yield strength [MPa]"] is None


def test_the_program_stands_beside_in_printed_units(table, sound):
    """What the program found has a heading with its unit; what a variant does not have is blank."""
    outcome = check(table([{**sound, "flexspline_type": "cylinder", "disk_inner_radius_mm": ""}]))
    (one,) = outcome.computed.values()
    (row,) = stored_inputs([one], 4.0).rows
    assert row["Backlash, program [rad]"] == one.nominal.backlash
    assert row["Wall shear, program [MPa]"] == one.nominal.wall_shear / 1e6
    assert row["Governing section, program"] == "wall"
    assert {row[PROGRAM[key][0]] for key in ("hub_shear", "disk_windup", "rim_windup", "lost_motion")} == {None}
