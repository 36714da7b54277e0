"""The Ranking sheet: the numbers of Results in their order, and differences that follow the base."""

from __future__ import annotations

import pytest
import xlsxwriter
from libreoffice import convert_all, needs_libreoffice
from report_entries import opened, typed

from flexlash.analysis.run_summary import share_words
from flexlash.pipeline import run
from flexlash.report.compare.compared import COMPARED_NOTE, compared_variants
from flexlash.report.compare.ranking_sheet import BASE_ROW, DIFFERENCES, FIRST_ROW, HEADER, write_ranking
from flexlash.report.failing.failing_places import variant_targets
from flexlash.report.layout.styles import Book
from flexlash.report.report_data import ROW, drawn_variants
from flexlash.report.wording.verdict import verdict_word
from flexlash.schema.angle_unit import ARC_MINUTES
from flexlash.schema.entry_words import dimension_words

KEYS = {
    "P2.5 [arcmin]": "p2_5_arcmin", "P50 [arcmin]": "p50_arcmin", "P97.5 [arcmin]": "p97_5_arcmin",
    "P99.865 [arcmin]": "p99_865_arcmin", "Limit [arcmin]": "backlash_limit_arcmin", "sd [arcmin]": "sd_arcmin",
    "Its share of variance": "main_contributor_share", "Disk share of wind-up": "disk_share",
}  # fmt: skip
OF_DIFFERENCE = {"P50": "p50_arcmin", "P97.5": "p97_5_arcmin", "sd": "sd_arcmin"}


def _alone(outcome, path):
    """Write the Ranking with its data and what it leads to, which are recalculated sooner than a whole report."""
    drawn = drawn_variants(outcome)
    compared = compared_variants(drawn, ARC_MINUTES)
    with xlsxwriter.Workbook(path) as workbook:
        book = Book(workbook)
        write_ranking(book, outcome, drawn, compared)
        compared.write(book, COMPARED_NOTE)
        workbook.add_worksheet("Results")
    return path


def _sheet(path, **options):
    return opened(path, **options)["Ranking"]


def _places(sheet):
    """Return the columns of the sheet's first figures by heading, and those of differences by figure and unit."""
    headings = [cell.value for cell in sheet[HEADER + 1]]
    first = headings.index("l/r") + 2
    differences = {
        (figure, unit): first + 2 * number + place
        for number, figure in enumerate(DIFFERENCES)
        for place, unit in enumerate(("arcmin", "%"))
    }
    return {heading: headings.index(heading) + 1 for heading in headings[: first - 1]}, differences


@pytest.mark.slow
def test_rows_repeat_results_worst_first(study):
    """Each row has rank, verdict, figures and words of its variant, in the order of the share over the limit."""
    outcome, path = study
    sheet = _sheet(path, data_only=True)
    places, _ = _places(sheet)
    drawn = drawn_variants(outcome)
    targets = {
        row: f"'{target.partition('!')[0]}'!{target.partition('!')[2]}" if " " in target else target
        for row, target in variant_targets(drawn, outcome.settings.verdict_bounds).items()
    }
    for rank, one in enumerate(drawn, start=1):
        row = one.row
        cells = {heading: sheet.cell(FIRST_ROW + rank, place) for heading, place in places.items()}
        assert cells["Rank"].value == rank
        assert cells["Variant"].value == row["variant"]
        assert cells["Variant"].hyperlink.location == targets[row[ROW]]
        assert cells["Verdict"].value == verdict_word(row, outcome.settings.verdict_bounds)
        assert cells["Units over the limit"].value == share_words(row)
        assert cells["Main contributor"].value == dimension_words(row["main_contributor"])
        assert {heading: cells[heading].value for heading in KEYS} == {
            heading: pytest.approx(row[key], rel=1e-15) for heading, key in KEYS.items()
        }
        margin = cells["Margin of P97.5 [arcmin]"].value
        assert margin == pytest.approx(row["backlash_limit_arcmin"] - row["p97_5_arcmin"], rel=1e-12)


def _assert_differences(sheet, outcome, base):
    """Hold every difference of a sheet against those of Results."""
    rows = {row["variant"]: row for row in outcome.results.iter_rows(named=True)}
    places, differences = _places(sheet)
    for number in range(FIRST_ROW + 1, FIRST_ROW + 1 + len(outcome.computed)):
        name = sheet.cell(number, places["Variant"]).value
        for figure, key in OF_DIFFERENCE.items():
            own, other = rows[name][key], rows[base][key]
            found = [sheet.cell(number, differences[figure, unit]).value for unit in ("arcmin", "%")]
            assert found[0] == pytest.approx(own - other, rel=1e-12, abs=1e-15)
            assert found[1] == pytest.approx(own / other - 1, rel=1e-9, abs=1e-15)


def test_the_base_is_the_first_submitted(study):
    """The base picked at first is the first variant submitted, and the stored differences are to it."""
    outcome, path = study
    sheet = _sheet(path, data_only=True)
    assert sheet.cell(BASE_ROW + 1, 2).value == "B3-160 case 1"
    _assert_differences(sheet, outcome, "B3-160 case 1")
    (rule,) = sheet.data_validations.dataValidation
    assert (str(rule.sqref), rule.formula1) == ("B5", "Compared!$A$3:$A$13")


