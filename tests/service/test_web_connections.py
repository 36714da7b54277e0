"""The page on a socket: who is slow, large or talks nonsense is cut off; it starts and ends in good order."""

import io
import os
import re
import signal
import socket
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest
from web_pages import answering

from flexlash.service.log import Log
from flexlash.service.records import Ending, StoredFile
from flexlash.service.web import connections, serving
from flexlash.service.web.access import Access
from flexlash.service.web.serving import AddressError, PageServer, open_browser
from flexlash.service.web.site import Limits

SHORT = Limits(idle_seconds=0.3, body_seconds=0.9)


def served(folder, *, access=None, limits=SHORT):
    """Yield a page and its server, which answers in a thread."""
    return answering(folder, limits=limits, access=access or Access.of(port=0))


@pytest.fixture(autouse=True)
def _impatient(monkeypatch):
    """Look often, so that a test need not wait."""
    monkeypatch.setattr(connections, "SECONDS_BETWEEN_LOOKS", 0.25)


def _connected(server):
    return socket.create_connection(("127.0.0.1", _port(server)), timeout=10)


def _port(server):
    return int(re.search(r":(\d+)/", server.address)[1])


def _answer(connection):
    """Return all that comes until the other end closes."""
    pieces = []
    while True:
        try:
            piece = connection.recv(65_536)
        except ConnectionResetError:
            break
        if not piece:
            break
        pieces.append(piece)
    return b"".join(pieces).decode("latin-1")


def _asked(server, text):
    with _connected(server) as connection:
        connection.sendall(text if isinstance(text, bytes) else text.encode())
        return _answer(connection)


def _head(*lines, method="POST", path="/submissions"):
    return "\r\n".join((f"{method} {path} HTTP/1.1", "Host: 127.0.0.1", "Sec-Fetch-Site: same-origin", *lines, "", ""))


OPENING = b'--b\r\nContent-Disposition: form-data; name="file"; filename="a"\r\n\r\n'
FORM = ("Content-Type: multipart/form-data; boundary=b", "Connection: close")


def test_an_upload_that_pauses_is_ended(tmp_path):
    """An upload that pauses for longer than the limit is answered 408 in words, and its connection closed."""
    with served(tmp_path) as (_, server):
        began = time.monotonic()
        said = _asked(server, _head(*FORM, "Content-Length: 5000") + "--b\r\n")
        assert said.startswith("HTTP/1.1 408 ")
        assert "too long to arrive" in said
        assert "content-security-policy: default-src 'none'" in said
        assert time.monotonic() - began < 3


@pytest.mark.parametrize("length", ["Content-Length: 5000", "Transfer-Encoding: chunked"])
def test_an_upload_that_drips_is_ended(tmp_path, length):
    """An upload that never pauses for long but takes for ever is ended all the same."""
    with served(tmp_path) as (_, server), _connected(server) as connection:
        is_chunked = "chunked" in length
        connection.sendall(_head(*FORM, length).encode())
        connection.sendall(b"%x\r\n%s\r\n" % (len(OPENING), OPENING) if is_chunked else OPENING)
        began = time.monotonic()
        with suppress(OSError):
            while time.monotonic() - began < 8:
                connection.sendall(b"1\r\nx\r\n" if is_chunked else b"x")
                time.sleep(0.1)
        assert 0.8 < time.monotonic() - began < 5


@pytest.mark.parametrize("drip", [b"", b"X"])
def test_who_does_not_ask_is_cut_off(tmp_path, drip):
    """A connection on which no request comes to its end, in silence or letter by letter, is cut off."""
    with served(tmp_path) as (_, server), _connected(server) as connection:
        began = time.monotonic()
        connection.sendall(b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX: ")
        try:
            while time.monotonic() - began < 8:
                connection.settimeout(0.1)
                connection.sendall(drip)
                try:
                    if not connection.recv(1):
                        break
                except TimeoutError:
                    pass
        except OSError:
            pass
        assert time.monotonic() - began < 4
        _wait(lambda: not server.server_state.connections)


def _wait(holds, seconds=5.0):
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.02)


