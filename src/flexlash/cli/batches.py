"""What `run` and `check` do with the submissions that they are given: started, told in order, summed up."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import click

from flexlash.analysis.options import Options
from flexlash.batch.answer import Command
from flexlash.batch.ended import Ended
from flexlash.batch.executor import Executor
from flexlash.batch.given_files import GivenFiles
from flexlash.batch.manifest import MANIFEST_NAME, Manifest, options_digest
from flexlash.cli.submissions import Submissions
from flexlash.cli.terminal import Bar, complain, named
from flexlash.outputs.export_places import ExportPlaces
from flexlash.outputs.plan import Output
from flexlash.reading.read import Source
from flexlash.reading.refusal import Refusal
from flexlash.schema.exit_codes import ExitCode
from flexlash.schema.file_faults import reason

__all__ = ["Planned", "carried_out", "to_be_told", "workers"]


@dataclass(frozen=True, kw_only=True)
class Planned:
    """Where outputs go: report or fixed file, marked copy, samples and pictures of each submission, summary of all."""

    files: Mapping[Path, Output] = field(default_factory=dict)
    copies: Mapping[Path, Output] = field(default_factory=dict)
    exports: Mapping[Path, ExportPlaces] = field(default_factory=dict)
    summary: tuple[Output, Output] | None = None


def to_be_told(
    given: GivenFiles, *, recursive: bool, as_json: bool, quiet: bool, verbose: bool, ran: bool = False
) -> Submissions:
    """Return the submissions as they will be told, having said what of a folder is left alone.

    A folder has several, however many are in it.
    """
    several = len(given.files) > 1 or bool(given.folders)
    told = Submissions(several=several, as_json=as_json, quiet=quiet, ran=ran, verbose=verbose)
    for remark in () if quiet else given.remarks:
        click.echo(remark, err=True)
    if not given.submissions and not any(one.fault for one in given.files):
        where, more = (" or below it", "") if recursive else ("", "; --recursive also looks below it")
        for folder in given.folders:
            complain(
                f"{named(folder)}: there is no submission in this folder{where}, no workbook or table "
                f"(.xlsx, .xlsm, .csv, .tsv, .parquet) that flexlash did not write{more}."
            )
    return told


@contextmanager
def workers(jobs: int, scheduler: str | None = None) -> Iterator[Executor]:
    """Give the workers that compute: so many processes of this machine, or those of a Dask scheduler."""
    if scheduler is None:
        from flexlash.batch.local_executor import local_executor

        with local_executor(jobs) as executor:
            yield executor
        return
    from flexlash.batch.dask_executor import MissingDaskError, dask_executor

    with ExitStack() as stack:
        try:
            executor = stack.enter_context(dask_executor(scheduler, jobs))
        except (ValueError, MissingDaskError) as fault:
            raise click.UsageError(f"--scheduler: {fault}.".replace("..", ".")) from fault
        yield executor


def carried_out(
    command: Command,
    given: GivenFiles,
    planned: Planned,
    options: Options,
    told: Submissions,
    *,
    resume: bool = False,
    scheduler: str | None = None,
) -> ExitCode:
    """Compute, check or fix submissions side by side, write what is wanted, tell how each ended; return the code."""
    # Workers load their libraries while this process loads its own.
    with workers(_side_by_side(options, given.submissions), scheduler) as executor:
        from flexlash.batch.side_by_side import Batch, Wanted, side_by_side, tables_or_why

        tables = tables_or_why(options)
        what, is_brief = ("Computing", False) if told.ran else ("Checking", not told.several)
        bar = Bar(len(given.files), what, quiet=told.quiet or told.as_json or is_brief)
        with _manifest(planned, options, tables, resume=resume) as manifest:
            batch = Batch(
                command=command,
                options=options,
                wanted=[
                    Wanted(
                        given=one,
                        file=planned.files.get(one.path),
                        copy=planned.copies.get(one.path),
                        exports=planned.exports.get(one.path),
                    )
                    for one in given.files
                ],
                tables=tables,
                manifest=manifest,
                resume=resume,
                several=told.several,
                progress=bar.advance_rows,
            )
            all_ended = _told_in_order(side_by_side(batch, executor, bar.advance), told, bar)
    return _summed_up(all_ended, planned.summary, told)


def _side_by_side(options: Options, paths: Sequence[Path]) -> int:
    """Return how many workers there is something to do for."""
    if len(paths) < options.jobs:
        from flexlash.batch.side_by_side import large_tables

        return options.jobs if large_tables(options, paths) else max(1, len(paths))
    return options.jobs


@contextmanager
def _manifest(
    planned: Planned, options: Options, tables: Mapping[str, Source] | OSError | Refusal, *, resume: bool
) -> Iterator[Manifest | None]:
    """Give the manifest of a folder of outputs; say where it cannot be written, since then no later run can go on."""
    manifest, fault, place = None, None, Path(MANIFEST_NAME)
    if planned.summary is not None and not isinstance(tables, OSError | Refusal):
        place = planned.summary[0].path.with_name(MANIFEST_NAME)
        digest = options_digest(options, tables, marked=bool(planned.copies))
        try:
            manifest = Manifest(place.parent, digest, resume=resume)
        except OSError as refused:
            fault = refused
    try:
        yield manifest
    finally:
        if manifest is not None:
            manifest.close()
            fault = manifest.fault
        if fault is not None:
            why = f"{reason(fault)}; a later run cannot go on from here by --resume."
            click.echo(f"{named(place)} could not be written: {why}", err=True)


def _told_in_order(all_ended: Iterator[Ended], told: Submissions, bar: Bar) -> list[Ended]:
    """Tell how each submission ended, the bar being drawn below what is printed; return them all."""
    kept = []
    for ended in all_ended:
        bar.clear()
        told.tell(ended)
        bar.draw()
        kept.append(ended)
    bar.clear()
    return kept


def _summed_up(all_ended: Sequence[Ended], summary: tuple[Output, Output] | None, told: Submissions) -> ExitCode:
    """Write the summary where one is wanted, and say what came of all; return the code."""
    if summary is None:
        return told.end()
    from flexlash.batch.summary_workbook import SUMMARY, summary_lines_file, summary_workbook

    workbook, lines = summary
    written = []
    try:
        for output, data in (
            (workbook, summary_workbook(all_ended, workbook.path.parent)),
            (lines, summary_lines_file(all_ended)),
        ):
            file = output.write(data, SUMMARY)
            written.append(file.path)
            if file.remark:
                click.echo(click.style(file.remark, fg="yellow"), err=True)
    except OSError as fault:
        complain(f"{named(fault.filename)} could not be written: {reason(fault)}")
        told.further_codes.append(ExitCode.NO_FILE)
    return told.end(written)
