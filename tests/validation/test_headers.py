"""The header row: where it is, which column each header means, in which unit, and what is told of the rest."""

import pytest

from flexlash.reading.raw import RawSheet
from flexlash.schema.columns import ENTRY_SHEETS
from flexlash.validation.headers import closest, find_headings, plain
from flexlash.validation.ledger import Ledger

MATES = ["Variant", "Material"]
"""Headers that make a row a header row whatever stands beside them."""


def _headings(headers, schema="Variants", row=1):
    """Return the headings of a header row over a filled one, and the ledger of their findings."""
    ledger = Ledger("a.xlsx")
    cells = {place: header for place, header in enumerate(headers, start=1) if header is not None}
    rows = {row: cells, row + 1: dict.fromkeys(cells, 1.0)}
    return find_headings(RawSheet(name=schema, rows=rows), schema, ledger), ledger


def _beside(header):
    """Return heading, and findings at the third column, of a header beside two known ones."""
    heading, ledger = _headings([*MATES, header])
    return heading, [found for found in ledger.findings if found.cell == "C1" and found.code != "E111"]


@pytest.mark.parametrize("spelling", ["label", "key", "name"])
@pytest.mark.parametrize("schema", ENTRY_SHEETS)
def test_every_column_is_known(schema, spelling):
    """Each column is recognised by its label, its key, and its label without unit."""
    columns = ENTRY_SHEETS[schema]
    heading, ledger = _headings([getattr(column, spelling) for column in columns], schema)
    assert heading.columns == {column.key: place for place, column in enumerate(columns, start=1)}
    assert set(heading.factors.values()) == {1.0}
    assert {found.code for found in ledger.findings} <= {"I503"}
    assert not ledger.everything


@pytest.mark.parametrize(
    "header",
    [
        "Wall thickness Δ [mm]",
        "wall thickness δ [mm]",
        "WALL THICKNESS Δ [MM]",
        "  Wall   thickness  Δ  [ mm ] ",
        "Wall\nthickness Δ\n[mm]",
        "Wall\u00a0thickness Δ [mm]",
        "Wall thickness [mm]",
        "Wall thickness (mm)",
        "Wall-thickness [mm]",
        "wall_thickness_mm",
        "WALL_THICKNESS_MM",
        "wall thickness mm",
        "Ｗall thickness [mm]",
    ],
)
def test_case_spacing_and_brackets_do_not_matter(header):
    """A header is recognised in other case, other spacing, with round brackets or without its symbol, silently."""
    heading, findings = _beside(header)
    assert heading.columns == {"variant": 1, "material": 2, "wall_thickness_mm": 3}
    assert findings == []


def test_order_does_not_matter():
    """Columns are found in whatever order they stand, with gaps."""
    heading, _ = _headings(["Wall thickness [mm]", None, "Material", None, "variant"])
    assert heading.columns == {"wall_thickness_mm": 1, "material": 3, "variant": 5}


