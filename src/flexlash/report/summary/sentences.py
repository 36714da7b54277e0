"""The Summary in words: what a design review asks, each answer below its question, worst first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

from flexlash.assessment import Computed
from flexlash.findings import CATALOGUE, shown, spelled_out
from flexlash.outcome import Outcome
from flexlash.report.summary.advice import stiffening, tightening
from flexlash.report.verdict import light, verdict_counts
from flexlash.summary import angle_words, counted, dimension_words, listed, share_words, spread_notes, worst_first

__all__ = ["FINDINGS", "sentences"]

FINDINGS = "Findings"
"""The topic of the sentence that leads to the sheet of this name."""

_NAME = 30
"""Most characters of a name in a sentence."""

_NAMED = 3
"""Most variants that a sentence names."""

_CAUSES = 3
"""Most dimensions that are named as the cause of a spread."""

_LEAST_CAUSE = 0.01
"""Share of the variance below which a dimension is not named."""

Row: TypeAlias = dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class _Told:
    """An outcome with what several sentences ask of it."""

    outcome: Outcome
    rows: Sequence[Row]

    @cached_property
    def computed(self) -> dict[str, Computed]:
        """The computed variants by name."""
        return {one.variant.name: one for one in self.outcome.computed.values()}

    @cached_property
    def failing(self) -> list[Row]:
        """The variants whose verdict is red or amber, worst first."""
        return [row for row in self.rows if light(row) in {"red", "amber"}]

    @cached_property
    def judged(self) -> list[Row]:
        """The variants with a limit, worst first."""
        return [row for row in self.rows if row["backlash_limit_arcmin"] is not None]


def sentences(outcome: Outcome) -> Iterator[tuple[str, str]]:
    """Yield topic and sentences: what a design review wants to know, rounded by the standard error."""
    told = _Told(outcome=outcome, rows=worst_first(outcome))
    topics = {
        "Computed": _computed(outcome),
        "Which fail": _failing(told),
        "How sure": _sureness(told),
        "Why": _causes(told),
        "What to tighten": tightening(outcome, told.failing),
        "What to stiffen": stiffening(outcome, told.failing),
        "Cylinder-only formula": _classical(told),
        "Strength": _strength(told),
        "Of the calculation": _calculation(outcome),
        FINDINGS: _findings(outcome),
    }
    for topic, found in topics.items():
        text = " ".join(found)
        if text:
            yield topic, text


def _short(row: Row) -> str:
    return shown(row["variant"], longest=_NAME)


def _computed(outcome: Outcome) -> Iterator[str]:
    """Yield how many variants were computed, and the first of those that were not, with its reason."""
    counts = outcome.counts
    rows, computed = counts["rows"], counts["computed"]
    yield f"{computed} of {counted(rows, 'variant')} {'was' if computed == 1 else 'were'} computed."
    lost = outcome.results.filter(outcome.results["status"] == "error")["variant"].to_list()
    if lost:
        yield f"Not computed: {listed([shown(name or '(no name)', longest=_NAME) for name in lost], _NAMED)}."
        first = next((found for found in outcome.findings if found.level == "error"), None)
        if first:
            yield f"The first fault: {first.message}"


def _failing(told: _Told) -> Iterator[str]:
    """Yield which variants fail, by how much; where none does, which is nearest to its limit."""
    if not told.rows:
        return
    counts = verdict_counts(told.outcome)
    if not told.judged:
        worst = told.rows[0]
        greatest = ", the greatest backlash of all" if len(told.rows) > 1 else ""
        yield "No limit was given, so nothing is judged."
        yield f"97.5 % of the units of {_short(worst)} stay below {_tail(worst, 'p97_5')}{greatest}."
        return
    with_limit = counted(len(told.judged), "variant")
    for verdict in ("red", "amber"):
        rows = [row for row in told.failing if light(row) == verdict]
        if rows:
            are = "is" if len(rows) == 1 else "are"
            named = listed([_excess(row, first=place == 0) for place, row in enumerate(rows)], _NAMED)
            yield f"{len(rows)} of {with_limit} with a limit {are} {verdict}: {named}."
    if not told.failing:
        which = "all" if len(told.judged) > 1 else "the"
        yield f"None: {which} {with_limit} with a limit {_are(len(told.judged))} green."
        nearest = max(told.judged, key=lambda row: row["p99_865_arcmin"] / row["backlash_limit_arcmin"])
        yield f"Nearest to its limit is {_excess(nearest, first=True)}."
    elif counts["green"]:
        yield f"{counts['green']} {_are(counts['green'])} green."
    without = len(told.rows) - len(told.judged)
    if without:
        yield f"{without} {'has' if without == 1 else 'have'} no limit."


def _are(count: int) -> str:
    return "is" if count == 1 else "are"


def _tail(row: Row, key: str) -> str:
    """Return a percentile in words, with no more digits than are known or needed."""
    return angle_words(row[f"{key}_arcmin"], row[f"{key}_standard_error_arcmin"])


def _excess(row: Row, *, first: bool) -> str:
    """Return a variant with the percentile that its verdict hangs on and its distance from the limit."""
    red = light(row) == "red"
    key, share = ("p97_5", "97.5 %") if red else ("p99_865", "99.865 %")
    limit, value = row["backlash_limit_arcmin"], row[f"{key}_arcmin"]
    part = f"{spelled_out(100 * abs(value / limit - 1), 2)} % {'over' if value > limit else 'under'}"
    if first:
        return f"{_short(row)} ({share} of its units stay below {_tail(row, key)}, {part} its limit of {limit:g}′)"
    return f"{_short(row)} ({_tail(row, key)}, {part} {limit:g}′)"


def _sureness(told: _Told) -> Iterator[str]:
    """Yield the share over the limit of the worst variants with its interval, and the bounds of the worst one."""
    if not told.rows:
        return
    shares = [(_short(row), share_words(row)) for row in (told.failing or told.judged[:1])[:_NAMED]]
    if shares:
        yield f"Units over the limit: {listed([f'{name} {words}' for name, words in shares], _NAMED)}."
        if any("(" in words for _, words in shares):
            yield "In brackets the 95 % interval of the calculation, for the tolerances as entered."
    worst = told.rows[0]
    low, high = worst["worst_case_low_arcmin"], worst["worst_case_high_arcmin"]
    if low < high:
        low, high = angle_words(low), angle_words(high)
        yield f"With every dimension at a limit the backlash of {_short(worst)} lies between {low} and {high}."


def _causes(told: _Told) -> Iterator[str]:
    """Yield what the spread of the worst variant comes from, and what dominates all of them."""
    if not told.rows:
        return
    worst = told.rows[0]
    variation = told.computed[worst["variant"]].variation
    shares = variation.shares if variation else {}
    if not shares:
        yield f"Nothing scatters in {_short(worst)}: no tolerance applies to its dimensions, so all units are alike."
    ranked = sorted(shares, key=lambda name: (-shares[name], name))
    named = ranked[:1] + [name for name in ranked[1:_CAUSES] if shares[name] >= _LEAST_CAUSE]
    if named:
        parts = [f"{dimension_words(name)} {100 * shares[name]:.0f} %" for name in named]
        yield f"The spread of {_short(worst)} comes from {listed(parts, _CAUSES)} (shares of its variance)."
    main = Counter(name for name in told.outcome.results["main_contributor"].to_list() if name is not None)
    if main.total() > 1:
        order = sorted(main, key=lambda name: (-main[name], name))
        parts = [f"{dimension_words(name)} in {main[name]}" for name in order]
        where = f"all {main.total()} variants" if len(main) == 1 else f"{main.total()} variants"
        what = dimension_words(order[0]) if len(main) == 1 else listed(parts, _CAUSES)
        yield f"Main contributor of {where}: {what}."


def _classical(told: _Told) -> Iterator[str]:
    """Yield what the classical formula would have said of the worst cup or hat, and its range over all of them."""
    worst = next((row for row in told.rows if _has_disk(told.computed[row["variant"]])), None)
    if worst is None:
        return
    classical, own = worst["cylinder_only_backlash_arcmin"], worst["backlash_arcmin"]
    said, meant = angle_words(classical), angle_words(own)
    yield (
        f"The classical formula, without the disk, would have said {said} for {_short(worst)} "
        f"instead of {meant}: {_off(classical / own)}."
    )
    ratios = [
        float(one.nominal["cylinder_only_backlash"] or 0) / float(one.nominal["backlash"] or 1)
        for one in told.computed.values()
        if _has_disk(one)
    ]
    if len(ratios) > 1:
        least, most = _off(max(ratios)), _off(min(ratios))
        if least.split("%")[1] == most.split("%")[1]:
            least = least.split(" %")[0]
        yield f"Over all {len(ratios)} cups and hats: {least if least == most else f'{least} to {most}'}."


def _has_disk(one: Computed) -> bool:
    return one.variant.flexspline_type != "cylinder"


def _off(ratio: float) -> str:
    """Return how far a number is off that is so many times the right one."""
    return f"{100 * abs(ratio - 1):.0f} % too {'low' if ratio <= 1 else 'high'}"


def _strength(told: _Told) -> Iterator[str]:
    """Yield how far the variant nearest to yield is from it, and what else the verdict does not show."""
    reserves = {
        row["variant"]: row["elastic_limit_torque_Nm"] / told.computed[row["variant"]].variant.dimensions["torque"]
        for row in told.rows
        if row["elastic_limit_torque_Nm"] is not None
    }
    if reserves:
        name = min(reserves, key=lambda variant: reserves[variant])
        yield (
            f"Nearest to yield is {shown(name, longest=_NAME)}: its {told.computed[name].nominal['governing_section']} "
            f"yields at {spelled_out(reserves[name], 3)} times the torque, corners not counted."
        )
    for code in ("W402", "W411", "W412", "W415", "W417"):
        names = dict.fromkeys(found.variant for found in told.outcome.findings if found.code == code)
        if names:
            flagged = listed([shown(name, longest=_NAME) for name in names], _NAMED)
            yield f"{CATALOGUE[code].title.capitalize()}: {flagged} ({code})."


def _calculation(outcome: Outcome) -> Iterator[str]:
    """Yield what a reader must know of how the numbers were found."""
    yield from _elasticity(outcome)
    yield from spread_notes(outcome)
    exact = sum(
        "shear_modulus" in one.variant.dimensions and "shear_modulus" not in one.limits
        for one in outcome.computed.values()
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
        least, most = (f"{one:+.2f}" for one in (min(differences), max(differences)))
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
        titles = Counter(CATALOGUE[found.code].title for found in outcome.findings if found.level == level)
        if titles:
            parts = [f"{title} ({count})" for title, count in titles.most_common()]
            yield f"{counted(titles.total(), level)}: {listed(parts, _NAMED)}."
