"""Walking through XML: element by element, without document types, within limits."""

import pytest
from small_workbook import MAIN

from flexlash.reading.elements import Elements, Listing, Texts, local
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal

DECLARED = '<!DOCTYPE x [<!ENTITY a "b">]><x>&a;</x>'


def _refused(data, **limits):
    """Return the code by which XML is refused, or None."""
    try:
        Elements(data, ReadingLimits(**limits))
    except Refusal as refusal:
        return refusal.code
    return None


REFUSED = {
    "no XML": ("E102", b"Variant,Material"),
    "nothing": ("E102", b""),
    "no end": ("E102", b"<a><b></b>"),
    "two roots": ("E102", b"<a/><b/>"),
    "an unknown prefix": ("E102", b"<x:a/>"),
    "an unknown entity": ("E102", b"<a>&b;</a>"),
    "bytes that are no UTF-8": ("E102", b"<a>\xff</a>"),
    "an over-long form of a character": ("E102", b"<a>\xc0\xbc</a>"),
    "a control character": ("E102", b"<a>\x01</a>"),
    "a reference to a control character": ("E102", b"<a>&#1;</a>"),
    "UTF-7": ("E102", b'<?xml version="1.0" encoding="UTF-7"?><a/>'),
    "an encoding nobody knows": ("E102", b'<?xml version="1.0" encoding="nonsense"?><a/>'),
    "EBCDIC": ("E102", b'<?xml version="1.0" encoding="cp037"?>' + "<a/>".encode("cp037")),
    "UTF-32": ("E102", "<a/>".encode("utf-32")),
    "an attribute twice": ("E102", b'<a b="1" b="2"/>'),
    "a document type": ("E105", DECLARED.encode()),
    "a document type in UTF-16": ("E105", DECLARED.encode("utf-16")),
    "a document type in UTF-16 without a mark": ("E105", DECLARED.encode("utf-16-be")),
    "a document type in Latin-1": ("E105", b'<?xml version="1.0" encoding="ISO-8859-1"?>' + DECLARED.encode()),
    "a document type elsewhere": ("E105", b'<!DOCTYPE x SYSTEM "file:///etc/passwd"><x/>'),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_refused_by_its_code(what):
    """What is no XML is damage; a document type is refused by its own code, whatever letters it is written in."""
    code, data = REFUSED[what]
    assert _refused(data) == code


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
def test_unicode_is_read_in_each_of_its_forms(encoding):
    """The text of an element is the same in every form of Unicode."""
    assert Texts("<a><t>Δ µ 𝄞</t></a>".encode(encoding), ReadingLimits(), "t").texts == ["Δ µ 𝄞"]


def test_depth_at_its_limit():
    """Elements may nest 64 deep, not 65."""
    assert _refused(b"<a>" * 64 + b"</a>" * 64) is None
    assert _refused(b"<a>" * 65 + b"</a>" * 65) == "E110"
    assert _refused(b"<a>" * 100_000) == "E110"


def test_attributes_at_their_limit():
    """An element may have 256 attributes, not 257."""
    many = [f'a{number}="1"' for number in range(257)]
    assert _refused(f"<a {' '.join(many[:256])}/>".encode()) is None
    assert _refused(f"<a {' '.join(many)}/>".encode()) == "E110"


def test_siblings_do_not_add_to_the_depth():
    """Depth counts what is open, not what was."""
    assert _refused(b"<a>" + b"<b><c/></b>" * 200 + b"</a>", depth=3) is None


def test_a_listing_finds_attributes_by_local_name():
    """A listing gives the attributes of every element of a name, whatever its prefix."""
    data = f'<x:a xmlns:x="{MAIN}"><x:b n="1"/><c><b n="2" xmlns=""/></c><x:bb n="3"/></x:a>'.encode()
    assert [one["n"] for one in Listing(data, ReadingLimits(), "b").attributes] == ["1", "2"]


def test_a_listing_within_another_element():
    """A listing within an element passes over what stands outside of it."""
    data = b'<a><b n="0"/><in><b n="1"/><c><b n="2"/></c></in><b n="3"/><in><b n="4"/></in></a>'
    assert [one["n"] for one in Listing(data, ReadingLimits(), "b", "in").attributes] == ["1", "2", "4"]


def test_texts_of_children_belong_to_their_parent():
    """The text of an element includes that of its children, CDATA and references."""
    data = b"<a><t>1<b>2</b><![CDATA[<3>]]>&#52;</t>no<t/></a>"
    assert Texts(data, ReadingLimits(), "t").texts == ["12<3>4", ""]


@pytest.mark.parametrize(("name", "expected"), [("urn:x y", "y"), ("y", "y")])
def test_local_names(name, expected):
    """An element's name without its namespace."""
    assert local(name) == expected
