"""What the caller of a run decides: each option's name, kind, default and help once, for Python and command line."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import partial
from pathlib import Path
from typing import Any

from flexlash.reading.reading_limits import ReadingLimits
from flexlash.schema.argument_checks import (
    file_path,
    flag,
    function,
    known,
    number_within,
    of_type,
    one_of,
    whole_number,
)
from flexlash.schema.columns import SETTINGS

__all__ = ["TABLES", "Options", "Progress"]

TABLES = {
    sheet.lower().replace(" ", "_"): sheet
    for sheet in ("Tolerances", "Materials", "Measurements", "Correlations", "Other sources")
}
"""Options that name a table to be used instead of a submission's own, with the sheet that it replaces."""

Progress = Callable[[int, int], None]
"""Called with how many steps are done, and of how many."""


def _declared(check: Callable[[str, object], Any], text: str = "") -> dict[str, Any]:
    """Return what an option must be, and its help on the command line, empty where it has no place there."""
    return {"check": check, "help": text}


def _setting(key: str, text: str) -> dict[str, Any]:
    """Return the same of an option that the Settings sheet has as well, by the sheet's own bounds."""
    column = next(one for one in SETTINGS if one.key == key)
    if column.choices:
        return _declared(partial(one_of, choices=column.choices), text)
    least, most = column.minimum or 0, column.maximum or 0
    if column.type == "number":
        return _declared(partial(number_within, least=least, most=most), text)
    return _declared(partial(whole_number, least=int(least), most=int(most)), text)


def _output(name: str, value: object) -> Any:
    """Return the place of an output, which may be planned already: its path alone would not tell."""
    return value if isinstance(value, os.PathLike) else file_path(name, value)


def _paths(name: str, value: object) -> tuple[Path, ...]:
    return tuple(file_path(name, one) for one in of_type(name, value, Sequence, "a list of paths"))


_LIMITS = partial(of_type, wanted=ReadingLimits, required="ReadingLimits, as ReadingLimits.of makes them,")
_PROGRESS = partial(function, required="a function of how many steps are done, and of how many,")


@dataclass(frozen=True, kw_only=True)
class Options:
    """What the caller decides; None leaves it to the submission's settings. `of` makes them and checks each.

    `marked_copy` is where the submission goes with its errors and warnings marked, when there are any; `given` are the
    submissions that are given together: a fixed one is skipped when its original is among them. With `from_report`
    what is None is as it was in the run that made the report.
    """

    seed: int | None = field(default=None, metadata=_setting("seed", "Start of the random numbers."))
    method: str | None = field(default=None, metadata=_setting("method", "How the spread is sampled."))
    samples: int | None = field(default=None, metadata=_setting("samples", "Lines or points per variant."))
    target_percent: float | None = field(
        default=None,
        metadata=_setting("target_percent", "Share of units in per cent that shall be within their backlash limit."),
    )
    angle_unit: str | None = field(
        default=None, metadata=_setting("angle_unit", "Unit of angles in report, page and on the screen.")
    )
    strict: bool | None = field(default=None, metadata=_declared(flag, "Compute nothing when any row has an error."))
    fail_over_limit: bool = field(
        default=False, metadata=_declared(flag, "End with exit code 6 when a variant does not meet its limit.")
    )
    cross_check: bool | None = field(
        default=None,
        metadata=_declared(flag, ("Compute plain Monte Carlo beside the spread and say whether they agree.")),
    )
    elasticity: bool | None = field(
        default=None, metadata=_declared(flag, "Check each variant by two-dimensional elasticity.")
    )
    jobs: int = field(default=1, metadata=_declared(partial(whole_number, least=1), "Processes."))
    tolerances: str | Path | None = field(
        default=None, metadata=_declared(file_path, "The Tolerances table to use instead of the submission's.")
    )
    materials: str | Path | None = field(
        default=None, metadata=_declared(file_path, "The Materials table to use instead of the submission's.")
    )
    measurements: str | Path | None = field(
        default=None, metadata=_declared(file_path, "The Measurements table: measured parts, one per row.")
    )
    correlations: str | Path | None = field(
        default=None, metadata=_declared(file_path, "The Correlations table: dimensions that scatter together.")
    )
    other_sources: str | Path | None = field(
        default=None, metadata=_declared(file_path, "The Other sources table: other sources of backlash in the drive.")
    )
    samples_out: str | Path | None = field(
        default=None,
        metadata=_declared(
            file_path,
            "Write random units of each variant, with their dimensions, into this folder: "
            "<name>-samples.parquet, at most a million units.",
        ),
    )
    pictures: str | Path | None = field(
        default=None,
        metadata=_declared(
            file_path,
            "Write charts into this folder as SVG, and PNG where matplotlib is installed: all variants beside the "
            "limit; of the ten worst the part, the spread, its causes and the segments.",
        ),
    )
    limits: ReadingLimits = field(
        default_factory=ReadingLimits,
        metadata=_declared(
            _LIMITS, "Read more, or less, of a file than by default: cells=2000000. A refusal names the limit."
        ),
    )
    marked_copy: str | os.PathLike[str] | None = field(default=None, metadata=_declared(_output))
    marked_copies: bool = field(
        default=False, metadata=_declared(flag, "Also accept marked copies (<name>-checked.xlsx) as submissions.")
    )
    given: Sequence[Path] = field(default=(), metadata=_declared(_paths))
    from_report: bool = field(
        default=False,
        metadata=_declared(
            flag,
            "The files are reports: write out the submission that each carries and recompute it, with its own options.",
        ),
    )
    progress: Progress | None = field(default=None, metadata=_declared(_PROGRESS))

    @classmethod
    def of(cls, what: str, options: Mapping[str, Any]) -> Options:
        """Return options by name, each checked.

        Raises TypeError where `what` is given one that there is not, with the nearest, or one of another kind,
        ValueError for a value out of range.
        """
        known(what, options, [one.name for one in fields(cls)])
        chosen = cls(**{name: _checked(name, value) for name, value in options.items()})
        if what != "run()" and (chosen.samples_out or chosen.pictures):
            raise ValueError(f"{what} writes no samples and no pictures; run() does")
        if chosen.from_report and chosen.marked_copy is not None:
            raise ValueError("a report does not hold the file itself, so that nothing can be marked in it")
        return chosen

    @property
    def tables(self) -> dict[str, Path]:
        """Return the tables that stand beside each submission, by the sheet that each replaces."""
        given = {sheet: getattr(self, name) for name, sheet in TABLES.items()}
        return {sheet: Path(path) for sheet, path in given.items() if path is not None}

    def without_tables(self, **changes: Any) -> Options:
        """Return these options as a worker gets them, who is handed bytes of tables and told of no folder."""
        left: dict[str, Any] = dict.fromkeys((*TABLES, "samples_out", "pictures"))
        return replace(self, **left, **changes)

    def completed(self, run_with: Mapping[str, Any] | None) -> Options:
        """Return these options, and those of an earlier run where these leave them open."""
        left_open = {name: value for name, value in (run_with or {}).items() if getattr(self, name) is None}
        return replace(self, **{name: _checked(name, value) for name, value in left_open.items()})


_DECLARED = {one.name: one for one in fields(Options)}


def _checked(name: str, value: object) -> Any:
    """Return an option as its check returns it; None stays where it is the default."""
    option = _DECLARED[name]
    return value if value is None and option.default is None else option.metadata["check"](name, value)
