"""What is handed in by the form: taken once and whole, or refused in a sentence; names do no harm."""

import errno
import sqlite3
import time
from concurrent.futures import Future
from tempfile import SpooledTemporaryFile

import pytest
from starlette import formparsers
from web_pages import JSON, OWN, Idle, page

from flexlash.batch.answer import Answer
from flexlash.schema.exit_codes import ExitCode
from flexlash.service.questions import TooManyQuestionsError
from flexlash.service.records import Ending, StoredFile
from flexlash.service.web.site import Limits

FORM = b'--b\r\nContent-Disposition: form-data; name="file"; filename="a"\r\n\r\nabc\r\n--b--\r\n'

XSS = [
    "<script>alert(1)</script>",
    '"><img src=x onerror=alert(1)>',
    "{{ 'ab' * 3 }}xyz",
    "javascript:alert(1)",
    "' onload='x",
]


def test_a_submission_gets_the_address_of_its_token(tmp_path):
    """What is handed in lies under the ID that its form held; the browser is led there, a program gets it told."""
    with page(tmp_path) as one:
        visitor = one.visitor()
        token = visitor.token()
        answer = visitor.hand_in(token=token, content=b"abc")
        assert (answer.status_code, answer.headers["location"]) == (303, f"/submissions/{token[:32]}")
        stored = one.store.submission(token[:32])
        assert (stored.name, stored.options, stored.door, stored.size) == ("b3.xlsx", "options", "page", 3)
        assert one.store.blobs.read(stored.sha256) == b"abc"
        assert one.works.woken == 1
        told = visitor.hand_in(headers={**OWN, **JSON}, name="c.csv")
        assert told.status_code == 201
        assert told.json()["state"] == "waiting"
        assert visitor.get(told.headers["location"]).status_code == 200


def test_a_form_that_is_sent_again_is_the_same_submission(tmp_path):
    """A browser that resends gets the same answer; with another file in an old form it is another submission."""
    with page(tmp_path) as one:
        visitor = one.visitor()
        token = visitor.token()
        first = visitor.hand_in(token=token, content=b"abc").headers["location"]
        assert visitor.hand_in(token=token, content=b"abc").headers["location"] == first
        assert visitor.hand_in(token=token, content=b"abc", headers={**OWN, **JSON}).status_code == 200
        second = visitor.hand_in(token=token, content=b"abd").headers["location"]
        third = visitor.hand_in(token=token, content=b"abc", name="other.xlsx").headers["location"]
        assert visitor.hand_in(token=token, content=b"abd").headers["location"] == second
        assert len({first, second, third}) == 3
        assert len(one.store.history()) == 3


@pytest.mark.parametrize("token", ["", "0" * 32, "x", "0" * 32 + "-1-" + "0" * 64, "../../etc", "\0"])
def test_tokens_of_others_are_not_taken(tmp_path, token):
    """A token that is not ours keeps nothing, and says so on the form, which has a fresh one."""
    with page(tmp_path) as one:
        visitor = one.visitor()
        for action in ("run", "check"):
            answer = visitor.hand_in(token=token, action=action)
            assert answer.status_code == 400
            assert "did not come from this page" in answer.text
            assert 'name="token"' in answer.text
        assert not one.store.history()


@pytest.mark.parametrize(
    ("sent", "words"),
    [
        ({"files": {"file": ("", b"")}}, "Choose a file first"),
        ({"files": {"other": (None, "text")}}, "Choose a file first"),
        ({"files": [("file", ("a.xlsx", b"a")), ("file", ("b.xlsx", b"b"))]}, "one file at a time"),
        ({"files": [("file", ("a.xlsx", b"a"))] * 3}, "one file at a time"),
        ({"files": {"file": ("a.xlsx", b"a")}, "data": {f"f{n}": "x" for n in range(20)}}, "choose the file again"),
        ({"files": {"file": ("a.xlsx", b"a")}, "data": {"action": "x" * 9_000}}, "choose the file again"),
        ({"files": {"file": ("a.xlsx", b"a")}, "data": {"action": "delete"}}, "one of the two buttons"),
        ({"content": b"junk", "headers": {"content-type": "multipart/form-data; boundary=x"}}, "choose the file again"),
        ({"content": b"junk", "headers": {"content-type": "multipart/form-data"}}, "choose the file again"),
        (
            {"content": FORM, "headers": {"content-type": "multipart/form-data; boundary=b; charset=undefined"}},
            "choose the file again",
        ),
    ],
)
def test_what_is_wrong_is_said_on_the_form(tmp_path, sent, words):
    """No file, two, too many fields, a long one or no form at all: a sentence, on the form again, and nothing kept."""
    with page(tmp_path) as one:
        visitor = one.visitor()
        fields = {"token": visitor.token(), "action": "run", **sent.get("data", {})}
        asked = {**sent, "headers": {**OWN, **sent.get("headers", {})}} | (
            {} if "content" in sent else {"data": fields}
        )
        answer = visitor.post("/submissions", **asked)
        assert answer.status_code == 400
        assert words in answer.text
        assert 'enctype="multipart/form-data"' in answer.text
        told = visitor.post("/submissions", **{**asked, "headers": {**asked["headers"], **JSON}})
        assert words in told.json()["error"]["sentence"]
        assert not one.store.history()


