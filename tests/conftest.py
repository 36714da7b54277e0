"""Submissions for the tests, made from the template or as plain tables."""

from __future__ import annotations

import csv
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import openpyxl
import pytest
from filled import SOUND, filled
from here import WHERE, WORKERS, answer_here, workers_here

from flexlash.cli import batches
from flexlash.reading import limited_process as isolated

VECTORS = "ignore:wmf image format is not supported:UserWarning"
"""openpyxl, which only tests read reports with, leaves out the drawings of parts and says so."""

_APART = {WHERE: isolated._answer, WORKERS: batches.workers}
_HERE = {WHERE: answer_here, WORKERS: workers_here}


@pytest.hookimpl(tryfirst=True)
def pytest_cmdline_main(config):
    """Run on all cores where no path is named; a room or a file alone starts sooner in this process.

    The processes that are started for it pass here as well, and start no others.
    """
    whole = config.args_source != pytest.Config.ArgsSource.ARGS and not hasattr(config, "workerinput")
    if whole and config.option.numprocesses is None and not config.option.usepdb:
        config.option.numprocesses = "auto"


def pytest_configure(config):
    """Let tests open a report whose pages of failing variants show their parts."""
    config.addinivalue_line("filterwarnings", VECTORS)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item):
    """Let a test fail that skips where FLEXLASH_MUST_RUN=1 says that nothing it needs is missing, as in CI.

    Public workbooks alone may be missing there, since no package brings them.
    """
    report = yield
    must_run = os.environ.get("FLEXLASH_MUST_RUN") == "1" and not item.get_closest_marker("public_workbooks")
    if must_run and report.skipped and not hasattr(report, "wasxfail"):
        report.outcome = "failed"
        report.longrepr = f"skipped although FLEXLASH_MUST_RUN=1: {report.longrepr[2]}"
    return report


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector):
    """Let a module fail that skips as a whole, by the same rule."""
    report = yield
    if os.environ.get("FLEXLASH_MUST_RUN") == "1" and report.skipped:
        report.outcome = "failed"
        report.longrepr = f"{collector.nodeid} skipped although FLEXLASH_MUST_RUN=1: {report.longrepr[2]}"
    return report


@pytest.fixture(scope="session", autouse=True)
def _read_here():
    """Read and compute in this process: starting another takes a second."""
    with pytest.MonkeyPatch.context() as patch:
        for place, here in _HERE.items():
            patch.setattr(place, here)
        yield


@pytest.fixture(scope="module", autouse=True)
def _read_apart_in_module(request):
    """Read them in a process of their own, as the program does, also in the fixtures of a module that is about it."""
    with pytest.MonkeyPatch.context() as patch:
        for place, apart in _APART.items() if request.node.get_closest_marker("limited_process") else ():
            patch.setattr(place, apart)
        yield


@pytest.fixture(autouse=True)
def _read_apart(request, monkeypatch):
    """Read them in a process of their own where a test is about it."""
    for place, apart in _APART.items() if "limited_process" in request.keywords else ():
        monkeypatch.setattr(place, apart)


@pytest.fixture
def sound() -> dict[str, Any]:
    """Return a fresh copy of a row without a fault."""
    return dict(SOUND)


@pytest.fixture
def workbook(tmp_path: Path) -> Callable[..., Path]:
    """Return a function that fills the template with rows, and other sheets by keyword, and gives its path."""

    def write(rows: Sequence[Mapping[str, Any]], name: str = "submission.xlsx", **filling: Any) -> Path:
        path = tmp_path / name
        path.write_bytes(filled(rows, **filling))
        return path

    return write


@pytest.fixture
def table(tmp_path: Path) -> Callable[..., Path]:
    """Return a function that writes rows as a CSV file under their keys and gives its path."""

    def write(rows: Sequence[Mapping[str, Any]], name: str = "submission.csv") -> Path:
        path = tmp_path / name
        headers = list(dict.fromkeys(key for row in rows for key in row))
        with path.open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, headers)
            writer.writeheader()
            writer.writerows(rows)
        return path

    return write


@pytest.fixture
def book(tmp_path: Path) -> Callable[..., Path]:
    """Return a function that writes sheets of rows as a workbook, changes it, and gives its path."""

    def write(sheets, change=None):
        workbook = openpyxl.Workbook()
        workbook.remove(workbook.active)
        for name, rows in sheets.items():
            sheet = workbook.create_sheet(name)
            for row in rows:
                sheet.append(row)
        if change:
            change(workbook)
        path = tmp_path / "submission.xlsx"
        workbook.save(path)
        return path

    return write
