"""The verdict follows its rule and is counted over all variants."""

from __future__ import annotations

import pytest

from flexlash.pipeline import run
from flexlash.report.wording.verdict import (
    COLOURS,
    NO_VERDICT,
    firm,
    straddled,
    verdict_counts,
    verdict_rules,
    verdict_word,
)
from flexlash.schema.limit_verdict import VerdictBounds

BOUNDS = VerdictBounds()
SHARES = {0.0: "meets", 0.00135: "meets", 0.01: "marginal", 0.025: "marginal", 0.5: "fails", None: NO_VERDICT}


@pytest.mark.parametrize("share", SHARES)
def test_verdict_follows_its_rule(share):
    """Meets, marginal and fails follow the share of units over the limit; a share at its bound keeps it."""
    row = {f"probability_over_limit{end}": share for end in ("", "_low", "_high")}
    assert verdict_word(row, BOUNDS) == SHARES[share]
    assert SHARES[share] in COLOURS
    assert (SHARES[share] in verdict_rules(BOUNDS)) == (share is not None)


@pytest.mark.slow
def test_verdicts_are_counted(table, sound):
    """Every computed variant has one verdict; a row with errors has none."""
    limits = (3.7, 3.76, 5, 6, "")
    rows = [{**sound, "variant": f"v{place}", "backlash_limit_arcmin": limit} for place, limit in enumerate(limits)]
    outcome = run(table([*rows, {**sound, "variant": "bad", "torque_Nm": ""}]))
    assert verdict_counts(outcome) == {"fails": 1, "marginal": 1, "meets": 2, NO_VERDICT: 1}
    assert verdict_counts(run(table([{**sound, "torque_Nm": ""}]))) == {}


INTERVALS = {
    "meets, known well": ("meets", 1e-4, 2e-4, "meets", []),
    "meets, up to its bound": ("meets", 0.0, 0.00134, "meets", []),
    "meets, maybe marginal": ("meets", 1e-3, 2e-3, "meets?", [0.00135]),
    "meets, maybe even fails": ("meets", 0.0, 0.056, "meets?", [0.00135, 0.025]),
    "marginal, known well": ("marginal", 2e-3, 0.02, "marginal", []),
    "marginal, maybe meets": ("marginal", 1e-3, 0.02, "marginal?", [0.00135]),
    "marginal, maybe fails": ("marginal", 2e-3, 0.03, "marginal?", [0.025]),
    "fails, known well": ("fails", 0.03, 0.04, "fails", []),
    "fails, maybe marginal": ("fails", 0.02, 0.04, "fails?", [0.025]),
    "fails, of which all were seen": ("fails", 0.944, 1.0, "fails", []),
    "nothing scatters": ("fails", 1.0, 1.0, "fails", []),
    "at its bound, exactly": ("meets", 0.00135, 0.00135, "meets", []),
}


@pytest.mark.parametrize("case", INTERVALS)
def test_a_verdict_that_more_points_may_change_has_a_mark(case):
    """Where the 95 % interval of the share lies on both sides of a bound the verdict has a ? and keeps its colour."""
    verdict, low, high, told, bounds = INTERVALS[case]
    row = {"probability_over_limit": {"meets": low, "marginal": 0.01, "fails": high}[verdict]}
    row |= {"probability_over_limit_low": low, "probability_over_limit_high": high}
    assert verdict_word(row, BOUNDS) == told
    assert straddled(row, BOUNDS) == bounds
    assert firm(told) == verdict
    assert COLOURS[told] == COLOURS[verdict]


@pytest.mark.slow
def test_few_points_settle_no_meets(table, sound):
    """Of 64 draws none over the limit is no proof of 0.135 %, whereas 64 lines are; counts keep both apart."""
    rows = [{**sound, "variant": f"v{place}", "backlash_limit_arcmin": limit} for place, limit in enumerate((5, 3, ""))]
    few = verdict_counts(run(table(rows), method="random", samples=64))
    assert few == {"meets?": 1, "fails": 1, NO_VERDICT: 1}
    assert verdict_counts(run(table(rows))) == {"meets": 1, "fails": 1, NO_VERDICT: 1}
