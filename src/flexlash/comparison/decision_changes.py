"""What differs between two files' sheets Other sources, Levers and Sweep, row by row, and whom it concerns."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from flexlash.comparison.changed_value import Change, equal
from flexlash.comparison.sides import Name, Side
from flexlash.schema.column import Column
from flexlash.schema.columns import DIMENSIONS, ENTRY_SHEETS
from flexlash.schema.decision_columns import MATERIAL, source_unit
from flexlash.schema.entry_words import dimension_title
from flexlash.schema.findings import shown
from flexlash.schema.spellings import plain
from flexlash.validation.decision_sheets import DECISION_SHEETS
from flexlash.validation.validated import Table

__all__ = ["DecisionChange", "decision_changes"]

_NAMED_BY = {
    "Other sources": ("source",),
    "Levers": ("dimension",),
    "Sweep": ("variant", "dimension", "second_dimension"),
}
_ROW = "row"
"""Key of the change of a row that only one of the files has."""


@dataclass(frozen=True, kw_only=True)
class DecisionChange:
    """A change of a row, and the variant or the dimension that it is about; empty where it is about all of them."""

    change: Change
    variant: str = ""
    dimension: str = ""

    def concerns(self, name: Name, dimensions: frozenset[str]) -> bool:
        """Whether it concerns a variant of this name that has these dimensions of its own."""
        if self.variant:
            return plain(name.text) == self.variant
        return not self.dimension or self.dimension in dimensions


def decision_changes(old: Side, new: Side) -> list[DecisionChange]:
    """Return what differs between the three sheets of two files; the order of their rows says nothing."""
    found = []
    for sheet in DECISION_SHEETS:
        before, after = (_rows(sheet, side) for side in (old, new))
        for key in dict.fromkeys([*before, *after]):
            rows = before.get(key), after.get(key)
            filled = rows[1] or rows[0] or {}
            named = filled.get("variant") if sheet == "Sweep" else None
            dimension = filled.get("dimension") if sheet == "Levers" else None
            found += [
                DecisionChange(
                    change=change,
                    variant=plain(named) if isinstance(named, str) else "",
                    dimension=dimension if isinstance(dimension, str) and dimension != MATERIAL else "",
                )
                for change in _changes(sheet, *rows)
            ]
    return found


def _rows(sheet: str, side: Side) -> dict[tuple[Any, ...], dict[str, Any]]:
    """Return the rows of a sheet by what names them, and by their turn among those of one name."""
    table = side.validated.decision_tables.get(sheet)
    seen: Counter[tuple[str, ...]] = Counter()
    rows = {}
    for record in table.frame.iter_rows(named=True) if table else ():
        entered = _entered(record, sheet, table)
        name = tuple(plain(str(entered[key] or "")) for key in _NAMED_BY[sheet])
        seen[name] += 1
        rows[*name, seen[name]] = entered
    return rows


def _entered(record: Mapping[str, Any], sheet: str, table: Table | None) -> dict[str, Any]:
    """Return a row as it is compared: blank cells with their default, faulty ones as entered."""
    entered = {}
    for column in ENTRY_SHEETS[sheet]:
        value = record[column.key]
        if table and (record["row"], column.key) in table.faulty:
            value = shown(table.entered(record["row"], column.key))
        entered[column.key] = column.default if value is None else value
    return entered


def _changes(sheet: str, old: Mapping[str, Any] | None, new: Mapping[str, Any] | None) -> Iterator[Change]:
    """Yield what differs between two rows of one name, of which one may not be there."""
    row = new or old or {}
    owner = _owner(sheet, row)
    if old is None or new is None:
        words = [None if one is None else _words(sheet, one) for one in (old, new)]
        yield Change(sheet=sheet, owner=owner, key=_ROW, label="Row", old=words[0], new=words[1])
        return
    for column in ENTRY_SHEETS[sheet]:
        pair = old[column.key], new[column.key]
        if column.key not in _NAMED_BY[sheet] and not equal(*pair):
            units = _unit(sheet, column, old), _unit(sheet, column, new)
            same = units[0] == units[1]
            values = pair if same else tuple(_shown(value, unit) for value, unit in zip(pair, units, strict=True))
            unit = units[1] if same else ""
            yield Change(
                sheet=sheet, owner=owner, key=column.key, label=column.name, unit=unit, old=values[0], new=values[1]
            )


def _owner(sheet: str, row: Mapping[str, Any]) -> str:
    """Return what a row is about, in words: `Cylinder length over Wall thickness of case 3`."""
    if sheet == "Other sources":
        return str(row["source"] or "")
    named = [_title(row[key]) for key in ("dimension", "second_dimension") if row.get(key)]
    owner = " over ".join(named)
    return f"{owner} of {row['variant'] or 'every variant'}" if sheet == "Sweep" else owner


def _title(entry: Any) -> str:
    """Return a dimension as a line begins with it, another entry as it stands."""
    return dimension_title(entry) if entry in DIMENSIONS else str(entry)


def _words(sheet: str, row: Mapping[str, Any]) -> str:
    """Return what a row says beside its name: `Value 20 arcmin, Side input, Ratio 100`."""
    told = [
        f"{column.name} {_shown(row[column.key], _unit(sheet, column, row))}"
        for column in ENTRY_SHEETS[sheet]
        if column.key not in _NAMED_BY[sheet] and row[column.key] not in {None, column.default}
    ]
    return ", ".join(told) or "there"


def _shown(value: Any, unit: str) -> str | None:
    """Return an entry with its unit."""
    if isinstance(value, float):
        return f"{value:.10g}{f' {unit}' if unit else ''}"
    return None if value is None else str(value)


def _unit(sheet: str, column: Column, row: Mapping[str, Any]) -> str:
    """Return the unit of a cell: its column's, or the one that another cell of the row says."""
    if column.unit or not column.is_number:
        return column.unit
    if sheet == "Other sources":
        is_play = column.key in {"value_arcmin", "lower_deviation", "upper_deviation"}
        return source_unit(row["enter_as"]) if is_play else ""
    if sheet == "Levers" and column.key not in {"lowest", "highest", "step"}:
        return ""
    of = DIMENSIONS.get(row["second_dimension" if column.key.startswith("second") else "dimension"] or "")
    return of.unit.replace("-", "") if of else ""
