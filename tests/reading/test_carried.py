"""What a report carries was written by whoever sent it: nonsense there is one refusal, never a failure."""

from __future__ import annotations

import contextlib
import copy
import json
import math

import openpyxl
import pytest
import regenerate
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from openpyxl.packaging.custom import StringProperty

from flexlash.pipeline import check, run
from flexlash.reading.carried import FORM, carried_changes, carried_submission
from flexlash.reading.limited_process import ask
from flexlash.reading.read import Source, limits_of_reports, report_of
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.report.carried_sheet import carried_text
from flexlash.schema.findings import finding

STUDY = regenerate.ROOT / "data" / "b3-160-study.xlsx"
GOOD = json.loads(carried_text(check(STUDY)))
FIRST = ("cells", "sheets", 0)


def _changed(path, value):
    """Return the carried text's content with one place of it replaced."""
    found = copy.deepcopy(GOOD)
    place = found
    for step in path[:-1]:
        place = place[step]
    place[path[-1]] = value
    return found


def _refused(found, limits=None):
    with pytest.raises(Refusal) as refusal:
        carried_submission(found, limits or ReadingLimits())
    finding(refusal.value.code, **{"file": "r.xlsx", **refusal.value.facts})
    return refusal.value


def test_what_is_sound_is_taken():
    """Unchanged, the content is a submission; so the cases below fail by their change alone."""
    assert carried_submission(GOOD, ReadingLimits()).name == STUDY.name


def test_a_report_of_before_the_target_was_an_option_is_taken():
    """Without target_percent among its options a report leaves it to the settings that it carries."""
    options = {name: value for name, value in GOOD["options"].items() if name != "target_percent"}
    found = carried_submission(_changed(("options",), options), ReadingLimits())
    assert "target_percent" not in found.run_with


WRONG = {
    "no object": ((), [1]),
    "name a number": (("submission", "name"), 7),
    "name empty": (("submission", "name"), ""),
    "name endless": (("submission", "name"), "n" * 256),
    "digest short": (("submission", "sha256"), "12"),
    "digest no text": (("submission", "sha256"), None),
    "kind unknown": (("submission", "kind"), "refused"),
    "kind a list": (("submission", "kind"), []),
    "worst of a text": (("submission", "worst_of"), "9"),
    "seed a text": (("options", "seed"), "0"),
    "seed true": (("options", "seed"), True),
    "seed negative": (("options", "seed"), -1),
    "seed huge": (("options", "seed"), 2**64),
    "method unknown": (("options", "method"), "guess"),
    "method a list": (("options", "method"), []),
    "unit unknown": (("options", "angle_unit"), "degrees"),
    "samples 0": (("options", "samples"), 0),
    "samples a fraction": (("options", "samples"), 1.5),
    "a switch between": (("options", "strict"), 1),
    "target a text": (("options", "target_percent"), "99"),
    "target true": (("options", "target_percent"), True),
    "target no number": (("options", "target_percent"), math.nan),
    "target of all": (("options", "target_percent"), 100),
    "options absent": (("options",), {}),
    "role a number": (("cells", "role"), 1),
    "modified no date": (("cells", "modified"), "yesterday"),
    "modified elsewhere": (("cells", "modified"), "2026-01-01T00:00:00+02:00"),
    "sheets a text": (("cells", "sheets"), "abc"),
    "sheet name a number": ((*FIRST, "name"), 1),
    "sheet name empty": ((*FIRST, "name"), ""),
    "row a text": ((*FIRST, "rows"), [["1", []]]),
    "row 0": ((*FIRST, "rows"), [[0, []]]),
    "row beyond": ((*FIRST, "rows"), [[1_048_577, []]]),
    "rows out of order": ((*FIRST, "rows"), [[2, []], [1, []]]),
    "row true": ((*FIRST, "rows"), [[True, []]]),
    "column beyond": ((*FIRST, "rows"), [[1, [[16_385, "x"]]]]),
    "column a fraction": ((*FIRST, "rows"), [[1, [[1.5, "x"]]]]),
    "value an object": ((*FIRST, "rows"), [[1, [[1, {}]]]]),
    "value nothing": ((*FIRST, "rows"), [[1, [[1, None]]]]),
    "value of no kind": ((*FIRST, "rows"), [[1, [[1, ["code", "x"]]]]]),
    "value without content": ((*FIRST, "rows"), [[1, [[1, ["date"]]]]]),
    "an error of numbers": ((*FIRST, "rows"), [[1, [[1, ["error", 5]]]]]),
    "no percentage": ((*FIRST, "rows"), [[1, [[1, ["percentage", "nan"]]]]]),
    "a duration without end": ((*FIRST, "rows"), [[1, [[1, ["duration", "1e300"]]]]]),
    "hidden a text": ((*FIRST, "hidden"), "no"),
    "hidden rows texts": ((*FIRST, "hidden_rows"), ["1"]),
    "merged of three": ((*FIRST, "merged"), [[1, 2, 3]]),
    "manner a text": ((*FIRST, "manner"), "csv"),
    "manner with more": ((*FIRST, "manner"), {"delimiter": ";", "encoding": "", "file": "", "more": 1}),
    "manner of no sign": ((*FIRST, "manner"), {"delimiter": "xx", "encoding": "", "file": ""}),
    "manner nowhere": ((*FIRST, "manner"), {"delimiter": ";", "encoding": "", "comma_number": [0, 1]}),
    "numbers perhaps texts": ((*FIRST, "numbers_are_texts"), 1),
    "form a text": (("form",), "new"),
    "form 0": (("form",), 0),
}


