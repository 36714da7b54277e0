"""The verdict of Trace spread: where any s is not the program's, that is said, whichever of them is greater."""

from __future__ import annotations

import io

import openpyxl
import pytest
from traced_spreads import spread_traced

from flexlash.pipeline import run
from flexlash.report.trace import scatter
from flexlash.report.trace.trace_spread import AGREES, DIFFERS
from flexlash.schema.units import ARCMIN

pytestmark = pytest.mark.slow


@pytest.fixture
def outcome(table, sound):
    """Return the outcome of one cup in class standard."""
    return run(table([sound]), samples=64)


def _wrong(factor):
    """Return rows of Tolerances used whose standard deviations are this much greater."""

    def rows(one):
        for row in used_rows(one):
            yield row | {"standard_deviation": row["standard_deviation"] * factor}

    used_rows = scatter.used_rows
    return rows


@pytest.mark.parametrize(("factor", "verdict"), [(1.0, AGREES), (1 + 1e-7, DIFFERS), (1 - 1e-7, DIFFERS)])
def test_a_standard_deviation_beside_the_programs_is_told(outcome, monkeypatch, factor, verdict):
    """A program's s that is a little greater or less than that of the formulas makes the verdict."""
    monkeypatch.setattr(scatter, "used_rows", _wrong(factor))
    assert spread_traced(outcome)[0]["verdict"].value == verdict


def test_the_engines_numbers_stand_beside_the_first_order(outcome):
    """Of the first variant, too, the sheet has the standard deviations that the engine found [arcmin]."""
    _, data = spread_traced(outcome)
    sheet = openpyxl.load_workbook(io.BytesIO(data), data_only=True)["Trace spread"]
    labels = {row[0].value: [cell.value for cell in row] for row in sheet.iter_rows()}
    (one,) = outcome.computed.values()
    for label, key in (("All units", "sd"), ("Parts within one lot", "within_lot_sd")):
        assert one.spread.numbers[key] / ARCMIN == pytest.approx(labels[label][11], rel=1e-12)


@pytest.mark.parametrize("side", [1, -1])
def test_a_process_outside_its_limits_is_added_up_as_any_other(table, sound, tmp_path, side):
    """Of a truncated normal whose mean lies outside the limits s after the cut is the program's at either side."""
    tolerances = tmp_path / "classes.csv"
    tolerances.write_text(
        "tolerance_class,dimension,lower_deviation,upper_deviation,deviation_unit,distribution,mean_shift,"
        f"standard_deviation\nstandard,wall_thickness,-0.02,0.02,mm,truncated normal,{side * 0.03},0.01\n",
        encoding="utf-8",
    )
    variant = {key: value for key, value in sound.items() if key != "tolerance_class"}
    assert spread_traced(run(table([variant]), samples=64, tolerances=tolerances))[0]["verdict"].value == AGREES