@pytest.mark.slow
@needs_libreoffice
def test_differences_follow_the_base(study, tmp_path):
    """With another base every difference and the base's own figures are anew; unchanged, they are as stored."""
    outcome, path = study[0], _alone(study[0], tmp_path / "alone.xlsx")
    bases = ("B3-160 hat", "B3-160 case 5", "B3-160 detail")
    books = [typed(path, tmp_path / f"{place}.xlsx", "Ranking", {"B5": base}) for place, base in enumerate(bases)]
    recalculated = convert_all([path, *books], "xlsx", tmp_path)
    stored, again, *picked = (_sheet(one, data_only=True) for one in (path, *recalculated))
    formulas = [cell.coordinate for row in _sheet(path).iter_rows() for cell in row if cell.data_type == "f"]
    assert len(formulas) > 7 * len(outcome.computed)
    for cell in formulas:
        before, after = stored[cell].value, again[cell].value
        assert after == (pytest.approx(before, rel=1e-12, abs=1e-15) if isinstance(before, float) else before)
    for base, sheet in zip(bases, picked, strict=True):
        _assert_differences(sheet, outcome, base)
        places, _ = _places(sheet)
        row = next(row for row in outcome.results.iter_rows(named=True) if row["variant"] == base)
        for heading in ("P2.5 [arcmin]", "P99.865 [arcmin]", "Limit [arcmin]", "Disk share of wind-up"):
            found = sheet.cell(BASE_ROW + 1, places[heading]).value
            assert found == pytest.approx(row[KEYS[heading]], rel=1e-12)


@pytest.mark.slow
def test_differences_are_coloured_by_their_sign(study):
    """More than the base is orange, less blue, and an empty text neither; a negative margin is orange."""
    sheet = _sheet(study[1])
    rules = {
        (str(cells.sqref), rule.formula[0]): rule.dxf.fill.bgColor.rgb
        for cells, found in sheet.conditional_formatting._cf_rules.items()
        for rule in found
    }
    assert rules == {
        ("S8:X18", "AND(ISNUMBER(S8),S8>0)"): "FFFBE3B8",
        ("S8:X18", "AND(ISNUMBER(S8),S8<0)"): "FFD3E7F5",
        ("M8:M18", "AND(ISNUMBER(M8),M8<0)"): "FFFBE3B8",
    }


def test_formulas_move_with_their_row(study):
    """A difference refers to its own row relatively, so that a table sorted by the reader stays right."""
    sheet = _sheet(study[1])
    for number in (FIRST_ROW + 1, FIRST_ROW + 11):
        base = f"$H${BASE_ROW + 1}"
        assert sheet.cell(number, 19).value == f'=IF(ISNUMBER({base}),H{number}-{base},"")'
        assert sheet.cell(number, 13).value == f"=L{number}-J{number}"


@pytest.mark.slow
def test_of_more_variants_than_are_drawn_the_worst_stand_here(table, sound, tmp_path, monkeypatch):
    """Of more variants than are drawn the worst stand here, in order, and the sheet says so."""
    monkeypatch.setattr("flexlash.report.report_data.DRAWN", 50)
    rows = [{**sound, "variant": f"v{number}", "torque_Nm": 700.0 + number} for number in range(60)]
    outcome = run(table(rows), tmp_path / "report.xlsx", method="random", samples=64)
    sheet = _sheet(tmp_path / "report.xlsx", data_only=True)
    worst = outcome.results.sort("p97_5_arcmin", descending=True)["variant"].to_list()[:50]
    shown = [sheet.cell(row, 2).value for row in range(FIRST_ROW + 1, sheet.max_row + 1)]
    assert len(shown) == 50
    assert set(shown) == set(worst)
    assert "the 50 worst of 60; all are in Results" in sheet["A2"].value
    # The first submitted has the least torque: it is not drawn, so the base is the first of those that are.
    assert sheet.cell(BASE_ROW + 1, 2).value == min(shown, key=lambda name: int(name[1:])) == "v10"


@pytest.mark.slow
@pytest.mark.parametrize("scatters", [True, False])
def test_without_a_limit_there_is_neither_verdict_nor_margin(table, sound, tmp_path, scatters):
    """Without a limit, and without scatter, the cells that would need them are empty and nothing fails."""
    tolerances = tmp_path / "tolerances.csv"
    dimension = "wall_thickness" if scatters else "rim_length"
    tolerances.write_text(
        f"tolerance_class,dimension,lower_deviation,upper_deviation\nstandard,{dimension},-0.01,0.01\n",
        encoding="utf-8",
    )
    rows = [{**sound, "variant": name, "backlash_limit_arcmin": ""} for name in ("a", "b*")]
    path = tmp_path / "report.xlsx"
    run(table(rows), path, method="random", samples=64, tolerances=tolerances)
    sheet = _sheet(path, data_only=True)
    places, differences = _places(sheet)
    for number in (FIRST_ROW + 1, FIRST_ROW + 2):
        assert sheet.cell(number, places["Verdict"]).value == "–"
        assert sheet.cell(number, places["Units over the limit"]).value is None
        assert sheet.cell(number, places["Margin of P97.5 [arcmin]"]).value is None
        assert sheet.cell(number, differences["P50", "arcmin"]).value == 0
        assert sheet.cell(number, differences["sd", "%"]).value == (0 if scatters else None)


@pytest.mark.slow
def test_a_long_name_is_shortened_and_can_be_picked_whole(table, sound, tmp_path):
    """Two names that differ only late are shown short and told apart in the drop-down's list."""
    names = ["a variant with a name longer than thirty, A", "a variant with a name longer than thirty, B"]
    rows = [{**sound, "variant": name, "torque_Nm": 800.0 - number} for number, name in enumerate(names)]
    path = tmp_path / "report.xlsx"
    run(table(rows), path, method="random", samples=64)
    sheet = _sheet(path, data_only=True)
    assert [sheet.cell(FIRST_ROW + rank, 2).value for rank in (1, 2)] == [
        "a variant with…han thirty, A",
        "a variant with…han thirty, B",
    ]
    assert sheet.cell(BASE_ROW + 1, 2).value == names[0]
    assert sheet.cell(BASE_ROW + 1, 3).value == 1
