"""The Summary sheet: one printed page that says what was found, in words, numbers and one chart."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from flexlash.findings import CATALOGUE, shown
from flexlash.outcome import Outcome
from flexlash.report.selection import Drawn
from flexlash.report.spread_sheet import curve_place
from flexlash.report.styles import GRID, PALETTE, Book
from flexlash.summary import dimension_words, points_words, rounded, share_words, spread_notes

__all__ = ["light", "sentences", "write_summary"]

_LISTED = 12
_NAME = 30
"""Most characters of a name in a sentence or a table."""

_NAMED = 4
_CHARTED = 60
_COLUMNS = (
    ("Variant", 24),
    ("Verdict", 9),
    ("Nominal [arcmin]", 11),
    ("P2.5 [arcmin]", 11),
    ("P50 [arcmin]", 11),
    ("P97.5 [arcmin]", 11),
    ("Limit [arcmin]", 11),
    ("Units over the limit", 32),
    ("Main contributor", 22),
)
LIGHT_RULE = (
    "Verdict: green, at least 99.865 % of units within the limit; amber, at least 97.5 %; red, fewer; –, no limit. "
    "Order: share over the limit. It judges the backlash alone."
)


def light(row: dict[str, Any]) -> str:
    """Return a Results row's verdict: green, amber, red, or a dash without a limit."""
    limit = row["backlash_limit_arcmin"]
    if limit is None:
        return "–"
    if row["p99_865_arcmin"] <= limit:
        return "green"
    return "amber" if row["p97_5_arcmin"] <= limit else "red"


def sentences(outcome: Outcome, drawn: Sequence[Drawn]) -> Iterator[str]:
    """Yield what a design review wants to know, worst first, rounded by the standard error."""
    counts = outcome.counts
    yield f"{counts['computed']} of {counts['rows']} variants were computed.{_lost(outcome)}"
    if not drawn:
        return
    judged = [one for one in drawn if one.row["backlash_limit_arcmin"] is not None]
    if judged:
        reds = sum(light(one.row) == "red" for one in judged)
        yield f"{reds} of {len(judged)} variants with a limit have more than 2.5 % of their units over it."
    worst, name = drawn[0].row, shown(drawn[0].row["variant"], longest=_NAME)
    tail = rounded(worst["p97_5_arcmin"], worst["p97_5_standard_error_arcmin"])
    head = f"97.5 % of the units of {name} stay below {tail}′"
    if worst["backlash_limit_arcmin"] is None:
        yield f"{head}; no limit was given for it."
    else:
        yield f"{head}; the limit of {worst['backlash_limit_arcmin']:g}′ is exceeded by {share_words(worst)} of them."
    if worst["main_contributor"]:
        cause = dimension_words(worst["main_contributor"])
        share = 100 * worst["main_contributor_share"]
        yield f"The spread of {name} comes first from {cause}: {share:.0f} % of the variance."
    low, high = worst["worst_case_low_arcmin"], worst["worst_case_high_arcmin"]
    yield f"With every dimension at a limit the backlash of {name} lies between {low:.3f}′ and {high:.3f}′."
    missed = [
        1 - one.row["cylinder_only_backlash_arcmin"] / one.row["backlash_arcmin"]
        for one in drawn
        if one.computed.variant.flexspline_type != "cylinder"
    ]
    if missed:
        yield (
            "The classical cylinder-only formula would miss "
            f"{_missed(100 * min(missed), 100 * max(missed))} of the backlash of cups and hats."
        )
    yield from _strength(drawn)
    yield from _flagged(outcome)
    yield from _elasticity(outcome)
    yield from spread_notes(outcome)
    exact = sum(
        "shear_modulus" in one.variant.dimensions and "shear_modulus" not in one.limits
        for one in outcome.computed.values()
    )
    if exact:
        yield f"The shear modulus of {exact} variants is given and has no tolerance: it does not scatter."


def _strength(drawn: Sequence[Drawn]) -> Iterator[str]:
    """Yield how far the variant nearest to yield is from it."""
    reserves = {
        one.row["variant"]: one.row["elastic_limit_torque_Nm"] / one.computed.variant.dimensions["torque"]
        for one in drawn
        if one.row["elastic_limit_torque_Nm"] is not None
    }
    if reserves:
        name = min(reserves, key=lambda variant: reserves[variant])
        section = next(one.row["governing_section"] for one in drawn if one.row["variant"] == name)
        yield (
            f"Nearest to yield is {shown(name, longest=_NAME)}: its {section} yields at {reserves[name]:.3g} times the "
            "torque, corners not counted."
        )


