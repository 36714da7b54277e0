"""Inside the limited process: so much memory and processor time, no writing, no calling, while a file is handled.

Where the system cannot limit a process (Windows), the clock remains, which the one that asks keeps.
"""

from __future__ import annotations

import contextlib
import gc
import math
import os
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from flexlash.reading.libraries import ChangedLibrary, require_known_libraries
from flexlash.reading.raw import RawSheet, RawValue, Submission
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.schema.columns import columns_of
from flexlash.workers import timed

__all__ = ["Fault", "answered", "carried_out", "forbid", "is_prepared", "limited", "prepare"]

_MEBI = 2**20
_FORBIDDEN = (
    "socket.", "subprocess.", "os.system", "os.exec", "os.posix_spawn", "os.spawn", "os.fork", "os.remove", "os.rename",
    "os.mkdir", "os.rmdir", "os.link", "os.symlink", "os.chmod", "os.truncate", "shutil.", "ctypes.dlopen", "urllib.",
)  # fmt: skip
_WRITING = frozenset("wax+")


@dataclass(frozen=True, kw_only=True)
class Fault:
    """An exception that is no refusal, in words, since exceptions do not always survive the way between processes."""

    kind: str
    trace: str

    @classmethod
    def of(cls, exception: BaseException) -> Fault:
        """Return an exception in words."""
        return cls(kind=type(exception).__name__, trace="".join(traceback.format_exception(exception)))


class _State:
    """What this process knows of itself: whether it was prepared and handles a file, what failed at first."""

    prepared = False
    handles_a_file = False
    fault: Fault | ChangedLibrary | None = None


def is_prepared() -> bool:
    """Whether this process was made one that can be limited."""
    return _State.prepared


def prepare() -> None:
    """Make this process one that can be limited: silent, with its libraries loaded before anything is forbidden."""
    _State.prepared = True
    _silence()
    try:
        _warm_up()
        # What was loaded stays: it need not be looked through for garbage again while files are read.
        gc.freeze()
    except BaseException as fault:  # noqa: BLE001
        # Told by the first answer: a process that ends here could not say why.
        _State.fault = _why(fault)
    sys.addaudithook(_judge)


def _why(fault: BaseException) -> Fault | ChangedLibrary:
    """Return what failed while the libraries were loaded: a library that lacks something, or a fault in words."""
    try:
        require_known_libraries()
    except ChangedLibrary as changed:
        return changed
    return Fault.of(fault)


def _silence() -> None:
    """Send what libraries print, such as the panics of Rust, nowhere; with FLEXLASH_DEBUG=1 it is shown."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    if os.environ.get("FLEXLASH_DEBUG") != "1":
        os.dup2(nowhere, 2)
    os.close(nowhere)


def _warm_up() -> None:
    """Load the libraries, so that neither their memory nor their time counts against a file.

    One row of a workbook is validated, since pandera and RapidFuzz load half of themselves only then, some of which
    fails where the working folder has been removed.
    """
    from flexlash.reading import parquet, sheet_cells  # noqa: F401
    from flexlash.validation.validate import validate

    headers: dict[int, RawValue] = {**dict(enumerate(columns_of("Variants"), start=1))}
    sheets = [RawSheet(name="Variants", rows={1: headers, 2: {1: "warm-up"}}), RawSheet(name="Notes", rows={})]
    submission = Submission(name="", sha256="", kind="workbook", sheets={sheet.name: sheet for sheet in sheets})
    validate(submission, ReadingLimits())


def carried_out(task: Callable[..., Any], limits: ReadingLimits, arguments: tuple[Any, ...]) -> Any:
    """Return what a task gives within limits, the Refusal or ChangedLibrary it raises, or the Fault that it has."""
    if _State.fault:
        return _State.fault
    try:
        with limited(limits):
            return task(*arguments)
    except (Refusal, ChangedLibrary) as answer:
        return answer
    except MemoryError:
        return limits.exceeded("memory_mebibytes")
    except BaseException as fault:  # noqa: BLE001
        # A library of Rust panics with what is no Exception; nothing may end this process without an answer.
        return Fault.of(fault)


def answered(
    task: Callable[..., Any],
    limits: ReadingLimits,
    arguments: tuple[Any, ...],
    then: Callable[[Any], Any] | None = None,
) -> Any:
    """Return what `carried_out` returns, or what follows from it within no limits, or the Fault that this has."""
    answer = carried_out(task, limits, arguments)
    if then is None or isinstance(answer, Refusal | ChangedLibrary | Fault):
        return answer
    try:
        return then(answer)
    except Exception as fault:  # noqa: BLE001
        return Fault.of(fault)


@contextlib.contextmanager
def limited(limits: ReadingLimits) -> Iterator[None]:
    """Limit time, memory, processor time and reach of this process meanwhile, as far as the system can."""
    with timed(limits.seconds):
        before = _lowered(limits)
        _State.handles_a_file = True
        try:
            yield
        finally:
            _State.handles_a_file = False
            _set(before)


def _lowered(limits: ReadingLimits) -> dict[int, int]:
    """Lower what this process may use to what it has used and the limits; return what it was allowed before."""
    try:
        import resource
    except ImportError:
        return {}
    wanted = {
        resource.RLIMIT_CPU: math.ceil(time.process_time()) + limits.processor_seconds,
        resource.RLIMIT_FSIZE: 0,
        resource.RLIMIT_CORE: 0,
    }
    if size := _address_space():
        wanted[resource.RLIMIT_AS] = size + limits.memory_mebibytes * _MEBI
    before = {kind: resource.getrlimit(kind)[0] for kind in wanted}
    _set(wanted)
    return before


def _address_space() -> int:
    """Return how much memory [bytes] this process has addressed; 0 where the system does not say."""
    try:
        import resource

        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
        return pages * resource.getpagesize()
    except (ImportError, OSError, ValueError):
        return 0


def _set(values: dict[int, int]) -> None:
    """Set soft limits of this process, none above its hard one."""
    for kind, value in values.items():
        import resource

        hard = resource.getrlimit(kind)[1]
        above = hard != resource.RLIM_INFINITY and (value == resource.RLIM_INFINITY or value > hard)
        with contextlib.suppress(OSError, ValueError):
            resource.setrlimit(kind, (hard if above else value, hard))


def _judge(event: str, arguments: tuple[Any, ...]) -> None:
    """Raise for anything that would reach outside of this process while it handles a file."""
    if _State.handles_a_file:
        forbid(event, arguments)


def forbid(event: str, arguments: tuple[Any, ...]) -> None:
    """Raise PermissionError for an audit event that writes, starts or calls anything."""
    if event == "open":
        mode, flags = arguments[1], arguments[2]
        writes = _WRITING & set(mode) if isinstance(mode, str) else flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT)
        if writes:
            raise PermissionError("reading may not write")
    elif event.startswith(_FORBIDDEN):
        raise PermissionError(f"reading may not use {event}")
