"""From INBOX into the store: what is passed over, when and how a file is claimed, and that none is ever lost."""

import errno
import os
import unicodedata
from pathlib import Path

import pytest
from drop_folders import Service, digest

from flexlash.service import inbox as inbox_room
from flexlash.service.blobs import Blobs
from flexlash.service.settling import is_whole

_POSIX = pytest.mark.skipif(os.name == "nt", reason="names and links of POSIX")
STUDY = (Path(__file__).parents[2] / "data" / "b3-160-study.xlsx").read_bytes()


@pytest.fixture
def service(tmp_path):
    """Make a drop folder for a test alone."""
    with Service(tmp_path) as one:
        yield one


def names(folder: Path) -> set[str]:
    """Return what lies in a folder."""
    return set(os.listdir(folder))  # noqa: PTH208


def test_what_has_settled_is_claimed_and_accepted(service):
    """A file goes whole from INBOX to work/STORE/ID/NAME, under the ID that the store knows it by."""
    service.put("study.xlsx", STUDY)
    service.pass_time(4)
    assert service.submissions() == []
    service.pass_time(4)
    (submission,) = service.submissions()
    assert (submission.name, submission.sha256, submission.door) == ("study.xlsx", digest(STUDY), "folder")
    assert submission.options == "options"
    path = service.out / "work" / service.store.name / submission.id / "study.xlsx"
    assert path.read_bytes() == STUDY
    assert names(service.inbox) == set()
    assert service.woken == 1


def test_hidden_and_temporary_files_links_folders_and_pipes_are_never_touched(service):
    """Whatever is not a whole file of somebody stays as it is, and is named once."""
    passed_over = {".hidden.csv", "~$a.xlsx", "a.tmp", "a.xlsx.PART", "b.crdownload", "c.filepart", "Thumbs.db"}
    for name in passed_over:
        service.put(name)
    (service.inbox / "folder.xlsx").mkdir()
    (service.inbox / "folder.xlsx" / "inside.csv").write_text("a\n")
    passed_over |= {"folder.xlsx"}
    if os.name != "nt":
        (service.inbox / "link.xlsx").symlink_to(service.inbox / "a.tmp")
        os.mkfifo(service.inbox / "pipe.xlsx")
        passed_over |= {"link.xlsx", "pipe.xlsx"}
    service.put("any.ending")
    service.pass_time(200)
    assert names(service.inbox) == passed_over
    assert [one.name for one in service.submissions()] == ["any.ending"]
    told = [line for line in service.said if line.startswith("passed over")]
    assert len(told) == len(passed_over)


def test_r11_a_slow_copy_is_taken_once_it_is_whole(service):
    """A copy in pieces with pauses, each shorter or longer than what settles a whole file, is judged as a whole."""
    piece = len(STUDY) // 7
    for pause in (2, 4, 6, 20, 40, 58):
        service.put("study.xlsx", b"")
        for start in range(0, len(STUDY), piece):
            with (service.inbox / "study.xlsx").open("ab") as file:
                file.write(STUDY[start : start + piece])
            if start + piece < len(STUDY):
                service.pass_time(pause)
                assert names(service.inbox) == {"study.xlsx"}
        service.pass_time(8)
        assert service.submissions()[-1].sha256 == digest(STUDY)
    assert {one.sha256 for one in service.submissions()} == {digest(STUDY)}


def test_r11_torn_copies_at_every_sector_are_not_judged_early(service):
    """Pieces of a workbook, one for each sector, lie unclaimed for 58 seconds; the whole beside them does not wait."""
    pieces = {f"{length}.xlsx": STUDY[:length] for length in range(0, len(STUDY), 512)}
    for name, data in pieces.items():
        service.put(name, data)
    service.put("whole.xlsx", STUDY)
    service.pass_time(58)
    assert names(service.inbox) == set(pieces)
    assert [one.name for one in service.submissions()] == ["whole.xlsx"]


def test_r11_a_copy_that_stopped_is_judged_after_a_minute(service):
    """Whoever's copy broke off is told so; what goes on within the minute starts it anew."""
    service.put("a.xlsx", STUDY[:1000])
    service.pass_time(58)
    service.put("a.xlsx", STUDY[:2000])
    service.pass_time(58)
    assert service.submissions() == []
    service.pass_time(4)
    assert [one.size for one in service.submissions()] == [2000]


