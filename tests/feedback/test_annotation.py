"""The marked copy: guilty cells coloured and noted, nothing else touched, marks replaced by a second marking."""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
import zipfile
from copy import copy

import marking_samples
import openpyxl
import pytest
import xlsxwriter
from libreoffice import convert, needs_libreoffice
from marking_samples import fault, loaded, look, notes, own_workbook, rewritten, rich_workbook
from openpyxl.comments import Comment
from openpyxl.styles import PatternFill

from flexlash.feedback.annotation import findings_workbook, marked_copy, marked_table
from flexlash.feedback.annotation.appearance import COLOURS
from flexlash.feedback.annotation.findings_list import MOST_LISTED, counted
from flexlash.feedback.annotation.marked_copy import MOST_NOTES
from flexlash.reading.raw import ErrorCell, RawSheet

FAULTS = (
    fault(cell="B2", message="Data!B2 is too large.", fix="Make it smaller."),
    fault(cell="B3", level="warning", code="W401"),
    fault(cell="C5", level="info", code="I501"),
    fault(cell="D7"),
    fault(cell="H5"),
    fault(cell="B10", code="E208"),
    fault(sheet="It's hidden", cell="B2"),
    fault(sheet="It's hidden", cell="C9", level="warning", code="W401"),
    fault(sheet="Elsewhere", cell="A1"),
    fault(sheet="", cell="", code="E101"),
    fault(sheet="Data", cell="ZZZ99"),
)
SHEET_RELATIONS = "xl/worksheets/_rels/sheet1.xml.rels"
MARKED = {
    ("Data", "B2"): "error",
    ("Data", "B3"): "warning",
    ("Data", "D7"): "error",
    ("Data", "H5"): "error",
    ("Data", "A9"): "error",
    ("It's hidden", "B2"): "error",
    ("It's hidden", "C9"): "warning",
}


def _marked(data=None, findings=FAULTS):
    return marked_copy(own_workbook() if data is None else data, findings, "mine.xlsx").data


def level_of(fill):
    """Return the level whose fill this is, None for a fill of the user's."""
    levels = {colour: level for level, colour in COLOURS.items()}
    return levels.get(fill.fgColor.rgb) if fill.fill_type == "solid" and fill.fgColor.type == "rgb" else None


def _resaved(data, change):
    workbook = loaded(data)
    change(workbook)
    buffer = io.BytesIO()
    workbook.save(buffer)
    return buffer.getvalue()


