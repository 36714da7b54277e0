"""The gate: what is refused and by which code, what is let in, and each limit at its edge."""

import contextlib
import csv
import datetime
import io
import os
import re
import warnings
import zipfile
from pathlib import Path

import numpy as np
import pytest

from flexlash.pipeline import check
from flexlash.submission import gate
from flexlash.submission.gate import Refusal, admit, read_bytes
from flexlash.submission.read import read_submission

CORPUS = Path(__file__).resolve().parents[2] / "shared" / "corpus"
OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
PACKAGE = "http://schemas.openxmlformats.org/package/2006"
SHEET = "xl/worksheets/sheet1.xml"
STRINGS = "xl/sharedStrings.xml"
OLE2 = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
ONE = '<row r="1"><c r="A1"><v>1</v></c></row>'


def _relation(number, kind, target):
    return f'<Relationship Id="rId{number}" Type="{OFFICE}/{kind}" Target="{target}"/>'


def _book(sheets=('<sheet name="S" sheetId="1" r:id="rId1"/>',)):
    return f'<workbook xmlns="{MAIN}" xmlns:r="{OFFICE}"><sheets>{"".join(sheets)}</sheets></workbook>'


def _parts(rows=ONE, **changed):
    """Return the parts of a small workbook by name; `changed` replaces parts, None leaves one out."""
    kind = "application/vnd.openxmlformats-officedocument.spreadsheetml"
    parts = {
        "[Content_Types].xml": f'<Types xmlns="{PACKAGE}/content-types">'
        '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        '<Default Extension="xml" ContentType="application/xml"/>'
        f'<Override PartName="/xl/workbook.xml" ContentType="{kind}.sheet.main+xml"/>'
        f'<Override PartName="/{SHEET}" ContentType="{kind}.worksheet+xml"/>'
        f'<Override PartName="/{STRINGS}" ContentType="{kind}.sharedStrings+xml"/></Types>',
        "_rels/.rels": f'<Relationships xmlns="{PACKAGE}/relationships">'
        f"{_relation(1, 'officeDocument', 'xl/workbook.xml')}</Relationships>",
        "xl/workbook.xml": _book(),
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{PACKAGE}/relationships">'
        f"{_relation(1, 'worksheet', 'worksheets/sheet1.xml')}"
        f"{_relation(2, 'sharedStrings', 'sharedStrings.xml')}</Relationships>",
        SHEET: f'<worksheet xmlns="{MAIN}"><sheetData>{rows}</sheetData></worksheet>',
        STRINGS: f'<sst xmlns="{MAIN}"><si><t>first</t></si><si><t>last</t></si></sst>',
    }
    parts.update(changed)
    return {name: text for name, text in parts.items() if text is not None}


def _zip(parts, method=zipfile.ZIP_DEFLATED):
    """Return an archive of (name, text) pairs or of a dictionary."""
    buffer = io.BytesIO()
    pairs = parts.items() if isinstance(parts, dict) else parts
    with warnings.catch_warnings(), zipfile.ZipFile(buffer, "w", method) as archive:
        warnings.simplefilter("ignore")
        for name, text in pairs:
            archive.writestr(name, text)
    return buffer.getvalue()


def _book_of(rows=ONE, **changed):
    return _zip(_parts(rows, **changed))


def _refused(data):
    """Return the code by which bytes are refused, or None."""
    try:
        admit(data)
    except Refusal as refusal:
        return refusal.code
    return None


def _refused_or_read(path, data):
    """Return the code by which a file is refused from opening to the last cell, or None."""
    path.write_bytes(data)
    try:
        read_submission(path)
    except Refusal as refusal:
        return refusal.code
    return None


def _patched(data, signature, offset, value, size):
    """Return an archive with one field of every header of a kind overwritten."""
    changed = bytearray(data)
    place = changed.find(signature)
    while place >= 0:
        changed[place + offset : place + offset + size] = value.to_bytes(size, "little")
        place = changed.find(signature, place + 4)
    return bytes(changed)


def _encrypted():
    data = _patched(_book_of(), b"PK\x01\x02", 8, 1, 2)
    return _patched(data, b"PK\x03\x04", 6, 1, 2)