def test_r11_a_writer_that_goes_on_after_the_claim_is_answered_with_the_whole(service):
    """A file whose writer kept it open is another submission; what came of the piece is told to nobody."""
    with (service.inbox / "a.csv").open("ab") as file:
        file.write(b"a,b\n")
        file.flush()
        service.pass_time(8)
        (piece,) = service.submissions()
        file.write(b"1,2\n")
        file.flush()
        service.answer()
        service.pass_time(4)
        assert service.delivered == {}
        file.write(b"3,4\n")
    service.settle()
    service.settle()
    whole = service.submissions()[-1]
    assert whole.sha256 == digest(b"a,b\n1,2\n3,4\n")
    assert service.delivered == {"a-report.xlsx": f"report of {whole.sha256}".encode()}
    assert service.originals() == {("a.csv", b"a,b\n1,2\n3,4\n"): 1}
    assert any(line.startswith(f"changed after it was claimed {piece.id}") for line in service.said)


def test_r11_what_changes_while_it_is_kept_settles_again(service, monkeypatch):
    """Where the writer goes on during the copy into the store, none of it is accepted until it has ended."""
    keep = Blobs.put_file

    def changing(blobs: Blobs, path: Path) -> tuple[str, int]:
        monkeypatch.setattr(Blobs, "put_file", keep)
        put = Blobs.put

        def growing(blobs: Blobs, content) -> tuple[str, int]:
            monkeypatch.setattr(Blobs, "put", put)
            kept = put(blobs, content)
            with path.open("ab") as file:
                file.write(b"3,4\n")
            return kept

        monkeypatch.setattr(Blobs, "put", growing)
        return keep(blobs, path)

    monkeypatch.setattr(Blobs, "put_file", changing)
    service.put("a.csv", b"a,b\n")
    service.pass_time(8)
    assert service.submissions() == []
    service.pass_time(8)
    assert [one.sha256 for one in service.submissions()] == [digest(b"a,b\n3,4\n")]


_HOSTILE = [
    "line\nend.csv", "bell\a\x1b[2Jescape.csv", "turn\u202egnp.csv", "caf\udce9.csv", "-o.csv", "con.csv", "dots...csv",
    "space .csv ", "a" * 251 + ".csv", "ä" * 125 + ".csv", "'; DROP TABLE submission; --.csv", "$(reboot).csv", "%s%n",
    "a\\b.csv", "=cmd|x.csv", "\u200b.csv", "Case.csv", "case.csv", unicodedata.normalize("NFC", "é.csv"),
    unicodedata.normalize("NFD", "é.csv"), "..a", "no ending",
]  # fmt: skip


@_POSIX
def test_r8_hostile_names_are_inert_everywhere(service):
    """Each is taken, and its original keeps its very name; reports, log and store get harmless ones."""
    put = {}
    for number, name in enumerate(_HOSTILE):
        put[name] = f"a,b\n{number},2\n".encode()
        service.put(name, put[name])
    service.settle()
    taken = {name: data for name, data in put.items() if name != "..a"}
    assert service.originals("done") == dict.fromkeys(taken.items(), 1)
    assert names(service.inbox) == {"..a"}
    assert len(service.delivered) == len(taken)
    assert sorted(service.delivered.values()) == sorted(f"report of {digest(data)}".encode() for data in taken.values())
    for name in (*service.delivered, *(one.name for one in service.submissions()), *service.said):
        assert name.isprintable()
    assert {path.parent for path in service.out.rglob("*-report*")} == {service.out}
    assert all(len(os.fsencode(name)) <= 255 for name in service.delivered)


def test_of_a_file_that_nobody_reads_the_store_keeps_the_beginning(tmp_path):
    """Gigabytes in INBOX neither fill the store nor hold up others; the original goes whole to rejected/."""
    with Service(tmp_path, most_bytes=1000) as service:
        sizes = {"at limit.csv": 1000, "one more.csv": 1001, "large.csv": 5_000_000}
        files = {name: os.urandom(size - 1) + b"\n" for name, size in sizes.items()}
        for name, data in files.items():
            service.put(name, data)
        service.pass_time(70)
        kept = {one.name: one.size for one in service.submissions()}
        assert kept == {"at limit.csv": 1000, "one more.csv": 1001, "large.csv": 1001}
        (path,) = (service.out / "work").rglob("large.csv")
        service.answer({"reasons": b"too large"}, state="rejected")
        with path.open("r+b") as file:
            file.seek(10)
            file.write(b"still written")
        service.pass_time(2)
        assert service.originals("rejected").keys() == {(name, files[name]) for name in files if name != "large.csv"}
        assert len(service.submissions()) == 3
        service.pass_time(70)
        assert len(service.submissions()) == 4


