"""Header cells → columns of the schema: by label or key, in any order, with the unit in brackets."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from flexlash.columns import Column, columns_of
from flexlash.findings import shown
from flexlash.submission.header_names import LAST_HEADER_ROW, known_names, name_and_unit
from flexlash.submission.ledger import Ledger
from flexlash.submission.likely_headers import likely_headers
from flexlash.submission.reading.read import ErrorCell, RawSheet, RawValue, Unstored, column_letters
from flexlash.submission.spellings import closest, misspelt, plain
from flexlash.units import Unit, find_unit

__all__ = ["STATUS_HEADER", "Heading", "closest", "count_headings", "find_headings", "plain"]

STATUS_HEADER = "Row status"
"""Header of the template's own formula column, which is never data."""


@dataclass(kw_only=True)
class Heading:
    """The columns found in a sheet: place and factor to the printed unit by key, extra headers by place.

    `doubtful` are the places of headers with an error and the key that was probably meant; `ignored` those of
    the template's own formulas.
    """

    row: int
    places: dict[str, int] = field(default_factory=dict)
    factors: dict[str, float] = field(default_factory=dict)
    extra: dict[int, str] = field(default_factory=dict)
    doubtful: dict[int, str] = field(default_factory=dict)
    ignored: set[int] = field(default_factory=set)


def _as_header(cell: RawValue) -> str:
    """Return a header cell as a text, whatever it holds."""
    if isinstance(cell, ErrorCell):
        return cell.text
    if isinstance(cell, Unstored):
        return "(formula without a result)"
    return cell if isinstance(cell, str) else shown(cell)


def find_headings(sheet: RawSheet, schema: str, ledger: Ledger) -> Heading | None:
    """Return the columns of a sheet, or None (with a finding) when it has no header row."""
    return _Recogniser(sheet, schema, ledger).recognise()


def count_headings(sheet: RawSheet, schema: str) -> int:
    """Return how many headers of a schema stand in one of a sheet's first rows."""
    return max(_Recogniser(sheet, schema, Ledger("")).known_by_row().values(), default=0)


class _Recogniser:
    """Recognises the header row of one sheet."""

    def __init__(self, sheet: RawSheet, schema: str, ledger: Ledger) -> None:
        self.sheet = sheet
        self.ledger = ledger
        self.columns = columns_of(schema)
        self.spellings = known_names(self.columns)

    def recognise(self) -> Heading | None:
        """Return the headings of the row, within the first fifteen, that has most of them."""
        known = self.known_by_row()
        best = max(known, key=lambda number: known[number], default=0)
        if not known or known[best] < min(2, len(self.columns)):
            self.ledger.add("E109", sheet=self.sheet.name, cell="A1")
            self.ledger.everything = True
            return None
        heading = Heading(row=best)
        headers = {place: _as_header(cell) for place, cell in self.sheet.rows[best].items()}
        heading.ignored |= {place for place, header in headers.items() if plain(header) == plain(STATUS_HEADER)}
        headers = {place: text for place, text in headers.items() if text.strip() and place not in heading.ignored}
        names = {place: name_and_unit(header)[0] for place, header in headers.items()}
        likely = likely_headers(names, self.columns, self.spellings)
        for place, header in headers.items():
            self._place(heading, place, header, likely.get(place, []))
        self._require(heading, max(self.sheet.rows[best]) + 1)
        return heading

    def known_by_row(self) -> dict[int, int]:
        """Return how many known headers each of the first rows holds."""
        rows = {number: cells for number, cells in self.sheet.rows.items() if number <= LAST_HEADER_ROW}
        return {number: sum(map(self._is_known, cells.values())) for number, cells in rows.items()}

    def _is_known(self, cell: RawValue) -> bool:
        return isinstance(cell, str) and plain(name_and_unit(cell)[0]) in self.spellings

    def _require(self, heading: Heading, next_place: int) -> None:
        """Tell which required columns are missing, at the cell where they could be added."""
        for key, column in self.columns.items():
            if not column.required or key in heading.places:
                continue
            self.ledger.everything = True
            if key not in heading.doubtful.values():
                address = f"{column_letters(next_place)}{heading.row}"
                facts: dict[str, Any] = {"column": key, "name": column.name, "label": column.label}
                self.ledger.add("E111", sheet=self.sheet.name, cell=address, **facts)

    def _place(self, heading: Heading, place: int, header: str, likely: list[str]) -> None:
        """Recognise one header cell, or say what is wrong with it; `likely` are the columns an unknown one may be."""
        name, unit_text = name_and_unit(header)
        key = self.spellings.get(plain(name))
        meant = key or next(iter(likely), None)
        place_facts: dict[str, Any] = {
            "sheet": self.sheet.name,
            "cell": f"{column_letters(place)}{heading.row}",
            "value": header.strip(),
        }
        if meant is None:
            heading.extra[place] = header.strip()
            self.ledger.add("I502", **place_facts)
            return
        column = self.columns[meant]
        facts = place_facts | {
            "column": meant,
            "name": column.name,
            "label": column.label,
            "unit": column.unit or "the unit that Deviation unit names",
        }
        unit = _unit(column, unit_text, by_key=plain(name) == plain(meant))
        if key is None:
            heading.doubtful[place] = meant
            labels = [_label(self.columns[one], unit_text) for one in likely]
            sure = misspelt(name, self.spellings) == meant and (unit is not None or column.unit in {"", "-"})
            repair = labels[0] if sure and len(labels) == 1 else None
            facts["label"] = " or ".join(labels)
            facts["name"] = " or ".join(self.columns[one].name for one in likely)
            self.ledger.add("E112", suggestion=facts["label"], repair=repair, **facts)
        elif key in heading.places:
            heading.doubtful[place] = key
            self.ledger.add("E114", other=column_letters(heading.places[key]), **facts)
            self.ledger.everything = True
        elif unit is None and unit_text is not None and column.is_number:
            heading.doubtful[place] = key
            self.ledger.add("E113", suggestion=column.label, **facts)
        else:
            heading.places[key] = place
            heading.factors[key] = unit.si / column.si_unit.si if unit else 1.0
            self._tell_unit(column, unit, facts, unit_text)

    def _tell_unit(self, column: Column, unit: Unit | None, facts: dict[str, Any], text: str | None) -> None:
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
