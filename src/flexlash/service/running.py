"""The service put together: store, dispatcher, drop folder, webhook and keeper, started and stopped in order.

page or drop folder ─► store ─► dispatcher ─► workers ─► store ─► drop folder, webhook
"""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from flexlash.analysis.options import Options
from flexlash.batch.executor import Executor
from flexlash.batch.manifest import options_digest
from flexlash.service.dispatcher import Dispatcher
from flexlash.service.drop_folder import DropFolder
from flexlash.service.keeper import Keeper
from flexlash.service.log import Log
from flexlash.service.memory import give_back_large_blocks
from flexlash.service.places import Places
from flexlash.service.running_page import forget_page
from flexlash.service.store import Store
from flexlash.service.tasks import service_options
from flexlash.service.webhook import Webhook, webhook_key

__all__ = ["STOPPING", "Service", "Setup", "running", "stopped_by_signals"]

STOPPING = 25.0
"""Seconds within which what is at work may still end once the service is told to stop; 5 more and all has ended."""

_LEAST_STOP = 1.0
"""Seconds that each part has for its present step, however little is left."""


@dataclass(frozen=True, kw_only=True)
class Setup:
    """What a service is started with.

    `store` is the folder of the store, `workers` how many processes compute, or what a Dask `scheduler` has; `inbox`
    and `out` are the drop folder, both or neither. What ended longer ago than `keep_seconds` is forgotten. Each ending
    is told to the address `webhook`, signed with the key in a file, or with one that the store has.
    """

    store: Path
    workers: int
    scheduler: str | None = None
    inbox: Path | None = None
    out: Path | None = None
    keep_seconds: float = 90 * 86_400.0
    webhook: str = ""
    webhook_key_file: Path | None = None
    options: Options = field(default_factory=Options)

    def executor(self) -> AbstractContextManager[Executor]:
        """Return what computes; of a lost process the store counts the tries."""
        if self.scheduler is None:
            from flexlash.batch.local_executor import local_executor

            return local_executor(self.workers, tries=1, warm=True)
        from flexlash.batch.dask_executor import dask_executor

        return dask_executor(self.scheduler, self.workers)


@dataclass(frozen=True, kw_only=True)
class Service:
    """A service that runs: its store, what computes, its drop folder if it has one, the digest of its options."""

    store: Store
    dispatcher: Dispatcher
    places: Places | None
    folder: DropFolder | None
    options_digest: str
    started_at: float


class _Part(Protocol):
    """What runs in a thread of its own."""

    def start(self) -> None:
        """Begin."""

    def stop(self, seconds: float, /) -> None:
        """End within so many seconds."""


@contextmanager
def running(setup: Setup, log: Log) -> Iterator[Service]:
    """Give a service that runs until it is left, which takes no more than half a minute.

    Raises StoreError, PlacesError, ValueError or OSError for what it cannot be started with.
    """
    give_back_large_blocks()
    with ExitStack() as stack:
        places = None
        if setup.inbox is not None and setup.out is not None:
            places = stack.enter_context(Places.of(setup.inbox, setup.out, setup.store))
        store = stack.enter_context(Store(setup.store, serving=True, webhook=bool(setup.webhook)))
        forget_page(store.folder)
        stack.callback(forget_page, store.folder)
        service, parts = _put_together(setup, store, places, log)
        facts: dict[str, object] = {"inbox": places.inbox, "out": places.out} if places else {}
        log.say("started", "", store=store.folder, workers=setup.scheduler or setup.workers, **facts)
        stack.callback(_stop, parts)
        for part in parts:
            part.start()
        yield service
        log.say("stopping")
    log.say("stopped")


def _put_together(setup: Setup, store: Store, places: Places | None, log: Log) -> tuple[Service, Sequence[_Part]]:
    """Return a service and its parts, in the order in which they are started and stopped."""
    options = service_options(setup.options)
    digest = options_digest(options, {}, marked=True)
    outward: list[DropFolder | Webhook] = []

    def ended() -> None:
        for part in outward:
            part.wake()

    dispatcher = Dispatcher(store, setup.executor, setup.options, log, ended=ended)
    folder = None
    if places is not None:
        most = options.limits.file_mebibytes * 2**20
        folder = DropFolder(store, places, digest, log, dispatcher.wake, most_bytes=most)
        outward.append(folder)
    if setup.webhook:
        outward.append(Webhook(store, setup.webhook, webhook_key(store.folder, setup.webhook_key_file), log))
    service = Service(
        store=store,
        dispatcher=dispatcher,
        places=places,
        folder=folder,
        options_digest=digest,
        started_at=time.time(),
    )
    return service, [dispatcher, Keeper(store, setup.keep_seconds, log), *outward]


def _stop(parts: Sequence[_Part]) -> None:
    """Stop parts, one after the other, so that all have ended in time however long one of them takes."""
    end = time.monotonic() + STOPPING
    for part in parts:
        part.stop(max(_LEAST_STOP, end - time.monotonic()))


@contextmanager
def stopped_by_signals() -> Iterator[threading.Event]:
    """Give what is set once the process is asked to end: by Ctrl-C, SIGTERM, or Ctrl-Break on Windows."""
    wanted = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGBREAK") if hasattr(signal, name)]
    stopped = threading.Event()
    before = {one: signal.signal(one, lambda *_: stopped.set()) for one in wanted}
    try:
        yield stopped
    finally:
        for one, handler in before.items():
            signal.signal(one, handler)
