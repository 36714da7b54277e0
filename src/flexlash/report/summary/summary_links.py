"""Where the topics of the Summary lead: one click from a question to all that the report knows of its answer."""

from __future__ import annotations

from collections.abc import Mapping

from flexlash.analysis.outcome import Outcome
from flexlash.report.about_sheet import PRESENT, SPREAD, TRUST, VERDICT, about_places
from flexlash.report.allocation_sheet import ALLOCATED
from flexlash.report.drive.drive_page import SHEET as DRIVE_SHEET
from flexlash.report.explorer.explorer_sheet import EXPLORER_PLACES
from flexlash.report.failing.failing_places import FAILING, failing_variants
from flexlash.report.layout.styles import Book
from flexlash.report.levers_sheet import LEVERS, lever_places
from flexlash.report.report_data import ReportData
from flexlash.report.wording.allocation_sentences import CLASSES
from flexlash.report.wording.drive_sentences import DRIVE
from flexlash.report.wording.lever_sentences import CHANGE, LENGTH, RELAX
from flexlash.report.wording.lever_words import shown_levers
from flexlash.report.wording.lot_sentences import LOTS
from flexlash.report.wording.measured_parts import PARTS
from flexlash.report.wording.normal_theory import NORMAL
from flexlash.report.wording.review_sentences import ANOTHER, COMPARED, LIMITS, MODEL
from flexlash.report.wording.sentences import FINDINGS
from flexlash.report.wording.verdict_sentences import WORST_CASE

__all__ = ["topic_targets"]


def topic_targets(book: Book, outcome: Outcome, data: ReportData) -> Mapping[str, str]:
    """Return the cells to which the topics of the Summary lead; for a hidden sheet where About lists the sheets."""
    about = about_places(outcome)
    targets = {
        COMPARED: about[VERDICT],
        "Computed": f"{FINDINGS}!A1",
        CLASSES: f"{ALLOCATED}!A1" if book.shows(ALLOCATED) else about[PRESENT],
        DRIVE: f"{DRIVE_SHEET}!A1",
        MODEL: about[TRUST],
        "Of the calculation": about[SPREAD],
        FINDINGS: f"{FINDINGS}!A1",
        "Sweep": "Sweep!A1",
    }
    if data.drawn:
        levers = _changes(data) if book.shows(LEVERS) else dict.fromkeys((RELAX, LENGTH), about[PRESENT])
        targets |= {"Why": "Contributions!A1", **_of_the_worst(), **levers}
    if failing_variants(data.drawn, outcome.settings.verdict_bounds):
        pages = ("Which fail", LIMITS) if book.shows(LEVERS) else ("Which fail", LIMITS, CHANGE)
        targets |= dict.fromkeys(pages, f"{FAILING}!A1")
    return targets


def _of_the_worst() -> dict[str, str]:
    """Return the cells of Explorer that answer for the variant that is picked, at first the worst."""
    places = {
        "Which fail": "verdict", ANOTHER: "another limit", "How sure": "interval", NORMAL: "interval",
        WORST_CASE: "worst case", PARTS: "left open", LOTS: "lots", "Cylinder-only formula": "cylinder only",
        "Strength": "strength", LIMITS: "limits",
    }  # fmt: skip
    return {topic: EXPLORER_PLACES[place] for topic, place in places.items()}


def _changes(data: ReportData) -> dict[str, str]:
    """Return the cells of the changes that a sentence tells first."""
    levers = shown_levers(data.levers)
    places, first = lever_places(levers), {CHANGE: "meet", RELAX: "relax", LENGTH: "relax"}
    return {
        topic: f"{LEVERS}!A{places[variant] + 1}"
        for topic, direction in first.items()
        for variant in levers.filter(levers["direction"] == direction)["variant"].head(1)
    }
