"""The template cannot easily be filled wrongly, and survives other programs."""

from __future__ import annotations

import datetime
import io
import itertools

import openpyxl
import pytest
import regenerate
from libreoffice import convert, needs_libreoffice, needs_pages

from flexlash.feedback.template.decision_status import LEVER_STATUS, SOURCE_STATUS, SWEEP_STATUS
from flexlash.feedback.template.entry_rules import FIRST_ROW, HEADER_ROW
from flexlash.feedback.template.template_workbook import Filling, study, template_bytes
from flexlash.feedback.template.tolerance_status import CORRELATION_STATUS, tolerance_status
from flexlash.feedback.template.variant_status import VARIANT_STATUS
from flexlash.reading.raw import ErrorCell
from flexlash.schema.columns import ENTRY_SHEETS, OPTIONAL_SHEETS, VARIANTS
from flexlash.schema.part_rules import PART_RULES
from flexlash.validation.template_versions import TEMPLATE_VERSION

HAT = {"flexspline_type": "hat", "disk_inner_radius_mm": None, "disk_outer_radius_mm": 120.0}
TUBE = {"flexspline_type": "cylinder", "disk_inner_radius_mm": None}
RIM = {"rim_length_mm": 20.0, "rim_thickness_mm": 3.2}
STATUS_ROWS = [
    ({}, "complete"),
    ({"material": None}, "material missing"),
    ({"torque_Nm": None}, "torque missing"),
    ({"material": "cheese"}, "material not in Materials"),
    ({"flexspline_type": "cap"}, "flexspline type is not in its list"),
    ({"flexspline_type": " Cup "}, "complete"),
    ({"flexspline_type": None}, "complete"),
    ({"torque_Nm": "800 Nm"}, "torque is not a number above 0 N·m"),
    ({"torque_Nm": -1.0}, "torque is not a number above 0 N·m"),
    ({"torque_Nm": True}, "torque is not a number above 0 N·m"),
    ({"wall_thickness_mm": 0.0}, "wall thickness is not a number above 0 mm"),
    ({"disk_cone_angle_deg": 29.0}, "disk cone angle is not a number from 30 to 90 °"),
    ({"disk_cone_angle_deg": 91.0}, "disk cone angle is not a number from 30 to 90 °"),
    ({"disk_cone_angle_deg": datetime.date(2026, 1, 1)}, "disk cone angle is not a number from 30 to 90 °"),
    ({"disk_thickness_exponent": 11.0}, "disk thickness exponent is not a number from 0 to 10"),
    ({"hub_fillet_radius_mm": -1.0}, "hub fillet radius is not a number of at least 0 mm"),
    ({"cylinder_length_mm": ErrorCell("#REF!")}, "a cell holds an error"),
    ({"notes": ErrorCell("#N/A"), "torque_Nm": None}, "a cell holds an error"),
    ({"mean_radius_mm": None}, "neither mean radius nor bore diameter is given"),
    ({"bore_diameter_mm": 160.0}, "mean radius and bore diameter are both given"),
    ({"disk_inner_radius_mm": None}, "a cup without a disk inner radius"),
    (HAT | {"disk_outer_radius_mm": None}, "a hat without a disk outer radius"),
    ({"flexspline_type": "cylinder"}, "a cylinder has no disk inner radius"),
    (TUBE | {"disk_thickness_mm": 1.6}, "a cylinder has no disk thickness"),
    (TUBE | {"disk_outer_radius_mm": 80.0}, "a cylinder has no disk outer radius"),
    (TUBE | {"disk_cone_angle_deg": 60.0}, "a cylinder has no disk cone angle"),
    (TUBE | {"disk_thickness_exponent": 2.0}, "only a cup has a disk thickness exponent"),
    (HAT | {"disk_hub_thickness_mm": 2.0}, "only a cup has a disk thickness at hub"),
    (HAT | {"junction_fillet_radius_mm": 3.0}, "only a cup has a junction fillet radius"),
    (TUBE | {"hub_fillet_radius_mm": 3.0}, "only a cup has a hub fillet radius"),
    (TUBE | {"hub_fillet_radius_mm": 0.0, "load_inertia_kg_m2": 1.0}, "complete"),
    ({"disk_thickness_exponent": 2.0}, "an exponent without a thickness at hub"),
    ({"disk_thickness_exponent": 0}, "an exponent without a thickness at hub"),
    (
        {"disk_thickness_exponent": 2.0, "disk_hub_thickness_mm": 4.0, "disk_thickness_mm": 1.6},
        "an exponent and a disk thickness are both given",
    ),
    ({"disk_thickness_exponent": 2.0, "disk_hub_thickness_mm": 4.0}, "complete"),
    ({"disk_hub_thickness_mm": 4.0, "disk_thickness_mm": 1.6}, "complete"),
    ({"disk_cone_angle_deg": 60.0, "load_inertia_kg_m2": 0.5}, "complete"),
    ({"disk_cone_angle_deg": 60.0, "hub_fillet_radius_mm": 3.0}, "a conical disk with a hub fillet radius"),
    ({"disk_cone_angle_deg": 60.0, "junction_fillet_radius_mm": 3.0}, "a conical disk with a junction fillet radius"),
    ({"disk_cone_angle_deg": 90.0, "hub_fillet_radius_mm": 3.0}, "complete"),
    ({"load_inertia_kg_m2": "0,5"}, "load inertia is not a number above 0 kg·m²"),
    ({"load_inertia_kg_m2": -0.5}, "load inertia is not a number above 0 kg·m²"),
    ({"disk_inner_radius_mm": 81.0}, "disk inner radius is not below disk outer radius"),
    (
        {"disk_inner_radius_mm": 60.0, "disk_outer_radius_mm": 50.0},
        "disk inner radius is not below disk outer radius",
    ),
    ({"mean_radius_mm": None, "bore_diameter_mm": 78.0}, "disk inner radius is not below disk outer radius"),
    (HAT | {"disk_outer_radius_mm": 80.0}, "disk inner radius is not below disk outer radius"),
    ({"disk_inner_radius_mm": 79.5}, "complete"),
    ({"mean_radius_mm": None, "bore_diameter_mm": 81.0}, "complete"),
    ({"wall_thickness_mm": 160.0}, "wall is not below twice the mean radius: no bore"),
    ({"wall_thickness_mm": 450.0, "mean_radius_mm": None, "bore_diameter_mm": 81.0}, "complete"),
    (HAT | {"disk_outer_radius_mm": 81.6}, "complete"),
    ({"rim_length_mm": 20.0}, "a tooth rim without a thickness"),
    ({"rim_thickness_mm": 3.2}, "a tooth rim without a length"),
    (RIM, "complete"),
    (RIM | {"rim_length_mm": 160.0}, "tooth rim is not shorter than the cylinder"),
    (RIM | {"rim_thickness_mm": 1.5}, "tooth rim is thinner than the wall"),
    (RIM | {"rim_thickness_mm": 1.6}, "complete"),
    ({"hub_fillet_radius_mm": 40.001}, "hub fillet is wider than the disk"),
    ({"hub_fillet_radius_mm": 40.0}, "complete"),
    (RIM | {"junction_fillet_radius_mm": 140.001}, "junction fillet and tooth rim exceed the length"),
    ({"tooth_face_width_mm": 160.0}, "complete"),
    ({"tooth_face_width_mm": 160.001}, "tooth face and junction fillet exceed the length"),
    (
        {"tooth_face_width_mm": 158.0, "junction_fillet_radius_mm": 3.0},
        "tooth face and junction fillet exceed the length",
    ),
    ({"engaged_teeth_percent": 101.0}, "engaged teeth is not a number above 0, at most 100 %"),
    ({"junction_fillet_radius_mm": 79.201}, "junction fillet is wider than the bore"),
    ({"junction_fillet_radius_mm": 79.2}, "complete"),
    ({"tolerance_class": "mine"}, "tolerance class not in Tolerances"),
    ({"tolerance_class": "standard"}, "complete"),
]


