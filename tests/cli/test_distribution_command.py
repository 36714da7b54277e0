"""`flexlash distribution` as its user meets it."""

from __future__ import annotations

import json

import polars as pl
import pytest
from click.testing import CliRunner

from flexlash.cli import cli

pytestmark = pytest.mark.slow


def _call(*arguments):
    return CliRunner().invoke(cli, ["distribution", *map(str, arguments)])


@pytest.fixture
def submission(table, sound):
    """Return a table of one variant."""
    return table([sound], "gear.csv")


def test_the_ending_decides_what_is_written(submission, tmp_path):
    """Units, percentiles and metalogs go where they are named; the screen says where."""
    for ending in ("parquet", "csv", "json"):
        done = _call(submission, "-o", tmp_path / f"out.{ending}", "--units", 50)
        assert done.exit_code == 0, done.output
        assert f"out.{ending}" in done.stdout
    assert pl.read_parquet(tmp_path / "out.parquet").height == 50
    assert pl.read_csv(tmp_path / "out.csv").height > 50
    assert len(json.loads((tmp_path / "out.json").read_text(encoding="utf-8"))["sips"]) == 1


def test_a_file_of_the_user_is_never_overwritten(submission, tmp_path):
    """What is not flexlash's own stays, and the output is numbered; its own is replaced."""
    (tmp_path / "out.csv").write_text("mine", encoding="utf-8")
    for _ in range(2):
        assert _call(submission, "-o", tmp_path / "out.csv").exit_code == 0
    assert (tmp_path / "out.csv").read_text(encoding="utf-8") == "mine"
    assert {path.name for path in tmp_path.iterdir()} == {"gear.csv", "out.csv", "out (2).csv"}


def test_what_cannot_be_meant_is_a_usage_error(submission, tmp_path):
    """No OUT, an ending that there is not and no units end with 2, and nothing is written."""
    for arguments in ([], ["-o", tmp_path / "out.xlsx"], ["-o", tmp_path / "out.csv", "--units", "0"]):
        assert _call(submission, *arguments).exit_code == 2
    assert {path.name for path in tmp_path.iterdir()} == {"gear.csv"}