def test_the_id_is_not_made_of_the_name(service):
    """The same name and content twice has two IDs."""
    for _ in range(2):
        service.put("a.csv")
        service.settle()
    first, second = service.submissions()
    assert first.id != second.id
    assert len(first.id) == 32


def test_the_oldest_are_taken_first_and_not_all_at_once(service, monkeypatch):
    """Of many files a step takes some, in the order in which they came; the next go on."""
    monkeypatch.setattr(inbox_room, "_AT_ONCE", 4)
    for number in reversed(range(6)):
        service.put(f"{number}.csv", f"{number}\n".encode())
        service.folder.step()
        service.now += 0.05
    service.now += 10
    assert service.folder.step()
    assert [one.name for one in service.submissions()] == ["5.csv", "4.csv", "3.csv", "2.csv"]
    assert not service.folder.step()
    assert len(service.submissions()) == 6


def failing(path: Path) -> bool:
    """Fail to look into files named `bad`, as where permission is missing."""
    if path.name.startswith("bad"):
        raise PermissionError(errno.EACCES, "Permission denied", str(path))
    return is_whole(path)


def test_a_file_that_may_not_be_read_waits_and_hinders_no_other(service, monkeypatch):
    """It is told once, stays where it is, and is taken when it may be read."""
    monkeypatch.setattr("flexlash.service.settling.is_whole", failing)
    service.put("bad.csv")
    service.put("good.csv")
    service.pass_time(30)
    assert [one.name for one in service.submissions()] == ["good.csv"]
    assert [line for line in service.said if line.startswith("fault")] == [
        "fault what=bad.csv why=you have no permission"
    ]
    assert not service.folder.is_idle
    monkeypatch.setattr("flexlash.service.settling.is_whole", is_whole)
    service.pass_time(300)
    assert [one.name for one in service.submissions()] == ["good.csv", "bad.csv"]


def test_a_file_that_vanishes_before_the_claim_leaves_nothing(service, monkeypatch):
    """Whoever takes a file back in the last moment, or another service, is not in the way."""
    sync = inbox_room.sync_file

    def vanishing(path: Path) -> None:
        sync(path)
        path.rename(path.with_name(".taken back"))

    monkeypatch.setattr(inbox_room, "sync_file", vanishing)
    service.put("a.csv")
    service.pass_time(20)
    assert service.submissions() == []
    assert not any(service.places.claimed(service.store.name))
    monkeypatch.setattr(inbox_room, "sync_file", lambda _: None)
    rename = Path.rename

    def lost(path: Path, target: Path) -> Path:
        if path.name == "b.csv":
            path.unlink(missing_ok=True)
        return rename(path, target)

    monkeypatch.setattr(Path, "rename", lost)
    service.put("b.csv")
    service.pass_time(20)
    assert service.submissions() == []
    assert not any(service.places.claimed(service.store.name))
    assert not [line for line in service.said if line.startswith("fault")]


def test_r11_what_is_written_in_the_moment_of_the_claim_settles_first(service, monkeypatch):
    """A file that changes between the last look and the rename is ours, but accepted once its writer has ended."""
    rename = Path.rename

    def grown(path: Path, target: Path) -> Path:
        if path.name == "a.csv" and path.parent == service.inbox:
            with path.open("ab") as file:
                file.write(b"3,4\n")
        return rename(path, target)

    monkeypatch.setattr(Path, "rename", grown)
    service.put("a.csv")
    service.pass_time(6)
    assert names(service.inbox) == set()
    assert service.submissions() == []
    assert not service.folder.is_idle
    service.pass_time(8)
    assert [one.sha256 for one in service.submissions()] == [digest(b"a,b\n1,2\n3,4\n")]


def test_inbox_may_go_and_come_back(service):
    """A drive that is lost for a while, even one that comes back as another folder, is told and then used again."""
    service.inbox.rename(service.inbox.with_name("away"))
    service.pass_time(20)
    assert [line.split(" ")[0] for line in service.said] == ["fault"]
    assert not service.folder.is_idle
    service.inbox.mkdir()
    service.put("a.csv")
    service.settle()
    assert service.originals("done") == {("a.csv", b"a,b\n1,2\n"): 1}
    assert any(line.startswith("fault is over") for line in service.said)


