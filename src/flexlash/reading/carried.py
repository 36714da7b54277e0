"""What a report carries → the submission it was made of: one text on a hidden sheet, every part of it checked."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable
from typing import Any, get_args

from flexlash.reading.cells_json import cells_from_json
from flexlash.reading.raw import CsvDialect, ErrorCell, Percentage, RawSheet, RawValue, Submission
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.survey import MOST_ROWS
from flexlash.reading.worksheet import MAXIMUM_COLUMN, MAXIMUM_ROW
from flexlash.reading.xlsx import Cells, read_workbook
from flexlash.schema.angle_unit import ARC_MINUTES
from flexlash.schema.columns import SETTINGS
from flexlash.schema.findings import shown
from flexlash.schema.variant import OVERRIDDEN

__all__ = ["FORM", "SHEET", "SWITCHES", "carried_changes", "carried_submission", "read_report"]

SHEET = "Carried"
"""The sheet of a report that holds, in pieces below each other, the text that it carries."""

FORM = 1
"""The form of that text that this program writes, and the latest it reads."""

RESULTS = "Results"
SWITCHES = ("cross_check", "elasticity", "strict")
_NONSENSE = (ValueError, TypeError, LookupError, AttributeError, RecursionError, OverflowError)
"""What arises where a text is not what it should be."""

_TARGET, _UNIT = "target_percent", "angle_unit"
_DIGEST = re.compile("[0-9a-f]{64}")
_KINDS = frozenset({"workbook", "csv", "parquet"})
_DELIMITERS = frozenset(",;\t|")
_LONGEST_NAME = 255
_ALTERED = "they were altered or damaged"


def read_report(
    data: bytes, limits: ReadingLimits, limits_of_file: ReadingLimits
) -> tuple[Submission, RawSheet | None, str, dict[str, str]]:
    """Return the submission that a report carries, its Results, its version, the cheapest changes by variant.

    Nothing else of it is read.

    `limits` hold for the submission, `limits_of_file` for the report.

    Raises Refusal when the workbook is unsafe, is no report, or carries nothing that makes a submission.
    """
    cells = read_workbook(data, limits_of_file, only=(SHEET, RESULTS))
    sheets = {sheet.name: sheet for sheet in cells.sheets}
    if SHEET not in sheets:
        raise Refusal("E121" if cells.role == "report" else "E120")
    carried = _parsed(sheets[SHEET])
    return carried_submission(carried, limits), sheets.get(RESULTS), carried["version"], carried_changes(carried)


def carried_changes(carried: Any) -> dict[str, str]:
    """Return the cheapest changes that a report tells, none of one of before 0.10; raise Refusal for what are none."""
    try:
        changes = carried.get("changes", {})
        _require(all(isinstance(text, str) and len(text) <= _LONGEST_NAME for text in changes.values()))
        return dict(changes)
    except _NONSENSE as fault:
        raise Refusal("E122", found=_ALTERED) from fault


def _parsed(sheet: RawSheet) -> Any:
    """Return what the text on the sheet says."""
    try:
        return json.loads("".join(str(cells[1]) for cells in sheet.rows.values() if 1 in cells))
    except _NONSENSE as fault:
        raise Refusal("E122", found=_ALTERED) from fault


def carried_submission(carried: Any, limits: ReadingLimits) -> Submission:
    """Return the submission that a report carries; raise Refusal when it is none that could have been read."""
    try:
        _require(type(carried["form"]) is int, carried["form"] >= 1, isinstance(carried["version"], str))
        if carried["form"] > FORM:
            raise Refusal(
                "E122", found=f"flexlash {shown(carried['version'])} wrote them, which is later than this one"
            )
        cells, head = cells_from_json(carried["cells"]), carried["submission"]
        _check_head(head, cells)
        _check_sheets(cells.sheets, limits, MAXIMUM_ROW if head["kind"] == "workbook" else MOST_ROWS + 1)
        return Submission(
            name=head["name"],
            sha256=head["sha256"],
            kind=head["kind"],
            sheets={sheet.name: sheet for sheet in cells.sheets},
            modified=cells.modified,
            role=cells.role,
            template_version=cells.template_version,
            run_with=_options(carried["options"]),
            worst_of=head.get("worst_of", 0),
        )
    except _NONSENSE as fault:
        raise Refusal("E122", found=_ALTERED) from fault


def _require(*facts: bool) -> None:
    if not all(facts):
        raise ValueError(_ALTERED)


def _check_head(head: dict[str, Any], cells: Cells) -> None:
    """Require the name, digest and kind of a file."""
    _require(
        isinstance(head["name"], str) and 0 < len(head["name"]) <= _LONGEST_NAME,
        bool(_DIGEST.fullmatch(head["sha256"])),
        head["kind"] in _KINDS,
        type(head.get("worst_of", 0)) is int and 0 <= head.get("worst_of", 0) <= MOST_ROWS,
        isinstance(cells.role, str),
        isinstance(cells.template_version, str),
        cells.modified is None or cells.modified.tzinfo is None,
    )


def _options(carried: dict[str, Any]) -> dict[str, Any]:
    """Return the options of a run, each within the bounds of its setting."""
    columns = {column.key: column for column in SETTINGS}
    for name in ("seed", "samples"):
        value, column = carried[name], columns[name]
        fits = type(value) is int and (column.minimum or 0) <= value <= (column.maximum or math.inf)
        _require(fits or (name == "samples" and value is None))
    _require(carried["method"] in columns["method"].choices, *(isinstance(carried[name], bool) for name in SWITCHES))
    # Reports of before 0.10 have the target among the settings of the submission alone, and no unit of angles.
    target, column = carried.get(_TARGET), columns[_TARGET]
    if target is not None:
        _require(type(target) in {int, float} and (column.minimum or 0) <= target <= (column.maximum or math.inf))
    _require(carried.get(_UNIT, ARC_MINUTES.name) in columns[_UNIT].choices)
    return {name: carried[name] for name in (*OVERRIDDEN, *SWITCHES) if name in carried}


def _check_sheets(sheets: list[RawSheet], limits: ReadingLimits, last: int) -> None:
    """Require cells as reading yields them, no more of them than a file may have, none beyond the last row."""
    limits.require("sheets", len(sheets))
    limits.require("cells", sum(len(cells) for sheet in sheets for cells in sheet.rows.values()))
    _require(len({sheet.name for sheet in sheets}) == len(sheets))
    for sheet in sheets:
        rows = list(sheet.rows)
        _require(
            isinstance(sheet.name, str) and 0 < len(sheet.name) <= _LONGEST_NAME,
            _are_numbers(rows, last) and rows == sorted(rows),
            _are_numbers(sheet.hidden_rows, last),
            all(len(area) == 4 and _are_numbers(area, last) for area in sheet.merged),  # noqa: PLR2004
            isinstance(sheet.hidden, bool),
            isinstance(sheet.numbers_are_texts, bool),
            sheet.dialect is None or _is_dialect(sheet.dialect, last),
        )
        for cells in sheet.rows.values():
            _require(_are_numbers(cells, MAXIMUM_COLUMN), all(map(_is_value, cells.values())))


def _are_numbers(numbers: Iterable[Any], most: int) -> bool:
    """Whether these are row or column numbers."""
    return all(type(number) is int and 1 <= number <= most for number in numbers)


def _is_value(value: Any) -> bool:
    """Whether a cell can hold this."""
    if isinstance(value, ErrorCell):
        return isinstance(value.text, str)
    if isinstance(value, Percentage):
        return math.isfinite(value)
    return isinstance(value, get_args(RawValue))


def _is_dialect(dialect: CsvDialect, last: int) -> bool:
    """Whether a delimited text can have been written like this."""
    addresses = (dialect.comma_number, dialect.foreign_text)
    return (
        dialect.delimiter in _DELIMITERS
        and isinstance(dialect.encoding, str)
        and isinstance(dialect.file, str)
        and _are_numbers(dialect.longer, last)
        and all(address is None or (len(address) == 2 and _are_numbers(address, last)) for address in addresses)  # noqa: PLR2004
    )
