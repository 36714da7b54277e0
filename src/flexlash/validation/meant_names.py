"""What a name that nothing has probably means, among those that there are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from flexlash.schema.column import Column
from flexlash.schema.spellings import affordable, misspelt, spelt_alike, suggested
from flexlash.validation.cell_values import is_no_value, no_value_facts

__all__ = ["MOST_NAMES", "MeantNames"]

MOST_NAMES = 100_000
"""Most materials, classes or samples named, beyond which none of them is compared with those that there are."""

_NEAR = 0.7
"""Likeness from which on a name is suggested; short names of steels share letters by chance."""


class MeantNames(dict[str, dict[str, str | None]]):
    """What unknown names probably mean, looked up once each, where so `few` are named that all can be compared."""

    def __init__(self, names: Sequence[str], named: int) -> None:
        super().__init__()
        self.names = names
        self.known: Mapping[str, str] = spelt_alike(names)
        self.few = named <= min(affordable(names), MOST_NAMES)

    def __missing__(self, value: str) -> dict[str, str | None]:
        """Look a name up."""
        self[value] = (
            {"suggestion": suggested(value, self.names, _NEAR), "certain_value": misspelt(value, self.known)}
            if self.few
            else {}
        )
        return self[value]

    def unknown(self, code: str, column: Column, value: str) -> dict[str, Any]:
        """Return code and facts of a name in a column that nothing has, or of a word that stands for none."""
        if is_no_value(value):
            return {"code": "E221", **no_value_facts(column)}
        return {"code": code, **self[value]}
