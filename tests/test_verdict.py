"""The verdict follows its rule and is counted over all variants."""

from __future__ import annotations

import pytest

from flexlash.pipeline import run
from flexlash.report.verdict import COLOURS, NO_VERDICT, RULES, light, verdict_counts


@pytest.mark.parametrize(
    ("limit", "verdict"), [(3.1, "green"), (3.0, "green"), (2.99, "amber"), (2.0, "amber"), (1.99, "red"), (None, "–")]
)
def test_verdict_follows_its_rule(limit, verdict):
    """Green, amber and red follow P97.5 and P99.865 against the limit; a percentile at the limit keeps it."""
    assert light({"p97_5_arcmin": 2.0, "p99_865_arcmin": 3.0, "backlash_limit_arcmin": limit}) == verdict
    assert verdict in COLOURS
    assert (verdict in RULES) == (limit is not None)


def test_verdicts_are_counted(table, sound):
    """Every computed variant has one verdict; a row with errors has none."""
    limits = (3.7, 3.76, 5, 6, "")
    rows = [{**sound, "variant": f"v{place}", "backlash_limit_arcmin": limit} for place, limit in enumerate(limits)]
    outcome = run(table([*rows, {**sound, "variant": "bad", "torque_Nm": ""}]))
    assert verdict_counts(outcome) == {"red": 1, "amber": 1, "green": 2, NO_VERDICT: 1}
    assert verdict_counts(run(table([{**sound, "torque_Nm": ""}]))) == {}
