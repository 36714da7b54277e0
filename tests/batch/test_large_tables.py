"""A large table computed in chunks gives what it gives in one piece, whatever happens to the processes meanwhile."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
import zipfile
from dataclasses import replace
from pathlib import Path

import openpyxl
import polars as pl
import pytest
from dask_cluster import dask_cluster
from filled import SOUND
from here import HereExecutor
from poisoned import POISON, lost_at_poison, lost_at_reading_poison

from flexlash.analysis.examination import tables_beside
from flexlash.analysis.options import Options
from flexlash.analysis.run_summary import worst_first
from flexlash.batch.chunk import compute_chunk
from flexlash.batch.compute import answer_of
from flexlash.batch.executor import WorkerLostError
from flexlash.batch.large_tables import LargeTable, large_table
from flexlash.batch.local_executor import local_executor
from flexlash.cli.recreation import recreate
from flexlash.comparison.difference import difference
from flexlash.comparison.difference_lines import difference_lines
from flexlash.comparison.sides import side_of
from flexlash.outputs.export_places import ExportPlaces
from flexlash.outputs.plan import Plan
from flexlash.pipeline import check, run
from flexlash.reading.limited_process import ProcessFaultError
from flexlash.reading.products import Companions
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.report.exports import exported_files
from flexlash.report.page.page_facts import Found, page_facts
from flexlash.report.report_data import report_data
from flexlash.schema.exit_codes import ExitCode
from flexlash.schema.stamps import stamp_at, stamped

FEW = {"samples": 16, "method": "random"}
"""Options with which a row costs next to nothing."""

ROWS = 60
SOURCE = {**os.environ, "PYTHONPATH": str(Path(__file__).resolve().parents[2] / "src")}


def _rows(count=ROWS, *, faulty=True):
    """Return rows that differ; among them, where wanted, every fault that looks beyond its own row."""
    rows = [
        SOUND
        | {
            "variant": f"V-{number}",
            "torque_Nm": 500 + 7 * number,
            "backlash_limit_arcmin": round(2.5 + number % 7 / 4, 2) if number % 4 == 0 else "",
            "Drawing": f"D{number % 5}",
            "Lot": number,
            "Mass [kg]": f"{number / 8}",
            "hub_fillet_radius_mm": 3 if number % 6 == 0 else "",
            "notes": '=1+1, "quoted"\nsecond line' if number == 11 else "",
        }
        for number in range(count)
    ]
    if faulty:
        rows[5]["torque_Nm"] = -1
        rows[8]["material"] = "20cr2ni4"
        rows[9]["material"] = "unknown steel"
        rows[13]["variant"] = "V-50"
        rows[17]["Mass [kg]"] = "heavy"
        rows[23]["wall_thickness_mm"] = 0.0016
        rows[31]["torque_Nm"] = "TBD"
        rows[44]["torque_Nm"] = 60_000
        rows[52] = dict.fromkeys(rows[52], "")
    return rows


def _written(path, rows):
    """Write rows as a text table or as Parquet under their keys."""
    if path.suffix == ".parquet":
        texts = {"variant", "flexspline_type", "material", "Drawing", "notes"}
        if rows[17]["Mass [kg]"] == "heavy":
            texts |= {"Mass [kg]"}
        columns = {
            key: [None if row[key] in {"", "TBD"} else (str if key in texts else float)(row[key]) for row in rows]
            for key in rows[0]
        }
        pl.DataFrame(columns).write_parquet(path, row_group_size=25)
        return path
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    return path


def _table(path, output=None, *, ran=True, copy=None, resume=False, **options):
    """Return a large table with places for its outputs, planned as the command line does."""
    chosen = Options.of("run()", FEW | options)
    plan = Plan(inputs=[path])
    return LargeTable(
        path=path,
        ran=ran,
        options=chosen,
        tables=tables_beside(chosen),
        companions=Companions.of(path, [path]),
        report=None if output is None else plan.claim(output, named=True),
        copy=None if copy is None else plan.claim(copy),
        resume=resume,
    )


def _in_chunks(path, output, rows, executor=None, **wanted):
    return large_table(_table(path, output, **wanted), executor or HereExecutor(), chunk_rows=rows)


def _names(folder):
    return sorted(path.name for path in folder.iterdir())


# The same as in one piece


@pytest.mark.parametrize("kind", [".csv", ".parquet"])
@pytest.mark.parametrize("ending", [".csv", ".parquet", ".json"])
def test_results_are_those_in_one_piece(kind, ending, tmp_path, monkeypatch):
    """CSV and Parquet in chunks of 7, 25 and all rows give the bytes of Results that one piece gives, faults included.

    JSON also counts its findings by rule. More variants than a report draws have no widths to relax or tighten to.
    """
    monkeypatch.setattr("flexlash.report.output.DRAWN", 10)
    path = _written(tmp_path / f"gears{kind}", _rows())
    whole = run(path, tmp_path / f"whole{ending}", **FEW)
    assert {found.level for found in whole.findings} == {"error", "warning", "info"}
    for rows in (7, 25, 1000):
        output = tmp_path / f"chunks-{rows}{ending}"
        answer, written = _in_chunks(path, output, rows)
        assert written.paths[0] == output
        if ending == ".json":
            found, expected = (json.loads(one.read_text(encoding="utf-8")) for one in (output, whole.outputs[0]))
            assert sum(found.pop("findings_by_rule").values()) == len(whole.findings)
            assert {**found, "stamp": ""} == {**expected, "stamp": ""}
        else:
            assert output.read_bytes() == whole.outputs[0].read_bytes()
        assert ending == ".csv" or stamp_at(output) == "results"
        told = whole.as_dictionary()
        assert {key: answer.told[key] for key in told if key != "outputs"} == {
            key: value for key, value in told.items() if key != "outputs"
        }
        assert answer.exit_code == whole.exit_code == ExitCode.SOME_ROWS


@pytest.mark.parametrize("kind", [".csv", ".parquet"])
def test_all_findings_stand_beside_the_results(kind, tmp_path):
    """A table beside Results has every finding in the order of the submission, whatever the chunks."""
    path = _written(tmp_path / f"gears{kind}", _rows())
    expected = [found.as_dictionary() for found in run(path, **FEW).findings]
    for rows in (7, 1000):
        _in_chunks(path, tmp_path / f"out-{rows}.csv", rows)
        with (tmp_path / f"out-{rows}-findings.csv").open(encoding="utf-8", newline="") as file:
            # A text that would act as a formula has an apostrophe before it.
            found = [{key: text.removeprefix("'") for key, text in row.items()} for row in csv.DictReader(file)]
        assert found == expected


def test_the_screen_says_the_same(tmp_path):
    """Counts, worst variants and the lines about findings are those of one piece, and depend on no chunk."""
    path = _written(tmp_path / "gears.csv", _rows())
    answers = [_in_chunks(path, tmp_path / f"{rows}.csv", rows)[0] for rows in (7, 1000)]
    lines = [
        [(level, line.replace(f"{rows}-findings.csv", "it")) for level, line in answer.finding_lines]
        for rows, answer in zip((7, 1000), answers, strict=True)
    ]
    assert lines[0] == lines[1]
    for name in ("words", "details", "worst", "by_rule", "exit_code"):
        assert getattr(answers[0], name) == getattr(answers[1], name), name
    expected = answer_of(run(path, **FEW), ran=True)
    for name in ("words", "details", "worst", "by_rule", "exit_code"):
        assert getattr(answers[0], name) == getattr(expected, name), name


def test_the_screen_tells_of_lots(tmp_path):
    """Of a variant over its limit the lots that fail are told as of one piece, angles in the unit that is asked for."""
    rows = [{**SOUND, "variant": f"v{number}", "backlash_limit_arcmin": 3.7 + number / 100} for number in range(9)]
    path = _written(tmp_path / "gears.csv", rows)
    answer, _ = _in_chunks(path, tmp_path / "out.csv", 4, angle_unit="arcsec")
    expected = answer_of(run(path, **FEW, angle_unit="arcsec"), ran=True)
    assert list(answer.details) == list(expected.details)
    assert "% of lots fail" in answer.details[1]
    assert "over 222″" in answer.details[1]


def test_cross_check_and_tables_beside(tmp_path):
    """Further columns, and Tolerances and Materials given beside the table, give the bytes of one piece.

    A chunk without a computed row has the further columns as well.
    """
    rows = _rows(20, faulty=False)
    for row in rows[7:14]:
        row["torque_Nm"] = "TBD"
    rows[3]["tolerance_class"], rows[4]["tolerance_class"] = "fine", "coarse"
    rows = [{"tolerance_class": "", **row} for row in rows]
    path = _written(tmp_path / "gears.csv", rows)
    tolerances, materials = tmp_path / "tolerances.csv", tmp_path / "materials.csv"
    tolerances.write_text(
        "tolerance_class,dimension,grade\nfine,wall_thickness,IT6\ncoarse,wall_thickness,IT99\nunused,torque,IT7\n"
    )
    materials.write_text("material,youngs_modulus_GPa,poisson_ratio\n20Cr2Ni4,211,0.3\n")
    options = FEW | {"cross_check": True, "tolerances": tolerances, "materials": materials}
    whole = run(path, tmp_path / "whole.csv", **options)
    answer, _ = _in_chunks(path, tmp_path / "chunks.csv", 7, **options)
    assert (tmp_path / "chunks.csv").read_bytes() == (tmp_path / "whole.csv").read_bytes()
    assert answer.told["findings"] == whole.as_dictionary()["findings"]
    assert answer.told["counts"] == whole.counts


def test_faults_that_stop_everything_beside_faults_that_stop_some(tmp_path):
    """Where a class is faulty and a fault stops every row as well, each is told once, with the rows that wait for it.

    Rows of a chunk wait for all faults, and for that of their class where it has some.
    """
    rows = [{"tolerance_class": "coarse" if row["Lot"] > 9 else "", **row} for row in _rows(18, faulty=False)]
    path = _written(tmp_path / "gears.csv", rows)
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(
        "tolerance_class,dimension,grade\ncoarse,wall_thickness,IT99\n,wall_thickness,IT7\nodd,torque,IT7\n"
    )
    whole = check(path, tolerances=tolerances)
    messages = [found.message for found in whole.findings if found.sheet == "Tolerances"]
    assert any("All rows of Variants wait" in message for message in messages)
    assert any("of Variants wait for class coarse" in message for message in messages)
    for size in (5, 1000):
        answer, _ = _in_chunks(path, None, size, ran=False, tolerances=tolerances)
        assert answer.told["findings"] == whole.as_dictionary()["findings"]
        assert answer.told["counts"] == whole.counts


# What comes out


def test_a_report_of_the_worst_with_everything_beside(tmp_path, monkeypatch):
    """A report holds the worst rows; Results and findings of all rows lie beside it under its submission's name."""
    path = _written(tmp_path / "gears.csv", _rows())
    monkeypatch.setattr("flexlash.batch.chunk_computing.DRAWN", 10)
    monkeypatch.setattr("flexlash.batch.chunk_totals.DRAWN", 10)
    report = tmp_path / "gears-report.xlsx"
    answer, written = _in_chunks(path, report, 7, copy=tmp_path / "gears-checked.xlsx")
    beside = ["gears-report.xlsx", "gears-results.parquet", "gears-findings.csv", "gears-checked.xlsx"]
    assert [one.name for one in written.paths] == beside
    assert _names(tmp_path) == sorted([*beside, "gears.csv"])
    whole = run(path, tmp_path / "whole.parquet", **FEW)
    assert (tmp_path / "gears-results.parquet").read_bytes() == (tmp_path / "whole.parquet").read_bytes()
    assert [stamp_at(tmp_path / name) for name in beside[:2]] == ["report", "results"]
    text = zipfile.ZipFile(report).read("xl/sharedStrings.xml").decode()
    assert "gears-results.parquet" in text
    for row in worst_first(whole)[:10]:
        assert f">{row['variant']}<" in text
    assert f">{worst_first(whole)[12]['variant']}<" not in text
    assert answer.told["counts"] == whole.counts


