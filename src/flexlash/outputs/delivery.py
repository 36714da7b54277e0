"""What one submission's run is to write, planned before anything is computed, and what came of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from flexlash.analysis.options import Options
from flexlash.analysis.outcome import Outcome, Written
from flexlash.outputs.export_places import ExportPlaces, export_folders, export_places
from flexlash.outputs.naming import WORKBOOK, named_output
from flexlash.outputs.plan import Output, Plan
from flexlash.reading.read import ReadReport, Source
from flexlash.schema.argument_checks import file_path

__all__ = ["Delivery", "delivery", "with_file"]


@dataclass(frozen=True, kw_only=True)
class Delivery:
    """Where the report, or the fixed submission, goes, where the marked copy, where samples and pictures.

    None for each that is not wanted.
    """

    output: Output | None
    copy: Output | None
    exports: ExportPlaces | None = None

    def require(self) -> None:
        """Raise OSError where it is known already that the report cannot be written; a copy may fail alone."""
        if self.output is not None:
            self.output.require()

    def written(self, outcome: Outcome, data: bytes | None, role: str) -> Outcome:
        """Return the outcome with what was written for it: these bytes, if any, and the marked copy where one helps."""
        written = Written()
        if self.output is not None and data is not None:
            written = with_file(written, self.output, data, role)
        return replace(outcome, written=self._marked(outcome, written))

    def reported(self, outcome: Outcome) -> Outcome:
        """Return the outcome with what was written for it, if a row was computed: all but a marked copy needs one."""
        if not outcome.computed:
            return self.written(outcome, None, "")
        data = None
        if self.output is not None and self.output.ending == ".xlsx":
            from flexlash.report.report_data import report_data

            data = report_data(outcome)
        file: tuple[bytes | None, str] = (None, "")
        if self.output is not None:
            from flexlash.report.output import outcome_bytes

            file = outcome_bytes(outcome, self.output.ending, data)
        done = self.written(outcome, *file)
        if self.exports is None:
            return done
        from flexlash.report.exports import exported_files

        files = exported_files(outcome, samples=self.exports.samples, pictures=self.exports.pictures, data=data)
        return replace(done, written=self.exports.written(done.written, files))

    def _marked(self, outcome: Outcome, written: Written) -> Written:
        """Write the marked copy, when there is something to mark; a failure loses nothing else."""
        if self.copy is None:
            return written
        from flexlash.feedback.returned_files import marked, worth_marking

        if not worth_marking(outcome):
            return written
        try:
            self.copy.require()
            data, not_carried = marked(outcome, outcome.options.limits, macros=self.copy.ending == ".xlsm")
            with_copy = with_file(written, self.copy, data, "checked")
        except OSError as fault:
            return replace(written, fault=fault)
        return replace(with_copy, marked_copy=with_copy.paths[-1], not_carried=not_carried)


def delivery(
    given: str | Path | Source | ReadReport,
    options: Options,
    output: str | Path | Output | None = None,
    endings: Sequence[str] = (),
) -> Delivery:
    """Return where the outputs of one submission go, none in the place of what is read.

    Raises ValueError for one that cannot be meant.
    """
    submission = given.path if isinstance(given, Source | ReadReport) else file_path("submission", given)
    plan = Plan(inputs=[*([] if submission is None else [submission]), *options.tables.values()])
    return Delivery(
        output=None if output is None else named_output(plan, output, endings),
        copy=None if options.marked_copy is None else named_output(plan, options.marked_copy, WORKBOOK),
        exports=_exports(given, options, output.plan if isinstance(output, Output) else plan),
    )


def _exports(given: str | Path | Source | ReadReport, options: Options, plan: Plan) -> ExportPlaces | None:
    """Return where samples and pictures go; those of a report are called like the submission that it carries."""
    if options.samples_out is None and options.pictures is None:
        return None
    named = given.submission if isinstance(given, ReadReport) else given
    name = named if isinstance(named, str | Path) else named.name
    samples, pictures = (None if folder is None else Path(folder) for folder in (options.samples_out, options.pictures))
    (places,) = export_places(plan, [Path(Path(name).name)], export_folders(samples, pictures))
    return places


def with_file(written: Written, output: Output, data: bytes, role: str) -> Written:
    """Write an output; return what was written before and this, with what was left alone in its place."""
    file = output.write(data, role)
    remarks = (file.remark,) if file.remark else ()
    return replace(written, paths=(*written.paths, file.path), remarks=(*written.remarks, *remarks))
