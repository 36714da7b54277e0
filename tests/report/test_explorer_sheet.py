"""The Explorer: what its formulas say of any variant and any limit is what the program says."""

from __future__ import annotations

import itertools
import zipfile

import numpy as np
import pytest
import regenerate
import xlsxwriter
from libreoffice import convert_all, needs_libreoffice
from report_entries import error_cells, typed, values_of, without_charts
from scipy.special import ndtri

from flexlash.analysis.used_tolerances import used_rows
from flexlash.pipeline import run
from flexlash.report.explorer.curves_sheet import CURVES_NOTE, stored_curves
from flexlash.report.explorer.explorer_sheet import write_explorer
from flexlash.report.extent import extent_of
from flexlash.report.layout.styles import Book
from flexlash.report.report_data import drawn_variants
from flexlash.report.trace.scatter import SCATTER_NOTE, stored_scatter
from flexlash.schema.limit_verdict import VerdictBounds
from flexlash.schema.units import ARCMIN
from flexlash.tolerance.distribution_curves import CURVE_SCORES

VARIANT, UNIT, LIMIT, WANTED = "B4", "B5", "B6", "B7"
TARGET = "B8"
USED, SHARE, LOW, HIGH, PPM, VERDICT, FOUND, FOUND_ERROR = (f"B{row}" for row in range(10, 18))
LOTS = "F15", "F16", "F17"
OUTER = 1e-6
"""The rarest share whose reading is promised to be within 1 %."""


@pytest.fixture
def _curves_without_a_report(monkeypatch):
    """Leave out the writing of whole reports, for tests that look at the Explorer alone."""
    monkeypatch.setattr("flexlash.report.workbook.report_bytes", lambda *_: b"")


def _explorer_alone(outcome, path):
    """Write the Explorer without charts and its data sheet alone, recalculated sooner than a whole report."""
    drawn = path.with_name(f"drawn {path.name}")
    with xlsxwriter.Workbook(drawn) as workbook:
        book, variants = Book(workbook), drawn_variants(outcome)
        curves, (scatter, _) = stored_curves(variants), stored_scatter([variant.computed for variant in variants])
        write_explorer(book, (curves, scatter), extent_of(outcome), outcome.settings.verdict_bounds)
        curves.write(book, CURVES_NOTE)
        scatter.write(book, SCATTER_NOTE)
    return without_charts(drawn, path)


def _number(cell):
    """Return the number that a cell tells as a text, a share of per cent as a fraction."""
    return float(cell.removesuffix(" %")) * (0.01 if cell.endswith(" %") else 1)


def _decimals(cell):
    return len(cell.removesuffix(" %").partition(".")[2])


def _limits(values):
    """Return lower and upper limit of each line below the charts."""
    first = next(int(cell[1:]) for cell, value in values.items() if cell[0] == "A" and value == "Dimension")
    rows = itertools.takewhile(lambda row: values.get(f"A{row}"), itertools.count(first + 1))
    return [(pytest.approx(values[f"B{row}"]), pytest.approx(values[f"C{row}"])) for row in rows]


def _rows(outcome):
    return {row["variant"]: row for row in outcome.results.iter_rows(named=True)}


def test_the_worst_variant_is_picked_and_answered(study):
    """As written, the Explorer shows the worst variant at its own limit with the numbers of Results."""
    outcome, path = study
    values = values_of(path, "Explorer")
    row = _rows(outcome)[values[VARIANT]]
    assert row["probability_over_limit"] == max(one["probability_over_limit"] for one in _rows(outcome).values())
    assert values[USED] == row["backlash_limit_arcmin"]
    assert _number(values[SHARE]) == pytest.approx(row["probability_over_limit"], rel=1e-6)
    assert values["F4"] == pytest.approx(row["backlash_arcmin"], rel=1e-14)
    assert values["F9"] == f"{row['p97_5_arcmin']:.4f}"
    assert values["F14"] == f"{row['ppk']:.3f}"
    within, between = (f"{row[f'{name}_arcmin']:.4f}" for name in ("within_lot_sd", "between_lots_sd"))
    assert [values[cell] for cell in LOTS] == [within, between, "practically all"]
    assert _number(values[FOUND]) == pytest.approx(row["p99_865_arcmin"], abs=row["p99_865_standard_error_arcmin"])
    assert values[VERDICT] == "fails"
    assert not error_cells(values)


