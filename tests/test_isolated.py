"""Asking the limited process: whatever a file does to its reader, a refusal by name comes back and nothing stays."""

import json
import os
import random
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import polars as pl
import pytest

import regenerate
from flexlash.pipeline import check
from flexlash.submission.reading import isolated
from flexlash.submission.reading.isolated import Asked, ask
from flexlash.submission.reading.limits import ReadingLimits
from flexlash.submission.reading.read import read_submission
from flexlash.submission.reading.refusal import Refusal
from here import AskedHere
from small_workbook import book_of

pytestmark = pytest.mark.limited_process

OBEYING = (
    "import sys; sys.path.append(sys.argv[1])\n"
    "from flexlash.submission.reading import child\n"
    "def obey(data, limits):\n    answer = {}\n    exec(data.decode(), {'answer': answer})\n    return answer, b''\n"
    "child.TASKS['workbook'] = obey\nchild.main()\n"
)
"""Starts a reader that does what the file says: as if the file had taken it over."""
limits_are_there = pytest.mark.skipif(sys.platform == "win32", reason="this system cannot limit a process")


@pytest.fixture
def obeying(monkeypatch):
    """Return a function that has a process do what a text says and gives its answer."""
    monkeypatch.setattr(isolated, "_START", OBEYING)

    def order(text, **limits):
        asked = Asked("workbook", text.encode(), ReadingLimits(**limits))
        try:
            return asked.answer()[0]
        finally:
            assert asked.process.poll() is not None

    return order


def _refusal(order, text, **limits):
    with pytest.raises(Refusal) as caught:
        order(text, **limits)
    return caught.value


def test_an_answer_comes_back(obeying):
    """What a task answers comes back."""
    assert obeying("answer['x'] = [1, 'Δ']") == {"x": [1, "Δ"]}


EVIL = {
    "hangs": ("import time; time.sleep(60)", {"seconds": 1}, "seconds"),
    "hangs and will not end": (
        "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(60)",
        {"seconds": 1},
        "seconds",
    ),
    "computes for ever": ("while True: pass", {"processor_seconds": 1}, "processor_seconds"),
    "eats memory": ("x = bytearray(3 * 2**30)", {}, "memory_mebibytes"),
    "eats memory little by little": (
        "x = []\nwhile True: x.append(bytearray(2**22))",
        {"memory_mebibytes": 300},
        "memory_mebibytes",
    ),
    "answers more than memory holds": (
        "answer['x'] = ['x' * 2**20] * 2000",
        {"memory_mebibytes": 300},
        "memory_mebibytes",
    ),
    "crashes": ("import os; os.abort()", {}, "E118"),
    "leaves": ("import os; os._exit(0)", {}, "E118"),
    "kills itself": ("import os; os.kill(os.getpid(), 9)", {}, "E118"),
    "raises": ("raise ValueError('/secret')", {}, "E118"),
    "raises what is no error": ("raise SystemExit(0)", {}, "E118"),
    "recurses": ("def f(): f()\nf()", {}, "E118"),
    "opens a socket": ("import socket; socket.socket()", {}, "E118"),
    "asks for a name": ("import socket; socket.getaddrinfo('localhost', 1)", {}, "E118"),
    "forks": ("import os; os.fork()", {}, "E118"),
    "starts a program": ("import subprocess; subprocess.Popen(['true'])", {}, "E118"),
    "starts a shell": ("import os; os.system('true')", {}, "E118"),
    "becomes a program": ("import os; os.execv('/bin/true', ['true'])", {}, "E118"),
    "answers what cannot be written": ("answer['x'] = {1, 2}", {}, "E118"),
}


@limits_are_there
@pytest.mark.parametrize("what", EVIL)
def test_a_reader_that_goes_astray_is_refused_by_name(obeying, what):
    """A reader that hangs, eats, crashes or reaches out ends in a refusal that names limit and setting, soon."""
    text, limits, expected = EVIL[what]
    start = time.monotonic()
    refusal = _refusal(obeying, text, **limits)
    assert refusal.facts.get("setting", refusal.code) == expected
    assert "secret" not in str(refusal.facts)
    assert time.monotonic() - start < 15


@pytest.mark.parametrize(
    "order",
    [
        "open({path!r}, 'w')",
        "import os; os.open({path!r}, os.O_CREAT | os.O_WRONLY)",
        "import pathlib; pathlib.Path({path!r}).write_text('x')",
        "import os; os.mkdir({path!r})",
        "import os; os.symlink('/', {path!r})",
    ],
)
def test_a_reader_writes_nothing(obeying, tmp_path, order):
    """A reader that writes a file is refused, and there is no file."""
    target = tmp_path / "stray"
    assert _refusal(obeying, order.format(path=str(target))).code == "E118"
    assert list(tmp_path.iterdir()) == []


