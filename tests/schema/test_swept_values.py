"""The values of a sweep."""

from __future__ import annotations

import pytest

from flexlash.schema.swept_values import MOST_POINTS, swept_count, swept_values


def test_steps_add_up_as_decimals():
    """A sweep of 0.1 in steps of 0.1 holds 0.3 itself and ends on its last value, which binary steps miss."""
    values = swept_values(0.1, 1.0, 0.1)
    assert values == (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
    assert 0.1 + 0.1 + 0.1 not in values


def test_the_last_step_ends_at_most_on_the_last_value():
    """A step that does not end on the last value leaves it out, upwards and downwards; one value alone is a sweep."""
    assert swept_values(1.5, 2.0, 0.2) == (1.5, 1.7, 1.9)
    assert swept_values(2.0, 1.5, 0.2) == (2.0, 1.8, 1.6)
    assert swept_values(3, 3, 1) == (3.0,)


def test_too_many_values_are_not_made():
    """Of a sweep without measure one value more than is allowed is made, which tells that it is too long."""
    assert len(swept_values(0, 1e300, 1e-300)) == MOST_POINTS + 1


def test_a_step_of_nothing_is_refused():
    """A step must be greater than 0."""
    with pytest.raises(ValueError, match="greater than 0"):
        swept_values(0, 1, 0)


def test_the_last_value_is_reached_within_rounding():
    """A step that is a rounded third ends on the last value itself, whether it was rounded up or down."""
    for third in (0.3333333333333333, 0.33333333333333337, 1 / 3):
        assert swept_values(0, 1, third)[-1] == 1.0
        assert swept_count(0, 1, third) == len(swept_values(0, 1, third)) == 4
    assert swept_values(0, 1, 0.333)[-1] == pytest.approx(0.999, abs=1e-15)


def test_how_many_values_there_are_is_told_of_any_number():
    """The count needs no list of the values, however many there are."""
    assert swept_count(0, 1e300, 1e-300) == 10**600 + 1
    for first, last, step in ((0, 7, 0.7), (7, 0, 0.7), (-1, 1, 0.3), (2, 2, 5)):
        assert swept_count(first, last, step) == len(swept_values(first, last, step))
