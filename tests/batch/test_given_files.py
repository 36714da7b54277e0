"""Files and folders of a command line: what is taken, in which order, and what is left alone and told."""

from __future__ import annotations

import os

import pytest

import flexlash
from flexlash.batch.given_files import given_files

POSIX = pytest.mark.skipif(os.name == "nt", reason="links need a privilege on Windows")


@pytest.fixture
def folder(tmp_path):
    """Return a folder with submissions, and what lies beside them in real folders."""
    made = tmp_path / "in"
    for name in (
        "b.xlsx", "a.CSV", "c.parquet", "notes.docx", "picture.png", "LICENSE", ".hidden.xlsx", "~$b.xlsx",
        "d.xlsx.part", "e.tmp", "sub/f.xlsm", "sub/deep/a.tsv", ".git/g.xlsx",
    ):  # fmt: skip
        (made / name).parent.mkdir(parents=True, exist_ok=True)
        (made / name).write_text(name, encoding="utf-8")
    return made


def _names(found, folder):
    return [path.relative_to(folder).as_posix() for path in found.submissions]


def test_a_folder_gives_what_lies_directly_in_it_by_name(folder):
    """Workbooks and tables, whatever the case of their ending, by name; nothing below, hidden or unfinished."""
    assert _names(given_files([folder]), folder) == ["a.CSV", "b.xlsx", "c.parquet"]


def test_recursive_gives_what_lies_below_with_its_sub_folder(folder):
    """Files of sub-folders keep where they lie; a hidden folder is not looked into."""
    found = given_files([folder], recursive=True)
    assert _names(found, folder) == ["a.CSV", "b.xlsx", "c.parquet", "sub/deep/a.tsv", "sub/f.xlsm"]
    assert {given.path.name: given.below.as_posix() for given in found.files if given.path.suffix == ".tsv"} == {
        "a.tsv": "sub/deep"
    }


def test_lock_files_and_others_are_told_and_not_looked_at(folder):
    """A lock file has its finding; others are one sentence with their number and endings, and no error."""
    found = given_files([folder])
    assert [(given.path.name, given.skipped) for given in found.files if given.skipped] == [("~$b.xlsx", "I525")]
    assert found.remarks == (
        f"{folder}: not read: 3 files of other kinds (.docx, .png, without an ending), 1 hidden file, "
        "2 unfinished files.",
    )


def test_what_flexlash_wrote_is_skipped_unless_somebody_changed_it(tmp_path, table, sound):
    """Reports, results and marked copies in a folder are known by their stamp; a changed one is judged by content."""
    faulty = table([sound, {**sound, "variant": "b", "torque_Nm": ""}])
    for name in ("a-report.xlsx", "r.parquet"):
        flexlash.run(faulty, tmp_path / name, samples=64, marked_copy=tmp_path / "a-checked.xlsx")
    changed = tmp_path / "z-report.xlsx"
    changed.write_bytes((tmp_path / "a-report.xlsx").read_bytes().replace(b"1980", b"1981") + b" ")
    found = {given.path.name: given.skipped for given in given_files([tmp_path]).files}
    marked = "a-checked (2).xlsx" if (tmp_path / "a-checked (2).xlsx").exists() else "a-checked.xlsx"
    assert found == {
        "a-report.xlsx": "I508", "r.parquet": "I527", marked: "I513", "submission.csv": "", "z-report.xlsx": "",
    }  # fmt: skip
    taken = {given.path.name: given.skipped for given in given_files([tmp_path], marked_copies=True).files}
    assert taken[marked] == ""


def test_no_file_is_taken_twice(folder):
    """A file given itself and by its folder, or under another spelling, is one submission, in the first place."""
    twice = [folder / "b.xlsx", folder, folder / "sub" / ".." / "a.CSV", folder / "b.xlsx"]
    assert _names(given_files(twice), folder) == ["b.xlsx", "a.CSV", "c.parquet"]


def test_the_folder_of_outputs_is_not_entered(folder):
    """Where reports go below the given folder, nothing is read from there; given itself, it is an input like others."""
    out = folder / "sub"
    assert _names(given_files([folder], recursive=True, output=out), folder) == ["a.CSV", "b.xlsx", "c.parquet"]
    assert _names(given_files([folder], output=folder), folder) == ["a.CSV", "b.xlsx", "c.parquet"]


def test_a_table_given_beside_is_no_submission(folder):
    """What --tolerances names is not computed as well because it lies in the folder."""
    found = given_files([folder], beside=[folder / "a.CSV"])
    assert _names(found, folder) == ["b.xlsx", "c.parquet"]
    assert "1 table given by an option" in found.remarks[0]


def test_files_named_are_taken_whatever_they_are_called(folder):
    """A file that is named goes on to be judged, also one that a folder would not give, or that is not there."""
    paths = [folder / "notes.docx", folder / "none.xlsx", folder / ".hidden.xlsx"]
    assert given_files(paths).submissions == tuple(paths)


@POSIX
def test_links_in_a_folder_lead_nowhere(folder, tmp_path):
    """Links to files and folders, even to the folder itself, are not followed; a folder given by a link is read."""
    (tmp_path / "outside.xlsx").write_bytes(b"secret")
    (folder / "x.xlsx").symlink_to(tmp_path / "outside.xlsx")
    (folder / "loop").symlink_to(folder)
    found = given_files([folder], recursive=True)
    assert "2 links" in found.remarks[0]
    assert not {"x.xlsx", "outside.xlsx"} & {path.name for path in found.submissions}
    (tmp_path / "way").symlink_to(folder)
    assert len(given_files([tmp_path / "way"]).submissions) == 3


def test_a_folder_that_cannot_be_read_is_a_fault_of_its_own(folder, monkeypatch):
    """What may not be looked into is named with its fault, and the rest is taken."""
    scandir = os.scandir

    def refusing(path):
        if os.path.basename(path) == "sub":  # noqa: PTH119
            raise PermissionError(13, "Permission denied", str(path))
        return scandir(path)

    monkeypatch.setattr(os, "scandir", refusing)
    found = given_files([folder], recursive=True)
    assert [given.path.name for given in found.files if given.fault] == ["sub"]
    assert len(found.submissions) == 3


def test_an_empty_folder_gives_nothing(tmp_path):
    """A folder without a file has no submissions and nothing to tell."""
    assert given_files([tmp_path]).files == ()
