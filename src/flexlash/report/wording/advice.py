"""What to change, in words: which tolerance to halve and what that brings, or how much stiffer a variant must be."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import polars as pl

from flexlash.analysis.recommendations import Halving, Recommendation
from flexlash.analysis.run_summary import counted
from flexlash.report.wording.summary_facts import Row, SummaryFacts
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.findings import spelled_out
from flexlash.schema.number_words import angle_words, glance, rounded, share_error, share_words

__all__ = ["stiffening", "tightening", "tightening_of"]

_LEVERS = 2
"""Most dimensions named by which a variant gets stiffer."""

_RARE = 1e-3
"""Shares nearer to none or all than this are told in ppm."""

_WORTH = 0.1
"""Part of the way to green that half a tolerance must bring to be worth its mention."""

_LEAST_SLOPE = 0.1
"""Per cent of backlash for one per cent of a dimension below which that dimension is no lever."""


def tightening(facts: SummaryFacts) -> Iterator[str]:
    """Yield which tolerance to halve and what that brings, or why no tolerance helps, or that none needs to."""
    if facts.failing.is_empty():
        if facts.judged.height:
            yield from _nothing(facts)
        return
    hopeless = facts.failing.filter(pl.col("p50_arcmin") > pl.col("backlash_limit_arcmin"))["variant"].to_list()
    if hopeless:
        yield _hopeless(facts, hopeless)
    for recommendation in facts.recommendations:
        if recommendation.halvings:
            yield _halvings(facts, recommendation)


def tightening_of(facts: SummaryFacts, row: Row) -> Iterator[str]:
    """Yield the same of one variant that does not meet its limit; nothing where no halving was looked at."""
    if row["p50_arcmin"] > row["backlash_limit_arcmin"]:
        yield _hopeless(facts, [row["variant"]])
    for recommendation in facts.recommendations:
        if recommendation.variant == row["variant"] and recommendation.halvings:
            yield _halvings(facts, recommendation)


def stiffening(facts: SummaryFacts) -> Iterator[str]:
    """Yield how the worst red variants become stiffer, and by which wall they would keep their limit."""
    recommendations = facts.recommendations
    for recommendation in recommendations:
        if recommendation.thickening is not None or not recommendation.halvings:
            yield from _levers(facts, recommendation)
            yield from _thickening(recommendation)
    if any(recommendation.thickening and recommendation.thickening.wanted for recommendation in recommendations):
        yield "How the wave generator bends a thicker wall is not judged here."


def _nothing(facts: SummaryFacts) -> Iterator[str]:
    """Yield that nothing is to be changed, as far as that is settled."""
    whole = facts.outcome.whole
    if unsettled := sum(whole.unsettled.values()) if whole else int(facts.judged["straddled"].sum()):
        yield f"Nothing so far: no variant is found to fail, but {counted(unsettled, 'verdict')} may change."
    else:
        yield "Nothing: no variant with a limit needs a tighter tolerance or a stiffer part."


def _hopeless(facts: SummaryFacts, variants: Sequence[str]) -> str:
    """Return that no tolerance helps some variants."""
    whose = "its backlash is" if len(variants) == 1 else "their backlash is"
    return (
        f"Tighter tolerances cannot help {facts.names(variants)}: {whose} over the limit for half of the units or more."
    )


def _row(facts: SummaryFacts, recommendation: Recommendation) -> Row:
    """Return the Results row that a recommendation is for."""
    return facts.failing.row(by_predicate=pl.col("variant") == recommendation.variant, named=True)


def _halvings(facts: SummaryFacts, recommendation: Recommendation) -> str:
    """Return what half the tolerance of one dimension, or of all, would leave over the limit."""
    name, row = facts.named(recommendation.variant), _row(facts, recommendation)
    now, every = row["probability_over_limit"], recommendation.halvings[-1]
    least = _WORTH * (now - facts.bounds.meets)
    worth = [halving for halving in recommendation.halvings if now - halving.over["probability_over_limit"] >= least]
    if not worth:
        what = "all of them" if len(every.limits) > 1 else "that of the only one that scatters"
        return (
            f"Tighter tolerances hardly help {name}: halving {what} only brings the units over the limit from "
            f"{_share(row)} to {_share(every.over)}."
        )
    return (
        f"Halving the tolerance of {_halved(worth[0])} would bring the units of {name} over the limit from "
        f"{_share(row)} to {_share(worth[0].over)}"
        + "".join(f"; of {_halved(other)}, to {_share(other.over)}" for other in worth[1:])
        + "."
    )


def _share(over: Mapping[str, Any]) -> str:
    """Return a share over the limit in three digits, or fewer where its error is greater, without its interval."""
    value, low, high = (over[f"probability_over_limit{end}"] for end in ("", "_low", "_high"))
    if not _RARE <= value <= 1 - _RARE:
        return share_words(over).split(" (")[0]
    return f"{rounded(100 * value, 100 * max(share_error(low, high), 10 * glance(value)))} %"


def _halved(halving: Halving) -> str:
    """Return what is halved: one dimension with the limits that this leaves, or how many."""
    if len(halving.limits) > 1:
        return f"all {len(halving.limits)} dimensions"
    ((name, limits),) = halving.limits.items()
    column = DIMENSIONS[name]
    size = column.si_unit.si
    unit = "" if column.unit == "-" else f" {column.unit}"
    half = spelled_out((limits.high - limits.low) / 2 / size, 3)
    return f"{dimension_words(name)} (to {limits.middle / size:.6g} ± {half}{unit})"


def _levers(facts: SummaryFacts, recommendation: Recommendation) -> Iterator[str]:
    """Yield what makes a variant stiffer, most first."""
    name, row = facts.named(recommendation.variant), _row(facts, recommendation)
    median = angle_words(row["p50_arcmin"], row["p50_standard_error_arcmin"])
    levers = [lever for lever in recommendation.levers if abs(lever.slope) >= _LEAST_SLOPE][:_LEVERS]
    if levers:
        parts = [
            f"1 % {'less' if lever.slope > 0 else 'more'} {dimension_words(lever.dimension)} "
            f"{'lowers the backlash by' if index == 0 else 'by'} {spelled_out(abs(lever.slope), 2)} %"
            for index, lever in enumerate(levers)
        ]
        limit = f"{row['backlash_limit_arcmin']:g}′"
        yield f"To stiffen {name} (median {median}, limit {limit}): {', '.join(parts)}."


def _thickening(recommendation: Recommendation) -> Iterator[str]:
    """Yield which wall would bring P97.5 to the limit."""
    thickening = recommendation.thickening
    if thickening is None:
        return
    present = f"{1000 * thickening.present:.6g} mm"
    if thickening.wanted is None:
        thickest = f"{1000 * thickening.thickest:.4g} mm"
        yield f"A thicker wall alone is not enough for it, even {thickest} instead of {present}."
    else:
        wanted = f"{_rounded_up(1000 * thickening.wanted):.6g} mm"
        yield f"A wall of about {wanted} instead of {present} would keep 97.5 % of its units within the limit."


def _rounded_up(value: float) -> float:
    """Return a number in three digits that is not less.

    >>> _rounded_up(2.63662), _rounded_up(0.65), _rounded_up(12.31)
    (2.64, 0.65, 12.4)
    """
    unit = 10.0 ** (math.floor(math.log10(value)) - 2)
    return round(math.ceil(round(value / unit, 6)) * unit, 12)
