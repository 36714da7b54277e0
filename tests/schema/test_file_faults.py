"""Why a file cannot be used: in words of one's own, whatever the system says and in which language."""

import errno
import os

import pytest

from flexlash.schema.file_faults import reason, unusable


def _from_windows(number):
    """Return a fault as Windows raises it, its words in the language of the machine."""
    fault = PermissionError(errno.EACCES, "Der Prozess kann nicht auf die Datei zugreifen")
    fault.winerror = number
    return fault


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        (FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT)), "there is no such file"),
        (PermissionError(errno.EACCES, os.strerror(errno.EACCES)), "you have no permission"),
        (FileNotFoundError(errno.ENOENT, "there is no folder out"), "there is no folder out"),
        (_from_windows(32), "another program, such as Excel, has it open; close it there"),
        (_from_windows(5), "you have no permission"),
        (OSError(errno.ENOSPC, "the disk is full"), "the disk is full"),
    ],
)
def test_a_fault_has_plain_words(fault, words, tmp_path):
    """What the system says is put in words; what flexlash says itself stays."""
    assert reason(fault, tmp_path / "a.xlsx") == words


@pytest.mark.parametrize(("asked", "meant"), [("varients.xlsx", "variants.xlsx"), ("other.csv", "")])
def test_a_missing_file_comes_with_the_name_most_like_its_own(tmp_path, asked, meant):
    """A slip in a name is answered with the file that was meant, where one has nearly that name."""
    (tmp_path / "variants.xlsx").touch()
    fault = FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(tmp_path / asked))
    assert unusable(fault, tmp_path / asked) == (
        f"{tmp_path / asked} could not be opened: there is no such file{f'; did you mean {meant}?' if meant else ''}"
    )
    assert "could not be opened: there is no such file" in unusable(fault, tmp_path / "none" / asked)
