"""Results rows → sentences: which variants fail, by how much, and how sure that is."""

from __future__ import annotations

from collections.abc import Iterator

import polars as pl

from flexlash.analysis.run_summary import are, counted, grouped, listed, points_range
from flexlash.report.wording.distances import STORED, deciding_percentile, distance_words
from flexlash.report.wording.summary_facts import NAMED, Row, SummaryFacts, first_rows
from flexlash.report.wording.verdict import (
    NO_VERDICT,
    UNSETTLED,
    firm,
    straddled,
    verdict_counts,
    verdict_rules,
    verdict_verb,
    verdict_word,
)
from flexlash.schema.limit_verdict import VERDICTS, Verdict
from flexlash.schema.number_words import brief_share, share_words

WORST_CASE = "Worst case"
"""The topic of what the tolerances allow at worst, whatever the calculation's own error is."""

__all__ = ["WORST_CASE", "extremes", "extremes_of_worst", "failing", "judged", "sureness"]

_PERCENTILES = {"p97_5": "97.5 %", "p99_865": "99.865 %"}
_VERDICTS = {"fails": "It fails", "marginal": "It is marginal", "meets": "It meets its limit"}
_IN_BRACKETS = "In brackets the 95 % interval of the calculation, for the tolerances as entered."


def failing(facts: SummaryFacts) -> Iterator[str]:
    """Yield which variants fail, by how much; where none does, which is nearest to its limit."""
    worst = facts.worst
    if worst is None:
        return
    counts = verdict_counts(facts.outcome)
    if not (judged := counts.total() - counts[NO_VERDICT]):
        greatest = ", the greatest backlash of all" if facts.extent.total > 1 else ""
        yield "No limit was given, so nothing is judged."
        tail = _tail(facts, worst, "p97_5")
        yield f"97.5 % of the units of {facts.named(worst['variant'])} stay below {tail}{greatest}."
        return
    with_limit, doubts = counted(judged, "variant"), {verdict: counts[f"{verdict}{UNSETTLED}"] for verdict in VERDICTS}
    numbers = {verdict: counts[verdict] + doubts[verdict] for verdict in VERDICTS}
    missing: tuple[Verdict, ...] = ("fails", "marginal")
    for verdict in missing:
        if number := numbers[verdict]:
            rows = first_rows(facts.judged.filter(pl.col("verdict") == verdict))
            excess = [_excess(facts, row, first=index == 0) for index, row in enumerate(rows)]
            named = f": {listed(excess, NAMED, number)}" if excess else ""
            verb = f"{are(number)} marginal" if verdict == "marginal" else verdict_verb(verdict, number)
            yield f"{grouped(number)} of {with_limit} with a limit {verb}{_doubt(doubts[verdict], number)}{named}."
    meeting = numbers["meets"]
    if meeting == judged:
        which = "all" if meeting > 1 else "the"
        verb = f"{verdict_verb('meets', meeting)} it"
        yield f"None: {which} {with_limit} with a limit {verb}{_doubt(doubts['meets'], meeting)}."
        reach = pl.col(f"{deciding_percentile(facts.bounds)[0]}_arcmin") / pl.col("backlash_limit_arcmin")
        nearest = facts.judged.row(facts.judged.select(reach.arg_max()).item(), named=True)
        whose = f" of the {facts.extent.drawn} worst" if facts.outcome.whole else ""
        yield f"Nearest to its limit{whose} is {_excess(facts, nearest, first=True)}."
    elif meeting:
        yield f"{grouped(meeting)} {verdict_verb('meets', meeting)} it{_doubt(doubts['meets'], meeting)}."
    if without := counts[NO_VERDICT]:
        yield f"{grouped(without)} {'has' if without == 1 else 'have'} no limit."


def sureness(facts: SummaryFacts) -> Iterator[str]:
    """Yield the share over the limit of the worst variants with its interval, and what is not settled."""
    named = first_rows(facts.failing) or first_rows(facts.judged, 1)
    shares = [(facts.named(row["variant"]), share_words(row)) for row in named]
    if shares:
        yield f"Units over the limit: {listed([f'{name} {words}' for name, words in shares], NAMED)}."
        if any("(" in words for _, words in shares):
            yield _IN_BRACKETS
    yield from _unsettled(facts)


