"""The outcome in words: shares never a bare 0 or 100 %, no more digits than are known, what a reader must know."""

from __future__ import annotations

import re

import polars as pl
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flexlash.findings import Finding, cell_ranges
from flexlash.pipeline import check, run
from flexlash.summary import (
    finding_lines,
    over_limit_lines,
    points_words,
    rounded,
    share_words,
    spread_notes,
    summary_lines,
    to_fix_words,
    worst_first,
)
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
    "all seen": ((1.0, 0.9999, 1.0), "all but at most 100 ppm"),
    "all seen of few": ((1.0, 0.98, 1.0), "all but at most 2 %"),
    "all told": ((1.0, 1 - 1e-15, 1.0), "practically all"),
    "per cent": ((0.412, 0.407, 0.417), "41.2 % (40.7 to 41.7 %)"),
    "per cent, better known": ((0.41234, 0.4122, 0.4125), "41.23 % (41.22 to 41.25 %)"),
    "most": ((0.985, 0.98, 0.99), "98.5 % (98.0 to 99.0 %)"),
    "ppm": ((2e-4, 1e-4, 4e-4), "200 ppm (100 to 400 ppm)"),
    "ppm, better known": ((1.234e-6, 1.2e-6, 1.27e-6), "1.23 ppm (1.20 to 1.27 ppm)"),
    "ppb": ((3e-9, 2e-9, 5e-9), "3 ppb (2 to 5 ppb)"),
    "part of a ppb": ((1.01e-11, 0.96e-11, 1.07e-11), "0.0101 ppb (0.0096 to 0.0107 ppb)"),
    "less than is told": ((1e-14, 1e-15, 1e-13), "practically none"),
    "all but ppm": ((1 - 2e-5, 1 - 4e-5, 1 - 1e-5), "all but 20 ppm (10 to 40 ppm)"),
    "all but less than is told": ((1 - 1e-14, 1 - 1e-13, 1.0), "practically all"),
}


@pytest.mark.parametrize("case", SHARES)
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


