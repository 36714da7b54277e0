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
from flexlash.report.wording.correlation_words import correlation_sentences, first_order_sentence, share_sentence
from flexlash.report.wording.measured_parts import how_left_open
from flexlash.report.wording.review_sentences import FINITE_ELEMENTS, TWO_TERMS, WITH_FILLETS_AND_RIM
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
    "CHECKSUMS",
    "ERRATA",
    "HOW_TO_SHOW",
    "LEFT_OUT",
    "MODEL",
    "PRESENT",
    "PROOF",
    "SHEETS",
    "SPREAD",
    "TABS",
    "TRUST",
    "VERDICT",
    "about_places",
    "about_sheet",
    "write_about",
]

SHEETS = {
    "Summary": "One page: what was computed, what fails, by how much, why and what to change.",
    "Failing variants": "One printed page for each variant that misses its limit: by how much, why, what to change.",
    "Allocation": (
        "What the tolerances of each class may be, at the least cost, with all of its variants within their limits."
    ),
    "Levers": "Which single change brings a failing variant within its limit; how far a passing one may still change.",
    "Results": "Every number of every variant, in submitted order, to filter and to copy.",
    "Explorer": "One variant picked from a list: the share over any limit, the limit for any share, its curves.",
    "Compare": "Variants side by side: percentile boxes against their limits.",
    "Ranking": "Variants worst first, each beside a base variant that you pick.",
    "Contributions": (
        "How much of each variant's spread each dimension causes, and how much of the backlash the disk adds."
    ),
    "Sweep": "Parametric studies: backlash and spread over one dimension or two, and where they cross the limit.",
    "Trade-offs": (
        "Backlash against mass and cost, with the variants that no other beats; the worst variant by each dimension."
    ),
    "Trace": "One variant worked through in formulas, from its inputs to backlash and stress; inputs can be changed.",
    "Trace spread": "The tolerances of that variant added up to the first-order standard deviation, in formulas.",
    "Trace steps": "The sums over points and the search behind single lines of Trace.",
    "Sensitivity": "Which dimension causes the spread: tornado of the worst variant, shares of all.",
    "Tolerances used": "Limits, mean and scatter of every dimension of every variant, and where they come from.",
    "Samples": (
        "What the measured parts say about each dimension: mean, scatter, Cp, Cpk with 95 % intervals, normality."
    ),
    "Sections": "Where along the part the nominal backlash arises.",
    "Strength": "Stress in each section, when it yields or buckles, how stiff the part is.",
    "Drive": "The whole drive: wind-up and other sources added up in formulas by five rules; the catalogue's curve.",
    "Elasticity": "The formula beside two-dimensional elasticity, and the bounds under two lobes.",
    "Stress": "Shear stress in the half-section of the worst checked variants, as pictures.",
    "Findings": "What was found in the submission: each rule with its fix, then every cell.",
    "Submission": "Sheet Variants as read, cell by cell; a coloured cell has a comment that says what is wrong.",
    "Materials": "The materials used, as read or built in.",
    "Tolerances": "The tolerance classes used, as read or built in.",
    "Settings": "The settings as read.",
    "Measurements": "The measured parts as read, one row a part.",
    "Correlations": "The correlations as read, one row a pair of dimensions.",
    "Other sources": "The other sources of the drive's backlash as read.",
    "Levers entered": "What may change, how far and at which cost, as read.",
    "Sweep entered": "The parametric studies as read.",
    "About": "This page: where the numbers come from and what they mean.",
    "Curves": "Stored percentiles behind Summary and Explorer.",
    "Compared": "Stored figures behind Compare, Ranking and Contributions.",
    "Pages": "Stored figures behind Failing variants.",
    "Swept": "Stored curves behind the charts of Sweep.",
    "Inputs": "What was entered and what the program found, behind Trace.",
    "Scatter": "How each dimension scatters, behind Trace spread.",
    "Tied": "Which dimensions scatter together, behind Trace spread.",
    "Drives": "Stored figures behind Drive.",
    "Trace slope": "The formulas of Trace in the middle of the tolerances, with one dimension moved.",
}
"""What each sheet is for, in one line."""

HOW_TO_SHOW = (
    "To see one: right-click the tab of any sheet, Unhide (in LibreOffice: Show Sheet), and pick it from the list."
)
"""How a reader gets at a hidden sheet."""

TABS = "Sheets with orange tabs have yellow cells to change; sheets with grey tabs hold stored numbers."