def parts_of(data):
    """Return the parts of a workbook by name."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def _levels(data):
    return {
        (sheet.title, cell.coordinate): level_of(cell.fill)
        for sheet in loaded(data).worksheets
        if not str(sheet["A1"].value).startswith("flexlash")
        for row in sheet.iter_rows()
        for cell in row
        if level_of(cell.fill)
    }


def _listed(data):
    """Return the texts of the Findings sheet by row."""
    return [["" if cell is None else cell for cell in row] for row in loaded(data).worksheets[0].values]


def test_guilty_cells_are_filled_by_their_worst_level():
    """Errors and warnings have their fills, also on blank, merged and hidden cells; no other cell has one."""
    assert _levels(_marked()) == MARKED


def test_an_error_outweighs_a_warning_on_the_same_cell():
    """A cell with both is filled as an error, whichever comes first."""
    findings = [fault(level="warning", code="W401"), fault(), fault(level="warning", code="W402")]
    assert _levels(_marked(findings=findings)) == {("Data", "B2"): "error"}


def test_fills_differ_in_lightness():
    """The two fills can be told apart without hue, and black text is legible on both."""
    luminance = {}
    for level, colour in COLOURS.items():
        channels = [int(colour[place : place + 2], 16) / 255 for place in (2, 4, 6)]
        linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in channels]
        luminance[level] = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    assert luminance["warning"] / luminance["error"] > 1.5
    assert all((light + 0.05) / 0.05 > 7 for light in luminance.values())


def test_notes_say_code_message_and_fix():
    """Each guilty cell's note names code, message and fix; the user's own words stand above."""
    found = notes(_marked())
    text, author = found["Data", "B2"]
    assert text.startswith("JM: measured twice\n\n")
    assert "Error E202: Data!B2 is too large.\nFix: Make it smaller." in text
    assert author == "JM"
    assert "Warning W401" in found["Data", "B3"][0]
    assert found["Data", "B3"][1] == "flexlash"
    assert found["Data", "C3"] == ("only theirs", "JM")
    assert set(found) == {*MARKED, ("Data", "C3")}


def test_all_findings_of_a_cell_are_in_its_note():
    """A cell with three findings tells all three, the error first, also the info."""
    found = [fault(level="info", code="I501"), fault(level="warning", code="W401"), fault(code="E207")]
    text = notes(_marked(findings=found))["Data", "B2"][0]
    assert text.index("E207") < text.index("W401") < text.index("I501")


def test_notes_are_large_enough():
    """A note's box grows with its text, also one with the user's own words; boxes of notes without a mark stay."""

    def change(workbook):
        workbook["Data"]["B2"].comment = Comment("word " * 150, "JM")
        workbook["Data"]["C3"].comment = Comment("word " * 150, "JM", height=33)

    with zipfile.ZipFile(io.BytesIO(_marked(_resaved(own_workbook(), change)))) as archive:
        drawing = archive.read("xl/drawings/commentsDrawing1.vml").decode()
    heights = sorted(int(part.split("px")[0]) for part in drawing.split("height:")[1:])
    assert len(heights) == 6
    assert heights[0] == 33
    assert heights[1] >= 17 * 3
    assert heights[-1] > 17 * 15


def test_only_the_fill_of_a_guilty_cell_changes():
    """Font, number format, border, protection and value of a guilty cell are as before."""
    before, after = loaded(own_workbook())["Data"]["B2"], loaded(_marked())["Data"]["B2"]
    for trait in ("value", "font", "number_format", "border", "protection", "alignment"):
        assert repr(getattr(before, trait)) == repr(getattr(after, trait))


def test_a_blank_cell_keeps_the_format_of_its_column():
    """A guilty cell that was not there takes its column's number format, not the workbook's."""
    assert loaded(_marked())["Data"]["H5"].number_format == "0.0"


def test_nothing_else_is_touched():
    """Values, formulas, validations, names, formats, widths, hidden states, protection and set-up are as before."""
    before, after = loaded(own_workbook()), loaded(_marked())
    assert dict(after.defined_names) == dict(before.defined_names)
    assert [name for name in after.sheetnames if "flexlash" not in name] == before.sheetnames
    for theirs in before.worksheets:
        ours = after[theirs.title]
        values = [[cell.value for cell in row] for row in theirs.iter_rows()]
        assert [[cell.value for cell in row][: len(values[0])] for row in ours.iter_rows(max_row=len(values))] == values
        for trait in ("sheet_state", "freeze_panes", "print_area", "print_title_rows", "merged_cells"):
            assert getattr(ours, trait) == getattr(theirs, trait)
        assert list(map(str, ours.data_validations.dataValidation)) == list(
            map(str, theirs.data_validations.dataValidation)
        )
        assert ours.page_setup.orientation == theirs.page_setup.orientation
        assert dict(ours.protection) == dict(theirs.protection)
        for bands, traits in (
            ("column_dimensions", ("width", "hidden", "fill")),
            ("row_dimensions", ("hidden", "outlineLevel")),
        ):
            for place, band in getattr(theirs, bands).items():
                for trait in traits:
                    assert repr(getattr(getattr(ours, bands)[place], trait)) == repr(getattr(band, trait))


def test_a_blank_cell_with_a_link_stays_blank():
    """A link on a blank cell stays, and the cell does not get the link as its text."""
    with zipfile.ZipFile(io.BytesIO(_marked())) as archive:
        sheet = archive.read("xl/worksheets/sheet1.xml").decode()
    assert re.search('<c r="F6" s="[0-9]+" ?/>|<c r="F6" s="[0-9]+" t="n" ?/>', sheet)
    assert re.search('<hyperlink [^>]*ref="F6" r:id=', sheet)


@pytest.mark.parametrize("make", [own_workbook, rich_workbook])
def test_nothing_but_formats_of_cells_and_marks_changes(make):
    """Every part without a mark is byte for byte the original's, and in a marked sheet all that is in its cells."""
    before, after = parts_of(make()), parts_of(_marked(make(), [fault(cell="A1"), fault(cell="D7")]))
    changed = {name for name in before if before[name] != after[name]}
    assert changed == {
        "[Content_Types].xml", "_rels/.rels", "xl/_rels/workbook.xml.rels", "xl/workbook.xml", "xl/styles.xml",
        "xl/worksheets/sheet1.xml",
        *((set(before) & {"xl/comments/comment1.xml", "xl/drawings/commentsDrawing1.vml"}) or {SHEET_RELATIONS}),
        *({"xl/worksheets/sheet3.xml"} if make is own_workbook else set()),
    }  # fmt: skip

    def cells(part):
        data = re.search(rb"<sheetData>.*</sheetData>", part, re.DOTALL)[0]
        return re.sub(rb' s="\d+"|<c r="D7"[^>]*/>|<row r="7">(?=</row>)', b"", data)

    assert cells(after["xl/worksheets/sheet1.xml"]) == cells(before["xl/worksheets/sheet1.xml"])
    assert set(after) >= set(before)


