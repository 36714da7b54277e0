"""Runs over a folder that are killed without warning at many moments and taken up: what it costs, whether it holds.

    python tests/benchmarks/killed_batches.py [moments] [submissions]

A run is killed after a time that is spread over an undisturbed run's, taken up and killed again until it ends by
itself; then its outputs must be those of the undisturbed run, byte for byte. It prints how often each was killed, how
many submissions were done by then, and the wall time of all runs as a share of the undisturbed one.
"""

from __future__ import annotations

import shutil
import subprocess
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


def killed(folder: Path, moments: list[float]) -> tuple[list[int], float]:
    """Run, kill at each of these moments after its start, then let it end; return what was done then, and the time."""
    known, start = [], time.perf_counter()
    for seconds in moments:
        run = begun(folder, "--resume")
        try:
            run.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
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
        spread = [whole * (number + 0.5) / moments for number in range(moments)]
        for first in range(0, moments, 3):
            folder = place / f"killed-{first}"
            shutil.copytree(place / "straight" / "in", folder / "in")
            at = spread[first : first + 3]
            known, seconds = killed(folder, at)
            same = outputs(folder) == expected
            words = ", ".join(f"{one:.1f} s ({number} done)" for one, number in zip(at, known, strict=True))
            held = "the same bytes" if same else "OTHER BYTES"
            print(f"killed at {words}: {held}, {seconds / whole:.1f} times the time")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
