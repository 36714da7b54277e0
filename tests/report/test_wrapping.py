"""A wrapped text gets lines enough for every program that shows it."""

from __future__ import annotations

import textwrap

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flexlash.report.layout.wrapping import fitted, lines_of, merged_width

SENTENCE = "Halving the tolerance of wall thickness would bring the units over the limit from 41.2 % to 18 %. " * 4

_LETTER = 0.9
"""Width of the average letter of that sentence in digits, in Carlito."""


@pytest.mark.parametrize("width", [20, 40, 80, 110])
def test_lines_are_neither_too_few_nor_many_too_many(width):
    """A sentence gets at least the lines that its average letter needs, and at most a quarter more and one."""
    needed = len(textwrap.wrap(SENTENCE, round(width / _LETTER)))
    assert needed <= lines_of(SENTENCE, width) <= 1.25 * needed + 1


@pytest.mark.parametrize(("text", "lines"), [("", 1), ("o", 1), ("W" * 40, 4), ("尺" * 40, 5), ("i" * 30, 1)])
def test_wide_letters_take_more_room(text, lines):
    """Broad and full-width letters fill lines sooner than narrow ones, also in a word that is longer than a line."""
    assert lines_of(text, 20) == lines


@given(text=st.text(max_size=200), width=st.floats(5, 100))
def test_a_wider_cell_never_needs_more_lines(text, width):
    """Whatever the text, lines fall with the width and are at least one."""
    assert 1 <= lines_of(text, 1.5 * width) <= lines_of(text, width)


def test_merged_columns_are_as_wide_as_their_pixels():
    """Merged cells have the pixels of their columns, less the space at their sides."""
    assert merged_width([10, 10]) == pytest.approx((2 * 75 - 8) / 7)


@given(text=st.text(max_size=60), width=st.floats(5, 40))
def test_a_fitted_text_is_one_line(text, width):
    """A text that is cut takes one line and is the beginning of itself; one that fits stays whole."""
    cut = fitted(text, width)
    assert lines_of(cut.replace(" ", "i"), width) == 1
    assert cut == text or text.startswith(cut[:-1])
    assert fitted(text, 2.2 * len(text) + 1) == text
