"""The outcome → the report workbook; the same bytes for the same submission and options."""

from __future__ import annotations

import datetime
import io

import xlsxwriter

from flexlash.outcome import Outcome
from flexlash.report.about_sheet import write_about
from flexlash.report.elasticity_sheet import write_elasticity, write_stress
from flexlash.report.results_sheet import write_results
from flexlash.report.sections_sheet import write_sections
from flexlash.report.selection import drawn_variants
from flexlash.report.sensitivity_sheet import write_sensitivity
from flexlash.report.spread_sheet import write_curves, write_spread
from flexlash.report.strength_sheet import write_strength
from flexlash.report.styles import Book
from flexlash.report.submission_sheets import write_findings, write_submission
from flexlash.report.summary_sheet import write_summary

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
    drawn = drawn_variants(outcome)
    write_summary(book, outcome, drawn)
    write_results(book, outcome.results)
    write_spread(book, drawn, len(outcome.computed))
    write_sensitivity(book, outcome, drawn)
    write_sections(book, drawn, len(outcome.computed))
    write_strength(book, drawn, len(outcome.computed))
    if "elasticity_windup_rad" in outcome.results.columns:
        write_elasticity(book, outcome)
        write_stress(book, outcome, drawn)
    write_findings(book, outcome)
    write_submission(book, outcome)
    write_about(book, outcome)
    write_curves(book, drawn)
    workbook.close()
    return buffer.getvalue()
