"""What the caller of a run decides."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flexlash.submission.reading.limits import ReadingLimits

if TYPE_CHECKING:
    from flexlash.outputs.plan import Output

__all__ = ["Options", "Progress"]

Progress = Callable[[int, int], None]
"""Called with how many steps are done, and of how many."""


@dataclass(frozen=True, kw_only=True)
class Options:
    """What the caller decides; None leaves it to the submission's settings.

    `marked_copy` is where the submission goes with its errors and warnings marked, when there are any;
    `marked_copies` takes such copies as submissions as well. `given` are the submissions that are given together: a
    mended one is skipped when its original is among them. `fail_over_limit` gives an exit code of its own where a
    variant does not meet its limit. `from_report` says that the file is a report, of whose
    submission everything is computed anew; what is None is then as it was in that run.
    """

    seed: int | None = None
    method: str | None = None
    samples: int | None = None
    strict: bool | None = None
    fail_over_limit: bool = False
    cross_check: bool | None = None
    elasticity: bool | None = None
    jobs: int = 1
    tolerances: str | Path | None = None
    materials: str | Path | None = None
    limits: ReadingLimits = field(default_factory=ReadingLimits)
    marked_copy: str | Path | Output | None = None
    marked_copies: bool = False
    given: Sequence[Path] = ()
    from_report: bool = False
    progress: Progress | None = None

    def __post_init__(self) -> None:
        if self.from_report and self.marked_copy is not None:
            raise ValueError("a report does not hold the file itself, so that nothing can be marked in it")

    def completed(self, run_with: Mapping[str, Any] | None) -> Options:
        """Return these options, and those of an earlier run where these leave them open."""
        return replace(self, **{name: value for name, value in (run_with or {}).items() if getattr(self, name) is None})