def test_out_may_go_and_come_back(service):
    """While OUT is lost nothing is claimed or delivered, nor put into what lies in its place."""
    service.put("a.csv")
    service.pass_time(8)
    service.answer()
    service.put("b.csv")
    service.out.rename(service.out.with_name("away"))
    service.out.mkdir()
    service.pass_time(30)
    assert names(service.out) == set()
    assert names(service.inbox) == {"b.csv"}
    service.out.rmdir()
    service.out.with_name("away").rename(service.out)
    service.settle()
    assert service.originals("done") == {("a.csv", b"a,b\n1,2\n"): 1, ("b.csv", b"a,b\n1,2\n"): 1}


def test_a_full_disk_is_not_the_files_fault(service, monkeypatch):
    """What the store cannot keep lies claimed, is tried less and less often, and is accepted when there is room."""
    tries = []
    keep = Blobs.put_file

    def full(_: Blobs, path: Path) -> tuple[str, int]:
        tries.append(service.now)
        raise OSError(errno.ENOSPC, "No space left on device", str(path))

    monkeypatch.setattr(Blobs, "put_file", full)
    service.put("a.csv")
    service.pass_time(300)
    assert len(tries) < 10
    assert len([line for line in service.said if line.startswith("fault")]) == 1
    monkeypatch.setattr(Blobs, "put_file", keep)
    service.pass_time(300)
    assert len(service.submissions()) == 1


def test_what_was_claimed_without_a_row_is_accepted_under_its_id(tmp_path):
    """After a kill between the claim and the store, the next start knows the file by the ID of its folder."""
    with Service(tmp_path) as first:
        own = first.places.work / first.store.name
        first.folder.step()
        for id_ in ("ab" * 16, "cd" * 16):
            (own / id_).mkdir()
        (own / ("ab" * 16) / "a.csv").write_bytes(b"a\n")
        (own / "no ID").mkdir()
        (own / "stray").write_text("x")
    with Service(tmp_path) as second:
        second.pass_time(8)
        assert [(one.id, one.name) for one in second.submissions()] == [("ab" * 16, "a.csv")]
        assert names(own) == {"ab" * 16, "no ID", "stray"}


def test_what_another_store_has_claimed_is_left_alone_and_told(tmp_path):
    """Originals of a store that was lost are named at the start, with what to do; nothing of them is moved."""
    with Service(tmp_path, "lost store") as first:
        first.put("a.csv")
        first.pass_time(8)
        folder = first.places.work / first.store.name
    with Service(tmp_path) as second:
        second.pass_time(70)
        assert second.submissions() == []
        (told,) = [line for line in second.said if line.startswith("left alone")]
        assert str(folder) in told
        assert "move them back into INBOX" in told
        (path,) = folder.rglob("a.csv")
        path.rename(second.inbox / "a.csv")
        second.settle()
        assert second.originals("done") == {("a.csv", b"a,b\n1,2\n"): 1}


def test_a_piece_that_was_not_handed_in_anew_is_so_at_the_next_start(tmp_path):
    """A kill between dropping the piece's result and the new claim loses nothing."""
    with Service(tmp_path) as first:
        path = first.put("a.csv")
        first.pass_time(8)
        (piece,) = first.answer()
        path = first.places.work / first.store.name / piece.id / "a.csv"
        path.write_bytes(b"a,b\n1,2\n3,4\n")
        first.store.drop_deliveries(piece.id, "killed here")
    with Service(tmp_path) as second:
        second.settle()
        assert second.originals("done") == {("a.csv", b"a,b\n1,2\n3,4\n"): 1}
        assert len(second.submissions()) == 2


def test_idle_is_said_once_all_is_delivered(service):
    """Neither before the first look, nor while a file settles, waits, is at work or is to be delivered."""
    assert not service.folder.is_idle
    service.put("a.csv")
    service.folder.step()
    assert not service.folder.is_idle
    service.pass_time(8)
    assert not service.folder.is_idle
    service.answer()
    assert not service.folder.is_idle
    service.pass_time(2)
    assert service.folder.is_idle


def test_idle_does_not_wait_for_ever_for_what_this_machine_refuses(service, monkeypatch):
    """A file that may not be read keeps `watch --once` for a minute, not for good."""
    monkeypatch.setattr("flexlash.service.settling.is_whole", failing)
    service.put("bad.csv")
    service.pass_time(50)
    assert not service.folder.is_idle
    service.pass_time(30)
    assert service.folder.is_idle