@pytest.mark.slow
@needs_libreoffice
def test_stored_values_are_those_of_a_recalculation(study, recalculated):
    """Every formula of Explorer holds what LibreOffice makes of it."""
    stored = values_of(study[1], "Explorer")
    again = values_of(recalculated, "Explorer")
    assert stored.keys() == again.keys()
    for cell, value in stored.items():
        assert again[cell] == (pytest.approx(value, rel=1e-7, abs=1e-12) if isinstance(value, float) else value), cell


SHARES = (0.999999, 0.999, 0.9, 0.5, 0.2, 0.025, 0.00135, 1e-4, 1e-5, 1.2e-6)
FEW = (0.3, 1.2e-6)
SHAPES = {
    "normal": "standard,wall_thickness,-0.05,0.05,normal,3\nstandard,disk_inner_radius,-0.4,0.4,normal,3\n",
    "uniform": "standard,wall_thickness,-0.05,0.05,uniform,\nstandard,disk_inner_radius,-0.4,0.4,uniform,\n",
    "mixed": "standard,wall_thickness,-0.05,0.02,triangular,\nstandard,cylinder_length,-0.4,0.4,uniform,\n"
    "standard,youngs_modulus,-5,5,normal,2\n",
}


def _five(sound):
    """Return five variants of different kinds."""
    cup = {**sound, "disk_hub_thickness_mm": "4", "hub_fillet_radius_mm": "2"}
    return [
        {**sound, "variant": "a?"},
        {**sound, "variant": "a*", "wall_thickness_mm": "1.2"},
        {**cup, "variant": "thick hub"},
        {**sound, "variant": "cylinder", "flexspline_type": "cylinder", "disk_inner_radius_mm": ""},
        {**sound, "variant": "long", "cylinder_length_mm": "300"},
    ]


@pytest.mark.slow
@needs_libreoffice
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.usefixtures("_curves_without_a_report")
def test_any_variant_and_any_limit_agree_with_the_program(table, sound, tmp_path, shape):
    """Five variants at two or ten limits each, from 1 ppm up: the reading is within 1 % of the program's share.

    The limits are typed into the report, LibreOffice recalculates it, and a run with those very limits answers beside.
    """
    tolerances = tmp_path / "tolerances.csv"
    head = "tolerance_class,dimension,lower_deviation,upper_deviation,distribution,limits_sigma\n"
    tolerances.write_text(head + SHAPES[shape], encoding="utf-8")
    given = {"tolerances": tolerances, "samples": 1024}
    rows = _five(sound)
    outcome = run(table(rows), tmp_path / "report.xlsx", **given)
    report = _explorer_alone(outcome, tmp_path / "alone.xlsx")
    drawn = drawn_variants(outcome)
    curves = {one.row["variant"]: one.curve for one in drawn}
    used = {one.row["variant"]: list(used_rows(one.computed)) for one in drawn}
    asked = [
        (row, float(f"{_at(curves[row['variant']], share):.9g}"))
        for row in rows
        for share in (SHARES if shape == "mixed" else FEW)
    ]
    every = [{**row, "variant": f"{n}", "backlash_limit_arcmin": repr(limit)} for n, (row, limit) in enumerate(asked)]
    told = _rows(run(table(every), None, **given))
    books = [
        typed(report, tmp_path / f"{n}.xlsx", "Explorer", {VARIANT: row["variant"], LIMIT: limit})
        for n, (row, limit) in enumerate(asked)
    ]
    seen = set()
    for number, book in enumerate(convert_all(books, "xlsx", tmp_path / "again")):
        values, program = values_of(book, "Explorer"), told[str(number)]
        assert not error_cells(values)
        share = program["probability_over_limit"]
        assert values[USED] == asked[number][1]
        assert min(share, 1 - share) >= 0.8 * OUTER
        shown = _number(values[SHARE])
        step = 0.01 * 10.0 ** -_decimals(values[SHARE])
        room = 0.01 * min(share, 1 - share) + step / 2
        assert shown == pytest.approx(share, rel=0, abs=room)
        assert _number(values[PPM]) == pytest.approx(program["ppm_over_limit"], rel=0, abs=1e6 * room)
        assert _number(values["F14"]) == pytest.approx(program["ppk"], abs=0.51 * 10.0 ** -_decimals(values["F14"]))
        seen.add((values["F4"], values[VERDICT].removesuffix("?")))
        assert _limits(values) == [(one["lower"], one["upper"]) for one in used[asked[number][0]["variant"]]]
        assert values["F18"] == f"{program['von_mises_MPa']:.1f}"
        error = (program["probability_over_limit_high"] - program["probability_over_limit_low"]) / 3.92
        if values[LOW] == values[HIGH] == "–":
            assert error < 1.6 * step
            continue
        low, high = _number(values[LOW]), _number(values[HIGH])
        assert low < shown < high
        assert error < 16 * step
        reach = [low - shown, high - shown]
        told_reach = [program[f"probability_over_limit_{end}"] - share for end in ("low", "high")]
        assert reach == pytest.approx(told_reach, rel=0.6, abs=1e-3 * min(share, 1 - share) + step)
    assert len({nominal for nominal, _ in seen}) == 5
    assert {verdict for _, verdict in seen} == {"meets", "fails"} | ({"marginal"} if shape == "mixed" else set())


