"""What other programs do to a template when they save it: nothing of it is lost, and it means what it meant."""

from __future__ import annotations

import openpyxl
import pytest
import regenerate
from libreoffice import convert_all, needs_libreoffice
from openpyxl.utils import get_column_letter

from flexlash.feedback.template.upgrade import upgraded
from flexlash.pipeline import check
from flexlash.validation.template_versions import TEMPLATE_VERSION

FILES = {
    "template": "templates/flexlash-template.xlsx",
    "study": "data/b3-160-study.xlsx",
    "calibrated": "data/b3-160-calibrated.xlsx",
    "needs fixing": "data/needs-fixing.xlsx",
    "measured": "data/measured-parts.xlsx",
}
_EVERY = 60
"""Rows at the top of each sheet of which every cell's lock is compared."""


def _through_openpyxl(path, folder):
    saved = folder / "openpyxl.xlsx"
    openpyxl.load_workbook(path).save(saved)
    return saved


def _through_xlsxwriter(path, folder):
    rebuilt = folder / "xlsxwriter.xlsx"
    rebuilt.write_bytes(upgraded(path).data)
    return rebuilt


PROGRAMS = {
    "openpyxl": _through_openpyxl,
    "xlsxwriter": _through_xlsxwriter,
}
HELPLESS = {
    "libreoffice": {"frozen panes"},
    "openpyxl": {"size of notes"},
    "xlsxwriter": set(),
}
"""What a program loses whatever a workbook does: LibreOffice without a window has no view to freeze, and openpyxl
gives every note its own size."""


FORMULAS = {
    "E205": {"libreoffice": "E205", "openpyxl": "E206", "xlsxwriter": "E205"},
    "E206": {"libreoffice": None, "openpyxl": "E206", "xlsxwriter": "E206"},
}
"""What becomes of cells with a formula: LibreOffice calculates it, openpyxl drops every result."""


@pytest.fixture(scope="module")
def through_libreoffice(tmp_path_factory):
    """Return every file, and a plain one with frozen panes, as LibreOffice saves it."""
    folder = tmp_path_factory.mktemp("libreoffice")
    book = openpyxl.Workbook()
    book.active["A1"] = "x"
    book.active.freeze_panes = "B2"
    book.save(folder / "plain.xlsx")
    paths = [*(regenerate.ROOT / file for file in FILES.values()), folder / "plain.xlsx"]
    return dict(zip([*FILES, "plain"], convert_all(paths, "xlsx", folder), strict=True))


TRIPS = [pytest.param(("libreoffice", file), marks=[pytest.mark.slow, needs_libreoffice]) for file in FILES]
TRIPS += [(program, file) for program in PROGRAMS for file in FILES]


@pytest.fixture(scope="module", params=TRIPS, ids="-".join)
def trip(request, tmp_path_factory):
    """Return a program's name, a file, and the same file as that program saves it."""
    program, file = request.param
    path = regenerate.ROOT / FILES[file]
    if program == "libreoffice":
        return program, path, request.getfixturevalue("through_libreoffice")[file]
    return program, path, PROGRAMS[program](path, tmp_path_factory.mktemp("trip"))


@pytest.fixture(scope="module")
def books(trip):
    """Return a program's name and the workbook before and after it."""
    program, before, after = trip
    return program, openpyxl.load_workbook(before), openpyxl.load_workbook(after)


def _truth(formula):
    """Return a formula with FALSE as LibreOffice writes it."""
    return "0" if formula == "FALSE" else formula


def _rules(sheet):
    """Return every data validation with all that its user meets; what a type of rule does not use is left out."""
    found = []
    for rule in sheet.data_validations.dataValidation:
        compared = rule.type in {"decimal", "whole"}
        between = compared and rule.operator in {None, "between", "notBetween"}
        numbers = [_truth(rule.formula1), rule.formula2 if between else None]
        found.append(
            (
                str(rule.sqref),
                rule.type,
                (rule.operator or "between") if compared else None,
                [float(number) if number and compared else number for number in numbers] if rule.type else [],
                (rule.errorTitle, rule.error, rule.promptTitle, rule.prompt),
                (rule.showErrorMessage, rule.showInputMessage, rule.allow_blank, rule.errorStyle or "stop"),
            )
        )
    return sorted(found, key=lambda rule: rule[0])


