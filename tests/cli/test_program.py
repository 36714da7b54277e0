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


def test_what_is_dropped_on_the_program_is_computed(frozen, monkeypatch, table, sound):
    """Files dropped on its icon come as whole paths: each is computed, and the window waits until it was read."""
    path = table([sound], "dropped file.csv")
    frozen(str(path))
    assert program.command_given() == ["run", str(path)]
    frozen(str(path), "other.csv")
    assert program.command_given() is None
    waited = []
    monkeypatch.setattr("click.pause", lambda *words, **_: waited.append(words))
    frozen(str(path))
    with pytest.raises(SystemExit, match="0"):
        main()
    assert path.with_name("dropped file-report.xlsx").exists()
    assert len(waited) == 1


def test_a_file_in_the_place_of_a_command_is_told_how(monkeypatch, capsys, table, sound):
    """`flexlash variants.csv` is a slip; the answer is the command to type."""
    path = table([sound])
    monkeypatch.setattr(sys, "argv", ["flexlash", str(path)])
    with pytest.raises(SystemExit, match="2"):
        main()
    assert f"is a file, not a command. To compute it: flexlash run {path}" in capsys.readouterr().err


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
