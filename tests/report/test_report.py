"""The report workbook: every sheet says what it should, every formula is stored with its value."""

from __future__ import annotations

import re
import zipfile

import pytest
import regenerate
from libreoffice import needs_libreoffice
from report_entries import opened

from flexlash.pipeline import run
from flexlash.report import report_data
from flexlash.report.failing.failing_places import FAILING
from flexlash.report.wording.about_texts import PROOF
from flexlash.report.workbook import report_bytes
from flexlash.schema.columns import DIMENSIONS, ENTRY_SHEETS
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.result_columns import CROSS_CHECK, FINDINGS, RESULTS, result_columns
from flexlash.schema.stamps import stamped
from flexlash.schema.units import ARCMIN
from flexlash.tolerance.distribution_curves import CURVE_SCORES

SHEETS = [
    "Summary", "Failing variants", "Results", "Explorer", "Levers", "Contributions", "Trace", "Findings", "Submission",
    "Materials", "Tolerances", "Settings", "About", "Trace spread", "Compare", "Ranking", "Sensitivity",
    "Tolerances used", "Sections", "Strength", "Allocation", "Trade-offs", "Curves", "Compared", "Bars", "Pages",
    "Inputs", "Scatter", "Trace steps", "Trace slope", "Carried",
]  # fmt: skip

_FINEST_UNIT = 1e-8
"""Results shows no more than eight decimals, however well a number is known."""


@pytest.fixture(scope="module")
def faulty(tmp_path_factory):
    """Return the outcome of the submission with twenty faults and the path of its report."""
    path = tmp_path_factory.mktemp("faulty") / "report.xlsx"
    return run(regenerate.ROOT / "data" / "needs-fixing.xlsx", path, samples=512), path


def test_the_sheets_stand_in_order(study):
    """The report opens on the Summary and holds every sheet in reading order."""
    book = opened(study[1])
    assert book.sheetnames == SHEETS
    assert book.active.title == "Summary"


def test_results_repeat_the_frame(study):
    """The Results sheet holds every number of the frame below label and key, errors and estimated shares rounded."""
    outcome, path = study
    sheet = opened(path)["Results"]
    rows = list(sheet.iter_rows(values_only=True))
    labels = {column.key: column.label for column in RESULTS} | {"verdict": "Verdict"}
    keys = list(rows[1])
    assert sorted(keys) == sorted(labels)
    assert list(rows[0]) == [labels[key] for key in keys]
    for written, row in zip(rows[2:], outcome.results.iter_rows(), strict=True):
        by_key = dict(zip(keys, written, strict=True))
        for column, number in zip(RESULTS, row, strict=True):
            value, rounding = by_key[column.key], {"rel": 1e-15}
            if "standard_error" in column.key:
                rounding = {"rel": 5e-4, "abs": 0}
            elif column.key in {"main_contributor_share", "interaction_share"}:
                rounding = {"abs": 5.001e-5}
            assert value == (pytest.approx(number, **rounding) if isinstance(number, float) else number)


def _digits(number_format):
    """Return how many decimals a number format shows."""
    return len(number_format.partition(".")[2])


def _with_errors():
    """Return the Results columns that have a standard error, and the key of that error."""
    keys = {column.key for column in result_columns(cross_check=True)}
    found = {key: f"{key}_standard_error" for key in ("skewness", "kurtosis")}
    for key in keys:
        error = f"{key.removesuffix('_arcmin')}_standard_error_arcmin"
        if error in keys:
            found[key] = error
    return found | {"coverage_low_arcmin": "p2_5_standard_error_arcmin",
                    "coverage_high_arcmin": "p97_5_standard_error_arcmin"}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("how", [{}, {"method": "sobol"}, {"method": "random", "samples": 64}, {"samples": 8}], ids=str)
