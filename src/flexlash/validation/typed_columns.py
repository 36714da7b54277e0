"""A raw sheet → a table: typed columns in a frame, each row with the row number that its user sees."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import polars as pl

from flexlash.reading.raw import Percentage, RawSheet, RawValue, Unstored
from flexlash.schema.cell_addresses import CellAddress, column_letters
from flexlash.schema.columns import DIMENSIONS, Column, columns_of, naming_column
from flexlash.schema.decision_columns import source_unit
from flexlash.schema.header_names import BLANK
from flexlash.schema.units import ARCMIN, find_unit
from flexlash.validation.cell_values import Fault, as_number, as_text, plain_number
from flexlash.validation.headers import find_headings, plain
from flexlash.validation.ledger import Ledger
from flexlash.validation.number_texts import Measure
from flexlash.validation.rows_without_entries import NoEntries, NoEntry
from flexlash.validation.units_row import take_units_row
from flexlash.validation.validated import Heading, Table

__all__ = ["entries_of", "longest_text", "surplus_of", "tabulate"]

_MEANT_BESIDE = "setting"
"""First column of Settings, where the template explains each setting in a column without a header."""

_MILLIMETRE = 1e-3
_JUDGED_LATER = ("Settings", "value")
"""The cell whose meaning depends on the cell beside it."""

_IN_ANOTHER_UNIT = {
    "Tolerances": frozenset({"lower_deviation", "upper_deviation", "mean_shift", "standard_deviation"}),
    "Other sources": frozenset({"value_arcmin", "lower_deviation", "upper_deviation"}),
    "Levers": frozenset({"lowest", "highest", "step"}),
    "Sweep": frozenset({"from", "to", "step", "second_from", "second_to", "second_step"}),
}
"""Columns whose numbers are in the unit that other cells of the row say."""


def tabulate(sheet: RawSheet, schema: str, ledger: Ledger) -> Table | None:
    """Return the typed table of an entry sheet, or None (with a finding) when it has no header row."""
    heading = find_headings(sheet, schema, ledger)
    if heading is None:
        return None
    columns = columns_of(schema)
    units = take_units_row(sheet, heading, schema, ledger)
    table = Table(
        sheet=sheet.name,
        schema=schema,
        heading=heading,
        frame=pl.DataFrame(),
        numbers_are_texts=sheet.numbers_are_texts,
        whole=sheet.whole,
    )
    read = {index: columns[key] for key, index in heading.columns.items()}
    exact = {index for index, column in read.items() if column.is_number and heading.factors[column.key] == 1}
    records: list[dict[str, Any]] = []
    first_key = naming_column(schema).key
    for number, cells, bare in entries_of(table, sheet, units, ledger):
        record: dict[str, Any] = {"row": number}
        if surplus := surplus_of(sheet, heading, number):
            _report_surplus(table, number, surplus, sheet, ledger)
        if bare:
            table.faulty.update((number, key) for key in columns)
            where = {"sheet": sheet.name, "cell": table.address(number, first_key), "column": first_key}
            ledger.add(bare.code, rows=[number], **where, **bare.facts)
        for index, value in cells.items():
            if surplus and index != heading.columns.get(first_key):
                continue
            if (column := read.get(index)) is not None:
                plainly = plain_number(value, from_text=table.numbers_are_texts) if index in exact else None
                record[column.key] = (
                    _typed(_Cell(table=table, column=column, row=number, value=value, beside=cells), ledger)
                    if plainly is None
                    else plainly
                )
            elif index in heading.doubtful:
                _spoil(ledger, schema, number)
                table.faulty.add((number, heading.doubtful[index]))
        records.append(record)
        table.cells[number] = cells
    types = {key: pl.Float64 if column.is_number else pl.String for key, column in columns.items()}
    return replace(table, frame=pl.DataFrame(records, schema={"row": pl.Int64, **types}, orient="row"))


def entries_of(
    table: Table, sheet: RawSheet, units: int | None, ledger: Ledger
) -> Iterator[tuple[int, dict[int, RawValue], NoEntry | None]]:
    """Yield the rows of a table but that of units, each with why it is no entry after all; tell what is none at all."""
    no_entries, last = NoEntries(table.schema, table.heading), table.heading.row
    for number, cells in _data_rows(sheet, table.heading, naming_column(table.schema).key, ledger):
        if sheet.whole:
            last = max(sheet.whole.above.get(number, number - 1), units or 0, table.heading.row)
        none = no_entries.of(cells, apart=number > last + 1) if number != units else None
        if none and none.code[0] == "W":
            ledger.add(none.code, sheet=sheet.name, cell=CellAddress(row=number, column=none.column), **none.facts)
            continue
        last = number
        if number != units:
            yield number, cells, none


def surplus_of(sheet: RawSheet, heading: Heading, row: int) -> list[int]:
    """Return the columns of a delimited text's row that lie beyond the last header, blank ones where they may count."""
    if sheet.dialect is None:
        return []
    last = max(sheet.rows[heading.row])
    beyond = [index for index, value in sheet.rows[row].items() if index > last and _as_shown(value)]
    return beyond or ([last + 1] if row in sheet.dialect.longer else [])


