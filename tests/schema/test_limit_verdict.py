"""One place decides whether a variant meets its limit, by its share of units over it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import flexlash
from flexlash.schema.limit_verdict import limit_verdict, misses_limit

SHARES = {0.0: "meets", 0.00135: "meets", 0.0013501: "marginal", 0.025: "marginal", 0.02501: "fails", 1.0: "fails"}


@pytest.mark.parametrize("share", [*SHARES, None])
def test_the_verdict_follows_the_share(share):
    """At most 0.135 % over the limit meets it, at most 2.5 % is marginal, more fails; without a limit there is none."""
    assert limit_verdict(share) == SHARES.get(share)
    assert misses_limit(share) is (SHARES.get(share) in {"marginal", "fails"})


def test_no_other_place_knows_the_bounds():
    """The shares at which a verdict changes stand in one module of those that judge."""
    judging = re.compile(r"[<>]=? *0\.(00135|025)\b|(?<!p)0\.025\b.*amber|amber.*0\.025")
    source = Path(flexlash.__file__).parent
    found = [str(path) for path in source.rglob("*.py") if judging.search(path.read_text(encoding="utf-8"))]
    assert found == []
