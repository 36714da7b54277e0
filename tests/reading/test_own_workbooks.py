"""Workbooks of every kind, made here: each is read as it was meant, or refused by the right name, never the other."""

from __future__ import annotations

import csv
import os
from pathlib import Path

import pytest
from marking_samples import fault
from own_workbooks import READABLE, REFUSED
from python_calamine import CalamineWorkbook
from read_files import read_submission

from flexlash.feedback.annotation import marked_copy
from flexlash.pipeline import check
from flexlash.reading.raw import Unstored
from flexlash.schema.cell_addresses import column_letters

CORPUS = Path(os.environ.get("FLEXLASH_CORPUS", "no such folder"))
ALSO_CALLED = {
    "no-workbook-part": "docx",
    "ole2": "encrypted-ooxml",
    "hidden-rowcol": "hidden-sheet",
    "defined-names": "data-validation",
    "external-links": "external-rel",
    "no-content-types": "an empty archive",
}
"""Kinds of the public list that a workbook of another kind here is of, too."""


NOT_BY_CALAMINE = {"UTF-16", "the farthest cells"}
"""The first it refuses; the second takes it all memory, since it fills every gap with blank cells."""


def _cells(path):
    """Return the cells that are read, by sheet and address; an empty text is no cell."""
    return {
        name: {
            f"{column_letters(place)}{row}": value
            for row, cells in sheet.rows.items()
            for place, value in cells.items()
            if value != ""
        }
        for name, sheet in read_submission(path).sheets.items()
    }


@pytest.fixture
def readable(request, tmp_path):
    """Return a readable workbook's path and the cells it holds."""
    make, cells = READABLE[request.param]
    path = tmp_path / "own.xlsx"
    path.write_bytes(make())
    return path, cells


every_kind = pytest.mark.parametrize("readable", READABLE, indirect=True)


@every_kind
def test_every_cell_is_read_as_it_was_meant(readable):
    """Every cell of a readable workbook comes back as it was written, at its address, and none more."""
    path, cells = readable
    found = _cells(path)
    assert found == cells
    assert {name: {a: type(v) for a, v in one.items()} for name, one in found.items()} == {
        name: {a: type(v) for a, v in one.items()} for name, one in cells.items()
    }


@every_kind
def test_it_is_no_template_but_a_workbook(readable):
    """A readable workbook that is no submission is told as such, not as damaged or foreign."""
    outcome = check(readable[0])
    assert (outcome.exit_code, [found.code for found in outcome.findings if found.level == "error"]) == (4, ["E108"])


@pytest.mark.parametrize("kind", REFUSED)
def test_what_must_be_refused_is_refused_by_name(kind, tmp_path):
    """A file that cannot be read rightly is refused with the code for its kind, not read."""
    code, make = REFUSED[kind]
    path = tmp_path / "own.xlsx"
    path.write_bytes(make())
    outcome = check(path)
    assert (outcome.exit_code, [found.code for found in outcome.findings]) == (4, [code])
    assert outcome.submission.sheets == {}


@pytest.mark.parametrize("readable", [kind for kind in READABLE if kind not in NOT_BY_CALAMINE], indirect=True)
def test_another_reader_sees_the_same_numbers_and_texts(readable):
    """What calamine reads of a workbook is what is expected of us."""
    path, cells = readable
    book = CalamineWorkbook.from_path(path)
    sheets = {name: book.get_sheet_by_name(name).to_python(skip_empty_area=False) for name in cells}
    for name, rows in sheets.items():
        seen = {f"{column_letters(j)}{i}": v for i, row in enumerate(rows, 1) for j, v in enumerate(row, 1) if v != ""}
        mine = {a: v for a, v in cells[name].items() if isinstance(v, str | int | float)}
        assert {address: seen.get(address) for address in mine} == mine


@every_kind
def test_marking_changes_no_cell(readable, tmp_path):
    """The marked copy of every readable workbook holds the same cells; formulas wait for Excel to calculate them."""
    path, cells = readable
    faults = [fault(sheet=name, cell=cell) for name in cells for cell in ("A1", "ZZ77")]
    copy = tmp_path / "copy.xlsx"
    copy.write_bytes(marked_copy(path.read_bytes(), faults, path.name).data)
    found = _cells(copy)
    for name, held in cells.items():
        assert {a: v for a, v in found[name].items() if v != Unstored()} == {
            a: v for a, v in held.items() if found[name].get(a) != Unstored()
        }


@pytest.mark.public_workbooks
def test_every_kind_of_public_workbook_is_among_our_own():
    """Each kind in the list of public workbooks has a workbook of that kind here."""
    if not CORPUS.is_dir():
        pytest.skip("FLEXLASH_CORPUS names no folder of public workbooks")
    lines = (CORPUS / "MANIFEST.tsv").read_text(encoding="utf-8").splitlines()
    rows = csv.DictReader([line for line in lines if not line.startswith("#")], delimiter="\t")
    kinds = {kind for row in rows for kind in row["kind"].split(";")} - {""}
    ours = {*READABLE, *(part for kind in REFUSED for part in (kind, kind.partition(" ")[0].strip(":")))}
    assert {kind for kind in kinds if ALSO_CALLED.get(kind, kind) not in ours and "=" not in kind} == set()
