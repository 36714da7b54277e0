"""Columns → the Excel template, empty or filled; the same bytes every time."""

from __future__ import annotations

import datetime
import io
from collections.abc import Mapping, Sequence
from typing import Any

import xlsxwriter
from xlsxwriter.utility import xl_col_to_name, xl_rowcol_to_cell

from flexlash.feedback.template.cell_writer import DATE_FORMATS, CellWriter
from flexlash.feedback.template.dictionary_sheet import write_dictionary
from flexlash.feedback.template.entry_rules import (
    FIRST_ROW,
    HEADER_ROW,
    PREPARED_ROWS,
    SIDE_ROWS,
    cell_rule,
    header_note,
    write_lists,
)
from flexlash.feedback.template.filling import Entries, Filling, study
from flexlash.feedback.template.status_formulas import COMPLETE, status_formula, status_names
from flexlash.feedback.template.stored_status import listed_name, stored_statuses
from flexlash.schema.columns import ENTRY_SHEETS, OPTIONAL_SHEETS, SETTINGS, Column
from flexlash.validation.headers import STATUS_HEADER
from flexlash.validation.template_versions import TEMPLATE_VERSION

__all__ = ["TITLES", "Filling", "study", "template_bytes"]

TITLES = {
    "Variants": (
        "flexlash: one row per flexspline variant",
        "Yellow columns are required. Each header has a note; each cell says what it takes.",
    ),
    "Materials": ("Materials", "One row per material. Add rows for your own."),
    "Tolerances": (
        "Tolerances",
        "One row per class and dimension: a grade, or lower and upper deviation. No row: exact.",
    ),
    "Settings": ("Settings", "Blank values take the default."),
}
"""Title and hint above each entry sheet."""

_PRINTED_ROWS = 100
_OWN_WIDTH = 16
_PLAIN = tuple(name for name in ENTRY_SHEETS if name not in OPTIONAL_SHEETS)

_DATE = datetime.datetime(2026, 1, 1, tzinfo=datetime.UTC).replace(tzinfo=None)

_WIDTHS = {
    "variant": 24,
    "material": 24,
    "notes": 56,
    "source": 86,
    "dimension": 24,
    "setting": 24,
    "value": 14,
}


def template_bytes(filling: Filling | None = None) -> bytes:
    """Return the template as an .xlsx file, empty or filled."""
    buffer = io.BytesIO()
    workbook = xlsxwriter.Workbook(buffer, {"in_memory": True})
    workbook.set_properties(
        {"title": "flexlash template", "comments": f"Template version {TEMPLATE_VERSION}", "created": _DATE}
    )
    workbook.set_custom_property("flexlash", "template")
    # A text, since LibreOffice makes whole numbers decimal ones.
    workbook.set_custom_property("flexlash_template_version", str(TEMPLATE_VERSION), "text")
    _Template(workbook, filling or Filling()).write()
    workbook.close()
    return buffer.getvalue()


