"""How much of a file is read, so that one damaged or hostile file cannot stop the work of others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from typing import Any

from flexlash.submission.reading.refusal import Refusal

__all__ = ["ReadingLimits"]


def _limit(value: int, what: str, unit: str = "") -> Any:
    return field(default=value, metadata={"what": what, "unit": unit})


@dataclass(frozen=True, kw_only=True)
class ReadingLimits:
    """The greatest number of each kind that is read; the field's name is the setting that changes it."""

    file_mebibytes: int = _limit(20, "the file's size", "MiB")
    parquet_mebibytes: int = _limit(100, "the Parquet file's size", "MiB")
    parts: int = _limit(1_000, "the number of parts inside the file")
    part_mebibytes: int = _limit(100, "the unpacked size of one part", "MiB")
    unpacked_mebibytes: int = _limit(200, "the unpacked size", "MiB")
    compression: int = _limit(100, "the compression", "to 1")
    depth: int = _limit(64, "the nesting inside a part", "levels")
    attributes: int = _limit(256, "the number of attributes of one element")
    sheets: int = _limit(100, "the number of sheets")
    cells: int = _limit(1_000_000, "the number of cells")
    table_rows: int = _limit(1_048_576, "the number of rows of a table")
    table_cells: int = _limit(3_000_000, "the number of cells of a table")
    merged_areas: int = _limit(100_000, "the number of merged areas")
    characters: int = _limit(32_767, "the length of one cell's text", "characters")
    rows: int = _limit(20_000, "the number of rows with data")
    columns: int = _limit(256, "the number of columns")
    seconds: int = _limit(20, "the time for reading", "s")
    processor_seconds: int = _limit(15, "the computing time for reading", "s")
    memory_mebibytes: int = _limit(1_024, "the memory for reading", "MiB")

    @classmethod
    def of(cls, settings: Mapping[str, object]) -> ReadingLimits:
        """Return limits with some of them changed; raise ValueError for an unknown name or no whole number above 0."""
        names = {one.name for one in fields(cls)}
        for name, value in settings.items():
            if name not in names:
                raise ValueError(f"{name} is no limit; there are {', '.join(sorted(names))}")
            if not str(value).isascii() or not str(value).isdigit() or not int(str(value)):
                raise ValueError(f"{name}={value}: a whole number above 0 is required")
        return cls(**{name: int(str(value)) for name, value in settings.items()})

    def exceeded(self, setting: str, found: float | None = None) -> Refusal:
        """Return the refusal that names a limit, what was found, and the setting."""
        (one,) = (one for one in fields(self) if one.name == setting)
        unit = f" {one.metadata['unit']}" if one.metadata["unit"] else ""
        value = getattr(self, setting)
        shown = f"more than {value:,}" if found is None else f"{found:,.10g}"
        return Refusal(
            "E110", what=one.metadata["what"], limit=f"{value:,}{unit}", found=f"{shown}{unit}", setting=setting
        )

    def require(self, setting: str, found: float) -> None:
        """Raise the refusal when a number exceeds its limit."""
        if found > getattr(self, setting):
            raise self.exceeded(setting, found)

    def as_dictionary(self) -> dict[str, int]:
        """Return every limit by its setting."""
        return asdict(self)
