"""Results alone: the engineer's own columns beside them, typed and never lost, and a CSV that can do nothing."""

from __future__ import annotations

import csv
import datetime
import io
import json

import openpyxl
import polars as pl
import pytest
from written import write_outcome

from flexlash.pipeline import run
from flexlash.report.results_table import csv_text, results_table

SAMPLES = 64


@pytest.fixture
def results(table, sound):
    """Return a function that gives the table of rows with other columns beside a sound row's, as CSV submits them."""

    def of(*rows):
        return results_table(
            run(table([{**sound, "variant": f"v{place}", **row} for place, row in enumerate(rows)]), samples=SAMPLES)
        )

    return of


@pytest.mark.parametrize("ending", ["csv", "parquet", "json"])
def test_own_columns_reach_every_form(table, sound, tmp_path, ending):
    """The engineer's own columns follow the Results, under their headers, also for rows that were not computed."""
    rows = [{**sound, "Drawing": "D-17", "Pieces": 12}, {**sound, "variant": "b", "torque_Nm": "", "Drawing": "D-18"}]
    outcome = run(table(rows), samples=SAMPLES)
    path = write_outcome(outcome, tmp_path / f"out.{ending}")
    if ending == "csv":
        read = list(csv.DictReader(io.StringIO(path.read_text(encoding="utf-8"))))
    elif ending == "json":
        read = json.loads(path.read_text(encoding="utf-8"))["results"]
    else:
        read = pl.read_parquet(path).to_dicts()
    assert list(read[0]) == [*outcome.results.columns, "Drawing", "Pieces"]
    assert [row["Drawing"] for row in read] == ["D-17", "D-18"]
    assert [row["Pieces"] for row in read] == (["12", ""] if ending == "csv" else [12, None])


def test_without_own_columns_the_table_is_results(table, sound):
    """A submission without columns of its own gives the Results as they are; one without a header row none."""
    outcome = run(table([sound]), samples=SAMPLES)
    assert results_table(outcome).equals(outcome.results)
    refused = run(table([{"a": 1, "b": 2}]))
    assert results_table(refused).equals(refused.results)


COLUMNS = {
    "whole numbers": (["12", "-3", ""], [12, -3, None]),
    "numbers": (["12.5", "3", "1e-05"], [12.5, 3.0, 1e-05]),
    "one of them a text": (["12.5", "3", "n/a"], ["12.5", "3", "n/a"]),
    "part numbers": (["007", "12", "13"], ["007", "12", "13"]),
    "what Excel takes for a power of ten": (["12E5", "1", "2"], ["12E5", "1", "2"]),
    "more digits than a number keeps": (["8900000000000000001", "1", "2"], ["8900000000000000001", "1", "2"]),
    "nothing but blanks below": (["", " ", ""], [None, None, None]),
}


@pytest.mark.parametrize("what", COLUMNS)
def test_a_column_is_numeric_where_all_of_it_is(results, what):
    """Numbers of a CSV file are numbers where the whole column is numeric and no digit is lost, else its own texts."""
    texts, expected = COLUMNS[what]
    column = results(*({"Own": text} for text in texts))["Own"]
    assert column.to_list() == expected
    assert column.dtype in ({pl.String} if isinstance(expected[0], str | None) else {pl.Int64, pl.Float64})


def test_a_decimal_comma_is_read_as_such(tmp_path, sound):
    """In a table with decimal commas the own columns' numbers have them too."""
    path = tmp_path / "comma.csv"
    commas = {"wall_thickness_mm": "1,6", "backlash_limit_arcmin": "3,75", "torque_Nm": 800, "Own": "12,5"}
    cells = {**sound, "cylinder_length_mm": 160, "mean_radius_mm": 80, "disk_inner_radius_mm": 40, **commas}
    path.write_text(";".join(cells) + "\n" + ";".join(map(str, cells.values())) + "\n", encoding="utf-8")
    assert results_table(run(path, samples=SAMPLES))["Own"].to_list() == [12.5]


@pytest.mark.slow
def test_cells_of_a_workbook_keep_what_they_show(workbook, sound):
    """Of a workbook numbers stay numbers; a date, a truth value, an error in a mixed column read as the cell shows."""
    path = workbook([{**sound, "variant": name} for name in "abcd"])
    book = openpyxl.load_workbook(path)
    sheet = book["Variants"]
    header = next(row[0].row for row in sheet.iter_rows() if row[0].value == "Variant" and row[1].value)
    place = sheet.max_column + 1
    cells = {"Pieces": [1, 2.5, None, 4], "Mixed": [datetime.datetime(2026, 3, 9), True, 12.0, "x\ty"]}  # noqa: DTZ001
    for column, (name, values) in enumerate(cells.items(), start=place):
        for row, value in enumerate([name, *values], start=header):
            sheet.cell(row, column).value = value
    book.save(path)
    found = results_table(run(path, samples=SAMPLES))
    assert found["Pieces"].to_list() == [1.0, 2.5, None, 4.0]
    assert found["Mixed"].to_list() == ["2026-03-09", "TRUE", "12", "x\ty"]


def test_no_column_takes_the_place_of_another(tmp_path, sound):
    """An own column with the name of a result, or of another own column, is kept beside it and says so."""
    own = ["status", "cross_check", "Remark", "Remark", "Remark", "Remark (as submitted)"]
    path = tmp_path / "twice.csv"
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([[*sound, *own], [*sound.values(), *"123456"]])
    found = results_table(run(path, samples=SAMPLES))
    assert found["status"].to_list() == ["ok"]
    assert found.columns[-6:] == [
        "status (as submitted)", "cross_check (as submitted)", "Remark", "Remark (as submitted)",
        "Remark (as submitted 2)", "Remark (as submitted) (as submitted)",
    ]  # fmt: skip
    assert found.row(0)[-6:] == (1, 2, 3, 4, 5, 6)


def test_csv_quotes_every_text_and_no_number():
    """Texts, headers too, stand in quotes; numbers do not, and blanks are empty."""
    frame = pl.DataFrame({"a": ["x", "1", None, 'say "x"'], 'b "c"': [1.5, None, -3.0, 1e-9]})
    assert csv_text(frame) == '"a","b ""c"""\n"x",1.5\n"1",\n,-3.0\n"say ""x""",1e-9\n'


FORMULAS = ["=1", "+1", "-1", "@x", "\t=1", "\r=1", "a;=1", "a\t=1", "a|@x", "a\n+1", "a\r\n-1", ";;=1", "=1;=1"]


@pytest.mark.parametrize("delimiter", [",", ";", "\t", "|"])
def test_csv_texts_are_inert_whatever_separates_cells(delimiter):
    """No reader, whichever sign it splits cells at, finds a cell that begins as a formula does."""
    frame = pl.DataFrame({name: [text] for name, text in zip(["a", *FORMULAS], ["x", *FORMULAS], strict=True)})
    cells = [cell for row in csv.reader(io.StringIO(csv_text(frame), newline=""), delimiter=delimiter) for cell in row]
    assert len(cells) >= 2
    assert [cell for cell in cells if cell.startswith(("=", "+", "-", "@", "\t", "\r"))] == []


def test_csv_leaves_harmless_texts_alone():
    """What no program takes for a formula is written letter by letter."""
    texts = ["a=b", "1.6 -0.02", "D-17, =", "a; b", "it's", "Übermaß ±0,02"]
    assert [row[0] for row in csv.reader(io.StringIO(csv_text(pl.DataFrame({"a": texts}))))] == ["a", *texts]