def test_samples_and_pictures_are_those_of_the_worst(tmp_path, monkeypatch):
    """They are those that the worst rows have when all are computed at once, whatever the chunks; words say so."""
    path = _written(tmp_path / "gears.csv", _rows())
    whole = run(path, **FEW)
    for module in ("batch.chunk_computing", "batch.chunk_totals", "report.exports"):
        monkeypatch.setattr(f"flexlash.{module}.DRAWN", 10)
    monkeypatch.setattr("flexlash.report.exports._COMPARED", 10)
    known = {file.name: file.data for file in exported_files(whole, samples=True, pictures=True)}
    for rows in (7, 40):
        plain = _table(path, tmp_path / f"report-{rows}.parquet")
        folders = {kind: tmp_path / f"{kind}-{rows}" for kind in ("samples", "pictures")}
        for folder in folders.values():
            folder.mkdir()
        places = ExportPlaces(plan=plain.report.plan, folders=folders, stem="gears")
        answer, written = large_table(replace(plain, exports=places), HereExecutor(), chunk_rows=rows)
        exported = [one for one in written.paths if one.parent != tmp_path]
        found = {one.name.removeprefix("gears"): one.read_bytes() for one in exported}
        assert found == {name: stamped(data, ROLES[name[-3:]]) for name, data in known.items()}
        assert any("the 10 worst of" in line for line in answer.details)


