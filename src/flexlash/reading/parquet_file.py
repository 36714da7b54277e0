"""A Parquet file's bytes → whether they may be read: what they say they hold, and whether all pages are whole."""

from __future__ import annotations

import hashlib
import os
import zlib
from typing import Any, BinaryIO, NamedTuple

from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.thrift import read_struct

__all__ = ["RowGroup", "check_file", "check_group", "row_groups"]

_MARK = b"PAR1"
_TAIL = 8
"""The length of the footer and the mark, which end a file."""

_MEBI = 2**20
_LARGEST_FOOTER, _LARGEST_FOOTER_OF_MANY = 2 * _MEBI, 64 * _MEBI

_LARGEST_CHUNK = 512 * _MEBI

_SCHEMA, _ROWS, _GROUPS = 2, 3, 4
_CHILDREN = 5
_CHUNKS, _GROUP_ROWS = 1, 3
_META = 3
_VALUES, _UNPACKED, _PACKED, _DATA_PAGE, _DICTIONARY_PAGE = 5, 6, 7, 9, 11
_PAGE_SIZE, _PAGE_CHECKSUM = 3, 4
"""Numbers of fields, by parquet.thrift: of the footer, a column, a group of rows, its chunk of a column, a page."""

_NONSENSE = (ValueError, IndexError, KeyError, TypeError, AttributeError)


def check_file(data: bytes, limits: ReadingLimits) -> bool:
    """Return whether the pages of a Parquet file have checksums, all of them right.

    Raises Refusal when the file says to hold more than the limits allow, is damaged, or differs from a checksum.
    """
    try:
        footer = _footer(data, limits)
        groups = footer.get(_GROUPS, [])
        chunks = [chunk[_META] for group in groups for chunk in group[_CHUNKS]]
        rows = max(footer[_ROWS], sum(group[_GROUP_ROWS] for group in groups))
        columns = footer[_SCHEMA][0].get(_CHILDREN, 0)
        limits.require("columns", columns)
        limits.require("table_rows", rows + 1)
        limits.require("table_cells", max(rows * columns, sum(chunk[_VALUES] for chunk in chunks)))
        limits.require("unpacked_mebibytes", sum(chunk[_UNPACKED] for chunk in chunks) / _MEBI)
        checked = {_is_checked(data, chunk) for chunk in chunks if chunk[_PACKED]}
    except _NONSENSE as fault:
        raise Refusal("E102") from fault
    if len(checked) > 1:
        raise Refusal("E102")
    return checked == {True}


class RowGroup(NamedTuple):
    """A group of rows of a Parquet file, by what its footer says of it."""

    rows: int
    unpacked: int
    chunks: tuple[dict[int, Any], ...]


def row_groups(file: BinaryIO, limits: ReadingLimits | None = None) -> list[RowGroup]:
    """Return the groups of rows of a Parquet file, of which nothing but the footer is read.

    Raises Refusal when it is damaged, or has too many columns.
    """
    limits = limits or ReadingLimits()
    try:
        end = file.seek(-_TAIL, os.SEEK_END)
        length = min(int.from_bytes(file.read(4), "little"), _LARGEST_FOOTER_OF_MANY)
        # The mark at the beginning is before the footer as well.
        file.seek(max(end - length - len(_MARK), 0))
        footer = _footer(file.read(), limits, _LARGEST_FOOTER_OF_MANY)
        limits.require("columns", footer[_SCHEMA][0].get(_CHILDREN, 0))
        return [
            RowGroup(
                rows=group[_GROUP_ROWS],
                unpacked=sum(chunk[_META][_UNPACKED] for chunk in group[_CHUNKS]),
                chunks=tuple(chunk[_META] for chunk in group[_CHUNKS]),
            )
            for group in footer.get(_GROUPS, [])
        ]
    except (*_NONSENSE, OSError) as fault:
        raise Refusal("E102") from fault


def check_group(file: BinaryIO, group: RowGroup) -> tuple[set[bool], bytes]:
    """Return whether pages of a group of rows have checksums, all of them right, and the digest of its bytes.

    Raises Refusal for a wrong checksum.
    """
    checked = set()
    digest = hashlib.blake2b(digest_size=16)
    try:
        for chunk in group.chunks:
            if chunk[_PACKED]:
                file.seek(min(chunk[field] for field in (_DATA_PAGE, _DICTIONARY_PAGE) if chunk.get(field)))
                if not 0 < chunk[_PACKED] <= _LARGEST_CHUNK:
                    raise Refusal("E102")
                data = file.read(chunk[_PACKED])
                digest.update(data)
                checked.add(_is_checked(data, chunk, 0))
    except (*_NONSENSE, OSError) as fault:
        raise Refusal("E102") from fault
    return checked, digest.digest()


def _footer(data: bytes, limits: ReadingLimits, largest: int = _LARGEST_FOOTER) -> dict[int, Any]:
    """Return the fields of the footer, which stands before its length at the end of the file."""
    length = int.from_bytes(data[-_TAIL:-4], "little")
    start = len(data) - _TAIL - length
    if not data.endswith(_MARK) or start < len(_MARK):
        raise ValueError("no Parquet file")
    if length > largest:
        # It describes every column of every group of rows.
        raise limits.exceeded("columns")
    return read_struct(data[start:-_TAIL], 0)[0]


def _is_checked(data: bytes, chunk: dict[int, Any], start: int | None = None) -> bool:
    """Whether the pages of a chunk have checksums; raise ValueError where one of them has none or a wrong one."""
    if start is None:
        start = min(chunk[field] for field in (_DATA_PAGE, _DICTIONARY_PAGE) if chunk.get(field))
    end = start + chunk[_PACKED]
    try:
        if _PAGE_CHECKSUM not in read_struct(data, start)[0]:
            return False
    except _NONSENSE:
        # Whether such a page can be read is for the reader to say.
        return False
    while start < end:
        page, content = read_struct(data, start)
        start = content + page[_PAGE_SIZE]
        checksum = page[_PAGE_CHECKSUM] & 0xFFFFFFFF
        if page[_PAGE_SIZE] < 0 or start > end or zlib.crc32(memoryview(data)[content:start]) != checksum:
            raise ValueError("another page than was written")
    return True
