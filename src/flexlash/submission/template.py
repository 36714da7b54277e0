"""Columns → the Excel template, empty or filled; the same bytes every time."""

from __future__ import annotations

import datetime
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import xlsxwriter
from xlsxwriter.utility import xl_col_to_name, xl_rowcol_to_cell

from flexlash import tables
from flexlash.columns import ENTRY_SHEETS, MATERIALS, SETTINGS, SETTINGS_SHEET, TOLERANCES, VARIANTS, Column
from flexlash.submission.entry_rules import (
    FIRST_ROW,
    HEADER_ROW,
    PREPARED_ROWS,
    SIDE_ROWS,
    cell_rule,
    header_note,
    write_lists,
)
from flexlash.submission.headers import STATUS_HEADER
from flexlash.submission.read import ErrorCell, Unstored
from flexlash.submission.status import COMPLETE, status_formula, status_text
from flexlash.submission.validate import TEMPLATE_VERSION

__all__ = ["Filling", "study", "template_bytes"]

_PRINTED_ROWS = 100
_UNSTORED_FORMULA = "=0.8*2"
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


@dataclass(frozen=True, kw_only=True)
class Filling:
    """Rows to fill a template with, each by key; `None` keeps what the empty template holds."""

    variants: Sequence[Mapping[str, Any]] = ()
    tolerances: Sequence[Mapping[str, Any]] = ()
    materials: Sequence[Mapping[str, Any]] = ()
    settings: Mapping[str, Any] = field(default_factory=dict)


def study() -> Filling:
    """Return the published B3-160 study with its screening tolerances, as `--example` fills it in."""
    return Filling(variants=_typed("study", VARIANTS), tolerances=_typed("study_class", TOLERANCES))


def _typed(table: str, columns: Sequence[Column]) -> list[dict[str, Any]]:
    """Return the rows of a packaged table with its numbers as numbers and its blanks left out."""
    numeric = {column.key for column in columns if column.is_number}
    return [
        {key: float(text) if key in numeric else text for key, text in row.items() if text}
        for row in tables.rows(table)
    ]


