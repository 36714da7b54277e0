"""A workbook's parts, and adding or removing some of them with all that announces them."""

from __future__ import annotations

import posixpath
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from flexlash.feedback.splicing.xml_spans import (
    appended,
    element_spans,
    in_order,
    in_utf_8,
    spliced,
    with_attributes,
    xml_text,
)
from flexlash.reading.archive import packed, unpacked
from flexlash.reading.package import STRICT_NAMES, open_package
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.schema.unused_names import numbered_names, unused_name

__all__ = ["Relation", "Sheet", "WorkbookParts"]

_TYPES, _ROOT_RELATIONS, _CUSTOM = "[Content_Types].xml", "_rels/.rels", "docProps/custom.xml"
_OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006"
_PACKAGE = "http://schemas.openxmlformats.org/package/2006"
_SPREADSHEET = "application/vnd.openxmlformats-officedocument.spreadsheetml"
_PLAIN, _MACROS = f"{_SPREADSHEET}.sheet", "application/vnd.ms-excel.sheet.macroEnabled"
_PROPERTY_FORMAT = "{D5CDD505-2E9C-101B-9397-08002B2CF9AE}"
_STRICT_PROPERTIES = (
    b"http://purl.oclc.org/ooxml/officeDocument/relationships/custom-properties",
    b"http://purl.oclc.org/ooxml/officeDocument/relationships/customProperties",
)
_HEAD = b'<?xml version="1.0" encoding="UTF-8" standalone="yes"?>'
_ORDER = (
    "fileVersion", "fileSharing", "workbookPr", "workbookProtection", "bookViews", "sheets", "functionGroups",
    "externalReferences", "definedNames",
)  # fmt: skip
_CONTENT_TYPES = {
    "worksheet": f"{_SPREADSHEET}.worksheet+xml",
    "styles": f"{_SPREADSHEET}.styles+xml",
    "comments": f"{_SPREADSHEET}.comments+xml",
    "vmlDrawing": "application/vnd.openxmlformats-officedocument.vmlDrawing",
    "custom-properties": "application/vnd.openxmlformats-officedocument.custom-properties+xml",
}
_SINGLE = frozenset({"styles"})
"""Kinds of which a workbook has one part: a relation to one that is not there goes when it is made."""


@dataclass(frozen=True, kw_only=True)
class Relation:
    """What one part refers to: the relation's id, the last word of its type, and the name of the other part."""

    id: str
    kind: str
    part: str


@dataclass(frozen=True, kw_only=True)
class Sheet:
    """A sheet of any kind: its title, its part, the kind of relation it has, and whether it is hidden."""

    title: str
    part: str
    kind: str
    is_hidden: bool


