"""How a submission ended: plain values from which it is printed, summed up, and told again by a later run."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from flexlash import __version__
from flexlash.analysis.outcome import Written
from flexlash.analysis.run_summary import finding_lines, to_fix_words
from flexlash.batch.answer import Answer, WorstVariant
from flexlash.feedback.fixing.fix import Fix
from flexlash.reading.inside_limits import Fault
from flexlash.reading.libraries import ChangedLibrary
from flexlash.reading.refusal import Refusal
from flexlash.schema.exit_codes import ExitCode
from flexlash.schema.file_faults import reason
from flexlash.schema.findings import Finding, finding, readable, shown
from flexlash.schema.variant import Settings

__all__ = ["Ended", "fault_of", "fault_words", "how_many", "refused_answer"]

_FIELDS = (
    "submission", "path", "sha256", "version", "seed", "method", "seconds", "exit_code", "error", "counts", "findings",
    "outputs",
)  # fmt: skip
"""What `--json` says of a submission, whatever happened."""

_COUNTS = ("rows", "computed", "errors", "warnings", "meets", "marginal", "fails")
_KINDS = {ExitCode.FINE: "computed", ExitCode.OVER_LIMIT: "computed", ExitCode.SOME_ROWS: "partly"}
"""How much of a submission was computed, by its exit code; by any other, nothing."""


@dataclass(frozen=True, kw_only=True)
class Ended:
    """How a submission ended: with an answer, or why there is none.

    `below` is its sub-folder of the folder that was given, `in_folder` says that there was one. `code` is its own
    among all of them. `told` is what `--json` prints of it but outputs, time and end; `error` the sentence that says
    why nothing of it was computed or a file is missing, `fix` what helps where that is all that is known. Lines,
    words, rules, worst variants and fixes are those of an `Answer`. `fault` is one of the program's own. `seconds` is
    how long it took; `done_before` says that an earlier run has written its files.
    """

    path: Path
    code: ExitCode
    below: Path = Path()
    in_folder: bool = False
    told: Mapping[str, Any] = field(default_factory=dict)
    error: str = ""
    fix: str = ""
    finding_lines: tuple[tuple[str, str], ...] = ()
    words: str = ""
    details: tuple[str, ...] = ()
    by_rule: Mapping[str, int] = field(default_factory=dict)
    worst: tuple[WorstVariant, ...] = ()
    fixes: tuple[Fix, ...] | None = None
    written: Written = field(default_factory=Written)
    refused: bool = False
    skipped: bool = False
    fault: Fault | None = None
    seconds: float = 0.0
    done_before: bool = False

    @classmethod
    def answered(cls, path: Path, answer: Answer, written: Written, *, several: bool) -> Ended:
        """Return how a submission ended that was answered; a skipped one is no failure among several."""
        if answer.fault is not None:
            return cls(path=path, code=ExitCode.INTERNAL, error=fault_words(answer.fault.kind), fault=answer.fault)
        code, error = answer.exit_code, ""
        if answer.skipped:
            code = ExitCode.FINE if several else ExitCode.NOTHING
        elif written.fault is not None:
            code = ExitCode.NO_FILE
            error = f"{shown(written.fault.filename, 4096)} could not be written: {reason(written.fault)}"
        elif answer.refused:
            error = answer.told["findings"][0]["message"]
        return cls(
            path=path,
            code=code,
            error=error,
            told=answer.told,
            finding_lines=answer.finding_lines,
            words=answer.words,
            details=answer.details,
            by_rule=answer.by_rule,
            worst=answer.worst,
            fixes=answer.fixes,
            written=written,
            refused=answer.refused,
            skipped=answer.skipped,
        )

    @classmethod
    def refusing(cls, path: Path, refusal: Refusal, *, several: bool, sha256: str = "") -> Ended:
        """Return how a file ended that is no submission, as far as its name, its size or its reader's end tell."""
        return cls.answered(path, refused_answer(path, refusal, sha256), Written(), several=several)

    @classmethod
    def failing(cls, path: Path, code: ExitCode, error: str, found: Finding | None = None) -> Ended:
        """Return how a submission ended of which nothing is known but why; `found` says what helps."""
        by_rule = {found.code: 1} if found else {}
        told, fix = _told_of(path, found), found.fix if found else ""
        return cls(path=path, code=code, error=error, told=told, fix=fix, by_rule=by_rule)

    @property
    def name(self) -> str:
        """The file that the closing lines speak of: the fixed one, where there is one."""
        return shown(self.written.paths[0] if self.fixes and self.written.paths else self.path, 4096)

    @property
    def counts(self) -> Mapping[str, int]:
        """How many rows, findings and verdicts there are."""
        return self.told.get("counts") or dict.fromkeys(_COUNTS, 0)

    def as_dictionary(self, *, timed: bool = True) -> dict[str, Any]:
        """Return the object that `--json` prints; a summary that is the same for the same input is not `timed`."""
        known: dict[str, Any] = dict.fromkeys(_FIELDS)
        known |= _told_of(self.path, None) | dict(self.told)
        known |= {"path": readable(self.path), "seconds": round(self.seconds, 3)}
        known |= {"exit_code": self.code, "error": self.error or None}
        known |= {"outputs": [readable(path) for path in self.written.paths]}
        if self.fixes is not None:
            known |= {"fixes": [fix.as_dictionary() for fix in self.fixes]}
        if not timed:
            del known["seconds"]
        return known


