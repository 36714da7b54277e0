"""The elasticity check of a submission: numbers beside the formula's, findings where they part, pictures."""

from __future__ import annotations

import subprocess
import sys

import polars as pl
import pytest
import regenerate

from flexlash.analysis import verification
from flexlash.analysis.examination import Examined
from flexlash.analysis.options import Options
from flexlash.cli import cli
from flexlash.mechanics import elasticity
from flexlash.mechanics.elasticity import MISSING
from flexlash.mechanics.elasticity.twist import ElasticityCheck
from flexlash.pipeline import run
from flexlash.reading.raw import Submission
from flexlash.report import report_data
from flexlash.schema.result_columns import ELASTICITY, RESULTS

pytest.importorskip("skfem", reason="scikit-fem is not installed here")
pytest.importorskip("matplotlib", reason="matplotlib is not installed here")

QUICK = {"method": "random", "samples": 16}
FILLETS = {"hub_fillet_radius_mm": 3.5, "junction_fillet_radius_mm": 3.5}
SHORT_HAT = {
    "flexspline_type": "hat",
    "mean_radius_mm": 60.0,
    "cylinder_length_mm": 48.0,
    "wall_thickness_mm": 1.8,
    "disk_inner_radius_mm": None,
    "disk_outer_radius_mm": 90.0,
    "disk_thickness_mm": 5.0,
    "rim_length_mm": 10.0,
    "rim_thickness_mm": 4.5,
}


def _rows(outcome):
    return {row["variant"]: row for row in outcome.results.iter_rows(named=True)}


@pytest.fixture(scope="module")
def proof(tmp_path_factory):
    """Return the outcome of the B3-160 proof and the path of its report."""
    path = tmp_path_factory.mktemp("proof") / "report.xlsx"
    return run(regenerate.ROOT / "data" / "b3-160-proof.xlsx", path, elasticity=True, **QUICK), path


def test_the_check_stands_beside_the_formula(proof):
    """Every row has wind-up, difference and error; the difference is that of the formula relative to elasticity."""
    for row in _rows(proof[0]).values():
        ratio = row["windup_rad"] / row["elasticity_windup_rad"] - 1
        assert row["elasticity_difference_percent"] == pytest.approx(100 * ratio, rel=1e-9)
        assert abs(row["elasticity_difference_percent"]) < 0.25
        assert 0 < row["elasticity_error_percent"] < 0.05


def test_fillets_and_rim_explain_the_published_finite_elements(proof):
    """A plain part exceeds the published 9.86e-4 rad by 7 %; fillets and rims of 20 and 30 mm bracket it."""
    rows = _rows(proof[0])
    backlash = {name: 2 * row["elasticity_windup_rad"] / 9.86e-4 - 1 for name, row in rows.items()}
    assert backlash["true mean radius"] == pytest.approx(0.0727, abs=5e-4)
    assert backlash["fillets"] == pytest.approx(0.0436, abs=1e-3)
    assert -0.015 < backlash["fillets, rim 30 mm"] < 0 < backlash["fillets, rim 20 mm"] < 0.01


def test_only_a_hub_fillet_has_a_peak(proof):
    """The peak stress is given where there is a hub fillet, and lies above the formula's stress, by less than half."""
    for name, row in _rows(proof[0]).items():
        peak = row["elasticity_hub_fillet_shear_MPa"]
        if "fillets" in name:
            assert 1 < peak / row["hub_shear_MPa"] < 1.5
        else:
            assert peak is None


def test_without_the_option_nothing_is_checked(table, sound):
    """The columns are those of --elasticity alone, and come last."""
    assert run(table([sound]), **QUICK).results.columns == [column.key for column in RESULTS]
    checked = run(table([sound]), elasticity=True, **QUICK).results.columns
    assert checked == [column.key for column in (*RESULTS, *ELASTICITY)]


def test_the_formula_and_the_spread_do_not_change(table, sound):
    """The check adds its columns and changes no other number."""
    plain, checked = (run(table([sound]), elasticity=asked, **QUICK).results for asked in (False, True))
    assert checked.select(plain.columns).equals(plain)


