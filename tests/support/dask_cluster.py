"""A scheduler of Dask and workers as real programs of this computer, which have ended when the context is left."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from contextlib import contextmanager

import regenerate

__all__ = ["DaskCluster", "dask_cluster"]


class DaskCluster:
    """A scheduler and the workers that were started for it."""

    def __init__(self, folder):
        self._folder = folder
        self._programs = []
        file = folder / "scheduler.json"
        self.scheduler = self._start(
            "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--dashboard-address", "127.0.0.1:0",
            "--scheduler-file", str(file),
        )  # fmt: skip
        while not file.exists() or not file.read_text(encoding="utf-8").endswith("}"):
            assert self.scheduler.poll() is None
            time.sleep(0.05)
        self.address = json.loads(file.read_text(encoding="utf-8"))["address"]

    def worker(self, *options):
        """Start a worker of one thread."""
        return self._start(
            "worker", self.address, "--nthreads", "1", "--host", "127.0.0.1", "--no-dashboard", "--death-timeout", "60",
            *options,
        )  # fmt: skip

    def _start(self, what, *options):
        paths = [str(regenerate.ROOT / one) for one in ("src", "tests/support")]
        with (self._folder / f"{what}.log").open("ab") as log:
            program = subprocess.Popen(
                [sys.executable, "-m", f"distributed.cli.dask_{what}", *options],
                stdout=log, stderr=log, cwd=self._folder, env={**os.environ, "PYTHONPATH": os.pathsep.join(paths)},
            )  # fmt: skip
        self._programs.append(program)
        return program

    def end(self):
        """End all programs, the workers first."""
        for program in reversed(self._programs):
            program.terminate()
        for program in self._programs:
            try:
                program.wait(10)
            except subprocess.TimeoutExpired:
                program.kill()
                program.wait()


@contextmanager
def dask_cluster(folder):
    """Give a scheduler without workers, whose logs lie in a folder."""
    cluster = DaskCluster(folder)
    try:
        yield cluster
    finally:
        cluster.end()
