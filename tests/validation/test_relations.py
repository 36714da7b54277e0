"""What the cells of a row must be to one another: each rule broken, each rule just kept, and when it is silent."""

import pytest

from flexlash.reading.raw import RawSheet
from flexlash.schema.columns import columns_of
from flexlash.schema.part_rules import PART_RULES
from flexlash.validation.ledger import Ledger
from flexlash.validation.relations import RELATIONS
from flexlash.validation.row_checks import check_relations
from flexlash.validation.typed_columns import tabulate

CUP = {
    "variant": "A",
    "flexspline_type": "cup",
    "material": "20Cr2Ni4",
    "torque_Nm": 800,
    "cylinder_length_mm": 160,
    "mean_radius_mm": 80,
    "wall_thickness_mm": 1.6,
    "disk_inner_radius_mm": 40,
}
HAT = CUP | {"flexspline_type": "hat", "disk_inner_radius_mm": None, "disk_outer_radius_mm": 120}
TUBE = CUP | {"flexspline_type": "cylinder", "disk_inner_radius_mm": None}
BORE = CUP | {"mean_radius_mm": None, "bore_diameter_mm": 158.4}
RIM = CUP | {"rim_length_mm": 25, "rim_thickness_mm": 3.2}
SHORT = CUP | {"cylinder_length_mm": 30}
SHORT_RIM = SHORT | {"rim_length_mm": 10, "rim_thickness_mm": 3.2}
POWER = CUP | {"disk_hub_thickness_mm": 4, "disk_thickness_exponent": 2}
CONE = CUP | {"disk_cone_angle_deg": 60}
KEYS = list(columns_of("Variants"))


def _found(row):
    """Return code, column and finding of the relations that a row of the template breaks."""
    cells = {KEYS.index(key) + 1: value for key, value in row.items() if value is not None}
    ledger = Ledger("a.xlsx")
    raw = RawSheet(name="Variants", rows={1: dict(enumerate(KEYS, start=1)), 2: cells})
    table = tabulate(raw, "Variants", ledger)
    own = len(ledger.findings)
    check_relations(table, ledger)
    return {(found.code, found.column): found for found in ledger.findings[own:]}


@pytest.mark.parametrize(
    "row",
    [CUP, HAT, TUBE, BORE, RIM, POWER, CONE, {key: value for key, value in CUP.items() if key != "flexspline_type"}],
    ids=["cup", "hat", "cylinder", "bore", "rim", "power-law disk", "cone", "blank type"],
)
def test_sound_rows_break_nothing(row):
    """A sound cup, hat, cylinder, cup with bore, rim, power law or cone, and a blank type, a cup, break no rule."""
    assert _found(row) == {}


