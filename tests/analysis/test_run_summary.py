"""The outcome in words: what was computed, what a reader must know of it, what to do next."""

from __future__ import annotations

import re
from dataclasses import replace

import polars as pl
import pytest

from flexlash.analysis.run_summary import (
    finding_lines,
    limit_lines,
    points_words,
    spread_notes,
    summary_lines,
    to_fix_words,
    words_of_state,
    worst_first,
)
from flexlash.pipeline import check, run
from flexlash.schema.cell_addresses import cell_address, cell_ranges
from flexlash.schema.findings import Finding


def test_cells_are_drawn_together():
    """Runs of a column become ranges, doubles one cell, a sheet's column alone stays itself."""
    assert cell_ranges(map(cell_address, ["D6", "D8", "D7", "D14", "E3", "D14"])) == "D6:D8, D14, E3"
    assert cell_ranges(map(cell_address, ["AA2", "F3", "C4", "C5"])) == "C4:C5, F3, AA2"
    assert cell_ranges((cell_address(f"A{row}") for row in range(2, 60, 2)), most=3) == "A2, A4, A6 and 26 more"
    assert cell_ranges([]) == ""


def _replaced(outcome, **columns):
    """Return the outcome with some Results columns replaced."""
    series = [pl.Series(name, values, dtype=outcome.results.schema[name]) for name, values in columns.items()]
    return replace(outcome, results=outcome.results.with_columns(series))


@pytest.fixture
def three(table, sound):
    """Return the outcome of three variants by 64 lines, cross-checked."""
    rows = [{**sound, "variant": f"v{number}", "torque_Nm": 780.0 + 10 * number} for number in range(3)]
    return run(table(rows), samples=64, cross_check=True)


def test_points_in_words(three, table, sound):
    """Lines or points per variant are told in one way of writing thousands, as a range where variants differ."""
    assert points_words(three) == "64 lines"
    assert points_words(_replaced(three, spread_points=[64.0, 16384.0, 1024.0])) == "64 to 16384 lines"
    assert points_words(_replaced(three, spread_points=[None, 128.0, None])) == "128 lines"
    assert points_words(_replaced(three, spread_points=[None, None, None])) == "no points"
    assert points_words(run(table([sound]), method="sobol")) == "32768 points"
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
    assert one[0] == "Spread of “v1”: why."
    noted = _replaced(three, spread_note=["because", "why", None])
    assert next(spread_notes(noted)) == "Spread of “v0”: because and 1 more, see Results."
    assert "Spread of “v0”: because and 1 more, see Results." in list(summary_lines(noted, "x.csv", ran=True))


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


def test_limit_lines_name_the_worst(table, sound):
    """At most three variants over their limit are named, the worst first, each with its share in words."""
    rows = [{**sound, "variant": f"v{number}", "backlash_limit_arcmin": 3.66 + number / 100} for number in range(5)]
    outcome = run(table(rows), method="random", samples=2**12)
    lines = list(limit_lines(outcome))
    assert lines[0] == (
        "Of 5 variants with a limit 5 fail, 0 are marginal and 0 meet it: 2U at full torque, with at most 0.135 % of "
        "units over the limit; marginal: at most 2.5 %."
    )
    assert [line.split(":")[0] for line in lines[1:]] == ["  v0", "  v1", "  v2"]
    for line in lines[1:]:
        assert re.search(
            r": \d\d\.\d+ % \(\d\d\.\d+ to \d\d\.\d+ %\) of units are over 3\.6[678]′; \d\d\.\d+ % of lots fail\.$",
            line,
        )


def test_all_units_over_their_limit_are_no_part_of_them(table, sound, tmp_path):
    """Where no unit, or hardly one, is within the limit the line says that all units are over, not all of units."""
    outcome = run(table([{**sound, "backlash_limit_arcmin": 3.0}]), samples=64)
    assert list(limit_lines(outcome))[1] == "  B3-160: practically all units are over 3′."
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(
        "tolerance_class,dimension,lower_deviation,upper_deviation\nstandard,rim_length,-1,1\n", encoding="utf-8"
    )
    outcome = run(table([{**sound, "backlash_limit_arcmin": 3.6}]), tolerances=tolerances)
    assert list(limit_lines(outcome))[1] == "  B3-160: all units are over 3.6′."


@pytest.mark.parametrize("content", [b"lock", b"PK\x03\x04 damaged", b"%PDF-1.7", b""])
def test_what_could_not_be_read_has_no_marked_copy(tmp_path, content):
    """The workbook beside a file that could not be read is called by what it holds: the findings alone."""
    path = tmp_path / "broken.xlsx"
    path.write_bytes(content)
    outcome = check(path, marked_copy=tmp_path / "broken-checked.xlsx")
    lines = list(summary_lines(outcome, "broken.xlsx", ran=False))
    assert lines[1] == f"Findings alone, without your file itself: {outcome.written.marked_copy}"


def test_what_was_marked_is_a_marked_copy(table, sound, tmp_path):
    """A table that could be read has its marked copy."""
    outcome = check(table([{**sound, "torque_Nm": ""}]), marked_copy=tmp_path / "checked.xlsx")
    assert f"Marked copy of your file: {tmp_path / 'checked.xlsx'}" in summary_lines(outcome, "x", ran=False)


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
                "fix that and check again, or compute the 2 rows: flexlash run x.csv",
            ],
        ),
        ([{"torque_Nm": ""}], "x.csv", ["0 of 1 rows ready; 1 cell to fix.", "fix that, then: flexlash check x.csv"]),
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
        "a.xlsx: nothing to compute; 1 problem with the file.",
        "Next: fix that, then: flexlash check a.xlsx",
    ]


def _error(cell, sheet="Variants"):
    return Finding(level="error", code="E201", sheet=sheet, cell=cell, message="", fix="")


@pytest.mark.parametrize(
    ("findings", "words"),
    [
        ([], ""),
        ([_error("D6")], "1 cell to fix"),
        ([_error("D6"), _error("D6"), _error("D7"), _error("D6", "Materials")], "3 cells to fix"),
        ([_error("")], "1 problem with the file"),
        ([_error("D6"), _error("", "Tolerance"), _error("")], "1 cell to fix and 2 problems with the file"),
        ([Finding(level="warning", code="W402", message="", fix="")], ""),
    ],
)
def test_cells_are_counted_once(findings, words):
    """However many errors a cell has, it is one cell to fix; errors without a cell are problems with the file."""
    assert to_fix_words(findings) == words


def test_groups_have_their_count_and_their_fixes():
    """Findings of one rule are one group with the number of its cells; different fixes are all said."""
    group = [
        Finding(level="error", code="E112", sheet="Variants", cell=cell, message=f"message {cell}", fix=f"Write {fix}.")
        for cell, fix in (("D1", "a"), ("F1", "b"), ("E1", "a"))
    ]
    assert [line for _, line in finding_lines(group)] == [
        "error E112 misspelt header, 3 cells: Variants!D1, E1, F1",
        "    message D1",
        "    message F1",
        "    message E1",
        "    Fix: Write a.",
        "    Fix: Write b.",
    ]


def test_many_rows_are_told_in_groups_of_digits():
    """Rows are counted as everything else is: from 10,000 on with their digits in groups."""
    counts = {"rows": 25_000, "computed": 24_999, "warnings": 0}
    assert words_of_state(counts, "1 cell to fix", [], ran=True) == "24,999 of 25,000 rows computed; 1 cell to fix"