ROLES = {"uet": "distribution", "svg": "picture", "png": "picture"}


def test_a_report_of_the_worst_says_so_wherever_it_is_read(tmp_path, monkeypatch):
    """A comparison of reports of the worst rows says of each what is not compared, one made anew from it as well."""
    path = _written(tmp_path / "gears.csv", _rows(18, faulty=False))
    monkeypatch.setattr("flexlash.batch.chunk_computing.DRAWN", 10)
    monkeypatch.setattr("flexlash.batch.chunk_totals.DRAWN", 10)
    report, anew = tmp_path / "gears-report.xlsx", tmp_path / "anew.xlsx"
    _in_chunks(path, report, 7)
    recreate(report, anew)
    found = difference(*(side_of(one, ReadingLimits()) for one in (report, anew)))
    assert list(difference_lines(found)) == [
        "gears-report.xlsx carries the 10 worst of 18 rows; the others are not compared.",
        "anew.xlsx carries the 10 worst of 18 rows; the others are not compared.",
        "No difference in inputs or results.",
    ]
    assert found.as_dictionary()["old"]["worst_of"] == 18


@pytest.mark.long
@pytest.mark.slow
def test_a_report_of_rows_beyond_a_worksheet_is_made_anew(tmp_path):
    """Of a table longer than any worksheet a report can be made anew: its rows then stand close below each other."""
    path = _written(tmp_path / "gears.csv", _rows(18, faulty=False))
    header, rows = path.read_text(encoding="utf-8").split("\n", 1)
    path.write_text(f"{header}\n{1_050_000 * chr(10)}{rows}", encoding="utf-8", newline="")
    report = tmp_path / "gears-report.xlsx"
    _in_chunks(path, report, 2_000_000)
    found = recreate(report, tmp_path / "anew.xlsx")
    assert (found.outcome.counts["computed"], found.different) == (18, 0)
    assert any("these rows stand close below each other" in remark for remark in found.remarks)
    sheet = openpyxl.load_workbook(found.outcome.outputs[0])["Variants"]
    names = [row[0] for row in sheet.iter_rows(values_only=True, max_row=40)]
    assert [name for name in names if str(name).startswith("V-")] == [f"V-{number}" for number in range(18)]


