"""Rows of Variants with other values in some cells are checked as if they had been submitted so."""

from __future__ import annotations

import pytest
from swept import sweep_row

from flexlash.pipeline import check
from flexlash.validation.replaced_rows import Replacement, with_replacements
from flexlash.validation.swept_variants import swept_variants

HEADER = "variant,flexspline_type,material,torque_Nm,cylinder_length_mm,mean_radius_mm,bore_diameter_mm"
HEADER += ",wall_thickness_mm,disk_inner_radius_mm"
ROWS = (
    "by radius,cup,20Cr2Ni4,800,160,80,,1.6,40",
    "by bore,cup,20Cr2Ni4,800,160,,160,1.6,40",
    "tube,cylinder,20Cr2Ni4,800,160,80,,1.6,",
    "faulty,cup,20Cr2Ni4,-800,160,80,,1.6,40",
)


@pytest.fixture(scope="module")
def validated(tmp_path_factory):
    """Return four validated variants, the last one with an error."""
    path = tmp_path_factory.mktemp("rows") / "rows.csv"
    path.write_text("\n".join([HEADER, *ROWS]), encoding="utf-8")
    return check(path).validated


def test_findings_are_those_of_the_rows(validated):
    """A hub outside the disk is found in its row alone; the submission's own findings are not repeated."""
    replacements = [Replacement(row=2, values={"disk_inner_radius_mm": value}) for value in (30.0, 90.0, 50.0)]
    found = with_replacements(validated, replacements)
    assert [(one.code, one.row) for one in found.findings if one.level == "error"] == [("E303", 3)]
    assert found.variants.rows == [2, 4]
    assert found.table.frame["disk_inner_radius_mm"].to_list() == [30.0, 90.0, 50.0]
    assert found.table.frame["variant"].unique().to_list() == ["by radius"]
    assert any(one.code == "E207" for one in validated.findings)


def test_a_column_that_the_table_lacks_can_be_replaced(validated):
    """A dimension without a column gets one, so that its bounds are checked as well."""
    replacements = [Replacement(row=2, values={"disk_thickness_mm": value}) for value in (2.0, -1.0)]
    found = with_replacements(validated, replacements)
    assert [(one.code, one.row, one.column) for one in found.findings if one.level == "error"] == [
        ("E207", 3, "disk_thickness_mm")
    ]


def test_two_replacements_of_different_cells(validated):
    """Rows keep what is not replaced in them, whatever is replaced in others."""
    found = with_replacements(
        validated,
        [Replacement(row=2, values={"torque_Nm": 900.0}), Replacement(row=3, values={"wall_thickness_mm": 2.0})],
    )
    columns = ["variant", "torque_Nm", "wall_thickness_mm", "mean_radius_mm", "bore_diameter_mm"]
    assert found.table.frame.select(columns).rows() == [
        ("by radius", 900.0, 1.6, 80.0, None),
        ("by bore", 800.0, 2.0, None, 160.0),
    ]


def test_which_variants_a_sweep_is_about(validated):
    """Those that can have the dimension and have no error; of the others the reason is known."""
    bores = swept_variants(validated, sweep_row(None, ("bore_diameter_mm", (150, 170, 10))))
    assert bores.variants == [(3, "by bore")]
    assert sorted(bores.refused) == ["by radius", "tube"]
    assert bores.faulty == ["faulty"]
    disks = swept_variants(validated, sweep_row("TUBE", ("disk_thickness_mm", (1, 2, 1))))
    assert not disks.variants
    assert disks.refused == {"tube": "a cylinder has no disk thickness"}
