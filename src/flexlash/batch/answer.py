"""What travels: a submission with what is to be done with it, and what came of it. An answer loads nothing heavy."""

from __future__ import annotations

import pickle
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, Self

from flexlash.analysis.options import Options
from flexlash.feedback.fixing.fix import Fix
from flexlash.reading.inside_limits import Fault
from flexlash.reading.read import Source
from flexlash.report.exported_file import ExportedFile
from flexlash.schema.exit_codes import ExitCode
from flexlash.schema.findings import Finding
from flexlash.schema.number_words import share_words

__all__ = ["Answer", "Command", "FileBytes", "RuleTotal", "Stage", "Task", "Told", "Travelling", "WorstVariant"]

Command = Literal["check", "fix", "run"]

Stage = Literal["checking", "computing", "writing"]
"""What is being done with a submission: its cells are checked, its rows computed, its files written."""


@dataclass(frozen=True, kw_only=True)
class Travelling:
    """A record that goes from process to process as bytes."""

    def as_bytes(self) -> bytes:
        """Return the record as bytes."""
        return pickle.dumps(self, protocol=5)

    @classmethod
    def of(cls, data: bytes) -> Self:
        """Return the record that these bytes are; they come from a process of ours alone."""
        return pickle.loads(data)  # type: ignore[no-any-return]  # noqa: S301


@dataclass(frozen=True, kw_only=True)
class Task(Travelling):
    """A submission and what is to be done with it.

    `tables` stand beside it, by the sheet that each replaces. `report` is how the report's name ends, `copy` how the
    marked copy's does, each empty where none is wanted; `samples` and `pictures` say whether these are. With `pages` it
    is told how far it is, and the answer has what a page shows and offers.
    """

    command: Command
    source: Source
    options: Options
    tables: Mapping[str, Source] = field(default_factory=dict)
    report: str = ""
    copy: str = ""
    samples: bool = False
    pictures: bool = False
    pages: bool = False


@dataclass(frozen=True, kw_only=True)
class Told(Travelling):
    """What a task tells while it is worked on: so many of its rows are done.

    `rows` are those that are computed, 0 until they are known; they are done once their spread is there, files follow.
    `counts` are those of `--json`, and `page` is what a page shows of the findings, as JSON, each where it is new.
    """

    rows_done: int = 0
    rows: int = 0
    stage: Stage = "checking"
    counts: Mapping[str, int] = field(default_factory=dict)
    page: bytes = b""


@dataclass(frozen=True, kw_only=True)
class RuleTotal:
    """How often a rule is broken in a column of a sheet: at how many cells, and at which first.

    What has no cell counts as one. Sheet and column are as the findings name them: the former is a stranger's text.
    """

    level: str
    code: str
    sheet: str = ""
    column: str = ""
    cells: int = 1
    first: str = ""

    @classmethod
    def all_of(cls, findings: Iterable[Finding]) -> tuple[RuleTotal, ...]:
        """Return the totals of findings, worst level first, then by code, sheet and column."""
        places: dict[tuple[str, str, str, str], dict[str, None]] = defaultdict(dict)
        for found in findings:
            places[found.level, found.code, found.sheet, found.column][found.cell] = None
        return tuple(
            cls(level=key[0], code=key[1], sheet=key[2], column=key[3], cells=len(cells), first=next(iter(cells)))
            for key, cells in sorted(places.items())
        )


@dataclass(frozen=True, kw_only=True)
class FileBytes:
    """A file that is to be written: its bytes and what its stamp says it is.

    `not_carried` is what of the submission a marked copy could not take over, None where it holds the findings alone.
    """

    data: bytes
    role: str
    not_carried: tuple[str, ...] | None = ()


@dataclass(frozen=True, kw_only=True)
class WorstVariant:
    """A computed variant that is among the worst of its submission; angles in arcmin, None without a limit.

    `over_limit` says its probability in words, with its interval.
    """

    variant: str
    p99_865_arcmin: float
    backlash_limit_arcmin: float | None
    probability_over_limit: float | None
    over_limit: str = ""

    @classmethod
    def of(cls, row: Mapping[str, Any]) -> Self:
        """Return the variant of a row of Results."""
        limit = row["backlash_limit_arcmin"]
        return cls(
            variant=row["variant"],
            p99_865_arcmin=row["p99_865_arcmin"],
            backlash_limit_arcmin=limit,
            probability_over_limit=None if limit is None else row["probability_over_limit"],
            over_limit="" if limit is None else share_words(row),
        )


@dataclass(frozen=True, kw_only=True)
class Answer(Travelling):
    """What came of a submission.

    `told` is what `--json` prints of it but its outputs, `finding_lines` and `details` are lines for the screen,
    `words` how much was computed, `by_rule` the number of findings of each code. `file` is the report or the fixed
    submission, `exports` are the samples and pictures that were wanted. `refused` says that it is no readable
    submission, `skipped` that flexlash wrote it, `fault` that the program failed. `exit_code` is that of a command for
    this submission alone whose files could all be written.

    Where a page is wanted, `results` is Results as CSV, `fixed` the submission with the certain fixes, None where
    there are none, `page` what a page shows, as JSON (`report.page.shape.PageFacts`), and `rules` are the findings by
    rule and column.
    """

    exit_code: ExitCode
    told: Mapping[str, Any] = field(default_factory=dict)
    finding_lines: tuple[tuple[str, str], ...] = ()
    words: str = ""
    details: tuple[str, ...] = ()
    by_rule: Mapping[str, int] = field(default_factory=dict)
    worst: tuple[WorstVariant, ...] = ()
    file: FileBytes | None = None
    copy: FileBytes | None = None
    exports: tuple[ExportedFile, ...] = ()
    fixes: tuple[Fix, ...] | None = None
    refused: bool = False
    skipped: bool = False
    fault: Fault | None = None
    results: FileBytes | None = None
    fixed: FileBytes | None = None
    page: bytes = b""
    rules: tuple[RuleTotal, ...] = ()
