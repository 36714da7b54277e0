"""From the store into OUT: each file whole, once, under a name that nothing else has; the original last."""

import errno
import io
import os
import shutil
import threading
import time
from pathlib import Path

import pytest
from drop_folders import _ENDINGS, Service
from web_pages import Idle, Visitor

from flexlash.service import delivering
from flexlash.service.drop_folder import DropFolder
from flexlash.service.log import Log
from flexlash.service.out_names import out_name
from flexlash.service.repeated import Repeated
from flexlash.service.store import Store
from flexlash.service.web.access import Access
from flexlash.service.web.app import application

FILES = {"report": b"the report", "checked": b"the marked copy", "reasons": b"the reasons"}


@pytest.fixture
def service(tmp_path):
    """Make a drop folder for a test alone."""
    with Service(tmp_path) as one:
        yield one


def hand_in(service: Service, data: bytes = b"a,b\n1,2\n", files=FILES, *, state: str = "done", name: str = "a.csv"):
    """Hand in a file, have it answered and delivered; return the submission."""
    service.put(name, data)
    service.pass_time(8)
    service.answer(files, state=state)
    service.pass_time(2)
    return service.submissions()[-1]


def faults(service: Service) -> list[str]:
    """Return what was told of faults."""
    return [line for line in service.said if line.startswith("fault ")]


@pytest.mark.parametrize("state", ["done", "rejected"])
def test_files_go_to_out_and_the_original_to_done_or_rejected(service, state):
    """The sender finds what is his under the name of his file, and the original under its ID."""
    submission = hand_in(service, state=state)
    assert service.delivered == {
        "a-report.xlsx": b"the report", "a-checked.xlsx": b"the marked copy", "a-reasons.txt": b"the reasons",
    }  # fmt: skip
    assert (service.out / state / submission.id / "a.csv").read_bytes() == b"a,b\n1,2\n"
    assert list((service.out / "work" / service.store.name).iterdir()) == []
    assert service.store.undelivered() == []


def test_what_the_report_of_a_large_table_names_lies_beside_it(service, monkeypatch):
    """Such a report holds the worst rows alone and names the files that have all; any other needs none."""
    monkeypatch.setitem(_ENDINGS, "results", "-results.parquet")
    monkeypatch.setitem(_ENDINGS, "findings", "-findings.csv")
    hand_in(service, files={**FILES, "results": b"all Results", "findings": b"all findings"})
    assert service.delivered.keys() == {
        "a-report.xlsx", "a-results.parquet", "a-findings.csv", "a-checked.xlsx", "a-reasons.txt",
    }  # fmt: skip
    monkeypatch.setitem(_ENDINGS, "results", "-results.csv")
    hand_in(service, b"b\n", {"report": b"the report", "results": b"all Results"}, name="b.csv")
    assert {name for name in service.delivered if name.startswith("b")} == {"b-report.xlsx"}


def test_the_original_goes_last(service, monkeypatch):
    """Whoever sees the original in done/ finds the report: it is moved when all files are there."""
    seen = []
    move = delivering._move
    monkeypatch.setattr(delivering, "_move", lambda *ways: (seen.append(set(service.delivered)), move(*ways)))
    hand_in(service)
    assert seen == [{"a-report.xlsx", "a-checked.xlsx", "a-reasons.txt"}]


def test_files_of_one_submission_get_the_same_number(service):
    """Who hands in a file of one name again and again sees which report, copy and reasons belong together."""
    hand_in(service, b"1\n", {"checked": b"c1", "reasons": b"r1"}, state="rejected")
    hand_in(service, b"2\n", {"report": b"p2", "checked": b"c2", "reasons": b"r2"})
    hand_in(service, b"3\n", {"report": b"p3"})
    assert service.delivered == {
        "a-checked.xlsx": b"c1", "a-reasons.txt": b"r1",
        "a-report (2).xlsx": b"p2", "a-checked (2).xlsx": b"c2", "a-reasons (2).txt": b"r2",
        "a-report.xlsx": b"p3",
    }  # fmt: skip


