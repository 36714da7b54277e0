"""What is left of a service that was killed or had faults, beside what an undisturbed one leaves.

Run as a program it reads points, one a line, from standard input, and answers each with one line: what was wrong
afterwards, an empty list where nothing was. Each point is a process of its own, forked from one that has loaded
everything; what it was killed over is finished by another.
"""

from __future__ import annotations

import hashlib
import json
import os
import pickle
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import traceback
from contextlib import suppress
from dataclasses import asdict, replace
from pathlib import Path

import service_steps
from service_steps import Point, Steps, once

from flexlash.service.store import Store

__all__ = ["Judge"]

_KILLED = -signal.SIGKILL
_ID = re.compile(r"[0-9a-f]{32}(?![0-9a-f])")


def _digest(data):
    """Return the digest of bytes in which IDs, which are drawn by chance, do not count."""
    with suppress(UnicodeDecodeError):
        data = _ID.sub("ID", data.decode()).encode()
    return hashlib.sha256(data).hexdigest()


def _tree(folder):
    """Return every file below a folder by its place, in which IDs do not count."""
    found = []
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path.name != "service.lock" and not path.name.startswith(".filelock-"):
            place = "/".join("ID" if _ID.fullmatch(part) else part for part in path.relative_to(folder).parts)
            found.append((place, _digest(path.read_bytes())))
    return sorted(found)


def _held(root):
    """Return what the store holds when all is done, and what is wrong with that."""
    wrong, held = [], []
    with Store(root / "store", serving=True) as store:
        for one in store.history(most=1000):
            files = store.files(one.id)
            wrong += [f"{one.name}: {file.role} is not whole" for file in files.values()
                      if not store.blobs.is_whole(file.sha256)]  # fmt: skip
            digests = {role: _digest(store.blobs.path(file.sha256).read_bytes()) for role, file in files.items()}
            facts = asdict(one)
            kept = {key: facts[key] for key in ("name", "sha256", "door", "state", "exit_code", "words", "counts",
                                                "tries", "alone", "rows", "rows_done")}  # fmt: skip
            held.append(json.dumps(kept | {"files": digests, "again": bool(one.same_as)}, sort_keys=True))
        named = {sha256 for sha256, _ in store.named()}
        store.sweep(0.0)
        kept = {path.name for path in (root / "store" / "blobs").glob("??/*")}
        if kept != named:
            wrong.append(f"{len(kept - named)} blobs that nothing names, {len(named - kept)} missing")
        if left := list((root / "store" / "blobs" / "incoming").iterdir()):
            wrong.append(f"left over: {left}")
        if store.undelivered():
            wrong.append("something is not delivered")
    return sorted(held), wrong


def _after_kill(root, scene, whole):
    """Return what is wrong at once after a kill.

    An original may be lost or doubled, an output not whole, or an original put away before its outputs are there.
    """
    wrong = []
    places = [*(root / "in").iterdir(), *(root / "out" / "work").glob("*/*/*"), *(root / "out" / "done").glob("*/*"),
              *(root / "out" / "rejected").glob("*/*")]  # fmt: skip
    found = sorted(hashlib.sha256(path.read_bytes()).hexdigest() for path in places if not path.name.startswith("."))
    if found != sorted(hashlib.sha256(data).hexdigest() for data in scene.inbox.values()):
        wrong.append(f"originals lost, doubled or altered: {[str(path) for path in places]}")
    outputs = [one for one in _tree(root / "out") if "/" not in one[0] and not one[0].startswith(".flexlash-")]
    wrong += [f"{one[0]} is not whole" for one in outputs if one not in whole]
    away = [path.stem for path in places if path.parts[-3] in {"done", "rejected"}]
    missing = {one for one in whole if any(one[0].startswith(f"{stem}-") for stem in away)} - {*outputs}
    return [*wrong, *(f"{one[0]} is not there, though the original was put away" for one in missing)]


