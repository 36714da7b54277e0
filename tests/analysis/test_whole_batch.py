"""The order of a batch and its verdicts in numbers are those that its rows give one by one."""

from __future__ import annotations

from random import Random

import polars as pl
import pytest

from flexlash.analysis.outcome import Outcome
from flexlash.analysis.results import empty_results
from flexlash.analysis.whole_batch import WholeBatch, verdicts_of, worst_rows
from flexlash.reading.raw import Submission
from flexlash.report.wording.verdict import straddled
from flexlash.schema.limit_verdict import VERDICTS, VerdictBounds


def _results(rows):
    """Return so many rows with and without a spread and a limit, many of them alike."""
    source, made = Random(3), []  # noqa: S311
    for number in range(rows):
        limit = source.choice([None, 2.0, 3.0])
        share = None if limit is None else source.choice([0.0, 1e-3, 0.00135, 0.01, 0.025, 0.5, 1.0])
        computed = source.random() < 0.9
        made.append({
            "variant": f"V{number}",
            "backlash_limit_arcmin": limit,
            "p97_5_arcmin": 1.0 if computed else None,
            "p99_865_arcmin": source.choice([1.5, 2.0, 2.5]) if computed else None,
            "probability_over_limit": share if computed else None,
            "probability_over_limit_low": None if share is None or not computed else share * 0.9,
            "probability_over_limit_high": None if share is None or not computed else min(1.0, share * 1.1 + 1e-4),
        })  # fmt: skip
    return pl.DataFrame(made, infer_schema_length=None)


def _badness(row):
    limit = row["backlash_limit_arcmin"]
    return (-1.0 if limit is None else row["probability_over_limit"], row["p99_865_arcmin"] / (limit or 1.0))


def test_the_worst_come_first_and_equals_stay_in_order():
    """Rows with a spread are sorted by share, then by P99.865 over the limit, as Python's stable sort has them."""
    results = _results(500)
    rows = [row for row in results.iter_rows(named=True) if row["p97_5_arcmin"] is not None]
    expected = [row["variant"] for row in sorted(rows, key=_badness, reverse=True)]
    assert worst_rows(results)["variant"].to_list() == expected
    assert worst_rows(results, 20)["variant"].to_list() == expected[:20]


def test_the_worst_of_parts_are_the_worst_of_all():
    """The worst of each part, one below the other, hold the worst of all in the same order."""
    results = _results(300)
    parts = pl.concat([worst_rows(results[start : start + 70], 25) for start in range(0, 300, 70)])
    assert worst_rows(parts, 25).equals(worst_rows(results, 25))


@pytest.mark.parametrize("target", [97.5, 99.865, 99.99])
def test_verdicts_are_counted_as_row_by_row(target):
    """Verdicts, and those of them that are not settled, are counted as the single rows have them."""
    results, bounds = _results(500), VerdictBounds.of(target)
    every, doubtful = verdicts_of(results, bounds)
    rows = list(results.iter_rows(named=True))
    for verdict in VERDICTS:
        having = [row for row in rows if bounds.verdict(row["probability_over_limit"]) == verdict]
        assert every[verdict] == len(having)
        assert bool(having) is (bounds.any_marginal or verdict != "marginal")
        assert doubtful[verdict] == sum(bool(straddled(row, bounds)) for row in having)
    assert sum(doubtful.values())


def test_an_outcome_of_the_worst_rows_counts_the_whole_submission():
    """Counts are those of the whole submission, its findings by the level of their rules."""
    whole = WholeBatch(
        rows=1_000_000,
        computed=999_998,
        results_file="gears.parquet",
        verdicts={"meets": 7, "marginal": 2, "fails": 1},
        rules={"E201": 2, "W402": 5, "W411": 4, "I501": 9},
    )
    submission = Submission(name="gears.parquet", sha256="", kind="parquet", sheets={})
    counts = Outcome(submission=submission, results=empty_results(), findings=(), whole=whole).counts
    expected = {"rows": 1_000_000, "computed": 999_998, "errors": 2, "warnings": 9}
    assert counts == expected | {"meets": 7, "marginal": 2, "fails": 1}
