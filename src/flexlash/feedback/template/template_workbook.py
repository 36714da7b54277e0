"""Columns → the Excel template, empty or filled; the same bytes every time."""

from __future__ import annotations

import datetime
import io
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import xlsxwriter

from flexlash.feedback.template.cell_writer import CellWriter
from flexlash.feedback.template.decision_status import LEVER_STATUS, SOURCE_STATUS, SWEEP_STATUS
from flexlash.feedback.template.demanded_cells import asking_types
from flexlash.feedback.template.dictionary_sheet import write_dictionary
from flexlash.feedback.template.entry_colours import shade_entries
from flexlash.feedback.template.entry_rules import (
    FIRST_ROW,
    HEADER_ROW,
    cell_rule,
    header_note,
    prepared_rows,
    write_lists,
)
from flexlash.feedback.template.filling import Entries, Filling, study
from flexlash.feedback.template.print_pages import print_side_by_side, set_up_page
from flexlash.feedback.template.sketch_sheet import SKETCH, write_sketch
from flexlash.feedback.template.status_column import STATUS_WIDTH, write_progress, write_status
from flexlash.feedback.template.stored_status import counted, counted_pairs, listed_names
from flexlash.feedback.template.template_formats import cell_formats
from flexlash.feedback.template.tolerance_status import CORRELATION_STATUS, tolerance_status
from flexlash.feedback.template.variant_status import VARIANT_STATUS
from flexlash.schema.columns import SETTINGS, Column
from flexlash.validation.template_versions import TEMPLATE_VERSION

__all__ = ["LEGEND", "LINKS", "TITLES", "Filling", "study", "template_bytes"]

TITLES = {
    "Variants": (
        "Variants",
        "One flexspline per row. Fill the yellow cells: the type decides which. White cells may stay blank.",
    ),
    "Materials": ("Materials", "One row per material. Add rows for your own."),
    "Tolerances": (
        "Tolerances",
        "One row per class and dimension: a grade, or lower and upper deviation. A dimension without a row is exact, "
        "or as in the class that this one is based on.",
    ),
    "Settings": ("Settings", "A blank value takes its default. Nothing here must be changed."),
    "Other sources": (
        "Other sources",
        "One row per source of backlash beside the wind-up of the flexspline: its play, its deviations, or both. One "
        "budget for all variants.",
    ),
    "Levers": (
        "Levers",
        "One row per dimension: whether it may change, how far, in which steps, at which relative cost. No row: the "
        "built-in defaults.",
    ),
    "Sweep": (
        "Sweep",
        "One row per study: a dimension, or two, in steps from the first value to the last.",
    ),
    "Measurements": (
        "Measurements",
        "One row per measured part; blank where it was not measured. Dimensions measured on the same parts give their "
        "correlation.",
    ),
    "Correlations": (
        "Correlations",
        "One row per class and pair of dimensions that scatter together. No row: independent, or as measured.",
    ),
}
"""Title and hint above each entry sheet."""

_OUTLINED = ("Refinements", "Process")
"""Groups of columns that can be folded away."""

_PRINTED_ROWS = {
    "Variants": 90,
    "Tolerances": 42,
    "Correlations": 25,
    "Other sources": 25,
    "Levers": 30,
    "Sweep": 25,
}
"""Rows that are printed at least of a sheet whose formulas reach further down than its entries."""

LEGEND = {"needed": "fill in", "missing": "missing", "unused": "leave blank", "wrong": "clear it"}
"""What the colours of a cell of Variants say."""

LINKS = {SKETCH: "? Symbols: sheet Sketch", "Dictionary": "? Every column in words: sheet Dictionary"}
"""Where Variants leads to for help, and in which words."""

_LEGEND_COLUMN, _LINK_COLUMN = 5, 11
_OWN_WIDTH = 16

_DATE = datetime.datetime(2026, 1, 1, tzinfo=datetime.UTC).replace(tzinfo=None)

_WIDTHS = {
    "variant": 24,
    "material": 24,
    "notes": 40,
    "source": 86,
    "dimension": 24,
    "setting": 24,
    "value": 14,
    "sample": 20,
    "based_on": 20,
    "dimension_1": 24,
    "dimension_2": 24,
    "reason": 56,
    "enter_as": 16,
    "second_dimension": 24,
}
_WIDTHS_OF_SHEETS = {("Other sources", "source"): 30, ("Other sources", "distribution"): 17}


