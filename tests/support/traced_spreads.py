"""The Trace spread that is written of a submission."""

from __future__ import annotations

import io

import xlsxwriter

from flexlash.report.layout.styles import Book
from flexlash.report.trace.inputs import INPUTS_NOTE, stored_inputs
from flexlash.report.trace.scatter import SCATTER_NOTE, TIED_NOTE, stored_scatter
from flexlash.report.trace.trace_sheet import trace_sheet, write_trace
from flexlash.report.trace.trace_spread import trace_spread_sheet, write_trace_spread

__all__ = ["slope_audited", "spread_traced"]


def _written(workbook, outcome, picked, audited, computed):
    """Write the sheets; return the results of Trace spread by key."""
    book = Book(workbook)
    inputs = stored_inputs(computed, outcome.settings.lost_motion_percent)
    scatter, tied = stored_scatter(computed)
    trace, spread = trace_sheet(book), trace_spread_sheet(book)
    for stored, note in ((inputs, INPUTS_NOTE), (scatter, SCATTER_NOTE), (tied, TIED_NOTE)):
        stored.write(book, note)
    lines = write_trace(book, trace, inputs, len(computed), picked)
    return write_trace_spread(book, spread, inputs, (scatter, tied), lines.get("number"), audited)


def spread_traced(outcome, picked=0):
    """Return the results of Trace spread by key for a variant by its place, and the workbook's bytes."""
    buffer = io.BytesIO()
    with xlsxwriter.Workbook(buffer, {"in_memory": True, "strings_to_urls": False}) as workbook:
        found = _written(workbook, outcome, picked, "", list(outcome.computed.values()))
    return found, buffer.getvalue()


def slope_audited(outcome, one, dimension):
    """Return the results of Trace spread of one variant with the slope of this dimension audited."""
    # A workbook that is not closed is made in half the time.
    return _written(xlsxwriter.Workbook(io.BytesIO(), {"in_memory": True}), outcome, 0, dimension, [one])
