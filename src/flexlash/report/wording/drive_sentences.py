"""Results rows → sentences on the whole drive: what wind-up and other sources come to, and whose share is whose."""

from __future__ import annotations

from collections.abc import Iterator

import polars as pl

from flexlash.analysis.drive_budget import budget_of, drive_shares
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.run_summary import are, counted, grouped
from flexlash.report.wording.summary_facts import Row, SummaryFacts, first_rows
from flexlash.schema.findings import shown
from flexlash.schema.number_words import INTERVAL, share_words
from flexlash.schema.units import ARCMIN

__all__ = ["DRIVE", "drives_over_limit", "whole_drive", "whole_drive_of"]

DRIVE = "Whole drive"
"""The topic of these sentences."""

_DIGITS = 3
_NAME = 30
_NAMED = 5
"""Most sources that a sentence names."""


def whole_drive(facts: SummaryFacts) -> Iterator[str]:
    """Yield what the whole drive comes to of the variant that is worst by its system limit, and how many exceed it."""
    known = facts.ranked.filter(pl.col("system_mean_arcmin").is_not_null())
    over = "system_probability_over_limit"
    for row in first_rows(known.sort(over, descending=True, nulls_last=True, maintain_order=True), 1):
        yield from whole_drive_of(facts, row, f" of {facts.named(row['variant'])}" if known.height > 1 else "")
        target = facts.outcome.settings.target_percent
        judged = known.filter(pl.col(over).is_not_null())
        missing = judged.filter(pl.col(over) > 1 - target / 100).height
        if judged.height > 1:
            which = "None" if not missing else grouped(missing)
            count = f"{which} of {counted(judged.height, 'variant')} with a system limit {are(missing or 1)}"
            yield f"{count} over it in more than {100 - target:.4g} % of drives."


def whole_drive_of(facts: SummaryFacts, row: Row, whose: str = "") -> Iterator[str]:
    """Yield what the sources and the wind-up of a variant come to; nothing where no source is entered."""
    parts = _parts(facts.outcome, row)
    if not parts:
        return
    angles = facts.angles
    mean, most = (angles.spelled_out(row[f"system_{key}_arcmin"], _DIGITS) for key in ("mean", "worst_case_high"))
    made = f"make {mean} on average and at most {most}"
    yield f"The entered sources and the wind-up{whose} {made}: {parts} of the average."
    high = angles.words(row["system_p99_865_arcmin"], row["system_p99_865_standard_error_arcmin"])
    limit = row["system_limit_arcmin"]
    judged = "no system limit is given"
    if limit is not None:
        judged = f"over the system limit of {angles.entered(limit)}: {drives_over_limit(row)}"
    yield f"99.865 % of such drives stay below {high}; {judged}."


def drives_over_limit(row: Row) -> str:
    """Return the share of drives over the system limit in words, with its interval where that matters."""
    key = "system_probability_over_limit"
    share, reach = row[key], INTERVAL * row[f"{key}_standard_error"]
    ends = {"_low": max(share - reach, 0.0), "": share, "_high": min(share + reach, 1.0)}
    return share_words({f"probability_over_limit{end}": value for end, value in ends.items()})


def _parts(outcome: Outcome, row: Row) -> str:
    """Return what wind-up and sources have of the average, greatest first, in words; empty without a budget."""
    budget = None if outcome.validated is None else budget_of(outcome.validated, outcome.settings)
    if budget is None or row["system_mean_arcmin"] is None:
        return ""
    shares = drive_shares(budget, row["mean_arcmin"] * ARCMIN, (row["sd_arcmin"] or 0.0) * ARCMIN)
    order = sorted(shares, key=lambda share: -share.of_mean)
    told = [f"{shown(share.name, longest=_NAME)} {100 * share.of_mean:.0f} %" for share in order[:_NAMED]]
    rest = order[_NAMED:]
    if rest:
        told.append(f"{counted(len(rest), 'other')} {100 * sum(share.of_mean for share in rest):.0f} %")
    return ", ".join(told)
