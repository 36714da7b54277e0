"""How the numbers of Results are shown."""

from __future__ import annotations

import re

import openpyxl
import polars as pl
import pytest
import xlsxwriter

from flexlash.report.layout.result_formats import number_formats, usual_format
from flexlash.report.layout.styles import Book
from flexlash.schema.result_columns import result_columns

COLUMNS = {column.key: column for column in result_columns(cross_check=True, elasticity=True)}

USUAL = {
    "backlash_arcmin": "arcmin",
    "disk_share": "share",
    "stiffness_Nm_per_rad": "stiffness",
    "catalogue_size": "0",
    "catalogue_stiffness_Nm_per_rad": "count",
    "resonance_speed_rpm": "count",
    "spread_points": "count",
    "random_points": "count",
    "natural_frequency_Hz": "stress",
    "ppk": "plain",
}


@pytest.mark.parametrize("key", USUAL)
def test_whole_numbers_are_shown_whole(key):
    """Sizes, lines, points and speeds have no decimals; other numbers have those of their unit."""
    assert usual_format(COLUMNS[key]) == USUAL[key]


ERRORS = {7.07e-6: "0.0E+00", 3.3e-4: "0.00000", 0.0213: "0.000", 0.5: "0.00", 4.2: "0.0", 37.0: "0", 0.0: "0"}


def _formats(path, key, frame):
    """Return the number formats that cells of a column get."""
    with xlsxwriter.Workbook(path) as workbook:
        sheet = workbook.add_worksheet()
        for row, style in enumerate(number_formats(Book(workbook), pl.DataFrame(frame), COLUMNS[key])):
            sheet.write_number(row, 0, 0.0, style)
    return [cell.number_format for cell in openpyxl.load_workbook(path).worksheets[0]["A"]]


def test_standard_errors_have_two_digits(tmp_path):
    """A standard error is shown with two digits, never as zeros alone."""
    frame = {"mean_standard_error_arcmin": list(ERRORS)}
    assert _formats(tmp_path / "a.xlsx", "mean_standard_error_arcmin", frame) == list(ERRORS.values())


SHARES = (3e-11, 1 - 1e-9, 0.0, 1.0, 2e-6, 0.4)
BOUNDS = {"probability_over_limit_low": [share * 0.99 for share in SHARES],
          "probability_over_limit_high": [share * 1.01 for share in SHARES]}  # fmt: skip


def test_shares_near_none_or_all_read_well(tmp_path):
    """Within 1 ppm of none or all a share has four decimals of per cent and at most three of ppm."""
    formats = _formats(tmp_path / "a.xlsx", "probability_over_limit", {"probability_over_limit": SHARES, **BOUNDS})
    assert formats[:4] == ["0.0000%"] * 4
    assert formats[4:] == ["0.000000%", "0.0%"]
    parts = {key.replace("probability", "ppm"): [1e6 * one for one in values] for key, values in BOUNDS.items()}
    parts["ppm_over_limit"] = [1e6 * share for share in SHARES]
    formats = _formats(tmp_path / "b.xlsx", "ppm_over_limit", parts)
    assert formats[:4] == ["#,##0.0##"] * 4
    assert all(re.fullmatch(r"0(\.0+)?", one) for one in formats[4:])


NEEDED = {
    "ppk": [1.2345, 1.2345, None],
    "ppk_normal": [1.2345, 1.2345, None],
    "sd_arcmin": [0.05] * 3,
    "p50_arcmin": [3.7] * 3,
    "p99_865_arcmin": [3.85] * 3,
    "p50_standard_error_arcmin": [1e-7, 2e-4, 2e-4],
    "p99_865_standard_error_arcmin": [1e-7, 1.5e-3, 1.5e-3],
    "mean_standard_error_arcmin": [1e-7, 2e-4, 2e-4],
    "sd_standard_error_arcmin": [1e-7, 1e-3, 1e-3],
}


@pytest.mark.parametrize("key", ["ppk", "ppk_normal"])
def test_a_capability_is_known_as_its_percentiles_are(tmp_path, key):
    """Ppk has three decimals, or those that the errors of what it is worked out from leave: here 0.012 and 0.025."""
    assert _formats(tmp_path / "a.xlsx", key, NEEDED) == ["0.000", "0.00", "0.000"]


def test_other_estimates_are_shown_to_their_error(tmp_path):
    """A counted share, a difference from elasticity and a share of the variance have the digits that are known."""
    frame = {"random_probability_over_limit": [0.3, 0.0, None], "random_points": [16384.0] * 3}
    assert _formats(tmp_path / "a.xlsx", "random_probability_over_limit", frame) == ["0.0%", "0.00%", "0.00%"]
    frame = {"elasticity_difference_percent": [1.2345], "elasticity_error_percent": [0.02]}
    assert _formats(tmp_path / "b.xlsx", "elasticity_difference_percent", frame) == ["0.00"]
    assert usual_format(COLUMNS["main_contributor_share"]) == usual_format(COLUMNS["interaction_share"]) == "0.0%"