BROKEN = [
    ("E301", "mean_radius_mm", CUP | {"mean_radius_mm": None}),
    ("E302", "mean_radius_mm", CUP | {"bore_diameter_mm": 158.4}),
    ("E310", "disk_thickness_mm", TUBE | {"disk_thickness_mm": 1.6}),
    ("E310", "disk_inner_radius_mm", TUBE | {"disk_inner_radius_mm": 40}),
    ("E310", "disk_outer_radius_mm", TUBE | {"disk_outer_radius_mm": 80}),
    ("E310", "disk_hub_thickness_mm", TUBE | {"disk_hub_thickness_mm": 2}),
    ("E310", "disk_thickness_exponent", TUBE | {"disk_thickness_exponent": 2}),
    ("E310", "disk_cone_angle_deg", TUBE | {"disk_cone_angle_deg": 90}),
    ("E310", "hub_fillet_radius_mm", TUBE | {"hub_fillet_radius_mm": 1}),
    ("E310", "junction_fillet_radius_mm", TUBE | {"junction_fillet_radius_mm": 1}),
    ("E310", "disk_hub_thickness_mm", HAT | {"disk_hub_thickness_mm": 2}),
    ("E310", "disk_thickness_exponent", HAT | {"disk_thickness_exponent": 0.5}),
    ("E310", "hub_fillet_radius_mm", HAT | {"hub_fillet_radius_mm": 1}),
    ("E310", "junction_fillet_radius_mm", HAT | {"junction_fillet_radius_mm": 1}),
    ("E311", "disk_inner_radius_mm", CUP | {"disk_inner_radius_mm": None}),
    ("E311", "disk_inner_radius_mm", CUP | {"disk_inner_radius_mm": None, "flexspline_type": None}),
    ("E311", "disk_outer_radius_mm", HAT | {"disk_outer_radius_mm": None}),
    ("E303", "disk_inner_radius_mm", CUP | {"disk_inner_radius_mm": 90}),
    ("E303", "disk_inner_radius_mm", CUP | {"disk_inner_radius_mm": 80}),
    ("E303", "disk_inner_radius_mm", BORE | {"disk_inner_radius_mm": 80}),
    ("E303", "disk_inner_radius_mm", CUP | {"disk_inner_radius_mm": 80, "disk_outer_radius_mm": 80}),
    ("E303", "disk_inner_radius_mm", HAT | {"disk_outer_radius_mm": 80}),
    ("E303", "disk_inner_radius_mm", HAT | {"disk_outer_radius_mm": 100, "disk_inner_radius_mm": 100}),
    ("E330", "wall_thickness_mm", CUP | {"wall_thickness_mm": 450}),
    ("E330", "wall_thickness_mm", CUP | {"wall_thickness_mm": 160}),
    ("E330", "wall_thickness_mm", TUBE | {"wall_thickness_mm": 160}),
    ("E330", "wall_thickness_mm", HAT | {"wall_thickness_mm": 200}),
    ("E304", "rim_thickness_mm", CUP | {"rim_length_mm": 25}),
    ("E304", "rim_length_mm", CUP | {"rim_thickness_mm": 3.2}),
    ("E305", "rim_length_mm", RIM | {"rim_length_mm": 180}),
    ("E305", "rim_length_mm", RIM | {"rim_length_mm": 160}),
    ("E306", "rim_thickness_mm", RIM | {"rim_thickness_mm": 1.5999}),
    ("E312", "hub_fillet_radius_mm", CUP | {"hub_fillet_radius_mm": 40.001}),
    ("E312", "hub_fillet_radius_mm", BORE | {"hub_fillet_radius_mm": 40.001}),
    ("E312", "hub_fillet_radius_mm", CUP | {"hub_fillet_radius_mm": 41, "disk_outer_radius_mm": 80}),
    ("E313", "junction_fillet_radius_mm", SHORT | {"junction_fillet_radius_mm": 30.001}),
    ("E313", "junction_fillet_radius_mm", SHORT_RIM | {"junction_fillet_radius_mm": 20.001}),
    ("E360", "tooth_face_width_mm", CUP | {"tooth_face_width_mm": 160.001}),
    ("E360", "tooth_face_width_mm", HAT | {"tooth_face_width_mm": 200}),
    ("E360", "tooth_face_width_mm", TUBE | {"tooth_face_width_mm": 161}),
    ("E360", "tooth_face_width_mm", SHORT_RIM | {"junction_fillet_radius_mm": 10, "tooth_face_width_mm": 20.001}),
    ("E325", "disk_hub_thickness_mm", CUP | {"disk_thickness_exponent": 2}),
    ("E325", "disk_hub_thickness_mm", CUP | {"disk_thickness_exponent": 0, "flexspline_type": None}),
    ("E325", "disk_hub_thickness_mm", CUP | {"disk_thickness_exponent": 2, "disk_thickness_mm": 1.6}),
    ("E326", "disk_thickness_mm", POWER | {"disk_thickness_mm": 1.6}),
    ("E326", "disk_thickness_mm", POWER | {"disk_thickness_mm": 1.6, "disk_thickness_exponent": 0}),
    ("E327", "hub_fillet_radius_mm", CONE | {"hub_fillet_radius_mm": 1}),
    ("E327", "junction_fillet_radius_mm", CONE | {"junction_fillet_radius_mm": 1}),
    ("E327", "junction_fillet_radius_mm", CONE | {"junction_fillet_radius_mm": 1, "disk_cone_angle_deg": 89.999}),
    ("E328", "junction_fillet_radius_mm", CUP | {"junction_fillet_radius_mm": 79.201}),
    ("E328", "junction_fillet_radius_mm", BORE | {"junction_fillet_radius_mm": 79.201}),
    ("W416", "junction_fillet_radius_mm", CUP | {"junction_fillet_radius_mm": 39.201}),
    ("W416", "junction_fillet_radius_mm", BORE | {"junction_fillet_radius_mm": 39.201}),
    (
        "W416",
        "junction_fillet_radius_mm",
        CUP | {"junction_fillet_radius_mm": 20, "hub_fillet_radius_mm": 19.201},
    ),
    ("W401", "disk_outer_radius_mm", CUP | {"disk_outer_radius_mm": 80.001}),
    ("W401", "disk_outer_radius_mm", BORE | {"disk_outer_radius_mm": 79}),
    ("W401", "disk_inner_radius_mm", HAT | {"disk_inner_radius_mm": 80.801}),
    ("W401", "disk_inner_radius_mm", HAT | {"disk_inner_radius_mm": 79.199}),
    ("W419", "disk_inner_radius_mm", CUP | {"disk_inner_radius_mm": 55.441}),
    ("W419", "disk_inner_radius_mm", BORE | {"disk_inner_radius_mm": 55.441}),
    ("W419", "disk_inner_radius_mm", CUP | {"disk_inner_radius_mm": 79.1}),
    ("W418", "wall_thickness_mm", CUP | {"wall_thickness_mm": 0.959}),
    ("W418", "wall_thickness_mm", CUP | {"wall_thickness_mm": 3.201}),
    ("W418", "wall_thickness_mm", CUP | {"wall_thickness_mm": 8}),
    ("W418", "wall_thickness_mm", BORE | {"wall_thickness_mm": 0.955}),
    ("W418", "wall_thickness_mm", HAT | {"wall_thickness_mm": 3.201}),
    ("W418", "wall_thickness_mm", TUBE | {"wall_thickness_mm": 0.959}),
    ("W403", "wall_thickness_mm", CUP | {"wall_thickness_mm": 16.001}),
    ("I506", "wall_thickness_mm", CUP | {"wall_thickness_mm": 8.001}),
    ("I506", "wall_thickness_mm", CUP | {"wall_thickness_mm": 16}),
]
KEPT = [
    ("E301", CUP),
    ("E301", BORE),
    ("E302", BORE),
    ("E310", TUBE | {"hub_fillet_radius_mm": 0, "junction_fillet_radius_mm": 0}),
    ("E310", HAT | {"hub_fillet_radius_mm": 0, "junction_fillet_radius_mm": 0}),
    ("E310", HAT | {"disk_thickness_mm": 3, "disk_inner_radius_mm": 82}),
    ("E310", CUP | {"disk_hub_thickness_mm": 2, "hub_fillet_radius_mm": 1, "junction_fillet_radius_mm": 1}),
    ("E310", TUBE | {"rim_length_mm": 25, "rim_thickness_mm": 3.2}),
    ("E311", HAT),
    ("E311", TUBE),
    ("E303", CUP | {"disk_inner_radius_mm": 79.999}),
    ("E303", HAT | {"disk_outer_radius_mm": 80.001}),
    ("E303", HAT | {"disk_outer_radius_mm": 100, "disk_inner_radius_mm": 99.999}),
    ("E330", CUP | {"wall_thickness_mm": 79}),
    ("E330", BORE | {"wall_thickness_mm": 450}),
    ("E330", TUBE | {"wall_thickness_mm": 159.999}),
    ("E304", RIM),
    ("E305", RIM | {"rim_length_mm": 159.999}),
    ("E306", RIM | {"rim_thickness_mm": 1.6}),
    ("E312", CUP | {"hub_fillet_radius_mm": 40}),
    ("E312", CUP | {"hub_fillet_radius_mm": 0}),
    ("E312", CUP | {"hub_fillet_radius_mm": 5}),
    ("E313", SHORT | {"junction_fillet_radius_mm": 30}),
    ("E313", SHORT_RIM | {"junction_fillet_radius_mm": 20}),
    ("E313", SHORT_RIM | {"junction_fillet_radius_mm": 0}),
    ("E360", CUP | {"tooth_face_width_mm": 160}),
    ("E360", RIM | {"tooth_face_width_mm": 20}),
    ("E360", SHORT_RIM | {"junction_fillet_radius_mm": 10, "tooth_face_width_mm": 20}),
    ("E325", POWER),
    ("E325", CUP | {"disk_hub_thickness_mm": 4}),
    ("E325", HAT | {"disk_thickness_exponent": 2}),
    ("E326", POWER),
    ("E326", CUP | {"disk_hub_thickness_mm": 4, "disk_thickness_mm": 1.6}),
    ("E327", CONE | {"hub_fillet_radius_mm": 0, "junction_fillet_radius_mm": 0}),
    ("E327", CONE | {"disk_cone_angle_deg": 90, "hub_fillet_radius_mm": 1, "junction_fillet_radius_mm": 1}),
    ("E327", CUP | {"hub_fillet_radius_mm": 1, "junction_fillet_radius_mm": 1}),
    ("E328", CUP | {"junction_fillet_radius_mm": 79.2}),
    ("E328", BORE | {"junction_fillet_radius_mm": 79.2}),
    ("E328", CUP | {"junction_fillet_radius_mm": 0}),
    ("W416", CUP | {"junction_fillet_radius_mm": 39.2}),
    ("W416", BORE | {"junction_fillet_radius_mm": 39.2}),
    ("W416", CUP | {"junction_fillet_radius_mm": 20, "hub_fillet_radius_mm": 19.2}),
    ("W416", CUP | {"junction_fillet_radius_mm": 0, "hub_fillet_radius_mm": 40}),
    ("W416", CUP | {"hub_fillet_radius_mm": 40}),
    ("W401", CUP | {"disk_outer_radius_mm": 80}),
    ("W401", BORE | {"disk_outer_radius_mm": 80}),
    ("W401", HAT),
    ("W401", HAT | {"disk_inner_radius_mm": 80.8}),
    ("W401", HAT | {"disk_inner_radius_mm": 79.2}),
    ("W419", CUP | {"disk_inner_radius_mm": 55.44}),
    ("W419", BORE | {"disk_inner_radius_mm": 55.44}),
    ("W419", CUP | {"disk_inner_radius_mm": 80}),
    ("W419", CUP | {"disk_inner_radius_mm": 60, "disk_outer_radius_mm": 60}),
    ("W419", HAT | {"disk_inner_radius_mm": 80}),
    ("W418", CUP | {"wall_thickness_mm": 0.96}),
    ("W418", CUP | {"wall_thickness_mm": 3.2}),
    ("W418", BORE | {"wall_thickness_mm": 0.957}),
    ("W418", HAT | {"wall_thickness_mm": 3.2}),
    ("W418", TUBE | {"wall_thickness_mm": 0.96}),
    ("W418", CUP | {"wall_thickness_mm": 8.001}),
    ("W418", CUP | {"wall_thickness_mm": 20}),
    ("W403", CUP | {"wall_thickness_mm": 16}),
    ("I506", CUP | {"wall_thickness_mm": 8}),
    ("I506", CUP | {"wall_thickness_mm": 16.001}),
]


