"""`flexlash sweep`: a submission's variants over the values of one dimension or two."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from flexlash.analysis.options import TABLES
from flexlash.cli.click_types import SUBMISSION, option, planned, spread_options
from flexlash.cli.submissions import Attempt, Submissions
from flexlash.cli.terminal import progress
from flexlash.cli.vary_texts import sentence, varied
from flexlash.outputs.naming import sweep_output
from flexlash.outputs.plan import Output, Plan
from flexlash.schema.exit_codes import ExitCode
from flexlash.schema.findings import shown

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from flexlash.decisions.sweep import Study
    from flexlash.reading.read import Source
    from flexlash.reading.reading_limits import ReadingLimits
    from flexlash.schema.variant import Settings

__all__ = ["sweep"]

_SHOWN = 5
"""Most studies of which the screen says what they show."""


@click.command()
@SUBMISSION
@click.option(
    "--vary", multiple=True, metavar="NAME=FROM:TO:STEP",
    help= (
        "A dimension of Variants, by key or header, and its values, in the unit of its column; also NAME=V1,V2,… . "
        "Given twice: every combination of values. Default: the sheet Sweep."
    ),
)  # fmt: skip
@click.option("--variant", metavar="NAME", help="Sweep this variant alone. Default: every one that has the dimension.")
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="OUT",
    help="Report with a sheet Sweep (.xlsx), the points alone (.csv, .parquet, .json), or a folder. "
    "Default: <name>-sweep.xlsx beside the submission.",
)  # fmt: skip
@spread_options
@option("angle_unit")
def sweep(
    submission: Path,
    vary: tuple[str, ...],
    variant: str | None,
    output: Path | None,
    *,
    as_json: bool,
    quiet: bool,
    **options: Any,
) -> None:
    """Compute variants over the values of one dimension or two, and where the backlash crosses its limit.

    \b
    Examples:
      flexlash sweep study.xlsx --variant "case 3" --vary cylinder_length_mm=100:200:20
      flexlash sweep study.xlsx --vary disk_inner_radius_mm=40:60:2 --vary wall_thickness_mm=1.4,1.6,1.8 -o points.csv
    """  # noqa: D301
    values = varied(vary)
    if variant is not None and not values:
        raise click.UsageError("--variant needs --vary; without it the sheet Sweep says what is swept.")
    beside = [options[name] for name in TABLES if options[name]]
    target = planned(sweep_output, Plan(inputs=[submission, *beside]), submission, output)
    told = Submissions(several=False, as_json=as_json, quiet=quiet, ran=True)
    with told.one(submission) as attempt, progress(quiet=quiet or as_json) as advance:
        _carry_out(attempt, submission, target, values, variant, progress=advance, **options)
    sys.exit(told.code)


def _carry_out(
    attempt: Attempt,
    submission: Path,
    target: Output,
    values: dict[str, tuple[float, ...]],
    variant: str | None,
    **options: Any,
) -> None:
    """Compute and write the sweep, and fill in what is told of it; a usage error for what cannot be swept."""
    from flexlash.decisions.asked_sweep import SweepError
    from flexlash.pipeline import sweep as swept
    from flexlash.report.sweep_output import sweep_fields

    given = _given(submission, variant, options["limits"])
    try:
        attempt.outcome, studies = swept(given, target, vary=values or None, variant=variant, **options)
    except SweepError as fault:
        raise click.UsageError(sentence(f"Nothing is swept: {fault}")) from fault
    attempt.further = sweep_fields(studies)
    attempt.closing = list(_lines(studies, attempt.outcome.settings))
    attempt.codes = [_code_of(study) for study in studies]


def _given(submission: Path, variant: str | None, limits: ReadingLimits) -> Path | Source:
    """Return the submission; of a large table the rows of the variant alone."""
    from flexlash.reading.named_rows import excerpt_of_name
    from flexlash.reading.survey import LARGE_ROWS, is_large

    if not (submission.is_file() and is_large(submission, limits)):
        return submission
    if variant is None:
        raise click.UsageError(f"Of a table of more than {LARGE_ROWS:,} rows, name the variant to sweep: --variant.")
    found = excerpt_of_name(submission, variant, limits)
    if found is None:
        raise click.UsageError(f"Nothing is swept: there is no variant {shown(variant)}.")
    return found


def _code_of(study: Study) -> ExitCode:
    """Return the exit code of a study: that some of its points, or all, have no numbers."""
    missing = study.results["status"].eq("error").sum()
    if not missing:
        return ExitCode.FINE
    return ExitCode.NOTHING if missing == study.results.height else ExitCode.SOME_ROWS


def _lines(studies: Sequence[Study], settings: Settings) -> Iterator[str]:
    """Yield what the screen says of the studies."""
    from flexlash.report.wording.sweep_words import study_title, told_sentences

    for study in studies[:_SHOWN]:
        yield study_title(study)
        yield from (f"  {sentence}" for sentence in told_sentences(study, settings.target_percent, settings.angles))
    if len(studies) > _SHOWN:
        yield f"… and {len(studies) - _SHOWN:,} more studies; the output has all of them."
