"""Which columns unknown headers may mean: what is missing first, letters next, and nothing by chance."""

import pytest

from flexlash.pipeline import check
from flexlash.reading.raw import RawSheet
from flexlash.schema.columns import columns_of
from flexlash.validation.headers import find_headings
from flexlash.validation.ledger import Ledger

NEEDED = {
    "variant": "Variant",
    "material": "Material",
    "torque_Nm": "Torque T [N·m]",
    "cylinder_length_mm": "Cylinder length l [mm]",
    "mean_radius_mm": "Mean radius r_m [mm]",
    "wall_thickness_mm": "Wall thickness Δ [mm]",
    "disk_inner_radius_mm": "Disk inner radius r_ci [mm]",
}


def _found(headers):
    ledger = Ledger("a.xlsx")
    rows = {1: dict(enumerate(headers, start=1)), 2: dict.fromkeys(range(1, len(headers) + 1), 1.0)}
    find_headings(RawSheet(name="Variants", rows=rows), "Variants", ledger)
    return [(found.code, found.cell, found.suggestion) for found in ledger.findings]


@pytest.mark.parametrize(
    ("key", "header"),
    [
        ("torque_Nm", "Torgue"),
        ("torque_Nm", "Drehmoment [Nm]"),
        ("torque_Nm", "Coppia"),
        ("cylinder_length_mm", "Lenght"),
        ("cylinder_length_mm", "Length [mm]"),
        ("cylinder_length_mm", "Länge"),
        ("mean_radius_mm", "Radius"),
        ("mean_radius_mm", "Radius [mm]"),
        ("mean_radius_mm", "Rayon moyen [mm]"),
        ("wall_thickness_mm", "Wall [mm]"),
        ("wall_thickness_mm", "Thickness"),
        ("wall_thickness_mm", "Wandstärke (mm)"),
        ("material", "Werkstoff"),
        ("material", "Materials"),
        ("disk_inner_radius_mm", "Innenradius [mm]"),
        ("disk_inner_radius_mm", "Inner radius"),
    ],
)
def test_a_missing_column_is_asked_for_at_its_header(key, header):
    """Where a needed column is missing, a header that can mean it is one error there, with the right header."""
    headers = [header if one == key else label for one, label in NEEDED.items()]
    cell = f"{'ABCDEFG'[list(NEEDED).index(key)]}1"
    assert _found(headers) == [("E112", cell, columns_of("Variants")[key].label)]


def test_its_unit_is_kept():
    """A unit that fits stays in the header that is suggested."""
    headers = [*list(NEEDED.values())[:4], "Radius [in]", *list(NEEDED.values())[5:]]
    assert _found(headers) == [("E112", "E1", "Mean radius r_m [in]")]


@pytest.mark.parametrize(
    ("header", "expected"),
    [
        ("Thickness", ("E112", "H1", "Tooth rim thickness [mm] or Disk thickness [mm]")),
        ("Rim lenght [mm]", ("E112", "H1", "Tooth rim length [mm]")),
        ("Radius", ("I502", "H1", "")),
        ("Werkstoff", ("I502", "H1", "")),
        ("Wall", ("I502", "H1", "")),
        ("Name", ("I502", "H1", "")),
    ],
)
def test_where_nothing_is_missing(header, expected):
    """Beside all needed columns a header passes through unless its letters are near; of two as near, both are named."""
    assert _found([*NEEDED.values(), header]) == [expected]


def test_a_nearer_optional_column_goes_first():
    """A misspelt optional header is not taken for a required column that is missing; that one is told as missing."""
    headers = [label for key, label in NEEDED.items() if key != "wall_thickness_mm"]
    assert _found([*headers, "Rim thicknes [mm]"]) == [("E112", "G1", "Tooth rim thickness [mm]"), ("E111", "H1", "")]


def test_one_header_for_one_column():
    """Of two headers that may mean the missing column the nearer one is asked about, whatever their order."""
    headers = [label for key, label in NEEDED.items() if key != "wall_thickness_mm"]
    for pair in (["Walls", "Wall thicknes"], ["Wall thicknes", "Walls"]):
        errors = [one for one in _found([*headers, *pair]) if one[0] == "E112"]
        assert [one[1] for one in errors] == ["HG"[pair.index("Wall thicknes") == 0] + "1"]


def test_no_row_is_blamed_for_the_header(table, sound):
    """A radius column under another header is one finding; the rows do not lack a radius each."""
    radius = sound.pop("mean_radius_mm")
    rows = [{**sound, "variant": f"V{number}", "Radius": radius} for number in range(3)]
    outcome = check(table(rows))
    assert [found.code for found in outcome.findings if found.level == "error"] == ["E112"]
    assert outcome.counts["computed"] == 0
