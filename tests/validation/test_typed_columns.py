"""From a raw sheet to typed rows: which rows are data, what each cell becomes, and what a bad header spoils."""

import datetime

import polars as pl
import pytest

from flexlash.reading.delimited import read_table
from flexlash.reading.raw import ErrorCell, RawSheet, Unstored
from flexlash.validation.ledger import Ledger
from flexlash.validation.materials_and_classes import tolerance_classes_of
from flexlash.validation.row_checks import check_cells
from flexlash.validation.typed_columns import tabulate

HEADERS = ["Variant", "Material", "Torque T [N·m]", "Cylinder length l [mm]", "Wall thickness Δ [mm]"]
ROW = ["A", "20Cr2Ni4", 800, 160, 1.6]


def _tabulate(rows, schema="Variants", *, from_text=False):
    """Return the table of rows by row number, and the ledger."""
    raw = {
        number: {place: value for place, value in enumerate(cells, start=1) if value is not None}
        for number, cells in rows.items()
    }
    ledger = Ledger("a.xlsx")
    return tabulate(RawSheet(name=schema, rows=raw, numbers_are_texts=from_text), schema, ledger), ledger


def _told(ledger, *levels):
    """Return code and cell of the findings, all of them or those of some levels."""
    return [(found.code, found.cell) for found in ledger.findings if not levels or found.level in levels]


def _wall(header, value, *, from_text=False):
    table, ledger = _tabulate({1: [*HEADERS[:4], header], 2: [*ROW[:4], value]}, from_text=from_text)
    return table.frame["wall_thickness_mm"][0], ledger


def test_rows_keep_their_numbers():
    """Each row has the number that its user sees, whatever is blank before and between."""
    table, ledger = _tabulate({4: HEADERS, 9: ROW, 70: ["B", *ROW[1:]], 2000: ["C", *ROW[1:]]})
    assert table.frame["row"].to_list() == [9, 70, 2000]
    assert table.frame["variant"].to_list() == ["A", "B", "C"]
    assert str(table.address(70, "wall_thickness_mm")) == "E70"
    assert ledger.findings == []


def test_every_column_is_there_with_its_type():
    """The table has a column for every key, of numbers or of texts, also where the sheet has none."""
    table, _ = _tabulate({1: HEADERS, 2: ROW})
    assert table.frame.width == 29
    assert table.frame.schema["torque_Nm"] == table.frame.schema["bore_diameter_mm"] == pl.Float64
    assert table.frame.schema["notes"] == pl.String
    assert table.frame["torque_Nm"].to_list() == [800.0]
    assert table.frame["bore_diameter_mm"].to_list() == [None]


def test_a_column_that_the_sheet_lacks_stands_at_the_first_cell():
    """What is wrong with a column that the sheet lacks is told at the row's first cell."""
    table, _ = _tabulate({1: HEADERS, 2: ROW})
    assert str(table.address(2, "mean_radius_mm")) == "A2"


def test_what_stands_above_the_header_is_no_data():
    """Titles and groups above the header row are not read as rows."""
    table, ledger = _tabulate({1: ["Study"], 2: ["Variant", None, "Load"], 3: HEADERS, 4: ROW})
    assert table.frame["row"].to_list() == [4]
    assert ledger.findings == []


@pytest.mark.parametrize(
    ("header", "value", "number"),
    [
        ("Wall thickness Δ [mm]", 1.6, 1.6),
        ("wall_thickness_mm", 1.6, 1.6),
        ("Wall thickness", 1.6, 1.6),
        ("Wall thickness Δ [in]", 0.0625, 1.5875),
        ("Wall thickness Δ [m]", 0.0016, 1.6),
        ("Wall thickness Δ [µm]", 1600, 1.6),
        ("Wall thickness Δ (mm)", 1.6, 1.6),
        ("Wall thickness Δ [cm]", 0.16, 1.6),
    ],
)
def test_lengths_are_converted_to_mm(header, value, number):
    """A length in another unit becomes the same length in mm."""
    found, _ = _wall(header, value)
    assert found == pytest.approx(number, rel=1e-15)


