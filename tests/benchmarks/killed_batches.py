"""Runs over a folder that are killed without warning at many moments and taken up: what it costs, whether it holds.

    python tests/benchmarks/killed_batches.py [moments] [submissions]

Each folder is begun and killed three times, when so many submissions more are done and a moment has passed, and then
ends by itself; its outputs must be those of an undisturbed run, byte for byte, at each moment every file whole and
afterwards no process left. It prints what was done by each moment and the wall time of all runs beside that of the
undisturbed one.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

from batch_runs import begun, done, ended, none_left, outputs, parts
from filled import SOUND, filled


def submissions(folder: Path, count: int) -> None:
    """Write so many workbooks of ten rows each."""
    (folder / "in").mkdir(parents=True)
    for number in range(count):
        rows = [{**SOUND, "variant": f"{number}-{row}", "torque_Nm": 100 + number + row} for row in range(10)]
        (folder / "in" / f"s{number:03}.xlsx").write_bytes(filled(rows))


def killed(folder: Path, moments: list[tuple[int, float]]) -> tuple[list[int], float]:
    """Run and kill at each of these moments, then let it end; return what was done then, and the time of all [s]."""
    known, start = [], time.perf_counter()
    for more, seconds in moments:
        before = done(folder)
        run = begun(folder, "--resume")
        while done(folder) < before + more and run.poll() is None:
            time.sleep(0.005)
        time.sleep(seconds)
        run.kill()
        run.communicate()
        known.append(done(folder))
        assert not parts(folder), parts(folder)
        assert none_left(run.pid), "processes are left"
    assert ended(begun(folder, "--resume"))[0] == 0
    return known, time.perf_counter() - start


def main(moments: int = 20, count: int = 12) -> None:
    """Kill runs at so many moments in all, three to a folder, and print what came of each."""
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        submissions(place / "straight", count)
        start = time.perf_counter()
        assert ended(begun(place / "straight"))[0] == 0
        whole = time.perf_counter() - start
        expected = outputs(place / "straight")
        print(f"undisturbed: {whole:.1f} s for {count} submissions, {len(expected)} files")
        at = [(number % (count // 3), 0.03 * number) for number in range(moments)]
        for first in range(0, moments, 3):
            folder = place / f"killed-{first}"
            shutil.copytree(place / "straight" / "in", folder / "in")
            known, seconds = killed(folder, at[first : first + 3])
            held = "the same bytes" if outputs(folder) == expected else "OTHER BYTES"
            print(f"killed with {known} of {count} done: {held}, {seconds / whole:.1f} times the time")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
