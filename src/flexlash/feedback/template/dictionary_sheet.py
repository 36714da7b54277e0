"""The template's Dictionary sheet: every column in words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flexlash.schema.columns import ENTRY_SHEETS

__all__ = ["write_dictionary"]


def write_dictionary(sheet: Any, formats: Mapping[str, Any]) -> None:
    """Write every column of every entry sheet: what it is called, holds and means."""
    headings = {
        "Sheet": 12,
        "Column": 28,
        "Key": 24,
        "Required": 10,
        "Holds": 44,
        "Default": 12,
        "Meaning": 90,
    }
    for index, (heading, width) in enumerate(headings.items()):
        sheet.set_column(index, index, width)
        sheet.write_string(0, index, heading, formats["header"])
    entries = [column for columns in ENTRY_SHEETS.values() for column in columns]
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
    sheet.freeze_panes(1, 0)
    sheet.set_landscape()
    sheet.set_paper(9)
    sheet.fit_to_pages(1, 0)
    sheet.repeat_rows(0)
    sheet.set_footer("&L&A&C&P / &N&Rflexlash template")
    sheet.protect("", {"format_columns": True})
