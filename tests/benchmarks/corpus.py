"""Every file of a folder through the command line under a memory limit: how each ends, how long and how large.

    python tests/benchmarks/corpus.py FOLDER ...

Each file is checked and run with 2 GB of address space, its outputs in a temporary folder. Printed are the exit codes,
what ends otherwise than with 0, 3, 4 or 5, any traceback, the slowest and the largest; it exits with 1 when something
is wrong.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

LIMITED = 'ulimit -v 2000000; exec "$@"'
SLOWEST = 25.0
GOOD = {0, 3, 4, 5}


def one(path: Path, verb: str, folder: Path) -> tuple[Path, str, int, float, float, str]:
    """Return path, verb, exit code, wall time [s], peak memory [MiB] and output of one command."""
    command = [sys.executable, "-m", "flexlash", verb, str(path)]
    if verb == "run":
        command += ["-o", str(folder / f"{path.name}-{abs(hash(path))}.xlsx")]
    start = time.perf_counter()
    with tempfile.TemporaryFile() as out:
        process = subprocess.Popen(["sh", "-c", LIMITED, "sh", *command], stdout=out, stderr=out)
        _, status, usage = os.wait4(process.pid, 0)
        out.seek(0)
        text = out.read().decode(errors="replace")
    code = os.waitstatus_to_exitcode(status)
    return path, verb, code, time.perf_counter() - start, usage.ru_maxrss / 1024, text


def main(folders: list[str]) -> int:
    """Print how all files ended; return 1 when one of them ended wrongly."""
    files = sorted(path for folder in folders for path in Path(folder).iterdir() if path.is_file())
    with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor(os.cpu_count()) as pool:
        ended = list(
            pool.map(lambda job: one(*job, Path(name)), [(path, verb) for path in files for verb in ("check", "run")])
        )
    print(f"{len(files)} files, exit codes {dict(sorted(Counter(code for _, _, code, *_ in ended).items()))}")
    for what, place in (("slowest", 3), ("largest", 4)):
        path, verb, _, wall, memory, _ = max(ended, key=lambda row: row[place])
        print(f"{what}: {verb} {path.name}, {wall:.1f} s, {memory:.0f} MiB")
    bad = [
        row for row in ended if row[2] not in GOOD or "Traceback" in row[5] or "panicked" in row[5] or row[3] > SLOWEST
    ]
    for path, verb, code, wall, _, text in bad:
        print(f"WRONG: {verb} {path.name}: exit code {code} after {wall:.1f} s\n{text[-2000:]}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
