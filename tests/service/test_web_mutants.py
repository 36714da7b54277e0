"""Two thousand requests made up by chance: none is a fault, none comes without the policy, none keeps anything."""

import asyncio
import random
import re

import pytest
from web_pages import page

from flexlash.service.web.access import Access

WORDS = ["/", "submissions", "history", "static", "files", "report", "variants", "0", "..", "%", "\0", "\n", "é", "💥",
         "findings", "E101", "open", "login", "difference", "retry", "health?", "#", "a" * 300, "0" * 32]  # fmt: skip
FORMS = ["/submissions", "/login", f"/submissions/{'0' * 32}/retry"]
NAMES = [b"accept", b"cookie", b"authorization", b"origin", b"sec-fetch-site", b"content-length", b"range"]
VALUES = [b"application/json", b"same-origin", b"Bearer x", b"5", b"bytes=0-5", b"text/html;q=", b"flexlash-8765=0"]
CHARSETS = [b"utf-8", b"utf-7", b"utf-16", b"idna", b"punycode", b"undefined", b"hex", b"zlib", b"none"]


class Chance(random.Random):
    """What is sent, by a seed."""

    def junk(self, most):
        """Return some bytes that a header may hold."""
        return bytes(self.choice(range(33, 256)) for _ in range(self.randrange(most)))

    def path(self):
        """Return a path, as often as not one that takes a form."""
        if self.random() < 0.7:
            return self.choice(FORMS)
        return "/" + "/".join(self.choice(WORDS) for _ in range(self.randrange(5)))

    def headers(self, body):
        """Return headers, sound ones first."""
        found = [(b"host", b"127.0.0.1"), (b"remote-user", b"anna"), (b"content-length", b"%d" % len(body))]
        kind = b"multipart/form-data; boundary=b; charset=%s" % self.choice(CHARSETS)
        found.append((b"content-type", self.choice([kind, kind, b"application/x-www-form-urlencoded", self.junk(30)])))
        if self.random() < 0.3:
            found += [(name, self.choice([*VALUES, self.junk(40)])) for name in NAMES if self.random() < 0.2]
        return found

    def body(self):
        """Return a form with some parts, or none."""
        names = [b"token", b"file", b"action", b"access", self.junk(5)]
        ends = [b"", b'; filename="a.xlsx"', b"; filename*=UTF-8''%E2%82%AC", b'; filename="%s"' % self.junk(20)]
        parts = (
            b'--b\r\nContent-Disposition: form-data; name="%s"%s\r\n%s\r\n%s\r\n'
            % (self.choice(names), self.choice(ends), self.choice([b"", b"X: y\r\n", self.junk(9)]), self.junk(60))
            for _ in range(self.randrange(1, 4))
        )
        form = b"".join(parts) + b"--b--\r\n"
        return self.choice([form, form, form, self.junk(100), b"a=%00&access=%ff&token=x", b""])


async def _answer(app, scope, body):
    """Return status and headers of the answer to a request whose body comes in two pieces."""
    pieces, sent = [body[:7], body[7:]], []

    async def receive():
        if not pieces:
            return {"type": "http.disconnect"}
        return {"type": "http.request", "body": pieces.pop(0), "more_body": bool(pieces)}

    async def send(message):
        sent.append(message)

    await app(scope, receive, send)
    return sent[0]["status"], [name for name, _ in sent[0]["headers"]]


@pytest.mark.slow
@pytest.mark.parametrize("how", [{}, {"behind_proxy": "Remote-User"}, {"opens": True}])
def test_no_request_is_a_fault(tmp_path, how):
    """Whatever path, headers and form are put together by chance, the answer is a refusal or a page, never a fault."""
    chance, statuses = Chance(str(how)), set()

    async def ask_all(app):
        for _ in range(700):
            body = chance.body()
            method = chance.choice(["GET", "HEAD", "PUT", "OPTIONS", *["POST"] * 5])
            scope = {
                "type": "http", "asgi": {"version": "3.0"}, "http_version": "1.1", "method": method, "scheme": "http",
                "path": chance.path(), "raw_path": b"/", "root_path": "", "headers": chance.headers(body),
                "query_string": chance.choice([b"", b"text=%25&state=%ff", b"before=99999999999", chance.junk(30)]),
                "client": (chance.choice(["127.0.0.1", "::1", "10.0.0.1"]), 5), "server": ("127.0.0.1", 8765),
            }  # fmt: skip
            status, names = await _answer(app, scope, body)
            statuses.add(status)
            assert status < 500, (scope, body)
            assert names.count(b"content-security-policy") == 1, (scope, body)

    with page(tmp_path, access=Access.of(**how)) as one:
        asyncio.run(ask_all(one.app))
        assert not one.store.history()
        assert not re.search("Traceback|internal error", one.said.getvalue())
    assert len(statuses) >= 4
