"""Work given to an executor and taken back in order, at most some pieces of it at a time."""

from __future__ import annotations

from collections import deque


def in_order(executor, work, items, window):
    """Yield the finished future of each item in the order of the items, which are taken only as they are needed.

    At most `window` pieces of work are in the hands of the executor, or finished and not yet yielded. What is under way
    when the caller stops is cancelled, as far as it has not begun.
    """
    ahead = deque()
    coming = iter(items)
    try:
        while True:
            while len(ahead) < max(window, 1) and (data := next(coming, None)) is not None:
                ahead.append(executor.submit(work, data))
            if not ahead:
                return
            ahead[0].exception()
            yield ahead.popleft()
    finally:
        for future in ahead:
            future.cancel()
