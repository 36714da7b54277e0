"""Work done by the workers of a Dask scheduler, on this machine or others: bytes travel, and nothing else.

Whatever Dask needs on a network is said in docs/clusters.md.
"""

from __future__ import annotations

import asyncio
import itertools
import os
import re
import secrets
import threading
import zlib
from collections.abc import Coroutine, Iterator
from concurrent.futures import CancelledError, Future
from contextlib import AsyncExitStack, contextmanager, suppress
from importlib.util import find_spec
from typing import Any, TypeVar

from flexlash import __version__
from flexlash.batch.dask_work import OtherVersion, begin_processes, carried_out_here, end_processes
from flexlash.batch.executor import ClusterError, Executor, Told, Work, WorkerLostError
from flexlash.schema.exit_codes import ExitCode
from flexlash.schema.findings import shown

__all__ = ["LOCAL", "ClusterError", "MissingDaskError", "dask_executor", "require_address"]

Result = TypeVar("Result")

LOCAL = "local"
"""The address of a scheduler that is started here, and ends with its caller."""

_ADDRESS = re.compile(r"(tcp|tls)://[^\s/]+:\d{1,5}", re.ASCII)

_HERE = "127.0.0.1:0"
"""Any port that this computer alone reaches."""

_CONNECTING = 10
"""Seconds that the scheduler may take to answer."""

_COMING = 60
"""Seconds that its first worker may take to come."""

_COUNTING = 2
"""Seconds after which the workers are counted again."""

_DESERTED = 300
"""Seconds without a worker after which none is expected any more; in a shorter time a machine starts anew."""

_TRIES = 3
"""Times that a piece of work is given to a scheduler that gave it up, having lost several workers over it."""

_QUIET = {
    # What goes wrong is told by the one that asks; Dask's own words would stand between.
    "logging": dict.fromkeys(("distributed", "distributed.client", "distributed.core", "tornado"), "critical"),
    # A workbook may have 20 MiB, and data that are scattered are lost with the worker that holds them.
    "distributed.admin.large-graph-warning-threshold": "1TiB",
    # Looking on while its threads wait for processes would take more processor time than all else that Dask does.
    "distributed.worker.profile.enabled": False,
    "distributed.comm.timeouts.connect": f"{_CONNECTING}s",
}


class MissingDaskError(ModuleNotFoundError):
    """Dask is not installed."""

    exit_code = ExitCode.USAGE

    def __init__(self) -> None:
        super().__init__("A scheduler needs Dask: pip install 'flexlash[dask]'.")


class _DaskExecutor:
    """The workers of a scheduler, which come and go, asked in a thread that talks with it."""

    def __init__(self, address: str, client: Any, loop: asyncio.AbstractEventLoop) -> None:
        self.workers = 1
        self._address = address
        self._client = client
        self._loop = loop
        self._lost = f"the Dask scheduler at {address} is not reachable"
        self._topic = f"flexlash-{secrets.token_hex(8)}"
        self._numbers = itertools.count()
        self._told: dict[int, Told] = {}
        client.subscribe_topic(self._topic, self._tell)

    def submit(self, work: Work, data: bytes, told: Told | None = None) -> Future[bytes]:
        """Return what will be the answer; threads may ask side by side.

        What is told meanwhile goes by the scheduler, so that it may come late, or never when a machine is lost. Besides
        what every executor raises it raises ClusterError when the scheduler or all of its workers are lost, or workers
        have another version of flexlash.
        """
        return asyncio.run_coroutine_threadsafe(self._answer(work, data, told), self._loop)

    def _tell(self, event: tuple[float, tuple[int, bytes]]) -> None:
        """Hand on what a worker tells; what is told after the answer concerns nobody."""
        piece, message = event[1]
        if told := self._told.get(piece):
            with suppress(Exception):
                told(zlib.decompress(message))

    async def counted(self) -> int:
        """Return how many threads the workers have now."""
        threads: int = sum((await self._client.nthreads()).values())
        self.workers = max(1, threads)
        return threads

    async def counted_again_and_again(self) -> None:
        """Count the workers as long as the scheduler is there; give up when there have been none for too long."""
        seen = self._loop.time()
        while self._client.status == "running":
            await asyncio.sleep(_COUNTING)
            with suppress(OSError):
                if await self.counted():
                    seen = self._loop.time()
            if self._loop.time() - seen > _DESERTED:
                self._lost = f"the Dask scheduler at {self._address} has had no workers for {_DESERTED} seconds"
                await self._client.close()

    async def _answer(self, work: Work, data: bytes, told: Told | None) -> bytes:
        """Return the answer of some worker, and have told meanwhile what it tells."""
        if told is None:
            return await self._asked(work, data)
        piece = next(self._numbers)
        self._told[piece] = told
        try:
            return await self._asked(work, data, self._topic, piece)
        finally:
            del self._told[piece]

    async def _asked(self, work: Work, data: bytes, *where_to_tell: object) -> bytes:
        """Return the answer of some worker; the scheduler repeats by itself what it loses a few workers over."""
        from distributed import KilledWorker

        for _ in range(_TRIES):
            try:
                asked = self._client.submit(carried_out_here, __version__, work, data, *where_to_tell, pure=False)
                answer = await asked
            except KilledWorker:
                continue
            except CancelledError:
                raise ClusterError(self._lost) from None
            except Exception as fault:
                if self._client.status != "running":
                    raise ClusterError(self._lost) from None
                raise ClusterError(
                    f"a worker of the Dask scheduler at {self._address} cannot do the work of flexlash {__version__} "
                    f"({type(fault).__name__}: {fault}); install flexlash {__version__} there"
                ) from fault
            if isinstance(answer, OtherVersion):
                raise ClusterError(
                    f"a worker of the Dask scheduler at {self._address} has flexlash {answer}, this is {__version__}; "
                    "install the same version everywhere"
                )
            if isinstance(answer, Exception):
                raise answer
            return answer  # type: ignore[no-any-return]
        message = f"all workers of Dask that took up a piece of work were lost, {_TRIES} times"
        raise WorkerLostError(message, losses=_TRIES)


