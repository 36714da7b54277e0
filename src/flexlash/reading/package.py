"""The parts of a workbook → how they belong together: its sheets, the part that holds each, its date of change."""

from __future__ import annotations

import datetime
import posixpath
import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from flexlash.reading.elements import MAIN, Elements, Listing, Texts, local
from flexlash.reading.other_kinds import other_archive
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal

__all__ = ["STRICT_NAMES", "Package", "SheetPart", "open_package"]

_CORE = "docProps/core.xml"
_STYLES = "xl/styles.xml"
_TYPES = "[Content_Types].xml"
_ROOT = "_rels/.rels"
_OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
_STRICT = b"http://purl.oclc.org/ooxml/"
STRICT_NAMES = (
    (b"http://purl.oclc.org/ooxml/spreadsheetml/main", MAIN.encode()),
    (b"http://purl.oclc.org/ooxml/officeDocument/relationships", _OFFICE.encode()),
    (
        b"http://purl.oclc.org/ooxml/officeDocument/customProperties",
        b"http://schemas.openxmlformats.org/officeDocument/2006/custom-properties",
    ),
    (
        b"http://purl.oclc.org/ooxml/officeDocument/docPropsVTypes",
        b"http://schemas.openxmlformats.org/officeDocument/2006/docPropsVTypes",
    ),
)
"""Names of the Strict dialect whose meaning is that of the usual one."""

_SHEET_KINDS = ("/worksheet", "/chartsheet", "/dialogsheet", "/xlMacrosheet", "/xlIntlMacrosheet")
"""What a sheet can be; only the first holds cells, and one that is none of them would be left out without a word."""


@dataclass(frozen=True, kw_only=True)
class SheetPart:
    """A worksheet: its title, the part that holds it, and whether it is hidden."""

    title: str
    part: str
    hidden: bool = False


@dataclass(frozen=True, kw_only=True)
class Package:
    """A workbook's parts in the usual dialect.

    `styles` is how many cell formats it has, `strings` the part that holds the `texts` its cells share.
    `is_rewritten` says that parts are not as the file has them, but in the usual dialect.
    """

    parts: dict[str, bytes]
    workbook: str
    sheets: list[SheetPart] = field(default_factory=list)
    styles: int = 1
    strings: str = ""
    texts: int = 0
    modified: datetime.datetime | None = None
    is_rewritten: bool = False


def open_package(parts: Mapping[str, bytes], limits: ReadingLimits) -> Package:
    """Return how the parts belong together; raise Refusal when they are no workbook of this format."""
    for name, part in parts.items():
        if name.lower().endswith((".xml", ".rels")) and b"<!DOCTYPE" in part:
            raise Refusal("E105")
    if refusal := other_archive(parts.keys(), parts.get("mimetype", b"")):
        raise refusal
    usual = _usual_dialect(_without_dangling_types(parts, limits))
    workbook = _workbook_part(usual, limits)
    relations = _relations(usual, workbook, limits)
    _check_type(usual, workbook, limits)
    sheets = _sheets(usual, workbook, relations, limits)
    styles = _related(relations, "styles") or _STYLES
    strings = _related(relations, "sharedStrings")
    if styles in usual:
        # This is where readers look for it, whatever its name is.
        usual = {**usual, _STYLES: usual[styles]}
    return Package(
        parts=usual,
        workbook=workbook,
        sheets=sheets,
        styles=_count_styles(usual[styles], limits) if styles in usual else limits.cells,
        strings=strings if strings in usual else "",
        texts=_Strings(usual[strings], limits).count if strings in usual else 0,
        modified=_modified(usual, limits),
        is_rewritten=usual != parts,
    )


def _without_dangling_types(parts: Mapping[str, bytes], limits: ReadingLimits) -> dict[str, bytes]:
    """Leave out the types of parts that are not there; some programs list them, and readers look for the parts."""
    types = parts.get(_TYPES, b"")
    for entry in Listing(types, limits, "Override").attributes if types else ():
        name = entry.get("PartName", "")
        if name.lstrip("/") not in parts:
            pattern = rb"<(?:\w+:)?Override\b[^<>]*PartName=([\"'])%s\1[^<>]*/>" % re.escape(name.encode())
            types = re.sub(pattern, b"", types)
    return {**parts, _TYPES: types} if types else dict(parts)


def _usual_dialect(parts: dict[str, bytes]) -> dict[str, bytes]:
    """Return the parts with the names of the Strict dialect replaced by the usual ones."""
    if not any(_STRICT in part for name, part in parts.items() if name.lower().endswith((".xml", ".rels"))):
        return parts
    usual_parts = {}
    for name, part in parts.items():
        usual = part
        if name.lower().endswith((".xml", ".rels")):
            for strict, transitional in STRICT_NAMES:
                usual = usual.replace(strict, transitional)
        usual_parts[name] = usual
    return usual_parts


