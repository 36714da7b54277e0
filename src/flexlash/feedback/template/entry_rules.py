"""What guides and guards an entry in the template: notes, cell rules, and the lists behind the drop-downs."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

from xlsxwriter.utility import xl_col_to_name, xl_rowcol_to_cell

from flexlash.feedback.template.decision_status import SIZES
from flexlash.feedback.template.tolerance_status import GRADED
from flexlash.schema.columns import DIMENSIONS, ENTRY_SHEETS, SETTINGS, Column, columns_of

__all__ = [
    "FIRST_ROW",
    "HEADER_ROW",
    "PREPARED_ROWS",
    "SIDE_ROWS",
    "cell_rule",
    "header_note",
    "prepared_rows",
    "write_lists",
]

HEADER_ROW = 3
FIRST_ROW = HEADER_ROW + 1
PREPARED_ROWS = 2000
SIDE_ROWS = 500
_MEASURED_ROWS = 1000
"""LibreOffice keeps the rules of no more than a thousand rows below the last entry."""

_FEW_ROWS = 100
"""Rows of a sheet that has one for a source, a dimension or a study."""

_LISTED_ROWS = {"Measurements": 10_000}
"""Rows whose names are listed, where these are more than those that are prepared."""

_LIST_ROWS = 20
_FAR = 1e9
"""What stands for no bound in a rule that must have one."""

_GRADES = (
    *(f"{letter}{number}" for letter in ("IT", "js", "h", "H") for number in range(5, 13)),
    *(f"2768-{letter}" for letter in "fmcv"),
)
_DEVIATION_UNITS = ("mm", "µm", "in", "%", "N·m", "GPa", "MPa", "-")

_LISTS = {
    ("Variants", "flexspline_type"): "fl_flexspline_types",
    ("Variants", "material"): "fl_materials",
    ("Variants", "tolerance_class"): "fl_tolerance_classes",
    ("Tolerances", "dimension"): "fl_dimensions",
    ("Tolerances", "grade"): "fl_grades",
    ("Tolerances", "deviation_unit"): "fl_deviation_units",
    ("Tolerances", "distribution"): "fl_distributions",
    ("Tolerances", "sample"): "fl_samples",
    ("Tolerances", "scatters_between"): "fl_scatters_between",
    ("Tolerances", "based_on"): "fl_tolerance_classes",
    ("Settings", "setting"): "fl_settings",
    ("Measurements", "use_as"): "fl_uses",
    ("Correlations", "tolerance_class"): "fl_tolerance_classes",
    ("Correlations", "dimension_1"): "fl_dimensions",
    ("Correlations", "dimension_2"): "fl_dimensions",
    ("Other sources", "enter_as"): "fl_enter_as",
    ("Other sources", "distribution"): "fl_source_distributions",
    ("Other sources", "side"): "fl_sides",
    ("Other sources", "kind"): "fl_kinds",
    ("Levers", "dimension"): "fl_levers",
    ("Levers", "may_change"): "fl_answers",
    ("Levers", "tolerance_may_change"): "fl_answers",
    ("Sweep", "variant"): "fl_variant_names",
    ("Sweep", "dimension"): "fl_sizes",
    ("Sweep", "second_dimension"): "fl_sizes",
}

_ROWS = {"Tolerances": "fl_tolerance_rows", "Measurements": "fl_sample_rows"}
"""The cells of a sheet's first column, by name."""

_NAMES = {"Tolerances": "fl_tolerance_classes", "Measurements": "fl_samples"}
"""The names in a sheet's first column, each once."""

_PICK = "Please pick a name from the list."
_OWN_NAMES = {
    "fl_materials": "For a material of your own add a row to the sheet Materials.",
    "fl_tolerance_classes": "For a class of your own add its rows to the sheet Tolerances.",
    "fl_samples": "Samples come from the sheet Measurements.",
    "fl_variant_names": "Variants come from the sheet Variants.",
}
"""Where the names of a list come from."""