@pytest.mark.parametrize(("code", "key", "row"), BROKEN)
def test_a_broken_rule_is_told_once_at_its_cell(code, key, row):
    """A row that breaks one rule has one finding, at the cell that is to blame."""
    found = _found(row)
    assert list(found) == [(code, key)]
    (one,) = found.values()
    assert one.place == f"Variants!{chr(65 + KEYS.index(key))}2"
    assert one.level == {"E": "error", "W": "warning", "I": "info"}[code[0]]


@pytest.mark.parametrize(("code", "row"), KEPT)
def test_a_row_at_the_edge_breaks_nothing(code, row):
    """A row that lies exactly at the edge of a rule, on the good side, is not blamed by it."""
    assert code not in {found for found, _ in _found(row)}


def test_every_rule_is_tried():
    """Each rule has a row that breaks it and a row that keeps it."""
    rules = {(rule.code, rule.key) for rule in PART_RULES}
    assert {(code, key) for code, key, _ in BROKEN} == rules
    assert {code for code, _ in KEPT} == {rule.code for rule in PART_RULES}


@pytest.mark.parametrize(
    ("row", "words"),
    [
        (CUP | {"bore_diameter_mm": 158.4}, "Mean radius r_m = 80 and Bore diameter = 158.4 are both given"),
        (CUP | {"disk_inner_radius_mm": 90}, "= 90 mm: less than the disk's outer radius 80 mm is required"),
        (BORE | {"disk_inner_radius_mm": 90}, "= 90 mm: less than the disk's outer radius 80 mm is required"),
        (HAT | {"disk_outer_radius_mm": 70}, "= 80 mm: less than the disk's outer radius 70 mm is required"),
        (RIM | {"rim_length_mm": 180}, "= 180 mm: less than the cylinder length 160 mm is required"),
        (RIM | {"rim_thickness_mm": 1.2}, "= 1.2 mm: at least the wall thickness 1.6 mm is required"),
        (
            CUP | {"junction_fillet_radius_mm": 4, "tooth_face_width_mm": 158},
            "= 158 mm: at most 156 mm is required, the cylinder length without the junction fillet",
        ),
        (CUP | {"hub_fillet_radius_mm": 45}, "= 45 mm: at most the width of the disk, 40 mm, is required"),
        (
            SHORT_RIM | {"junction_fillet_radius_mm": 25},
            "= 25 mm: with the tooth rim it exceeds the cylinder length 30 mm",
        ),
        (TUBE | {"disk_cone_angle_deg": 60}, "= 60: a cylinder has no such dimension"),
        (HAT | {"disk_thickness_exponent": 2}, "= 2: a hat has no such dimension"),
        (CUP | {"disk_thickness_exponent": 2}, "is empty; a disk with a thickness exponent requires it"),
        (
            POWER | {"disk_thickness_mm": 1.6},
            "= 1.6 mm: the exponent 2 gives the thickness at every radius already",
        ),
        (CONE | {"hub_fillet_radius_mm": 2}, "= 2 mm: a disk at 60° to the axis takes no fillet"),
        (CONE | {"junction_fillet_radius_mm": 3}, "= 3 mm: a disk at 60° to the axis takes no fillet"),
        (CUP | {"junction_fillet_radius_mm": 90}, "= 90 mm: at most the radius of the bore, 79.2 mm, is required"),
        (BORE | {"junction_fillet_radius_mm": 90}, "= 90 mm: at most the radius of the bore, 79.2 mm, is required"),
        (
            CUP | {"junction_fillet_radius_mm": 30, "hub_fillet_radius_mm": 10},
            "= 30 mm: fillets take more than the 39.2 mm of disk between hub and bore",
        ),
        (CUP | {"wall_thickness_mm": 450}, "= 450 mm: less than twice the mean radius, 160 mm, is required"),
        (TUBE | {"disk_thickness_mm": 2}, "= 2: a cylinder has no such dimension"),
        (HAT | {"hub_fillet_radius_mm": 2}, "= 2: a hat has no such dimension"),
        (CUP | {"disk_inner_radius_mm": None}, "is empty; a cup requires it"),
        (HAT | {"disk_outer_radius_mm": None}, "is empty; a hat requires it"),
        (CUP | {"disk_outer_radius_mm": 85}, "= 85 mm differs from the mean radius 80 mm"),
        (CUP | {"wall_thickness_mm": 0.8}, "= 0.8 mm is 0.005 of the mean diameter 160 mm"),
        (CUP | {"disk_inner_radius_mm": 60}, "= 60 mm exceeds 0.7 of the bore radius 79.2 mm"),
        (CUP | {"wall_thickness_mm": 20}, "0.25 times the mean radius"),
        (BORE | {"wall_thickness_mm": 10}, "0.12 times the mean radius"),
    ],
)
def test_the_message_names_both_sides(row, words):
    """A message names what was entered and what it collides with."""
    (found,) = _found(row).values()
    assert words in found.message


