"""The page in this process, and somebody who asks it; nobody works, so that what is handed in waits."""

from __future__ import annotations

import asyncio
import io
import re
import threading
import time
from contextlib import contextmanager

import httpx

from flexlash.service.log import Log
from flexlash.service.store import Store
from flexlash.service.web.access import Access
from flexlash.service.web.app import application
from flexlash.service.web.serving import PageServer

OWN = {"sec-fetch-site": "same-origin"}
JSON = {"accept": "application/json"}
ADDRESS = "http://127.0.0.1:8765"
TOKEN = re.compile(r'name="token" value="([^"]+)"')


class Idle:
    """Nobody works, and whoever waits is told so by nobody."""

    workers, busy, is_alive = 1, 0, True

    def __init__(self):
        self.woken = 0

    def wake(self):
        """Count who says that something has come in."""
        self.woken += 1


class Visitor:
    """Somebody with a browser: it keeps cookies, says where it comes from, and follows no way of its own accord."""

    def __init__(self, app, client="127.0.0.1", address=ADDRESS, **headers):
        self.app, self.client, self.address = app, client, address
        self.headers = {name.replace("_", "-"): value for name, value in headers.items()}
        self.cookies = httpx.Cookies()

    def ask(self, method, path, **asked):
        """Return the answer to a request."""
        return asyncio.run(self._ask(method, path, **asked))

    async def _ask(self, method, path, *, headers=None, **asked):
        transport = httpx.ASGITransport(self.app, raise_app_exceptions=False, client=(self.client, 50_000))
        async with httpx.AsyncClient(transport=transport, base_url=self.address, cookies=self.cookies) as client:
            said = headers if isinstance(headers, list) else list((headers or {}).items())
            answer = await client.request(method, path, headers=[*self.headers.items(), *said], **asked)
            self.cookies.update(client.cookies)
            return answer

    def get(self, path, **asked):
        """Return the answer to GET."""
        return self.ask("GET", path, **asked)

    def post(self, path, **asked):
        """Return the answer to a form of the page."""
        return self.ask("POST", path, **{"headers": OWN, **asked})

    def token(self):
        """Return the token of a form that has just been shown."""
        return TOKEN.search(self.get("/").text)[1]

    def hand_in(self, name="b3.xlsx", content=b"a workbook", *, token=None, action="run", **asked):
        """Return the answer to a file that is handed in by the form."""
        fields = {"token": self.token() if token is None else token, "action": action}
        return self.post("/submissions", data=fields, files={"file": (name, io.BytesIO(content))}, **asked)


class Page:
    """A store and its page."""

    def __init__(self, folder, access=None, limits=None, works=None, **store):
        self.store = Store(folder / "store", serving=True, **store)
        self.works, self.said = works or Idle(), io.StringIO()
        log = Log(stream=self.said)
        self.access = access or Access.of()
        self.app = application(self.store, self.works, self.access, "options", time.time(), log=log, limits=limits)

    def visitor(self, **how):
        """Return somebody who asks it."""
        return Visitor(self.app, **how)


@contextmanager
def page(folder, **how):
    """Yield a page over a new store."""
    made = Page(folder, **how)
    try:
        yield made
    finally:
        made.store.close()


@contextmanager
def answering(folder, **how):
    """Yield a page over a new store and its server, which answers in a thread at a free port."""
    one = Page(folder, **{"access": Access.of(port=0), **how})
    server = PageServer(one.app, one.access, Log(stream=one.said))
    thread = threading.Thread(target=server.run)
    thread.start()
    try:
        yield one, server
    finally:
        server.stop()
        thread.join(15)
        one.store.close()
        assert not thread.is_alive()
