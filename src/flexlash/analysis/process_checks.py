"""Processes beside limits that hang on a variant's size: those of grades, and of samples that hold sizes.

The others are judged where they stand, on Tolerances.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.findings import shown
from flexlash.schema.process_verdict import ProcessVerdict, is_usual_process, process_verdict
from flexlash.schema.spellings import plain
from flexlash.schema.variant import Limits, ToleranceRow, Variant
from flexlash.tolerance.limit_arrays import LimitArrays
from flexlash.validation.ledger import Ledger
from flexlash.validation.process_entries import BLAMED
from flexlash.validation.validated import Table, Validated

__all__ = ["processes_are_usual", "report_processes"]


def processes_are_usual(
    limits: Mapping[str, LimitArrays], rows: Sequence[ToleranceRow]
) -> npt.NDArray[np.bool_] | np.bool_:
    """Return of which variants alike `report_processes` has surely nothing to say."""
    usual: npt.NDArray[np.bool_] | np.bool_ = np.True_
    for row in rows:
        if row.dimension in limits and row.has_process and row.waits_for_size:
            one = limits[row.dimension]
            usual = usual & is_usual_process(one.low, one.high, one.mean, one.sd) & (row.cpk is None)
    return usual


def report_processes(
    ledger: Ledger, variant: Variant, validated: Validated, rows: Sequence[ToleranceRow], limits: Mapping[str, Limits]
) -> None:
    """Record which of a variant's processes cannot be meant beside their limits.

    What a row of Tolerances says of a process is told there, once, of the first variant that shows it; values that were
    measured at the dimension of each variant, whose size may as well be wrong.
    """
    for row in rows:
        limit = limits.get(row.dimension)
        if limit is None or not (limit.low < limit.high and row.has_process and row.waits_for_size):
            continue
        sd = limit.standard_deviation
        verdict = process_verdict(
            limit.low,
            limit.high,
            limit.mean,
            sd,
            is_entered=row.sd is not None,
            cpk=row.cpk,
            is_truncated=row.distribution == "truncated normal",
        )
        if verdict and (row.sample or validated.tolerances is None):
            _report_at_variant(ledger, variant, row, verdict)
        elif verdict and validated.tolerances:
            _report_at_row(ledger, variant, validated.tolerances, row, verdict)


def _report_at_variant(ledger: Ledger, variant: Variant, row: ToleranceRow, verdict: ProcessVerdict) -> None:
    column = DIMENSIONS[row.dimension]
    value = f"{variant.dimensions[row.dimension] / column.si_unit.si:.10g}"
    words = f"in class {variant.tolerance_class} {verdict.words}"
    ledger.add_at(verdict.code, variant, column.variant_key, name=column.name, value=value, detail=words)


def _report_at_row(ledger: Ledger, variant: Variant, table: Table, row: ToleranceRow, verdict: ProcessVerdict) -> None:
    """Record a process at the cell of Tolerances that tells it, unless it is told; an error holds the variant."""
    key = next((key for key in BLAMED[verdict.blamed] if table.entered(row.row, key) != ""), "dimension")
    if verdict.code[0] == "E":
        ledger.hold("class", plain(variant.tolerance_class), table.sheet, row.row, variant.row)
    place = (verdict.code, table.sheet, str(table.address(row.row, key)))
    if place not in ledger.told:
        words = f"for variant {shown(variant.name)} {verdict.words}"
        ledger.add_in(table, verdict.code, row.row, key, value=table.entered(row.row, key), detail=words)
