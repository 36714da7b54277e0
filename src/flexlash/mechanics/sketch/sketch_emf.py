"""A drawing as an Enhanced Metafile, the vector picture that Excel and LibreOffice show without a library.

Source: [MS-EMF], Enhanced Metafile Format: each record is its number, its size in bytes and its fields, little-endian.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator

from flexlash.mechanics.sketch.drawing_marks import LETTER, Area, Drawing, Label, Mark, Stroke, hatching

__all__ = ["emf"]

_FINE = 20
"""Steps of the metafile in a pixel."""

_PIXEL_MM = 25.4 / 96
_HEADER, _POLYGON, _POLYLINE, _WINDOW, _ORIGIN, _VIEWPORT, _EOF, _MAP, _BACKGROUND = 1, 3, 4, 9, 10, 11, 14, 17, 18
_ALIGN, _TEXT_COLOUR, _SELECT, _BRUSH, _FONT, _TEXT, _PEN = 22, 24, 37, 39, 82, 84, 95
_ANISOTROPIC, _TRANSPARENT, _BASELINE = 8, 1, 24
_ANCHORS = {"start": 0, "middle": 6, "end": 2}
_NO_PEN, _PEN_STYLE = 0x80000008, 0x00010000
"""No outline around areas; a solid pen as wide as it says, with round ends and joints."""

_FONT_DETAILS = 228
"""Bytes of a font's further names and classes, which may be blank."""


_EM, _OTHER = 2048, 1038
_WIDTHS = {
    463: " ", 470: "il", 490: "j", 511: ",", 516: "I", 517: ".·", 548: ":;", 621: "()", 625: "f", 627: "-", 653: "J",
    686: "t", 694: "°", 714: "r", 791: "/", 801: "s", 809: "z", 861: "L", 866: "c", 887: "x", 919: "ν", 925: "v",
    927: "y", 931: "k", 941: "FS", 959: "Z", 964: "g", 981: "a", 998: "TY", 1000: "E", 1019: "e", 1020: "+<=>_±×−",
    1058: "P", 1063: "X", 1064: "K", 1076: "bdhnpqu", 1080: "o", 1084: "ø", 1092: "C", 1112: "R", 1114: "B",
    1156: "Δ", 1162: "V", 1185: "A", 1260: "D", 1276: "H", 1292: "G", 1314: "U", 1322: "N", 1356: "O", 1464: "%w",
    1636: "m", 1751: "M", 1822: "W",
}  # fmt: skip
"""Letters of Calibri by their width, in parts of `_EM` of their height; others are as wide as a digit.

Source: hmtx of Carlito 1.104, whose widths are those of Calibri.
"""


def emf(drawing: Drawing) -> bytes:
    """Return a drawing as EMF; a dashed line is drawn dash by dash, since programs do not agree on such pens."""
    marks = [*_drawn(drawing)]
    tools = {tool: handle for handle, tool in enumerate(dict.fromkeys(map(_tool, marks)), start=1)}
    width, height = round(drawing.width), round(drawing.height)
    records = [
        _record(_MAP, struct.pack("<I", _ANISOTROPIC)),
        _record(_ORIGIN, struct.pack("<ii", 0, 0)),
        _record(_WINDOW, struct.pack("<ii", width * _FINE, height * _FINE)),
        _record(_VIEWPORT, struct.pack("<ii", width, height)),
        _record(_BACKGROUND, struct.pack("<I", _TRANSPARENT)),
        *(_record(kind, struct.pack("<I", handle) + fields) for (kind, fields), handle in tools.items()),
        *(record for mark in marks for record in _records(mark, tools[_tool(mark)])),
        _record(_EOF, struct.pack("<III", 0, 16, 20)),
    ]
    body = b"".join(records)
    return _header(drawing, records=1 + len(records), handles=1 + len(tools), size=len(body)) + body


def _drawn(drawing: Drawing) -> Iterator[Mark]:
    """Yield all marks in their order, those on an area behind it."""
    for mark in drawing.marks:
        yield mark
        if isinstance(mark, Area):
            yield from hatching(mark)