def header_note(column: Column) -> str:
    """Return the note on a header."""
    default = "" if column.default is None else f"\nBlank: {column.default}."
    entry = f"\nEnter: {column.requirement}." if column.is_number or column.choices else ""
    return f"{column.help}{entry}{default}"


def prepared_rows(sheet: str, filled: int) -> int:
    """Return how many rows of an entry sheet, so many of them filled, have rules, lists and a status."""
    few = min(SIDE_ROWS, _FEW_ROWS)
    rows = {
        "Variants": PREPARED_ROWS,
        "Measurements": _MEASURED_ROWS,
        **dict.fromkeys(("Other sources", "Levers", "Sweep"), few),
    }
    return max(rows.get(sheet, SIDE_ROWS), filled)


def cell_rule(column: Column, index: int, sheets: Collection[str] = tuple(ENTRY_SHEETS)) -> dict[str, Any]:
    """Return the data validation of a column in a workbook of these sheets: hint, rule, error text."""
    rule: dict[str, Any] = {
        "validate": "any",
        "input_title": column.name[:32],
        "input_message": column.help if len(column.help) <= 255 else column.help[:254] + "…",  # noqa: PLR2004
        "error_title": column.name[:32],
        "error_message": f"Please enter {column.requirement}."[:255],
    }
    name = _LISTS.get((column.sheet, column.key))
    if name == _NAMES["Measurements"] and "Measurements" not in sheets:
        rule["input_message"] += " For this add the sheet Measurements: flexlash template --with measurements."
    elif name:
        words = f"{_PICK} {_OWN_NAMES.get(name, '')}".strip()
        rule |= {"validate": "list", "value": f"={name}", "error_message": words}
    elif column.is_number:
        rule |= {"validate": "integer" if column.type == "integer" else "decimal"}
        if column.minimum is None:
            rule |= {
                "criteria": "between",
                "minimum": -1e9,
                "maximum": 1e9 if column.maximum is None else column.maximum,
            }
        elif column.maximum is not None:
            rule |= {"criteria": "between", "minimum": column.minimum, "maximum": column.maximum}
        else:
            rule |= {"criteria": ">" if column.exclusive_minimum else ">=", "value": column.minimum}
    elif column.key == "variant":
        cell = xl_rowcol_to_cell(FIRST_ROW, index)
        rule |= {"validate": "custom", "value": f"=COUNTIF(fl_variants,{cell})=1"}
        rule["error_message"] = "This name is already used. Give each variant a name of its own."
    return rule


def write_lists(workbook: Any, sheet: Any, names: Mapping[str, Sequence[str]]) -> None:
    """Write the hidden lists behind the drop-downs and name them.

    `names` are those in the first column of each sheet of the workbook, row by row.
    """
    lists = {
        "fl_flexspline_types": _choices("Variants", "flexspline_type"),
        "fl_distributions": _choices("Tolerances", "distribution"),
        "fl_dimensions": _choices("Tolerances", "dimension"),
        "fl_grades": _GRADES,
        "fl_deviation_units": _DEVIATION_UNITS,
        **{f"fl_{column.key}s": column.choices for column in SETTINGS if column.choices},
        "fl_settings": _choices("Settings", "setting"),
        "fl_graded_dimensions": GRADED,
        "fl_scatters_between": _choices("Tolerances", "scatters_between"),
        **_optional_lists(names),
    }
    for index, (name, entries) in enumerate(lists.items()):
        letter = xl_col_to_name(index)
        sheet.write_string(0, index, name)
        sheet.write_column(1, index, entries)
        workbook.define_name(name, f"=Lists!${letter}$2:${letter}${len(entries) + 1}")
    workbook.define_name("fl_materials", _filled_part(_first_column("Materials", names)))
    if "Sweep" in names:
        workbook.define_name("fl_variant_names", _filled_part(_first_column("Variants", names)))
    for schema, title in _ROWS.items():
        if schema in names:
            workbook.define_name(title, f"={_first_column(schema, names)}")
    if "Correlations" in names:
        block = _first_column("Tolerances", names).replace("$A$", "$B$")
        workbook.define_name("fl_tolerance_dimensions", f"={block}")
    for index, schema in enumerate((one for one in _NAMES if one in names), start=len(lists)):
        _write_names(workbook, sheet, index, schema, names)
    sheet.hide()
    sheet.protect()


