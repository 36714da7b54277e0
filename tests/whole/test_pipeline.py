"""One submission in, one outcome out: the same numbers whoever the neighbours are."""

from __future__ import annotations

import datetime
import math

import numpy as np
import openpyxl
import polars as pl
import pytest
import regenerate

import flexlash
from flexlash import workers
from flexlash.analysis import tolerance_spread
from flexlash.pipeline import Options, check, run
from flexlash.schema.result_columns import CROSS_CHECK, RESULTS

SAMPLES = 512


def _variants(sound):
    """Return five variants of different shapes and tolerances."""
    return [
        sound,
        {**sound, "variant": "short", "cylinder_length_mm": 80.0},
        {**sound, "variant": "detail", "hub_fillet_radius_mm": 3.5, "rim_length_mm": 20.0, "rim_thickness_mm": 3.2},
        {**sound, "variant": "hat", "flexspline_type": "hat", "disk_inner_radius_mm": "", "disk_outer_radius_mm": 120},
        {**sound, "variant": "tube", "flexspline_type": "cylinder", "disk_inner_radius_mm": ""},
    ]


def _rows(outcome):
    return {row["variant"]: row for row in outcome.results.iter_rows(named=True)}


HOW = {
    "lines as needed": {},
    "64 lines": {"samples": 64},
    "sobol": {"method": "sobol", "samples": SAMPLES},
    "random": {"method": "random", "samples": SAMPLES},
    "cross-checked": {"samples": SAMPLES, "cross_check": True},
}


@pytest.mark.slow
@pytest.mark.parametrize("how", HOW)
def test_a_variant_does_not_depend_on_its_neighbours(table, sound, how):
    """Rows shuffled, removed or added change no bit of a variant's numbers."""
    rows = _variants(sound)
    every = _rows(run(table(rows), **HOW[how]))
    for kept in (rows[::-1], rows[1:3], rows[2:3], [*rows[3:], {**sound, "variant": "new", "torque_Nm": 1.0}]):
        for name, row in _rows(run(table(kept), **HOW[how])).items():
            if name != "new":
                assert row == every[name]


def _many(sound):
    """Return sixty variants of all kinds and sizes, some without a limit, some with a tapered disk, one faulty."""
    found = []
    for number in range(12):
        for row in _variants(sound):
            wall = {"wall_thickness_mm": 1.2 + number / 10, "torque_Nm": 500.0 + 60 * number}
            limit = {} if number % 3 else {"backlash_limit_arcmin": ""}
            found.append({**row, "variant": f"{row['variant']} {number}", **wall, **limit})
    found[7]["disk_hub_thickness_mm"] = 5.0
    found[20]["torque_Nm"] = "much"
    return found


@pytest.mark.parametrize("how", HOW)
def test_shuffling_many_rows_changes_no_bit(table, sound, how):
    """Sixty rows of all kinds in another order, in batches of any size, keep every bit of their Results."""
    rows = _many(sound)
    every = _rows(run(table(rows), **HOW[how]))
    for seed in (1, 2):
        order = np.random.default_rng(seed).permutation(len(rows))
        for name, row in _rows(run(table([rows[place] for place in order]), **HOW[how])).items():
            # The findings name the cell, which has moved.
            assert row | {"findings": None} == every[name] | {"findings": None}


@pytest.mark.parametrize("how", HOW)
def test_worker_processes_change_no_bit(table, sound, monkeypatch, how):
    """Sixty rows of all kinds spread by two worker processes have, bit for bit, the Results that they have here."""
    path = table(_many(sound))
    here = run(path, **HOW[how]).results
    asked = []
    start = workers.Workers
    monkeypatch.setattr(tolerance_spread, "ROWS_PER_WORKER", 1)
    monkeypatch.setattr(workers, "Workers", lambda count: asked.append(count) or start(count))
    assert run(path, **HOW[how], jobs=2).results.equals(here)
    assert asked == [2]


def test_the_number_of_jobs_changes_nothing(table, sound, tmp_path, monkeypatch):
    """Computed here or by three worker processes, the report has the same bytes."""
    monkeypatch.setattr(tolerance_spread, "ROWS_PER_WORKER", 1)
    path = table(_many(sound)[:25])
    for jobs in (1, 3):
        run(path, tmp_path / f"{jobs}.xlsx", samples=SAMPLES, jobs=jobs)
    assert (tmp_path / "1.xlsx").read_bytes() == (tmp_path / "3.xlsx").read_bytes()