def _header(drawing: Drawing, *, records: int, handles: int, size: int) -> bytes:
    """Return the first record: bounds [px], frame [0.01 mm], description, counts, the device's size."""
    width, height = round(drawing.width), round(drawing.height)
    said = f"flexlash\0{drawing.title}\0\0".encode("utf-16-le")
    words = said + bytes(-len(said) % 4)
    length = 100 + len(words)
    frame = (0, 0, round(100 * width * _PIXEL_MM), round(100 * height * _PIXEL_MM))
    pixels, millimetres = (1920, 1080), (508, 286)
    fields = struct.pack(
        "<IIiiiiiiii4sIIIHHIIIiiiiIII",
        _HEADER, length, 0, 0, width - 1, height - 1, *frame, b" EMF", 0x10000, length + size, records, handles, 0,
        len(said) // 2, 100, 0, *pixels, *millimetres, 0, 0, 0,
    )  # fmt: skip
    return fields + words


def _record(kind: int, fields: bytes) -> bytes:
    return struct.pack("<II", kind, 8 + len(fields)) + fields


def _tool(mark: Mark) -> tuple[int, bytes]:
    """Return what a mark is drawn with, as the record that makes it: its number and its fields without the handle."""
    if isinstance(mark, Area):
        return _BRUSH, struct.pack("<III", 0, _colour(mark.fill), 0)
    if isinstance(mark, Stroke):
        width, colour = _fine(mark.width), _colour(mark.colour)
        return _PEN, struct.pack("<IIIIIIIIII", 0, 0, 0, 0, _PEN_STYLE, width, 0, colour, 0, 0)
    looks = struct.pack("<iiiiiBBBBBBBB", -LETTER * _FINE, 0, 0, 0, 400, 0, 0, 0, 1, 0, 0, 0, 0)
    return _FONT, looks + "Calibri".encode("utf-16-le").ljust(64, b"\0") + bytes(_FONT_DETAILS)


def _records(mark: Mark, handle: int) -> Iterator[bytes]:
    """Yield the records that draw a mark with the tool of this handle."""
    yield _record(_SELECT, struct.pack("<I", handle))
    if isinstance(mark, Area):
        yield _record(_SELECT, struct.pack("<I", _NO_PEN))
        yield _points(_POLYGON, mark.points)
    elif isinstance(mark, Stroke):
        for piece in _dashes(mark) if mark.dashed else [mark.points]:
            yield _points(_POLYLINE, piece)
    else:
        yield _record(_TEXT_COLOUR, struct.pack("<I", _colour(mark.colour)))
        yield _record(_ALIGN, struct.pack("<I", _BASELINE | _ANCHORS[mark.anchor]))
        yield _text(mark)


def _points(kind: int, points: tuple[tuple[float, float], ...]) -> bytes:
    places = [(_fine(x), _fine(y)) for x, y in points]
    bounds = (
        min(x for x, _ in places),
        min(y for _, y in places),
        max(x for x, _ in places),
        max(y for _, y in places),
    )
    fields = struct.pack("<iiiiI", *bounds, len(places))
    return _record(kind, fields + b"".join(struct.pack("<ii", *place) for place in places))


def _text(mark: Label) -> bytes:
    """Return words at a place, with the width of each letter, without which some programs show none."""
    letters = mark.words.encode("utf-16-le")
    padded = letters + bytes(-len(letters) % 4)
    number = len(letters) // 2
    start = 76
    fields = struct.pack(
        "<iiiiIffiiIIIiiiiI",
        0, 0, -1, -1, 1, 1.0, 1.0, _fine(mark.x), _fine(mark.y), number, start, 0, 0, 0, -1, -1, start + len(padded),
    )  # fmt: skip
    widths = struct.pack(f"<{number}I", *(_fine(_width(letter)) for letter in mark.words))
    return _record(_TEXT, fields + padded + widths)


def _width(letter: str) -> float:
    """Return the width of a letter [px]."""
    units = next((units for units, letters in _WIDTHS.items() if letter in letters), _OTHER)
    return LETTER * units / _EM


def _dashes(mark: Stroke) -> Iterator[tuple[tuple[float, float], ...]]:
    """Yield dashes and dots along a straight line."""
    (x1, y1), (x2, y2) = mark.points[0], mark.points[-1]
    length = ((x2 - x1) ** 2 + (y2 - y1) ** 2) ** 0.5
    place, pattern = 0.0, (12.0, 3.0, 2.0, 3.0)
    while place < length:
        for index, step in enumerate(pattern):
            end = min(place + step, length)
            if index % 2 == 0 and end > place:
                yield tuple((x1 + (x2 - x1) * at / length, y1 + (y2 - y1) * at / length) for at in (place, end))
            place = end


def _fine(value: float) -> int:
    return round(value * _FINE)


def _colour(code: str) -> int:
    """Return a colour as the metafile has it: blue, green, red."""
    red, green, blue = (int(code[place : place + 2], 16) for place in (1, 3, 5))
    return red | green << 8 | blue << 16