def test_results_show_no_more_digits_than_their_error_justifies(table, sound, tmp_path, how):
    """A cell of Results ends at the first digit of its standard error: one more would be noise, one fewer a loss."""
    rows = [sound, {**sound, "variant": "small", "torque_Nm": 8.0}, {**sound, "variant": "large", "torque_Nm": 2e4}]
    outcome = run(table(rows), tmp_path / "report.xlsx", cross_check=True, **how)
    sheet = opened(tmp_path / "report.xlsx")["Results"]
    keys = [cell.value for cell in sheet[2]]
    seen = set()
    for key, error in _with_errors().items():
        for number, row in enumerate(outcome.results.iter_rows(named=True), start=3):
            if row[key] is not None:
                cell = sheet.cell(number, keys.index(key) + 1)
                unit = 10.0 ** -_digits(cell.number_format)
                assert set(cell.number_format) <= set("0.")
                assert unit <= max(10 * row[error], _FINEST_UNIT)
                assert row[error] < 10 * unit
                assert cell.value == pytest.approx(row[key], rel=1e-15)
                seen.add((key, unit))
    assert {key for key, _ in seen} >= {
        "mean_arcmin",
        "sd_arcmin",
        "p1_arcmin",
        "p99_865_arcmin",
        "skewness",
        "kurtosis",
    }
    assert len({unit for _, unit in seen}) >= 3


@pytest.mark.slow
def test_results_without_scatter_show_their_usual_digits(table, sound, tmp_path):
    """A number without a standard error, since nothing scatters, is shown as the nominal numbers are."""
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(
        "tolerance_class,dimension,lower_deviation,upper_deviation\nstandard,rim_length,-1,1\n", encoding="utf-8"
    )
    run(table([sound]), tmp_path / "report.xlsx", tolerances=tolerances)
    sheet = opened(tmp_path / "report.xlsx")["Results"]
    formats = {sheet.cell(2, cell.column).value: cell.number_format for cell in sheet[3]}
    assert formats["backlash_arcmin"] == formats["mean_arcmin"] == formats["p99_865_arcmin"] == "0.0000"


@pytest.mark.slow
def test_a_cross_check_stands_in_the_report(table, sound, tmp_path):
    """With a cross-check Results has its columns and About says what was compared."""
    run(table([sound]), tmp_path / "report.xlsx", cross_check=True)
    book = opened(tmp_path / "report.xlsx")
    columns = [cell.value for cell in book["Results"][2]]
    assert sorted(columns) == sorted(["verdict", *(column.key for column in (*RESULTS, *CROSS_CHECK))])
    assert book["Results"].auto_filter.ref.startswith("A2:")
    assert book["Results"].cell(3, columns.index("cross_check") + 1).value == "agrees"
    about = [cell.value for row in book["About"].iter_rows(max_col=1) for cell in row if cell.value]
    assert any(str(one).startswith("•  Cross-check: plain Monte Carlo beside the spread.") for one in about)
    assert "Cross-check" in about


SAID = {
    "line": ("Line sampling: ", "method line, seed 0, 256 lines per variant."),
    "sobol": ("16 independent replicates", "method sobol, seed 0, 256 points per variant."),
    "random": ("independent draws", "method random, seed 0, 256 points per variant."),
}


@pytest.mark.slow
@pytest.mark.parametrize("method", SAID)
def test_about_and_summary_name_the_method(table, sound, tmp_path, method):
    """About tells the method that was used and no other; the Summary names it with its lines or points."""
    run(table([sound]), tmp_path / "report.xlsx", samples=256, method=method)
    told, points = SAID[method]
    book = opened(tmp_path / "report.xlsx")
    about = "\n".join(str(cell.value) for row in book["About"].iter_rows() for cell in row if cell.value)
    others = {words for words, _ in SAID.values()} - {told}
    assert told in about
    assert not [other for other in others if other in about]
    assert "Cross-check: plain" not in about
    summary = "\n".join(str(cell.value) for row in book["Summary"].iter_rows() for cell in row if cell.value)
    assert points in summary


