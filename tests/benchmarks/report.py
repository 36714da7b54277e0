"""Time, memory and size of writing a report, beside XlsxWriter alone writing the same cells in the plainest loop.

    python tests/benchmarks/report.py [ROWS ...]

The rows are those of the published study, their dimensions varied by a per cent. While one report is made, every cell
is noted: the same values, formulas, links and formats are then written by XlsxWriter alone, without charts, filters
and rules. Both are timed alternately in one process, by the processor time of the quickest of three runs of each;
memory is the peak of a process which writes the report once, less what it holds before (Linux only). Quote the ratios:
absolute times differ from machine to machine.
"""

from __future__ import annotations

import gc
import io
import pickle
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import polars as pl
import xlsxwriter
from xlsxwriter.url import Url

from flexlash.analysis.outcome import Outcome
from flexlash.feedback.template.template_workbook import study
from flexlash.pipeline import run
from flexlash.report.layout.given_rows import GivenRows
from flexlash.report.workbook import report_bytes

RUNS = 3
VARIED = ("torque_Nm", "cylinder_length_mm", "wall_thickness_mm", "backlash_limit_arcmin")
WRITERS = ("write_string", "write_number", "write_formula", "write_blank", "write_url")


def computed(rows: int, folder: Path) -> Outcome:
    """Return the outcome of that many rows, those of the study varied by a per cent."""
    source, examples, made = random.Random(1), list(study().variants), []  # noqa: S311
    for number in range(rows):
        row = dict(examples[number % len(examples)])
        row |= {key: round(row[key] * source.uniform(0.99, 1.01), 4) for key in VARIED if key in row}
        made.append(row | {"variant": f"{row['variant']} no. {number:05d}", "tolerance_class": ""})
    path = folder / f"{rows}.csv"
    pl.DataFrame(made, infer_schema_length=None).write_csv(path)
    return run(path, folder / f"{rows}.xlsx", jobs=2)


class Noted:
    """What one report writes: per sheet every cell with its format, in the order in which it was written."""

    def __init__(self, outcome: Outcome) -> None:
        self.formats: list[dict[str, Any]] = []
        self.sheets: list[tuple[str, list[tuple[Any, ...]]]] = []
        self.cells = 0
        self._places: dict[int, int] = {}
        add_format, add_worksheet = xlsxwriter.Workbook.add_format, xlsxwriter.Workbook.add_worksheet

        def noting_format(workbook: Any, properties: dict[str, Any] | None = None) -> Any:
            made = add_format(workbook, properties)
            if properties and "xf_index" not in properties:  # the workbook's own format has one
                self._places[id(made)] = len(self.formats)
                self.formats.append(dict(properties))
            return made

        def noting_sheet(workbook: Any, name: str, kind: Any = None) -> Any:
            sheet = add_worksheet(workbook, name, kind)
            calls: list[tuple[Any, ...]] = []
            self.sheets.append((name, calls))
            for writer in WRITERS:
                setattr(sheet, writer, self._noting(getattr(sheet, writer), calls, writer))
            if isinstance(sheet, GivenRows):
                sheet.give = self._noting_rows(sheet.give, calls)
            return sheet

        xlsxwriter.Workbook.add_format, xlsxwriter.Workbook.add_worksheet = noting_format, noting_sheet
        try:
            report_bytes(outcome)
        finally:
            xlsxwriter.Workbook.add_format, xlsxwriter.Workbook.add_worksheet = add_format, add_worksheet

    def _noting(self, write: Callable[..., Any], calls: list[tuple[Any, ...]], name: str) -> Callable[..., Any]:
        """Return a writer that notes what it is given; of a link its target, since its text is changed later."""

        def noting(row: int, column: int, value: Any = None, style: Any = None, *rest: Any) -> Any:
            kept, more = (value._original_url, (value.text,)) if isinstance(value, Url) else (value, rest)
            calls.append((name, row, column, kept, self._places.get(id(style), -1), more))
            self.cells += 1
            return write(row, column, value, style, *rest)

        return noting

    def _noting_rows(self, give: Callable[..., None], calls: list[tuple[Any, ...]]) -> Callable[..., None]:
        """Return what takes rows at once and notes their cells, row by row."""

        def noting(first: int, columns: Any, heights: Any) -> None:
            for offset in range(len(columns[0][0])):
                for column, (values, styles) in enumerate(columns):
                    if (value := values[offset]) is not None:
                        writer = "write_string" if isinstance(value, str) else "write_number"
                        place = self._places[id(styles[offset])]
                        calls.append((writer, first + offset, column, value, place, ()))
                        self.cells += 1
            give(first, columns, heights)

        return noting

    def again(self) -> bytes:
        """Write the same cells by XlsxWriter alone."""
        buffer = io.BytesIO()
        workbook = xlsxwriter.Workbook(buffer, {"in_memory": True, "strings_to_urls": False})
        styles = [*(workbook.add_format(properties) for properties in self.formats), None]
        for name, calls in self.sheets:
            sheet = workbook.add_worksheet(name)
            for writer, row, column, value, style, rest in calls:
                getattr(sheet, writer)(row, column, value, styles[style], *rest)
        workbook.close()
        return buffer.getvalue()


def quickest(first: Callable[[], bytes], second: Callable[[], bytes]) -> tuple[float, float]:
    """Return the processor time [s] of the quickest of some runs of each, run alternately."""
    gc.collect()
    gc.freeze()
    times: tuple[list[float], list[float]] = ([], [])
    for _ in range(RUNS):
        for work, found in zip((first, second), times, strict=True):
            start = time.process_time()
            work()
            found.append(time.process_time() - start)
    return min(times[0]), min(times[1])


def resident(what: str) -> float:
    """Return what Linux calls VmRSS, the memory of this process, or VmHWM, its peak [MiB]."""
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return next(int(line.split()[1]) / 1024 for line in lines if line.startswith(what))


def memory(path: Path) -> float:
    """Return the memory [MiB] that a process of its own needs for a report on top of the outcome."""
    done = subprocess.run([sys.executable, __file__, "--memory", str(path)], check=True, capture_output=True, text=True)
    return float(done.stdout)


def main() -> None:
    """Print a line for each number of rows."""
    print(f"{'rows':>7}{'cells':>11}{'report s':>10}{'plain s':>9}{'ratio':>7}{'MB':>7}{'MiB':>7}{'MiB/10,000':>12}")
    with tempfile.TemporaryDirectory() as name:
        for rows in [int(argument) for argument in sys.argv[1:]] or [1000, 10_000]:
            outcome = computed(rows, Path(name))
            path = Path(name) / "outcome.pickle"
            path.write_bytes(pickle.dumps(outcome))
            noted = Noted(outcome)
            ours, plain = quickest(lambda: report_bytes(outcome), noted.again)  # noqa: B023
            used, size = memory(path), len(report_bytes(outcome)) / 1e6
            line = f"{rows:7,}{noted.cells:11,}{ours:10.2f}{plain:9.2f}{ours / plain:7.2f}{size:7.2f}"
            print(f"{line}{used:7.0f}{used * 10_000 / rows:12.0f}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--memory"]:
        kept = pickle.loads(Path(sys.argv[2]).read_bytes())  # noqa: S301
        before = resident("VmRSS")
        report_bytes(kept)
        print(resident("VmHWM") - before)
    else:
        main()