def refused_answer(path: Path, refusal: Refusal, sha256: str = "") -> Answer:
    """Return the answer to a file that no worker has read to its end, since it is refused before, or stops them."""
    found = finding(refusal.code, **{"file": readable(path.name), **refusal.facts})
    return Answer(
        exit_code=refusal.exit_code,
        told=_told_of(path, found) | {"sha256": sha256},
        finding_lines=tuple(finding_lines([found])),
        words="; ".join(filter(None, ["nothing to compute", to_fix_words([found])])),
        by_rule={found.code: 1},
        refused=True,
        skipped=found.level == "info",
    )


def fault_of(exception: BaseException) -> Fault:
    """Return a fault of the program in words; one of a worker brings its own."""
    from flexlash.reading.limited_process import ProcessFaultError

    if isinstance(exception, ProcessFaultError):
        kind, _, trace = str(exception).partition("\n")
        return Fault(kind=kind, trace=trace)
    if isinstance(exception, ChangedLibrary):
        return Fault(kind=str(exception), trace=Fault.of(exception).trace)
    return Fault.of(exception)


def fault_words(kind: str) -> str:
    """Return the sentence about a fault of flexlash's own, or of a library, of which this is known."""
    if "Your file is not to blame" in kind:
        return f"Internal error: {shown(kind, longest=400)}."
    return (
        f"Internal error ({readable(kind)}): this is a fault of flexlash, not of your file. "
        "Set FLEXLASH_DEBUG=1 for details."
    )


def how_many(codes: Sequence[ExitCode]) -> dict[str, int]:
    """Return how many submissions were computed, in part, or not.

    >>> how_many([ExitCode.FINE, ExitCode.OVER_LIMIT, ExitCode.SOME_ROWS, ExitCode.NO_FILE])
    {'computed': 2, 'partly': 1, 'not': 1}
    """
    kinds = Counter(_KINDS.get(code, "not") for code in codes)
    return {kind: kinds[kind] for kind in ("computed", "partly", "not")}


def _told_of(path: Path, found: Finding | None) -> dict[str, Any]:
    """Return what `--json` says of a submission of which nothing is known but one finding, if any."""
    usual, counts = Settings(), dict.fromkeys(_COUNTS, 0)
    if found is not None and found.level != "info":
        counts[f"{found.level}s"] = 1
    return {
        "submission": readable(path.name),
        "sha256": "",
        "version": __version__,
        "seed": usual.seed,
        "method": usual.method,
        "counts": counts,
        "findings": [] if found is None else [found.as_dictionary()],
    }
