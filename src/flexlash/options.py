"""What the caller of a run decides."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from flexlash.submission.reading.limits import ReadingLimits

__all__ = ["Options", "Progress"]

Progress = Callable[[int, int], None]
"""Called with how many steps are done, and of how many."""


@dataclass(frozen=True, kw_only=True)
class Options:
    """What the caller decides; None leaves it to the submission's settings.

    `marked_copy` is where the submission goes with its errors and warnings marked, when there are any;
    `marked_copies` takes such copies as submissions as well.
    """

    seed: int | None = None
    method: str | None = None
    samples: int | None = None
    strict: bool = False
    cross_check: bool = False
    elasticity: bool = False
    jobs: int = 1
    tolerances: str | Path | None = None
    materials: str | Path | None = None
    limits: ReadingLimits = field(default_factory=ReadingLimits)
    marked_copy: str | Path | None = None
    marked_copies: bool = False
    progress: Progress | None = None
