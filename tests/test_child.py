"""The limited process from inside: what it answers, and what it is forbidden."""

import os

import pytest

from flexlash.submission.reading import child
from flexlash.submission.reading.limits import ReadingLimits
from flexlash.submission.reading.refusal import Refusal
from small_workbook import book_of


def _raising(fault):
    def task(data, limits):  # noqa: ARG001
        raise fault

    return task


ANSWERS = {
    "a refusal": (Refusal("E104", found="x"), ["E104", {"found": "x"}]),
    "too little memory": (MemoryError(), "memory_mebibytes"),
    "a fault of the program": (KeyError("/secret/path"), ["E118", {}]),
    "too deep a recursion": (RecursionError(), ["E118", {}]),
}


@pytest.mark.parametrize("what", ANSWERS)
def test_every_fault_is_an_answer(what, monkeypatch, capfd):
    """Whatever goes wrong with a task, its answer is a refusal by name, without the fault's own words."""
    fault, expected = ANSWERS[what]
    monkeypatch.setitem(child.TASKS, "workbook", _raising(fault))
    head, payload = child.answer("workbook", b"", ReadingLimits())
    capfd.readouterr()
    assert payload == b""
    if isinstance(expected, str):
        assert head["refusal"][1]["setting"] == expected
    else:
        assert head == {"refusal": expected}


def test_a_workbook_is_answered_with_its_cells():
    """The answer to a workbook holds its cells."""
    head, payload = child.answer("workbook", book_of(), ReadingLimits())
    assert ([sheet["rows"] for sheet in head["sheets"]], payload) == ([[[1, [[1, 1]]]]], b"")


FORBIDDEN = {
    "open": [("x", "w", 0), ("x", "a", 0), ("x", "r+", 0), ("x", "xb", 0), ("x", None, os.O_WRONLY),
             ("x", None, os.O_RDWR), ("x", None, os.O_CREAT)],
    "socket.__new__": [()],
    "socket.connect": [()],
    "socket.getaddrinfo": [()],
    "subprocess.Popen": [()],
    "os.system": [()],
    "os.exec": [()],
    "os.posix_spawn": [()],
    "os.fork": [()],
    "os.forkpty": [()],
    "os.remove": [()],
    "os.rename": [()],
    "os.mkdir": [()],
    "os.rmdir": [()],
    "os.link": [()],
    "os.symlink": [()],
    "os.chmod": [()],
    "os.truncate": [()],
    "shutil.rmtree": [()],
    "ctypes.dlopen": [()],
    "urllib.Request": [()],
}  # fmt: skip


@pytest.mark.parametrize("event", FORBIDDEN)
def test_what_reaches_outside_is_forbidden(event):
    """Writing, starting, connecting and deleting raise in the limited process."""
    for arguments in FORBIDDEN[event]:
        with pytest.raises(PermissionError):
            child._forbid(event, arguments)


@pytest.mark.parametrize(
    ("event", "arguments"),
    [("open", ("x", "r", 0)), ("open", ("x", "rb", 0)), ("open", ("x", None, os.O_RDONLY)), ("import", ("os",))],
)
def test_reading_is_allowed(event, arguments):
    """What only reads is let through."""
    assert child._forbid(event, arguments) is None


def test_every_task_says_what_it_needs():
    """Every task names the modules that it imports before writing is forbidden."""
    assert child._NEEDED.keys() == child.TASKS.keys()
