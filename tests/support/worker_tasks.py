"""Work for worker processes, in a module that they can import."""

from __future__ import annotations

import json
import os
import pickle
import random
import signal
import time
from pathlib import Path

from flexlash.batch.lent_workers import borrowed_workers
from flexlash.reading.limited_process import ask
from flexlash.reading.read import Source, submission_of
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.workers import tell, timed

__all__ = [
    "ask_for_a_process",
    "borrow",
    "borrow_and_wait",
    "die",
    "die_once",
    "doubled",
    "each_parquet",
    "fail",
    "large",
    "leave",
    "obey",
    "own_number",
    "random_bytes",
    "read_within",
    "sleep",
    "slowly",
    "square",
    "tell_and_wait",
    "tell_each",
    "told",
]


def square(number):
    """Return the square of a number and the process that computed it."""
    return number * number, os.getpid()


def die_once(item):
    """Return a number; the first process that takes number 2 is killed and leaves a file."""
    number, trace = item
    if number == 2 and not Path(trace).exists():
        Path(trace).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def die(number):
    """Kill every process that takes number 2, if it is not the one that is named beside it."""
    if number[0] == 2 and os.getpid() != number[1]:
        os.kill(os.getpid(), signal.SIGKILL)
    return number[0]


def fail(dimensions):
    """Be a model that fails."""
    raise ValueError(f"the model failed with {len(dimensions)} dimensions")


def sleep(seconds):
    """Do nothing for some seconds."""
    time.sleep(seconds)
    return os.getpid()


def slowly(answer):
    """Return what was given, after more time than a file has."""
    time.sleep(1.5)
    return answer


def leave():
    """End this process."""
    os._exit(3)


def large(size):
    """Return so many bytes."""
    return bytes(size)


def own_number():
    """Return the number of the process that does this."""
    return os.getpid()


def ask_for_a_process():
    """Return why the limited process cannot be started from here, an empty text where it can."""
    from flexlash.reading.limited_process import ProcessFaultError, begin

    try:
        begin()
    except ProcessFaultError as fault:
        return str(fault)
    return ""


def obey(text):
    """Do what a text says, as if a file had taken its reader over."""
    answer = {}
    exec(text, {"answer": answer})  # noqa: S102
    return answer


def each_parquet(files):
    """Return what became of each of these files: its refusal, or that it was read."""
    ends = []
    for data in files:
        try:
            submission_of(Source(name="a.parquet", data=data), ReadingLimits())
            ends.append("read")
        except Refusal as refusal:
            ends.append(refusal.code)
    return ends


def doubled(data):
    """Return some bytes twice, from a piece of work of a batch."""
    return data * 2


def told(data):
    """Do what some bytes say and return what they call `answer`, as JSON."""
    found = {}
    exec(data.decode(), {"answer": found})  # noqa: S102
    return json.dumps(found).encode()


def tell_each(data):
    """Tell each byte of what is given, then return all of it twice."""
    for place in range(len(data)):
        tell(data[place : place + 1])
    return data * 2


def tell_and_wait(data):
    """Tell again and again for some seconds, of which one is allowed."""
    with timed(1):
        for _ in range(10 * int(data)):
            tell(b"still here")
            time.sleep(0.1)
    return data


def read_within(data):
    """Do what some bytes say as if a file had taken its reader over, with the limits that stand before them."""
    limits, text = data.decode().split("\n", 1)
    try:
        found = ask(obey, ReadingLimits(**json.loads(limits)), text)
    except Refusal as refusal:
        found = {"refused": refusal.facts.get("setting", refusal.code)}
    return json.dumps(found).encode()


def random_bytes(data):
    """Return as many bytes as are named after a seed, the same for every worker."""
    seed, size = data.decode().split()
    return random.Random(seed).randbytes(int(size))  # noqa: S311


def borrow(name, pieces):
    """Have borrowed workers do pieces of work of this module; return answers, or faults in words, in order."""
    tell(pickle.dumps("begun"))
    with borrowed_workers(2) as workers:
        futures = [workers.submit(globals()[name], piece) for piece in pieces]
        return pickle.dumps([_answer_or_fault(future) for future in futures])


def borrow_and_wait(seconds):
    """Want many pieces of work that take a while."""
    return borrow("told", [b"import time; time.sleep(0.5)"] * (2 * seconds))


def _answer_or_fault(future):
    fault = future.exception()
    return future.result() if fault is None else f"{type(fault).__name__}: {fault}"