def test_the_report_does_not_name_its_place_or_time(workbook, sound, tmp_path):
    """The same submission gives the same report bytes wherever and whenever it is written."""
    path = workbook([sound])
    (tmp_path / "elsewhere").mkdir()
    run(path, tmp_path / "a.xlsx", samples=SAMPLES)
    run(path, tmp_path / "elsewhere" / "b.xlsx", samples=SAMPLES)
    assert (tmp_path / "a.xlsx").read_bytes() == (tmp_path / "elsewhere" / "b.xlsx").read_bytes()


@pytest.mark.parametrize("method", ["line", "sobol", "random"])
def test_another_seed_gives_other_numbers_within_their_error(table, sound, method):
    """A seed changes the estimates, by no more than their standard errors explain."""
    path = table([sound])
    first, second = (run(path, method=method, seed=seed).results.row(0, named=True) for seed in (1, 2))
    for name in ("p97_5", "p0_135", "mean", "sd"):
        assert first[f"{name}_arcmin"] != second[f"{name}_arcmin"]
        error = math.hypot(*(row[f"{name}_standard_error_arcmin"] for row in (first, second)))
        assert abs(first[f"{name}_arcmin"] - second[f"{name}_arcmin"]) < 4 * error
    assert first["backlash_arcmin"] == second["backlash_arcmin"]


@pytest.mark.parametrize("method", ["line", "sobol", "random"])
def test_every_method_agrees_with_first_order_theory(table, sound, method):
    """For small tolerances each method's sd is the first-order sd, and its mean the nominal, nearly."""
    row = run(table([sound]), method=method).results.row(0, named=True)
    assert row["sd_arcmin"] == pytest.approx(row["first_order_sd_arcmin"], rel=0.01)
    assert row["mean_arcmin"] == pytest.approx(row["backlash_arcmin"], rel=1e-3)
    assert row["p0_135_arcmin"] < row["p2_5_arcmin"] < row["p50_arcmin"] < row["p97_5_arcmin"] < row["p99_865_arcmin"]


def test_results_hold_the_columns_in_order(table, sound):
    """The Results frame has the contract's columns in order, with numbers where numbers belong."""
    results = run(table([sound]), samples=SAMPLES).results
    assert results.columns == [column.key for column in RESULTS]
    for column in RESULTS:
        assert results.schema[column.key] == (pl.Float64 if column.is_number else pl.String)


def test_every_column_of_a_computed_row_is_filled(table, sound, tmp_path):
    """A row with everything given has something in every column of Results but notes and what measured parts leave."""
    detail = {"hub_fillet_radius_mm": 3.5, "junction_fillet_radius_mm": 2.0, "rim_length_mm": 20.0}
    row = {**sound, **detail, "rim_thickness_mm": 3.2, "rated_torque_Nm": 1000.0, "notes": "drawing 7"}
    row |= {
        "load_inertia_kg_m2": 1.0,
        "tooth_face_width_mm": 20.0,
        "radial_deflection_mm": 0.5,
        "system_limit_arcmin": 9.0,
    }
    sources = tmp_path / "sources.csv"
    sources.write_text("Source,Value,Lower deviation,Upper deviation\ncoupling,1,-0.5,0.5\n")
    results = run(table([row]), samples=SAMPLES, cross_check=True, other_sources=sources).results
    assert results.columns == [column.key for column in (*RESULTS, *CROSS_CHECK)]
    empty = [key for key, value in results.row(0, named=True).items() if value is None]
    assert [key for key in empty if "_sample_" not in key] == ["spread_note", "findings"]


def test_cross_check_adds_its_columns_and_changes_no_other(table, sound):
    """With cross_check the Results gain the columns of plain Monte Carlo; the others keep every bit."""
    path = table(_variants(sound))
    plain, checked = run(path).results, run(path, cross_check=True).results
    assert checked.columns == [column.key for column in (*RESULTS, *CROSS_CHECK)]
    assert checked.select(plain.columns).equals(plain)
    assert checked["cross_check"].to_list() == ["agrees"] * 5
    assert checked["random_points"].to_list() == [2.0**17] * 5
    drawn = run(path, method="random").results
    for key in ("mean", "sd", "p2_5", "p50", "p97_5", "p99_865"):
        assert checked[f"random_{key}_arcmin"].to_list() == drawn[f"{key}_arcmin"].to_list()
        error = f"{key}_standard_error_arcmin"
        assert checked[f"random_{error}"].to_list() == drawn[error].to_list()