def test_nothing_is_ever_overwritten(service, tmp_path):
    """A file, folder or link of somebody that has the name stays as it is; the delivery gets a number."""
    (service.out / "a-report.xlsx").write_text("mine")
    (service.out / "a-report (2).xlsx").mkdir()
    number = 3
    if os.name != "nt":
        (tmp_path / "elsewhere").write_text("elsewhere")
        (service.out / "a-report (3).xlsx").symlink_to(tmp_path / "elsewhere")
        number = 4
    hand_in(service, files={"report": b"the report"})
    assert (service.out / f"a-report ({number}).xlsx").read_bytes() == b"the report"
    assert (service.out / "a-report.xlsx").read_text() == "mine"
    assert os.name == "nt" or (tmp_path / "elsewhere").read_text() == "elsewhere"


def test_what_comes_to_have_the_name_in_the_last_moment_stays(service, monkeypatch):
    """Between the choice of a name and its use somebody may be quicker: another name is chosen."""
    put_new = delivering.put_new

    def quicker(made: Path, path: Path) -> bool:
        monkeypatch.setattr(delivering, "put_new", put_new)
        path.write_text("mine")
        return put_new(made, path)

    monkeypatch.setattr(delivering, "put_new", quicker)
    hand_in(service, files={"report": b"the report"})
    service.pass_time(10)
    assert service.delivered == {"a-report.xlsx": b"mine", "a-report (2).xlsx": b"the report"}


@pytest.mark.skipif(os.name == "nt", reason="Windows renames")
def test_a_drive_without_links_is_delivered_to(service, monkeypatch):
    """Where a file cannot have a second name, an empty one holds its name until it is whole."""

    def unable(self: Path, target: Path) -> None:
        raise OSError(errno.EPERM, "Operation not permitted", str(self), None, str(target))

    monkeypatch.setattr(Path, "hardlink_to", unable)
    (service.out / "a-report.xlsx").write_text("mine")
    hand_in(service, files={"report": b"the report"})
    assert service.delivered == {"a-report.xlsx": b"mine", "a-report (2).xlsx": b"the report"}


def test_an_out_that_was_removed_and_made_anew_by_hand_is_used(service):
    """What comes in after somebody has removed OUT and made it again, with `work`, is taken and delivered as ever."""
    hand_in(service)
    shutil.rmtree(service.out)
    service.put("b.csv", b"b\n")
    service.pass_time(20)
    assert service.submissions()[-1].name == "a.csv"
    (service.out / "work").mkdir(parents=True)
    service.pass_time(20)
    service.answer(FILES)
    service.pass_time(20)
    assert service.delivered.keys() == {"b-report.xlsx", "b-checked.xlsx", "b-reasons.txt"}
    assert service.originals("done") == {("b.csv", b"b\n"): 1}


@pytest.mark.parametrize("listed", ["file", "original"])
@pytest.mark.parametrize("has_ended_again", [False, True])
def test_what_is_retried_while_it_is_delivered_leaves_with_its_last_result(
    service, monkeypatch, listed, has_ended_again
):
    """Retried between the look at what is due and its delivery, a submission is delivered once it has ended again."""
    deliveries = service.store.deliveries

    def then_retried():
        found = deliveries()
        if any(one.kind == listed for one in found):
            monkeypatch.undo()
            service.store.retry(found[0].submission)
            if has_ended_again:
                service.answer({"report": b"the last report"}, state="rejected")
        return found

    monkeypatch.setattr(service.store, "deliveries", then_retried)
    submission = hand_in(service, files={"report": b"the first report"})
    if not has_ended_again:
        assert service.store.submission(submission.id).state == "waiting"
        assert {path.name for path in service.out.iterdir() if path.is_dir()} == {"work", "done", "rejected"}
    service.answer({"report": b"the last report"}, state="rejected")
    service.pass_time(10)
    assert b"the last report" in service.delivered.values()
    assert (b"the first report" in service.delivered.values()) == (listed == "original")
    assert (service.out / "rejected" / submission.id / "a.csv").is_file()