def test_the_report_does_not_depend_on_the_chunks(tmp_path):
    """Report, Results, findings and the workbook of findings have the same bytes for any size of the chunks."""
    path = _written(tmp_path / "gears.csv", _rows())
    made = []
    for rows in (7, 1000):
        folder = tmp_path / f"chunks-{rows}"
        folder.mkdir()
        _in_chunks(path, folder / "gears-report.xlsx", rows, copy=folder / "gears-checked.xlsx")
        made.append({one.name: one.read_bytes() for one in folder.iterdir()})
    assert made[0] == made[1]
    assert len(made[0]) == 4


def test_findings_beyond_the_first_thousand(tmp_path, monkeypatch):
    """Of many findings the first are told one by one, all are counted, and the workbook says where the others are."""
    for module in ("chunk_computing", "chunk_totals"):
        monkeypatch.setattr(f"flexlash.batch.{module}.FIRST_FINDINGS", 10)
    rows = _rows(40, faulty=False)
    for row in rows[::2]:
        row["torque_Nm"] = -1
    path = _written(tmp_path / "gears.csv", rows)
    whole = run(path, **FEW)
    answer, written = _in_chunks(path, tmp_path / "out.json", 7, copy=tmp_path / "out-checked.xlsx")
    assert answer.told["findings"] == whole.as_dictionary()["findings"][:10]
    assert answer.told["counts"] == whole.counts
    assert answer.by_rule["E207"] == 20
    assert json.loads((tmp_path / "out.json").read_text(encoding="utf-8"))["findings"] == answer.told["findings"]
    sheet = openpyxl.load_workbook(written.marked_copy).active
    text = "\n".join(str(cell) for row in sheet.iter_rows(values_only=True) for cell in row if cell)
    assert "The first 10 findings of gears.csv are listed here; all of them are in out-findings.csv" in text
    assert "gears.csv has 20 errors" in text
    assert text.count("E207") == sum(found["code"] == "E207" for found in answer.told["findings"])


def test_strict_computes_nothing_when_a_row_is_wrong(tmp_path):
    """With --strict one error in a late chunk keeps all rows from being computed, as in one piece."""
    rows = _rows(30, faulty=False)
    sound, faulty = tmp_path / "sound.csv", tmp_path / "faulty.csv"
    _written(sound, rows)
    rows[28]["torque_Nm"] = -1
    _written(faulty, rows)
    answer, written = _in_chunks(faulty, tmp_path / "out.csv", 7, strict=True)
    assert (answer.exit_code, answer.told["counts"]["computed"]) == (ExitCode.NOTHING, 0)
    assert [one.name for one in written.paths] == ["out-findings.csv"]
    answer, _ = _in_chunks(faulty, None, 7, ran=False, strict=True)
    assert (answer.exit_code, answer.words.partition(";")[0]) == (ExitCode.NOTHING, "0 of 30 rows ready")
    answer, _ = _in_chunks(sound, tmp_path / "good.csv", 7, strict=True)
    assert (answer.exit_code, answer.told["counts"]["computed"]) == (ExitCode.FINE, 30)
    assert (tmp_path / "good.csv").read_bytes() == run(sound, tmp_path / "w.csv", **FEW).outputs[0].read_bytes()