def test_a_tolerance_on_a_disk_that_is_not_there_is_harmless(table, sound, tmp_path):
    """A class with a tolerance on the disk calibration serves cylinders, which have no disk, as if without it."""
    rows = "standard,wall_thickness,-50,50,µm\n", "standard,disk_calibration,-0.05,0.05,-\n"
    tube = {**sound, "variant": "tube", "flexspline_type": "cylinder", "disk_inner_radius_mm": ""}
    found = []
    for number, lines in enumerate((rows[:1], rows)):
        tolerances = tmp_path / f"{number}.csv"
        tolerances.write_text(
            "tolerance_class,dimension,lower_deviation,upper_deviation,deviation_unit\n" + "".join(lines),
            encoding="utf-8",
        )
        found.append(run(table([tube, sound]), tolerances=tolerances).results)
    without, given = (results.row(0, named=True) for results in found)
    for key in ("sd_arcmin", "p99_865_arcmin", "first_order_sd_arcmin", "worst_case_high_arcmin"):
        assert given[key] == pytest.approx(without[key], rel=1e-6)
    assert found[1]["sd_arcmin"][1] > found[0]["sd_arcmin"][1]


def test_a_row_with_errors_keeps_its_place_with_empty_numbers(table, sound):
    """A faulty row stays where it was submitted, with its status and no numbers."""
    rows = [{**sound, "variant": "bad", "torque_Nm": "much"}, sound]
    results = run(table(rows), samples=SAMPLES).results
    assert results["variant"].to_list() == ["bad", "B3-160"]
    assert results["status"].to_list() == ["error", "ok"]
    bad = results.row(0, named=True)
    assert [key for key, value in bad.items() if value is not None] == ["variant", "status", "findings"]
    assert bad["findings"] == "E202 D2"


def test_strict_computes_nothing_when_a_row_is_bad(table, sound, tmp_path):
    """With --strict one bad row stops the whole submission, and nothing is written."""
    path = table([{**sound, "variant": "bad", "torque_Nm": -1}, sound])
    outcome = run(path, tmp_path / "out.csv", strict=True)
    assert outcome.exit_code == 4
    assert outcome.counts["computed"] == 0
    assert not (tmp_path / "out.csv").exists()
    assert run(path, strict=False, samples=SAMPLES).exit_code == 3


def test_settings_rule_unless_options_do(workbook, sound):
    """Seed, method and samples come from the Settings sheet; options on the call win."""
    path = workbook([sound], settings={"seed": 7, "method": "random", "samples": 256.0, "coverage_percent": 50})
    outcome = run(path)
    row = outcome.results.row(0, named=True)
    assert (outcome.settings.seed, row["spread_method"], row["spread_points"]) == (7, "random", 256)
    assert row["p2_5_arcmin"] < row["coverage_low_arcmin"] < row["coverage_high_arcmin"] < row["p97_5_arcmin"]
    other = run(path, seed=8, method="sobol", samples=1024)
    row = other.results.row(0, named=True)
    assert (other.settings.seed, row["spread_method"], row["spread_points"]) == (8, "sobol", 1024)


def test_the_default_method_is_line(table, sound):
    """Without settings lines make the spread, as many as the precision takes."""
    outcome = run(table([sound]))
    row = outcome.results.row(0, named=True)
    assert outcome.settings.method == outcome.as_dictionary()["method"] == row["spread_method"] == "line"
    assert row["spread_note"] is None
    for key in ("p0_135", "p2_5", "p50", "p97_5", "p99_865"):
        assert row[f"{key}_standard_error_arcmin"] <= 1.1e-3 * row["sd_arcmin"]


def test_calibration_multiplies_its_part(workbook, sound):
    """The published calibration pair lowers cylinder and disk wind-up by its factors."""
    settings = {"cylinder_calibration": 0.907, "disk_calibration": 0.936}
    plain, fitted = (check(workbook([sound], settings=one)).results.row(0, named=True) for one in ({}, settings))
    assert fitted["cylinder_windup_rad"] == pytest.approx(0.907 * plain["cylinder_windup_rad"], rel=1e-12)
    assert fitted["disk_windup_rad"] == pytest.approx(0.936 * plain["disk_windup_rad"], rel=1e-12)


