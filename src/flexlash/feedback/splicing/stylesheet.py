"""A workbook's stylesheet: cell formats looked up, and new ones added behind those that are there."""

from __future__ import annotations

from flexlash.feedback.splicing.xml_spans import (
    appended,
    element_spans,
    end_of_tag,
    in_order,
    prefixed,
    spliced,
    with_attributes,
)
from flexlash.reading.elements import MAIN

__all__ = ["Stylesheet", "empty_stylesheet"]

_ORDER = (
    "numFmts", "fonts", "fills", "borders", "cellStyleXfs", "cellXfs", "cellStyles", "dxfs",
)  # fmt: skip
_FIRST: dict[str, tuple[bytes, ...]] = {
    "fonts": (b'<@font><@sz val="11"/><@name val="Calibri"/></@font>',),
    "fills": (
        b'<@fill><@patternFill patternType="none"/></@fill>',
        b'<@fill><@patternFill patternType="gray125"/></@fill>',
    ),
    "borders": (b"<@border><@left/><@right/><@top/><@bottom/><@diagonal/></@border>",),
    "cellXfs": (b'<@xf numFmtId="0" fontId="0" fillId="0" borderId="0"/>',),
    "dxfs": (),
}
"""What each list begins with, where a stylesheet lacks it."""


def empty_stylesheet(formats: int) -> bytes:
    """Return a stylesheet of so many plain cell formats."""
    lists = {**_FIRST, "cellXfs": _FIRST["cellXfs"] * formats}
    text = b"".join(b"<%s>%s</%s>" % (name.encode(), b"".join(lists[name]), name.encode()) for name in lists)
    head = b'<?xml version="1.0" encoding="UTF-8" standalone="yes"?><styleSheet xmlns="%s">' % MAIN.encode()
    return head + prefixed(text, "") + b"</styleSheet>"


class Stylesheet:
    """The lists of a stylesheet, by name; what is added stands behind what is there, and nothing is added twice."""

    def __init__(self, part: bytes) -> None:
        self._part = part
        root, *spans = element_spans(part, _FIRST, parents=_FIRST)
        self._prefix = root.prefix
        self._there = {span.name for span in spans if span.name in _FIRST}
        self._entries = {
            name: [part[one.start : one.end] for one in spans if one.parent == name]
            if name in self._there
            else [prefixed(entry, root.prefix) for entry in first]
            for name, first in _FIRST.items()
        }
        self._counts = {name: len(entries) for name, entries in self._entries.items()}
        self._indices = {
            name: {entry: index for index, entry in reversed(list(enumerate(entries)))}
            for name, entries in self._entries.items()
        }

    def add(self, name: str, entry: bytes) -> int:
        """Return the index of an entry of a list, which is added where it is not there yet; `@` is the prefix."""
        return self._add(name, prefixed(entry, self._prefix))

    def _add(self, name: str, entry: bytes) -> int:
        entries, indices = self._entries[name], self._indices[name]
        if entry not in indices:
            indices[entry] = len(entries)
            entries.append(entry)
        return indices[entry]

    def fills_of(self, *colours: str) -> set[int]:
        """Return the indices of solid fills of these colours."""
        found = set()
        for index, fill in enumerate(self._entries["fills"]):
            spans = element_spans(fill, ("patternFill", "fgColor"))
            attributes = {span.name: span.attributes for span in spans}
            is_solid = attributes.get("patternFill", {}).get("patternType") == "solid"
            if is_solid and attributes.get("fgColor", {}).get("rgb") in colours:
                found.add(index)
        return found

    def fill(self, style: str) -> int:
        """Return the index of a cell format's fill."""
        entry = self._format(style)
        return int(element_spans(entry)[0].attributes.get("fillId", "0"))

    def styles_with(self, fills: set[int]) -> set[str]:
        """Return the cell formats that have one of these fills."""
        return {str(index) for index in range(len(self._entries["cellXfs"])) if self.fill(str(index)) in fills}

    def with_fill(self, style: str, fill: int, like: str | None = None) -> str:
        """Return the cell format that is this one with another fill, and rather `like`, where that is the same one."""
        entry = self._format(style)
        end = end_of_tag(entry, 0)
        wanted = with_attributes(entry[:end], fillId=str(fill), applyFill="1") + entry[end:]
        if like is not None and _but_use(self._format(like)) == _but_use(wanted):
            return like
        return str(self._add("cellXfs", wanted))

    def _format(self, style: str) -> bytes:
        return self._entries["cellXfs"][int(style or 0)]

    def part(self) -> bytes:
        """Return the stylesheet with what was added."""
        part = self._part
        for name, entries in self._entries.items():
            added = entries[self._counts[name] :]
            if added and name in self._there:
                part = appended(part, name, b"".join(added))
                span = next(span for span in element_spans(part, (name,)) if span.name == name)
                tag = with_attributes(part[span.start : span.inner], count=str(len(entries)))
                part = spliced(part, [(span.start, span.inner, tag)])
            elif added:
                new = b"<@%s>%s</@%s>" % (name.encode(), b"".join(entries), name.encode())
                part = in_order(part, _ORDER, name, new)
        return part


def _but_use(entry: bytes) -> tuple[dict[str, str], bytes]:
    """Return what a cell format says, but for whether its fill is used."""
    (span,) = element_spans(entry)
    return {"fillId": "0", **span.attributes, "applyFill": ""}, span.contents(entry)