def _choices(sheet: str, key: str) -> Sequence[Any]:
    return columns_of(sheet)[key].choices


def _optional_lists(sheets: Collection[str]) -> dict[str, Sequence[Any]]:
    """Return the lists of the optional sheets among these; beside the dimensions of levers stand their bounds."""
    lists: dict[str, Sequence[Any]] = {}
    if "Measurements" in sheets:
        lists["fl_uses"] = _choices("Measurements", "use_as")
    if "Other sources" in sheets:
        lists["fl_enter_as"] = _choices("Other sources", "enter_as")
        lists["fl_source_distributions"] = _choices("Other sources", "distribution")
        lists["fl_sides"] = _choices("Other sources", "side")
        lists["fl_kinds"] = _choices("Other sources", "kind")
    if "Levers" in sheets:
        lists["fl_answers"] = _choices("Levers", "may_change")
    if "Sweep" in sheets:
        lists["fl_sizes"] = SIZES
    if not {"Levers", "Sweep"}.isdisjoint(sheets):
        bounds = [DIMENSIONS[name] for name in SIZES]
        lists["fl_levers"] = _choices("Levers", "dimension")
        lists["fl_lever_least"] = [column.minimum or 0 for column in bounds]
        lists["fl_lever_above"] = [int(column.exclusive_minimum) for column in bounds]
        lists["fl_lever_most"] = [_FAR if column.maximum is None else column.maximum for column in bounds]
    return lists


def _filled_part(block: str) -> str:
    """Return the formula of the cells of a block down to its last entry, where there is no gap."""
    return f"={block.partition(':')[0]}:INDEX({block},MAX(1,COUNTA({block})))"


def _first_column(schema: str, names: Mapping[str, Sequence[str]]) -> str:
    """Return the cells of a sheet's first column whose names are listed."""
    rows = max(prepared_rows(schema, len(names[schema])), _LISTED_ROWS.get(schema, 0))
    return f"{schema}!$A${FIRST_ROW + 1}:$A${FIRST_ROW + rows}"


def _write_names(workbook: Any, sheet: Any, index: int, schema: str, names: Mapping[str, Sequence[str]]) -> None:
    """Write the formulas that collect the names in a sheet's first column, each once."""
    letter, title = xl_col_to_name(index), _NAMES[schema]
    rows = _first_column(schema, names)
    # LOOKUP finds the last name that is not listed yet, so the names after the first stand in reverse.
    first, *others = dict.fromkeys(names[schema]) or ("",)
    listed = [first, *(name for name in reversed(others) if name)]
    sheet.write_string(0, index, title)
    sheet.write_formula(1, index, f'={rows.split(":", maxsplit=1)[0]}&""', None, listed[0])
    for row in range(2, _LIST_ROWS + 2):
        above = f"${letter}$2:${letter}${row}"
        formula = f'=IFERROR(LOOKUP(2,1/((COUNTIF({above},{rows})=0)*({rows}<>"")),{rows}),"")'
        value = listed[row - 1] if row - 1 < len(listed) else ""
        sheet.write_formula(row, index, formula, None, value)
    block = f"Lists!${letter}$2:${letter}${_LIST_ROWS + 2}"
    end = f'INDEX({block},MAX(1,COUNTIF({block},"?*")))'
    workbook.define_name(title, f"=Lists!${letter}$2:{end}")
