"""The gate: bytes of a regular file, and what kind of submission they are by their content."""

import os

import numpy as np
import pytest

from flexlash.pipeline import check
from flexlash.submission.reading.gate import kind_of, read_bytes
from flexlash.submission.reading.limits import ReadingLimits
from flexlash.submission.reading.refusal import Refusal
from small_workbook import OLE2, archive_of, book_of

REFUSED = {
    "random bytes": ("E101", np.random.default_rng(1).bytes(5000)),
    "a PDF": ("E101", b"%PDF-1.7\n1 0 obj\n<<>>\nendobj\n"),
    "a web page": ("E101", b"<html><table><tr><td>Variant</td></tr></table></html>"),
    "a letter in RTF": ("E101", b"{\\rtf1 Variant}"),
    "a picture": ("E101", b"\x89PNG\r\n\x1a\n" + b"\0" * 20),
    "a photo": ("E101", b"\xff\xd8\xff\xe0" + b"\0" * 20),
    "a single word": ("E101", b"x"),
    "a sentence": ("E101", b"hello world\n"),
    "an empty archive": ("E101", b"PK\x05\x06" + b"\0" * 18),
    "an old .xls": ("E104", OLE2 + b"\0" * 504 + "Workbook".encode("utf-16-le")),
    "an old .xls whose sectors form a loop": ("E104", OLE2 + b"\0" * 68 + b"\0\0\0\0" * 1000),
    "an encrypted workbook": ("E103", OLE2 + b"\0" * 504 + "EncryptedPackage".encode("utf-16-le")),
}


@pytest.mark.parametrize("what", REFUSED)
def test_refused_by_its_code(what):
    """What is no submission, old or locked is refused, each by its own code."""
    code, data = REFUSED[what]
    with pytest.raises(Refusal) as caught:
        kind_of(data)
    assert caught.value.code == code


ENDS = {
    **REFUSED,
    "a half copy": ("E102", book_of()[:900]),
    "an .ods": ("E104", archive_of({"mimetype": "application/vnd.oasis.opendocument.spreadsheet"})),
    "a workbook of other sheets": ("E108", book_of()),
}


@pytest.mark.parametrize("what", ENDS)
def test_a_refusal_is_an_outcome_that_names_the_file(what, tmp_path):
    """A refused file ends in one error that names the file and nothing of the program's inside."""
    code, data = ENDS[what]
    path = tmp_path / "mine.xlsx"
    path.write_bytes(data)
    outcome = check(path)
    assert outcome.exit_code == 4
    assert [found.code for found in outcome.findings] == [code]
    assert outcome.findings[0].message.startswith("mine.xlsx ")
    assert str(tmp_path) not in outcome.findings[0].message


@pytest.mark.parametrize(
    ("what", "words"),
    [
        ("a picture", "a picture"),
        ("a photo", "a picture"),
        ("a PDF", "PDF"),
        ("a letter in RTF", "RTF"),
        ("a web page", "web page"),
        ("a sentence", "no table"),
        ("random bytes", "neither a workbook nor a table"),
    ],
)
def test_other_files_are_named(what, words):
    """A picture, a document or a sentence is refused as what it is."""
    with pytest.raises(Refusal) as caught:
        kind_of(REFUSED[what][1])
    assert words in caught.value.facts["found"]


def test_a_lock_file_is_named(tmp_path):
    """The small file that Excel puts beside an open workbook is refused by its name; a real one of that name is not."""
    path = tmp_path / "~$good.xlsx"
    path.write_bytes(b"\x05Anna " + b" " * 49 + b"\x05\0A\0n\0n\0a\0" + b" \0" * 50)
    (found,) = check(path).findings
    assert found.code == "E101"
    assert "lock file" in found.message
    path.write_bytes(book_of())
    assert read_bytes(path) == book_of() or len(book_of()) <= 1024


def test_an_old_workbook_is_named():
    """A workbook of the old format is refused by the name of that format."""
    with pytest.raises(Refusal) as caught:
        kind_of(REFUSED["an old .xls"][1])
    assert ".xls" in caught.value.facts["found"]


ACCEPTED = {
    "a workbook": ("workbook", book_of()),
    "Parquet": ("parquet", b"PAR1" + b"\0" * 20 + b"PAR1"),
    "a table": ("csv", b"Variant,Material\na,b\n"),
    "a table with a byte order mark": ("csv", b"\xef\xbb\xbfVariant;Material\na;b\n"),
    "a table that Excel saved as Unicode Text": ("csv", "Variant\tMaterial\na\tb\n".encode("utf-16")),
    "a table in UTF-16 the other way round": ("csv", b"\xfe\xff" + "Variant\ta\n".encode("utf-16-be")),
    "a column of two rows": ("csv", b"Variant\na\n"),
    "a lone header row": ("csv", b"Variant;Material"),
}


@pytest.mark.parametrize("what", ACCEPTED)
def test_the_kind_is_told_by_content(what):
    """Workbooks, Parquet and text are told as what they are, whatever their name would be."""
    kind, data = ACCEPTED[what]
    assert kind_of(data) == kind


@pytest.mark.parametrize("what", ["a workbook", "Parquet"])
def test_where_only_a_table_will_do(what):
    """Where a CSV file is asked for, another kind is refused with the kind that is required."""
    kind, data = ACCEPTED[what]
    with pytest.raises(Refusal) as caught:
        kind_of(data, only="csv")
    assert caught.value.code == "E101"
    assert "csv" in caught.value.facts["found"]
    assert kind_of(data, only=kind) == kind


def test_a_file_at_the_limit_of_size(tmp_path):
    """A file of the greatest size is read whole, one byte more is refused; Parquet has no such limit."""
    limits = ReadingLimits(file_mebibytes=1)
    path = tmp_path / "a.csv"
    path.write_bytes(b"x" * 2**20)
    assert len(read_bytes(path, limits)) == 2**20
    path.write_bytes(b"x" * (2**20 + 1))
    with pytest.raises(Refusal) as caught:
        read_bytes(path, limits)
    assert (caught.value.code, caught.value.facts["limit"]) == ("E110", "1 MiB")
    path.write_bytes(b"PAR1" + b"x" * 2**20)
    assert len(read_bytes(path, limits)) == 2**20 + 4


def test_an_empty_file(tmp_path):
    """An empty file is refused as empty."""
    path = tmp_path / "a.xlsx"
    path.touch()
    with pytest.raises(Refusal) as caught:
        read_bytes(path)
    assert (caught.value.code, caught.value.facts) == ("E101", {"found": "the file is empty"})


def test_what_is_no_file_cannot_be_opened(tmp_path):
    """A folder, a pipe and a missing file are errors of opening, told by name."""
    places = [tmp_path, tmp_path / "missing.xlsx"]
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "pipe.xlsx")
        places.append(tmp_path / "pipe.xlsx")
    for place in places:
        with pytest.raises(OSError, match=place.name):
            read_bytes(place)


@pytest.mark.skipif(not hasattr(os, "O_NOFOLLOW"), reason="this system cannot open without following links")
@pytest.mark.parametrize("target", ["real.csv", "missing.csv", "."])
def test_a_link_is_not_followed(tmp_path, target):
    """A symbolic link is no regular file and is not opened; the error names it."""
    (tmp_path / "real.csv").write_bytes(b"x")
    (tmp_path / "link.csv").symlink_to(tmp_path / target)
    with pytest.raises(OSError, match="this is a link") as caught:
        read_bytes(tmp_path / "link.csv")
    assert caught.value.filename == str(tmp_path / "link.csv")
