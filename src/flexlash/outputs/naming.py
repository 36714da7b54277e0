"""Submissions and OUT → the planned output of each: its report, its marked copy or its fixed copy."""

from __future__ import annotations

import contextlib
import os
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from flexlash.outputs.plan import Output, Plan
from flexlash.reading.products import (
    CHECKED_NAME,
    FIXED_NAME,
    REPORT_NAME,
    SUMMARY_NAME,
    SWEEP_NAME,
    is_made_by_name,
    made_of,
)
from flexlash.schema.argument_checks import file_path

__all__ = [
    "FIXED",
    "REPORTS",
    "TABLES",
    "WORKBOOK",
    "fixed_outputs",
    "marked_outputs",
    "named_output",
    "recreated_outputs",
    "report_outputs",
    "summary_outputs",
    "sweep_output",
    "table_output",
    "template_output",
]

REPORTS = (".xlsx", ".csv", ".parquet", ".json")
"""Forms in which results are written, by the ending of their path."""

TABLES = REPORTS[1:]
"""Those that hold a table alone."""

FIXED = (".xlsx", ".xlsm", ".csv")
WORKBOOK = (".xlsx", ".xlsm")
_ENDING = re.compile(r"\.[a-z][a-z0-9]{0,6}", re.IGNORECASE)
"""What ends the name of a kind of file; a point with a number, as in `study-2.1`, may be part of a folder's name."""

Below = Mapping[Path, Path]
"""Submissions that lie below the folder that was given, with their sub-folders."""

_NOWHERE_BELOW: Below = {}
_RECREATED = "-recreated"
_FORBIDDEN = re.compile(r'[<>:"/\\|?*\x00-\x1f\x7f]')
"""What no name of a file can hold on every system."""


def named_output(plan: Plan, path: str | os.PathLike[str], endings: Sequence[str]) -> Output:
    """Return the output that a caller names; raise ValueError where it cannot be meant."""
    if isinstance(path, Output):
        return path
    path = file_path("output", path)
    if path.suffix.lower() not in endings:
        raise ValueError(f"the output must end in {', '.join(endings)}, not {path.suffix or 'nothing'}")
    return plan.claim(path, named=True)


def report_outputs(
    plan: Plan, submissions: Sequence[Path], output: Path | None, *, below: Below = _NOWHERE_BELOW
) -> list[Output]:
    """Return where each submission's report goes; raise ValueError for an output that cannot be meant.

    `below` gives the sub-folder of an output folder that a submission's files go to, here and in the other functions.
    """
    return _outputs(plan, submissions, output, lambda path: f"{path.stem}{REPORT_NAME}.xlsx", REPORTS, below)


def sweep_output(plan: Plan, submission: Path, output: Path | None) -> Output:
    """Return where the sweep of a submission goes; raise ValueError for an output that cannot be meant."""

    def name(path: Path) -> str:
        return f"{path.stem}{SWEEP_NAME}.xlsx"

    (claimed,) = _outputs(plan, [submission], output, name, REPORTS, _NOWHERE_BELOW)
    return claimed


def summary_outputs(plan: Plan, output: Path | None) -> tuple[Output, Output] | None:
    """Return where the summary of all submissions goes, as a workbook and as lines; None where OUT is no folder."""
    if output is None:
        return None
    _require_name(output)
    if not _is_folder(output):
        return None
    _make_folder(output, REPORTS)
    return plan.claim(output / f"{SUMMARY_NAME}.xlsx"), plan.claim(output / f"{SUMMARY_NAME}.jsonl")


def fixed_outputs(
    plan: Plan, submissions: Sequence[Path], output: Path | None, *, below: Below = _NOWHERE_BELOW
) -> list[Output]:
    """Return where each fixed submission goes; raise ValueError for an output that cannot be meant."""

    def name(path: Path) -> str:
        return f"{made_of(path, FIXED_NAME)}{FIXED_NAME}{path.suffix}"

    return _outputs(plan, submissions, output, name, FIXED, below)


def marked_outputs(
    plan: Plan,
    submissions: Sequence[Path],
    output: Path | None,
    *,
    itself: bool = False,
    below: Below = _NOWHERE_BELOW,
) -> list[Output]:
    """Return where each submission's marked copy goes; raise ValueError for an output that cannot be meant.

    The marked copy of a marked copy is called like the first. `itself` says that OUT, where it is a file, is the marked
    copy; else this goes beside it.
    """

    def name(path: Path) -> str:
        return f"{made_of(path, CHECKED_NAME)}{CHECKED_NAME}.xlsx"

    if output is None or itself or _is_folder(output):
        return _outputs(plan, submissions, output, name, WORKBOOK, below)
    return _claims(plan, submissions, output.parent, name, below)


