"""Measurements: what is read as parts of samples, and each fault of a sample at its cell."""

from __future__ import annotations

import math

import pytest
from measured_parts import HEADERS, measured_rows, samples_of, scattered

from flexlash.analysis.examination import examined
from flexlash.analysis.options import Options
from flexlash.pipeline import check
from flexlash.reading.read import Source
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.schema.columns import columns_of

_TOLD = ("E", "W")


@pytest.fixture
def measured(book, sound):
    """Return a function that validates rows of Measurements, used by class shop for the wall."""

    def read(rows, headers=HEADERS, uses=(("shop", "wall_thickness", "wall"),), name="Measurements", **options):
        entered = {
            columns_of("Variants")[key].label: value for key, value in (sound | {"tolerance_class": "shop"}).items()
        }
        variants = [list(entered), list(entered.values())]
        path = book({"Variants": variants, "Tolerances": samples_of(*uses), name: [headers, *rows]})
        found = examined(Source.at(path, ReadingLimits()), Options(**options))
        assert found.validated is not None
        return found.validated

    return read


def _told(validated, sheet="Measurements"):
    """Return code and cell of the errors and warnings of a sheet."""
    return [(one.code, one.cell) for one in validated.findings if one.sheet == sheet and one.code[0] in _TOLD]


def test_sixty_parts(measured):
    """Each column is a dimension of the sample, in SI and in the order of the rows."""
    rows = measured_rows()
    found = measured(rows)
    assert _told(found) == []
    assert set(found.measured) == {"wall"}
    wall = found.measured["wall"]["wall_thickness"]
    assert (wall.sample, wall.dimension, wall.are_deviations) == ("wall", "wall_thickness", False)
    assert wall.values == pytest.approx([row[3] * 1e-3 for row in rows], rel=1e-15)
    assert wall.parts == tuple(range(2, 62))
    assert found.measured["wall"]["disk_thickness"].parts == wall.parts
    assert found.blocked.classes == frozenset()


def test_blank_cells_are_parts_that_were_not_measured(measured):
    """A blank leaves out the part in this dimension alone; the rows of Measurements tell which parts remain."""
    rows = measured_rows(20)
    rows[3][3] = rows[5][4] = rows[6][4] = None
    found = measured(rows)
    assert _told(found) == []
    assert found.measured["wall"]["wall_thickness"].parts == (2, 3, 4, *range(6, 22))
    assert found.measured["wall"]["disk_thickness"].parts == (2, 3, 4, 5, 6, *range(9, 22))


def test_several_samples(measured):
    """Rows of each name make a sample, however they are mixed, and names in other spellings are one."""
    first, second = measured_rows(20), measured_rows(20, "Disk B")
    second[3][0] = "disk-b"
    mixed = [row for pair in zip(first, second, strict=True) for row in pair]
    found = measured(mixed)
    assert _told(found) == []
    assert set(found.measured) == {"wall", "diskb"}
    assert found.measured["diskb"]["wall_thickness"].sample == "Disk B"
    assert found.measured["diskb"]["wall_thickness"].parts == tuple(range(3, 42, 2))


@pytest.mark.parametrize(("unit", "factor"), [("µm", 1e-6), ("m", 1.0), ("in", 0.0254), ("mm", 1e-3)])
def test_units_in_headers(measured, unit, factor):
    """A column in another length unit is converted, and told."""
    wall = scattered(20)
    rows = [["wall", value * 1e-3 / factor] for value in wall]
    found = measured(rows, ["Sample", f"Wall thickness Δ [{unit}]"])
    assert found.measured["wall"]["wall_thickness"].values == pytest.approx([value * 1e-3 for value in wall], rel=1e-12)
    assert [one.code for one in found.findings if one.sheet == "Measurements"] == ["I501"] * (unit != "mm")


def test_deviations(measured):
    """What was measured above the entered value may be negative and 0."""
    rows = [["wall", number, "Deviation", value - 1.607, None] for number, value in enumerate(scattered(20))]
    rows[4][3] = 0
    found = measured(rows)
    assert _told(found) == []
    assert found.measured["wall"]["wall_thickness"].are_deviations
    assert math.fsum(found.measured["wall"]["wall_thickness"].values) < 0.001


