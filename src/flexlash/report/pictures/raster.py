"""An SVG file of ours → the same picture as PNG, drawn by matplotlib."""

from __future__ import annotations

import io
from importlib.util import find_spec
from typing import Any
from xml.etree.ElementTree import Element, fromstring

from flexlash.report.pictures.standing_alone import ROLE
from flexlash.schema.stamps import placeholder

__all__ = ["MISSING", "is_available", "png_file"]

MISSING = "Pictures are written as SVG alone: PNG needs matplotlib, pip install 'flexlash[elasticity]'."

_SHARPER = 2
"""Dots of the PNG for each pixel of the SVG."""

_POINT, _LETTERS = 0.72, 0.88
"""Size of a pixel at 100 dots per inch [pt]; matplotlib's own letters are wider than those of the SVG."""

_DOTS = 100
_NAMESPACE = "{http://www.w3.org/2000/svg}"
_ANCHORS = {"start": "left", "middle": "center", "end": "right"}


def is_available() -> bool:
    """Whether matplotlib is installed."""
    return find_spec("matplotlib") is not None


def png_file(svg: bytes) -> bytes:
    """Return an SVG file of ours as PNG, its title and description in it; the stamp follows its last chunk."""
    import matplotlib as mpl
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    root = fromstring(svg)  # noqa: S314  # made here
    left, top, width, height = map(float, root.get("viewBox", "").split())
    with mpl.rc_context(), io.BytesIO() as buffer:
        mpl.rcParams.update(mpl.rcParamsDefault)
        figure = Figure(figsize=(width / _DOTS, height / _DOTS), dpi=_DOTS * _SHARPER)
        FigureCanvasAgg(figure)
        axes = figure.add_axes((0, 0, 1, 1))
        axes.set_axis_off()
        axes.set_xlim(left, left + width)
        axes.set_ylim(top + height, top)
        for order, element in enumerate(root):
            _draw(axes, element, order)
        told = {"Title": root.findtext(f"{_NAMESPACE}title"), "Description": root.findtext(f"{_NAMESPACE}desc")}
        figure.savefig(buffer, format="png", metadata={"Software": None, **told})
        return buffer.getvalue() + placeholder(ROLE).encode()


def _draw(axes: Any, element: Element, order: int) -> None:
    """Draw an element; what is no shape is none."""
    tag = element.tag.removeprefix(_NAMESPACE)
    if tag == "rect":
        x, y, width, height = (_number(element, name) for name in ("x", "y", "width", "height"))
        _area(axes, [(x, y), (x + width, y), (x + width, y + height), (x, y + height)], element, order)
    elif tag == "polygon":
        _area(axes, _points(element), element, order)
    elif tag == "svg":
        _inner(axes, element, order)
    elif tag == "line":
        ends = [(_number(element, f"x{end}"), _number(element, f"y{end}")) for end in (1, 2)]
        _stroke(axes, ends, element, order)
    elif tag == "polyline":
        _stroke(axes, _points(element), element, order)
    elif tag == "text":
        axes.text(
            _number(element, "x"), _number(element, "y"), (element.text or "").replace("$", r"\$"),
            color=element.get("fill"), ha=_ANCHORS[element.get("text-anchor", "start")], va="baseline",
            fontsize=_number(element, "font-size") * _POINT * _LETTERS, zorder=order,
            fontweight="bold" if element.get("font-weight") else "normal",
        )  # fmt: skip


def _inner(axes: Any, element: Element, order: int) -> None:
    """Draw the areas of a picture within the picture, which is stretched to its place."""
    _, _, wide, high = map(float, element.get("viewBox", "").split())
    x, y, width, height = (_number(element, name) for name in ("x", "y", "width", "height"))
    for area in element:
        points = [(x + width * across / wide, y + height * down / high) for across, down in _points(area)]
        _area(axes, points, area, order)


def _area(axes: Any, points: list[tuple[float, float]], element: Element, order: int) -> None:
    from matplotlib.patches import Polygon

    axes.add_patch(Polygon(points, closed=True, facecolor=element.get("fill"), edgecolor="none", zorder=order))


def _stroke(axes: Any, points: list[tuple[float, float]], element: Element, order: int) -> None:
    from matplotlib.lines import Line2D

    width = float(element.get("stroke-width", "1"))
    dashes = [float(one) / width for one in element.get("stroke-dasharray", "").split()]
    across, down = zip(*points, strict=True)
    line = Line2D(across, down, color=element.get("stroke"), linewidth=width * _POINT, zorder=order)
    line.set_solid_capstyle("butt")
    line.set_dash_capstyle("butt")
    line.set_linestyle((0, dashes) if dashes else "solid")
    axes.add_line(line)


def _number(element: Element, name: str) -> float:
    return float(element.get(name, "0"))


def _points(element: Element) -> list[tuple[float, float]]:
    pairs = (pair.split(",") for pair in element.get("points", "").split())
    return [(float(x), float(y)) for x, y in pairs]
