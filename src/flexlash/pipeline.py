"""The one natural way through: read → validate → nominal numbers → spread → elasticity check → outcome → report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flexlash.analysis.examination import Examined, examined, opened
from flexlash.analysis.options import Options
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.run_result import outcome_of
from flexlash.mechanics.elasticity import require_libraries
from flexlash.outputs.delivery import delivery
from flexlash.outputs.naming import FIXED, REPORTS, TABLES
from flexlash.outputs.plan import Output
from flexlash.reading.read import ReadReport, Source
from flexlash.reading.refusal import Refusal

if TYPE_CHECKING:
    import polars as pl

    from flexlash.decisions.sweep import Study
    from flexlash.feedback.fixing.fix import Fix

__all__ = ["Options", "Outcome", "check", "computed", "distribution", "fix", "levers", "run", "spread_out", "sweep"]


def check(submission: str | Path | Source | ReadReport, **options: Any) -> Outcome:
    """Return the outcome of validation and nominal calculation alone; nothing is sampled.

    Nothing is written but the marked copy, when `marked_copy` says where. Raises OSError when a file cannot be opened,
    ValueError for an output that cannot be meant. A file that is no submission gives an outcome whose only finding says
    why; of a marked copy that cannot be written, the outcome's `fault` does.
    """
    chosen = Options.of("check()", options)
    outputs = delivery(submission, chosen)
    outcome = outcome_of(examined(opened(submission, chosen), chosen))
    return outputs.reported(outcome)


def fix(
    submission: str | Path | Source | ReadReport, output: str | Path | Output, **options: Any
) -> tuple[Outcome, list[Fix]]:
    """Write a submission with the certain fixes made; return the outcome of checking that, and the fixes.

    Nothing is written when there is no certain fix. Options and errors are those of `check`; OSError also says that
    the file cannot be written.
    """
    from flexlash.feedback.returned_files import fixed

    chosen = Options.of("fix()", options)
    outputs = delivery(submission, chosen, output, FIXED)
    source = opened(submission, chosen)
    outputs.require()
    found = fixed(source, chosen)
    outcome = outputs.written(found.outcome, found.data if found.fixes else None, found.role)
    return outcome, list(found.fixes)


def run(
    submission: str | Path | Source | ReadReport, output: str | Path | Output | None = None, **options: Any
) -> Outcome:
    """Return the outcome of a submission and write it to `output`, unless that is None.

    Options are those of the command line: seed, method, samples, target_percent, cross_check, elasticity, strict, jobs,
    tolerances, materials, measurements, correlations, other_sources, samples_out, pictures, from_report. The output's
    ending decides its form: .xlsx, .csv, .parquet or .json.

    All rows are held at once, within `limits`; the command line computes a table of any size in chunks.

    A file at the place of an output is replaced only if flexlash wrote it and nobody has changed it since; else the
    output gets ` (2)`, and the outcome's `remarks` say so.

    Raises OSError when a file cannot be opened or written, ValueError for an output that cannot be meant, such as the
    submission itself, ModuleNotFoundError for elasticity without its libraries. Of a marked copy that cannot be
    written, the outcome's `fault` says why.
    """
    chosen = Options.of("run()", options)
    outputs = delivery(submission, chosen, output, REPORTS)
    source = opened(submission, chosen)
    outputs.require()
    return outputs.reported(computed(source, chosen))


def levers(
    submission: str | Path | Source | ReadReport, output: str | Path | Output | None = None, **options: Any
) -> tuple[Outcome, pl.DataFrame]:
    """Return the outcome of a submission and the table of single changes of its variants; write that to `output`.

    The table has the columns `LEVERS_TABLE`, variants with a limit in submitted order. The output ends in .csv,
    .parquet or .json; None writes nothing. Options and errors are those of `run`.
    """
    from flexlash.report.levers_output import ROLE, levers_bytes
    from flexlash.report.report_data import levers_of_variants

    chosen = Options.of("levers()", options)
    outputs = delivery(submission, chosen, output, TABLES)
    source = opened(submission, chosen)
    outputs.require()
    outcome = computed(source, chosen)
    table = levers_of_variants(outcome, list(outcome.computed))
    data = None
    if outputs.output is not None and outcome.computed:
        data = levers_bytes(outcome, table, outputs.output.ending)
    return outputs.written(outcome, data, ROLE), table


def distribution(
    submission: str | Path | Source | ReadReport,
    output: str | Path | Output,
    *,
    units: int | None = None,
    **options: Any,
) -> Outcome:
    """Return the outcome of a submission and write the distribution of its variants to `output`, for other programs.

    One that ends in .parquet has so many random `units` of each variant, 10,000 unless said, with their dimensions; one
    in .csv the percentiles of the backlash; one in .json these as metalogs, a library of the SIPmath 3.0 standard.
    Options and errors are those of `run`; ValueError for less than one unit or more than a million.
    """
    from flexlash.analysis.drawn_units import MOST_UNITS, UNITS
    from flexlash.report.distribution_output import ROLE, distribution_bytes
    from flexlash.schema.argument_checks import whole_number

    chosen = Options.of("distribution()", options)
    count = UNITS if units is None else whole_number("units", units, least=1, most=MOST_UNITS)
    outputs = delivery(submission, chosen, output, TABLES)
    source = opened(submission, chosen)
    outputs.require()
    outcome = computed(source, chosen)
    data = None
    if outputs.output is not None and outcome.computed:
        data = distribution_bytes(outcome, outputs.output.ending, count)
    return outputs.written(outcome, data, ROLE)


def sweep(
    submission: str | Path | Source | ReadReport,
    output: str | Path | Output | None = None,
    *,
    vary: Mapping[str, Sequence[float]] | None = None,
    variant: str | None = None,
    **options: Any,
) -> tuple[Outcome, list[Study]]:
    """Return the outcome of a submission and the studies that it asks for on its sheet Sweep, or that `vary` names.

    `vary` gives the values of one or two columns of Variants by their keys, in the units of these; the variant of that
    name is swept, or every one that can have them. An output that ends in .xlsx is the report with its sheet Sweep; one
    in .csv, .parquet or .json the points alone, and then the outcome holds the swept variants alone.

    Options and errors are those of `run`; SweepError, a ValueError, says what cannot be swept.
    """
    from flexlash.decisions.asked_sweep import asked_sweep, swept_alone, with_sweep
    from flexlash.decisions.sweep import sweeps_of
    from flexlash.report.output import outcome_bytes
    from flexlash.report.report_data import report_data
    from flexlash.report.sweep_output import sweep_bytes

    chosen = Options.of("sweep()", options)
    asked = None if vary is None else asked_sweep(vary, variant)
    outputs = delivery(submission, chosen, output, REPORTS)
    source = opened(submission, chosen)
    outputs.require()
    found = with_sweep(examined(source, chosen), asked)
    is_report = outputs.output is not None and outputs.output.ending == ".xlsx"
    outcome = spread_out(found if is_report else swept_alone(found), chosen)
    if is_report and outcome.computed:
        data = report_data(outcome)
        return outputs.written(outcome, *outcome_bytes(outcome, ".xlsx", data)), [*data.studies]
    studies = sweeps_of(outcome)
    if outputs.output is None or not studies:
        return outputs.written(outcome, None, ""), studies
    return outputs.written(outcome, *sweep_bytes(studies, outcome, outputs.output.ending)), studies


def computed(
    source: Source | ReadReport | Refusal, options: Options, tables: Mapping[str, Source] | None = None
) -> Outcome:
    """Return the outcome of a submission with the spread of its rows; `tables` as for `examined`."""
    return spread_out(examined(source, options, tables), options)


def spread_out(found: Examined, options: Options) -> Outcome:
    """Return the outcome of an examined submission with the spread of its rows."""
    options = options.completed(found.submission.run_with)
    if options.elasticity:
        require_libraries()
    spread = verified = None
    if found.nominal.computed:
        from flexlash.analysis.tolerance_spread import spread_of

        spread = spread_of(found.nominal.computed, found.settings, options)
    if found.nominal.computed and options.elasticity:
        from flexlash.analysis.verification import verified_by_elasticity

        verified = verified_by_elasticity(found, options)
    return outcome_of(found, spread, verified)