def _renamed_in_directory():
    """Return an archive whose directory calls a part by another name than the part itself."""
    data = _zip(_parts(), zipfile.ZIP_STORED)
    place = data.rfind(b"xl/sharedStrings.xml")
    return data[:place] + b"xl/sharedStringz.xml" + data[place + 20 :]


def _flipped():
    """Return an archive in which one digit of a number was changed and the checksum was not."""
    data = _zip(_parts('<row r="1"><c r="A1"><v>1.6</v></c></row>'), zipfile.ZIP_STORED)
    return data.replace(b"<v>1.6</v>", b"<v>1.7</v>")


REFUSED = {
    "random bytes": ("E101", np.random.default_rng(1).bytes(5000)),
    "a PDF": ("E101", b"%PDF-1.7\n1 0 obj\n<<>>\nendobj\n"),
    "a web page": ("E101", b"<html><table><tr><td>Variant</td></tr></table></html>"),
    "a letter in RTF": ("E101", b"{\\rtf1 Variant}"),
    "an empty archive": ("E101", b"PK\x05\x06" + b"\0" * 18),
    "an old .xls": ("E104", OLE2 + b"\0" * 504 + "Workbook".encode("utf-16-le")),
    "an encrypted workbook": ("E103", OLE2 + b"\0" * 504 + "EncryptedPackage".encode("utf-16-le")),
    "an encrypted part": ("E103", _encrypted()),
    "an .ods": ("E104", _zip({"mimetype": "application/vnd.oasis.opendocument.spreadsheet", "content.xml": "<a/>"})),
    "an .ods without its type": ("E104", _zip({"content.xml": "<a/>", "META-INF/manifest.xml": "<a/>"})),
    "an .xlsb": ("E104", _book_of(**{"xl/workbook.bin": "x"})),
    "an archive without relations": ("E101", _zip({"a.txt": "x"})),
    "an archive whose relations lead nowhere": ("E101", _book_of(**{"xl/workbook.xml": None})),
    "a document": ("E101", _book_of(**{"xl/workbook.xml": '<document xmlns="x"><body/></document>'})),
    "Strict Open XML": (
        "E106",
        _book_of(**{"xl/workbook.xml": _book().replace(MAIN, "http://purl.oclc.org/ooxml/spreadsheetml/main")}),
    ),
    "a DOCTYPE in a sheet": ("E105", _book_of(**{SHEET: f'<!DOCTYPE worksheet><worksheet xmlns="{MAIN}"/>'})),
    "a DOCTYPE in the workbook": ("E105", _book_of(**{"xl/workbook.xml": f"<!DOCTYPE workbook>{_book()}"})),
    "a DOCTYPE in the relations": (
        "E105",
        _book_of(**{"_rels/.rels": f"<!DOCTYPE x>{_parts()['_rels/.rels']}"}),
    ),
    "a half copy": ("E102", _book_of()[:900]),
    "a copy that lacks its end": ("E102", _book_of()[:-10]),
    "a changed digit": ("E102", _flipped()),
    "two parts of one name": ("E102", _zip([*_parts().items(), (SHEET, "<worksheet/>")])),
    "names that differ in case": ("E102", _zip([*_parts().items(), (SHEET.upper(), "<worksheet/>")])),
    "a part called otherwise in the directory": ("E102", _renamed_in_directory()),
    "a missing sheet": ("E102", _book_of(**{SHEET: None})),
    "a missing list of sheets": ("E102", _book_of(**{"xl/_rels/workbook.xml.rels": None})),
    "a sheet outside the file": (
        "E102",
        _book_of(
            **{
                "xl/_rels/workbook.xml.rels": _parts()["xl/_rels/workbook.xml.rels"].replace(
                    "worksheets/sheet1.xml", "http://example.com/sheet1.xml"
                )
            }
        ),
    ),
    "broken XML": ("E102", _book_of(**{SHEET: f'<worksheet xmlns="{MAIN}"><sheetData>'})),
    "a sheet without a name": ("E102", _book_of(**{"xl/workbook.xml": _book(['<sheet sheetId="1"/>'])})),
    "rows out of order": ("E102", _book_of('<row r="2"/><row r="1"/>')),
    "a row twice": ("E102", _book_of('<row r="2"/><row r="2"/>')),
    "a row 0": ("E102", _book_of('<row r="0"/>')),
    "a row beyond Excel": ("E102", _book_of('<row r="1048577"/>')),
    "a row 2,000,000,000": ("E102", _book_of('<row r="2000000000"/>')),
    "a row that is no number": ("E102", _book_of('<row r="x"/>')),
    "cells out of order": ("E102", _book_of('<row r="1"><c r="B1"/><c r="A1"/></row>')),
    "a cell twice": ("E102", _book_of('<row r="1"><c r="B1"/><c r="B1"/></row>')),
    "a cell in another row": ("E102", _book_of('<row r="1"><c r="A2"/></row>')),
    "a cell outside any row": ("E102", _book_of('<c r="A1"/>')),
    "a cell beyond Excel": ("E102", _book_of('<row r="1"><c r="XFE1"/></row>')),
    "a cell without letters": ("E102", _book_of('<row r="1"><c r="1"/></row>')),
    "an absolute reference": ("E102", _book_of('<row r="1"><c r="$A$1"/></row>')),
    "a padded row number": ("E102", _book_of('<row r="1"><c r="A01"/></row>')),
}