def extremes_of_worst(facts: SummaryFacts) -> Iterator[str]:
    """Yield what the worst case, first order and the computed distribution say of the worst variant."""
    row = facts.worst
    if row is None or not row["worst_case_low_arcmin"] < row["worst_case_high_arcmin"]:
        return
    yield from extremes(facts, row)
    if row["first_order_sd_arcmin"] is not None:
        high = facts.angles.words(row["mean_arcmin"] + 3 * row["first_order_sd_arcmin"])
        yield (
            f"Mean + 3 first-order standard deviations (RSS) give {high}; by Monte Carlo 99.865 % of units stay below "
            f"{_tail(facts, row, 'p99_865')}, from a nominal {facts.angles.words(row['backlash_arcmin'])}."
        )


def extremes(facts: SummaryFacts, row: Row) -> Iterator[str]:
    """Yield between which bounds the backlash of a variant lies whatever the parts are, where it scatters."""
    low, high = row["worst_case_low_arcmin"], row["worst_case_high_arcmin"]
    if low < high:
        low, high = facts.angles.words(low), facts.angles.words(high)
        name = facts.named(row["variant"])
        yield f"With every dimension at its worst limits the backlash of {name} lies between {low} and {high}."


def judged(facts: SummaryFacts, row: Row) -> Iterator[str]:
    """Yield of one variant how far its percentiles are from its limit, its verdict, and the share over the limit."""
    tails = {words: _tail(facts, row, key) for key, words in _PERCENTILES.items()}
    (first, low), (second, high) = tails.items()
    if row["backlash_limit_arcmin"] is None:
        yield f"{first} of its units stay below {low}, {second} below {high}."
        yield "No limit was given, so nothing is judged."
        return
    near, far = (distance_words(row, key, facts.angles) for key in _PERCENTILES)
    limit, verdict = facts.angles.entered(row["backlash_limit_arcmin"]), verdict_word(row, facts.bounds)
    yield f"{first} of its units stay below {low}, {near} its limit of {limit}; {second} below {high}, {far} it."
    doubt = " (not settled)" if verdict.endswith(UNSETTLED) else ""
    yield f"{_VERDICTS[firm(verdict)]}{doubt}: {verdict_rules(facts.bounds)[firm(verdict)]}."
    words = share_words(row)
    yield f"Units over the limit: {words}."
    if "(" in words:
        yield _IN_BRACKETS


def _doubt(doubtful: int, count: int) -> str:
    """Return how many of some verdicts are not settled, an empty text for none."""
    if not doubtful:
        return ""
    every = ", but not settled" if count == 1 else ", none of them settled"
    return every if doubtful == count else f", {grouped(doubtful)} of them not settled"


def _unsettled(facts: SummaryFacts) -> Iterator[str]:
    """Yield how many verdicts are not settled, why, and what would settle them."""
    rows = facts.judged.filter("straddled")
    whole = facts.outcome.whole
    count = sum(whole.unsettled.values()) if whole else rows.height
    if not count:
        return
    told = f"{counted(count, 'verdict')} with ? {are(count)} not settled"
    if rows.is_empty():
        yield f"{told}."
    else:
        ends = rows.select("probability_over_limit_low", "probability_over_limit_high").iter_rows(named=True)
        shares = sorted({share for row in ends for share in straddled(row, facts.bounds)})
        bounds = " or ".join(f"{100 * share:g}" for share in shares)
        lines = (rows["spread_method"] == "line").all()
        points = points_range(rows["spread_points"].to_list(), "lines" if lines else "points")
        yield f"{told}: {points} leave open whether more than {bounds} % of units are over the limit."
    yield (
        "Run with more samples."
        if facts.outcome.settings.method == "line"
        else ("Run with more samples or with the method line.")
    )


def _tail(facts: SummaryFacts, row: Row, key: str) -> str:
    """Return a percentile in words, with no more digits than are known or needed."""
    return facts.angles.words(row[f"{key}_arcmin"], row[f"{key}_standard_error_arcmin"])


def _excess(facts: SummaryFacts, row: Row, *, first: bool) -> str:
    """Return a variant with the percentile that decides whether it meets its limit, and its distance from the limit."""
    bounds = facts.bounds
    name, limit = facts.named(row["variant"]), facts.angles.entered(row["backlash_limit_arcmin"])
    if bounds.verdict(row["probability_over_limit"]) == "marginal" and bounds.target_words not in STORED:
        return f"{name} (units over its limit of {limit}: {brief_share(row)})"
    key, percentile = deciding_percentile(bounds)
    tail, off = _tail(facts, row, key), distance_words(row, key, facts.angles)
    if first:
        return f"{name} ({percentile.removeprefix('P')} % of its units stay below {tail}, {off} its limit of {limit})"
    return f"{name} ({tail}, {off} {limit})"