def _at(curve, share):
    """Return the backlash that this share of units exceeds, roughly [arcmin]."""
    return float(np.interp(-ndtri(share), CURVE_SCORES, curve.outputs)) / ARCMIN


@pytest.mark.slow
@needs_libreoffice
def test_the_limit_for_a_wanted_share_is_the_programs_percentile(study, tmp_path):
    """The limit read off for 0.135, 2.5 and 50 % of units over it is P99.865, P97.5 and P50 of Results."""
    outcome, path = study[0], _explorer_alone(study[0], tmp_path / "alone.xlsx")
    wanted = {0.00135: "p99_865_arcmin", 0.025: "p97_5_arcmin", 0.5: "p50_arcmin", 0.95: "p5_arcmin"}
    name = "B3-160 hat"
    books = [
        typed(path, tmp_path / f"{n}.xlsx", "Explorer", {VARIANT: name, WANTED: share})
        for n, share in enumerate(wanted)
    ]
    again = convert_all(books, "xlsx", tmp_path / "again")
    for key, book in zip(wanted.values(), again, strict=True):
        values = values_of(book, "Explorer")
        found, half = _number(values[FOUND]), _number(values[FOUND_ERROR])
        step = 10.0 ** -_decimals(values[FOUND])
        assert _decimals(values[FOUND_ERROR]) == _decimals(values[FOUND])
        assert found == pytest.approx(_rows(outcome)[name][key], abs=1.01 * step)
        error = _rows(outcome)[name][key.replace("_arcmin", "_standard_error_arcmin")]
        assert half == pytest.approx(1.96 * error, rel=0.15, abs=0.51 * step)
        assert half >= step


@pytest.mark.slow
@needs_libreoffice
def test_an_answer_has_the_digits_that_are_known(study, tmp_path):
    """Case 1 at 3.75′, 1.687 %, has by plain draws the digits its interval leaves; known better it has no interval."""
    drawn = run(regenerate.ROOT / "data" / "b3-160-study.xlsx", method="random", samples=2**14)
    asked = {"B3-160 case 1": (drawn, 3.75), "B3-160 case 4 r_m 80": (study[0], 3.8)}
    books = [
        typed(
            _explorer_alone(outcome, tmp_path / f"alone {limit}.xlsx"),
            tmp_path / f"{limit}.xlsx",
            "Explorer",
            {VARIANT: name, LIMIT: limit},
        )
        for name, (outcome, limit) in asked.items()
    ]
    few, many = (values_of(book, "Explorer") for book in convert_all(books, "xlsx", tmp_path / "again"))
    share, low, high = (few[cell].removesuffix(" %") for cell in (SHARE, LOW, HIGH))
    assert float(low) < 1.687 < float(high)
    assert float(low) < float(share) < float(high)
    assert {len(number.partition(".")[2]) for number in (share, low, high)} == {1}
    row = _rows(study[0])["B3-160 case 4 r_m 80"]
    assert row["probability_over_limit_high"] - row["probability_over_limit_low"] < 3e-5
    assert many[SHARE].startswith("99.452")
    assert _decimals(many[SHARE]) <= 5


