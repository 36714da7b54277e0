"""What openpyxl writes against the schema of workbooks, put right: Excel repairs or refuses what does not follow it."""

from __future__ import annotations

import re

__all__ = ["put_right"]

_FONT = re.compile(rb"<font>(?:<[^<>]*/>)*</font>")
_CHILD = re.compile(rb"<(\w+)[^<>]*/>")
_ORDER = (
    b"b", b"i", b"strike", b"condense", b"extend", b"outline", b"shadow", b"u", b"vertAlign", b"sz", b"color", b"name",
    b"family", b"charset", b"scheme",
)  # fmt: skip
_PARENT = re.compile(rb'(?<= xfId=")\d+')
_PARENTS = re.compile(rb"<cellStyleXfs.*?</cellStyleXfs>", re.DOTALL)


def put_right(name: str, part: bytes) -> bytes:
    """Return a part as the schema wants it.

    >>> put_right("xl/styles.xml", b'<font><name val="Arial" /><b val="1" /><sz val="9" /></font>')
    b'<font><b val="1" /><sz val="9" /><name val="Arial" /></font>'
    """
    if name == "xl/styles.xml":
        return _known_parents(_FONT.sub(_in_order, part))
    if name.startswith("xl/charts/"):
        # A paragraph without text gets an empty run by openpyxl, which reads that as the word None.
        return part.replace(b"<a:r><a:t /></a:r>", b"").replace(b"<a:uFill />", b"")
    if name.startswith("xl/drawings/"):
        return part.replace(b"<avLst />", b"<a:avLst />")
    if name.startswith("xl/pivotTables/") and name.endswith(".xml"):
        return re.sub(rb' r:id="\w+"', b"", part, count=1)
    return part


def _in_order(font: re.Match[bytes]) -> bytes:
    """Return a font with its properties in the schema's order."""
    children = sorted(_CHILD.finditer(font[0]), key=lambda child: _ORDER.index(child[1]))
    return b"<font>" + b"".join(child[0] for child in children) + b"</font>"


def _known_parents(styles: bytes) -> bytes:
    """Return styles in which cell formats that are based on a missing one are based on the first."""
    parents = _PARENTS.search(styles)
    count = parents[0].count(b"<xf ") if parents else 0
    return _PARENT.sub(lambda parent: parent[0] if int(parent[0]) < count else b"0", styles) if count else styles
