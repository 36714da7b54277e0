"""Formulas that carry their value: the text means what was worked out, whatever was put together."""

from __future__ import annotations

import io
import operator

import openpyxl
import pytest
import xlsxwriter
from hypothesis import given, settings
from hypothesis import strategies as st

from flexlash.report.formula.functions import CONCATENATE, IF
from flexlash.report.formula.live import Live, fill, is_error, live, put

NUMBERS = st.one_of(st.integers(-9, 9).map(float), st.sampled_from([0.1, 2.5, -0.3, 1e-7, 3e20]))
SIGNS = {"+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv}


def _trees(depth=4):
    """Return expressions put together from numbers and references by the four signs and powers."""
    leaf = NUMBERS.map(live) | NUMBERS.map(lambda number: Live("cell", number) if number == 2.5 else live(number))
    return st.recursive(
        leaf,
        lambda inner: (
            st.tuples(st.sampled_from([*SIGNS.values()]), inner, inner).map(lambda one: one[0](*one[1:]))
            | inner.map(operator.neg)
            | st.tuples(inner, st.sampled_from([1.0, 2.0])).map(lambda one: one[0] ** one[1])
        ),
        max_leaves=2**depth,
    )


@pytest.mark.slow
@settings(max_examples=400, deadline=None, derandomize=True)
@given(_trees())
def test_the_text_means_the_value(found):
    """Read by the rules of arithmetic, the text comes to the very value: no parenthesis lacks."""
    if is_error(found.value):
        return
    assert eval(found.text.replace("^", "**"), {"cell": 2.5}) == found.value  # noqa: S307


@pytest.mark.parametrize(
    ("found", "text"),
    [
        (live(2.0) - (live(3.0) - 1.0), "2-(3-1)"),
        (live(2.0) - live(3.0) - 1.0, "2-3-1"),
        (live(2.0) / (live(3.0) * 4.0), "2/(3*4)"),
        (live(2.0) * 3.0 / 4.0, "2*3/4"),
        ((live(2.0) + 1.0) ** 2.0, "(2+1)^2"),
        (live(-2.0) ** 2.0, "(-2)^2"),
        (2.0 - live(-3.0), "2-(-3)"),
        (-(live(1.0) + 2.0), "0-(1+2)"),
        (1.0 / live(4.0), "1/4"),
        (live(1e-7) + 1e20, "1E-07+1E+20"),
    ],
)
def test_parentheses_only_where_they_matter(found, text):
    """A formula has the parentheses that it takes, and no other, so that a reader can follow it."""
    assert found.text == text


@pytest.mark.parametrize(
    ("found", "value"),
    [
        (live(1.0) / 0.0, "#DIV/0!"),
        (live("words") + 1.0, "#VALUE!"),
        (live("") * 2.0, "#VALUE!"),
        ((live(1.0) / 0.0) + live("words"), "#DIV/0!"),
        (live(0.0) ** -1.0, "#NUM!"),
        (live(1e200) ** 2.0, "#NUM!"),
        (live("words") > 1e300, True),
        (live("a").equals("A"), True),
        (live("1").equals(1.0), False),
        (live("b") > "A", True),
        (live(2.0) >= 2.0, True),
        (live(2.0) < 2.0, False),
        (live(2.0) <= 1.0, False),
        (IF(live(1.0) > 0.0, "yes", live(1.0) / 0.0), "yes"),
        (IF(live(1.0) / 0.0, "yes", "no"), "#DIV/0!"),
        (CONCATENATE("a ", live("b"), ""), "a b"),
        (CONCATENATE("a ", Live("$A$1", "#N/A")), "#N/A"),
    ],
)
def test_errors_texts_and_comparisons_are_those_of_excel(found, value):
    """A text is more than any number and no number itself; letter case does not count; errors pass through."""
    assert found.value == value
    assert type(found.value) is type(value)


def test_a_text_is_not_a_number():
    """Asked for its number, an expression that is a text or a truth raises."""
    for one in (live("a"), live(1.0) > 0.0):
        with pytest.raises(TypeError, match="not a number"):
            _ = one.number


def test_cells_hold_formula_and_value():
    """A written expression is a formula with its value, its reference stands for it; entries are constants."""
    data = io.BytesIO()
    with xlsxwriter.Workbook(data) as workbook:
        sheet = workbook.add_worksheet()
        entry = fill(sheet, 0, 0, 2.5, None)
        blank = fill(sheet, 1, 0, "", None)
        text = fill(sheet, 2, 0, '=say "hi"', None)
        found = put(sheet, 3, 0, entry * 4.0, None)
        put(sheet, 4, 0, CONCATENATE(text, "!"), None)
    assert (entry.text, blank.text, found.text) == ("$A$1", "$A$2", "$A$4")
    assert (entry.value, blank.value, found.value) == (2.5, "", 10.0)
    for data_only, column in ((True, [2.5, None, '=say "hi"', 10, '=say "hi"!']), (False, [2.5, None, '=say "hi"'])):
        sheet = openpyxl.load_workbook(data, data_only=data_only).active
        assert [cell.value for cell in sheet["A"]][: len(column)] == column
    assert sheet["A4"].value == "=$A$1*4"
    assert sheet["A3"].data_type == "s"


def test_quotes_in_a_text_are_doubled():
    """A text with quotation marks stays one text in a formula."""
    assert live('a "b"').text == '"a ""b"""'
