"""Each ending is told to the webhook once it can hear it, signed, and to nobody else."""

from __future__ import annotations

import hashlib
import hmac
import io
import json
import socket
import stat
import sys
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest
from dispatching import Clock, opened

from flexlash.service.backup import back_up
from flexlash.service.log import Log
from flexlash.service.records import Ending, HandedIn, StoredFile
from flexlash.service.running import Setup, running
from flexlash.service.store import Store
from flexlash.service.webhook import Webhook, webhook_address, webhook_key

KEY = b"a key that both know"


class _Heard(BaseHTTPRequestHandler):
    """Keeps what it is told and answers as the test says."""

    def do_POST(self):
        """Keep a message."""
        body = self.rfile.read(int(self.headers["Content-Length"]))
        self.server.heard.append((self.path, dict(self.headers), body))
        status = self.server.answers.pop(0) if self.server.answers else 204
        if status == "hang":
            time.sleep(8)
            return
        self.send_response(status)
        if status in {301, 307, 308}:
            self.send_header("Location", f"http://127.0.0.1:{self.server.server_port}/elsewhere")
        self.end_headers()

    do_GET = do_POST  # noqa: N815

    def log_message(self, *_):
        """Say nothing."""


@pytest.fixture
def listener():
    """Return a server that hears messages: `heard` has them, `answers` the statuses that come next."""
    with ThreadingHTTPServer(("127.0.0.1", 0), _Heard) as server:
        server.heard, server.answers = [], []
        server.url = f"http://127.0.0.1:{server.server_port}/hook?for=flexlash"
        thread = threading.Thread(target=server.serve_forever, args=(0.02,))
        thread.start()
        yield server
        server.shutdown()
        thread.join()


@pytest.fixture
def clock():
    """Return the time of the store."""
    return Clock()


@pytest.fixture
def store(tmp_path, clock):
    """Return a store that has a webhook."""
    with opened(tmp_path / "store", clock=clock, webhook=True) as store:
        yield store


def _end(store, name="a.csv", door="page", **files):
    """Have a submission end, with an outcome and further files, and return its ID."""
    id_ = store.accept(HandedIn(name=name, options="o", door=door), name.encode()).id
    store.take()
    contents = {"outcome": json.dumps({"submission": name, "exit_code": 0}).encode(), **files}
    kept = [
        StoredFile(role=role, sha256=store.blobs.put(data)[0], size=len(data), name=role)
        for role, data in contents.items()
    ]
    store.end(id_, Ending(state="done", exit_code=0, words="fine", files=kept))
    return id_


def _webhook(store, url):
    lines = io.StringIO()
    webhook = Webhook(store, url, KEY, Log(stream=lines))
    webhook.lines = lines
    return webhook


def test_the_outcome_is_posted_once_and_signed(store, listener):
    """The body is the outcome with ID and state, its signature is right, and nothing is sent again."""
    id_ = _end(store)
    webhook = _webhook(store, listener.url)
    webhook.step()
    webhook.step()
    ((path, headers, body),) = listener.heard
    assert path == "/hook?for=flexlash"
    assert json.loads(body) == {"id": id_, "state": "done", "submission": "a.csv", "exit_code": 0}
    expected = hmac.new(KEY, body, hashlib.sha256).hexdigest()
    assert headers["X-Flexlash-Signature"] == f"sha256={expected}"
    assert headers["Content-Type"] == "application/json"
    assert store.deliveries() == []


@pytest.mark.parametrize("status", [301, 307, 308, 400, 404, 500, 503])
def test_a_message_that_was_not_taken_is_sent_again_later(store, clock, listener, status):
    """Redirects are not followed; any answer but success is tried again, later each time, with the same number."""
    listener.answers += [status] * 2
    _end(store)
    webhook = _webhook(store, listener.url)
    for rest in (5, 10):
        webhook.step()
        count = len(listener.heard)
        webhook.step()
        assert len(listener.heard) == count
        assert str(status) in store.undelivered()[0].trouble
        clock.now += rest
    webhook.step()
    assert [path for path, _, _ in listener.heard] == ["/hook?for=flexlash"] * 3
    assert len({headers["X-Flexlash-Delivery"] for _, headers, _ in listener.heard}) == 1
    assert store.undelivered() == []


def test_one_message_that_fails_holds_no_other_up(store, clock, listener):
    """The next turn sends the others while the first waits."""
    listener.answers += [500]
    ids = [_end(store, f"{number}.csv") for number in range(3)]
    webhook = _webhook(store, listener.url)
    webhook.step()
    assert len(listener.heard) == 1
    webhook.step()
    clock.now += 5
    webhook.step()
    assert [json.loads(body)["id"] for _, _, body in listener.heard] == [ids[0], ids[1], ids[2], ids[0]]


