"""A workbook's bytes → its parts, every one checked: the archive inside an .xlsx is judged before anything reads it."""

from __future__ import annotations

import io
import struct
import zipfile
import zlib
from collections.abc import Mapping

from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal

__all__ = ["packed", "unpacked"]

_MEBI = 2**20
_LOCAL_HEADER = struct.Struct("<4s5H3L2H")
_COUNT = struct.Struct("<10xH")
"""How many parts there are, in the record that ends an archive."""

_MANY = 0xFFFF
"""The number that stands there for more; a record of another kind has it then."""

_LITTER = frozenset((".DS_Store", "Thumbs.db", "desktop.ini", "Icon\r"))
"""Files by which macOS and Windows remember how a folder looks."""

_SMALL, _LARGE = _MEBI, 16 * _MEBI
_REPETITIVE = 400
"""Up to so many times a part of honest rows that are all alike shrinks, which is let through unless it is large."""

_FIRST_DATE = (1980, 1, 1, 0, 0, 0)
_DAMAGE = (
    zipfile.BadZipFile, zlib.error, struct.error, EOFError, OSError, NotImplementedError, RuntimeError, ValueError,
    OverflowError,
)  # fmt: skip


def unpacked(data: bytes, limits: ReadingLimits) -> dict[str, bytes]:
    """Return the parts of an archive by name, their checksums verified; what file managers leave behind is none.

    Raises Refusal for an archive that is damaged, too large, encrypted, or that hides one part in another.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            parts = archive.infolist()
            limits.require("parts", len(parts))
            _check_count(data, parts)
            _check_overlap(data, parts, archive.start_dir)
            parts = [part for part in parts if not _is_litter(part.filename)]
            _check_names(parts)
            _check_sizes(parts, limits)
            return {part.filename: _inflated(archive, data, part) for part in parts if not part.is_dir()}
    except _DAMAGE as fault:
        raise Refusal("E102") from fault


def _check_count(data: bytes, parts: list[zipfile.ZipInfo]) -> None:
    """Refuse a directory that says to list more parts than it does: one of its entries has swallowed the next."""
    (count,) = _COUNT.unpack_from(data, data.rfind(b"PK\x05\x06"))
    if count not in {len(parts), _MANY}:
        raise Refusal("E102")


def _is_litter(name: str) -> bool:
    """Whether a part is what macOS or Windows put into an archive for themselves; no workbook refers to it."""
    last = name.rpartition("/")[2]
    return name.startswith("__MACOSX/") or last.startswith("._") or last in _LITTER


def _check_names(parts: list[zipfile.ZipInfo]) -> None:
    """Refuse names that lead out of the archive, that are used twice, and what cannot be unpacked."""
    if len({part.filename.casefold() for part in parts}) < len(parts):
        raise Refusal("E102")
    for part in parts:
        if _strays(part.orig_filename) or part.compress_type not in {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}:
            raise Refusal("E102")
        if part.flag_bits & 1:
            raise Refusal("E103")


def _strays(name: str) -> bool:
    """Whether a part's name points out of the archive or hides something."""
    return name.startswith("/") or ".." in name.split("/") or any(sign in name for sign in "\\:\0")


def _check_sizes(parts: list[zipfile.ZipInfo], limits: ReadingLimits) -> None:
    """Refuse what would unpack to too much; unpacking never yields more than is declared here."""
    for part in parts:
        limits.require("part_mebibytes", part.file_size / _MEBI)
        shrinks = part.file_size / max(1, part.compress_size)
        if part.file_size > (_LARGE if shrinks <= _REPETITIVE else _SMALL):
            limits.require("compression", shrinks)
    limits.require("unpacked_mebibytes", sum(part.file_size for part in parts) / _MEBI)


def _check_overlap(data: bytes, parts: list[zipfile.ZipInfo], directory: int) -> None:
    """Refuse parts that overlap: one stretch of bytes unpacked many times is how small files become enormous.

    Python checks this itself only since 3.11.8 and 3.12.2.
    """
    end = 0
    for part in sorted(parts, key=lambda part: part.header_offset):
        header = _LOCAL_HEADER.unpack_from(data, part.header_offset)
        if part.header_offset < end or header[0] != b"PK\x03\x04":
            raise Refusal("E102")
        end = part.header_offset + _LOCAL_HEADER.size + header[-2] + header[-1] + part.compress_size
    if end > directory:
        raise Refusal("E102")


def _inflated(archive: zipfile.ZipFile, data: bytes, part: zipfile.ZipInfo) -> bytes:
    """Return a part, of exactly the size and checksum that are declared; never more than that is unpacked.

    Python's own reading unpacks the whole stream first and cuts it off at the declared size then.
    """
    with archive.open(part):
        header = _LOCAL_HEADER.unpack_from(data, part.header_offset)
    start = part.header_offset + _LOCAL_HEADER.size + header[-2] + header[-1]
    content = data[start : start + part.compress_size]
    if part.compress_type == zipfile.ZIP_DEFLATED:
        stream = zlib.decompressobj(-zlib.MAX_WBITS)
        content = stream.decompress(content, part.file_size + 1)
        if not stream.eof or stream.unused_data:
            raise Refusal("E102")
    if len(content) != part.file_size or zlib.crc32(content) != part.CRC:
        raise Refusal("E102")
    return content


def packed(parts: Mapping[str, bytes], *, compressed: bool = False) -> bytes:
    """Return parts as an archive; the same bytes for the same parts."""
    buffer = io.BytesIO()
    method = zipfile.ZIP_DEFLATED if compressed else zipfile.ZIP_STORED
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, part in parts.items():
            archive.writestr(zipfile.ZipInfo(name, _FIRST_DATE), part, compress_type=method)
    return buffer.getvalue()
