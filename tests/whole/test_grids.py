"""The loop over a grid's cases: it runs every one, and names every one that fails."""

import pytest
from grids import for_each


def test_every_offender_is_named():
    """All cases run, the failing ones are listed with their values, and stacked grids cross."""
    seen = []

    @for_each("first, second", [(1, 2), (3, 4)])
    @for_each("third", [5, 6])
    def check(first, second, third):
        seen.append((first, second, third))
        assert third == 5, "too much"

    with pytest.raises(AssertionError, match=r"2 of 2 cases fail\nfirst=1, second=2.*\nthird=6: too much") as failure:
        check()
    assert seen == [(1, 2, 5), (1, 2, 6), (3, 4, 5), (3, 4, 6)]
    assert "first=3, second=4" in str(failure.value)


def test_a_missing_refusal_is_an_offence():
    """A case that was to raise and does not fails like any other."""

    @for_each("number", [0, 1])
    def check(number):
        with pytest.raises(ZeroDivisionError):
            1 / number

    with pytest.raises(AssertionError, match=r"1 of 2 cases fail\nnumber=1: DID NOT RAISE"):
        check()


def test_other_exceptions_name_their_case():
    """An error of the test itself ends the grid and says where."""

    @for_each("number", [1, 0])
    def check(number):
        assert 1 / number

    with pytest.raises(ZeroDivisionError) as failure:
        check()
    assert failure.value.__notes__ == ["in the case {'number': 0}"]


def test_a_grid_without_cases_fails():
    """A grid whose cases have all gone does not pass for sound."""

    @for_each("number", [])
    def check(number):
        raise AssertionError(number)

    with pytest.raises(AssertionError, match="there is no case"):
        check()


@for_each("number", [1, 2])
def test_fixtures_are_handed_over(number, tmp_path):
    """A test in a loop has the fixtures that it asks for besides."""
    assert tmp_path.is_dir()
    assert number
