"""The Contributions sheet: a heat map of the very shares, sums over all variants, and the disk share chart."""

from __future__ import annotations

import pytest
from report_charts import chart_titled, points_of
from report_entries import opened

from flexlash.pipeline import run
from flexlash.report.compare.causes import cause_sentences, causes_of, ranked_dimensions
from flexlash.report.compare.contributions_sheet import MAPPED
from flexlash.report.report_data import drawn_variants
from flexlash.schema.entry_words import dimension_words

CHART = "Disk share of the wind-up against the length of the cylinder"


def _sheet(path):
    return opened(path)["Contributions"]


def _table(sheet):
    """Return the headings of the heat map and its rows by dimension."""
    rows = list(sheet.iter_rows(values_only=True))
    top = next(place for place, row in enumerate(rows) if row[0] == "Share of variance")
    headings = [cell for cell in rows[top] if cell]
    table = {}
    for row in rows[top + 1 :]:
        if row[len(headings) - 1] is None:
            break
        table[row[0]] = row[1 : len(headings)]
    return headings[1:], table


def _words(name):
    words = dimension_words(name)
    return words[0].upper() + words[1:]


def test_the_heat_map_is_the_shares(study):
    """Each cell is the share that the spread found; a dimension without a tolerance there has a blank cell."""
    outcome, path = study
    headings, table = _table(_sheet(path))
    drawn = drawn_variants(outcome)
    assert headings[: len(drawn)] == [one.row["variant"] for one in drawn]
    dimensions = ranked_dimensions(causes_of(outcome))
    assert list(table) == [_words(name) for name in dimensions]
    blanks = 0
    for name in dimensions:
        shares = [one.computed.spread.shares.get(name) for one in drawn]
        expected = [None if share is None else pytest.approx(share, rel=1e-15) for share in shares]
        assert list(table[_words(name)][: len(drawn)]) == expected
        blanks += shares.count(None)
    assert blanks


@pytest.mark.slow
def test_the_columns_over_all_variants_are_over_all(table, sound, tmp_path):
    """Beyond the variants of the map, mean, greatest share and count are over every computed one."""
    rows = [
        {**sound, "variant": f"v{number:02d}", "torque_Nm": 800.0 - number, "wall_thickness_mm": 1.6 - number / 50}
        for number in range(MAPPED + 5)
    ]
    path = tmp_path / "report.xlsx"
    outcome = run(table(rows), path, method="random", samples=256)
    sheet = _sheet(path)
    headings, found = _table(sheet)
    count = len(outcome.computed)
    assert headings[MAPPED:] == [
        f"Mean of all {count}",
        f"Greatest of all {count}",
        "Greatest in",
        "Main contributor in",
    ]
    for name in ranked_dimensions(causes_of(outcome)):
        shares = {one.variant.name: one.spread.shares[name] for one in outcome.computed.values()}
        mean, greatest, where, times = found[_words(name)][MAPPED:]
        assert mean == pytest.approx(sum(shares.values()) / count, rel=1e-12)
        assert (greatest, where) == (pytest.approx(max(shares.values()), rel=1e-15), max(shares, key=shares.get))
        assert times == outcome.results["main_contributor"].to_list().count(name)
    texts = " ".join(str(cell.value) for row in sheet.iter_rows(max_col=1) for cell in row if cell.value)
    assert f"the {MAPPED} worst of {count}, worst first; the columns to the right are over all of them" in texts


def test_sentences_stand_above_the_map(study):
    """The sheet says in words which tolerance hurts everywhere."""
    outcome, path = study
    texts = [row[0] for row in _sheet(path).iter_rows(max_col=1, values_only=True)]
    said = [f"•  {one}" for one in cause_sentences(causes_of(outcome))]
    assert texts[1 : 1 + len(said)] == said


def test_shares_are_coloured_from_white_to_orange(study):
    """The scale begins at a share of 0 and ends at the greatest share of any variant."""
    outcome, path = study
    ((cells, (rule,)),) = _sheet(path).conditional_formatting._cf_rules.items()
    most = max(max(one.shares.values()) for one in causes_of(outcome))
    assert [float(end.val) for end in rule.colorScale.cfvo] == [0.0, pytest.approx(most, rel=1e-12)]
    assert [colour.rgb for colour in rule.colorScale.color] == ["FFFFFFFF", "FFE69F00"]
    sheet = _sheet(path)
    top = next(cell.row for cell in sheet["A"] if cell.value == "Share of variance")
    assert str(cells.sqref) == f"B{top + 1}:N{top + len(_table(sheet)[1])}"


def test_the_disk_share_chart_has_a_point_per_disk(study):
    """Cups and hats have their points, at their disk share over their length; the cylinder has none."""
    outcome, path = study
    chart = chart_titled(path, CHART)
    drawn = drawn_variants(outcome)
    last = 2 + len(drawn)
    for kind, letter in (("cup", "T"), ("hat", "U")):
        expected = {
            place: pytest.approx(one.row["disk_share"], rel=1e-14)
            for place, one in enumerate(drawn)
            if one.computed.variant.flexspline_type == kind
        }
        assert expected
        assert points_of(chart, f"Compared!${letter}$3:${letter}${last}") == expected
    assert f"<c:f>Compared!$M$3:$M${last}</c:f>" in chart
    assert 'formatCode="0%"' in chart


@pytest.mark.slow
def test_cylinders_alone_have_no_disk_share_chart(table, sound, tmp_path):
    """Where no variant has a disk the chart is left out and the map stays."""
    rows = [
        {**sound, "variant": f"pin {number}", "flexspline_type": "cylinder", "disk_inner_radius_mm": ""}
        for number in range(2)
    ]
    path = tmp_path / "report.xlsx"
    run(table(rows), path, method="random", samples=64)
    with pytest.raises(ValueError, match="not enough values"):
        chart_titled(path, CHART)
    assert "Wall thickness" in _table(_sheet(path))[1]


@pytest.mark.slow
def test_without_scatter_there_is_a_sentence_and_no_map(table, sound, tmp_path):
    """Where nothing scatters the sheet says so instead of a map."""
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(
        "tolerance_class,dimension,lower_deviation,upper_deviation\nstandard,rim_length,-1,1\n", encoding="utf-8"
    )
    path = tmp_path / "report.xlsx"
    run(table([sound]), path, tolerances=tolerances)
    texts = [row[0] for row in _sheet(path).iter_rows(max_col=1, values_only=True) if row[0]]
    assert texts == [
        "Which tolerance hurts everywhere, which only here",
        "•  No dimension has a tolerance that counts: nothing scatters.",
    ]
