"""Submissions with other sources, from the file to Results: the worked example, every method, what is withheld."""

from __future__ import annotations

import polars as pl
import pytest
from entry_books import entry_book
from whole_drives import CASE_3, EVERY_KIND, EXAMPLE, GRINDING

from flexlash.pipeline import check, run

SYSTEM = ("mean", "rss_high", "bender_high", "mean_shift_high", "worst_case_high", "p99_865")


def _book(path, *variants, sources=EXAMPLE, **sheets):
    return entry_book(path, variants=variants or [CASE_3], tolerances=GRINDING, other_sources=sources, **sheets)


@pytest.fixture
def example(tmp_path):
    """Return the worked example as a workbook."""
    return _book(tmp_path / "example.xlsx")


@pytest.mark.slow
def test_the_worked_example(example):
    """Case 3 ground makes 4.822′ on average, 5.281′ by RSS, 5.511′ by Bender, 5.531′ at most; its limit stays."""
    (row,) = run(example).results.iter_rows(named=True)
    found = {name: row[f"system_{name}_arcmin"] for name in SYSTEM}
    printed = {"mean": 4.822, "rss_high": 5.281, "bender_high": 5.511, "worst_case_high": 5.531}
    assert {name: found[name] for name in printed} == pytest.approx(printed, abs=1e-3)
    assert row["system_limit_arcmin"] == 5.3
    assert 3 * row["sd_arcmin"] == pytest.approx(0.1015, abs=2e-4)


@pytest.mark.slow
def test_every_method_finds_the_same(tmp_path):
    """Lines, Sobol' points and plain draws agree on tail and share over the limit within their errors."""
    path = _book(tmp_path / "a.xlsx", CASE_3 | {"system_limit_arcmin": 5.9}, sources=EVERY_KIND)
    names = ("system_p99_865_arcmin", "system_probability_over_limit")
    by_line, *others = (run(path, method=method).results for method in ("line", "sobol", "random"))
    for other in others:
        for name in names:
            error = f"{name.removesuffix('_arcmin')}_standard_error{'_arcmin' * name.endswith('_arcmin')}"
            reach = 4 * max(other[error].item(), by_line[error].item())
            assert abs(other[name].item() - by_line[name].item()) < reach, name
    assert 1e-4 < by_line["system_probability_over_limit"].item() < 0.9


@pytest.mark.slow
def test_neighbours_order_and_settings(tmp_path):
    """A variant's drive does not depend on other rows; η of Settings counts in the mean shift alone."""
    others = [CASE_3 | {"variant": f"V{torque}", "torque_Nm": torque} for torque in (300, 500, 700)]
    alone, among, shifted = (
        run(_book(tmp_path / f"{place}.xlsx", *rows, **sheets)).results.filter(pl.col("variant") == "B3-160 case 3")
        for place, (rows, sheets) in enumerate((
            ([CASE_3], {}),
            ([*others, CASE_3], {}),
            ([CASE_3], {"settings": [{"setting": "mean_shift_factor", "value": 1}]}),
        ))
    )  # fmt: skip
    assert alone.drop("findings").equals(among.drop("findings"))
    moved = [name for name in alone.columns if alone[name].to_list() != shifted[name].to_list()]
    assert moved == ["system_mean_shift_high_arcmin"]
    assert shifted["system_mean_shift_high_arcmin"].item() == pytest.approx(
        shifted["system_worst_case_high_arcmin"].item(), rel=1e-12
    )


@pytest.mark.slow
def test_a_faulty_source_leaves_no_budget(tmp_path):
    """With one source that cannot be read nothing of the drive is told, and everything of the variant."""
    broken = [*EXAMPLE, {"source": "play", "enter_as": "mm at radius", "lower_deviation": 0, "upper_deviation": 1}]
    outcome = run(_book(tmp_path / "a.xlsx", sources=broken))
    (row,) = outcome.results.iter_rows(named=True)
    assert row["mean_arcmin"] == pytest.approx(4.2137, abs=1e-3)
    told = [name for name in row if name.startswith("system_") and row[name] is not None]
    assert told == ["system_limit_arcmin"]
    assert not {"W470", "W471", "W472"} & {found.code for found in outcome.findings}


@pytest.mark.slow
def test_findings_of_system_limits(tmp_path):
    """A limit below the average is told by a check, one that too many drives exceed by a run, by target_percent."""
    rows = [CASE_3 | {"variant": str(limit), "system_limit_arcmin": limit} for limit in (4.7, 5.0, 5.3, 3.7)]
    path = _book(tmp_path / "a.xlsx", *rows)

    def told(outcome):
        return [(found.code, found.variant) for found in outcome.findings if found.code.startswith("W47")]

    assert sorted(told(check(path))) == [("W470", "3.7"), ("W470", "4.7"), ("W472", "3.7")]
    assert sorted(told(run(path))) == [("W470", "3.7"), ("W470", "4.7"), ("W471", "5.0"), ("W472", "3.7")]
    strict = _book(tmp_path / "b.xlsx", *rows, settings=[{"setting": "target_percent", "value": 99.99}])
    assert ("W471", "5.3") in told(run(strict))
