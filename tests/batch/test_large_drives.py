"""A large table with other sources beside it gives the drives in chunks that it gives in one piece."""

from __future__ import annotations

import csv

import pytest
from here import HereExecutor
from whole_drives import CASE_3, EXAMPLE, GRINDING

from flexlash.analysis.examination import tables_beside
from flexlash.analysis.options import Options
from flexlash.batch.compute import answer_of
from flexlash.batch.large_tables import LargeTable, large_table
from flexlash.outputs.plan import Plan
from flexlash.pipeline import run
from flexlash.reading.products import Companions

FEW = {"samples": 64, "method": "line"}


def _table(path, rows):
    """Write rows as a text table under their keys; return its path."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(dict.fromkeys(key for row in rows for key in row)))
        writer.writeheader()
        writer.writerows(rows)
    return path


def _in_chunks(path, output, rows, beside):
    """Return the answer of a table computed in chunks of so many rows, in this process."""
    options = Options.of("run()", FEW | beside)
    plan = Plan(inputs=[path])
    table = LargeTable(
        path=path,
        ran=True,
        options=options,
        tables=tables_beside(options),
        companions=Companions.of(path, [path]),
        report=plan.claim(output, named=True),
        copy=None,
        resume=False,
    )
    return large_table(table, HereExecutor(), chunk_rows=rows)[0]


@pytest.mark.slow
@pytest.mark.parametrize("sources", [EXAMPLE, [*EXAMPLE, EXAMPLE[0]]])
def test_drives_in_chunks(sources, tmp_path):
    """Results, findings, counts and lines for the screen are those of one piece, also where a source is faulty."""
    limits = (None, 4.9, 5.2, 5.3)
    rows = [
        CASE_3
        | {"variant": f"V{number}", "torque_Nm": 700 + 10 * number, "system_limit_arcmin": limits[number % len(limits)]}
        for number in range(23)
    ]
    path = _table(tmp_path / "gears.csv", rows)
    beside = {
        "tolerances": _table(tmp_path / "tolerances.csv", GRINDING),
        "other_sources": _table(tmp_path / "sources.csv", sources),
    }
    whole = run(path, tmp_path / "whole.csv", **FEW | beside)
    expected = answer_of(whole, ran=True)
    has_drives = whole.results["system_mean_arcmin"].count() > 0
    assert has_drives == (sources is EXAMPLE)
    assert any(line.startswith("Whole drive") for line in expected.details) == has_drives
    for count in (7, 1000):
        answer = _in_chunks(path, tmp_path / f"{count}.csv", count, beside)
        assert (tmp_path / f"{count}.csv").read_bytes() == (tmp_path / "whole.csv").read_bytes()
        told = whole.as_dictionary()
        assert answer.told["findings"] == told["findings"]
        assert answer.told["counts"] == told["counts"]
        assert list(answer.details) == list(expected.details)
        assert answer.exit_code == whole.exit_code