def _in_child(work):
    """Do something in a process of its own; return how that ended and what it wrote."""
    read, write = os.pipe()
    child = os.fork()
    if not child:
        os.close(read)
        code = 1
        try:
            told = json.dumps(work())
            os.write(write, told.encode())
            code = 0
        except BaseException:  # noqa: BLE001
            os.write(write, traceback.format_exc()[-3000:].encode())
        os._exit(code)
    os.close(write)
    with open(read, "rb") as pipe:  # noqa: PTH123
        told = pipe.read().decode()
    _, status = os.waitpid(child, 0)
    return os.waitstatus_to_exitcode(status), told


def _run(root, scene, restarts, **chosen):
    """Run the service in a process of its own; return how it ended, its steps, and whether all was done."""

    def work():
        steps = Steps(**chosen)
        steps.watch()
        return once(root, scene, restarts, steps)

    return _in_child(work)


def _traced(root, point, number):
    """Run the service under strace, which kills it at a system call or has that fail; return as `_run` does."""
    inject = ["-e", f"trace={point.call}", "-e", f"inject={point.call}:{point.how}:when={number}"]
    command = [
        "strace",
        "-qq",
        "-o",
        os.devnull,
        *inject,
        sys.executable,
        service_steps.__file__,
        sys.argv[1],
        str(root),
    ]
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    return ended.returncode, ended.stdout or ended.stderr


class Judge:
    """An undisturbed run, and what every other one must come to."""

    def __init__(self, scene, folder) -> None:
        self._scene, self._folder = scene, folder
        self._root = folder / "run"
        self._begin()
        code, told = _run(self._root, scene, 0)
        if code or not json.loads(told)["done"]:
            raise RuntimeError(f"the undisturbed run ended with {code}: {told}")
        self.steps = json.loads(told)["steps"]
        self._tree = _tree(self._root / "out")
        self._held, wrong = _held(self._root)
        if wrong:
            raise RuntimeError(f"the undisturbed run: {wrong}")

    def _begin(self):
        shutil.rmtree(self._root, ignore_errors=True)
        (self._root / "in").mkdir(parents=True)
        for name, data in self._scene.inbox.items():
            (self._root / "in" / name).write_bytes(data)

    def wrong(self, point):
        """Return what is wrong once a run that was killed, or had faults, was finished."""
        self._begin()
        wrong, restarts = [], 0
        for step in point.steps:
            if point.call:
                code, told = _traced(self._root, point, step)
            else:
                code, told = _run(self._root, self._scene, restarts, step=step, how=point.how, lasting=point.lasting)
            restarts += 1
            if code == _KILLED:
                wrong += _after_kill(self._root, self._scene, self._tree)
                continue
            if code:
                return [f"ended with {code}: {told}"]
            said = json.loads(told)
            if "internal error" in said["said"] or not (said["done"] or "could not start" in said["said"]):
                wrong.append(said["said"][-2000:])
            elif said["done"] and {*_in_child_held(self._root)[0]} != {*self._held}:
                wrong.append("what was said to be done is not held")
        code, told = _run(self._root, self._scene, restarts)
        if code or not json.loads(told)["done"]:
            return [*wrong, f"not finished: {code} {told[-3000:]}"]
        held, more = _in_child_held(self._root)
        wrong += more
        wrong += [f"held otherwise: {one}" for one in {*held} ^ {*self._held}]
        if len(held) != len(self._held):
            wrong.append(f"{len(held)} submissions instead of {len(self._held)}")
        tree = _tree(self._root / "out")
        if tree != self._tree:
            wrong.append(f"OUT differs: {sorted({*tree} ^ {*self._tree})}")
        return wrong


def _in_child_held(root):
    code, told = _in_child(lambda: _held(root))
    return json.loads(told) if not code else ([], [told])


def main():
    """Answer points, one a line."""
    scene = pickle.loads(Path(sys.argv[1]).read_bytes())  # noqa: S301
    memory = Path("/dev/shm")  # noqa: S108
    where = memory if os.access(memory, os.W_OK) else None
    with tempfile.TemporaryDirectory(dir=where) as folder:
        judge = Judge(scene, Path(folder))
        print(json.dumps(judge.steps), flush=True)  # noqa: T201
        for line in sys.stdin:
            given = json.loads(line)
            point = replace(Point(), **given | {"steps": tuple(given["steps"])})
            print(json.dumps(judge.wrong(point)), flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
