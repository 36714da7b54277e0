"""One place decides whether a variant meets its limit, by its share of units over it."""

from __future__ import annotations

import math
import re
from decimal import Decimal
from pathlib import Path

import pytest

import flexlash
from flexlash.schema.limit_verdict import MARGINAL, VerdictBounds
from flexlash.schema.variant import Settings

SHARES = {0.0: "meets", 0.00135: "meets", 0.0013501: "marginal", 0.025: "marginal", 0.02501: "fails", 1.0: "fails"}


@pytest.mark.parametrize("share", [*SHARES, None])
def test_the_verdict_follows_the_share(share):
    """At most 0.135 % over the limit meets it, at most 2.5 % is marginal, more fails; without a limit there is none."""
    bounds = VerdictBounds()
    assert bounds.verdict(share) == SHARES.get(share)
    assert bounds.misses(share) is (SHARES.get(share) in {"marginal", "fails"})


@pytest.mark.parametrize("target", [97.5, 98, 99, 99.73, 99.865, 99.9, 99.99, 99.9999])
def test_the_target_decides_what_meets_the_limit(target):
    """A variant meets its limit with at most 100 less target per cent of units over it, to the last decimal typed."""
    bounds = VerdictBounds.of(target)
    allowed = float(1 - Decimal(str(target)) / 100)
    assert bounds.meets == allowed
    assert bounds.verdict(allowed) == "meets"
    assert not bounds.misses(allowed)
    assert bounds.verdict(math.nextafter(allowed, 1)) == ("fails" if target == 97.5 else "marginal")
    assert bounds.verdict(MARGINAL) == ("meets" if target == 97.5 else "marginal")
    assert bounds.verdict(math.nextafter(MARGINAL, 1)) == "fails"
    assert bounds.any_marginal is (target > 97.5)
    assert bounds.target_words == f"{target} %"
    assert VerdictBounds.of(99.865) == VerdictBounds() == Settings().verdict_bounds


def test_an_interval_straddles_each_bound_once():
    """Where nothing is marginal there is one bound, which an interval on both sides of it straddles once."""
    assert VerdictBounds.of(97.5).straddled(0.01, 0.03) == [0.025]
    assert VerdictBounds.of(99.99).straddled(5e-5, 0.03) == [0.0001, 0.025]
    assert VerdictBounds.of(99.99).straddled(None, None) == []


@pytest.mark.parametrize("target", [97.4, 100, 0, -1])
def test_targets_that_mean_nothing_are_refused(target):
    """No share meets a target of 100 %, and one that asks less than a marginal variant has is none."""
    with pytest.raises(ValueError, match="must be above 0 and at most marginal"):
        VerdictBounds.of(target)


def test_no_other_place_knows_the_bounds():
    """The shares at which a verdict changes stand in one module of those that judge."""
    judging = re.compile(r"[<>]=? *0\.(00135|025)\b|(?<!p)0\.025\b.*amber|amber.*0\.025")
    source = Path(flexlash.__file__).parent
    found = [str(path) for path in source.rglob("*.py") if judging.search(path.read_text(encoding="utf-8"))]
    assert found == []