@pytest.mark.slow
def test_sensitivity_has_first_order_and_total_indices(study):
    """Sensitivity lists each variant's first-order indices and, to the right, its total ones."""
    outcome, path = study
    sheet = opened(path)["Sensitivity"]
    (header,) = (row for row in sheet.iter_rows() if row[0].value == "Variant")
    headings = [cell.value for cell in header if cell.value]
    firsts = [heading for heading in headings[1:] if not heading.endswith(", total")]
    assert headings[1:] == [*firsts, *(f"{heading}, total" for heading in firsts)]
    columns = {cell.value: cell.column for cell in header if cell.value}
    for row, one in enumerate(outcome.computed.values(), start=header[0].row + 1):
        assert sheet.cell(row, 1).value == one.variant.name
        for name in DIMENSIONS:
            words = dimension_words(name)
            if words in columns:
                for heading, indices in ((words, one.spread.shares), (f"{words}, total", one.spread.total_shares)):
                    value = sheet.cell(row, columns[heading]).value
                    assert value == (pytest.approx(indices[name], abs=5.001e-5) if name in indices else None)
    assert set(firsts) == {dimension_words(name) for one in outcome.computed.values() for name in one.spread.shares}


def test_tornado_has_both_indices_of_the_worst_variant(study):
    """The tornado's table has, by falling share, swings, first-order and total index of the worst variant."""
    outcome, path = study
    sheet = opened(path)["Sensitivity"]
    worst = report_data.drawn_variants(outcome)[0].computed.spread
    assert [cell.value for cell in sheet[4]][:5] == [
        "Dimension", "At lower limit", "At upper limit", "Share of variance", "Share with interactions",
    ]  # fmt: skip
    by_share = sorted(worst.shares, key=worst.shares.get, reverse=True)
    for row, name in enumerate(by_share, start=5):
        found = [cell.value for cell in sheet[row]][:5]
        expected = [*(end / ARCMIN for end in worst.swings[name]), worst.shares[name], worst.total_shares[name]]
        assert found == [dimension_words(name), *(pytest.approx(value, rel=1e-14) for value in expected)]


def _table(sheet, header):
    """Return the rows below a header row as dictionaries, up to the first empty one."""
    rows = list(sheet.iter_rows(min_row=header, values_only=True))
    names = [name for name in rows[0] if name]
    table = []
    for row in rows[1:]:
        if row[0] is None:
            break
        table.append(dict(zip(names, row, strict=False)))
    return table


def test_segments_add_up_to_the_backlash(study):
    """Sections holds every computed variant, whose segments add up to its nominal backlash."""
    outcome, path = study
    sheet = opened(path)["Sections"]
    rows = _table(sheet, 1 + next(cell.row for cell in sheet["A"] if cell.value == "Variant") - 1)
    results = {row["variant"]: row for row in outcome.results.iter_rows(named=True)}
    assert {row["Variant"] for row in rows} == set(results)
    for row in rows:
        segments = [
            row[f"{name} [arcmin]"] or 0 for name in ("Tooth rim", "Wall", "Junction fillet", "Disk", "Hub fillet")
        ]
        assert sum(segments) == pytest.approx(results[row["Variant"]]["backlash_arcmin"], rel=1e-9)
        two_term = results[row["Variant"]]["two_term_backlash_arcmin"]
        assert row["Two-term formula [arcmin]"] == pytest.approx(two_term, rel=1e-15)


def test_strength_names_the_governing_section(study):
    """Strength holds shear and von Mises stress of every section and names the one with the greatest."""
    outcome, path = study
    sheet = opened(path)["Strength"]
    rows = _table(sheet, next(cell.row for cell in sheet["A"] if cell.value == "Variant"))
    assert len(rows) == len(outcome.computed)
    for row in rows:
        stress = {
            "wall": row["Wall von Mises [MPa]"],
            "tooth rim": row["Rim von Mises [MPa]"] or 0,
            "disk": row["Disk von Mises [MPa]"] or 0,
        }
        assert row["Wall von Mises [MPa]"] == pytest.approx(3**0.5 * row["Wall shear [MPa]"], rel=1e-12)
        assert row["Governing section"] == max(stress, key=stress.get)