def test_users_formats_do_not_hide_a_mark():
    """Where a conditional format of the user's reaches a guilty cell, a rule of ours stands before it."""
    sheet = loaded(_marked())["Data"]
    rules = {str(area.sqref): area.rules[0] for area in sheet.conditional_formatting}
    assert set(rules) == {"B2:C4", "B2", "B3"}
    assert rules["B2"].priority < rules["B2:C4"].priority
    assert rules["B3"].priority < rules["B2:C4"].priority
    again = loaded(_marked(_marked(), []))["Data"].conditional_formatting
    assert [(str(area.sqref), area.rules[0].priority) for area in again] == [("B2:C4", 1)]


def test_marking_twice_shows_the_same():
    """A marked copy marked again for the same findings is the same file."""
    once = _marked()
    assert _marked(once) == once


def test_marks_go_when_findings_go():
    """Marked again without findings, cells, fills and notes are those of the original."""
    before = own_workbook()
    clean = _marked(_marked(before), [])
    assert look(clean) == look(before)
    assert notes(clean) == notes(before)
    assert "no errors and no warnings" in _listed(clean)[1][0].lower()


def test_new_findings_replace_old_ones():
    """A second marking shows its own findings alone."""
    second = _marked(_marked(), [fault(cell="C3", level="warning", code="W402")])
    assert _levels(second) == {("Data", "C3"): "warning"}
    assert [row[1] for row in _listed(second) if row[0] == "warning"] == ["W402"]
    assert loaded(second).sheetnames.count("Findings") == 1
    assert len(loaded(second).sheetnames) == len(loaded(_marked()).sheetnames)


def test_what_the_user_changed_meanwhile_stays():
    """Words added above our note, and a fill chosen after the marking, survive the next marking."""

    def change(workbook):
        cell = workbook["Data"]["D7"]
        cell.comment = Comment(f"ask Anna\n\n{cell.comment.text}", "AB")
        workbook["Data"]["B3"].fill = PatternFill("solid", fgColor="FF123456")

    clean = _marked(_resaved(_marked(), change), [])
    assert notes(clean)["Data", "D7"][0] == "ask Anna"
    assert loaded(clean)["Data"]["B3"].fill.fgColor.rgb == "FF123456"


