"""The program that needs no Python: a double click opens its page, files dropped on it are computed."""

from __future__ import annotations

import sys
from pathlib import Path

import click

__all__ = ["command_given", "keep_window_open"]

_PAGE = ["serve", "--open", "--port", "0"]
"""Any port that is free: whoever clicks can choose no other."""


def command_given() -> list[str] | None:
    """Return what opens the page, or computes what was dropped; None leaves it to click, which knows each system."""
    if dropped := _dropped():
        return ["run", *dropped]
    return _PAGE if _is_clicked() else None


def keep_window_open(*, failed: bool) -> None:
    """Wait for a key where a window was opened for the program, which would close on what it says."""
    if (failed and _is_clicked()) or _dropped():
        click.pause("Any key closes this window.", err=True)


def _is_clicked() -> bool:
    """Whether the program was started by itself, with nothing said; Python is never started so."""
    return bool(getattr(sys, "frozen", False)) and len(sys.argv) == 1


def _dropped() -> list[str]:
    """Return the files and folders that were dropped on the program's icon: whole paths, and nothing else."""
    given = sys.argv[1:] if getattr(sys, "frozen", False) else []
    return given if all(Path(one).is_absolute() and Path(one).exists() for one in given) else []