def _width(name: str, column: Column) -> int:
    """Return how wide a column of an entry sheet is [characters]."""
    return _WIDTHS_OF_SHEETS.get((name, column.key)) or _WIDTHS.get(column.key, 13)


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
        self.formats = cell_formats(workbook)
        self.entries = {name: filling.entries(name) for name in filling.sheet_names}
        first, *others = self.entries
        names = (first, SKETCH, *others, "Dictionary", "Lists")
        self.sheets = {name: workbook.add_worksheet(name) for name in names}
        self.names = {name: listed_names(entries) for name, entries in self.entries.items() if name != "Settings"}

    def write(self) -> None:
        """Write all sheets."""
        write_lists(self.workbook, self.sheets["Lists"], self.names)
        known = {
            "fl_variants": counted(name for name in self.names["Variants"] if name),
            "fl_materials": counted(self.names["Materials"]),
            "fl_tolerance_rows": counted(self.names["Tolerances"]),
            "fl_tolerance_dimensions": counted_pairs(self.entries["Tolerances"], "tolerance_class", "dimension"),
            "fl_sample_rows": counted(self.names.get("Measurements", ())),
        }
        stages = {
            "Variants": VARIANT_STATUS,
            "Tolerances": tolerance_status(has_measurements="Measurements" in self.entries),
            "Correlations": CORRELATION_STATUS,
            "Other sources": SOURCE_STATUS,
            "Levers": LEVER_STATUS,
            "Sweep": SWEEP_STATUS,
        }
        for name, entries in self.entries.items():
            if name == "Settings":
                self._settings(entries)
                continue
            sheet = self._table(name, entries, has_status=name in stages)
            if name in stages:
                texts = write_status(self.workbook, sheet, entries, (stages[name], known), self.formats)
                if name == "Variants":
                    self._variants(sheet, entries, texts)
                last = len(entries.columns) + len(entries.own)
                sheet.print_area(0, 0, HEADER_ROW + max(_PRINTED_ROWS[name], len(texts)), last)
            self._print(sheet, name, entries, has_status=name in stages)
        write_sketch(self.workbook, self.sheets[SKETCH], self.sheets["Lists"], self.formats)
        write_dictionary(self.sheets["Dictionary"], self.formats, self.entries)

    @staticmethod
    def _print(sheet: Any, name: str, entries: Entries, *, has_status: bool) -> None:
        """Print a sheet whose last column but the user's own may be its status."""
        columns = entries.columns
        behind = [*([STATUS_WIDTH] if has_status else []), *(_OWN_WIDTH for _ in entries.own)]
        widths = [*(_width(name, column) for column in columns), *behind]
        groups = [index for index, (one, next_) in enumerate(pairwise(columns), start=1) if one.group != next_.group]
        print_side_by_side(sheet, widths, groups)

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
        sheet.write_string(1, 1, hint, self.formats["hint"])
        sheet.set_row(0, 26)
        sheet.set_row(HEADER_ROW, 62)
        for index, column in enumerate(columns):
            some = "required by some" if asking_types(column) else "header"
            style = "required" if column.required else some
            sheet.set_column(index, index, _width(name, column), self._format(column), self._outline(column))
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
        set_up_page(sheet, HEADER_ROW)
        return sheet

    @staticmethod
    def _outline(column: Column) -> dict[str, int]:
        return {"level": 1} if column.group in _OUTLINED else {}

    def _table(self, name: str, entries: Entries, *, has_status: bool) -> Any:
        """Write a sheet's headings and entries, with the rules of all prepared rows; return the sheet."""
        sheet, columns = self._heading(name, entries), entries.columns
        if any(column.group for column in columns):
            self._groups(sheet, columns)
        self._fill(sheet, entries, len(columns) + has_status)
        rows = prepared_rows(name, len(entries.rows))
        for index, column in enumerate(columns):
            rule = cell_rule(column, index, self.entries)
            sheet.data_validation(FIRST_ROW, index, FIRST_ROW + rows - 1, index, rule)
        shade_entries(sheet, columns, rows, self.formats)
        return sheet

    def _groups(self, sheet: Any, columns: Sequence[Column]) -> None:
        """Write the names of groups of columns above the first of each."""
        sheet.set_row(2, 18)
        groups: list[str] = []
        for index, column in enumerate(columns):
            sheet.write_string(2, index, "" if column.group in groups else column.group, self.formats["group"])
            groups.append(column.group)
        sheet.write_string(2, len(columns), "", self.formats["group"])

    def _variants(self, sheet: Any, entries: Entries, texts: Sequence[str]) -> None:
        """Write what Variants alone has: the version, the count of complete rows, the colour of doubled names."""
        sheet.write_string(0, 9, f"Template version {TEMPLATE_VERSION}", self.formats["hint"])
        write_progress(self.workbook, sheet, len(entries.columns), texts, self.formats["live"])
        last = FIRST_ROW + prepared_rows("Variants", len(texts)) - 1
        sheet.conditional_format(FIRST_ROW, 0, last, 0, {"type": "duplicate", "format": self.formats["open"]})
        for index, (style, words) in enumerate(LEGEND.items(), start=_LEGEND_COLUMN):
            sheet.write_string(0, index, words, self.formats[f"legend {style}"])
        for row, (name, words) in enumerate(LINKS.items()):
            sheet.write_url(row, _LINK_COLUMN, f"internal:'{name}'!A1", self.formats["link"], words)
        sheet.activate()
        sheet.set_selection(FIRST_ROW, 0, FIRST_ROW, 0)

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
                rule |= {"validate": "list", "value": f"=fl_{column.key}s"}
            sheet.data_validation(row, 1, row, 1, rule)
        sheet.set_column(meaning, meaning, 110, self.formats["hint"])
        sheet.protect("", {"format_columns": True})
