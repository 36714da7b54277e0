"""Asking the limited process: a file's bytes go in, what it holds comes back, whatever the file does to its reader."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import flexlash
from flexlash.findings import finding
from flexlash.submission.reading.child import Answer
from flexlash.submission.reading.limits import ReadingLimits
from flexlash.submission.reading.refusal import Refusal

__all__ = ["Asked", "ask"]

_START = "import sys; sys.path.append(sys.argv[1]); from flexlash.submission.reading.child import main; main()"
_ENVIRONMENT = {"POLARS_MAX_THREADS": "1", "RUST_BACKTRACE": "0", "OPENBLAS_NUM_THREADS": "1"}


def ask(task: str, data: bytes, limits: ReadingLimits, **facts: Any) -> Answer:
    """Return what a task of the limited process gives.

    Raises Refusal when the file is refused, exceeds a limit or stops the process, OSError when no process can be
    started.
    """
    return Asked(task, data, limits, **facts).answer()


class Asked:
    """A request under way; its caller can do something else until it wants the answer."""

    def __init__(self, task: str, data: bytes, limits: ReadingLimits, **facts: Any) -> None:
        self.limits = limits
        head = {"task": task, "facts": facts, "limits": limits.as_dictionary()}
        # -I: neither the working folder nor the user's variables can put other code in the way.
        self.process = subprocess.Popen(  # noqa: S603
            [sys.executable, "-I", "-c", _START, str(Path(flexlash.__file__).parent.parent)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=None if os.environ.get("FLEXLASH_DEBUG") == "1" else subprocess.DEVNULL,
            env={**os.environ, **_ENVIRONMENT},
        )
        self.out = b""
        self.too_slow = False
        request = json.dumps(head).encode() + b"\n" + data
        self.talk = threading.Thread(target=self._talk, args=(request,), daemon=True)
        self.talk.start()

    def _talk(self, request: bytes) -> None:
        """Hand over the request and collect the answer, within the time allowed."""
        try:
            self.out, _ = self.process.communicate(request, timeout=self.limits.seconds)
        except subprocess.TimeoutExpired:
            self.too_slow = True
            self.stop()
            for pipe in (self.process.stdin, self.process.stdout):
                with contextlib.suppress(OSError):
                    pipe.close()  # type: ignore[union-attr]

    def stop(self) -> None:
        """End the process, whatever it is doing."""
        self.process.kill()
        self.process.wait()

    def answer(self) -> Answer:
        """Wait for the answer and return it; raise Refusal when there is none."""
        try:
            self.talk.join()
        except BaseException:
            self.stop()
            raise
        head, end, payload = self.out.partition(b"\n")
        if not end:
            raise self._failure()
        found, refusal = _understood(head)
        if refusal:
            raise refusal
        return found, payload

    def _failure(self) -> Refusal:
        """Return what a process that gave no answer died of."""
        if self.too_slow:
            return self.limits.exceeded("seconds")
        if self.process.wait() == -getattr(signal, "SIGXCPU", 0):
            return self.limits.exceeded("processor_seconds")
        return Refusal("E118")


def _understood(head: bytes) -> tuple[dict[str, Any], Refusal | None]:
    """Return what the process says and its refusal; nonsense is a refusal as well, since a file may have made it."""
    try:
        found = json.loads(head)
        if "refusal" not in found:
            return dict(found), None
        code, facts = found["refusal"]
        finding(code, **{"file": "", **facts})
        return found, Refusal(code, **facts)
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return {}, Refusal("E118")
