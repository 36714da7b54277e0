"""Two readers of workbooks beside Python, SheetJS and exceljs, and what openpyxl reads in the same form."""

from __future__ import annotations

import datetime
import json
import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import openpyxl
import pytest
from openpyxl.utils.datetime import to_excel

__all__ = ["READERS", "differences", "needs_other_readers", "read_by", "read_by_openpyxl"]

READERS = ("SheetJS", "exceljs")

_PACKAGES = os.environ.get("OTHER_READERS", "")
_SCRIPT = Path(__file__).with_name("other_readers.cjs")
_MILLISECOND = 1.0 / 86_400_000
"""A day has so many; openpyxl and exceljs round dates to them."""

Cells = dict[str, dict[str, list[Any]]]
"""By sheet and address: kind, value and whether a formula gives it."""

needs_other_readers = pytest.mark.skipif(
    not (_PACKAGES and shutil.which("node")),
    reason="SheetJS and exceljs are not here: npm install --prefix FOLDER xlsx exceljs, with OTHER_READERS=FOLDER",
)


def read_by(reader: str, path: Path) -> Cells:
    """Return what SheetJS or exceljs reads in a workbook."""
    command = ["node", str(_SCRIPT), reader, str(Path(_PACKAGES).resolve()), str(path)]
    done = subprocess.run(command, check=False, capture_output=True, text=True, encoding="utf-8")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def read_by_openpyxl(path: Path) -> Cells:
    """Return what openpyxl reads in a workbook; dates as the numbers that they are stored as, with the kind `date`."""
    values, formulas = (openpyxl.load_workbook(path, data_only=known) for known in (True, False))
    return {sheet.title: dict(_cells(sheet, formulas[sheet.title])) for sheet in values.worksheets}


def _cells(values: Any, formulas: Any) -> Iterator[tuple[str, list[Any]]]:
    for row in values.iter_rows():
        for cell in row:
            is_formula = formulas.cell(cell.row, cell.column).data_type == "f"
            if cell.value is not None or is_formula:
                yield cell.coordinate, [*_kind_and_value(cell), is_formula]


def _kind_and_value(cell: Any) -> tuple[str, Any]:
    if isinstance(cell.value, datetime.datetime | datetime.date | datetime.time):
        return "date", to_excel(cell.value)
    if cell.data_type == "n" and cell.value is not None:
        return "number", float(cell.value)
    return {"b": "boolean", "e": "error", "n": "nothing"}.get(cell.data_type, "text"), cell.value


def differences(one: Cells, other: Cells) -> list[str]:
    """Return where two readers part: sheets and their order, addresses, kinds, values to the last bit, formulas.

    Dates of the first may part by a millisecond.
    """
    if list(one) != list(other):
        return [f"sheets: {list(one)}, {list(other)}"]
    return [
        f"{sheet}!{address}: {one[sheet].get(address)}, {other[sheet].get(address)}"
        for sheet in one
        for address in {**one[sheet], **other[sheet]}
        if not _is_same(one[sheet].get(address), other[sheet].get(address))
    ]


def _is_same(one: list[Any] | None, other: list[Any] | None) -> bool:
    if one and other and one[0] == "date":
        return other[0] == "number" and abs(one[1] - other[1]) < _MILLISECOND and one[2] == other[2]
    return one == other