def _colours(sheet):
    """Return every conditional format: where, when, and the colours that it gives."""
    return sorted(
        (str(area.sqref), rule.type, list(rule.formula), rule.dxf.fill.bgColor.rgb, rule.dxf.font.color.rgb)
        for area in sheet.conditional_formatting
        for rule in area.rules
    )


def _protection(sheet):
    """Return what a sheet's protection forbids."""
    names = ("sheet", "formatColumns", "formatCells", "sort", "insertRows", "deleteRows", "selectLockedCells")
    return {name: getattr(sheet.protection, name) for name in names} if sheet.protection.sheet else {}


def _locks(sheet, area):
    """Return which cells of an area are locked, by their own format or their column's."""
    columns = {
        place: dimension.protection.locked
        for dimension in sheet.column_dimensions.values()
        if dimension.has_style
        for place in range(dimension.min, dimension.max + 1)
    }
    return {
        cell.coordinate: cell.protection.locked if cell.has_style else columns.get(cell.column, True)
        for row in sheet[area]
        for cell in row
    }


def _columns(sheet):
    """Return width, outline level and hidden state of every column."""
    found = {}
    for dimension in sheet.column_dimensions.values():
        for place in range(dimension.min, min(dimension.max, 60) + 1):
            level = dimension.outlineLevel or 0
            found[get_column_letter(place)] = (round(dimension.width, 1), level, bool(dimension.hidden))
    return found


def _notes(sheet):
    return {
        cell.coordinate: cell.comment.text.strip()
        for row in sheet["A1:AD60"]
        for cell in row
        if cell.comment is not None
    }


def _page(sheet):
    """Return how a sheet is printed."""
    setup, footer = sheet.page_setup, sheet.oddFooter
    fit = sheet.sheet_properties.pageSetUpPr
    fits = bool(fit and fit.fitToPage)
    return {
        "titles": sheet.print_title_rows,
        "area": sheet.print_area,
        "pages": (setup.orientation or "portrait", fits, (setup.fitToWidth or 1, setup.fitToHeight) if fits else None),
        "paper": setup.paperSize if fits else None,
        "footer": (footer.left.text, footer.center.text, footer.right.text),
    }


def test_names_are_kept(books):
    """Every defined name refers to what it referred to."""
    _, before, after = books
    assert {name: one.attr_text for name, one in after.defined_names.items()} == {
        name: one.attr_text for name, one in before.defined_names.items()
    }
    assert len(before.defined_names) == (28 if "Measurements" in before.sheetnames else 22)


def test_properties_are_kept(books):
    """Role, version, title and description are kept, the version as the text that it was."""
    _, before, after = books
    properties = {one.name: one.value for one in after.custom_doc_props.props}
    assert properties == {one.name: one.value for one in before.custom_doc_props.props}
    assert properties["flexlash_template_version"] == str(TEMPLATE_VERSION)
    assert after.properties.title == before.properties.title == "flexlash template"
    assert after.properties.description == before.properties.description


def test_sheets_keep_their_order_and_hidden_state(books):
    """All sheets are there in order, the lists still hidden."""
    _, before, after = books
    assert [(one.title, one.sheet_state) for one in after] == [(one.title, one.sheet_state) for one in before]
    assert after["Lists"].sheet_state == "hidden"


def test_rules_of_cells_are_kept(books):
    """Every data validation is kept with its range, condition, list, hint and error text."""
    _, before, after = books
    for sheet in before:
        assert _rules(after[sheet.title]) == _rules(sheet)
    assert sum(len(_rules(sheet)) for sheet in before) == (91 if "Measurements" in before.sheetnames else 65)


def test_lists_are_kept(books):
    """The lists behind the drop-downs hold what they held, constants and formulas alike."""
    _, before, after = books
    kept = [[str(getattr(cell.value, "text", cell.value)) for cell in row] for row in after["Lists"]["A1:N40"]]
    assert kept == [[str(getattr(cell.value, "text", cell.value)) for cell in row] for row in before["Lists"]["A1:N40"]]


