"""Two services on one folder whose locks do not hold: each file becomes one submission of one of them."""

import os
import subprocess
import sys
import threading
from collections import Counter
from pathlib import Path

import pytest
from drop_folders import Service

_FILES = 8
_LONG = 200


def raced(root: Path) -> int:
    """Let two services race for the same files; require that nothing is lost or doubled, return how many they lost.

    Both see all files settled before either begins to claim.
    """
    with Service(root, "one", bypassing=True) as one, Service(root, "two", bypassing=True) as two:
        files = {f"{number}.csv": f"{root.name} {number}\n".encode() for number in range(_FILES)}
        for name, data in files.items():
            one.put(name, data)
        services, gate, looked = (one, two), threading.Barrier(2), Counter()
        for service in services:
            for _ in range(2):
                service.folder.step()
                service.now += 2
            service.now += 4
            ready = service.folder._inbox._ready

            def held(ready=ready):
                found = ready()
                looked.update(path.path.name for path in found)
                gate.wait()
                return found

            service.folder._inbox._ready = held
        steps = [threading.Thread(target=service.folder.step) for service in services]
        for step in steps:
            step.start()
        for step in steps:
            step.join()
        for service in services:
            del service.folder._inbox.__dict__["_ready"]
            service.settle()
        accepted = Counter(sub.name for service in services for sub in service.submissions())
        assert accepted == dict.fromkeys(files, 1)
        assert one.originals() == dict.fromkeys(files.items(), 1)
        assert set(one.originals("done")) == set(files.items())
        assert len(one.delivered) == len(files)
        left = [*one.inbox.iterdir(), *(folder for it in services for folder in it.places.claimed(it.store.name))]
        assert left == []
        return looked.total() - len(files)


@pytest.mark.slow
def test_r12_two_services_race_for_the_same_files(tmp_path):
    """In ten races of two services for eight files nothing is lost, doubled or altered, nor an empty ID left."""
    contested = sum(raced(tmp_path / str(number)) for number in range(10))
    assert contested == 10 * _FILES


@pytest.mark.long
@pytest.mark.slow
def test_r12_two_hundred_races(tmp_path):
    """The same two hundred times."""
    contested = sum(raced(tmp_path / str(number)) for number in range(_LONG))
    assert contested == _LONG * _FILES


_SERVICE = """
import sys
from pathlib import Path
from drop_folders import Service
root, name = Path(sys.argv[1]), sys.argv[2]
with Service(root, name, bypassing=True) as service:
    for _ in range(4):
        service.folder._inbox._ready()
        service.now += 2
    print("ready", flush=True)
    sys.stdin.readline()
    service.settle()
    service.settle()
    print(len(service.submissions()), flush=True)
"""


def processes_raced(root: Path) -> list[int]:
    """Let two processes race for the same files; return how many each got."""
    (root / "in").mkdir(parents=True)
    files = {f"{number}.csv": f"{root.name} {number}\n".encode() for number in range(40)}
    for name, data in files.items():
        (root / "in" / name).write_bytes(data)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    started = [
        subprocess.Popen(
            [sys.executable, "-c", _SERVICE, str(root), name],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment,
        )
        for name in ("one", "two")
    ]  # fmt: skip
    for service in started:
        assert service.stdout.readline() == "ready\n"
    for service in started:
        service.stdin.write("\n")
        service.stdin.flush()
    got = [int(service.communicate()[0]) for service in started]
    assert all(service.returncode == 0 for service in started)
    originals = Counter((path.name, path.read_bytes()) for path in (root / "out" / "done").rglob("*.csv"))
    assert originals == dict.fromkeys(files.items(), 1)
    assert sum(got) == len(files)
    return got


@pytest.mark.slow
def test_r12_two_processes_race_for_the_same_files(tmp_path):
    """Neither loses or doubles what the other claims, as processes that share nothing but the folder."""
    processes_raced(tmp_path / "race")


@pytest.mark.long
@pytest.mark.slow
def test_r12_fifty_races_of_processes(tmp_path):
    """The same fifty times; both get their share, so that they did race."""
    got = [processes_raced(tmp_path / str(number)) for number in range(50)]
    assert sum(min(one) > 0 for one in got) > 10