@pytest.mark.parametrize(
    ("header", "key", "unit", "factor"),
    [
        ("Wall thickness Δ [m]", "wall_thickness_mm", "m", 1000.0),
        ("Wall thickness Δ [cm]", "wall_thickness_mm", "cm", 10.0),
        ("Wall thickness Δ [µm]", "wall_thickness_mm", "µm", 1e-3),
        ("Wall thickness Δ [um]", "wall_thickness_mm", "um", 1e-3),
        ("Wall thickness Δ [in]", "wall_thickness_mm", "in", 25.4),
        ("Wall thickness Δ [inch]", "wall_thickness_mm", "inch", 25.4),
        ('Wall thickness Δ ["]', "wall_thickness_mm", '"', 25.4),
        ("Wall thickness (mil)", "wall_thickness_mm", "mil", 0.0254),
        ("wall_thickness [in]", "wall_thickness_mm", "in", 25.4),
        ("Torque T [kN·m]", "torque_Nm", "kN·m", 1000.0),
        ("Torque T [kNm]", "torque_Nm", "kNm", 1000.0),
        ("Torque [lbf·in]", "torque_Nm", "lbf·in", 0.1129848290276167),
        ("Torque (in-lb)", "torque_Nm", "in-lb", 0.1129848290276167),
        ("Torque [lbf·ft]", "torque_Nm", "lbf·ft", 1.3558179483314004),
        ("Torque [kgf·m]", "torque_Nm", "kgf·m", 9.80665),
        ("Backlash limit [arcsec]", "backlash_limit_arcmin", "arcsec", 1 / 60),
        ("Backlash limit [mrad]", "backlash_limit_arcmin", "mrad", 3.437746770784939),
        ("Backlash limit [rad]", "backlash_limit_arcmin", "rad", 3437.746770784939),
        ("Backlash limit [°]", "backlash_limit_arcmin", "°", 60.0),
        ("Backlash limit [deg]", "backlash_limit_arcmin", "deg", 60.0),
    ],
)
def test_a_known_unit_is_converted_and_told(header, key, unit, factor):
    """A header in another unit of the same quantity converts its column and says so once."""
    heading, findings = _beside(header)
    assert heading.columns[key] == 3
    assert heading.factors[key] == pytest.approx(factor, rel=1e-14)
    assert [(found.code, found.value, found.column) for found in findings] == [("I501", unit, key)]


@pytest.mark.parametrize(
    ("header", "factor"),
    [
        ("Young's modulus E [MPa]", 1e-3),
        ("Young's modulus E [psi]", 6.894757293168361e-6),
        ("Yield strength [N/mm²]", 1.0),
        ("Density [g/cm³]", 1000.0),
        ("Poisson's ratio ν [%]", 0.01),
    ],
)
def test_units_of_materials(header, factor):
    """Units of Materials are converted alike; one of the same size is told as well."""
    heading, ledger = _headings(["Material", header], "Materials")
    (key,) = set(heading.columns) - {"material"}
    assert heading.factors[key] == pytest.approx(factor, rel=1e-14)
    assert [found.code for found in ledger.findings] == ["I501"]


@pytest.mark.parametrize("header", ["Wall thickness Δ", "Wall thickness", "wall_thickness"])
def test_a_missing_unit_is_assumed_and_told(header):
    """A header without unit takes the template's, and says so."""
    heading, findings = _beside(header)
    assert heading.factors["wall_thickness_mm"] == 1.0
    assert [(found.code, found.value) for found in findings] == [("I503", header)]


@pytest.mark.parametrize(
    ("header", "unit"),
    [
        ("Wall thickness Δ [furlong]", "mm"),
        ("Wall thickness Δ []", "mm"),
        ("Wall thickness Δ [kg]", "mm"),
        ("Wall thickness Δ [%]", "mm"),
        ("Torque T [mm]", "N·m"),
        ("Torque T [mN·m]", "N·m"),
        ("Backlash limit [mm]", "arcmin"),
        ("wall_thickness_mm [furlong]", "mm"),
    ],
)
def test_an_unknown_unit_is_an_error(header, unit):
    """A unit that is unknown, or measures something else, leaves its column unread and names the right one."""
    heading, findings = _beside(header)
    assert set(heading.columns) == set(heading.factors) == {"variant", "material"}
    assert list(heading.doubtful) == [3]
    (found,) = findings
    assert (found.code, found.value) == ("E113", header)
    assert f"in {unit}" in found.message


def test_a_unit_on_a_number_without_one():
    """Deviations take their unit from a column of their own: brackets on their header are an error that says so."""
    heading, ledger = _headings(["Tolerance class", "Dimension", "Lower deviation [mm]"], "Tolerances")
    assert heading.doubtful == {3: "lower_deviation"}
    (found,) = ledger.findings
    assert found.code == "E113"
    assert "Deviation unit" in found.message + found.fix


