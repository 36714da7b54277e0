"""What a page shows of a computed submission is what its report says, word for word and number for number."""

from __future__ import annotations

import itertools
import json
import math
from dataclasses import replace

import numpy as np
import openpyxl
import pytest
from report_entries import opened

from flexlash.analysis.whole_batch import WholeBatch
from flexlash.pipeline import check, run
from flexlash.report.page.excel_texts import number_text
from flexlash.report.page.page_facts import PAGED, TABLED, Found, page_bytes, page_facts
from flexlash.report.report_data import ROW, ranked, report_data
from flexlash.report.wording.verdict import verdict_word
from flexlash.schema.limit_verdict import VerdictBounds
from flexlash.schema.result_columns import RESULTS
from flexlash.schema.units import ARCMIN


@pytest.fixture(scope="module")
def facts(study):
    """Return the study's facts."""
    return page_facts(study[0], Found.of(study[0], ran=True), ran=True, data=report_data(study[0]))


@pytest.fixture(scope="module")
def worst(study):
    """Return the study's Results, worst first."""
    return ranked(study[0]).to_dicts()


def _told_rows(sheet):
    """Return the rows of the Summary with a topic and its sentence: that above the key figures, and those below."""
    first = next(row for row in range(1, 20) if sheet.cell(row, 1).value == "What is compared")
    below = next(row for row in range(1, 20) if sheet.cell(row, 1).value == "Which fail")
    return [first, *itertools.takewhile(lambda row: sheet.cell(row, 1).value, range(below, 60))]


def test_the_sentences_are_those_of_the_summary(facts, study):
    """Topic and sentence of each row of the Summary sheet stand on the page in the same order, on one line each."""
    sheet = opened(study[1])["Summary"]
    said = [(sheet.cell(row, 1).value, sheet.cell(row, 2).value) for row in _told_rows(sheet)]
    said = [(topic, " ".join(text.split("\n"))) for topic, text in said]
    assert [(one["topic"], one["text"]) for one in facts["sentences"]] == said
    assert {one["kind"] for one in facts["sentences"]} >= {"verdict", "note", "cause", "advice", "findings"}


def _distance_words(cell):
    """Return in words how far the Summary's table shows a percentile over its limit."""
    decimals = len(cell.number_format.split(";")[0].partition(".")[2])
    return f"{abs(cell.value):.{decimals}f}′ {'over' if cell.value > 0 else 'under'}"


def test_the_table_is_that_of_the_summary(facts, study):
    """Verdict, angles, distance, share over the limit and main contributor of each listed variant are the Summary's."""
    sheet = openpyxl.load_workbook(study[1], data_only=True)["Summary"]
    header = next(row for row in range(1, 60) if sheet.cell(row, 1).value == "Variant")
    listed = list(itertools.takewhile(lambda row: sheet.cell(row, 2).value, range(header + 1, 60)))
    assert len(listed) >= 3
    for place, told in zip(listed, facts["table"], strict=False):
        shown = [sheet.cell(place, column).value for column in (1, 2, 10, 12)]
        assert shown == [told["variant"], told["light"], told["over_limit"], told["main_cause"]]
        assert told["distance"] == _distance_words(sheet.cell(place, 7))
        for column, text in ((3, "limit"), (4, "nominal"), (5, "p97_5"), (6, "p99_865")):
            cell = sheet.cell(place, column)
            digits = len(cell.number_format.partition(".")[2])
            assert float(told[text].rstrip("′")) == pytest.approx(cell.value, abs=0.51 * 10.0**-digits)


def test_the_tiles_count_what_the_results_say(facts, study):
    """Fails, marginal and meets are the counts of `--json`; without errors nothing is to fix."""
    counts = study[0].counts
    assert [(tile["number"], tile["words"]) for tile in facts["verdict_tiles"]] == [
        (str(counts["fails"]), "fail"),
        (str(counts["marginal"]), "marginal"),
        (str(counts["meets"]), "meet 99.865 %"),
        (str(counts["warnings"]), "warnings"),
    ]
    assert facts["tiles"][0]["number"] == f"{counts['computed']} of {counts['rows']}"
    assert (facts["cells_to_fix"], facts["fixable"]) == (0, 0)


