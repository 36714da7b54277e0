"""What a row holds in memory between the stages: as many numbers as there are, and hardly anything beside them."""

import random
from dataclasses import replace
from functools import partial

import pytest
from held_bytes import held
from toleranced import plan, row, statistics_of_row

from flexlash.analysis.assessment import assess
from flexlash.analysis.computed import Spread
from flexlash.analysis.examination import Examined
from flexlash.analysis.run_result import outcome_of
from flexlash.analysis.spread_rows import SpreadRows
from flexlash.mechanics.flexspline import backlash
from flexlash.reading.read import Source, submission_of
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.validation.validate import validate

LIMITS = ReadingLimits()
STAGES = ("read", "validate", "assess", "spread", "outcome")
BETWEEN, RESULTS = 2000, 900
"""Bytes that a row of nine cells may hold before its Results are made, and in its Results."""


def _table(count):
    """Return a table of cups, none of which anything is to be said of but its spread."""
    draw, lines = random.Random(1), []  # noqa: S311
    for number in range(count):
        size = draw.uniform(40, 200)
        lengths = (size, size / 2, size * 0.01, size * 0.015, size * 0.25)
        cells = [f"V{number:06d}", "42CrMo4 (Q+T)", size**3 / 1e4, *lengths, draw.uniform(5, 9)]
        lines.append(",".join(cell if isinstance(cell, str) else f"{cell:.5g}" for cell in cells))
    keys = "variant,material,torque_Nm,cylinder_length_mm,mean_radius_mm,wall_thickness_mm,disk_thickness_mm"
    text = "\n".join([f"{keys},disk_inner_radius_mm,backlash_limit_arcmin", *lines])
    return Source(name="cups.csv", data=text.encode())


def _held_by_stage(count, measured):
    """Return how many bytes each stage of so many rows holds beyond the one before."""
    source = _table(count)
    submission, read = measured(lambda: submission_of(source, LIMITS))
    validated, typed = measured(lambda: validate(submission, LIMITS))
    nominal, numbers = measured(lambda: assess(validated, validated.settings))
    assert len(nominal.computed) == count
    first = next(iter(nominal.computed.values()))
    alike = row(partial(backlash, "cup"), first.variant.dimensions, first.limits, first.variant.backlash_limit)
    told = statistics_of_row(replace(alike, between=first.between), plan("line", 64))
    assert told.numbers.keys() >= {"within_lot_sd", "lots_failing_standard_error"}
    rows = SpreadRows.of((number, told) for number in nominal.computed)
    spread, spreading = measured(lambda: Spread(statistics=SpreadRows(rows.frame.clone())))
    examined = Examined(submission=submission, validated=validated, settings=validated.settings, nominal=nominal)
    _, outcome = measured(lambda: outcome_of(examined, spread))
    return dict(zip(STAGES, (read, typed, numbers, spreading, outcome), strict=True))


@pytest.mark.slow
def test_a_row_holds_little_more_than_its_numbers():
    """A thousand rows more hold at most 2,000 bytes a row between the stages, cells as read included."""
    _held_by_stage(3, partial(held, known=[]))
    few, many = (_held_by_stage(count, partial(held, known=[])) for count in (500, 1500))
    a_row = {stage: (many[stage] - few[stage]) / 1000 for stage in STAGES}
    assert a_row["outcome"] < RESULTS, a_row
    assert sum(a_row.values()) - a_row["outcome"] < BETWEEN, a_row