class _Template:
    """The workbook being written: its formats, and one method a sheet."""

    def __init__(self, workbook: xlsxwriter.Workbook, filling: Filling) -> None:
        self.workbook = workbook
        self.filling = filling
        base = {"font_name": "Calibri", "font_size": 11, "valign": "vcenter"}
        head = {
            **base,
            "bold": True,
            "text_wrap": True,
            "align": "center",
            "border": 1,
            "border_color": "#8EA9C1",
        }
        entry = {**base, "locked": False, "border": 1, "border_color": "#D9D9D9"}
        self.formats = {
            name: workbook.add_format(properties)
            for name, properties in {
                "title": {**base, "bold": True, "font_size": 16, "font_color": "#1F3A5F"},
                "hint": {**base, "italic": True, "font_color": "#595959"},
                "meaning": {**base, "italic": True, "font_color": "#595959", "indent": 1},
                "live": {**base, "bold": True, "font_color": "#1F3A5F"},
                "group": {**base, "bold": True, "font_color": "#FFFFFF", "bg_color": "#1F3A5F"},
                "plain": base,
                "header": {**head, "bg_color": "#D9E2EC"},
                "required": {**head, "bg_color": "#FFD966"},
                "number": entry,
                "text": {**entry, "num_format": "@", "indent": 1},
                "number required": {**entry, "bg_color": "#FFF5D6"},
                "text required": {**entry, "num_format": "@", "bg_color": "#FFF5D6"},
                "status": {**base, "italic": True, "font_color": "#595959", "indent": 1},
                **{kind: {**entry, "num_format": form} for kind, form in DATE_FORMATS.items()},
                "good": {"font_color": "#006100", "bg_color": "#D5EBDD"},
                "open": {"font_color": "#7F4F00", "bg_color": "#FFE3B3"},
                "wrap": {**base, "text_wrap": True, "valign": "top"},
            }.items()
        }
        self.sheets = {name: workbook.add_worksheet(name) for name in (*_PLAIN, "Dictionary", "Lists")}

    def write(self) -> None:
        """Write all sheets."""
        entries = {name: self.filling.entries(name) for name in _PLAIN}
        materials, tolerances = entries["Materials"], entries["Tolerances"]
        names = [listed_name(row.get("material")) for row in materials.rows]
        classes = [listed_name(row.get("tolerance_class")) for row in tolerances.rows]
        rows = max(SIDE_ROWS, len(materials.rows), len(tolerances.rows))
        write_lists(self.workbook, self.sheets["Lists"], classes, rows)
        self._variants(entries["Variants"], names, classes)
        self._side("Materials", materials)
        self._side("Tolerances", tolerances)
        self._settings(entries["Settings"])
        write_dictionary(self.sheets["Dictionary"], self.formats)

    def _format(self, column: Column) -> Any:
        kind = "number" if column.is_number else "text"
        return self.formats[f"{kind} required" if column.required else kind]

    def _heading(self, name: str, entries: Entries) -> Any:
        """Write title, hint and header row of an entry sheet; return the sheet."""
        title, hint = TITLES[name]
        sheet, columns = self.sheets[name], entries.columns
        for row in range(HEADER_ROW):
            for index in range(len(columns) + 1):
                sheet.write_blank(row, index, None, self.formats["plain"])
        sheet.write_string(0, 0, title, self.formats["title"])
        sheet.write_string(1, 0, hint, self.formats["hint"])
        sheet.set_row(0, 26)
        sheet.set_row(HEADER_ROW, 62)
        for index, column in enumerate(columns):
            style = "required" if column.required else "header"
            width = _WIDTHS.get(column.key, 13)
            sheet.set_column(index, index, width, self._format(column), self._outline(column))
            sheet.write_string(HEADER_ROW, index, column.label, self.formats[style])
            sheet.write_comment(HEADER_ROW, index, header_note(column), {"x_scale": 2, "y_scale": 1.2})
        sheet.data_validation(
            HEADER_ROW,
            0,
            HEADER_ROW,
            len(columns),
            {
                "validate": "custom",
                "value": "=FALSE",
                "error_title": "Header row",
                "error_message": "The headers tell flexlash what each column holds. Please leave them as they are.",
            },
        )
        sheet.freeze_panes(FIRST_ROW, 1)
        sheet.set_landscape()
        sheet.set_paper(9)
        sheet.fit_to_pages(1, 0)
        sheet.repeat_rows(HEADER_ROW)
        sheet.set_footer("&L&A&C&P / &N&Rflexlash template")
        return sheet

    @staticmethod
    def _outline(column: Column) -> dict[str, int]:
        return {"level": 1} if column.group == "Refinements" else {}

    def _variants(self, entries: Entries, materials: Sequence[str], classes: Sequence[str]) -> None:
        """Write the Variants sheet: entries, hints, live status."""
        sheet = self._heading("Variants", entries)
        columns, status = entries.columns, len(entries.columns)
        sheet.write_string(0, 9, f"Template version {TEMPLATE_VERSION}", self.formats["hint"])
        sheet.set_row(2, 18)
        groups: list[str] = []
        for index, column in enumerate(columns):
            sheet.write_string(2, index, "" if column.group in groups else column.group, self.formats["group"])
            groups.append(column.group)
        sheet.write_string(2, status, "", self.formats["group"])
        sheet.write_string(HEADER_ROW, status, STATUS_HEADER, self.formats["header"])
        sheet.write_comment(HEADER_ROW, status, "Calculated while you type: what the row still lacks.")
        sheet.set_column(status, status, 48, self.formats["status"])
        self._fill(sheet, entries, status + 1)
        letters = {column.key: xl_col_to_name(index) for index, column in enumerate(columns)}
        for name, formula in status_names(letters).items():
            self.workbook.define_name(name, formula)
        texts = stored_statuses(entries, materials, classes)
        prepared = max(PREPARED_ROWS, len(texts))
        for index in range(prepared):
            text = texts[index] if index < len(texts) else ""
            if text or index < PREPARED_ROWS:
                formula = status_formula(FIRST_ROW + index + 1, letters)
                sheet.write_formula(FIRST_ROW + index, status, formula, self.formats["status"], text)
        self._progress(sheet, xl_col_to_name(status), texts, prepared)
        self._entry_rules(sheet, columns, prepared)
        self._shading(sheet, columns, prepared)
        sheet.print_area(0, 0, HEADER_ROW + max(_PRINTED_ROWS, len(texts)), status + len(entries.own))
        sheet.activate()

    def _progress(self, sheet: Any, letter: str, texts: Sequence[str], prepared: int) -> None:
        """Write the live sentence that says how many rows are complete and where the first gap is."""
        block = f"${letter}${FIRST_ROW + 1}:${letter}${FIRST_ROW + prepared}"
        names = f"$A${FIRST_ROW + 1}:$A${FIRST_ROW + prepared}"
        done, started = f'COUNTIF({block},"{COMPLETE}")', f'COUNTIF({block},"?*")'
        sentence = f'{done}&" of "&{started}&" rows complete"'
        entered = [text for text in texts if text]
        shown = f"{entered.count(COMPLETE)} of {len(entered)} rows complete" if entered else "No row entered yet"
        formula = f'=IF({started}=0,"No row entered yet",{sentence})'
        sheet.write_formula(1, 9, formula, self.formats["live"], shown)
        self.workbook.define_name("fl_variants", f"=Variants!{names}")

    def _shading(self, sheet: Any, columns: Sequence[Column], prepared: int) -> None:
        """Colour what is missing, what is double, and the status."""
        status = len(columns)
        last = FIRST_ROW + prepared - 1
        first, end = xl_col_to_name(0), xl_col_to_name(status - 1)
        row = FIRST_ROW + 1
        for index, column in enumerate(columns):
            if column.required:
                cell = xl_rowcol_to_cell(FIRST_ROW, index)
                criteria = f'=AND(COUNTA(${first}{row}:${end}{row})>0,{cell}="")'
                rule = {"type": "formula", "criteria": criteria, "format": self.formats["open"]}
                sheet.conditional_format(FIRST_ROW, index, last, index, rule)
        sheet.conditional_format(FIRST_ROW, 0, last, 0, {"type": "duplicate", "format": self.formats["open"]})
        cell = f"${xl_col_to_name(status)}{row}"
        # Each rule excludes the other, since LibreOffice forgets which of them would stop the next.
        unfinished = f'=AND(LEN({cell})>0,{cell}<>"{COMPLETE}")'
        for criteria, style in ((f'={cell}="{COMPLETE}"', "good"), (unfinished, "open")):
            rule = {"type": "formula", "criteria": criteria, "format": self.formats[style]}
            sheet.conditional_format(FIRST_ROW, status, last, status, rule)

    def _fill(self, sheet: Any, entries: Entries, own: int, styles: Mapping[str, Any] | None = None) -> None:
        """Write the given rows, and the user's own columns from the column `own` on; `styles` are formats by key."""
        cells = CellWriter(sheet, self.formats)
        styles = styles or {column.key: self._format(column) for column in entries.columns}
        targets: dict[str | int, tuple[int, Any]] = {
            column.key: (index, styles[column.key]) for index, column in enumerate(entries.columns)
        }
        for number, header in enumerate(entries.own):
            targets[number] = (own + number, self.formats["number"])
            sheet.set_column(own + number, own + number, _OWN_WIDTH, self.formats["number"])
            cells.write(HEADER_ROW, own + number, header, self.formats["header"])
            for row in range(HEADER_ROW):
                sheet.write_blank(row, own + number, None, self.formats["plain"])
        for row, values in enumerate(entries.rows, start=FIRST_ROW):
            for key, (index, style) in targets.items() if values else ():
                cells.write(row, index, values.get(key), style)

    def _entry_rules(self, sheet: Any, columns: Sequence[Column], rows: int) -> None:
        """Give every cell of every column its hint and its rule."""
        for index, column in enumerate(columns):
            rule = cell_rule(column, index)
            sheet.data_validation(FIRST_ROW, index, FIRST_ROW + rows - 1, index, rule)

    def _side(self, name: str, entries: Entries) -> None:
        """Write Materials or Tolerances."""
        sheet = self._heading(name, entries)
        self._fill(sheet, entries, len(entries.columns))
        self._entry_rules(sheet, entries.columns, max(SIDE_ROWS, len(entries.rows)))

    def _settings(self, entries: Entries) -> None:
        """Write Settings: fixed names, free values, what they mean beside them."""
        sheet = self._heading("Settings", entries)
        meaning = len(entries.columns)
        for index in range(len(entries.rows)):
            sheet.write_blank(FIRST_ROW + index, 1, None, self.formats["number"])
        self._fill(sheet, entries, meaning + 1, {"setting": self.formats["plain"], "value": self.formats["number"]})
        for index, column in enumerate(SETTINGS):
            row = FIRST_ROW + index
            sheet.write_string(row, meaning, f"{column.help} Allowed: {column.requirement}.", self.formats["meaning"])
            rule = cell_rule(column, 1)
            if column.choices:
                rule |= {"validate": "list", "value": "=fl_methods"}
            sheet.data_validation(row, 1, row, 1, rule)
        sheet.set_column(meaning, meaning, 110, self.formats["hint"])
        sheet.protect("", {"format_columns": True})
