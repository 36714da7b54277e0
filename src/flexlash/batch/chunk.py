"""A chunk of a large table: what goes to a worker and what comes back; what it takes to compute is loaded there."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

from flexlash.analysis.drive_notes import DriveNotes
from flexlash.analysis.options import Options
from flexlash.analysis.run_summary import FindingGroup, SpreadNotes, by_rule
from flexlash.analysis.whole_batch import WholeBatch
from flexlash.batch.answer import Travelling
from flexlash.reading.read import Source
from flexlash.report.exported_file import ExportedFile
from flexlash.schema.cell_addresses import CellAddress
from flexlash.schema.findings import Finding, finding
from flexlash.schema.limit_verdict import Verdict
from flexlash.schema.variant import Settings
from flexlash.validation.blocking_errors import Waiting

__all__ = [
    "FIRST_CELLS",
    "FIRST_FINDINGS",
    "ChunkAnswer",
    "ChunkSummary",
    "ChunkTask",
    "ExportAnswer",
    "ExportTask",
    "FindingsTask",
    "PageTask",
    "ReportTask",
    "WorstRow",
    "blank_row",
    "compute_chunk",
    "export_worst",
    "list_findings",
    "page_of_large",
    "report_worst",
]

FIRST_FINDINGS = 1000
"""Most findings of a large table that are told one by one; a table beside its Results holds all of them."""

FIRST_CELLS = 200
"""Most cells of a rule that are told of a large table."""


@dataclass(frozen=True, kw_only=True)
class ChunkTask(Travelling):
    """Rows of a large table, as a table of their own under their true row numbers, and what is to be done with them.

    `tables` stand beside it, by the sheet that each replaces. `spread` says whether it is sampled; `ending` is that of
    the file of which the chunk's Results will be a part, empty where none is wanted. `passed_over` says that the rows
    stopped their process and are read, but not computed.
    """

    source: Source
    options: Options
    tables: Mapping[str, Source] = field(default_factory=dict)
    spread: bool = True
    ending: str = ""
    passed_over: bool = False


@dataclass(frozen=True, kw_only=True)
class WorstRow:
    """A computed row by its number in the table, with what it is ordered by; what is told of it where it is named."""

    share: float
    reach: float
    row: int
    told: Mapping[str, Any] | None = None

    @property
    def order(self) -> tuple[float, float, int]:
        """What sorts rows worst first, as `worst_rows` does."""
        return -self.share, -self.reach, self.row


@dataclass(frozen=True, kw_only=True)
class ChunkSummary:
    """What is counted and told of a chunk.

    `refusal` says why it is no readable submission, or is skipped; then there is nothing else. `columns` are those of
    its Results. `own` are the first findings at its rows, by `rules` and `groups` there are more; `before` and `after`
    are the findings of the whole file that come before and after those, without the sentence about the rows that wait
    for them: `waiting` are those of the chunk, of the sheet of this name, `all_wait` that all rows do. `to_fix` is at
    how many cells of its rows there are errors, `worst` are its worst rows.
    """

    rows: int = 0
    computed: int = 0
    refusal: Finding | None = None
    skipped: bool = False
    seed: int = 0
    method: str = ""
    target_percent: float = Settings.target_percent
    angle_unit: Literal["arcmin", "arcsec"] = "arcmin"
    columns: tuple[str, ...] = ()
    verdicts: Mapping[Verdict, int] = field(default_factory=dict)
    unsettled: Mapping[Verdict, int] = field(default_factory=dict)
    rules: Mapping[str, int] = field(default_factory=dict)
    groups: tuple[FindingGroup, ...] = ()
    before: tuple[Finding, ...] = ()
    own: tuple[Finding, ...] = ()
    after: tuple[Finding, ...] = ()
    to_fix: int = 0
    sheet: str = ""
    waiting: tuple[Waiting, ...] = ()
    all_wait: bool = False
    worst: tuple[WorstRow, ...] = ()
    drives: DriveNotes = field(default_factory=DriveNotes)
    notes: SpreadNotes = field(default_factory=SpreadNotes)
    cross_checked: bool = False

    def as_bytes(self) -> bytes:
        """Return the summary as JSON: it is kept on the disk, where anybody may change it."""
        return json.dumps(asdict(self), ensure_ascii=False).encode()

    @classmethod
    def of(cls, data: bytes) -> ChunkSummary:
        """Return the summary that `as_bytes` returned."""
        known = json.loads(data)
        known |= {key: tuple(Finding(**one) for one in known[key]) for key in ("before", "own", "after")}
        known["groups"] = tuple(
            FindingGroup(
                **one
                | {
                    "first": tuple(Finding(**found) for found in one["first"]),
                    "addresses": tuple(CellAddress(*address) for address in one["addresses"]),
                }
            )
            for one in known["groups"]
        )
        known["waiting"] = tuple(
            Waiting(**one | {"sources": [(sheet, row) for sheet, row in one["sources"]]}) for one in known["waiting"]
        )
        known["worst"] = tuple(WorstRow(**one) for one in known["worst"])
        known["columns"], known["notes"] = tuple(known["columns"]), SpreadNotes(**known["notes"])
        known["drives"] = DriveNotes(**known["drives"])
        known["refusal"] = known["refusal"] and Finding(**known["refusal"])
        return cls(**known)


@dataclass(frozen=True, kw_only=True)
class ChunkAnswer(Travelling):
    """What came of a chunk: its summary, its part of Results in the form that is wanted, its part of the findings.

    `tolerances` is its part of Tolerances used, where that form is JSON.
    """

    summary: bytes
    results: bytes = b""
    tolerances: bytes = b""
    findings: bytes = b""


@dataclass(frozen=True, kw_only=True)
class ReportTask(Travelling):
    """The worst rows of a large table, as a table of their own, for the report that stands for the whole."""

    source: Source
    options: Options
    tables: Mapping[str, Source]
    whole: WholeBatch


@dataclass(frozen=True, kw_only=True)
class ExportTask(ReportTask):
    """The same for samples or pictures, or both, of those rows."""

    samples: bool
    pictures: bool


@dataclass(frozen=True, kw_only=True)
class ExportAnswer(Travelling):
    """Samples and pictures of the worst rows, and what they hold in words."""

    files: tuple[ExportedFile, ...]
    notes: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class FindingsTask(Travelling):
    """The first findings of a large table of this name, for a workbook that lists them.

    `counted` says in words how many there are, `findings_file` names the table that holds all of them.
    """

    name: str
    findings: tuple[Finding, ...]
    counted: str
    findings_file: str
    macros: bool


@dataclass(frozen=True, kw_only=True)
class PageTask(Travelling):
    """What a page shows of a large table: its findings by rule, and its worst rows, as tables of their own.

    `cells` has the rows of the first findings of each rule, `worst` those that a report draws, None where no spread
    was computed. `state` says in words how far the table can be computed.
    """

    cells: Source
    worst: Source | None
    options: Options
    tables: Mapping[str, Source]
    whole: WholeBatch
    groups: tuple[FindingGroup, ...]
    findings: tuple[Finding, ...]
    cells_to_fix: int
    state: str


def compute_chunk(task: bytes) -> bytes:
    """Return what came of a chunk, both as bytes; the same bytes for the same bytes, and nothing is written."""
    from flexlash.batch.chunk_computing import answered

    return answered(ChunkTask.of(task)).as_bytes()


def report_worst(task: bytes) -> bytes:
    """Return the report of the worst rows of a large table."""
    from flexlash.batch.chunk_computing import report_of_worst

    return report_of_worst(ReportTask.of(task))


def export_worst(task: bytes) -> bytes:
    """Return samples and pictures of the worst rows of a large table."""
    from flexlash.batch.chunk_computing import exports_of_worst

    return exports_of_worst(ExportTask.of(task)).as_bytes()


def page_of_large(task: bytes) -> bytes:
    """Return what a page shows of a large table, as JSON."""
    from flexlash.batch.chunk_computing import page_made

    return page_made(PageTask.of(task))


def list_findings(task: bytes) -> bytes:
    """Return the workbook of the first findings of a large table."""
    from flexlash.batch.chunk_computing import findings_listed

    return findings_listed(FindingsTask.of(task))


def blank_row(row: int) -> tuple[ChunkSummary, bytes, bytes]:
    """Return what is said of a row that cannot even be read: a summary, its finding as in Results and as in a table."""
    from flexlash.report.findings_table import findings_rows

    found = finding("E334", sheet="Variants", cell=CellAddress(row=row, column=1))
    summary = ChunkSummary(rows=1, rules={found.code: 1}, groups=tuple(by_rule([found])), own=(found,), to_fix=1)
    return summary, f"{found.code} {found.cell}".encode(), findings_rows([found])