@pytest.mark.slow
@needs_libreoffice
def test_the_unit_is_switched_in_one_cell(study, tmp_path):
    """In arcsec every angle is sixty times as much, the typed limit is read so, and no share changes."""
    path = _explorer_alone(study[0], tmp_path / "alone.xlsx")
    book = typed(path, tmp_path / "seconds.xlsx", "Explorer", {UNIT: "arcsec", LIMIT: 6.16 * 60})
    minutes = typed(path, tmp_path / "minutes.xlsx", "Explorer", {LIMIT: 6.16})
    one, other = (values_of(path, "Explorer") for path in convert_all([book, minutes], "xlsx", tmp_path / "again"))
    for cell in (USED, *(f"F{row}" for row in (4, 11, 12, 13))):
        assert one[cell] == pytest.approx(60 * other[cell], rel=1e-9), cell
    for cell in (FOUND, FOUND_ERROR, *(f"F{row}" for row in range(5, 11))):
        room = 0.5 * 10.0 ** -_decimals(one[cell]) + 30 * 10.0 ** -_decimals(other[cell])
        assert _number(one[cell]) == pytest.approx(60 * _number(other[cell]), abs=1.01 * room), cell
    unchanged = (SHARE, LOW, HIGH, PPM, "F14")
    assert [one[cell] for cell in unchanged] == [other[cell] for cell in unchanged]
    assert one["G4"] == one["C10"] == "arcsec"
    assert (one["A20"], other["A20"]) == ("Charts in arcsec", "Charts in arcmin")
    assert "arcsec" in one["C6"]


@pytest.mark.slow
@needs_libreoffice
def test_lots_follow_the_variant_and_its_own_limit(study, tmp_path):
    """What lots and parts have of the spread follows variant and unit; how many lots fail is of its own limit alone."""
    entries = {VARIANT: "B3-160 case 1", UNIT: "arcsec", LIMIT: 1.0}
    book = typed(study[1], tmp_path / "case 1.xlsx", "Explorer", entries)
    values = values_of(convert_all([book], "xlsx", tmp_path / "again")[0], "Explorer")
    row = _rows(study[0])["B3-160 case 1"]
    told = [float(values[cell].removesuffix(" %")) for cell in LOTS]
    assert told[0] == pytest.approx(60 * row["within_lot_sd_arcmin"], abs=1e-4)
    assert told[1] == pytest.approx(60 * row["between_lots_sd_arcmin"], abs=1e-4)
    assert told[2] == pytest.approx(100 * row["lots_failing"], abs=1e-5) == 0.01149
    assert _number(values[SHARE]) == pytest.approx(1.0)


def test_lots_that_are_alike_may_not_be_settled(study, tmp_path):
    """Where it is not known whether lots fail that are all alike, neither none nor all is told."""
    variants = drawn_variants(study[0])[:1]
    curves, (scatter, _) = stored_curves(variants), stored_scatter([variants[0].computed])
    for error, words in ((0.4, "not settled"), (0.001, "practically none")):
        curves.rows[0].update({"Lots failing": 0.0, "error of Lots failing": error})
        path = tmp_path / f"{error}.xlsx"
        with xlsxwriter.Workbook(path) as workbook:
            book = Book(workbook)
            write_explorer(book, (curves, scatter), extent_of(study[0]), VerdictBounds())
            curves.write(book, CURVES_NOTE)
        assert values_of(path, "Explorer")[LOTS[2]] == words


