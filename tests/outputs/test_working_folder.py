"""A working folder keeps what was done whole, gives it back where it is proven, and is gone in the end."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest

from flexlash.outputs.working_folder import working_folder

WHAT = {"source": "4f", "options": ["a", 1]}
PIECES = [{"results": b"one", "head": b"1"}, {"results": b"two", "head": b"2"}]


class Killed(BaseException):
    """Something that ends a run in the middle."""


def _interrupted(output, what=WHAT, *, resume=False, names=("2-51", "52-101")):
    """Keep some pieces of work, then end in the middle; return what was done before."""
    with suppress(Killed), working_folder(output, what, resume=resume) as folder:
        before = list(folder.done)
        for name in names:
            folder.keep(name, PIECES)
        raise Killed
    return before


def _read(parts):
    return [{what: path.read_bytes() for what, path in piece.items()} for piece in parts]


def test_what_was_done_is_taken_up(tmp_path):
    """After an interruption a run that resumes has all parts of the pieces that were finished; another has none."""
    output = tmp_path / "out.csv"
    _interrupted(output)
    with suppress(Killed), working_folder(output, WHAT, resume=True) as folder:
        assert list(folder.done) == ["2-51", "52-101"]
        assert _read(folder.done["52-101"]) == PIECES
        raise Killed
    with working_folder(output, WHAT, resume=False) as folder:
        assert folder.done == {}
        assert [path.name for path in folder.folder.iterdir()] == ["manifest.jsonl"]


def test_nothing_is_left_in_the_end(tmp_path):
    """A run that comes to its end leaves no folder."""
    with working_folder(tmp_path / "out.csv", WHAT, resume=False) as folder:
        folder.keep("2-51", PIECES)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("other", [{**WHAT, "source": "50"}, {**WHAT, "options": ["a", 2]}, {}])
def test_parts_of_something_else_are_not_taken_up(tmp_path, other):
    """Another source, other options or another program: nothing is taken up."""
    _interrupted(tmp_path / "out.csv", other)
    assert _interrupted(tmp_path / "out.csv", resume=True) == []


def test_what_is_not_proven_is_not_taken_up(tmp_path):
    """A part that is missing or altered, and a line of the manifest that is not whole, make their work undone."""
    output = tmp_path / "out.csv"
    _interrupted(output, names=("1-1", "2-2", "3-3", "4-4"))
    folder = tmp_path / ".out.csv.flexlash-parts"
    (folder / "1-1-0-results.part").unlink()
    (folder / "2-2-1-head.part").write_bytes(b"3")
    manifest = folder / "manifest.jsonl"
    manifest.write_bytes(manifest.read_bytes()[:-9])
    assert _interrupted(output, resume=True, names=["5-5"]) == ["3-3"]
    assert _interrupted(output, resume=True) == ["3-3", "5-5"]


def test_a_manifest_that_names_other_files_proves_nothing(tmp_path):
    """A manifest that somebody has written cannot make a run read files outside the folder."""
    output = tmp_path / "out.csv"
    (tmp_path / "secret-0-results.part").write_bytes(b"one")
    _interrupted(output, names=["1-1"])
    manifest = tmp_path / ".out.csv.flexlash-parts" / "manifest.jsonl"
    for name in (b"../secret", b"/etc/x", b'1-1", "more": "'):
        manifest.write_bytes(manifest.read_bytes().replace(b'"1-1"', b'"' + name + b'"'))
        assert _interrupted(output, resume=True, names=["1-1"]) in ([], ["1-1"])
        _interrupted(output, names=["1-1"])


def test_a_folder_of_somebody_else_is_left_alone(tmp_path):
    """A folder, a link or a file of this name that is not ours stays as it is; the run takes another."""
    output = tmp_path / "out.csv"
    foreign = tmp_path / ".out.csv.flexlash-parts"
    foreign.mkdir()
    (foreign / "mine.txt").write_text("mine")
    (tmp_path / ".out.csv.flexlash-parts-2").symlink_to(tmp_path)
    (tmp_path / ".out.csv.flexlash-parts-3").write_text("mine")
    with working_folder(output, WHAT, resume=False) as folder:
        assert folder.folder.name == ".out.csv.flexlash-parts-4"
    assert (foreign / "mine.txt").read_text() == "mine"
    assert len(list(tmp_path.iterdir())) == 3


_SOURCE = {**os.environ, "PYTHONPATH": str(Path(__file__).resolve().parents[2] / "src")}
_HOLDER = (
    "import sys, time; from pathlib import Path; from flexlash.outputs.working_folder import working_folder\n"
    "with working_folder(Path(sys.argv[1]), {'source': '4f', 'options': ['a', 1]}, resume=True) as folder:\n"
    "    folder.keep('2-51', [{'results': b'one'}]); print('here', flush=True); time.sleep(600)\n"
)


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX locks")
def test_two_runs_do_no_harm_to_each_other(tmp_path):
    """A folder that a living run holds is left to it; when that one was killed, the next takes up what it did."""
    output = tmp_path / "out.csv"
    with subprocess.Popen(
        [sys.executable, "-c", _HOLDER, output], stdout=subprocess.PIPE, text=True, env=_SOURCE
    ) as process:
        assert process.stdout.readline() == "here\n"
        with working_folder(output, WHAT, resume=True) as folder:
            assert (folder.folder.name, folder.done) == (".out.csv.flexlash-parts-2", {})
        process.kill()
    time.sleep(0.1)
    assert _interrupted(output, resume=True, names=()) == ["2-51"]


def test_a_long_name_has_a_folder_of_its_own(tmp_path):
    """An output with the longest name that a system allows has a folder, which a run that resumes finds again."""
    one, other = (tmp_path / f"{'é' * 120}{number}.parquet" for number in (1, 2))
    assert _interrupted(one) == []
    assert _interrupted(other, resume=True) == []
    assert _interrupted(one, resume=True) == ["2-51", "52-101"]


def test_where_no_folder_can_be_made_the_output_is_named(tmp_path):
    """A fault names the output, which the user has asked for, and no hidden folder."""
    output = tmp_path / "none" / "out.csv"
    with pytest.raises(FileNotFoundError) as fault, working_folder(output, WHAT, resume=False):
        pass
    assert fault.value.filename == str(output)
