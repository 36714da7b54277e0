"""What is said of whole drives: on the Summary, on a variant's page, and on the screen."""

from __future__ import annotations

import pytest
from entry_books import entry_book
from whole_drives import CASE_3, EXAMPLE, GRINDING

from flexlash.analysis.run_summary import detail_lines
from flexlash.pipeline import run
from flexlash.report.page.page_facts import Found, page_facts
from flexlash.report.report_data import report_data
from flexlash.report.wording.drive_sentences import DRIVE
from flexlash.report.wording.sentences import sentences

SAID = (
    "make 4.82′ on average and at most 5.53′: wind-up 87 %, tooth clearance 9 %, coupling 2 %, bearing 2 % of the "
    "average. 99.865 % of such drives stay below 5.281′;"
)


def _outcome(folder, *variants, sources=EXAMPLE):
    path = entry_book(folder / "a.xlsx", variants=variants, tolerances=GRINDING, other_sources=sources)
    return run(path)


def _summary(outcome):
    return dict(sentences(outcome, report_data(outcome).levers)).get(DRIVE, "")


@pytest.mark.slow
def test_one_variant(tmp_path):
    """The worked example is told on the Summary, on the variant's page and on the screen, with the same numbers."""
    outcome = _outcome(tmp_path, CASE_3)
    data = report_data(outcome)
    said = dict(sentences(outcome, data.levers))[DRIVE]
    assert (
        said == f"The entered sources and the wind-up {SAID} over the system limit of 5.3′: {said.rpartition(': ')[2]}"
    )
    assert said.endswith("ppm).")
    page = page_facts(outcome, Found.of(outcome, ran=True), ran=True, data=data)["variants"][0]
    assert [one["text"] for one in page["sentences"] if one["topic"] == DRIVE] == [said]
    assert {"system_mean_arcmin", "system_probability_over_limit"} <= {number["key"] for number in page["numbers"]}
    (line,) = [line for line in detail_lines(outcome, ran=True) if line.startswith("Whole drive")]
    assert line == (
        "Whole drive, wind-up and other sources: worst case 5.531′; system limit met by 1 of 1 "
        "(99.865 % of drives within it)."
    )


@pytest.mark.slow
def test_several_variants(tmp_path):
    """Of several the one that is worst by its system limit is told, and how many exceed theirs."""
    others = [CASE_3 | {"variant": f"limit {limit}", "system_limit_arcmin": limit} for limit in (4.6, 5.2, None)]
    outcome = _outcome(tmp_path, CASE_3, *others)
    said = _summary(outcome)
    assert said.startswith(f"The entered sources and the wind-up of “limit 4.6” {SAID} over the system limit of 4.6′: ")
    assert said.endswith("2 of 3 variants with a system limit are over it in more than 0.135 % of drives.")
    (line,) = [line for line in detail_lines(outcome, ran=True) if line.startswith("Whole drive")]
    assert "system limit met by 1 of 3 (" in line


@pytest.mark.slow
def test_many_sources_and_none(tmp_path):
    """Beyond five sources the rest is told together; without sources nothing is said anywhere."""
    many = [{"source": f"play {number}", "value_arcmin": number / 10} for number in range(1, 9)]
    said = _summary(_outcome(tmp_path, CASE_3 | {"system_limit_arcmin": None}, sources=many))
    assert "4 others" in said
    assert "no system limit is given." in said
    alone = run(entry_book(tmp_path / "b.xlsx", variants=[CASE_3], tolerances=GRINDING))
    assert not _summary(alone)
    assert not [line for line in detail_lines(alone, ran=True) if "drive" in line]