@pytest.mark.parametrize(
    ("header", "value", "key", "number"),
    [
        ("Torque T [kN·m]", 0.8, "torque_Nm", 800),
        ("Torque T [lbf·in]", 7080.6, "torque_Nm", 800.0003804129427),
        ("Torque T [lbf·ft]", 590, "torque_Nm", 799.932589515526),
        ("Torque T [kgf·m]", 81.5, "torque_Nm", 799.241975),
        ("Backlash limit [arcsec]", 225, "backlash_limit_arcmin", 3.75),
        ("Backlash limit [mrad]", 1, "backlash_limit_arcmin", 3.437746770784939),
        ("Backlash limit [°]", 0.0625, "backlash_limit_arcmin", 3.75),
        ("Disk cone angle [rad]", 1.0, "disk_cone_angle_deg", 57.29577951308232),
        ("Disk cone angle [arcmin]", 3600, "disk_cone_angle_deg", 60),
        ("Load inertia J [kg·cm²]", 5000, "load_inertia_kg_m2", 0.5),
        ("Load inertia J [lb·in²]", 1000, "load_inertia_kg_m2", 0.2926396534292),
        ("Disk thickness exponent n [%]", 150, "disk_thickness_exponent", 1.5),
    ],
)
def test_other_quantities_are_converted(header, value, key, number):
    """Torques become N·m, angles arcmin or degrees, inertias kg·m² and ratios plain numbers."""
    table, ledger = _tabulate({1: ["Variant", "Material", header], 2: ["A", "20Cr2Ni4", value]})
    assert table.frame[key][0] == pytest.approx(number, rel=1e-14)
    assert [code for code, _ in _told(ledger, "info")] == ["I501"]


def test_the_templates_own_unit_changes_no_bit():
    """A value in the template's own unit is kept to the last digit."""
    found, _ = _wall("Wall thickness Δ [mm]", 0.1 + 0.2)
    assert found == 0.30000000000000004


FAULTS = [
    ("1,6", "E202", "1.6"),
    ("1.6 mm", "E202", "1.6"),
    ("1.6", "E220", "1.6"),
    ("1.600", "E202", "1.6 or 1600"),
    ("±0.02", "E202", "0.02"),
    ("\u00a01.6", "E220", "1.6"),
    ("\u22121.6", "E202", "-1.6"),
    ("１.６", "E202", "1.6"),
    ("5%", "E202", ""),
    ("n/a", "E221", ""),
    ("NaN", "E221", ""),
    ("-", "E221", ""),
    ("?", "E221", ""),
    ("TBD", "E221", ""),
    (datetime.datetime(2026, 4, 1), "E203", "1.4"),  # noqa: DTZ001
    (datetime.datetime(1980, 12, 1), "E203", "12.80"),  # noqa: DTZ001
    (datetime.datetime(1980, 12, 3), "E203", ""),  # noqa: DTZ001
    (datetime.time(1, 4), "E203", ""),
    (True, "E204", ""),
    (ErrorCell("#REF!"), "E205", ""),
    (Unstored(), "E206", ""),
    (float("inf"), "E212", ""),
]


@pytest.mark.parametrize(("value", "code", "suggestion"), FAULTS, ids=str)
def test_a_bad_cell_has_one_finding(value, code, suggestion):
    """Each kind of bad cell has its own code, its address, the requirement in words, and a suggestion if any."""
    number, ledger = _wall("Wall thickness Δ [mm]", value)
    assert number is None
    (found,) = ledger.findings
    assert (found.code, found.place, found.column) == (code, "Variants!E2", "wall_thickness_mm")
    assert found.suggestion == suggestion
    assert code in {"E206", "E220"} or "a length in mm above 0 is required" in found.message
    assert ledger.rows == {2}
    assert not ledger.everything


@pytest.mark.parametrize(
    ("value", "code"),
    [
        (datetime.datetime(2026, 4, 1), "E203"),  # noqa: DTZ001
        (True, "E204"),
        (ErrorCell("#N/A"), "E205"),
        (Unstored(), "E206"),
        ("x" * 1001, "E222"),
    ],
    ids=["date", "truth", "error", "formula", "long"],
)
def test_a_name_that_is_none(value, code):
    """A date, truth value, error or endless text is no name of a variant or material."""
    table, ledger = _tabulate({1: HEADERS, 2: [value, *ROW[1:]]})
    assert table.frame["variant"][0] is None
    assert _told(ledger) == [(code, "A2")]
    assert table.faulty == {(2, "variant")}


def test_the_value_is_told_as_entered():
    """A finding shows what the cell holds, not what became of it."""
    for value, shown in (("1,6 mm", "1,6 mm"), (datetime.datetime(2026, 4, 1), "2026-04-01"), (True, "TRUE")):  # noqa: DTZ001
        _, ledger = _wall("Wall thickness Δ [mm]", value)
        assert ledger.findings[0].value == shown


