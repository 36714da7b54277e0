"""The submission as read: filters, comments on guilty cells, percentages, links."""

from __future__ import annotations

from dataclasses import replace

import openpyxl
import pytest
from made_up_parts import measured_parts

from flexlash.feedback.template.template_workbook import template_bytes
from flexlash.pipeline import run
from flexlash.report import submission_sheets


def _report(path, tmp_path):
    outcome = run(path, tmp_path / "report.xlsx", samples=256)
    return outcome, openpyxl.load_workbook(tmp_path / "report.xlsx")


@pytest.fixture
def faulty(table, sound):
    """Return the path of a table with a sound row, two rows without a torque and one with two faults."""
    rows = [
        sound,
        {**sound, "variant": "a", "torque_Nm": ""},
        {**sound, "variant": "b", "torque_Nm": ""},
        {**sound, "variant": "c", "wall_thickness_mm": "thin", "flexspline_type": "cap"},
    ]
    return table(rows)


@pytest.mark.slow
def test_guilty_cells_say_what_is_wrong(faulty, tmp_path):
    """Each guilty cell has its finding's code and message in a comment; no other cell has one."""
    outcome, book = _report(faulty, tmp_path)
    expected = {}
    for found in outcome.findings:
        if found.level != "info":
            expected.setdefault(found.cell, []).append(f"{found.code} {found.message}")
    comments = {cell.coordinate: cell.comment.text for row in book["Submission"].iter_rows()
                for cell in row if cell.comment}  # fmt: skip
    assert comments == {cell: "\n".join(messages) for cell, messages in expected.items()}
    assert len(comments) == 4


@pytest.mark.slow
def test_comments_are_no_more_than_can_be_kept(faulty, tmp_path, monkeypatch):
    """With more guilty cells than comments the first cells have one; all are coloured."""
    monkeypatch.setattr(submission_sheets, "MOST_COMMENTS", 2)
    outcome, book = _report(faulty, tmp_path)
    cells = [cell for row in book["Submission"].iter_rows() for cell in row]
    guilty = {found.cell for found in outcome.findings if found.level == "error"}
    assert sum(cell.comment is not None for cell in cells) == 2
    assert {cell.coordinate for cell in cells if cell.fill.fgColor.rgb == "FFF8CBAD"} == guilty


@pytest.mark.slow
def test_entry_sheets_are_frozen_and_filtered_below_their_headers(workbook, sound, tmp_path):
    """Rows above the header stay on screen, and the table below it can be filtered, on every entry sheet."""
    outcome, book = _report(workbook([sound]), tmp_path)
    for schema, header in outcome.validated.header_rows.items():
        sheet = book["Submission" if schema == "Variants" else schema]
        assert sheet.freeze_panes == f"B{header + 1}"
        first, last = sheet.auto_filter.ref.split(":")
        assert first == f"A{header}"
        assert int(last.lstrip("ABCDEFGHIJKLMNOPQRSTUVWXYZ")) == max(sheet.max_row, header)


@pytest.mark.slow
def test_percentages_look_as_entered(workbook, sound, tmp_path):
    """A cell that showed 5% shows 5% again, whatever was computed of it."""
    path = workbook([sound])
    book = openpyxl.load_workbook(path)
    sheet = book["Tolerances"]
    header = next(cell.row for cell in sheet["A"] if cell.value == "Tolerance class")
    places = {cell.value: cell.column for cell in sheet[header]}
    row = ["standard-2", "wall_thickness", -0.05, 0.125, "%"]
    labels = ("Tolerance class", "Dimension", "Lower deviation", "Upper deviation", "Deviation unit")
    last = sheet.max_row + 1
    for label, value in zip(labels, row, strict=True):
        place = next(place for title, place in places.items() if title and title.startswith(label))
        cell = sheet.cell(last, place, value)
        if isinstance(value, float):
            cell.number_format = "0.0%"
    book.save(path)
    _, report = _report(path, tmp_path)
    shown = {cell.value: cell.number_format for cell in report["Tolerances"][last]}
    assert shown[-0.05] == "0%"
    assert shown[0.125] == "0.0%"


