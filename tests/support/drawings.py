"""What a workbook draws: its charts with the colours of their series, and the alternative texts of its drawings."""

from __future__ import annotations

import posixpath
import re
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

__all__ = ["Drawing", "Series", "charts_of", "drawings_of"]

_A, _C = (
    "{http://schemas.openxmlformats.org/drawingml/2006/main}",
    "{http://schemas.openxmlformats.org/drawingml/2006/chart}",
)
_X = "{http://schemas.openxmlformats.org/drawingml/2006/spreadsheetDrawing}"


@dataclass(frozen=True, kw_only=True)
class Drawing:
    """A chart, picture or shape: its sheet's part, kind, and the text that stands for it."""

    sheet: str
    kind: str
    text: str


@dataclass(frozen=True, kw_only=True)
class Series:
    """A series of a chart that is seen: colours of area, line and marks, where it has them, and their forms."""

    name: str
    colours: tuple[str, ...]
    form: tuple[str, ...]

    @property
    def main(self) -> str:
        """The colour by which it is told: of its area, else of its line, else of its marks."""
        return self.colours[0]


def drawings_of(path: Path) -> Iterator[Drawing]:
    """Yield each chart, picture and shape of a workbook, in the order of the drawings."""
    with zipfile.ZipFile(path) as archive:
        for name in sorted(archive.namelist()):
            if not re.fullmatch(r"xl/worksheets/_rels/sheet\d+\.xml\.rels", name):
                continue
            for relation in ElementTree.fromstring(archive.read(name)):  # noqa: S314
                if relation.attrib["Type"].endswith("/drawing"):
                    part = posixpath.normpath(posixpath.join("xl/worksheets", relation.attrib["Target"]))
                    yield from _drawn(posixpath.basename(name)[:-5], archive.read(part.lstrip("/")))


def _drawn(sheet: str, xml: bytes) -> Iterator[Drawing]:
    for kind in ("graphicFrame", "pic", "sp", "cxnSp", "grpSp"):
        for element in ElementTree.fromstring(xml).iter(f"{_X}{kind}"):  # noqa: S314
            about = next(element.iter(f"{_X}cNvPr")).attrib
            yield Drawing(sheet=sheet, kind=kind, text=about.get("descr", ""))


def charts_of(path: Path) -> Iterator[tuple[str, list[Series]]]:
    """Yield title and seen series of each chart of a workbook; one without axes is a sketch, and left out."""
    with zipfile.ZipFile(path) as archive:
        for name in archive.namelist():
            if name.startswith("xl/charts/chart"):
                root = ElementTree.fromstring(archive.read(name))  # noqa: S314
                axes = [one for kind in ("valAx", "catAx", "dateAx") for one in root.iter(f"{_C}{kind}")]
                if all(_is_deleted(axis) for axis in axes):
                    continue
                title = root.find(f"{_C}chart/{_C}title")
                words = "" if title is None else "".join(one.text or "" for one in title.iter(f"{_A}t"))
                yield words, [one for series in root.iter(f"{_C}ser") if (one := _series(series)).colours]


def _is_deleted(axis: ElementTree.Element) -> bool:
    deleted = axis.find(f"{_C}delete")
    return deleted is not None and deleted.attrib.get("val", "1") == "1"


def _series(element: ElementTree.Element) -> Series:
    look, marker = element.find(f"{_C}spPr"), element.find(f"{_C}marker")
    line = None if look is None else look.find(f"{_A}ln")
    marks = None if marker is None else marker.find(f"{_C}spPr")
    symbol = None if marker is None else marker.find(f"{_C}symbol")
    dash = None if line is None else line.find(f"{_A}prstDash")
    edge = None if marks is None else marks.find(f"{_A}ln")
    found = [_colour(one) for one in (look, line, marks, edge)]
    forms = ["" if one is None else one.attrib["val"] for one in (dash, symbol)]
    name = element.find(f".//{_C}tx//{_C}v")
    return Series(
        name="" if name is None else name.text or "", colours=tuple(one for one in found if one), form=tuple(forms)
    )


def _colour(look: ElementTree.Element | None) -> str:
    colour = None if look is None else look.find(f"{_A}solidFill/{_A}srgbClr")
    return "" if colour is None else f"#{colour.attrib['val']}"
