"""Where numbers cross 0, found together."""

from __future__ import annotations

import math

import pytest
from scipy.optimize import brentq

from flexlash.decisions.crossings import Bracket, Turn, crossings, past_turns

FUNCTIONS = {
    "line": (lambda x: 3 * x - 4, 0.0, 9.0),
    "cube": (lambda x: x**3 - 2, -1.0, 50.0),
    "steep": (lambda x: math.expm1(20 * (x - 0.3)), 0.0, 2.0),
    "flat": (lambda x: (x - 0.7) ** 5, 0.0, 2.0),
    "falling, given downwards": (lambda x: 1 / x - 0.01, 500.0, 2.0),
    "with ends without measure": (lambda x: math.inf * (x - 0.5) if abs(x - 0.6) > 0.2 else x - 0.45, 0.0, 1.0),
}


def _bracket(name):
    function, low, high = FUNCTIONS[name]
    return Bracket(whose=name, low=low, high=high, at_low=function(low), at_high=function(high))


def _evaluate(asked):
    return [FUNCTIONS[name][0](value) for name, value in asked]


def test_roots_are_those_of_brent():
    """Every root agrees with scipy's Brent, whichever others are sought beside it, to the same bits as alone."""
    names = list(FUNCTIONS)
    found = crossings([_bracket(name) for name in names], _evaluate, 1e-13)
    for name, value in zip(names, found, strict=True):
        function, low, high = FUNCTIONS[name]
        if name != "with ends without measure":
            expected = brentq(function, min(low, high), max(low, high), xtol=1e-13, maxiter=1000)
            assert value == pytest.approx(expected, abs=3e-3 if name == "flat" else 1e-8), name
        else:
            assert value == pytest.approx(0.45, abs=1e-8)
        assert crossings([_bracket(name)], _evaluate, 1e-13) == [value]


def test_an_end_on_the_root_is_the_root():
    """Where an end is 0 already nothing is evaluated."""
    bracket = Bracket(whose="", low=1.0, high=2.0, at_low=0.0, at_high=5.0)
    assert crossings([bracket], lambda asked: pytest.fail(f"asked for {asked}"), 1e-12) == [1.0]


def test_a_number_that_is_missing_has_no_root():
    """Where no part is possible on the way no crossing is told; others go on."""
    line = Bracket(whose="line", low=0.0, high=9.0, at_low=-4.0, at_high=23.0)
    gap = Bracket(whose="gap", low=0.0, high=9.0, at_low=-4.0, at_high=23.0)
    found = crossings(
        [gap, line], lambda asked: [None if whose == "gap" else 3 * value - 4 for whose, value in asked], 1e-12
    )
    assert found == [None, pytest.approx(4 / 3)]


def test_few_evaluations_of_a_smooth_number():
    """A number as smooth as a backlash takes at most six evaluations to a ten-millionth."""
    counted = []

    def evaluate(asked):
        counted.append(len(asked))
        return [1e-3 * (1 / value**2 - 1 / 45.84**2) * 40**2 for _, value in asked]

    ends = {value: 1e-3 * (1 / value**2 - 1 / 45.84**2) * 40**2 for value in (40.0, 50.0)}
    bracket = Bracket(whose="", low=40.0, high=50.0, at_low=ends[40.0], at_high=ends[50.0])
    assert crossings([bracket], evaluate, 1e-10) == [pytest.approx(45.84, rel=1e-6)]
    assert len(counted) <= 6


TURNS = {
    "dip": (lambda x: (x - 1.7) ** 2 - 0.01, (0.0, 2.0, 3.0), True),
    "dip, given downwards": (lambda x: (x - 1.7) ** 2 - 0.01, (3.0, 2.0, 0.0), True),
    "hill of another shape": (lambda x: -0.2 + math.exp(-(abs(x - 0.4) ** 1.5)) - 0.7, (-1.0, 0.05, 3.0), True),
    "touches nothing": (lambda x: (x - 1.7) ** 2 + 0.01, (0.0, 2.0, 3.0), False),
    "far off": (lambda x: 5 + (x - 1.7) ** 2, (0.0, 2.0, 3.0), False),
    "level": (lambda _: 1.0, (0.0, 1.0, 2.0), False),
}
"""A function, three values that have one sign, whether it has another one between them."""


def test_what_turns_past_0_between_its_points_is_bracketed_twice():
    """Zeros before and after a turn are those of Brent; one that comes near to 0, or does not, has none."""
    turns = [Turn(whose=name, values=at, numbers=tuple(map(of, at))) for name, (of, at, _) in TURNS.items()]

    def evaluate(asked):
        return [TURNS[name][0](value) for name, value in asked]

    found = past_turns(turns, evaluate)
    for name, (function, values, turned) in TURNS.items():
        own = [one for one in found if one.whose == name]
        assert len(own) == 2 * turned, name
        assert own == past_turns([turn for turn in turns if turn.whose == name], evaluate)
        for bracket, value in zip(own, crossings(own, evaluate, 1e-13), strict=True):
            assert (function(bracket.low), function(bracket.high)) == (bracket.at_low, bracket.at_high)
            low, high = sorted((bracket.low, bracket.high))
            assert min(values) <= low < high <= max(values)
            assert value == pytest.approx(brentq(function, low, high), abs=1e-8), name
        assert sum(value is not None for value in crossings(own, evaluate, 1e-13)) == len(own)


def test_a_turn_where_no_part_is_possible_is_left_alone():
    """Where the number is missing between the values nothing is told."""
    turn = Turn(whose="", values=(0.0, 2.0, 3.0), numbers=(4.0, 0.1, 3.0))
    assert past_turns([turn], lambda asked: [None] * len(asked)) == []
