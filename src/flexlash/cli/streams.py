"""Standard streams that bear what happens to them: none at all, a reader that leaves, a full disk."""

from __future__ import annotations

import errno
import io
import os
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

__all__ = ["lost_output", "patient_streams"]

_NAMES = ("stdout", "stderr")
_HANDLES = 3
"""Standard input, output and error are the handles 0, 1 and 2."""

_READER_LEFT = frozenset({errno.EPIPE} | ({errno.EINVAL} if os.name == "nt" else set()))
"""What a system says of a pipe that nobody reads any more; that is no fault."""


class _Patient(io.RawIOBase):
    """A stream to which everything can be written; what nobody takes is dropped, and `fault` says why."""

    def __init__(self, raw: io.RawIOBase) -> None:
        self.raw = raw
        self.is_left = False
        self.fault: OSError | None = None

    def writable(self) -> bool:
        """Return that it can be written to."""
        return True

    def fileno(self) -> int:
        """Return the handle of the stream itself."""
        return self.raw.fileno()

    def isatty(self) -> bool:
        """Return whether the stream itself is a terminal."""
        return self.raw.isatty()

    def write(self, data: ReadableBuffer, /) -> int | None:
        """Write as much as the stream takes at once; return how many bytes are done with."""
        if not self.is_left:
            try:
                return self.raw.write(data)
            except OSError as fault:
                self.is_left = True
                self.fault = None if fault.errno in _READER_LEFT else fault
        return memoryview(data).nbytes


@contextmanager
def patient_streams() -> Iterator[None]:
    """Let everything be written to standard output and error, whatever they are; a character they lack is escaped."""
    with ExitStack() as stack:
        _reserve_handles()
        for name in _NAMES:
            stack.enter_context(_patient(name))
        yield


def lost_output() -> OSError | None:
    """Return why standard output could not be written, None where it was or where its reader had enough of it."""
    sys.stdout.flush()
    raw = getattr(getattr(sys.stdout, "buffer", None), "raw", None)
    return raw.fault if isinstance(raw, _Patient) else None


def _reserve_handles() -> None:
    """Let no file that is opened later become a standard stream because that was closed."""
    while (handle := os.open(os.devnull, os.O_RDWR)) < _HANDLES:
        os.set_inheritable(handle, True)
    os.close(handle)


@contextmanager
def _patient(name: str) -> Iterator[None]:
    """Put a patient stream in the place of one, unless somebody else has done so."""
    stream: IO[str] | None = getattr(sys, name)
    raw = None if stream is None else getattr(stream, "buffer", None)
    raw = getattr(raw, "raw", raw)
    if stream is None or stream.closed:
        new: IO[str] = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115
    elif isinstance(stream, io.TextIOWrapper) and isinstance(raw, io.RawIOBase) and not isinstance(raw, _Patient):
        stream.flush()
        new = io.TextIOWrapper(
            io.BufferedWriter(_Patient(raw)),
            encoding=stream.encoding,
            errors="backslashreplace",
            line_buffering=stream.line_buffering,
            write_through=stream.write_through,
        )
    else:
        yield
        return
    setattr(sys, name, new)
    try:
        yield
    finally:
        new.close()
        setattr(sys, name, stream)
