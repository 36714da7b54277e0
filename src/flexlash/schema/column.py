"""The record of one field: what every sheet, message and heading derives from."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any, Literal, TypeAlias

from flexlash.schema.units import Unit, find_unit

__all__ = [
    "FACTOR",
    "FILLET",
    "LENGTH",
    "PERCENT",
    "POSITIVE",
    "RADIUS",
    "STRESS",
    "TORQUE",
    "Column",
    "ColumnRule",
    "Role",
]

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

_QUANTITIES = {"length": "a length", "angle": "an angle", "torque": "a torque"}
"""What numbers of a quantity are called, where that says more than their unit."""

_FIRST = ("sheet", "key", "label", "unit", "type", "required", "minimum", "maximum", "choices", "default", "help")


@dataclass(frozen=True, kw_only=True)
class ColumnRule:
    """What a cell of a column must hold, in words.

    `id` is `column|rule`, `code` that of the finding at a cell that breaks it; results, which keep theirs, have none.
    """

    id: str
    code: str
    words: str


@dataclass(frozen=True, kw_only=True)
class Column:
    """One field of one sheet; bounds are in the printed unit, `since` is the template version that brought it.

    `zero_is_blank` where a 0 says the same as a blank cell: a fillet of 0 is none. `grade_at` is the size at which a
    tolerance grade of a length is read: the length itself, the diameter of a radius, or none where no grade applies.
    A number outside its `usual` span, in the printed unit, is warned of. `also_called` are whole names of the column
    that engineers use in English, German, French and Italian, without spaces; a header of such a name is a question.
    Each row of the sheet has an entry here or in the column that is named as the one `instead`.
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
    usual: tuple[float, float] | None = None
    also_called: str = ""
    instead: str = ""

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

    def is_needed(self, present: Collection[str]) -> bool:
        """Whether a sheet that has the columns of these keys cannot do without this one."""
        return self.required or bool(self.instead and self.instead not in present)

    @cached_property
    def rules(self) -> dict[str, ColumnRule]:
        """The rules that each cell is held to, by name: required, minimum, maximum, choices."""
        rules = {
            "required": ("E201", "required" if self.required else ""),
            "minimum": ("E207", self._lower_bound),
            "maximum": ("E208", "" if self.maximum is None else f"at most {self.maximum:.15g}"),
            "choices": ("E209", self._list),
        }
        return {
            name: ColumnRule(id=f"{self.key}|{name}", code="" if self.role == "result" else code, words=words)
            for name, (code, words) in rules.items()
            if words
        }

    @property
    def _lower_bound(self) -> str:
        """The lower bound in words, an empty text where there is none."""
        if self.minimum is None:
            return ""
        return f"above {self.minimum:.15g}" if self.exclusive_minimum else f"of {self.minimum:.15g} or more"

    @property
    def _list(self) -> str:
        """The choices in words, an empty text where there are none."""
        if len(self.choices) > _FEW:
            return "a name from the list"
        return " or ".join(filter(None, (", ".join(self.choices[:-1]), *self.choices[-1:])))

    @property
    def unit_behind(self) -> str:
        """The unit as it stands behind a number: ` mm`; an empty text for a plain number."""
        return "" if self.unit in {"", "-"} else f" {self.unit}"

    @property
    def variant_key(self) -> str:
        """The key of the cell of Variants that its value comes from: its own, or that of the material."""
        return self.key if self.sheet == "Variants" else "material"

    @property
    def requirement(self) -> str:
        """What a cell must hold, in words: `a length in mm above 0`."""
        if self.choices:
            return self._list
        if not self.is_number:
            return "a name" if self.role == "identity" else "text"
        words = "a whole number" if self.type == "integer" else _QUANTITIES.get(self.quantity, "a number")
        return " ".join(filter(None, [f"{words} in{self.unit_behind}" if self.unit_behind else words, self._bounds]))

    @property
    def _bounds(self) -> str:
        """Both bounds in words: `from 30 to 90`."""
        bounds = [self.rules[name].words for name in ("minimum", "maximum") if name in self.rules]
        if len(bounds) > 1 and not self.exclusive_minimum:
            return f"from {self.minimum:.15g} to {self.maximum:.15g}"
        return " and ".join(bounds) if self.minimum is not None else "".join(f"of {words}" for words in bounds)

    def as_dictionary(self) -> dict[str, Any]:
        """Return the entry of `flexlash schema --json`: the fields that scripts rely on first."""
        entry = asdict(self) | {"rules": [asdict(rule) for rule in self.rules.values()]}
        entry = {key: list(value) if isinstance(value, tuple) else value for key, value in entry.items()}
        return {key: entry[key] for key in dict.fromkeys((*_FIRST, *entry))}


def _is_symbol(word: str) -> bool:
    """Whether a word of a label is its symbol, such as Δ or r_ci."""
    return (len(word) == 1 and word.isalpha()) or word.startswith("r_")
