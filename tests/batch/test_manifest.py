"""What a stopped run wrote down is believed as far as the files prove it, and no further."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from flexlash.analysis.options import Options
from flexlash.analysis.outcome import Written
from flexlash.batch.answer import WorstVariant
from flexlash.batch.ended import Ended
from flexlash.batch.manifest import MANIFEST_NAME, Manifest, options_digest
from flexlash.outputs.plan import Plan
from flexlash.reading.read import Source
from flexlash.schema.exit_codes import ExitCode

SHA = "5" * 64


@pytest.fixture
def outputs(tmp_path):
    """Return the planned report and marked copy of a submission."""
    plan = Plan(inputs=[])
    return plan.claim(tmp_path / "a-report.xlsx"), plan.claim(tmp_path / "a-checked.xlsx")


def _ended(outputs, **changed):
    """Return how a submission ended whose files lie there."""
    paths = tuple(output.path for output in outputs)
    for path in paths:
        path.write_bytes(path.name.encode())
    facts = {
        "path": Path("in/a.xlsx"),
        "code": ExitCode.SOME_ROWS,
        "told": {"submission": "a.xlsx", "counts": {"rows": 3}, "findings": [{"code": "E201", "value": "0,1 “x”"}]},
        "finding_lines": (("error", "error E201"), ("", "    Variants!D7")),
        "words": "2 of 3 rows computed",
        "details": ("Of 2 variants with a limit 1 fails",),
        "by_rule": {"E201": 1},
        "worst": (WorstVariant(variant="v", p99_865_arcmin=0.1 + 0.2, backlash_limit_arcmin=None,
                               probability_over_limit=None),),
        "written": Written(paths=paths, marked_copy=paths[1], not_carried=("its charts",), remarks=("left alone",)),
    }  # fmt: skip
    return Ended(**facts | changed)


def _resumed(folder, outputs, sha=SHA, options="o", below=Path()):
    manifest = Manifest(folder, options, resume=True)
    try:
        return manifest.done(Path("in/a.xlsx"), below, sha, *outputs)
    finally:
        manifest.close()


def _kept(folder, outputs, options="o", **changed):
    ended = _ended(outputs, **changed)
    manifest = Manifest(folder, options, resume=False)
    manifest.keep(ended, SHA, *outputs)
    manifest.close()
    assert manifest.fault is None
    return ended


def test_what_was_done_is_told_as_it_was(tmp_path, outputs):
    """A line gives back all that is printed and summed up, with every digit, and says that it was done before."""
    ended = _kept(tmp_path, outputs)
    found = _resumed(tmp_path, outputs)
    assert found.done_before
    assert found.as_dictionary() == ended.as_dictionary()
    for name in ("code", "finding_lines", "words", "details", "by_rule", "worst", "written"):
        assert getattr(found, name) == getattr(ended, name), name


@pytest.mark.parametrize("change", ["content", "options", "report", "copy", "gone", "place", "name"])
def test_nothing_is_believed_that_is_not_proven(tmp_path, outputs, change):
    """Other content, options or names, a file that was changed, is gone or would go elsewhere: it is done again."""
    _kept(tmp_path, outputs)
    wanted, asked = outputs, {}
    if change == "content":
        asked["sha"] = "6" * 64
    elif change == "options":
        asked["options"] = "p"
    elif change == "name":
        asked["below"] = Path("sub")
    elif change == "place":
        wanted = (Plan(inputs=[]).claim(tmp_path / "b-report.xlsx"), outputs[1])
    elif change == "gone":
        outputs[0].path.unlink()
    else:
        outputs[change == "copy"].path.write_bytes(b"changed")
    assert _resumed(tmp_path, wanted, **asked) is None


AGAIN = {
    "an internal error": {"code": ExitCode.INTERNAL},
    "a full disk": {"code": ExitCode.NO_FILE},
    "a refusal": {"refused": True, "code": ExitCode.NOTHING},
    "skipped": {"skipped": True},
}


@pytest.mark.parametrize("why", AGAIN)
def test_what_failed_is_done_again(tmp_path, outputs, why):
    """What may have been the computer's fault, and what costs nothing, has no line."""
    _kept(tmp_path, outputs, **AGAIN[why])
    assert _resumed(tmp_path, outputs) is None