def test_lost_motion_follows_the_set_per_cent(workbook, sound):
    """Lost motion is the backlash at a per cent of the rated torque; beside it a size 65 drive's, up to its T1."""
    torques = {"within": 1000.0, "beyond": 8000.0, "none": None}
    rows = [{**sound, "variant": name, "rated_torque_Nm": torque} for name, torque in torques.items()]
    path = workbook(rows, settings={"lost_motion_percent": 3})
    row, beyond, none = check(path).results.iter_rows(named=True)
    assert row["lost_motion_arcmin"] == pytest.approx(row["backlash_arcmin"] * 0.03 * 1000 / 800, rel=1e-12)
    assert row["drive_lost_motion_arcmin"] == pytest.approx(2 * 30 / 440_000 * 10800 / math.pi, rel=1e-12)
    assert beyond["lost_motion_arcmin"] == pytest.approx(8 * row["lost_motion_arcmin"], rel=1e-12)
    assert [one["drive_lost_motion_arcmin"] for one in (beyond, none)] == [None, None]


def test_wall_and_disk_share_one_dimension_when_blank(table, sound, tmp_path):
    """A blank disk thickness scatters with the wall; a given one by itself, which narrows the spread."""
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(
        "tolerance_class,dimension,lower_deviation,upper_deviation,deviation_unit\n"
        "standard,wall_thickness,-10,10,µm\nstandard,disk_thickness,-10,10,µm\n",
        encoding="utf-8",
    )
    rows = [sound, {**sound, "variant": "two cuts", "disk_thickness_mm": 1.6}]
    results = run(table(rows), tolerances=tolerances).results
    variances = (results["first_order_sd_arcmin"] ** 2).to_list()
    assert variances[1] / variances[0] == pytest.approx(25 / 49, rel=1e-5)


def test_a_bore_makes_the_radius_follow_both(table, sound, tmp_path):
    """With a bore, wall thickness moves the mean radius too, and the tolerance of mean_radius does not apply."""
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(
        "tolerance_class,dimension,lower_deviation,upper_deviation,deviation_unit\n"
        "standard,wall_thickness,-10,10,µm\nstandard,mean_radius,-1,1,mm\n",
        encoding="utf-8",
    )
    bore = {**sound, "mean_radius_mm": "", "bore_diameter_mm": 160}
    outcome = run(table([bore]), tolerances=tolerances, samples=SAMPLES)
    (computed,) = outcome.computed.values()
    assert list(computed.limits) == ["wall_thickness"]
    row = outcome.results.row(0, named=True)
    step = 10e-3 / 1.6
    assert row["worst_case_low_arcmin"] < row["backlash_arcmin"] * (1 - step)


def test_without_scatter_every_percentile_is_the_nominal(table, sound, tmp_path):
    """A class without rows that apply leaves the variant exact: no spread, no contributor, no Ppk."""
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(
        "tolerance_class,dimension,lower_deviation,upper_deviation\nstandard,rim_length,-1,1\n", encoding="utf-8"
    )
    rows = [sound, {**sound, "variant": "over", "backlash_limit_arcmin": 3.0}]
    for row, over in zip(
        run(table(rows), tolerances=tolerances).results.iter_rows(named=True), (0.0, 1.0), strict=True
    ):
        assert row["sd_arcmin"] == 0
        assert row["p0_135_arcmin"] == row["p99_865_arcmin"] == row["backlash_arcmin"] == row["worst_case_high_arcmin"]
        assert row["probability_over_limit"] == row["probability_over_limit_high"] == over
        assert row["main_contributor"] is None
        assert row["ppk"] is None


@pytest.mark.parametrize("method", ["line", "sobol", "random"])
def test_probability_is_never_a_bare_zero(table, sound, method):
    """With no unit over the limit the upper end of the interval says how sure that is."""
    row = run(table([{**sound, "backlash_limit_arcmin": 30.0}]), method=method).results.row(0, named=True)
    assert row["probability_over_limit"] <= 1e-15
    assert row["ppm_over_limit"] <= 1e-9
    assert row["probability_over_limit_low"] == 0
    assert 0 < row["probability_over_limit_high"] < (1e-13 if method == "line" else 2e-4)
    assert row["ppm_over_limit_high"] == pytest.approx(1e6 * row["probability_over_limit_high"], rel=1e-15)


