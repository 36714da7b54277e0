"""What reading yields: sheets of raw cells at their own addresses."""

from __future__ import annotations

import datetime
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias

from flexlash.reading.whole_table import WholeTable

__all__ = [
    "ERROR_WORDS",
    "CommaNumber",
    "CsvDialect",
    "DoubtfulNumber",
    "ErrorCell",
    "Percentage",
    "RawSheet",
    "RawValue",
    "Submission",
    "Unstored",
]

ERROR_WORDS = frozenset((
    "#REF!", "#DIV/0!", "#VALUE!", "#NAME?", "#N/A", "#NUM!", "#NULL!", "#SPILL!", "#CALC!", "#FIELD!", "#BLOCKED!",
    "#CONNECT!", "#UNKNOWN!", "#BUSY!", "#GETTING_DATA", "#EXTERNAL!", "#PYTHON!",
))  # fmt: skip
"""Error words, which some programs store as plain texts."""


@dataclass(frozen=True)
class ErrorCell:
    """A cell that shows an Excel error."""

    text: str


@dataclass(frozen=True)
class Unstored:
    """A formula whose result was never stored."""


class Percentage(float):
    """A number that its cell shows as a percentage: 0.05 is shown as 5%."""

    __slots__ = ()

    @property
    def shown(self) -> str:
        """What the cell shows."""
        return f"{round(self * 100, 10):.10g}%"


class CommaNumber(str):
    """A text of a table that is a number with a decimal comma, beyond doubt."""

    __slots__ = ()


class DoubtfulNumber(str):
    """A text of a table whose sign may not be what it seems, such as 1.600 or 1.7 beside 1,6; never fixed unasked."""

    __slots__ = ()


RawValue: TypeAlias = (
    str | float | int | bool | datetime.date | datetime.time | datetime.timedelta | ErrorCell | Unstored
)


@dataclass(frozen=True, kw_only=True)
class CsvDialect:
    """How a delimited text was written: whatever of it was recognised rather than known.

    `comma_number` and `foreign_text` are the addresses, row and column, of the first number with a decimal comma
    and of the first text that another encoding would show otherwise; None where there is none. `longer` are rows of
    more cells than the header row has, blank ones included, where an unquoted decimal comma may have made two of one.
    """

    delimiter: str
    encoding: str
    file: str = ""
    comma_number: tuple[int, int] | None = None
    foreign_text: tuple[int, int] | None = None
    longer: frozenset[int] = frozenset()
    sample_column: int = 0


@dataclass(frozen=True, kw_only=True)
class RawSheet:
    """Cells by row and column number, both from 1 as the user counts; blank cells are absent.

    `numbers_are_texts` tells a delimited text, in which a text may be a number, `dialect` how it was written.
    `hidden_rows` hold cells that Excel does not show; `merged` are areas as (first row, first column, last row, last
    column). `whole` are the facts of the table of which these are but some rows; None for a sheet that is all of it.
    """

    name: str
    rows: dict[int, dict[int, RawValue]]
    numbers_are_texts: bool = False
    hidden: bool = False
    hidden_rows: frozenset[int] = frozenset()
    merged: tuple[tuple[int, int, int, int], ...] = ()
    dialect: CsvDialect | None = None
    whole: WholeTable | None = None


@dataclass(frozen=True, kw_only=True)
class Submission:
    """A submission as read, and its bytes. `role` is what its document properties say it is.

    `run_with` are the options of the run whose report carried it; None for a submission that was read itself.
    `worst_of` is how many rows it had where the report carried the worst of them alone, else 0.
    """

    name: str
    sha256: str
    kind: str
    sheets: dict[str, RawSheet] = field(default_factory=dict)
    modified: datetime.datetime | None = None
    role: str = ""
    template_version: str = ""
    data: bytes = field(default=b"", repr=False)
    run_with: Mapping[str, Any] | None = None
    worst_of: int = 0

    @property
    def dialect(self) -> CsvDialect | None:
        """How a delimited submission was written; None for workbooks."""
        return next((sheet.dialect for sheet in self.sheets.values() if self.kind == "csv" and sheet.dialect), None)

    @property
    def delimiter(self) -> str:
        """What separates the columns of a delimited text; an empty text for others."""
        return self.dialect.delimiter if self.dialect else ""

    @property
    def encoding(self) -> str:
        """The encoding of a delimited text; an empty text for others."""
        return self.dialect.encoding if self.dialect else ""