@pytest.mark.slow
@pytest.mark.parametrize("name", RELATIONS)
def test_a_bad_cell_silences_the_rules_that_look_at_it(name):
    """A cell that has its own error causes no second finding by any rule that looks at it."""
    relation = RELATIONS[name]
    blamed = relation.rule.code, relation.rule.key
    row = next(row for code, key, row in BROKEN if (code, key) == blamed)
    for key in relation.keys:
        assert blamed not in _found(row | {key: "1,6"}), key


def test_a_bad_cell_leaves_other_rules_alone():
    """A bad cell does not hide what other cells of the row break."""
    assert list(_found(RIM | {"disk_inner_radius_mm": "x", "rim_length_mm": 200})) == [("E305", "rim_length_mm")]


def test_several_rules_at_once():
    """All rules that a row breaks are told together."""
    row = CUP | {"mean_radius_mm": None, "disk_inner_radius_mm": None, "rim_length_mm": 25}
    assert set(_found(row)) == {
        ("E301", "mean_radius_mm"),
        ("E311", "disk_inner_radius_mm"),
        ("E304", "rim_thickness_mm"),
    }


def test_a_follow_up_is_not_told_as_well():
    """A rim longer than the cylinder does not also collide with the fillet, nor a hub outside the disk with its own."""
    for length in (160, 180):
        row = RIM | {"rim_length_mm": length, "junction_fillet_radius_mm": 3}
        assert list(_found(row)) == [("E305", "rim_length_mm")]
    for radius in (80, 90):
        row = CUP | {"disk_inner_radius_mm": radius, "hub_fillet_radius_mm": 3}
        assert list(_found(row)) == [("E303", "disk_inner_radius_mm")]