def test_lines_tell_a_ppm_that_points_cannot_see(table, sound):
    """A limit 5 sd above the mean is exceeded by under a ppm, which lines tell to 20 %, in ppm as in fractions."""
    plain = run(table([sound])).results.row(0, named=True)
    limit = plain["mean_arcmin"] + 5 * plain["sd_arcmin"]
    row = run(table([{**sound, "backlash_limit_arcmin": limit}])).results.row(0, named=True)
    assert 1e-8 < row["probability_over_limit"] < 2e-5
    assert row["probability_over_limit_high"] < 1.2 * row["probability_over_limit"]
    assert row["probability_over_limit_low"] > 0.8 * row["probability_over_limit"]
    for end in ("", "_low", "_high"):
        assert row[f"ppm_over_limit{end}"] == pytest.approx(1e6 * row[f"probability_over_limit{end}"], rel=1e-14)
    assert row["ppk_normal"] == pytest.approx(5 / 3, rel=1e-3)


def test_interaction_is_what_the_shares_leave(table, sound):
    """Interaction is what the first-order shares leave to 1, never negative, and next to nothing for a flexspline."""
    outcome = run(table(_variants(sound)))
    for one, row in zip(outcome.computed.values(), outcome.results.iter_rows(named=True), strict=True):
        left = 1 - math.fsum(one.spread.shares.values())
        assert row["interaction_share"] == pytest.approx(max(left, 0.0), abs=1e-15)
        assert 0 <= row["interaction_share"] < 0.01


def test_a_report_is_skipped_by_name(workbook, sound, tmp_path):
    """A report submitted by mistake is named and skipped, not computed and not failed."""
    run(workbook([sound]), tmp_path / "report.xlsx", samples=SAMPLES)
    outcome = run(tmp_path / "report.xlsx")
    assert outcome.skipped
    assert [one.code for one in outcome.findings] == ["I508"]
    assert outcome.results.is_empty()


def test_a_refused_file_gives_an_outcome_that_says_why(tmp_path):
    """A file that is no submission gives one finding and nothing else."""
    path = tmp_path / "letter.xlsx"
    path.write_bytes(b"%PDF-1.7 dear colleague")
    outcome = flexlash.run(path, tmp_path / "out.csv")
    assert [one.code for one in outcome.findings] == ["E101"]
    assert outcome.exit_code == 4
    assert outcome.results.is_empty()
    assert outcome.outputs == ()


def test_a_missing_file_raises(tmp_path):
    """A path without a file is an OSError for the caller to tell."""
    with pytest.raises(FileNotFoundError, match=r"none\.xlsx"):
        check(tmp_path / "none.xlsx")
    with pytest.raises(FileNotFoundError, match="this is not a file"):
        check(tmp_path)


def test_progress_counts_up_to_all_rows(table, sound):
    """The progress callback is told of every row and ends at their number."""
    told = []
    rows = [{**sound, "variant": f"v{number}"} for number in range(5)]
    run(table(rows), samples=SAMPLES, progress=lambda done, total: told.append((done, total)))
    assert told == [(number, 5) for number in range(1, 6)]


def test_progress_of_workers_counts_up_too(table, sound, monkeypatch):
    """With worker processes the progress callback is told of every row all the same."""
    monkeypatch.setattr(tolerance_spread, "ROWS_PER_WORKER", 1)
    told = []
    rows = [{**sound, "variant": f"v{number}"} for number in range(5)]
    run(table(rows), samples=SAMPLES, jobs=2, progress=lambda done, total: told.append((done, total)))
    assert told == [(number, 5) for number in range(1, 6)]


def test_the_report_keeps_the_submissions_date(workbook, sound, tmp_path):
    """The report's document date is the submission's own."""
    path = workbook([sound])
    book = openpyxl.load_workbook(path)
    book.properties.modified = datetime.datetime(2024, 5, 6, 7, 8, 9)  # noqa: DTZ001
    book.save(path)
    stamped = openpyxl.load_workbook(path).properties.modified
    run(path, tmp_path / "report.xlsx", samples=SAMPLES)
    assert openpyxl.load_workbook(tmp_path / "report.xlsx").properties.created == stamped


