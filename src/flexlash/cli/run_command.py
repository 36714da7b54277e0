"""`flexlash run`: the tolerance spread of submissions, and the reports."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from flexlash.analysis.options import TABLES, Options
from flexlash.batch.given_files import GivenFiles, given_files
from flexlash.cli.batches import Planned, carried_out, to_be_told
from flexlash.cli.click_types import JSON, LIMITS, QUIET, RECURSIVE, SUBMISSIONS, VERBOSE, option, planned
from flexlash.outputs.export_places import export_folders, export_places
from flexlash.outputs.naming import marked_outputs, report_outputs, summary_outputs
from flexlash.outputs.plan import Plan

__all__ = ["run"]


@click.command()
@SUBMISSIONS
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="OUT",
    help="Report (.xlsx), Results alone (.csv, .parquet, .json), or a folder. "
    "Default: <name>-report.xlsx beside the submission.",
)  # fmt: skip
@option("seed")
@option("method")
@option("samples")
@option("target_percent")
@option("angle_unit")
@option("cross_check")
@option("elasticity")
@option("jobs", default=os.cpu_count() or 1, show_default="all cores")
@option("samples_out", metavar="FOLDER")
@option("pictures", metavar="FOLDER")
@option("strict")
@option("fail_over_limit")
@LIMITS
@RECURSIVE
@click.option(
    "--resume", is_flag=True, help="Continue in the folder OUT where an earlier run was stopped; what is done is kept."
)
@click.option(
    "--scheduler", metavar="ADDRESS",
    help="Compute on the workers of a Dask scheduler, such as tcp://10.0.0.1:8786; local starts one here.",
)  # fmt: skip
@JSON
@option("from_report")
@QUIET
@VERBOSE
@click.option(
    "--annotate/--no-annotate", default=True, show_default=True,
    help="Write <name>-checked.xlsx, your file with the cells to fix marked, when there are errors or warnings.",
)  # fmt: skip
@option("marked_copies")
@option("tolerances")
@option("materials")
@option("measurements")
@option("correlations")
@option("other_sources")
def run(
    submissions: tuple[Path, ...],
    output: Path | None,
    *,
    annotate: bool,
    from_report: bool,
    recursive: bool,
    resume: bool,
    scheduler: str | None,
    as_json: bool,
    quiet: bool,
    verbose: bool,
    **options: Any,
) -> None:
    """Validate, compute the tolerance spread, write the report.

    Of a folder that is done with each workbook and table in it.
    """
    from flexlash.mechanics.elasticity import MISSING, is_available
    from flexlash.report.pictures import raster

    if options["elasticity"] and not is_available():
        raise click.UsageError(MISSING)
    if options["pictures"] and not raster.is_available() and not quiet:
        click.echo(raster.MISSING, err=True)
    beside = [options[name] for name in TABLES if options[name]]
    if from_report:
        from flexlash.cli.recreate_command import recreate_all

        planned(report_outputs, Plan(inputs=[*submissions, *beside]), submissions, output)
        planned(export_folders, options["samples_out"], options["pictures"])
        sys.exit(recreate_all(submissions, output, as_json=as_json, quiet=quiet, **options))
    given = given_files(
        submissions,
        recursive=recursive,
        output=output,
        beside=beside,
        marked_copies=options["marked_copies"],
    )
    outputs = _outputs(given, beside, output, options, annotate=annotate)
    if resume and outputs.summary is None and (given.folders or len(given.files) > 1):
        raise click.UsageError("--resume needs a folder as OUT, in which an earlier run was stopped.")
    told = to_be_told(given, recursive=recursive, as_json=as_json, quiet=quiet, verbose=verbose, ran=True)
    chosen = Options.of("run()", options)
    sys.exit(carried_out("run", given, outputs, chosen, told, resume=resume, scheduler=scheduler))


def _outputs(
    given: GivenFiles, beside: list[Path], output: Path | None, options: Mapping[str, Any], *, annotate: bool
) -> Planned:
    """Return where reports, marked copies, samples, pictures and the summary go."""
    paths, below = given.submissions, given.sub_folders
    plan = Plan(inputs=[*paths, *beside], submissions=paths, marked_copies=options["marked_copies"])
    summary = planned(summary_outputs, plan, output)
    reports = planned(report_outputs, plan, paths, output, below=below)
    copies = planned(marked_outputs, plan, paths, output, below=below) if annotate else []
    folders = planned(export_folders, options["samples_out"], options["pictures"])
    exports = export_places(plan, paths, folders, below) if folders else []
    return Planned(
        files=dict(zip(paths, reports, strict=False)),
        copies=dict(zip(paths, copies, strict=False)),
        exports=dict(zip(paths, exports, strict=False)),
        summary=summary,
    )