@pytest.mark.parametrize("what", REFUSED)
def test_refused_by_its_code(what):
    """What is no submission, damaged, locked or unsafe is refused, each by its own code."""
    code, data = REFUSED[what]
    assert _refused(data) == code


@pytest.mark.parametrize("what", REFUSED)
def test_a_refusal_is_an_outcome_that_names_the_file(what, tmp_path):
    """A refused file ends in one error that names the file and nothing of the program's inside."""
    code, data = REFUSED[what]
    path = tmp_path / "mine.xlsx"
    path.write_bytes(data)
    outcome = check(path)
    assert outcome.exit_code == 4
    assert [found.code for found in outcome.findings] == [code]
    assert outcome.findings[0].message.startswith("mine.xlsx ")
    assert str(tmp_path) not in outcome.findings[0].message


@pytest.mark.parametrize(
    ("code", "words"),
    [("an old .xls", ".xls"), ("an .ods", ".ods"), ("an .xlsb", ".xlsb")],
)
def test_another_format_is_named(code, words):
    """A workbook of another format is refused by the name of that format."""
    with pytest.raises(Refusal) as caught:
        admit(REFUSED[code][1])
    assert words in caught.value.facts["found"]


ACCEPTED = {
    "a workbook": ("workbook", _book_of()),
    "a workbook whose parts are not compressed": ("workbook", _zip(_parts(), zipfile.ZIP_STORED)),
    "cells without addresses": ("workbook", _book_of("<row><c><v>1</v></c><c/></row><row><c/></row>")),
    "cells partly without addresses": ("workbook", _book_of('<row r="3"><c r="B3"/><c/></row>')),
    "the last cell of Excel": ("workbook", _book_of('<row r="1048576"><c r="A1048576"/><c r="XFD1048576"/></row>')),
    "an absolute path to the workbook": (
        "workbook",
        _book_of(**{"_rels/.rels": _parts()["_rels/.rels"].replace('"xl/', '"/xl/')}),
    ),
    "an absolute path to a sheet": (
        "workbook",
        _book_of(
            **{
                "xl/_rels/workbook.xml.rels": _parts()["xl/_rels/workbook.xml.rels"].replace(
                    '"worksheets/', '"/xl/worksheets/'
                )
            }
        ),
    ),
    "another prefix": (
        "workbook",
        _book_of(**{"xl/workbook.xml": re.sub(r"(</?)(?=\w)", r"\1x:", _book()).replace("xmlns=", "xmlns:x=")}),
    ),
    "a chart sheet beside": (
        "workbook",
        _book_of(
            **{"xl/workbook.xml": _book(['<sheet name="S" sheetId="1" r:id="rId1"/><sheet name="C" sheetId="2"/>'])}
        ),
    ),
    "Parquet": ("parquet", b"PAR1" + b"\0" * 20 + b"PAR1"),
    "a table": ("csv", b"Variant,Material\na,b\n"),
    "a table with a byte order mark": ("csv", b"\xef\xbb\xbfVariant;Material\na;b\n"),
    "a single word": ("csv", b"x"),
}


