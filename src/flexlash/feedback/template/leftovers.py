"""A workbook's bytes → what it holds beside the values of cells: formulas, notes, charts, which no table carries."""

from __future__ import annotations

import posixpath
import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from flexlash.reading.archive import unpacked
from flexlash.reading.elements import MAIN, Elements, Listing
from flexlash.reading.package import Package, SheetPart, open_package
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.schema.cell_addresses import CellAddress, cell_address

__all__ = ["Leftovers", "leftovers_of"]

_OBJECTS = (
    ("chart", r"charts/chart\d*\.xml"),
    ("picture", r"media/[^/]+"),
    ("pivot table", r"pivotTables/[^/]+\.xml"),
    ("discussion", r"threadedComments/[^/]+\.xml"),
    ("form control", r"ctrlProps/[^/]+\.xml"),
    ("link to another workbook", r"externalLinks/[^/]+\.xml"),
    ("set of macros", r"vbaProject\.bin"),
)
"""What parts of a workbook hold, with a pattern of their names."""

_DRAWING = re.compile(r"(?:.*/)?drawings/drawing\d*\.xml")
_SHAPES = ("sp", "cxnSp")


@dataclass(frozen=True, kw_only=True)
class Leftovers:
    """The texts of formulas by their cells, and the cells with notes, each by sheet; other objects counted by name."""

    formulas: Mapping[str, Mapping[CellAddress, str]] = field(default_factory=dict)
    notes: Mapping[str, Sequence[CellAddress]] = field(default_factory=dict)
    objects: Mapping[str, int] = field(default_factory=dict)


def leftovers_of(data: bytes, limits: ReadingLimits, apart: Collection[str] = ()) -> Leftovers:
    """Return what a workbook holds beside values; raise Refusal when it exceeds a limit.

    Objects on the sheets named in `apart` are not counted.
    """
    package = open_package(unpacked(data, limits), limits)
    objects: Counter[str] = Counter()
    ours = {part for sheet in package.sheets if sheet.title in apart for part in _objects_on(package, sheet, limits)}
    for part, content in package.parts.items():
        if part in ours:
            continue
        objects.update(name for name, pattern in _OBJECTS if re.fullmatch(rf"(?:.*/)?{pattern}", part))
        if _DRAWING.fullmatch(part):
            objects["text box or shape"] += sum(len(Listing(content, limits, shape).attributes) for shape in _SHAPES)
    return Leftovers(
        formulas={sheet.title: _Formulas(package.parts[sheet.part], limits).formulas for sheet in package.sheets},
        notes={sheet.title: _notes(package, sheet, limits) for sheet in package.sheets},
        objects={name: count for name, count in sorted(objects.items()) if count},
    )


class _Formulas(Elements):
    """Collects the formulas of a worksheet; those that share another's text have an empty one."""

    def __init__(self, data: bytes, limits: ReadingLimits) -> None:
        self.row = self.column = 0
        self.open = False
        self.formulas: dict[CellAddress, str] = {}
        super().__init__(data, limits)

    def start(self, name: str, attributes: dict[str, str]) -> None:
        """Follow rows and cells, whether they name their address or not."""
        if name == f"{MAIN} row":
            self.row, self.column = int(attributes.get("r", self.row + 1)), 0
        elif name == f"{MAIN} c":
            self.column = _address(attributes["r"]).column if "r" in attributes else self.column + 1
        elif name == f"{MAIN} f":
            self.open = True
            self.formulas[CellAddress(self.row, self.column)] = ""

    def end(self, name: str) -> None:
        """Leave a formula."""
        self.open = self.open and name != f"{MAIN} f"

    def text(self, text: str) -> None:
        """Collect a formula's text."""
        if self.open:
            self.formulas[CellAddress(self.row, self.column)] += text


def _objects_on(package: Package, sheet: SheetPart, limits: ReadingLimits) -> Iterator[str]:
    """Yield the drawings of a sheet and what these hold."""
    for drawing in _related(package, sheet.part, "/drawing", limits):
        yield drawing
        yield from _related(package, drawing, "", limits)


def _related(package: Package, part: str, kind: str, limits: ReadingLimits) -> Iterator[str]:
    """Yield the parts that a part refers to by relations whose type ends so."""
    folder, name = posixpath.split(part)
    relations = package.parts.get(f"{folder}/_rels/{name}.rels", b"")
    for relation in Listing(relations, limits, "Relationship").attributes if relations else ():
        target = relation.get("Target", "")
        found = target.lstrip("/") if target.startswith("/") else posixpath.normpath(posixpath.join(folder, target))
        if relation.get("Type", "").endswith(kind) and found in package.parts:
            yield found


def _notes(package: Package, sheet: SheetPart, limits: ReadingLimits) -> list[CellAddress]:
    """Return the cells of a sheet that have a note."""
    return sorted(
        _address(note.get("ref", ""))
        for part in _related(package, sheet.part, "/comments", limits)
        for note in Listing(package.parts[part], limits, "comment").attributes
    )


def _address(reference: str) -> CellAddress:
    """Return row and column of an address; what is none counts as row and column 0."""
    return cell_address(reference) or CellAddress(0, 0)
