"""Numbers in words: shares never a bare 0 or 100 %, no more digits than are known."""

from __future__ import annotations

import re

import pytest
from grids import for_each
from hypothesis import given, settings
from hypothesis import strategies as st

from flexlash.report.formula.functions import decimals_to
from flexlash.report.formula.live import live
from flexlash.report.layout.styles import decimals_of
from flexlash.schema.number_words import places, range_words, rounded, share_words
from flexlash.tolerance.capability import clopper_pearson

thorough = settings(deadline=None, max_examples=300, derandomize=True)


def words_of(value, low, high):
    """Return the words of a share with its interval."""
    keys = ("probability_over_limit", "probability_over_limit_low", "probability_over_limit_high")
    return share_words(dict(zip(keys, (value, low, high), strict=True)))


SHARES = {
    "exact: none": ((0.0, 0.0, 0.0), "none"),
    "exact: all": ((1.0, 1.0, 1.0), "all"),
    "none seen": ((0.0, 0.0, 1.1e-4), "at most 110 ppm"),
    "none seen of few": ((0.0, 0.0, 0.0143), "at most 1.43 %"),
    "none seen of very many": ((0.0, 0.0, 4.2e-8), "at most 42 ppb"),
    "none told": ((0.0, 0.0, 1e-15), "practically none"),
    "all seen": ((1.0, 0.9999, 1.0), "at least 99.99 %"),
    "all seen of few": ((1.0, 0.98, 1.0), "at least 98 %"),
    "all told": ((1.0, 1 - 1e-15, 1.0), "practically all"),
    "per cent": ((0.412, 0.407, 0.417), "41.2 % (40.7 to 41.7 %)"),
    "per cent, better known": ((0.41234, 0.4122, 0.4125), "41.234 % (41.220 to 41.250 %)"),
    "known better than it is told": ((0.9945264, 0.9945221, 0.9945306), "99.453 %"),
    "just as well known as it is told": ((0.41234, 0.412225, 0.412455), "41.234 % (41.223 to 41.245 %)"),
    "an interval to one side": ((3e-6, 2.9e-6, 9e-6), "3.0 ppm (2.9 to 9.0 ppm)"),
    "most": ((0.985, 0.98, 0.99), "98.5 % (98.0 to 99.0 %)"),
    "ppm": ((2e-4, 1e-4, 4e-4), "200 ppm (100 to 400 ppm)"),
    "ppm, better known": ((1.234e-6, 1.2e-6, 1.27e-6), "1.23 ppm (1.20 to 1.27 ppm)"),
    "ppb": ((3.3e-9, 2e-9, 5e-9), "3 ppb"),
    "ppb, better known": ((1.918e-8, 1.87e-8, 1.98e-8), "19 ppb"),
    "nearly a ppm": ((9.43e-7, 9.4e-7, 9.5e-7), "940 ppb"),
    "a ppb at most": ((2e-10, 0.0, 1.2e-9), "at most 1.2 ppb"),
    "none seen of a billion": ((0.0, 0.0, 4.2e-7), "at most 420 ppb"),
    "less than is told": ((9e-10, 8e-10, 9.9e-10), "practically none"),
    "much less than is told": ((1e-14, 1e-15, 1e-13), "practically none"),
    "nearly all": ((1 - 2e-5, 1 - 4e-5, 1 - 1e-5), "99.9980 % (99.9960 to 99.9990 %)"),
    "nearly all, better known": ((1 - 1.1e-6, 1 - 1.12e-6, 1 - 1.08e-6), "99.999890 % (99.999888 to 99.999892 %)"),
    "nearly all, known exactly": ((0.9995, 0.9995, 0.9995), "99.9500 %"),
    "all but some ppb": ((1 - 3.16e-8, 1 - 3.2e-8, 1 - 3.1e-8), "99.9999968 %"),
    "all but less than is told": ((1 - 3.2e-11, 1 - 3.3e-11, 1 - 3.1e-11), "practically all"),
}


@for_each("case", SHARES)
def test_a_share_in_words(case):
    """A share is told in per cent, ppm or ppb with its interval and with no more digits than that justifies."""
    numbers, words = SHARES[case]
    assert words_of(*numbers) == words


@pytest.mark.parametrize(
    ("share", "digits"), [(0.0465, r"4\.\d+ %"), (0.8446, r"84\.\d+ %"), (3.2e-5, r"3[12]\.?\d* ppm")]
)
def test_a_share_that_is_known_exactly_is_told(share, digits):
    """A share whose interval is a point, as where one dimension scatters alone, is told and not called all or none."""
    assert re.match(digits, words_of(share, share, share))


def _first_number(words):
    return float(re.search(r"[\d.]+", words)[0])