@pytest.mark.parametrize("what", ACCEPTED)
def test_admitted_by_content(what):
    """Workbooks, Parquet and text are admitted as what they are, whatever their name would be."""
    kind, data = ACCEPTED[what]
    admitted = admit(data)
    assert (admitted.kind, admitted.data) == (kind, data)


@pytest.mark.parametrize("what", ["a workbook", "Parquet"])
def test_where_only_a_table_will_do(what):
    """Where a CSV file is asked for, another kind is refused with the kind that is required."""
    kind, data = ACCEPTED[what]
    with pytest.raises(Refusal) as caught:
        admit(data, only="csv")
    assert caught.value.code == "E101"
    assert "csv" in caught.value.facts["found"]
    assert admit(data, only=kind).kind == kind


FORMULAS = {
    '<c r="A1"><f>1+1</f></c>': [(1, 1)],
    '<c r="A1"><f>1+1</f><v></v></c>': [(1, 1)],
    '<c r="A1"><f>1+1</f><v/></c>': [(1, 1)],
    "<c><v>1</v></c><c><f>1+1</f></c>": [(1, 2)],
    '<c r="A1"><f>1+1</f><v>2</v></c>': [],
    '<c r="A1"><f>1+1</f><v>0</v></c>': [],
    '<c r="A1" t="str"><f>""</f><v></v></c>': [],
    '<c r="A1" t="str"><f>"x"</f><v>x</v></c>': [],
    '<c r="A1" t="e"><f>1/0</f><v>#DIV/0!</v></c>': [],
    '<c r="A1"><v>2</v></c><c r="AB1"><f>A1</f></c>': [(1, 28)],
    '<c r="A1"><f t="shared" ref="A1:B1" si="0">1</f></c><c r="B1"><f t="shared" si="0"/></c>': [(1, 1), (1, 2)],
    '<c r="A1"><f t="array" ref="A1:A1">1</f><v>1</v></c>': [],
    '<c r="A1"/>': [],
}


@pytest.mark.parametrize("cells", FORMULAS)
def test_formulas_without_a_stored_result_are_named(cells):
    """A formula whose result was never stored is named by sheet, row and column; an empty text is a result."""
    admitted = admit(_book_of(f'<row r="1">{cells}</row>'))
    assert admitted.unstored == {"S": frozenset(FORMULAS[cells])}


ERROR_CELLS = {
    '<c r="A1" t="e"><v>#REF!</v></c>': [(1, 1)],
    '<c r="A1" t="e"><f>1/0</f><v>#DIV/0!</v></c>': [(1, 1)],
    '<c><v>1</v></c><c t="e"><v>#N/A</v></c>': [(1, 2)],
    '<c r="A1" t="e"><v>#NEWWORD!</v></c>': [(1, 1)],
    '<c r="A1" t="e"/>': [(1, 1)],
    '<c r="A1" t="inlineStr"><is><t>#REF!</t></is></c>': [],
    '<c r="A1"><v>1</v></c>': [],
}


@pytest.mark.parametrize("cells", ERROR_CELLS)
def test_error_cells_are_named(cells):
    """A cell stored as an error is named by sheet, row and column, whatever its word."""
    assert admit(_book_of(f'<row r="1">{cells}</row>')).errors == {"S": frozenset(ERROR_CELLS[cells])}


@pytest.mark.parametrize(
    ("stored", "date"),
    [
        ("2026-01-02T03:04:05Z", datetime.datetime(2026, 1, 2, 3, 4, 5)),  # noqa: DTZ001
        ("2026-01-02T03:04:05.678+02:00", datetime.datetime(2026, 1, 2, 1, 4, 5)),  # noqa: DTZ001
        ("2026-01-02T03:04:05", datetime.datetime(2026, 1, 2, 3, 4, 5)),  # noqa: DTZ001
        ("yesterday", None),
        ("", None),
    ],
)
def test_the_date_of_a_workbook_is_its_own(stored, date):
    """A workbook's date of change is the one it stores, in UTC; without one, or with nonsense, it has none."""
    dates = f"<d:created>2001</d:created><d:modified>{stored}</d:modified><d:issued>2002</d:issued>"
    core = f'<a xmlns:d="http://purl.org/dc/terms/">{dates}</a>'
    assert admit(_book_of(**{"docProps/core.xml": core})).modified == date
    assert admit(_book_of()).modified is None


