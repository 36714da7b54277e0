"""A row of units below the headers: skipped where it agrees with them, an error where it does not."""

import openpyxl
import pytest

from flexlash.pipeline import check

KEYS = "variant;material;torque_Nm;cylinder_length_mm;mean_radius_mm;wall_thickness_mm;disk_inner_radius_mm;notes"
ROW = "A;20Cr2Ni4;800;160;80;1.6;40;x"


def _checked(folder, units, header=KEYS, row=ROW, delimiter=";"):
    path = folder / "study.csv"
    path.write_text(f"{header}\n{units}\n{row}".replace(";", delimiter), encoding="utf-8")
    return check(path)


def _told(outcome):
    return [(one.code, one.cell) for one in outcome.findings if one.code not in {"I503", "I507", "I501", "I502"}]


AGREE = {
    "in brackets": ";;[Nm];[mm];[mm];[mm];[mm];",
    "in round brackets": ";;(N·m);(mm);(mm);(mm);(mm);",
    "bare": ";;Nm;mm;mm;mm;mm;",
    "with a title": "Unit;-;N*m;mm;mm;mm;mm;-",
    "with a title in brackets": "[Einheit];[-];[Nm];[mm];[mm];[mm];[mm];[-]",
    "some of them": ";;;;mm;mm;;",
}


@pytest.mark.parametrize("what", AGREE)
@pytest.mark.parametrize("delimiter", [";", ",", "\t"])
def test_a_row_of_units_is_skipped_with_an_info(tmp_path, what, delimiter):
    """A row of units right below the headers is told once, and the rows below it are computed."""
    outcome = _checked(tmp_path, AGREE[what], delimiter=delimiter)
    ((code, cell),) = _told(outcome)
    assert (code, cell[1:]) == ("I515", "2")
    assert (outcome.exit_code, outcome.counts["computed"]) == (0, 1)


def test_units_that_the_header_names_too(tmp_path):
    """Headers in another unit agree with a row of that unit."""
    header = KEYS.replace("wall_thickness_mm", "Wall thickness [µm]")
    outcome = _checked(tmp_path, ";;Nm;mm;mm;um;mm;", header, ROW.replace("1.6", "1600"))
    assert _told(outcome) == [("I515", "C2")]
    assert outcome.counts["computed"] == 1


@pytest.mark.parametrize("header", ["wall_thickness_mm", "Wall thickness [mm]", "Wall thickness"])
def test_units_that_differ_from_the_headers_are_an_error(tmp_path, header):
    """A row of units that contradicts a header stops the rows with a value there: one finding names both."""
    outcome = _checked(tmp_path, ";;Nm;mm;mm;µm;mm;", KEYS.replace("wall_thickness_mm", header), ROW)
    assert ("E219", "F2") in _told(outcome)
    (found,) = [one for one in outcome.findings if one.code == "E219"]
    assert "µm" in found.message
    assert found.message.endswith("for Wall thickness Δ, but its header is read in mm.")
    assert (outcome.exit_code, outcome.counts["computed"]) == (4, 0)


NONE = {
    "a variant": "B;20Cr2Ni4;800;160;80;1.6;40;x",
    "a variant without a name": ";20Cr2Ni4;800;160;80;1.6;40;x",
    "units and numbers": ";;Nm;160;mm;mm;mm;",
    "one unit alone": ";;Nm;;;;;",
    "remarks": ";;see drawing;mm;mm;mm;mm;",
    "units of other quantities": ";;mm;Nm;mm;mm;mm;",
}


@pytest.mark.parametrize("what", NONE)
def test_other_rows_are_no_rows_of_units(tmp_path, what):
    """A row that holds anything but units is data, or what else it was."""
    assert "I515" not in {code for code, _ in _told(_checked(tmp_path, NONE[what]))}


def test_only_the_first_row_below_the_headers(tmp_path):
    """Units further below are no row of units."""
    outcome = _checked(tmp_path, ROW, row=";;Nm;mm;mm;mm;mm;")
    assert "I515" not in {code for code, _ in _told(outcome)}
    assert outcome.exit_code == 3


def test_workbooks_and_other_sheets_too(tmp_path):
    """A workbook's sheets may have a row of units each."""
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "Variants"
    sheet.append(["Made by the shop"])
    sheet.append(KEYS.split(";"))
    sheet.append([None, None, "[N·m]", "[mm]", "[mm]", "[mm]", "[mm]"])
    sheet.append(["A", "20Cr2Ni4", 800, 160, 80, 1.6, 40])
    materials = book.create_sheet("Materials")
    materials.append(["material", "youngs_modulus_GPa", "density_kg_m3", "poisson_ratio"])
    materials.append(["", "GPa", "kg/m³", "-"])
    materials.append(["20Cr2Ni4", 211, 7800, 0.3])
    book.save(tmp_path / "study.xlsx")
    outcome = check(tmp_path / "study.xlsx")
    told = [(one.sheet, one.cell) for one in outcome.findings if one.code == "I515"]
    assert told == [("Variants", "C3"), ("Materials", "B2")]
    assert (outcome.exit_code, outcome.counts["computed"]) == (0, 1)


SPLIT = KEYS.replace(";", ",").replace(",notes", ",tolerance_class,notes")


def _split(folder, *rows):
    path = folder / "split.csv"
    path.write_text("\n".join([SPLIT, *rows]), encoding="utf-8")
    return check(path)


def test_a_split_number_is_told_also_where_the_last_cell_is_blank(tmp_path):
    """One value more than headers is an error where a decimal comma may have split a number, nothing of it is used."""
    outcome = _split(tmp_path, "A,20Cr2Ni4,800,160,80,1,6,40,standard,")
    assert _told(outcome) == [("E215", "J2")]
    assert outcome.exit_code == 4
    honest = _split(tmp_path, "A,20Cr2Ni4,800,160,80,1.6,40,standard,,")
    assert (_told(honest), honest.counts["computed"]) == ([], 1)


def test_digits_for_remarks_are_a_warning(tmp_path):
    """A notes column of nothing but short digits in a table of commas may be where split numbers ended."""
    outcome = _split(tmp_path, "A,20Cr2Ni4,800,160,80,2,40,standard,5", "B,20Cr2Ni4,800,160,80,2,40,,25")
    assert _told(outcome) == [("W430", "I2")]
    assert outcome.exit_code == 0
    for rows in (["A,20Cr2Ni4,800,160,80,2,40,,drawing 5"], ["A,20Cr2Ni4,800,160,80,2,40,,"]):
        assert _told(_split(tmp_path, *rows)) == []
    assert _told(_checked(tmp_path, "B;20Cr2Ni4;800;160;80;2;40;5", row="")) == []
