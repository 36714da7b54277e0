"""An answer → how its submission ended, with the files of its result kept as blobs: the same bytes each time."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import Any

from flexlash.analysis.outcome import Written
from flexlash.batch.answer import Answer, FileBytes
from flexlash.batch.ended import Ended, fault_words
from flexlash.reading.products import CHECKED_NAME, FIXED_NAME, REPORT_NAME
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.schema.exit_codes import ExitCode
from flexlash.schema.findings import finding
from flexlash.schema.stamps import stamped
from flexlash.service.blobs import Blobs
from flexlash.service.reasons import reasons_text
from flexlash.service.records import Ending, FileRole, RuleCount, StoredFile, StoredSubmission

__all__ = ["PAGE", "KeptFile", "ending_of", "kept", "named", "outcome_json"]

_DONE = {ExitCode.FINE, ExitCode.SOME_ROWS, ExitCode.OVER_LIMIT}
_BY_CHANCE = ("seconds", "processor_seconds", "memory_mebibytes")
"""Limits that the same file may keep another time, when this machine has less to do."""

_SUBMISSIONS = {".xlsx", ".xlsm", ".csv"}
PAGE = "-page.json"
"""How the file is called that a page is made of; it leaves the store as part of an answer to a program alone."""


@dataclass(frozen=True, kw_only=True)
class KeptFile:
    """A file of a result before it is kept: the end of its name, behind the submission's, and its bytes."""

    role: FileRole
    ending: str
    data: bytes


def ending_of(
    submission: StoredSubmission,
    answer: Answer,
    blobs: Blobs,
    limits: ReadingLimits,
    *,
    reason: str = "",
    further: Mapping[str, StoredFile] | None = None,
) -> Ending:
    """Return how a submission ended, its files kept; call it within `blobs.keeping()` until the row names them.

    `reason` says why it was rejected where the answer does not; it may end otherwise another time. `further` are files
    of its result that are kept already, by what they are. Raises OSError where a file cannot be kept.
    """
    further = further or {}
    is_done = answer.exit_code in _DONE and answer.fault is None
    why = "" if is_done else reason or _reason(answer)
    made = [file for file in _files(submission, answer, "" if is_done else reason) if file.role not in further]
    files = [*further.values(), *(kept(blobs, submission, file) for file in made)]
    told = outcome_json(submission, answer, [file.name for file in files if file.role != "page"])
    files.append(kept(blobs, submission, KeptFile(role="outcome", ending="-outcome.json", data=told)))
    return Ending(
        state="done" if is_done else "rejected",
        exit_code=answer.exit_code,
        words=answer.words or "nothing was computed",
        reason=why,
        counts=answer.told.get("counts", {}),
        files=files,
        rules=tuple(
            RuleCount(level=r.level, code=r.code, sheet=r.sheet, column=r.column, cells=r.cells, first=r.first)
            for r in answer.rules
        ),
        is_repeatable=not reason and answer.fault is None and not _is_by_chance(answer, limits),
    )


def kept(blobs: Blobs, submission: StoredSubmission, file: KeptFile) -> StoredFile:
    """Keep a file of a submission's result and return it; raise OSError where that cannot be."""
    sha256, size = blobs.put(file.data)
    return StoredFile(role=file.role, sha256=sha256, size=size, name=named(submission, file.ending))


def named(submission: StoredSubmission, ending: str) -> str:
    """Return how a file of a submission's result is called."""
    return f"{PurePath(submission.name).stem}{ending}"


def outcome_json(submission: StoredSubmission, answer: Answer, names: list[str]) -> bytes:
    """Return the object that `--json` prints of a submission, without the time that it took, which is never the same.

    `names` are those of the files that were written for it.
    """
    path = Path(submission.name)
    ended = Ended.answered(path, answer, Written(paths=tuple(map(Path, names))), several=False)
    known: dict[str, Any] = ended.as_dictionary() | {"sha256": submission.sha256, "seconds": None}
    return json.dumps(known, ensure_ascii=False).encode()


def _files(submission: StoredSubmission, answer: Answer, reason: str) -> Iterator[KeptFile]:
    """Yield the files of an answer, in the order in which they are named."""
    if answer.file is not None:
        yield KeptFile(role="report", ending=f"{REPORT_NAME}.xlsx", data=_stamped(answer.file))
    if answer.results is not None:
        yield KeptFile(role="results", ending="-results.csv", data=answer.results.data)
    if answer.copy is not None:
        yield KeptFile(role="checked", ending=f"{CHECKED_NAME}.xlsx", data=_stamped(answer.copy))
    if answer.fixed is not None:
        ending = PurePath(submission.name).suffix.lower()
        ending = ending if ending in _SUBMISSIONS else ".xlsx" if answer.fixed.data.startswith(b"PK") else ".csv"
        yield KeptFile(role="fixed", ending=f"{FIXED_NAME}{ending}", data=_stamped(answer.fixed))
    if answer.exit_code not in {ExitCode.FINE, ExitCode.OVER_LIMIT} or answer.copy is not None:
        text = reasons_text(answer, submission.name, submission=submission.id, reason=reason)
        yield KeptFile(role="reasons", ending="-reasons.txt", data=text)
    if answer.page:
        yield KeptFile(role="page", ending=PAGE, data=answer.page)


def _stamped(file: FileBytes) -> bytes:
    return stamped(file.data, file.role)


def _reason(answer: Answer) -> str:
    """Return the sentences that say why a submission was rejected, and what helps."""
    if answer.fault is not None:
        return fault_words(answer.fault.kind)
    findings = answer.told.get("findings", ())
    first = next((one for one in findings if one["level"] == "error"), next(iter(findings), None))
    return answer.words if first is None else f"{first['message']} {first['fix']}"


def _is_by_chance(answer: Answer, limits: ReadingLimits) -> bool:
    """Whether a limit refused the file that it may keep another time."""
    findings = answer.told.get("findings", ())
    if not answer.refused or not findings:
        return False
    file = answer.told.get("submission", "")
    refusals = map(limits.exceeded, _BY_CHANCE)
    return findings[0]["message"] in {finding(one.code, **{"file": file, **one.facts}).message for one in refusals}
