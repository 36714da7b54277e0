"""Whole runs over a folder in processes of their own, which may be stopped, and what they leave."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from flexlash.batch.manifest import MANIFEST_NAME
from flexlash.schema.stamps import stamp_at

SOURCE = Path(__file__).resolve().parents[2] / "src"
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(SOURCE)}


def begun(folder: Path, *more: object, code: str = "from flexlash.cli import main; main()", **how) -> subprocess.Popen:
    """Return a run of all submissions of `in` into `out` in a folder, in a session of its own."""
    arguments = ["run", "in", "-o", "out", "--samples", "64", "--jobs", "2", *map(str, more)]
    command = [sys.executable, "-c", f"if __name__ == '__main__':\n  import sys; {code}", *arguments]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen(command, cwd=folder, env=ENVIRONMENT, start_new_session=True, **pipes | how)


def ended(run: subprocess.Popen) -> tuple[int, str, str]:
    """Return exit code, standard output and error of a run."""
    out, err = run.communicate(timeout=300)
    return run.returncode, out, err


def outputs(folder: Path) -> dict[str, bytes]:
    """Return all that is in `out`, but the manifest and temporary files, by its place."""
    found = (path for path in (folder / "out").rglob("*") if path.is_file() and not path.name.startswith("."))
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in found}


def parts(folder: Path) -> list[str]:
    """Return the files in `out` that are not whole."""
    return [name for name in outputs(folder) if not stamp_at(folder / name)]


def done(folder: Path) -> int:
    """Return how many submissions the manifest says are done."""
    path = folder / "out" / MANIFEST_NAME
    return max(0, path.read_bytes().count(b"\n") - 1) if path.exists() else 0


def stopped(run: subprocess.Popen, folder: Path, *, after: int, how: int = signal.SIGKILL) -> None:
    """Send a run a signal once so many submissions are done."""
    while done(folder) < after and run.poll() is None:
        time.sleep(0.01)
    os.killpg(run.pid, how) if how != signal.SIGKILL else run.kill()


def processes_of(session: int) -> list[int]:
    """Return the processes that live in a session (Linux)."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                state, _, _, its_session = (entry / "stat").read_text().rpartition(")")[2].split()[:4]
            except (OSError, ValueError):
                continue
            if int(its_session) == session and state != "Z":
                found.append(int(entry.name))
    return found


def none_left(session: int, seconds: float = 10) -> bool:
    """Return whether all processes of a session end soon."""
    end = time.monotonic() + seconds
    while processes_of(session) and time.monotonic() < end:
        time.sleep(0.05)
    return not processes_of(session)
