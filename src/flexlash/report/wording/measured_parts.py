"""Results rows of measured dimensions → sentences: what so few parts leave open, and how many would settle it."""

from __future__ import annotations

import math
from collections.abc import Iterator

import polars as pl
from scipy.special import ndtri

from flexlash.analysis.run_summary import counted, grouped, listed
from flexlash.report.wording.summary_facts import NAMED, Row, SummaryFacts, first_rows
from flexlash.report.wording.verdict import firm, verdict_word
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.limit_verdict import VERDICTS, VerdictBounds
from flexlash.schema.number_words import brief_share, range_words

__all__ = ["PARTS", "how_left_open", "left_open_by", "left_open_words", "measured_parts"]

PARTS = "Measured parts"
"""The topic of these sentences."""

_ENDS = ("probability_over_limit_sample_low", "probability_over_limit_sample_high")
_MANY = 100
"""Times as many parts as were measured that nobody measures."""

_LEAST = 1e-12
"""Shares nearer to none or all have no score that one could reckon with."""


def measured_parts(facts: SummaryFacts) -> Iterator[str]:
    """Yield what measured parts leave open of some variants, those first whose verdict they may change."""
    if _ENDS[0] not in facts.ranked.columns:
        return
    rows = facts.ranked.filter(pl.col("p99_865_sample_low_arcmin").is_not_null())
    if rows.is_empty():
        return
    low, high = (pl.col(end) for end in _ENDS)
    shares = facts.bounds.shares
    may_change = pl.any_horizontal((low <= share) & (share < high) for share in shares).fill_null(value=False)
    doubtful = rows.filter(may_change)
    for row in first_rows(doubtful) or first_rows(rows, 1):
        yield f"{facts.named(row['variant'])}: {_interval(facts, row)}."
        yield from _verdict(row, facts.bounds)
    yield from _others(rows.filter(low.is_not_null()).height, doubtful.height)
    yield "More lines or points do not narrow this; more measured parts do."


def _others(judged: int, doubtful: int) -> Iterator[str]:
    """Yield how many verdicts measured parts leave open, where not all of them were told."""
    if doubtful > NAMED:
        yield f"In all, the verdicts of {grouped(doubtful)} of {counted(judged, 'variant')} are left open."
    elif not doubtful and judged > 1:
        yield f"The same holds for all {counted(judged, 'variant')}: no verdict is left open."


def left_open_by(facts: SummaryFacts, row: Row) -> Iterator[str]:
    """Yield the same of one variant; nothing where nothing of it was measured."""
    if row.get("p99_865_sample_low_arcmin") is not None:
        told = _interval(facts, row)
        yield f"{told[0].upper()}{told[1:]}."
        yield from _verdict(row, facts.bounds)


def left_open_words(row: Row) -> str:
    """Return the share over the limit that measured parts leave open; an empty text where there is none."""
    low, high = (row.get(end) for end in _ENDS)
    return "" if low is None or high is None else range_words(low, high)


def how_left_open(results: pl.DataFrame) -> Iterator[str]:
    """Yield what the interval is that measured parts leave open, and how it is found; nothing where none is told."""
    if "p99_865_sample_low_arcmin" not in results.columns or not results["p99_865_sample_low_arcmin"].count():
        return
    yield (
        "By measured parts: where mean and standard deviation of a dimension come from measured parts, their "
        "number leaves both uncertain. The intervals of the probability over the limit and of P99.865 by measured "
        "parts hold the true ones of the process in 95 of 100 samples; the interval beside the probability is the "
        "calculation's alone."
    )
    yield (
        "Mean by Student's t, standard deviation by chi-square; of a distribution taken as measured by Bonett's "
        "interval, its skewness and tails by 1.5 times the usual 1.96 of their standard errors; a measured correlation "
        "by Fisher's z. The backlash is spread anew with each of them at either end; together they act as the fiducial "
        "distribution says, which for one normal dimension is exact (noncentral t)."
    )
    yield (
        "It presumes independent parts of one process that stays as it was, and that a dimension taken as normal is "
        "so: where the sheet Samples doubts that, take it as measured."
    )