@pytest.mark.slow
def test_about_repeats_what_the_proof_computes(tmp_path, monkeypatch):
    """The numbers of the proof in About are those of the proof's own run."""
    pytest.importorskip("skfem", reason="scikit-fem is not installed here")
    # Another picture in the place of all: how they are drawn is tested for itself, and takes a second each.
    picture = (regenerate.ROOT / "data" / "b3-160-study-report.png").read_bytes()
    monkeypatch.setattr("flexlash.report.elasticity_sheet.section_png", lambda *_: picture)
    path = regenerate.ROOT / "data" / "b3-160-proof.xlsx"
    outcome = run(path, tmp_path / "proof.xlsx", elasticity=True, method="random", samples=16)
    text = " ".join(PROOF)
    rows = {row["variant"]: row for row in outcome.results.iter_rows(named=True)}
    elastic = {
        name: row["backlash_arcmin"] / (1 + row["elasticity_difference_percent"] / 100) for name, row in rows.items()
    }
    assert f"as published: {rows['as published']['two_term_backlash_arcmin']:.3f}′" in text
    plain = rows["true mean radius"]["two_term_backlash_arcmin"]
    assert f"80.8 mm: {plain:.3f}′, by elasticity {elastic['true mean radius']:.3f}′" in text
    for name in ("fillets", "fillets, rim 20 mm"):
        assert f"meridian integral {rows[name]['backlash_arcmin']:.3f}′, elasticity {elastic[name]:.3f}′" in text
    assert f"{rows['fillets, rim 30 mm']['backlash_arcmin']:.3f}′ and {elastic['fillets, rim 30 mm']:.3f}′" in text
    sheets = opened(tmp_path / "proof.xlsx")
    about = [str(row[0]) for row in sheets["About"].iter_rows(values_only=True)]
    assert all(f"•  {line}" in about for line in PROOF)
    sheet = sheets["Elasticity"]
    table = _table(sheet, next(cell.row for cell in sheet["A"] if cell.value == "Variant"))
    assert {row["Variant"]: row["Elasticity [arcmin]"] for row in table} == pytest.approx(elastic)
    assert len(sheets["Stress"]._images) == len(rows)


def test_findings_link_to_their_cells(faulty):
    """Each finding links to its cell in the submission as read, at the user's own address, coloured there."""
    outcome, path = faulty
    book = opened(path)
    sheet = book["Findings"]
    labels = [column.label for column in FINDINGS]
    header = next(row[0].row for row in sheet.iter_rows() if [cell.value for cell in row] == labels)
    for row, found in zip(sheet.iter_rows(min_row=header + 1), outcome.findings, strict=True):
        expected = found.as_dictionary()
        key = expected.pop("column")
        assert [cell.value or "" for cell in (*row[:5], *row[6:])] == list(expected.values())
        assert row[5].value.endswith(f"\n{key}")
        assert row[3].hyperlink.location == f"Submission!{found.cell}"
        assert book["Submission"][found.cell].fill.fgColor.rgb == "FFF8CBAD"


@pytest.mark.slow
def test_the_submission_stands_at_its_own_addresses(faulty):
    """The submission as read repeats texts and numbers of the file cell by cell."""
    original = opened(regenerate.ROOT / "data" / "needs-fixing.xlsx", data_only=True)
    book = opened(faulty[1])
    for name, title in (("Variants", "Submission"), ("Materials", "Materials"), ("Tolerances", "Tolerances")):
        for row in original[name].iter_rows(max_col=min(20, len(ENTRY_SHEETS[name]))):
            for cell in row:
                if isinstance(cell.value, str | float | int) and not isinstance(cell.value, bool):
                    assert book[title][cell.coordinate].value == cell.value