def require_address(address: str) -> None:
    """Raise ValueError for what is no address of a scheduler, MissingDaskError where Dask is missing."""
    if address != LOCAL and not _ADDRESS.fullmatch(address):
        raise ValueError(
            f"{shown(address)} is not the address of a Dask scheduler: local or tcp://HOST:PORT is required"
        )
    if find_spec("distributed") is None:
        raise MissingDaskError


@contextmanager
def dask_executor(address: str, workers: int | None = None) -> Iterator[Executor]:
    """Give an executor of all workers of the Dask scheduler at an address such as `tcp://10.0.0.1:8786`.

    The address `local` starts a scheduler here, with so many `workers` or as many as there are processors; both end
    when the executor is left. Raises ValueError for what is no address, MissingDaskError, and ClusterError when the
    scheduler or its workers do not answer.
    """
    require_address(address)
    import dask
    import distributed  # noqa: F401 - else its own settings would be forgotten with those that are set here

    with dask.config.set(_QUIET), _loop() as loop:
        stack = AsyncExitStack()
        try:
            yield _in(loop, _connected(stack, address, workers or os.cpu_count() or 1, loop))
        finally:
            _in(loop, stack.aclose())


async def _connected(
    stack: AsyncExitStack, address: str, workers: int, loop: asyncio.AbstractEventLoop
) -> _DaskExecutor:
    """Return an executor that is connected until the stack is closed."""
    from distributed import Client, LocalCluster

    at: Any = address
    if address == LOCAL:
        # A worker of Dask within this process, whose own processes do the work. Its servers are seen here alone.
        at = await stack.enter_async_context(
            LocalCluster(  # type: ignore[no-untyped-call]
                n_workers=1, threads_per_worker=workers, processes=False, protocol="inproc://", memory_limit=0,
                dashboard_address=_HERE, worker_dashboard_address=_HERE, asynchronous=True,
            )
        )  # fmt: skip
        begin_processes()
        # Before the worker ends, which would wait for what they are doing.
        stack.callback(end_processes)
    try:
        client: Any = Client(at, asynchronous=True, set_as_default=False, timeout=_CONNECTING)  # type: ignore[no-untyped-call]
        stack.push_async_callback(client.close)
        await client
    except (OSError, TypeError) as fault:
        # A TypeError says that tls:// was asked for without certificates.
        raise ClusterError(f"the Dask scheduler at {address} is not reachable: {fault}") from fault
    try:
        await client.wait_for_workers(1, timeout=_COMING)
    except (TimeoutError, OSError) as fault:
        raise ClusterError(
            f"the Dask scheduler at {address} has no workers; start one with: dask worker {address}"
        ) from fault
    executor = _DaskExecutor(address, client, loop)
    await executor.counted()
    counting = loop.create_task(executor.counted_again_and_again())
    stack.callback(counting.cancel)
    return executor


def _in(loop: asyncio.AbstractEventLoop, what: Coroutine[Any, Any, Result]) -> Result:
    """Return what is worked out in the thread of a loop."""
    return asyncio.run_coroutine_threadsafe(what, loop).result()


@contextmanager
def _loop() -> Iterator[asyncio.AbstractEventLoop]:
    """Give a loop that runs in a thread of its own; what it has not finished at the end is cancelled."""
    loop = asyncio.new_event_loop()
    thread = threading.Thread(target=loop.run_forever, name="flexlash Dask", daemon=True)
    thread.start()
    try:
        yield loop
    finally:
        _in(loop, _all_cancelled())
        loop.call_soon_threadsafe(loop.stop)
        thread.join()
        loop.close()


async def _all_cancelled() -> None:
    """Cancel everything else that this loop is doing."""
    others = asyncio.all_tasks() - {asyncio.current_task()}
    for task in others:
        task.cancel()
    await asyncio.gather(*others, return_exceptions=True)
