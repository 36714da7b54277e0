"""The outcome → the report workbook; the same bytes for the same submission and options."""

from __future__ import annotations

import datetime
import io
from collections.abc import Mapping

import xlsxwriter

from flexlash.analysis.outcome import Outcome
from flexlash.report.about_sheet import about_sheet, write_about
from flexlash.report.allocation_sheet import write_allocation
from flexlash.report.carried_sheet import write_carried
from flexlash.report.compare.compare_sheet import write_compare
from flexlash.report.compare.compared import COMPARED_NOTE, compared_variants
from flexlash.report.compare.contributions_sheet import write_contributions
from flexlash.report.compare.ranking_sheet import write_ranking
from flexlash.report.drive.drive_sheet import write_drive
from flexlash.report.drive.stored_drives import DRIVES_NOTE
from flexlash.report.elasticity_sheet import write_elasticity, write_stress
from flexlash.report.explorer.curves_sheet import CURVES_NOTE, stored_curves
from flexlash.report.explorer.explorer_sheet import write_explorer
from flexlash.report.extent import extent_of
from flexlash.report.failing.failing_sheet import write_failing
from flexlash.report.failing.stored_pages import PAGES_NOTE
from flexlash.report.findings_sheet import write_findings
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.styles import Book
from flexlash.report.levers_sheet import write_levers
from flexlash.report.page.lever_cells import cheapest_changes
from flexlash.report.report_data import ReportData, report_data
from flexlash.report.results_sheet import write_results
from flexlash.report.samples_sheet import write_samples
from flexlash.report.sections_sheet import write_sections
from flexlash.report.sensitivity_sheet import write_sensitivity
from flexlash.report.shown_sheets import shown_sheets
from flexlash.report.strength_sheet import write_strength
from flexlash.report.submission_sheets import write_submission
from flexlash.report.summary.relative_bars import BARS_NOTE, relative_bars
from flexlash.report.summary.summary_chart import CHARTED
from flexlash.report.summary.summary_sheet import write_summary
from flexlash.report.sweeps.sweep_curves import SWEPT_NOTE, stored_sweeps
from flexlash.report.sweeps.sweep_sheet import MOST_STUDIES, write_sweep
from flexlash.report.trace.inputs import INPUTS_NOTE, stored_inputs
from flexlash.report.trace.scatter import SCATTER_NOTE, TIED_NOTE, stored_scatter
from flexlash.report.trace.trace_sheet import trace_sheet, write_trace
from flexlash.report.trace.trace_slope import SLOPE
from flexlash.report.trace.trace_spread import trace_spread_sheet, write_trace_spread
from flexlash.report.trace.trace_steps import STEPS
from flexlash.report.tradeoffs.trade_offs_sheet import write_trade_offs
from flexlash.report.used_sheet import write_used
from flexlash.report.wording.lever_words import hats_of, shown_levers

__all__ = ["report_bytes"]

_NO_DATE = datetime.datetime(2000, 1, 1, tzinfo=datetime.UTC).replace(tzinfo=None)


def report_bytes(outcome: Outcome, data: ReportData | None = None) -> bytes:
    """Return the report as an .xlsx file; `data` is what it draws, made here where it is None."""
    buffer = io.BytesIO()
    workbook = _begun(buffer, outcome)
    data = report_data(outcome) if data is None else data
    drawn = data.drawn
    book = Book(workbook, shown_sheets(outcome, data), outcome.settings.angles)
    extent, compared, curves = extent_of(outcome), compared_variants(drawn, book.angles), stored_curves(drawn)
    bars = relative_bars(drawn, outcome.settings.verdict_bounds, CHARTED)
    swept = stored_sweeps(data.studies[:MOST_STUDIES], book.angles)
    computed = [variant.computed for variant in drawn]
    scatter, tied = stored_scatter(computed)
    unit = write_summary(book, outcome, data, bars)
    pages = write_failing(book, outcome, data)
    write_results(book, outcome, drawn)
    write_explorer(book, (curves, scatter), extent, outcome.settings.verdict_bounds, unit)
    write_levers(book, outcome, data)
    write_contributions(book, outcome, drawn, compared)
    drives = write_drive(book, outcome, drawn)
    write_sweep(book, outcome, data.studies, swept)
    trace = trace_sheet(book)
    write_findings(book, outcome, drawn)
    write_submission(book, outcome, drawn)
    about = about_sheet(book)
    trace_spread = trace_spread_sheet(book)
    _write_further(book, outcome, data, compared)
    inputs = stored_inputs(computed, outcome.settings.lost_motion_percent)
    noted = _noted({
        CURVES_NOTE: curves, COMPARED_NOTE: compared, BARS_NOTE: bars if bars.rows else None, PAGES_NOTE: pages,
        SWEPT_NOTE: swept if swept.rows else None, DRIVES_NOTE: drives, INPUTS_NOTE: inputs,
        SCATTER_NOTE: scatter, TIED_NOTE: tied if tied.rows else None,
    })  # fmt: skip
    steps = [STEPS] * bool(inputs.rows) + [SLOPE] * bool(scatter.rows)
    write_about(book, about, outcome, later=(*(stored.name for stored, _ in noted), *steps))
    part = f"{extent.note} " if extent.large and extent.note else ""
    for stored, note in noted:
        stored.write(book, f"{part}{note}")
    lines = write_trace(book, trace, inputs, extent.total)
    write_trace_spread(book, trace_spread, inputs, (scatter, tied), lines.get("number"))
    write_carried(book, outcome, cheapest_changes(shown_levers(data.levers, hats_of(outcome))))
    workbook.close()
    return buffer.getvalue()


def _noted(sheets: Mapping[str, Stored | None]) -> list[tuple[Stored, str]]:
    """Return the data sheets that there are, by their notes, each with its note."""
    return [(stored, note) for note, stored in sheets.items() if stored is not None]


def _write_further(book: Book, outcome: Outcome, data: ReportData, compared: Stored) -> None:
    """Write the sheets for who wants more of one matter than the others tell."""
    drawn, extent = data.drawn, extent_of(outcome)
    write_compare(book, outcome, drawn, compared)
    write_ranking(book, outcome, drawn, compared)
    write_sensitivity(book, outcome, drawn)
    write_used(book, outcome, data)
    write_samples(book, outcome, drawn)
    write_sections(book, drawn, extent)
    write_strength(book, drawn, extent)
    write_allocation(book, data.allocation, outcome.settings.target_percent)
    write_trade_offs(book, outcome, drawn)
    if "elasticity_windup_rad" in outcome.results.columns:
        write_elasticity(book, outcome, drawn)
        write_stress(book, data)


def _begun(buffer: io.BytesIO, outcome: Outcome) -> xlsxwriter.Workbook:
    """Return a workbook without sheets that says what it reports on."""
    workbook = xlsxwriter.Workbook(buffer, {"in_memory": True, "strings_to_urls": False})
    created = outcome.submission.modified or _NO_DATE
    workbook.set_properties({"title": f"flexlash report on {outcome.submission.name}", "created": created})
    workbook.set_custom_property("flexlash", "report")
    return workbook