@pytest.fixture(scope="module")
def empty():
    """Return the empty template with all optional sheets as openpyxl sees it."""
    return openpyxl.load_workbook(io.BytesIO(template_bytes(Filling(optional=OPTIONAL_SHEETS))))


@pytest.fixture(scope="module")
def plain():
    """Return the empty template without optional sheets as openpyxl sees it."""
    return openpyxl.load_workbook(io.BytesIO(template_bytes()))


@pytest.fixture(scope="module")
def filled(tmp_path_factory):
    """Return a template filled with one row per status, two of them of the same name."""
    base = {
        "flexspline_type": "cup",
        "material": "20Cr2Ni4",
        "torque_Nm": 800.0,
        "cylinder_length_mm": 160.0,
        "mean_radius_mm": 80.0,
        "wall_thickness_mm": 1.6,
        "disk_inner_radius_mm": 40.0,
    }
    rows = [{"variant": f"row {number}", **base, **change} for number, (change, _) in enumerate(STATUS_ROWS)]
    rows += [{"variant": "twin", **base}, {"variant": "twin", **base}]
    path = tmp_path_factory.mktemp("filled") / "filled.xlsx"
    path.write_bytes(template_bytes(Filling(variants=rows)))
    return path


@pytest.fixture(scope="module")
def recalculated(filled):
    """Return the same file as a spreadsheet program recalculates and saves it."""
    return convert(filled, "xlsx", filled.parent)


