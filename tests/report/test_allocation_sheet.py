"""The sheet Allocation shows the table of allocated tolerances, and sentences tell of it what the table holds."""

from __future__ import annotations

import polars as pl
import pytest
from report_entries import opened

from flexlash.decisions.allocation import allocation_of
from flexlash.report.allocation_sheet import ALLOCATED
from flexlash.report.report_data import no_allocation, report_data
from flexlash.report.wording.allocation_sentences import allocation_lines, class_tolerances
from flexlash.schema.decision_results import ALLOCATION
from flexlash.schema.entry_words import dimension_title

ROW = {
    "tolerance_class": "shop",
    "dimension": "wall_thickness",
    "unit": "mm",
    "from_value": 0.02,
    "to_value": 0.031,
    "grade_steps": 0.95,
    "relative_cost": -0.95,
    "limited_by": "long",
    "possible": "yes",
    "reason": None,
}


def _table(*changes):
    return pl.DataFrame([ROW | change for change in changes], schema=no_allocation().schema, orient="row")


@pytest.mark.slow
def test_the_sheet_has_the_table(study):
    """Every row of the table stands there in its order, with its numbers."""
    outcome, path = study
    frame = allocation_of(outcome.computed, outcome.settings, {}, outcome.options)
    sheet = opened(path)[ALLOCATED]
    labels = {column.label: column.key for column in ALLOCATION}
    header = next(row for row in sheet.iter_rows() if row[0].value == "Tolerance class")
    keys = [labels[cell.value] for cell in header]
    assert set(keys) == {"tolerance_class", *frame.columns}
    rows = list(sheet.iter_rows(min_row=header[0].row + 1, values_only=True))
    assert len(rows) == frame.height > 10
    for row, expected in zip(rows, frame.to_dicts(), strict=True):
        for key, value in zip(keys, row, strict=True):
            if key == "dimension":
                assert value == dimension_title(expected[key])
            elif key != "reason":
                wanted = expected[key]
                assert value == (pytest.approx(wanted, rel=1e-15) if isinstance(wanted, float) else wanted)


@pytest.mark.slow
def test_a_part_of_a_large_table_allocates_nothing(study):
    """Where an outcome holds the worst rows alone nothing is said of classes, whose other variants are missing."""
    outcome, _ = study
    assert report_data(outcome).allocation.height > 10
    from dataclasses import replace

    from flexlash.analysis.whole_batch import WholeBatch

    part = replace(outcome, whole=WholeBatch(rows=10**5, computed=10**5, results_file=""))
    assert report_data(part).allocation.is_empty()


def test_what_a_class_may_have_is_told():
    """A class that saves is told with what it may have, one that costs with what it needs, in µm and grades."""
    other = {"dimension": "bore_diameter", "unit": "IT grade", "from_value": 7.0, "to_value": 9.0, "grade_steps": 2.0}
    (line,) = allocation_lines(_table({}, other | {"relative_cost": -2.0}), 99.865, 9)
    assert line == (
        "Class shop may have bore diameter grade 9 instead of grade 7 and wall thickness ± 31 µm instead of ± 20 µm: "
        "that saves 2.95 in relative cost and keeps 99.865 % of units of every variant within."
    )
    (line,) = allocation_lines(_table({"to_value": 0.01, "grade_steps": -1.505, "relative_cost": 1.5}), 99.865, 9)
    assert line.startswith("Class shop needs wall thickness ± 10 µm instead of ± 20 µm to keep 99.865 %")
    assert line.endswith("that takes 1.5 in relative cost.")


def test_a_class_that_cannot_is_told():
    """A class of which some variants cannot be kept is told with them; one of which none can, with that alone."""
    reason = {"possible": "no", "reason": "even with the narrowest widths 12 % of units of long stay over the limit"}
    (line,) = allocation_lines(_table(reason), 99.0, 9)
    assert "99 % of units of every other variant within. Note: even with the narrowest widths 12 %" in line
    (line,) = allocation_lines(_table(reason | {"to_value": None, "relative_cost": None}), 99.0, 9)
    assert line == f"Class shop: no tolerances keep its variants within their limits: {reason['reason']}."


def test_the_summary_tells_of_the_class_that_changes_most():
    """On the Summary stands the class whose cost changes most, and how many more there are."""
    small = ROW | {"tolerance_class": "other", "relative_cost": -0.1}
    told = list(class_tolerances(_table(small, {}), 99.865))
    assert told[0].startswith("Class shop may have")
    assert told[1] == "1 more class is on the hidden sheet Allocation."
    assert list(class_tolerances(no_allocation(), 99.865)) == []
