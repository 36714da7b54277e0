"""Work done in this process, at once, for tests that are about the work and not about who does it."""

from __future__ import annotations

from concurrent.futures import Future

from flexlash.batch.executor import Work

__all__ = ["Here"]


class Here:
    """An executor whose only worker is this process."""

    workers = 1

    def submit(self, work: Work, data: bytes) -> Future[bytes]:
        """Return the answer, or what the work raises."""
        future: Future[bytes] = Future()
        try:
            future.set_result(work(data))
        except BaseException as fault:  # noqa: BLE001
            future.set_exception(fault)
        return future
