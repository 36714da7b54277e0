"""What is written of a large table once its chunks are there: all Results, all findings, the report of the worst.

They are joined from parts on the disk, since a million rows do not fit in memory.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import BinaryIO

from flexlash.analysis.options import Options
from flexlash.analysis.outcome import Written
from flexlash.analysis.run_summary import counted
from flexlash.batch.chunk import (
    ExportAnswer,
    ExportTask,
    FindingsTask,
    PageTask,
    ReportTask,
    export_worst,
    list_findings,
    page_of_large,
    report_worst,
)
from flexlash.batch.chunk_totals import Totals
from flexlash.batch.executor import Executor
from flexlash.outputs.export_places import ExportPlaces
from flexlash.outputs.plan import Output, WrittenFile
from flexlash.outputs.working_folder import Parts, WorkingFolder
from flexlash.outputs.writing import Filling
from flexlash.reading.products import CHECKED_NAME, REPORT_NAME, made_of
from flexlash.reading.read import Source

__all__ = ["Files", "LargeOutputs"]

_RESULTS, _FINDINGS = "-results", "-findings"
"""What is put behind the name of a large table for what its report has no room for."""


@dataclass(frozen=True, kw_only=True)
class Files:
    """What was written: the report, the file of all Results where that is another, all findings, their workbook.

    `exported` are samples and pictures, of which `notes` say what they hold.
    """

    report: WrittenFile | None = None
    results: WrittenFile | None = None
    findings: WrittenFile | None = None
    copy: WrittenFile | None = None
    exported: Written = field(default_factory=Written)
    notes: tuple[str, ...] = ()
    fault: OSError | None = None

    def told(self) -> Written:
        """Return the files in order, and sentences about what stood in their way."""
        files = [file for file in (self.report, self.results, self.findings, self.copy) if file is not None]
        return Written(
            paths=(*(file.path for file in files), *self.exported.paths),
            remarks=(*(file.remark for file in files if file.remark), *self.exported.remarks),
            marked_copy=self.copy.path if self.copy else None,
            not_carried=None if self.copy else (),
            fault=self.fault or self.exported.fault,
        )


@dataclass(frozen=True, kw_only=True)
class LargeOutputs:
    """What came of a large table of this name, and what is wanted of it.

    `parts` are what came of its chunks, in order, in the working `folder`, and `totals` all of them together. `report`
    and `copy` are where the report and the workbook of findings go, `exports` where samples and pictures; `ending` is
    how the file of all Results ends.
    `source` gives the excerpt of some rows, which workers turn into the report, with these `options` and `tables`.
    """

    name: str
    ran: bool
    options: Options
    tables: Mapping[str, Source]
    report: Output | None
    copy: Output | None
    exports: ExportPlaces | None
    ending: str
    totals: Totals
    parts: Sequence[Parts]
    folder: WorkingFolder | None
    source: Callable[[Sequence[int]], Source]
    executor: Executor

    def written(self) -> Files:
        """Write what is wanted of a table that was computed; the report last, since it names the others.

        The rows that the report shows are asked for first: where that refuses the file, nothing is written.
        """
        report, copy, totals = self.report, self.copy, self.totals
        is_computed = self.folder is not None and report is not None and self.ran and bool(totals.computed)
        is_apart = is_computed and report is not None and report.ending != self.ending
        needs_worst = is_apart or (is_computed and self.exports is not None)
        worst = self.source(sorted(one.row for one in totals.worst)) if needs_worst else None
        files = Files()
        if self.folder is not None and report is not None and is_computed:
            results = report if report.ending == self.ending else self._beside(_RESULTS, self.ending)
            if results is not None:
                files = replace(files, results=results.write(self._all_results(self.folder), "results"))
        if self.folder is not None and totals.rules and (beside := self._beside(_FINDINGS, ".csv")) is not None:
            files = replace(files, findings=beside.write(self._all_findings()))
        if report is not None and worst is not None and is_apart:
            files = replace(files, report=report.write(self._report(worst, files), "report"))
        if self.exports is not None and worst is not None:
            exported = self._exported(worst, self.exports)
            files = replace(files, exported=self.exports.written(Written(), exported.files), notes=exported.notes)
        levels = totals.whole().levels
        if copy is None or not levels["error"] + levels["warning"]:
            return files
        try:
            copy.require()
            return replace(files, copy=copy.write(self._listed(files, copy), "checked"))
        except OSError as fault:
            return replace(files, fault=fault)

    def page(self, files: Files) -> bytes:
        """Return what a page shows of the table, as JSON, with the names of the files that were written."""
        totals = self.totals
        names = [file.path.name if file else "" for file in (files.results or files.report, files.findings)]
        worst = sorted(one.row for one in totals.worst) if self.ran and totals.computed else []
        task = PageTask(
            cells=self.source(totals.first_rows),
            worst=self.source(worst) if worst else None,
            options=self.options,
            tables=self.tables,
            whole=totals.whole(*names),
            groups=tuple(totals.groups),
            findings=tuple(totals.findings),
            cells_to_fix=totals.cells_to_fix,
            state=totals.state_words(ran=self.ran),
        )
        return self.executor.submit(page_of_large, task.as_bytes()).result()

    def _beside(self, what: str, ending: str) -> Output | None:
        """Return a place beside the report, or beside the workbook of findings, under its name."""
        output, name = (self.report, REPORT_NAME) if self.report else (self.copy, CHECKED_NAME)
        if output is None:
            return None
        return output.plan.claim(output.path.with_name(f"{made_of(output.wanted, name)}{what}{ending}"))

    def _all_findings(self) -> Filling:
        """Return what writes all findings as a table, in the order of the submission."""
        from flexlash.report.findings_table import findings_header, findings_rows

        def fill(file: BinaryIO) -> None:
            file.write(findings_header())
            file.write(findings_rows([*self.totals.before]))
            for part in self.parts:
                if "findings" in part:
                    with part["findings"].open("rb") as rows:
                        shutil.copyfileobj(rows, file)
            file.write(findings_rows([*self.totals.after]))

        return fill

    def _all_results(self, folder: WorkingFolder) -> Filling:
        """Return what writes all Results, joined from their parts."""
        from flexlash.report.results_pieces import blank_piece, joined

        pieces = []
        for number, part in enumerate(self.parts):
            if "blank" in part:
                known = {"variant": "", "status": "error", "findings": part["blank"].read_text()}
                pieces.append(folder.put(f"blank-{number}.part", blank_piece(known, self.totals.columns, self.ending)))
            elif "results" in part:
                pieces.append(part["results"])
        model = next(part["results"] for part in self.parts if "results" in part)
        findings = [found.as_dictionary() for found in self.totals.findings]
        further = {"findings": findings, "findings_by_rule": dict(sorted(self.totals.rules.items()))}
        used = [part["tolerances"] for part in self.parts if "tolerances" in part]
        return joined(self.ending, pieces, model, self.totals.columns, used=used, further=further)

    def _report(self, worst: Source, files: Files) -> bytes:
        """Return the report of the worst rows."""
        names = [file.path.name if file else "" for file in (files.results, files.findings)]
        task = ReportTask(
            source=worst,
            options=self.options,
            tables=self.tables,
            whole=self.totals.whole(*names),
        )
        return self.executor.submit(report_worst, task.as_bytes()).result()

    def _exported(self, worst: Source, places: ExportPlaces) -> ExportAnswer:
        """Return samples and pictures of the worst rows."""
        task = ExportTask(
            source=worst,
            options=self.options,
            tables=self.tables,
            whole=self.totals.whole(),
            samples=places.samples,
            pictures=places.pictures,
        )
        return ExportAnswer.of(self.executor.submit(export_worst, task.as_bytes()).result())

    def _listed(self, files: Files, copy: Output) -> bytes:
        """Return the first findings as a workbook that says where the rest is."""
        levels = self.totals.whole().levels
        task = FindingsTask(
            name=self.name,
            findings=tuple(self.totals.findings),
            counted=", ".join(counted(levels[level], level) for level in ("error", "warning") if levels[level]),
            findings_file=files.findings.path.name if files.findings else "",
            macros=copy.ending == ".xlsm",
        )
        return self.executor.submit(list_findings, task.as_bytes()).result()
