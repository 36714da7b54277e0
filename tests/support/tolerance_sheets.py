"""Sheets of Tolerances as rows by key, with what validation says of them."""

from __future__ import annotations

from typing import Any

from flexlash.reading.raw import RawSheet
from flexlash.schema.columns import columns_of
from flexlash.schema.variant import MeasuredDimension
from flexlash.validation.ledger import Ledger
from flexlash.validation.materials_and_classes import tolerance_classes_of
from flexlash.validation.measured_samples import Samples
from flexlash.validation.row_checks import check_cells
from flexlash.validation.typed_columns import tabulate

__all__ = ["GRADED", "MEASURED", "WALL", "based", "judged", "row", "sample", "told"]

KEYS = list(columns_of("Tolerances"))
WALL: dict[str, Any] = {
    "tolerance_class": "own",
    "dimension": "wall_thickness",
    "lower_deviation": -0.02,
    "upper_deviation": 0.02,
}
GRADED = {"tolerance_class": "own", "dimension": "wall_thickness", "grade": "IT9"}


def sample(name="Wall", dimension="wall_thickness", values=(1.603, 1.604, 1.605, 1.606, 1.607), *, deviations=False):
    """Return a sample of values in mm."""
    return MeasuredDimension(
        sample=name,
        dimension=dimension,
        values=tuple(value / 1e3 for value in values),
        parts=tuple(range(2, 2 + len(values))),
        are_deviations=deviations,
    )


MEASURED = {"wall": {"wall_thickness": sample()}}


def judged(*rows, measured=None, spoilt=()):
    """Return the classes of rows given by key, and the ledger; `spoilt` are samples and dimensions with faults."""
    cells = [KEYS, *([row.get(key) for key in KEYS] for row in rows)]
    raw = {
        number: {place: value for place, value in enumerate(row, start=1) if value is not None}
        for number, row in enumerate(cells, start=1)
    }
    ledger = Ledger("a.xlsx")
    table = tabulate(RawSheet(name="Tolerances", rows=raw), "Tolerances", ledger)
    check_cells(table, ledger)
    found = MEASURED if measured is None else measured
    names = {key: one.sample for key, of in found.items() for one in of.values()}
    samples = Samples(dimensions=found, names=names, faults=dict.fromkeys(spoilt, (2,)))
    return tolerance_classes_of(table, ledger, samples), ledger


def told(ledger):
    """Return code, column and row of the findings."""
    return [(found.code, found.column, found.row) for found in ledger.findings]


def row(name, dimension="wall_thickness", half=0.02, **rest):
    """Return a row of a class with a dimension within ± half."""
    return {"tolerance_class": name, "dimension": dimension, "lower_deviation": -half, "upper_deviation": half, **rest}


def based(name, base, **rest):
    """Return the row that says what a class is based on."""
    return {"tolerance_class": name, "based_on": base, **rest}