def test_what_a_reader_prints_is_no_answer(obeying, capfd):
    """What a reader prints, or writes to the standard output, reaches neither the answer nor the terminal."""
    text = "import os\nprint('{}', flush=True)\nos.write(1, b'{}\\n')\nos.write(2, b'nonsense')\nanswer['x'] = 1"
    assert obeying(text) == {"x": 1}
    assert capfd.readouterr() == ("", "")


NONSENSE = {
    "nothing": "",
    "no line": "{",
    "no JSON": "nonsense\\n",
    "no letters": "\\udcff\\udcfe\\n",
    "a number": "7\\n",
    "nothing in JSON": "null\\n",
    "a list": "[]\\n",
    "a word": '\\"x\\"\\n',
    "an empty object": "{}\\n",
    "deep nesting": "' + '[' * 100000 + '\\n",
    "a refusal that is none": '{\\"refusal\\": 5}\\n',
    "a refusal without facts": '{\\"refusal\\": [\\"E102\\"]}\\n',
    "a refusal with a list of facts": '{\\"refusal\\": [\\"E102\\", []]}\\n',
    "a refusal by an unknown code": '{\\"refusal\\": [\\"E999\\", {}]}\\n',
    "a refusal without what its message needs": '{\\"refusal\\": [\\"E110\\", {}]}\\n',
    "sheets that are none": '{\\"sheets\\": 5}\\n',
    "cells that are none": '{\\"sheets\\": [{\\"name\\": \\"S\\", \\"rows\\": [[1, [[1, [\\"x\\", \\"\\"]]]]]}]}\\n',
}


@pytest.mark.parametrize("what", NONSENSE)
def test_nonsense_is_refused(what, monkeypatch, tmp_path):
    """A process that answers nonsense has failed to read the file, and its user is told so."""
    words = f"'{NONSENSE[what]}'.encode(errors='surrogateescape')"
    code = f"import sys; sys.stdin.buffer.read(); sys.stdout.buffer.write({words})"
    monkeypatch.setattr(isolated, "_START", code)
    path = tmp_path / "a.xlsx"
    path.write_bytes(book_of())
    outcome = check(path)
    assert [found.code for found in outcome.findings] == ["E118"]


def test_an_interrupt_ends_the_process(monkeypatch):
    """Whoever stops waiting takes the process along."""
    monkeypatch.setattr(isolated, "_START", "import time; time.sleep(60)")
    asked = Asked("workbook", b"", ReadingLimits())

    def interrupted():
        raise KeyboardInterrupt

    talk = asked.talk
    asked.talk = type("Talk", (), {"join": staticmethod(interrupted)})()
    with pytest.raises(KeyboardInterrupt):
        asked.answer()
    assert asked.process.poll() is not None
    talk.join(5)
    assert not talk.is_alive()


@limits_are_there
def test_an_interrupt_from_the_keyboard():
    """Ctrl-C while a file is read ends the command, and no process of it stays."""
    code = (
        f"import sys; sys.path[:0] = {[str(regenerate.ROOT / 'src')]!r}\n"
        "from flexlash.submission.reading import isolated, limits\n"
        "isolated._START = 'import time; time.sleep(60)'\n"
        "asked = isolated.Asked('workbook', b'', limits.ReadingLimits())\n"
        "print(asked.process.pid, flush=True)\nasked.answer()\n"
    )
    command = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True
    )
    with command:
        reader = int(command.stdout.readline())
        time.sleep(0.2)
        command.send_signal(2)
        assert command.wait(10) != 0
    with pytest.raises(ProcessLookupError):
        os.kill(reader, 0)


def test_a_system_without_limits_still_reads(monkeypatch):
    """Where a process cannot be limited, files are read all the same, and the clock still ends what hangs."""
    without = "import sys; sys.modules['resource'] = None\n"
    monkeypatch.setattr(isolated, "_START", without + isolated._START)
    head, _ = ask("workbook", book_of(), ReadingLimits())
    assert [sheet["name"] for sheet in head["sheets"]] == ["S"]
    monkeypatch.setattr(isolated, "_START", without + OBEYING)
    with pytest.raises(Refusal) as caught:
        ask("workbook", b"while True: pass", ReadingLimits(seconds=1))
    assert caught.value.facts["setting"] == "seconds"


