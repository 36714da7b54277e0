"""What flexlash itself wrote, met again among submissions, and the lock files of other programs: they are skipped.

A workbook says what it is in its document properties, which stay when somebody works in it and saves it. A table cannot
say so: Results are known by their header row, a fixed table by its name beside its original.
"""

from __future__ import annotations

import contextlib
import hashlib
import re
import stat
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from flexlash.reading.raw import Submission
from flexlash.reading.refusal import Refusal
from flexlash.schema.columns import VARIANTS
from flexlash.schema.decision_results import LEVERS_TABLE
from flexlash.schema.distribution_keys import LAST_OF_UNITS, PERCENTILES_TABLE, UNITS_TABLE
from flexlash.schema.result_columns import FINDINGS, result_columns

__all__ = [
    "CHECKED_NAME",
    "FIXED_NAME",
    "REPORT_NAME",
    "SUMMARY_NAME",
    "SWEEP_NAME",
    "Companions",
    "digests_of",
    "fixed_role",
    "is_made_by_name",
    "is_replaced",
    "made_of",
    "require_submission",
    "results_header",
    "stamped_product",
]

REPORT_NAME, CHECKED_NAME, FIXED_NAME, SWEEP_NAME = "-report", "-checked", "-autofixed", "-sweep"
"""What flexlash puts behind the name of a submission."""

SUMMARY_NAME = "flexlash-summary"
"""How the summary of all submissions is called in the folder of their reports."""

_FORMER_FIXED_NAME = "-mended"
_NAMES = f"{REPORT_NAME}|{CHECKED_NAME}|{FIXED_NAME}|{_FORMER_FIXED_NAME}|{SWEEP_NAME}"
_MADE = re.compile(rf"(?P<stem>.+)(?P<what>{_NAMES})(?: \(\d+\))?")
_FIXED = "mended"
_PRODUCTS = {
    "report": "I508",
    "summary": "I508",
    "results": "I527",
    "levers": "I527",
    "distribution": "I527",
    "checked": "I513",
}
"""By its role, the finding that says why a file that flexlash wrote is skipped."""

_RESULTS = tuple(column.key for column in result_columns(cross_check=False, elasticity=False))
_OTHERS = (*(tuple(column.key for column in columns) for columns in (FINDINGS, LEVERS_TABLE)), PERCENTILES_TABLE)
_SWEPT = frozenset(column.key for column in VARIANTS if column.role == "dimension")
_LARGEST = 2**27
"""Largest file whose digest is taken to find out whether it is the original of a fixed one [bytes]."""


def fixed_role(original: bytes) -> str:
    """Return what a fixed workbook says of itself: that it is one, and of which submission."""
    return f"{_FIXED} {hashlib.sha256(original).hexdigest()}"


def results_header(keys: Iterable[object]) -> bool:
    """Whether a header row is that of Results, behind which further columns may follow, of findings or the like.

    Of a sweep the swept columns stand behind the variant, of random units those that scatter.
    """
    header = list(keys)
    if header[-1:] == [LAST_OF_UNITS] and tuple(header[:2]) == UNITS_TABLE:
        return True
    swept = [key for key in header if key not in _SWEPT]
    return tuple(header) in _OTHERS or (tuple(swept[:2]) == _RESULTS[:2] and set(_RESULTS) <= set(header))


def is_made_by_name(path: Path) -> bool:
    """Whether a file has the kind of name that flexlash gives: `<name>-report`, `-checked`, `-autofixed` and so on.

    >>> is_made_by_name(Path("a-autofixed (2).csv")), is_made_by_name(Path("a.csv"))
    (True, False)
    """
    return _MADE.fullmatch(path.stem) is not None


def made_of(path: Path, what: str) -> str:
    """Return the stem of the submission of which a file of this name was made, its own when it is none.

    >>> made_of(Path("a-checked (2).xlsx"), CHECKED_NAME), made_of(Path("b.xlsx"), CHECKED_NAME)
    ('a', 'b')
    >>> made_of(Path("a-mended.csv"), FIXED_NAME)  # as it was called before version 0.10
    'a'
    """
    match = _MADE.fullmatch(path.stem)
    made = match and (FIXED_NAME if match["what"] == _FORMER_FIXED_NAME else match["what"])
    return match["stem"] if match and made == what else path.stem