@pytest.mark.slow
def test_text_of_a_submission_is_inert(table, sound, tmp_path):
    """Names that look like formulas, links or array formulas stay texts in every sheet."""
    names = ["=1+1", "{=1}", "http://example.org", "+cmd", "@x", "-2", "mailto:a@b.c", "internal:Results!A1"]
    rows = [{**sound, "variant": name, "notes": name} for name in names]
    run(table(rows), tmp_path / "report.xlsx", samples=256)
    book = opened(tmp_path / "report.xlsx")
    assert [cell.value for cell in book["Results"]["A"][2:]] == names
    leads = {"Explorer", f"'{FAILING}'", "Submission"}
    for title in ("Results", "Submission", "Summary", "Curves", "Sensitivity"):
        for row in book[title].iter_rows():
            for cell in row:
                if cell.value in names:
                    assert cell.data_type == "s"
                    link = cell.hyperlink
                    assert link is None or (link.target is None and link.location.split("!")[0] in leads)


def test_charts_have_cached_points_and_alternative_texts(study):
    """Every chart carries its points, so that viewers without calculation draw it, and a text for its reader."""
    with zipfile.ZipFile(study[1]) as archive:
        charts = [name for name in archive.namelist() if name.startswith("xl/charts/chart")]
        drawings = [name for name in archive.namelist() if name.startswith("xl/drawings/drawing")]
        assert len(charts) > 5
        for name in charts:
            text = archive.read(name).decode()
            assert text.count("<c:v>") > 3
        texts = "".join(archive.read(name).decode() for name in drawings)
    assert len(re.findall(r'descr="[^"]+"', texts)) == len(charts) + len(re.findall(r"<xdr:pic>", texts))


@pytest.mark.slow
@pytest.mark.parametrize(("sheet", "cell"), [("Explorer", "B4"), ("Ranking", "B5"), ("Trace", "B3")])
def test_a_variant_is_picked_from_the_drawn_ones(study, sheet, cell):
    """Each drop-down lists all drawn variants, worst first, as its data sheet stores them."""
    outcome, path = study
    book = opened(path)
    rules = {str(rule.sqref): rule.formula1 for rule in book[sheet].data_validations.dataValidation}
    stored, _, cells = rules[cell].partition("!")
    listed = [entry.value for (entry,) in book[stored][cells.replace("$", "")]]
    assert listed == [one.row["variant"] for one in report_data.drawn_variants(outcome)]
    assert book[sheet][cell].value in listed


def test_stored_curves_rise_and_stored_heights_are_shares(study):
    """The percentiles of each variant rise, and its histogram holds all units but the two cut tails."""
    sheet = opened(study[1])["Curves"]
    headings = [cell.value for cell in sheet[2]]
    first, last = headings.index("Bin 1"), headings.index("Bin 40")
    start, end = headings.index("z -5.0"), headings.index("z +5.0")
    for row in sheet.iter_rows(min_row=3, values_only=True):
        assert sum(row[first : last + 1]) == pytest.approx(0.999, abs=1.5e-3)
        curve = list(row[start : end + 1])
        assert len(curve) == len(CURVE_SCORES)
        assert curve == sorted(set(curve))


@pytest.mark.slow
def test_only_the_worst_are_drawn_when_there_are_many(table, sound, tmp_path, monkeypatch):
    """With more variants than can be drawn the report holds the worst and says so."""
    monkeypatch.setattr(report_data, "DRAWN", 3)
    rows = [{**sound, "variant": f"v{number}", "torque_Nm": 700.0 + 10 * number} for number in range(5)]
    run(table(rows), tmp_path / "report.xlsx", samples=256)
    book = opened(tmp_path / "report.xlsx")
    assert [cell.value for cell in book["Curves"]["A"][2:]] == ["v4", "v3", "v2"]
    assert "The 3 worst of 5 variants" in book["Explorer"]["A2"].value
    assert book["Results"].max_row == 7


@pytest.mark.slow
def test_a_report_without_scatter_or_limit(table, sound, tmp_path):
    """Exact dimensions and no limit give a report all the same: no tornado, no verdict, no share."""
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(
        "tolerance_class,dimension,lower_deviation,upper_deviation\nstandard,rim_length,-1,1\n", encoding="utf-8"
    )
    run(table([{**sound, "backlash_limit_arcmin": ""}]), tmp_path / "report.xlsx", tolerances=tolerances)
    book = opened(tmp_path / "report.xlsx")
    assert book["Sensitivity"]["A4"].value is None


