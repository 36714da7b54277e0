"""The Summary in words: what a design review asks, each answer below its question, worst first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from flexlash.analysis.computed import Computed
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.recommendations import Recommendation
from flexlash.analysis.run_summary import counted, dimension_words, listed, points_range, spread_notes
from flexlash.report.wording.advice import stiffening, tightening
from flexlash.report.wording.summary_facts import NAMED, Row, SummaryFacts, rough, summary_facts
from flexlash.report.wording.verdict_sentences import failing, sureness
from flexlash.schema.findings import CATALOGUE, spelled_out
from flexlash.schema.number_words import angle_words

__all__ = ["FINDINGS", "sentences"]

FINDINGS = "Findings"
"""The topic of the sentence that leads to the sheet of this name."""

_DIGITS = 3
"""Digits in which a reserve is told; what is equal in them is alike."""

_CAUSES = 3
"""Most dimensions that are named as the cause of a spread."""

_WHOLE = 100

_LEAST_CAUSE = 0.01
"""Share of the variance below which a dimension is not named."""


def sentences(outcome: Outcome, recommendations: Sequence[Recommendation]) -> Iterator[tuple[str, str]]:
    """Yield topic and sentences: what a design review wants to know, rounded by the standard error.

    `recommendations` are what would help the worst failing variants.
    """
    facts = summary_facts(outcome, recommendations)
    topics = {
        "Computed": _computed(facts),
        "Which fail": failing(facts),
        "How sure": sureness(facts),
        "Why": _causes(facts),
        "What to tighten": tightening(facts),
        "What to stiffen": stiffening(facts),
        "Cylinder-only formula": _classical(facts),
        "Strength": _strength(facts),
        "Of the calculation": _calculation(outcome),
        FINDINGS: _findings(outcome),
    }
    for topic, answer in topics.items():
        text = " ".join(answer)
        if text:
            yield topic, text


def _computed(facts: SummaryFacts) -> Iterator[str]:
    """Yield how many variants were computed, and the first of those that were not, with its reason."""
    outcome = facts.outcome
    counts = outcome.counts
    rows, computed = counts["rows"], counts["computed"]
    yield f"{computed} of {counted(rows, 'variant')} {'was' if computed == 1 else 'were'} computed."
    lost = outcome.results.filter(outcome.results["status"] == "error")["variant"].to_list()
    if lost:
        yield f"Not computed: {listed([facts.named(name) if name else '(no name)' for name in lost], NAMED)}."
        first = next((finding for finding in outcome.findings if finding.level == "error"), None)
        if first:
            yield f"The first fault: {first.message}"


def _causes(facts: SummaryFacts) -> Iterator[str]:
    """Yield what the spread of the worst variant comes from, and what dominates all of them."""
    if not facts.rows:
        return
    worst = facts.rows[0]
    name = facts.named(worst["variant"])
    spread = facts.computed[worst["variant"]].spread
    shares = spread.shares if spread else {}
    if not shares:
        yield f"Nothing scatters in {name}: no tolerance applies to its dimensions, so all units are alike."
    ranked = sorted(shares, key=lambda cause: (-shares[cause], cause))
    named = ranked[:1] + [cause for cause in ranked[1:_CAUSES] if shares[cause] >= _LEAST_CAUSE]
    if named:
        yield f"The spread of {name} comes from {_parts(worst, {cause: shares[cause] for cause in named})}."
    main = Counter(cause for cause in facts.outcome.results["main_contributor"].to_list() if cause is not None)
    if main.total() > 1:
        order = sorted(main, key=lambda cause: (-main[cause], cause))
        parts = [f"{dimension_words(cause)} in {main[cause]}" for cause in order]
        where = f"all {main.total()} variants" if len(main) == 1 else f"{main.total()} variants"
        what = dimension_words(order[0]) if len(main) == 1 else listed(parts, _CAUSES)
        yield f"Main contributor of {where}: {what}."


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
    """Yield what the classical formula would have said of the worst cup or hat, and its range over all of them."""
    worst = next((row for row in facts.rows if _has_disk(facts.computed[row["variant"]])), None)
    if worst is None:
        return
    classical, own = worst["cylinder_only_backlash_arcmin"], worst["backlash_arcmin"]
    said, meant = angle_words(classical), angle_words(own)
    yield (
        f"The classical formula, without the disk, would have said {said} for {facts.named(worst['variant'])} "
        f"instead of {meant}: {_off(classical / own)}."
    )
    ratios = [
        computed.nominal.cylinder_only_backlash / computed.nominal.backlash
        for computed in facts.computed.values()
        if _has_disk(computed)
    ]
    if len(ratios) > 1:
        least, most = _off(max(ratios)), _off(min(ratios))
        if least.split("%")[1] == most.split("%")[1]:
            least = least.split(" %")[0]
        yield f"Over all {len(ratios)} cups and hats: {least if least == most else f'{least} to {most}'}."


def _has_disk(computed: Computed) -> bool:
    return computed.variant.flexspline_type != "cylinder"


def _off(ratio: float) -> str:
    """Return how far a number is off that is so many times the right one."""
    return f"{100 * abs(ratio - 1):.0f} % too {'low' if ratio <= 1 else 'high'}"


def _strength(facts: SummaryFacts) -> Iterator[str]:
    """Yield how far the variant nearest to yield is from it, and what else the verdict does not show."""
    reserves: dict[tuple[float, str], list[str]] = {}
    for row in facts.rows:
        if row["elastic_limit_torque_Nm"] is not None:
            computed = facts.computed[row["variant"]]
            times = float(spelled_out(row["elastic_limit_torque_Nm"] / computed.variant.dimensions["torque"], _DIGITS))
            reserves.setdefault((times, computed.nominal.governing_section), []).append(row["variant"])
    if reserves:
        times, section = least = min(reserves)
        alike = len(reserves[least])
        which = f", one of {alike} alike, is" if alike > 1 else " is"
        yield (
            f"Nearest to yield{which} {facts.named(reserves[least][0])}: its {section} yields at "
            f"{spelled_out(times, _DIGITS)} times the torque, corners not counted."
        )
    for code in ("W402", "W411", "W412", "W415", "W417"):
        names = dict.fromkeys(finding.variant for finding in facts.outcome.findings if finding.code == code)
        if names:
            yield f"{CATALOGUE[code].title.capitalize()}: {facts.names(list(names))} ({code})."


def _calculation(outcome: Outcome) -> Iterator[str]:
    """Yield what a reader must know of how the numbers were found."""
    yield from _elasticity(outcome)
    yield from spread_notes(outcome)
    exact = sum(
        "shear_modulus" in variant.variant.dimensions and "shear_modulus" not in variant.limits
        for variant in outcome.computed.values()
    )
    if exact:
        yield f"The shear modulus of {counted(exact, 'variant')} is given and has no tolerance: it does not scatter."


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
        titles = Counter(CATALOGUE[finding.code].title for finding in outcome.findings if finding.level == level)
        if titles:
            parts = [f"{title} ({count})" for title, count in titles.most_common()]
            yield f"{counted(titles.total(), level)}: {listed(parts, NAMED)}."