@pytest.mark.slow
@needs_libreoffice
@pytest.mark.usefixtures("_curves_without_a_report")
def test_without_limit_or_scatter_nothing_is_an_error(table, sound, tmp_path):
    """A variant without a limit says so; one that does not scatter is over a limit or not; no cell is an error."""
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(
        "tolerance_class,dimension,lower_deviation,upper_deviation\nstandard,rim_length,-1,1\n", encoding="utf-8"
    )
    rows = [{**sound, "variant": "none", "backlash_limit_arcmin": ""}]
    _explorer_alone(run(table(rows), tmp_path / "report.xlsx"), tmp_path / "none.xlsx")
    level = run(table(rows), tmp_path / "report.xlsx", tolerances=tolerances)
    _explorer_alone(level, tmp_path / "level.xlsx")
    books = [
        tmp_path / "none.xlsx",
        typed(tmp_path / "none.xlsx", tmp_path / "far.xlsx", "Explorer", {LIMIT: 99.0}),
        typed(tmp_path / "none.xlsx", tmp_path / "near.xlsx", "Explorer", {LIMIT: 0.01}),
        typed(tmp_path / "level.xlsx", tmp_path / "under.xlsx", "Explorer", {LIMIT: 99.0}),
        typed(tmp_path / "level.xlsx", tmp_path / "over.xlsx", "Explorer", {LIMIT: 0.01}),
    ]
    none, far, near, under, over = (
        values_of(path, "Explorer") for path in convert_all(books, "xlsx", tmp_path / "again")
    )
    for values in (none, far, near, under, over):
        assert not error_cells(values)
    assert none[SHARE] == none[PPM] == none["F14"] == none["F17"] == "none"
    assert [under[cell] for cell in LOTS] == ["0.0000", "0.0000", "none"]
    assert none[VERDICT] == "–"
    assert "type one above" in none["C11"]
    assert _number(far[SHARE]) == pytest.approx(2.9e-7, rel=0.02)
    assert far["C11"].startswith("at most")
    assert near["C11"].startswith("at least")
    assert (_number(far[LOW]), _number(near[HIGH])) == (0, 1)
    assert far["E20"] == "The limit 99.00 lies outside the pictures."
    assert (under[SHARE], over[SHARE]) == ("0.0000 %", "100.0000 %")
    assert (under[VERDICT], over[VERDICT]) == ("meets", "fails")


@pytest.mark.slow
@needs_libreoffice
def test_the_verdict_follows_the_target_that_is_typed(table, sound, tmp_path):
    """With 756 ppm over its limit a variant meets a target of 99.9 %, is marginal by 99.95 %; nonsense is not used."""
    outcome = run(table([{**sound, "backlash_limit_arcmin": 3.785}]), tmp_path / "report.xlsx")
    report = _explorer_alone(outcome, tmp_path / "alone.xlsx")
    asked = {0.975: "meets", 0.999: "meets", 0.9995: "marginal", 0.999999: "marginal"}
    verdicts = [*asked.items(), (0.9, "meets"), (1.0, "meets"), ("x", "meets")]
    books = [typed(report, tmp_path / f"{n}.xlsx", "Explorer", {TARGET: one}) for n, (one, _) in enumerate(verdicts)]
    for (target, verdict), again in zip(verdicts, convert_all(books, "xlsx", tmp_path / "again"), strict=True):
        values = values_of(again, "Explorer")
        assert not error_cells(values)
        assert values[VERDICT] == verdict
        used = target if target in asked else 0.99865
        assert values["C15"] == f"meets to {100 * (1 - used):.4f} %, marginal to 2.5 %"
        assert ("not used" in values["C8"]) is (used != target)


@pytest.mark.slow
@pytest.mark.parametrize("how", [{"method": "sobol", "samples": 4096}, {"method": "random", "samples": 16}], ids=str)
def test_points_tell_no_rarer_share_than_they_hold(table, sound, tmp_path, how):
    """With plain points a share below one in all points is told as a bound."""
    outcome = run(table([{**sound, "backlash_limit_arcmin": "99"}]), tmp_path / "report.xlsx", **how)
    values = values_of(tmp_path / "report.xlsx", "Explorer")
    assert _number(values[SHARE]) == pytest.approx(1 / outcome.results["spread_points"][0], rel=0.2)
    assert values["C11"].startswith("at most")
    assert not error_cells(values)


