"""How much memory a row holds after each stage, and what a row costs there in processor time.

    python tests/benchmarks/memory.py [ROWS]

A table of so many rows, every fifth with fillets and rim, goes through the stages in this process, once as a
delimited text and once as a workbook. What is printed is by how much a record of three times as many rows is larger,
per row, counted as in `tests/support/held_bytes.py`; and the processor time of a run that is not counted, per row.
"""

from __future__ import annotations

import sys
import tempfile
import time
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

from held_bytes import held
from whole_command import make_submission

from flexlash.analysis.assessment import assess
from flexlash.analysis.examination import Examined
from flexlash.analysis.options import Options
from flexlash.analysis.run_result import outcome_of
from flexlash.analysis.tolerance_spread import spread_of
from flexlash.reading.read import Source, submission_of
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.validation.validate import validate

LIMITS = ReadingLimits()


def stages(path, measured):
    """Return the measure of each stage by name; `measured` returns what a stage returns, and its measure."""
    source, options, found = Source.at(path, LIMITS), Options(), {}
    submission, found["read"] = measured(lambda: submission_of(source, LIMITS))
    validated, found["validate"] = measured(lambda: validate(submission, LIMITS))
    nominal, found["assess"] = measured(lambda: assess(validated, validated.settings))
    spread, found["spread"] = measured(lambda: spread_of(nominal.computed, validated.settings, options))
    settings = validated.settings
    examined = Examined(submission=submission, validated=validated, settings=settings, options=options, nominal=nominal)
    results, found["outcome"] = measured(lambda: outcome_of(examined, spread))
    return results, found


def timed(work):
    """Return what a stage returns and its processor time [s]."""
    start = time.process_time()
    made = work()
    return made, time.process_time() - start


def main() -> None:
    """Print a table of stages for each kind of file."""
    rows = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    with tempfile.TemporaryDirectory() as name:
        for ending in (".xlsx", ".csv"):
            paths = [Path(name) / f"{count}{ending}" for count in (rows, 3 * rows)]
            for count, path in zip((rows, 3 * rows), paths, strict=True):
                make_submission(count, path.with_suffix(".xlsx"))
                if ending == ".csv":
                    sheets = submission_of(Source.at(path.with_suffix(".xlsx"), LIMITS), LIMITS)
                    validate(sheets, LIMITS).table.frame.drop("row").write_csv(path)
            _, times = stages(paths[1], timed)
            few, many = (stages(path, partial(held, known=[]))[1] for path in paths)
            print(f"{ending:10}{'kB a row':>10}{'ms a row':>10}")
            for stage, size in many.items():
                print(f"{stage:10}{(size - few[stage]) / (2e3 * rows):10.2f}{1e3 * times[stage] / (3 * rows):10.3f}")


if __name__ == "__main__":
    main()
