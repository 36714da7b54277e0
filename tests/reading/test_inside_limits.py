"""The limited process from inside: what it gives, and what it is forbidden."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from flexlash.reading import inside_limits as limited_module
from flexlash.reading.inside_limits import Fault, carried_out, forbid
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal


def _raising(fault):
    raise fault


def test_a_refusal_and_too_little_memory_are_answers():
    """What a task refuses is its answer, and memory that does not suffice is a refusal that names the limit."""
    refusal = Refusal("E104", found="x")
    assert carried_out(_raising, ReadingLimits(), (refusal,)) is refusal
    assert carried_out(_raising, ReadingLimits(), (MemoryError(),)).facts["setting"] == "memory_mebibytes"


@pytest.mark.parametrize("fault", [KeyError("x"), RecursionError(), SystemExit(0)])
def test_every_other_exception_is_told_in_words(fault):
    """Whatever else a task raises comes back as its kind and trace, which every process understands."""
    answer = carried_out(_raising, ReadingLimits(), (fault,))
    assert isinstance(answer, Fault)
    assert (answer.kind, "_raising" in answer.trace) == (type(fault).__name__, True)


def test_a_process_that_was_not_prepared_says_why(monkeypatch):
    """A library that cannot be loaded is named by every answer, instead of a file."""
    monkeypatch.setattr(limited_module._State, "fault", Fault.of(ImportError("no polars")))
    assert "no polars" in carried_out(len, ReadingLimits(), ("",)).trace


@pytest.mark.slow
def test_the_warm_up_loads_all_that_a_file_needs(tmp_path):
    """After the warm-up a workbook is read and validated without loading anything more, in a folder that has gone."""
    (gone := tmp_path / "gone").mkdir()
    code = (
        "import os, sys; from pathlib import Path\n"
        "from flexlash.reading.inside_limits import _warm_up\n"
        "from flexlash.reading.read import Source, submission_of\n"
        "from flexlash.reading.reading_limits import ReadingLimits\n"
        "from flexlash.validation.validate import validate\n"
        "limits = ReadingLimits()\n"
        "source = Source.at(Path(sys.argv[1]), limits)\n"
        "_warm_up()\n"
        "if os.name != 'nt': os.rmdir(os.getcwd())\n"
        "loaded = set(sys.modules)\n"
        "validate(submission_of(source, limits), limits)\n"
        "print(*{name for name in set(sys.modules) - loaded if not name.startswith('encodings')})"
    )
    study = Path(__file__).resolve().parents[2] / "data" / "b3-160-study.xlsx"
    ran = subprocess.run(
        [sys.executable, "-c", code, str(study)], cwd=gone, check=False, capture_output=True, text=True
    )
    assert (ran.stdout.strip(), ran.stderr) == ("", "")


@pytest.mark.skipif(sys.platform == "win32", reason="this system cannot limit a process")
def test_limits_end_with_the_file():
    """What a process may use is lowered while it handles a file, and as before afterwards, whatever happens."""
    before = _allowed()
    during = []

    def look_and_fail():
        during.extend(_allowed())
        raise KeyError

    carried_out(look_and_fail, ReadingLimits(), ())
    assert during[2][0] == 0
    assert all(low[0] != high[0] for low, high in zip(during, before, strict=True))
    assert _allowed() == before


def _allowed():
    import resource

    return [resource.getrlimit(kind) for kind in (resource.RLIMIT_AS, resource.RLIMIT_CPU, resource.RLIMIT_FSIZE)]


def test_a_system_without_limits_still_works(monkeypatch):
    """Where a process cannot be limited, its work is done all the same."""
    monkeypatch.setitem(sys.modules, "resource", None)
    assert carried_out(len, ReadingLimits(), ("four",)) == 4


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
            forbid(event, arguments)


@pytest.mark.parametrize(
    ("event", "arguments"),
    [("open", ("x", "r", 0)), ("open", ("x", "rb", 0)), ("open", ("x", None, os.O_RDONLY)), ("import", ("os",))],
)
def test_reading_is_allowed(event, arguments):
    """What only reads is let through."""
    assert forbid(event, arguments) is None