def template_bytes(filling: Filling | None = None) -> bytes:
    """Return the template as an .xlsx file, empty or filled."""
    buffer = io.BytesIO()
    workbook = xlsxwriter.Workbook(buffer, {"in_memory": True})
    workbook.set_properties(
        {"title": "flexlash template", "comments": f"Template version {TEMPLATE_VERSION}", "created": _DATE}
    )
    workbook.set_custom_property("flexlash", "template")
    workbook.set_custom_property("flexlash_template_version", TEMPLATE_VERSION, "number_int")
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
                "date": {**entry, "num_format": "d mmm"},
                "good": {"font_color": "#006100", "bg_color": "#D5EBDD"},
                "open": {"font_color": "#7F4F00", "bg_color": "#FFE3B3"},
                "wrap": {**base, "text_wrap": True, "valign": "top"},
            }.items()
        }
        self.sheets = {name: workbook.add_worksheet(name) for name in (*ENTRY_SHEETS, "Dictionary", "Lists")}

    def write(self) -> None:
        """Write all sheets."""
        materials = self.filling.materials or _typed("materials", MATERIALS)
        standard = [{"tolerance_class": "standard", **row} for row in _typed("standard_class", TOLERANCES)]
        tolerances = [*standard, *self.filling.tolerances]
        classes = [row["tolerance_class"] for row in tolerances]
        write_lists(self.workbook, self.sheets["Lists"], classes)
        self._variants([row["material"] for row in materials], classes)
        self._side("Materials", MATERIALS, materials, "One row per material. Add rows for your own.")
        self._side(
            "Tolerances",
            TOLERANCES,
            tolerances,
            "One row per class and dimension: a grade, or lower and upper deviation. No row: exact.",
        )
        self._settings()
        self._dictionary()

    def _format(self, column: Column) -> Any:
        kind = "number" if column.is_number else "text"
        return self.formats[f"{kind} required" if column.required else kind]

    def _heading(self, name: str, title: str, hint: str, columns: Sequence[Column]) -> Any:
        """Write title, hint and header row of an entry sheet; return the sheet."""
        sheet = self.sheets[name]
        for row in range(HEADER_ROW):
            for place in range(len(columns) + 1):
                sheet.write_blank(row, place, None, self.formats["plain"])
        sheet.write_string(0, 0, title, self.formats["title"])
        sheet.write_string(1, 0, hint, self.formats["hint"])
        sheet.set_row(0, 26)
        sheet.set_row(HEADER_ROW, 62)
        for place, column in enumerate(columns):
            style = "required" if column.required else "header"
            width = _WIDTHS.get(column.key, 13)
            sheet.set_column(place, place, width, self._format(column), self._outline(column))
            sheet.write_string(HEADER_ROW, place, column.label, self.formats[style])
            sheet.write_comment(HEADER_ROW, place, header_note(column), {"x_scale": 2, "y_scale": 1.2})
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

    def _variants(self, materials: Sequence[str], classes: Sequence[str]) -> None:
        """Write the Variants sheet: entries, hints, live status."""
        hint = "Yellow columns are required. Each header has a note; each cell says what it takes."
        sheet = self._heading("Variants", "flexlash: one row per flexspline variant", hint, VARIANTS)
        sheet.write_string(0, 9, f"Template version {TEMPLATE_VERSION}", self.formats["hint"])
        sheet.set_row(2, 18)
        groups: list[str] = []
        for place, column in enumerate(VARIANTS):
            sheet.write_string(2, place, "" if column.group in groups else column.group, self.formats["group"])
            groups.append(column.group)
        status = len(VARIANTS)
        sheet.write_string(2, status, "", self.formats["group"])
        sheet.write_string(HEADER_ROW, status, STATUS_HEADER, self.formats["header"])
        sheet.write_comment(HEADER_ROW, status, "Calculated while you type: what the row still lacks.")
        sheet.set_column(status, status, 36, self.formats["status"])
        letters = {column.key: xl_col_to_name(place) for place, column in enumerate(VARIANTS)}
        rows = self.filling.variants
        texts = [_stored_status(row, rows, materials, classes) for row in rows]
        for place, row in enumerate(rows):
            self._fill(sheet, FIRST_ROW + place, VARIANTS, row)
        for place in range(max(PREPARED_ROWS, len(rows))):
            text = texts[place] if place < len(texts) else ""
            formula = status_formula(FIRST_ROW + place + 1, letters)
            sheet.write_formula(FIRST_ROW + place, status, formula, self.formats["status"], text)
        self._progress(sheet, xl_col_to_name(status), texts)
        self._entry_rules(sheet, VARIANTS, PREPARED_ROWS)
        self._shading(sheet, status)
        sheet.print_area(0, 0, HEADER_ROW + max(_PRINTED_ROWS, len(rows)), status)
        sheet.activate()

    def _progress(self, sheet: Any, letter: str, texts: Sequence[str]) -> None:
        """Write the live sentence that says how many rows are complete and where the first gap is."""
        block = f"${letter}${FIRST_ROW + 1}:${letter}${FIRST_ROW + PREPARED_ROWS}"
        names = f"$A${FIRST_ROW + 1}:$A${FIRST_ROW + PREPARED_ROWS}"
        done, started = f'COUNTIF({block},"{COMPLETE}")', f'COUNTIF({block},"?*")'
        sentence = f'{done}&" of "&{started}&" rows complete"'
        ready = sum(text == COMPLETE for text in texts)
        shown = f"{ready} of {len(texts)} rows complete" if texts else "No row entered yet"
        formula = f'=IF({started}=0,"No row entered yet",{sentence})'
        sheet.write_formula(1, 9, formula, self.formats["live"], shown)
        self.workbook.define_name("fl_variants", f"=Variants!{names}")

    def _shading(self, sheet: Any, status: int) -> None:
        """Colour what is missing, what is double, and the status."""
        last = FIRST_ROW + PREPARED_ROWS - 1
        first, end = xl_col_to_name(0), xl_col_to_name(len(VARIANTS) - 1)
        row = FIRST_ROW + 1
        for place, column in enumerate(VARIANTS):
            if column.required:
                cell = xl_rowcol_to_cell(FIRST_ROW, place)
                criteria = f'=AND(COUNTA(${first}{row}:${end}{row})>0,{cell}="")'
                rule = {"type": "formula", "criteria": criteria, "format": self.formats["open"]}
                sheet.conditional_format(FIRST_ROW, place, last, place, rule)
        sheet.conditional_format(FIRST_ROW, 0, last, 0, {"type": "duplicate", "format": self.formats["open"]})
        cell = f"${xl_col_to_name(status)}{row}"
        for criteria, style in ((f'={cell}="{COMPLETE}"', "good"), (f"=LEN({cell})>0", "open")):
            rule = {
                "type": "formula",
                "criteria": criteria,
                "format": self.formats[style],
                "stop_if_true": True,
            }
            sheet.conditional_format(FIRST_ROW, status, last, status, rule)

    def _fill(self, sheet: Any, row: int, columns: Sequence[Column], values: Mapping[str, Any]) -> None:
        """Write the given values of a row, texts as texts."""
        for place, column in enumerate(columns):
            value = values.get(column.key)
            if isinstance(value, str):
                sheet.write_string(row, place, value, self._format(column))
            elif isinstance(value, bool):
                sheet.write_boolean(row, place, value, self._format(column))
            elif isinstance(value, datetime.date):
                sheet.write_datetime(row, place, value, self.formats["date"])
            elif isinstance(value, ErrorCell):
                sheet.write_formula(row, place, f"={value.text}", self._format(column), value.text)
            elif isinstance(value, Unstored):
                sheet.write_formula(row, place, _UNSTORED_FORMULA, self._format(column), "")
            elif value is not None:
                sheet.write_number(row, place, value, self._format(column))

    def _entry_rules(self, sheet: Any, columns: Sequence[Column], rows: int) -> None:
        """Give every cell of every column its hint and its rule."""
        for place, column in enumerate(columns):
            rule = cell_rule(column, place)
            sheet.data_validation(FIRST_ROW, place, FIRST_ROW + rows - 1, place, rule)

    def _side(self, name: str, columns: Sequence[Column], rows: Sequence[Mapping[str, Any]], hint: str) -> None:
        """Write Materials or Tolerances."""
        sheet = self._heading(name, name, hint, columns)
        for place, row in enumerate(rows):
            self._fill(sheet, FIRST_ROW + place, columns, row)
        self._entry_rules(sheet, columns, SIDE_ROWS)

    def _settings(self) -> None:
        """Write Settings: fixed names, free values, what they mean beside them."""
        sheet = self._heading("Settings", "Settings", "Blank values take the default.", SETTINGS_SHEET)
        for place, column in enumerate(SETTINGS):
            row = FIRST_ROW + place
            sheet.write_string(row, 0, column.key, self.formats["plain"])
            value = self.filling.settings.get(column.key, column.default)
            style = self.formats["number"]
            if isinstance(value, str):
                sheet.write_string(row, 1, value, style)
            elif value is None:
                sheet.write_blank(row, 1, None, style)
            else:
                sheet.write_number(row, 1, value, style)
            sheet.write_string(row, 2, f"{column.help} Allowed: {column.requirement}.", self.formats["meaning"])
            rule = cell_rule(column, 1)
            if column.choices:
                rule |= {"validate": "list", "value": "=fl_methods"}
            sheet.data_validation(row, 1, row, 1, rule)
        sheet.set_column(2, 2, 110, self.formats["hint"])
        sheet.protect("", {"format_columns": True})

    def _dictionary(self) -> None:
        """Write the data dictionary."""
        sheet = self.sheets["Dictionary"]
        headings = {
            "Sheet": 12,
            "Column": 28,
            "Key": 24,
            "Required": 10,
            "Holds": 44,
            "Default": 12,
            "Meaning": 90,
        }
        for place, (heading, width) in enumerate(headings.items()):
            sheet.set_column(place, place, width)
            sheet.write_string(0, place, heading, self.formats["header"])
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
            for place, text in enumerate(texts):
                sheet.write_string(row, place, text, self.formats["wrap"])
        sheet.freeze_panes(1, 0)
        sheet.set_landscape()
        sheet.set_paper(9)
        sheet.fit_to_pages(1, 0)
        sheet.repeat_rows(0)
        sheet.set_footer("&L&A&C&P / &N&Rflexlash template")
        sheet.protect("", {"format_columns": True})


def _stored_status(
    row: Mapping[str, Any], rows: Sequence[Mapping[str, Any]], materials: Sequence[str], classes: Sequence[str]
) -> str:
    """Return what Excel would show as a row's status; an error in the row shows through."""
    error = next((value.text for value in row.values() if isinstance(value, ErrorCell)), None)
    if error is not None:
        return error
    as_excel = {key: 1.0 if isinstance(value, datetime.date | Unstored) else value for key, value in row.items()}
    return status_text(as_excel, rows, materials, classes)
