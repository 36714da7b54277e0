"""Files that stop or hang whoever reads them cost their own tries alone; the others are computed (R4)."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from functools import partial
from pathlib import Path

import pytest
from batch_runs import processes_of
from dispatching import BROKEN, DATA, GOOD, MIXED, QUICK, dispatching, ended, hand_in, opened, table
from poisoned import stopped_by_name

from flexlash import run
from flexlash.analysis.options import Options
from flexlash.batch.dask_executor import dask_executor
from flexlash.batch.local_executor import local_executor
from flexlash.reading.reading_limits import ReadingLimits

pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL, no limits here")]

LIMITED = Options(samples=64, limits=ReadingLimits(seconds=1, processor_seconds=1))


@pytest.fixture(scope="module")
def processes():
    """Return what opens two real workers, which stay between the tests."""
    with local_executor(2, tries=1) as executor:
        yield executor


@pytest.fixture
def store(tmp_path):
    """Return a store with its server's lock."""
    with opened(tmp_path / "store") as store:
        yield store
