"""Asking the limited process: whatever a file does to its reader, a refusal by name comes back and nothing stays."""

import json
import multiprocessing
import os
import random
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import polars as pl
import pytest
import regenerate
from here import WHERE, answer_here
from read_files import read_submission
from small_workbook import book_of
from worker_tasks import ask_for_a_process, each_parquet, fail, large, obey, own_number, slowly, square

from flexlash.pipeline import check
from flexlash.reading import limited_process as isolated
from flexlash.reading.limited_process import ProcessFaultError, ask
from flexlash.reading.read import Source, submission_of
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal

pytestmark = pytest.mark.limited_process

limits_are_there = pytest.mark.skipif(sys.platform == "win32", reason="this system cannot limit a process")


def _refusal(text, **limits):
    with pytest.raises(Refusal) as caught:
        ask(obey, ReadingLimits(**limits), text)
    return caught.value


def test_an_answer_comes_back():
    """What a task gives comes back, from one process for all tasks."""
    assert ask(obey, ReadingLimits(), "answer['x'] = [1, 'Δ']") == {"x": [1, "Δ"]}
    assert ask(own_number, ReadingLimits()) == ask(own_number, ReadingLimits()) != os.getpid()


REFUSED = {
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
    "crashes": ("import os; os.abort()", {}, "E118"),
    "leaves": ("import os; os._exit(3)", {}, "E118"),
    "kills itself": ("import os; os.kill(os.getpid(), 9)", {}, "E118"),
}


@pytest.mark.slow
@limits_are_there
@pytest.mark.parametrize("what", REFUSED)
def test_a_reader_that_goes_astray_is_refused_by_name(what):
    """A reader that hangs, eats or dies ends in a refusal that names limit and setting; the next file is read."""
    text, limits, expected = REFUSED[what]
    refusal = _refusal(text, **limits)
    assert refusal.facts.get("setting", refusal.code) == expected
    assert ask(obey, ReadingLimits(), "answer['x'] = 1") == {"x": 1}


@limits_are_there
def test_processor_time_is_that_of_one_file():
    """What one file has used counts against no other: limits are set anew for each, and lifted after it."""
    busy = "import time\nend = time.process_time() + 0.7\nwhile time.process_time() < end: pass"
    for _ in range(4):
        ask(obey, ReadingLimits(processor_seconds=2), busy)
    free = "import resource as r; answer['x'] = r.getrlimit(r.RLIMIT_CPU)[0] - __import__('time').process_time()"
    assert 2 < ask(obey, ReadingLimits(processor_seconds=5), free)["x"] < 7


FAULTS = {
    "raises": "raise ValueError('no')",
    "raises what is no error": "raise SystemExit(0)",
    "recurses": "def f(): f()\nf()",
    "opens a socket": "import socket; socket.socket()",
    "asks for a name": "import socket; socket.getaddrinfo('localhost', 1)",
    "forks": "import os; os.fork()",
    "starts a program": "import subprocess; subprocess.Popen(['true'])",
    "starts a shell": "import os; os.system('true')",
    "becomes a program": "import os; os.execv('/bin/true', ['true'])",
}


@pytest.mark.parametrize("what", FAULTS)
def test_a_fault_of_the_program_is_told_as_one(what):
    """What a task raises is told as the program's fault, with its trace; the process lives on for other files."""
    number = ask(own_number, ReadingLimits())
    with pytest.raises(ProcessFaultError, match="in the limited process"):
        ask(obey, ReadingLimits(), FAULTS[what])
    assert ask(own_number, ReadingLimits()) == number


def test_a_fault_that_cannot_travel_is_told():
    """An exception that another process cannot rebuild arrives in words; it once would have stopped all answers."""
    text = "class Own(Exception):\n    def __init__(self, a, b): super().__init__(a)\nraise Own(1, 2)"
    with pytest.raises(ProcessFaultError, match="Own"):
        ask(obey, ReadingLimits(), text)


def test_a_fault_of_a_reader_is_the_files(tmp_path, monkeypatch):
    """Whatever a library raises while it reads a file refuses that file, and names nothing of the program."""
    monkeypatch.setattr(WHERE, answer_here)

    def panic(data, limits):  # noqa: ARG001
        raise SystemExit("/secret")

    monkeypatch.setattr("flexlash.reading.read.read_workbook", panic)
    path = tmp_path / "a.xlsx"
    path.write_bytes(book_of())
    (found,) = check(path).findings
    assert (found.code, "secret" in found.message) == ("E118", False)


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
def test_a_reader_writes_nothing(tmp_path, order):
    """A reader that writes a file is stopped, and there is no file."""
    with pytest.raises(ProcessFaultError, match="PermissionError"):
        ask(obey, ReadingLimits(), order.format(path=str(tmp_path / "stray")))
    assert list(tmp_path.iterdir()) == []


