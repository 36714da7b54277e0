"""Workbooks that real people made keep every value when they are marked."""

from __future__ import annotations

import io
import os
import re
import zipfile
from pathlib import Path

import pytest
from marking_samples import fault, loaded
from python_calamine import CalamineWorkbook

from flexlash.feedback.annotation import marked_copy

CORPUS = Path(os.environ.get("FLEXLASH_CORPUS", "no such folder"))
LARGEST = 60_000
CASES = sorted(path for path in CORPUS.glob("*.xlsx") if path.stat().st_size < LARGEST)[::4] if CORPUS.is_dir() else []


def _by_openpyxl(data):
    return {
        sheet.title: {
            place: getattr(cell.value, "text", cell.value)
            for place, cell in sheet._cells.items()
            if cell.value is not None
        }
        for sheet in loaded(data).worksheets
    }


def _by_calamine(data):
    book = CalamineWorkbook.from_filelike(io.BytesIO(data))
    found = {}
    for one in book.sheets_metadata:
        if "WorkSheet" in str(one.typ):
            sheet = book.get_sheet_by_name(one.name)
            top, left = sheet.start or (0, 0)
            found[one.name] = {
                (top + row + 1, left + column + 1): value
                for row, values in enumerate(sheet.to_python(skip_empty_area=True))
                for column, value in enumerate(values)
                if value != ""
            }
    return found


@pytest.mark.slow
@pytest.mark.public_workbooks
@pytest.mark.skipif(not CASES, reason="FLEXLASH_CORPUS names no folder of public workbooks")
@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_marking_changes_no_value(path):
    """Two readers find the same values before and after, results of formulas included, and marking again is the same.

    Every part stays byte for byte but sheets, styles, notes and the lists that name them.
    """
    data = path.read_bytes()
    try:
        before, seen = _by_openpyxl(data), _by_calamine(data)
    except Exception as fault_of_file:  # noqa: BLE001
        pytest.skip(f"not readable at all: {type(fault_of_file).__name__}")
    findings = [fault(sheet=title, cell=cell) for title in before for cell in ("A1", "C3", "ZZ77")]
    copy = marked_copy(data, findings, path.name).data
    after, sees = _by_openpyxl(copy), _by_calamine(copy)
    assert {title: after[title] for title in before} == before
    assert {title: sees[title] for title in seen} == seen
    assert marked_copy(copy, findings, path.name).data == copy
    with zipfile.ZipFile(io.BytesIO(data)) as original, zipfile.ZipFile(io.BytesIO(copy)) as archive:
        assert archive.testzip() is None
        for name in set(original.namelist()) & set(archive.namelist()):
            if not re.search(r"(?i)sheets/|styles|comments|vmldrawing|\.rels|workbook|content_types|custom\.xml", name):
                assert archive.read(name) == original.read(name), name