@pytest.mark.parametrize("what", WRONG)
def test_nonsense_is_refused(what):
    """Whatever is not as reading yields it refuses the whole, with the same code."""
    path, value = WRONG[what]
    assert _refused(_changed(path, value) if path else value).code == "E122"


def test_changes_are_texts_by_variant():
    """The cheapest changes that a report tells are taken as they are; without any there are none."""
    assert carried_changes(GOOD) == {}
    assert carried_changes(GOOD | {"changes": {"a": "Hub radius 40 → 46 mm"}}) == {"a": "Hub radius 40 → 46 mm"}
    for changes in ([], "text", None, {"a": 1}, {"a": "x" * 256}):
        with pytest.raises(Refusal) as refusal:
            carried_changes(GOOD | {"changes": changes})
        assert refusal.value.code == "E122"


KEYS = st.sampled_from(["form", "version", "submission", "options", "cells", "sheets", "rows", "name"])
thorough = settings(deadline=None, derandomize=True, max_examples=60, suppress_health_check=[HealthCheck.too_slow])

VALUES = st.none() | st.booleans() | st.floats() | st.text()


@pytest.mark.slow
@thorough
@given(st.recursive(VALUES, lambda one: st.lists(one) | st.dictionaries(KEYS, one)))
def test_any_nonsense_is_refused(found):
    """No JSON text whatever raises anything but a refusal."""
    assert _refused(found).code == "E122"


@pytest.mark.slow
@thorough
@given(st.data())
def test_any_place_replaced_by_anything(data):
    """One part of a sound text replaced by anything gives a submission or a refusal, nothing else."""
    path: list = []
    place = GOOD
    while isinstance(place, dict | list) and place and (not path or data.draw(st.booleans())):
        keys = sorted(place) if isinstance(place, dict) else range(len(place))
        path.append(data.draw(st.sampled_from(list(keys))))
        place = place[path[-1]]
    value = data.draw(st.none() | st.booleans() | st.integers() | st.floats() | st.text() | st.lists(st.integers()))
    with contextlib.suppress(Refusal):
        carried_submission(_changed(path, value), ReadingLimits())