def _statuses(path):
    sheet = openpyxl.load_workbook(path, data_only=True)["Variants"]
    return [sheet.cell(FIRST_ROW + 1 + place, len(VARIANTS) + 1).value for place in range(len(STATUS_ROWS) + 2)]


@pytest.mark.parametrize("name", ENTRY_SHEETS)
def test_headers_are_the_labels(empty, name):
    """Each entry sheet has one header row whose cells are exactly the labels, and no data key or unit rows."""
    cells = [cell.value for cell in empty[name][HEADER_ROW + 1]]
    labels = [column.label for column in ENTRY_SHEETS[name]]
    assert cells[: len(labels)] == labels
    assert cells[len(labels) :] in ([], ["Row status"], [None])


def test_optional_sheets_are_there_where_they_are_asked_for(plain):
    """The plain template has none of them and says in its dictionary how to get them; others have what is named."""
    assert plain.sheetnames == ["Variants", "Sketch", "Materials", "Tolerances", "Settings", "Dictionary", "Lists"]
    told = {row[0].value: row[-1].value for row in plain["Dictionary"]["A2:G99"] if row[0].value in OPTIONAL_SHEETS}
    assert {name: f"--with {name.lower().replace(' ', '-')}" in text for name, text in told.items()} == dict.fromkeys(
        OPTIONAL_SHEETS, True
    )
    book = openpyxl.load_workbook(io.BytesIO(template_bytes(Filling(optional=["Correlations"]))))
    names = ["Variants", "Sketch", "Materials", "Tolerances", "Settings", "Correlations", "Dictionary", "Lists"]
    assert book.sheetnames == names


def test_a_sample_is_picked_where_there_are_any(empty, plain):
    """Tolerances' column Sample has the drop-down of samples beside Measurements, else says where they come from."""
    column = [cell.value for cell in plain["Tolerances"][HEADER_ROW + 1]].index("Sample") + 1
    (picked, free) = (
        next(
            rule
            for rule in book["Tolerances"].data_validations.dataValidation
            if any(area.min_col == column and area.min_row > HEADER_ROW + 1 for area in rule.sqref.ranges)
        )
        for book in (empty, plain)
    )
    assert (picked.type, picked.formula1) == ("list", "fl_samples")
    assert (free.type, "--with measurements" in free.prompt) == (None, True)