@dataclass(frozen=True, kw_only=True)
class Companions:
    """The other files that are given together with one, of which it may be a fixed copy.

    `original` says that the one of which it is a copy by its name is among them, `digests` are those of all of them.
    """

    original: bool = False
    digests: frozenset[str] = frozenset()

    @classmethod
    def of(cls, path: Path, given: Collection[Path], digests: frozenset[str] | None = None) -> Companions:
        """Return what is given together with a file; `digests` may be taken once for all of them."""
        digests = digests_of(other for other in given if other != path) if digests is None else digests
        return cls(original=_original_beside(path, given), digests=digests)

    def hold_the_original(self, role: str) -> bool:
        """Whether that is among them of which a file is a fixed copy, by its name or by this role of its stamp."""
        return self.original or role.removeprefix(f"{_FIXED} ") in self.digests


def digests_of(paths: Iterable[Path]) -> frozenset[str]:
    """Return the digests of files, of those that are ordinary and of ordinary size."""
    return frozenset(map(_digest, paths)) - {""}


def require_submission(submission: Submission, companions: Companions, *, marked_copies: bool) -> None:
    """Raise Refusal, with the code of an info, for a file that flexlash itself wrote and that is therefore skipped.

    A fixed file is skipped when its original is given with it.
    """
    if code := _product(submission, companions, marked_copies=marked_copies):
        raise Refusal(code)


def _product(submission: Submission, companions: Companions, *, marked_copies: bool) -> str:
    if submission.run_with is not None:
        return ""
    if submission.kind == "workbook":
        return _code(submission.role, companions, marked_copies=marked_copies)
    rows = [sheet.rows for sheet in submission.sheets.values()]
    if any(results_header(sheet.get(1, {}).values()) for sheet in rows):
        return "I527"
    return "I526" if submission.kind == "csv" and companions.original else ""


def is_replaced(role: str, path: Path, given: Collection[Path], *, marked_copies: bool) -> bool:
    """Whether a given file with this role in its stamp will be skipped, so that its successor may take its place.

    A table that was fixed has no stamp, but a name.
    """
    if path.suffix.lower() == ".csv":
        return _original_beside(path, given)
    companions = Companions.of(path, given) if role.startswith(_FIXED) else Companions()
    return bool(_code(role, companions, marked_copies=marked_copies))


def stamped_product(role: str, *, marked_copies: bool) -> str:
    """Return why a file with this role in its stamp is skipped, whatever else is given; else an empty text.

    >>> stamped_product("report", marked_copies=False), stamped_product("checked", marked_copies=True)
    ('I508', '')
    """
    return "" if role == "checked" and marked_copies else _PRODUCTS.get(role, "")


def _code(role: str, companions: Companions, *, marked_copies: bool) -> str:
    kind = role.partition(" ")[0]
    if code := stamped_product(kind, marked_copies=marked_copies):
        return code
    return "I526" if kind == _FIXED and companions.hold_the_original(role) else ""


def _original_beside(path: Path, given: Iterable[Path]) -> bool:
    """Whether the original, by its name, stands beside a fixed file and is given as well."""
    if (stem := made_of(path, FIXED_NAME)) == path.stem:
        return False
    original = path.with_name(f"{stem}{path.suffix}")
    return any(_is_same(original, other) for other in given)


def _is_same(path: Path, other: Path) -> bool:
    with contextlib.suppress(OSError, ValueError):
        return path.samefile(other)
    return False


def _digest(path: Path) -> str:
    """Return a file's digest, an empty text for what is no ordinary file."""
    with contextlib.suppress(OSError, ValueError):
        status = path.stat()
        if stat.S_ISREG(status.st_mode) and status.st_size <= _LARGEST:
            return _digest_of(path, status.st_size, status.st_mtime_ns)
    return ""


@lru_cache(maxsize=4096)
def _digest_of(path: Path, size: int, changed: int) -> str:  # noqa: ARG001
    """Return a file's digest; that of an unchanged file is not taken again."""
    return hashlib.sha256(path.read_bytes()).hexdigest()
