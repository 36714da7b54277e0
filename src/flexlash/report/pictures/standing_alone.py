"""An inline picture → an SVG file of its own: with a width, a heading, a margin, and its stamp.

Programs for slides and documents show less of SVG than browsers do: lengths are in pixels, and letters have no edge,
which some would paint over them.
"""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement, fromstring, tostring

from flexlash.report.pictures.drawing import INK
from flexlash.schema.findings import readable, shown
from flexlash.schema.stamps import placeholder

__all__ = ["ACROSS", "ROLE", "svg_file"]

ROLE = "picture"
"""What the stamp of a picture says that it is."""

ACROSS = 640.0
"""Width of a picture that is as wide as its place [px]."""

_NAMESPACE = "{http://www.w3.org/2000/svg}"
_FONTS = "Carlito, Calibri, Arial, sans-serif"
_MARGIN, _HEADING, _LETTER, _LONGEST = 16.0, 40.0, 16, 72
_EDGE = ("stroke", "stroke-width", "stroke-linejoin", "paint-order")


def svg_file(inline: str, heading: str) -> bytes:
    """Return the file of a picture that is inline SVG of ours, under a heading that is also its title."""
    root = fromstring(inline)  # noqa: S314  # made here
    across = ACROSS if root.get("width") == "100%" else float(root.get("width", "0"))
    height = float(root.get("height", "0"))
    for element in root.iter():
        element.tag = element.tag.removeprefix(_NAMESPACE)
        if element is not root:
            _in_pixels(element, across)
        if element.tag == "text":
            _without_edge(element)
    title = root.find("title")
    if title is not None:
        title.text = readable(heading)
    whole, high = across + 2 * _MARGIN, height + _HEADING + _MARGIN
    words = root.attrib["aria-labelledby"]
    root.attrib.clear()
    root.attrib.update({
        "xmlns": _NAMESPACE[1:-1], "role": "img", "aria-labelledby": words, "width": f"{whole:g}",
        "height": f"{high:g}", "viewBox": f"{-_MARGIN:g} {-_HEADING:g} {whole:g} {high:g}", "font-family": _FONTS,
    })  # fmt: skip
    place = {"x": f"{-_MARGIN:g}", "y": f"{-_HEADING:g}", "width": f"{whole:g}", "height": f"{high:g}"}
    root.insert(2, Element("rect", {**place, "fill": "#ffffff"}))
    looks = {"x": "0", "y": f"{24 - _HEADING:g}", "fill": INK, "font-size": str(_LETTER), "font-weight": "600"}
    told = Element("text", looks)
    told.text = shown(heading, longest=_LONGEST)
    root.insert(3, told)
    SubElement(root, "metadata").text = placeholder(ROLE)
    text: str = tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'.encode()


def _in_pixels(element: Element, across: float) -> None:
    """Turn per cent of the width into pixels."""
    for name in ("x", "x1", "x2", "width"):
        value = element.get(name, "")
        if value.endswith("%"):
            element.set(name, f"{float(value[:-1]) * across / 100:.2f}".rstrip("0").rstrip("."))


def _without_edge(element: Element) -> None:
    for name in (*_EDGE, "font-family"):
        element.attrib.pop(name, None)
