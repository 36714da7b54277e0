"""The template's Dictionary sheet: every column in words."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from typing import Any

from flexlash.feedback.template.print_pages import set_up_page
from flexlash.schema.columns import ENTRY_SHEETS, OPTIONAL_SHEETS

__all__ = ["write_dictionary"]

_LINE = 15
"""Height of a line [pt]."""

_LETTERS = 1.15
"""Letters of a text that are as wide as a digit, by which widths are counted."""

_ABSENT = "Optional sheet: {use}. To add it: flexlash template --upgrade THIS.xlsx --with {option}"


def write_dictionary(sheet: Any, formats: Mapping[str, Any], sheets: Collection[str]) -> None:
    """Write every column of these entry sheets: what it is called, holds and means; then which sheets are missing."""
    headings = {
        "Sheet": 15,
        "Column": 28,
        "Key": 24,
        "Required": 10,
        "Holds": 36,
        "Default": 12,
        "Meaning": 90,
    }
    for index, (heading, width) in enumerate(headings.items()):
        sheet.set_column(index, index, width)
        sheet.write_string(0, index, heading, formats["header"])
    entries = [column for name in sheets for column in ENTRY_SHEETS[name]]
    for row, column in enumerate(entries, start=1):
        default = "" if column.default is None else f"{column.default}"
        required = "yes" if column.required else ""
        texts = (
            column.sheet,
            column.label,
            column.key,
            required,
            column.requirement,
            default,
            column.help,
        )
        for index, text in enumerate(texts):
            sheet.write_string(row, index, text, formats["wrap"])
        _set_height(sheet, row, texts, headings.values())
    absent = (name for name in OPTIONAL_SHEETS if name not in sheets)
    for row, name in enumerate(absent, start=len(entries) + 1):
        sheet.write_string(row, 0, name, formats["wrap"])
        words = _ABSENT.format(use=OPTIONAL_SHEETS[name], option=name.lower().replace(" ", "-"))
        sheet.write_string(row, len(headings) - 1, words, formats["wrap"])
        _set_height(sheet, row, [words], [headings["Meaning"]])
    sheet.freeze_panes(1, 0)
    set_up_page(sheet, 0)
    sheet.protect("", {"format_columns": True})


def _set_height(sheet: Any, row: int, texts: Iterable[str], widths: Iterable[int]) -> None:
    """Make a row as high as the longest of its texts needs, since not every program does so by itself."""
    lines = (math.ceil(len(text) / (_LETTERS * width)) for text, width in zip(texts, widths, strict=True))
    sheet.set_row(row, _LINE * max(lines))
