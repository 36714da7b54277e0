"""A Parquet file's bytes → whether they may be read: what they say they hold, and whether all pages are whole."""

from __future__ import annotations

import zlib
from typing import Any

from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.thrift import read_struct

__all__ = ["check_file"]

_MARK = b"PAR1"
_TAIL = 8
"""The length of the footer and the mark, which end a file."""

_MEBI = 2**20
_LARGEST_FOOTER = 2 * _MEBI

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


def _footer(data: bytes, limits: ReadingLimits) -> dict[int, Any]:
    """Return the fields of the footer, which stands before its length at the end of the file."""
    length = int.from_bytes(data[-_TAIL:-4], "little")
    start = len(data) - _TAIL - length
    if not data.endswith(_MARK) or start < len(_MARK):
        raise ValueError("no Parquet file")
    if length > _LARGEST_FOOTER:
        # It describes every column of every group of rows.
        raise limits.exceeded("columns")
    return read_struct(data[start:-_TAIL], 0)[0]


def _is_checked(data: bytes, chunk: dict[int, Any]) -> bool:
    """Whether the pages of a chunk have checksums; raise ValueError where one of them has none or a wrong one."""
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
