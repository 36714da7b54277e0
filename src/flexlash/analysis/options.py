"""What the caller of a run decides."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import partial
from pathlib import Path
from typing import Any

from flexlash.reading.reading_limits import ReadingLimits
from flexlash.schema.argument_checks import file_path, flag, function, known, of_type, one_of, whole_number
from flexlash.schema.columns import SETTINGS

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
    marked_copy: str | os.PathLike[str] | None = None
    marked_copies: bool = False
    given: Sequence[Path] = ()
    from_report: bool = False
    progress: Progress | None = None

    @classmethod
    def of(cls, what: str, options: Mapping[str, Any]) -> Options:
        """Return options by name; raise TypeError where `what` is given one that there is not, with the nearest."""
        known(what, options, [one.name for one in fields(cls)])
        return cls(**options)

    def __post_init__(self) -> None:
        for name, check in _CHECKS.items():
            value = getattr(self, name)
            if value is not None or name not in _MAY_BE_NONE:
                object.__setattr__(self, name, check(name, value))
        if self.from_report and self.marked_copy is not None:
            raise ValueError("a report does not hold the file itself, so that nothing can be marked in it")

    def completed(self, run_with: Mapping[str, Any] | None) -> Options:
        """Return these options, and those of an earlier run where these leave them open."""
        return replace(self, **{name: value for name, value in (run_with or {}).items() if getattr(self, name) is None})


def _setting(key: str) -> Any:
    """Return the check of an option that the Settings sheet has as well, by the sheet's own bounds."""
    column = next(one for one in SETTINGS if one.key == key)
    if column.choices:
        return partial(one_of, choices=column.choices)
    return partial(whole_number, least=int(column.minimum or 0), most=int(column.maximum or 0))


_CHECKS: dict[str, Callable[[str, object], Any]] = {
    **{key: _setting(key) for key in ("seed", "method", "samples")},
    **dict.fromkeys(("strict", "fail_over_limit", "cross_check", "elasticity", "marked_copies", "from_report"), flag),
    **dict.fromkeys(("tolerances", "materials"), file_path),
    # Where it goes may be planned already, which its path alone does not tell.
    "marked_copy": lambda name, value: value if isinstance(value, os.PathLike) else file_path(name, value),
    "given": lambda name, value: tuple(
        file_path(name, one) for one in of_type(name, value, Sequence, "a list of paths")
    ),
    "jobs": partial(whole_number, least=1),
    "limits": partial(of_type, wanted=ReadingLimits, required="ReadingLimits, as ReadingLimits.of makes them,"),
    "progress": partial(function, required="a function of how many steps are done, and of how many,"),
}
"""What each option must be; those that are None by default may be None."""

_MAY_BE_NONE = frozenset(one.name for one in fields(Options) if one.default is None)
