"""Exit code, counts and words agree: where an error stands, the code is never 0."""

import pytest
from finding_examples import SUBMISSIONS

from flexlash.pipeline import check

VARIANTS = [
    ["Variant", "Material", "Torque T [N·m]", "Cylinder length l [mm]", "Mean radius r_m [mm]", "Wall thickness Δ [mm]",
     "Disk inner radius r_ci [mm]", "Tolerance class"],
    ["A", "steel", 800, 160, 80, 1.6, 40, "fine"],
]  # fmt: skip
MATERIALS = [["Material", "Shear modulus G [GPa]"], ["steel", 80]]
TOLERANCES = [["Tolerance class", "Dimension", "Grade"], ["fine", "wall_thickness", "IT7"]]


def _told(outcome):
    """Return errors and warnings, but that the class of these tables leaves dimensions exact."""
    return [(found.code, found.place) for found in outcome.findings if found.level != "info" and found.code != "W438"]


@pytest.mark.parametrize("row", [["brass", None], ["brass", "81 GPa"], ["brass", -1], ["steels", "#N/A"]])
def test_an_unused_material(book, row):
    """A faulty material that no variant uses stops no row, but the exit code tells it; used, it stops its rows."""
    outcome = check(book({"Variants": VARIANTS, "Materials": [*MATERIALS, row], "Tolerances": TOLERANCES}))
    assert all(code[0] == "E" for code, _ in _told(outcome))
    assert (outcome.counts["computed"], outcome.exit_code) == (1, 3)
    used = [VARIANTS[0], [*VARIANTS[1][:1], row[0], *VARIANTS[1][2:]]]
    outcome = check(book({"Variants": used, "Materials": [*MATERIALS, row], "Tolerances": TOLERANCES}))
    assert outcome.exit_code == 4


def test_a_merged_setting_stops_everything(book, tmp_path):
    """A setting hidden under merged cells is not replaced by its default."""
    import openpyxl

    path = book({"Variants": VARIANTS, "Materials": MATERIALS, "Tolerances": TOLERANCES,
                 "Settings": [["Setting", "Value"], ["seed", 3], ["samples", 64]]})  # fmt: skip
    loaded = openpyxl.load_workbook(path)
    loaded["Settings"].merge_cells("B2:B3")
    loaded.save(tmp_path / "merged.xlsx")
    outcome = check(tmp_path / "merged.xlsx")
    assert [code for code, _ in _told(outcome)] == ["E214"]
    assert outcome.exit_code == 4


def test_every_error_is_told_by_the_exit_code(tmp_path):
    """Of all submissions that have the findings of the catalogue, none with an error ends as if all were well."""
    offenders = []
    for number, (name, made) in enumerate(SUBMISSIONS.items()):
        folder = tmp_path / str(number)
        folder.mkdir()
        path, options = made(folder)
        outcome = check(path, **{key: value for key, value in options.items() if key != "elasticity"})
        if outcome.counts["errors"] and outcome.exit_code not in {3, 4}:
            offenders.append(name)
    assert offenders == []
