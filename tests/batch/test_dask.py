"""The same work over Dask, with a scheduler and workers that are programs of their own, some of which are killed."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time

import pytest
import regenerate
from batch_runs import ENVIRONMENT
from dask_cluster import dask_cluster
from filled import SOUND, filled
from in_order import in_order
from worker_tasks import doubled, random_bytes, read_within, told

from flexlash import __version__
from flexlash.analysis.options import Options
from flexlash.batch import dask_executor as module
from flexlash.batch.answer import Answer, Task
from flexlash.batch.compute import compute
from flexlash.batch.dask_executor import ClusterError, MissingDaskError, dask_executor
from flexlash.batch.dask_work import OtherVersion, carried_out_here
from flexlash.batch.executor import WorkerLostError
from flexlash.batch.local_executor import local_executor
from flexlash.reading.read import Source

pytest.importorskip("distributed")

slow = pytest.mark.slow
kills = pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL, no limits here")

NUMBERS = b"import os; answer['x'] = [os.getppid(), os.getpid()]"


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """Return a scheduler with two workers, each of which is started anew by its nanny when it is lost."""
    with dask_cluster(tmp_path_factory.mktemp("dask")) as cluster:
        cluster.worker()
        cluster.worker()
        yield cluster


@pytest.fixture
def executor(cluster):
    """Return an executor of that scheduler, once both workers have come."""
    with dask_executor(cluster.address) as executor:
        end = time.monotonic() + 60
        while executor.workers < 2 and time.monotonic() < end:
            time.sleep(0.2)
        yield executor


def _tasks():
    """Return four submissions as tasks: two variants with several seeds, and one that is none."""
    two = filled([SOUND, {**SOUND, "variant": "thin", "wall_thickness_mm": 1.4}])
    for seed in range(3):
        options = Options(seed=seed, samples=128)
        yield Task(command="run", source=Source(name="two.xlsx", data=two), options=options, report=".xlsx").as_bytes()
    yield Task(command="check", source=Source(name="a.xlsx", data=b"PK\3\4nothing"), options=Options()).as_bytes()


@slow
@kills
def test_reports_are_those_of_local_processes_though_a_worker_is_killed(executor):
    """Submissions give the same bytes over Dask as in processes of this machine, with a worker killed among them."""
    with local_executor(2) as local:
        expected = [future.result() for future in in_order(local, compute, _tasks(), 4)]
    assert [Answer.of(answer).exit_code for answer in expected] == [0, 0, 0, 4]
    worker, process = json.loads(executor.submit(told, NUMBERS).result())["x"]
    killer = threading.Timer(0.5, os.kill, (worker, signal.SIGKILL))
    killer.start()
    found = [future.result() for future in in_order(executor, compute, [*_tasks(), *_tasks()], 4)]
    killer.join()
    assert found == expected * 2
    assert _is_gone(worker)
    assert _is_gone(process)


def _is_gone(number, within=20):
    end = time.monotonic() + within
    while time.monotonic() < end:
        try:
            os.kill(number, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.1)
    return False


def _workers(executor):
    """Return the processes of both workers of Dask."""
    found = set()
    while len(found) < 2:
        side_by_side = [executor.submit(told, NUMBERS + b"; import time; time.sleep(0.2)") for _ in range(2)]
        found |= {json.loads(future.result())["x"][0] for future in side_by_side}
    return found


@slow
@kills
def test_what_a_file_does_to_its_reader_costs_no_worker(executor):
    """A limit that is exceeded is named, a piece that kills its process three times is told; the workers stay."""
    before = _workers(executor)
    poison = executor.submit(read_within, b'{"seconds": 1}\nimport time; time.sleep(60)')
    others = [executor.submit(doubled, b"x") for _ in range(20)]
    with pytest.raises(WorkerLostError) as lost:
        poison.result()
    assert lost.value.setting == "seconds"
    with pytest.raises(WorkerLostError, match="3 times"):
        executor.submit(told, b"import os; os.kill(os.getpid(), 9)").result()
    with pytest.raises(RuntimeError, match="ZeroDivisionError"):
        executor.submit(told, b"1 / 0").result()
    assert [other.result() for other in others] == [b"xx"] * 20
    assert _workers(executor) == before


TELL = b"""
from flexlash.workers import tell
import time
for number in range(50):
    tell(b"%d" % number * 1000)
import random
tell(random.Random(1).randbytes(2**19))
tell(b"last")
time.sleep(2)
"""


@slow
def test_what_a_worker_tells_is_heard_meanwhile(executor):
    """Messages come in order while the work goes on, those of each piece alone; what is too long is not told."""
    heard, others = [], []
    future, beside = executor.submit(told, TELL, heard.append), executor.submit(told, b"1", others.append)
    end = time.monotonic() + 20
    while b"last" not in heard and time.monotonic() < end:
        time.sleep(0.05)
    assert not future.done()
    assert heard == [*(b"%d" % number * 1000 for number in range(50)), b"last"]
    assert (future.result(), beside.result(), others) == (b"{}", b"{}", [])


@slow
def test_large_pieces_come_back(executor):
    """A piece of 20 MiB, the largest workbook, and an answer twice as long pass without a warning."""
    data = bytes(20 * 2**20)
    assert executor.submit(doubled, data).result() == 2 * data


@slow
def test_another_version_is_refused(executor, monkeypatch):
    """A worker with another version of flexlash does nothing; the sentence names both versions."""
    monkeypatch.setattr(module, "__version__", "0.0.1")
    with pytest.raises(ClusterError, match=rf"has flexlash {__version__}, this is 0\.0\.1"):
        executor.submit(doubled, b"x").result()


CLIENT = """
import sys
sys.path[:0] = {paths!r}
from flexlash.batch.dask_executor import dask_executor
from worker_tasks import told
with dask_executor({address!r}) as executor:
    futures = [executor.submit(told, b"import time; time.sleep(0.5)") for _ in range(200)]
    futures[0].result()
    print("begun", flush=True)
    print([future.result() for future in futures])
