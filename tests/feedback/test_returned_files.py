"""What goes back: the marked copy, the findings alone where marking is impossible, the fixed submission."""

import json

import openpyxl
import polars as pl
import pytest
from python_calamine import CalamineWorkbook

import flexlash
from flexlash.cli import cli
from flexlash.feedback.splicing.sheet_spans import SheetSpans
from flexlash.feedback.splicing.xml_spans import spliced
from flexlash.pipeline import check, fix, run
from flexlash.reading.archive import packed, unpacked
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.schema.stamps import stamp_at


def _titles(path):
    return openpyxl.load_workbook(path).sheetnames


def _text(path, title="Findings"):
    rows = CalamineWorkbook.from_path(path).get_sheet_by_name(title).to_python()
    return "\n".join(" ".join(map(str, row)) for row in rows)


def _coloured(path, title="Variants"):
    """Return the addresses of cells whose fill is not the template's."""
    plain = {"00000000", "FFFFF5D6", "FFD9E2EC", "FFFFD966", "FFFFEDB3", "FF1F3A5F"}
    sheet = openpyxl.load_workbook(path)[title]
    return {cell.coordinate for row in sheet.iter_rows(min_row=2) for cell in row if cell.fill.fgColor.rgb not in plain}


@pytest.mark.slow
def test_a_run_with_findings_marks_the_submission(workbook, sound, tmp_path):
    """Guilty cells and no others are coloured and noted in a copy of the engineer's own file; the rest is computed."""
    path = workbook([sound, {**sound, "variant": "B", "wall_thickness_mm": "1,6 mm"}])
    outcome = run(path, tmp_path / "out.xlsx", marked_copy=tmp_path / "copy.xlsx")
    assert outcome.outputs == (tmp_path / "out.xlsx", tmp_path / "copy.xlsx")
    assert outcome.written.marked_copy == tmp_path / "copy.xlsx"
    assert _coloured(tmp_path / "copy.xlsx") == {"H6"}
    note = openpyxl.load_workbook(tmp_path / "copy.xlsx")["Variants"]["H6"].comment.text
    assert "E202" in note
    assert "did you mean 1.6?" in note


@pytest.mark.slow
def test_without_errors_and_warnings_no_copy(workbook, sound, tmp_path):
    """What was merely converted or assumed needs no marked copy."""
    outcome = check(workbook([{**sound, "variant": " B3-160 "}]), marked_copy=tmp_path / "copy.xlsx")
    assert [found.level for found in outcome.findings] == ["info"]
    assert outcome.outputs == ()
    assert not (tmp_path / "copy.xlsx").exists()


def test_a_damaged_file_gets_its_findings_alone(tmp_path):
    """A file that cannot be read cannot be marked: the copy holds the finding and says so."""
    path = tmp_path / "bad.xlsx"
    path.write_bytes(b"PK\x03\x04 and no more")
    outcome = run(path, tmp_path / "out.xlsx", marked_copy=tmp_path / "copy.xlsx")
    assert outcome.exit_code == 4
    assert not (tmp_path / "out.xlsx").exists()
    assert _titles(tmp_path / "copy.xlsx") == ["Findings"]
    assert "could not read bad.xlsx" in _text(tmp_path / "copy.xlsx")
    assert "E102" in _text(tmp_path / "copy.xlsx")


@pytest.mark.slow
def test_what_cannot_be_marked_gets_its_findings_alone(workbook, sound, tmp_path, monkeypatch):
    """When marking exceeds the limits, the findings go back alone, with the reason."""

    def refuse(*_, **__):
        raise Refusal("E118")

    monkeypatch.setattr("flexlash.feedback.returned_files.ask", refuse)
    outcome = check(workbook([{**sound, "torque_Nm": None}]), marked_copy=tmp_path / "copy.xlsx")
    assert _titles(tmp_path / "copy.xlsx") == ["Findings"]
    assert "to be marked" in _text(tmp_path / "copy.xlsx")
    assert "E201" in _text(tmp_path / "copy.xlsx")
    assert outcome.outputs == (tmp_path / "copy.xlsx",)


@pytest.mark.parametrize("kind", ["csv", "parquet"])
def test_a_table_comes_back_as_a_workbook(kind, table, sound, tmp_path):
    """A CSV or Parquet submission is marked in a workbook that shows its table at the same addresses."""
    rows = [sound, {**sound, "variant": "B", "wall_thickness_mm": -1.0}]
    path = table(rows)
    if kind == "parquet":
        path = tmp_path / "a.parquet"
        pl.DataFrame(rows).write_parquet(path)
    outcome = check(path, marked_copy=tmp_path / "copy.xlsx")
    (cell,) = {found.cell for found in outcome.findings if found.level == "error"}
    sheet = openpyxl.load_workbook(tmp_path / "copy.xlsx")["Variants"]
    assert sheet[cell].value == -1
    assert "E207" in sheet[cell].comment.text


