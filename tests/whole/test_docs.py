"""What the documents say is what happens: their code blocks are executed, their links lead somewhere."""

from __future__ import annotations

import re
import shlex
import shutil
import sys

import polars as pl
import pytest
import regenerate
from filled import SOUND

from flexlash import __version__
from flexlash.cli import main
from flexlash.feedback.template.template_workbook import study

ROOT = regenerate.ROOT
README = (ROOT / "README.md").read_text(encoding="utf-8")
EXECUTED = ("template", "commands", "checking", "report", "model", "tolerances", "decisions", "python")
"""Pages of docs/ whose commands are executed, after those of the README and in this order."""

PAGES = {name: (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8") for name in EXECUTED}
DOCUMENTS = [*ROOT.glob("*.md"), *(ROOT / "data").glob("*.md"), *(ROOT / "docs").glob("*.md")]


def _blocks(language, text=README):
    return re.findall(rf"```{language}\n(.*?)```", text, flags=re.DOTALL)


@pytest.fixture
def copy(tmp_path, monkeypatch):
    """Work in a folder that holds the examples as a clone does."""
    (tmp_path / "data").mkdir()
    for path in (ROOT / "data").glob("*.xlsx"):
        shutil.copy(path, tmp_path / "data")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.slow
def test_shell_blocks_run(copy, monkeypatch, capsys):
    """Every flexlash command of the README and the pages ends with 0, or with 3 where the example is faulty.

    `serve`, which does not end, is in tests/service/test_service_commands.py.
    """
    blocks = [block for text in (README, *PAGES.values()) for block in _blocks("sh", text)]
    commands = [line for block in blocks for line in block.replace(" && ", "\n").splitlines()]
    every = [line for line in dict.fromkeys(commands) if line.startswith("flexlash ")]
    ours = [line for line in every if not line.startswith("flexlash serve")]
    assert len(ours) >= 7
    assert {line.split()[0] for line in commands} <= {"flexlash", "pip", "pytest"}
    (copy / "submissions" / "below").mkdir(parents=True)
    shutil.copy(copy / "data" / "b3-160-study.xlsx", copy / "submissions" / "below")
    pl.DataFrame([SOUND]).write_parquet(copy / "variants.parquet")
    for line in ours:
        monkeypatch.setattr(sys, "argv", shlex.split(line))
        try:
            main()
        except SystemExit as stop:
            assert (stop.code or 0) == (3 if "needs-fixing" in line else 0), line  # noqa: PT017
    assert (copy / "data" / "b3-160-study-report.xlsx").exists()
    assert (copy / "results.csv").exists()
    assert {path.name for path in (copy / "marked").iterdir()} == {
        ".flexlash-manifest.jsonl",
        "flexlash-summary.jsonl",
        "flexlash-summary.xlsx",
        "needs-fixing-checked.xlsx",
        "needs-fixing-report.xlsx",
    }
    assert (copy / "fixed.xlsx").exists()
    assert "Traceback" not in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize("block", [*_blocks("python"), *_blocks("python", PAGES["python"])])
def test_python_blocks_run(copy, block, capsys):  # noqa: ARG001
    """Every Python block of the README and of docs/python.md runs as printed."""
    exec(compile(block, "document", "exec"), {})  # noqa: S102
    assert capsys.readouterr().out


def test_the_quickstart_is_two_commands():
    """The README names the two commands that do all the set-up."""
    assert "pip install . && flexlash run data/b3-160-study.xlsx" in README
    assert "pip install '.[test]' && pytest" in README


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
def test_links_lead_to_files(path):
    """Every relative link and picture of a document exists."""
    for target in re.findall(r"\]\(([^)#]+)\)", path.read_text(encoding="utf-8")):
        if not target.startswith("http"):
            assert (path.parent / target).exists(), target


def test_the_documents_count_right():
    """The figures that the documents state in words are those of the program."""
    from flexlash.tolerance.engine.line_points import LINE_REPLICATES
    from flexlash.tolerance.engine.line_precision import SD_PRECISION

    words = " ".join(" ".join(PAGES.values()).split())
    assert len(README.splitlines()) <= 120
    assert LINE_REPLICATES == 8
    assert "Eight independent scrambled Sobol' nets of lines" in words
    assert SD_PRECISION == 1e-3
    assert "known to a thousandth of the standard deviation" in words
    assert "39 variants" in (ROOT / "data" / "README.md").read_text(encoding="utf-8")
    assert len(regenerate.catalogue_sizes().variants) == 39
    assert len(regenerate.FAULTS) == 24
    assert "twenty-four rows with a different fault" in (ROOT / "data" / "README.md").read_text(encoding="utf-8")
    assert len(study().variants) == 11


def test_one_version_everywhere():
    """pyproject, package and changelog agree on the version."""
    pyproject = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    assert f'version = "{__version__}"' in pyproject
    assert "## [Unreleased]" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
