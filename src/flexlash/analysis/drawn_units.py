"""A computed variant → random units of it: the size of every dimension that scatters, and the backlash of each."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexlash.analysis.computed import Computed
from flexlash.analysis.options import Options
from flexlash.analysis.tolerance_spread import sampling_plan, toleranced_row
from flexlash.schema.arrays import Array
from flexlash.schema.variant import Settings
from flexlash.tolerance.row_batches import RowBatch

__all__ = ["BACKLASH", "MOST_UNITS", "UNITS", "drawn_units"]

BACKLASH = "backlash"
"""Name of the output among the columns of units."""

UNITS, MOST_UNITS = 10_000, 1_000_000
"""Units of each variant that are drawn where nothing else is wanted, and at most."""


def drawn_units(variant: Computed, settings: Settings, options: Options, count: int = UNITS) -> dict[str, Array]:
    """Return independent random units of a variant [SI]: each dimension that scatters and the backlash, (count,) each.

    Every unit is of a lot of its own. The seed of the run decides them; the same unit of another variant has the same
    place within the tolerances, so that variants can be compared unit by unit.
    """
    batch = RowBatch([toleranced_row(variant)])
    plan = replace(sampling_plan(settings, options), method="random", samples=count)
    inputs = batch.inputs[0]
    standards = plan.points("random").standards(inputs, batch.factor) if inputs else {}
    units = {
        name: inputs[name].location + inputs[name].scale * standard.ravel()[:count]
        for name, standard in standards.items()
    }
    outputs = batch.outputs_of(units, np.array([0]))
    return {**units, BACKLASH: np.array(np.broadcast_to(outputs, (count,)))}
