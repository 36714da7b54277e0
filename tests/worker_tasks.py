"""Work for worker processes, in a module that they can import."""

from __future__ import annotations

import os
import signal

__all__ = ["PoolHere", "die_in_a_worker", "square"]


def square(number):
    """Return the square of a number and the process that computed it."""
    return number * number, os.getpid()


def die_in_a_worker(item):
    """Return a number; the process of number 2 is killed unless it is the parent, which is named beside it."""
    number, parent = item
    if number == 2 and os.getpid() != parent:
        os.kill(os.getpid(), signal.SIGKILL)
    return number, os.getpid()


class PoolHere:
    """A pool of two workers that are this process."""

    def __init__(self, count, **_):
        assert count == 2

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return False
