"""The program that needs no Python, as `.ci/build-program` makes it, beside the command that Python runs.

`FLEXLASH_PROGRAM` names the program; it must have been built of these sources with the libraries that are installed
here, since its reports are compared byte for byte.
"""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

import pytest
import regenerate
import xlsxwriter
from batch_runs import none_left
from page_requests import got, handed_in, handed_over, shown_at_last
from service_process import children_of

PROGRAM = os.environ.get("FLEXLASH_PROGRAM", "")

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(not PROGRAM, reason="FLEXLASH_PROGRAM names no program; .ci/build-program makes one"),
    pytest.mark.skipif(sys.platform == "win32", reason="signals and limits are those of POSIX"),
]


def _environment(folder, **more):
    """Return the environment of a user without Python: a home of their own, no folder where Python could be found."""
    own = {"HOME": str(folder), "XDG_DATA_HOME": str(folder / "data"), "PATH": ""}
    return {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")} | own | more


def _by_program(folder, *arguments):
    """Return what the program answers."""
    return _answered(folder, [PROGRAM, *arguments], _environment(folder))


def _by_python(folder, *arguments):
    """Return what the command answers."""
    return _answered(folder, [sys.executable, "-m", "flexlash", *arguments], None)


def _answered(folder, command, environment):
    return subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, check=False, encoding="utf-8", timeout=300
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return a folder with the study in it, as the program writes it."""
    path = tmp_path_factory.mktemp("program")
    assert _by_program(path, "template", "--example", "-o", "study.xlsx").returncode == 0
    return path


@pytest.fixture(scope="module")
def large(folder):
    """Return a workbook that takes more than a second and more than 16 MiB to read."""
    path = folder / "large.xlsx"
    with xlsxwriter.Workbook(path) as book:
        sheet = book.add_worksheet("Variants")
        for row in range(15_000):
            sheet.write_row(row, 0, range(40))
    return path


def test_it_is_the_same_program(folder):
    """It is of the version that is tested, and its help is that of the command."""
    for arguments in (["--version"], ["--help"], ["run", "--help"]):
        by_python = _by_python(folder, *arguments).stdout
        assert _by_program(folder, *arguments).stdout == by_python.replace("python -m flexlash", "flexlash"), arguments


def test_the_study_has_the_report_of_the_command(folder):
    """Template, report and Results of the study are those that Python gives, byte for byte, and so is what is said."""
    assert _by_python(folder, "template", "--example", "-o", "study-by-python.xlsx").returncode == 0
    assert (folder / "study.xlsx").read_bytes() == (folder / "study-by-python.xlsx").read_bytes()
    for ending, options in (("xlsx", ()), ("csv", ("--jobs", "2")), ("json", ("--elasticity", "--cross-check"))):
        said = []
        for run in (_by_program, _by_python):
            done = run(folder, "run", "study.xlsx", "--no-annotate", "-o", f"{run.__name__}.{ending}", *options)
            assert done.returncode == 0, done.stderr
            said.append((done.stdout + done.stderr).replace(f"{run.__name__}.{ending}", "report"))
        assert said[0] == said[1]
        by_program, by_python = (folder / f"{run.__name__}.{ending}" for run in (_by_program, _by_python))
        assert by_program.read_bytes() == by_python.read_bytes()


def test_a_faulty_file_has_the_findings_of_the_command(folder):
    """Every finding of the faulty example is told in the same words, and the marked copies are equal."""
    path = str(regenerate.ROOT / "data" / "needs-fixing.xlsx")
    told = []
    for run in (_by_program, _by_python):
        done = run(folder, "check", path, "--annotate", "-o", f"{run.__name__}.xlsx")
        assert done.returncode == 3
        told.append((done.stdout + done.stderr).replace(run.__name__, "copy"))
    assert told[0] == told[1]
    assert {code for code, _, _ in regenerate.FAULTS} <= set(re.findall(r"[EW]\d{3}", told[0]))
    assert (folder / "_by_program.xlsx").read_bytes() == (folder / "_by_python.xlsx").read_bytes()


@pytest.mark.parametrize("setting", ["memory_mebibytes=16", "processor_seconds=1", "seconds=1"])
def test_a_hostile_workbook_is_refused_under_limits(folder, large, setting):
    """What asks for more memory or time than is allowed is refused by the limit's name, by a process of its own."""
    done = _by_program(folder, "check", "--limit", setting, large.name)
    assert done.returncode == 4, done.stderr
    assert "E110" in done.stdout + done.stderr
    assert f"(setting {setting.partition('=')[0]})" in done.stdout + done.stderr


def _begun(folder, *arguments, **more):
    """Return the program that runs, in a session of its own."""
    return subprocess.Popen(
        [PROGRAM, *arguments], cwd=folder, env=_environment(folder, **more), stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, text=True, start_new_session=True,
    )  # fmt: skip


def _interrupted(process):
    """Have Ctrl-C reach a program and all that it has started, as a terminal does; it ends well, and nothing stays."""
    os.killpg(process.pid, signal.SIGINT)
    said, _ = process.communicate(timeout=60)
    assert process.returncode == 0, said
    assert "Traceback" not in said
    assert none_left(process.pid)


def test_a_click_opens_a_page_that_computes(folder):
    """Started with nothing, it opens a browser, with the system's libraries, on a page that computes, until Ctrl-C."""
    browser = folder / "browser"
    browser.write_text('#!/bin/sh\necho "$1 <$LD_LIBRARY_PATH>" >opened.tmp && /bin/mv opened.tmp opened\n')
    browser.chmod(0o755)
    process = _begun(folder, BROWSER=f"{browser} %s", LD_LIBRARY_PATH="/libraries/of/the/user")
    try:
        place, libraries = _read_at_last(folder / "opened").split()
        assert libraries == "</libraries/of/the/user>"
        page = Path(place.removeprefix("file://")).read_text(encoding="utf-8")
        opener = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
        address = re.search(r"url=([^\"]+)", page)[1]
        assert "flexlash" in got(address, opener)
        address = address.partition("/open/")[0]
        page = handed_in(address, "study.xlsx", (folder / "study.xlsx").read_bytes(), opener)
        shown_at_last(page, "/files/report", opener)
        assert _by_python(folder, "run", "study.xlsx", "--no-annotate", "-o", "beside-page.xlsx").returncode == 0
        report = handed_over(f"{page}/files/report", opener)
        assert report == (folder / "beside-page.xlsx").read_bytes()
    finally:
        _interrupted(process)


def _read_at_last(path, seconds=60):
    end = time.monotonic() + seconds
    while not path.exists():
        assert time.monotonic() < end, path
        time.sleep(0.1)
    return path.read_text(encoding="utf-8")


def test_ctrl_c_ends_a_run(folder):
    """A run of many rows that is interrupted says so, ends with its own exit code and leaves no process."""
    headers = "variant,material,torque_Nm,cylinder_length_mm,mean_radius_mm,wall_thickness_mm,disk_inner_radius_mm\n"
    rows = (f"V{number},20Cr2Ni4,800,160,{80 + number / 1e4},1.6,40\n" for number in range(15_000))
    (folder / "many.csv").write_text(headers + "".join(rows), encoding="utf-8")
    process = _begun(folder, "run", "many.csv", "-o", "many.parquet", "--jobs", "2")
    end = time.monotonic() + 60
    while not children_of(process.pid):
        assert time.monotonic() < end
        time.sleep(0.1)
    os.killpg(process.pid, signal.SIGINT)
    said, _ = process.communicate(timeout=60)
    assert (process.returncode, said.strip()) == (130, "Interrupted.")
    assert none_left(process.pid)
    assert not (folder / "many.parquet").exists()