def test_the_chart_has_the_numbers_of_results(facts, worst):
    """Every bar is that of the Results, unrounded, the worst first, with its verdict."""
    keys = {"low": "p2_5", "median": "p50", "high": "p97_5", "nominal": "backlash", "limit": "backlash_limit"}
    chart = facts["chart"]
    assert (chart["drawn"], chart["of"]) == (len(chart["variants"]), len(worst))
    for bar, row in zip(chart["variants"], worst, strict=True):
        assert {name: bar[name] for name in keys} == {name: row[f"{key}_arcmin"] for name, key in keys.items()}
        assert bar["verdict"] == verdict_word(row, VerdictBounds()).rstrip("?")
    assert chart["limits"] == [3.8]
    assert chart["axis"]["start"] < min(bar["low"] for bar in chart["variants"])


def test_every_number_of_a_variant_is_that_of_the_results_sheet(facts, study):
    """Each is the text that Excel shows of the cell of Results, in the cell's own number format."""
    sheet = opened(study[1])["Results"]
    columns = {sheet.cell(2, column).value: column for column in range(1, sheet.max_column + 1)}
    rows = {sheet.cell(row, 1).value: row for row in range(3, sheet.max_row + 1)}
    compared = 0
    for page in facts["variants"]:
        for number in page["numbers"]:
            cell = sheet.cell(rows[page["variant"]], columns[number["key"]])
            told = number["value"]
            if isinstance(cell.value, str):
                assert told == cell.value
                continue
            assert told == number_text(cell.value, cell.number_format), number["key"]
            plain = float(told.rstrip("%").replace(",", "")) / (100 if told.endswith("%") else 1)
            decimals = len(told.rstrip("%").partition(".")[2].partition("E")[0]) + 2 * told.endswith("%")
            size = 10.0 ** math.floor(math.log10(abs(cell.value) or 1)) if "E" in told else 1.0
            assert plain == pytest.approx(cell.value, abs=0.51 * size * 10.0**-decimals)
            compared += 1
    assert compared > 300
    assert {column.key for column in RESULTS} >= {number["key"] for number in facts["variants"][0]["numbers"]}


def test_the_density_is_that_of_the_explorer(facts, study):
    """Bins and heights are those on the sheet Curves."""
    sheet = opened(study[1])["Curves"]
    columns = {sheet.cell(2, column).value: column for column in range(1, sheet.max_column + 1)}
    for row, page in enumerate(facts["variants"], start=3):
        density = page["density"]
        assert sheet.cell(row, 1).value == page["variant"]
        assert density["start"] == pytest.approx(sheet.cell(row, columns["Bin start"]).value, rel=1e-14)
        assert density["width"] == pytest.approx(sheet.cell(row, columns["Bin width"]).value, rel=1e-14)
        heights = [sheet.cell(row, columns[f"Bin {number}"]).value for number in range(1, 41)]
        assert density["heights"] == heights
        assert sum(density["heights"]) == pytest.approx(0.999, abs=5e-5)


def test_segments_and_causes_add_up(facts, worst, study):
    """The segments are the whole nominal backlash; causes are the shares of the variance, the greatest first."""
    for page, row in zip(facts["variants"], worst, strict=True):
        assert sum(one["backlash"] for one in page["segments"]) == pytest.approx(row["backlash_arcmin"], rel=1e-12)
        assert sum(one["share"] for one in page["segments"]) == pytest.approx(1.0, rel=1e-12)
        spread = study[0].computed[row[ROW]].spread
        shares = [one["share"] for one in page["shares"]]
        assert shares == sorted(spread.shares.values(), reverse=True)[: len(shares)]
        first = page["shares"][0]
        assert sorted((first["low"], first["high"])) == pytest.approx(sorted(
            swing / ARCMIN for swing in spread.swings[row["main_contributor"]]
        ))  # fmt: skip


def test_the_limits_used_are_those_of_the_tolerances(facts):
    """A wall of 1.6 mm in ± 2.5 µm with limits at three standard deviations is told as that."""
    (page,) = (page for page in facts["variants"] if page["variant"] == "B3-160 case 3")
    (wall,) = (one for one in page["limits"] if one["name"] == "Wall thickness Δ")
    assert wall == {
        "name": "Wall thickness Δ", "unit": "mm", "nominal": "1.6", "lower": "1.5975", "upper": "1.6025",
        "sd": "0.000833", "distribution": "normal, limits at ± 3 sigma",
    }  # fmt: skip
    (torque,) = (one for one in page["limits"] if one["name"] == "Torque T")
    assert (torque["nominal"], torque["distribution"]) == ("800", "exact")