@pytest.mark.parametrize("killed_before", ["choose_target", "delivered"])
def test_a_delivery_that_was_cut_short_is_made_once(tmp_path, monkeypatch, killed_before):
    """After a kill before or behind the file, the next start neither doubles nor loses anything."""
    with Service(tmp_path) as first:
        first.put("a.csv")
        first.pass_time(8)
        first.answer(FILES)
        with monkeypatch.context() as patched:
            patched.setattr(Store, killed_before, lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
            with pytest.raises(KeyboardInterrupt):
                first.folder.step()
    with Service(tmp_path) as second:
        second.pass_time(2)
        assert sorted(second.delivered.values()) == sorted(FILES.values())
        assert second.originals() == {("a.csv", b"a,b\n1,2\n"): 1}
        assert second.store.undelivered() == []


def test_a_target_that_holds_something_else_meanwhile_is_left(service, monkeypatch):
    """Somebody who has changed the report between delivery and note keeps that; the report comes again."""
    with monkeypatch.context() as patched:
        patched.setattr(Store, "delivered", lambda *_: (_ for _ in ()).throw(OSError(errno.EIO, "I/O error")))
        hand_in(service, files={"report": b"the report"})
    (service.out / "a-report.xlsx").write_text("changed by somebody")
    service.pass_time(20)
    assert service.delivered == {"a-report.xlsx": b"changed by somebody", "a-report (2).xlsx": b"the report"}


def test_the_same_submission_again_is_answered_with_its_report_and_told_so(service):
    """A file handed in again and again has one report and one text that says where it is; each original is kept."""
    first = hand_in(service, files={"report": b"the report"})
    for _ in range(3):
        service.put("a.csv")
        service.pass_time(10)
    assert service.delivered.keys() == {"a-report.xlsx", "a-reasons.txt"}
    text = service.delivered["a-reasons.txt"].decode("utf-8-sig")
    for needed in ("handed in before", "a-report.xlsx", first.id):
        assert needed in text
    assert service.originals("done") == {("a.csv", b"a,b\n1,2\n"): 4}


def test_a_report_that_was_taken_away_is_delivered_again(service):
    """Who has moved the report and hands in the same file once more finds it again."""
    hand_in(service, files={"report": b"the report"})
    (service.out / "a-report.xlsx").unlink()
    service.put("a.csv")
    service.pass_time(10)
    assert service.delivered["a-report.xlsx"] == b"the report"


def test_who_hands_in_a_rejected_file_unchanged_is_told_where_the_reasons_are(service):
    """The reasons stay, and a text beside them names them; a third time adds nothing."""
    hand_in(service, files={"reasons": b"because"}, state="rejected")
    for _ in range(2):
        service.put("a.csv")
        service.pass_time(10)
    assert service.delivered.keys() == {"a-reasons.txt", "a-reasons (2).txt"}
    assert service.delivered["a-reasons.txt"] == b"because"
    assert b"a-reasons.txt" in service.delivered["a-reasons (2).txt"]
    assert service.originals("rejected") == {("a.csv", b"a,b\n1,2\n"): 3}


def test_what_has_ended_is_delivered_at_once_when_told(service):
    """A thread looks every so often; woken it delivers without delay, and it ends when it is stopped."""
    service.put("a.csv")
    service.pass_time(8)
    folder = DropFolder(service.store, service.places, "options", Log(stream=service.lines), seconds=3600)
    folder.start()
    service.answer({"report": b"the report"})
    folder.wake()
    for _ in range(500):
        if not service.store.undelivered():
            break
        time.sleep(0.01)
    folder.stop(10)
    assert service.delivered == {"a-report.xlsx": b"the report"}
    assert "flexlash drop folder" not in {thread.name for thread in threading.enumerate()}


def test_one_delivery_that_fails_hinders_no_other(service, monkeypatch):
    """A full disk is told once, tried less and less often, and nothing is lost by it."""
    put = delivering.Delivering._put
    tries = []

    def full(self: delivering.Delivering, name: str, *content: object) -> None:
        if name.startswith("a-"):
            tries.append(name)
            raise OSError(errno.ENOSPC, "No space left on device", name)
        put(self, name, *content)

    with monkeypatch.context() as patched:
        patched.setattr(delivering.Delivering, "_put", full)
        service.put("a.csv")
        service.put("b.csv")
        service.pass_time(8)
        service.answer(FILES)
        service.pass_time(200)
    assert service.delivered.keys() == {"b-report.xlsx", "b-checked.xlsx", "b-reasons.txt"}
    assert len(faults(service)) == 1
    assert 3 < len(tries) < 10
    service.pass_time(300)
    assert len(service.delivered) == 6
    assert service.originals("done") == {("a.csv", b"a,b\n1,2\n"): 1, ("b.csv", b"a,b\n1,2\n"): 1}


def test_an_original_that_somebody_moved_is_told_and_the_rest_delivered(service):
    """The report goes to OUT although its original is no longer in work/."""
    service.put("a.csv")
    service.pass_time(8)
    (submission,) = service.submissions()
    (service.out / "work" / service.store.name / submission.id / "a.csv").unlink()
    service.answer({"report": b"the report"})
    service.pass_time(4)
    assert service.delivered == {"a-report.xlsx": b"the report"}
    assert any(line.startswith(f"original is gone {submission.id}") for line in service.said)
    assert service.store.undelivered() == []


def test_an_original_never_replaces_what_lies_in_its_folder(service):
    """Somebody's file under done/ID keeps its name; the original gets a number."""
    service.put("a.csv")
    service.pass_time(8)
    (submission,) = service.answer({})
    folder = service.out / "done" / submission.id
    folder.mkdir()
    (folder / "a.csv").write_text("mine")
    service.pass_time(2)
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == {
        "a.csv": b"mine", "a (2).csv": b"a,b\n1,2\n",
    }  # fmt: skip


def test_a_damaged_file_of_the_store_is_not_delivered(service):
    """What no longer has the bytes it was kept with goes to nobody, and is told."""
    service.put("a.csv")
    service.pass_time(8)
    (submission,) = service.answer({"report": b"the report"})
    kept = service.store.blobs.path(service.store.files(submission.id)["report"].sha256)
    kept.chmod(0o600)
    kept.write_bytes(b"the re_ort")
    service.pass_time(4)
    assert service.delivered == {}
    assert "damaged" in faults(service)[0]
    assert service.originals("work") == {("a.csv", b"a,b\n1,2\n"): 1}


def test_what_a_killed_service_left_in_out_is_removed(tmp_path):
    """A temporary file of a delivery that was cut short goes at the next start; others stay."""
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / ".flexlash-0123.tmp").write_text("half")
    (tmp_path / "out" / "mine.tmp").write_text("mine")
    with Service(tmp_path) as service:
        service.pass_time(2)
        assert service.delivered == {"mine.tmp": b"mine"}


