"""What guides and guards an entry in the template: notes, cell rules, and the lists behind the drop-downs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from xlsxwriter.utility import xl_col_to_name, xl_rowcol_to_cell

from flexlash.schema.columns import ENTRY_SHEETS, SETTINGS, Column

__all__ = ["FIRST_ROW", "HEADER_ROW", "PREPARED_ROWS", "SIDE_ROWS", "cell_rule", "header_note", "write_lists"]

HEADER_ROW = 3
FIRST_ROW = HEADER_ROW + 1
PREPARED_ROWS = 2000
SIDE_ROWS = 500
_LIST_ROWS = 20

_GRADES = (
    *(f"{letter}{number}" for letter in ("IT", "js", "h", "H") for number in range(5, 13)),
    *(f"2768-{letter}" for letter in "fmcv"),
)
_DEVIATION_UNITS = ("mm", "µm", "in", "%", "N·m", "GPa", "MPa", "-")


def header_note(column: Column) -> str:
    """Return the note on a header."""
    default = "" if column.default is None else f"\nBlank: {column.default}."
    return f"{column.help}\nHolds {column.requirement}.{default}"


_LISTS = {
    ("Variants", "flexspline_type"): "fl_flexspline_types",
    ("Variants", "material"): "fl_materials",
    ("Variants", "tolerance_class"): "fl_tolerance_classes",
    ("Tolerances", "dimension"): "fl_dimensions",
    ("Tolerances", "grade"): "fl_grades",
    ("Tolerances", "deviation_unit"): "fl_deviation_units",
    ("Tolerances", "distribution"): "fl_distributions",
    ("Settings", "setting"): "fl_settings",
}


def cell_rule(column: Column, index: int) -> dict[str, Any]:
    """Return the data validation of a column: hint, rule, error text."""
    rule: dict[str, Any] = {
        "validate": "any",
        "input_title": column.name[:32],
        "input_message": column.help if len(column.help) <= 255 else column.help[:254] + "…",  # noqa: PLR2004
        "error_title": column.name[:32],
        "error_message": f"{column.requirement[:1].upper()}{column.requirement[1:]} is required here."[:255],
    }
    if name := _LISTS.get((column.sheet, column.key)):
        rule |= {"validate": "list", "value": f"={name}"}
        rule["error_message"] = "Pick an entry of the list. Add materials and tolerance classes on their sheets."
    elif column.is_number:
        rule |= {"validate": "integer" if column.type == "integer" else "decimal"}
        if column.minimum is None:
            rule |= {"criteria": "between", "minimum": -1e9, "maximum": 1e9}
        elif column.maximum is not None:
            rule |= {"criteria": "between", "minimum": column.minimum, "maximum": column.maximum}
        else:
            rule |= {"criteria": ">" if column.exclusive_minimum else ">=", "value": column.minimum}
    elif column.key == "variant":
        cell = xl_rowcol_to_cell(FIRST_ROW, index)
        rule |= {"validate": "custom", "value": f"=COUNTIF(fl_variants,{cell})=1"}
        rule["error_message"] = "This name is already used. Give each variant a name of its own."
    return rule


def write_lists(workbook: Any, sheet: Any, classes: Sequence[str], rows: int = SIDE_ROWS) -> None:
    """Write the hidden lists behind the drop-downs and name them.

    `classes` are the names in Tolerances, row by row; `rows` is how many rows of Materials and Tolerances are listed.
    """
    choices = {column.key: column.choices for columns in ENTRY_SHEETS.values() for column in columns}
    lists = {
        "fl_flexspline_types": choices["flexspline_type"],
        "fl_distributions": choices["distribution"],
        "fl_dimensions": choices["dimension"],
        "fl_grades": _GRADES,
        "fl_deviation_units": _DEVIATION_UNITS,
        "fl_methods": next(column.choices for column in SETTINGS if column.key == "method"),
        "fl_settings": choices["setting"],
    }
    for index, (name, entries) in enumerate(lists.items()):
        letter = xl_col_to_name(index)
        sheet.write_string(0, index, name)
        sheet.write_column(1, index, entries)
        workbook.define_name(name, f"=Lists!${letter}$2:${letter}${len(entries) + 1}")
    first, last = FIRST_ROW + 1, FIRST_ROW + rows
    for name, title in (("Materials", "fl_materials"), ("Tolerances", "fl_tolerance_rows")):
        block = f"{name}!$A${first}:$A${last}"
        end = f"INDEX({block},MAX(1,COUNTA({block})))"
        workbook.define_name(title, f"={name}!$A${first}:{end}")
    _write_classes(workbook, sheet, len(lists), classes, last)
    sheet.hide()
    sheet.protect()


def _write_classes(workbook: Any, sheet: Any, index: int, classes: Sequence[str], last: int) -> None:
    """Write the formulas that collect the names of the tolerance classes, each once."""
    letter = xl_col_to_name(index)
    rows = f"Tolerances!$A${FIRST_ROW + 1}:$A${last}"
    # LOOKUP finds the last name that is not listed yet, so the names after the first stand in reverse.
    first, *others = dict.fromkeys(classes) or ("",)
    names = [first, *(name for name in reversed(others) if name)]
    sheet.write_string(0, index, "fl_tolerance_classes")
    sheet.write_formula(1, index, f'={rows.split(":", maxsplit=1)[0]}&""', None, names[0])
    for row in range(2, _LIST_ROWS + 2):
        above = f"${letter}$2:${letter}${row}"
        formula = f'=IFERROR(LOOKUP(2,1/((COUNTIF({above},{rows})=0)*({rows}<>"")),{rows}),"")'
        value = names[row - 1] if row - 1 < len(names) else ""
        sheet.write_formula(row, index, formula, None, value)
    block = f"Lists!${letter}$2:${letter}${_LIST_ROWS + 2}"
    end = f'INDEX({block},MAX(1,COUNTIF({block},"?*")))'
    workbook.define_name("fl_tolerance_classes", f"=Lists!${letter}$2:{end}")