def test_formulas_are_told_by_sheet():
    """Formulas without a result are kept apart by the sheets they stand in."""
    links = _parts()["xl/_rels/workbook.xml.rels"].replace(
        "</Relationships>", _relation(3, "worksheet", "worksheets/sheet2.xml") + "</Relationships>"
    )
    titles = ['<sheet name="S" sheetId="1" r:id="rId1"/>', '<sheet name="Δ &amp; more" sheetId="2" r:id="rId3"/>']
    second = f'<worksheet xmlns="{MAIN}"><sheetData><row r="7"><c r="C7"><f>1</f></c></row></sheetData></worksheet>'
    data = _book_of(
        **{
            "xl/workbook.xml": _book(titles),
            "xl/_rels/workbook.xml.rels": links,
            "xl/worksheets/sheet2.xml": second,
        }
    )
    assert admit(data).unstored == {"S": frozenset(), "Δ & more": frozenset({(7, 3)})}


def _nested(depth):
    """Return a workbook whose sheet nests its elements to a depth."""
    return _book_of("<a>" * (depth - 2) + "</a>" * (depth - 2))


def _with_part(size):
    return _book_of(**{"xl/media/image.bin": b"\0" * size})


def test_depth_at_its_limit():
    """Elements may nest 64 deep, not 65."""
    assert _refused(_nested(64)) is None
    assert _refused(_nested(65)) == "E102"


def test_compression_at_its_limit():
    """A part of up to 1 MiB may shrink as it will; a larger one by 100 to 1 at most."""
    assert _refused(_with_part(2**20)) is None
    assert _refused(_with_part(2**20 + 1)) == "E110"


def test_parts_at_their_limit():
    """An archive may hold 1,000 parts, not 1,001."""
    own = len(_parts())
    extra = {f"xl/extra/{number}.xml": "" for number in range(1000 - own)}
    assert _refused(_zip(_parts() | extra)) is None
    assert _refused(_zip(_parts() | extra | {"one/more.xml": ""})) == "E110"


LIMITS = {
    "MAXIMUM_ATTRIBUTES": (10, _book_of('<row r="1" a="" b="" c="" d="" e="" f="" g="" h="" i=""/>')),
    "MAXIMUM_SHEETS": (1, _book_of()),
    "MAXIMUM_MERGES": (2, _book_of(f'{ONE}<mergeCell ref="A1:B1"/><mergeCell ref="A2:B2"/>')),
    "MAXIMUM_CELLS": (3, _book_of('<row r="1"><c r="A1"/><c r="B1"/></row><row r="2"><c r="A2"/></row>')),
    "MAXIMUM_PART_BYTES": (5000, _with_part(5000)),
    "MAXIMUM_INFLATED_BYTES": (sum(map(len, _parts().values())), _book_of()),
    "MAXIMUM_ROW": (7, _book_of('<row r="7"/>')),
    "MAXIMUM_COLUMN": (28, _book_of('<row r="1"><c r="AB1"/></row>')),
}


@pytest.mark.parametrize("name", LIMITS)
def test_a_limit_at_its_edge(name, monkeypatch):
    """What lies at a limit is admitted; one more is refused."""
    size, data = LIMITS[name]
    monkeypatch.setattr(gate, name, size)
    assert _refused(data) is None
    monkeypatch.setattr(gate, name, size - 1)
    assert _refused(data) in {"E102", "E110"}


def test_styles_at_their_edge():
    """A cell may refer to the last of the workbook's cell formats, not beyond; other lists of formats do not count."""
    styles = ONE_STYLE.replace(
        "<xf/></cellXfs>", "<xf><alignment/></xf><xf><alignment/></xf></cellXfs><dxfs><xf/></dxfs>"
    )
    for style, code in ((0, None), (1, None), (2, "E102"), (-1, "E102")):
        cells = f'<row r="1"><c r="A1" s="{style}"><v>1</v></c></row>'
        assert _refused(_book_of(cells, **{STYLES: styles})) == code