def test_nobody_there_or_silence_is_a_failure_in_a_sentence(store, clock, listener, monkeypatch):
    """A port that nobody listens at, a name that nobody has, and one who never answers cost a bounded time."""
    monkeypatch.setattr("flexlash.service.webhook._PATIENCE", 0.2)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    _end(store)
    listener.answers += ["hang"]
    begun = time.monotonic()
    for url in (
        f"http://127.0.0.1:{port}/",
        "http://nobody.invalid/",
        f"https://127.0.0.1:{listener.server_port}/",
        listener.url,
    ):
        webhook = _webhook(store, url)
        webhook.step()
        (waiting,) = store.undelivered()
        assert waiting.trouble, url
        assert "webhook failed" in webhook.lines.getvalue()
        clock.now += 300
    assert waiting.tries == 4
    assert time.monotonic() - begun < 6


def test_a_message_is_given_up_in_the_end_and_that_is_written_down(store, clock, listener, monkeypatch):
    """After so many tries nothing is sent any more, and the events say so."""
    monkeypatch.setattr("flexlash.service.webhook._MOST_TRIES", 3)
    listener.answers += [500] * 9
    id_ = _end(store)
    webhook = _webhook(store, listener.url)
    for _ in range(6):
        webhook.step()
        clock.now += 300
    assert len(listener.heard) == 3
    assert store.undelivered() == []
    assert ("given up", "message: the webhook answered 500") in {
        (one["kind"], one["text"]) for one in store.events(id_)
    }


def test_files_come_before_the_message_and_do_not_wait_for_it(store, listener):
    """Nothing is told before report and original have left; what leaves by the folder never waits for the webhook."""
    listener.answers += [500] * 9
    _end(store, door="folder", report=b"PK report")
    webhook = _webhook(store, listener.url)
    kinds = []
    while due := [one for one in store.deliveries() if one.kind != "message"]:
        webhook.step()
        assert listener.heard == []
        kinds.append(due[0].kind)
        store.delivered(due[0])
    assert kinds == ["file", "original"]
    webhook.step()
    assert len(listener.heard) == 1
    second = _end(store, "b.csv", door="folder", report=b"PK other")
    assert {one.kind for one in store.deliveries() if one.submission == second} == {"file"}


def test_a_thread_sends_what_comes_and_stops_at_once(store, listener):
    """Woken, it sends within a moment; stopped, it ends."""
    webhook = _webhook(store, listener.url)
    webhook.start()
    id_ = _end(store)
    webhook.wake()
    end = time.monotonic() + 5
    while not listener.heard and time.monotonic() < end:
        time.sleep(0.01)
    webhook.stop(5)
    assert json.loads(listener.heard[0][2])["id"] == id_


@pytest.mark.parametrize(
    "url",
    ["", "hook", "ftp://a/b", "file:///etc/passwd", "http://", "https:///x", "http://a b/", "http://a:99999999/", "http://a:0x/",
     "http://a/\r\nX: y", "http://ä/", "http://u:p@a/", "http://a/#x"],
)  # fmt: skip
def test_what_is_no_address_is_refused_at_start(url):
    """Only http and https with a host, without a user, are addresses."""
    with pytest.raises(ValueError, match="webhook"):
        webhook_address(url)


def test_the_key_is_made_once_or_taken_from_a_file(tmp_path):
    """Without a file a key is made that nobody else may read; a given one counts without its line end."""
    key = webhook_key(tmp_path)
    assert len(key) >= 32
    assert webhook_key(tmp_path) == key
    if sys.platform != "win32":
        assert stat.S_IMODE((tmp_path / "webhook.key").stat().st_mode) == 0o600
    given = tmp_path / "token"
    given.write_bytes(b"0123456789abcdef\r\n")
    assert webhook_key(tmp_path, given) == b"0123456789abcdef"
    given.write_bytes(b"0123456789abcde\n")
    with pytest.raises(ValueError, match="15 bytes; at least 16 are required"):
        webhook_key(tmp_path, given)


def test_a_store_with_a_key_of_its_own_is_opened_again(tmp_path, listener):
    """A service that tells a webhook is started again and again with the key that it has made, also on a backup."""
    setup = Setup(store=tmp_path / "store", workers=1, webhook=listener.url)
    keys = set()
    for _ in range(2):
        with running(setup, Log(stream=io.StringIO())):
            keys.add((tmp_path / "store" / "webhook.key").read_bytes())
    with Store(tmp_path / "store", serving=True) as store:
        back_up(store, tmp_path / "copy")
        back_up(store, tmp_path / "copy")
    with running(Setup(store=tmp_path / "copy", workers=1, webhook=listener.url), Log(stream=io.StringIO())):
        keys.add((tmp_path / "copy" / "webhook.key").read_bytes())
    assert len(keys) == 1
    if sys.platform != "win32":
        assert stat.S_IMODE((tmp_path / "copy" / "webhook.key").stat().st_mode) == 0o600