def test_colours_by_rule_are_kept(books):
    """Every conditional format is kept with range, formula and colours."""
    _, before, after = books
    for sheet in before:
        assert _colours(after[sheet.title]) == _colours(sheet)
    assert len(_colours(before["Variants"])) == 42


def test_no_colour_depends_on_another_being_skipped(books):
    """The two colours of the status never apply to the same cell, since programs forget which rule stops the next."""
    _, _, after = books
    status = [rule for rule in _colours(after["Variants"]) if rule[0].startswith("AC5")]
    assert {rule[2][0] for rule in status} == {'$AC5="complete"', 'AND(LEN($AC5)>0,$AC5<>"complete")'}


def test_locks_are_kept(books):
    """Sheets stay protected or open as they were, and each cell locked or free."""
    _, before, after = books
    for sheet in before:
        assert _protection(after[sheet.title]) == _protection(sheet)
        area = f"A1:{get_column_letter(sheet.max_column)}{min(sheet.max_row, _EVERY)}"
        assert _locks(after[sheet.title], area) == _locks(sheet, area)
    assert {sheet.title for sheet in before if _protection(sheet)} == {"Sketch", "Settings", "Dictionary", "Lists"}


def test_columns_are_kept(books):
    """Widths, the outline group of the refinements and hidden columns are kept."""
    _, before, after = books
    for sheet in before:
        assert _columns(after[sheet.title]) == _columns(sheet)
    assert {level for _, level, _ in _columns(after["Variants"]).values()} == {0, 1}


def test_notes_are_kept(books):
    """Every header keeps its note."""
    _, before, after = books
    for sheet in before:
        assert _notes(after[sheet.title]) == _notes(sheet)
    assert len(_notes(after["Variants"])) == 29


def test_pages_are_kept(books):
    """Print titles, print area, paper, fit to one page wide and footer are kept."""
    _, before, after = books
    for sheet in before:
        assert _page(after[sheet.title]) == _page(sheet)
    assert _page(after["Variants"])["titles"] == "$4:$4"


def test_what_a_program_always_loses_is_known(books):
    """Frozen panes and the size of notes are kept, but for the programs named here."""
    program, before, after = books
    panes = {sheet.title: sheet.freeze_panes for sheet in before}
    lost = set()
    if {sheet.title: sheet.freeze_panes for sheet in after} != panes:
        lost.add("frozen panes")
    size = before["Variants"]["A4"].comment.width
    if program == "openpyxl" or after["Variants"]["A4"].comment.width != size:
        lost |= {"size of notes"} if program == "openpyxl" else set()
    assert lost <= HELPLESS[program]
    assert panes["Variants"] == "B5"


@pytest.mark.slow
@needs_libreoffice
def test_libreoffice_without_a_window_freezes_nothing(through_libreoffice):
    """The loss of frozen panes is LibreOffice's own: a plain workbook loses them as the template does."""
    kept = [openpyxl.load_workbook(through_libreoffice["plain"]).active.freeze_panes]
    kept += [openpyxl.load_workbook(through_libreoffice["template"])["Variants"].freeze_panes]
    assert kept in ([None, None], ["B2", "B5"])


def test_the_meaning_is_kept(trip):
    """Findings and numbers of a file saved by another program are those of the file before, but for its formulas."""
    program, path, saved = trip
    before, after = check(path), check(saved)
    fed = {f"{one.sheet}!{one.cell}" for one in before.findings if one.code in FORMULAS}
    told, expected = (
        [
            {**one.as_dictionary(), "message": one.message.replace(outcome.submission.name, "")}
            for one in outcome.findings
            if one.place not in fed
        ]
        for outcome in (after, before)
    )
    assert told == expected
    codes = {one.place: one.code for one in after.findings}
    assert [codes.get(place) for place in sorted(fed)] == [FORMULAS[code][program] for code in FORMULAS if fed]
    named = {one.variant for one in before.findings if one.code in FORMULAS}
    kept = ~before.results["variant"].is_in(named)
    assert after.results.filter(kept).equals(before.results.filter(kept))
    assert kept.sum() >= before.results.height - 2
    assert after.settings == before.settings
    assert after.submission.role == "template"