@pytest.mark.parametrize("kind", ["application/x-www-form-urlencoded", "text/plain", "application/json", ""])
def test_other_kinds_of_forms_are_refused(tmp_path, kind):
    """What is no multipart form is told which kind is wanted."""
    with page(tmp_path) as one:
        answer = one.visitor().post("/submissions", content=b"a=b", headers={**OWN, "content-type": kind})
        assert answer.status_code == 415
        assert "multipart/form-data" in answer.text


def test_the_body_has_a_limit(tmp_path):
    """At the limit a body is taken, beyond it refused in words, whether its length is said or not; nothing is kept."""
    with page(tmp_path, limits=Limits(body=10_000)) as one:
        visitor = one.visitor()
        token = visitor.token()
        head = (
            f'--b\r\nContent-Disposition: form-data; name="token"\r\n\r\n{token}\r\n--b\r\n'
            'Content-Disposition: form-data; name="file"; filename="a.csv"\r\n\r\n'
        ).encode()
        tail = b"\r\n--b--\r\n"
        kind = {**OWN, "content-type": "multipart/form-data; boundary=b"}

        async def pieces(body):
            for start in range(0, len(body), 1_000):
                yield body[start : start + 1_000]

        for size, status in ((10_001, 413), (10_000, 303)):
            body = head + b"x" * (size - len(head) - len(tail)) + tail
            for content in (body, pieces(body)):
                answer = visitor.post("/submissions", content=content, headers=kind)
                assert answer.status_code == status, size
                assert status == 303 or "too large" in answer.text
        assert len(one.store.history()) == 1
        for path in ("/login", f"/submissions/{token[:32]}/retry", "/nix"):
            assert visitor.post(path, content=b"x" * 70_000, headers=kind).status_code == 413


def test_what_waits_has_a_limit(tmp_path):
    """Beyond so many submissions, or bytes, that wait nothing more is taken; what is there is still answered."""
    for limits in (Limits(most_waiting=2), Limits(waiting_bytes=20)):
        with page(tmp_path / str(limits.most_waiting), limits=limits) as one:
            visitor = one.visitor()
            token = visitor.token()
            assert [visitor.hand_in(token=token, content=b"0123456789").status_code] == [303]
            assert visitor.hand_in(name="2.csv", content=b"0123456789").status_code == 303
            answer = visitor.hand_in(name="3.csv")
            assert (answer.status_code, answer.headers["retry-after"]) == (503, "120")
            assert "The queue is full" in answer.text
            assert visitor.hand_in(token=token, content=b"0123456789").status_code == 303
            assert len(one.store.history()) == 2


@pytest.mark.parametrize(
    ("fault", "status", "words"),
    [
        (OSError(errno.ENOSPC, "No space left on device"), 507, "disk of flexlash is full"),
        (OSError(errno.EIO, "Input/output error"), 503, "try again later"),
        (sqlite3.OperationalError("database or disk is full"), 507, "disk of flexlash is full"),
        (ValueError("secret /path"), 500, "fault of flexlash"),
    ],
)
def test_a_fault_of_the_machine_is_told(tmp_path, monkeypatch, fault, status, words):
    """A full disk is said to be full, a fault of the program to be one; no trace, no path, nothing half kept."""
    with page(tmp_path) as one:
        visitor = one.visitor()
        monkeypatch.setattr(one.store.blobs, "put", lambda _: (_ for _ in ()).throw(fault))
        answer = visitor.hand_in()
        assert answer.status_code == status
        assert words in answer.text
        assert "Traceback" not in answer.text + one.said.getvalue()
        assert "secret" not in answer.text
        assert not one.store.history()
        monkeypatch.undo()
        assert visitor.hand_in().status_code == 303