@pytest.mark.slow
def test_marked_copies_are_skipped_unless_wanted(workbook, sound, tmp_path):
    """A marked copy is recognised and skipped by name; where it is wanted it is read, its findings sheet ignored."""
    path = workbook([sound, {**sound, "variant": "B", "torque_Nm": None}])
    first = check(path, marked_copy=tmp_path / "copy.xlsx")
    skipped = check(tmp_path / "copy.xlsx")
    assert skipped.skipped
    assert [found.code for found in skipped.findings] == ["I513"]
    again = check(tmp_path / "copy.xlsx", marked_copies=True, marked_copy=tmp_path / "again.xlsx")
    assert [(found.code, found.cell) for found in again.findings] == [
        (found.code, found.cell) for found in first.findings
    ]
    assert _coloured(tmp_path / "again.xlsx") == {"D6"}
    assert _titles(tmp_path / "again.xlsx").count("Findings") == 1


@pytest.mark.slow
def test_certain_repairs_are_made_and_listed(workbook, sound, tmp_path):
    """What leaves no doubt is fixed in a new file; what does, is left and told."""
    rows = [
        {**sound, "wall_thickness_mm": "1,6 mm"},
        {**sound, "variant": "B", "tolerance_class": "standart"},
        {**sound, "variant": "C", "torque_Nm": "about 800"},
    ]
    path = workbook(rows)
    before = path.read_bytes()
    outcome, fixes = fix(path, tmp_path / "new.xlsx")
    assert path.read_bytes() == before
    assert [(one.place, one.value) for one in fixes] == [("Variants!H5", 1.6), ("Variants!AA6", "standard")]
    assert [(found.code, found.cell) for found in outcome.findings] == [("E202", "D7")]
    assert outcome.outputs == (tmp_path / "new.xlsx",)
    counts = check(tmp_path / "new.xlsx").counts
    assert [counts[one] for one in ("rows", "computed", "errors", "warnings")] == [3, 2, 1, 0]
    assert "Variants!H5" in _text(tmp_path / "new.xlsx", "Fixes")


def test_one_repair_uncovers_another(table, sound, tmp_path):
    """When a header is fixed, what stands under it is looked at and fixed as well."""
    path = table([{**sound, "Tooth rim lenght [mm]": "20 mm", "rim_thickness_mm": 3.2}])
    outcome, fixes = fix(path, tmp_path / "new.csv")
    assert {one.code for one in fixes} == {"E112", "E202"}
    assert outcome.exit_code == 0
    assert check(tmp_path / "new.csv").results["backlash_rad"][0] == outcome.results["backlash_rad"][0]


def test_nothing_to_fix_writes_nothing(table, sound, tmp_path):
    """Without a certain fix no file is written."""
    outcome, fixes = fix(table([{**sound, "torque_Nm": None}]), tmp_path / "new.csv")
    assert (fixes, outcome.outputs) == ([], ())
    assert not (tmp_path / "new.csv").exists()


def test_a_refused_file_is_not_fixed(tmp_path):
    """A file that is no submission is refused as ever."""
    (tmp_path / "a.xlsx").write_bytes(b"%PDF-1.7")
    outcome, fixes = fix(tmp_path / "a.xlsx", tmp_path / "new.xlsx")
    assert (outcome.exit_code, fixes) == (4, [])


def test_repairs_do_not_touch_parquet(sound, tmp_path):
    """A Parquet file is left to the program that wrote it."""
    path = tmp_path / "a.parquet"
    pl.DataFrame([{**sound, "material": "20crNi2Mo"}]).write_parquet(path)
    assert fix(path, tmp_path / "new.csv")[1] == []


@pytest.mark.limited_process
def test_marked_and_fixed_by_the_limited_process(workbook, sound, tmp_path):
    """The process that reads also marks and fixes, within its limits."""
    path = workbook([{**sound, "wall_thickness_mm": "1,6"}])
    outcome, fixes = fix(path, tmp_path / "new.xlsx", marked_copy=tmp_path / "copy.xlsx", limits=ReadingLimits())
    assert len(fixes) == 1
    assert outcome.exit_code == 0
    check(path, marked_copy=tmp_path / "copy.xlsx")
    assert _coloured(tmp_path / "copy.xlsx") == {"H5"}


def test_the_same_copy_again(workbook, sound, tmp_path):
    """The same submission gives the same marked copy, byte for byte."""
    path = workbook([{**sound, "torque_Nm": None}])
    copies = []
    for name in ("one.xlsx", "two.xlsx"):
        check(path, marked_copy=tmp_path / name)
        copies.append((tmp_path / name).read_bytes())
    assert copies[0] == copies[1]


def test_json_lists_the_fixes(workbook, sound, tmp_path, capsys):
    """With --json the fixes are part of the outcome."""
    path = workbook([{**sound, "wall_thickness_mm": "1,6"}])
    with pytest.raises(SystemExit) as ended:
        cli.main(["check", str(path), "--apply-fixes", "--json"], standalone_mode=False)
    assert ended.value.code == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["fixes"] == [
        {"sheet": "Variants", "cell": "H5", "found": "1,6", "value": 1.6, "code": "E202"},
    ]
    assert answer["outputs"] == [str(tmp_path / "submission-autofixed.xlsx")]
    assert check(tmp_path / "submission-autofixed.xlsx").exit_code == 0


