"""Conditional formats that keep a mark visible where the user's own conditional formats would paint over it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from openpyxl.formatting.formatting import ConditionalFormattingList
from openpyxl.formatting.rule import Rule
from openpyxl.styles import PatternFill
from openpyxl.styles.differential import DifferentialStyle
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.cell_range import CellRange

from flexlash.feedback.annotation.appearance import FILLS
from flexlash.schema.finding_catalogue import Level

__all__ = ["overrule", "withdraw"]

_ALWAYS = '"flexlash"="flexlash"'
"""A condition that is always true and by which our own rules are known."""


def withdraw(sheet: Any) -> None:
    """Take our own rules away from a sheet and give the user's their places back."""
    rules = [(area, rule) for area in sheet.conditional_formatting for rule in area.rules]
    users = [(area, rule) for area, rule in rules if rule.formula != [_ALWAYS]]
    if len(users) < len(rules):
        sheet.conditional_formatting = ConditionalFormattingList()
        for area, rule in users:
            sheet.conditional_formatting.add(area, rule)
        _shift(sheet, -min([len(rules) - len(users), *(rule.priority - 1 for _, rule in users)]))


def overrule(sheet: Any, places: Mapping[Level, Iterable[tuple[int, int]]]) -> None:
    """Give marked cells a rule before all others, where the user's rules reach them."""
    users = list(sheet.conditional_formatting)
    taken = [area for one in users for area in one.sqref]
    ours = {
        level: " ".join(run.coord for run in _runs(cells) if any(not run.isdisjoint(area) for area in taken))
        for level, cells in places.items()
    }
    needed = [(level, areas) for level, areas in ours.items() if areas]
    _shift(sheet, len(needed))
    # Excel goes by priority, LibreOffice by order.
    sheet.conditional_formatting = ConditionalFormattingList()
    for priority, (level, areas) in enumerate(needed, start=1):
        fill = PatternFill(bgColor=FILLS[level].bgColor)
        rule = Rule(type="expression", priority=priority, formula=[_ALWAYS], dxf=DifferentialStyle(fill=fill))
        sheet.conditional_formatting.add(areas, rule)
    for one in users:
        for rule in one.rules:
            sheet.conditional_formatting.add(one, rule)


def _shift(sheet: Any, steps: int) -> None:
    """Move the priorities of a sheet's rules."""
    for area in sheet.conditional_formatting:
        for rule in area.rules:
            rule.priority += steps


def _runs(cells: Iterable[tuple[int, int]]) -> Iterator[CellRange]:
    """Yield the areas of cells that stand under each other."""
    first = last = (0, 0)
    for row, column in sorted(cells, key=lambda place: (place[1], place[0])):
        if (row, column) != (last[0] + 1, last[1]):
            if last[0]:
                yield _area(first, last)
            first = (row, column)
        last = (row, column)
    if last[0]:
        yield _area(first, last)


def _area(first: tuple[int, int], last: tuple[int, int]) -> CellRange:
    letters = get_column_letter(first[1])
    return CellRange(f"{letters}{first[0]}:{letters}{last[0]}")