_FLAGS = ("W402", "W411", "W412", "W415", "W417")


def _flagged(outcome: Outcome) -> Iterator[str]:
    """Yield which variants have an engineering warning that the verdict on backlash does not show."""
    for code in _FLAGS:
        names = list(dict.fromkeys(found.variant for found in outcome.findings if found.code == code))
        if names:
            listed = ", ".join(shown(name, longest=_NAME) for name in names[:_NAMED])
            more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
            yield f"{CATALOGUE[code].title.capitalize()}: {listed}{more} ({code}, see Findings)."


def _elasticity(outcome: Outcome) -> Iterator[str]:
    """Yield how far the formula is from two-dimensional elasticity, where that was checked."""
    if "elasticity_difference_percent" not in outcome.results.columns:
        return
    checked = outcome.results.filter(outcome.results["elasticity_difference_percent"].is_not_null())
    if checked.height:
        differences = checked["elasticity_difference_percent"].to_list()
        error = max(checked["elasticity_error_percent"].to_list())
        least, most = (f"{one:+.2f}" for one in (min(differences), max(differences)))
        span = most if least == most else f"{least} to {most}"
        yield (
            f"Against two-dimensional elasticity the nominal backlash is {span} % off ({checked.height} checked, "
            f"converged to {error:.1g} %)."
        )


def _lost(outcome: Outcome) -> str:
    """Return which rows were not computed, the first few by name."""
    names = outcome.results.filter(outcome.results["status"] == "error")["variant"].to_list()
    if not names:
        return ""
    listed = ", ".join(shown(name or "(no name)", longest=_NAME) for name in names[:_NAMED])
    more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
    return f" Not computed, see Findings: {listed}{more}."


def _missed(least: float, most: float) -> str:
    """Return the range that the classical formula misses; below 0 it overstates."""
    if round(least) == round(most):
        return f"{most:.0f} %"
    return f"{least:.0f} to {most:.0f} %"


def write_summary(book: Book, outcome: Outcome, drawn: Sequence[Drawn]) -> None:
    """Write the Summary sheet."""
    sheet = book.sheet("Summary", landscape=False, pages_tall=1)
    for place, (_, width) in enumerate(_COLUMNS):
        sheet.set_column(place, place, width)
    sheet.write_string(0, 0, "Backlash from torsional wind-up: tolerance spread", book.format("title"))
    sheet.set_row(0, 28)
    sheet.write_string(1, 0, f"Submission {outcome.submission.name}", book.format("quiet"))
    _write_counts(book, sheet, outcome, drawn)
    row = 6
    for sentence in sentences(outcome, drawn):
        sheet.write_string(row, 0, f"•  {sentence}", book.format("text"))
        row += 1
    row += 1
    first = _write_table(book, sheet, drawn, row)
    last = _write_provenance(book, sheet, outcome, first + 1)
    if drawn:
        _chart(book, sheet, drawn, last + 2)
        last += 29
    sheet.print_area(0, 0, last + 1, len(_COLUMNS) - 1)
    sheet.activate()


def _write_counts(book: Book, sheet: Any, outcome: Outcome, drawn: Sequence[Drawn]) -> None:
    """Write the four key figures."""
    counts = outcome.counts
    reds = sum(light(one.row) == "red" for one in drawn)
    figures = (
        (f"{counts['computed']} of {counts['rows']}", "variants computed"),
        (str(reds) if any(light(one.row) != "–" for one in drawn) else "–", "red: over 2.5 % of units over limit"),
        (str(counts["errors"]), "errors"),
        (str(counts["warnings"]), "warnings"),
    )
    for (value, caption), (left, right) in zip(figures, ((0, 1), (2, 4), (5, 6), (7, 8)), strict=True):
        sheet.merge_range(3, left, 3, right, value, book.format("big"))
        sheet.merge_range(4, left, 4, right, caption, book.format("caption"))
    sheet.set_row(3, 30)