def test_columns_of_the_process_fold_away(plain):
    """What the shop knows of its process stands in an outline group, expanded, so that Tolerances stays readable."""
    sheet = plain["Tolerances"]
    labels = [cell.value for cell in sheet[HEADER_ROW + 1]]
    folded = [
        labels[place - 1]
        for dimension in sheet.column_dimensions.values()
        if dimension.outlineLevel and not dimension.hidden
        for place in range(dimension.min, dimension.max + 1)
    ]
    assert folded == ["Mean shift", "Standard deviation", "Cp", "Cpk", "Sample", "Scatters between"]
    groups = [cell.value for cell in sheet[HEADER_ROW] if cell.value]
    assert groups == ["Class", "Drawing", "Scatter", "Process", "Inheritance"]


@pytest.mark.parametrize("name", ENTRY_SHEETS)
def test_every_entry_cell_has_a_hint(empty, name):
    """Every column of every entry sheet carries an input message and a note on its header."""
    sheet = empty[name]
    hinted = {
        column
        for rule in sheet.data_validations.dataValidation
        if rule.prompt
        for area in rule.sqref.ranges
        for column in range(area.min_col, area.max_col + 1)
        if area.min_row == FIRST_ROW + 1
    }
    wanted = {2} if name == "Settings" else set(range(1, len(ENTRY_SHEETS[name]) + 1))
    assert wanted <= hinted
    for place, column in enumerate(ENTRY_SHEETS[name], start=1):
        note = sheet.cell(HEADER_ROW + 1, place).comment
        assert note is not None
        assert column.help in note.text


def test_every_rule_has_an_error_text_of_our_own(empty):
    """No cell rule leaves the user with Excel's own error text."""
    rules = [rule for sheet in ENTRY_SHEETS for rule in empty[sheet].data_validations.dataValidation]
    assert all(rule.error for rule in rules if rule.type)
    assert len(rules) > 30


def test_lists_come_from_defined_names(empty):
    """Every drop-down refers to a defined name beginning with fl_, which exists."""
    used = {
        rule.formula1
        for sheet in ENTRY_SHEETS
        for rule in empty[sheet].data_validations.dataValidation
        if rule.type == "list"
    }
    assert used == {
        "fl_flexspline_types", "fl_materials", "fl_tolerance_classes", "fl_dimensions", "fl_grades",
        "fl_deviation_units", "fl_distributions", "fl_methods", "fl_samples", "fl_scatters_between", "fl_uses",
        "fl_enter_as", "fl_source_distributions", "fl_sides", "fl_kinds", "fl_levers", "fl_answers", "fl_sizes",
        "fl_variant_names", "fl_angle_units",
    }  # fmt: skip
    assert used <= set(empty.defined_names)
    assert empty["Lists"].sheet_state == "hidden"


def test_variants_is_not_protected_and_the_header_is_guarded(empty):
    """Sorting and deleting rows stay possible, while typing over a header is refused with our text."""
    sheet = empty["Variants"]
    assert not sheet.protection.sheet
    guards = [rule for rule in sheet.data_validations.dataValidation if rule.formula1 == "FALSE"]
    assert [str(rule.sqref) for rule in guards] == [f"A{HEADER_ROW + 1}:AC{HEADER_ROW + 1}"]
    assert sheet.freeze_panes == f"B{FIRST_ROW + 1}"


def test_nothing_is_merged_in_entry_tables(empty):
    """Entry tables have no merged cells, which would break sorting and reading."""
    assert all(not empty[name].merged_cells.ranges for name in ENTRY_SHEETS)


def test_the_version_is_stamped_twice(empty):
    """The template's version stands in a visible cell and in a document property."""
    texts = [cell.value for row in empty["Variants"]["A1:W2"] for cell in row]
    assert f"Template version {TEMPLATE_VERSION}" in texts
    properties = {one.name: one.value for one in empty.custom_doc_props.props}
    assert properties == {"flexlash": "template", "flexlash_template_version": str(TEMPLATE_VERSION)}


