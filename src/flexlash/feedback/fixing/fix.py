"""The record of one fix."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

__all__ = ["Fix"]


@dataclass(frozen=True, kw_only=True)
class Fix:
    """One cell, what stood there, what is to stand there, and the code of the finding that says so."""

    sheet: str
    cell: str
    found: str
    value: str | float
    code: str

    def as_dictionary(self) -> dict[str, Any]:
        """Return the fields as JSON can hold them."""
        return asdict(self)

    @property
    def place(self) -> str:
        """Sheet and cell as Excel writes them: `Variants!D7`."""
        return f"{self.sheet}!{self.cell}"

    @property
    def written(self) -> str:
        """The value as its list shows it."""
        return self.value if isinstance(self.value, str) else f"{self.value:.15g}"
