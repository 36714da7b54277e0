"""Where elements stand in an XML part, and replacing or adding a few of them without writing the rest anew."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from xml.parsers import expat
from xml.sax.saxutils import escape

__all__ = [
    "ElementSpan",
    "appended",
    "element_spans",
    "end_of_tag",
    "in_order",
    "in_utf_8",
    "prefixed",
    "spliced",
    "with_attributes",
    "xml_text",
]

_NOT_ALLOWED = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_TAG = re.compile(rb"""<[^"'>]*(?:(?:"[^"]*"|'[^']*')[^"'>]*)*>""")
_DECLARATION = re.compile(r"^\ufeff?<\?xml[^>]*\?>")


@dataclass(frozen=True, kw_only=True)
class ElementSpan:
    """Where an element stands: from its tag at `start` to `inner`, its contents to `close`, its end tag to `end`.

    `parent` is the local name of the element that holds it, `text` all character data inside.
    """

    name: str
    prefix: str
    attributes: Mapping[str, str]
    start: int
    inner: int
    close: int
    end: int
    parent: str
    text: str = ""

    def contents(self, part: bytes) -> bytes:
        """Return the bytes between its tags."""
        return part[self.inner : self.close]

    def holds(self, other: ElementSpan) -> bool:
        """Whether the other element stands inside this one."""
        return self.inner <= other.start and other.end <= self.close


def element_spans(part: bytes, names: Iterable[str] = (), *, parents: Iterable[str] = ()) -> list[ElementSpan]:
    """Return the elements with one of these local names or parents, and the root, in the order of their beginnings.

    Raises expat.ExpatError for what is no XML.
    """
    return _Walk(part, frozenset(names), frozenset(parents)).found


class _Walk:
    """Notes where wanted elements begin and end."""

    def __init__(self, part: bytes, names: frozenset[str], parents: frozenset[str]) -> None:
        self.part = part
        self.names = names
        self.parents = parents
        self.open: list[str] = []
        self.begun: list[tuple[int, dict[str, str], int, int]] = []
        self.pieces: list[str] = []
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._open
        self.parser.EndElementHandler = self._close
        self.parser.buffer_text = True
        self.spans: list[ElementSpan] = []
        self.parser.Parse(part, True)
        self.found = sorted(self.spans, key=lambda span: span.start)

    def _wanted(self, name: str, parent: str) -> bool:
        return not parent or name in self.names or parent in self.parents

    def _open(self, name: str, attributes: dict[str, str]) -> None:
        local = name.rpartition(":")[2]
        if self._wanted(local, self.open[-1] if self.open else ""):
            self.begun.append((self.parser.CurrentByteIndex, attributes, len(self.pieces), len(self.open)))
            if len(self.begun) > 1:
                self.parser.CharacterDataHandler = self.pieces.append
        self.open.append(local)

    def _close(self, name: str) -> None:
        local = self.open.pop()
        if not self.begun or self.begun[-1][-1] != len(self.open):
            return
        start, attributes, text, _ = self.begun.pop()
        inner = end_of_tag(self.part, start)
        is_empty = self.part.endswith(b"/>", start, inner)
        close = inner if is_empty else self.parser.CurrentByteIndex
        self.spans.append(
            ElementSpan(
                name=local,
                prefix=name.removesuffix(local),
                attributes=attributes,
                start=start,
                inner=inner,
                close=close,
                end=inner if is_empty else self.part.index(b">", close) + 1,
                parent=self.open[-1] if self.open else "",
                text="".join(self.pieces[text:]) if self.open else "",
            )
        )
        if len(self.begun) <= 1:
            self.parser.CharacterDataHandler = None
            self.pieces.clear()


def end_of_tag(part: bytes, start: int) -> int:
    """Return where the tag that begins at `start` ends."""
    tag = _TAG.match(part, start)
    if tag is None:
        raise ValueError("no tag")
    return tag.end()


def in_utf_8(part: bytes) -> bytes:
    """Return a part whose ASCII is ASCII: one in UTF-16 in UTF-8, any other as it is."""
    if b"\0" not in part[:4]:
        return part
    encoding = "utf-16" if part[:2] in {b"\xff\xfe", b"\xfe\xff"} else "utf-16-le" if part[1] == 0 else "utf-16-be"
    return _DECLARATION.sub('<?xml version="1.0" encoding="UTF-8"?>', part.decode(encoding)).encode()


def spliced(part: bytes, changes: Iterable[tuple[int, int, bytes]]) -> bytes:
    """Return a part with stretches from … to … replaced; they must not overlap, and several may be put in one place."""
    pieces = []
    end = 0
    for start, stop, new in sorted(changes, key=lambda change: change[:2]):
        pieces += [part[end:start], new]
        end = stop
    return b"".join([*pieces, part[end:]])


def prefixed(new: bytes, prefix: str) -> bytes:
    """Return XML whose elements are written `<@name>` with a prefix in the place of each `@`."""
    return new.replace(b"<@", b"<" + prefix.encode()).replace(b"</@", b"</" + prefix.encode())


def appended(part: bytes, element: str, new: bytes, *, first: bool = False) -> bytes:
    """Return a part with XML put at the end, or beginning, of an element's contents; `@` is its prefix.

    Raises ValueError when the part has no such element.
    """
    span = next((span for span in element_spans(part, (element,)) if span.name == element), None)
    if span is None:
        raise ValueError(f"no {element}")
    new = prefixed(new, span.prefix)
    if span.close == span.end:
        tag = part[span.start : span.inner].removesuffix(b"/>").rstrip()
        name = f"{span.prefix}{element}".encode()
        return spliced(part, [(span.start, span.end, b"%s>%s</%s>" % (tag, new, name))])
    place = span.inner if first else span.close
    return spliced(part, [(place, place, new)])


def in_order(part: bytes, order: Sequence[str], element: str, new: bytes) -> bytes:
    """Return a part with a new child of its root, put where the schema's order of children wants this element."""
    root, *children = element_spans(part, parents=(element_spans(part)[0].name,))
    before = set(order[: order.index(element) + 1])
    place = max((child.end for child in children if child.name in before and child.parent == root.name), default=0)
    if not place:
        return appended(part, root.name, new, first=True)
    return spliced(part, [(place, place, prefixed(new, root.prefix))])


def with_attributes(tag: bytes, **values: str | None) -> bytes:
    """Return a tag with attributes set, or taken away where the value is None.

    >>> with_attributes(b'<c r="A1" s="3"/>', s="12", t=None)
    b'<c r="A1" s="12"/>'
    """
    for name, value in values.items():
        attribute = b"" if value is None else b' %s="%s"' % (name.encode(), xml_text(value))
        found = re.search(rb"""\s+%s\s*=\s*(?:"[^"]*"|'[^']*')""" % name.encode(), tag)
        if found:
            tag = tag[: found.start()] + attribute + tag[found.end() :]
        elif attribute:
            end = len(tag) - (2 if tag.endswith(b"/>") else 1)
            tag = tag[:end].rstrip() + attribute + tag[end:]
    return tag


def xml_text(text: str) -> bytes:
    """Return a text as XML in any encoding; characters that XML does not allow are left out."""
    return escape(_NOT_ALLOWED.sub("", text), {'"': "&quot;", "\r": "&#13;"}).encode("ascii", "xmlcharrefreplace")
