"""What is easily overlooked: merged cells, hidden rows and sheets, a row far below the others."""

import time

import openpyxl
import pytest

from flexlash.pipeline import check
from flexlash.reading.raw import RawSheet, Submission
from flexlash.validation.consolidation import consolidated
from flexlash.validation.validate import validate

KEYS = [
    "variant",
    "material",
    "torque_Nm",
    "cylinder_length_mm",
    "mean_radius_mm",
    "wall_thickness_mm",
    "disk_inner_radius_mm",
    "notes",
]
VALUES = ["A", "20Cr2Ni4", 800.0, 160.0, 80.0, 1.6, 40.0, "x"]


def _told(sheet, **others):
    """Return (code, cell) of all findings but those of built-in tables, and the rows that are computable."""
    sheets = {"Variants": sheet, **others}
    validated = validate(Submission(name="a.xlsx", sha256="", kind="workbook", sheets=sheets))
    told = [(found.code, found.cell) for found in validated.findings if found.code not in {"I505", "I503"}]
    return told, [variant.row for variant in validated.variants]


def _sheet(*numbers, without=(), **facts):
    """Return a sheet with a sound variant in each of these rows; `without` are (row, place) left blank."""
    rows = {1: dict(enumerate(KEYS, start=1))}
    for number in numbers:
        cells = dict(enumerate([f"V{number}", *VALUES[1:]], start=1))
        rows[number] = {place: value for place, value in cells.items() if (number, place) not in without}
    return RawSheet(name="Variants", rows=rows, **facts)


MERGED = {
    "two rows, one torque": ((2, 3, 3, 3), [(3, 3)], [("E214", "C3")], [2, 4]),
    "three rows": ((2, 3, 4, 3), [(3, 3), (4, 3)], [("E214", "C3"), ("E214", "C4")], [2]),
    "two columns": ((3, 4, 3, 5), [(3, 5)], [("E214", "E3")], [2, 4]),
    "a value under the area that Excel does not show": ((2, 3, 3, 3), [], [("E214", "C3")], [2, 4]),
    "an empty area": ((2, 3, 3, 3), [(2, 3), (3, 3)], [("E201", "C2"), ("E201", "C3")], [4]),
    "remarks": ((2, 8, 4, 8), [(3, 8), (4, 8)], [], [2, 3, 4]),
    "beyond the table": ((2, 9, 4, 12), [], [], [2, 3, 4]),
    "one cell": ((2, 3, 2, 3), [], [], [2, 3, 4]),
    "above the table": ((1, 3, 1, 3), [], [], [2, 3, 4]),
    "the whole sheet": ((2, 1, 1048576, 16384), [], None, []),
}


@pytest.mark.parametrize("what", MERGED)
def test_cells_under_a_merged_area(what):
    """A cell that is read but lies under a merged area is an error of its own, told once, unless it is a remark."""
    area, without, expected, computable = MERGED[what]
    told, rows = _told(_sheet(2, 3, 4, without=without, merged=(area,)))
    assert rows == computable
    if expected is None:
        assert {code for code, _ in told} == {"E214"}
    else:
        assert told == expected


def test_a_merged_material_stops_those_who_use_it():
    """A merged cell of Materials is told there and stops the variants of that material."""
    materials = RawSheet(
        name="Materials",
        rows={
            1: {1: "material", 2: "youngs_modulus_GPa", 3: "poisson_ratio"},
            2: {1: "steel", 2: 211.0, 3: 0.3},
            3: {1: "20Cr2Ni4", 3: 0.3},
        },
        merged=((2, 2, 3, 2),),
    )
    told, rows = _told(_sheet(2), Materials=materials)
    assert told == [("E214", "B3")]
    assert rows == []


@pytest.mark.parametrize(
    ("hidden", "expected"),
    [
        ({3}, [("W425", "A3")]),
        ({2, 3, 5}, [("W425", "A2"), ("W425", "A5")]),
        ({1, 7}, []),
        (set(), []),
    ],
)
def test_hidden_rows_are_computed_and_told(hidden, expected):
    """Hidden rows with data are computed; each run of them is told at its first row, hidden empty rows are not."""
    told, rows = _told(_sheet(2, 3, 4, 5, hidden_rows=frozenset(hidden)))
    assert told == expected
    assert rows == [2, 3, 4, 5]


def test_a_run_of_hidden_rows_says_how_far_it_goes():
    """The finding of several hidden rows names the first and the last."""
    submission = Submission(
        name="a.xlsx", sha256="", kind="workbook", sheets={"Variants": _sheet(2, 3, 4, hidden_rows=frozenset({3, 4}))}
    )
    (found,) = [one for one in consolidated(validate(submission)) if one.code == "W425"]
    assert found.message == "Variants!A3: rows 3 to 4 are hidden, but used."
    assert found.variant == "V3"


def test_a_hidden_sheet_is_told():
    """A hidden entry sheet with data is told once; one without data is not."""
    assert _told(_sheet(2, hidden=True))[0] == [("W426", "A1")]
    assert ("W426", "A1") not in _told(_sheet(hidden=True))[0]


@pytest.mark.parametrize(("row", "told"), [(62, []), (63, [("W427", "A63")])])
def test_a_row_below_sixty_empty_ones(row, told):
    """A row is far when sixty empty rows or more lie above it; it is computed all the same."""
    assert _told(_sheet(2, row)) == (told, [2, row])


@pytest.mark.slow
def test_a_workbook_says_all_of_it(workbook, sound, tmp_path):
    """From a workbook on disk merged cells, hidden rows and hidden sheets are read and told."""
    path = workbook([{**sound, "variant": name} for name in "ABCD"])
    book = openpyxl.load_workbook(path)
    book["Variants"].merge_cells("D5:D6")
    book["Variants"].row_dimensions[7].hidden = True
    book["Materials"].sheet_state = "hidden"
    book.save(tmp_path / "changed.xlsx")
    outcome = check(tmp_path / "changed.xlsx")
    told = {(found.code, found.sheet, found.cell) for found in outcome.findings if found.level != "info"}
    assert told >= {("E214", "Variants", "D6"), ("W425", "Variants", "A7"), ("W426", "Materials", "A1")}
    assert outcome.counts["computed"] == 3


@pytest.mark.slow
def test_overlapping_merged_areas_cost_no_more_than_one():
    """Many areas over the same cells, which Excel never writes, are judged once a cell."""
    sheet = _sheet(*range(2, 302), merged=((2, 1, 1_048_576, 16_384),) * 5_000)
    start = time.process_time()
    told, rows = _told(sheet)
    assert time.process_time() - start < 5
    assert rows == []
    assert len({place for place in told if place[0] == "E214"}) == len([one for one in told if one[0] == "E214"])
