"""Changing a few places of an XML part and leaving every other byte as it is.

A workbook holds much that no library carries over; what is not parsed and written anew cannot be lost.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from xml.parsers import expat
from xml.sax.saxutils import escape

from flexlash.schema.cell_addresses import CellAddress, cell_address

__all__ = ["CellSpan", "before_end", "cell_spans", "cell_xml", "spliced", "xml_text"]

_NOT_ALLOWED = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


@dataclass(frozen=True, kw_only=True)
class CellSpan:
    """Where a cell stands in its part, the prefix of its element's name, its style, and whether it is a formula."""

    start: int
    end: int
    prefix: str
    style: str
    is_formula: bool


def cell_spans(part: bytes, wanted: frozenset[str]) -> dict[str, CellSpan]:
    """Return the spans of the wanted cells of a worksheet by address; cells that it does not hold are absent."""
    return _Cells(part, wanted).found


class _Cells:
    """Finds cells by address, as written or as counted."""

    def __init__(self, part: bytes, wanted: frozenset[str]) -> None:
        self.part = part
        self.wanted = wanted
        self.found: dict[str, CellSpan] = {}
        self.row = self.column = 0
        self.address = self.prefix = self.style = ""
        self.begin = -1
        self.is_formula = False
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._open
        self.parser.EndElementHandler = self._close
        self.parser.Parse(part, True)

    def _open(self, name: str, attributes: dict[str, str]) -> None:
        prefix, _, local = name.rpartition(":")
        if local == "row":
            self.row = int(attributes.get("r", self.row + 1))
            self.column = 0
        elif local == "c":
            self.column += 1
            self.address = attributes.get("r", "").upper()
            if address := cell_address(self.address):
                self.column = address.column
            else:
                self.address = str(CellAddress(row=self.row, column=self.column))
            if self.address in self.wanted:
                self.begin = self.parser.CurrentByteIndex
                self.prefix = f"{prefix}:" if prefix else ""
                self.style = attributes.get("s", "")
                self.is_formula = False
        elif local == "f":
            self.is_formula = True

    def _close(self, name: str) -> None:
        if self.begin >= 0 and name.rpartition(":")[2] == "c":
            place = self.parser.CurrentByteIndex
            # At an element without contents the parser stands behind it already.
            ended = re.compile(rb"</%s\s*>" % name.encode()).match(self.part, place)
            self.found[self.address] = CellSpan(
                start=self.begin,
                end=ended.end() if ended else place,
                prefix=self.prefix,
                style=self.style,
                is_formula=self.is_formula,
            )
            self.begin = -1


def spliced(part: bytes, changes: Mapping[tuple[int, int], bytes]) -> bytes:
    """Return a part with some of its spans replaced; the spans must not overlap."""
    pieces = []
    end = 0
    for (start, stop), new in sorted(changes.items()):
        pieces += [part[end:start], new]
        end = stop
    return b"".join([*pieces, part[end:]])


def before_end(part: bytes, element: str, new: bytes) -> bytes:
    """Return a part with something put before the end of an element's last occurrence; `@` is its prefix.

    Raises ValueError when the part has no such element with contents.
    """
    ends = list(re.finditer(rb"</((?:[\w.-]+:)?)%s\s*>" % element.encode(), part))
    if not ends:
        raise ValueError(f"no {element} with contents")
    place = ends[-1].start()
    return part[:place] + new.replace(b"@", ends[-1][1]) + part[place:]


def xml_text(text: str) -> bytes:
    """Return a text as XML in any encoding; characters that XML does not allow are left out."""
    return escape(_NOT_ALLOWED.sub("", text), {'"': "&quot;"}).encode("ascii", "xmlcharrefreplace")


def cell_xml(address: str, value: str | float, prefix: str = "", style: str = "") -> bytes:
    """Return a cell as XML: a number as such, a text inside the cell."""
    tag = prefix.encode()
    attributes = b' r="%s"' % address.encode() + (b' s="%s"' % style.encode() if style else b"")
    if isinstance(value, str):
        text = b'<%sis><%st xml:space="preserve">%s</%st></%sis>' % (tag, tag, xml_text(value), tag, tag)
        return b'<%sc%s t="inlineStr">%s</%sc>' % (tag, attributes, text, tag)
    return b"<%sc%s><%sv>%s</%sv></%sc>" % (tag, attributes, tag, repr(value).encode(), tag, tag)