def test_sorted_rows_take_their_marks_along():
    """A mark that was moved within its column is taken away where it is now."""

    def change(workbook):
        guilty, other = workbook["Data"]["D7"], workbook["Data"]["D6"]
        note, guilty.comment = guilty.comment, None
        other.comment = Comment(note.text, note.author)
        other.fill, guilty.fill = copy(guilty.fill), PatternFill()

    moved = _resaved(_marked(), change)
    assert _levels(moved)["Data", "D6"] == "error"
    clean = _marked(moved, [])
    assert _levels(clean) == {}
    assert ("Data", "D6") not in notes(clean)


@pytest.mark.slow
@needs_libreoffice
def test_marks_survive_libreoffice(tmp_path):
    """After a round trip through LibreOffice the marks are replaced and taken away as before."""
    original, copy = tmp_path / "original.xlsx", tmp_path / "copy.xlsx"
    original.write_bytes(own_workbook())
    copy.write_bytes(_marked())
    plain = convert(original, "xlsx", tmp_path).read_bytes()
    travelled = convert(copy, "xlsx", tmp_path).read_bytes()
    clean = _marked(travelled, [])
    assert look(clean) == look(plain)
    assert {place: text for place, (text, _) in notes(clean).items()} == {
        place: text for place, (text, _) in notes(plain).items()
    }
    again = _marked(travelled)
    assert _levels(again) == MARKED
    assert loaded(again).sheetnames == loaded(_marked()).sheetnames


def test_the_findings_sheet_lists_all_worst_first():
    """Every finding is listed with its words; errors come before warnings before infos, rules together."""
    rows = [row for row in _listed(_marked()) if row[0] in {"error", "warning", "info"}]
    assert len(rows) == len(FAULTS)
    order = {"error": 0, "warning": 1, "info": 2}
    assert [(row[0], row[1]) for row in rows] == sorted(
        ((one.level, one.code) for one in FAULTS), key=lambda pair: (order[pair[0]], pair[1])
    )
    assert any("Data!B2 is too large." in row and "Make it smaller." in row for row in rows)


def test_cells_are_linked():
    """Each address leads to its cell, quotes in sheet names doubled; what is not in the file has no link."""
    sheet = loaded(_marked()).worksheets[0]
    links = {cell.hyperlink.location for row in sheet.iter_rows() for cell in row if cell.hyperlink}
    assert {"'Data'!B2", "'It''s hidden'!B2"} <= links
    assert not any("Elsewhere" in link for link in links)


def test_the_findings_sheet_says_what_the_file_is():
    """Its first lines count, say what to do, and it opens first, alone, under a title of its own."""
    workbook = loaded(_marked())
    first = workbook.worksheets[0]
    assert first.title == "flexlash Findings"
    assert workbook["Findings"]["A1"].value == "an own sheet of this name"
    assert first["A2"].value.startswith("8 errors and 2 warnings.")
    assert "submit" in first["A3"].value
    assert workbook.active is first
    assert [sheet.title for sheet in workbook if sheet.sheet_view.tabSelected] == [first.title]
    assert first.freeze_panes
    assert first.auto_filter.ref
    assert first.print_title_rows
    assert workbook.worksheets[-1].sheet_state == "veryHidden"


@pytest.mark.parametrize("text", ["=1+1", "#REF!", "+1", "@a", "a\x00b\x07", "\ud800", "1.6", "_x0041_", "'1"])
def test_texts_stay_texts(text):
    """No word of a finding becomes a formula or an error, and none stops the copy."""
    one = fault(value=text, suggestion=text, message=text, fix=text)
    for data in (_marked(findings=[one]), findings_workbook([one], text, text)):
        sheet = loaded(data).worksheets[0]
        cells = [cell for row in sheet.iter_rows() for cell in row if cell.value is not None]
        assert {cell.data_type for cell in cells} == {"s"}
        assert any(cell.value in {text, "ab", "_x005F_x0041_"} for cell in cells) or text == "\ud800"