def test_a_later_form_says_so():
    """What a later flexlash wrote is refused by its version."""
    refusal = _refused(_changed(("form",), FORM + 1) | {"version": "9.9"})
    assert "9.9" in refusal.facts["found"]


def test_two_sheets_of_one_name():
    """Two sheets of one name, of which one would be lost, are refused."""
    assert _refused(_changed(("cells", "sheets"), [GOOD["cells"]["sheets"][0]] * 2)).code == "E122"


@pytest.mark.parametrize("limit", ["cells", "sheets"])
def test_limits_hold_for_what_is_carried(limit):
    """A report cannot carry more than a submission may hold."""
    refusal = _refused(GOOD, ReadingLimits(**{limit: 1}))
    assert (refusal.code, refusal.facts["setting"]) == ("E110", limit)


def _book(folder, sheets, role="report"):
    book = openpyxl.Workbook()
    book.active.title = "Summary"
    for name, texts in sheets.items():
        sheet = book.create_sheet(name)
        for row, text in enumerate(texts, start=1):
            sheet.cell(row, 1, text)
    if role:
        book.custom_doc_props.append(StringProperty(name="flexlash", value=role))
    book.save(folder / "r.xlsx")
    return folder / "r.xlsx"


FILES = {
    "an older report": ({}, "report", "E121"),
    "a workbook": ({}, "", "E120"),
    "a template": ({"Variants": ["Variant"]}, "template", "E120"),
    "no text": ({"Carried": []}, "report", "E122"),
    "half a text": ({"Carried": ["{", '"form": 1']}, "report", "E122"),
    "deep": ({"Carried": ["[" * 30_000, "]" * 30_000]}, "report", "E122"),
    "a number of many digits": ({"Carried": ['{"form": ' + "9" * 20_000 + "}"]}, "report", "E122"),
}


@pytest.mark.parametrize("what", FILES)
def test_files_that_carry_nothing(what, tmp_path):
    """Each kind of file that carries no submission says which it is, and nothing is computed."""
    sheets, role, code = FILES[what]
    outcome = run(_book(tmp_path, sheets, role), tmp_path / "out.xlsx", from_report=True)
    assert [found.code for found in outcome.findings] == [code]
    assert outcome.exit_code == 4
    assert not (tmp_path / "out.xlsx").exists()


def test_a_table_is_no_report(table, sound):
    """A table is refused without starting anything."""
    outcome = check(table([sound]), from_report=True)
    assert [found.code for found in outcome.findings] == ["E120"]


def _read(path, limits=None):
    limits = limits or ReadingLimits()
    return ask(report_of, limits_of_reports(limits), Source.at(path, limits), limits)


@pytest.mark.slow
@pytest.mark.limited_process
def test_the_limited_process_reads_the_report(tmp_path):
    """A report comes through the limited process with its Results; a text that fills its memory is refused there."""
    run(STUDY, tmp_path / "good.xlsx", samples=64)
    report = _read(tmp_path / "good.xlsx")
    assert (report.submission.name, len(report.results.rows)) == (STUDY.name, 13)
    path = _book(tmp_path, {"Carried": ["[" + "[]," * 9_999, *["[]," * 9_999] * 2_000, "[]]"]})
    with pytest.raises(Refusal) as refusal:
        _read(path, ReadingLimits(memory_mebibytes=300))
    assert refusal.value.code in {"E110", "E122"}


@pytest.mark.slow
def test_a_report_may_hold_more_than_a_submission(tmp_path):
    """A report has its results beside the submission: four times as many cells and seconds are allowed for it."""
    run(STUDY, tmp_path / "r.xlsx", samples=64)
    assert _read(tmp_path / "r.xlsx", ReadingLimits(cells=3_300)).submission.sheets["Variants"].rows
    limits = limits_of_reports(ReadingLimits(cells=3_300))
    usual = ReadingLimits()
    assert limits.cells == 13_200
    assert (limits.seconds, limits.processor_seconds) == (4 * usual.seconds, 4 * usual.processor_seconds)
