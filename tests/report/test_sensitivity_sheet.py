"""The Sensitivity sheet: every computed variant with its shares, filtered, beside the tornado of the worst."""

from __future__ import annotations

import re
import zipfile

import openpyxl
import pytest

from flexlash.pipeline import run
from flexlash.report.sensitivity_sheet import _HEADER
from flexlash.schema.entry_words import dimension_words


@pytest.mark.slow
def test_every_variant_has_its_shares_however_few_are_drawn(table, sound, tmp_path, monkeypatch):
    """The table holds all computed variants in submitted order, also when curves are kept of one alone."""
    rows = [{**sound, "variant": f"v{number}", "torque_Nm": 700.0 + number} for number in range(5)]
    monkeypatch.setattr("flexlash.report.report_data.DRAWN", 1)
    outcome = run(table(rows), tmp_path / "report.xlsx", samples=256)
    sheet = openpyxl.load_workbook(tmp_path / "report.xlsx")["Sensitivity"]
    names = [sheet.cell(row, 1).value for row in range(_HEADER + 2, sheet.max_row + 1)]
    assert names == [f"v{number}" for number in range(5)]
    first = next(iter(outcome.computed.values())).spread
    headings = {cell.value: cell.column for cell in sheet[_HEADER + 1]}
    for name, share in first.shares.items():
        assert sheet.cell(_HEADER + 2, headings[dimension_words(name)]).value == round(share, 4)
        assert sheet.cell(_HEADER + 2, headings[f"{dimension_words(name)}, total"]).value == round(
            first.total_shares[name], 4
        )
    assert sheet.auto_filter.ref.startswith(f"A{_HEADER + 1}:")
    assert sheet.auto_filter.ref.endswith(str(_HEADER + 1 + 5))
    assert sheet.freeze_panes == "B1"


@pytest.mark.slow
def test_the_tornado_names_every_bar(table, sound, tmp_path):
    """Every bar of the tornado has its label, and a long name is shortened in its title."""
    name = "pinned sleeve with a really long name for the design review"
    run(table([{**sound, "variant": name}]), tmp_path / "report.xlsx", samples=256)
    with zipfile.ZipFile(tmp_path / "report.xlsx") as archive:
        charts = [archive.read(one).decode() for one in archive.namelist() if one.startswith("xl/charts/chart")]
    (tornado,) = [chart for chart in charts if "Tornado of" in chart]
    assert '<c:tickLblSkip val="1"/>' in tornado
    (title,) = re.findall(r"Tornado of ([^<]*) \[arcmin\]", tornado)
    assert len(title) == 30
    assert title.endswith("…")
