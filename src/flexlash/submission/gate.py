"""Bytes → what kind of submission they are, or a refusal by name; judged by content, never by the ending.

The gate also looks at each sheet's XML for what the workbook reader cannot tell: formulas without a stored
result, error cells, and what the reader would take for something else without a word (rows or cells out of
order, texts where numbers belong).
"""

from __future__ import annotations

import datetime
import io
import re
import zipfile
import zlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal
from xml.parsers import expat

__all__ = ["Admitted", "Refusal", "admit", "read_bytes"]

Kind = Literal["workbook", "parquet", "csv"]

MAXIMUM_BYTES = 20 * 2**20
MAXIMUM_PARTS = 1_000
MAXIMUM_PART_BYTES = 100 * 2**20
MAXIMUM_INFLATED_BYTES = 200 * 2**20
MAXIMUM_RATIO = 100
MAXIMUM_ROW = 1_048_576
MAXIMUM_COLUMN = 16_384
MAXIMUM_CELLS = 1_000_000
MAXIMUM_DEPTH = 64
MAXIMUM_ATTRIBUTES = 256
MAXIMUM_SHEETS = 100
MAXIMUM_MERGES = 10_000

_NUMBER = re.compile(r"\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*", re.ASCII)
_INDEX = re.compile(r"\s*\d+\s*", re.ASCII)
_REFERENCE = re.compile(r"([A-Z]{1,3})([1-9]\d{0,6})", re.ASCII)
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")

_OLE2 = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_STRICT = "http://purl.oclc.org/ooxml/"
_RELATIONS = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"


class Refusal(Exception):
    """The submission as a whole cannot be used: a finding code and what its message needs."""

    def __init__(self, code: str, **facts: object) -> None:
        super().__init__(code)
        self.code = code
        self.facts = facts


@dataclass(frozen=True, kw_only=True)
class Admitted:
    """Bytes that passed the gate.

    `unstored` are the formula cells without a stored result, `errors` the error cells, both as (row, column)
    by sheet; `modified` is the date that the workbook itself gives.
    """

    kind: Kind
    data: bytes
    unstored: dict[str, frozenset[tuple[int, int]]] = field(default_factory=dict)
    errors: dict[str, frozenset[tuple[int, int]]] = field(default_factory=dict)
    modified: datetime.datetime | None = None


def read_bytes(path: Path) -> bytes:
    """Return the bytes of a regular file of acceptable size.

    Raises OSError when it cannot be opened, Refusal when it is empty or too large.
    """
    if not path.is_file():
        raise FileNotFoundError(f"{path.name} is not a file" if path.exists() else f"{path.name} does not exist")
    with path.open("rb") as file:
        data = file.read(MAXIMUM_BYTES + 1)
    if not data:
        raise Refusal("E101", found="the file is empty")
    if len(data) > MAXIMUM_BYTES and not data.startswith(b"PAR1"):
        raise Refusal("E110", what="the file", limit=f"{MAXIMUM_BYTES // 2**20} MiB")
    return data if len(data) <= MAXIMUM_BYTES else path.read_bytes()


def admit(data: bytes, only: Kind | None = None) -> Admitted:
    """Return the submission's kind and what its XML tells; raise Refusal for anything unfit, or of another kind."""
    admitted = _judge(data)
    if only not in {None, admitted.kind}:
        raise Refusal("E101", found=f"a {only} file is required here")
    return admitted


def _judge(data: bytes) -> Admitted:
    """Return what the content is, whatever its name says."""
    if data.startswith(b"PK\x03\x04"):
        try:
            return _inspect(data)
        except (
            zipfile.BadZipFile,
            zlib.error,
            expat.ExpatError,
            EOFError,
            OSError,
            NotImplementedError,
        ) as fault:
            raise Refusal("E102") from fault
        except (KeyError, RuntimeError, UnicodeError, ValueError, OverflowError) as fault:
            raise Refusal("E102") from fault
    if data.startswith(_OLE2):
        locked = "EncryptedPackage".encode("utf-16-le") in data
        raise Refusal("E103") if locked else Refusal("E104", found="an old Excel file (.xls)")
    if data.startswith(b"PAR1"):
        return Admitted(kind="parquet", data=data)
    if data.startswith(_UTF_16):
        raise Refusal("E107")
    if b"\0" in data[:4096] or data.startswith((b"PK", b"%PDF", b"{\\rtf", b"<")):
        raise Refusal("E101", found="the content is neither a workbook nor a table")
    return Admitted(kind="csv", data=data)


