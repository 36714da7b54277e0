"""The Results table in other forms, and files that are whole or absent."""

from __future__ import annotations

import csv
import json
import os
from pathlib import Path

import polars as pl
import pytest

from flexlash.pipeline import run
from flexlash.report import output


@pytest.fixture
def outcome(table, sound):
    """Return an outcome with a computed row, a faulty row and a name that looks like a formula."""
    rows = [{**sound, "variant": "=1+1"}, {**sound, "variant": "bad", "torque_Nm": ""}]
    return run(table(rows), samples=512)


def test_csv_holds_full_doubles_and_blanks(outcome, tmp_path):
    """CSV repeats every double to its last bit and leaves missing numbers blank."""
    path = output.write_outcome(outcome, tmp_path / "out.csv")
    with path.open(encoding="utf-8", newline="") as file:
        good, bad = csv.DictReader(file)
    assert float(good["p97_5_arcmin"]) == outcome.results["p97_5_arcmin"][0]
    assert float(good["windup_rad"]) == outcome.results["windup_rad"][0]
    assert bad["status"] == "error"
    assert bad["windup_rad"] == ""


def test_csv_text_is_inert(outcome, tmp_path):
    """A text that a spreadsheet would take for a formula gets an apostrophe in CSV, and only there."""
    text = output.write_outcome(outcome, tmp_path / "out.csv").read_text(encoding="utf-8")
    assert '\n"\'=1+1",' in text
    assert outcome.results["variant"][0] == "=1+1"


def test_parquet_repeats_the_frame(outcome, tmp_path):
    """Parquet gives back the very frame."""
    assert pl.read_parquet(output.write_outcome(outcome, tmp_path / "out.parquet")).equals(outcome.results)


def test_json_is_a_list_of_rows(outcome, tmp_path):
    """JSON is one object per row with null for what is missing."""
    rows = json.loads(output.write_outcome(outcome, tmp_path / "out.json").read_text(encoding="utf-8"))
    assert [row["variant"] for row in rows] == ["=1+1", "bad"]
    assert rows[0]["backlash_rad"] == outcome.results["backlash_rad"][0]
    assert rows[1]["backlash_rad"] is None


def test_an_unknown_ending_is_refused(outcome, tmp_path):
    """An ending without a meaning is refused before anything is written."""
    with pytest.raises(ValueError, match="must end in"):
        output.write_outcome(outcome, tmp_path / "out.txt")
    assert list(tmp_path.glob("out*")) == []


def test_a_failed_write_leaves_the_old_file(outcome, tmp_path, monkeypatch):
    """When the disk fails in the middle, the earlier file stays whole and no scrap remains."""
    path = tmp_path / "out.csv"
    path.write_text("earlier", encoding="utf-8")

    def fail(_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(output.os, "fsync", fail)
    with pytest.raises(OSError, match="No space"):
        output.write_outcome(outcome, path)
    assert path.read_text(encoding="utf-8") == "earlier"
    assert not list(tmp_path.glob(".flexlash-*"))


@pytest.mark.skipif(os.name == "nt", reason="POSIX permission bits")
def test_files_have_the_users_permissions(tmp_path):
    """A written file has the permissions that any new file of the user has."""
    plain = tmp_path / "plain"
    plain.touch()
    written = output.write_bytes(b"x", tmp_path / "written")
    assert written.stat().st_mode == plain.stat().st_mode


def test_a_report_open_in_excel_is_left_alone(tmp_path, monkeypatch):
    """On Windows a locked report stays, and the new one is written beside it as ` (2)`, then ` (3)`."""
    path = tmp_path / "report.xlsx"
    path.write_bytes(b"open in Excel")
    (tmp_path / "report (2).xlsx").write_bytes(b"the one before")
    replace = Path.replace

    def locked(self, target):
        if target == path:
            raise PermissionError(13, "in use")
        return replace(self, target)

    monkeypatch.setattr(output, "_LOCKS", True)
    monkeypatch.setattr(Path, "replace", locked)
    assert output.write_bytes(b"new", path).name == "report (3).xlsx"
    assert path.read_bytes() == b"open in Excel"


def test_a_folder_without_permission_is_told(tmp_path, monkeypatch):
    """Elsewhere a refused rename is an error, not a copy under another name."""

    def refuse(self, target):  # noqa: ARG001
        raise PermissionError(13, "denied")

    monkeypatch.setattr(output, "_LOCKS", False)
    monkeypatch.setattr(Path, "replace", refuse)
    with pytest.raises(PermissionError, match="denied"):
        output.write_bytes(b"new", tmp_path / "report.xlsx")


def test_endless_locks_end(tmp_path, monkeypatch):
    """When every name is locked, the error says so instead of trying for ever."""

    def refuse(self, target):  # noqa: ARG001
        raise PermissionError(13, "denied")

    monkeypatch.setattr(output, "_LOCKS", True)
    monkeypatch.setattr(Path, "replace", refuse)
    with pytest.raises(PermissionError, match="cannot be replaced"):
        output.write_bytes(b"new", tmp_path / "report.xlsx")
