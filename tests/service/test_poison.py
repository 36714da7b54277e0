"""Files that stop or hang whoever reads them cost their own tries alone; the others are computed (R4)."""

from __future__ import annotations

import sys
import time
from contextlib import nullcontext
from functools import partial
from importlib.util import find_spec
from pathlib import Path

import pytest
from dispatching import BROKEN, DATA, MIXED, dispatching, ended, hand_in, opened, table
from poison_files import stopped_by_name

from flexlash import run
from flexlash.analysis.options import Options
from flexlash.batch.dask_executor import dask_executor
from flexlash.batch.local_executor import local_executor
from flexlash.reading.reading_limits import ReadingLimits

pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL, no limits here")]

LIMITED = Options(samples=64, limits=ReadingLimits(seconds=4, processor_seconds=1))


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


def _shared(executor):
    """Return what opens an executor that stays."""
    return lambda: nullcontext(executor)


def test_r4_poison_costs_three_tries_and_the_others_are_done(store, processes, monkeypatch):
    """Files that kill, hang or occupy their reader are rejected with that reason; all others are done meanwhile."""
    monkeypatch.setattr("flexlash.service.dispatcher.computed_apart", stopped_by_name)
    poison = ["kills-1.csv", "hangs-1.csv", "kills-2.csv", "loops-1.csv"]
    ids = {name: hand_in(store, name=name) for name in poison}
    fine = [hand_in(store, table(800, mark=str(number)), f"{number}.csv") for number in range(6)]
    begun = time.monotonic()
    with dispatching(store, _shared(processes), LIMITED) as dispatcher:
        assert [one.state for one in ended(store, *fine)] == ["done"] * 6
        found = dict(zip(ids, ended(store, *ids.values()), strict=True))
    assert time.monotonic() - begun < 60
    assert {one.state for one in found.values()} == {"rejected"}
    for name in ("kills-1.csv", "kills-2.csv"):
        assert found[name].reason == f"{name} stopped the worker 3 times, so it was not computed."
        assert dispatcher.lines.getvalue().count(f"worker lost {ids[name]}") == 3
    assert "the time for reading" in found["hangs-1.csv"].reason
    assert "time for reading" in found["loops-1.csv"].reason
    assert [one.tries for one in store.history(most=10) if one.id in fine] == [0] * 6


def test_work_of_a_killed_worker_is_handed_back_within_a_second(store, processes, monkeypatch):
    """From the end of the worker to the next beginning it takes less than a second."""
    monkeypatch.setattr("flexlash.service.dispatcher.computed_apart", stopped_by_name)
    with dispatching(store, _shared(processes), LIMITED):
        id_ = hand_in(store, name="kills-1.csv")
        ended(store, id_)
    events = [(one["kind"], one["at"]) for one in reversed(store.events(id_))]
    back = [at for kind, at in events if kind == "handed back"]
    again = [at for kind, at in events if kind == "begun"][1:]
    assert len(back) == len(again) == 2
    assert max(second - first for first, second in zip(back, again, strict=True)) < 1


SUBMISSIONS = {
    "study.xlsx": (DATA / "b3-160-study.xlsx").read_bytes(),
    "fixing.xlsx": (DATA / "needs-fixing.xlsx").read_bytes(),
    "mixed.csv": MIXED,
    "broken.csv": BROKEN,
}


def _results(folder, opening):
    """Return the files of all results but those that name a submission's ID, by submission and kind."""
    with opened(folder) as store, dispatching(store, opening) as dispatcher:
        ids = {name: hand_in(store, content, name) for name, content in SUBMISSIONS.items()}
        dispatcher.wake()
        ended(store, *ids.values(), seconds=120)
        return {
            (name, role): store.blobs.read(file.sha256)
            for name, id_ in ids.items()
            for role, file in store.files(id_).items()
            if role != "reasons"
        }


def test_files_are_those_of_the_command_whoever_computes_them(tmp_path, processes):
    """One worker, two, and Dask give the same bytes, which are those of `flexlash.run`."""
    found = _results(tmp_path / "two", _shared(processes))
    assert {role for _, role in found} == {"report", "results", "checked", "fixed", "outcome", "page"}
    assert _results(tmp_path / "one", partial(local_executor, 1, tries=1)) == found
    if find_spec("distributed"):
        assert _results(tmp_path / "dask", partial(dask_executor, "local", 2)) == found
    for name, content in SUBMISSIONS.items():
        (tmp_path / name).write_bytes(content)
        stem = Path(name).stem
        report, copy = tmp_path / f"{stem}-report.xlsx", tmp_path / f"{stem}-checked.xlsx"
        run(tmp_path / name, report, marked_copy=copy, samples=64)
        assert found.get((name, "report")) == (report.read_bytes() if report.exists() else None)
        assert found.get((name, "checked")) == (copy.read_bytes() if copy.exists() else None)
        results = tmp_path / f"{stem}.csv2" / "results.csv"
        results.parent.mkdir()
        run(tmp_path / name, results, samples=64)
        assert found.get((name, "results")) == (results.read_bytes() if results.exists() else None)