"""


@slow
@kills
def test_what_a_killed_client_asked_for_is_dropped(executor, cluster):
    """The workers forget the pieces of a client that was killed, and are free for the next one."""
    paths = [str(regenerate.ROOT / one) for one in ("src", "tests/support")]
    code = CLIENT.format(paths=paths, address=cluster.address)
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as client:
        assert client.stdout.readline() == "begun\n"
        client.kill()
    begun = time.monotonic()
    assert [executor.submit(doubled, b"x").result() for _ in range(4)] == [b"xx"] * 4
    # 200 pieces of half a second would take two workers 50 s.
    assert time.monotonic() - begun < 20


@slow
@kills
def test_a_lost_scheduler_is_told(tmp_path):
    """When the scheduler is killed what was asked for ends at once with a sentence, and so does what comes after."""
    with dask_cluster(tmp_path) as cluster:
        cluster.worker("--no-nanny")
        with dask_executor(cluster.address) as executor:
            asked = [executor.submit(told, b"import time; time.sleep(60)") for _ in range(3)]
            time.sleep(0.5)
            cluster.scheduler.kill()
            begun = time.monotonic()
            for future in [*asked, executor.submit(doubled, b"x")]:
                with pytest.raises(ClusterError, match=f"^the Dask scheduler at {cluster.address} is not reachable$"):
                    future.result()
        assert time.monotonic() - begun < 10


@slow
@kills
def test_workers_come_and_go(tmp_path, monkeypatch):
    """A worker that comes later is counted and used; when all have gone for too long it is told."""
    monkeypatch.setattr(module, "_COUNTING", 0.2)
    monkeypatch.setattr(module, "_DESERTED", 1)
    with dask_cluster(tmp_path) as cluster:
        workers = [cluster.worker("--no-nanny")]
        with dask_executor(cluster.address) as executor:
            workers.append(cluster.worker("--no-nanny"))
            end = time.monotonic() + 60
            while executor.workers < 2 and time.monotonic() < end:
                time.sleep(0.1)
            assert executor.workers == 2
            asked = executor.submit(told, b"import time; time.sleep(60)")
            for worker in workers:
                worker.kill()
            with pytest.raises(ClusterError, match="has had no workers for 1 seconds"):
                asked.result()


@slow
def test_a_scheduler_of_its_own():
    """`local` needs nothing that runs already: as many pieces as asked for side by side, and nothing stays."""
    threads = threading.active_count()
    with dask_executor("local", 2) as executor:
        assert executor.workers == 2
        items = [f"{number} 1000000".encode() for number in range(6)]
        for item, future in zip(items, in_order(executor, random_bytes, items, 4), strict=True):
            assert future.result() == random_bytes(item)
        busy = [executor.submit(told, NUMBERS + b"; import time; time.sleep(1)") for _ in range(2)]
        numbers = [json.loads(future.result())["x"][1] for future in busy]
        executor.submit(told, b"import time; time.sleep(60)")
    assert len(set(numbers)) == 2
    if sys.platform != "win32":
        assert all(_is_gone(number) for number in numbers)
    end = time.monotonic() + 5
    while threading.active_count() > threads + 2 and time.monotonic() < end:
        time.sleep(0.1)
    assert threading.active_count() <= threads + 2, [t.name for t in threading.enumerate()]


def test_a_scheduler_can_be_opened_again():
    """A second scheduler answers in a process that loaded Dask with the first: a service may lose its first."""
    code = (
        "from flexlash.batch.dask_executor import dask_executor\n"
        "for _ in range(2):\n"
        "    with dask_executor('local', 1) as executor:\n"
        "        print(executor.submit(bytes.upper, b'done').result())\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], env=ENVIRONMENT, capture_output=True, text=True, check=False, timeout=120
    )  # fmt: skip
    assert done.stdout == "b'DONE'\nb'DONE'\n", done.stderr


def test_an_address_without_a_scheduler_is_told():
    """Where no scheduler answers the sentence says so; what is no address is told apart."""
    with (
        pytest.raises(ValueError, match=r"localhost is not the address .* tcp://HOST:PORT"),
        dask_executor("localhost"),
    ):
        pass


def test_without_dask_it_is_told(monkeypatch):
    """Where Dask is not installed the sentence says how to install it."""
    monkeypatch.setattr(module, "find_spec", lambda _: None)
    with pytest.raises(MissingDaskError, match=r"pip install 'flexlash\[dask\]'"), dask_executor("local"):
        pass


def test_a_worker_knows_its_version():
    """A worker that is asked by another version returns its own, and starts nothing."""
    answer = carried_out_here("0.0.1", doubled, b"x")
    assert isinstance(answer, OtherVersion)
    assert str(answer) == __version__
