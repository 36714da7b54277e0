"""Every kind of workbook that flexlash writes is valid by Microsoft's Open XML SDK."""

from __future__ import annotations

import pytest
from marking_samples import fault, own_workbook, rich_workbook
from open_xml import faults_of, needs_validator
from own_workbooks import READABLE, RICH
from workbook_kinds import KINDS

from flexlash.feedback.annotation import marked_copy

pytestmark = [needs_validator, pytest.mark.slow]

MARKABLE = {
    **{kind: make for kind, (make, _) in READABLE.items()},
    **RICH,
    "by openpyxl": own_workbook,
    "by XlsxWriter": rich_workbook,
}
"""Workbooks as engineers, programs and converters make them."""


@pytest.mark.parametrize("name", KINDS)
def test_every_kind_of_file_is_valid(kinds, name):
    """The Open XML SDK finds nothing wrong in a file of each kind."""
    assert faults_of(kinds / name) == []


@pytest.mark.parametrize("name", MARKABLE)
def test_the_marked_copy_of_any_workbook_is_valid(tmp_path, name):
    """Whatever the engineer's file holds, its marked copy has no fault that the file itself does not have."""
    path = tmp_path / "marked.xlsx"
    path.write_bytes(marked_copy(MARKABLE[name](), [fault(), fault(cell="ZZ77", level="warning")], name).data)
    if faults := faults_of(path):
        path.write_bytes(MARKABLE[name]())
        described = [{one.partition(": ")[2] for one in found} for found in (faults, faults_of(path))]
        assert described[0] <= described[1]


def test_the_validator_finds_faults(tmp_path):
    """A workbook as openpyxl writes it, its fonts out of order, is not valid."""
    path = tmp_path / "openpyxl.xlsx"
    path.write_bytes(own_workbook())
    assert "font" in str(faults_of(path))
