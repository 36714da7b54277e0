"""How much of a file is read, so that one damaged or hostile file cannot stop the work of others."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any

from flexlash.reading.refusal import Refusal
from flexlash.schema.argument_checks import whole_number
from flexlash.schema.findings import shown

__all__ = ["ReadingLimits"]


def _limit(value: int, most: int, what: str, unit: str = "", remark: str = "") -> Any:
    """Return a limit that may be set up to `most`, beyond which it would protect nobody."""
    return field(default=value, metadata={"most": most, "what": what, "unit": unit, "remark": remark})


_WHOLE = re.compile(r"0*[1-9]\d{0,17}", re.ASCII)
"""A number that a computer takes at all; the bounds of each limit are closer."""
_DAY = 86_400
_TEBI = 2**20
_BUSY = "; the computer may be busy"


@dataclass(frozen=True, kw_only=True)
class ReadingLimits:
    """The greatest number of each kind that is read; the field's name is the setting that changes it."""

    file_mebibytes: int = _limit(20, _TEBI, "the file's size", "MiB")
    parquet_mebibytes: int = _limit(100, _TEBI, "the Parquet file's size", "MiB")
    parts: int = _limit(1_000, 1_000_000, "the number of parts inside the file")
    part_mebibytes: int = _limit(100, _TEBI, "the unpacked size of one part", "MiB")
    unpacked_mebibytes: int = _limit(200, _TEBI, "the unpacked size", "MiB")
    compression: int = _limit(100, 1_000_000, "the compression", "to 1")
    depth: int = _limit(64, 500, "the nesting inside a part", "levels")
    attributes: int = _limit(256, 1_000_000, "the number of attributes of one element")
    sheets: int = _limit(100, 100_000, "the number of sheets")
    cells: int = _limit(1_000_000, 10**9, "the number of cells")
    table_rows: int = _limit(1_048_576, 10**9, "the number of rows of a table")
    table_cells: int = _limit(1_500_000, 10**10, "the number of cells of a table")
    merged_areas: int = _limit(100_000, 10**9, "the number of merged areas")
    characters: int = _limit(32_767, 10**9, "the length of one cell's text", "characters")
    rows: int = _limit(20_000, 1_048_576, "the number of rows with data")
    columns: int = _limit(256, 16_384, "the number of columns")
    seconds: int = _limit(60, _DAY, "the time for reading", "s", remark=_BUSY)
    processor_seconds: int = _limit(20, _DAY, "the computing time for reading", "s")
    memory_mebibytes: int = _limit(1_024, _TEBI, "the memory for reading", "MiB")

    def times(self, factor: int, *settings: str) -> ReadingLimits:
        """Return limits of which some are so many times higher, as far as they may be."""
        most = {limit.name: limit.metadata["most"] for limit in fields(self)}
        return replace(self, **{name: min(factor * getattr(self, name), most[name]) for name in settings})

    @classmethod
    def of(cls, settings: Mapping[str, object]) -> ReadingLimits:
        """Return limits with some of them changed; raise ValueError for an unknown name or no whole number above 0."""
        names = {limit.name for limit in fields(cls)}
        for name, value in settings.items():
            if name not in names:
                raise ValueError(f"{shown(name)} is not a limit; the limits are {', '.join(sorted(names))}")
            if not _WHOLE.fullmatch(str(value)):
                raise ValueError(f"{name} = {shown(value)}: a whole number of at least 1 is required")
        return cls(**{name: int(str(value)) for name, value in settings.items()})

    def __post_init__(self) -> None:
        for limit in fields(self):
            whole_number(limit.name, getattr(self, limit.name), least=1, most=limit.metadata["most"])

    def exceeded(self, setting: str, amount: float | None = None) -> Refusal:
        """Return the refusal that names a limit, what was found, and the setting."""
        (limit,) = (limit for limit in fields(self) if limit.name == setting)
        unit = f" {limit.metadata['unit']}" if limit.metadata["unit"] else ""
        value = getattr(self, setting)
        exceeded = f"more than {value:,}" if amount is None else f"{amount:,.10g}"
        return Refusal(
            "E110",
            what=limit.metadata["what"],
            limit=f"{value:,}{unit}",
            found=f"{exceeded}{unit}",
            setting=setting,
            detail=limit.metadata["remark"],
        )

    def require(self, setting: str, amount: float) -> None:
        """Raise the refusal when a number exceeds its limit."""
        if amount > getattr(self, setting):
            raise self.exceeded(setting, amount)
