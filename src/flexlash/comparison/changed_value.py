"""One value that differs between two files, and when two values say the same."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

__all__ = ["ROUNDING", "Change", "equal"]

ROUNDING = 1e-12
"""Numbers that differ by no more than this part of themselves are equal."""


@dataclass(frozen=True, kw_only=True)
class Change:
    """One value that differs, in printed units; None where there is none. `owner` is the table's row it stands in."""

    sheet: str
    owner: str = ""
    key: str
    label: str
    unit: str = ""
    old: str | float | None
    new: str | float | None

    @property
    def part(self) -> float | None:
        """The change as a part of the old number; None where there is no such number."""
        if isinstance(self.old, str) or isinstance(self.new, str) or not self.old or self.new is None:
            return None
        return self.new / self.old - 1

    def as_dictionary(self) -> dict[str, Any]:
        """Return the change as JSON holds it."""
        names = ("sheet", "owner", "key", "label", "unit", "old", "new")
        percent = None if self.part is None else 100 * self.part
        return {**{name: getattr(self, name) for name in names}, "change_percent": percent}


def equal(old: Any, new: Any, tolerance: float = ROUNDING) -> bool:
    """Whether two values say the same; numbers, alone or in a row, may differ by their rounding."""
    if isinstance(old, tuple) and isinstance(new, tuple):
        pairs = zip(old, new, strict=False)
        return len(old) == len(new) and all(equal(*pair, tolerance) for pair in pairs)
    if isinstance(old, int | float) and isinstance(new, int | float):
        return math.isclose(old, new, rel_tol=tolerance)
    return bool(old == new)
