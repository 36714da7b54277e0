"""The Tolerances used sheet shows the very numbers of the file in JSON, one row for each dimension of each variant."""

from __future__ import annotations

import pytest
from report_entries import opened

from flexlash.analysis.used_tolerances import used_tolerances
from flexlash.decisions.levers import levers_of
from flexlash.decisions.width_table import width_table
from flexlash.report import extent, report_data
from flexlash.report.used_sheet import USED
from flexlash.report.workbook import report_bytes
from flexlash.schema.entry_words import dimension_title
from flexlash.schema.used_columns import TOLERANCES_USED

_HEADER = 5
_LABELS = {column.label: column.key for column in TOLERANCES_USED}


def _rows(sheet):
    heads = [_LABELS[cell.value] for cell in sheet[_HEADER]]
    return [dict(zip(heads, row, strict=True)) for row in sheet.iter_rows(min_row=_HEADER + 1, values_only=True)]


@pytest.mark.slow
def test_the_sheet_has_every_number(study):
    """Rows, their order and every number are those of the frame; what no variant has takes no column."""
    outcome, path = study
    widths = width_table(levers_of(outcome.computed, outcome.settings, {}, outcome.options))
    frame, rows = used_tolerances(outcome.computed.values(), widths), _rows(opened(path)[USED])
    assert frame.height == len(rows) > 60
    empty = {key for key in frame.columns if frame[key].is_null().all()}
    assert "tighten_to" in empty
    assert frame["relax_to"].drop_nulls().len() > 10
    for row, expected in zip(rows, frame.to_dicts(), strict=True):
        assert set(row) == set(expected) - empty
        for key in row:
            value = dimension_title(expected[key]) if key == "dimension" else expected[key]
            assert row[key] == (pytest.approx(value, rel=1e-15) if isinstance(value, float) else value), (key, row)


@pytest.mark.slow
def test_limits_show_their_digits(study):
    """A limit is shown as entered, a standard deviation with three digits, a mean to a tenth of that."""
    sheet = opened(study[1])[USED]
    heads = {_LABELS[cell.value]: cell.column for cell in sheet[_HEADER]}
    wall = next(row[0].row for row in sheet.iter_rows(min_row=_HEADER) if row[1].value == "Wall thickness")
    codes = {key: sheet.cell(wall, column).number_format for key, column in heads.items()}
    assert [codes[key] for key in ("lower", "mean", "standard_deviation", "share")] == [
        "General", "0.00000", "0.000000", "0.0%"
    ]  # fmt: skip


@pytest.mark.slow
def test_of_many_variants_the_drawn_stand_there(study, monkeypatch, tmp_path):
    """Where a report draws the worst variants alone, these stand here, worst first, and a sentence says so."""
    monkeypatch.setattr(report_data, "DRAWN", 3)
    assert extent.extent_of(study[0]).is_part
    path = tmp_path / "report.xlsx"
    path.write_bytes(report_bytes(study[0]))
    sheet = opened(path)[USED]
    worst = report_data.ranked(study[0]).head(3)["variant"].to_list()
    assert list(dict.fromkeys(row["variant"] for row in _rows(sheet))) == worst
    assert sheet.cell(_HEADER - 1, 1).value.startswith("The 3 worst of 11 variants")