def test_what_a_reader_prints_is_no_answer(capfd):
    """What a reader prints, or writes to the standard output, reaches neither the answer nor the terminal."""
    text = "import os\nprint('{}', flush=True)\nos.write(1, b'{}\\n')\nos.write(2, b'nonsense')\nanswer['x'] = 1"
    assert ask(obey, ReadingLimits(), text) == {"x": 1}
    assert capfd.readouterr() == ("", "")


def test_threads_wait_for_one_another():
    """Several threads ask one process; the time that each waits for the others is not that of its file."""
    answers = []
    text = "import time; time.sleep(0.6); answer['x'] = 1"
    threads = [
        threading.Thread(target=lambda: answers.append(ask(obey, ReadingLimits(seconds=2), text))) for _ in range(5)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert answers == [{"x": 1}] * 5


ALONE = """
import os, sys
sys.path[:0] = {paths!r}
from flexlash.reading.limited_process import ask
from flexlash.reading.reading_limits import ReadingLimits
from worker_tasks import obey, own_number
print(ask(own_number, ReadingLimits()), flush=True)
ask(obey, ReadingLimits(), "import time; time.sleep(3)")
"""


def _alone(tmp_path, **environment):
    script = tmp_path / "alone.py"
    script.write_text(
        ALONE.format(paths=[str(regenerate.ROOT / one) for one in ("src", "tests/support")]), encoding="utf-8"
    )
    return subprocess.Popen(
        [sys.executable, str(script)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=tmp_path,
        env={**os.environ, **environment},
    )  # fmt: skip


def _is_gone(number, within=20):
    end = time.monotonic() + within
    while time.monotonic() < end:
        try:
            os.kill(number, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.1)
    return False


@pytest.mark.slow
@limits_are_there
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_no_process_stays(tmp_path, how):
    """Ctrl-C, a request to end and a kill of the program while a file is read leave no process behind."""
    with _alone(tmp_path) as command:
        reader = int(command.stdout.readline())
        time.sleep(0.5)
        command.send_signal(how)
        assert command.wait(20) != 0
    assert _is_gone(reader)


@pytest.mark.slow
def test_a_script_is_not_run_again(tmp_path):
    """A script without a guard reads files: the process that does so does not run it once more."""
    with _alone(tmp_path) as command:
        out, complaints = command.communicate(timeout=60)
    assert (command.returncode, len(out.split()), complaints) == (0, 1, "")


@pytest.mark.slow
def test_the_working_folder_puts_no_code_in_the_way(tmp_path):
    """A module that lies beside the submission is imported by neither process, even while they start."""
    for name in ("json", "openpyxl", "runpy", "pickle", "struct", "selectors", "multiprocessing", "polars"):
        (tmp_path / f"{name}.py").write_text(f"raise SystemExit('taken over by {name}')", encoding="utf-8")
    source = str(regenerate.ROOT / "src")
    code = (
        f"import sys; sys.path = [{source!r}, *(one for one in sys.path if one)]\n"
        "from flexlash.pipeline import check\n"
        f"print(check({str(regenerate.ROOT / 'data' / 'b3-160-study.xlsx')!r}).submission.kind)"
    )
    done = subprocess.run([sys.executable, "-P", "-c", code], capture_output=True, text=True, cwd=tmp_path, check=False)
    assert (done.stdout, done.stderr) == ("workbook\n", "")


@pytest.mark.slow
def test_where_no_process_can_be_started_it_is_told(monkeypatch):
    """A system that starts no process is named as the reason, not the file."""
    isolated._abandon()

    def refuse(*_):
        raise OSError(11, "Resource temporarily unavailable")

    monkeypatch.setattr("flexlash.workers._Process.start", refuse)
    with pytest.raises(ProcessFaultError, match="cannot be started"):
        ask(own_number, ReadingLimits())
    monkeypatch.undo()
    assert ask(own_number, ReadingLimits()) != os.getpid()


@pytest.mark.slow
@limits_are_there
def test_a_process_that_dies_while_it_answers_is_noticed():
    """Half an answer of a process that was killed is neither waited for nor taken for one: another one gives it."""
    for moment in range(5):
        number = ask(own_number, ReadingLimits())
        killer = threading.Timer(0.01 * moment, os.kill, (number, signal.SIGKILL))
        killer.start()
        while ask(own_number, ReadingLimits()) == number:
            assert len(ask(large, ReadingLimits(), 50 * 2**20)) == 50 * 2**20
        killer.join()


@pytest.mark.slow
@limits_are_there
def test_a_process_that_was_stopped_between_two_files_costs_nothing():
    """Whatever stopped it while it waited, the next file is read by another one."""
    number = ask(own_number, ReadingLimits())
    os.kill(number, signal.SIGKILL)
    assert ask(own_number, ReadingLimits()) not in {number, os.getpid()}


def _files(folder):
    study = regenerate.ROOT / "data" / "b3-160-study.xlsx"
    parquet = folder / "a.parquet"
    pl.DataFrame({"variant": ["A", None], "wall": [1.6, float("nan")]}).write_parquet(parquet)
    small = folder / "small.xlsx"
    small.write_bytes(book_of('<row r="1"><c r="A1" t="e"><v>#REF!</v></c><c r="B1"><f>1</f></c></row>'))
    text = folder / "a.csv"
    text.write_text("variant;wall\nA;1,6\n", encoding="utf-8")
    return [study, small, parquet, text]


@pytest.mark.slow
def test_ordinary_files_are_read_alike_there_and_here(tmp_path):
    """The limited process gives the submission that this process would give."""
    for path in _files(tmp_path):
        there = read_submission(path)
        here = submission_of(Source(name=path.name, data=path.read_bytes()), ReadingLimits())
        assert repr(there) == repr(here)
        assert there.data == path.read_bytes()


def test_mutants_of_parquet_are_read_or_refused(capfd, tmp_path):
    """Three hundred damaged Parquet files are read or refused: none stops the process, hangs or prints."""
    path = tmp_path / "a.parquet"
    pl.DataFrame({
        "variant": [f"V{n}" for n in range(50)], "wall": [n / 7 for n in range(50)], "n": [None, *range(49)]
    }).write_parquet(path)  # fmt: skip
    sound = path.read_bytes()
    draw = random.Random(5)  # noqa: S311
    mutants = []
    for _ in range(300):
        data = bytearray(sound)
        for _ in range(draw.choice([1, 2, 8])):
            data[draw.randrange(4, len(data))] = draw.randrange(256)
        if draw.random() < 0.2:
            del data[(cut := draw.randrange(4, len(data))) : cut + draw.randrange(1, 40)]
        mutants.append(bytes(data))
    ends = ask(each_parquet, ReadingLimits(), mutants)
    assert len(ends) == 300
    assert set(ends) <= {"read", "E102", "E118", "E101"}
    assert {"read", "E102"} <= set(ends)
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


@pytest.mark.slow
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


@pytest.mark.slow
def test_what_follows_has_no_limits():
    """What goes on with an answer that was found within limits takes its time; a refusal has nothing to go on."""
    assert ask(square, ReadingLimits(seconds=1), 3, then=slowly)[0] == 9
    with pytest.raises(Refusal):
        ask(obey, ReadingLimits(seconds=1), "import time; time.sleep(9)", then=slowly)
    with pytest.raises(ProcessFaultError, match="dimensions"):
        ask(square, ReadingLimits(), 3, then=fail)


@pytest.mark.slow
def test_a_process_that_may_start_none_is_told_what_to_do():
    """A worker of multiprocessing.Pool may start no process: the message says so, and what to use instead."""
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert "ProcessPoolExecutor" in pool.apply(ask_for_a_process)


LOST = """
import sys
sys.path[:0] = {paths!r}
from flexlash.reading.limited_process import ask
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from worker_tasks import obey
try:
    ask(obey, ReadingLimits({limit}), {order!r})
except Refusal as refusal:
    print(refusal.facts.get("setting", refusal.code))
"""


@pytest.mark.slow
@limits_are_there
@pytest.mark.parametrize(
    ("order", "limit", "told"),
    [("import os; os._exit(3)", "", "E118"), ("import time; time.sleep(60)", "seconds=1", "seconds")],
)
def test_a_program_that_ends_after_a_lost_process_says_nothing(order, limit, told):
    """The process that is started in the place of a lost one does not complain where the program ends at once."""
    paths = [str(regenerate.ROOT / one) for one in ("src", "tests/support")]
    for _ in range(3):
        done = subprocess.run(
            [sys.executable, "-c", LOST.format(paths=paths, limit=limit, order=order)],
            capture_output=True, text=True, check=True,
        )  # fmt: skip
        assert (done.stdout.strip(), done.stderr) == (told, "")
