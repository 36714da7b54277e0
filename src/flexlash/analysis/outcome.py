"""What came out of one submission: the record that the report and the command line draw on."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flexlash import __version__
from flexlash.analysis.computed import Computed
from flexlash.analysis.options import Options
from flexlash.analysis.whole_batch import WholeBatch, verdicts_of
from flexlash.reading.raw import Submission
from flexlash.schema.exit_codes import ExitCode
from flexlash.schema.findings import Finding, readable
from flexlash.schema.limit_verdict import VERDICTS
from flexlash.schema.variant import Settings
from flexlash.validation.validated import Blocked, Validated

if TYPE_CHECKING:
    import polars as pl

__all__ = ["Outcome", "Written", "exit_code_of"]


@dataclass(frozen=True, kw_only=True)
class Written:
    """What was written for a submission: the files in order, and sentences about what stood in their way.

    `marked_copy` is the one of them in which the findings are marked, `not_carried` what of the submission that copy
    could not take over, None where it holds the findings alone; `fault` says why it could not be written.
    """

    paths: tuple[Path, ...] = ()
    remarks: tuple[str, ...] = ()
    marked_copy: Path | None = None
    not_carried: tuple[str, ...] | None = ()
    fault: OSError | None = None


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What came out of one submission.

    `results` is the Results table; `findings` all findings in the order of the submission; `options` what was decided
    beside the settings. `computed` holds, by row number, what the report draws on, `blocked` what
    could not be computed. `skipped` says that flexlash itself
    wrote the file, or that it is a lock file. `processor_seconds` is how much computing reading and validation took.
    `whole` is the submission of which this outcome holds the worst rows alone, None where it holds all.
    """

    submission: Submission
    results: pl.DataFrame
    findings: tuple[Finding, ...]
    settings: Settings = field(default_factory=Settings)
    options: Options = field(default_factory=Options)
    validated: Validated | None = None
    computed: Mapping[int, Computed] = field(default_factory=dict)
    blocked: Blocked = field(default_factory=Blocked)
    skipped: bool = False
    processor_seconds: float = 0.0
    written: Written = field(default_factory=Written)
    whole: WholeBatch | None = None

    @property
    def outputs(self) -> tuple[Path, ...]:
        """The files that were written."""
        return self.written.paths

    @property
    def remarks(self) -> tuple[str, ...]:
        """What stood at the place of an output and was left alone, in sentences."""
        return self.written.remarks

    @property
    def fault(self) -> OSError | None:
        """Why the marked copy could not be written, None where it was or was not needed."""
        return self.written.fault

    @property
    def counts(self) -> dict[str, int]:
        """Submitted and computed rows, error and warning findings, variants with a limit by their verdict.

        They are those of the whole submission.
        """
        if self.whole is not None:
            rows, computed, levels = self.whole.rows, self.whole.computed, self.whole.levels
            verdicts = Counter(self.whole.verdicts)
        else:
            rows, computed = len(self.validated.submitted) if self.validated else 0, len(self.computed)
            levels = Counter(found.level for found in self.findings)
            verdicts = Counter(verdicts_of(self.results, self.settings.verdict_bounds)[0])
        return {
            "rows": rows,
            "computed": computed,
            "errors": levels["error"],
            "warnings": levels["warning"],
            **{verdict: verdicts[verdict] for verdict in VERDICTS},
        }

    def as_dictionary(self) -> dict[str, Any]:
        """Return what `--json` prints of it."""
        return {
            "submission": self.submission.name,
            "sha256": self.submission.sha256,
            "version": __version__,
            "seed": self.settings.seed,
            "method": self.settings.method,
            "counts": self.counts,
            "findings": [found.as_dictionary() for found in self.findings],
            "outputs": [readable(path) for path in self.outputs],
        }

    @property
    def exit_code(self) -> ExitCode:
        """With which code a command ends that computes this submission alone."""
        if self.fault is not None:
            return ExitCode.NO_FILE
        return exit_code_of(self.counts, fail_over_limit=self.options.fail_over_limit)


def exit_code_of(counts: Mapping[str, int], *, fail_over_limit: bool) -> ExitCode:
    """Return with which code a command ends for a submission of these counts whose files could all be written."""
    if not counts["computed"]:
        return ExitCode.NOTHING
    if counts["computed"] < counts["rows"] or counts["errors"]:
        return ExitCode.SOME_ROWS
    if fail_over_limit and counts["marginal"] + counts["fails"]:
        return ExitCode.OVER_LIMIT
    return ExitCode.FINE
