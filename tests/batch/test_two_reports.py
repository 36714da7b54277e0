"""What changed between two uploads is told in the words of `flexlash diff`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from flexlash.batch.two_reports import ComparisonTask, compare
from flexlash.cli import cli
from flexlash.pipeline import run
from flexlash.reading.read import Source

DATA = Path(__file__).resolve().parents[2] / "data"
FEW = {"samples": 64}


def _told(old, new, names=("before.xlsx", "now.xlsx")):
    sources = [Source(name=name, data=path.read_bytes()) for name, path in zip(names, (old, new), strict=True)]
    task = ComparisonTask(old=sources[0], new=sources[1]).as_bytes()
    told = compare(task)
    assert compare(task) == told
    return json.loads(told)


@pytest.fixture
def two(table, sound, tmp_path):
    """Return the reports of two submissions of which one has another wall and one variant more."""
    reports = []
    for number, wall in enumerate((1.6, 1.7)):
        rows = [sound | {"wall_thickness_mm": wall}, *[sound | {"variant": "more"}] * number]
        reports.append(tmp_path / f"report-{number}.xlsx")
        run(table(rows), reports[-1], **FEW)
    return reports


@pytest.mark.slow
def test_the_lines_are_those_of_the_command(two):
    """A page says of two reports what the terminal says, but for the option that tells more."""
    printed = CliRunner().invoke(cli, ["diff", *map(str, two)], catch_exceptions=False).output
    told = _told(*two, names=[path.name for path in two])
    assert told["differs"]
    assert told["results_compared"]
    assert [line.replace(" (--all)", "") for line in printed.splitlines()] == told["lines"]
    assert not any("--" in line for line in told["lines"])
    assert (told["counts"]["differing"], told["counts"]["added"]) == (1, 1)


@pytest.mark.slow
def test_a_report_beside_itself_differs_in_nothing(two):
    """Equal reports say so."""
    told = _told(two[0], two[0])
    assert not told["differs"]
    assert told["lines"] == ["No difference in inputs or results."]


def test_what_cannot_be_read_is_told(tmp_path):
    """A file that is neither report nor submission says why, in place of lines."""
    broken = tmp_path / "broken.xlsx"
    broken.write_bytes(b"PK\x03\x04 nothing")
    told = _told(DATA / "b3-160-study.xlsx", broken)
    assert told["refused"]["code"].startswith("E1")
    assert "now.xlsx" in told["refused"]["message"]
    assert told["lines"] == [told["refused"]["message"], told["refused"]["fix"]]
