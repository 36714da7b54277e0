"""The first cells of a rule drawn like the sheet: letters, headers, row numbers, what was entered and its fix."""

from __future__ import annotations

import datetime
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise

from flexlash.feedback.fixing.fix import Fix
from flexlash.reading.raw import RawSheet, RawValue, Submission
from flexlash.report.layout.raw_cells import raw_text
from flexlash.report.page.shape import Grid, GridRow
from flexlash.schema.cell_addresses import CellAddress, column_letters
from flexlash.schema.columns import columns_of
from flexlash.schema.findings import Finding, shown
from flexlash.schema.header_names import known_names, name_and_unit
from flexlash.schema.spellings import plain
from flexlash.validation.entry_sheets import sheet_names
from flexlash.validation.relations import RELATIONS

__all__ = ["GRID_ROWS", "Sheets"]

GRID_ROWS = 3
"""Most rows that are drawn of a rule."""

_COLUMNS = 8
"""Most columns that are drawn beside one another."""

_LONGEST = 60
"""Most characters of a cell."""

_LEFT_OUT = "…"
"""What stands for the columns between two that are no neighbours."""

_OWNERS: Mapping[str, tuple[str, ...]] = {
    "Variants": ("variant",),
    "Materials": ("material",),
    "Tolerances": ("tolerance_class", "dimension"),
    "Settings": ("setting",),
    "Measurements": ("sample", "part"),
    "Correlations": ("tolerance_class", "dimension_1", "dimension_2"),
    "Other sources": ("source",),
    "Levers": ("dimension",),
    "Sweep": ("variant", "dimension"),
}
"""The columns that say whose row it is, by entry sheet."""


_BESIDE: Mapping[tuple[str, str], tuple[str, ...]] = {
    ("E318", "lower_deviation"): ("upper_deviation",),
    ("E362", "radius_mm"): ("enter_as",),
    ("E362", "pressure_angle_deg"): ("enter_as",),
    ("E362", "ratio"): ("side",),
    **dict.fromkeys((("E364", "lower_deviation"), ("W462", "lower_deviation")), ("value_arcmin", "upper_deviation")),
    **dict.fromkeys((("E365", "lowest"), ("W464", "lowest")), ("highest",)),
    ("W464", "highest"): ("lowest",),
    ("W463", "step"): ("lowest", "highest"),
    **dict.fromkeys((("E368", "step"), ("E369", "step")), ("from", "to")),
    **dict.fromkeys((("E368", "second_step"), ("E369", "second_step")), ("second_from", "second_to")),
}
"""The columns that a finding outside Variants compares with its own, by its code and column."""


@dataclass(frozen=True, kw_only=True)
class Sheets:
    """The sheets of a submission from which cells are drawn.

    `header_rows` is the row of each entry sheet's headers, by schema; `fixes` are the certain fixes.
    """

    submission: Submission
    header_rows: Mapping[str, int] = field(default_factory=dict)
    fixes: Sequence[Fix] = ()

    @cached_property
    def _schemas(self) -> dict[str, str]:
        return {name: schema for schema, name in sheet_names(self.submission).items()}

    @cached_property
    def _places(self) -> dict[str, dict[str, int]]:
        """The columns of each entry sheet by key."""
        return {
            name: _places(self.submission.sheets[name].rows.get(self.header_rows.get(schema, 0), {}), schema)
            for name, schema in self._schemas.items()
        }

    @cached_property
    def _fixes(self) -> dict[tuple[str, str], str]:
        return {(fix.sheet, fix.cell): self._written(fix) for fix in self.fixes}

    def _written(self, fix: Fix) -> str:
        """Return a fix as it stands in the fixed submission."""
        dialect = self.submission.dialect
        comma = bool(dialect and dialect.comma_number) and not isinstance(fix.value, str)
        return fix.written.replace(".", ",") if comma else shown(fix.written, _LONGEST)

    def grid(self, findings: Iterable[Finding]) -> Grid | None:
        """Return the first cells of findings in one sheet; None where they are at none that can be drawn."""
        placed = [(found, address) for found in findings if (address := found.address)]
        sheet = self.submission.sheets.get(placed[0][0].sheet) if placed else None
        if sheet is None:
            return None
        numbers = [*dict.fromkeys(address.row for _, address in placed)][:GRID_ROWS]
        here = [(found, address) for found, address in placed if address.row in numbers]
        header = self.header_rows.get(self._schemas.get(sheet.name, ""), 0)
        columns = self._columns(sheet, here)
        if header >= min(numbers):
            header = 0
        cells = sheet.rows.get(header, {})
        guilty = {address for _, address in here}
        return Grid(
            sheet=shown(sheet.name),
            columns=[column_letters(column) if column else _LEFT_OUT for column in columns],
            header_row=header,
            header=[_text(cells.get(column)) for column in columns] if header else [],
            rows=[self._row(sheet, number, columns, guilty) for number in sorted(numbers)],
        )

    def _columns(self, sheet: RawSheet, here: Sequence[tuple[Finding, CellAddress]]) -> list[int]:
        """Return the columns to draw: whose row it is, the guilty, those they are compared with; 0 for a gap."""
        places = self._places.get(sheet.name, {})
        owners = [places[key] for key in _OWNERS.get(self._schemas.get(sheet.name, ""), ()) if key in places]
        guilty = [address.column for _, address in here]
        compared = [places[key] for found, _ in here for key in _compared(found) if key in places]
        filled = {column for _, address in here for column in sheet.rows.get(address.row, {})}
        telling = [column for column in compared if column in filled and column not in guilty] or compared
        drawn = sorted([*dict.fromkeys([*owners, *guilty, *telling])][:_COLUMNS])
        gaps = [[column, 0] if following - column > 1 else [column] for column, following in pairwise(drawn)]
        return [*(place for some in gaps for place in some), *drawn[-1:]]

    def _row(self, sheet: RawSheet, number: int, columns: Sequence[int], guilty: set[CellAddress]) -> GridRow:
        """Return a row of the sheet, and what it becomes."""
        cells = sheet.rows.get(number, {})
        addresses = [CellAddress(row=number, column=column) for column in columns]
        fixed = [self._fixes.get((sheet.name, str(cell)), "") if cell in guilty else "" for cell in addresses]
        return GridRow(
            row=number,
            cells=[_text(cells.get(column)) for column in columns],
            marked=[place for place, cell in enumerate(addresses) if cell in guilty],
            fixed=fixed if any(fixed) else None,
        )


def _places(header: Mapping[int, RawValue], schema: str) -> dict[str, int]:
    """Return the columns of a header row by key."""
    spellings = known_names(columns_of(schema))
    places: dict[str, int] = {}
    for column, value in header.items():
        key = spellings.get(plain(name_and_unit(value)[0])) if isinstance(value, str) else None
        if key:
            places.setdefault(key, column)
    return places


def _compared(found: Finding) -> list[str]:
    """Return the columns that the rule of a finding compares with its own; the type where there is no other."""
    relation = RELATIONS.get(f"{found.column}|{found.code}")
    beside = _BESIDE.get((found.code, found.column), ())
    keys = [key for key in relation.keys if key != found.column] if relation else [*beside]
    return [key for key in keys if key != "flexspline_type"] or keys


def _text(value: RawValue | None) -> str:
    """Return a cell as it was entered, cut where it is long."""
    if value is None:
        return ""
    if isinstance(value, datetime.datetime) and value.time() == datetime.time():
        value = value.date()
    return shown(raw_text(value), _LONGEST)
