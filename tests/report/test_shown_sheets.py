"""Which sheets of a report can be seen, and that every link leads to one of them."""

from __future__ import annotations

import pytest
from decided_drives import drive
from finding_examples import SUBMISSIONS
from report_entries import opened

from flexlash.feedback.template.template_workbook import template_bytes
from flexlash.pipeline import run
from flexlash.report.shown_sheets import ALWAYS, MOST_SHOWN


def _seen(book):
    return [name for name in book.sheetnames if book[name].sheet_state == "visible"]


def _check(path):
    """Hold a report against the claims on its tabs and links."""
    book = opened(path)
    seen = _seen(book)
    assert set(ALWAYS) <= set(seen)
    assert len(seen) <= MOST_SHOWN
    for sheet in book.worksheets:
        for link in sheet._hyperlinks:
            title, _, cell = link.location.rpartition("!")
            assert title.strip("'") in seen, (sheet.title, link.ref, link.location)
            assert book[title.strip("'")][cell] is not None
    for sheet in book.worksheets:
        # LibreOffice prints what a hidden sheet names as its area.
        assert sheet.sheet_state == "visible" or not sheet.print_area, sheet.title
    return seen


def test_ten_tabs_at_most_and_no_link_to_a_hidden_sheet(study):
    """The study shows its failing variants, Levers and Trace, and no working sheet."""
    seen = _check(study[1])
    assert seen == [
        "Summary", "Failing variants", "Results", "Explorer", "Levers", "Contributions", "Trace", "Findings", "About",
    ]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("name", ["decided", "whole drives"])
def test_what_was_asked_for_is_seen(name, tmp_path):
    """Drive and Sweep, which somebody asked for, are seen; no tab is one too many."""
    path, options = SUBMISSIONS[name](tmp_path)
    run(path, tmp_path / "report.xlsx", samples=16, method="random", **options)
    seen = _check(tmp_path / "report.xlsx")
    assert {"Drive", "Sweep"} & set(opened(tmp_path / "report.xlsx").sheetnames) <= set(seen)


def test_levers_yield_to_both_drive_and_sweep(tmp_path):
    """With both Drive and Sweep the pack is no page longer: Levers are hidden, and no link leads there."""
    (tmp_path / "a.xlsx").write_bytes(template_bytes(drive()))
    run(tmp_path / "a.xlsx", tmp_path / "report.xlsx", samples=16, method="random")
    seen = _check(tmp_path / "report.xlsx")
    assert set(seen) == {*ALWAYS, "Drive", "Sweep", "Failing variants"}
    assert "Levers" in opened(tmp_path / "report.xlsx").sheetnames