def test_limits_are_the_promised_ones():
    """The limits are those that were measured and promised."""
    promised = {
        "MAXIMUM_BYTES": 20 * 2**20,
        "MAXIMUM_PARTS": 1_000,
        "MAXIMUM_PART_BYTES": 100 * 2**20,
        "MAXIMUM_INFLATED_BYTES": 200 * 2**20,
        "MAXIMUM_RATIO": 100,
        "MAXIMUM_ROW": 1_048_576,
        "MAXIMUM_COLUMN": 16_384,
        "MAXIMUM_CELLS": 1_000_000,
        "MAXIMUM_DEPTH": 64,
        "MAXIMUM_ATTRIBUTES": 256,
        "MAXIMUM_SHEETS": 100,
        "MAXIMUM_MERGES": 10_000,
    }
    assert {name: getattr(gate, name) for name in promised} == promised


def test_a_size_that_is_only_declared():
    """A part that claims to be larger than the limit is refused before it is unpacked."""
    data = _patched(_book_of(), b"PK\x01\x02", 24, 101 * 2**20, 4)
    with pytest.raises(Refusal) as caught:
        admit(data)
    assert caught.value.code == "E110"
    assert caught.value.facts == {"what": "the unpacked size", "limit": "100 MiB a part, 200 MiB in all"}


def test_a_part_larger_than_it_claims():
    """A part that unpacks to more than it claims is refused as damaged."""
    assert _refused(_patched(_book_of(), b"PK\x01\x02", 24, 10, 4)) == "E102"


def test_a_refusal_names_its_limit(monkeypatch):
    """A refusal for size says what may be at most how much."""
    monkeypatch.setattr(gate, "MAXIMUM_CELLS", 0)
    with pytest.raises(Refusal) as caught:
        admit(_book_of())
    assert caught.value.facts == {"what": "the number of cells", "limit": "0"}


def test_a_file_at_the_limit_of_size(tmp_path, monkeypatch):
    """A file of the greatest size is read whole, one byte more is refused; Parquet has no such limit."""
    monkeypatch.setattr(gate, "MAXIMUM_BYTES", 2**20)
    path = tmp_path / "a.csv"
    path.write_bytes(b"x" * 2**20)
    assert len(read_bytes(path)) == 2**20
    path.write_bytes(b"x" * (2**20 + 1))
    with pytest.raises(Refusal) as caught:
        read_bytes(path)
    assert (caught.value.code, caught.value.facts["limit"]) == ("E110", "1 MiB")
    path.write_bytes(b"PAR1" + b"x" * 2**20)
    assert len(read_bytes(path)) == 2**20 + 4


def test_an_empty_file(tmp_path):
    """An empty file is refused as empty."""
    path = tmp_path / "a.xlsx"
    path.touch()
    with pytest.raises(Refusal) as caught:
        read_bytes(path)
    assert (caught.value.code, caught.value.facts) == ("E101", {"found": "the file is empty"})


def test_what_is_no_file_cannot_be_opened(tmp_path):
    """A folder, a pipe and a missing file are errors of opening, told by name without their folder."""
    places = [tmp_path, tmp_path / "missing.xlsx"]
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "pipe.xlsx")
        places.append(tmp_path / "pipe.xlsx")
    for place in places:
        with pytest.raises(OSError, match=place.name) as caught:
            read_bytes(place)
        assert str(place.parent) not in str(caught.value)


def test_a_flipped_bit_never_reads_as_another_value(tmp_path):
    """Wherever one bit of a workbook flips, it is refused or reads exactly as before."""
    rows = '<row r="1"><c r="A1"><v>1.6</v></c><c r="B1" t="s"><v>1</v></c><c r="C1"><f>1</f></c></row>'
    data = _zip(_parts(rows), zipfile.ZIP_STORED)
    path = tmp_path / "a.xlsx"
    path.write_bytes(data)
    sound = read_submission(path).sheets
    draw = np.random.default_rng(7)
    read = 0
    for place, bit in draw.integers((0, 0), (len(data), 8), size=(400, 2)):
        changed = bytearray(data)
        changed[place] ^= 1 << bit
        path.write_bytes(changed)
        with contextlib.suppress(Refusal):
            assert read_submission(path).sheets == sound
            read += 1
    assert read < 100


