"""Sentences on what causes the spread: true, and to the point, in constructed cases."""

from __future__ import annotations

import pytest

from flexlash.pipeline import run
from flexlash.report.compare.causes import Cause, cause_sentences, causes_of, left_out, mean_share, ranked_dimensions

WALL, E, NU, HUB = "wall_thickness", "youngs_modulus", "poisson_ratio", "disk_inner_radius"


def _causes(*rows):
    """Return causes of variants A, B, … from their shares."""
    names = "ABCDEFGHIJ"
    return [
        Cause(name=names[place], shares=shares, main=max(shares, key=shares.get)) for place, shares in enumerate(rows)
    ]


CASES = {
    "nothing scatters": (_causes(), ["No dimension has a tolerance that counts: nothing scatters."]),
    "one variant": (_causes({WALL: 0.7, E: 0.3}), ["Wall thickness is the main contributor of A."]),
    "the same everywhere": (
        _causes({WALL: 0.9, E: 0.1}, {WALL: 0.95, E: 0.05}),
        [
            "Wall thickness is the main contributor in all 2 variants.",
            "Wall thickness hurts everywhere (10 % of the variance or more); Young's modulus only in A (10 %).",
        ],
    ),
    "one variant is different": (
        _causes({WALL: 0.6, E: 0.4}, {WALL: 0.7, E: 0.3}, {WALL: 0.3, E: 0.2, HUB: 0.5}),
        [
            "Wall thickness is the main contributor in 2 of 3 variants; disk inner radius only in C.",
            "Wall thickness and Young's modulus hurt everywhere (10 % of the variance or more); disk inner radius only "
            "in C (50 %).",
        ],
    ),
    "nothing in common": (
        _causes({WALL: 1.0}, {E: 1.0}),
        [
            "Wall thickness is the main contributor in A; Young's modulus only in B.",
            "No dimension hurts everywhere (10 % of the variance or more); wall thickness only in A (100 %), Young's "
            "modulus only in B (100 %).",
        ],
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_sentences_say_where_a_tolerance_hurts(name):
    """The main contributor is counted, the one of a single variant named with it."""
    causes, expected = CASES[name]
    assert list(cause_sentences(causes)) == expected


def test_many_main_contributors_are_summed_up():
    """Beyond four main contributors, and three that hurt in one variant only, the others are counted."""
    dimensions = [WALL, E, NU, HUB, "cylinder_length", "torque"]
    first, second = cause_sentences(_causes(*({name: 1.0} for name in dimensions)))
    assert first.count(" in ") == 5
    assert first.endswith("; other dimensions in 2.")
    assert second.endswith("; 3 more in one variant each.")


def test_dimensions_are_ranked_by_their_mean_and_the_others_named():
    """What matters nowhere has no row but is named; a variant without a dimension counts as 0 in its mean."""
    causes = _causes({WALL: 0.2, E: 0.796, NU: 0.004}, {E: 0.5, HUB: 0.5})
    assert ranked_dimensions(causes) == [E, HUB, WALL]
    assert mean_share(causes, WALL) == pytest.approx(0.1)
    assert list(left_out(causes)) == ["Below 0.5 % everywhere and left out: Poisson's ratio."]
    assert list(left_out(_causes({WALL: 1.0}))) == []


def test_causes_are_those_of_the_outcome(table, sound):
    """Each computed variant that scatters is a cause with its shares and the main contributor of Results."""
    outcome = run(table([sound, {**sound, "variant": "bad", "torque_Nm": ""}]), method="random", samples=64)
    (cause,) = causes_of(outcome)
    (computed,) = outcome.computed.values()
    assert (cause.name, cause.shares) == ("B3-160", computed.spread.shares)
    assert cause.main == outcome.results["main_contributor"][0]
