"""Columns that the template does not have: what looks like a tolerance, a figure of a process or a diameter is told."""

import pytest

from flexlash.pipeline import check
from flexlash.reading.raw import RawSheet
from flexlash.schema.header_names import name_and_unit
from flexlash.validation.headers import find_headings
from flexlash.validation.ledger import Ledger
from flexlash.validation.other_headers import radius_of_diameter, tolerance_columns

NEEDED = (
    "Variant", "Material", "Torque T [N·m]", "Cylinder length l [mm]", "Mean radius r_m [mm]", "Wall thickness Δ [mm]",
    "Disk inner radius r_ci [mm]",
)  # fmt: skip


def _found(*headers, schema="Variants", filled=True):
    """Return codes and suggestions of the findings at the headers of a sheet with one row below."""
    rows = {1: dict(enumerate(headers, start=1))}
    if filled:
        rows[2] = dict.fromkeys(rows[1], 1.0)
    ledger = Ledger("a.xlsx")
    heading = find_headings(RawSheet(name=schema, rows=rows), schema, ledger)
    return heading, [(found.code, found.suggestion) for found in ledger.findings if found.code != "I503"]


@pytest.mark.parametrize(
    "header",
    [
        "wall_thickness_tolerance", "Wall thickness tol", "Wall tol. [mm]", "± wall [mm]", "+/- [mm]",
        "Wanddickentoleranz", "Tolérance", "oberes Abmaß", "Abmass", "Abweichung", "Streuung", "Deviation", "dev", "IT",
        "IT grade", "Mean", "mean value", "Average", "Wall thickness mean", "Mittelwert", "sd", "s [mm]", "std. dev.",
        "Standard deviation", "Stdev wall", "Sigma", "σ [mm]", "Cp", "cpk", "Cpk wall", "Ppk", "Cmk",
    ],
)  # fmt: skip
def test_what_looks_like_a_tolerance_takes_no_part(header):
    """On Variants a column that looks like a tolerance or a figure of a process is a warning, by its own name."""
    assert _found(*NEEDED, header)[1] == [("W434", "")]


@pytest.mark.parametrize("header", ["Mean", "Variance", "Ppk", "Tolerance note"])
def test_on_tolerances_too(header):
    """Tolerances takes some figures of a process; another one is a warning."""
    heading, found = _found("Tolerance class", "Dimension", "Grade", header, schema="Tolerances")
    assert found == [("W434", "")]
    assert heading.extra == {4: header}


@pytest.mark.parametrize(
    "header",
    [
        "Description", "Specification", "Mean temperature [°C]", "Std size", "Cp [J/kgK]", "Sigma [MPa]", "Customer",
        "Item", "Device", "Max torque [N·m]", "Status", "Steps", "Comparison", "Capacity", "Media", "Datum", "Meaning",
    ],
)  # fmt: skip
def test_what_does_not(header):
    """Words that hold such letters, or figures of another quantity, pass through with an info."""
    assert _found(*NEEDED, header)[1] == [("I502", "")]


def test_a_pair_of_limits():
    """Least and greatest of one dimension are limits; one alone, or a pair of something else, is the author's own."""
    names = ("Wall min [mm]", "Wall max [mm]", "Max torque [N·m]", "Min speed", "Max speed")
    split = {place: name_and_unit(name) for place, name in enumerate(names)}
    assert tolerance_columns(split) == {0: "a limit", 1: "a limit"}


def test_an_empty_column_is_no_matter():
    """A column without values takes nothing away."""
    assert _found(*NEEDED, "Cpk", filled=False)[1] == [("I502", "")]


@pytest.mark.parametrize("header", ["Toleranzklasse", "Tolerence class", "Tolerance clas"])
def test_a_tolerance_class_is_none_of_these(header):
    """A header that means the class is asked about, not called a tolerance."""
    assert _found(*NEEDED, header)[1] == [("E112", "Tolerance class")]


@pytest.mark.parametrize(
    ("header", "key"),
    [
        ("Mean diameter", "mean_radius_mm"), ("Mean dia.", "mean_radius_mm"), ("Mean Ø", "mean_radius_mm"),
        ("Outer diameter", "mean_radius_mm"), ("OD", "mean_radius_mm"), ("Diameter", "mean_radius_mm"),
        ("mittlerer Durchmesser", "mean_radius_mm"), ("Außendurchmesser", "mean_radius_mm"),
        ("Diamètre moyen", "mean_radius_mm"), ("Hub diameter", "disk_inner_radius_mm"),
        ("Nabendurchmesser", "disk_inner_radius_mm"), ("Dia. of hub", "disk_inner_radius_mm"),
        ("Disk inner diameter", "disk_inner_radius_mm"), ("Disk outer diameter", "disk_outer_radius_mm"),
        ("Bolt circle diameter", "disk_outer_radius_mm"), ("Inner diameter", "bore_diameter_mm"),
        ("Innendurchmesser", "bore_diameter_mm"), ("Wave generator diameter", None), ("Shaft diameter", None),
        ("Hub fillet diameter", None), ("Mean radius", None), ("ID", None), ("Grid", None),
    ],
)  # fmt: skip
def test_which_column_a_diameter_belongs_in(header, key):
    """A diameter is known by its words and belongs in the column of its half, the bore in its own."""
    assert radius_of_diameter(header, ()) == key


