"""A drawing as SVG: attributes alone, so that a policy without inline style shows it."""

from __future__ import annotations

from xml.sax.saxutils import escape, quoteattr

from flexlash.mechanics.sketch.drawing_marks import LETTER, Area, Drawing, Mark, Point, Stroke, hatching

__all__ = ["svg"]

_LETTERS = {
    "font-size": str(LETTER), "font-family": "Carlito, Calibri, Arial, sans-serif", "stroke": "#ffffff",
    "stroke-width": "3", "stroke-linejoin": "round", "paint-order": "stroke",
}  # fmt: skip
"""Letters have a white edge, so that they can be read on lines."""


def svg(drawing: Drawing, name: str = "sketch") -> str:
    """Return a drawing as one SVG element of its size; `name` makes its IDs, by which its words stand for it."""
    width, height = _short(drawing.width), _short(drawing.height)
    root = {
        "xmlns": "http://www.w3.org/2000/svg", "role": "img", "class": "picture sketch", "width": width,
        "height": height, "viewBox": f"0 0 {width} {height}", "aria-labelledby": f"{name}-title {name}-words",
    }  # fmt: skip
    words = [_element("title", {"id": f"{name}-title"}, drawing.title)]
    words.append(_element("desc", {"id": f"{name}-words"}, drawing.description))
    return f"<svg{_attributes(root)}>{''.join([*words, *map(_marked, drawing.marks)])}</svg>"


def _marked(mark: Mark) -> str:
    if isinstance(mark, Area):
        area = _element("polygon", {"points": _path(mark.points), "fill": mark.fill})
        return "".join([area, *map(_marked, hatching(mark))])
    if isinstance(mark, Stroke):
        looks = {"fill": "none", "stroke": mark.colour, "stroke-width": _short(mark.width), "stroke-linejoin": "round"}
        dashes = {"stroke-dasharray": "12 3 2 3"} if mark.dashed else {}
        return _element("polyline", {"points": _path(mark.points), **looks, **dashes})
    place = {"x": _short(mark.x), "y": _short(mark.y), "text-anchor": mark.anchor, "fill": mark.colour}
    return _element("text", place | _LETTERS, mark.words)


def _element(name: str, attributes: dict[str, str], words: str = "") -> str:
    return f"<{name}{_attributes(attributes)}>{escape(words)}</{name}>"


def _attributes(attributes: dict[str, str]) -> str:
    return "".join(f" {name}={quoteattr(value)}" for name, value in attributes.items())


def _path(points: tuple[Point, ...]) -> str:
    return " ".join(f"{_short(x)},{_short(y)}" for x, y in points)


def _short(value: float) -> str:
    return f"{value:.2f}".rstrip("0").rstrip(".")