def _inspect(data: bytes) -> Admitted:
    """Check the archive and each worksheet."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        _check_archive(archive)
        names = set(archive.namelist())
        if "xl/workbook.bin" in names:
            raise Refusal("E104", found="a binary workbook (.xlsb)")
        if "mimetype" in names or {"content.xml", "META-INF/manifest.xml"} <= names:
            raise Refusal("E104", found="an OpenDocument file (.ods)")
        start = _workbook_part(archive, names)
        sheets = _sheets(archive.read(start))
        targets = _targets(archive, start)
        styles = _count_styles(archive, start, names)
        found = {
            title: _Sheet(archive.read(targets[relation]), styles) for title, relation in sheets if relation in targets
        }
        return Admitted(
            kind="workbook",
            data=data,
            unstored={title: frozenset(sheet.unstored) for title, sheet in found.items()},
            errors={title: frozenset(sheet.errors) for title, sheet in found.items()},
            modified=_modified(archive, names),
        )


def _check_archive(archive: zipfile.ZipFile) -> None:
    """Refuse archives that are too large, that hide parts, or whose parts fail their checksum when read."""
    parts = archive.infolist()
    if len(parts) > MAXIMUM_PARTS:
        raise Refusal("E110", what="the number of parts", limit=f"{MAXIMUM_PARTS:,}")
    if len({part.filename.casefold() for part in parts}) < len(parts):
        raise Refusal("E102")
    if any(_strays(part.orig_filename) or part.compress_type not in {0, zipfile.ZIP_DEFLATED} for part in parts):
        raise Refusal("E102")
    total = 0
    for part in parts:
        total += part.file_size
        if part.flag_bits & 1:
            raise Refusal("E103")
        if part.file_size > MAXIMUM_PART_BYTES or total > MAXIMUM_INFLATED_BYTES:
            limit = f"{MAXIMUM_PART_BYTES // 2**20} MiB a part, {MAXIMUM_INFLATED_BYTES // 2**20} MiB in all"
            raise Refusal("E110", what="the unpacked size", limit=limit)
        if part.file_size > 2**20 and part.file_size > MAXIMUM_RATIO * part.compress_size:
            raise Refusal("E110", what="the compression", limit=f"{MAXIMUM_RATIO} to 1")
    for part in parts:
        if b"<!DOCTYPE" in archive.read(part) and part.filename.lower().endswith((".xml", ".rels")):
            raise Refusal("E105")


def _strays(name: str) -> bool:
    """Whether a part's name points out of the archive or hides something."""
    return name.startswith("/") or ".." in name.split("/") or any(sign in name for sign in "\\:\0")


class _Elements:
    """Feeds a part to expat and calls back for each element; no DOCTYPE, no deep nesting."""

    def __init__(self, data: bytes) -> None:
        self.depth = 0
        parser = expat.ParserCreate(namespace_separator=" ")
        parser.StartDoctypeDeclHandler = self._refuse
        parser.StartElementHandler = self._open
        parser.EndElementHandler = self._close
        parser.CharacterDataHandler = self.text
        parser.buffer_text = True
        parser.Parse(data, True)

    @staticmethod
    def _refuse(*_: object) -> None:
        raise Refusal("E105")

    def _open(self, name: str, attributes: dict[str, str]) -> None:
        self.depth += 1
        if self.depth > MAXIMUM_DEPTH or len(attributes) > MAXIMUM_ATTRIBUTES:
            raise Refusal("E102")
        self.start(name.rpartition(" ")[2], attributes, name)

    def _close(self, name: str) -> None:
        self.depth -= 1
        self.end(name.rpartition(" ")[2])

    def start(self, name: str, attributes: dict[str, str], qualified: str) -> None:
        """React to an opening element."""

    def end(self, name: str) -> None:
        """React to a closing element."""

    def text(self, text: str) -> None:
        """React to character data."""


class _Listing(_Elements):
    """Collects the attributes of elements of one name."""

    def __init__(self, data: bytes, wanted: str) -> None:
        self.wanted = wanted
        self.root = ""
        self.found: list[dict[str, str]] = []
        super().__init__(data)

    def start(self, name: str, attributes: dict[str, str], qualified: str) -> None:
        self.root = self.root or qualified
        if name == self.wanted:
            self.found.append(attributes)


def _workbook_part(archive: zipfile.ZipFile, names: set[str]) -> str:
    """Name of the part that lists the sheets."""
    if "_rels/.rels" not in names:
        raise Refusal("E101", found="the archive holds no workbook")
    for relation in _Listing(archive.read("_rels/.rels"), "Relationship").found:
        if relation.get("Type", "").endswith("/officeDocument"):
            part = relation.get("Target", "").lstrip("/")
            if part in names and _Listing(archive.read(part), "sheets").root.endswith(" workbook"):
                return part
    raise Refusal("E101", found="the archive holds no workbook")


def _sheets(workbook: bytes) -> list[tuple[str, str]]:
    """Titles and relation ids of the sheets, in order."""
    listing = _Listing(workbook, "sheet")
    if listing.root.startswith(_STRICT):
        raise Refusal("E106")
    if len(listing.found) > MAXIMUM_SHEETS:
        raise Refusal("E110", what="the number of sheets", limit=f"{MAXIMUM_SHEETS:,}")
    return [(sheet["name"], sheet.get(f"{_RELATIONS} id", "")) for sheet in listing.found]


