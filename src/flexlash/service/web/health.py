"""How flexlash fares, for whoever watches it: neither names anybody."""

from __future__ import annotations

import shutil
import tempfile
import time

from starlette.requests import Request
from starlette.responses import JSONResponse, PlainTextResponse, Response

from flexlash.service.web.site import Site

__all__ = ["Health"]

_PATIENCE = 60.0
"""Seconds that a submission may wait while workers are being started, or a scheduler is."""


class Health:
    """The handlers of /health and /metrics."""

    def __init__(self, site: Site) -> None:
        self._site = site

    def health(self, _: Request) -> Response:
        """Say that all is well, or what is not."""
        wrong = self._wrong()
        told = {
            "status": "failing" if wrong else "ok",
            "wrong": wrong,
            "seconds": int(time.time() - self._site.started_at),
        }
        return JSONResponse(told, 503 if wrong else 200)

    def _wrong(self) -> list[str]:
        """Return what is wrong, in words."""
        wrong = [] if self._site.works.is_alive else ["nothing is taking the waiting submissions"]
        try:
            with tempfile.TemporaryFile(dir=self._site.store.folder):
                pass
            waited = self._site.store.figures()["oldest_waiting_seconds"]
            if not self._site.works.workers and waited > _PATIENCE:
                wrong.append("the waiting submissions find no workers")
            wrong += self._site.troubles()
            if self._free() < self._site.limits.free_bytes:
                wrong.append("the disk is nearly full")
        except Exception:  # noqa: BLE001
            wrong.append("the store cannot be used")
        return wrong

    def _free(self) -> int:
        return shutil.disk_usage(self._site.store.folder).free

    def metrics(self, _: Request) -> Response:
        """Return the numbers in the text format of Prometheus."""
        store, works = self._site.store, self._site.works
        states = [f'flexlash_submissions{{state="{state}"}} {count}' for state, count in store.totals().items()]
        gauges = {"waiting_bytes": store.waiting_bytes(), "workers": works.workers, "workers_busy": works.busy,
                  "free_bytes": self._free(), **store.figures()}  # fmt: skip
        lines = ["# TYPE flexlash_submissions gauge", *states]
        for name, value in gauges.items():
            lines += [f"# TYPE flexlash_{name} gauge", f"flexlash_{name} {value}"]
        return PlainTextResponse("\n".join(lines) + "\n", media_type="text/plain; version=0.0.4")
