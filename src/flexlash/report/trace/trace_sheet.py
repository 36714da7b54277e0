"""The Trace sheet: one variant picked by drop-down, worked in live formulas from its inputs to backlash and stress.

The reader may type other inputs beside the submitted ones. The program's numbers stand beside the traced ones with the
difference of the two. Sums over points and the search for a greatest stress stand in Trace steps.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from xlsxwriter.utility import xl_rowcol_to_cell

from flexlash.report.formula.functions import CONCATENATE, COUNTA, FIXED, IF, MAX, MIN, OR, match_exactly
from flexlash.report.formula.live import Live, Range, fill, put
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.paper import Listed, print_one_page
from flexlash.report.layout.styles import PALETTE, Book
from flexlash.report.trace.trace_inputs import write_inputs
from flexlash.report.trace.trace_mechanics import write_integrals, write_shape, write_sums, write_windups
from flexlash.report.trace.trace_page import CHANGE, HEADER, LEFT_OUT, SHEET, SUBMITTED, VALUE, WIDTHS, Page
from flexlash.report.trace.trace_steps import Steps
from flexlash.report.trace.trace_strength import write_buckling, write_stresses
from flexlash.schema.number_words import grouped

__all__ = ["AGREEMENT", "AGREES", "CHANGED", "NOT_LISTED", "NO_PART", "UNREAL", "trace_sheet", "write_trace"]

AGREEMENT = 1e-12
"""Relative difference up to which a traced number agrees with the program's."""

AGREES, CHANGED, _DIFFERS = "agrees to 1e-12", "inputs changed", "differs"
NOT_LISTED = "◄ not on the list: pick one"
NO_PART = "◄ these inputs make no part: "
UNREAL = "◄ no flexspline has such a backlash: check values and units (E324)"
_LEAST, _MOST = 1e-12, 10.0
"""Backlash [rad] between which a submission is computed."""

_LINES_BELOW = 100
"""More than the lines of results."""

_PICK, _EQUATION, _PLACE = 1, 4, 5


def trace_sheet(book: Book) -> Any:
    """Return the sheet for Trace in its place among the others; its steps come where it is written."""
    return book.sheet(SHEET, landscape=False, tab="entry")


def write_trace(book: Book, sheet: Any, inputs: Stored, total: int, picked: int = 0) -> Mapping[str, Live]:
    """Write Trace, and its steps on a new sheet, with the variant of this index picked; return lines by key."""
    sheet.write_string(0, 0, "Trace: one variant from its inputs to backlash and stress", book.format("title"))
    sheet.set_row(0, 28)
    note = (
        "Pick a variant. Type another input into a yellow cell and everything follows; "
        f"{LEFT_OUT} leaves an input out, an empty cell takes it as submitted."
    )
    if len(inputs.rows) < total:
        note = f"The {len(inputs.rows)} worst of {grouped(total)} variants can be picked. {note}"
    if not inputs.rows:
        return {}
    sheet.write_string(1, 0, note, book.format("quiet"))
    page = Page(book, sheet, _pick(book, sheet, inputs, picked), inputs)
    page.lines["number"] = page.number
    changes = write_inputs(page)
    steps = Steps(page)
    fault = steps.fault()
    page.judge(fault)
    _hide_unreal(page)
    write_shape(page)
    write_integrals(page, steps)
    write_windups(page)
    write_sums(page)
    write_stresses(page, steps)
    write_buckling(page)
    _write_headline(page, fault, _write_verdict(page, changes))
    sheet.freeze_panes(HEADER + 1, 0)
    sheet.repeat_rows(HEADER)
    ends = [row - 2 for row in page.sections[1:]]
    print_one_page(sheet, WIDTHS, page.row, upright=True, ends=ends, listed=Listed(noun="sections"))
    return page.lines


def _pick(book: Book, sheet: Any, inputs: Stored, picked: int) -> Live:
    """Write the drop-down and return the reference to the number of the variant."""
    names = inputs.cells("Variant")
    sheet.write_string(2, 0, "Variant", book.format("label"))
    style = book.format("input")
    sheet.merge_range(2, _PICK, 2, _EQUATION - 1, "", style)
    name = fill(sheet, 2, _PICK, str(names.values[picked]), style)
    sheet.data_validation(2, _PICK, 2, _PICK, {
        "validate": "list",
        "source": f"={names.text}",
        "input_title": "Variant",
        "input_message": "The whole sheet follows.",
        "error_title": "Variant",
        "error_message": "Pick a variant from the list.",
    })  # fmt: skip
    return put(sheet, HEADER - 1, _PLACE, match_exactly(name, names), book.format("quiet", '"number "0'))


def _hide_unreal(page: Page) -> None:
    """Let no number show below while the headline says that the backlash is no flexspline's."""
    headline = xl_rowcol_to_cell(HEADER - 2, _EQUATION, row_abs=True, col_abs=True)
    hidden = page.book.workbook.add_format({"num_format": '"none";"none";"none";@', "font_color": PALETTE["grey"]})
    rule = {"type": "formula", "criteria": f'={headline}="{UNREAL}"', "format": hidden, "stop_if_true": True}
    for column in (VALUE, VALUE + 1, SUBMITTED, CHANGE):
        page.sheet.conditional_format(page.row + 1, column, page.row + _LINES_BELOW, column, rule)


def _write_verdict(page: Page, changes: Range) -> Live:
    """Write how far the trace is from the program; return it in words."""
    page.section("7  Agreement with the program")
    first, last = min(page.rows[key] for key in page.rows if key.endswith("_windup")), page.row
    cells = ":".join(xl_rowcol_to_cell(row, CHANGE, row_abs=True, col_abs=True) for row in (first, last))
    differences = [value for value in page.differences if isinstance(value, float)]
    beside = Range(cells, differences)
    off = MAX(MAX(beside), -MIN(beside))
    words = ("Greatest relative difference", "", "", "of the lines that have a value of the program")
    largest = page.line("difference", off, words, "difference")
    verdict = IF(largest <= AGREEMENT, AGREES, _DIFFERS)
    return page.line(
        "verdict",
        IF(COUNTA(changes) > 0, CHANGED, verdict),
        ("Verdict", "", "", "traced numbers beside the program's"),
        "plain",
    )


def _write_headline(page: Page, fault: Live, verdict: Live) -> None:
    """Write the backlash beside the drop-down, or why there is none."""
    backlash, angles = page["backlash"], page.book.angles
    answer = CONCATENATE("◄ backlash ", FIXED(backlash / page.radians, 4 - angles.fewer), f"{angles.sign}, ", verdict)
    is_unreal = OR(backlash <= _LEAST, backlash >= _MOST)
    told = IF(fault.equals(""), IF(is_unreal, UNREAL, answer), CONCATENATE(NO_PART, fault))
    said = IF(page.number.equals(0.0), NOT_LISTED, told)
    put(page.sheet, HEADER - 2, _EQUATION, said, page.book.format("label"))
