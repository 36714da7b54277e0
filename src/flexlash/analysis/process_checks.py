"""Processes beside limits that hang on a variant's size: those of grades, and of samples that hold sizes.

The others are judged where they stand, on Tolerances.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.process_verdict import is_usual_process, process_verdict
from flexlash.schema.variant import Limits, ToleranceRow, Variant
from flexlash.tolerance.dimension_limits import LimitArrays
from flexlash.validation.ledger import Ledger

__all__ = ["processes_are_usual", "report_processes"]


def _hangs_on_size(row: ToleranceRow) -> bool:
    """Whether a row's limits or its mean beside them are known only for a variant."""
    if row.distribution in {"uniform", "triangular"}:
        return False
    return bool(row.grade or (row.sample and (row.relative or not row.sample.are_deviations)))


def processes_are_usual(
    limits: Mapping[str, LimitArrays], rows: Sequence[ToleranceRow]
) -> npt.NDArray[np.bool_] | np.bool_:
    """Return of which variants alike `report_processes` has surely nothing to say."""
    usual: npt.NDArray[np.bool_] | np.bool_ = np.True_
    for row in rows:
        if row.dimension in limits and _hangs_on_size(row):
            one = limits[row.dimension]
            usual = usual & is_usual_process(one.low, one.high, one.mean, one.sd)
    return usual


def report_processes(
    ledger: Ledger, variant: Variant, rows: Sequence[ToleranceRow], limits: Mapping[str, Limits]
) -> None:
    """Record at a variant's dimensions which of its processes cannot be meant beside their limits."""
    for row in rows:
        limit = limits.get(row.dimension)
        if limit is None or not limit.low < limit.high or not _hangs_on_size(row):
            continue
        is_entered = row.sd is not None
        verdict = process_verdict(limit.low, limit.high, limit.mean, limit.standard_deviation, is_entered=is_entered)
        if verdict:
            column = DIMENSIONS[row.dimension]
            key = column.key if column.sheet == "Variants" else "material"
            value = f"{variant.dimensions[row.dimension] / column.si_unit.si:.10g}"
            words = f"in class {variant.tolerance_class} {verdict.words}"
            ledger.add_at(verdict.code, variant, key, name=column.name, value=value, detail=words)
