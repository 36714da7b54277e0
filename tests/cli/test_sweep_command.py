"""`flexlash sweep` as its user meets it: words, exit codes, files."""

from __future__ import annotations

import csv
import json

import polars as pl
import pytest
from click.testing import CliRunner

import flexlash
from flexlash.cli import cli
from flexlash.decisions.asked_sweep import SweepError
from flexlash.feedback.template.template_workbook import Filling, template_bytes
from flexlash.feedback.template.template_workbook import study as published
from flexlash.reading import survey
from flexlash.schema.columns import VARIANTS
from flexlash.schema.result_columns import RESULTS

THIRD = "B3-160 case 3"
LENGTHS = "cylinder_length_mm=100:200:20"
ALLOWED = "  Cylinder length must be at most 161.85 mm for 99.865 % of units within 3.8′."


@pytest.fixture
def submission(tmp_path):
    """Return the path of the first and the third case of the published study, and a cylinder."""
    whole = published()
    variants = [whole.variants[0], whole.variants[2], whole.variants[-1]]
    path = tmp_path / "study.xlsx"
    path.write_bytes(template_bytes(Filling(variants=variants, tolerances=whole.tolerances)))
    return path


def _call(*arguments):
    return CliRunner().invoke(cli, ["sweep", *map(str, arguments)])


def _complaint(*arguments):
    done = _call(*arguments)
    assert done.exit_code == 2, done.output
    return done.stderr.splitlines()[-1]


@pytest.mark.slow
def test_a_report_beside_the_submission(submission, tmp_path):
    """Without -o the report with the sheet Sweep stands beside; the screen says what is allowed; bytes are the same."""
    done = _call(submission, "--variant", THIRD, "--vary", LENGTHS)
    assert done.exit_code == 0
    lines = done.stdout.splitlines()
    report = tmp_path / "study-sweep.xlsx"
    assert f"Written: {report}" in lines
    assert lines[-4:-2] == [f"{THIRD}: cylinder length from 100 to 200 mm", ALLOWED]
    before = report.read_bytes()
    assert _call(submission, "--variant", "b3-160 CASE 3", "--vary", "cylinder_length=100:200:20").exit_code == 0
    assert report.read_bytes() == before


@pytest.mark.slow
def test_the_report_alone_makes_it_again(submission, tmp_path):
    """What was asked for on the command line is carried: the report made anew has the same bytes."""
    assert _call(submission, "--variant", THIRD, "--vary", LENGTHS, "-o", tmp_path / "a.xlsx").exit_code == 0
    done = CliRunner().invoke(cli, ["run", "--from-report", str(tmp_path / "a.xlsx"), "-o", str(tmp_path / "b.xlsx")])
    assert done.exit_code == 0
    assert (tmp_path / "a.xlsx").read_bytes() == (tmp_path / "b.xlsx").read_bytes()