@pytest.mark.parametrize(
    ("change", "column", "cause"),
    [
        ({"disk_outer_radius_mm": 100.0}, "disk_outer_radius_mm", "the disk does not end within the wall"),
        ({"disk_inner_radius_mm": 79.5}, "disk_inner_radius_mm", "the hub reaches into the wall"),
        (
            {"hub_fillet_radius_mm": 25.0, "junction_fillet_radius_mm": 20.0},
            "junction_fillet_radius_mm",
            "hub fillet and junction fillet overlap on the disk",
        ),
        ({"hub_fillet_radius_mm": 39.9}, "hub_fillet_radius_mm", "the hub fillet reaches into the wall"),
        (
            {"flexspline_type": "hat", "disk_inner_radius_mm": None, "disk_outer_radius_mm": 80.5},
            "disk_outer_radius_mm",
            "the flange ends within the wall",
        ),
    ],
)
def test_what_cannot_be_made_is_told_and_stays_unchecked(table, sound, change, column, cause):
    """A row without a closed half-section is computed, keeps empty check cells, and says why at the cell to blame."""
    outcome = run(table([{**sound, **change}, {**sound, "variant": "sound"}]), elasticity=True, **QUICK)
    (told,) = [found for found in outcome.findings if found.code == "W413"]
    assert told.column == column
    assert told.variant == sound["variant"]
    assert cause in told.message
    rows = _rows(outcome)
    assert rows[sound["variant"]]["status"] == "warning"
    assert rows[sound["variant"]]["backlash_arcmin"] > 0
    assert all(rows[sound["variant"]][key.key] is None for key in ELASTICITY)
    assert rows["sound"]["elasticity_windup_rad"] > 0
    assert outcome.exit_code == 0


def test_where_formula_and_elasticity_part_is_flagged(table, sound):
    """A short thick hat with a rim is over 2 % off and says so; a plain cup is not."""
    outcome = run(table([{**sound, **SHORT_HAT}, {**sound, "variant": "cup"}]), elasticity=True, **QUICK)
    (told,) = [found for found in outcome.findings if found.code == "W414"]
    row = _rows(outcome)[sound["variant"]]
    assert told.variant == sound["variant"]
    assert f"{-row['elasticity_difference_percent']:.1f} % below two-dimensional elasticity" in told.message
    assert row["elasticity_difference_percent"] < -2
    assert "W414" in row["findings"]


def test_calibration_has_no_part_in_the_difference(workbook, sound):
    """With factors on both parts the check and its difference stay those of the formula without them."""
    keys = [column.key for column in ELASTICITY]
    plain = _rows(run(workbook([sound]), elasticity=True, **QUICK))[sound["variant"]]
    factors = {"cylinder_calibration": 0.9, "disk_calibration": 0.8}
    outcome = run(workbook([sound], settings=factors), elasticity=True, **QUICK)
    scaled = _rows(outcome)[sound["variant"]]
    assert [scaled[key] for key in keys[:3]] == pytest.approx([plain[key] for key in keys[:3]], rel=1e-9)
    assert scaled["windup_rad"] < 0.9 * plain["windup_rad"]
    assert outcome.findings == ()


@pytest.mark.parametrize(("torque", "told"), [(8500, False), (9800, True)])
def test_a_hub_fillet_that_yields(table, sound, torque, told):
    """A peak von Mises stress above yield along the hub fillet is a warning, also where the section does not yield."""
    row = {**sound, "torque_Nm": torque, "hub_fillet_radius_mm": 1.0}
    outcome = run(table([row]), elasticity=True, **QUICK)
    peaks = [found for found in outcome.findings if found.code == "W417"]
    assert len(peaks) == told
    peak = 3**0.5 * _rows(outcome)[sound["variant"]]["elasticity_hub_fillet_shear_MPa"]
    assert (peak > 1080) == told
    if told:
        assert f"{peak:.4g} MPa exceeds the yield strength 1080 MPa" in peaks[0].message


def test_a_junction_fillet_that_yields(table, sound):
    """In a disk that is thick at the hub and thin at the wall the junction fillet has the greatest peak."""
    disk = {"disk_hub_thickness_mm": 6.4, "disk_thickness_exponent": 2.0}
    row = {**sound, **disk, "torque_Nm": 25000, "hub_fillet_radius_mm": 3.0, "junction_fillet_radius_mm": 0.5}
    outcome = run(table([row]), elasticity=True, **QUICK)
    found = _rows(outcome)[sound["variant"]]
    assert found["elasticity_junction_fillet_shear_MPa"] > 1.2 * found["elasticity_hub_fillet_shear_MPa"]
    assert [one.column for one in outcome.findings if one.code == "W417"] == ["junction_fillet_radius_mm"]


def test_what_cannot_be_solved_is_told(table, sound, monkeypatch):
    """Where the equations fail, or their result is nonsense, the row says so and stays without a check."""

    def fail(*_):
        raise RuntimeError("singular")

    def nonsense(*_):
        return elasticity_check_of(windup=-1.0, error=0.0)

    for faulty in (fail, nonsense, lambda *_: elasticity_check_of(windup=1e-3, error=0.02)):
        monkeypatch.setattr(verification, "elasticity_check", faulty)
        outcome = run(table([sound]), elasticity=True, **QUICK)
        (told,) = outcome.findings
        assert told.code == "W413"
        assert told.message.endswith(
            "= 1.6 mm: not checked by elasticity, since so extreme a part cannot be solved to 1 %."
        )
        assert _rows(outcome)[sound["variant"]]["elasticity_windup_rad"] is None