def recreated_outputs(plan: Plan, report: Path, output: Path | None, name: str) -> tuple[Output, Output]:
    """Return where the submission goes that a report carries by this name, and where the report made anew."""
    stem = Path(_FORBIDDEN.sub("_", name)).stem or "submission"
    is_file = output is not None and not _is_folder(output)
    folder = report.parent if output is None else output.parent if is_file else output
    filled = plan.claim(folder / f"{stem}{_RECREATED}.xlsx")
    if is_file:
        return filled, plan.claim(output, named=True)  # type: ignore[arg-type]
    return filled, plan.claim(folder / f"{stem}{_RECREATED}{REPORT_NAME}.xlsx")


def table_output(plan: Plan, output: Path) -> Output:
    """Return where a table goes that the user names; raise ValueError for an output that cannot be meant."""
    _require_name(output)
    if _is_folder(output) or output.suffix.lower() not in TABLES:
        raise ValueError(f"OUT must end in {', '.join(TABLES)}, not {output.name}.")
    return plan.claim(output, named=True)


def template_output(output: Path | None, old: Path | None, *, force: bool) -> Output:
    """Return where a template goes; raise ValueError where it would replace a file that may be filled."""
    from flexlash.validation.template_versions import TEMPLATE_VERSION

    default = old.parent / f"{old.stem}-v{TEMPLATE_VERSION}.xlsx" if old else Path("flexlash-template.xlsx")
    target = output or default
    plan = Plan(inputs=[old] if old else [])
    plan.refuse_input(target)
    _require_name(target)
    if target.suffix.lower() != ".xlsx":
        raise ValueError(f"A template is a workbook: -o must end in .xlsx, not {target.name}.")
    claimed = plan.claim(target, named=True, forced=True)
    if claimed.path != target:
        raise ValueError(f"{target} cannot be written: {plan.obstacle(target, named=True)}. Choose another -o.")
    if os.path.lexists(target) and not force:
        raise ValueError(f"{target} exists and may be filled; choose another -o, or --force.")
    return claimed


def _outputs(  # noqa: PLR0917
    plan: Plan,
    submissions: Sequence[Path],
    output: Path | None,
    name: Callable[[Path], str],
    endings: Sequence[str],
    below: Below,
) -> list[Output]:
    """Return the output of each submission: in its own folder, in the folder that was named, or the one file named."""
    if output is not None:
        _require_name(output)
    if output is not None and not _is_folder(output):
        if len(submissions) > 1:
            raise ValueError("Several submissions need a folder as OUT.")
        if output.suffix.lower() not in endings:
            raise ValueError(f"OUT must end in {', '.join(endings)} or be a folder, not in {output.suffix}.")
        return [plan.claim(output, named=True)]
    if output is not None:
        _make_folder(output, endings)
    return _claims(plan, submissions, output, name, below)


def _claims(
    plan: Plan, submissions: Sequence[Path], folder: Path | None, name: Callable[[Path], str], below: Below
) -> list[Output]:
    """Return the output of each submission in a folder, or in its own.

    What seems to be of our own making comes last: as a rule it is skipped, and it takes no name from a submission.
    """
    claimed: dict[int, Output] = {}
    for index in sorted(range(len(submissions)), key=lambda index: is_made_by_name(submissions[index])):
        path = submissions[index]
        place = path.parent if folder is None else folder / below.get(path, "")
        if folder is not None and path in below:
            # What cannot be made is known to its output, and raised when it is needed.
            with contextlib.suppress(OSError):
                place.mkdir(parents=True, exist_ok=True)
        # Not with_name: `.` and `/` have no name; reading them says that they are folders.
        claimed[index] = plan.claim(place / name(path))
    return [claimed[index] for index in range(len(submissions))]


def _require_name(output: Path) -> None:
    """Raise ValueError for an OUT that names neither a file nor a folder."""
    if output.name == "-":
        raise ValueError(f"OUT must be a file or a folder, not {output}: only --json writes to standard output.")
    if output.name.lower() in {*REPORTS, *FIXED}:
        raise ValueError(f"OUT is an ending without a name: write a name before {output.name}.")
    if output.name.endswith(".") and not _is_there(output):
        raise ValueError(f"{output.name} ends in a point without an ending: write {output.name}xlsx, or leave it out.")


def _is_folder(output: Path) -> bool:
    """Whether OUT is meant as a folder: one that is there, or a name without the ending of a kind of file."""
    return _is_there(output) or str(output).endswith("\\") or not _ENDING.fullmatch(output.suffix.strip())


def _is_there(folder: Path) -> bool:
    # Not is_dir, which raises for a name that is too long.
    return os.path.isdir(folder)  # noqa: PTH112


def _make_folder(output: Path, endings: Sequence[str]) -> None:
    try:
        output.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError) as fault:
        raise ValueError(
            f"{output} leads to a file that is no folder; OUT must end in {', '.join(endings)} or be a folder."
        ) from fault
