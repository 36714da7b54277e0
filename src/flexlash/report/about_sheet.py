"""The About sheet: what was computed and how, what is exact, what is estimated, what is left out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from flexlash.analysis.outcome import Outcome
from flexlash.report.allocation_sheet import ALLOCATED
from flexlash.report.extent import MOST_FINDINGS, Extent, extent_of
from flexlash.report.layout.links import write_link
from flexlash.report.layout.paper import Listed, print_one_page
from flexlash.report.layout.styles import Book
from flexlash.report.results_sheet import AS_SUBMITTED, ERROR_DIGITS, SHARE_DECIMALS
from flexlash.report.wording.about_texts import (
    CHECKSUMS,
    ERRATA,
    HOW_TO_SHOW,
    LEFT_OUT,
    MODEL,
    PROOF,
    SHEETS,
    TABS,
)
from flexlash.report.wording.correlation_words import correlation_sentences, first_order_sentence, share_sentence
from flexlash.report.wording.measured_parts import how_left_open
from flexlash.report.wording.verdict import NO_VERDICT, verdict_rules
from flexlash.schema.column import Column
from flexlash.schema.columns import DIMENSIONS, SETTINGS
from flexlash.schema.decision_results import ALLOCATION
from flexlash.schema.limit_verdict import VerdictBounds
from flexlash.schema.number_words import grouped
from flexlash.schema.result_columns import result_columns
from flexlash.schema.used_columns import TOLERANCES_USED
from flexlash.tolerance.cross_check import AGREEMENT
from flexlash.tolerance.engine.line_points import LINE_REPLICATES
from flexlash.tolerance.engine.line_precision import MOST_LINES, PROBABILITY_PRECISION, SD_PRECISION
from flexlash.tolerance.sampling import REPLICATES

__all__ = [
    "PRESENT",
    "SPREAD",
    "TRUST",
    "VERDICT",
    "about_places",
    "about_sheet",
    "write_about",
]

_SAMPLING = {
    "line": (
        "Line sampling: lines run through the tolerances in the direction in which the backlash rises fastest. Where a "
        "line passes a backlash, the part of it beyond is a normal tail; the mean over lines is the share of units.",
        "What lines say is corrected by a sum of polynomials, one for each tolerance, whose distribution is known "
        "exactly: its misfit makes numbers less sharp, never wrong.",
        f"Lines are placed by {LINE_REPLICATES} independent scrambled Sobol' nets, whose scatter gives the standard "
        "errors (widened as Student's t asks for so few).",
        "Unless Settings name a number, lines are added until P0.135, P2.5, P50, P97.5 and P99.865 have standard "
        f"errors of {SD_PRECISION:g} sd and the probability over the limit of {100 * PROBABILITY_PRECISION:g} % of "
        f"itself, or there are {MOST_LINES:,}: then the note on the spread says what was reached.",
        "A row whose backlash does not rise smoothly along its lines is answered by Sobol' points; its note says so.",
    ),
    "sobol": (
        f"Scrambled Sobol' points in {REPLICATES} independent replicates, whose scatter gives the standard errors "
        "(widened as Student's t asks).",
        "All variants meet the same points, so that they differ by their dimensions and not by chance.",
        "Percentiles are quantiles of type 7 (Excel's PERCENTILE.INC). The interval of the probability over the limit "
        "is Clopper and Pearson's of so many independent points as know it as well.",
    ),
    "random": (
        "Plain Monte Carlo: independent draws, standard errors by theory.",
        "All variants meet the same draws, so that they differ by their dimensions and not by chance.",
        "Percentiles are quantiles of type 7 (Excel's PERCENTILE.INC). The interval of the probability over the limit "
        "is Clopper and Pearson's.",
    ),
}


def _statistics(outcome: Outcome) -> Iterator[str]:
    """Yield how the spread was made and how good it is."""
    yield (
        "Each tolerance gives limits; parts scatter around the middle of the limits, not around the entry, unless a "
        "mean shift, Cpk or a sample says where their mean lies."
    )
    yield (
        "normal: σ = (upper − lower)/(2k), or that of the process (Standard deviation, Cp, Sample), unbounded; "
        "truncated normal: the same, cut at the limits; measured: a curve through the values of the sample; others: "
        "between the limits."
    )
    yield from correlation_sentences(outcome.computed)
    yield from _SAMPLING[outcome.settings.method]
    yield "P99.865 of a normal is mean + 3 sd. A number ± 1.96 of its standard errors is its 95 % interval."
    yield from _lots(outcome.settings.acceptable_ppm)
    yield from how_left_open(outcome.results)
    if "cross_check" in outcome.results.columns:
        yield (
            "Cross-check: plain Monte Carlo beside the spread. They agree when mean, sd, all percentiles and the "
            f"probability over the limit differ by at most {AGREEMENT:g} combined standard errors, which chance "
            "exceeds in fewer than one row in 10,000."
        )
    yield "Worst case: every dimension at the tolerance limit that hurts, whatever k; normal units can lie beyond it."
    yield first_order_sentence(outcome.computed)
    yield (
        "First order enough: whether the backlash at mid-limits ± k·(first-order sd) meets the coverage interval "
        "within half a unit in the second digit of the first-order sd in arcmin, JCGM 101 clause 8."
    )
    yield share_sentence(outcome.computed)
    yield (
        "Ppk upper = (limit − P50)/(P99.865 − P50), ISO 22514-2; by normal theory (limit − mean)/(3 sd), which holds "
        "for a normal backlash alone."
    )
    yield "Exact to rounding: nominal columns, worst case, first-order sd. All other statistics are estimates."


def _lots(acceptable_ppm: float) -> Iterator[str]:
    """Yield what a lot is, how the spread divides into lots and parts, and when a lot fails."""
    yield (
        "Lots and parts: a lot has one value of each dimension that scatters between lots (elastic constants and "
        "calibrations, unless Tolerances says otherwise), each of its parts a value of its own of every other one."
    )
    yield (
        "Within-lot sd: root of the mean over lots of the variance of their parts. Between-lots sd: standard deviation "
        "of the means of lots. Their squares add up to that of the standard deviation. In sentences: ± 1.96 of them."
    )
    yield (
        "The probability over the limit is the share of the units of all lots. A lot fails where more than "
        f"{acceptable_ppm:,g} ppm of its units are over the limit (Settings: acceptable_ppm). Where nothing scatters "
        "between lots all of them fail or none; where nothing scatters within them, as many lots fail as units."
    )
    yield (
        "A calibration is one unknown value for all lots. It counts as scattering between them, so that the share of "
        "lots failing then says how likely it is that they fail."
    )


def _verdict(bounds: VerdictBounds) -> Iterator[str]:
    """Yield how the verdict on a variant is formed."""
    marginal = "is marginal where P97.5 is, " if bounds.any_marginal else ""
    yield from (f"{verdict.capitalize()}: {rule}." for verdict, rule in verdict_rules(bounds).items())
    yield (
        f"By percentiles: a variant meets its limit where P{bounds.target_words.removesuffix(' %')} is at most it, "
        f"{marginal}else fails; {NO_VERDICT} where no limit was given. It judges the backlash alone, by the estimate "
        "as it stands; a ? says that the 95 % interval of the share over the limit reaches another verdict, so that "
        "more samples may turn it."
    )
    yield (
        "It is about the units of all lots together. How many lots fail by themselves is shown beside it and changes "
        "no verdict."
    )
    yield "A variant with warnings has its verdict all the same: a part beyond yield can meet its limit. See Findings."


def _digits() -> Iterator[str]:
    """Yield what the digits of Results mean."""
    yield (
        "A number with a standard error is shown down to the first digit of that error, and its cell holds all digits; "
        "the ends of an interval have the same place. The error of a share of units is a 3.92th of its 95 % interval, "
        "that of a share of the variance about 0.2 %. A number without an error has the digits usual for its unit."
    )
    yield (
        f"Standard errors are kept to {ERROR_DIGITS} digits and estimated shares to {SHARE_DECIMALS} decimals, which "
        "is finer than they are known. Files in CSV, Parquet and JSON hold every digit of every number."
    )
    yield (
        "In words a share of units below 1 ppb is practically none, and practically all the other way round; up to "
        "1 ppm it has two digits. The columns of Results have every digit, and the bounds."
    )
    yield (
        "Standard errors are shown with two digits. A share of units within 1 ppm of none or all is shown with at most "
        "four decimals of per cent; its cell and the column in ppm hold the rest."
    )
    yield (
        "Columns that few need are folded away: the + above the columns of Results shows them. The key below a heading "
        "is the name of the column in files."
    )
    yield f"Columns of the submission that flexlash does not know stand at the right end, marked “{AS_SUBMITTED}”."


def _result_columns(outcome: Outcome) -> tuple[Column, ...]:
    every = result_columns(cross_check=True, elasticity=True)
    return tuple(column for column in every if column.key in outcome.results.columns)


PRESENT, SPREAD, TRUST, VERDICT = "Sheets", "Spread", "How good the formula is", "Verdict"
"""Titles of sections to which other sheets lead."""

_FIRST_ROW, _BETWEEN = 2, 2
"""Row of the first title, and rows between the end of a section and the next title, counted from 0."""

_LINES = (30, 88, 114)
"""Widths of both columns, and how many characters fit on a line across both."""


def about_sheet(book: Book) -> Any:
    """Return the sheet About in its place among the others; what it tells of them comes when all are known."""
    return book.sheet("About", landscape=False)


def write_about(book: Book, sheet: Any, outcome: Outcome, later: Sequence[str] = ()) -> None:
    """Write the About sheet; `later` are sheets that are not made yet."""
    sheet.set_column(0, 0, _LINES[0])
    sheet.set_column(1, 1, _LINES[1])
    sheet.write_string(0, 0, "About this report", book.format("title"))
    sheet.set_row(0, 28)
    extent = extent_of(outcome)
    sheets = SHEETS | (_of_large(extent) if extent.large else {})
    present = [worksheet.get_name() for worksheet in book.workbook.worksheets()] + list(later)
    sections: dict[str, list[tuple[str, str]]] = {
        **_first_sections(outcome),
        PRESENT: [(name, sheets.get(name, "")) for name in present if book.shows(name)],
        "Hidden sheets": [("", HOW_TO_SHOW), ("", TABS), *_hidden(book, present, sheets)],
        "Digits and columns": [("", text) for text in _digits()],
        "Model": [("", text) for text in MODEL],
        "Errata of the published study": [("", text) for text in ERRATA],
        "Columns of Results": [(column.label, column.help) for column in _result_columns(outcome)],
        "Columns of Tolerances used": [(column.label, column.help) for column in TOLERANCES_USED],
        "Columns of Allocation": [(column.label, column.help) for column in ALLOCATION if ALLOCATED in present],
        "Dimensions": [(name, f"{column.sheet}: {column.label}") for name, column in DIMENSIONS.items()],
    }
    row, ends = _FIRST_ROW, []
    for title, entries in sections.items():
        row = _write_section(book, sheet, row, title, entries)
        ends.append(row - 2)
    print_one_page(sheet, _LINES[:2], ends[-1], upright=True, ends=ends[:-1], listed=Listed(noun="sections"))


def _first_sections(outcome: Outcome) -> dict[str, list[tuple[str, str]]]:
    """Return what a reviewer wants first, whatever sheets there are: the first of it is printed."""
    texts = {
        VERDICT: _verdict(outcome.settings.verdict_bounds), TRUST: PROOF, "Not covered": LEFT_OUT,
        SPREAD: _statistics(outcome),
    }  # fmt: skip
    settings = {"Provenance and settings": list(_identity(outcome).items())}
    return settings | {title: [("", text) for text in lines] for title, lines in texts.items()}


def about_places(outcome: Outcome) -> dict[str, str]:
    """Return the cells of About at which its first sections begin, by their titles."""
    row, places = _FIRST_ROW, {}
    for title, entries in [*_first_sections(outcome).items(), (PRESENT, [])]:
        places[title] = f"About!A{row + 1}"
        row += len(entries) + _BETWEEN
    return places


def _hidden(book: Book, present: Sequence[str], sheets: Mapping[str, str]) -> list[tuple[str, str]]:
    """Return the sheets that are hidden, with what each is for."""
    return [(name, sheets.get(name, "")) for name in present if not book.shows(name)]


def _of_large(extent: Extent) -> dict[str, str]:
    """Return what sheets are for in the report of a large submission, where that is something else."""
    worst = f"the {extent.words} variants" if extent.is_part else f"all {grouped(extent.total)} variants"
    texts = {
        "Sensitivity": f"Which dimension causes the spread: tornado of the worst variant, shares of {worst}.",
        "Tolerances used": f"Limits, mean and scatter of every dimension of {worst}, and where these are from.",
        "Findings": f"What was found: each rule with its fix and count, then the first {MOST_FINDINGS} findings.",
        "Submission": f"Sheet Variants as read, of {worst}, worst first behind their row numbers.",
    }
    if extent.only_drawn:
        texts["Results"] = f"Every number of {worst}, in submitted order; {extent.elsewhere}."
    return texts


def _write_section(book: Book, sheet: Any, row: int, title: str, entries: Sequence[tuple[str, str]]) -> int:
    """Write a section, names beside their texts; return the row after it."""
    sheet.write_string(row, 0, title, book.format("section"))
    sheet.write_blank(row, 1, None, book.format("section"))
    for name, text in entries:
        row += 1
        if not name:
            sheet.merge_range(row, 0, row, 1, f"•  {text}", book.format("wrap"))
        elif title == PRESENT:
            write_link(sheet, row, 0, f"{name}!A1", name, style=book.format("link"))
        else:
            sheet.write_string(row, 0, name, book.format("wrap"))
        if name:
            sheet.write_string(row, 1, text, book.format("wrap"))
        lines = max(1 + len(text) // _LINES[1 if name else 2], 1 + len(name) // _LINES[0])
        sheet.set_row(row, 15.5 * lines)
    return row + _BETWEEN


def _identity(outcome: Outcome) -> dict[str, str]:
    """Return where the numbers come from: submission, version, settings."""
    from flexlash import __version__

    settings = {
        **{key: value for key, value in vars(outcome.settings).items() if key != "calibrations"},
        **outcome.settings.calibrations,
    }
    return {
        "Submission": outcome.submission.name,
        "sha256": outcome.submission.sha256,
        "Kind": outcome.submission.kind,
        "Checksums": CHECKSUMS[outcome.submission.kind],
        "flexlash version": __version__,
        **{column.key: _text(settings[column.key]) for column in SETTINGS},
        **({"Variants shown": _shown(extent_of(outcome))} if extent_of(outcome).large else {}),
    }


def _shown(extent: Extent) -> str:
    """Return what the report of a large submission shows."""
    if not extent.is_part:
        return f"All {grouped(extent.total)}; Findings lists the first {MOST_FINDINGS}."
    findings = f"all findings are in {extent.findings_file}" if extent.findings_file else "Findings counts all findings"
    return f"{extent.note} Every sheet but Results shows these alone; {findings}."


def _text(value: object) -> str:
    return "chosen by the program" if value is None else f"{value:g}" if isinstance(value, float) else str(value)
