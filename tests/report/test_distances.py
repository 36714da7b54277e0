"""Distances from the limit are told in arcmin, alike in words and in the table's number format."""

from __future__ import annotations

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flexlash.report.wording.distances import distance, distance_format, distance_words
from flexlash.schema.angle_unit import ARC_MINUTES


def _row(value, limit, error):
    return {"p97_5_arcmin": value, "backlash_limit_arcmin": limit, "p97_5_standard_error_arcmin": error}


DISTANCES = {
    "far over": ((6.261963, 3.8, 1e-6), "2.462′ over", "+0.000;-0.000;0.000"),
    "far under": ((3.427964, 3.8, 1e-6), "0.372′ under", "+0.000;-0.000;0.000"),
    "little over": ((2.654028, 2.65, 1e-6), "0.0040′ over", "+0.0000;-0.0000;0.0000"),
    "hardly over": ((2.65000028, 2.65, 0.0), "less than 0.000001′ over", "+0.000000;-0.000000;0.000000"),
    "not known well": ((6.277, 3.8, 0.02), "2.48′ over", "+0.00;-0.00;0.00"),
    "less than is known": ((3.803, 3.8, 0.02), "less than 0.01′ over", "+0.00;-0.00;0.00"),
    "hundreds": ((748.28, 5.0, 1e-3), "743.3′ over", "+0.0;-0.0;0.0"),
    "nothing scatters": ((3.687, 3.6, None), "0.087′ over", "+0.000;-0.000;0.000"),
    "at the limit": ((3.8, 3.8, 0.0), "right at", "+0.000;-0.000;0.000"),
}


@pytest.mark.parametrize("case", DISTANCES)
def test_a_distance_in_words_and_in_a_cell(case):
    """Two digits at least, as many as the percentile has, none beyond its standard error."""
    numbers, words, look = DISTANCES[case]
    assert distance_words(_row(*numbers), "p97_5", ARC_MINUTES) == words
    assert distance_format(_row(*numbers), "p97_5", ARC_MINUTES) == look


@pytest.mark.slow
@settings(deadline=None, derandomize=True)
@given(value=st.floats(1e-2, 1e3), part=st.floats(-0.5, 0.5), error=st.one_of(st.none(), st.floats(1e-9, 1e-1)))
def test_words_and_cell_agree(value, part, error):
    """The sentence has as many decimals as the cell shows, and is right to half of the last one."""
    row = _row(value, value * (1 + part), error)
    words = distance_words(row, "p97_5", ARC_MINUTES)
    places = distance_format(row, "p97_5", ARC_MINUTES).split(";")[0].partition(".")[2]
    if words == "right at" or words.startswith("less than"):
        return
    told = re.match(r"[\d.]+", words)[0]
    assert len(told.partition(".")[2]) == len(places)
    sign = 1 if words.endswith("over") else -1
    assert abs(sign * float(told) - distance(row, "p97_5")) <= 0.5000001 * 10.0 ** -len(places)