def test_who_does_not_take_a_download_is_cut_off(tmp_path):
    """A download that nobody takes holds neither its connection nor its file open for ever."""
    with served(tmp_path) as (one, server):
        where = one.visitor().hand_in().headers["location"]
        sha256, size = one.store.blobs.put(bytes(40 * 2**20))
        file = StoredFile(role="report", sha256=sha256, size=size, name="large.xlsx")
        one.store.end(one.store.take().id, Ending(state="done", exit_code=0, words="", files=[file]))
        with socket.socket() as connection:
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4_096)
            connection.connect(("127.0.0.1", _port(server)))
            connection.sendall(_head(method="GET", path=f"{where}/files/report").encode())
            assert connection.recv(100).startswith(b"HTTP/1.1 200")
            _wait(lambda: server.server_state.tasks)
            _wait(lambda: not server.server_state.tasks and not server.server_state.connections)


def test_a_body_without_a_length_has_a_limit(tmp_path):
    """Pieces without a length said beforehand are refused as soon as they are too many; what follows is dropped."""
    with served(tmp_path, limits=Limits(body=100_000, idle_seconds=2)) as (one, server), _connected(server) as asking:
        asking.sendall(_head(*FORM, "Transfer-Encoding: chunked").encode())
        asking.sendall(b"%x\r\n%s\r\n" % (len(OPENING), OPENING))
        with suppress(OSError):
            for _ in range(60):
                asking.sendall(b"2000\r\n" + b"x" * 0x2000 + b"\r\n")
        said = _answer(asking)
        assert said.startswith("HTTP/1.1 413 ")
        assert "too large" in said
        assert not one.store.history()


@pytest.mark.parametrize(
    "text",
    [
        "nonsense\r\n\r\n",
        "GET / HTTP/1.1\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nHost: evil.example\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX y: z\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX: " + "y" * 100_000,
        "POST /submissions HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: -5\r\n\r\n",
        "POST /submissions HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 5\r\nContent-Length: 6\r\n\r\n",
        "POST /submissions HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n",
        b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03",
        b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
    ],
)
def test_what_is_no_http_is_refused(tmp_path, text):
    """What is no request, or says two things at once, is refused with every header, and without a trace in the log."""
    with served(tmp_path) as (one, server):
        said = _asked(server, text)
        assert re.match(r"HTTP/1\.1 4\d\d ", said)
        assert said.count("content-security-policy: default-src 'none'") == said.count("HTTP/1.1 ")
        assert "nosniff" in said
        assert "Traceback" not in one.said.getvalue()
        assert _asked(server, _head("Connection: close", method="GET", path="/")).startswith("HTTP/1.1 200")


def test_a_second_request_that_is_none_does_no_harm(tmp_path):
    """Nonsense behind a sound request, as a body longer than was said, is answered by an end of the connection."""
    with served(tmp_path) as (one, server):
        said = _asked(server, _head("Content-Length: 3", path="/login") + "a=bEVIL / HTTP/1.1\r\nX\r\n\r\n")
        assert said.startswith("HTTP/1.1 401")
        assert "Traceback" not in one.said.getvalue()


def test_a_request_of_two_lengths_is_refused_and_nothing_behind_it_is_read(tmp_path):
    """What says both how long it is and that it comes in pieces may hold a second request, which is not answered."""
    with served(tmp_path) as (_, server):
        hidden = _head("Connection: close", method="GET", path="/history")
        said = _asked(server, _head("Content-Length: 6", "Transfer-Encoding: chunked") + "0\r\n\r\n" + hidden)
        assert said.startswith("HTTP/1.1 400")
        assert said.count("HTTP/1.1 ") == 1


def test_only_so_many_connections_are_held(tmp_path, monkeypatch):
    """Connections beyond the limit are closed at once, so that others can still be answered later."""
    monkeypatch.setattr(connections, "MOST_CONNECTIONS", 3)
    monkeypatch.setattr(connections, "SECONDS_BETWEEN_LOOKS", 60)
    with served(tmp_path) as (_, server):
        held = [_connected(server) for _ in range(3)]
        _wait(lambda: len(server.server_state.connections) == 3)
        with _connected(server) as fourth:
            fourth.sendall(_head("Connection: close", method="GET", path="/").encode())
            assert _answer(fourth) == ""
        for one in held:
            one.close()
        _wait(lambda: not server.server_state.connections)
        assert _asked(server, _head("Connection: close", method="GET", path="/")).startswith("HTTP/1.1 200")


def test_no_header_changes_who_asks(tmp_path):
    """X-Forwarded-For does not make another of the one who is connected, whoever sends it."""
    access = Access.of(port=0, behind_proxy="Remote-User", proxy_addresses=["10.0.0.1"])
    with served(tmp_path, access=access) as (_, server):
        said = _asked(
            server,
            _head("Remote-User: anna", "X-Forwarded-For: 10.0.0.1", "Forwarded: for=10.0.0.1", "Connection: close",
                  method="GET", path="/"),
        )  # fmt: skip
        assert said.startswith("HTTP/1.1 403")