def test_check_writes_nothing_unless_asked(tmp_path):
    """`check` finds what it finds in one piece; a workbook of findings, and all of them beside, only where wanted."""
    path = _written(tmp_path / "gears.csv", _rows())
    answer, written = _in_chunks(path, None, 7, ran=False)
    whole = check(path)
    assert answer.told["findings"] == whole.as_dictionary()["findings"]
    assert answer.told["counts"] == whole.counts
    assert (written.paths, _names(tmp_path)) == ((), ["gears.csv"])
    _, written = _in_chunks(path, None, 7, ran=False, copy=tmp_path / "gears-checked.xlsx")
    assert [one.name for one in written.paths] == ["gears-findings.csv", "gears-checked.xlsx"]


def test_a_workbook_of_findings_that_cannot_be_written_loses_nothing_else(tmp_path):
    """Where the marked copy cannot be written the table is checked or computed all the same, and the fault is told."""
    path = _written(tmp_path / "gears.csv", _rows())
    for ran, report in ((False, None), (True, tmp_path / "out.csv")):
        answer, written = _in_chunks(path, report, 25, ran=ran, copy=tmp_path / "none" / "gears-checked.xlsx")
        assert answer.told["counts"]["rows"] == ROWS - 1
        assert "there is no folder" in written.fault.strerror
        assert [one.name for one in written.paths] == (["out.csv", "out-findings.csv"] if ran else [])


@pytest.mark.parametrize("what", ["header", "results", "findings"])
def test_what_is_no_submission_ends_like_any_other(what, tmp_path):
    """A table without headers, and what flexlash itself wrote, are refused or skipped in the same words."""
    path = tmp_path / "gears.csv"
    if what == "header":
        path.write_text("a,b\n" + "1,2\n" * 50)
    else:
        _in_chunks(_written(tmp_path / "source.csv", _rows()), tmp_path / "results.csv", 25)
        path = tmp_path / {"results": "results.csv", "findings": "results-findings.csv"}[what]
    before = _names(tmp_path)
    expected = check(path)
    answer, written = _in_chunks(path, tmp_path / "out.csv", 7)
    assert answer.told["findings"] == expected.as_dictionary()["findings"]
    assert (answer.skipped, answer.exit_code) == (expected.skipped, expected.exit_code)
    assert written.paths == ((tmp_path / "out-findings.csv",) if what == "header" else ())
    assert [name for name in _names(tmp_path) if name != "out-findings.csv"] == before


def test_nothing_of_the_users_is_overwritten(tmp_path):
    """Files of the user's that have the names of outputs stay; the outputs get a number, which the report names."""
    path = _written(tmp_path / "gears.csv", _rows())
    for name in ("gears-results.parquet", "gears-findings.csv"):
        (tmp_path / name).write_bytes(b"mine")
    _, written = _in_chunks(path, tmp_path / "gears-report.xlsx", 25)
    assert [one.name for one in written.paths] == [
        "gears-report.xlsx", "gears-results (2).parquet", "gears-findings (2).csv",
    ]  # fmt: skip
    assert len(written.remarks) == 2
    text = zipfile.ZipFile(tmp_path / "gears-report.xlsx").read("xl/sharedStrings.xml").decode()
    assert "gears-results (2).parquet" in text
    assert (tmp_path / "gears-results.parquet").read_bytes() == b"mine"


def test_progress_is_told_in_rows(tmp_path):
    """Progress rises in rows and ends with all of them."""
    path = _written(tmp_path / "gears.csv", _rows(30, faulty=False))
    told = []
    large_table(_table(path, tmp_path / "out.csv"), HereExecutor(), lambda *steps: told.append(steps), chunk_rows=7)
    assert told == [(7, 30), (14, 30), (21, 30), (28, 30), (30, 30)]


# What happens meanwhile


