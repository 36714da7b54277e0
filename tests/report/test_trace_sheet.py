"""The Trace: its formulas come to the program's numbers, as submitted and after a reader's changes."""

from __future__ import annotations

import io
import re
import zipfile

import openpyxl
import pytest
import regenerate
import xlsxwriter
from libreoffice import convert_all, needs_libreoffice
from report_entries import error_cells, typed, values_of
from traced_rows import (
    LINES,
    MATERIALS,
    ROWS,
    _written,
    rows_of,
    traced,
)

from flexlash.feedback.template.template_workbook import Filling, template_bytes
from flexlash.pipeline import check
from flexlash.report.layout.styles import Book
from flexlash.report.trace.inputs import PROGRAM, stored_inputs
from flexlash.report.trace.trace_sheet import AGREES, CHANGED, NOT_LISTED, trace_sheet, write_trace

DATA = regenerate.ROOT / "data"
SETTINGS = {"cylinder_calibration": 0.907, "disk_calibration": 0.936, "lost_motion_percent": 3.0}


def assert_program(found, nominal, name):
    """Assert that values by key are the program's numbers to 1e-12, and none where the program has none."""
    for key, (_, size) in PROGRAM.items():
        number = getattr(nominal, key)
        if isinstance(number, float) and number:
            assert found[key] == pytest.approx(number / size, rel=1e-12, abs=0), f"{name}: {key}"
        else:
            assert found[key] == (number or "none" if key == "buckling_range" else number or 0), f"{name}: {key}"


@pytest.fixture(scope="module")
def everything(tmp_path_factory):
    """Return the outcome of one row of every kind, with calibrations."""
    path = tmp_path_factory.mktemp("everything") / "submission.xlsx"
    path.write_bytes(template_bytes(Filling(variants=rows_of(ROWS), materials=MATERIALS, settings=SETTINGS)))
    outcome = check(path)
    assert [one.variant.name for one in outcome.computed.values()] == list(ROWS)
    return outcome


SUBMISSIONS = ["b3-160-study.xlsx", "catalogue-sizes.xlsx", "b3-160-proof.xlsx", "b3-160-calibrated.xlsx"]


@pytest.mark.slow
@pytest.mark.parametrize("name", SUBMISSIONS)
def test_every_example_agrees_with_the_program(name):
    """With any variant of the examples picked, every traced number is the program's to 1e-12."""
    outcome = check(DATA / name)
    for place, one in enumerate(outcome.computed.values()):
        # The numbers alone are looked at: a workbook that is not closed is made in half the time.
        lines = _written(xlsxwriter.Workbook(io.BytesIO(), {"in_memory": True}), outcome, place)
        assert_program({key: line.value for key, line in lines.items()}, one.nominal, one.variant.name)
        assert lines["verdict"].value == AGREES


@pytest.fixture(scope="module")
def traces(everything):
    """Return the trace of each of these rows."""
    return [traced(everything, place) for place in range(len(ROWS))]


@pytest.mark.slow
def test_every_kind_of_row_agrees_with_the_program(everything, traces):
    """Every shape and refinement, wide and narrow, traces to the program's numbers, and no cell holds an error."""
    for one, (lines, data) in zip(everything.computed.values(), traces, strict=True):
        assert_program({key: line.value for key, line in lines.items()}, one.nominal, one.variant.name)
        assert lines["verdict"].value == AGREES
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            for part in ("xl/worksheets/sheet1.xml", "xl/worksheets/sheet2.xml"):
                text = archive.read(part).decode()
                assert 't="e"' not in text
                assert "<v>#" not in text


def test_the_kinds_of_rows_reach_every_branch(traces):
    """The rows of these tests meet each disk profile, each range of buckling and each governing section."""
    lines = [one for one, _ in traces]
    for key, values in {
        "profile": {"none", "even", "straight taper", "power law"},
        "buckling_range": {"none", "shorter", "yes", "longer"},
        "governing_section": {"wall", "disk"},
    }.items():
        assert {line[key].value for line in lines} == values
    assert any(line["fillet_shear"].value > max(line["start_shear"].value, line["outer_shear"].value) for line in lines)


def _opened(data):
    return openpyxl.load_workbook(io.BytesIO(data))


FUNCTIONS = {
    "ABS", "AND", "COS", "COUNTA", "EXACT", "EXP", "FIXED", "IF", "IFERROR", "INDEX", "ISNUMBER", "LN", "MATCH", "MAX",
    "MIN", "N", "NOT", "OR", "PI", "SIN", "SQRT", "SUM",
}  # fmt: skip


