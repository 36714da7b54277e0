"""Header cells → columns of the schema: by label or key, in any order, with the unit in brackets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from flexlash.reading.raw import ErrorCell, RawSheet, RawValue, Unstored
from flexlash.schema.cell_addresses import CellAddress, column_letters
from flexlash.schema.columns import Column, columns_of
from flexlash.schema.findings import shown
from flexlash.schema.header_names import (
    BLANK,
    LAST_HEADER_ROW,
    called_names,
    columns_named,
    known_names,
    name_and_unit,
)
from flexlash.schema.spellings import closest, misspelt, plain
from flexlash.schema.units import Unit, find_unit
from flexlash.validation.ledger import Ledger
from flexlash.validation.likely_headers import likely_headers
from flexlash.validation.other_headers import radius_of_diameter, tolerance_columns
from flexlash.validation.validated import Heading

__all__ = ["STATUS_HEADER", "closest", "count_headings", "find_headings", "known_headings", "plain"]

STATUS_HEADER = "Row status"
"""Header of the template's own formula column, which is never data."""

_OF_TOLERANCES = frozenset({
    "tolerance_class", "lower_deviation", "upper_deviation", "deviation_unit", "limits_sigma",
    "mean_shift", "standard_deviation", "cp", "cpk",
})  # fmt: skip
"""Columns of the template whose names speak of tolerances or of a process themselves."""

_OF_THE_ROW = {
    "Tolerances": "the unit that Deviation unit names",
    "Other sources": "the unit that Enter as names",
    "Levers": "the unit of the row's dimension in Variants",
    "Sweep": "the unit of the row's dimension in Variants",
}
"""Unit of the numbers of a sheet whose columns name none, since each row has its own."""


def _as_header(cell: RawValue) -> str:
    """Return a header cell as a text, whatever it holds."""
    if isinstance(cell, ErrorCell):
        return cell.text
    if isinstance(cell, Unstored):
        return "(formula without a result)"
    return cell if isinstance(cell, str) else shown(cell)


def _filled(sheet: RawSheet, header: int) -> set[int]:
    """Return the columns that hold anything below the header row."""
    if sheet.whole:
        return {*sheet.whole.filled}
    return {
        index
        for row, cells in sheet.rows.items()
        if row > header
        for index, value in cells.items()
        if not (isinstance(value, str) and not value.strip(BLANK))
    }


class _Unknown(NamedTuple):
    """The columns that an unknown header may mean, or else what of the scatter it seems to tell."""

    keys: Sequence[str]
    scatter: str = ""


def find_headings(sheet: RawSheet, schema: str, ledger: Ledger) -> Heading | None:
    """Return the columns of a sheet, or None (with a finding) when it has no header row."""
    return _Recogniser(sheet, schema, ledger).recognise()


def count_headings(sheet: RawSheet, schema: str) -> int:
    """Return how many headers of a schema stand in one of a sheet's first rows."""
    return len(known_headings(sheet, schema))


def known_headings(sheet: RawSheet, schema: str) -> set[str]:
    """Return the keys of a schema whose headers stand in that of a sheet's first rows which has most of them."""
    return max(_Recogniser(sheet, schema, Ledger("")).keys_by_row().values(), key=len, default=set())


