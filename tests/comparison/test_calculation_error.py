"""Which changes are the calculation's own: within the errors that both reports give, and no other."""

from __future__ import annotations

import pytest

from flexlash.comparison.calculation_error import is_within_error

P97_5 = {"p97_5_arcmin": 3.6, "p97_5_standard_error_arcmin": 0.003}
SHARE = {
    "probability_over_limit": 0.4,
    "probability_over_limit_low": 0.4 - 0.196,
    "probability_over_limit_high": 0.4 + 0.0196,
}
CASES = {
    "within 4 combined errors": (P97_5, {"p97_5_arcmin": 3.6199, "p97_5_standard_error_arcmin": 0.004}, True),
    "beyond them": (P97_5, {"p97_5_arcmin": 3.6201, "p97_5_standard_error_arcmin": 0.004}, False),
    "an error is missing": (P97_5, {"p97_5_arcmin": 3.6001, "p97_5_standard_error_arcmin": None}, False),
    "a number is missing": (P97_5, {"p97_5_arcmin": None, "p97_5_standard_error_arcmin": 0.003}, False),
    "without error": ({"backlash_arcmin": 3.6}, {"backlash_arcmin": 3.6000001}, False),
    "a verdict in words": ({"status": "ok"}, {"status": "error"}, False),
    "what follows from others": ({"ppk": 1.0}, {"ppk": 1.1}, True),
    "a share, up by little": (SHARE, SHARE | {"probability_over_limit": 0.43}, True),
    "a share, up by much": (SHARE, SHARE | {"probability_over_limit": 0.9, "probability_over_limit_low": 0.9}, False),
    "a share without interval": (SHARE, {"probability_over_limit": 0.4001}, False),
}


@pytest.mark.parametrize("what", CASES)
def test_when_a_change_is_within_the_error(what):
    """Numbers agree within four combined standard errors, those of a share read off its interval's facing ends."""
    old, new, expected = CASES[what]
    changed = [key for key in old if old[key] != new.get(key) and "standard_error" not in key]
    assert changed
    assert is_within_error(changed, old, new) is expected
    assert is_within_error(changed, new, {**old, **dict.fromkeys(new.keys() - old.keys())}) is expected


def test_one_change_beyond_is_enough():
    """A variant is within the error only when all its changes are."""
    old = {**P97_5, "mean_arcmin": 3.0, "mean_standard_error_arcmin": 0.001}
    near, far = old | {"p97_5_arcmin": 3.601}, old | {"p97_5_arcmin": 3.601, "mean_arcmin": 3.1}
    assert is_within_error(["p97_5_arcmin"], old, near)
    assert not is_within_error(["p97_5_arcmin", "mean_arcmin"], old, far)