@pytest.mark.parametrize("how", ["altered", "longer"])
def test_a_table_that_changes_between_the_passes_is_refused(how, tmp_path):
    """A table whose rows are changed after its survey is refused with a sentence; nothing of it is written or kept."""
    path = _written(tmp_path / "gears.csv", _rows(40, faulty=False))

    def change(*_):
        text = path.read_text(encoding="utf-8")
        path.write_text(text.replace("V-39", "W-39") if how == "altered" else text + text.splitlines()[-1] + "\n")

    answer, written = large_table(_table(path, tmp_path / "out.csv"), HereExecutor(), change, chunk_rows=7)
    (found,) = answer.told["findings"]
    assert "gears.csv cannot be read as a submission: it has changed since its first reading" in found["message"]
    assert (answer.refused, answer.exit_code, written.paths) == (True, ExitCode.NOTHING, ())
    assert _names(tmp_path) == ["gears.csv"]


def test_a_table_that_changes_before_its_report_is_refused(tmp_path):
    """Once all rows are computed, those of the report are asked for before anything is written."""
    path = _written(tmp_path / "gears.csv", _rows(20, faulty=False))

    def change(done, total):
        if done == total:
            path.write_text(path.read_text(encoding="utf-8").replace("V-1", "W-1"), encoding="utf-8")

    answer, written = large_table(_table(path, tmp_path / "out.xlsx"), HereExecutor(), change, chunk_rows=7)
    assert (answer.refused, answer.exit_code, written.paths) == (True, ExitCode.NOTHING, ())
    assert _names(tmp_path) == ["gears.csv"]


@pytest.mark.slow
@pytest.mark.limited_process
def test_one_worker_or_two(tmp_path):
    """One worker process, two, and this process alone give the same bytes."""
    path = _written(tmp_path / "gears.parquet", _rows())
    made = []
    for workers in (0, 1, 2):
        folder = tmp_path / f"by-{workers}"
        folder.mkdir()
        if workers:
            with local_executor(workers) as executor:
                _in_chunks(path, folder / "gears-report.xlsx", 9, executor)
        else:
            _in_chunks(path, folder / "gears-report.xlsx", 9)
        made.append({one.name: one.read_bytes() for one in folder.iterdir()})
    assert made[0] == made[1] == made[2]


@pytest.mark.slow
@pytest.mark.limited_process
@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
@pytest.mark.parametrize(("work", "ending"), [(lost_at_poison, ".csv"), (lost_at_reading_poison, ".parquet")])
def test_a_row_that_stops_its_process_is_found(work, ending, tmp_path):
    """A row that kills every process that computes it keeps its place without numbers; all others are computed.

    Where it kills those that merely read it as well, nothing is known of it but its place.
    """
    rows = _rows(12, faulty=False)
    sound = run(_written(tmp_path / "sound.csv", rows), **FEW).results
    rows[7]["variant"] = POISON
    path = _written(tmp_path / "gears.csv", rows)
    output = tmp_path / f"out{ending}"
    with local_executor(2) as executor:
        answer, _ = large_table(_table(path, output), executor, chunk_rows=2, work=work)
    results = pl.read_csv(output) if ending == ".csv" else pl.read_parquet(output)
    assert answer.told["counts"] | {"warnings": 0} == {
        **answer.told["counts"], "rows": 12, "computed": 11, "errors": 1, "warnings": 0,
    }  # fmt: skip
    (error,) = (one for one in answer.told["findings"] if one["level"] == "error")
    assert (error["code"], error["cell"]) == ("E334", "A9")
    row = results.row(7, named=True)
    assert (row["status"], row["findings"], row["backlash_rad"]) == ("error", "E334 A9", None)
    assert (row["variant"] or "") == (POISON if work is lost_at_poison else "")
    kept = [number for number in range(12) if number != 7]
    assert results[kept]["p99_865_arcmin"].to_list() == sound[kept]["p99_865_arcmin"].to_list()
    assert answer.exit_code == ExitCode.SOME_ROWS


def test_workers_that_are_always_lost_end_the_run(tmp_path, monkeypatch):
    """Where every row stops its process the fault is not the rows': the run ends soon, and what was done is kept."""
    monkeypatch.setattr("flexlash.batch.large_tables._MOST_LOST", 3)
    path = _written(tmp_path / "gears.csv", _rows(40, faulty=False))
    asked = []

    def lost(data):
        asked.append(data)
        if len(asked) > 1:
            raise WorkerLostError("a worker process was stopped 3 times")
        return compute_chunk(data)

    with pytest.raises(ProcessFaultError, match="more than 3 rows"):
        large_table(_table(path, tmp_path / "out.csv"), HereExecutor(), chunk_rows=10, work=lost)
    assert len(asked) < 30
    _in_chunks(path, tmp_path / "out.csv", 10, resume=True)
    assert (tmp_path / "out.csv").read_bytes() == run(path, tmp_path / "w.csv", **FEW).outputs[0].read_bytes()


