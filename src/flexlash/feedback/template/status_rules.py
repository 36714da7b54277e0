"""What a row of an entry sheet may lack: conditions, each as a formula of Excel and as a function of the row.

The formulas stand in defined names whose references are relative to the row, so that each is written once for all rows.
What they come to is stored beside them, so that a viewer which does not calculate shows the right text.
"""

from __future__ import annotations

import operator
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from xlsxwriter.utility import quote_sheetname

from flexlash.reading.raw import ErrorCell
from flexlash.schema.column import Column
from flexlash.schema.entry_words import inner_name, wrong_number

__all__ = [
    "COMPLETE",
    "ERROR",
    "Known",
    "Row",
    "Rule",
    "Stage",
    "count_formula",
    "entry_number",
    "entry_text",
    "first_text",
    "given",
    "is_blank",
    "missing",
    "no_number",
    "not_in_list",
    "row_formula",
    "stage_names",
    "stage_text",
    "twice",
    "unknown",
    "unlisted",
]

COMPLETE = "complete"
ERROR = "a cell holds an error"

Row: TypeAlias = Mapping[str, Any]

Known: TypeAlias = Mapping[str, Counter[Any]]
"""How often each name, in small letters, stands in a range of the workbook, by the name of the range; what several
columns say together, as tuples by the keys of the columns with commas between them."""


@dataclass(frozen=True, kw_only=True)
class Rule:
    """A fault in words, its Excel condition, where `{key}` stands for the cell of a column, and the same of a row.

    `{key_block}` stands for all prepared cells of the column. `together` are columns whose entries it counts in all
    rows.
    """

    text: str
    excel: str
    holds: Callable[[Row, Known], bool]
    together: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Stage:
    """Rules that are looked at in their order, under the defined name of the formula that does so.

    `quicker` finds the text of the first that holds for a row in one go, where asking rule by rule takes long.
    """

    name: str
    rules: Sequence[Rule]
    quicker: Callable[[Row], str | None] | None = None

    def fault(self, row: Row, known: Known) -> str | None:
        """Return the text of the first rule that holds for a row, None where there is none."""
        if self.quicker:
            return self.quicker(row)
        return next((rule.text for rule in self.rules if rule.holds(row, known)), None)


def is_blank(value: Any) -> bool:
    """Whether a formula finds nothing in a cell."""
    return value is None or value == ""


def entry_text(row: Row, key: str) -> str:
    """Return a text as Excel compares it."""
    return str(row.get(key) or "").casefold()


def entry_number(row: Row, key: str) -> float:
    """Return a number, a blank cell as 0, as Excel compares it."""
    return float(row.get(key) or 0.0)


def given(row: Row, *keys: str) -> int:
    """Return how many of these cells are filled."""
    return sum(not is_blank(row.get(key)) for key in keys)


def count_formula(*keys: str) -> str:
    """Return the formula of how many of these cells are filled."""
    return f"({'+'.join(f'({{{key}}}<>{chr(34)}{chr(34)})' for key in keys)})"


def missing(column: Column) -> Rule:
    """Return the rule that a required cell is filled."""
    key = column.key
    return Rule(
        text=f"{inner_name(column)} missing", excel=f'{{{key}}}=""', holds=lambda row, _: is_blank(row.get(key))
    )


def unlisted(column: Column) -> Rule:
    """Return the rule that an entry is one of a column's list."""
    key, listed = column.key, ("", *column.choices)
    differs = ",".join(f'TRIM({{{key}}})<>"{word}"' for word in listed)
    return Rule(
        text=f"{inner_name(column)} is not in its list",
        excel=f"AND({differs})",
        holds=lambda row, _: entry_text(row, key).strip() not in listed,
    )


def not_in_list(column: Column, names: str) -> Rule:
    """Return the rule that an entry is one of a list that is too long for a formula: the range of that name."""
    key, listed = column.key, column.choices
    return Rule(
        text=f"{inner_name(column)} is not in its list",
        excel=f'AND({{{key}}}<>"",COUNTIF({names},TRIM({{{key}}}))=0)',
        holds=lambda row, _: not is_blank(row.get(key)) and entry_text(row, key).strip() not in listed,
    )


