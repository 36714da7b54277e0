"""R1 to R3: whatever step of the service a kill or a fault meets, what was handed in ends once, whole and the same."""

from __future__ import annotations

import csv
import io
import json
import os
import pickle
import random
import shutil
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest
from filled import SOUND, filled
from service_steps import FAULTS, scene_of

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not hasattr(os, "fork"), reason="a kill at each step needs processes that are forked"),
]

_PROGRAM = Path(__file__).resolve().parents[1] / "support" / "service_judge.py"
_SOURCE = Path(__file__).resolve().parents[2] / "src"


def _table(row):
    text = io.StringIO()
    writer = csv.DictWriter(text, list(row))
    writer.writeheader()
    writer.writerow(row)
    return text.getvalue().encode()


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """Return three submissions for INBOX, a partly good, a good and a broken one, and the same one twice by page."""
    wrong = SOUND | {"variant": "B", "torque_Nm": -5}
    path = tmp_path_factory.mktemp("scene") / "scene.pickle"
    path.write_bytes(
        pickle.dumps(
            scene_of(
                {"partly.xlsx": filled([SOUND, wrong]), "good.csv": _table(SOUND), "broken.csv": b"no,table\n1,2\n"},
                {f"{number:032x}": ("page.csv", _table(SOUND)) for number in (1, 2)},
            )
        )
    )
    return path


@contextmanager
def _judge(scene):
    """Give the durable steps of an undisturbed run, and a function that says what is wrong after points."""
    program = subprocess.Popen(
        [sys.executable, str(_PROGRAM), str(scene)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        env=os.environ | {"PYTHONPATH": os.pathsep.join((str(_SOURCE), str(_PROGRAM.parent)))},
    )  # fmt: skip

    def wrong(points):
        found = {}
        for point in points:
            program.stdin.write(f"{json.dumps(point)}\n")
            program.stdin.flush()
            if said := json.loads(program.stdout.readline()):
                found[json.dumps(point)] = said
        return found

    with program:
        try:
            yield json.loads(program.stdout.readline()), wrong
        finally:
            program.stdin.close()


def _first(steps):
    """Return the first step of those that are taken at the same place in the service."""
    return sorted({step: number for number, step in reversed([*enumerate(steps, 1)])}.values())


def _kills(steps, chosen):
    """Return kills right before each of these steps, and half way through what is written."""
    whole = [{"steps": [step], "how": "before"} for step in chosen]
    return whole + [{"steps": [step], "how": "half"} for step in chosen if steps[step - 1].startswith("write ")]


def _pairs(steps, number):
    """Return kills at one step and, in the run that finishes what was left, at another."""
    drawn = random.Random(0)  # noqa: S311
    places = range(1, len(steps) + 1)
    return [{"steps": drawn.choices(places, k=2), "how": drawn.choice(("before", "after"))} for _ in range(number)]


def _faulty(chosen, hows, lasting):
    return [{"steps": [step], "how": how, "lasting": lasting} for step in chosen for how in hows]


def test_r1_r2_a_kill_at_each_kind_of_step_loses_doubles_and_alters_nothing(scene):
    """Killed before and after a durable step, and finished by another run, it comes to the same bytes and states.

    Right after the kill each original is in one place, each file in OUT is whole, and those of an original that was put
    away are there.
    """
    with _judge(scene) as (steps, wrong):
        assert len(steps) > 300
        around = {step + more for step in _first(steps) for more in (0, 1)}
        assert wrong(_kills(steps, sorted(around & {*range(1, len(steps) + 1)}))) == {}
        assert wrong(_pairs(steps, 10)) == {}


def test_r3_a_fault_of_this_machine_at_each_kind_of_step_loses_nothing(scene):
    """A full disk, a failing one, missing permission, a fault after the deed, for one step or for a while: it goes on.

    What it then says is done the store holds at once.
    """
    with _judge(scene) as (steps, wrong):
        first = _first(steps)
        for number, how in enumerate(FAULTS):
            assert wrong(_faulty(first[number::4], [how], 1)) == {}
            assert wrong(_faulty(first[number::16], [how], 20)) == {}


@pytest.mark.long
def test_r1_r2_a_kill_at_every_step_loses_doubles_and_alters_nothing(scene):
    """The same at every step, and at a thousand pairs of steps."""
    with _judge(scene) as (steps, wrong):
        assert wrong(_kills(steps, range(1, len(steps) + 1))) == {}
        assert wrong(_pairs(steps, 1_000)) == {}


@pytest.mark.long
def test_r3_faults_of_this_machine_at_every_step_lose_nothing(scene):
    """The same at every step, for one step and for thirty."""
    with _judge(scene) as (steps, wrong):
        for lasting in (1, 30):
            assert wrong(_faulty(range(1, len(steps) + 1), FAULTS, lasting)) == {}


@pytest.mark.long
@pytest.mark.skipif(not shutil.which("strace"), reason="strace kills at system calls, and is not there")
def test_r1_r3_kills_and_faults_within_sqlite_lose_nothing(scene):
    """Killed, or refused, at any of the writes and flushes that SQLite makes, it comes to the same as well."""
    drawn = random.Random(0)  # noqa: S311
    calls = ("pwrite64", "fdatasync", "fsync")
    hows = ("signal=KILL", "error=EIO", "error=ENOSPC")
    points = [
        {"steps": [drawn.randint(1, 400)], "how": drawn.choice(hows), "call": drawn.choice(calls)} for _ in range(200)
    ]
    with _judge(scene) as (_, wrong):
        assert wrong(points) == {}
