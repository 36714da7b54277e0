"""Small workbooks through the service: throughput, findings, hand-back, memory; a million rows beside them.

    python tests/benchmarks/service.py [--workbooks N] [--rows N]

A server runs in a process of its own (`tests/support/service_process.py`) and is watched in /proc (Linux only). Printed
are submissions a second with one worker and with two and the ratio, processor time of each submission, the server's
memory after 20, 200 and all and the most that a worker has, the time from handing in to the findings and to the report
of a small workbook, and from the end of a killed worker to the next beginning. With `--rows` a table of so many rows is
computed as well, and small workbooks handed in meanwhile. Quote the ratios of a quiet machine.
"""

from __future__ import annotations

import argparse
import io
import json
import os
import signal
import statistics
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

from dispatching import QUICK, hand_in, table
from filled import SOUND, filled
from service_process import MEASURED, STORE, children_of, served

from flexlash.batch.local_executor import local_executor
from flexlash.service.dispatcher import Dispatcher
from flexlash.service.log import Log
from flexlash.service.store import Store

SMALL = 3
"""Rows of a small workbook."""


def workbooks(count: int) -> list[bytes]:
    """Return small workbooks that differ."""
    return [
        filled([{**SOUND, "variant": f"v{number}-{row}", "torque_Nm": 700 + row} for row in range(SMALL)])
        for number in range(count)
    ]


def throughput(files: list[bytes], workers: int) -> list[dict[str, float]]:
    """Return what was measured while these were computed."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        with Store(folder / STORE, serving=True) as store:
            for number, data in enumerate(files):
                hand_in(store, data, f"{number}.xlsx")
        served(folder, workers).wait()
        return [json.loads(line) for line in (folder / MEASURED).read_text().splitlines()]


def told(files: list[bytes], workers: int, measured: list[dict[str, float]]) -> float:
    """Print what was measured; return submissions a second once all workers were busy."""
    first, last = measured[0], measured[-1]
    rate = (last["done"] - first["done"]) / (last["seconds"] - first["seconds"])
    each = (last["processor"] - first["processor"]) / (last["done"] - first["done"])
    later = next((one for one in measured if one["done"] >= 200), last)
    print(f"{workers} workers: {len(files)} workbooks, {rate:.2f} a second, {each:.2f} s of processor time each")
    servers = [f"{one['server']:.1f} MiB after {one['done']}" for one in (first, later, last)]
    print(f"  server {', '.join(servers)}; worker {first['worker']:.0f} MiB, {last['worker']:.0f} at the end")
    return rate


def latency(files: list[bytes], rows: int) -> None:
    """Print how long findings and reports take, how soon a killed worker's piece is begun again, and beside a table."""
    with tempfile.TemporaryDirectory() as name, Store(Path(name) / STORE, serving=True) as store:
        dispatcher = Dispatcher(store, lambda: local_executor(2, 1, warm=True), QUICK, Log(stream=io.StringIO()))
        dispatcher.start()
        while not dispatcher.workers:
            time.sleep(0.1)
        time.sleep(8)
        print("first", _waited(store, dispatcher, files[0], "first.xlsx"))
        found = [_waited(store, dispatcher, data, f"{number}.xlsx") for number, data in enumerate(files[1:21])]
        for place, what in enumerate(("findings", "report")):
            seconds = [one[place] for one in found]
            print(f"{what}: median {statistics.median(seconds):.2f} s, most {max(seconds):.2f} s after handing in")
        print(f"hand-back after a killed worker: {_handed_back(store, dispatcher, files[21]):.3f} s")
        if rows:
            large = hand_in(store, table(*(500 + number % 400 for number in range(rows))), "large.csv")
            dispatcher.wake()
            begun = time.monotonic()
            while not store.submission(large).rows_done and not store.submission(large).has_ended:
                time.sleep(0.1)
            found = []
            while not store.submission(large).has_ended and len(found) < 20:
                found.append(_waited(store, dispatcher, files[22 + len(found)], f"beside-{len(found)}.xlsx"))
            seconds = [one[1] for one in found]
            print(f"beside {rows:,} rows: report median {statistics.median(seconds):.2f} s, most {max(seconds):.2f} s")
            while not store.submission(large).has_ended:
                time.sleep(0.1)
            print(f"{rows:,} rows: {time.monotonic() - begun:.0f} s")
        dispatcher.stop(1.0)


def _waited(store: Store, dispatcher: Dispatcher, data: bytes, name: str) -> tuple[float, float]:
    """Return seconds until the findings of a workbook are there, and until its report is."""
    begun = time.monotonic()
    id_ = hand_in(store, data, name)
    dispatcher.wake()
    checked = 0.0
    while not (known := store.submission(id_)).has_ended:
        if known.counts and not checked:
            checked = time.monotonic() - begun
        time.sleep(0.01)
    ended = time.monotonic() - begun
    return checked or ended, ended


def _handed_back(store: Store, dispatcher: Dispatcher, data: bytes) -> float:
    """Return the seconds from the end of a worker to the next beginning of what it had."""
    id_ = hand_in(store, data, "killed.xlsx")
    dispatcher.wake()
    while store.submission(id_).state != "working":
        time.sleep(0.001)
    time.sleep(0.05)
    killed = time.time()
    for number in children_of(os.getpid()):
        os.kill(number, signal.SIGKILL)
    while not store.submission(id_).has_ended:
        time.sleep(0.01)
    again = [one["at"] for one in store.events(id_) if one["kind"] == "begun" and one["at"] > killed]
    return min(again) - killed if again else float("nan")


def main() -> None:
    """Measure all of it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--workbooks", type=int, default=500)
    parser.add_argument("--rows", type=int, default=0)
    chosen = parser.parse_args()
    files = workbooks(max(chosen.workbooks, 45))
    latency(files, chosen.rows)
    one, two = (told(files, workers, throughput(files[: chosen.workbooks], workers)) for workers in (1, 2))
    print(f"two workers to one: {two / one:.2f}")


if __name__ == "__main__":
    main()