def test_a_torn_copy_is_never_read(tmp_path):
    """However much of a workbook's end is missing, it is refused as damaged, or as empty."""
    data = _book_of()
    path = tmp_path / "a.xlsx"
    for length in range(4, len(data), 37):
        assert _refused_or_read(path, data[:length]) == "E102"


STYLES = "xl/styles.xml"
ONE_STYLE = f'<styleSheet xmlns="{MAIN}"><cellStyleXfs><xf/><xf/></cellStyleXfs><cellXfs><xf/></cellXfs></styleSheet>'
MANY_ATTRIBUTES = " ".join(f'a{number}="1"' for number in range(256))
MERGES = "".join(f'<mergeCell ref="A{number}:B{number}"/>' for number in range(1, 10_002))
PROMISED = {
    "a path that climbs": _book_of(**{"../evil.xml": "<a/>"}),
    "an absolute path": _book_of(**{"/evil.xml": "<a/>"}),
    "a backslash in a path": _book_of(**{"xl\\evil.xml": "<a/>"}),
    "a colon in a path": _book_of(**{"C:evil.xml": "<a/>"}),
    "compression other than deflate": _zip(_parts(), zipfile.ZIP_LZMA),
    "257 attributes": _book_of(f'<row r="1" {MANY_ATTRIBUTES}/>'),
    "101 sheets": _book_of(
        **{"xl/workbook.xml": _book(f'<sheet name="S{n}" sheetId="{n + 1}" r:id="rId1"/>' for n in range(101))}
    ),
    "10,001 merged ranges": _book_of(
        **{SHEET: _parts()[SHEET].replace("</sheetData>", f"</sheetData><mergeCells>{MERGES}</mergeCells>")}
    ),
    "a shared text before the first": _book_of('<row r="1"><c r="A1" t="s"><v>-1</v></c></row>'),
    "a style that does not exist": _book_of('<row r="1"><c r="A1" s="1"><v>1</v></c></row>', **{STYLES: ONE_STYLE}),
    "a number with an underscore": _book_of('<row r="1"><c r="A1"><v>1_000</v></c></row>'),
    "an address in small letters": _book_of('<row r="1"><c r="B1"/><c r="a1"><v>1</v></c></row>'),
    "a row inside a row": _book_of('<row r="1"><c r="A1"><v>1</v></c><row r="2"><c r="A2"><v>2</v></c></row></row>'),
}


@pytest.mark.parametrize("what", PROMISED)
def test_promised_refusals(what, tmp_path):
    """Each further limit and rule of the gate refuses what breaks it."""
    assert _refused_or_read(tmp_path / "a.xlsx", PROMISED[what]) in {"E102", "E110"}


@pytest.mark.parametrize(
    "part",
    [
        STRINGS,
        "[Content_Types].xml",
        STYLES,
        "docProps/core.xml",
    ],
)
def test_a_doctype_anywhere(part, tmp_path):
    """A document type declaration is refused by its own code in whichever part it stands."""
    text = _parts().get(part, "<x/>")
    declared = f'<!DOCTYPE x [<!ENTITY a "b">]>{text}'
    data = _book_of(**{part: declared})
    assert _refused_or_read(tmp_path / "a.xlsx", data) == "E105"


def test_a_doctype_in_another_encoding(tmp_path):
    """A document type declaration that a search for its letters misses is refused where the part is read."""
    sheet = '<?xml version="1.0" encoding="UTF-16"?><!DOCTYPE x [<!ENTITY a "b">]><worksheet/>'
    parts = _parts()
    (part,) = [name for name in parts if name.startswith("xl/worksheets/")]
    assert _refused_or_read(tmp_path / "a.xlsx", _book_of(**{part: sheet.encode("utf-16")})) == "E105"


def test_a_picture_may_declare_its_type():
    """A picture that Excel keeps beside the sheets, and nobody reads, may have a DOCTYPE as SVG files do."""
    picture = '<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/x.dtd"><svg/>'
    assert _refused(_book_of(**{"xl/media/image1.svg": picture})) is None


