"""Results rows → sentences: which variants fail, by how much, and how sure that is."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from flexlash.analysis.run_summary import are, counted, listed, points_range
from flexlash.report.wording.distances import distance_words
from flexlash.report.wording.summary_facts import NAMED, Row, SummaryFacts
from flexlash.report.wording.verdict import firm, light, straddled
from flexlash.schema.number_words import angle_words, share_words

__all__ = ["failing", "sureness"]

_PERCENTILES = {"p97_5": "97.5 %", "p99_865": "99.865 %"}


def failing(facts: SummaryFacts) -> Iterator[str]:
    """Yield which variants fail, by how much; where none does, which is nearest to its limit."""
    if not facts.rows:
        return
    if not facts.judged:
        worst = facts.rows[0]
        greatest = ", the greatest backlash of all" if len(facts.rows) > 1 else ""
        yield "No limit was given, so nothing is judged."
        yield f"97.5 % of the units of {facts.named(worst['variant'])} stay below {_tail(worst, 'p97_5')}{greatest}."
        return
    rows = {verdict: [row for row in facts.judged if firm(light(row)) == verdict] for verdict in ("red", "amber")}
    green = [row for row in facts.judged if firm(light(row)) == "green"]
    with_limit = counted(len(facts.judged), "variant")
    for verdict, with_verdict in rows.items():
        if with_verdict:
            named = listed([_excess(facts, row, first=index == 0) for index, row in enumerate(with_verdict)], NAMED)
            count = f"{len(with_verdict)} of {with_limit} with a limit {are(len(with_verdict))}"
            yield f"{count} {verdict}{_doubt(with_verdict)}: {named}."
    if not facts.failing:
        which = "all" if len(green) > 1 else "the"
        yield f"None: {which} {with_limit} with a limit {are(len(green))} green{_doubt(green)}."
        nearest = max(green, key=lambda row: row["p99_865_arcmin"] / row["backlash_limit_arcmin"])
        yield f"Nearest to its limit is {_excess(facts, nearest, first=True)}."
    elif green:
        yield f"{len(green)} {are(len(green))} green{_doubt(green)}."
    without = len(facts.rows) - len(facts.judged)
    if without:
        yield f"{without} {'has' if without == 1 else 'have'} no limit."


def sureness(facts: SummaryFacts) -> Iterator[str]:
    """Yield the share over the limit of the worst variants with its interval, and the bounds of the worst one."""
    if not facts.rows:
        return
    named = (facts.failing or facts.judged[:1])[:NAMED]
    shares = [(facts.named(row["variant"]), share_words(row)) for row in named]
    if shares:
        yield f"Units over the limit: {listed([f'{name} {words}' for name, words in shares], NAMED)}."
        if any("(" in words for _, words in shares):
            yield "In brackets the 95 % interval of the calculation, for the tolerances as entered."
    yield from _unsettled(facts)
    worst = facts.rows[0]
    low, high = worst["worst_case_low_arcmin"], worst["worst_case_high_arcmin"]
    if low < high:
        low, high = angle_words(low), angle_words(high)
        name = facts.named(worst["variant"])
        yield f"With every dimension at a limit the backlash of {name} lies between {low} and {high}."


def _doubt(rows: Sequence[Row]) -> str:
    """Return how many of some verdicts are not settled, an empty text for none."""
    count = sum(bool(straddled(row)) for row in rows)
    if not count:
        return ""
    every = ", but not settled" if len(rows) == 1 else ", none of them settled"
    return every if count == len(rows) else f", {count} of them not settled"


def _unsettled(facts: SummaryFacts) -> Iterator[str]:
    """Yield how many verdicts are not settled, why, and what would settle them."""
    rows = [row for row in facts.judged if straddled(row)]
    if not rows:
        return
    shares = sorted({share for row in rows for share in straddled(row)})
    bounds = " or ".join(f"{100 * share:g}" for share in shares)
    lines = all(row["spread_method"] == "line" for row in rows)
    points = points_range([row["spread_points"] for row in rows], "lines" if lines else "points")
    yield (
        f"{counted(len(rows), 'verdict')} with ? {are(len(rows))} not settled: {points} leave open whether more than "
        f"{bounds} % of units are over the limit."
    )
    yield (
        "Run with more samples."
        if facts.outcome.settings.method == "line"
        else ("Run with more samples or with the method line.")
    )


def _tail(row: Row, key: str) -> str:
    """Return a percentile in words, with no more digits than are known or needed."""
    return angle_words(row[f"{key}_arcmin"], row[f"{key}_standard_error_arcmin"])


def _excess(facts: SummaryFacts, row: Row, *, first: bool) -> str:
    """Return a variant with the percentile that its verdict hangs on and its distance from the limit."""
    key = "p97_5" if firm(light(row)) == "red" else "p99_865"
    name, limit = facts.named(row["variant"]), f"{row['backlash_limit_arcmin']:g}′"
    tail, off = _tail(row, key), distance_words(row, key)
    if first:
        return f"{name} ({_PERCENTILES[key]} of its units stay below {tail}, {off} its limit of {limit})"
    return f"{name} ({tail}, {off} {limit})"