@pytest.mark.slow
def test_overlapping_fillets_are_not_told_where_one_alone_is_too_wide():
    """A fillet wider than disk or bore, or a hub as wide as the disk, is not also told as fillets that overlap."""
    hub = CUP | {"hub_fillet_radius_mm": 45, "junction_fillet_radius_mm": 3}
    assert list(_found(hub)) == [("E312", "hub_fillet_radius_mm")]
    junction = CUP | {"hub_fillet_radius_mm": 3, "junction_fillet_radius_mm": 90}
    assert list(_found(junction)) == [("E328", "junction_fillet_radius_mm")]
    for radius in (80, 90):
        row = CUP | {"disk_inner_radius_mm": radius, "junction_fillet_radius_mm": 3}
        assert list(_found(row)) == [("E303", "disk_inner_radius_mm")]


def test_both_fillets_on_a_cone_are_told():
    """A cone with two fillets has a finding at each of them; a hat's cone, which has none by its type, has neither."""
    row = CONE | {"hub_fillet_radius_mm": 1, "junction_fillet_radius_mm": 1}
    assert set(_found(row)) == {("E327", "hub_fillet_radius_mm"), ("E327", "junction_fillet_radius_mm")}
    hat = HAT | {"disk_cone_angle_deg": 60, "hub_fillet_radius_mm": 1}
    assert list(_found(hat)) == [("E310", "hub_fillet_radius_mm")]