def test_a_variant_says_what_the_summary_says_of_it(facts):
    """The worst variant's own sentences are contained in, or agree with, those of the Summary."""
    said = {one["topic"]: one["text"] for one in facts["sentences"]}
    page = facts["variants"][0]
    own = {one["topic"]: one["text"] for one in page["sentences"]}
    assert own["Why"] in said["Why"]
    assert own["What to change"].partition(" Tighter")[0] in said["What to change"]
    assert "97.5 % of its units stay below 6.262′, 2.462′ over its limit of 3.8′" in own["Verdict"]
    assert "It fails: fewer than 97.5 % of units within the limit." in own["Verdict"]
    assert own["Verdict"].split(" With every")[1] in said["Worst case"]


def test_a_variant_without_a_limit_is_not_judged(table, sound):
    """It has a page with its percentiles; no verdict, no distance, no advice."""
    outcome = run(table([sound | {"backlash_limit_arcmin": ""}]), samples=64)
    told = page_facts(outcome, Found.of(outcome, ran=True), ran=True, data=report_data(outcome))
    (row,), (page,) = told["table"], told["variants"]
    assert {row[key] for key in ("verdict", "light", "limit", "distance", "over_limit")} == {""}
    assert [one["topic"] for one in page["sentences"]] == [
        "Verdict", "Lots and parts", "Why", "Another limit", "Strength",
    ]  # fmt: skip
    assert "No limit was given" in page["sentences"][0]["text"]
    assert [(tile["number"], tile["words"]) for tile in told["verdict_tiles"]] == [
        ("1", "without a limit"),
        ("0", "warnings"),
    ]
    assert told["chart"]["limits"] == []


def test_what_does_not_scatter_is_told_as_level(workbook, sound):
    """A row without any tolerance has a page without causes, and no number is missing or endless."""
    rows = [{"tolerance_class": "none", "dimension": "torque", "lower_deviation": 0, "upper_deviation": 0}]
    outcome = run(workbook([sound | {"tolerance_class": "none"}], tolerances=rows))
    told = page_facts(outcome, Found.of(outcome, ran=True), ran=True, data=report_data(outcome))
    json.dumps(told, allow_nan=False)
    (page,) = told["variants"]
    assert "Nothing scatters" in page["sentences"][1]["text"]
    assert max(page["density"]["heights"]) == 1.0


def test_the_same_outcome_gives_the_same_bytes(study):
    """Facts are the outcome's alone."""
    first, second = (
        page_bytes(study[0], Found.of(study[0], ran=True), ran=True, data=report_data(study[0])) for _ in range(2)
    )
    assert first == second


def test_a_check_has_findings_alone(study):
    """Before rows are computed nothing is said of them."""
    told = page_facts(study[0], Found.of(study[0], ran=False), ran=False)
    assert (told["sentences"], told["chart"], told["table"], told["variants"]) == ([], None, [], [])
    assert told["verdict_tiles"] == []
    assert told["findings"] == len(study[0].findings) > 0


def test_variants_that_were_not_computed_say_why(table, sound):
    """A lost row stands apart with its row number and the cells that are why."""
    outcome = run(table([sound, sound | {"variant": "bad", "torque_Nm": -1}]), samples=64)
    told = page_facts(outcome, Found.of(outcome, ran=True), ran=True, data=report_data(outcome))
    assert told["lost"] == [{"variant": "bad", "row": 3, "why": "E207 D3"}]
    assert told["lost_in_all"] == 1
    assert told["computed"] == 1


