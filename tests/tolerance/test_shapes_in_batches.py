"""Rows whose inputs have any shape: in a batch each has the bits that it has alone, and the spread that points give."""

from __future__ import annotations

import numpy as np
import pytest
from toleranced import every_number, plan

from flexlash.tolerance import Lognormal, Measured, Student, Triangular, TruncatedNormal, propagate
from flexlash.tolerance.engine.line_direction import Inputs
from flexlash.tolerance.engine.line_statistics import line_statistics

SAMPLE = np.random.default_rng(2).gamma(4.0, 0.1, 40)
SIZES = np.linspace(0.5, 2.0, 5)


def inputs_of(size):
    """Return inputs whose shapes are the same for every size: measured deviations from the size, and others."""
    return {
        "a": Measured(SAMPLE, shift=40.0 * size),
        "b": Lognormal(mean=8.0 * size, sd=2.0 * size),
        "c": Student(mean=size, scale=0.25, degrees=6),
        "d": Triangular(low=0.0, high=4.0 * size, mode=size),
        "e": TruncatedNormal(mean=size, sd=0.5, low=size - 1.0, high=size + 0.25),
    }


def model(a, b, c, d, e):
    """Return an output that is not additive in its inputs."""
    return (a + d) * (1 + 0.05 * b) + c + e


ROWS = [inputs_of(size) for size in SIZES]


def told(rows, lines=256):
    """Return everything that so many lines tell of rows that are alike, by row."""

    def outputs(arguments, indices):
        del indices
        return model(**arguments)

    found = dict(line_statistics(outputs, Inputs.of(rows), np.full(len(rows), 70.0), plan("line", lines)))
    return [every_number(found[index]) for index in range(len(rows))]


def test_rows_alike_have_the_same_shapes():
    """Inputs that differ in location and scale alone have equal shapes, so that rows are spread together."""
    assert len({tuple(one.shape for one in row.values()) for row in ROWS}) == 1


@pytest.mark.slow
def test_any_batch_gives_the_same_bits():
    """Rows alone, in pairs and in another order have to the last bit the numbers of all of them together."""
    together = told(ROWS)
    assert [told([row])[0] for row in ROWS] == together
    assert told(ROWS[::-1])[::-1] == together
    assert told(ROWS[2:4]) == together[2:4]


@pytest.mark.slow
def test_a_row_has_the_spread_of_the_engine_alone():
    """Percentiles of a row are those of Sobol' points of the same inputs, within four standard errors."""
    numbers = told(ROWS[4:], 2048)[0][0]
    points = propagate(model, ROWS[4], method="sobol")
    for level, name in ((0.00135, "p0_135"), (0.025, "p2_5"), (0.5, "p50"), (0.975, "p97_5"), (0.99865, "p99_865")):
        error = np.hypot(numbers[f"{name}_standard_error"], float(points.standard_error(level)))
        assert numbers[name] == pytest.approx(float(points.quantile(level)), abs=4 * error)
