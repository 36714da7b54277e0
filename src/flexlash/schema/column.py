"""The record of one field: what every sheet, message and heading derives from."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any, Literal, TypeAlias

from flexlash.schema.units import Unit, find_unit

__all__ = ["FACTOR", "FILLET", "LENGTH", "PERCENT", "POSITIVE", "RADIUS", "STRESS", "TORQUE", "Column", "Role"]

Role: TypeAlias = Literal["identity", "dimension", "requirement", "remark", "result"]
"""What a field is good for.

- identity: says which row it is, or which row of another sheet or which kind it takes;
- dimension: a number that the mechanics may take and that may have a tolerance;
- requirement: what is asked of a part, a material or a run; it is exact and no dimension of the part;
- remark: a text that is carried to the report;
- result: what flexlash says.
"""

POSITIVE: dict[str, Any] = {"minimum": 0, "exclusive_minimum": True}
LENGTH = {"quantity": "length", **POSITIVE}
RADIUS = {**LENGTH, "grade_at": "diameter"}
FILLET = {"quantity": "length", "minimum": 0, "zero_is_blank": True, "grade_at": "none"}
TORQUE = {"quantity": "torque", **POSITIVE}
STRESS = {"quantity": "stress", **POSITIVE}
FACTOR = {"quantity": "ratio", "unit": "-", "minimum": 0.1, "maximum": 10, "default": 1}
PERCENT = {"quantity": "ratio", "unit": "%", **POSITIVE}
"""Quantity and bounds that several fields share."""

_FEW = 8
"""Most choices that a sentence lists."""

_FIRST = ("sheet", "key", "label", "unit", "type", "required", "minimum", "maximum", "choices", "default", "help")


@dataclass(frozen=True, kw_only=True)
class Column:
    """One field of one sheet; bounds are in the printed unit, `since` is the template version that brought it.

    `zero_is_blank` where a 0 says the same as a blank cell: a fillet of 0 is none. `grade_at` is the size at which a
    tolerance grade of a length is read: the length itself, the diameter of a radius, or none where no grade applies.
    """

    sheet: str
    role: Role
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
    zero_is_blank: bool = False
    grade_at: Literal["length", "diameter", "none"] = "length"

    @classmethod
    def entry(cls, sheet: str, role: Role, key: str, label: str, text: str, **rest: Any) -> Column:
        """Return a field that is entered; a unit at the end of its label is its unit."""
        unit = label.rpartition("[")[2].rstrip("]") if "[" in label else rest.pop("unit", "")
        return cls(sheet=sheet, role=role, key=key, label=label, help=text, unit=unit, **rest)

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
        """The unit the field is measured in; that of a ratio for a number without unit."""
        unit = find_unit(self.unit, self.quantity or "ratio") if self.is_number else None
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
        """Return the entry of `flexlash schema --json`: the fields that scripts rely on first."""
        entry = asdict(self) | {"choices": list(self.choices)}
        return {key: entry[key] for key in dict.fromkeys((*_FIRST, *entry))}


def _is_symbol(word: str) -> bool:
    """Whether a word of a label is its symbol, such as Δ or r_ci."""
    return len(word) == 1 or word.startswith("r_")
