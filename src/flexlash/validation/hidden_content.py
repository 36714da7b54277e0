"""What is easily overlooked in a filled sheet: merged cells, hidden rows or sheets, a row far away, split numbers."""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from itertools import pairwise

from flexlash.reading.raw import RawSheet
from flexlash.schema.cell_addresses import CellAddress
from flexlash.schema.columns import columns_of, naming_column
from flexlash.validation.ledger import Ledger
from flexlash.validation.validated import Table

__all__ = ["DIGITS", "report_hidden_content"]

_EMPTY_ROWS = 60
"""So many empty rows between two rows fill more than a screen: who scrolls does not see both."""

DIGITS = re.compile(r"\d{1,3}", re.ASCII)


def report_hidden_content(sheet: RawSheet, table: Table, ledger: Ledger) -> None:
    """Tell what an engineer may not see in the rows of an entry sheet; cells under a merged area are errors."""
    rows = sorted(table.cells)
    if sheet.hidden and rows:
        ledger.add("W426", sheet=sheet.name, cell=CellAddress(row=1, column=1), value=len(rows))
    for row, index, area in _covered(sheet, table, rows):
        _report_covered(table, ledger, row, index, area)
    for first, last in _runs(rows, sheet.hidden_rows):
        words = f"row {first} is" if first == last else f"rows {first} to {last} are"
        ledger.add("W425", sheet=sheet.name, cell=_name_cell(table, first), detail=words)
    for above, row in ((sheet.whole.above.get(row, 0), row) for row in rows) if sheet.whole else pairwise(rows):
        if above and row - above > _EMPTY_ROWS:
            cell = _name_cell(table, row)
            ledger.add("W427", sheet=sheet.name, cell=cell, detail=row - above - 1, other=above)
    _report_digits(sheet, table, ledger)


def _report_digits(sheet: RawSheet, table: Table, ledger: Ledger) -> None:
    """Warn of remarks that are nothing but short digits, as where decimal commas have split numbers."""
    if sheet.dialect is None or sheet.dialect.delimiter != ",":
        return
    for key, column in columns_of(table.schema).items():
        texts = table.frame.select("row", key).drop_nulls().rows() if column.role == "remark" else []
        if sheet.whole:
            texts = [(row, text) for row, text in texts if row == sheet.whole.digits.get(key)]
        if texts and all(DIGITS.fullmatch(text) for _, text in texts):
            row, text = texts[0]
            cell = table.address(row, key)
            ledger.add("W430", sheet=sheet.name, cell=cell, column=key, name=column.name, value=text)


def _name_cell(table: Table, row: int) -> CellAddress:
    """Return the cell that names a row."""
    return table.address(row, naming_column(table.schema).key)


def _covered(sheet: RawSheet, table: Table, rows: list[int]) -> Iterator[tuple[int, int, str]]:
    """Yield row, column and area of every cell of a column that is read but lies under another cell."""
    judged = dict.fromkeys(table.heading.columns.values(), 0)
    for top, left, bottom, right in sorted(sheet.merged):
        last = bisect_right(rows, bottom)
        shown = sheet.rows.get(top, {}).get(left) is not None
        for index in judged if bisect_left(rows, top) < last else ():
            # Areas that overlap, which only a faulty program writes, would cost their number times the rows.
            first = bisect_left(rows, max(top, judged[index] + 1)) if left <= index <= right else last
            for row in rows[first:last]:
                hides = index in table.cells[row]
                if (row, index) != (top, left) and (shown or hides):
                    yield row, index, f"{CellAddress(row=top, column=left)}:{CellAddress(row=bottom, column=right)}"
                judged[index] = row


def _report_covered(table: Table, ledger: Ledger, row: int, index: int, area: str) -> None:
    """Record that a cell lies under a merged area, unless it holds a remark or has a finding already."""
    (key,) = (key for key, own in table.heading.columns.items() if own == index)
    column = columns_of(table.schema)[key]
    # A remark may well be merged over the rows that it is about.
    if column.role == "remark" or (row, key) in table.faulty:
        return
    table.faulty.add((row, key))
    ledger.add(
        "E214",
        sheet=table.sheet,
        cell=table.address(row, key),
        column=key,
        name=column.name,
        value=table.entered(row, key),
        requirement=column.requirement,
        other=area,
        rows=[row] if table.schema == "Variants" else [],
    )


def _runs(rows: list[int], hidden: frozenset[int]) -> Iterator[tuple[int, int]]:
    """Yield first and last of each run of hidden rows with data."""
    run: list[int] = []
    for row in [*rows, 0]:
        if row in hidden:
            run.append(row)
        elif run:
            yield run[0], run[-1]
            run = []
