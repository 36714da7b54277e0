"""A changed source of backlash is told by what the whole drive comes to; other points of the calculation are not."""

from __future__ import annotations

import pytest
from entry_books import entry_book
from whole_drives import CASE_3, EXAMPLE, GRINDING

from flexlash.comparison.difference import difference
from flexlash.comparison.difference_lines import difference_lines
from flexlash.comparison.sides import side_of
from flexlash.pipeline import run
from flexlash.reading.reading_limits import ReadingLimits


def _report(folder, name, sources, **options):
    path = entry_book(folder / f"{name}.xlsx", variants=[CASE_3], tolerances=GRINDING, other_sources=sources)
    report = folder / f"{name}-report.xlsx"
    run(path, report, **options)
    return side_of(report, ReadingLimits())


@pytest.mark.slow
def test_changed_system_numbers_are_named(tmp_path):
    """With half the tooth clearance average, P99.865 and share over the limit of the drive are named, nothing else."""
    old = _report(tmp_path, "old", EXAMPLE)
    new = _report(tmp_path, "new", [EXAMPLE[0] | {"upper_deviation": 0.01}, *EXAMPLE[1:]])
    found = difference(old, new)
    keys = {change.key for change in found.variants[0].results}
    assert {"system_mean_arcmin", "system_p99_865_arcmin", "system_probability_over_limit"} <= keys
    assert all(key.startswith(("system_", "status", "findings")) for key in keys), keys
    lines = "\n".join(difference_lines(found))
    assert "System mean: 4.82" in lines
    assert "System over limit:" in lines


@pytest.mark.slow
def test_another_seed_is_within_the_error(tmp_path):
    """Another seed moves last digits of the drive, which are told as the error of the calculation."""
    found = difference(*(_report(tmp_path, f"s{seed}", EXAMPLE, seed=seed) for seed in (1, 2)))
    assert found.differing == []
    assert len(found.within_error) == 1
