"""The limited process: everything that a stranger's file could attack happens here, and only words come back.

It takes a line of JSON (the task, its facts, the limits) and the file's bytes from its standard input and answers with
a line of JSON and, for some tasks, bytes. It may use only so much memory and time and may not write, start or call
anything. Where the system cannot limit a process (Windows), the parent's clock remains.
"""

from __future__ import annotations

import contextlib
import importlib
import json
import os
import sys
import traceback
from collections.abc import Callable
from typing import Any, BinaryIO

from flexlash.submission.reading.limits import ReadingLimits
from flexlash.submission.reading.refusal import Refusal

__all__ = ["TASKS", "Answer", "answer", "main"]

Answer = tuple[dict[str, Any], bytes]
"""What a task gives: what JSON can hold, and bytes."""

_MEBI = 2**20
_RESERVED = {"parquet": 1024}
"""Address space [MiB] that a task's library reserves without using it."""


def _workbook(data: bytes, limits: ReadingLimits) -> Answer:
    from flexlash.submission.reading.wire import to_wire
    from flexlash.submission.reading.workbook import read_workbook

    return to_wire(read_workbook(data, limits)), b""


def _report(data: bytes, limits: ReadingLimits) -> Answer:
    from flexlash.submission.reading.carried import read_report

    return read_report(data, limits), b""


def _parquet(data: bytes, limits: ReadingLimits) -> Answer:
    from flexlash.submission.reading.parquet import read_parquet
    from flexlash.submission.reading.wire import to_wire

    return to_wire(read_parquet(data, limits)), b""


def _leftovers(data: bytes, limits: ReadingLimits) -> Answer:
    from flexlash.submission.templating.leftovers import leftovers

    return leftovers(data, limits), b""


def _mark(data: bytes, limits: ReadingLimits, findings: list[dict[str, Any]], name: str) -> Answer:  # noqa: ARG001
    from flexlash.findings import Finding
    from flexlash.submission.marking.marked_copy import marked_copy

    copy = marked_copy(data, [Finding(**found) for found in findings], name)
    return {"lost": copy.lost}, copy.data


def _mend(data: bytes, limits: ReadingLimits, repairs: list[dict[str, Any]]) -> Answer:
    from flexlash.submission.mending.mended_workbook import mended_workbook
    from flexlash.submission.mending.repair import Repair

    new, made = mended_workbook(data, [Repair(**repair) for repair in repairs], limits)
    return {"made": [repair.as_dictionary() for repair in made]}, new


TASKS: dict[str, Callable[..., Answer]] = {
    "workbook": _workbook,
    "report": _report,
    "parquet": _parquet,
    "leftovers": _leftovers,
    "mark": _mark,
    "mend": _mend,
}
_NEEDED = {
    "workbook": ("flexlash.submission.reading.wire", "flexlash.submission.reading.sheet_cells"),
    "report": ("flexlash.submission.reading.carried", "flexlash.submission.reading.sheet_cells"),
    "parquet": ("flexlash.submission.reading.wire", "polars"),
    "leftovers": ("flexlash.submission.templating.leftovers",),
    "mark": ("flexlash.submission.marking.marked_copy",),
    "mend": ("flexlash.submission.mending.mended_workbook",),
}
"""What each task imports, before writing is forbidden."""


def answer(task: str, data: bytes, limits: ReadingLimits, **facts: Any) -> Answer:
    """Return a task's answer; a refusal is an answer as well."""
    try:
        return TASKS[task](data, limits, **facts)
    except Refusal as refusal:
        traceback.print_exc()
        return {"refusal": [refusal.code, refusal.facts]}, b""
    except MemoryError:
        return _too_large(limits), b""
    except Exception:  # noqa: BLE001
        traceback.print_exc()
        return {"refusal": ["E118", {}]}, b""


def _reply(task: str, limits: ReadingLimits, facts: dict[str, Any]) -> tuple[bytes, bytes]:
    """Return the answer's line and bytes; an answer that memory cannot hold is a refusal as well."""
    try:
        head, payload = answer(task, sys.stdin.buffer.read(), limits, **facts)
        return json.dumps(head).encode() + b"\n", payload
    except MemoryError:
        return json.dumps(_too_large(limits)).encode() + b"\n", b""


def _too_large(limits: ReadingLimits) -> dict[str, Any]:
    refusal = limits.exceeded("memory_mebibytes")
    return {"refusal": [refusal.code, refusal.facts]}


def _limit(task: str, limits: ReadingLimits) -> None:
    """Limit memory, computing time and writing of this process as far as the system can."""
    try:
        import resource
    except ImportError:
        return
    memory = (limits.memory_mebibytes + _RESERVED.get(task, 0)) * _MEBI
    wanted = {
        resource.RLIMIT_AS: memory,
        resource.RLIMIT_CPU: limits.processor_seconds,
        resource.RLIMIT_FSIZE: 0,
        resource.RLIMIT_CORE: 0,
    }
    for kind, value in wanted.items():
        hard = resource.getrlimit(kind)[1]
        least = value if hard == resource.RLIM_INFINITY else min(value, hard)
        with contextlib.suppress(OSError, ValueError):
            resource.setrlimit(kind, (least, hard if kind == resource.RLIMIT_CPU else least))


_FORBIDDEN = (
    "socket.", "subprocess.", "os.system", "os.exec", "os.posix_spawn", "os.spawn", "os.fork", "os.remove", "os.rename",
    "os.mkdir", "os.rmdir", "os.link", "os.symlink", "os.chmod", "os.truncate", "shutil.", "ctypes.dlopen", "urllib.",
)  # fmt: skip
_WRITING = frozenset("wax+")


def _forbid(event: str, arguments: tuple[Any, ...]) -> None:
    """Raise for anything that would reach outside of this process."""
    if event == "open":
        mode, flags = arguments[1], arguments[2]
        writes = _WRITING & set(mode) if isinstance(mode, str) else flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT)
        if writes:
            raise PermissionError("reading may not write")
    elif event.startswith(_FORBIDDEN):
        raise PermissionError(f"reading may not use {event}")


def main() -> None:
    """Answer one request from standard input, alone in this process."""
    out: BinaryIO = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    # NumPy is not needed here; without it openpyxl loads in half the time, and no threads reserve memory.
    sys.modules["numpy"] = None  # type: ignore[assignment]
    request = json.loads(sys.stdin.buffer.readline())
    if request["task"] == "parquet":
        del sys.modules["numpy"]
    for module in _NEEDED[request["task"]]:
        importlib.import_module(module)
    limits = ReadingLimits(**request["limits"])
    _limit(request["task"], limits)
    sys.addaudithook(_forbid)
    out.writelines(_reply(request["task"], limits, request["facts"]))
    out.flush()
    os._exit(0)


if __name__ == "__main__":
    main()
