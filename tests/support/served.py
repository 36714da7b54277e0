"""A whole service on a free port of this machine: store, dispatcher with real workers, page."""

from __future__ import annotations

import io
import os
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import pytest

from flexlash.analysis.options import Options
from flexlash.batch.local_executor import local_executor
from flexlash.batch.manifest import options_digest
from flexlash.service.dispatcher import Dispatcher
from flexlash.service.log import Log
from flexlash.service.store import Store
from flexlash.service.tasks import service_options
from flexlash.service.web.access import Access
from flexlash.service.web.app import application
from flexlash.service.web.serving import PageServer

__all__ = ["Served", "chromium", "needs_chromium", "served"]

_CHROMIUM = next((path for path in ("/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome")
                  if os.access(path, os.X_OK)), "")  # fmt: skip

needs_chromium = pytest.mark.skipif(not _CHROMIUM, reason="Chromium is not installed here")


@dataclass(frozen=True, kw_only=True)
class Served:
    """A service that runs: where its page is, what its store has, who works, what it has said."""

    address: str
    store: Store
    dispatcher: Dispatcher
    said: io.StringIO


@contextmanager
def served(folder: Path, *, workers: int = 1, working: bool = True) -> Iterator[Served]:
    """Run a service over a store in a folder; with `working` false what is handed in waits until it is started."""
    said = io.StringIO()
    log, options = Log(stream=said), service_options(Options())
    with Store(folder, serving=True) as store:
        dispatcher = Dispatcher(store, partial(local_executor, workers, tries=1), options, log)
        access = Access.of(port=0)
        app = application(store, dispatcher, access, options_digest(options, {}, marked=True), time.time(), log=log)
        server = PageServer(app, access, log)
        thread = threading.Thread(target=server.run, daemon=True)
        thread.start()
        if working:
            dispatcher.start()
        try:
            yield Served(address=server.address.rstrip("/"), store=store, dispatcher=dispatcher, said=said)
        finally:
            server.stop()
            thread.join(10)
            dispatcher.stop(5)


@contextmanager
def chromium() -> Iterator[object]:
    """Run Debian's browser without a window."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=_CHROMIUM, args=["--no-sandbox"])
        try:
            yield browser
        finally:
            browser.close()