def test_the_copy_is_recognised_and_keeps_other_properties():
    """The property says checked, once; the template's version stays."""

    def add(workbook):
        for name, value in (("flexlash", "template"), ("flexlash_template_version", "3")):
            workbook.custom_doc_props.append(openpyxl.packaging.custom.StringProperty(name=name, value=value))

    found = loaded(_marked(_resaved(own_workbook(), add))).custom_doc_props
    assert {one.name: one.value for one in found} == {"flexlash": "checked", "flexlash_template_version": "3"}
    assert len(found) == 2


@pytest.mark.slow
def test_same_input_same_bytes():
    """The copy does not depend on the day or on the order of sets, and keeps the original's date of change."""
    code = (
        "import hashlib, sys\nsys.path.insert(0, sys.argv[1])\n"
        "import marking_samples as s\nfrom flexlash.feedback.annotation import marked_copy\n"
        "data = sys.stdin.buffer.read()\n"
        "print(hashlib.sha256(marked_copy(data, [s.fault(), s.fault(cell='A9')], 'x').data).hexdigest())"
    )
    data = own_workbook()
    prints = {
        subprocess.run(
            [sys.executable, "-c", code, os.path.dirname(marking_samples.__file__)],  # noqa: PTH120
            input=data,
            capture_output=True,
            check=True,
            env={**os.environ, "PYTHONHASHSEED": seed, "SOURCE_DATE_EPOCH": seed},
        ).stdout
        for seed in ("1", "2", "3")
    }
    assert len(prints) == 1
    assert loaded(_marked(data)).properties.modified == loaded(data).properties.modified
    with zipfile.ZipFile(io.BytesIO(_marked(data))) as archive:
        assert {entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}


@pytest.mark.slow
def test_no_file_is_written():
    """Marking works in a process that may not write a byte to disk."""
    resource = pytest.importorskip("resource")
    code = (
        "import sys, resource\nsys.path.insert(0, sys.argv[1])\nimport marking_samples as s\n"
        "from flexlash.feedback.annotation import marked_copy\ndata = sys.stdin.buffer.read()\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))\nwriting = set('wax+')\n"
        "sys.addaudithook(lambda what, args: what == 'open' and writing & set(str(args[1])) and sys.exit(str(args)))\n"
        "sys.exit(0 if marked_copy(data, [s.fault()], 'x').data else 9)"
    )
    assert resource.RLIMIT_FSIZE is not None
    done = subprocess.run(
        [sys.executable, "-c", code, os.path.dirname(marking_samples.__file__)],  # noqa: PTH120
        input=own_workbook(),
        capture_output=True,
        check=False,
        env={name: value for name, value in os.environ.items() if not name.startswith("COV")},
    )
    assert (done.returncode, done.stderr) == (0, b"")


def test_a_template_type_becomes_a_workbook():
    """A file of Excel's own template type is a plain workbook in the copy, which Excel opens under .xlsx."""
    data = _resaved(own_workbook(), lambda book: setattr(book, "template", True))
    with zipfile.ZipFile(io.BytesIO(_marked(data))) as archive:
        kinds = archive.read("[Content_Types].xml")
    assert b"sheet.main+xml" in kinds
    assert b"template.main+xml" not in kinds


def test_names_beside_chart_sheets_keep_their_sheet():
    """Print areas stay with their sheet when a chart sheet stands before it."""
    buffer = io.BytesIO()
    workbook = xlsxwriter.Workbook(buffer)
    picture, sheet = workbook.add_chartsheet("Picture"), workbook.add_worksheet("Data")
    sheet.write_number(0, 0, 1)
    sheet.print_area("A1:D9")
    chart = workbook.add_chart({"type": "line"})
    chart.add_series({"values": "=Data!$A$1:$A$2"})
    picture.set_chart(chart)
    workbook.close()
    found = loaded(_marked(buffer.getvalue()))
    assert found.sheetnames[:3] == ["Findings", "Picture", "Data"]
    assert found["Data"].print_area == "'Data'!$A$1:$D$9"
    assert found["Findings"].print_title_rows


