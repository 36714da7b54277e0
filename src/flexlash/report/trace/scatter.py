"""The sheets Scatter and Tied: how the dimensions of each drawn variant scatter, and which of them scatter together.

One row for each dimension, or pair, of a variant, the variants in the order of Inputs. Numbers are in the unit of the
dimension's own column.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from flexlash.analysis.computed import Computed
from flexlash.analysis.tolerance_spread import first_orders
from flexlash.analysis.used_tolerances import used_rows
from flexlash.report.formula.stored import Stored
from flexlash.schema.columns import DIMENSIONS, Column
from flexlash.schema.entry_words import dimension_title
from flexlash.schema.units import ARCMIN
from flexlash.schema.variant import Limits
from flexlash.tolerance.row_batches import FirstOrder

__all__ = ["NUMBER", "SCATTER_NOTE", "TIED", "TIED_NOTE", "stored_scatter"]

SCATTER_NOTE = "How each dimension scatters, and the program's slope of the backlash, for the sheet Trace spread."
TIED_NOTE = "Which dimensions scatter together: Pearson's correlation of their values, for the sheet Trace spread."
NUMBER, TIED = "Variant number", "Correlation of the values"


def stored_scatter(variants: Sequence[Computed]) -> tuple[Stored, Stored]:
    """Return Scatter and Tied of variants in their order."""
    scatter: list[dict[str, Any]] = []
    tied: list[dict[str, Any]] = []
    for number, (one, first_order) in enumerate(zip(variants, first_orders(variants), strict=True), start=1):
        head = {NUMBER: float(number), "Variant": one.variant.name}
        scatter += ({**head, **row} for row in _rows_of(one, first_order))
        for first, second, correlation in first_order.ties:
            names = {"First": dimension_title(first), "Second": dimension_title(second)}
            tied.append({**head, **names, TIED: correlation})
    return Stored("Scatter", scatter), Stored("Tied", tied)


def _rows_of(one: Computed, first_order: FirstOrder) -> Iterator[dict[str, str | float | None]]:
    """Yield a row for each dimension of a variant that scatters or is shifted."""
    for used in used_rows(one):
        name = used["dimension"]
        column, limits, slope = DIMENSIONS[name], one.limits[name], first_order.slopes.get(name)
        unit = column.si_unit.si
        yield {
            "Dimension": dimension_title(name),
            "Unit": column.unit,
            "Lower limit": used["lower"],
            "Upper limit": used["upper"],
            "Distribution": used["distribution"],
            "Scatters between": used["scatters_between"],
            **_process(limits, used, column),
            "Standard deviation, program": used["standard_deviation"],
            "Slope, program [arcmin per unit]": None if slope is None else slope * unit / ARCMIN,
        }


def _process(limits: Limits, used: Mapping[str, Any], column: Column) -> dict[str, str | float | None]:
    """Return what mean and standard deviation follow from beside the limits."""
    unit, cut = column.si_unit.si, limits.cut or (-math.inf, math.inf)
    is_measured, given = limits.distribution == "measured", limits.sd
    sample = f"s of {limits.sample.sample}" if limits.sample else "s as given"
    return {
        "k": limits.sigma if "normal" in limits.distribution and given is None and used["distribution"] else None,
        "Mean above middle": limits.mean_shift / unit,
        "Process sd": used["standard_deviation"] if is_measured else given and given / unit,
        "Process sd in words": sample if given is not None or is_measured else None,
        "Cut below": None if is_measured or math.isinf(cut[0]) else cut[0] / unit,
        "Cut above": None if is_measured or math.isinf(cut[1]) else cut[1] / unit,
    }