def elasticity_check_of(windup, error):
    """Return a check with these results and nothing else."""
    return ElasticityCheck(
        windup=windup, error=error, hub_fillet_shear=None, junction_fillet_shear=None, section=None, shear=None
    )


def test_a_foil_is_not_solved(table, sound):
    """A disk that thins to a foil is told, not solved."""
    thin = {"disk_inner_radius_mm": 20.0, "disk_hub_thickness_mm": 4.0, "disk_thickness_exponent": 4.6}
    outcome = run(table([{**sound, **thin}]), elasticity=True, **QUICK)
    assert "thins to a foil" in next(found.message for found in outcome.findings if found.code == "W413")


def test_worker_processes_change_no_bit(table, sound, tmp_path, monkeypatch):
    """Checked here or by two worker processes, the report has the same bytes."""
    monkeypatch.setattr(verification, "WORTH_A_WORKER", 1)
    rows = [{**sound, **FILLETS, "variant": f"l {length}", "cylinder_length_mm": length} for length in (90, 120.5, 160)]
    path = table(rows)
    for jobs in (1, 2):
        run(path, tmp_path / f"{jobs}.xlsx", elasticity=True, jobs=jobs, **QUICK)
    assert (tmp_path / "1.xlsx").read_bytes() == (tmp_path / "2.xlsx").read_bytes()


def test_a_variant_does_not_depend_on_its_neighbours(table, sound):
    """A row's check has the same bits alone and among others in another order."""
    rows = [{**sound, **FILLETS, "variant": f"l {length}", "cylinder_length_mm": length} for length in (90, 120.5, 160)]
    keys = [column.key for column in ELASTICITY]
    every = _rows(run(table(rows[::-1]), elasticity=True, **QUICK))
    for row in rows:
        alone = _rows(run(table([row]), elasticity=True, **QUICK))[row["variant"]]
        assert [alone[key] for key in keys] == [every[row["variant"]][key] for key in keys]


def test_progress_counts_spread_and_check(table, sound):
    """The progress callback ends at twice the rows: each is spread, then checked."""
    told = []
    rows = [{**sound, "variant": f"v{number}"} for number in range(3)]
    run(table(rows), elasticity=True, progress=lambda done, total: told.append((done, total)), **QUICK)
    assert told == [(number, 6) for number in range(1, 7)]


def test_only_the_worst_are_pictured_and_only_in_a_report(table, sound, tmp_path, monkeypatch):
    """The report pictures the worst few; the other forms and a run without output solve nothing twice."""
    monkeypatch.setattr(report_data, "PICTURED", 2)
    rows = [{**sound, "variant": f"T {torque}", "torque_Nm": torque} for torque in (500, 800, 700)]
    path = table(rows)
    asked = []
    solve = verification.pictured
    monkeypatch.setattr(verification, "pictured", lambda worst: asked.append(worst) or solve(worst))
    run(path, tmp_path / "r.xlsx", elasticity=True, **QUICK)
    run(path, tmp_path / "r.csv", elasticity=True, **QUICK)
    run(path, elasticity=True, **QUICK)
    assert [[one.variant.name for one in worst] for worst in asked] == [["T 800", "T 700"]]
    assert pl.read_csv(tmp_path / "r.csv")["elasticity_windup_rad"].null_count() == 0


def test_nothing_computed_is_nothing_to_check(table, sound):
    """A submission without a sound row ends as it does without the check."""
    outcome = run(table([{**sound, "torque_Nm": None}]), elasticity=True, **QUICK)
    assert outcome.exit_code == 4
    refused = run(regenerate.ROOT / "pyproject.toml", elasticity=True)
    assert refused.exit_code == 4


def test_absent_libraries_are_named_before_anything_is_read(table, sound, tmp_path, monkeypatch):
    """Without the extra the command line ends with usage and says what to install; the function raises; no file."""
    path = table([sound])
    monkeypatch.setattr(elasticity, "find_spec", lambda _: None)
    with pytest.raises(ModuleNotFoundError, match="pip install 'flexlash\\[elasticity\\]'"):
        run(path, tmp_path / "report.xlsx", elasticity=True)
    with pytest.raises(ModuleNotFoundError, match="scikit-fem"):
        verification.verified_by_elasticity(Examined(submission=Submission(name="", sha256="", kind="csv")), Options())
    from click.testing import CliRunner

    shown = CliRunner().invoke(cli, ["run", str(path), "--elasticity"])
    assert shown.exit_code == 2
    assert MISSING in shown.output
    assert [one.name for one in tmp_path.iterdir()] == [path.name]