def test_two_thousand_rows_do_not_bloat_the_file():
    """The empty template with its 2,000 prepared rows, and 500 of tolerances, stays under 100 kB."""
    assert len(template_bytes()) < 100_000


def test_the_same_bytes_every_time():
    """The template is byte for byte the same whenever it is written."""
    assert template_bytes(study()) == template_bytes(study())


def test_stored_status_tells_what_a_row_lacks(filled):
    """The stored row status names the first thing that a row lacks."""
    assert _statuses(filled) == [text for _, text in STATUS_ROWS] + ["variant used twice"] * 2


@pytest.mark.slow
@needs_libreoffice
def test_the_status_formula_calculates_what_is_stored(filled, recalculated):
    """Recalculated by a spreadsheet program, every status formula gives its stored text."""
    assert _statuses(recalculated) == _statuses(filled)


@pytest.mark.slow
@needs_libreoffice
def test_the_live_sentence_counts_complete_rows(filled, recalculated):
    """The sentence above the table counts the complete rows, stored and recalculated."""
    complete = [text for _, text in STATUS_ROWS].count("complete")
    for path in (filled, recalculated):
        sheet = openpyxl.load_workbook(path, data_only=True)["Variants"]
        assert sheet.cell(2, 10).value == f"{complete} of {len(STATUS_ROWS) + 2} rows complete"


@pytest.mark.slow
@needs_pages
def test_the_template_prints_on_whole_pages(tmp_path):
    """The filled template prints on the pages that its sheets are set up for: no page holds a cut-off column."""
    import subprocess

    document = convert(regenerate.ROOT / "data" / "b3-160-study.xlsx", "pdf", tmp_path)
    pages = subprocess.run(["pdfinfo", document], check=True, capture_output=True, text=True).stdout
    count = int(next(line for line in pages.splitlines() if line.startswith("Pages")).split()[1])
    assert count == 3 * 2 + 1 + 1 + 2 + 1 + 2  # Variants, Sketch, Materials, Tolerances, Settings, Dictionary


@pytest.mark.slow
@needs_libreoffice
def test_the_class_list_follows_tolerances(tmp_path):
    """The drop-down of classes holds each name of Tolerances once, stored and recalculated."""
    path = tmp_path / "study.xlsx"
    path.write_bytes(template_bytes(study()))
    for one in (path, convert(path, "xlsx", tmp_path)):
        sheet = openpyxl.load_workbook(one, data_only=True)["Lists"]
        (place,) = [cell.column for cell in sheet[1] if cell.value == "fl_tolerance_classes"]
        names = [sheet.cell(row, place).value for row in range(2, 7)]
        assert [name or "" for name in names] == ["standard", "turning", "grinding", "", ""]


def test_every_rule_of_the_book_has_a_row():
    """Each rule whose breach is an error has a row above whose status names it."""
    told = {text for _, text in STATUS_ROWS}
    assert {rule.words for rule in PART_RULES if rule.is_error} <= told


def test_the_status_stays_within_what_excel_takes(empty):
    """Each formula of the status is shorter and less deeply nested than Excel allows: 8,192 characters, 64 levels."""
    decided = (*SOURCE_STATUS, *LEVER_STATUS, *SWEEP_STATUS)
    stages = [*VARIANT_STATUS, *tolerance_status(has_measurements=True), *CORRELATION_STATUS, *decided]
    names = {name for name in empty.defined_names if name.endswith("_status")} | {stage.name for stage in stages}
    assert len(names) == len(stages) + 6
    for name in names:
        formula = empty.defined_names[name].attr_text
        assert len(formula) < 8000
        depths = itertools.accumulate({"(": 1, ")": -1}.get(letter, 0) for letter in formula)
        assert max(depths) < 60
