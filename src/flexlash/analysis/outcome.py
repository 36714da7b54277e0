"""What came out of one submission: the record that the report and the command line draw on."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flexlash import __version__
from flexlash.analysis.assessment import Computed
from flexlash.analysis.options import Options
from flexlash.reading.read import Submission
from flexlash.schema.exit_codes import ExitCode
from flexlash.schema.findings import Finding, readable
from flexlash.schema.limit_verdict import VERDICTS, limit_verdict
from flexlash.schema.variant import Settings
from flexlash.validation.validate import Validated

if TYPE_CHECKING:
    import polars as pl

    from flexlash.analysis.recommendations import Remedy
    from flexlash.mechanics.elasticity.twist import ElasticityCheck
    from flexlash.tolerance.distribution_curves import Curve

__all__ = ["DRAWN", "PICTURED", "Outcome"]

DRAWN = 500
"""Most variants that the report draws, worst first."""

PICTURED = 6
"""Most variants of which the report shows the half-section."""


@dataclass(kw_only=True)
class Outcome:
    """What came out of one submission.

    `results` is the Results table; `findings` all findings in the order of the submission; `outputs` the
    files written; `options` what was decided beside the settings.
    `computed` holds, by row number, what the report draws on.
    `curves` holds, by row number, the whole distribution of the variants that the report draws.
    `pictured` holds, by variant, the elasticity checks that the report draws.
    `remedies` say what would bring the worst failing variants within their limit.
    `skipped` says that flexlash itself wrote the file, or that it is a lock file; `marked_copy` is where its findings
    were marked, `not_carried` what of it that copy could not take over, None where it holds the findings alone, `fault`
    why it could not be written.
    `remarks` say what stood at the place of an output and was left alone.
    `processor_seconds` is how much computing it took to come this far.
    """

    submission: Submission
    results: pl.DataFrame
    findings: list[Finding]
    settings: Settings
    options: Options = field(default_factory=Options)
    validated: Validated | None = None
    computed: dict[int, Computed] = field(default_factory=dict)
    outputs: list[Path] = field(default_factory=list)
    curves: dict[int, Curve] = field(default_factory=dict)
    pictured: dict[str, ElasticityCheck] = field(default_factory=dict)
    remedies: list[Remedy] = field(default_factory=list)
    skipped: bool = False
    marked_copy: Path | None = None
    not_carried: tuple[str, ...] | None = ()
    fault: OSError | None = None
    remarks: list[str] = field(default_factory=list)
    processor_seconds: float = 0.0

    @property
    def counts(self) -> dict[str, int]:
        """Submitted and computed rows, error and warning findings, variants with a limit by their verdict."""
        levels = Counter(found.level for found in self.findings)
        verdicts = Counter(map(limit_verdict, self.results["probability_over_limit"]))
        return {
            "rows": len(self.validated.submitted) if self.validated else 0,
            "computed": len(self.computed),
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
        counts = self.counts
        if self.fault is not None:
            return ExitCode.NO_FILE
        if not self.computed:
            return ExitCode.NOTHING
        if counts["computed"] < counts["rows"] or counts["errors"]:
            return ExitCode.SOME_ROWS
        if self.options.fail_over_limit and counts["marginal"] + counts["fails"]:
            return ExitCode.OVER_LIMIT
        return ExitCode.FINE