@pytest.mark.parametrize("text", ["1.6", " 1.6 ", "16e-1"])
def test_in_a_csv_file_texts_are_numbers(text):
    """In a CSV file a plain decimal is a number."""
    number, ledger = _wall("wall_thickness_mm", text, from_text=True)
    assert number == 1.6
    assert ledger.findings == []


@pytest.mark.parametrize(
    ("entered", "read", "told"),
    [
        ("cup", "cup", []),
        ("Cup", "cup", ["I504"]),
        (" CUP ", "cup", ["I504"]),
        ("c u p", "cup", ["I504"]),
        ("cap", "cap", []),
        ("  cap ", "cap", ["I504"]),
    ],
)
def test_entries_of_a_list(entered, read, told):
    """An entry of a list is recognised in other case and spacing, which is told; others are left for judgement."""
    table, ledger = _tabulate({1: [*HEADERS, "Flexspline type"], 2: [*ROW, entered]})
    assert table.frame["flexspline_type"][0] == read
    assert [found.code for found in ledger.findings] == told
    assert all(found.suggestion == read for found in ledger.findings)


@pytest.mark.parametrize(
    ("entered", "read", "told"),
    [
        ("B3-160", "B3-160", []),
        (" B3-160", "B3-160", ["I504"]),
        ("B3\u00a0160", "B3 160", ["I504"]),
        ("B3  160", "B3 160", ["I504"]),
        (160, "160", []),
        (160.0, "160", []),
        (1.5, "1.5", []),
        ("=A1", "=A1", []),
    ],
)
def test_names_are_kept(entered, read, told):
    """A name is kept but for its spaces, which is told; a number may be a name."""
    table, ledger = _tabulate({1: HEADERS, 2: [entered, *ROW[1:]]})
    assert table.frame["variant"][0] == read
    assert [found.code for found in ledger.findings] == told


@pytest.mark.parametrize(
    "blank",
    ["", " ", "\t", "\n", "\r\n", "\u00a0", "\u200b", "\ufeff", " \u00a0 "],
    ids=repr,
)
def test_white_space_is_blank(blank):
    """A row of white space is empty, and a cell of white space is blank, without a word."""
    table, ledger = _tabulate({1: [*HEADERS, "Notes"], 2: [*ROW, blank], 3: [blank] * 6, 104: [None, blank]})
    assert table.frame["row"].to_list() == [2]
    assert table.frame["notes"][0] is None
    assert ledger.findings == []


@pytest.mark.parametrize(
    ("cells", "address", "value"),
    [
        ([None, None, None, "x"], "D104", "x"),
        ([None, None, None, None, 5], "E104", "5"),
        ([None, None, None, None, None, None, None, "x"], "H104", "x"),
        ([None, None, None, "x", None, None, " "], "D104", "x"),
        ([None, None, ErrorCell("#REF!")], "C104", "#REF!"),
    ],
)
def test_a_lone_cell_is_a_warning(cells, address, value):
    """A stray cell far below is no variant: it is told with its address and stops nothing."""
    table, ledger = _tabulate({1: HEADERS, 2: ROW, 104: cells})
    assert table.frame["row"].to_list() == [2]
    (found,) = ledger.findings
    assert (found.code, found.level, found.place, found.value) == ("W408", "warning", f"Variants!{address}", value)
    assert ledger.rows == set()
    assert not ledger.everything


def test_a_name_alone_is_a_row():
    """A row with only its variant's name is a row, begun and not finished."""
    table, _ = _tabulate({1: HEADERS, 2: ROW, 3: ["B"]})
    assert table.frame["row"].to_list() == [2, 3]


def test_two_cells_are_a_row():
    """A row without a name but with two entries is a row, so that nothing entered is lost."""
    table, _ = _tabulate({1: HEADERS, 2: [None, None, 800, 160]})
    assert table.frame["row"].to_list() == [2]


def test_the_row_status_is_no_data():
    """The template's status formula makes no row and is not read, with or without a stored result."""
    rows = {1: [*HEADERS, "Row status"], 2: [*ROW, "complete"], 3: [None] * 5 + [""], 4: [None] * 5 + [Unstored()]}
    rows[5] = [None] * 5 + ["variant missing"]
    rows[6] = ["B", *ROW[1:], ErrorCell("#VALUE!")]
    table, ledger = _tabulate(rows)
    assert table.frame["row"].to_list() == [2, 6]
    assert table.heading.extra == {}
    assert ledger.findings == []