def test_r8_a_name_in_out_never_leads_elsewhere():
    """Whatever a submission is called, its report lies in OUT itself under a printable name of bounded length."""
    for name in ("../../etc/passwd-report.xlsx", "a/b\\c-report.xlsx", "\0\n\u202e\udcff-report.xlsx", "ä" * 500):
        safe = out_name(name)
        assert safe.isprintable()
        assert Path(safe).name == safe
        assert len(safe.encode()) <= 255 - len(" (9999)")


def test_health_says_what_keeps_the_drop_folder_from_its_work(service, tmp_path, monkeypatch):
    """Whoever watches the service hears of a lost drive, of files that do not come into OUT, of a thread that ended."""
    app = application(
        service.store, Idle(), Access.of(), "options", time.time(), log=Log(stream=io.StringIO()),
        troubles=service.folder.troubles,
    )  # fmt: skip

    def wrong() -> list[str]:
        return Visitor(app).get("/health").json()["wrong"]

    assert wrong() == ["nothing looks into INBOX"]
    monkeypatch.setattr(Repeated, "is_alive", True)
    service.step()
    assert wrong() == []
    service.out.rename(tmp_path / "away")
    service.step()
    assert wrong() == ["INBOX or OUT cannot be used"]
    (tmp_path / "away").rename(service.out)
    service.step()
    assert wrong() == []

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(delivering, "put_new", full)
        hand_in(service)
    assert wrong() == ["files cannot be put into OUT"]
    service.pass_time(10)
    assert wrong() == []
