"""A batch of many rows: the order from the worst on, its verdicts in numbers, and what stands for rows left out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from flexlash.schema.findings import CATALOGUE
from flexlash.schema.limit_verdict import VERDICTS, Verdict, VerdictBounds

if TYPE_CHECKING:
    import polars as pl

__all__ = ["DRAWN", "LARGE", "WholeBatch", "is_straddled", "verdict_place", "verdicts_of", "worst_rows"]

LARGE = 2000
"""Most submitted rows of which a report repeats every one on all of its sheets."""

DRAWN = 500
"""Most variants that a report draws, worst first."""


@dataclass(frozen=True, kw_only=True)
class WholeBatch:
    """The whole submission, where an outcome holds the worst of its rows alone.

    `rows` were submitted and so many of them `computed`; `verdicts` counts the variants with a limit, `unsettled` those
    whose verdict more points may change, both as `verdicts_of` does; `rules` counts all findings by code.
    `results_file` and `findings_file` are the names of the files beside the report that hold every row of Results and
    every finding; the latter is empty where there is none.
    """

    rows: int
    computed: int
    results_file: str
    verdicts: Mapping[Verdict, int] = field(default_factory=dict)
    unsettled: Mapping[Verdict, int] = field(default_factory=dict)
    rules: Mapping[str, int] = field(default_factory=dict)
    findings_file: str = ""

    @property
    def levels(self) -> Counter[str]:
        """How many findings there are of each level."""
        levels: Counter[str] = Counter()
        for code, count in self.rules.items():
            levels[CATALOGUE[code].level] += count
        return levels


def worst_rows(results: pl.DataFrame, most: int | None = None) -> pl.DataFrame:
    """Return the rows of Results that have a spread, all or at most so many, worst first.

    The greatest share over the limit comes first, among equals the greatest P99.865 over the limit; then rows without a
    limit, the greatest P99.865 first. What is equal in both stays in the given order, so that the worst of several
    parts, one below the other, give the worst of all.
    """
    import polars as pl

    spread = results.filter(pl.col("p97_5_arcmin").is_not_null())
    limit = pl.col("backlash_limit_arcmin")
    share = pl.when(limit.is_null()).then(-1.0).otherwise(pl.col("probability_over_limit"))
    reach = pl.col("p99_865_arcmin") / pl.when(limit == 0.0).then(1.0).otherwise(limit.fill_null(1.0))
    keys = spread.select(share.alias("share"), reach.alias("reach")).with_row_index("place")
    order = keys.sort("share", "reach", "place", descending=[True, True, False])["place"]
    return spread[order if most is None else order.head(most)]


def verdict_place(bounds: VerdictBounds) -> pl.Expr:
    """Return the place among the verdicts of what a row of Results has, from 0; null without a limit."""
    import polars as pl

    over = pl.col("probability_over_limit")
    return pl.when(over.is_not_null()).then(
        pl.sum_horizontal((over > bound).cast(pl.Int32) for bound in (bounds.meets, bounds.marginal))
    )


def is_straddled(bounds: VerdictBounds) -> pl.Expr:
    """Return whether more points may give a row of Results another verdict."""
    import polars as pl

    low, high = pl.col("probability_over_limit_low"), pl.col("probability_over_limit_high")
    return pl.any_horizontal((low <= bound) & (bound < high) for bound in bounds.shares).fill_null(value=False)


def verdicts_of(results: pl.DataFrame, bounds: VerdictBounds) -> tuple[dict[Verdict, int], dict[Verdict, int]]:
    """Return how many variants with a limit have each verdict, and how many of each more points may give another.

    That is so where the 95 % interval of the share over the limit reaches beyond a bound.
    """
    judged = results.select(place=verdict_place(bounds), straddled=is_straddled(bounds))
    every, doubtful = Counter(judged["place"]), Counter(judged.filter("straddled")["place"])
    return (
        {verdict: every[number] for number, verdict in enumerate(VERDICTS)},
        {verdict: doubtful[number] for number, verdict in enumerate(VERDICTS)},
    )
