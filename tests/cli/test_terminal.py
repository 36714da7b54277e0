"""What a terminal shows: a progress bar where it can be drawn, colours where they are wanted."""

from __future__ import annotations

import os
import re
import subprocess
import sys

import pytest
import regenerate

pty = pytest.importorskip("pty", reason="needs a terminal of POSIX systems")

BAR = b"Computing"
RED = b"\x1b[31m"


def _on_a_terminal(*arguments, **environment):
    """Run the command on a terminal of its own; return what it shows there and the exit code."""
    outside, inside = pty.openpty()
    terms = {"PYTHONPATH": str(regenerate.ROOT / "src"), **environment}
    surroundings = {key: value for key, value in os.environ.items() if key not in {"TERM", "NO_COLOR"}} | terms
    command = [sys.executable, "-m", "flexlash", *map(str, arguments)]
    with subprocess.Popen(command, stdin=inside, stdout=inside, stderr=inside, env=surroundings) as process:
        os.close(inside)
        shown = b""
        while piece := _read(outside):
            shown += piece
    os.close(outside)
    return shown, process.returncode


def _read(handle):
    try:
        return os.read(handle, 2**16)
    except OSError:
        # Linux says so where the last program has let go of a terminal.
        return b""


TERMINALS = {"one that draws": {"TERM": "xterm"}, "dumb": {"TERM": "dumb"}, "unknown": {}}


@pytest.mark.parametrize("kind", TERMINALS)
def test_the_bar_is_drawn_where_that_can_be(table, sound, kind):
    """A terminal that can draw gets a progress bar; a dumb or unknown one plain lines without control sequences."""
    shown, code = _on_a_terminal("run", table([sound]), "--samples", 64, **TERMINALS[kind])
    assert code == 0
    assert b"1 of 1 rows computed." in shown
    assert (BAR in shown) is (kind == "one that draws")
    assert (b"\x1b" in shown) is (kind == "one that draws")


@pytest.mark.parametrize(
    ("environment", "coloured"),
    [
        ({"TERM": "xterm"}, True),
        ({"TERM": "xterm", "NO_COLOR": "1"}, False),
        ({"TERM": "xterm", "NO_COLOR": ""}, True),
        ({"TERM": "dumb"}, False),
    ],
)
def test_colours_are_shown_where_they_are_wanted(table, sound, tmp_path, environment, coloured):
    """Findings and what could not be opened are red on a terminal, unless NO_COLOR is set to anything or it is dumb."""
    shown, code = _on_a_terminal("check", table([{**sound, "torque_Nm": ""}]), tmp_path / "none.csv", **environment)
    assert code == 5
    assert (RED in shown) is coloured
    assert (RED in _on_a_terminal("template", "--upgrade", tmp_path / "none.csv", **environment)[0]) is coloured


def test_json_and_quiet_draw_nothing(table, sound):
    """--json and --quiet keep a terminal free of the bar."""
    for option in ("--json", "--quiet"):
        assert BAR not in _on_a_terminal("run", table([sound]), option, "--samples", 64, TERM="xterm")[0]


@pytest.mark.parametrize("environment", [{}, {"NO_COLOR": "1"}])
def test_the_bar_says_files_rows_and_time_left_and_leaves_the_lines_alone(table, sound, environment):
    """It tells files, rows, rows a second and time left, is taken away before a line is printed, and at the end.

    Without colours as well.
    """
    paths = [table([{**sound, "variant": f"v{row}"} for row in range(3)], f"{name}.csv") for name in "ab"]
    shown, code = _on_a_terminal("run", *paths, "--samples", 64, TERM="xterm", COLUMNS="200", **environment)
    assert code == 0
    drawn = shown.decode().split("\r\x1b[2K")
    assert drawn[1].startswith("Computing [------------------------] 0 of 2 files")
    assert re.search(r"\[#{12}-{12}\] 1 of 2 files, 3 rows, \d+ rows/s, \d+:\d\d left", shown.decode())
    lines = [line for piece in drawn for line in piece.splitlines() if line and not line.startswith("Computing")]
    assert [line.split(": ")[0] for line in lines[:2]] == [str(path) for path in paths]
    assert lines[2].startswith("Total of 2 submissions")
