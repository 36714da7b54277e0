"""The target of Settings decides the verdict wherever a report or a screen gives one."""

from __future__ import annotations

import re

import openpyxl
import pytest
from said import said_of

from flexlash.analysis.run_summary import limit_lines
from flexlash.pipeline import run
from flexlash.report.page.tiles import verdict_tiles
from flexlash.report.report_data import report_data
from flexlash.report.wording.summary_facts import summary_facts
from flexlash.report.wording.verdict_sentences import judged
from flexlash.schema.exit_codes import ExitCode
from flexlash.schema.limit_verdict import VERDICTS as NAMES

LIMITS = (3.7, 3.77, 3.785, 3.8, 3.82)
"""With these limits 34 %, 0.37 %, 756 ppm, 120 ppm and 7 ppm of units are over them."""

VERDICTS = {97.5: "fails meets meets meets meets", 99.865: "fails marginal meets meets meets"}
VERDICTS |= {99.95: "fails marginal marginal meets meets", 99.99: "fails marginal marginal marginal meets"}


OPENINGS = {"fails": "It fails", "marginal": "It is marginal", "meets": "It meets its limit"}


@pytest.fixture(scope="module", params=VERDICTS)
def judged_by(request, tmp_path_factory):
    """Return a target, the verdicts that it gives five variants, worst first, the outcome and the report of a run."""
    from filled import SOUND, filled

    folder, target = tmp_path_factory.mktemp("target"), request.param
    rows = [{**SOUND, "variant": f"to {limit}", "backlash_limit_arcmin": limit} for limit in LIMITS]
    submission = folder / "submission.xlsx"
    submission.write_bytes(filled(rows, settings={"target_percent": target}))
    outcome = run(submission, folder / "report.xlsx", fail_over_limit=True)
    return target, VERDICTS[target].split(), outcome, openpyxl.load_workbook(folder / "report.xlsx", data_only=True)


def _numbers(verdicts):
    return {verdict: verdicts.count(verdict) for verdict in NAMES}


@pytest.mark.slow
def test_counts_and_exit_code(judged_by):
    """What an outcome counts, and whether a run fails, follow the target."""
    _, verdicts, outcome, _ = judged_by
    assert {name: outcome.counts[name] for name in NAMES} == _numbers(verdicts)
    assert outcome.exit_code == ExitCode.OVER_LIMIT


@pytest.mark.slow
def test_a_screen_names_the_target(judged_by):
    """The terminal says how many units may be over the limit and names the variants that do not meet it."""
    target, verdicts, outcome, _ = judged_by
    first, *named = limit_lines(outcome, most=5)
    allowed = {97.5: "2.5 %", 99.865: "0.135 %", 99.95: "0.05 %", 99.99: "0.01 %"}[target]
    assert re.search(rf"^Of 5 variants with a limit .* and {verdicts.count('meets')} meets? it: ", first)
    assert f" with at most {allowed} of units over the limit" in first
    assert ("marginal" in first) is (target > 97.5)
    assert len(named) == 5 - verdicts.count("meets")


@pytest.mark.slow
def test_every_sheet_has_the_verdict(judged_by):
    """Summary and Ranking judge each variant by the target, and say by which rule."""
    target, verdicts, outcome, book = judged_by
    ranking = book["Ranking"]
    assert [ranking.cell(row, 3).value for row in range(8, 13)] == verdicts
    assert f"meets, at least {target} % of units within the limit" in ranking["A2"].value
    summary = [[cell.value for cell in row] for row in book["Summary"].iter_rows()]
    assert [row[1] for row in summary if str(row[0]).startswith("to 3")] == verdicts
    assert [value for value in summary[5] if value][2].startswith(
        f"97.5 to {target} %" if target > 97.5 else "none where the target is 97.5 %"
    )
    about = {str(row[0].value).removeprefix("•  ") for row in book["About"].iter_rows()}
    assert f"Meets: at least {target} % of units within the limit." in about
    said = said_of(outcome)["Which fail"]
    assert ("marginal" in said) is ("marginal" in verdicts)


@pytest.mark.slow
def test_the_page_of_the_service_has_the_verdict(judged_by):
    """Tiles and the sentences of each variant follow the target."""
    target, verdicts, outcome, _ = judged_by
    tiles = {tile["words"]: tile["number"] for tile in verdict_tiles(outcome)}
    meeting = verdicts.count("meets")
    assert tiles[f"{'meets' if meeting == 1 else 'meet'} {target} %"] == str(meeting)
    data = report_data(outcome)
    facts = summary_facts(outcome, data.levers)
    for one, verdict in zip(data.drawn, verdicts, strict=True):
        assert f"{OPENINGS[verdict]}: " in " ".join(judged(facts, one.row))


@pytest.mark.slow
def test_explorer_starts_with_the_target(judged_by):
    """Explorer's target is that of Settings, its wanted share what that leaves over the limit."""
    target, _, _, book = judged_by
    sheet = book["Explorer"]
    assert sheet["B8"].value == pytest.approx(target / 100, rel=1e-14)
    assert sheet["B7"].value == pytest.approx(1 - target / 100, rel=1e-9)