def test_a_full_disk_is_told_while_a_file_comes_in(tmp_path, monkeypatch):
    """A disk that is full already where an upload is put down is said to be full; nothing is kept."""

    class Full(SpooledTemporaryFile):
        def rollover(self):
            raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(formparsers, "SpooledTemporaryFile", Full)
    with page(tmp_path) as one:
        answer = one.visitor().hand_in(content=b"x" * (2 * 2**20))
        assert answer.status_code == 507
        assert "disk of flexlash is full" in answer.text
        assert not one.store.history()


@pytest.mark.parametrize(
    ("name", "kept"),
    [
        ("../../etc/passwd", "passwd"),
        ("C:\\Users\\a\\b.xlsx", "b.xlsx"),
        ("..", "submission"),
        ("a\u202egnp.xlsx", "a·gnp.xlsx"),
        ("a\x1b[31m.xlsx", "a·[31m.xlsx"),
        ("u\u0308ber.xlsx", "über.xlsx"),
        ("x" * 300 + ".xlsx", "x" * 199 + "…"),
        ("Prüfling 3 (neu).xlsx", "Prüfling 3 (neu).xlsx"),
        ("a%00b.xlsx", "a%00b.xlsx"),
        ("a\u2028b\u200bc.xlsx", "a·b·c.xlsx"),
    ],
)
def test_names_are_inert(tmp_path, name, kept):
    """A file's name is printed without its folder, in one line and direction, and is no part of any path."""
    with page(tmp_path) as one:
        before = {path.name for path in tmp_path.rglob("*")}
        assert one.visitor().hand_in(name=name).status_code == 303
        assert one.store.history()[0].name == kept
        made = {path.name for path in tmp_path.rglob("*")} - before
        assert all(name.isalnum() for name in made)


@pytest.mark.parametrize("text", XSS)
def test_texts_of_strangers_are_inert_on_every_page(tmp_path, text):
    """Names, senders, reasons and words of a stranger appear on no page as anything but text."""
    with page(tmp_path) as one:
        visitor = one.visitor()
        answer = visitor.hand_in(name=f"{text.replace('/', '')}.xlsx")
        where = answer.headers["location"]
        taken = one.store.take()
        sha256, size = one.store.blobs.put(b"bytes")
        file = StoredFile(role="report", sha256=sha256, size=size, name=f"{text}.xlsx")
        one.store.end(taken.id, Ending(state="rejected", exit_code=4, words=text, reason=text, files=[file]))
        for path in ("/", "/history", where, f"/history?text={text}", f"/history?state={text}", f"/findings/{text}"):
            shown = visitor.get(path)
            for harmful in ("<script>alert", "<img src=x", "abababxyz", "onload='x"):
                assert harmful not in shown.text, (path, harmful)
            assert "javascript:alert" not in "".join(part.split('"')[0] for part in shown.text.split('href="')[1:])
        download = visitor.get(f"{where}/files/report").headers["content-disposition"]
        assert not set(download.partition("filename*=UTF-8''")[2]) & set("<>\"'{}: ")


def test_a_name_adds_no_header(tmp_path):
    """A name with line ends, as a hand-made body has it, ends up in one header of the download, and in one line."""
    with page(tmp_path) as one:
        where = one.visitor().hand_in(name="a\r\nSet-Cookie: x=1\r\n\r\n<b>.xlsx").headers["location"]
        taken = one.store.take()
        sha256, size = one.store.blobs.put(b"bytes")
        file = StoredFile(role="report", sha256=sha256, size=size, name='a\r\nSet-Cookie: x=1;"é.xlsx')
        one.store.end(taken.id, Ending(state="done", exit_code=0, words="", files=[file]))
        answer = one.visitor().get(f"{where}/files/report")
        assert "set-cookie" not in answer.headers
        assert answer.headers["content-disposition"] == (
            "attachment; filename=\"a__Set-Cookie__x_1___.xlsx\"; filename*=UTF-8''a__Set-Cookie__x_1__%C3%A9.xlsx"
        )
        assert "\nSet-Cookie" not in one.said.getvalue()


