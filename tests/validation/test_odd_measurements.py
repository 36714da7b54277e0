"""Values apart from their sample: slips are told, long tails and second groups are not."""

from __future__ import annotations

import random

import pytest
from measured_parts import scattered

from flexlash.validation.odd_measurements import odd_values

WALLS = [round(value, 4) for value in scattered(60)]

SLIPS = {
    "point": (16.07, "1.607"),
    "two points": (0.01607, "1.607"),
    "metres": (0.001607, "1.607"),
    "micrometres": (1607.0, "1.607"),
    "inches": (0.0632677, ""),
    "swapped digits": (1.670, "1.607"),
    "swapped at the front": (6.107, "1.607"),
    "one digit": (1.907, ""),
}


@pytest.mark.parametrize("slip", SLIPS)
def test_a_slip_is_told(slip):
    """One value far from sixty others is told with the only value among them that it can have been."""
    value, meant = SLIPS[slip]
    found = odd_values([*WALLS[:30], value, *WALLS[31:]], are_sizes=True)
    assert list(found) == [30]
    assert (found[30].least, found[30].most) == (min(WALLS), max(WALLS))
    assert found[30].suggestion == meant or (slip == "inches" and found[30].suggestion.startswith("1.60"))


def test_sound_samples_have_none():
    """Of 2,000 sound samples of normal, uniform, lopsided and long-tailed processes none is blamed."""
    draw = random.Random(7)  # noqa: S311
    processes = [
        lambda: draw.gauss(1.6, 0.004),
        lambda: draw.uniform(1.58, 1.62),
        lambda: 1.6 + 0.004 * draw.lognormvariate(0, 0.5),
        lambda: 1.6 + 0.004 * draw.gauss(0, 1) / max(draw.gammavariate(5, 0.2), 1e-9) ** 0.5,
    ]
    for number in range(2000):
        count = draw.choice((5, 8, 20, 60, 200))
        digits = draw.choice((2, 3, 4))
        sample = [round(processes[number % 4](), digits) for _ in range(count)]
        if number % 4 < 2:
            assert odd_values(sample, are_sizes=True) == {}, sample
        else:
            assert len(odd_values(sample, are_sizes=True)) <= count // 20, sample


def test_a_second_group_is_none():
    """Parts of two machines, of which one makes a fifth, are no slips."""
    assert odd_values([*WALLS, *[value + 0.2 for value in WALLS[:15]]], are_sizes=True) == {}


def test_values_that_are_nearly_all_equal():
    """Where the gauge shows one value nearly always, a step of it is none, another size is."""
    assert odd_values([1.6] * 50 + [1.61] * 3, are_sizes=True) == {}
    assert list(odd_values([1.6] * 50 + [16.0], are_sizes=True)) == [50]


def test_deviations_may_be_many_times_each_other():
    """Deviations near 0 differ by any factor; only their scatter counts."""
    deviations = [value - 1.607 for value in WALLS]
    assert odd_values(deviations, are_sizes=False) == {}
    assert list(odd_values([*deviations, 0.9], are_sizes=False)) == [60]


@pytest.mark.parametrize("values", [[], [1.6], [1.6, 1.6, 1.6, 16.0]])
def test_of_few_values_none_is_told(values):
    """Of fewer than five nobody can say which is odd."""
    assert odd_values(values, are_sizes=True) == {}


def test_what_was_meant_may_lie_a_little_beyond_the_others():
    """A slip of the greatest part leaves a value just above the rest: up to half of their width is near enough."""
    values = [1.60, 1.61, 1.62, 1.63, 1.64, 1.62, 1.62, 16.58]
    assert odd_values(values, are_sizes=True)[7].suggestion == "1.658"
    assert odd_values([*values[:7], 16.62], are_sizes=True)[7].suggestion == ""
