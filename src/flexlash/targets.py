"""Where outputs go: a path for each submission's report, marked copy and mended file, none of them a submission."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

__all__ = ["MARKED", "beside", "mended_targets", "recreated_targets", "report_targets", "template_target"]

MARKED = "-checked"
MENDED = "-mended"
_RECREATED = "-recreated"
_FORBIDDEN = re.compile(r'[<>:"/\\|?*\x00-\x1f\x7f]')
"""What no name of a file can hold on every system."""

REPORTS = (".xlsx", ".csv", ".parquet", ".json")
"""Forms in which results are written, by the ending of their path."""


def report_targets(submissions: Sequence[Path], output: Path | None) -> list[Path]:
    """Return where each submission's report goes; raise ValueError for an output that cannot be meant."""
    return _targets(submissions, output, "-report", REPORTS)


def mended_targets(submissions: Sequence[Path], output: Path | None) -> list[Path]:
    """Return where each mended submission goes; raise ValueError for an output that cannot be meant."""
    return _targets(submissions, output, MENDED, (".xlsx", ".xlsm", ".csv"), own_ending=True)


def template_target(output: Path | None, old: Path | None, *, force: bool) -> Path:
    """Return where a template goes; raise ValueError where it would replace a file that may be filled."""
    from flexlash.submission.versions import TEMPLATE_VERSION

    default = old.parent / f"{old.stem}-v{TEMPLATE_VERSION}.xlsx" if old else Path("flexlash-template.xlsx")
    target = output or default
    if old and target.exists() and old.exists() and target.samefile(old):
        raise ValueError("-o is the old file, which flexlash never overwrites.")
    if target.suffix.lower() != ".xlsx":
        raise ValueError(f"A template is a workbook: -o must end in .xlsx, not {target.name}.")
    if target.exists() and not force:
        raise ValueError(f"{target} exists and may be filled; choose another -o, or --force.")
    return target


def recreated_targets(report: Path, output: Path | None, name: str, taken: set[Path]) -> tuple[Path, Path]:
    """Return where the submission goes that a report carries by this name, and where the report made anew.

    Neither takes the place of a path in `taken`, to which both are added.
    """
    stem = Path(_FORBIDDEN.sub("_", name)).stem or "submission"
    is_file = output is not None and not output.is_dir()
    folder = report.parent if output is None else output.parent if is_file else output
    found: list[Path] = []
    for ending in (_RECREATED, f"{_RECREATED}-report"):
        target, copy = folder / f"{stem}{ending}.xlsx", 1
        if output is not None and is_file and found:
            target = output
        while target != output and target.resolve() in taken:
            copy += 1
            target = folder / f"{stem}{ending} ({copy}).xlsx"
        taken.add(target.resolve())
        found.append(target)
    return found[0], found[1]


def _targets(
    submissions: Sequence[Path],
    output: Path | None,
    suffix: str,
    endings: tuple[str, ...],
    *,
    own_ending: bool = False,
) -> list[Path]:
    names = [f"{path.stem}{suffix}{path.suffix if own_ending else '.xlsx'}" for path in submissions]
    if output is None:
        # Not with_name: `.` and `/` have no name; reading them says that they are folders.
        targets = [path.parent / name for path, name in zip(submissions, names, strict=True)]
    elif output.is_dir() or not output.suffix or str(output).endswith(("/", "\\")):
        output.mkdir(parents=True, exist_ok=True)
        targets = [output / name for name in names]
    elif len(submissions) > 1:
        raise ValueError("Several submissions need a folder as OUT.")
    elif output.suffix.lower() not in endings:
        raise ValueError(f"OUT must end in {', '.join(endings)} or be a folder, not {output.suffix}.")
    else:
        targets = [output]
    inputs = {path.resolve() for path in submissions}
    if any(target.resolve() in inputs for target in targets):
        raise ValueError("OUT is one of the submissions, which flexlash never overwrites.")
    return _distinct(targets)


def beside(submissions: Sequence[Path], targets: Sequence[Path]) -> list[Path]:
    """Return where each submission's marked copy goes: into the folder of its target, under its own name.

    The marked copy of a marked copy takes its place.
    """
    stems = [path.stem.removesuffix(MARKED) for path in submissions]
    return _distinct([target.with_name(f"{stem}{MARKED}.xlsx") for stem, target in zip(stems, targets, strict=True)])


def _distinct(targets: list[Path]) -> list[Path]:
    """Give equal names a number: ` (2)`, ` (3)`."""
    used: set[Path] = set()
    found = []
    for target in targets:
        distinct, copy = target, 1
        while distinct in used:
            copy += 1
            distinct = target.with_name(f"{target.stem} ({copy}){target.suffix}")
        used.add(distinct)
        found.append(distinct)
    return found
