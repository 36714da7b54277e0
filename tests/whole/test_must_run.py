"""Where nothing that a test needs may be missing, no test skips unseen."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

TESTS = Path(__file__).parents[1]
SKIPPING = """
import pytest

@pytest.mark.skipif(True, reason="lacks a mark")
def test_mark(): pass

def test_inside(): pytest.importorskip("no_such_module", reason="lacks a module")

@pytest.fixture
def missing(): pytest.skip("lacks a fixture")

def test_fixture(missing): pass

@pytest.mark.public_workbooks
def test_public(): pytest.skip("lacks public workbooks")

@pytest.mark.xfail(strict=True)
def test_known(): raise AssertionError
"""
OUTCOMES = {"0": "4 skipped, 1 xfailed", "1": "1 failed, 1 skipped, 1 xfailed, 2 errors"}


@pytest.mark.slow
@pytest.mark.parametrize(("must", "outcomes"), OUTCOMES.items())
def test_a_skipped_test_fails_where_nothing_may_be_missing(must, outcomes, tmp_path):
    """A mark, a missing module and a fixture that skip fail with their reason; public workbooks may be missing."""
    (tmp_path / "test_skipping.py").write_text(SKIPPING, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-c", TESTS.parent / "pyproject.toml", "-n", "0", "-p", "conftest",
         "-p", "no:cacheprovider", "--basetemp", tmp_path / "temporary", tmp_path / "test_skipping.py"],
        env={**os.environ, "FLEXLASH_MUST_RUN": must, "PYTHONPATH": os.pathsep.join(map(str, [TESTS, *sys.path]))},
        check=False, capture_output=True, text=True,
    )  # fmt: skip
    assert outcomes in done.stdout
    for reason in ("a mark", "a module", "a fixture"):
        assert (f"skipped although FLEXLASH_MUST_RUN=1: Skipped: lacks {reason}" in done.stdout) == (must == "1")


@pytest.mark.parametrize(("worker", "processes"), [({}, "auto"), ({"workerinput": {}}, None)])
def test_the_processes_of_a_run_start_no_others(worker, processes, pytestconfig):
    """A run of everything takes all cores; each of its processes, which runs everything as well, takes none more."""
    option = SimpleNamespace(numprocesses=None, usepdb=False)
    config = SimpleNamespace(args_source=pytest.Config.ArgsSource.TESTPATHS, option=option, **worker)
    pytestconfig.pluginmanager.getplugin(str(TESTS / "conftest.py")).pytest_cmdline_main(config)
    assert option.numprocesses == processes
