"""What openpyxl writes in another order than the schema of workbooks, put in order."""

from __future__ import annotations

import re

__all__ = ["fonts_in_order"]

_FONT = re.compile(rb"<font>(?:<[^<>]*/>)*</font>")
_CHILD = re.compile(rb"<(\w+)[^<>]*/>")
_ORDER = (
    b"b", b"i", b"strike", b"condense", b"extend", b"outline", b"shadow", b"u", b"vertAlign", b"sz", b"color", b"name",
    b"family", b"charset", b"scheme",
)  # fmt: skip


def fonts_in_order(styles: bytes) -> bytes:
    """Return a part of styles with each font's properties in the schema's order.

    >>> fonts_in_order(b'<font><name val="Arial" /><b val="1" /><sz val="9" /></font>')
    b'<font><b val="1" /><sz val="9" /><name val="Arial" /></font>'
    """
    return _FONT.sub(_in_order, styles)


def _in_order(font: re.Match[bytes]) -> bytes:
    """Return one font with its properties in order."""
    children = sorted(_CHILD.finditer(font[0]), key=lambda child: _ORDER.index(child[1]))
    return b"<font>" + b"".join(child[0] for child in children) + b"</font>"