@pytest.mark.slow
def test_tables(submission, tmp_path):
    """CSV, Parquet and JSON hold the variant, the swept keys and the columns of Results; JSON the crossings as well."""
    for ending in (".csv", ".parquet", ".json"):
        vary = ("--vary", LENGTHS, "--vary", "wall_thickness=1.6,1.8")
        done = _call(submission, "--variant", THIRD, *vary, "-o", tmp_path / f"points{ending}", "--quiet")
        assert done.exit_code == 0, done.output
        assert not done.stdout
    table = pl.read_parquet(tmp_path / "points.parquet")
    keys = ["variant", "cylinder_length_mm", "wall_thickness_mm"]
    assert table.columns == [*keys, *(column.key for column in RESULTS if column.key != "variant")]
    assert table.height == 12
    with (tmp_path / "points.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["backlash_arcmin"]) for row in rows] == table["backlash_arcmin"].to_list()
    found = json.loads((tmp_path / "points.json").read_text(encoding="utf-8"))
    assert [row["p97_5_arcmin"] for row in found["sweep"]] == table["p97_5_arcmin"].to_list()
    target = {one["second"]: round(one["value"], 1) for one in found["crossings"] if one["percent"] == 99.865}
    assert target == {1.6: 161.9, 1.8: 197.1}


@pytest.mark.slow
def test_a_table_is_replaced_only_where_it_is_named_and_ours(submission, tmp_path):
    """A table of ours gives way to its successor; a file of the user's stays, and the points get a number."""
    arguments = (submission, "--variant", THIRD, "--vary", "torque=700,800", "-o", tmp_path / "points.csv")
    assert _call(*arguments).exit_code == 0
    assert _call(*arguments).exit_code == 0
    assert not (tmp_path / "points (2).csv").exists()
    (tmp_path / "points.csv").write_text("mine", encoding="utf-8")
    assert "was left alone" in _call(*arguments).stderr
    assert (tmp_path / "points.csv").read_text(encoding="utf-8") == "mine"
    assert (tmp_path / "points (2).csv").exists()
    assert _call(submission, "--vary", "torque=1,2", "-o", submission).exit_code == 2


@pytest.mark.slow
def test_points_without_numbers_end_with_3(submission, tmp_path):
    """Where some points are no part the others are computed, and the exit code is that of rows with errors."""
    done = _call(submission, "--variant", THIRD, "--vary", "disk_inner_radius=60:100:10", "-o", tmp_path / "p.csv")
    assert done.exit_code == 3
    again = _call(
        submission, "--variant", THIRD, "--vary", "disk_inner_radius=70,90", "-o", tmp_path / "q.csv", "--json"
    )
    assert json.loads(again.stdout)["exit_code"] == again.exit_code == 3
    assert "3 of 5 points are not computed: E303" in done.stdout


@pytest.mark.slow
def test_the_sheet_says_what_is_swept(submission, tmp_path):
    """Without --vary the rows of the sheet Sweep are computed, as `run` shows them in its report."""
    whole = published()
    sweep = [{"variant": THIRD, "dimension": "cylinder_length", "from": 100, "to": 200, "step": 20}]
    filled = tmp_path / "filled.xlsx"
    filling = Filling(variants=[whole.variants[2]], tolerances=whole.tolerances, sweep=sweep)
    filled.write_bytes(template_bytes(filling))
    done = _call(filled, "-o", tmp_path / "a.xlsx")
    assert done.exit_code == 0
    assert ALLOWED in done.stdout.splitlines()
    assert CliRunner().invoke(cli, ["run", str(filled), "-o", str(tmp_path / "b.xlsx")]).exit_code == 0
    assert (tmp_path / "a.xlsx").read_bytes() == (tmp_path / "b.xlsx").read_bytes()
    complaint = _complaint(submission)
    assert (
        complaint == "Error: Nothing is swept: its sheet Sweep has no row; say what to sweep: --vary NAME=FROM:TO:STEP."
    )


COMPLAINTS = {
    ("cylinder_lenth=1:2:1",): "there is no dimension cylinder_lenth; did you mean cylinder_length_mm?",
    ("backlash_limit=1:2:1",): "backlash_limit_arcmin is not a dimension of the part, so it cannot be swept.",
    ("torque=1:2",): "write NAME=FROM:TO:STEP, such as cylinder_length_mm=100:200:20, or NAME=V1,V2,…",
    ("torque",): "write NAME=FROM:TO:STEP, such as cylinder_length_mm=100:200:20, or NAME=V1,V2,…",
    ("torque=1:9:0",): "the step must be greater than 0, not 0; to count down write the greater value first.",
    ("torque=1:2:5",): "the step 5 is greater than the range of 1.",
    ("torque=1,5:2:1",): '"1,5" is not a number; decimals have a point.',
    ("torque=1,nan",): '"nan" is not a number.',
    ("torque=0:1:0.0001",): "that is 10,001 values; at most 2,000 are computed at once. Take a larger step.",
    ("torque=1,2", "torque_Nm=3"): "torque_Nm is swept twice; name two dimensions.",
    ("Torque T [N·m]=1,2", "torque_Nm=3"): "torque_Nm is swept twice; name two dimensions.",
    ("Wall thicknes [mm]=1,2",): "there is no dimension Wall thicknes [mm]; did you mean wall_thickness_mm?",
    ("Wanddicke=1,2",): "there is no dimension Wanddicke; did you mean wall_thickness_mm?",
    ("Wall thickness Δ [cm]=1,2",): "the values of wall_thickness_mm are in mm, not in cm.",
    ("Backlash limit [arcmin]=1,2",): ("backlash_limit_arcmin is not a dimension of the part, so it cannot be swept."),
    ("torque=1", "cylinder_length=1", "wall_thickness=1"): "one or two dimensions can be swept together, not 3.",
}


def test_what_cannot_be_meant_is_a_usage_error(tmp_path):
    """Every slip of --vary ends with 2 and a sentence that says what to write, before a file is read."""
    for texts, sentence in COMPLAINTS.items():
        complaint = _complaint(tmp_path / "none.xlsx", *(part for text in texts for part in ("--vary", text)))
        assert complaint.startswith("Error: --vary"), complaint
        assert complaint.endswith(f": {sentence}"), complaint


@pytest.mark.slow
def test_what_no_variant_can_be_swept_over(submission):
    """An unknown variant is told with the nearest, a dimension that it lacks with the rule; so are too many points."""
    assert _complaint(submission, "--variant", "B3-160 case 33", "--vary", "torque=1,2") == (
        f"Error: Nothing is swept: there is no variant B3-160 case 33; did you mean {THIRD}?"
    )
    assert _complaint(submission, "--variant", "B3-160 cylinder", "--vary", "disk_thickness=1,2").startswith(
        "Error: Nothing is swept: no value makes a part: B3-160 cylinder: "
    )
    assert _complaint(submission, "--variant", THIRD, "--vary", "Bore diameter=150,160").endswith(
        f": {THIRD}: its mean radius is entered; sweep mean_radius_mm instead."
    )
    assert _complaint(submission, "--vary", "torque=1:1000:1") == (
        "Error: Nothing is swept: that is 3,000 points of 3 variants; at most 2,000 are computed at once. Take larger "
        "steps, or name one with --variant."
    )
    assert _complaint(submission, "--variant", THIRD).startswith("Error: --variant needs --vary")


def test_a_file_that_is_not_there(tmp_path):
    """A file that cannot be opened ends with 5."""
    done = _call(tmp_path / "none.xlsx", "--vary", "torque=1,2")
    assert done.exit_code == 5
    assert "none.xlsx" in done.stderr


@pytest.mark.slow
def test_a_file_that_is_no_submission(tmp_path):
    """A file that cannot be read as a submission ends with 4; nothing is written."""
    path = tmp_path / "broken.xlsx"
    path.write_bytes(b"PK no workbook")
    done = _call(path, "--vary", "torque=1,2")
    assert done.exit_code == 4
    assert [one.name for one in tmp_path.iterdir()] == ["broken.xlsx"]


@pytest.mark.slow
def test_of_a_large_table_one_variant_is_swept(tmp_path, monkeypatch):
    """Of a table of many rows the named variant alone is computed, with the numbers that it has alone in a table."""
    monkeypatch.setattr(survey, "LARGE_ROWS", 50)
    keys = ["variant", "material", "torque_Nm", "cylinder_length_mm", "mean_radius_mm", "wall_thickness_mm"]
    keys += ["disk_inner_radius_mm", "backlash_limit_arcmin"]
    lines = [f"v{number},20Cr2Ni4,800,{150 + number},80,1.6,40,3.8" for number in range(80)]
    large, small = tmp_path / "large.csv", tmp_path / "small.csv"
    large.write_text("\n".join([",".join(keys), *lines]), encoding="utf-8")
    small.write_text("\n".join([",".join(keys), lines[70]]), encoding="utf-8")
    for path in (large, small):
        done = _call(path, "--variant", "V70", "--vary", "wall_thickness=1.5,1.7", "-o", path.with_suffix(".parquet"))
        assert done.exit_code == 0, done.output
    tables = [pl.read_parquet(path.with_suffix(".parquet")) for path in (large, small)]
    assert tables[0].equals(tables[1], null_equal=True)
    assert _complaint(large, "--vary", "torque=1,2").endswith(
        "Of a table of more than 50 rows, name the variant to sweep: --variant."
    )
    assert _complaint(large, "--variant", "v99", "--vary", "torque=1,2").endswith("there is no variant v99.")


@pytest.mark.slow
def test_from_python(submission, tmp_path):
    """`flexlash.sweep` returns the outcome and the studies, and writes nothing without an output."""
    outcome, (study,) = flexlash.sweep(submission, vary={"cylinder_length": [100, 120.5, 200]}, variant=THIRD)
    assert outcome.outputs == ()
    assert study.results["cylinder_length_mm"].to_list() == [100.0, 120.5, 200.0]
    assert [round(one.value, 1) for one in study.crossings] == [168.6, 164.1, 161.9]
    _, (same,) = flexlash.sweep(submission, vary={"Cylinder length l [mm]": [120.5, 100, 200, 100]}, variant=THIRD)
    assert same.results.equals(study.results, null_equal=True)
    assert same.first == study.first
    with pytest.raises(SweepError, match="did you mean torque_Nm"):
        flexlash.sweep(submission, vary={"torqe": [1.0]})
    with pytest.raises(SweepError, match="number"):
        flexlash.sweep(submission, vary={"torque": ["much"]})
    assert sorted(one.name for one in tmp_path.iterdir()) == ["study.xlsx"]


def test_every_dimension_can_be_named_with_and_without_its_unit():
    """Each dimension of Variants is found by key and header, each with and without unit, and no requirement is."""
    from flexlash.schema.swept_columns import swept_column

    for column in VARIANTS:
        if column.role == "dimension":
            assert swept_column(column.key) is swept_column(column.dimension) is column
            assert swept_column(column.label) is swept_column(column.name) is swept_column(column.plain_name) is column
        else:
            for name in (column.key, column.label):
                with pytest.raises(ValueError, match="cannot be swept"):
                    swept_column(name)


@pytest.mark.slow
def test_json(submission, tmp_path):
    """With --json one object is printed, which has points and crossings beside what `run --json` says."""
    done = _call(submission, "--variant", THIRD, "--vary", LENGTHS, "--json", "-o", tmp_path / "points.parquet")
    found = json.loads(done.stdout)
    assert found["exit_code"] == done.exit_code == 0
    assert [round(one["value"], 1) for one in found["crossings"]] == [168.6, 164.1, 161.9]
    assert [row["cylinder_length_mm"] for row in found["sweep"]] == [100, 120, 140, 160, 180, 200]
    assert found["outputs"] == [str(tmp_path / "points.parquet")]


@pytest.mark.slow
def test_what_it_wrote_is_no_submission(submission, tmp_path):
    """Of a folder its reports and tables are skipped, as those of `run` are."""
    for arguments in ((), ("-o", tmp_path / "points.csv"), ("-o", tmp_path / "points.parquet")):
        assert _call(submission, "--variant", THIRD, "--vary", "torque=700,800", *arguments).exit_code == 0
    done = CliRunner().invoke(cli, ["check", str(tmp_path), "--json"])
    objects = [json.loads(line) for line in done.stdout.splitlines()]
    codes = {one["submission"]: one["findings"][0]["code"] for one in objects if one.get("findings")}
    assert codes.pop("study.xlsx")[0] != "E"
    assert codes == {"study-sweep.xlsx": "I508", "points.csv": "I527", "points.parquet": "I527"}