def test_materials_given_beside_a_table_replace_the_built_in(table, sound, tmp_path):
    """--materials brings its own list: its shear modulus is used, and a built-in name is unknown."""
    materials = tmp_path / "materials.csv"
    materials.write_text("material,shear_modulus_GPa\nmine,80.0\n", encoding="utf-8")
    rows = [{**sound, "material": "mine"}, {**sound, "variant": "other"}]
    outcome = check(table(rows), materials=materials)
    assert [one.code for one in outcome.findings] == ["E307"]
    row = outcome.results.row(0, named=True)
    assert row["backlash_rad"] == pytest.approx(1.0725044299e-3 * 8.1153846154e10 / 8e10, rel=1e-9)


@pytest.mark.parametrize("content", [b"PK\x03\x04 a workbook", b"PAR1", b"\xff\xfe"])
def test_a_faulty_table_beside_a_submission_is_refused_by_its_own_name(table, sound, tmp_path, content):
    """A --tolerances file that is no CSV table is refused, and the message names that file."""
    path = tmp_path / "tolerances.csv"
    path.write_bytes(content)
    outcome = check(table([sound]), tolerances=path)
    assert outcome.exit_code == 4
    assert outcome.findings[0].message.startswith("tolerances.csv ")


def test_options_are_named():
    """An option that does not exist is refused by Python itself."""
    with pytest.raises(TypeError):
        Options(sede=1)


def test_the_study_reproduces_the_published_case():
    """The example's first row is the article's baseline, its cases 4 and 5 stand in both readings."""
    rows = _rows(check(regenerate.ROOT / "data" / "b3-160-study.xlsx"))
    assert rows["B3-160 case 1"]["backlash_rad"] == pytest.approx(1.0725044299e-3, rel=1e-9)
    assert rows["B3-160 case 1"]["disk_share"] == pytest.approx(3 / 7, rel=1e-12)
    assert rows["B3-160 case 4"]["backlash_rad"] == pytest.approx(0.8285863e-3, abs=5e-11)
    assert rows["B3-160 case 4 r_m 80"]["backlash_rad"] == pytest.approx(1.1276618e-3, abs=5e-11)
    assert rows["B3-160 case 5"]["backlash_rad"] == pytest.approx(1.7931820e-3, abs=5e-11)
    assert rows["B3-160 case 5 r_m 80"]["backlash_rad"] == pytest.approx(0.9533373e-3, abs=5e-11)
    assert rows["B3-160 bore"]["backlash_arcsec"] == pytest.approx(218.124879, abs=5e-7)


def test_the_package_knows_no_other_names():
    """An unknown name of the package is an AttributeError."""
    with pytest.raises(AttributeError, match="nothing"):
        _ = flexlash.nothing


def test_names_that_differ_by_case_alone_are_one_name(table, sound):
    """Two variants whose names differ only by letter case are doubles, as Excel sees them."""
    outcome = check(table([{**sound, "variant": "cup A"}, {**sound, "variant": "CUP a"}]))
    assert [(one.code, one.cell) for one in outcome.findings] == [("E308", "A2"), ("E308", "A3")]


def test_notes_stand_beside_the_results(table, sound):
    """A row's notes are carried to the Results, also where the row has an error."""
    rows = [{**sound, "notes": "drawing 7"}, {**sound, "variant": "b", "torque_Nm": "", "notes": "drawing 8"}]
    assert check(table(rows)).results["notes"].to_list() == ["drawing 7", "drawing 8"]


def test_a_renamed_status_column_is_quiet(workbook, sound, tmp_path):
    """Formulas without a result under a header that is not ours are blank, not two thousand findings."""
    path = workbook([sound])
    book = openpyxl.load_workbook(path)
    book["Variants"]["U4"] = "Status"
    book.save(tmp_path / "renamed.xlsx")
    outcome = check(tmp_path / "renamed.xlsx")
    assert [(one.code, one.value) for one in outcome.findings] == [("I502", "Status")]
    assert outcome.counts["computed"] == 1


def test_a_symbol_is_header_enough(table, sound):
    """A column headed by its symbol and unit alone is recognised."""
    row = {**sound}
    row["r_ci [mm]"] = row.pop("disk_inner_radius_mm")
    row["Δ [µm]"] = row.pop("wall_thickness_mm") * 1000
    outcome = check(table([row]))
    assert outcome.exit_code == 0
    assert outcome.results["backlash_rad"][0] == pytest.approx(1.0725044299e-3, rel=1e-9)
