"""A server in a process of its own: store and dispatcher, until nothing waits any more. Run, it takes a folder.

It writes a line of JSON for every so many submissions that have ended: how many, the seconds since it began, the memory
of the server and the most that a worker has [MiB], and the processor time of both [s] (Linux).
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path

__all__ = ["MEASURED", "STORE", "children_of", "served"]

MEASURED, STORE = "measured.jsonl", "store"
_EACH = 20
_PAGE, _TICKS = os.sysconf("SC_PAGE_SIZE") / 2**20, os.sysconf("SC_CLK_TCK")


def served(folder: Path, *options: object) -> subprocess.Popen:
    """Return a server of a store, begun."""
    return subprocess.Popen([sys.executable, __file__, str(folder), *map(str, options)], env=_environment())


def _environment():
    paths = [str(Path(__file__).resolve().parents[2] / "src"), str(Path(__file__).parent)]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}


def children_of(number: int) -> list[int]:
    """Return the workers that a process has started, without the process that tracks its semaphores."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            with suppress(OSError, ValueError):
                parent = int((entry / "stat").read_text().rpartition(")")[2].split()[1])
                if parent == number and b"resource_tracker" not in (entry / "cmdline").read_bytes():
                    found.append(int(entry.name))
    return found


def memory_of(number: int) -> float:
    """Return the resident memory of a process [MiB], 0 where it has ended."""
    with suppress(OSError):
        return int(Path(f"/proc/{number}/statm").read_text().split()[1]) * _PAGE
    return 0.0


def processor_seconds_of(number: int) -> float:
    """Return the processor time that a process has used so far [s]."""
    with suppress(OSError):
        fields = Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / _TICKS
    return 0.0


def _measured(done: int, begun: float) -> dict[str, float]:
    workers = children_of(os.getpid())
    return {
        "done": done,
        "seconds": time.monotonic() - begun,
        "server": memory_of(os.getpid()),
        "worker": max(map(memory_of, workers), default=0.0),
        "processor": sum(map(processor_seconds_of, [os.getpid(), *workers])),
    }


def _serve(folder: Path, workers: int, *, poisoned: bool) -> None:
    from dispatching import QUICK

    from flexlash.batch.local_executor import local_executor
    from flexlash.service import dispatcher as module
    from flexlash.service.log import Log
    from flexlash.service.store import Store

    if poisoned:
        from poison_files import stopped_by_name

        module.computed_apart = stopped_by_name
    stopped = threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: stopped.set())
    with Store(folder / STORE, serving=True) as store, (folder / "server.log").open("a") as log:
        dispatcher = module.Dispatcher(
            store, lambda: local_executor(workers, tries=1, warm=True), QUICK, Log(stream=log)
        )
        dispatcher.start()
        begun, told = time.monotonic(), 0
        with (folder / MEASURED).open("a") as lines:
            while not stopped.is_set():
                totals = store.totals()
                done = totals["done"] + totals["rejected"]
                is_over = not (totals["waiting"] or totals["working"])
                if done // _EACH > told // _EACH or is_over:
                    told = done
                    print(json.dumps(_measured(done, begun)), file=lines, flush=True)
                if is_over:
                    break
                stopped.wait(0.05)
        dispatcher.stop(1.0)


if __name__ == "__main__":
    _serve(Path(sys.argv[1]), int(sys.argv[2]), poisoned="poisoned" in sys.argv)