def test_extra_columns_are_carried():
    """Other columns are carried row by row as they are, and told once each."""
    rows = {1: [*HEADERS, "Customer", "Year"], 2: [*ROW, "ACME", 2026], 3: ["B", *ROW[1:], None, 1.5]}
    rows[4] = ["C", *ROW[1:], ErrorCell("#N/A"), True]
    table, ledger = _tabulate(rows)
    assert table.heading.extra == {6: "Customer", 7: "Year"}
    assert [cells.get(6) for cells in table.cells.values()] == ["ACME", None, ErrorCell("#N/A")]
    assert [cells.get(7) for cells in table.cells.values()] == [2026, 1.5, True]
    assert _told(ledger) == [("I502", "F1"), ("I502", "G1")]


@pytest.mark.parametrize("header", ["Tooth rim lenght [mm]", "Tooth rim length [furlong]"])
def test_a_bad_header_spoils_only_rows_that_hold_a_value(header):
    """Rows with a value under a misspelt header or an unknown unit are not computed; the others are."""
    rows = {1: [*HEADERS, header], 2: [*ROW, 20], 3: ["B", *ROW[1:]], 4: ["C", *ROW[1:], " "], 5: ["D", *ROW[1:], "x"]}
    table, ledger = _tabulate(rows)
    assert ledger.rows == {2, 5}
    assert not ledger.everything
    assert table.faulty == {(2, "rim_length_mm"), (5, "rim_length_mm")}
    assert table.frame["rim_length_mm"].to_list() == [None] * 4
    assert [found.code for found in ledger.findings] in (["E112"], ["E113"])


@pytest.mark.parametrize("header", ["Yield strenght [MPa]", "Density [furlong]"])
def test_a_bad_header_elsewhere_spoils_everything(header):
    """A value under a bad header of Materials could matter to every variant."""
    headers = ["Material", "Young's modulus E [GPa]", header]
    _, ledger = _tabulate({1: headers, 2: ["X", 211]}, "Materials")
    assert not ledger.everything
    table, ledger = _tabulate({1: headers, 2: ["X", 211, 5]}, "Materials")
    assert ledger.everything
    assert table.frame["material"].to_list() == ["X"]


def test_no_header_row_is_no_table():
    """A sheet without header row gives no table and one finding."""
    table, ledger = _tabulate({1: ROW})
    assert table is None
    assert _told(ledger) == [("E109", "A1")]


def test_a_header_row_alone_is_an_empty_table():
    """A sheet with nothing below its header row has no rows."""
    table, ledger = _tabulate({1: HEADERS})
    assert table.frame.is_empty()
    assert ledger.findings == []


def test_a_value_without_a_header_is_told():
    """Values in a column that has no header, beside variants, are told once, at the first of them."""
    _, ledger = _tabulate({1: HEADERS, 2: ROW, 3: ["B", *ROW[1:], None, 3.2], 4: ["C", *ROW[1:], 1, 3.4]})
    assert _told(ledger, "info") == [("I509", "F4"), ("I509", "G3")]
    assert ledger.findings[0].message.startswith("Variants!F4: the values of column F have no header")


def _shifted(text, name="Variants"):
    ledger = Ledger("a.csv")
    table = tabulate(read_table(text.encode(), name), name, ledger)
    check_cells(table, ledger)
    return table, ledger


SURPLUS = {
    "an unquoted decimal comma": (",", "A,20Cr2Ni4,800,160,1,6", "F2", "decimal comma"),
    "two of them": (",", "A,20Cr2Ni4,800,160,5,1,6", "F2", "decimal comma"),
    "behind blank cells": (",", "A,20Cr2Ni4,800,160,1,,x", "G2", "decimal comma"),
    "a text as well": (",", "A,20Cr2Ni4,x,160,1,6", "F2", "decimal comma"),
    "another separator": (";", "A;20Cr2Ni4;800;160;1,6;2", "F2", "separator"),
}


@pytest.mark.parametrize("what", SURPLUS)
def test_a_row_with_more_cells_than_headers_is_one_error(what):
    """Of a delimited text's row that is longer than its headers only the first column is used, with one finding."""
    sign, row, cell, words = SURPLUS[what]
    table, ledger = _shifted("\n".join([sign.join(HEADERS), row, f"B{row[1:10]}{sign}800{sign}160{sign}1", ""]))
    assert _told(ledger, "error", "warning") == [("E215", cell)]
    assert words in next(found.message for found in ledger.findings if found.code == "E215")
    assert ledger.rows == {2}
    assert table.frame["variant"].to_list() == ["A", "B"]
    assert table.frame["torque_Nm"].to_list() == [None, 800]