@pytest.mark.parametrize("kind", ["multipart/form-data; boundary=x", "multipart/form-data"])
def test_small_forms_that_are_none_are_refused(tmp_path, kind):
    """The forms of the token, and of what is done to a submission, are refused in words where they cannot be read."""
    with page(tmp_path) as one:
        where = one.visitor().hand_in().headers["location"]
        for path in ("/login", f"{where}/retry"):
            answer = one.visitor().post(path, content=b"junk", headers={**OWN, "content-type": kind})
            assert answer.status_code == 400, path
            assert "cannot be read" in answer.text


def test_retry_and_forget(tmp_path):
    """What has ended is computed anew or forgotten by its form; what has not is left alone, and so is its address."""
    with page(tmp_path) as one:
        visitor = one.visitor()
        where = visitor.hand_in().headers["location"]
        id_ = where.rpartition("/")[2]
        for what in ("retry", "forget"):
            answer = visitor.post(f"{where}/{what}", data={"token": visitor.token()})
            assert answer.status_code == 409
            assert "has not finished" in answer.text
        one.store.end(one.store.take().id, Ending(state="done", exit_code=0, words="fine"))
        assert visitor.post(f"{where}/forget", data={}).status_code == 400
        assert visitor.post(f"{where}/forget", data={"token": "x"}).status_code == 400
        answer = visitor.post(f"{where}/retry", data={"token": visitor.token()})
        assert (answer.status_code, answer.headers["location"]) == (303, where)
        assert one.store.submission(id_).state == "waiting"
        one.store.end(one.store.take().id, Ending(state="done", exit_code=0, words="fine"))
        answer = visitor.post(f"{where}/forget", data={"token": visitor.token()})
        assert (answer.status_code, answer.headers["location"]) == (303, "/history")
        for path in (where, f"{where}/files/report", f"{where}/variants/0", f"{where}/difference"):
            gone = visitor.get(path)
            assert gone.status_code == 410, path
            assert "hand it in again" in gone.text
        assert visitor.post(f"{where}/retry", data={"token": visitor.token()}).status_code == 410
        assert visitor.post(f"/submissions/{'0' * 32}/retry", data={"token": visitor.token()}).status_code == 404


class Checking(Idle):
    """Whoever checks says what the test has it say."""

    said: object = Answer(exit_code=ExitCode.INTERNAL)

    def check(self, name, data):
        """Return an answer, raise what is to be raised, or never end."""
        self.seen = name, data
        future = Future()
        if isinstance(self.said, TooManyQuestionsError):
            raise self.said
        if isinstance(self.said, BaseException):
            future.set_exception(self.said)
        elif self.said == "cancelled":
            future.cancel()
        elif self.said:
            future.set_result(self.said)
        return future


@pytest.mark.parametrize(
    ("said", "status", "words"),
    [
        (TooManyQuestionsError("x"), 503, "Other files are being checked just now"),
        (None, 503, "hand it in, and it waits its turn"),
        ("cancelled", 503, "is being stopped"),
        (Answer(exit_code=ExitCode.INTERNAL), 500, "fault of flexlash"),
        (RuntimeError("secret"), 500, "fault of flexlash"),
    ],
)
def test_a_check_that_cannot_be_made_is_told(tmp_path, said, status, words):
    """Where nobody answers, in time or at all, the page says what to do instead; nothing is kept either way."""
    works = Checking()
    works.said = said
    with page(tmp_path, works=works, limits=Limits(answer_seconds=0.05)) as one:
        began = time.monotonic()
        answer = one.visitor().hand_in(action="check", content=b"abc", name="a/b.xlsx")
        assert answer.status_code == status
        assert words in answer.text
        assert "secret" not in answer.text
        assert time.monotonic() - began < 20
        assert works.seen == ("b.xlsx", b"abc")
        assert not one.store.history()
        assert not list((one.store.folder / "blobs").glob("??/*"))


def test_large_files_are_not_held_in_memory(tmp_path):
    """A file beyond a mebibyte lies on the disk while it comes in, and is copied piece by piece."""
    with page(tmp_path) as one:
        visitor = one.visitor()
        put = one.store.blobs.put

        def watched(content):
            assert not isinstance(content, bytes)
            assert content.__self__.file._rolled
            return put(content)

        one.store.blobs.put = watched
        assert visitor.hand_in(content=b"x" * (3 * 2**20)).status_code == 303
        assert one.store.history()[0].size == 3 * 2**20
