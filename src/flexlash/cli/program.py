"""The program that needs no Python: started without a command, as by a double click, it opens the page."""

from __future__ import annotations

import sys

import click

__all__ = ["command_given", "keep_window_open"]

_PAGE = ["serve", "--open", "--port", "0"]
"""Any port that is free: whoever clicks can choose no other."""


def command_given() -> list[str] | None:
    """Return what opens the page where no command was given; None leaves it to click, which knows each system."""
    return _PAGE if _is_clicked() else None


def keep_window_open() -> None:
    """Wait for a key where a window was opened for the program, which would close on what went wrong."""
    if _is_clicked():
        click.pause("Any key closes this window.", err=True)


def _is_clicked() -> bool:
    """Whether the program was started by itself, with nothing said; Python is never started so."""
    return bool(getattr(sys, "frozen", False)) and len(sys.argv) == 1