@pytest.mark.slow
def test_a_name_that_is_a_number_stays_a_number(workbook, sound, tmp_path):
    """A variant whose name was typed as a number is repeated as a number."""
    _, book = _report(workbook([{**sound, "variant": 12}]), tmp_path)
    assert 12 in [cell.value for cell in book["Submission"]["A"]]


@pytest.mark.slow
def test_nothing_is_cut(workbook, sound, tmp_path):
    """Columns are as wide as their texts below the header; longer ones are wrapped in rows high enough."""
    _, book = _report(workbook([{**sound, "notes": "word " * 40}]), tmp_path)
    for name in ("Submission", "Materials", "Tolerances", "Settings"):
        sheet = book[name]
        header = int(sheet.print_title_rows.rpartition("$")[2])
        for row in sheet.iter_rows(min_row=header + 1):
            for cell in row:
                if isinstance(cell.value, str):
                    dimension = next(
                        one for one in sheet.column_dimensions.values() if one.min <= cell.column <= one.max
                    )
                    height = sheet.row_dimensions[cell.row].height or 15
                    assert 0.9 * len(cell.value) <= dimension.width * height / 15, (name, cell.coordinate)


@pytest.mark.slow
def test_columns_without_an_entry_are_folded_away(workbook, sound, tmp_path):
    """Columns in which no row has an entry or a finding are hidden, so that the page has room for the others."""
    rows = [{**sound, "rim_thickness_mm": 2.0}, {**sound, "variant": "b", "notes": "n"}]
    outcome, book = _report(workbook(rows), tmp_path)
    sheet, header = book["Submission"], outcome.validated.header_rows["Variants"]
    hidden = {
        column
        for one in sheet.column_dimensions.values()
        for column in range(one.min, one.max + 1)
        if one.hidden and one.outlineLevel == 1
    }
    entered = {cell.column for row in sheet.iter_rows(min_row=header + 1) for cell in row if cell.value is not None}
    told = {found.address.column for found in outcome.findings if found.sheet == "Variants" and found.address}
    assert told - entered
    assert hidden == set(range(1, sheet.max_column + 1)) - entered - told
    left = sheet.print_area.replace("$", "").rpartition(":")[2].rstrip("0123456789")
    assert sheet.column_dimensions[left].index == left
    assert not sheet.oddHeader.right.text


@pytest.mark.slow
def test_titles_of_our_template_look_like_titles(workbook, table, sound, tmp_path):
    """The first cell of a sheet of our template is a title; that of a table is a header."""
    _, book = _report(workbook([sound]), tmp_path)
    assert {book[name]["A1"].font.sz for name in ("Submission", "Materials", "Tolerances", "Settings")} == {18}
    _, book = _report(table([sound]), tmp_path)
    assert book["Submission"]["A1"].font.sz == 11


@pytest.mark.slow
def test_measured_parts_and_correlations_stand_at_their_addresses(tmp_path):
    """Both sheets are repeated cell by cell; a value that is blamed is coloured there, and Findings names its cell."""
    filling = measured_parts()
    measured = [dict(row) for row in filling.measurements]
    measured[7]["wall_thickness_mm"] = 1.671
    path = tmp_path / "parts.xlsx"
    path.write_bytes(template_bytes(replace(filling, measurements=measured)))
    outcome, book = _report(path, tmp_path)
    assert ("W446", "Measurements!H12") in {(found.code, found.place) for found in outcome.findings}
    cell = book["Measurements"]["H12"]
    assert (cell.value, cell.comment.text[:4]) == (1.671, "W446")
    assert ("Measurements", "H12") in {(row[2].value, row[3].value) for row in book["Findings"].iter_rows()}
    given = openpyxl.load_workbook(path)
    for name in ("Measurements", "Correlations"):
        rows = [[one.value for one in row[:5]] for row in given[name]["A4:E64"]]
        assert [[one.value for one in row[:5]] for row in book[name]["A4:E64"]] == rows, name