@pytest.mark.slow
def test_long_names_do_not_spill(table, sound, tmp_path):
    """A long name is shortened under charts and in the Summary, and whole in Results."""
    name = "pinned sleeve with a really long name for the design review"
    run(table([{**sound, "variant": name}]), tmp_path / "report.xlsx", samples=256)
    book = opened(tmp_path / "report.xlsx")
    assert book["Curves"]["B3"].value == "pinned sleeve with a re…"
    assert book["Results"]["A3"].value == name


def test_a_report_of_nothing_still_opens(table, sound):
    """A submission without a computed row can be reported too: its findings and nothing else."""
    outcome = run(table([{**sound, "torque_Nm": ""}]))
    assert report_bytes(outcome).startswith(b"PK")


@pytest.mark.slow
def test_the_same_outcome_gives_the_same_bytes(study):
    """Writing twice gives the same bytes, and so the same stamp."""
    assert stamped(report_bytes(study[0]), "report") == study[1].read_bytes()


@pytest.mark.slow
def test_a_table_alone_shows_the_built_in_materials_and_tolerances(table, sound, tmp_path):
    """A CSV submission's report shows the built-in materials and the class standard that were used."""
    run(table([sound]), tmp_path / "report.xlsx", samples=256)
    book = opened(tmp_path / "report.xlsx")
    assert book["Materials"]["A2"].value == "20Cr2Ni4"
    assert book["Materials"]["B2"].value == 211
    assert [cell.value for cell in book["Tolerances"][3]][:1] == ["mean_radius"]


@pytest.mark.slow
def test_notes_that_say_row_status_stay(table, sound, tmp_path):
    """Only the header of the status column hides a column, not a note of the same words."""
    run(table([{**sound, "notes": "Row status"}]), tmp_path / "report.xlsx", samples=256)
    cells = [cell.value for row in opened(tmp_path / "report.xlsx")["Submission"].iter_rows() for cell in row]
    assert "Row status" in cells
    assert "notes" in cells


@pytest.mark.slow
@needs_libreoffice
def test_every_formula_is_stored_with_its_value(study, recalculated):
    """Recalculated by a spreadsheet program, every cell of the report keeps its stored value."""
    stored, recalculated = (opened(path, data_only=True) for path in (study[1], recalculated))
    formulas = opened(study[1])
    count = 0
    for name in SHEETS:
        # Spreadsheet programs round a difference of near numbers otherwise: there s is beside the program's.
        least = 1e-11 if name == "Trace spread" else 1e-15
        for row in formulas[name].iter_rows():
            for cell in row:
                if cell.data_type == "f":
                    before, after = (book[name][cell.coordinate].value for book in (stored, recalculated))
                    assert after == (
                        pytest.approx(before, rel=1e-8, abs=least) if isinstance(before, float) else before
                    )
                    count += 1
    assert count > 1500


@pytest.mark.slow
def test_the_elasticity_sheet_says_what_was_not_checked(table, sound, tmp_path):
    """A row that cannot be checked stands in the Elasticity sheet and says so; one with errors does not stand there."""
    pytest.importorskip("skfem", reason="scikit-fem is not installed here")
    odd, faulty = (
        {**sound, "variant": "odd", "disk_outer_radius_mm": 100.0},
        {**sound, "variant": "bad", "torque_Nm": ""},
    )
    path = tmp_path / "report.xlsx"
    run(table([odd, faulty]), path, elasticity=True, method="random", samples=16)
    book = opened(path)
    sheet = book["Elasticity"]
    rows = _table(sheet, next(cell.row for cell in sheet["A"] if cell.value == "Variant"))
    assert [(row["Variant"], row["Two-term formula [arcmin]"]) for row in rows] == [
        ("odd", "not checked, see Findings")
    ]
    assert "Stress" not in book.sheetnames