class _Styles(_Elements):
    """Counts the cell formats."""

    def __init__(self, data: bytes) -> None:
        self.count = 0
        self.inside = False
        super().__init__(data)

    def start(self, name: str, attributes: dict[str, str], qualified: str) -> None:  # noqa: ARG002
        self.inside = self.inside or name == "cellXfs"
        self.count += self.inside and name == "xf"

    def end(self, name: str) -> None:
        self.inside = self.inside and name != "cellXfs"


def _count_styles(archive: zipfile.ZipFile, workbook: str, names: set[str]) -> int:
    """Return how many cell formats the workbook has; cells may always refer to the first."""
    part = f"{workbook.rpartition('/')[0]}/styles.xml"
    return max(1, _Styles(archive.read(part)).count) if part in names else MAXIMUM_CELLS


class _Dates(_Elements):
    """Collects when the workbook was modified."""

    def __init__(self, data: bytes) -> None:
        self.reading = False
        self.modified = ""
        super().__init__(data)

    def start(self, name: str, attributes: dict[str, str], qualified: str) -> None:  # noqa: ARG002
        self.reading = name == "modified"

    def end(self, name: str) -> None:  # noqa: ARG002
        self.reading = False

    def text(self, text: str) -> None:
        self.modified += text if self.reading else ""


def _modified(archive: zipfile.ZipFile, names: set[str]) -> datetime.datetime | None:
    """Return the workbook's own date of its last change, in UTC, or None when it has none."""
    if "docProps/core.xml" not in names:
        return None
    try:
        found = datetime.datetime.fromisoformat(_Dates(archive.read("docProps/core.xml")).modified.strip())
    except ValueError:
        return None
    return (found.astimezone(datetime.UTC) if found.tzinfo else found).replace(tzinfo=None, microsecond=0)


def _targets(archive: zipfile.ZipFile, workbook: str) -> dict[str, str]:
    """Parts of the worksheets by relation id."""
    folder, _, name = workbook.rpartition("/")
    listing = _Listing(archive.read(f"{folder}/_rels/{name}.rels"), "Relationship")
    targets = {}
    for relation in listing.found:
        if relation.get("Type", "").endswith("/worksheet"):
            target = relation["Target"]
            targets[relation["Id"]] = target.lstrip("/") if target.startswith("/") else f"{folder}/{target}"
    return targets


def _whole(text: str) -> int:
    """Return a whole number, written as one."""
    if not _INDEX.fullmatch(text):
        raise Refusal("E102")
    return int(text)


class _Sheet(_Elements):
    """Finds formula cells without a stored result and error cells; refuses what would be read wrongly."""

    def __init__(self, data: bytes, styles: int) -> None:
        self.unstored: list[tuple[int, int]] = []
        self.errors: list[tuple[int, int]] = []
        self.styles = styles
        self.row = self.column = self.cells = self.merges = 0
        self.kind = self.value = ""
        self.in_row = self.is_formula = self.in_value = False
        super().__init__(data)

    def start(self, name: str, attributes: dict[str, str], qualified: str) -> None:  # noqa: ARG002
        if name == "c":
            self._place_cell(attributes.get("r"))
            self.kind = attributes.get("t", "n")
            self.value = ""
            self.is_formula = False
            if _whole(attributes.get("s", "0")) >= self.styles:
                raise Refusal("E102")
        elif name == "row":
            number = _whole(attributes.get("r", str(self.row + 1)))
            if self.in_row or not self.row < number <= MAXIMUM_ROW:
                raise Refusal("E102")
            self.row, self.column, self.in_row = number, 0, True
        elif name == "f":
            self.is_formula = True
        elif name == "v":
            self.in_value = True
        elif name == "mergeCell":
            self.merges += 1
            if self.merges > MAXIMUM_MERGES:
                raise Refusal("E110", what="the number of merged areas", limit=f"{MAXIMUM_MERGES:,}")

    def _place_cell(self, reference: str | None) -> None:
        """Check a cell's own address against its row and the cell before."""
        self.cells += 1
        if self.cells > MAXIMUM_CELLS:
            raise Refusal("E110", what="the number of cells", limit=f"{MAXIMUM_CELLS:,}")
        if reference is None:
            self.column += 1
            return
        match = _REFERENCE.fullmatch(reference)
        if match is None or int(match[2]) != self.row:
            raise Refusal("E102")
        column = 0
        for letter in match[1]:
            column = column * 26 + ord(letter) - 64
        if not self.column < column <= MAXIMUM_COLUMN:
            raise Refusal("E102")
        self.column = column

    def end(self, name: str) -> None:
        if name == "v":
            self.in_value = False
        elif name == "row":
            self.in_row = False
        elif name == "c":
            self._close_cell()

    def _close_cell(self) -> None:
        """Judge a cell's stored value by its kind."""
        place = (self.row, self.column)
        if self.is_formula and not self.value and self.kind != "str":
            self.unstored.append(place)
        elif self.kind == "e":
            self.errors.append(place)
        elif self.value and (
            (self.kind == "n" and not _NUMBER.fullmatch(self.value))
            or (self.kind == "s" and not _INDEX.fullmatch(self.value))
        ):
            raise Refusal("E102")

    def text(self, text: str) -> None:
        if self.in_value:
            self.value += text