class _Recogniser:
    """Recognises the header row of one sheet."""

    def __init__(self, sheet: RawSheet, schema: str, ledger: Ledger) -> None:
        self.sheet = sheet
        self.ledger = ledger
        self.columns = columns_of(schema)
        self.spellings = known_names(self.columns)
        self._filled: set[int] = set()

    def recognise(self) -> Heading | None:
        """Return the headings of the row, within the first fifteen, that has most of them."""
        best = self._header_row(self.known_by_row()) or self._header_row(self._named_by_row())
        if not best:
            self.ledger.add("E109", sheet=self.sheet.name, cell=CellAddress(row=1, column=1))
            self.ledger.everything = True
            return None
        heading = Heading(row=best)
        headers = {index: _as_header(cell) for index, cell in self.sheet.rows[best].items()}
        heading.ignored.update(index for index, header in headers.items() if plain(header) == plain(STATUS_HEADER))
        headers = {index: text for index, text in headers.items() if text.strip() and index not in heading.ignored}
        self._filled = _filled(self.sheet, best)
        unknown = self._unknown(heading, headers)
        for index, header in headers.items():
            self._take_header(heading, index, header, unknown.get(index))
        self._require(heading, max(self.sheet.rows[best]) + 1)
        return heading

    def _header_row(self, counts: Mapping[int, int]) -> int:
        """Return the row that names most columns, 0 where none names enough of them."""
        best = max(counts, key=lambda number: counts[number], default=0)
        return best if best and counts[best] >= min(2, len(self.columns)) else 0

    def _named_by_row(self) -> dict[int, int]:
        """Return how many columns each of the first rows names, also in other words, of which each is a question."""
        names = called_names(self.columns) | self.spellings
        top = {number: cells for number, cells in self.sheet.rows.items() if number <= LAST_HEADER_ROW}
        return {number: len({*columns_named(cells, names).values()}) for number, cells in top.items()}

    def known_by_row(self) -> dict[int, int]:
        """Return how many columns each of the first rows names; a header that stands there twice counts once."""
        return {number: len(keys) for number, keys in self.keys_by_row().items()}

    def keys_by_row(self) -> dict[int, set[str]]:
        """Return which columns each of the first rows names."""
        rows = {number: cells for number, cells in self.sheet.rows.items() if number <= LAST_HEADER_ROW}
        return {
            number: {key for cell in cells.values() if (key := self._known(cell))} for number, cells in rows.items()
        }

    def _known(self, cell: RawValue) -> str | None:
        """Return the column that a cell names as its header, None for another."""
        return self.spellings.get(plain(name_and_unit(cell)[0])) if isinstance(cell, str) else None

    def _require(self, heading: Heading, next_index: int) -> None:
        """Tell which required columns are missing, at the cell where they could be added."""
        for key, column in self.columns.items():
            if key in heading.columns or not column.is_needed(heading.columns.keys() | {*heading.doubtful.values()}):
                continue
            self.ledger.everything = True
            if key not in heading.doubtful.values():
                address = CellAddress(row=heading.row, column=next_index)
                facts: dict[str, Any] = {"column": key, "name": column.name, "label": column.label}
                self.ledger.add("E111", sheet=self.sheet.name, cell=address, **facts)

    def _unknown(self, heading: Heading, headers: Mapping[int, str]) -> dict[int, _Unknown]:
        """Return what each unknown header may mean."""
        split = {index: name_and_unit(header) for index, header in headers.items()}
        present = {self.spellings[plain(name)] for name, _ in split.values() if plain(name) in self.spellings}
        unknown = {index: header for index, header in split.items() if plain(header[0]) not in self.spellings}
        is_variants = "mean_radius_mm" in self.columns
        diameters = {index: radius_of_diameter(name, present) for index, (name, _) in unknown.items() if is_variants}
        scatter = {} if "setting" in self.columns or "source" in self.columns else tolerance_columns(unknown)
        names = {index: name for index, (name, _) in split.items() if not diameters.get(index)}
        likely = likely_headers(names, self.columns, self.spellings)
        meanings = {}
        for index in unknown:
            diameter, keys = diameters.get(index), likely.get(index, [])
            is_needed = any(self.columns[key].is_needed(present) and key not in present for key in keys)
            if diameter:
                heading.diameters.update({index} if "radius" in diameter else ())
                meanings[index] = _Unknown([diameter])
            elif index in scatter and index in self._filled and not is_needed and not _OF_TOLERANCES.intersection(keys):
                meanings[index] = _Unknown([], scatter[index])
            else:
                meanings[index] = _Unknown(keys)
        return meanings

    def _take_header(self, heading: Heading, index: int, header: str, unknown: _Unknown | None) -> None:
        """Recognise one header cell, or say what is wrong with it; `unknown` is what it may mean else."""
        name, unit_text = name_and_unit(header)
        meant = unknown.keys if unknown else [self.spellings[plain(name)]]
        address = CellAddress(row=heading.row, column=index)
        facts: dict[str, Any] = {"sheet": self.sheet.name, "cell": address, "value": header.strip()}
        if not meant:
            heading.extra[index] = header.strip()
            scatter = unknown.scatter if unknown else ""
            self.ledger.add("W434" if scatter else "I502", detail=scatter, **facts)
            return
        column = self.columns[meant[0]]
        facts |= {
            "column": column.key,
            "name": column.name,
            "label": column.label,
            "unit": column.unit or _OF_THE_ROW.get(column.sheet, "no unit"),
        }
        if unknown:
            heading.doubtful[index] = column.key
            self._report_unknown(heading, index, meant, facts)
            return
        unit = _unit(column, unit_text, by_key=plain(name) == plain(column.key))
        if column.key in heading.columns:
            self._report_twice(heading, index, facts)
        elif unit is None and unit_text is not None and column.is_number:
            heading.doubtful[index] = column.key
            self.ledger.add(self._error_if_filled("E113", index, column), suggestion=column.label, **facts)
        else:
            heading.columns[column.key] = index
            heading.factors[column.key] = unit.si / column.si_unit.si if unit else 1.0
            self._report_unit(column, unit, facts, unit_text)

    def _report_unknown(self, heading: Heading, index: int, keys: Sequence[str], facts: Mapping[str, Any]) -> None:
        """Tell which columns a header probably means: by half its values, or under another header."""
        name, unit_text = name_and_unit(facts["value"])
        columns = [self.columns[key] for key in keys]
        labels = [_label(column, unit_text) for column in columns]
        if index in heading.diameters:
            bore = (
                f", or the bore under {self.columns['bore_diameter_mm'].label}" if keys[0] == "mean_radius_mm" else ""
            )
            self.ledger.add("E128", **{**facts, "label": labels[0], "detail": bore})
            return
        unit = _unit(columns[0], unit_text, by_key=False)
        is_known = unit is not None or columns[0].unit in {"", "-"}
        sure = misspelt(name, self.spellings) == keys[0] and is_known and len(labels) == 1
        meant = {"label": " or ".join(labels), "name": " or ".join(column.name for column in columns)}
        code = self._error_if_filled("E112", index, columns[0])
        self.ledger.add(
            code, suggestion=meant["label"], certain_value=labels[0] if sure else None, **{**facts, **meant}
        )

    def _report_twice(self, heading: Heading, index: int, facts: Mapping[str, Any]) -> None:
        """Tell that a column stands twice; an empty second one does no harm."""
        key = facts["column"]
        other = column_letters(heading.columns[key])
        if index not in self._filled:
            heading.ignored.add(index)
            self.ledger.add("W436", other=other, **facts)
            return
        heading.doubtful[index] = key
        self.ledger.add("E114", other=other, **facts)
        self.ledger.everything = True

    def _error_if_filled(self, code: str, index: int, column: Column) -> str:
        """Return the code of an error, or of a warning where nothing is lost: no value, and no column that must be."""
        return code if index in self._filled or column.is_needed(()) else "W435"

    def _report_unit(self, column: Column, unit: Unit | None, facts: dict[str, Any], text: str | None) -> None:
        """Tell a unit that was assumed or converted."""
        if unit is None and column.unit not in {"", "-"}:
            self.ledger.add("I503", **facts)
        elif unit and unit != column.si_unit:
            self.ledger.add("I501", **facts | {"value": text})


def _label(column: Column, unit_text: str | None) -> str:
    """Return a column's header, in the unit of another header where that fits."""
    unit = _unit(column, unit_text, by_key=False)
    return f"{column.name} [{unit_text}]" if unit and unit != column.si_unit else column.label


def _unit(column: Column, text: str | None, *, by_key: bool) -> Unit | None:
    """Return the unit that a header names: in brackets, or at the end of its key."""
    if not column.unit:
        return None
    if text is None:
        return column.si_unit if by_key else None
    return find_unit(text, column.quantity)