def _report_surplus(table: Table, row: int, surplus: list[int], sheet: RawSheet, ledger: Ledger) -> None:
    """Record that a row has more cells than headers, so that nothing tells which value belongs to which."""
    table.faulty.update((row, key) for key in columns_of(table.schema))
    comma = sheet.dialect is not None and sheet.dialect.delimiter == ","
    ledger.add(
        "E215",
        sheet=table.sheet,
        cell=CellAddress(row=row, column=surplus[0]),
        value=_as_shown(sheet.rows[row].get(surplus[0], "")),
        detail="an unquoted decimal comma makes two cells of one" if comma else "a separator stands once too often",
        rows=[row] if table.schema == "Variants" else [],
    )


def _spoil(ledger: Ledger, schema: str, row: int) -> None:
    """Mark what a value under an unreadable header spoils."""
    if schema == "Variants":
        ledger.rows.add(row)
    else:
        ledger.everything = True


def _data_rows(
    sheet: RawSheet, heading: Heading, first_key: str, ledger: Ledger
) -> Iterator[tuple[int, dict[int, RawValue]]]:
    """Yield the rows below the header that hold data; a lone cell elsewhere than in the first column is none."""
    named = {*heading.columns.values(), *heading.extra, *heading.doubtful}
    ours = {*heading.columns.values(), *heading.doubtful}
    first = heading.columns.get(first_key)
    nameless: dict[int, int] = {}
    last = heading.row
    for number, every in sheet.rows.items():
        if number <= heading.row:
            continue
        cells = {
            index: value
            for index, value in every.items()
            if index not in heading.ignored
            and not (isinstance(value, str) and not value.strip(BLANK))
            and not (isinstance(value, Unstored) and index not in ours)
        }
        # Held once with the sheet where nothing is left out.
        entered = every if every.keys() <= named and len(cells) == len(every) else _only(cells, named)
        # Of parts one dimension may be all that was measured; below an empty row it is a mean without a name.
        is_part = first_key == "sample" and number == last + 1 and bool(entered)
        if len(entered) > 1 or first in entered or is_part:
            last = number
            for index in cells.keys() - named - {*surplus_of(sheet, heading, number)}:
                nameless.setdefault(index, number)
            yield number, entered
        elif cells:
            index, value = next(iter((entered or cells).items()))
            address = CellAddress(row=number, column=index)
            ledger.add("W408", sheet=sheet.name, cell=address, value=_as_shown(value))
    if sheet.whole:
        nameless = {index: number for index, number in sheet.whole.nameless.items() if number in sheet.rows}
    for index, number in sorted(nameless.items()) if first_key != _MEANT_BESIDE else ():
        address = CellAddress(row=number, column=index)
        ledger.add("I509", sheet=sheet.name, cell=address, value=column_letters(index))


def _only(cells: Mapping[int, RawValue], columns: Collection[int]) -> dict[int, RawValue]:
    return {index: value for index, value in cells.items() if index in columns}


