"""One line an event, for whoever looks after the service: words, or JSON."""

from __future__ import annotations

import json
import sys
import threading
import time
from typing import TextIO

from flexlash.schema.findings import shown

__all__ = ["Log"]

_LONGEST = 400


class Log:
    """Lines on standard error, whole also where several threads write them.

    What stands in them is on one line and without control characters, whatever it came from.
    """

    def __init__(self, *, as_json: bool = False, stream: TextIO | None = None) -> None:
        self._as_json = as_json
        self._stream = stream
        self._writing = threading.Lock()

    def say(self, event: str, submission: str = "", **facts: object) -> None:
        """Write the line of an event, by whose name it can be searched, about a submission's ID, with further facts."""
        now = time.strftime("%Y-%m-%dT%H:%M:%S%z")
        known = {"at": now, "event": event} | ({"submission": submission} if submission else {}) | facts
        if self._as_json:
            line = json.dumps({key: value if isinstance(value, int | float) else shown(value, _LONGEST)
                               for key, value in known.items()})  # fmt: skip
        else:
            told = [f"{key}={shown(value, _LONGEST)}" for key, value in facts.items()]
            line = " ".join(filter(None, [now, event, submission, *told]))
        with self._writing:
            print(line, file=self._stream or sys.stderr, flush=True)
