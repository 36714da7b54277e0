"""What the template's row status says: the first fault of a row, as formulas of Excel and as they come to.

The formulas stand in defined names whose references are relative to the row, so that each is written once for all rows.
What they come to is stored beside them, so that a viewer which does not calculate shows the right text.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from flexlash.feedback.template.cell_operands import CellRow
from flexlash.reading.raw import ErrorCell
from flexlash.schema.columns import DIMENSIONS, VARIANTS, Column
from flexlash.schema.entry_words import inner_name, wrong_number
from flexlash.schema.part_row import NumberRow, first_broken
from flexlash.schema.part_rules import PART_RULES

__all__ = ["COMPLETE", "Names", "status_formula", "status_names", "status_text"]

COMPLETE = "complete"

Row = Mapping[str, Any]

_ENTRIES, _PART, _STATUS = "fl_row_entries", "fl_row_part", "fl_row_status"
_ERRORS = [rule for rule in PART_RULES if rule.is_error]
_ERROR = "a cell holds an error"
_DIMENSION_KEYS = {name: column.key for name, column in DIMENSIONS.items() if column.sheet == "Variants"}


@dataclass(frozen=True, kw_only=True)
class Names:
    """The names, in small letters, that a row's entries are looked up in; of the variants how often each stands."""

    variants: Mapping[str, int]
    materials: Collection[str]
    classes: Collection[str]


@dataclass(frozen=True, kw_only=True)
class _Rule:
    """A fault of an entry in words, its Excel condition on the cell `{0}`, and the same condition on a row."""

    key: str
    text: str
    excel: str
    holds: Callable[[Row, Names], bool]


def _is_blank(value: Any) -> bool:
    return value is None or value == ""


def _text(row: Row, key: str) -> str:
    """Return a text as Excel compares it."""
    return str(row.get(key) or "").casefold()


def _missing(column: Column) -> _Rule:
    """Return the rule that a required cell is filled."""
    text, key = f"{column.plain_name.lower()} missing", column.key
    return _Rule(key=key, text=text, excel='{0}=""', holds=lambda row, _: _is_blank(row.get(key)))


def _unlisted(column: Column) -> _Rule:
    """Return the rule that an entry is one of a column's list."""
    key, listed = column.key, ("", *column.choices)
    differs = ",".join(f'TRIM({{0}})<>"{word}"' for word in listed)
    return _Rule(
        key=key,
        text=f"{inner_name(column)} is not one of its list",
        excel=f"AND({differs})",
        holds=lambda row, _: _text(row, key).strip() not in listed,
    )


def _unknown(key: str, text: str, names: str, known: Callable[[Names], Collection[str]]) -> _Rule:
    """Return the rule that a name stands in a list: a range of the template, and what is known of it."""
    return _Rule(
        key=key,
        text=text,
        excel=f'AND({{0}}<>"",COUNTIF({names},{{0}})=0)',
        holds=lambda row, names: not _is_blank(row.get(key)) and _text(row, key) not in known(names),
    )


def _no_number(column: Column) -> _Rule:
    """Return the rule that an entry is a number within the bounds of its column."""
    key, least, most = column.key, column.minimum or 0.0, column.maximum
    is_low = operator.le if column.exclusive_minimum else operator.lt
    low = f"{{0}}{'<=' if column.exclusive_minimum else '<'}{least:.15g}"
    beyond = low if most is None else f"OR({low},{{0}}>{most:.15g})"

    def holds(row: Row, _: Names) -> bool:
        value = row.get(key)
        if isinstance(value, bool) or not isinstance(value, int | float):
            return not _is_blank(value)
        return is_low(value, least) or (most is not None and value > most)

    # LibreOffice takes TRUE for a number.
    excel = f'IF(AND(ISNUMBER({{0}}),NOT(ISLOGICAL({{0}}))),{beyond},{{0}}<>"")'
    return _Rule(key=key, text=wrong_number(column), excel=excel, holds=holds)


_ENTRY_RULES = (
    *(_missing(column) for column in VARIANTS if column.required),
    *(_unlisted(column) for column in VARIANTS if column.choices),
    _unknown("material", "material not in Materials", "fl_materials", lambda names: names.materials),
    *(_no_number(column) for column in VARIANTS if column.is_number),
)
_LAST_RULES = (
    _unknown("tolerance_class", "tolerance class not in Tolerances", "fl_tolerance_rows", lambda names: names.classes),
    _Rule(
        key="variant",
        text="variant used twice",
        excel="COUNTIF(fl_variants,{0})>1",
        holds=lambda row, names: names.variants[_text(row, "variant")] > 1,
    ),
)


def status_names(letters: Mapping[str, str]) -> dict[str, str]:
    """Return the formulas of a row's status by name, the columns standing under these letters.

    References are relative to the first row: a name means the row of the cell that uses it.
    """
    cells = {key: f"Variants!${letter}1" for key, letter in letters.items()}
    first, *_, last = letters.values()
    row = CellRow(cells)
    part = {rule.words: str(row.all_of(*rule.broken(row))) for rule in _ERRORS}
    before = {_ERROR: f"SUMPRODUCT(--ISERROR(Variants!${first}1:${last}1))>0"}
    status = _first(_conditions(_LAST_RULES, cells), f'"{COMPLETE}"')
    status = f'IF({_ENTRIES}<>"",{_ENTRIES},IF({_PART}<>"",{_PART},{status}))'
    return {
        _ENTRIES: f"={_first(_conditions(_ENTRY_RULES, cells))}",
        _PART: f"={_first(part)}",
        _STATUS: f"={_first(before, status)}",
    }


def _conditions(rules: Iterable[_Rule], cells: Mapping[str, str]) -> dict[str, str]:
    return {rule.text: rule.excel.format(cells[rule.key]) for rule in rules}


def _first(faults: dict[str, str], otherwise: str = '""') -> str:
    """Return the formula for the first of some texts whose condition holds."""
    formula = otherwise
    for text, condition in reversed(faults.items()):
        formula = f'IF({condition},"{text}",{formula})'
    return formula


def status_formula(row: int, letters: Mapping[str, str]) -> str:
    """Return the formula in the status cell of a row; a blank row has no status."""
    first, *_, last = letters.values()
    return f'=IF(COUNTA(${first}{row}:${last}{row})=0,"",{_STATUS})'


def status_text(row: Row, names: Names) -> str:
    """Return what the status formula shows for a filled row."""
    if any(isinstance(value, ErrorCell) for value in row.values()):
        return _ERROR
    return _fault(_ENTRY_RULES, row, names) or _part_fault(row) or _fault(_LAST_RULES, row, names) or COMPLETE


def _fault(rules: Iterable[_Rule], row: Row, names: Names) -> str | None:
    return next((rule.text for rule in rules if rule.holds(row, names)), None)


def _part_fault(row: Row) -> str | None:
    """Return which rule of the book a row of sound entries breaks first."""
    entries = {name: float(row[key]) for name, key in _DIMENSION_KEYS.items() if not _is_blank(row.get(key))}
    rule = first_broken(_ERRORS, NumberRow(type=_text(row, "flexspline_type").strip() or "cup", entries=entries))
    return rule.words if rule else None
