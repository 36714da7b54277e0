"""What this machine refuses for now: told when it begins and when it ends, tried again less and less often."""

from __future__ import annotations

from collections.abc import Callable, Collection, Hashable
from dataclasses import dataclass

from flexlash.schema.file_faults import reason
from flexlash.service.log import Log
from flexlash.service.repeated import back_off

__all__ = ["Patience"]


@dataclass(frozen=True, kw_only=True)
class _Fault:
    """A fault: in which words it was told, how often it was met in a row, since when and until when it stands [s]."""

    words: str
    times: int
    since: float
    until: float


class Patience:
    """The faults of this machine that stand, by what they hinder; `clock` only goes forward [s]."""

    def __init__(self, log: Log, clock: Callable[[], float]) -> None:
        self._log = log
        self._clock = clock
        self._faults: dict[Hashable, _Fault] = {}

    def may_try(self, what: Hashable) -> bool:
        """Whether enough time has gone since it last failed."""
        return what not in self._faults or self._faults[what].until <= self._clock()

    def failed(self, what: Hashable, fault: OSError, name: object, submission: str = "") -> None:
        """Note that something failed, and say so unless that is known."""
        now, known, words = self._clock(), self._faults.get(what), reason(fault)
        times = known.times + 1 if known else 1
        self._faults[what] = _Fault(
            words=words, times=times, since=known.since if known else now, until=now + back_off(times)
        )
        if known is None or known.words != words:
            self._log.say("fault", submission, what=name, why=words)

    def went_well(self, what: Hashable, name: object) -> None:
        """Note that something that may have failed before went well."""
        if self._faults.pop(what, None):
            self._log.say("fault is over", what=name)

    def stands_since(self, what: Hashable) -> float | None:
        """Return since when something fails, None where it does not."""
        return self._faults[what].since if what in self._faults else None

    def keep(self, kind: type, those: Collection[Hashable]) -> None:
        """Forget all faults of things of a kind that are no longer there."""
        self._faults = {
            what: fault for what, fault in self._faults.items() if not isinstance(what, kind) or what in those
        }
