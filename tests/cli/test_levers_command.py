"""`flexlash levers` as its user meets it: the table on the screen or in a file, with the exit codes of run."""

from __future__ import annotations

import json

import polars as pl
import pytest
from click.testing import CliRunner

from flexlash import levers
from flexlash.cli import cli
from flexlash.schema.decision_results import LEVERS_TABLE
from flexlash.schema.stamps import stamp_at

pytestmark = pytest.mark.slow


@pytest.fixture
def submission(table, sound):
    """Return a table of one variant that fails its limit, one that meets it, and one without a limit."""
    rows = [{**sound, "variant": name, "backlash_limit_arcmin": limit}
            for name, limit in (("too soft", 3.6), ("fine", 3.9), ("free", ""))]  # fmt: skip
    return table(rows, "gear.csv")


def _call(*arguments, **options):
    return CliRunner().invoke(cli, ["levers", *map(str, arguments)], **options)


def _same(read, frame):
    """Whether a table that was read back holds every number of another with every digit."""
    assert read.columns == [column.key for column in LEVERS_TABLE] == frame.columns
    for key in frame.columns:
        assert read[key].to_list() == frame[key].to_list(), key


def test_the_screen_has_a_block_for_each_variant_with_a_limit(submission):
    """First what was computed, then who misses the limit with its changes, then who meets it; no word of free."""
    done = _call(submission)
    assert done.exit_code == 0
    lines = done.stdout.splitlines()
    assert lines[0].startswith(f"{submission}: 3 of 3 rows computed")
    soft = next(place for place, line in enumerate(lines) if line.startswith("too soft misses its limit of 3.6′"))
    fine = next(place for place, line in enumerate(lines) if line.startswith("fine meets its limit of 3.9′"))
    assert soft < fine
    assert any(line.startswith("  1 ") for line in lines[soft:fine])
    assert lines[-1] == "1 variant has no backlash limit: there is nothing to meet."
    assert not any("flexlash levers" in line for line in lines)
    assert "\x1b" not in done.stdout


def test_the_cheapest_change_holds_as_a_submission_of_its_own(submission, table, sound):
    """The change of rank 1, entered with the value as drawn, has the very share over the limit that was told."""
    _, frame = levers(submission)
    first = frame.filter((pl.col("variant") == "too soft") & (pl.col("rank") == 1)).row(0, named=True)
    assert first["what"] == "nominal"
    changed = {f"{first['dimension']}_mm": first["drawing_value"]}
    outcome, again = levers(table([{**sound, "backlash_limit_arcmin": 3.6} | changed], "changed.csv"))
    assert outcome.results["probability_over_limit"][0] == first["probability_over_limit_after"] <= 0.00135
    assert set(again["direction"]) == {"relax"}


def test_the_screen_calls_the_inner_edge_of_a_hat_by_its_name(table, sound):
    """Beside a cup, whose hub radius it is, the inner edge of a hat's disk is its disk inner radius."""
    hat = {
        **sound,
        "variant": "hat",
        "flexspline_type": "hat",
        "disk_inner_radius_mm": 79.9,
        "disk_outer_radius_mm": 120,
    }
    limited = [one | {"backlash_limit_arcmin": 3.9} for one in (sound, hat)]
    cup, hat_lines = _call(table(limited)).stdout.split("\nhat m")
    assert "Hub radius" in cup
    assert "isk inner radius" not in cup
    assert "Hub radius" not in hat_lines
    assert "Disk inner radius" in hat_lines


def test_files_hold_the_table_with_every_digit(submission, tmp_path):
    """CSV, Parquet and JSON read back are the frame that Python returns; blank for none; JSON and Parquet stamped."""
    outcome, frame = levers(submission, tmp_path / "levers.parquet")
    assert outcome.outputs == (tmp_path / "levers.parquet",)
    _same(pl.read_parquet(tmp_path / "levers.parquet"), frame)
    for ending in (".csv", ".json"):
        done = _call(submission, "-o", tmp_path / f"levers{ending}")
        assert done.stdout.splitlines()[-1] == f"Written: {tmp_path / f'levers{ending}'}"
    _same(pl.read_csv(tmp_path / "levers.csv", schema=frame.schema), frame)
    content = json.loads((tmp_path / "levers.json").read_text(encoding="utf-8"))
    assert content["levers"] == frame.to_dicts()
    assert {stamp_at(tmp_path / f"levers{ending}") for ending in (".json", ".parquet")} == {"levers"}


def test_nothing_of_the_users_is_overwritten(submission, tmp_path):
    """A file of another program at the place of the table stays; the table gets a number, which is said."""
    taken = tmp_path / "levers.csv"
    taken.write_text("mine\n", encoding="utf-8")
    done = _call(submission, "-o", taken)
    assert done.exit_code == 0
    assert taken.read_text(encoding="utf-8") == "mine\n"
    assert (tmp_path / "levers (2).csv").exists()
    assert "was left alone" in done.stderr
    assert _call(submission, "-o", tmp_path / "levers (2).csv").exit_code == 0
    assert not (tmp_path / "levers (2) (2).csv").exists()


def test_a_table_of_levers_is_no_submission(submission, tmp_path):
    """Met again in a folder, the tables are skipped as results, not blamed as submissions."""
    for ending in (".csv", ".parquet"):
        levers(submission, tmp_path / f"levers{ending}")
        assert "I527" in CliRunner().invoke(cli, ["check", str(tmp_path / f"levers{ending}")]).stdout


def test_json_is_that_of_run_with_the_table(submission):
    """One object on standard output, of the shape of run, with the rows of the table beside."""
    done = _call(submission, "--json")
    told = json.loads(done.stdout)
    assert (told["exit_code"], told["counts"]["fails"], told["outputs"]) == (0, 1, [])
    assert {row["variant"] for row in told["levers"]} == {"too soft", "fine"}


def test_exit_codes_are_those_of_run(table, sound, tmp_path):
    """A row with an error: 3, nothing computable: 4, no such file: 5, an output that cannot be meant: 2."""
    some = table([sound, {**sound, "variant": "b", "torque_Nm": -1}], "some.csv")
    done = _call(some)
    assert done.exit_code == 3
    assert "E207" in done.stderr
    assert "E207" not in done.stdout
    assert _call(table([{**sound, "torque_Nm": -1}], "none.csv"), "-o", tmp_path / "none.json").exit_code == 4
    assert not (tmp_path / "none.json").exists()
    done = _call(tmp_path / "none.csv")
    assert done.exit_code == 4
    assert done.stdout.splitlines()[-1] == "There is no change to tell: no row could be computed."
    assert _call(tmp_path / "missing.csv").exit_code == 5
    done = _call(some, "-o", tmp_path / "report.xlsx")
    assert done.exit_code == 2
    assert "OUT must end in .csv, .parquet, .json" in done.stderr


def test_a_run_without_a_report_points_to_this_command(submission, tmp_path):
    """Where Results alone were written the last line names the command; a report tells the cheapest change itself."""
    done = CliRunner().invoke(cli, ["run", str(submission), "-o", str(tmp_path / "out.csv")])
    assert done.stdout.splitlines()[-1] == f"Which single change meets the limit: flexlash levers {submission}"
    done = CliRunner().invoke(cli, ["run", str(submission), "-o", str(tmp_path / "out.xlsx")])
    assert "  Cheapest single change for too soft: " in done.stdout
    assert "flexlash levers" not in done.stdout