FAULTS = {
    "a text": ({3: "1,607"}, "E202", "D12"),
    "text of a number": ({3: "1.6071"}, "E220", "D12"),
    "no value": ({3: "n/a"}, "E221", "D12"),
    "an error": ({3: "#DIV/0!"}, "E205", "D12"),
    "true": ({3: True}, "E204", "D12"),
    "none that a part has": ({3: 0}, "E207", "D12"),
    "below": ({4: -1.6}, "E207", "E12"),
    "no sample": ({0: None}, "E201", "A12"),
    "no use": ({2: "nominal"}, "E209", "C12"),
    "deviation": ({2: "deviation"}, "E342", "C12"),
    "tenfold": ({3: 16.07}, "W446", "D12"),
    "an inch": ({3: 1.607 / 25.4}, "W446", "D12"),
    "in metres": ({4: 0.001607}, "W446", "E12"),
    "swapped digits": ({3: 1.706}, "W446", "D12"),
    "another sample": ({0: "wal"}, "W453", "A12"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_told_at_its_cell(measured, fault):
    """One cell gives one finding, there; an error keeps the class from being used, nothing else."""
    changes, code, cell = FAULTS[fault]
    rows = measured_rows()
    for place, value in changes.items():
        rows[10][place] = value
    uses = [
        ("shop", "wall_thickness", "wall"),
        ("shop", "disk_thickness", "wall"),
        ("other", "wall_thickness", "third"),
    ]
    found = measured([*rows, *measured_rows(20, "third")], uses=uses)
    assert _told(found) == [(code, cell)]
    assert found.blocked.classes == ({"shop"} if code.startswith("E") else set()) | (
        {"other"} if code == "E201" else set()
    )
    assert not found.blocked.everything


def test_what_was_meant_is_suggested(measured):
    """A slip of the point, of the unit or of two digits gets the value among the others that it was made of."""
    rows = measured_rows()
    rows[10][3], rows[20][3], rows[30][3] = 16.07, 1607, 0.0016071
    said = [one for one in measured(rows).findings if one.code == "W446"]
    assert [(one.cell, one.suggestion) for one in said] == [("D12", "1.607"), ("D22", "1.607"), ("D32", "1.6071")]


def test_the_use_of_most_rows_holds(measured):
    """The first row alone as deviation, the others blank: the one cell is told, not the 59 others."""
    rows = measured_rows()
    rows[0][2] = "deviation"
    found = measured(rows)
    assert _told(found) == [("E342", "C2")]
    assert not found.measured["wall"]["wall_thickness"].are_deviations


def test_deviations_that_are_not_said_to_be(measured):
    """Half of the values below 0 are one finding, not thirty."""
    rows = [["wall", number, None, value - 1.607, None] for number, value in enumerate(scattered(60))]
    found = measured(rows)
    assert _told(found) == [("E343", "D2")]
    assert "30 of 60" in next(one.message for one in found.findings if one.code == "E343")
    assert found.blocked.classes == {"shop"}


def test_parts_measured_twice(measured):
    """A part that stands twice is told once, where it stands again; a part of another sample is another one."""
    rows = [*measured_rows(20), *measured_rows(20, "second")]
    rows[7][1] = 3
    found = measured(rows)
    assert [(one.code, one.cell) for one in found.findings if one.code == "I530"] == [("I530", "B9")]


@pytest.mark.parametrize(
    "headers",
    [
        ["Sample", "Part", "Wal thickness [mm]"],
        ["Sample", "Part", "Wall thickness [kg]"],
        ["Probe", "Part", HEADERS[3]],
    ],
)
def test_a_header_that_cannot_be_read_spoils_samples_alone(measured, headers):
    """Classes without a sample are computed whatever is wrong with the headers of Measurements."""
    rows = [[row[0], row[1], row[3]] for row in measured_rows()]
    found = measured(rows, headers)
    assert found.blocked.classes == {"shop"}
    assert not found.blocked.everything
    assert [code for code, cell in _told(found) if code[0] == "E"][:1] in (["E112"], ["E113"], ["E111"])


def test_a_sheet_of_this_name_that_holds_something_else(measured):
    """Before there were samples engineers had sheets of this name: a warning, and nothing is lost."""
    found = measured([["Mean", 1.6]], ["Statistic", "Result"], uses=())
    assert _told(found) == [("W452", "A1")]
    assert found.measurements is None
    assert not found.blocked.everything


def test_rows_that_add_up_are_no_parts(measured):
    """What is written below the parts, by the sample's or in the part's column, is not measured."""
    rows = [
        *measured_rows(),
        ["Mean", None, None, 1.607],
        ["wall", "Std dev", None, 0.0041],
        [None, "Max", None, 1.617],
    ]
    found = measured(rows)
    assert _told(found) == [("W433", "A62"), ("W433", "B63"), ("W433", "B64")]
    assert len(found.measured["wall"]["wall_thickness"].values) == 60


def test_a_part_without_a_sample(measured):
    """A value beside no sample is an error at the sample, not a stray cell; one below an empty row is stray."""
    rows = [["wall", value] for value in scattered(20)]
    rows[5][0] = None
    found = measured([*rows, [], [None, 1.607]], ["Sample", HEADERS[3]])
    assert _told(found) == [("W408", "B23"), ("E201", "A7")]


def test_ten_thousand_parts_take_half_a_second(measured):
    """Time grows with the number of rows; each of 10,000 may be a sample of its own."""
    rows = [[f"sample {number}", number, None, 1.6, 1.6] for number in range(5000)]
    found = measured(rows, uses=())
    assert len(found.measured) == 5000
    assert sum(one.code == "I529" for one in found.findings) == 5000


MACHINES = {
    "semicolons": ("Sample;Part;Wall thickness Δ [mm]\n", "wall;{number};{comma}\n"),
    "micrometres": ("Sample;Part;Wall thickness [µm];Operator\n", "wall;{number};{micro};Müller\n"),
    "a row of units": ("Sample;Part;Wall thickness\n;;mm\n", "wall;{number};{comma}\n"),
    "a head": ("Calypso;;\nPlan: cup;;\n\nSample;Part;Wall thickness Δ [mm]\n", "wall;{number};{comma}\n"),
    "commas": ("sample,part,wall_thickness_mm\n", "wall,{number},{point}\n"),
    "tabs": ("Sample\tPart\tWall thickness [mm]\n", "wall\t{number}\t{comma}\n"),
}


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp1252"])
def test_tables_of_measuring_machines(table, tmp_path, sound, machine, encoding):
    """A table beside a table of variants is read with its own separators, decimal comma, units and letters."""
    head, line = MACHINES[machine]
    if encoding == "cp1252" and "Δ" in head:
        head = head.replace("Δ", "?")
    values = scattered(60)
    lines = [
        line.format(
            number=place, point=f"{value:.4f}", comma=f"{value:.4f}".replace(".", ","),
            micro=f"{1000 * value:.1f}".replace(".", ","),
        )
        for place, value in enumerate(values, start=1)
    ]  # fmt: skip
    path = tmp_path / "measured.csv"
    path.write_bytes((head + "".join(lines)).encode(encoding))
    limits = {
        "tolerance_class": "shop",
        "dimension": "wall_thickness",
        "lower_deviation": -0.02,
        "upper_deviation": 0.02,
    }
    tolerances = table([limits | {"sample": "wall"}], name="tolerances.csv")
    submission = table([sound | {"tolerance_class": "shop"}])
    outcome = check(submission, tolerances=tolerances, measurements=path)
    assert [one.code for one in outcome.findings if one.code[0] in _TOLD and one.sheet == "Measurements"] == []
    measured = outcome.validated.measured["wall"]["wall_thickness"].values
    assert measured == pytest.approx([round(value, 4) * 1e-3 for value in values], rel=1e-12)


def test_a_number_that_no_size_has(measured):
    """What lies beyond a thousand million, in any unit, is an error at its cell and no part of the sample."""
    rows = measured_rows(20)
    rows[2][3], rows[4][3] = 2e9, -2e9
    found = measured(rows)
    assert [one for one in _told(found) if one[0] == "E208"] == [("E208", "D4"), ("E208", "D6")]
    assert len(found.measured["wall"]["wall_thickness"].values) == 18