_DRIVER = """
import json, sys
from pathlib import Path
from flexlash.analysis.options import Options
from flexlash.batch.chunk import compute_chunk
from flexlash.batch.executor import WorkerLostError
from flexlash.batch.large_tables import LargeTable, large_table
from flexlash.batch.local_executor import local_executor
from flexlash.outputs.plan import Plan

path, output, resume = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3] == "resume"
if __name__ == "__main__":
    told = []
    if len(sys.argv) > 4:
        import resource
        resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[4]), int(sys.argv[4])))
    with local_executor(2) as executor:
        def advance(done, total):
            told.append(done)
            print(done, flush=True)
        options = Options(samples=16, method="random")
        plan = Plan(inputs=[path])
        table = LargeTable(path=path, ran=True, options=options, report=plan.claim(output, named=True), resume=resume)
        try:
            large_table(table, executor, advance, chunk_rows=6)
        except OSError as fault:
            print("fault", fault.strerror, flush=True)
    print("end", flush=True)
"""


def _driver(folder, path, output, *arguments):
    script = folder / "driver.py"
    script.write_text(_DRIVER)
    command = [sys.executable, str(script), str(path), str(output), *map(str, arguments)]
    return subprocess.Popen(command, env=SOURCE, stdout=subprocess.PIPE, text=True)


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_a_killed_run_is_resumed(tmp_path):
    """Killed at several moments, a run that resumes does what is left alone and ends with the same bytes.

    No process is left, and only whole outputs.
    """
    folder = tmp_path / "tables"
    folder.mkdir()
    path = _written(folder / "gears.csv", _rows())
    expected = run(path, tmp_path / "whole.parquet", **FEW).outputs[0].read_bytes()
    output = folder / "gears-report.xlsx"
    _in_chunks(path, tmp_path / "gears-report.xlsx", 6)
    report = (tmp_path / "gears-report.xlsx").read_bytes()
    done = 0
    for chunks in (1, 3, 6):
        with _driver(tmp_path, path, output, "resume") as process:
            lines = [process.stdout.readline() for _ in range(chunks)]
            process.send_signal(signal.SIGKILL)
        assert int(lines[-1]) >= done
        assert _names(folder) == [".gears-report.xlsx.flexlash-parts", "gears.csv"]
        manifest = folder / ".gears-report.xlsx.flexlash-parts" / "manifest.jsonl"
        kept = len(manifest.read_bytes().splitlines()) - 1
        assert kept >= chunks
        done = kept
    with _driver(tmp_path, path, output, "resume") as process:
        told = process.stdout.read().split()
    assert told[-1] == "end"
    assert _names(folder) == ["gears-findings.csv", "gears-report.xlsx", "gears-results.parquet", "gears.csv"]
    assert (folder / "gears-results.parquet").read_bytes() == expected
    assert output.read_bytes() == report


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="POSIX limits of a process")
def test_a_full_disk_loses_nothing(tmp_path):
    """When no more can be written the fault is told, no half output is there, and a resumed run ends as any other."""
    folder = tmp_path / "tables"
    folder.mkdir()
    path = _written(folder / "gears.csv", _rows())
    expected = run(path, tmp_path / "whole.csv", **FEW).outputs[0].read_bytes()
    output = folder / "out.csv"
    with _driver(tmp_path, path, output, "anew", 40_000) as process:
        told = process.stdout.read().splitlines()
    assert told[-2] == "fault the file becomes larger than this system allows"
    assert _names(folder) == [".out.csv.flexlash-parts", "gears.csv"]
    with _driver(tmp_path, path, output, "resume") as process:
        assert process.stdout.read().split()[-1] == "end"
    assert output.read_bytes() == expected
    assert ".out.csv.flexlash-parts" not in _names(folder)


@pytest.mark.slow
@pytest.mark.limited_process
@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_killed_workers_lose_nothing(tmp_path):
    """Workers that are killed while they compute cost time alone: the same bytes come out."""
    path = _written(tmp_path / "gears.csv", _rows())
    expected = run(path, tmp_path / "whole.csv", **FEW).outputs[0].read_bytes()
    killed = []

    def kill(*_):
        workers = [int(one) for one in _children(os.getpid())]
        if workers and len(killed) < 3:
            killed.append(workers[-1])
            os.kill(workers[-1], signal.SIGKILL)
            time.sleep(0.05)

    with local_executor(2) as executor:
        large_table(_table(path, tmp_path / "out.csv"), executor, kill, chunk_rows=6)
    assert len(killed) == 3
    assert (tmp_path / "out.csv").read_bytes() == expected


