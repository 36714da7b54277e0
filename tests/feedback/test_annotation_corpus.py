"""Workbooks that real people made keep every value when they are marked."""

from __future__ import annotations

import io
import os
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
    """Two readers find the same values before and after; formulas have no result until Excel opens the copy."""
    data = path.read_bytes()
    try:
        before, seen = _by_openpyxl(data), _by_calamine(data)
    except Exception as fault_of_file:  # noqa: BLE001
        pytest.skip(f"not readable at all: {type(fault_of_file).__name__}")
    findings = [fault(sheet=title, cell=cell) for title in before for cell in ("A1", "C3", "ZZ77")]
    data = marked_copy(data, findings, path.name).data
    after, sees = _by_openpyxl(data), _by_calamine(data)
    assert {title: after[title] for title in before} == before
    for title, cells in seen.items():
        formulas = {
            place for place, value in before.get(title, {}).items() if str(value).startswith(("=", "<openpyxl"))
        }
        assert {place: value for place, value in sees[title].items() if place not in formulas} == {
            place: value for place, value in cells.items() if place not in formulas
        }
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert archive.testzip() is None