def unknown(key: str, text: str, names: str, *built_in: str) -> Rule:
    """Return the rule that a name stands in a range of the workbook, or is `built_in`."""
    others = "".join(f',{{{key}}}<>"{name}"' for name in built_in)
    return Rule(
        text=text,
        excel=f'AND({{{key}}}<>""{others},COUNTIF({names},{{{key}}})=0)',
        holds=lambda row, known: (
            not is_blank(row.get(key))
            and entry_text(row, key) not in built_in
            and not known[names][entry_text(row, key)]
        ),
    )


def twice(together: tuple[str, ...], text: str, excel: str = "") -> Rule:
    """Return the rule that what these columns say together stands in one row alone; rows that lack one are apart.

    `excel` is how it is counted where not by all prepared cells of the columns.
    """
    counts = ",".join(f"{{{key}_block}},{{{key}}}" for key in together)
    given = ",".join(f'{{{key}}}<>""' for key in together)

    def holds(row: Row, known: Known) -> bool:
        entries = tuple(entry_text(row, key) for key in together)
        return all(entries) and known[",".join(together)][entries] > 1

    return Rule(text=text, excel=excel or f"AND({given},COUNTIFS({counts})>1)", holds=holds, together=together)


def no_number(column: Column) -> Rule:
    """Return the rule that an entry is a number within the bounds of its column."""
    key, least, most = column.key, column.minimum, column.maximum
    is_low = operator.le if column.exclusive_minimum else operator.lt
    bounds = [] if least is None else [f"{{{key}}}{'<=' if column.exclusive_minimum else '<'}{least:.15g}"]
    bounds += [] if most is None else [f"{{{key}}}>{most:.15g}"]
    beyond = f"OR({','.join(bounds)})" if len(bounds) > 1 else bounds[0] if bounds else "0"

    def holds(row: Row, _: Known) -> bool:
        value = row.get(key)
        if isinstance(value, bool) or not isinstance(value, int | float):
            return not is_blank(value)
        return (least is not None and is_low(value, least)) or (most is not None and value > most)

    # LibreOffice takes TRUE for a number.
    excel = f'IF(AND(ISNUMBER({{{key}}}),NOT(ISLOGICAL({{{key}}}))),{beyond},{{{key}}}<>"")'
    return Rule(text=wrong_number(column), excel=excel, holds=holds)


def first_text(conditions: Mapping[str, str], otherwise: str = '""') -> str:
    """Return the formula for the first of some texts whose condition holds."""
    formula = otherwise
    for text, condition in reversed([*conditions.items()]):
        formula = f'IF({condition},"{text}",{formula})'
    return formula


def stage_names(sheet: str, stages: Sequence[Stage], letters: Mapping[str, str], block: range) -> dict[str, str]:
    """Return the formulas of a row's status by name: each stage, and before all, named by the first, their order.

    The columns stand under these letters, `block` are the numbers of their prepared rows. References are relative to
    the first row: a name means the row of the cell that uses it.
    """
    quoted = quote_sheetname(sheet)
    cells = {key: f"{quoted}!${letter}1" for key, letter in letters.items()}
    blocks = {
        f"{key}_block": f"{quoted}!${letter}${block.start}:${letter}${block.stop - 1}"
        for key, letter in letters.items()
    }
    first, *_, last = letters.values()
    names = {
        stage.name: f"={first_text({rule.text: rule.excel.format(**cells, **blocks) for rule in stage.rules})}"
        for stage in stages
    }
    status = f'"{COMPLETE}"'
    for name in reversed(names):
        status = f'IF({name}<>"",{name},{status})'
    before = {ERROR: f"SUMPRODUCT(--ISERROR({quoted}!${first}1:${last}1))>0"}
    return names | {_status_name(stages): f"={first_text(before, status)}"}


def row_formula(stages: Sequence[Stage], letters: Mapping[str, str], row: int) -> str:
    """Return the formula in the status cell of a row; a blank row has no status."""
    first, *_, last = letters.values()
    return f'=IF(COUNTA(${first}{row}:${last}{row})=0,"",{_status_name(stages)})'


def _status_name(stages: Sequence[Stage]) -> str:
    """Return the name of the formula of the whole status."""
    return f"{stages[0].name.rpartition('_')[0]}_status"


def stage_text(stages: Iterable[Stage], row: Row, known: Known) -> str:
    """Return what the status formula shows for a filled row."""
    if any(isinstance(value, ErrorCell) for value in row.values()):
        return ERROR
    return next((text for stage in stages if (text := stage.fault(row, known))), COMPLETE)