def test_work_saved_in_a_marked_copy_is_never_overwritten(workbook, sound, tmp_path):
    """A marked copy that somebody has saved since keeps its place, and the next one gets a number."""
    path = workbook([{**sound, "torque_Nm": None}])
    copy = tmp_path / "copy.xlsx"
    assert check(path, marked_copy=copy).outputs == (copy,)
    assert check(path, marked_copy=copy).outputs == (copy,)
    book = openpyxl.load_workbook(copy)
    book["Variants"]["D5"] = 800
    book.save(copy)
    outcome = check(path, marked_copy=copy)
    assert outcome.written.marked_copy == tmp_path / "copy (2).xlsx"
    assert outcome.remarks == (
        f"{copy} was left alone: flexlash did not write it, or somebody has changed it. Written instead: copy (2).xlsx",
    )
    assert openpyxl.load_workbook(copy)["Variants"]["D5"].value == 800
    assert check(copy, marked_copies=True).exit_code == 0


def test_a_fixed_file_does_not_replace_another(table, sound, tmp_path):
    """A fixed file takes no path where another file stands; the same bytes again need no number."""
    path = table([{**sound, "wall_thickness_mm": "1,6 mm"}])
    target = tmp_path / "new.csv"
    target.write_text("mine", encoding="utf-8")
    for _ in range(2):
        assert fix(path, target)[0].outputs == (tmp_path / "new (2).csv",)
    assert target.read_text(encoding="utf-8") == "mine"


def test_stamped_workbooks_are_ordinary_ones(workbook, sound, tmp_path):
    """The stamp of a workbook keeps no reader from it."""
    check(workbook([{**sound, "torque_Nm": None}]), marked_copy=tmp_path / "copy.xlsx")
    assert stamp_at(tmp_path / "copy.xlsx") == "checked"
    assert check(tmp_path / "copy.xlsx", marked_copies=True).counts["rows"] == 1
    assert "Variants" in CalamineWorkbook.from_path(tmp_path / "copy.xlsx").sheet_names


def test_a_percentage_in_a_cell(workbook, sound, tmp_path):
    """A deviation that a cell shows as 5% is 5 where its unit is %, and an error where it is a length."""
    rows = [
        {"tolerance_class": "fine", "dimension": "wall_thickness", "lower_deviation": -5.0, "upper_deviation": 5.0,
         "deviation_unit": "%"},
    ]  # fmt: skip
    variants = [{**sound, "tolerance_class": "fine"}]
    plain = run(workbook(variants, tolerances=rows), samples=64)
    for unit, shown in (("%", True), (None, False)):
        path = tmp_path / "other.xlsx"
        book = openpyxl.load_workbook(workbook(variants, tolerances=rows))
        sheet = book["Tolerances"]
        (row,) = [cells[0].row for cells in sheet.iter_rows() if cells[0].value == "fine"]
        for letter, value in (("C", -0.05), ("D", 0.05)):
            sheet[f"{letter}{row}"] = value
            sheet[f"{letter}{row}"].number_format = "0%"
        sheet[f"E{row}"] = unit
        book.save(path)
        outcome = run(path, samples=64)
        codes = [found.code for found in outcome.findings if found.sheet == "Tolerances" and found.level != "warning"]
        if shown:
            assert codes == ["I514", "I514"]
            assert outcome.results["sd_arcmin"][0] == plain.results["sd_arcmin"][0]
        else:
            assert codes == ["E216", "E216"]
            assert outcome.exit_code == 4


def test_a_formula_is_left_to_its_author(workbook, sound, tmp_path):
    """A cell whose text comes from a formula is told, but not fixed: the formula would be lost."""
    parts = unpacked(workbook([sound]).read_bytes(), ReadingLimits())
    part = next(name for name in parts if name.endswith("sheet1.xml"))
    (span,) = SheetSpans(parts[part], [(5, 8)]).cells.values()
    cell = b'<c r="H5" s="%s" t="str"><f>"1,6"</f><v>1,6</v></c>' % span.style.encode()
    parts[part] = spliced(parts[part], [(span.start, span.end, cell)])
    path = tmp_path / "formula.xlsx"
    path.write_bytes(packed(parts))
    outcome, fixes = fix(path, tmp_path / "new.xlsx")
    assert [(found.code, found.cell, found.suggestion) for found in outcome.findings] == [("E202", "H5", "1.6")]
    assert (fixes, outcome.outputs) == ([], ())


@pytest.mark.parametrize(("ending", "kind"), [("xlsx", b"sheet.main+xml"), ("xlsm", b"sheet.macroEnabled.main+xml")])
def test_the_marked_copy_is_of_the_kind_that_its_name_says(ending, kind, workbook, sound, tmp_path):
    """Excel opens a file that may hold macros under .xlsm alone, and no other under that."""
    path = workbook([{**sound, "torque_Nm": None}]).rename(tmp_path / "a.xlsm")
    copy = tmp_path / f"marked.{ending}"
    flexlash.check(path, marked_copy=copy)
    assert kind in unpacked(copy.read_bytes(), ReadingLimits())["[Content_Types].xml"]
    assert stamp_at(copy) == "checked"