@for_each("total", [2**power for power in range(4, 23)])
def test_a_counted_share_is_never_a_bare_zero_or_hundred(total):
    """Whatever count of whatever number of points, its words begin with neither 0 nor 100 %."""
    few = range(min(total, 40) + 1)
    for seen in (*few, *(total - count for count in few), total // 3):
        words = words_of(seen / total, *clopper_pearson(seen, total))
        assert _first_number(words) > 0
        assert not re.match(r"100(\.0*)? %", words)
        assert re.search(r"\d (%|ppm|ppb)", words)


@pytest.mark.slow
@thorough
@given(power=st.floats(-14, -0.31), relative=st.floats(1e-4, 0.5), mirrored=st.booleans())
def test_the_words_of_a_share_are_right(power, relative, mirrored):
    """A share of any size, told by its words, lies within its own interval of the share itself."""
    share = 10.0**power
    low, high = share * (1 - relative), share * (1 + relative)
    words = words_of(1 - share, 1 - high, 1 - low) if mirrored else words_of(share, low, high)
    if words.startswith("practically"):
        assert words == ("practically all" if mirrored else "practically none")
        assert high < 1.001e-9
        return
    factor = {"%": 1e-2, "ppm": 1e-6, "ppb": 1e-9}[words.removesuffix(")").split()[-1]]
    told = _first_number(words) * factor
    if mirrored and share >= 0.999e-3:
        assert abs(1 - told - share) <= max(relative * share, 1e-4) + 1e-15  # four digits are told at most
        return
    if mirrored:
        assert factor == 1e-2
        told = 1 - told
    if words.startswith("at least" if mirrored else "at most"):
        assert share < 1.001e-9
        assert told >= 0.99 * high
        return
    # Below a millionth two digits are told, or one where the second is not known.
    brief = 0.5 if relative >= 0.0999 else 0.05
    # Rounding of 1 − share itself leaves 1.1e-16.
    assert abs(told - share) <= max(relative, brief if share < 1.001e-6 else 0) * share + 3e-16
    assert ("(" in words) <= (share > 0.999e-6)


def test_numbers_in_words_have_no_more_digits_than_their_error():
    """A number is rounded at the first digit of its standard error, and to five digits where it has none."""
    assert rounded(3.684217, 0.0021) == "3.684"
    assert rounded(3.684217, 0.0099) == "3.684"
    assert rounded(3.684217, 0.01) == "3.68"
    assert rounded(3.684217, 3.0) == rounded(3.684217, 30.0) == "4"
    assert rounded(3.684217, 0.0) == rounded(3.684217, float("nan")) == "3.6842"
    assert rounded(3.684217, 1e-12) == "3.68421700"


@pytest.mark.slow
@thorough
@given(power=st.floats(-5.9, -0.31), relative=st.floats(1e-7, 0.4), skew=st.floats(0.3, 1.0), mirrored=st.booleans())
def test_an_interval_in_words_can_be_seen(power, relative, skew, mirrored):
    """Where an interval is told its ends differ from the number and have its place, and it holds at most two digits."""
    share = 10.0**power
    low, high = share * (1 - relative), share * (1 + relative * skew)
    words = words_of(1 - share, 1 - high, 1 - low) if mirrored else words_of(share, low, high)
    told = re.findall(r"[\d.]+", words)
    if "(" in words:
        assert len(set(told)) == 3
        assert len({len(one.partition(".")[2]) for one in told}) == 1
        assert float(told[2]) - float(told[1]) < 500 * 10.0 ** -len(told[0].partition(".")[2])
    else:
        assert len(told) == 1


PLACES = [(0.0021, 3), (0.001, 3), (0.00099, 4), (0.3, 1), (1.0, 0), (9.99, 0), (10.0, -1), (4321.0, -3), (1e-9, 9)]


@pytest.mark.parametrize(("error", "decimals"), PLACES)
def test_the_one_rule_of_digits(error, decimals):
    """Sentences, number formats and formulas tell a number to the place of its standard error's first digit."""
    assert places(error) == decimals
    assert decimals_to(live(error), 4.0, most=20.0).value == decimals
    value = 12345.678912345
    for told in (rounded(value, error), f"{value:.{decimals_of(error, '').count('0') - 1}f}"):
        if 0 <= decimals <= 6:
            assert told == f"{value:.{decimals}f}"


def test_a_number_without_an_error_keeps_its_usual_digits():
    """Where nothing is known of the error, the usual digits are told, in formulas too."""
    for error in (live(0.0), live("")):
        assert decimals_to(error, 4.0).value == 4


_ENDS = (0.0, 1e-12, 1e-9, 3e-6, 0.0123, 0.5, 0.9994, 0.99999932, 1 - 1e-9, 1 - 1e-12, 1.0)


@for_each("low", _ENDS)
def test_an_interval_with_any_ends_has_words(low):
    """Where nothing but all units is the upper end, the lower one alone is told."""
    for high in (end for end in _ENDS if end >= low):
        assert re.search(r"\d (%|ppm|ppb)|none|all", range_words(low, high)), (low, high)


def test_an_interval_up_to_all_is_told_by_its_lower_end():
    """With two digits of what it leaves to all, or of itself."""
    assert range_words(0.99912, 1.0) == "at least 99.912 %"
    assert range_words(3e-6, 1.0) == "at least 3 ppm"
    assert range_words(0.0, 1.0) == "0 to 100 %"


def test_the_ends_of_a_narrow_interval_are_told_apart():
    """Many measured parts leave little open, but never an interval of one number."""
    assert range_words(0.001782, 0.001817) == "0.178 to 0.182 %"
    assert range_words(0.99712, 0.99714) == "99.712 to 99.714 %"
    assert range_words(2.5001e-5, 2.5004e-5) == "25.001 to 25.004 ppm"
    assert range_words(0.25, 0.25) == "25 to 25 %"