def test_formulas_are_plain(traces):
    """The Trace uses functions of every Excel since 2007 and no array formulas; constants have at most 15 digits."""
    formulas = [
        cell.value
        for sheet in _opened(traces[0][1]).worksheets
        for row in sheet.iter_rows()
        for cell in row
        if cell.data_type == "f"
    ]
    assert len(formulas) > 900
    assert {name for one in formulas for name in re.findall(r"([A-Z.a-z_]+)\(", one)} <= FUNCTIONS
    assert not [one for one in formulas for number in re.findall(r"\d[\d.]*", one) if len(number) > 15]


def test_every_input_can_be_changed_within_the_bounds_of_a_submission(traces):
    """Each input has a yellow cell that takes what its column takes; optional ones the word that leaves them out."""
    lines, data = traces[0]
    rules = {str(rule.sqref): rule for rule in _opened(data)["Trace"].data_validations.dataValidation}
    rows = {key: lines[key].text.rpartition("$")[2] for key in lines}
    assert rules["G" + rows["torque"]].formula1 == "AND(ISNUMBER({0}),{0}>0)".format("G" + rows["torque"])
    ratio, cell = rules["G" + rows["poisson_ratio"]], "G" + rows["poisson_ratio"]
    assert ratio.formula1 == f'IF(ISNUMBER({cell}),AND({cell}>=0,{cell}<=0.5),{cell}="none")'
    assert ratio.error == "A number from 0 to 0.5 is required here, or none to leave it out."
    assert rules["G" + rows["torque"]].error.startswith("A torque in N·m ")
    assert rules["G" + rows["flexspline_type"]].formula1 == '"cup,hat,cylinder"'
    assert len([one for one in rules if one.startswith("G")]) == 26


def test_every_variant_can_be_picked(traces):
    """The drop-down lists the variants of Inputs in their order; the first is picked as written."""
    book = _opened(traces[0][1])
    rule = next(rule for rule in book["Trace"].data_validations.dataValidation if str(rule.sqref) == "B3")
    assert rule.formula1 == f"Inputs!$A$3:$A${len(ROWS) + 2}"
    assert [cell.value for cell in book["Inputs"]["A"][2:]] == list(ROWS)
    assert book["Trace"]["B3"].value == "cup"
    assert book["Trace"].freeze_panes == "A6"


@pytest.mark.slow
def test_the_trace_says_when_more_variants_were_computed():
    """With more variants than can be picked the Trace says how many of how many; without any it is empty."""
    outcome = check(DATA / "b3-160-study.xlsx")
    computed = list(outcome.computed.values())
    for count, said in ((11, False), (3, True), (0, False)):
        with xlsxwriter.Workbook(io.BytesIO(), {"in_memory": True}) as workbook:
            book = Book(workbook)
            lines = write_trace(book, trace_sheet(book), stored_inputs(computed[:count], 4.0), 11)
            texts = " ".join(workbook.str_table.string_table)
        assert ("The 3 worst of 11 variants can be picked." in texts) is said
        assert bool(lines) is (count > 0)


@pytest.mark.slow
@needs_libreoffice
def test_stored_values_are_those_of_a_recalculation(tmp_path):
    """Every formula of Trace and its steps, of the study's worst variant, holds what LibreOffice makes of it."""
    paths = []
    for place in (0, 5):
        paths.append(tmp_path / f"{place}.xlsx")
        paths[-1].write_bytes(traced(check(DATA / "b3-160-study.xlsx"), place)[1])
    for before, after in zip(paths, convert_all(paths, "xlsx", tmp_path), strict=True):
        for sheet in ("Trace", "Trace steps"):
            stored, again = values_of(before, sheet), values_of(after, sheet)
            assert stored.keys() == again.keys()
            assert not error_cells(again)
            for cell, value in stored.items():
                assert again[cell] == (
                    pytest.approx(value, rel=1e-12, abs=1e-15) if isinstance(value, float) else value
                ), f"{sheet}!{cell}"


CHANGES = {
    "cup": {"wall_thickness_mm": 1.8, "torque_Nm": 950.0, "youngs_modulus_GPa": 205.0, "hub_fillet_radius_mm": 3.0},
    "cup *": {"bore_diameter_mm": 161.0, "disk_inner_radius_mm": 33.0, "poisson_ratio": 0.28},
    "refined": {
        "hub_fillet_radius_mm": None,
        "rim_thickness_mm": 4.0,
        "disk_calibration": 1.1,
        "rated_torque_Nm": 20.0,
    },
    "taper": {"disk_thickness_mm": None, "disk_thickness_exponent": 2.0, "wall_thickness_mm": 0.9, "yield_MPa": 700.0},
    "hat": {"flexspline_type": "cylinder", "disk_outer_radius_mm": None, "cylinder_length_mm": 20.0},
    "given both": {"shear_modulus_GPa": None, "junction_fillet_radius_mm": 65.0},
    "power law": {"disk_hub_thickness_mm": 5.0, "disk_thickness_exponent": 6.5, "mean_radius_mm": 79.0},
}
"""What a reader types, by the variant that is picked; None leaves an input out."""
CALIBRATIONS = {"cylinder_calibration": 0.8, "disk_calibration": 1.1}
"""What the reader types beside it for each of them."""