def test_brackets_on_a_text_do_not_matter():
    """Brackets behind a text column's name are read past."""
    heading, findings = _beside("Notes (internal)")
    assert heading.columns["notes"] == 3
    assert findings == []


@pytest.mark.parametrize(
    ("header", "key", "suggestion"),
    [
        ("Rim lenght [mm]", "rim_length_mm", "Tooth rim length [mm]"),
        ("Tooth rim lenght [mm]", "rim_length_mm", "Tooth rim length [mm]"),
        ("Wal thickness [mm]", "wall_thickness_mm", "Wall thickness Δ [mm]"),
        ("Wall thicknes Δ [mm]", "wall_thickness_mm", "Wall thickness Δ [mm]"),
        ("torqe_Nm", "torque_Nm", "Torque T [N·m]"),
        ("Tolerence class", "tolerance_class", "Tolerance class"),
        ("Hub filet radius [mm]", "hub_fillet_radius_mm", "Hub fillet radius [mm]"),
        ("Rated torqe [N·m]", "rated_torque_Nm", "Rated torque [N·m]"),
        ("Wall thickness Δ [mm", "wall_thickness_mm", "Wall thickness Δ [mm]"),
    ],
)
def test_a_misspelt_header_is_an_error(header, key, suggestion):
    """A header that resembles a known one is never passed over: it is an error with the right header as suggestion."""
    heading, findings = _beside(header)
    assert set(heading.columns) == {"variant", "material"}
    assert heading.doubtful == {3: key}
    (found,) = findings
    assert (found.code, found.column, found.suggestion) == ("E112", key, suggestion)
    assert found.message.endswith(f"; did you mean {suggestion}?")


@pytest.mark.parametrize("header", ["Customer", "Drawing", "Ratio", "Size", "Note to purchasing", "xyz [mm]"])
def test_another_column_passes_through(header):
    """A header that resembles none is carried along and told."""
    heading, findings = _beside(header)
    assert heading.extra == {3: header}
    assert [(found.code, found.value) for found in findings] == [("I502", header)]


@pytest.mark.parametrize("header", ["", " ", "\n", "\u00a0"], ids=ascii)
def test_a_blank_header_is_none(header):
    """A header cell of white space is no header."""
    heading, findings = _beside(header)
    assert (heading.extra, findings) == ({}, [])


def test_a_header_twice():
    """With two columns of one meaning nothing is computed; the second names the first."""
    required = ["Torque T [N·m]", "Cylinder length l [mm]"]
    heading, ledger = _headings([*MATES, "Wall thickness [mm]", *required, "wall_thickness_mm"])
    assert heading.columns["wall_thickness_mm"] == 3
    assert heading.doubtful == {6: "wall_thickness_mm"}
    (found,) = ledger.findings
    assert (found.code, found.cell) == ("E114", "F1")
    assert "column C" in found.message
    assert ledger.everything


@pytest.mark.parametrize("row", range(1, 16))
def test_the_header_row_may_stand_in_rows_1_to_15(row):
    """The header row is found in each of the first fifteen rows, and its findings have its row number."""
    heading, ledger = _headings([*MATES, "Customer"], row=row)
    assert heading.row == row
    assert f"C{row}" in {found.cell for found in ledger.findings}


def test_the_header_row_has_the_most_headers():
    """A title, a row of groups or a row of data that names a column does not pass for the header row."""
    rows = {
        1: {1: "Variant study", 2: "Material"},
        2: {1: "Variant", 3: "Load"},
        5: {1: "Variant", 2: "Material", 3: "Torque T [N·m]"},
        6: {1: "Variant", 2: "Material", 3: 800},
    }
    heading = find_headings(RawSheet(name="Variants", rows=rows), "Variants", Ledger("a.xlsx"))
    assert heading.row == 5