def test_a_run_without_the_check_does_not_need_its_libraries():
    """Neither scikit-fem nor matplotlib is loaded by a run without the check."""
    code = (
        "import sys\nfrom flexlash.pipeline import run\n"
        f"run({str(regenerate.ROOT / 'data' / 'b3-160-study.xlsx')!r}, method='random', samples=16)\n"
        "assert not {'skfem', 'matplotlib'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)


SMALL = {
    "torque_Nm": 60.0, "cylinder_length_mm": 25.0, "mean_radius_mm": 25.0, "wall_thickness_mm": 0.55,
    "disk_thickness_mm": 0.8, "disk_inner_radius_mm": 13.0, "rim_length_mm": 10.0, "rim_thickness_mm": 1.1,
}  # fmt: skip
FACE = SMALL | {"tooth_face_width_mm": 10.0}


@pytest.fixture(scope="module")
def lobed(tmp_path_factory):
    """Return the outcome of a cup without and with a tooth face, and of parts that have no bounds."""
    rows = [
        {"variant": "open end", **SMALL},
        {"variant": "face", **FACE},
        {"variant": "more teeth", **FACE, "engaged_teeth_percent": 50.0},
        {"variant": "narrow bearing", **FACE, "bearing_width_mm": 3.0},
        {"variant": "usual bearing", **FACE, "bearing_width_mm": 7.0, "engaged_teeth_percent": 30.0},
        {"variant": "hat", **SHORT_HAT, "torque_Nm": 60.0, "tooth_face_width_mm": 10.0},
        {"variant": "wide bearing", **FACE, "bearing_width_mm": 45.0},
    ]
    path = tmp_path_factory.mktemp("lobed") / "lobed.csv"
    pl.DataFrame([{"material": "20Cr2Ni4", **row} for row in rows]).write_csv(path)
    return run(path, path.with_name("report.xlsx"), elasticity=True, **QUICK), path.with_name("report.xlsx")


def test_bounds_stand_beside_the_backlash(lobed):
    """A cup with a tooth face has bounds above its backlash; blank cells are the usual bearing and share of teeth."""
    rows = _rows(lobed[0])
    face = rows["face"]
    assert face["backlash_arcmin"] < face["two_lobe_low_arcmin"] < face["two_lobe_high_arcmin"]
    change = 100 * (face["backlash_rad"] / rows["open end"]["backlash_rad"] - 1)
    assert face["face_width_change_percent"] == pytest.approx(change, rel=1e-9)
    keys = ("two_lobe_low_arcmin", "two_lobe_high_arcmin", "face_width_change_percent")
    assert [rows["usual bearing"][key] for key in keys] == [face[key] for key in keys]
    assert rows["more teeth"]["two_lobe_low_arcmin"] < face["two_lobe_low_arcmin"]
    assert rows["narrow bearing"]["two_lobe_high_arcmin"] > face["two_lobe_high_arcmin"]
    assert rows["open end"]["two_lobe_low_arcmin"] is None


def test_elasticity_loads_the_tooth_face_too(lobed):
    """With a tooth face both formula and elasticity load it, so that they part no further than at the open end."""
    rows = _rows(lobed[0])
    for name in ("open end", "face"):
        assert abs(rows[name]["elasticity_difference_percent"]) < 1.0
    ratio = rows["face"]["elasticity_windup_rad"] / rows["open end"]["elasticity_windup_rad"]
    assert ratio == pytest.approx(1 + rows["face"]["face_width_change_percent"] / 100, abs=2e-3)


def test_parts_without_bounds_say_why(lobed):
    """A hat, and a cup whose bearing reaches into the disk, are checked, and told why they have no bounds."""
    outcome, rows = lobed[0], _rows(lobed[0])
    told = {found.variant: found.message for found in outcome.findings if found.code == "I540"}
    assert set(told) == {"hat", "wide bearing"}
    assert "a hat is held at its bolt circle" in told["hat"]
    assert "bearing of the wave generator reaches into the disk" in told["wide bearing"]
    for name in told:
        assert rows[name]["two_lobe_low_arcmin"] is None
        assert rows[name]["elasticity_windup_rad"] is not None


def test_the_sheet_shows_bounds_where_there_are_any(lobed, proof):
    """The sheet Elasticity has the columns of two lobes where a variant has bounds, and says what they leave out."""
    import openpyxl

    with_bounds, without = (openpyxl.load_workbook(made[1])["Elasticity"] for made in (lobed, proof))
    texts = [[str(cell.value) for row in sheet.iter_rows() for cell in row] for sheet in (with_bounds, without)]
    assert "Two lobes, high [arcmin]" in texts[0]
    assert any("The wave generator's fit is not included" in text for text in texts[0])
    assert not any("wo lobes" in text for text in texts[1])
