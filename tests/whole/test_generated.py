"""Generated files are what the code generates."""

from __future__ import annotations

import pytest
import regenerate
from openpyxl.utils import get_column_letter

from flexlash.pipeline import check, run


@pytest.mark.slow
def test_no_generated_file_is_stale():
    """The template, the examples, the documents' tables and the page of findings are those of today's code."""
    assert list(regenerate.stale()) == []


@pytest.mark.slow
def test_needs_fixing_gives_exactly_its_findings():
    """The submission with twenty-four faults gives twenty-four findings, each with its code at its cell."""
    outcome = check(regenerate.ROOT / "data" / "needs-fixing.xlsx")
    columns = {column.key: place for place, column in enumerate(regenerate.VARIANTS)}
    expected = [
        (code, f"{get_column_letter(1 + columns[key])}{row}", f"fault {code}")
        for row, (code, key, _) in enumerate(regenerate.FAULTS, start=8)
    ]
    assert [(one.code, one.cell, one.variant) for one in outcome.findings] == expected
    assert outcome.exit_code == 3


@pytest.mark.slow
def test_needs_fixing_computes_its_sound_rows():
    """Rows without a fault are computed beside twenty-four that are not."""
    outcome = run(regenerate.ROOT / "data" / "needs-fixing.xlsx", samples=1024)
    status = dict(outcome.results.select("variant", "status").iter_rows())
    assert [name for name, one in status.items() if one != "error"] == ["sound cup", "sound bore", "sound cylinder"]
    assert outcome.results["p97_5_arcmin"].is_not_null().sum() == 3


@pytest.mark.slow
def test_the_catalogue_example_is_plausible():
    """Over thirty constructed variants over sizes 14 to 100 have proportions of real parts, and one limit too low."""
    outcome = check(regenerate.ROOT / "data" / "catalogue-sizes.xlsx")
    assert [(one.code, one.cell) for one in outcome.findings] == [("W423", "Y17")]
    assert outcome.counts["computed"] >= 30
    for one in outcome.computed.values():
        dimensions = one.variant.dimensions
        diameter = dimensions["bore_diameter"]
        assert 0.01 <= dimensions["wall_thickness"] / diameter <= 0.015
        assert 0.5 <= dimensions["cylinder_length"] / diameter <= 1.0
