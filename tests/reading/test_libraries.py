"""A library that changed is not taken for a damaged file."""

from __future__ import annotations

import importlib
import pickle
import subprocess
import sys

import openpyxl
import pytest
from small_workbook import book_of

from flexlash.reading import inside_limits as limited
from flexlash.reading import limited_process as isolated
from flexlash.reading.libraries import ChangedLibrary, require_known_libraries
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.xlsx import read_workbook

READ = (
    ("openpyxl.worksheet._reader", "WorkSheetParser", "parse_cell"),
    ("openpyxl.reader.excel", "ExcelReader", "read_manifest"),
    ("openpyxl.cell.text", "Text", "content"),
)


def test_the_libraries_installed_here_are_known():
    """With the libraries that the tests run with, a small workbook is read."""
    require_known_libraries()


@pytest.mark.parametrize(("module", "owner", "name"), READ)
def test_a_part_that_is_gone_is_told_with_the_library(module, owner, name, monkeypatch):
    """Whatever openpyxl lacks of what reading uses is told with its name and version."""
    monkeypatch.delattr(getattr(importlib.import_module(module), owner), name)
    with pytest.raises(ChangedLibrary, match=rf"^openpyxl {openpyxl.__version__} .*not to blame"):
        require_known_libraries()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["worksheet._reader.WorkSheetParser", "styles.numbers.BUILTIN_FORMATS"])
def test_a_name_that_cannot_be_imported_is_told_with_the_library(name):
    """A release that lacks a name altogether is told as well, also when nothing was imported yet."""
    module, _, part = f"openpyxl.{name}".rpartition(".")
    code = (
        f"import importlib\ndel importlib.import_module({module!r}).{part}\n"
        "from flexlash.reading.libraries import require_known_libraries\nrequire_known_libraries()"
    )
    done = subprocess.run([sys.executable, "-c", code], check=False, capture_output=True, text=True)
    assert f"ChangedLibrary: openpyxl {openpyxl.__version__} cannot" in done.stderr
    assert part in done.stderr


@pytest.mark.parametrize(("module", "owner", "name"), READ)
def test_a_changed_library_damages_no_file(module, owner, name, monkeypatch):
    """A sound workbook that a changed library cannot read is not called damaged."""
    data = book_of('<row r="1"><c r="A1" t="inlineStr"><is><t>a</t></is></c></row>')
    read_workbook(data, ReadingLimits())
    monkeypatch.delattr(getattr(importlib.import_module(module), owner), name)
    with pytest.raises(ChangedLibrary, match="openpyxl"):
        read_workbook(data, ReadingLimits())


def test_a_library_that_takes_other_arguments_damages_no_file(monkeypatch):
    """A reader that takes other arguments than it did is a changed library as well."""
    monkeypatch.setattr("openpyxl.worksheet._reader.WorkSheetParser.__init__", lambda _: None)
    with pytest.raises(ChangedLibrary, match="TypeError"):
        read_workbook(book_of(), ReadingLimits())


def test_a_library_that_reads_other_values_is_told(monkeypatch):
    """A reader that gives other values than were written is a changed library as well."""
    monkeypatch.setattr("openpyxl.worksheet._reader._cast_number", lambda _: 7)
    with pytest.raises(ChangedLibrary, match="something else"):
        require_known_libraries()


def test_the_limited_process_tells_a_changed_library(monkeypatch):
    """A changed library comes back from the limited process as what it is, and survives the way between processes."""
    monkeypatch.delattr("openpyxl.worksheet._reader.WorkSheetParser.parse_cell")
    told = limited.carried_out(read_workbook, ReadingLimits(), (book_of(), ReadingLimits()))
    assert isinstance(told, ChangedLibrary)
    assert str(pickle.loads(pickle.dumps(told))) == str(told)  # noqa: S301
    monkeypatch.setattr("flexlash.reading.limited_process._answer", lambda *_: told)
    with pytest.raises(ChangedLibrary, match="not to blame"):
        isolated.ask(read_workbook, ReadingLimits(), b"")


def test_a_library_that_cannot_be_loaded_is_told_by_every_answer(monkeypatch):
    """A library that lacks something when the limited process starts is told with its name, not as a file's fault."""
    monkeypatch.setattr(limited._State, "fault", None)
    monkeypatch.setattr(limited._State, "prepared", False)
    monkeypatch.setattr("flexlash.reading.inside_limits._silence", lambda: None)
    monkeypatch.setattr("flexlash.reading.inside_limits._judge", lambda *_: None)
    monkeypatch.setattr("flexlash.reading.inside_limits._warm_up", lambda: importlib.import_module("no_such"))
    monkeypatch.delattr("openpyxl.reader.excel.ExcelReader.read_manifest")
    limited.prepare()
    assert isinstance(limited.carried_out(read_workbook, ReadingLimits(), (b"",)), ChangedLibrary)


def test_a_damaged_file_is_still_damaged():
    """A part that no library could read stays the file's own fault."""
    with pytest.raises(Refusal, match="E102"):
        read_workbook(book_of(**{"xl/styles.xml": "<styleSheet"}), ReadingLimits())
