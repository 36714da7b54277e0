"""The memory of the server: what it holds does not grow with what it has served."""

import csv
import io
import re
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest
from filled import SOUND

JSON = {"accept": "application/json"}
SCRIPT = "import sys; sys.path[:0] = {paths!r}; from flexlash.cli import main; sys.argv[1:] = {arguments!r}; main()"


def _table(number):
    text = io.StringIO()
    writer = csv.DictWriter(text, list(SOUND))
    writer.writeheader()
    writer.writerow({**SOUND, "torque_Nm": 500 + number})
    return text.getvalue().encode()


def _used(process):
    """Return the memory of a process in kB."""
    status = Path(f"/proc/{process.pid}/status").read_text(encoding="utf-8")
    return int(re.search(r"VmRSS:\s+(\d+)", status)[1])


@contextmanager
def _serving(folder):
    """Yield a server, as the command starts it, and a program that asks it."""
    arguments = ["serve", "--store", str(folder / "store"), "--port", "0", "--workers", "1"]
    script = SCRIPT.format(paths=[path for path in sys.path if path], arguments=arguments)
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as server:
        try:
            address = re.search(r"http://\S+", server.stdout.readline())[0]
            with httpx.Client(base_url=address, timeout=60) as client:
                yield server, client
        finally:
            server.terminate()
            server.wait(40)


def _ended(client, name, content):
    """Hand a submission in, and return its address once it has ended."""
    token = client.get("/", headers=JSON).json()["token"]
    files = {"file": (name, content)}
    where = client.post("/submissions", data={"token": token}, files=files, headers=JSON).headers["location"]
    while client.get(where, headers=JSON).json()["state"] not in {"done", "rejected"}:
        time.sleep(0.02)
    return where


def _served(client, number):
    """Hand a submission in, wait until it is done, and look at all of its pages."""
    where = _ended(client, f"part-{number % 10}.csv", _table(number))
    for path in (where, f"{where}/variants/0", f"{where}/files/report", "/history", "/rules"):
        assert client.get(path).status_code == 200, path


pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="the memory of a process is read from /proc"),
]


def test_large_files_leave_no_memory_behind(tmp_path):
    """After submissions of 20 MiB the server is as small as before, below 60 MB."""
    with _serving(tmp_path) as (server, client):
        for number in range(3):
            _ended(client, f"{number}.csv", bytes([number + 1]) * (20 * 2**20))
        assert _used(server) < 60_000


@pytest.mark.long
def test_the_server_does_not_grow(tmp_path):
    """After 200 submissions the server has at most 1.1 times the memory that it had after 20, and below 60 MB."""
    with _serving(tmp_path) as (server, client):
        used = {}
        for number in range(1, 201):
            _served(client, number)
            used[number] = _used(server)
        assert used[200] <= 1.1 * used[20], used
        assert max(used.values()) < 60_000, used