@pytest.mark.parametrize("unit", ["", " [mm]", " [in]"])
def test_diameters_are_one_finding_each(unit):
    """A diameter instead of a radius is told at its header with the column and unit that it belongs in; no row more."""
    headers = [*NEEDED[:4], f"Mean diameter{unit}", NEEDED[5], f"Hub diameter{unit}"]
    heading, found = _found(*headers)
    assert [code for code, _ in found] == ["E128", "E128"]
    assert heading.doubtful == {5: "mean_radius_mm", 7: "disk_inner_radius_mm"}
    assert heading.diameters == {5, 7}


def test_no_row_lacks_a_radius_beside_a_diameter(table, sound):
    """The rows wait for the header; none of them is told to lack a radius."""
    row = {key: value for key, value in sound.items() if key not in {"mean_radius_mm", "disk_inner_radius_mm"}}
    outcome = check(table([{**row, "Mean diameter": 160.0, "Hub diameter [in]": 3.0}]))
    errors = [found for found in outcome.findings if found.level == "error"]
    assert [found.code for found in errors] == ["E128", "E128"]
    assert "half" in errors[0].fix
    assert "Bore diameter" in errors[0].fix
    assert "Disk inner radius r_ci [in]" in errors[1].fix
    assert (outcome.counts["computed"], outcome.exit_code) == (0, 4)


def test_a_diameter_beside_the_radius_passes_through():
    """Who enters the radius may note the diameter beside it; of the bore that is true as well."""
    assert _found(*NEEDED, "Outer diameter [mm]", "Hub diameter")[1] == [("I502", "")] * 2
    assert _found(*NEEDED, "Inner diameter [mm]")[1] == [("I502", "")]


@pytest.mark.parametrize(
    "header",
    [
        "Hub radius [mm]",
        "hub r",
        "Hub rad.",
        "r_hub",
        "Inner radius of disk",
        "Nabenradius",
        "Clamping radius",
        "Inner r",
    ],
)
def test_the_hub_radius_is_the_disks(header):
    """The radius of the hub is the disk's inner radius, not that of a fillet."""
    assert _found(*NEEDED[:6], header)[1] == [("E112", "Disk inner radius r_ci [mm]")]


@pytest.mark.parametrize(
    ("place", "headers", "suggestion"),
    [
        (2, ("Load", "Output torque", "Peak torque", "Drehmoment"), "Torque T [N·m]"),
        (3, ("Depth", "Inside depth", "Cup length", "Height", "L"), "Cylinder length l [mm]"),
        (4, ("R [mm]", "Mean R", "Mid radius", "Cylinder radius", "Neutral radius"), "Mean radius r_m [mm]"),
        (4, ("Bore", "Bore dia [mm]", "Innendurchmesser", "Inside diameter"), "Bore diameter [mm]"),
        (5, ("Wall", "Wall thk", "Shell thickness", "s [mm]", "Wandstärke"), "Wall thickness Δ [mm]"),
    ],
)
def test_other_words_of_engineers(place, headers, suggestion):
    """Where a needed column is missing, the words that engineers use for it are asked about."""
    for header in headers:
        _, found = _found(*NEEDED[:place], header, *NEEDED[place + 1 :])
        assert found == [("E112", suggestion)], header


@pytest.mark.parametrize(
    ("header", "code"),
    [("Rim lenght [mm]", "W435"), ("Wall thickness Δ [furlong]", "E113"), ("Rim length [furlong]", "W435")],
)
def test_nothing_is_lost_in_an_empty_column(header, code):
    """A header that cannot be taken is an error over values, and a warning over none unless its column is needed."""
    headers = [*NEEDED[:5], header] if header.startswith("Wall") else [*NEEDED[:6], header]
    heading, found = _found(*headers, filled=False)
    assert found[-1][0] == code
    assert _found(*headers)[1][-1][0] in {"E112", "E113"}
    assert heading.doubtful


@pytest.mark.slow
def test_an_empty_second_column_is_passed_over(table, sound):
    """A column twice is an error when both hold values; an empty second one is not read."""
    outcome = check(table([{**sound, "Wall thickness [mm]": ""}]))
    assert [found.code for found in outcome.findings if found.level != "info"] == ["W436"]
    assert (outcome.counts["computed"], outcome.exit_code) == (1, 0)
    outcome = check(table([{**sound, "Wall thickness [mm]": 1.5}]))
    assert [found.code for found in outcome.findings if found.level == "error"] == ["E114"]


def test_headers_of_many_characters_are_no_names():
    """What no name can be is not compared: brackets are found by looking, a text over 200 characters is no name."""
    for header in ("\n" * 30_000 + "x", "(" * 30_000, "Wall [" + "mm" * 200 + "]", "[" * 198 + "x]"):
        assert name_and_unit(header)[0][:1] in {"\n", "(", "W", ""}, header[:9]
    headers = [f"a{'b' * 30_000}{number}" for number in range(30)]
    _, found = _found(*NEEDED, *headers)
    assert found == [("I502", "")] * 30
