"""The Trace sheet: one variant picked by drop-down, worked in live formulas from its inputs to backlash and stress.

The reader may type other inputs beside the submitted ones. The program's numbers stand beside the traced ones with the
difference of the two. Sums over points and the search for a greatest stress stand in Trace steps.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from xlsxwriter.utility import xl_rowcol_to_cell

from flexlash.report.live import Live, fill, fixed, greatest, joined, place_of_name, put, when
from flexlash.report.stored import Stored
from flexlash.report.styles import Book
from flexlash.report.trace.ranges import PI, filled, greatest_in, least_in
from flexlash.report.trace.trace_inputs import LEFT_OUT, write_inputs
from flexlash.report.trace.trace_mechanics import write_integrals, write_shape, write_sums, write_windups
from flexlash.report.trace.trace_page import CHANGE, HEADER, SHEET, Page
from flexlash.report.trace.trace_steps import Steps
from flexlash.report.trace.trace_strength import write_buckling, write_stresses

__all__ = ["AGREEMENT", "AGREES", "CHANGED", "write_trace"]

AGREEMENT = 1e-12
"""Relative difference up to which a traced number agrees with the program's."""

AGREES, CHANGED, _DIFFERS = "agrees to 1e-12", "inputs changed", "differs"
_PICK, _EQUATION, _PLACE = 1, 4, 5


def write_trace(book: Book, inputs: Stored, total: int, picked: int = 0) -> Mapping[str, Live]:
    """Write Trace and its steps with the variant at a place, from 0, picked; return the lines by key."""
    sheet = book.sheet(SHEET, landscape=False)
    sheet.write_string(0, 0, "Trace: one variant from its inputs to backlash and stress", book.format("title"))
    sheet.set_row(0, 28)
    note = (
        "Pick a variant. Type another input into a yellow cell and everything follows; "
        f"{LEFT_OUT} leaves an input out, an empty cell takes it as submitted."
    )
    if len(inputs.rows) < total:
        note = f"The {len(inputs.rows)} worst of {total} variants can be picked. {note}"
    if not inputs.rows:
        return {}
    sheet.write_string(1, 0, note, book.format("quiet"))
    page = Page(book, sheet, _pick(book, sheet, inputs, picked), inputs)
    changes = write_inputs(page)
    write_shape(page)
    steps = Steps(book, page)
    write_integrals(page, steps)
    write_windups(page)
    write_sums(page)
    write_stresses(page, steps)
    write_buckling(page)
    _write_verdict(page, changes)
    sheet.freeze_panes(HEADER + 1, 0)
    sheet.repeat_rows(HEADER)
    sheet.print_area(0, 0, page.row, CHANGE)
    return page.lines


def _pick(book: Book, sheet: Any, inputs: Stored, picked: int) -> Live:
    """Write the drop-down and return the reference to the place of the variant."""
    names = inputs.cells("Variant")
    all_names = [str(row["Variant"]) for row in inputs.rows]
    sheet.write_string(2, 0, "Variant", book.format("label"))
    style = book.format("input")
    sheet.merge_range(2, _PICK, 2, _EQUATION - 1, "", style)
    name = fill(sheet, 2, _PICK, all_names[picked], style)
    sheet.data_validation(2, _PICK, 2, _PICK, {
        "validate": "list",
        "source": f"={names}",
        "input_title": "Variant",
        "input_message": "The whole sheet follows.",
        "error_title": "Variant",
        "error_message": "Pick a variant of the list.",
    })  # fmt: skip
    return put(sheet, 2, _PLACE, place_of_name(name, names, all_names), book.format("quiet", '"number "0'))


def _write_verdict(page: Page, changes: str) -> None:
    """Write how far the trace is from the program, at the end and beside the drop-down."""
    page.section("7  Agreement with the program")
    first, last = min(page.rows[key] for key in page.rows if key.endswith("_windup")), page.row
    cells = ":".join(xl_rowcol_to_cell(row, CHANGE, row_abs=True, col_abs=True) for row in (first, last))
    differences = [value for value in page.differences if isinstance(value, float)]
    off = greatest(greatest_in(cells, differences), -least_in(cells, differences))
    words = ("Greatest relative difference", "", "", "of the lines that have a value of the program")
    largest = page.line("difference", off, words, "difference")
    verdict = when(largest <= AGREEMENT, AGREES, _DIFFERS)
    said = page.line(
        "verdict",
        when(filled(changes, []) > 0, CHANGED, verdict),
        ("Verdict", "", "", "traced numbers beside the program's"),
        "plain",
    )
    angle = fixed(page["backlash"] / (PI / 10800), 4)
    style = page.book.format("label")
    put(page.sheet, 2, _EQUATION, joined("◄ backlash ", angle, "′, ", said), style)
