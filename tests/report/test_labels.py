"""Short names that stay distinct."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flexlash.report.wording.labels import distinct_labels

CASES = {
    "short names stay": (["cup", "hat"], ["cup", "hat"]),
    "a long name alone is cut at its end": (["one long name that is told"], ["one long na…"]),
    "the same start: the end is shown": (["one long name, A", "one long name, B"], ["one lo…me, A", "one lo…me, B"]),
    "the same start and end: numbers": (
        ["one long name 1 of steel", "one long name 2 of steel", "one long name 3 of steel"],
        ["one lo…steel", "one lo…ste…2", "one lo…ste…3"],
    ),
    "a name that looks like a number's label keeps its own": (
        ["one lo…ste…2", "one long name 1 of steel", "one long name 2 of steel"],
        ["one lo…ste…2", "one lo…steel", "one lo…ste…3"],
    ),
    "signs that cannot be seen": (["a\tb", "a\rb"], ["a·b", "a·b…2"]),
}


@pytest.mark.parametrize("case", CASES)
def test_labels_stay_distinct(case):
    """Names are cut where that tells them apart, and numbered only where nothing else does."""
    names, labels = CASES[case]
    assert distinct_labels(names, 12) == labels


@given(names=st.lists(st.text("ab1…", min_size=1, max_size=12), unique=True, max_size=30), longest=st.integers(6, 9))
def test_no_two_labels_are_the_same(names, longest):
    """Whatever the names, each has a label of its own that is short enough; short names are their own labels first."""
    labels = distinct_labels(names, longest)
    assert len(set(labels)) == len(names)
    assert all(len(label) <= longest for label in labels)