class WorkbookParts:
    """The parts of a workbook that is being changed; whatever is not changed stays byte for byte.

    Raises Refusal for what is no workbook.
    """

    def __init__(self, data: bytes, limits: ReadingLimits) -> None:
        self.parts = unpacked(data, limits)
        self.workbook = open_package(self.parts, limits).workbook
        self.folder = posixpath.dirname(self.workbook) or "xl"
        self._is_strict = any(strict in self.parts[self.workbook] for strict, _ in STRICT_NAMES)

    def data(self) -> bytes:
        """Return the workbook's bytes, the same for the same parts."""
        return packed(self.parts, compressed=True)

    def read(self, part: str) -> bytes:
        """Return a part in an encoding in which ASCII is ASCII."""
        return in_utf_8(self.parts[part])

    def write(self, part: str, content: bytes) -> None:
        """Put a part's new content in the place of the old one."""
        self.parts[part] = content

    def relations(self, owner: str) -> list[Relation]:
        """Return what a part refers to inside the workbook."""
        name = _relations_of(owner)
        if name not in self.parts:
            return []
        found = []
        for span in element_spans(self.read(name), ("Relationship",))[1:]:
            target, folder = span.attributes.get("Target", ""), posixpath.dirname(owner)
            if span.attributes.get("TargetMode") != "External":
                part = target.lstrip("/") if target.startswith("/") else posixpath.normpath(f"{folder}/{target}")
                kind = span.attributes.get("Type", "").rpartition("/")[2]
                found.append(Relation(id=span.attributes.get("Id", ""), kind=kind, part=part.lstrip("/")))
        return found

    def related(self, owner: str, kind: str) -> str:
        """Return the part of a kind that a part refers to, an empty text when there is none."""
        return next((one.part for one in self.relations(owner) if one.kind == kind and one.part in self.parts), "")

    def add(self, owner: str, kind: str, part: str, content: bytes) -> str:
        """Add a part that another one refers to; return the relation's id."""
        name = _relations_of(owner)
        lost = {one.id for one in self.relations(owner) if one.kind == kind and one.part not in self.parts}
        if lost and kind in _SINGLE:
            self._cut(name, "Relationship", "Id", lost)
        self.parts[part] = self.dialect(content)
        self._announce(part, _CONTENT_TYPES[kind])
        if name not in self.parts:
            self.parts[name] = _HEAD + f'<Relationships xmlns="{_PACKAGE}/relationships"></Relationships>'.encode()
            # Some programs give no type to all parts of relations, but one to each.
            self._announce(name, "application/vnd.openxmlformats-package.relationships+xml")
        known = {one.attributes.get("Id", "") for one in element_spans(self.read(name), ("Relationship",))}
        own = unused_name(known, "rIdOwn1", numbered="rIdOwn{}".format)
        target = posixpath.relpath(part, posixpath.dirname(owner) or ".")
        new = f'<@Relationship Id="{own}" Type="{_OFFICE}/relationships/{kind}" Target="{target}"/>'
        self.parts[name] = appended(self.read(name), "Relationships", self.dialect(new.encode()))
        return own

    def legacy_drawing(self, sheet: str) -> str:
        """Return the part of the drawing in which a worksheet's notes have their boxes, an empty text for none."""
        spans = [one for one in element_spans(self.read(sheet), ("legacyDrawing",)) if one.name == "legacyDrawing"]
        ids = {value for one in spans for name, value in one.attributes.items() if name.rpartition(":")[2] == "id"}
        return next((one.part for one in self.relations(sheet) if one.id in ids), "")

    def reference(self, element: str, relation: str) -> bytes:
        """Return an element that refers to a part by the id of its relation."""
        text = f'<@{element} xmlns:r="{_OFFICE}/relationships" r:id="{relation}"/>'
        return self.dialect(text.encode())

    def free_name(self, pattern: str) -> str:
        """Return the first name of this pattern that no part bears: `xl/comments{}.xml`."""
        taken = {name.casefold() for name in self.parts}
        names = numbered_names(pattern.format(1), numbered=pattern.format)
        return next(name for name in names if name.casefold() not in taken)

    def remove(self, owner: str, part: str) -> None:
        """Remove a part that another one refers to, and what it alone refers to."""
        relations = _relations_of(owner)
        if relations in self.parts:
            gone = {one.id for one in self.relations(owner) if one.part == part}
            self._cut(relations, "Relationship", "Id", gone)
        others = {one.part for name in self.parts if name != part for one in self._relations_in(name)}
        if part in others or part not in self.parts:
            return
        for one in self.relations(part):
            self.remove(part, one.part)
        self.parts.pop(part)
        self.parts.pop(_relations_of(part), None)
        self._cut(_TYPES, "Override", "PartName", {f"/{part}", f"/{_relations_of(part)}"})

    def _announce(self, part: str, content_type: str) -> None:
        """Give a part its content type."""
        self._cut(_TYPES, "Override", "PartName", {f"/{part}"})
        new = f'<@Override PartName="/{part}" ContentType="{content_type}"/>'
        self.parts[_TYPES] = appended(self.read(_TYPES), "Types", new.encode())

    def _relations_in(self, part: str) -> list[Relation]:
        return self.relations(part) if _relations_of(part) in self.parts else []

    def _cut(self, part: str, element: str, attribute: str, values: set[str]) -> None:
        """Cut the elements out of a list whose attribute has one of these values."""
        content = self.read(part)
        spans = [span for span in element_spans(content, (element,)) if span.attributes.get(attribute) in values]
        self.parts[part] = spliced(content, [(span.start, span.end, b"") for span in spans])

    @property
    def sheets(self) -> list[Sheet]:
        """Sheets in order."""
        relations = {one.id: one for one in self.relations(self.workbook)}
        found = []
        for span in element_spans(self.read(self.workbook), parents=("sheets",))[1:]:
            attributes = {name.rpartition(":")[2]: value for name, value in span.attributes.items()}
            relation = relations[attributes["id"]]
            state = attributes.get("state", "visible")
            found.append(
                Sheet(title=attributes["name"], part=relation.part, kind=relation.kind, is_hidden=state != "visible")
            )
        return found

    @property
    def worksheets(self) -> dict[str, str]:
        """The parts of sheets that hold cells, by title."""
        return {sheet.title: sheet.part for sheet in self.sheets if sheet.kind == "worksheet"}

    def free_title(self, titles: Iterable[str]) -> str:
        """Return the first of these titles that no sheet bears."""
        taken = {sheet.title.casefold() for sheet in self.sheets}
        return next(title for title in titles if title.casefold() not in taken)

    def add_sheet(self, title: str, content: bytes, *, first: bool = False, state: str = "") -> None:
        """Add a worksheet before or after all others."""
        part = self.free_name(f"{self.folder}/worksheets/sheet{{}}.xml")
        relation = self.add(self.workbook, "worksheet", part, content)
        workbook = self.read(self.workbook)
        spans = element_spans(workbook, parents=("sheets", "definedNames"))
        numbers = [int(span.attributes.get("sheetId", "0")) for span in spans if span.parent == "sheets"]
        shown = f' state="{state}"' if state else ""
        number = f' sheetId="{max(numbers, default=0) + 1}"{shown}'
        new = self.reference(f'sheet name="{xml_text(title).decode()}"{number}', relation)
        if first:
            workbook = _with_owners(workbook, lambda owner: owner + 1)
        self.parts[self.workbook] = appended(workbook, "sheets", new, first=first)

    def remove_sheet(self, title: str) -> None:
        """Remove a sheet, its names, and an order of calculation that lists its cells; programs make that anew."""
        place, sheet = next((place, sheet) for place, sheet in enumerate(self.sheets) if sheet.title == title)
        workbook = _with_owners(
            self.read(self.workbook), lambda owner: None if owner == place else owner - (owner > place)
        )
        span = element_spans(workbook, parents=("sheets",))[1 + place]
        self.parts[self.workbook] = spliced(workbook, [(span.start, span.end, b"")])
        self.remove(self.workbook, sheet.part)
        chain = self.related(self.workbook, "calcChain")
        number = span.attributes.get("sheetId")
        if chain and any(cell.attributes.get("i") == number for cell in element_spans(self.read(chain), ("c",))):
            self.remove(self.workbook, chain)

    def add_names(self, names: bytes) -> None:
        """Add defined names, given as elements."""
        workbook = self.read(self.workbook)
        if any(span.name == "definedNames" for span in element_spans(workbook, ("definedNames",))):
            self.parts[self.workbook] = appended(workbook, "definedNames", names)
        else:
            new = b"<@definedNames>%s</@definedNames>" % names
            self.parts[self.workbook] = in_order(workbook, _ORDER, "definedNames", new)

    def open_at_first(self) -> None:
        """Let the workbook open at its first sheet, and at that alone: sheets selected together are edited together."""
        self.set_attributes(self.workbook, "workbookView", activeTab=None, firstSheet=None)
        for sheet in self.sheets[1:]:
            if b"tabSelected" in self.read(sheet.part):
                self.set_attributes(sheet.part, "sheetView", tabSelected=None)

    def set_kind(self, *, macros: bool) -> None:
        """Make the file a workbook of the kind that may hold macros, or of the plain one; never a template."""
        wanted = f"{_MACROS if macros else _PLAIN}.main+xml"
        content = self.read(_TYPES)
        spans = element_spans(content, ("Override",))
        own = next((one for one in spans if one.attributes.get("PartName") == f"/{self.workbook}"), None)
        if own and own.attributes.get("ContentType") != wanted:
            tag = with_attributes(content[own.start : own.inner], ContentType=wanted)
            self.parts[_TYPES] = spliced(content, [(own.start, own.inner, tag)])

    def set_property(self, name: str, value: str) -> None:
        """Set a document property, the earlier one of this name replaced."""
        if _CUSTOM not in self.parts:
            empty = f'<Properties xmlns="{_OFFICE}/custom-properties"></Properties>'
            self.add("", "custom-properties", _CUSTOM, _HEAD + empty.encode())
        part = self.read(_CUSTOM)
        spans = element_spans(part, ("property",))[1:]
        numbers = [int(span.attributes.get("pid", "1")) for span in spans if span.attributes.get("name") != name]
        own = [(span.start, span.end, b"") for span in spans if span.attributes.get("name") == name]
        new = (
            f'<@property fmtid="{_PROPERTY_FORMAT}" pid="{max(numbers, default=1) + 1}" name="{name}">'
            f'<vt:lpwstr xmlns:vt="{_OFFICE}/docPropsVTypes">{value}</vt:lpwstr></@property>'
        )
        self.parts[_CUSTOM] = appended(spliced(part, own), "Properties", self.dialect(new.encode()))

    def set_attributes(self, part: str, element: str, **values: str | None) -> None:
        """Set attributes of all elements of a name."""
        content = self.read(part)
        tags = [(span.start, span.inner) for span in element_spans(content, (element,)) if span.name == element]
        changes = [(start, end, with_attributes(content[start:end], **values)) for start, end in tags]
        self.parts[part] = spliced(content, changes)

    def dialect(self, content: bytes) -> bytes:
        """Return XML with names of the workbook's own dialect."""
        for strict, usual in STRICT_NAMES if self._is_strict else ():
            content = content.replace(usual, strict)
        return content.replace(_STRICT_PROPERTIES[0], _STRICT_PROPERTIES[1])


def _relations_of(part: str) -> str:
    folder, name = posixpath.split(part)
    return posixpath.join(folder, "_rels", f"{name}.rels")


def _with_owners(workbook: bytes, moved: Callable[[int], int | None]) -> bytes:
    """Return the workbook's part with the sheets that names belong to renumbered; None takes a name away."""
    changes = []
    for span in element_spans(workbook, ("definedName",))[1:]:
        if owner := span.attributes.get("localSheetId"):
            now = moved(int(owner))
            tag = with_attributes(workbook[span.start : span.inner], localSheetId=str(now))
            changes.append((span.start, span.end, b"") if now is None else (span.start, span.inner, tag))
    return spliced(workbook, changes)