def _write_table(book: Book, sheet: Any, drawn: Sequence[Drawn], row: int) -> int:
    """Write the worst variants and the rule of their verdict; return the row after them."""
    for place, (heading, _) in enumerate(_COLUMNS):
        sheet.write_string(row, place, heading, book.format("header"))
    sheet.set_row(row, 32)
    colours = {"red": "error", "amber": "warning", "green": "ok", "–": "text"}
    for one in drawn[:_LISTED]:
        row += 1
        result = one.row
        verdict = light(result)
        sheet.write_string(row, 0, shown(result["variant"], longest=_NAME), book.format("text"))
        sheet.write_string(row, 1, verdict, book.format(colours[verdict]))
        for place, key in enumerate(("backlash", "p2_5", "p50", "p97_5", "backlash_limit"), start=2):
            value = result[f"{key}_arcmin"]
            if value is not None:
                sheet.write_number(row, place, value, book.format("text", "plain"))
        if result["probability_over_limit"] is not None:
            sheet.write_string(row, 7, share_words(result), book.format("indented"))
        if result["main_contributor"]:
            share = f" ({100 * result['main_contributor_share']:.0f} %)"
            sheet.write_string(row, 8, dimension_words(result["main_contributor"]) + share, book.format("text"))
    row += 1
    more = f"The {_LISTED} worst of {len(drawn)} are listed; all are in Results. " if len(drawn) > _LISTED else ""
    sheet.write_string(row, 0, more + LIGHT_RULE, book.format("quiet"))
    return row + 1


def _write_provenance(book: Book, sheet: Any, outcome: Outcome, row: int) -> int:
    """Write where the numbers come from; return the last row."""
    from flexlash import __version__

    facts = (
        f"sha256 of the submission: {outcome.submission.sha256}",
        f"flexlash {__version__}, method {outcome.settings.method}, seed {outcome.settings.seed}, "
        f"{points_words(outcome)} per variant. Method and limits of the model: sheet About.",
    )
    for fact in facts:
        sheet.write_string(row, 0, fact, book.format("quiet"))
        row += 1
    return row - 1


def _chart(book: Book, sheet: Any, drawn: Sequence[Drawn], row: int) -> None:
    """Draw P2.5 to P97.5, median and limit of the variants; the data stand in Curves."""
    count = min(len(drawn), _CHARTED)
    title = "Backlash P2.5 to P97.5, median and limit [arcmin]"
    if count < len(drawn):
        title += f": the {count} worst of {len(drawn)}"
    bars = book.chart("column", title, subtype="stacked")
    marks = book.workbook.add_chart({"type": "line"})
    hidden = {"fill": {"none": True}, "border": {"none": True}, "gap": 60}
    band = {"fill": {"color": PALETTE["sky"]}, "border": {"color": PALETTE["blue"]}}
    labels = curve_place("Label")
    for chart, heading, name, look in (
        (bars, "P2.5", "P2.5", hidden),
        (bars, "P2.5 to P97.5", "P2.5 to P97.5", band),
        (marks, "P50", "Median", _marker("diamond", PALETTE["ink"])),
        (marks, "Limit", "Limit", _marker("long_dash", PALETTE["red"])),
    ):
        place = curve_place(heading)
        names = ["Curves", 2, labels, count + 1, labels]
        chart.add_series({"name": name, "categories": names, "values": ["Curves", 2, place, count + 1, place], **look})
    bars.combine(marks)
    bars.set_y_axis({"min": _axis_start(drawn[:count]), "num_format": "0.00", "major_gridlines": GRID})
    bars.set_x_axis({"num_font": {"rotation": -45, "size": 9}})
    bars.set_legend({"position": "bottom", "delete_series": [0]})
    text = "Backlash interval, median and limit of each variant"
    book.insert(sheet, row, 0, bars, size=(975, 520), text=text)


def _marker(shape: str, colour: str) -> dict[str, Any]:
    """Return the look of a series that is marks without a line."""
    fill = {"color": colour}
    return {"line": {"none": True}, "marker": {"type": shape, "size": 7, "fill": fill, "border": fill}}


def _axis_start(drawn: Sequence[Drawn]) -> float:
    """Return a round number below everything that the chart shows."""
    rows = [one.row for one in drawn]
    low = min(min(row["p2_5_arcmin"], row["backlash_limit_arcmin"] or row["p2_5_arcmin"]) for row in rows)
    step = 10.0 ** math.floor(math.log10(max(row["p97_5_arcmin"] for row in rows))) / 2
    return float(max(0.0, math.floor(0.97 * low / step) * step))
