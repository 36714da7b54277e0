"""The program that needs no Python, as its command line sees it; `tests/whole/test_program.py` starts a real one."""

import sys

import pytest

from flexlash.cli import main, program


@pytest.fixture
def frozen(monkeypatch):
    """Make this Python look like the program, with what it was started with."""

    def make(*arguments):
        monkeypatch.setattr(sys, "frozen", True, raising=False)
        monkeypatch.setattr(sys, "argv", ["flexlash", *arguments])

    return make


def test_only_the_program_without_a_command_opens_the_page(frozen, monkeypatch):
    """Python without a command gives the help, the program with one does what it says, without one the page."""
    monkeypatch.setattr(sys, "argv", ["flexlash"])
    assert program.command_given() is None
    frozen("--version")
    assert program.command_given() is None
    frozen()
    assert program.command_given() == ["serve", "--open", "--port", "0"]


@pytest.mark.parametrize("clicked", [True, False])
def test_a_window_of_its_own_stays_open_on_a_failure(frozen, monkeypatch, clicked):
    """What went wrong can be read where the window would close with the program, and nobody waits for a key elsewhere.

    What goes wrong is that there is no command of this name.
    """
    waited = []
    monkeypatch.setattr("click.pause", lambda *words, **_: waited.append(words))
    frozen(*([] if clicked else ["no-command"]))
    monkeypatch.setattr("flexlash.cli.program._PAGE", ["no-command"])
    with pytest.raises(SystemExit, match="2"):
        main()
    assert bool(waited) == clicked