def test_a_taken_address_is_told(tmp_path):
    """A port that another program has, or an address that is none of this machine, is told in a sentence."""
    with served(tmp_path) as (one, server):
        port = _port(server)
        with pytest.raises(AddressError, match=f"another program answers at 127.0.0.1 port {port}.*--port"):
            PageServer(one.app, Access.of(port=port), Log(stream=io.StringIO()))
        for host in ("192.0.2.1", "no.such.host.invalid"):
            with pytest.raises(AddressError, match="cannot be had"):
                PageServer(one.app, Access(host=host, port=0), Log(stream=io.StringIO()))


def test_open_shows_no_token_to_others(tmp_path, monkeypatch):
    """The browser is started with a file that only its owner reads, not with the token, which all users could see."""
    asked = []
    monkeypatch.setattr(serving.webbrowser, "open", lambda address: asked.append(address) or True)
    access = Access.of(port=0, opens=True)
    with served(tmp_path, access=access) as (one, server):
        assert server.opening == f"{server.address}open/{access.once}"
        assert open_browser(server.opening, one.store.folder)
        assert open_browser(server.opening, one.store.folder)
        assert access.once not in asked[0]
        path = Path(asked[0].removeprefix("file://"))
        assert server.opening in path.read_text(encoding="utf-8")
        assert os.name != "posix" or path.stat().st_mode & 0o777 == 0o600


SCRIPT = """
import sys, time
from pathlib import Path
sys.path[:0] = {paths!r}
from web_pages import Page
from flexlash.service.log import Log
from flexlash.service.web.access import Access
from flexlash.service.web.serving import PageServer
one = Page(Path(sys.argv[1]), access=Access.of(port=0))
server = PageServer(one.app, one.access, Log())
print(server.address, flush=True)
ended = server.run()
heavy = sorted({{name.partition(".")[0] for name in sys.modules}} & {heavy!r})
print(ended, heavy, one.works.woken, flush=True)
"""
HEAVY = {"polars", "rapidfuzz", "numpy", "openpyxl", "xlsxwriter", "pandera", "scipy", "distributed", "matplotlib"}


def _program(folder):
    support = Path(__file__).parents[1] / "support"
    paths = [str(support), *(path for path in sys.path if path)]
    script = SCRIPT.format(paths=paths, heavy=HEAVY)
    return subprocess.Popen(
        [sys.executable, "-c", script, str(folder)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="signals are sent otherwise on Windows")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_it_in_order(tmp_path, number):
    """A signal lets what is on its way be answered, then all returns; nothing heavy was loaded, nor 60 MB used."""
    with _program(tmp_path) as program:
        address = program.stdout.readline().strip()
        port = int(re.search(r":(\d+)/", address)[1])

        def asked(text):
            with socket.create_connection(("127.0.0.1", port), timeout=10) as connection:
                connection.sendall(text.encode())
                return _answer(connection)

        for path in ("/", "/history", "/rules", "/help", "/health", "/metrics", "/findings/E101"):
            assert asked(_head("Connection: close", method="GET", path=path)).startswith("HTTP/1.1 200"), path
        token = re.search(r'name="token" value="([^"]+)"', asked(_head("Connection: close", method="GET", path="/")))[1]
        body = f'--b\r\nContent-Disposition: form-data; name="token"\r\n\r\n{token}\r\n--b\r\n'
        body += 'Content-Disposition: form-data; name="file"; filename="a.csv"\r\n\r\nabc\r\n--b--\r\n'
        memory = re.search(r"VmRSS:\s+(\d+)", Path(f"/proc/{program.pid}/status").read_text(encoding="utf-8"))
        assert int(memory[1]) < 60_000
        with socket.create_connection(("127.0.0.1", port), timeout=10) as connection:
            connection.sendall(_head(*FORM, f"Content-Length: {len(body)}").encode())
            time.sleep(0.2)
            program.send_signal(number)
            time.sleep(0.5)
            connection.sendall(body.encode())
            assert _answer(connection).startswith("HTTP/1.1 303")
        told, said = program.communicate(timeout=15)
        assert told == f"{int(number)} [] 1\n"
        assert program.returncode == 0
        assert "Traceback" not in said
