"""`--samples-out` and `--pictures` of `flexlash run` as their user meets them."""

from __future__ import annotations

import json

import pytest
from click.testing import CliRunner

from flexlash import check, run
from flexlash.cli import cli

pytestmark = pytest.mark.slow


def _run(*arguments):
    return CliRunner().invoke(cli, ["run", *map(str, arguments)])


def _wanted(folder):
    return ["--samples-out", folder / "samples", "--pictures", folder / "pictures"]


def _content(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def _exports(folder):
    return {name: data for name, data in _content(folder).items() if name.startswith(("samples/", "pictures/"))}


def test_command_python_and_report_write_the_same(table, sound, tmp_path):
    """The command, run() and --from-report write the same files, named after the submission; --json lists them."""
    path = table([sound], "gear.csv")
    done = _run(path, *_wanted(tmp_path), "--json")
    assert done.exit_code == 0, done.output
    first = _exports(tmp_path)
    assert "samples/gear-samples.parquet" in first
    assert "pictures/gear-comparison.svg" in first
    assert {f"{tmp_path}/{name}" for name in first} < set(json.loads(done.stdout)["outputs"])
    outcome = run(path, samples_out=tmp_path / "py" / "samples", pictures=tmp_path / "py" / "pictures")
    assert {one.relative_to(tmp_path / "py").as_posix() for one in outcome.outputs} == {*first}
    assert _exports(tmp_path / "py") == first
    again = tmp_path / "again"
    done = _run(tmp_path / "gear-report.xlsx", "--from-report", "-o", again, *_wanted(again))
    assert done.exit_code == 0, done.output
    assert _exports(again) == first
    assert f"{len(first) - 1} pictures in" in done.stdout


def test_a_folder_by_one_worker_or_two_and_taken_up_again(table, sound, tmp_path):
    """Submissions of one name are numbered, whatever the workers; --resume makes anew only what is no longer there."""
    given = tmp_path / "in"
    given.mkdir()
    for name in ("gear.csv", "gear.tsv", "other.csv"):
        table([sound], name).rename(given / name)
    wanted = [given, "-o", tmp_path / "out", *_wanted(tmp_path)]
    assert _run(*wanted, "--jobs", 2).exit_code == 0
    first = _exports(tmp_path)
    samples = {name for name in first if name.startswith("samples/")}
    assert samples == {f"samples/{name}-samples.parquet" for name in ("gear", "gear (2)", "other")}
    assert "3 submissions done by an earlier run" in _run(*wanted, "--resume").stderr
    (tmp_path / "pictures" / "other-comparison.svg").unlink()
    assert "2 submissions done by an earlier run" in _run(*wanted, "--resume", "--jobs", 1).stderr
    assert _exports(tmp_path) == first


def test_a_file_of_the_user_is_never_overwritten(table, sound, tmp_path):
    """What has the name of a picture or of samples stays; its own files are replaced."""
    path = table([sound], "gear.csv")
    mine = [tmp_path / "pictures" / "gear-comparison.svg", tmp_path / "samples" / "gear-samples.parquet"]
    for file in mine:
        file.parent.mkdir()
        file.write_bytes(b"mine")
    for _ in range(2):
        done = _run(path, *_wanted(tmp_path))
        assert done.exit_code == 0, done.output
        assert "was left alone" in done.stderr
    assert [file.read_bytes() for file in mine] == [b"mine", b"mine"]
    assert not [name for name in _exports(tmp_path) if "(3)" in name]
    assert {"samples/gear-samples (2).parquet", "pictures/gear-comparison (2).svg"} <= {*_exports(tmp_path)}


def test_what_cannot_be_meant_or_made_is_told(table, sound, tmp_path):
    """A file as the folder is a usage error; where no row is computed nothing is written; check() writes none."""
    path = table([sound], "gear.csv")
    assert _run(path, "--pictures", path).exit_code == 2
    with pytest.raises(ValueError, match="run\\(\\) does"):
        check(path, pictures=tmp_path)
    wrong = table([sound | {"torque_Nm": -1}], "wrong.csv")
    assert _run(wrong, *_wanted(tmp_path)).exit_code == 4
    assert not _exports(tmp_path)