@pytest.mark.parametrize(
    "row",
    [
        CUP
        | {"cylinder_length_mm": 0.3, "rim_length_mm": 0.2, "rim_thickness_mm": 1.6, "junction_fillet_radius_mm": 0.1},
        CUP | {"mean_radius_mm": 80.3, "disk_inner_radius_mm": 40.2, "hub_fillet_radius_mm": 40.1},
        CUP | {"mean_radius_mm": 40.3, "wall_thickness_mm": 1.2, "junction_fillet_radius_mm": 39.7},
    ],
    ids=["0.1 + 0.2 > 0.3", "80.3 - 40.2 < 40.1", "40.3 - 0.6 < 39.7"],
)
def test_the_edge_in_decimals(row):
    """What lies exactly at an edge as typed in decimals is not blamed for the computer's binary rounding."""
    assert {code for code, _ in _found(row)} & {"E312", "E313", "E328"} == set()


def test_the_edge_of_overlapping_fillets_in_decimals():
    """Fillets that touch as typed in decimals are not blamed for the computer's binary rounding."""
    row = CUP | {"mean_radius_mm": 80.3, "disk_inner_radius_mm": 20.1}
    row |= {"hub_fillet_radius_mm": 1.7, "junction_fillet_radius_mm": 57.7}
    assert 57.7 + 1.7 > 80.3 - 0.8 - 20.1
    assert _found(row) == {}