def test_the_working_folder_puts_no_code_in_the_way(tmp_path, monkeypatch):
    """A module that lies beside the submission, or that a variable points to, is not what the process imports."""
    (tmp_path / "json.py").write_text("raise SystemExit('taken over')", encoding="utf-8")
    (tmp_path / "openpyxl.py").write_text("raise SystemExit('taken over')", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    assert ask("workbook", book_of(), ReadingLimits())[0]["sheets"]


def _files(folder):
    study = regenerate.ROOT / "data" / "b3-160-study.xlsx"
    parquet = folder / "a.parquet"
    pl.DataFrame({"variant": ["A", None], "wall": [1.6, float("nan")]}).write_parquet(parquet)
    small = folder / "small.xlsx"
    small.write_bytes(book_of('<row r="1"><c r="A1" t="e"><v>#REF!</v></c><c r="B1"><f>1</f></c></row>'))
    return [study, small, parquet]


def test_ordinary_files_are_read_alike_there_and_here(tmp_path, monkeypatch):
    """The limited process gives the submission that this process would give."""
    for path in _files(tmp_path):
        there = read_submission(path)
        with monkeypatch.context() as patch:
            patch.setattr("flexlash.submission.reading.read.Asked", AskedHere)
            here = read_submission(path)
        assert repr(there) == repr(here)
        assert replace(there, data=b"").sheets.keys() == here.sheets.keys()


PARQUET_READER = """
import json, sys
sys.path.append(sys.argv[1])
from flexlash.submission.reading import child
from flexlash.submission.reading.parquet import read_parquet
from flexlash.submission.reading.refusal import Refusal
from flexlash.submission.reading.wire import to_wire

def each(data, limits):
    import json, struct
    ends = []
    while data:
        (size,) = struct.unpack_from("<I", data)
        try:
            json.dumps(to_wire(read_parquet(data[4:4 + size])))
            ends.append("read")
        except Refusal as refusal:
            ends.append(refusal.code)
        data = data[4 + size:]
    return {"ends": ends}, b""

child.TASKS["parquet"] = each
child.main()
"""


def test_mutants_of_parquet_are_read_or_refused(monkeypatch, capfd, tmp_path):
    """Three hundred damaged Parquet files are read or refused: none stops the process, hangs or prints."""
    path = tmp_path / "a.parquet"
    pl.DataFrame({
        "variant": [f"V{n}" for n in range(50)], "wall": [n / 7 for n in range(50)], "n": [None, *range(49)]
    }).write_parquet(path)  # fmt: skip
    sound = path.read_bytes()
    draw = random.Random(5)  # noqa: S311
    batch = b""
    for _ in range(300):
        data = bytearray(sound)
        for _ in range(draw.choice([1, 2, 8])):
            data[draw.randrange(4, len(data))] = draw.randrange(256)
        if draw.random() < 0.2:
            del data[(cut := draw.randrange(4, len(data))) : cut + draw.randrange(1, 40)]
        batch += len(data).to_bytes(4, "little") + bytes(data)
    monkeypatch.setattr(isolated, "_START", PARQUET_READER)
    ends = ask("parquet", batch, ReadingLimits())[0]["ends"]
    assert len(ends) == 300
    assert set(ends) == {"read", "E102"}
    assert capfd.readouterr() == ("", "")


SPY = """
import json, os, sys
sys.path[:0] = [{source!r}]
seen = []
def spy(event, arguments):
    if event.startswith("socket.") and not event.startswith("socket.gethostname"):
        seen.append([event, str(arguments)])
    elif event == "open":
        path, mode, flags = arguments
        writes = set("wax+") & set(mode) if isinstance(mode, str) else flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT)
        if writes and path != os.devnull and not isinstance(path, int):
            seen.append([event, str(path)])
from flexlash.cli import cli
sys.addaudithook(spy)
codes = []
for arguments in {commands!r}:
    try:
        cli.main(arguments, standalone_mode=False)
        codes.append(0)
    except SystemExit as stop:
        codes.append(stop.code)
print(json.dumps([codes, seen]))
"""


def test_no_network_and_no_stray_write(workbook, sound, tmp_path):
    """Checking and computing a good and a bad file opens no socket and writes the reports and marked copies alone."""
    good = workbook([sound], "good.xlsx")
    bad = workbook([sound, sound | {"variant": "B", "wall_thickness_mm": "thick"}], "bad.xlsx")
    report = tmp_path / "out"
    report.mkdir()
    files = [str(path) for path in (good, bad)]
    commands = [["check", path] for path in files]
    commands += [["run", path, "-o", str(report / f"{Path(path).stem}.xlsx"), "--samples", "128"] for path in files]
    before = set(tmp_path.iterdir())
    done = subprocess.run(
        [sys.executable, "-B", "-c", SPY.format(source=str(regenerate.ROOT / "src"), commands=commands)],
        capture_output=True,
        text=True,
        check=True,
        cwd=tmp_path,
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},
    )
    codes, seen = json.loads(done.stdout.splitlines()[-1])
    assert codes == [0, 3, 0, 3]
    assert [event for event, _ in seen if event != "open"] == []
    assert {Path(path).parent for _, path in seen} == {report}
    assert {path.name for path in report.iterdir()} - {"bad-checked.xlsx"} == {"good.xlsx", "bad.xlsx"}
    assert set(tmp_path.iterdir()) == before