def test_a_run_that_does_not_resume_begins_anew(tmp_path, outputs):
    """Without --resume the lines of earlier runs are forgotten."""
    _kept(tmp_path, outputs)
    Manifest(tmp_path, "o", resume=False).close()
    assert _resumed(tmp_path, outputs) is None


def test_a_line_that_was_cut_is_none_and_the_next_is_whole(tmp_path, outputs):
    """Wherever a killed run was stopped within a line, that line is none, the others stay, and new ones are read."""
    _kept(tmp_path, outputs)
    path = tmp_path / MANIFEST_NAME
    whole = path.read_bytes()
    title = whole.index(b"\n") + 1
    for length in (0, 1, title - 1, title, title + 1, len(whole) // 2, len(whole) - 1):
        path.write_bytes(whole[:length])
        assert _resumed(tmp_path, outputs) is None, length
        manifest = Manifest(tmp_path, "o", resume=True)
        manifest.keep(_ended(outputs), SHA, *outputs)
        manifest.close()
        assert path.read_bytes() == whole, length
        assert _resumed(tmp_path, outputs) is not None, length


def test_a_line_of_another_kind_is_none(tmp_path, outputs):
    """What is no line of this version's making is passed over; it stands in the way of nothing."""
    _kept(tmp_path, outputs)
    path = tmp_path / MANIFEST_NAME
    for line in (b"[1]", b"3", b"{}", b"no JSON", b'{"submission": "a.xlsx", "sha256": "", "options": "o"}', b"\xff"):
        path.write_bytes(path.read_bytes() + line + b"\n")
    assert _resumed(tmp_path, outputs) is not None
    assert _resumed(tmp_path, outputs, sha="") is None


@pytest.mark.parametrize("content", [b"my notes\n", b"my notes", b'{"flexlash": "other"}\n'])
def test_a_file_of_somebody_else_is_left_alone(tmp_path, content):
    """What has the manifest's name and is none is neither read nor changed, whether or not to go on is asked."""
    (tmp_path / MANIFEST_NAME).write_bytes(content)
    for resume in (False, True):
        with pytest.raises(FileExistsError, match="did not write it"):
            Manifest(tmp_path, "o", resume=resume)
    assert (tmp_path / MANIFEST_NAME).read_bytes() == content


@pytest.mark.skipif(os.name == "nt", reason="links need a privilege on Windows")
def test_a_link_is_not_followed(tmp_path):
    """A link in its place leads to no other file."""
    (tmp_path / "other").write_bytes(b"")
    (tmp_path / MANIFEST_NAME).symlink_to(tmp_path / "other")
    with pytest.raises(OSError, match=r"."):
        Manifest(tmp_path, "o", resume=False)
    assert (tmp_path / "other").read_bytes() == b""


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such locks")
def test_two_runs_do_not_write_one_manifest(tmp_path):
    """While a run holds the lines, another one cannot have them."""
    manifest = Manifest(tmp_path, "o", resume=False)
    with pytest.raises(BlockingIOError):
        Manifest(tmp_path, "o", resume=True)
    manifest.close()
    Manifest(tmp_path, "o", resume=True).close()


def test_the_digest_holds_what_outputs_depend_on():
    """Every option that changes a report changes it, the tables beside by their content; where and how many do not."""
    table = {"Tolerances": Source(name="t.csv", data=b"a")}
    digests = {
        options_digest(options, tables, marked=marked)
        for options, tables, marked in (
            (Options(), {}, True), (Options(seed=1), {}, True), (Options(samples=64), {}, True),
            (Options(method="random"), {}, True), (Options(strict=True), {}, True),
            (Options(elasticity=True), {}, True), (Options(cross_check=True), {}, True),
            (Options(fail_over_limit=True), {}, True),
            (Options(marked_copies=True), {}, True), (Options(), table, True), (Options(), {}, False),
            (Options(), {"Tolerances": Source(name="t.csv", data=b"b")}, True),
            (Options(), {"Materials": Source(name="t.csv", data=b"a")}, True),
        )
    }  # fmt: skip
    assert len(digests) == 13
    same = Options(jobs=7, tolerances="here.csv", given=(Path("a"),), progress=print)
    assert options_digest(same, {}, marked=True) == options_digest(Options(), {}, marked=True)
