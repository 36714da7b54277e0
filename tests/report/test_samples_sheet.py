"""The Samples sheet shows what the measured parts tell, and stands only where something was measured."""

from __future__ import annotations

import pytest
from measured_parts import HEADERS, measured_rows, samples_of
from report_entries import opened

from flexlash.pipeline import run
from flexlash.report.samples_sheet import SAMPLES
from flexlash.schema.columns import columns_of

pytestmark = pytest.mark.slow


@pytest.fixture
def samples(book, sound, tmp_path):
    """Return a function that gives the rows of the sheet, as shown, in a report on these measurements."""

    def read(rows):
        label = {key: column.label for key, column in columns_of("Variants").items()}
        variant = sound | {"tolerance_class": "shop"}
        sheet = [[label[key] for key in variant], list(variant.values())]
        uses = samples_of(("shop", "wall_thickness", "wall"))
        path = book({"Variants": sheet, "Tolerances": uses, "Measurements": [HEADERS, *rows]})
        run(path, tmp_path / "report.xlsx", samples=64)
        return opened(tmp_path / "report.xlsx")[SAMPLES]

    return read


def _table(sheet, first="Sample"):
    """Return the rows below each header row of the sheet."""
    tables, heads = [], None
    for row in sheet.iter_rows(values_only=True):
        if row[0] == first:
            heads = row
            tables.append([])
        elif heads and row[0] is not None and row[1] is not None:
            tables[-1].append(list(row[: len(heads)]))
    return tables


def test_the_issues_wall(samples):
    """Sixty walls: n, mean, s, Cp, Cpk with their intervals, p and the class; then the pair measured together."""
    sheet = samples(measured_rows())
    (wall, disk), (pair,) = _table(sheet)
    assert wall[:4] == ["wall", "Wall thickness", "mm", 60]
    assert wall[4] == pytest.approx(1.607, rel=1e-12)
    assert wall[7:10] == pytest.approx([0.0041, 0.0034753, 0.0050006], rel=1e-4)
    assert wall[12:14] == [1.58, 1.62]
    # Cp and its interval are as s and its own: 0.04/(6 s).
    assert [f"{value:.2f}" for value in wall[14:20]] == ["1.63", "1.33", "1.92", "1.06", "0.85", "1.27"]
    assert wall[20] > 0.9
    assert wall[21] == "class shop, as normal; 1 variant"
    assert disk[1] == "Disk thickness"
    assert disk[12:20] == [None] * 8
    assert disk[21] == "no class"
    assert pair[:2] == ["wall", "Wall thickness"]
    assert pair[3] == 60
    assert pair[7] == "Disk thickness, of values"


def test_deviations_are_named(samples):
    """Where a sample holds deviations a column says so."""
    rows = [["wall", number, "deviation", row[3] - 1.6, None] for number, row in enumerate(measured_rows())]
    ((wall,),) = _table(samples(rows))
    assert wall[:5] == ["wall", "Wall thickness", "mm", "deviation", 60]
    assert wall[13:15] == [-0.02, 0.02]


def test_without_measurements_there_is_no_such_sheet(study):
    """A report on a submission without measured parts is as it was."""
    assert SAMPLES not in opened(study[1]).sheetnames
