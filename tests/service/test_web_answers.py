"""What is answered at each address: pages and JSON, downloads, refusals, and what every answer says to a browser."""

import json
import re

import pytest
from web_pages import JSON, OWN, Idle, page

from flexlash.service.records import Ending, StoredFile
from flexlash.service.web.access import Access
from flexlash.service.web.downloads import safe_name
from flexlash.service.web.site import Limits

POLICY = (
    "default-src 'none'; style-src 'self'; img-src 'self' data:; form-action 'self'; frame-ancestors 'none';"
    " base-uri 'none'"
)


def _ended(one, role="report", name="b3-report.xlsx", content=b"a report"):
    """Return the address of a submission that was handed in and is done, with one file."""
    where = one.visitor().hand_in(name="b3.xlsx").headers["location"]
    sha256, size = one.store.blobs.put(content)
    file = StoredFile(role=role, sha256=sha256, size=size, name=name)
    one.store.end(one.store.take().id, Ending(state="done", exit_code=0, words="all fine", files=[file]))
    return where


def _everything(one):
    """Yield the answer at every address of the application, by every method, and to what is refused before any."""
    where = _ended(one)
    visitor = one.visitor()
    paths = [route.path for route in one.app.routes]
    for path in [*paths, "/nix", where, f"{where}/files/report", f"{where}/files/nix", "/static/flexlash.css"]:
        address = re.sub(r"\{\w+\}", "0", path.replace("{name}", "nix").replace("/submissions/{id}", where))
        for method in ("GET", "HEAD", "POST", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE"):
            yield visitor.ask(method, address, headers=OWN)
        yield visitor.get(address, headers=JSON)
    yield visitor.get("/", headers={"host": "evil.example"})
    yield visitor.post("/submissions", headers={"origin": "http://evil.example"})
    yield visitor.post("/login", content=b"x" * 70_000)
    yield visitor.hand_in(content=b"x" * (21 * 2**20))
    yield visitor.hand_in(token="")
    waits = visitor.hand_in(name="waits.csv")
    yield waits
    yield visitor.post(f"{waits.headers['location']}/forget", data={"token": visitor.token()})
    yield visitor.get(f"{where}/files/report", headers={"range": "bytes=9999-"})
    yield visitor.get(f"{where}/files/report", headers={"range": "nonsense"})
    yield visitor.get("/", headers={"content-length": "-1"})


@pytest.mark.slow
def test_every_answer_says_the_same_to_a_browser(tmp_path):
    """Whatever is asked, also what is refused, missing or a fault, has the policy and all other headers, once."""
    with page(tmp_path) as one:
        statuses = set()
        for answer in _everything(one):
            statuses.add(answer.status_code)
            where = (answer.request.method, answer.request.url, answer.status_code)
            assert answer.headers.get_list("content-security-policy") == [POLICY], where
            assert answer.headers["x-content-type-options"] == "nosniff", where
            assert answer.headers["cache-control"] == "no-store", where
            assert answer.headers["referrer-policy"] == "no-referrer", where
            assert answer.headers["cross-origin-resource-policy"] == "same-origin", where
            assert answer.headers["cross-origin-opener-policy"] == "same-origin", where
            assert answer.headers["x-frame-options"] == "DENY", where
            assert "accept" in answer.headers["vary"].lower(), where
            assert "server" not in answer.headers, where
            assert answer.request.method == "HEAD" or "content-type" in answer.headers or not answer.content, where
        assert statuses >= {200, 303, 400, 401, 403, 404, 405, 409, 413, 415, 416, 421}


def test_a_fault_has_the_headers_too(tmp_path, monkeypatch):
    """A fault of the program is a page in plain words with every header, and a line in the log without a trace."""
    with page(tmp_path) as one:
        monkeypatch.setattr(one.store, "totals", lambda: 1 / 0)
        for headers in ({}, JSON):
            answer = one.visitor().get("/metrics", headers=headers)
            assert answer.status_code == 500
            assert answer.headers["content-security-policy"] == POLICY
            assert "fault of flexlash" in answer.text
            assert "division" not in answer.text
        assert "ZeroDivisionError: division by zero" in one.said.getvalue()
        assert "Traceback" not in one.said.getvalue()


@pytest.mark.slow
def test_no_page_carries_style_or_script(tmp_path):
    """What the policy forbids is nowhere: no inline style, no script, no handler, nothing from elsewhere."""
    with page(tmp_path) as one:
        for answer in _everything(one):
            if "html" in answer.headers.get("content-type", ""):
                assert not re.search(r"<style|\sstyle=|\son\w+=|<script(?! src=\"/static/)", answer.text), answer.url
                assert not re.search(r"(src|href|action)=\"(?!/|#|data:image/)", answer.text), answer.url


@pytest.mark.parametrize(
    ("accept", "is_json"),
    [
        ("application/json", True),
        ("text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8", False),
        ("*/*", False),
        ("", False),
        ("application/json;q=0.5, text/html;q=0.4", True),
        ("application/json;q=0.4, text/html;q=0.5", False),
        ("application/json, text/html", False),
        ("application/*", True),
        ("text/*;q=0.1, application/json;q=0.2", True),
        ("application/json;q=0", False),
        ("APPLICATION/JSON", True),
        ("application/json;q=nonsense, text/html", False),
        ("image/png", False),
        (",;,=" * 5_000, False),
    ],
)
def test_pages_or_json_by_what_is_asked(tmp_path, accept, is_json):
    """The same address gives a page or JSON by Accept with its weights; a browser always gets the page."""
    with page(tmp_path) as one:
        where = _ended(one)
        for path in ("/", where, "/history", "/rules", "/nix", f"{where}/difference"):
            answer = one.visitor().get(path, headers={"accept": accept})
            kind = answer.headers["content-type"]
            assert kind.startswith("application/json" if is_json else "text/html"), path
            assert answer.headers["vary"] == "Accept"


def test_a_submission_as_json(tmp_path):
    """As JSON a submission has all that its page shows; what waits says how many are before it."""
    with page(tmp_path) as one:
        where = _ended(one, "page", "page.json", json.dumps({"name": "b3"}).encode())
        told = one.visitor().get(where, headers=JSON).json()
        assert told["state"] == "done"
        assert told["words"] == "all fine"
        assert told["page"] == {"name": "b3"}
        assert told["files"] == []
        one.visitor().hand_in(name="1.csv")
        waits = one.visitor().hand_in(name="2.csv").headers["location"]
        told = one.visitor().get(waits, headers=JSON).json()
        assert {"id", "name", "state", "rows_done", "rows", "counts", "reason"} <= told.keys()
        assert (told["state"], told["position"], told["seconds_left"], told["page"]) == ("waiting", 1, None, None)
        history = one.visitor().get("/history?state=waiting", headers=JSON).json()
        assert [entry["name"] for entry in history["submissions"]] == ["2.csv", "1.csv"]
        assert one.visitor().get("/rules", headers=JSON).json() == {"rules": []}


@pytest.mark.parametrize(
    "id_",
    ["0" * 31, "0" * 33, "../history", "..%2f..%2fetc%2fpasswd", "%00", "A" * 32, "0" * 5_000, "%", "' OR 1=1 --",
     "0/../../etc", ".web.key", "%ff%fe"],
)  # fmt: skip
def test_ids_that_are_none(tmp_path, id_):
    """No text leads to anything but the submission whose ID it is, in these very letters."""
    with page(tmp_path) as one:
        where = _ended(one)
        for path in ("", "/files/report", "/variants/0", "/difference"):
            assert one.visitor().get(f"/submissions/{id_}{path}").status_code in {404, 200 if "history" in id_ else 404}
        assert one.visitor().get(where.upper().replace("/SUBMISSIONS", "/submissions")).status_code == 404


@pytest.mark.parametrize("number", ["-1", "1.5", "x", "9" * 5_000, "%00", "٣", "1e3", "0"])
def test_variants_that_are_none(tmp_path, number):
    """A number that no variant has, or that is none, is an address without a page."""
    with page(tmp_path) as one:
        assert one.visitor().get(f"{_ended(one)}/variants/{number}").status_code == 404


@pytest.mark.parametrize(
    "name",
    ["../app.py", "..%2fapp.py", "%2e%2e%2fapp.py", "..\\app.py", "/etc/passwd", "flexlash.css/", "FLEXLASH.CSS", "",
     ".", "%00", "flexlash.css%00.js"],
)  # fmt: skip
def test_static_files_are_those_of_the_package(tmp_path, name):
    """No name leads out of the folder of static files."""
    with page(tmp_path) as one:
        answer = one.visitor().get(f"/static/{name}")
        assert answer.status_code == 404
        assert "import" not in answer.text
        assert one.visitor().get("/static/flexlash.css").headers["content-type"].startswith("text/css")


@pytest.mark.parametrize("method", ["PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "CONNECT", "PROPFIND"])
def test_other_methods_are_not_allowed(tmp_path, method):
    """What is neither asked for nor handed in is refused with what is allowed, and changes nothing."""
    with page(tmp_path) as one:
        where = _ended(one)
        for path in ("/", where, "/submissions", f"{where}/files/report"):
            answer = one.visitor().ask(method, path, headers=OWN)
            assert answer.status_code == 405
            assert answer.headers["allow"]
            assert "cannot be done" in answer.text
        assert len(one.store.history()) == 1


def test_head_is_get_without_its_body(tmp_path):
    """HEAD has status and headers of GET at every address."""
    with page(tmp_path) as one:
        where = _ended(one)
        for path in ("/", where, "/history", "/help", f"{where}/files/report", "/static/flexlash.css", "/nix"):
            head, get = one.visitor().ask("HEAD", path), one.visitor().get(path)
            assert head.status_code == get.status_code
            assert head.headers["content-type"] == get.headers["content-type"]


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("b3-report.xlsx", "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"),
        ("b3-autofixed.xlsm", "application/vnd.ms-excel.sheet.macroEnabled.12"),
        ("b3.csv", "text/csv; charset=utf-8"),
        ("b3-reasons.txt", "text/plain; charset=utf-8"),
        ("b3.json", "application/json"),
        ("b3.parquet", "application/vnd.apache.parquet"),
        ("b3.html", "application/octet-stream"),
        ("b3.svg", "application/octet-stream"),
        ("b3", "application/octet-stream"),
    ],
)
def test_downloads_are_attachments(tmp_path, name, kind):
    """A file is taken away, never shown, whole, as the kind that it is, with the digest of its bytes as its tag."""
    content = bytes(range(256)) * 1_000
    with page(tmp_path) as one:
        where = _ended(one, name=name, content=content)
        answer = one.visitor().get(f"{where}/files/report")
        assert answer.content == content
        assert answer.headers["content-type"] == kind
        assert answer.headers["content-disposition"].startswith(f'attachment; filename="{name}"')
        file = one.store.files(where.rpartition("/")[2])["report"]
        assert answer.headers["etag"] == f'"{file.sha256}"'
        path = one.store.blobs.path(file.sha256)
        path.write_bytes(content[:-1] + b"x")
        assert one.visitor().get(f"{where}/files/report").status_code == 503
        path.unlink()
        assert one.visitor().get(f"{where}/files/report").status_code == 503
        for role in ("checked", "../report", "REPORT", "%00"):
            assert one.visitor().get(f"{where}/files/{role}").status_code == 404


def test_names_of_downloads():
    """Whatever a file was called, its download has a short name of letters, digits and -_.() that is no path."""
    hostile = ["", ".", "..", "/", "a/../b", "\\\\server\\share", "x" * 500 + ".xlsx", "con\x00.xlsx", "a\u202eb.xlsx"]
    hostile += [".htaccess", "a" * 300 + "." + "b" * 300, "😀.xlsx", "\ud800.xlsx", "%2e%2e%2f.csv", "ﬁ.xlsx"]
    for name in hostile:
        safe = safe_name(name)
        assert re.fullmatch(r"[\w().-]{1,130}", safe), name
        assert not safe.startswith(".")
    assert safe_name("a" * 300 + "-report.xlsx").endswith("a-report.xlsx")
    assert safe_name("a" * 300 + "-autofixed.xlsx").endswith("a-autofixed.xlsx")


def test_health_says_what_is_wrong(tmp_path, monkeypatch):
    """Health is 200 while all is well, and 503 with the reason where nobody works, disk or store fail."""
    with page(tmp_path) as one:
        assert one.visitor().get("/health").json()["status"] == "ok"
        monkeypatch.setattr(Idle, "is_alive", False)
        answer = one.visitor().get("/health")
        assert (answer.status_code, answer.json()["wrong"]) == (503, ["nothing is taking the waiting submissions"])
        monkeypatch.undo()
        monkeypatch.setattr(one.store, "folder", tmp_path / "gone")
        assert one.visitor().get("/health").json()["wrong"] == ["the store cannot be used"]
    now = [1e9]
    with page(tmp_path / "none", clock=lambda: now[0]) as one:
        monkeypatch.setattr(Idle, "workers", 0)
        one.visitor().hand_in()
        assert one.visitor().get("/health").status_code == 200
        now[0] += 61
        assert one.visitor().get("/health").json()["wrong"] == ["the waiting submissions find no workers"]
    with page(tmp_path / "full", limits=Limits(free_bytes=2**60)) as one:
        assert one.visitor().get("/health").json()["wrong"] == ["the disk is nearly full"]


def test_metrics_name_nobody(tmp_path):
    """The metrics are numbers by state in the text format, without a name, an ID or a sender."""
    with page(tmp_path, access=Access.of(behind_proxy="Remote-User")) as one:
        visitor = one.visitor(remote_user="anna")
        where = visitor.hand_in(name="secret-part.xlsx").headers["location"]
        told = one.visitor().get("/metrics")
        assert told.headers["content-type"].startswith("text/plain")
        lines = [line for line in told.text.splitlines() if not line.startswith("#")]
        assert all(re.fullmatch(r'flexlash_\w+(\{state="\w+"\})? \d+(\.\d+)?', line) for line in lines)
        assert 'flexlash_submissions{state="waiting"} 1' in lines
        assert {"flexlash_waiting_bytes 10", "flexlash_workers 1", "flexlash_rows_done 0"} <= set(lines)
        for text in (told.text, one.visitor().get("/health").text):
            assert not re.search(f"secret|anna|{where.rpartition('/')[2]}", text)


def test_the_log_has_what_changed_and_what_was_refused(tmp_path):
    """What is handed in and what is refused has its line, with who it was; what is merely looked at has none."""
    with page(tmp_path, access=Access.of(behind_proxy="Remote-User")) as one:
        visitor = one.visitor(remote_user="anna")
        visitor.get("/")
        assert one.said.getvalue() == ""
        visitor.hand_in()
        visitor.get("/nix%0d%0aforged")
        said = one.said.getvalue().splitlines()
        assert [line.partition(" ")[2] for line in said] == [
            f"received {one.store.history()[0].id} name=b3.xlsx",
            "request what=POST /submissions status=303 sender=anna",
            "request what=GET /nix··forged status=404 sender=anna",
        ]