@pytest.mark.parametrize("total", [2**power for power in range(4, 23)])
def test_a_counted_share_is_never_a_bare_zero_or_hundred(total):
    """Whatever count of whatever number of points, its words begin with neither 0 nor 100 %."""
    few = range(min(total, 40) + 1)
    for seen in (*few, *(total - count for count in few), total // 3):
        words = words_of(seen / total, *clopper_pearson(seen, total))
        assert _first_number(words) > 0
        assert not re.match(r"100(\.0*)? %", words)
        assert re.search(r"\d (%|ppm|ppb)", words)


@thorough
@given(power=st.floats(-14, -0.31), relative=st.floats(1e-4, 0.5), mirrored=st.booleans())
def test_the_words_of_a_share_are_right(power, relative, mirrored):
    """A share of any size, told by its words, lies within its own interval of the share itself."""
    share = 10.0**power
    low, high = share * (1 - relative), share * (1 + relative)
    words = words_of(1 - share, 1 - high, 1 - low) if mirrored else words_of(share, low, high)
    if words.startswith("practically"):
        assert words == ("practically all" if mirrored else "practically none")
        assert high < 1.001e-12
        return
    factor = {"%": 1e-2, "ppm": 1e-6, "ppb": 1e-9}[words.removesuffix(")").split()[-1]]
    told = _first_number(words) * factor
    if mirrored and not words.startswith("all but"):
        assert abs(1 - told - share) <= max(relative * share, 1e-4) + 1e-15  # four digits are told at most
        assert share >= 0.999e-3
    else:
        assert words.startswith("all but") == mirrored
        # Rounding of 1 − share itself leaves 1.1e-16.
        assert abs(told - share) <= relative * share + 3e-16


def test_numbers_in_words_have_no_more_digits_than_their_error():
    """A number is rounded at the first digit of its standard error, and to five digits where it has none."""
    assert rounded(3.684217, 0.0021) == "3.684"
    assert rounded(3.684217, 0.0099) == "3.684"
    assert rounded(3.684217, 0.01) == "3.68"
    assert rounded(3.684217, 3.0) == rounded(3.684217, 30.0) == "4"
    assert rounded(3.684217, 0.0) == rounded(3.684217, float("nan")) == "3.6842"
    assert rounded(3.684217, 1e-12) == "3.68421700"


def test_cells_are_drawn_together():
    """Runs of a column become ranges, doubles one cell, a sheet's column alone stays itself."""
    assert cell_ranges(["D6", "D8", "D7", "D14", "E3", "D14"]) == "D6:D8, D14, E3"
    assert cell_ranges(["AA2", "F3", "C4", "C5"]) == "C4:C5, F3, AA2"
    assert cell_ranges([f"A{row}" for row in range(2, 60, 2)], most=3) == "A2, A4, A6 and 26 more"
    assert cell_ranges([]) == ""


def _replaced(outcome, **columns):
    """Return the outcome with some Results columns replaced."""
    outcome.results = outcome.results.with_columns(
        *(pl.Series(name, values, dtype=outcome.results.schema[name]) for name, values in columns.items())
    )
    return outcome


@pytest.fixture
def three(table, sound):
    """Return the outcome of three variants by 64 lines, cross-checked."""
    rows = [{**sound, "variant": f"v{number}", "torque_Nm": 780.0 + 10 * number} for number in range(3)]
    return run(table(rows), samples=64, cross_check=True)


def test_points_in_words(three, table, sound):
    """Lines or points per variant are told with thousands apart, as a range where variants differ."""
    assert points_words(three) == "64 lines"
    assert points_words(_replaced(three, spread_points=[64.0, 16384.0, 1024.0])) == "64 to 16,384 lines"
    assert points_words(_replaced(three, spread_points=[None, 128.0, None])) == "128 lines"
    assert points_words(_replaced(three, spread_points=[None, None, None])) == "no points"
    assert points_words(run(table([sound]), method="sobol")) == "32,768 points"
    assert points_words(run(table([sound]), method="random", samples=100)) == "128 points"


def test_exact_variants_have_no_points(table, sound, tmp_path):
    """Where nothing scatters there are no points to tell of, and no note on them."""
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(
        "tolerance_class,dimension,lower_deviation,upper_deviation\nstandard,rim_length,-1,1\n", encoding="utf-8"
    )
    outcome = run(table([sound]), tolerances=tolerances, cross_check=True)
    assert points_words(outcome) == "no points"
    assert list(spread_notes(outcome)) == []


def test_nothing_is_said_of_a_spread_as_expected(table, sound):
    """Lines that served every row to the precision wanted need no word."""
    assert list(spread_notes(run(table([sound])))) == []


def test_notes_name_the_first_row_and_count_the_others(three):
    """A note on the spread is told for the first row that has one, with the number of others that have one too."""
    one = list(spread_notes(_replaced(three, spread_note=[None, "why", None])))
    assert one[0] == "Spread of v1: why."
    two = list(spread_notes(_replaced(three, spread_note=["because", "why", None])))
    assert two[0] == "Spread of v0: because and 1 more, see Results."
    assert "Spread of v0: because and 1 more, see Results." in list(summary_lines(three, "x.csv", ran=True))


def test_cross_check_is_told(three):
    """The cross-check is told with its greatest difference; a variant that differs is not counted as agreeing."""
    checked = _replaced(three, cross_check_deviation=[1.24, 0.5, 2.06])
    assert list(spread_notes(checked)) == [
        "Plain Monte Carlo agrees for 3 of 3 variants; the greatest difference is 2.1 combined standard errors."
    ]
    differing = _replaced(checked, cross_check=["agrees", "differs", None], cross_check_deviation=[1.24, 5.5, None])
    (said,) = spread_notes(differing)
    assert said.startswith("Plain Monte Carlo agrees for 1 of 2 variants; ")


def test_the_greatest_difference_is_that_of_checked_rows(three):
    """Rows that were not checked, among others that were, do not stop the sentence."""
    some = _replaced(three, cross_check=[None, "agrees", "agrees"], cross_check_deviation=[None, 1.0, 3.0])
    (said,) = spread_notes(some)
    assert said.endswith("the greatest difference is 3.0 combined standard errors.")
    none = _replaced(three, cross_check=[None] * 3, cross_check_deviation=[None] * 3)
    assert list(spread_notes(none)) == []


def test_the_worst_come_first(table, sound):
    """Variants stand by falling share over their limit; those too rare to tell apart by how near P99.865 comes."""
    limits = {"far": 5.0, "near": 4.2, "over": 3.6, "none": "", "beyond": 30.0}
    rows = [{**sound, "variant": name, "backlash_limit_arcmin": limit} for name, limit in limits.items()]
    outcome = run(table(rows), samples=64)
    assert [row["variant"] for row in worst_first(outcome)] == ["over", "near", "far", "beyond", "none"]


def test_over_limit_lines_name_the_worst(table, sound):
    """At most three variants over their limit are named, the worst first, each with its share in words."""
    rows = [{**sound, "variant": f"v{number}", "backlash_limit_arcmin": 3.66 + number / 100} for number in range(5)]
    outcome = run(table(rows))
    lines = list(over_limit_lines(outcome))
    assert lines[0] == "P97.5 is over the backlash limit for 5 of 5 variants with a limit."
    assert [line.split(":")[0] for line in lines[1:]] == ["  v0", "  v1", "  v2"]
    for line in lines[1:]:
        assert re.search(r": \d\d\.\d+ % \(\d\d\.\d+ to \d\d\.\d+ %\) of units are over 3\.6[678]′\.$", line)


def test_a_check_says_nothing_of_the_spread(table, sound):
    """A check alone has no spread to tell of."""
    outcome = check(table([sound]))
    assert points_words(outcome) == "no points"
    assert list(summary_lines(outcome, "x.csv", ran=False)) == [
        "x.csv: 1 of 1 rows ready.",
        "Next: flexlash run x.csv",
    ]


@pytest.mark.parametrize(
    ("changes", "name", "lines"),
    [
        ([{}], "x.csv", ["1 of 1 rows ready.", "flexlash run x.csv"]),
        ([{}], "my x.csv", ["1 of 1 rows ready.", 'flexlash run "my x.csv"']),
        (
            [{}, {}, {"torque_Nm": -1, "wall_thickness_mm": "1,6"}],
            "x.csv",
            [
                "2 of 3 rows ready; 2 cells to fix.",
                "mend that and check again, or compute the 2 rows: flexlash run x.csv",
            ],
        ),
        ([{"torque_Nm": ""}], "x.csv", ["0 of 1 rows ready; 1 cell to fix.", "mend that, then: flexlash check x.csv"]),
        ([{"torque_Nm": 12000}], "x.csv", ["1 of 1 rows ready; 1 warning.", "flexlash run x.csv"]),
    ],
)
def test_a_check_ends_with_what_is_ready_and_the_next_command(table, sound, changes, name, lines):
    """The last lines count rows, cells to fix and warnings, and end with the command to type next."""
    row = {**sound, "backlash_limit_arcmin": ""}
    path = table([{**row, "variant": f"v{number}", **one} for number, one in enumerate(changes)])
    assert list(summary_lines(check(path), name, ran=False)) == [f"{name}: {lines[0]}", f"Next: {lines[1]}"]


def test_an_unreadable_file_is_one_problem(tmp_path):
    """A file that is refused has one problem of the file to fix, and nothing else is counted."""
    path = tmp_path / "a.xlsx"
    path.write_bytes(b"PK\x03\x04half")
    assert list(summary_lines(check(path), "a.xlsx", ran=False)) == [
        "a.xlsx: nothing to compute; 1 problem of the file to fix.",
        "Next: mend that, then: flexlash check a.xlsx",
    ]


def _error(cell, sheet="Variants"):
    return Finding(level="error", code="E201", sheet=sheet, cell=cell, message="", fix="")


@pytest.mark.parametrize(
    ("findings", "words"),
    [
        ([], ""),
        ([_error("D6")], "1 cell to fix"),
        ([_error("D6"), _error("D6"), _error("D7"), _error("D6", "Materials")], "3 cells to fix"),
        ([_error("")], "1 problem of the file to fix"),
        ([_error("D6"), _error("", "Tolerance"), _error("")], "1 cell and 2 problems of the file to fix"),
        ([Finding(level="warning", code="W402", message="", fix="")], ""),
    ],
)
def test_cells_are_counted_once(findings, words):
    """However many errors a cell has, it is one cell to fix; errors without a cell are problems of the file."""
    assert to_fix_words(findings) == words


def test_groups_have_their_count_and_their_mends():
    """Findings of one rule are one group with the number of its cells; different mends are all said."""
    group = [
        Finding(level="error", code="E112", sheet="Variants", cell=cell, message=f"message {cell}", fix=f"Write {fix}.")
        for cell, fix in (("D1", "a"), ("F1", "b"), ("E1", "a"))
    ]
    assert [line for _, line in finding_lines(group)] == [
        "error E112 misspelt header, 3 cells: Variants!D1, E1, F1",
        "    message D1",
        "    message F1",
        "    message E1",
        "    Mend: Write a.",
        "    Mend: Write b.",
    ]
