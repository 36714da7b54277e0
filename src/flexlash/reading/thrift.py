"""Thrift's compact protocol → plain values: how a Parquet file writes what it says of itself."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

__all__ = ["read_struct"]

_, _TRUE, _FALSE, _BYTE, _I16, _I32, _I64, _DOUBLE, _BINARY, _LIST, _SET, _MAP, _STRUCT = range(13)
_DEPTH = 32
_LONG = 15
"""Length of a list from which on it stands behind the list's head."""


def read_struct(data: bytes, start: int) -> tuple[dict[int, Any], int]:
    """Return the fields of a struct by number, and where it ends.

    Raises ValueError or IndexError where there is none.
    """
    reader = _Reader(data, start)
    return reader.struct(), reader.position


class _Reader:
    def __init__(self, data: bytes, position: int) -> None:
        self.data = data
        self.position = position
        self.depth = 0
        self.readers: dict[int, Callable[[], Any]] = {
            **dict.fromkeys((_TRUE, _FALSE, _BYTE), self._byte),
            **dict.fromkeys((_I16, _I32, _I64), self._signed),
            _DOUBLE: lambda: self._bytes(8),
            _BINARY: lambda: self._bytes(self._unsigned()),
            **dict.fromkeys((_LIST, _SET), self._list),
            _MAP: self._map,
            _STRUCT: self.struct,
        }

    def struct(self) -> dict[int, Any]:
        """Read fields until the one that ends them; each tells its number by how far it is from the last."""
        self.depth += 1
        if self.depth > _DEPTH:
            raise ValueError("nested too deeply")
        fields: dict[int, Any] = {}
        number = 0
        while head := self._byte():
            step, kind = head >> 4, head & 0x0F
            number = number + step if step else self._signed()
            # The kind of a field that is true or false says which.
            fields[number] = kind == _TRUE if kind in {_TRUE, _FALSE} else self._value(kind)
        self.depth -= 1
        return fields

    def _value(self, kind: int) -> Any:
        """Read a value of a kind."""
        if kind not in self.readers:
            raise ValueError("unknown kind of field")
        return self.readers[kind]()

    def _list(self) -> list[Any]:
        head = self._byte()
        length = head >> 4 if head >> 4 < _LONG else self._unsigned()
        return [self._value(head & 0x0F) for _ in range(self._possible(length))]

    def _map(self) -> list[Any]:
        """Read keys and values by turns; nothing here asks for them."""
        length = self._possible(self._unsigned())
        kinds = self._byte() if length else 0
        return [self._value(kind) for _ in range(length) for kind in (kinds >> 4, kinds & 0x0F)]

    def _possible(self, length: int) -> int:
        """Return a length; each member takes a byte at least."""
        if length > len(self.data) - self.position:
            raise ValueError("longer than the file")
        return length

    def _byte(self) -> int:
        self.position += 1
        return self.data[self.position - 1]

    def _bytes(self, length: int) -> bytes:
        start = self.position
        self.position += self._possible(length)
        return self.data[start : self.position]

    def _unsigned(self) -> int:
        """Read a whole number in groups of seven bits, the lowest first."""
        value = shift = 0
        while (byte := self._byte()) & 0x80:
            value |= (byte & 0x7F) << shift
            shift += 7
            if shift > 63:  # noqa: PLR2004
                raise ValueError("a number without end")
        return value | byte << shift

    def _signed(self) -> int:
        value = self._unsigned()
        return value >> 1 ^ -(value & 1)
