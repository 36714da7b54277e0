"""The verdict follows its rule and is counted over all variants."""

from __future__ import annotations

import pytest

from flexlash.pipeline import run
from flexlash.report.wording.verdict import COLOURS, NO_VERDICT, firm, light, straddled, verdict_counts, verdict_rules
from flexlash.schema.limit_verdict import VerdictBounds

BOUNDS = VerdictBounds()
SHARES = {0.0: "green", 0.00135: "green", 0.01: "amber", 0.025: "amber", 0.5: "red", None: NO_VERDICT}


@pytest.mark.parametrize("share", SHARES)
def test_verdict_follows_its_rule(share):
    """Green, amber and red follow the share of units over the limit; a share at its bound keeps it."""
    row = {f"probability_over_limit{end}": share for end in ("", "_low", "_high")}
    assert light(row, BOUNDS) == SHARES[share]
    assert SHARES[share] in COLOURS
    assert (SHARES[share] in verdict_rules(BOUNDS)) == (share is not None)


@pytest.mark.slow
def test_verdicts_are_counted(table, sound):
    """Every computed variant has one verdict; a row with errors has none."""
    limits = (3.7, 3.76, 5, 6, "")
    rows = [{**sound, "variant": f"v{place}", "backlash_limit_arcmin": limit} for place, limit in enumerate(limits)]
    outcome = run(table([*rows, {**sound, "variant": "bad", "torque_Nm": ""}]))
    assert verdict_counts(outcome) == {"red": 1, "amber": 1, "green": 2, NO_VERDICT: 1}
    assert verdict_counts(run(table([{**sound, "torque_Nm": ""}]))) == {}


INTERVALS = {
    "green, known well": ("green", 1e-4, 2e-4, "green", []),
    "green, up to its bound": ("green", 0.0, 0.00134, "green", []),
    "green, maybe amber": ("green", 1e-3, 2e-3, "green?", [0.00135]),
    "green, maybe even red": ("green", 0.0, 0.056, "green?", [0.00135, 0.025]),
    "amber, known well": ("amber", 2e-3, 0.02, "amber", []),
    "amber, maybe green": ("amber", 1e-3, 0.02, "amber?", [0.00135]),
    "amber, maybe red": ("amber", 2e-3, 0.03, "amber?", [0.025]),
    "red, known well": ("red", 0.03, 0.04, "red", []),
    "red, maybe amber": ("red", 0.02, 0.04, "red?", [0.025]),
    "red, of which all were seen": ("red", 0.944, 1.0, "red", []),
    "nothing scatters": ("red", 1.0, 1.0, "red", []),
    "at its bound, exactly": ("green", 0.00135, 0.00135, "green", []),
}


@pytest.mark.parametrize("case", INTERVALS)
def test_a_verdict_that_more_points_may_change_has_a_mark(case):
    """Where the 95 % interval of the share lies on both sides of a bound the verdict has a ? and keeps its colour."""
    verdict, low, high, told, bounds = INTERVALS[case]
    row = {"probability_over_limit": {"green": low, "amber": 0.01, "red": high}[verdict]}
    row |= {"probability_over_limit_low": low, "probability_over_limit_high": high}
    assert light(row, BOUNDS) == told
    assert straddled(row, BOUNDS) == bounds
    assert firm(told) == verdict
    assert COLOURS[told] == COLOURS[verdict]


@pytest.mark.slow
def test_few_points_settle_no_green(table, sound):
    """Of 64 draws none over the limit is no proof of 0.135 %, whereas 64 lines are; counts keep both apart."""
    rows = [{**sound, "variant": f"v{place}", "backlash_limit_arcmin": limit} for place, limit in enumerate((5, 3, ""))]
    few = verdict_counts(run(table(rows), method="random", samples=64))
    assert few == {"green?": 1, "red": 1, NO_VERDICT: 1}
    assert verdict_counts(run(table(rows))) == {"green": 1, "red": 1, NO_VERDICT: 1}
