"""Programs beside Excel and LibreOffice read every kind of workbook that flexlash writes, and the same in it."""

from __future__ import annotations

import re
import zipfile
from collections import Counter

import pytest
import xlsxwriter
from other_readers import READERS, differences, needs_other_readers, read_by, read_by_openpyxl
from workbook_kinds import KINDS

from flexlash.feedback.annotation import marked_copy
from flexlash.schema.findings import Finding

pytestmark = [needs_other_readers, pytest.mark.slow]

_CELL = re.compile(rb"<c [^>]*?(?:/>|>(.*?)</c>)", re.DOTALL)


@pytest.mark.parametrize("name", KINDS)
def test_other_readers_read_the_same_in_every_kind_of_file(kinds, name):
    """Sheets in order, numbers to the last bit, texts, errors, dates and formulas' results are those openpyxl reads."""
    own = read_by_openpyxl(kinds / name)
    assert sum(map(len, own.values()))
    for reader in READERS:
        assert differences(own, read_by(reader, kinds / name))[:10] == [], reader


@pytest.mark.parametrize("name", KINDS)
def test_every_formula_has_a_stored_result(kinds, name):
    """No reader has to calculate: each formula of each sheet has its result beside it, be it an empty text."""
    with zipfile.ZipFile(kinds / name) as archive:
        for part in archive.namelist():
            if re.fullmatch(r"xl/worksheets/sheet\d+\.xml", part):
                inside = _CELL.findall(archive.read(part))
                assert [cell for cell in inside if b"<f" in cell and b"<v" not in cell][:3] == [], part


def _of_every_kind(path):
    """Write a workbook with values of each kind, typed and calculated."""
    workbook = xlsxwriter.Workbook(path)
    sheet = workbook.add_worksheet("Data")
    day, time = (workbook.add_format({"num_format": code}) for code in ("yyyy-mm-dd", "yyyy-mm-dd hh:mm:ss"))
    sheet.write_column(0, 0, [1 / 3, 1e-300, -0.1, 2**53, "a text", "  spaces ", "line\nbreak", "=1+1", "Ω ′ 𝄞"])
    sheet.write_number(0, 1, 46357, day)
    sheet.write_number(1, 1, 46357.52468, time)
    sheet.write_boolean(2, 1, True)
    sheet.write_rich_string(3, 1, "half ", workbook.add_format({"bold": True}), "bold")
    sheet.write_url(4, 1, "internal:Data!A1", string="a link")
    for row, result in enumerate((2 / 3, 0, "", "said", "#N/A", "#DIV/0!", True)):
        sheet.write_formula(row, 2, "=A1*2", None, result)
    workbook.close()


def test_a_marked_copy_keeps_values_of_every_kind(tmp_path):
    """Dates, booleans, errors, results of 0 and of nothing are read alike in an engineer's file and its marked copy."""
    own, marked = tmp_path / "own.xlsx", tmp_path / "marked.xlsx"
    _of_every_kind(own)
    fault = Finding(level="error", code="E202", sheet="Data", cell="A2", message="Data!A2 is wrong.", fix="Fix it.")
    marked.write_bytes(marked_copy(own.read_bytes(), [fault], own.name).data)
    before, after = read_by_openpyxl(own), read_by_openpyxl(marked)
    assert before["Data"] == after["Data"]
    said = Counter(kind for kind, _, _ in after["Data"].values())
    assert said == {"number": 7, "text": 7, "date": 2, "boolean": 2, "error": 2, "nothing": 1}
    for reader in READERS:
        assert differences(after, read_by(reader, marked)) == [], reader


def test_what_is_read_otherwise_is_told():
    """Another last bit, a text for a number, a formula for its value, a cell too many and another order are told."""
    one = {"A": {"A1": ["number", 0.1, False]}, "B": {}}
    for other in ([["number", 0.10000000000000002, False]], [["text", "0.1", False]], [["number", 0.1, True]], []):
        assert differences(one, {"A": dict(zip(["A1"], other, strict=False)), "B": {}})
    assert differences(one, {"A": one["A"], "B": {"C3": ["text", "", False]}})
    assert differences(one, {"B": {}, "A": one["A"]})
    assert not differences(one, one)
