"""A report alone → the submission it was made of, in a template of this version, and the report made anew."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flexlash.analysis.outcome import Outcome
from flexlash.comparison.difference import changed_results
from flexlash.comparison.sides import Name, by_variant, frame_rows, result_rows
from flexlash.outputs.naming import recreated_outputs
from flexlash.outputs.plan import Plan
from flexlash.pipeline import run
from flexlash.reading.limited_process import ask
from flexlash.reading.read import ReadReport, Source, limits_of_reports, report_of
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.schema.result_columns import result_columns

if TYPE_CHECKING:
    import polars as pl

__all__ = ["Recreation", "recreate"]


@dataclass(frozen=True, kw_only=True)
class Recreation:
    """What came of a report: the outcome, what the template could not take over, how many numbers are other ones.

    `numbers` is how many numbers of Results were compared, 0 when there were none to compare.
    """

    outcome: Outcome
    remarks: tuple[str, ...] = ()
    numbers: int = 0
    different: int = 0


def recreate(report: Path, output: Path | None, plan: Plan | None = None, **options: Any) -> Recreation:
    """Write the submission and the report anew; return what came of it.

    `output` is a folder, the new report's path, or None for the folder of the given one. Both take their places in a
    `plan`, where several reports are made anew. Raises OSError when a file cannot be opened or written.
    """
    limits = options.get("limits") or ReadingLimits()
    source = Source.at(report, limits)
    try:
        given: ReadReport | Source = ask(report_of, limits_of_reports(limits), source, limits)
    except Refusal:
        # Running it says why.
        given = source
    name = given.submission.name if isinstance(given, ReadReport) else source.name
    filled, anew = recreated_outputs(plan or Plan(inputs=[report]), report, output, name)
    filled.require()
    outcome = run(given, anew, from_report=True, **options)
    if not outcome.computed or not isinstance(given, ReadReport):
        return Recreation(outcome=outcome)
    from flexlash.feedback.template.upgrade import refilled

    upgrade = ask(refilled, limits_of_reports(limits), outcome.submission, limits)
    written = filled.write(upgrade.data, "recreated")
    all_written = replace(
        outcome.written,
        paths=(written.path, *outcome.outputs),
        remarks=(*outcome.remarks, *([written.remark] if written.remark else [])),
    )
    outcome = replace(outcome, written=all_written)
    anew_rows = frame_rows(_as_stored(outcome.results))
    numbers, different = _compared(by_variant(result_rows(given.results), anew_rows), anew_rows)
    return Recreation(outcome=outcome, remarks=upgrade.remarks, numbers=numbers, different=different)


def _as_stored(results: pl.DataFrame) -> pl.DataFrame:
    """Return a Results table with the digits that a report keeps of its numbers."""
    import polars as pl

    from flexlash.report.results_sheet import stored_values

    columns = {column.key: column for column in result_columns(cross_check=True, elasticity=True)}
    stored = {key: stored_values(results, columns[key]) for key in results.columns}
    return pl.DataFrame(stored, schema=results.schema)


def _compared(old: Mapping[Name, Mapping[str, Any]], new: Mapping[Name, Mapping[str, Any]]) -> tuple[int, int]:
    """Return how many numbers two Results hold, and how many of them differ."""
    numbers = different = 0
    for name in dict.fromkeys([*old, *new]):
        before, after = (rows.get(name, dict.fromkeys(other.get(name, {}))) for rows, other in ((old, new), (new, old)))
        numeric = {
            key for key in before.keys() | after.keys() for row in (before, after) if isinstance(row.get(key), float)
        }
        same_columns = before.keys() & after.keys()
        changed = {change.key for change in changed_results(before, after)} & numeric
        numbers += len(numeric)
        different += len(changed | (numeric - same_columns))
    return numbers, different