def _children(number):
    """Return the processes that a process has started and that compute, newest last."""
    listed = subprocess.run(
        ["ps", "-ww", "-o", "pid=,args=", "--ppid", str(number)], capture_output=True, text=True, check=False
    )
    return [line.split()[0] for line in listed.stdout.splitlines() if "spawn_main" in line]


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_over_dask_with_a_worker_and_then_the_scheduler_killed(tmp_path):
    """Over Dask a killed worker costs time alone; of a killed scheduler a resumed run makes the same bytes."""
    pytest.importorskip("distributed")
    from flexlash.batch.dask_executor import ClusterError, dask_executor

    folder = tmp_path / "tables"
    folder.mkdir()
    path = _written(folder / "gears.csv", _rows())
    expected = run(path, tmp_path / "whole.csv", **FEW).outputs[0].read_bytes()
    output, told = folder / "out.csv", []
    with dask_cluster(tmp_path) as cluster:
        victim, _ = cluster.worker("--no-nanny"), cluster.worker()

        def disturb(done, _):
            told.append(done)
            if len(told) == 2:
                victim.kill()
            if len(told) == 5:
                cluster.scheduler.kill()

        with dask_executor(cluster.address) as executor, pytest.raises(ClusterError):
            large_table(_table(path, output), executor, disturb, chunk_rows=6)
    assert 5 <= len(told) < 10
    assert _names(folder) == [".out.csv.flexlash-parts", "gears.csv"]
    large_table(_table(path, output, resume=True), HereExecutor(), chunk_rows=6)
    assert output.read_bytes() == expected
    assert _names(folder) == ["gears.csv", "out-findings.csv", "out.csv"]


def _page(path, output, *, ran=True):
    """Return the answer to a table of which a page is wanted, and what that shows."""
    answer, _ = large_table(replace(_table(path, output, ran=ran), pages=True), HereExecutor(), chunk_rows=7)
    return answer, json.loads(answer.page)


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize("ending", [".csv", ".parquet"])
def test_the_page_of_chunks_is_that_of_one_piece(ending, tmp_path):
    """Cards with their cells, counts, chart, table and pages of variants are equal, though nobody held all rows."""
    path = _written(tmp_path / f"table{ending}", _rows())
    answer, told = _page(path, tmp_path / "out.csv")
    outcome = run(path, **FEW)
    whole = page_facts(outcome, Found.of(outcome, ran=True, fixes=()), ran=True, data=report_data(outcome))
    for key in ("name", "sha256", "counts", "state", "cells_to_fix", "verdict_tiles", "computed", "table", "findings"):
        assert told[key] == whole[key], key
    assert (told["chart"], told["lost_in_all"]) == (whole["chart"], whole["lost_in_all"])
    for mine, theirs in zip(told["variants"], whole["variants"], strict=True):
        assert {**mine, "findings": []} == {**theirs, "findings": []}
    assert [card["code"] for card in told["cards"]] == [card["code"] for card in whole["cards"]]
    for mine, theirs in zip(told["cards"], whole["cards"], strict=True):
        assert mine == theirs, mine["code"]
    assert sum(rule.cells for rule in answer.rules) == sum(card["cells"] or card["count"] for card in whole["cards"])


@pytest.mark.slow
def test_the_page_of_a_large_table_counts_findings_that_it_does_not_tell(tmp_path, monkeypatch):
    """However few findings travel, each card has the number and the places of all of its rule."""
    path = _written(tmp_path / "table.csv", _rows())
    _, every = _page(path, None, ran=False)
    for module in ("chunk_computing", "chunk_totals"):
        monkeypatch.setattr(f"flexlash.batch.{module}.FIRST_FINDINGS", 2)
    _, few = _page(path, None, ran=False)
    for key in ("code", "count", "cells", "places"):
        assert [card[key] for card in few["cards"]] == [card[key] for card in every["cards"]], key
    assert (few["findings"], few["cells_to_fix"]) == (every["findings"], every["cells_to_fix"])


@pytest.mark.slow
def test_a_large_table_that_is_checked_has_a_page(tmp_path):
    """Without a spread there are its findings, and nothing that was not asked for."""
    path = _written(tmp_path / "table.csv", _rows())
    answer, told = _page(path, None, ran=False)
    outcome = check(path)
    whole = page_facts(outcome, Found.of(outcome, ran=False, fixes=()), ran=False)
    assert (told["ran"], told["variants"], told["table"]) == (False, [], [])
    assert [card["count"] for card in told["cards"]] == [card["count"] for card in whole["cards"]]
    assert told["state"] == whole["state"] == answer.words