def test_a_formula_without_address_or_result(tmp_path):
    """Cells without addresses are counted, also where a formula lacks its result."""
    path = tmp_path / "a.xlsx"
    path.write_bytes(_book_of("<row><c><v>1</v></c><c><f>1+1</f></c></row>"))
    assert 2 in read_submission(path).sheets["S"].rows[1]


def test_a_table_in_utf_16():
    """A table that Excel saved as Unicode Text is refused for its encoding, which the user can mend."""
    assert _refused("Variant\tMaterial\na\tb\n".encode("utf-16")) == "E107"


@pytest.mark.xfail(strict=True, reason="links are still followed; a drop folder must not")
def test_a_link_is_not_followed(tmp_path):
    """A symbolic link is no regular file and is not opened."""
    (tmp_path / "real.csv").write_bytes(b"x")
    (tmp_path / "link.csv").symlink_to(tmp_path / "real.csv")
    with pytest.raises(OSError, match=r"link\.csv"):
        read_bytes(tmp_path / "link.csv")


def _manifest():
    """Return the rows of the corpus's manifest."""
    if not CORPUS.is_dir():
        pytest.skip("the shared corpus is not here")
    lines = (CORPUS / "MANIFEST.tsv").read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader([line for line in lines if not line.startswith("#")], delimiter="\t"))


@pytest.fixture(scope="module")
def judged():
    """Return expectation, outcome or exception, and Python warnings of every file of the corpus, by name."""
    found = {}
    for row in _manifest():
        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always")
            try:
                outcome = check(CORPUS / row["file"])
            except Exception as fault:  # noqa: BLE001
                outcome = fault
        found[row["file"]] = (row["expectation"], outcome, warned)
    return found


CODES = {
    "refuse:encrypted": {"E103"},
    "refuse:old-xls": {"E104"},
    "refuse:ods": {"E104"},
    "refuse:xlsb": {"E104"},
    "refuse:damaged": {"E102"},
    "refuse:not-a-workbook": {"E101", "E109"},
    "refuse:dtd-entity": {"E101", "E104", "E105"},
    "refuse-or-read:strict": {"E106"},
    "refuse-or-read:dialect": {"E102", "E108"},
    "readable:not-our-template": {"E108"},
}
KNOWN = {
    "roo__implicit_coordinates.xlsx": "a content type without its part is told as damage, Excel reads it",
}


def test_every_public_workbook_ends_in_an_outcome(judged):
    """Every workbook of the corpus ends in one refusal with exit code 4, and none in an exception."""
    bad = {
        name: outcome if isinstance(outcome, Exception) else (outcome.exit_code, outcome.findings)
        for name, (_, outcome, _) in judged.items()
        if isinstance(outcome, Exception)
        or outcome.exit_code != 4
        or not any(found.code.startswith("E1") for found in outcome.findings)
    }
    assert len(judged) > 200
    assert bad == {}


def _mismatch(expectation, outcome):
    """Return the error codes of an outcome that its expectation does not allow."""
    codes = {found.code for found in outcome.findings if found.level == "error"}
    return sorted(codes - CODES[expectation.split(";")[0].strip()])


def test_every_public_workbook_is_refused_by_the_right_name(judged):
    """What the manifest calls encrypted, old, foreign, damaged or readable is told as such, both ways."""
    bad = {
        name: (expectation, found)
        for name, (expectation, outcome, _) in judged.items()
        if name not in KNOWN and (found := _mismatch(expectation, outcome))
    }
    assert bad == {}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.xfail(strict=True, reason=KNOWN[name])) for name in KNOWN]
)
def test_public_workbooks_that_are_told_wrongly(judged, name):
    """These too are told by the right name."""
    expectation, outcome, _ = judged[name]
    codes = {found.code for found in outcome.findings}
    allowed = {"E105"} if "dtd" in expectation else {"E108"}
    assert codes <= allowed


def test_reading_warns_nobody(judged):
    """Reading a workbook raises no Python warning, which would reach the user's terminal."""
    assert {name: str(warned[0].message) for name, (_, _, warned) in judged.items() if warned} == {}