def _workbook_part(parts: Mapping[str, bytes], limits: ReadingLimits) -> str:
    """Name of the part that lists the sheets."""
    if _ROOT in parts:
        for relation in Listing(parts[_ROOT], limits, "Relationship").attributes:
            if relation.get("Type", "").endswith("/officeDocument"):
                part = relation.get("Target", "").lstrip("/")
                if part in parts and local(Elements(parts[part], limits).root) == "workbook":
                    return part
    raise Refusal("E101", found="the archive holds no workbook")


def _count_styles(styles: bytes, limits: ReadingLimits) -> int:
    """Return how many cell formats the part of the styles holds."""
    return max(1, len(Listing(styles, limits, "xf", "cellXfs").attributes))


def _check_type(parts: Mapping[str, bytes], workbook: str, limits: ReadingLimits) -> None:
    """Refuse a file whose list of types names another workbook than its relations do: readers would differ."""
    types = Listing(parts[_TYPES], limits, "Override").attributes if _TYPES in parts else []
    mains = [
        override.get("PartName", "") for override in types if override.get("ContentType", "").endswith(".main+xml")
    ]
    if any(name.lstrip("/") != workbook for name in mains):
        raise Refusal("E102")


def _relations(parts: Mapping[str, bytes], workbook: str, limits: ReadingLimits) -> dict[str, tuple[str, str]]:
    """Type and part of what the workbook refers to, by relation id."""
    folder, name = posixpath.split(workbook)
    part = f"{folder}/_rels/{name}.rels" if folder else f"_rels/{name}.rels"
    if part not in parts:
        raise Refusal("E102")
    relations = {}
    for relation in Listing(parts[part], limits, "Relationship").attributes:
        target = relation.get("Target", "")
        path = target.lstrip("/") if target.startswith("/") else posixpath.normpath(posixpath.join(folder, target))
        relations[relation.get("Id", "")] = (relation.get("Type", ""), path)
    return relations


def _related(relations: Mapping[str, tuple[str, str]], kind: str) -> str:
    """Name of the workbook's part of a kind, an empty text when there is none."""
    return next((part for type_, part in relations.values() if type_.endswith(f"/{kind}")), "")


def _sheets(
    parts: Mapping[str, bytes], workbook: str, relations: Mapping[str, tuple[str, str]], limits: ReadingLimits
) -> list[SheetPart]:
    """Return the worksheets in order; charts on sheets of their own are none."""
    listing = Listing(parts[workbook], limits, "sheet")
    if not listing.root.startswith(f"{MAIN} "):
        raise Refusal("E106")
    limits.require("sheets", len(listing.attributes))
    sheets = []
    for sheet in listing.attributes:
        kind, part = relations.get(sheet.get(f"{_OFFICE} id", ""), ("", ""))
        if part not in parts or not kind.endswith(_SHEET_KINDS):
            raise Refusal("E102")
        if kind.endswith(_SHEET_KINDS[0]):
            hidden = sheet.get("state", "visible") != "visible"
            sheets.append(SheetPart(title=sheet.get("name", ""), part=part, hidden=hidden))
    if len({sheet.title.casefold() for sheet in sheets}) < len(sheets):
        raise Refusal("E102")
    return sheets


class _Strings(Elements):
    """Counts the texts that cells refer to, none of them longer than a cell can hold."""

    def __init__(self, data: bytes, limits: ReadingLimits) -> None:
        self.count = 0
        self.length = 0
        self.in_text = False
        super().__init__(data, limits)

    def start(self, name: str, attributes: dict[str, str]) -> None:  # noqa: ARG002
        if local(name) == "si":
            self.count += 1
            self.length = 0
        self.in_text = local(name) == "t"

    def end(self, name: str) -> None:  # noqa: ARG002
        self.in_text = False

    def text(self, text: str) -> None:
        if self.in_text:
            self.length += len(text)
            self.limits.require("characters", self.length)


def _modified(parts: Mapping[str, bytes], limits: ReadingLimits) -> datetime.datetime | None:
    """Return the workbook's own date of its last change, in UTC, or None when it has none."""
    if _CORE not in parts:
        return None
    try:
        (text,) = Texts(parts[_CORE], limits, "modified").texts
        moment = datetime.datetime.fromisoformat(text.strip())
        return (moment.astimezone(datetime.UTC) if moment.tzinfo else moment).replace(tzinfo=None, microsecond=0)
    except (ValueError, OverflowError):
        return None
