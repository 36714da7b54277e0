"""The Summary in words: what a design review asks, each answer below its question, worst first."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence

import polars as pl

from flexlash.analysis.outcome import Outcome
from flexlash.analysis.run_summary import counted, grouped, listed, points_range, spread_notes
from flexlash.report.layout.links import rule_counts
from flexlash.report.report_data import ROW
from flexlash.report.wording.allocation_sentences import CLASSES, class_tolerances
from flexlash.report.wording.drive_sentences import DRIVE, whole_drive
from flexlash.report.wording.lever_sentences import (
    CHANGE,
    LENGTH,
    LEVER_TOPICS,
    RELAX,
    lengths,
    relaxing,
    what_to_change,
)
from flexlash.report.wording.lot_sentences import LOTS, lots_and_parts
from flexlash.report.wording.measured_parts import PARTS, measured_parts
from flexlash.report.wording.normal_theory import NORMAL, normal_theory
from flexlash.report.wording.review_sentences import (
    ANOTHER,
    COMPARED,
    LIMITS,
    MODEL,
    another_limit,
    limits_used,
    model_trust,
    what_is_compared,
)
from flexlash.report.wording.summary_facts import NAMED, Row, SummaryFacts, first_rows, rough, summary_facts
from flexlash.report.wording.verdict_sentences import WORST_CASE, extremes_of_worst, failing, sureness
from flexlash.report.wording.wave_generator import bending, two_lobes
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.findings import CATALOGUE, spelled_out
from flexlash.schema.number_words import INTERVAL
from flexlash.tolerance.spread_statistics import SpreadStatistics

__all__ = ["FINDINGS", "cause_of", "sentences"]

FINDINGS = "Findings"
"""The topic of the sentence that leads to the sheet of this name."""

_DIGITS = 3
"""Digits in which a reserve is told; what is equal in them is alike."""

_NEARLY = 1.1
"""Times the least reserve beyond which no other one is told in the same digits."""

_CAUSES = 3
"""Most dimensions that are named as the cause of a spread."""

_WHOLE = 100

_OF_THOSE_DRAWN = (
    PARTS,
    "Why",
    *LEVER_TOPICS,
    DRIVE,
    "Cylinder-only formula",
    "Strength",
    "Of the calculation",
)
"""Topics of which no more than the worst variants are known, where the outcome holds no others."""

_LEAST_CAUSE = 0.01
"""Share of the variance below which a dimension is not named."""


def sentences(
    outcome: Outcome, levers: pl.DataFrame, allocation: pl.DataFrame | None = None
) -> Iterator[tuple[str, str]]:
    """Yield topic and sentences: what a design review wants to know, rounded by the standard error.

    `levers` are the single changes of the variants that the report shows, `allocation` the tolerances of classes.
    """
    facts = summary_facts(outcome, levers)
    topics = {
        COMPARED: what_is_compared(facts),
        "Computed": _computed(facts),
        "Which fail": failing(facts),
        ANOTHER: another_limit(facts),
        "How sure": sureness(facts),
        NORMAL: normal_theory(facts),
        WORST_CASE: extremes_of_worst(facts),
        PARTS: measured_parts(facts),
        LOTS: lots_and_parts(facts),
        "Why": _causes(facts),
        LIMITS: limits_used(facts),
        CHANGE: what_to_change(facts),
        RELAX: relaxing(facts),
        LENGTH: lengths(facts),
        CLASSES: class_tolerances(allocation, outcome.settings.target_percent),
        DRIVE: whole_drive(facts),
        "Cylinder-only formula": _classical(facts),
        "Strength": _strength(facts),
        MODEL: model_trust(facts),
        "Of the calculation": _calculation(facts),
        FINDINGS: _findings(outcome),
    }
    of_these = f"Of the {facts.extent.drawn} worst: " if outcome.whole else ""
    for topic, answer in topics.items():
        text = ("\n" if topic == CHANGE else " ").join(answer)
        if text:
            yield topic, f"{of_these if topic in _OF_THOSE_DRAWN else ''}{text}"


def _computed(facts: SummaryFacts) -> Iterator[str]:
    """Yield how many variants were computed and which were not, with the first reason; nothing where all are shown."""
    outcome = facts.outcome
    counts = outcome.counts
    rows, computed = counts["rows"], counts["computed"]
    if rows == computed and not facts.extent.large:
        return
    yield f"{grouped(computed)} of {counted(rows, 'variant')} {'was' if computed == 1 else 'were'} computed."
    yield from _shown(facts)
    lost = outcome.results.filter(outcome.results["status"] == "error")["variant"].to_list()
    if lost:
        yield f"Not computed: {listed([facts.named(name) if name else '(no name)' for name in lost], NAMED)}."
        first = next((finding for finding in outcome.findings if finding.level == "error"), None)
        if first:
            yield f"First fault: {first.message}"


def _shown(facts: SummaryFacts) -> Iterator[str]:
    """Yield what the sheets of a large report show, and where everything is."""
    extent = facts.extent
    if extent.only_drawn:
        findings = f", all findings in {extent.findings_file}" if extent.findings_file else ""
        yield f"This report shows the {extent.drawn} worst of them; {extent.elsewhere}{findings}."
    elif extent.large:
        part = f"; the other sheets show the {extent.drawn} worst" if extent.is_part else ""
        yield f"Results holds all of them{part}."


def _causes(facts: SummaryFacts) -> Iterator[str]:
    """Yield what the spread of the worst variant comes from, and what dominates all of them."""
    worst = facts.worst
    if worst is None:
        return
    yield from cause_of(facts, worst)
    main = Counter(cause for cause in facts.outcome.results["main_contributor"].to_list() if cause is not None)
    if main.total() > 1:
        order = sorted(main, key=lambda cause: (-main[cause], cause))
        parts = [f"{dimension_words(cause)} in {grouped(main[cause])}" for cause in order]
        where = counted(main.total(), "variant")
        where = f"all {where}" if len(main) == 1 else where
        what = dimension_words(order[0]) if len(main) == 1 else listed(parts, _CAUSES)
        yield f"Main contributor of {where}: {what}."


def cause_of(facts: SummaryFacts, row: Row) -> Iterator[str]:
    """Yield what the spread of a variant comes from."""
    name = facts.named(row["variant"])
    spread = facts.computed(row).spread
    shares = spread.shares if spread else {}
    if not shares:
        yield f"Nothing scatters in {name}: no tolerance applies to its dimensions, so all units are identical."
    ranked = sorted(shares, key=lambda cause: (-shares[cause], cause))
    named = ranked[:1] + [cause for cause in ranked[1:_CAUSES] if shares[cause] >= _LEAST_CAUSE]
    if named:
        yield f"The spread of {name} comes from {_parts(row, {cause: shares[cause] for cause in named})}."
    if spread and named and _undecided(spread, ranked):
        yield "Which of the first two causes more is not certain: they differ by less than the errors of their shares."


def _undecided(spread: SpreadStatistics, ranked: Sequence[str]) -> bool:
    """Whether the shares of the first two causes may change places within their 95 % errors, taken as alike."""
    first, second, *_ = *(spread.shares[cause] for cause in ranked), 0.0, 0.0
    error = spread.numbers.get("main_contributor_share_standard_error") or 0.0
    return first - second < INTERVAL * math.sqrt(2) * error


def _parts(row: Row, shares: dict[str, float]) -> str:
    """Return shares of a variance in words; a sum beyond 100 % is explained."""
    about = "about " if rough(row) else ""
    percents = {cause: f"{100 * share:.0f}" for cause, share in shares.items()}
    words = listed([f"{dimension_words(cause)} {about}{share} %" for cause, share in percents.items()], _CAUSES)
    note = "shares of its variance"
    if sum(map(float, percents.values())) > _WHOLE:
        points = points_range([row["spread_points"]], "lines" if row["spread_method"] == "line" else "points")
        note += f", estimated from {points}: their errors make the sum more than 100 %" if about else ", rounded"
    return f"{words} ({note})"


def _classical(facts: SummaryFacts) -> Iterator[str]:
    """Yield what the classical formula says of the worst cup or hat, and its range over all of them."""
    with_disk = facts.ranked.filter(pl.col("hub_shear_MPa").is_not_null())
    if with_disk.is_empty():
        return
    (worst,) = first_rows(with_disk, 1)
    classical, own = worst["cylinder_only_backlash_arcmin"], worst["backlash_arcmin"]
    said, meant = facts.angles.words(classical), facts.angles.words(own)
    yield (
        f"The classical formula, without the disk, gives {said} for {facts.named(worst['variant'])} "
        f"instead of {meant}: {_off(classical / own)}."
    )
    ratios = (with_disk["cylinder_only_backlash_arcmin"] / with_disk["backlash_arcmin"]).to_list()
    if len(ratios) > 1:
        least, most = _off(max(ratios)), _off(min(ratios))
        if least != most and least.split("%")[1] == most.split("%")[1]:
            least = least.split(" %")[0]
        yield f"Over the {grouped(len(ratios))} cups and hats: {least if least == most else f'{least} to {most}'}."


def _off(ratio: float) -> str:
    """Return how far a number is off that is so many times the right one."""
    return f"{100 * abs(ratio - 1):.0f} % too {'low' if ratio <= 1 else 'high'}"


def _strength(facts: SummaryFacts) -> Iterator[str]:
    """Yield how far the variant nearest to yield is from it, and what else the verdict does not show."""
    reserves: dict[tuple[float, str], list[str]] = {}
    for name, section, exact in _nearest_to_yield(facts):
        reserves.setdefault((float(spelled_out(exact, _DIGITS)), section), []).append(name)
    if reserves:
        times, section = least = min(reserves)
        others = len(reserves[least]) - 1
        more = f" and {counted(others, 'other')}" if others else ""
        yield (
            f"Nearest to yield: {facts.named(reserves[least][0])}{more}, whose {section} yields at "
            f"{spelled_out(times, _DIGITS)} times the torque, corners not counted."
        )
    yield from bending(facts)
    for code in ("W402", "W411", "W412", "W415", "W417", "W460"):
        names = dict.fromkeys(finding.variant for finding in facts.outcome.findings if finding.code == code)
        if names:
            yield f"{CATALOGUE[code].title.capitalize()}: {facts.names(list(names))} ({code})."


def _nearest_to_yield(facts: SummaryFacts) -> Iterator[tuple[str, str, float]]:
    """Yield name, governing section and elastic limit over torque of the variants that may be nearest to yield."""
    table = facts.outcome.validated.table if facts.outcome.validated else None
    limited = facts.ranked.filter(pl.col("elastic_limit_torque_Nm").is_not_null())
    if table is not None and limited.height:
        torques = table.frame.select(pl.col("row").alias(ROW), torque="torque_Nm")
        times = pl.col("elastic_limit_torque_Nm") / pl.col("torque")
        joined = limited.join(torques, on=ROW, maintain_order="left")
        reserves = joined.select("variant", "governing_section", times=times)
        # All that the told digits can make equal to the nearest, and some more.
        yield from reserves.filter(pl.col("times") <= _NEARLY * pl.col("times").min()).iter_rows()


def _calculation(facts: SummaryFacts) -> Iterator[str]:
    """Yield what a reader must know of how the numbers were found."""
    outcome = facts.outcome
    yield from _elasticity(outcome)
    yield from two_lobes(facts)
    yield from spread_notes(outcome)
    if exact := _exact_moduli(outcome):
        yield f"The shear modulus of {counted(exact, 'variant')} is given and has no tolerance: it does not scatter."


def _exact_moduli(outcome: Outcome) -> int:
    """Return how many variants have a given shear modulus without a tolerance: that of a material in a class."""
    table = outcome.validated.table if outcome.validated else None
    if table is None:
        return 0
    computed = table.frame.filter(pl.col("row").is_in(list(outcome.computed)))
    alike = computed.group_by("material", "tolerance_class").agg(pl.col("row").first(), count=pl.len())
    count = 0
    for row, rows in alike.select("row", "count").iter_rows():
        variant = outcome.computed[row]
        if "shear_modulus" in variant.variant.dimensions and "shear_modulus" not in variant.limits:
            count += rows
    return count


def _elasticity(outcome: Outcome) -> Iterator[str]:
    """Yield how far the formula is from two-dimensional elasticity, where that was checked."""
    if "elasticity_difference_percent" not in outcome.results.columns:
        return
    checked = outcome.results.filter(outcome.results["elasticity_difference_percent"].is_not_null())
    if checked.height:
        differences = checked["elasticity_difference_percent"].to_list()
        error = max(checked["elasticity_error_percent"].to_list())
        least, most = (f"{difference:+.2f}" for difference in (min(differences), max(differences)))
        span = most if least == most else f"{least} to {most}"
        yield (
            f"Against two-dimensional elasticity the nominal backlash is {span} % off ({checked.height} checked, "
            f"converged to {error:.1g} %)."
        )


def _findings(outcome: Outcome) -> Iterator[str]:
    """Yield how many errors and warnings there are and the commonest of each, which the sheet Findings lists."""
    counts = outcome.counts
    if not counts["errors"] and not counts["warnings"]:
        yield "No error and no warning."
        return
    for level in ("error", "warning"):
        titles = Counter({
            CATALOGUE[code].title: count
            for code, count in rule_counts(outcome).items()
            if CATALOGUE[code].level == level
        })  # fmt: skip
        if titles:
            parts = [f"{title} ({grouped(count)})" for title, count in titles.most_common()]
            yield f"{counted(titles.total(), level)}: {listed(parts, NAMED)}."