def _changed(workbook):
    """Return the program's numbers of the variants whose inputs were changed in the submission itself, by name."""
    rows, materials = {}, []
    for name, changes in CHANGES.items():
        row = dict(ROWS[name])
        material = dict(next(one for one in MATERIALS if one["material"] == row["material"]))
        for key, value in changes.items():
            (material if key.endswith(("GPa", "MPa", "ratio")) else row)[key] = value
        for one, other in (("bore_diameter_mm", "mean_radius_mm"), ("mean_radius_mm", "bore_diameter_mm")):
            if one in changes:
                row[other] = None
        rows[name] = row | {"material": f"of {name}"}
        given = {key: value for key, value in material.items() if value is not None}
        materials.append(given | {"material": f"of {name}"})
    path = workbook(rows_of(rows), "changed.xlsx", materials=materials, settings=SETTINGS | CALIBRATIONS)
    return {one.variant.name: one.nominal for one in check(path).computed.values()}


@pytest.mark.slow
@needs_libreoffice
def test_a_reader_may_pick_and_change(traces, workbook, tmp_path):
    """After picking a variant and typing changes, the Trace is what the program makes of those inputs."""
    lines, data = traces[0]
    (tmp_path / "report.xlsx").write_bytes(data)
    cells = {key: line.text.replace("$", "") for key, line in lines.items()}
    nominal, paths = _changed(workbook), []
    for place, (name, changes) in enumerate(CHANGES.items()):
        entries = {"B3": name}
        for key, value in (changes | CALIBRATIONS).items():
            line = LINES.get(key) or re.sub("_(mm|Nm|GPa|deg)$", "", key)
            entries["G" + cells[line][1:]] = "none" if value is None else value
        paths.append(typed(tmp_path / "report.xlsx", tmp_path / f"picked {place}.xlsx", "Trace", entries))
    for name, path in zip(CHANGES, convert_all(paths, "xlsx", tmp_path), strict=True):
        values = values_of(path, "Trace")
        found = {key: values[cells[key]] for key in PROGRAM}
        assert not error_cells(values)
        assert not error_cells(values_of(path, "Trace steps"))
        assert_program(found, nominal[name], name)
        assert values[cells["verdict"]] == CHANGED
        assert values["F4"] == list(ROWS).index(name) + 1


@pytest.mark.slow
@needs_libreoffice
def test_another_variant_that_is_picked_agrees(everything, traces, tmp_path):
    """After picking any of some variants, and nothing else, the Trace agrees with the program."""
    lines, data = traces[0]
    (tmp_path / "report.xlsx").write_bytes(data)
    names = ["cup 1", "cup *", "nearly 2", "cylinder", "given G", "fillet as wide as the disk", "thickness as radius"]
    paths = [
        typed(tmp_path / "report.xlsx", tmp_path / f"picked {place}.xlsx", "Trace", {"B3": name})
        for place, name in enumerate(names)
    ]
    nominal = {one.variant.name: one.nominal for one in everything.computed.values()}
    cells = {key: line.text.replace("$", "") for key, line in lines.items()}
    for name, path in zip(names, convert_all(paths, "xlsx", tmp_path), strict=True):
        values = values_of(path, "Trace")
        assert not error_cells(values)
        assert_program({key: values[cells[key]] for key in PROGRAM}, nominal[name], name)
        assert values[cells["verdict"]] == AGREES, (name, values[cells["difference"]])


@pytest.mark.slow
@needs_libreoffice
def test_a_variant_that_is_not_in_the_list_has_no_numbers(traces, tmp_path):
    """A name typed that is not there to the letter is told beside it; no cell holds a number or an error."""
    lines, data = traces[0]
    (tmp_path / "report.xlsx").write_bytes(data)
    names = ["absent", "", "Cup", "cup ", "c?p"]
    paths = [
        typed(tmp_path / "report.xlsx", tmp_path / f"typed {place}.xlsx", "Trace", {"B3": name})
        for place, name in enumerate(names)
    ]
    for name, path in zip(names, convert_all(paths, "xlsx", tmp_path), strict=True):
        values = values_of(path, "Trace")
        assert values["E3"] == NOT_LISTED, name
        assert not error_cells(values | values_of(path, "Trace steps")), name
        shown = {key: values[line.text.replace("$", "")] for key, line in lines.items()}
        assert {key for key, value in shown.items() if value not in {"none", 0}} == set(), name
        beside = {cell: value for cell, value in values.items() if cell[0] in "FG" and int(cell[1:]) > 5}
        assert not [cell for cell, value in beside.items() if isinstance(value, float | int)], name
