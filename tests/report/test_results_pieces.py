"""Results that are joined from pieces are those in one piece, byte for byte, whatever the pieces are."""

from __future__ import annotations

import io
import json

import polars as pl
import pytest
from filled import SOUND

from flexlash.analysis.used_tolerances import used_tolerances
from flexlash.pipeline import run
from flexlash.report.output import outcome_bytes
from flexlash.report.results_pieces import PIECES, blank_piece, joined, piece
from flexlash.report.results_table import results_table


@pytest.fixture(scope="module")
def outcome(tmp_path_factory):
    """Return the outcome of a table with a faulty row, texts that could act as formulas, and blank own columns."""
    rows = [
        SOUND | {"variant": f"V{n}", "Our no.": n, "Customer": ["=1+1", 'a "b"\nc', "", "ä"][n % 4], "Never": ""}
        for n in range(11)
    ]
    rows[4]["torque_Nm"] = -1
    path = tmp_path_factory.mktemp("pieces") / "table.csv"
    keys = list(rows[0])
    cells = [keys, *([str(row[key]) for key in keys] for row in rows)]
    path.write_text("".join(",".join('"' + cell.replace('"', '""') + '"' for cell in row) + "\n" for row in cells))
    return run(path, samples=16, method="random")


def _joined(outcome, ending, size, folder):
    table = results_table(outcome)
    paths = []
    for start in range(0, table.height, size):
        paths.append(folder / f"{start}.piece")
        paths[-1].write_bytes(piece(table[start : start + size], ending))
    findings = {"findings": [found.as_dictionary() for found in outcome.findings]}
    file = io.BytesIO()
    used = _used_pieces(outcome, size, folder) if ending == ".json" else []
    joined(ending, paths, paths[0], table.columns, used=used, further=findings)(file)
    return file.getvalue()


def _used_pieces(outcome, size, folder):
    table, paths = used_tolerances(outcome.computed.values()), []
    assert table.height > 11
    for start in range(0, table.height, size):
        paths.append(folder / f"{start}.used")
        paths[-1].write_bytes(piece(table[start : start + size], ".json"))
    return paths


@pytest.mark.parametrize("ending", PIECES)
@pytest.mark.parametrize("size", [1, 3, 11])
def test_pieces_of_any_size_give_the_bytes_of_one(outcome, ending, size, tmp_path):
    """CSV, Parquet and JSON joined from pieces of 1, 3 or all rows have the bytes that they have in one piece."""
    assert _joined(outcome, ending, size, tmp_path) == outcome_bytes(outcome, ending)[0]


@pytest.mark.parametrize("ending", PIECES)
def test_a_blank_row_keeps_its_place(outcome, ending, tmp_path):
    """A row of which only texts are known stands among the others, blank in every other column of whatever kind."""
    table = results_table(outcome)
    known = {"variant": "", "status": "error", "findings": "E334 A4"}
    pieces = [piece(table[:2], ending), blank_piece(known, table.columns, ending), piece(table[3:], ending)]
    paths = [tmp_path / f"{number}.piece" for number in range(3)]
    for path, data in zip(paths, pieces, strict=True):
        path.write_bytes(data)
    joined_path = tmp_path / f"joined{ending}"
    with joined_path.open("wb") as file:
        joined(ending, paths, paths[0], table.columns, further={})(file)
    if ending == ".json":
        found = json.loads(joined_path.read_text(encoding="utf-8"))["results"]
    else:
        found = (pl.read_parquet if ending == ".parquet" else pl.read_csv)(joined_path).to_dicts()
    assert len(found) == table.height
    assert {key: value for key, value in found[2].items() if value not in {None, ""}} == {
        key: value for key, value in known.items() if value
    }
    assert found[3]["backlash_rad"] is not None