MODEL = (
    "Backlash here is the lag of the output when the torque reverses: twice the torsional wind-up U of the flexspline.",
    "U = T/(2πG) ∫ ds/(r³ t) along the meridian: tooth rim, wall, junction fillet, disk or flange, hub fillet.",
    "With a tooth face width the torque enters over it from the open end on, and the band of the teeth counts a third: "
    "2 to 7 % less wind-up with a thickened tooth rim, 7 to 18 % without. Blank: it enters at the open end.",
    "Without refinements this is U_cylinder = T l/(G 2π r_m³ Δ) plus U_disk = T/(4π t G) (1/r_ci² − 1/r_co²).",
    "G = E/(2(1 + ν)) unless the material gives G. The wall is thin; its torsion constant is low by (Δ/2r_m)².",
    "A disk that thins as a power of the radius: t = t_hub (r_ci/r)^n. A cone winds up 1/sin of its angle as much.",
    "Shear stress T/(2π r² t); von Mises √3 times it; wall buckling by NASA SP-8007 with its knock-down factor 0.67.",
    "Bending: the wave generator presses the wall out of round by w₀ cos 2θ, twice a turn: 1.5 E Δ w₀/(r_m² (1 − ν²)), "
    "without coning of the mouth and notches. All other stresses are of torsion only.",
    "Two lobes, with --elasticity, of cups with a tooth face width: a bracket from harmonics of elasticity on a "
    "rigid, tight wave generator. Low: all engaged teeth turn by the same angle, the bore is held over the bearing's "
    "width. High: two single teeth carry everything, the bore is held in the bearing's middle alone. There is no "
    "factor for two lobes.",
    "With 25 to 50 % of the teeth engaged, parts of catalogue-like proportions so come to 4 % below to 9 % above the "
    "number without face width, which lies low in the bracket: two single teeth are further up than any drive.",
    "A blank disk thickness is the wall thickness and a blank disk radius the mean radius: one dimension, one scatter.",
)
PROOF = (
    f"B3-160, published finite elements with fillets and tooth rim: 2U = {FINITE_ELEMENTS:.3f}′.",
    f"Two-term formula as published: {TWO_TERMS:.3f}′; at the true mean radius 80.8 mm: 3.635′, by elasticity 3.636′.",
    "With its fillets R 3.5 mm: meridian integral 3.537′, elasticity 3.537′.",
    f"With a tooth rim of 20 mm × 3.2 mm too: meridian integral {WITH_FILLETS_AND_RIM:.3f}′, elasticity 3.411′; of "
    "30 mm: 3.339′ and 3.345′.",
    "So the gap to finite elements is mean radius 1.4 %, fillets 3 %, tooth rim 4 to 6 % (its size is not published).",
    "Against an independent finite-element program usual cups and hats of 1 to 3 % wall were within 1.3 % of the "
    "meridian integral; short thick hats with a rim, cones and strongly thinning disks up to 3 %. The option "
    "--elasticity checks each variant.",
    "Calibration: published finite elements over the two-term formula give 0.907 (cylinder) and 0.936 (disk). Such "
    "factors contain fillets and rim already; relative to the finite elements the formula is 10.0 and 7.07 % high.",
)
LEFT_OUT = (
    "Buckling of the disk; notches, except the fillets' peaks in the elasticity check; an elastic hub; fatigue, except "
    "the warning of an alternating stress.",
    "Two lobes, but for that bracket: backlash and its spread count the load as even around the axis.",
    "The wave generator's fit: radial play of a few µm, or a soft bearing, can add 20 to 130 %, most without a "
    "thickened tooth rim. It is not known from a drawing of the flexspline, and in no number here.",
    "Hub bolts, wave generator bearing and teeth: the wind-up is a lower bound on the drive's total compliance.",
    "Tooth clearance, radial play, couplings and hysteresis: they come on top of this backlash, except what is entered "
    "in Other sources: that counts in the columns System, which no verdict judges.",
    "Plastic deformation: a von Mises stress above yield is flagged, the number stays elastic.",
    "What ties dimensions together beyond the correlations that are entered or measured; a process that drifts.",
)
ERRATA = (
    "The published B3-160 study prints G = 8.10769e10 Pa; its E and ν give 8.11538e10. Its U_cylinder 3.058e-4 rad "
    "follows from neither: with G from E and ν it is 3.064e-4, with the printed G 3.067e-4.",
    "Its cases 4 and 5 print a disk wind-up that falls with r_co; by the formula it rises (2.574e-4 and 1.702e-4 rad).",
    "Its intermediate displacement lacks a factor r_co, its simplified ratio a power of r_m, and the equilibrium "
    "equation it quotes is the radial one.",
    "Its 80 mm is the radius of the bore, not of the middle of the wall: with 80.8 mm the backlash is 1.4 % less.",
    "Its errors of 9.1, 6.6 and 8.0 % are relative to the formula; relative to finite elements they are 10.0, 7.07 "
    "and 8.72 %.",
)

CHECKSUMS = {
    "workbook": "Every part of the workbook was compared with the checksum that its archive holds for it.",
    "csv": "A text table carries no checksum: a digit changed on the way is another number. The sha256 above is that "
    "of the bytes that were read; compare it with the sender's.",
    "parquet": "Pages are compared with their checksums where a Parquet file has them; many programs, Polars among "
    "them, write none. The sha256 above is that of the bytes that were read; compare it with the sender's.",
}
"""What tells whether a file of each kind was read as it was written."""

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
