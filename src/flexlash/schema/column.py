"""The record of one field: what every sheet, message and heading derives from."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any, Literal

from flexlash.schema.units import Unit, find_unit

__all__ = ["Column"]


_FEW = 8
"""Most choices that a sentence lists."""


@dataclass(frozen=True, kw_only=True)
class Column:
    """One field of one sheet; bounds are in the printed unit, `since` is the template version that brought it."""

    sheet: str
    key: str
    label: str
    help: str
    type: Literal["number", "integer", "text", "choice"] = "number"
    unit: str = ""
    quantity: str = ""
    required: bool = False
    minimum: float | None = None
    exclusive_minimum: bool = False
    maximum: float | None = None
    choices: tuple[str, ...] = ()
    default: str | float | None = None
    group: str = ""
    since: int = 1

    @cached_property
    def name(self) -> str:
        """The label without its unit, as a sentence names it."""
        return self.label.split(" [")[0]

    @cached_property
    def plain_name(self) -> str:
        """The label without unit and symbol: `Cylinder length`."""
        return " ".join(word for word in self.name.split(" ") if not _is_symbol(word)) or self.name

    @cached_property
    def dimension(self) -> str:
        """The key without its unit, as Tolerances and the report name a dimension."""
        stem, _, last = self.key.rpartition("_")
        return stem if self.unit and stem and find_unit(last, self.quantity) else self.key

    @cached_property
    def si_unit(self) -> Unit:
        """The unit the field is measured in."""
        unit = find_unit(self.unit, self.quantity)
        if unit is None:
            raise LookupError(f"{self.sheet}.{self.key} has no unit")
        return unit

    @property
    def is_number(self) -> bool:
        """Whether the field holds numbers."""
        return self.type in {"number", "integer"}

    @property
    def requirement(self) -> str:
        """What a cell must hold, in words: `a number in mm greater than 0`."""
        if len(self.choices) > _FEW:
            return "an entry of its list"
        if self.choices:
            return "one of " + ", ".join(self.choices)
        if not self.is_number:
            return "a text"
        words = "a whole number" if self.type == "integer" else "a number"
        if self.unit not in {"", "-"}:
            words += f" in {self.unit}"
        if self.minimum is not None:
            words += f" {'greater than' if self.exclusive_minimum else 'of at least'} {self.minimum:.15g}"
        if self.maximum is not None:
            words += f"{' and' if self.minimum is not None else ''} at most {self.maximum:.15g}"
        return words

    def as_dictionary(self) -> dict[str, Any]:
        """Return the entry of `flexlash schema --json`."""
        entry = asdict(self)
        entry["choices"] = list(self.choices)
        order = ("sheet", "key", "label", "unit", "type", "required", "minimum", "maximum")
        return {
            key: entry[key] for key in (*order, "choices", "default", "help", "exclusive_minimum", "group", "since")
        }


def _is_symbol(word: str) -> bool:
    """Whether a word of a label is its symbol, such as Δ or r_ci."""
    return len(word) == 1 or word.startswith("r_")