def _interval(facts: SummaryFacts, row: Row) -> str:
    """Return what is computed of a row and what its measured parts leave open of that."""
    parts = _parts(facts, row)
    if row["backlash_limit_arcmin"] is None:
        tail = facts.angles.words(row["p99_865_arcmin"], row["p99_865_standard_error_arcmin"])
        low, high = (facts.angles.words(row[f"p99_865_sample_{end}_arcmin"]) for end in ("low", "high"))
        return f"99.865 % of units stay below {tail} by calculation; {parts} leave open {low} to {high} (95 %)"
    told, wide = brief_share(row), left_open_words(row)
    if wide == told:
        return f"units over the limit are {told} by calculation, and whatever {parts} leave open (95 %)"
    return f"units over the limit are {told} by calculation; {parts} leave open {wide} (95 %)"


def _parts(facts: SummaryFacts, row: Row) -> str:
    """Return how many parts were measured of which dimensions: `60 measured parts (wall thickness)`."""
    limits = facts.computed(row).limits
    counts: dict[int, list[str]] = {}
    for name, limit in limits.items():
        if limit.sample is not None and limit.low < limit.high:
            counts.setdefault(len(limit.sample.values), []).append(dimension_words(name))
    told = [f"{grouped(count)} measured parts ({listed(names, NAMED)})" for count, names in counts.items()]
    return listed(told, NAMED)


def _verdict(row: Row, bounds: VerdictBounds) -> Iterator[str]:
    """Yield whether the parts leave the verdict on a row open, and how many parts would settle it."""
    low, high = (row[end] for end in _ENDS)
    if low is None or high is None:
        return
    told = firm(verdict_word(row, bounds))
    verdicts = {bounds.verdict(share) for share in (low, high)} | {told}
    if len(verdicts) == 1:
        yield f"At either end the verdict is “{told}”."
        return
    possible = _between(low, high, bounds)
    others = [f"“{verdict}”" for verdict in VERDICTS if verdict in possible and verdict != told]
    yield f"So the verdict “{told}” may as well be {' or '.join(others)}."
    times = _times_to_settle(row, bounds)
    if times > _MANY:
        yield "It lies so near to where the verdict changes that no number of parts would settle it."
    else:
        yield f"About {_rounded_up(times)} times as many parts would settle it, if they scatter as these do."


def _between(low: float, high: float, bounds: VerdictBounds) -> set[str | None]:
    """Return the verdicts that shares between two have."""
    shares = [low, high, *(share for share in bounds.shares if low <= share <= high)]
    return {bounds.verdict(share) for share in shares}


def _times_to_settle(row: Row, bounds: VerdictBounds) -> float:
    """Return how many times as many parts would draw the interval in to one verdict; scores shrink as their root."""
    now, *ends = (_score(row[key]) for key in ("probability_over_limit", *_ENDS))
    times = 1.0
    for share in bounds.shares:
        if row[_ENDS[0]] <= share < row[_ENDS[1]]:
            bound = _score(share)
            reach = max(ends) - now if bound > now else now - min(ends)
            times = max(times, (reach / (bound - now)) ** 2 if bound != now else math.inf)
    return times


def _score(share: float) -> float:
    return -float(ndtri(min(max(share, _LEAST), 1 - _LEAST)))


def _rounded_up(times: float) -> str:
    """Return a number of times with a digit that is not less.

    >>> _rounded_up(1.04), _rounded_up(3.2), _rounded_up(41.0)
    ('1.1', '3.2', '41')
    """
    exact = round(times, 6)
    return f"{math.ceil(exact * 10) / 10:g}" if exact < 10 else str(math.ceil(exact))  # noqa: PLR2004
