"""Standard streams that are missing, whose reader leaves or whose disk is full keep nobody from the report."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys

import pytest
import regenerate

pytestmark = pytest.mark.skipif(os.name == "nt", reason="the shell of POSIX systems closes handles")

CLOSED = {"stdout": ">&-", "stderr": "2>&-", "both": ">&- 2>&-", "all three": "<&- >&- 2>&-"}


def _shell(arguments, ending="", **environment):
    """Run the command with what a shell can do to its streams; `PIPESTATUS` of its own is its exit code."""
    command = " ".join(shlex.quote(str(one)) for one in [sys.executable, "-m", "flexlash", *arguments])
    return subprocess.run(
        ["bash", "-c", f"{command} {ending}; exit ${{PIPESTATUS[0]}}"],
        capture_output=True,
        text=True,
        encoding="utf-8",
        errors="replace",
        check=False,
        env={**os.environ, "PYTHONPATH": str(regenerate.ROOT / "src"), **environment},
    )


@pytest.mark.parametrize("closed", CLOSED)
def test_a_run_without_streams_writes_its_report(table, sound, tmp_path, closed):
    """Without standard streams the report is written whole and the exit code is what it would be."""
    path = table([sound, {**sound, "variant": "b", "torque_Nm": ""}])
    done = _shell(["run", path, "--samples", 64], CLOSED[closed])
    assert done.returncode == 3
    assert "Traceback" not in done.stdout + done.stderr
    report = (tmp_path / "submission-report.xlsx").read_bytes()
    assert report.startswith(b"PK")
    assert b"rows computed" not in report
    assert (tmp_path / "submission-checked.xlsx").read_bytes().startswith(b"PK")


@pytest.mark.parametrize("closed", CLOSED)
@pytest.mark.parametrize("arguments", [["schema"], ["explain"], ["fly"], ["check", "none.csv"]], ids=" ".join)
def test_other_commands_without_streams_end_as_ever(arguments, closed):
    """Every command ends with its own exit code, whichever stream is closed."""
    done = _shell(arguments, CLOSED[closed])
    assert done.returncode == {"fly": 2, "check": 5}.get(arguments[0], 0)
    assert "Traceback" not in done.stdout + done.stderr


@pytest.mark.parametrize(
    "arguments", [["schema", "--json"], ["schema"], ["explain"], ["--help"], ["run", "--help"]], ids=" ".join
)
def test_a_reader_that_leaves_is_no_error(arguments):
    """Piping into a program that stops reading, or never reads, is exit code 0 without a complaint."""
    for reader in ("head -c 1", "true"):
        done = _shell(arguments, f"| {reader}")
        assert (done.returncode, done.stderr) == (0, "")


def test_a_reader_that_leaves_changes_no_exit_code(table, sound):
    """Findings that nobody reads are findings all the same; so are those on standard error."""
    path = table([{**sound, "variant": f"v{place}", "torque_Nm": ""} for place in range(50)] + [sound])
    assert _shell(["check", path], "| true").returncode == 3
    assert _shell(["run", path, "--samples", 64], "2>&1 >/dev/null | true").returncode == 3


def test_a_reader_that_leaves_does_not_keep_the_others_from_being_computed(table, sound, tmp_path):
    """Where nobody reads what is said of the first submission, the second is computed as well."""
    paths = [table([sound], name) for name in ("a.csv", "b.csv")]
    done = _shell(["run", *paths, "--samples", 64], "| true")
    assert done.returncode == 0
    assert {path.name for path in tmp_path.glob("*.xlsx")} == {"a-report.xlsx", "b-report.xlsx"}


@pytest.mark.parametrize("buffering", ["", "1"])
@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a device that is always full")  # noqa: PTH110
def test_a_full_disk_behind_standard_output_is_told(table, sound, tmp_path, buffering):
    """What cannot be printed ends with 5 and says so, and the report is there."""
    path = table([sound])
    done = _shell(["run", path, "--samples", 64], ">/dev/full", PYTHONUNBUFFERED=buffering)
    assert done.returncode == 5
    assert done.stderr == "Standard output could not be written: No space left on device.\n"
    assert (tmp_path / "submission-report.xlsx").exists()
    assert _shell(["schema"], ">/dev/full", PYTHONUNBUFFERED=buffering).returncode == 5


def test_a_text_that_the_screen_lacks_is_escaped():
    """A stream in an old encoding gets every line, with escapes for what it cannot show."""
    done = _shell(["schema"], PYTHONIOENCODING="latin-1")
    assert done.returncode == 0
    assert "Wall thickness \\u0394 [mm]" in done.stdout


def test_json_is_plain_where_the_stream_is_not_utf_8(table, sound):
    """JSON stays JSON in a stream of another encoding."""
    import json

    path = table([{**sound, "torque_Nm": "x"}])
    done = _shell(["check", path, "--json"], PYTHONIOENCODING="cp1252")
    assert done.stdout.isascii()
    assert "N·m" in json.loads(done.stdout)["findings"][0]["message"]