@pytest.mark.parametrize(
    "rows",
    [
        {},
        {16: {1: "Variant", 2: "Material"}},
        {1: {1: "Variant"}},
        {1: {1: "B3-160", 2: "cup", 3: 800}},
        {1: {1: 1.0, 2: True}},
    ],
)
def test_no_header_row(rows):
    """Without two known headers in the first fifteen rows there is no header row, and nothing is computed."""
    ledger = Ledger("a.xlsx")
    assert find_headings(RawSheet(name="Variants", rows=rows), "Variants", ledger) is None
    assert [(found.code, found.place) for found in ledger.findings] == [("E109", "Variants!A1")]
    assert ledger.everything


def test_headers_in_other_words_are_questions_one_by_one():
    """Where no row has headers of the template one in another language is taken, and each header is asked for."""
    rows = {1: {1: "Werkzeug 7"}, 2: {1: "Werkstoff", 2: "Drehmoment", 3: "Wanddicke"}, 3: {1: "Stahl", 2: 800, 3: 1.6}}
    ledger = Ledger("a.xlsx")
    assert find_headings(RawSheet(name="Variants", rows=rows), "Variants", ledger).row == 2
    told = [(found.code, found.cell, found.suggestion) for found in ledger.findings if found.code == "E112"]
    assert told == [
        ("E112", "A2", "Material"),
        ("E112", "B2", "Torque T [N·m]"),
        ("E112", "C2", "Wall thickness Δ [mm]"),
    ]


def test_missing_required_columns():
    """Each required column that is missing is named where it could be added; nothing is computed."""
    heading, ledger = _headings(["Variant", "Material", "Cylinder length l [mm]"])
    found = {found.column: found for found in ledger.findings}
    assert set(found) == {"torque_Nm", "wall_thickness_mm"}
    assert {(one.code, one.cell) for one in found.values()} == {("E111", "D1")}
    assert found["torque_Nm"].fix == "Add the column with this header: Torque T [N·m]."
    assert heading is not None
    assert ledger.everything


def test_a_doubtful_header_is_not_missing_too():
    """A required column whose header is misspelt is told once, not as missing as well."""
    _, ledger = _headings(["Variant", "Material", "Torqe T [N·m]"])
    about = [found.code for found in ledger.findings if found.column == "torque_Nm"]
    assert about == ["E112"]


@pytest.mark.parametrize("header", ["Row status", "row status", " ROW  STATUS "])
def test_the_templates_own_column_is_ignored(header):
    """The template's status column is no data and not told."""
    heading, findings = _beside(header)
    assert heading.ignored == {3}
    assert findings == []


def test_a_header_that_is_no_text_passes_through():
    """A column headed by a number is carried along and told like any other extra column."""
    heading, findings = _beside(2026)
    assert heading.extra == {3: "2026"}
    assert [found.code for found in findings] == ["I502"]


def test_a_typographic_apostrophe():
    """A header with a typographic apostrophe is the same header."""
    heading, _ = _headings(["Material", "Source", "Young’s modulus E [GPa]"], "Materials")
    assert "youngs_modulus_GPa" in heading.columns


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Tolerance class", "toleranceclass"),
        (" Tolerance_Class ", "toleranceclass"),
        ("truncated-normal", "truncatednormal"),
        ("R\u00a0m", "rm"),
        ("μ", "μ"),
        ("µ", "μ"),
        ("STRASSE", "strasse"),
        ("straße", "strasse"),
        ("a\u200bb", "ab"),
    ],
)
def test_plain(text, expected):
    """Case, spaces, underscores and hyphens do not distinguish names."""
    assert plain(text) == expected


@pytest.mark.parametrize(
    ("text", "names", "expected"),
    [
        ("Varaints", ["Materials", "Variants"], "Variants"),
        ("variants ", ["Variants"], "Variants"),
        ("20Cr2Ni5", ["42CrMo4", "20Cr2Ni4"], "20Cr2Ni4"),
        ("x", ["Variants"], ""),
        ("x", [], ""),
        ("", ["Variants"], ""),
    ],
)
def test_closest(text, names, expected):
    """The nearest of several names is suggested, and none where none is near."""
    assert closest(text, names) == expected
