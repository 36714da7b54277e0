"""What a page costs: a task with it beside the same task without, in one worker that is limited as a service's is.

    python tests/benchmarks/page_facts.py [FILE ...]

By default the study and the submission that needs fixing. Both tasks make the report and the marked copy; with a page
they tell the findings first, and make Results as CSV, the file with the certain fixes and the facts of the page as
well. Printed is the processor time of the quickest of some runs in turn: quote the ratio, and the difference on a quiet
machine.
"""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

from flexlash.analysis.examination import opened
from flexlash.analysis.options import Options
from flexlash.batch.answer import Answer, Task
from flexlash.batch.compute import compute
from flexlash.reading.inside_limits import prepare

RUNS = 8
DATA = Path(__file__).resolve().parents[2] / "data"


def _seconds(task: bytes) -> float:
    start = time.process_time()
    compute(task)
    return time.process_time() - start


def main() -> None:
    """Print a line for each file."""
    paths = [*map(Path, sys.argv[1:])] or [DATA / "b3-160-study.xlsx", DATA / "needs-fixing.xlsx"]
    shown = os.fdopen(os.dup(1), "w")
    prepare()
    for path in paths:
        options = Options()
        source = opened(path, options)
        tasks = [
            Task(command="run", source=source, options=options, report=".xlsx", copy=".xlsx", pages=pages).as_bytes()
            for pages in (False, True)
        ]
        answer = Answer.of(compute(tasks[1]))
        plain, paged = (min(times) for times in zip(*([*map(_seconds, tasks)] for _ in range(RUNS)), strict=True))
        print(
            f"{path.name}: {plain:.3f} s without a page, {paged:.3f} s with one ({paged / plain:.2f} times, "
            f"{paged - plain:+.3f} s); page {len(answer.page) / 1024:.0f} KiB",
            file=shown,
            flush=True,
        )


if __name__ == "__main__":
    main()
