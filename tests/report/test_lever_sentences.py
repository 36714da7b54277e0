"""What the Summary says of single changes: the three questions of who decides, answered from the table of levers."""

from __future__ import annotations

import polars as pl
import pytest
from told_levers import CASE_1, CASE_3, NOMINAL_OVER, lever, levers_table, study_levers

from flexlash.report.wording.lever_sentences import CHANGE, LENGTH, RELAX, cheapest_lines
from flexlash.report.wording.sentences import sentences

_HUB = ("disk_inner_radius", "", (40, 45.8406, 46, 320, -1.4, 65.0, 0, 12, 1))


@pytest.fixture
def told(study):
    """Return a function that gives the sentences of the study with other levers by topic."""
    return lambda levers: dict(sentences(study[0], levers))


def test_the_three_questions_are_answered(told):
    """The cheapest change of the failing case 3, what case 1 may be relaxed to, and its length still allowed."""
    said = told(study_levers())
    assert said[CHANGE].startswith(
        "Cheapest single change for “B3-160 case 3”: hub radius 40 → 46 mm; 99.97 % of units are then within 3.8′, "
        "the disk stress falls from 86 to 65 MPa, the mass by 1.4 %."
    )
    assert said[RELAX] == (
        "Holding the wall and disk thickness of “B3-160 case 1” so tight buys nothing: ± 29 µm instead of ± 2.5 µm "
        "still keeps 99.865 % within 3.8′; 99.6 % of the spread comes from the material."
    )
    assert said[LENGTH] == "Cylinder length may grow from 160 to 161.5 mm in “B3-160 case 1”."


def test_what_no_tolerance_can_do_is_said(told):
    """Case 3 is over its limit in the middle of its tolerances: tightening is named as what cannot help."""
    assert told(study_levers())[CHANGE].endswith(
        "Tighter tolerances cannot bring it within, not even all of them at once: half of its units or more are over "
        "the limit."
    )


def test_side_effects_for_the_worse_are_told(told):
    """A thicker wall weighs more and is bent harder; a stress that stays is not told, a note to mind is."""
    wall = lever("wall_thickness", "", (1.6, 1.9766, 1.98, 910, 20.7, 86.174, 23.75, 38, 1), range_note="it is thick")
    said = told(levers_table(wall))[CHANGE]
    assert "; 99.91 % of units are then within 3.8′, the mass rises by 20.7 %, the bending stress by 23.8 %." in said
    assert said.count("stress") == 1
    assert " Note: it is thick." in said


def test_a_stress_that_may_be_elsewhere_is_the_greatest(told):
    """Where the stress left in the disk is no more than that of the wall, no section is named."""
    said = told(levers_table(lever("disk_inner_radius", "", (40, 75, 76, 320, -1.4, 21.0, 0, 12, 1))))[CHANGE]
    assert "the greatest stress falls from 86 to 21 MPa" in said


def test_a_change_out_of_range_is_no_advice(told):
    """Where only a change out of range would do, this is said with what it leaves, and no change is called cheapest."""
    row = lever(*_HUB) | {"in_range": "no", "rank": None, "range_note": "it is above the highest 44 mm of Levers"}
    said = told(levers_table(row))[CHANGE]
    assert said.startswith(
        "No single change can bring “B3-160 case 3” within 3.8′ and stay in range: hub radius 40 → 46 mm would, but "
        "it is above the highest 44 mm of Levers."
    )
    assert "Cheapest" not in said


def test_where_nothing_can_the_reason_is_told(told):
    """One reason for all dimensions is told as it is; of several the sheet has each."""
    cannot = {"possible": "no", "rank": None, "drawing_value": None, "in_range": None}
    rows = [lever(*_HUB) | cannot | {"reason": "even 79.5 mm leaves all units over"}]
    assert told(levers_table(*rows))[CHANGE].startswith(
        "No single change can bring “B3-160 case 3” within 3.8′: even 79.5 mm leaves all units over."
    )
    rows.append(lever("mean_radius", "", (80, 0, 0, 0)) | cannot | {"reason": "another"})
    assert "half of its units being over 4.214′; Levers says why." in told(levers_table(*rows))[CHANGE]


def test_another_material_is_told_beside_the_present_one(told):
    """Where a material is the cheapest change, both are named."""
    row = lever("material", "", (0, 0, 0, 320, 1.0, 86, 2.4, 1, 1)) | {"what": "material", "to_material": "17-4PH"}
    said = told(levers_table(row | dict.fromkeys(("from_value", "to_value", "drawing_value"))))[CHANGE]
    assert said.startswith("Cheapest single change for “B3-160 case 3”: material 20Cr2Ni4 → 17-4PH; 99.97 % of units")


def test_all_tolerances_together_are_told_beside_the_one_that_matters_most(told):
    """Of the variant nearest to its limit the tolerance that matters most is told, then how wide all may be."""
    both = [
        lever(name, moves, (1, wide, wide, 900, 0, 86, 0, cost), variant=CASE_1, direction="relax", what="tolerance",
              unit=unit)
        for name, moves, wide, cost, unit in (
            ("all", "mean_radius+wall_thickness+cylinder_length", 11.76, -21, "×"),
            ("mean_radius", "", 3, -13, "mm"),
            ("wall_thickness", "", 2, -5, "mm"),
        )
    ]  # fmt: skip
    said = told(levers_table(*both))[RELAX]
    assert said.startswith("Holding the wall thickness of “B3-160 case 1” so tight buys nothing: ± 2 mm instead of ± 1")
    assert said.endswith(" All 3 of its tolerances together may be 11.76 times as wide.")


def test_a_tolerance_that_matters_may_be_relaxed_but_does_not_buy_nothing(told):
    """A dimension with a visible share of the variance is told as one that may have more, not as idle."""
    row = lever("youngs_modulus", "", (2.0, 3.1, 3.0, 900, 0, 86, 0, -1), variant=CASE_1, direction="relax",
                what="tolerance", unit="GPa")  # fmt: skip
    said = told(levers_table(row))[RELAX]
    assert said.startswith("The Young's modulus of “B3-160 case 1” may be ± 3 GPa instead of ± 2 GPa: that still keeps")


def test_nothing_is_said_without_a_lever(told):
    """An empty table of levers has no sentence."""
    assert not {CHANGE, RELAX, LENGTH} & told(study_levers().clear()).keys()


def test_many_failing_variants_are_told_in_part(study, told):
    """Of many failing variants the worst three are told, a line each, with how many more the sheet has."""
    names = study[0].results["variant"].to_list()
    rows = [lever(*_HUB) | {"variant": name} for name in names]
    said = told(levers_table(*rows))[CHANGE]
    first, *others, _, last = said.split("\n")
    assert first.startswith(f"Cheapest single change for “{names[0]}”: ")
    assert [line.split(": ")[0] for line in others] == [f"For “{name}”" for name in names[1:3]]
    assert last == f"{len(names) - 3} more on Levers."


def test_the_screen_names_the_cheapest_change():
    """The closing lines name variant and change; one without a change is told as that."""
    assert list(cheapest_lines(study_levers())) == [f"  Cheapest single change for {CASE_3}: hub radius 40 → 46 mm."]
    stuck = study_levers().filter(pl.col("reason") == NOMINAL_OVER)
    assert list(cheapest_lines(stuck)) == [f"  Cheapest single change for {CASE_3}: none, see sheet Levers."]
