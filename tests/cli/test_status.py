"""`flexlash status` and `flexlash retry`: what the service holds, in sentences and as JSON, served or not."""

from __future__ import annotations

import importlib.util
import json

import pytest
from click.testing import CliRunner

from flexlash.cli import cli, status_command
from flexlash.service.records import Ending, HandedIn, StoredFile
from flexlash.service.store import Store
from flexlash.service.store_place import StoreError


@pytest.fixture
def store(tmp_path):
    """Return a store that is served, with a submission in each state and one that has not left it."""
    with Store(tmp_path / "store", serving=True) as store:
        for number, (name, state) in enumerate(
            [("done.csv", "done"), ("no.csv", "rejected"), ("works.csv", ""), ("waits.csv", "")]
        ):
            door = "folder" if state else "page"
            store.accept(HandedIn(id=f"{number}" * 32, name=name, options="o", door=door, sender="joe"), name.encode())
        for state in ("done", "rejected"):
            sha256, size = store.blobs.put(state.encode())
            file = StoredFile(role="report", sha256=sha256, size=size, name=f"{state}-report.xlsx")
            store.end(
                store.take().id,
                Ending(state=state, exit_code=0, words="2 of 2 rows computed", files=[file],
                       reason="E118 the reader failed." if state == "rejected" else ""),
            )  # fmt: skip
        store.take()
        store.note_rows("2" * 32, 5, 10)
        store.postpone(store.deliveries()[0], 60.0, "No space left on device")
        yield store


def said(*arguments, code=0):
    """Return what a command prints."""
    result = CliRunner().invoke(cli, list(map(str, arguments)))
    assert result.exit_code == code, result.output
    return result.output


def test_the_sentences_say_what_waits_works_and_has_ended(store):
    """Where the store is, whether a server works on it, each state, each reason, and what has not been delivered."""
    lines = said("status", "--store", store.folder).splitlines()
    assert lines[0] == f"Store {store.folder}: a server works on it."
    assert lines[1].startswith("1 at work, 1 waiting (0.0 MiB to be computed), 1 done, 1 rejected;")
    for start in (
        "At work: works.csv, 5 of 10 rows, since ",
        "Waiting: waits.csv.",
        "Rejected: no.csv: E118 the reader failed.",
        "Done: done.csv",
        "Not delivered yet: report of done.csv: No space left on device; tried 1 times",
    ):
        assert any(line.startswith(start) for line in lines), start


def test_without_a_server_the_same_is_told(store):
    """Once the server has ended the store can be asked still."""
    store.close()
    assert "no server works on it" in said("status", "--store", store.folder)


def test_json_says_the_same(store):
    """One object with the store, its counts, and what waits, works, was rejected and is not delivered."""
    told = json.loads(said("status", "--json", "--store", store.folder))
    assert told["store"] == str(store.folder)
    assert told["served"]
    assert told["counts"] == {"waiting": 1, "working": 1, "done": 1, "rejected": 1}
    assert [one["name"] for one in (*told["working"], *told["waiting"], *told["rejected"])] == [
        "works.csv", "waits.csv", "no.csv",
    ]  # fmt: skip
    assert {one["trouble"] for one in told["undelivered"]} == {"No space left on device", ""}


def test_one_submission_is_told_whole(store):
    """The first letters of an ID are enough: state, files, and what happened to it in order."""
    text = said("status", "0000", "--store", store.folder)
    assert "Done: done.csv: 2 of 2 rows computed." in text
    assert "File: report, done-report.xlsx, 4 bytes, sha256" in text
    events = [line.split()[2].rstrip(":") for line in text.splitlines() if line[:4].isdigit()]
    assert events == ["received", "begun", "done"]
    told = json.loads(said("status", "3333", "--json", "--store", store.folder))
    assert (told["state"], told["position"], told["sender"]) == ("waiting", 0, "joe")


def test_retry_has_a_submission_computed_anew_while_the_server_works(store):
    """The server finds it among what waits; one that has not ended is left as it is."""
    assert said("retry", "1111", "--store", store.folder) == "no.csv is computed anew.\n"
    assert store.submission("1" * 32).state == "waiting"
    assert "has not finished yet" in said("retry", "1111", "--store", store.folder)
    store.close()
    assert "as soon as flexlash serve or watch runs" in said("retry", "0000", "--store", store.folder)


def test_an_unknown_id_is_a_usage_error(store):
    """Nothing that begins so, too little of it, and what was forgotten are told apart; the code is 2."""
    store._database.run("INSERT INTO forgotten VALUES (?, 0)", "f" * 32)
    for command in ("status", "retry"):
        assert "There is no submission abcd" in said(command, "abcd", "--store", store.folder, code=2)
        assert "There is no submission 0;" in said(command, "0", "--store", store.folder, code=2)
        assert "has been deleted" in said(command, "f" * 32, "--store", store.folder, code=2)


def test_hostile_names_stay_on_their_line(store):
    """A name with line ends and escape sequences is printed without them."""
    store.accept(HandedIn(id="e" * 32, name="a\n\x1b[31mred", options="o", door="page"), b"x")
    for text in (said("status", "--store", store.folder), said("status", "eeee", "--store", store.folder)):
        assert "\x1b" not in text
        assert any("a··[31mred" in line for line in text.splitlines())


def test_no_store_is_told_and_none_is_made(tmp_path):
    """Where there is no store the sentence says what makes one."""
    result = CliRunner().invoke(cli, ["status", "--store", str(tmp_path / "none")])
    assert isinstance(result.exception, StoreError)
    assert "flexlash serve makes one" in str(result.exception)
    assert list(tmp_path.iterdir()) == []


def test_a_backup_is_made_on_the_way(store, tmp_path):
    """The copy is a store; with --json the sentence about it goes to standard error; damage ends with code 5."""
    assert "6 files copied" in said("status", "--store", store.folder, "--backup", tmp_path / "copy")
    assert "1 at work, 1 waiting" in said("status", "--store", tmp_path / "copy")
    result = CliRunner().invoke(
        cli, ["status", "--json", "--store", str(store.folder), "--backup", str(tmp_path / "copy")]
    )
    assert json.loads(result.stdout)["served"]
    assert "0 files copied" in result.stderr
    store.blobs.path(store.files("0" * 32)["report"].sha256).write_bytes(b"d0ne")
    assert "is damaged or gone" in said("status", "--store", store.folder, "--backup", tmp_path / "new", code=5)


def test_a_missing_extra_is_told(monkeypatch, tmp_path):
    """Without the libraries of the service a sentence says what to install; the code is 2."""
    monkeypatch.setattr(status_command, "find_spec", lambda name: None if name == "filelock" else importlib.util)
    for command in (["status"], ["retry", "abcd"]):
        assert "pip install 'flexlash[service]'" in said(*command, "--store", tmp_path, code=2)
