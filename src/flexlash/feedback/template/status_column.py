"""The column of an entry sheet that says while one types what a row still lacks, and its colours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from flexlash.feedback.template.entry_rules import FIRST_ROW, HEADER_ROW, prepared_rows
from flexlash.feedback.template.filling import Entries
from flexlash.feedback.template.status_rules import COMPLETE, Known, Stage, row_formula, stage_names
from flexlash.feedback.template.stored_status import stored_statuses
from flexlash.validation.headers import STATUS_HEADER

__all__ = ["STATUS_WIDTH", "write_progress", "write_status"]

STATUS_WIDTH = 48
"""Width of the column [characters]."""


def write_status(
    workbook: Any, sheet: Any, entries: Entries, status_of: tuple[Sequence[Stage], Known], formats: Mapping[str, Any]
) -> list[str]:
    """Write header, formulas and colours of the status behind the columns of a sheet; return the texts of its rows.

    `status_of` are the stages of the status, and what is known of names in the workbook.
    """
    (stages, known), columns = status_of, entries.columns
    name, status = sheet.get_name(), len(columns)
    sheet.write_string(HEADER_ROW, status, STATUS_HEADER, formats["header"])
    sheet.write_comment(HEADER_ROW, status, "Calculated while you type: what the row still lacks.")
    sheet.set_column(status, status, STATUS_WIDTH, formats["status"])
    texts = stored_statuses(entries, stages, known)
    prepared = prepared_rows(name, len(texts))
    letters = {column.key: xl_col_to_name(index) for index, column in enumerate(columns)}
    block = range(FIRST_ROW + 1, FIRST_ROW + prepared + 1)
    for title, formula in stage_names(name, stages, letters, block).items():
        workbook.define_name(title, formula)
    least = prepared_rows(name, 0)
    for index in range(prepared):
        text = texts[index] if index < len(texts) else ""
        if text or index < least:
            formula = row_formula(stages, letters, FIRST_ROW + index + 1)
            sheet.write_formula(FIRST_ROW + index, status, formula, formats["status"], text)
    cell = f"${xl_col_to_name(status)}{FIRST_ROW + 1}"
    # Each rule excludes the other, since LibreOffice forgets which of them would stop the next.
    unfinished = f'=AND(LEN({cell})>0,{cell}<>"{COMPLETE}")'
    for criteria, style in ((f'={cell}="{COMPLETE}"', "good"), (unfinished, "open")):
        rule = {"type": "formula", "criteria": criteria, "format": formats[style]}
        sheet.conditional_format(FIRST_ROW, status, FIRST_ROW + prepared - 1, status, rule)
    return texts


def write_progress(workbook: Any, sheet: Any, status: int, texts: Sequence[str], style: Any) -> None:
    """Write the live sentence that says how many variants are complete, and name their cells."""
    letter, last = xl_col_to_name(status), FIRST_ROW + prepared_rows("Variants", len(texts))
    block = f"${letter}${FIRST_ROW + 1}:${letter}${last}"
    done, started = f'COUNTIF({block},"{COMPLETE}")', f'COUNTIF({block},"?*")'
    sentence = f'{done}&" of "&{started}&" rows complete"'
    entered = [text for text in texts if text]
    shown = f"{entered.count(COMPLETE)} of {len(entered)} rows complete" if entered else "No row entered yet"
    formula = f'=IF({started}=0,"No row entered yet",{sentence})'
    sheet.write_formula(1, 9, formula, style, shown)
    workbook.define_name("fl_variants", f"=Variants!$A${FIRST_ROW + 1}:$A${last}")