@dataclass(frozen=True, kw_only=True)
class _Cell:
    """A raw cell with its row and column; `beside` are the raw cells of its row."""

    table: Table
    column: Column
    row: int
    value: RawValue
    beside: Mapping[int, RawValue]

    @property
    def facts(self) -> dict[str, Any]:
        """What a finding says of the cell."""
        column, table = self.column, self.table
        address = table.address(self.row, column.key)
        return {"sheet": table.sheet, "cell": address, "column": column.key, "name": column.name}

    @property
    def measure(self) -> Measure:
        """What numbers of the cell stand for, by its header or, in the deviation unit, by the cells beside it."""
        schema, key = self.column.sheet, self.column.key
        if key not in _IN_ANOTHER_UNIT.get(schema, ()):
            return Measure.of(self.column, self.table.heading.factors[key])
        if schema == "Other sources":
            is_angle = source_unit(self._text_of("enter_as")) == "arcmin"
            return Measure(quantity="angle", si=ARCMIN) if is_angle else Measure(quantity="length", si=_MILLIMETRE)
        if schema in {"Levers", "Sweep"}:
            size = DIMENSIONS.get(self._text_of("second_dimension" if key.startswith("second") else "dimension"))
            return Measure(quantity=size.quantity, si=size.si_unit.si) if size else Measure(quantity="", si=1.0)
        return self._measure_of_deviation

    def _text_of(self, key: str) -> str:
        """Return what stands in another cell of the row, in small letters."""
        return str(self.beside.get(self.table.heading.columns.get(key, 0), "")).strip().casefold()

    @property
    def _measure_of_deviation(self) -> Measure:
        """What a number of a process or a drawing stands for, by deviation unit and dimension."""
        unit = str(self.beside.get(self.table.heading.columns.get("deviation_unit", 0), "")).strip()
        if unit == "%":
            return Measure(quantity="ratio", si=0.01)
        column = DIMENSIONS.get(self._text_of("dimension"))
        if column is None or column.quantity == "ratio":
            return Measure(quantity="", si=1.0, unit_is_open=not unit)
        measured_in = find_unit(unit, column.quantity) if unit else column.si_unit
        if measured_in is None:
            return Measure(quantity="", si=1.0)
        return Measure(quantity=column.quantity, si=measured_in.si, unit_is_open=not unit)


def _typed(cell: _Cell, ledger: Ledger) -> str | float | None:
    """Return a cell's typed value; None, with a finding, when it has none."""
    column, value = cell.column, cell.value
    if (column.sheet, column.key) == _JUDGED_LATER:
        return _as_shown(value)
    typed = (
        as_number(value, column, from_text=cell.table.numbers_are_texts, measure=cell.measure)
        if column.is_number
        else as_text(value, longest_text(column))
    )
    if isinstance(typed, float):
        factor = cell.table.heading.factors[column.key]
        typed = typed if factor == 1 else _on_bound(column, typed * factor)
        typed = typed if math.isfinite(typed) else Fault(code="E212", value=value)
    if isinstance(typed, Fault):
        cell.table.faulty.add((cell.row, column.key))
        rows = [cell.row] if cell.table.schema == "Variants" else []
        meant = {"suggestion": typed.suggestion, "certain_value": typed.certain_value}
        facts = {**meant, "requirement": column.requirement, **typed.facts, **cell.facts}
        ledger.add(typed.code, value=typed.value, rows=rows, **facts)
        return None
    if isinstance(typed, float):
        if isinstance(value, Percentage) and typed != value:
            ledger.add("I514", value=value.shown, detail=f"{typed:.10g}", **cell.facts)
        return typed
    entry = _choice(column, typed)
    if entry != typed or (isinstance(value, str) and typed != value):
        ledger.add("I504", value=value, suggestion=entry, certain_value=entry, **cell.facts)
    return entry or None


def _on_bound(column: Column, value: float) -> float:
    """Return the bound of a column that a converted value misses by its last digits only, else the value."""
    for bound in (column.minimum, column.maximum):
        if bound is not None and math.isclose(value, bound, rel_tol=1e-12):
            return float(bound)
    return value


def longest_text(column: Column) -> int:
    """Return how many characters a text may have: names are short, remarks are not."""
    return 1000 if column.role == "remark" else 200


def _choice(column: Column, text: str) -> str:
    """Return the list entry that a text names in other case or spacing, or the text itself."""
    if text in column.choices:
        return text
    for choice in column.choices:
        if plain(choice) == plain(text):
            return choice
    return text


def _as_shown(value: RawValue) -> str:
    """Return a cell as a message shows it."""
    text = as_text(value, longest=1000)
    return str(text.value) if isinstance(text, Fault) else text
