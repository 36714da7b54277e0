"""The outcome → the report workbook; the same bytes for the same submission and options."""

from __future__ import annotations

import datetime
import io

import xlsxwriter

from flexlash.analysis.outcome import Outcome
from flexlash.report.about_sheet import write_about
from flexlash.report.carried_sheet import write_carried
from flexlash.report.compare.compare_sheet import write_compare
from flexlash.report.compare.compared import COMPARED_NOTE, compared_variants
from flexlash.report.compare.contributions_sheet import write_contributions
from flexlash.report.compare.ranking_sheet import write_ranking
from flexlash.report.elasticity_sheet import write_elasticity, write_stress
from flexlash.report.explorer.curves_sheet import CURVES_NOTE, stored_curves
from flexlash.report.explorer.explorer_sheet import write_explorer
from flexlash.report.findings_sheet import write_findings
from flexlash.report.layout.styles import Book
from flexlash.report.report_data import report_data
from flexlash.report.results_sheet import write_results
from flexlash.report.sections_sheet import write_sections
from flexlash.report.sensitivity_sheet import write_sensitivity
from flexlash.report.strength_sheet import write_strength
from flexlash.report.submission_sheets import write_submission
from flexlash.report.summary.summary_sheet import write_summary
from flexlash.report.trace.inputs import INPUTS_NOTE, stored_inputs
from flexlash.report.trace.trace_sheet import trace_sheet, write_trace
from flexlash.report.trace.trace_steps import STEPS

__all__ = ["report_bytes"]

_NO_DATE = datetime.datetime(2000, 1, 1, tzinfo=datetime.UTC).replace(tzinfo=None)


def report_bytes(outcome: Outcome) -> bytes:
    """Return the report as an .xlsx file."""
    buffer = io.BytesIO()
    workbook = xlsxwriter.Workbook(buffer, {"in_memory": True, "strings_to_urls": False})
    created = outcome.submission.modified or _NO_DATE
    workbook.set_properties({"title": f"flexlash report on {outcome.submission.name}", "created": created})
    workbook.set_custom_property("flexlash", "report")
    book = Book(workbook)
    data = report_data(outcome)
    drawn = data.drawn
    curves = stored_curves(drawn)
    write_summary(book, outcome, data, curves)
    write_results(book, outcome)
    write_explorer(book, curves, len(outcome.computed))
    compared = compared_variants(drawn)
    write_compare(book, outcome, drawn, compared)
    write_ranking(book, outcome, drawn, compared)
    write_contributions(book, outcome, drawn, compared)
    trace = trace_sheet(book)
    write_sensitivity(book, outcome, drawn)
    write_sections(book, drawn, len(outcome.computed))
    write_strength(book, drawn, len(outcome.computed))
    if "elasticity_windup_rad" in outcome.results.columns:
        write_elasticity(book, outcome)
        write_stress(book, data)
    write_findings(book, outcome)
    write_submission(book, outcome)
    inputs = stored_inputs([variant.computed for variant in drawn], outcome.settings.lost_motion_percent)
    steps = (STEPS,) if inputs.rows else ()
    write_about(book, outcome, later=(curves.name, compared.name, inputs.name, *steps))
    curves.write(book, CURVES_NOTE)
    compared.write(book, COMPARED_NOTE)
    inputs.write(book, INPUTS_NOTE)
    write_trace(book, trace, inputs, len(outcome.computed))
    write_carried(book, outcome)
    workbook.close()
    return buffer.getvalue()
