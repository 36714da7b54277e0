"""How the parts of a workbook belong together: what is no workbook, and which part is which sheet."""

import datetime
import re

import pytest
from small_workbook import (
    CORE,
    MAIN,
    OFFICE,
    RELATIONS,
    ROOT,
    SHEET,
    STRINGS,
    STYLES,
    TYPES,
    WORKBOOK,
    parts_of,
    relation,
    sheet_of,
    styles_of,
    workbook_part,
)

from flexlash.reading.package import open_package
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal

STRICT = "http://purl.oclc.org/ooxml/spreadsheetml/main"


def _opened(parts, **limits):
    """Open parts given as texts or bytes."""
    encoded = {name: part if isinstance(part, bytes) else part.encode() for name, part in parts.items()}
    return open_package(encoded, ReadingLimits(**limits))


def _refused(parts, **limits):
    try:
        _opened(parts, **limits)
    except Refusal as refusal:
        return refusal.code
    return None


def _replaced(part, old, new):
    """Return a workbook's parts with one of them changed."""
    text = parts_of()[part]
    assert old in text
    return parts_of(**{part: text.replace(old, new)})


_BESIDE = parts_of()[RELATIONS].replace("</Rel", f"{relation(9, 'chartsheet', 'chartsheets/sheet1.xml')}</Rel")