@pytest.mark.long
@pytest.mark.slow
def test_many_variants_stay_within_bounds(table, sound):
    """Of 700 variants the worst are drawn and have pages with sketches, in less than 3 MiB; names stay apart."""
    name = "a very long name of a variant that goes on and on and on, so that it is cut at its end: number"
    rows = [sound | {"variant": f"{name} {number}", "torque_Nm": 700 + number / 2} for number in range(700)]
    outcome = run(table(rows), samples=64)
    data = page_bytes(outcome, Found.of(outcome, ran=True), ran=True, data=report_data(outcome))
    told = json.loads(data)
    assert (len(told["chart"]["variants"]), len(told["table"]), len(told["variants"])) == (60, TABLED, PAGED)
    assert (told["chart"]["of"], told["computed"]) == (700, 700)
    assert [row["page"] for row in told["table"]] == [*range(PAGED), *[None] * (TABLED - PAGED)]
    names = [row["variant"] for row in told["table"]]
    assert len(set(names)) == TABLED
    assert max(map(len, names)) <= 80
    assert [page["variant"] for page in told["variants"]] == names[:PAGED]
    limits = np.array([float(row["p97_5"].rstrip("′")) for row in told["table"]])
    assert (np.diff(limits) <= 0).all()
    assert len(data) < 3 * 2**20


HOSTILE = ("<script>alert(1)</script>", "=1+1", "a\u202egnp.exe", "a\x07b", "two\nlines", "x" * 180, "x" * 181)


@pytest.mark.slow
def test_hostile_names_are_short_and_on_one_line(table, sound):
    """Computed variants of any name are told on one line, cut, without control characters, each by another name."""
    rows = [sound | {"variant": name, "notes": name, "own column": name} for name in HOSTILE]
    outcome = run(table(rows), samples=64)
    told = json.loads(page_bytes(outcome, Found.of(outcome, ran=True), ran=True, data=report_data(outcome)))
    assert told["computed"] == len(HOSTILE)
    assert len({row["variant"] for row in told["table"]}) == len(HOSTILE)
    texts = list(_texts(told))
    assert all(text.isprintable() for text in texts)
    assert max(map(len, texts)) <= 2000
    assert max(len(row["variant"]) for row in told["table"]) <= 80
    assert "<script>alert(1)</script>" in texts


def _texts(content):
    """Yield every text in an object of JSON."""
    if isinstance(content, str):
        yield content
    for inner in content.values() if isinstance(content, dict) else content if isinstance(content, list) else ():
        yield from _texts(inner)


def test_the_worst_rows_of_a_large_table_stand_for_all(study):
    """Counts are those of the whole table, of which the page shows the worst rows."""
    outcome = study[0]
    whole = WholeBatch(
        rows=90_000, computed=80_000, results_file="r.csv", verdicts={"fails": 70_000}, rules={"E202": 9}
    )
    told = page_facts(replace(outcome, whole=whole), Found.of(outcome, ran=True), ran=True, data=report_data(outcome))
    assert told["counts"]["rows"] == 90_000
    assert told["verdict_tiles"][0]["number"] == "70,000"
    assert told["chart"]["of"] == 80_000


def test_a_refused_file_says_why(tmp_path):
    """It has no cards, but code, message and fix."""
    path = tmp_path / "x.xlsx"
    path.write_bytes(b"PK\x03\x04 nothing")
    outcome = check(path)
    told = page_facts(outcome, Found.of(outcome, ran=True), ran=True)
    assert told["refused"]["code"] == outcome.findings[0].code
    assert told["refused"]["fix"]
    assert told["cards"] == []


def test_each_variant_has_its_changes_and_each_failing_one_its_cheapest(facts, study):
    """The page's table of changes is that of the sheet Levers; who fails is listed with the change of rank 1."""
    levers = report_data(study[0]).levers
    for page in facts["variants"]:
        own = levers.filter(levers["variant"] == page["variant"])
        assert len(page["levers"]["rows"]) == own.height
        assert {len(row["cells"]) for row in page["levers"]["rows"]} == {len(page["levers"]["headings"])}
        assert [row["possible"] for row in page["levers"]["rows"]].count(True) == (own["possible"] == "yes").sum()
    told = {row["variant"]: row["cheapest"] for row in facts["table"]}
    assert told["B3-160 case 3"] == "Hub radius 40 → 46 mm"
    assert {bool(told[row["variant"]]) for row in facts["table"] if row["verdict"] == "fails"} == {True}
    assert {told[row["variant"]] for row in facts["table"] if row["verdict"] == "meets"} == {""}