def test_blank_cells_beyond_the_headers_are_no_surplus():
    """Separators and spaces behind the last column of a delimited text do no harm."""
    _, ledger = _shifted("\n".join([",".join(HEADERS), "A,20Cr2Ni4,800,160,1.6,, ,", ""]))
    assert _told(ledger) == []


def test_a_value_under_a_blank_header_of_a_delimited_text():
    """A column without a header before the last header is told as in a workbook, and moves nothing."""
    _, ledger = _shifted("\n".join([",".join([*HEADERS, "", "Notes"]), "A,20Cr2Ni4,800,160,1.6,5,x", ""]))
    assert _told(ledger) == [("I509", "F2")]


def test_a_shifted_tolerance_spoils_its_class_alone():
    """A row of Tolerances that is longer than its headers leaves other classes usable."""
    heads = "tolerance_class,dimension,lower_deviation,upper_deviation"
    text = f"{heads}\nfine,wall_thickness,-0,02,0,02\nother,wall_thickness,-0.02,0.02\n"
    table, ledger = _shifted(text, "Tolerances")
    classes = tolerance_classes_of(table, ledger)
    assert _told(ledger) == [("E215", "E2")]
    assert (ledger.classes, ledger.everything, len(classes["other"])) == ({"fine"}, False, 1)


def test_extra_columns_of_one_name():
    """Two extra columns of one name are both carried."""
    table, _ = _tabulate({1: [*HEADERS, "Rev", "Rev"], 2: [*ROW, "a", "b"]})
    assert table.heading.extra == {6: "Rev", 7: "Rev"}
    assert (table.cells[2][6], table.cells[2][7]) == ("a", "b")


def test_explanations_beside_settings_are_no_values():
    """The template's own explanations beside the settings, which have no header, are not told."""
    _, ledger = _tabulate({1: ["Setting", "Value"], 2: ["seed", 0, "Start of the random numbers."]}, "Settings")
    assert ledger.findings == []


@pytest.mark.parametrize("name", ["A\u200bB", "\u202eAB", "A\x07B", "A\u00adB"], ids=ascii)
def test_names_lose_hidden_characters(name):
    """A name loses characters that nobody sees, which is told."""
    table, ledger = _tabulate({1: HEADERS, 2: [name, *ROW[1:]]})
    assert table.frame["variant"][0] == "AB"
    assert [(found.code, found.suggestion) for found in ledger.findings] == [("I504", "AB")]


def test_names_are_short():
    """A name of more than 200 characters does not pass untold."""
    _, ledger = _tabulate({1: HEADERS, 2: ["A" * 201, *ROW[1:]]})
    assert [found.cell for found in ledger.findings] == ["A2"]


@pytest.mark.parametrize("header", [ErrorCell("#REF!"), Unstored()], ids=["error", "formula"])
def test_a_header_that_is_an_error(header):
    """A header that shows an Excel error, or was not calculated, is not told in a programmer's words."""
    _, ledger = _tabulate({1: [*HEADERS, header], 2: ROW})
    (found,) = ledger.findings
    assert "Cell(" not in found.message
    assert "Unstored" not in found.message


@pytest.mark.parametrize(
    ("unit", "value", "found", "expected"),
    [
        ("rad", 1.570796326794897, [], 90.0),
        ("rad", 1.570796326794897 * (1 + 1e-11), ["E208"], None),
        ("mrad", 1570.796326794897, [], 90.0),
        ("rad", 0.5235987755982988, [], 30.0),
        ("rad", 0.5235987755982988 * (1 - 1e-11), ["E207"], None),
        ("°", 90.00000000000001, ["E208"], None),
    ],
)
def test_a_converted_value_on_a_bound(unit, value, found, expected):
    """A right angle in radians is within 90°; what is over by more than the last digits, or entered so, is not."""
    rows = {1: {1: "Variant", 2: f"Disk cone angle [{unit}]"}, 2: {1: "A", 2: value}}
    ledger = Ledger("a.xlsx")
    table = tabulate(RawSheet(name="Variants", rows=rows), "Variants", ledger)
    check_cells(table, ledger)
    assert [one.code for one in ledger.findings if one.code in {"E207", "E208"}] == found
    assert expected is None or table.frame["disk_cone_angle_deg"].to_list() == [expected]


def test_a_unit_makes_no_number_infinite():
    """A number that is finite as entered and infinite once converted is no number."""
    number, ledger = _wall("Wall thickness Δ [m]", 1e306)
    assert number is None
    assert [found.code for found in ledger.findings if found.level == "error"] == ["E212"]