REFUSED = {
    "an .ods": ("E104", {"mimetype": "application/vnd.oasis.opendocument.spreadsheet", "content.xml": "<a/>"}),
    "an .ods without its type": ("E104", {"content.xml": "<a/>", "META-INF/manifest.xml": "<a/>"}),
    "an .xlsb": ("E104", parts_of(**{"xl/workbook.bin": "x"})),
    "an archive without relations": ("E101", {"a.txt": "x"}),
    "an empty archive": ("E101", {}),
    "relations that lead nowhere": ("E101", parts_of(**{WORKBOOK: None})),
    "a document": ("E101", parts_of(**{WORKBOOK: '<document xmlns="x"><body/></document>'})),
    "a workbook of an unknown dialect": ("E106", _replaced(WORKBOOK, MAIN, "urn:other")),
    "a missing sheet": ("E102", parts_of(**{SHEET: None})),
    "a missing list of sheets": ("E102", parts_of(**{RELATIONS: None})),
    "a sheet outside the file": ("E102", _replaced(RELATIONS, "worksheets/sheet1.xml", "http://example.com/1.xml")),
    "a sheet without its relation": ("E102", _replaced(RELATIONS, 'Id="rId1"', 'Id="rId7"')),
    "a sheet of an unknown kind": ("E102", _replaced(RELATIONS, '/worksheet"', '/worksheets"')),
    "two sheets of one name": (
        "E102",
        parts_of(**{WORKBOOK: workbook_part(f'<sheet name="{name}" sheetId="1" r:id="rId1"/>' for name in "Ss")}),
    ),
    "another workbook in the list of types": ("E102", _replaced(TYPES, "/xl/workbook.xml", f"/{SHEET}")),
    "a DOCTYPE in the list of types": ("E105", parts_of(**{TYPES: f"<!DOCTYPE x>{parts_of()[TYPES]}"})),
    "a DOCTYPE in the workbook": ("E105", parts_of(**{WORKBOOK: f"<!DOCTYPE workbook>{workbook_part()}"})),
    "a DOCTYPE in the relations": ("E105", parts_of(**{ROOT: f"<!DOCTYPE x>{parts_of()[ROOT]}"})),
    "a DOCTYPE in a sheet": ("E105", parts_of(**{SHEET: f"<!DOCTYPE worksheet>{sheet_of('')}"})),
    "a DOCTYPE in the texts": ("E105", parts_of(**{STRINGS: '<!DOCTYPE x [<!ENTITY a "b">]><sst/>'})),
    "a DOCTYPE in the styles": ("E105", parts_of(**{STYLES: '<!DOCTYPE x [<!ENTITY a "b">]><styleSheet/>'})),
    "a DOCTYPE in the properties": ("E105", parts_of(**{CORE: '<!DOCTYPE x [<!ENTITY a "b">]><x/>'})),
    "a DOCTYPE in an unknown part": ("E105", parts_of(**{"xl/new.xml": "<!DOCTYPE x><x/>"})),
    "broken XML in the styles": ("E102", parts_of(**{STYLES: "<styleSheet>"})),
    "broken XML in the texts": ("E102", parts_of(**{STRINGS: "<sst>"})),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_refused_by_its_code(what):
    """What is no workbook, foreign, damaged or unsafe is refused, each by its own code."""
    code, parts = REFUSED[what]
    assert _refused(parts) == code


@pytest.mark.parametrize(("what", "words"), [("an .ods", ".ods"), ("an .xlsb", ".xlsb")])
def test_another_format_is_named(what, words):
    """A workbook of another format is refused by the name of that format."""
    with pytest.raises(Refusal) as caught:
        _opened(REFUSED[what][1])
    assert words in caught.value.facts["found"]


ACCEPTED = {
    "as usual": parts_of(),
    "an absolute path to the workbook": _replaced(ROOT, '"xl/', '"/xl/'),
    "an absolute path to a sheet": _replaced(RELATIONS, '"worksheets/', '"/xl/worksheets/'),
    "a path that goes up and down": _replaced(RELATIONS, '"worksheets/', '"../xl/worksheets/'),
    "another prefix": parts_of(
        **{WORKBOOK: re.sub(r"(</?)(?=\w)", r"\1x:", workbook_part()).replace("xmlns=", "xmlns:x=")}
    ),
    "a chart sheet beside": parts_of(
        **{
            WORKBOOK: workbook_part(f'<sheet name="S{n}" sheetId="{n}" r:id="rId{n}"/>' for n in (1, 9)).replace(
                "S1", "S"
            ),
            RELATIONS: _BESIDE,
            "xl/chartsheets/sheet1.xml": "<chartsheet/>",
        }
    ),
    "a picture that declares its type": parts_of(
        **{"xl/media/image1.svg": '<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/x.dtd"><svg/>'}
    ),
}


@pytest.mark.parametrize("what", ACCEPTED)
def test_the_sheet_is_found(what):
    """The sheet is found by relations, whatever their paths and prefixes look like."""
    package = _opened(ACCEPTED[what])
    assert [(sheet.title, sheet.part, sheet.hidden) for sheet in package.sheets] == [("S", SHEET, False)]


def test_texts_and_styles_are_counted():
    """A workbook tells how many texts and cell formats its cells may refer to, whatever its texts claim."""
    package = _opened(
        parts_of(
            **{
                STRINGS: f'<sst xmlns="{MAIN}" count="4294967295" uniqueCount="4294967295"><si><t>a</t></si></sst>',
                STYLES: styles_of(0, 14, 2),
            }
        )
    )
    assert (package.texts, package.strings, package.styles) == (1, STRINGS, 3)
    bare = _opened(parts_of(**{STRINGS: None, STYLES: None}))
    assert (bare.texts, bare.strings) == (0, "")


def test_styles_are_where_readers_look_for_them():
    """Styles in a part of another name are those of the workbook: without them dates would be read as numbers."""
    links = parts_of()[RELATIONS].replace("styles.xml", "looks.xml")
    package = _opened(parts_of(**{STYLES: None, "xl/looks.xml": styles_of(0, 14), RELATIONS: links}))
    assert package.parts[STYLES] == styles_of(0, 14).encode()
    assert (package.styles, package.is_rewritten) == (2, True)


def test_a_type_without_its_part_is_left_out():
    """A part that is listed and not there is forgotten, and the workbook is told as fixed."""
    listed = '<Override PartName="/xl/theme/theme1.xml" ContentType="x"/></Types>'
    package = _opened(_replaced(TYPES, "</Types>", listed))
    assert package.is_rewritten
    assert b"theme" not in package.parts[TYPES]
    assert not _opened(parts_of()).is_rewritten


def test_the_strict_dialect_is_read_as_the_usual_one():
    """Strict Open XML means the same under other names, and nothing of it keeps its name."""
    strict = {
        name: text.replace(MAIN, STRICT).replace(OFFICE, "http://purl.oclc.org/ooxml/officeDocument/relationships")
        for name, text in parts_of().items()
    }
    package = _opened(strict)
    assert [sheet.title for sheet in package.sheets] == ["S"]
    assert package.is_rewritten
    assert package.texts == 2
    assert not any(b"purl.oclc.org" in part for part in package.parts.values())


def test_hidden_sheets_are_told():
    """Hidden and very hidden sheets are told as hidden; their order stays."""
    links = parts_of()[RELATIONS].replace(
        "</Relationships>",
        "".join(relation(n, "worksheet", "worksheets/sheet1.xml") for n in (8, 9)) + "</Relationships>",
    )
    titles = [
        f'<sheet name="{name}" sheetId="{number}" r:id="rId{number}"{state}/>'
        for name, number, state in [("Δ &amp; b", 8, ""), ("c", 9, ' state="hidden"'), ("a", 1, ' state="veryHidden"')]
    ]
    sheets = _opened(parts_of(**{WORKBOOK: workbook_part(titles), RELATIONS: links})).sheets
    assert [(sheet.title, sheet.hidden) for sheet in sheets] == [("Δ & b", False), ("c", True), ("a", True)]


@pytest.mark.parametrize(
    ("stored", "date"),
    [
        ("2026-01-02T03:04:05Z", datetime.datetime(2026, 1, 2, 3, 4, 5)),  # noqa: DTZ001
        ("2026-01-02T03:04:05.678+02:00", datetime.datetime(2026, 1, 2, 1, 4, 5)),  # noqa: DTZ001
        ("2026-01-02T03:04:05", datetime.datetime(2026, 1, 2, 3, 4, 5)),  # noqa: DTZ001
        ("0001-01-01T00:00:00+10:00", None),
        ("yesterday", None),
        ("", None),
    ],
)
def test_the_date_of_a_workbook_is_its_own(stored, date):
    """A workbook's date of change is the one it stores, in UTC; without one, or with nonsense, it has none."""
    dates = f"<d:created>2001</d:created><d:modified>{stored}</d:modified><d:issued>2002</d:issued>"
    core = f'<a xmlns:d="http://purl.org/dc/terms/">{dates}</a>'
    assert _opened(parts_of(**{CORE: core})).modified == date
    assert _opened(parts_of()).modified is None


def test_sheets_at_their_limit():
    """A workbook may have 100 sheets, not 101."""
    for number, code in ((100, None), (101, "E110")):
        titles = (f'<sheet name="S{n}" sheetId="{n + 1}" r:id="rId1"/>' for n in range(number))
        assert _refused(parts_of(**{WORKBOOK: workbook_part(titles)})) == code


@pytest.mark.parametrize("around", ["", "\n  "])
def test_a_shared_text_at_its_limit(around):
    """A shared text may have 32,767 characters, not 32,768; blanks between texts are none of it."""
    for length, code in ((32_767, None), (32_768, "E110")):
        text = f"<si>{around}<r><t>{'x' * 7}</t></r>{around}<r><t>{'x' * (length - 7)}</t></r>{around}</si>"
        assert _refused(parts_of(**{STRINGS: f'<sst xmlns="{MAIN}">{around}{text}{around}</sst>'})) == code