NONSENSE = {
    "a text for the limit": ({LIMIT: "3,8"}, "not a number above 0"),
    "a limit below 0": ({LIMIT: -1.0}, "not a number above 0"),
    "a limit of 0": ({LIMIT: 0.0}, "not a number above 0"),
    "another letter case": ({VARIANT: "b3-160 HAT"}, "not on the list"),
    "no variant": ({VARIANT: ""}, "not on the list"),
    "a space behind": ({VARIANT: "B3-160 hat "}, "not on the list"),
    "another unit": ({UNIT: "degrees"}, "nothing else"),
    "no unit": ({UNIT: ""}, "nothing else"),
    "a share of 0": ({WANTED: 0.0}, "a share from"),
    "a share of 1e-9": ({WANTED: 1e-9}, "a share from"),
    "no share": ({WANTED: ""}, "a share from"),
    "a text for the share": ({WANTED: "much"}, "a share from"),
}


@pytest.mark.slow
@needs_libreoffice
def test_nonsense_is_told_and_gives_no_number(study, tmp_path):
    """What cannot be read is named beside its cell, and nothing is answered from it: no verdict, no error in a cell."""
    alone = _explorer_alone(study[0], tmp_path / "alone.xlsx")
    books = [
        typed(alone, tmp_path / f"{n}.xlsx", "Explorer", entries) for n, (entries, _) in enumerate(NONSENSE.values())
    ]
    hints = {"not on the list": "C4", "nothing else": "C5", "not a number above 0": "C6", "a share from": "C7"}
    again = convert_all(books, "xlsx", tmp_path / "again")
    for (name, (entries, words)), book in zip(NONSENSE.items(), again, strict=True):
        values = values_of(book, "Explorer")
        assert not error_cells(values), name
        (cell,) = entries
        if cell == WANTED:
            assert values[FOUND] == values[FOUND_ERROR] == "none"
            assert values[VERDICT] == "fails"
        else:
            assert values[SHARE] == values[LOW] == values[PPM] == values["F14"] == "none"
            assert values[VERDICT] == "–"
        if cell in {VARIANT, UNIT}:
            assert values["F4"] == values[FOUND] == "none"
            assert values["A20"] == "Nothing to draw"
            assert values[hints[words]] == 0
        else:
            assert words in values[hints[words]], name


@pytest.mark.slow
def test_a_verdict_that_is_not_settled_has_a_question_mark(table, sound, tmp_path):
    """Sixteen plain draws cannot tell 0.135 %: what they show to meet has a question mark."""
    rows = [{**sound, "backlash_limit_arcmin": "99"}]
    run(table(rows), tmp_path / "few.xlsx", method="random", samples=16)
    run(table(rows), tmp_path / "lines.xlsx")
    few, lines = (values_of(tmp_path / f"{name}.xlsx", "Explorer") for name in ("few", "lines"))
    assert (few[VERDICT], lines[VERDICT]) == ("meets?", "meets")
    assert _number(few[LOW]) == 0


def test_charts_hold_their_points_and_say_what_they_are(study):
    """The four charts of Explorer have stored points, titles that hold in any unit, and alternative texts."""
    with zipfile.ZipFile(study[1]) as archive:
        charts = {name: archive.read(name).decode() for name in archive.namelist() if name.startswith("xl/charts/")}
        drawings = "".join(
            archive.read(name).decode() for name in archive.namelist() if name.startswith("xl/drawings/drawing")
        )
    mine = [text for text in charts.values() if "<c:f>Explorer!" in text]
    assert len(mine) == 4
    for text in mine:
        assert "<c:title>" in text
        assert "arcmin" not in text
        assert text.count("<c:numCache>") == text.count("<c:numRef>") > 0
        assert '<c:ptCount val="0"/>' not in text
    told = ("Histogram", "Share of units below each backlash", "Tornado", "Nominal backlash by segment")
    for words in told:
        assert drawings.count(f'"{words} of the picked variant (when the report was written, ') == 1