@pytest.mark.slow
def test_many_cells_have_fills_but_not_all_have_notes():
    """Beyond the limits, fills go on, notes stop, the list stops, and the first lines say so."""
    findings = [fault(cell=f"{'ABC'[place % 3]}{place // 3 + 20}") for place in range(MOST_LISTED + 1)]
    data = _marked(findings=findings)
    assert len(_levels(data)) == MOST_LISTED + 1
    assert len(notes(data)) == MOST_NOTES + 2
    listed = _listed(data)
    assert any(f"Notes are on the first {MOST_NOTES:,}" in str(row[0]) for row in listed[:6])
    assert "1 more" in listed[-1][0]


@pytest.mark.parametrize(
    ("levels", "words"),
    [
        ((), "no errors and no warnings"),
        (("error",), "1 error and no warnings"),
        (("error",) * 1200 + ("warning", "info"), "1,200 errors and 1 warning"),
    ],
)
def test_findings_are_counted_in_words(levels, words):
    """Errors and warnings are counted, infos are not."""
    assert counted([fault(level=level) for level in levels]) == words


def test_findings_alone():
    """Where no copy can be made, the findings stand alone under the reason, without links."""
    data = findings_workbook(FAULTS, "mine.xlsx", "mine.xlsx is damaged.")
    workbook = loaded(data)
    sheet = workbook["Findings"]
    assert workbook.sheetnames == ["Findings"]
    assert sheet["A1"].value == "mine.xlsx is damaged."
    assert not [cell for row in sheet.iter_rows() for cell in row if cell.hyperlink]
    assert workbook.custom_doc_props["flexlash"].value == "checked"
    assert findings_workbook(FAULTS, "mine.xlsx", "mine.xlsx is damaged.") == data


def test_a_table_is_marked_as_a_workbook():
    """A text table becomes a sheet: numbers as numbers, what only looks like one as text, marks as in a workbook."""
    rows = {
        1: {1: "variant", 2: "torque_Nm"},
        2: {1: "007", 2: "800.5"},
        3: {1: "=A1", 2: "1,6"},
        5: {1: "b\x00c", 2: ErrorCell("#REF!")},
    }
    raw = RawSheet(name="Variants", rows=rows, numbers_are_texts=True)
    data = marked_table({"Variants": raw}, [fault(sheet="Variants", cell="B3")], "mine.csv")
    sheet = loaded(data)["Variants"]
    assert [(cell.value, cell.data_type) for cell in (sheet["A2"], sheet["B2"], sheet["A3"], sheet["B5"])] == [
        ("007", "s"),
        (800.5, "n"),
        ("=A1", "s"),
        ("#REF!", "s"),
    ]
    assert _levels(data) == {("Variants", "B3"): "error"}
    assert _levels(_marked(data, [])) == {}


def test_new_relations_have_a_type_where_no_type_holds_for_all():
    """Where a workbook gives each part of relations a type of its own, so does its copy, or it is damaged."""
    data = marked_table({"Data": RawSheet(name="Data", rows={1: {1: "a"}})}, [], "x")
    kind = b'ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    each = b"".join(
        b'<Override PartName="/%s" %s' % (name, kind) for name in (b"_rels/.rels", b"xl/_rels/workbook.xml.rels")
    )
    data = rewritten(data, "[Content_Types].xml", b'<Default Extension="rels" ' + kind, each)
    after = parts_of(_marked(data, [fault(cell="A1")]))
    for name in after:
        assert not name.endswith(".rels") or b'PartName="/%s"' % name.encode() in after["[Content_Types].xml"]
    assert "xl/worksheets/_rels/sheet1.xml.rels" in after
