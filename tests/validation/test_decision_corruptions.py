"""Random corruptions of Other sources, Levers and Sweep: each is found at its cell, nothing else is blamed or lost."""

from __future__ import annotations

import datetime
from dataclasses import dataclass
from random import Random
from typing import Any

import openpyxl
import pytest
from decided_drives import CASE_3, CYLINDER, LEVERS, SOURCES, SWEEPS
from edited_workbooks import reading_here
from entry_books import entry_book

from flexlash.pipeline import check
from flexlash.schema.columns import columns_of

pytestmark = pytest.mark.slow

MOST_AT_ONCE, RIGHT = 3, 0.99
ROWS = {"Other sources": SOURCES, "Levers": LEVERS, "Sweep": SWEEPS}
_TEXTS = {"E202": ("E202", "E220", "E221")}
"""A text in the place of a number is told by what it is: a number stored as text, a word for no value, another text."""

NO_NUMBERS = ("1,6", "0.5 ", "half", "±0.2", "5%", "-", "n/a", "0.2 mm")
WRONG = (
    (True, "E204"),
    (datetime.datetime(2026, 12, 1), "E203"),  # noqa: DTZ001
    ("=1/0", "E206"),
    ("#REF!", "E205"),
)


@dataclass(frozen=True, kw_only=True)
class Spoilt:
    """A cell that is replaced, and the code that must be told there, or at that of another column."""

    sheet: str
    row: int
    key: str
    content: Any
    code: str
    told_at: str = ""


def _cell_fault(random: Random, sheet: str, key: str) -> tuple[Any, str]:
    """Return a content that no cell of a column can have, and its code."""
    column = columns_of(sheet)[key]
    wrong = [*WRONG]
    if column.is_number:
        wrong += [(random.choice(NO_NUMBERS), "E202")] * 4
    if column.minimum is not None:
        wrong += [(-1.0, "E207")] * 2
    if column.maximum is not None:
        wrong.append((column.maximum + 1.0, "E208"))
    if column.choices:
        wrong += [("another", "E209"), (f"{column.choices[0]}x", "E209")] * 2
    if column.required:
        wrong.append((None, "E201"))
    return random.choice(wrong)


_RELATIONS = {
    "Other sources": [
        (0, "radius_mm", None, "E201", ""),
        (0, "enter_as", None, "E362", "radius_mm"),
        (0, "upper_deviation", -0.02, "E318", "lower_deviation"),
        (0, "lower_deviation", -0.05, "E364", "lower_deviation"),
        (0, "pressure_angle_deg", 20.0, "E362", ""),
        (1, "upper_deviation", None, "E201", ""),
        (1, "source", "Tooth Clearance", "E361", ""),
        (2, "ratio", None, "E201", ""),
        (2, "side", None, "E362", "ratio"),
        (2, "radius_mm", 30.0, "E362", ""),
        (3, "kind", "systematic", "W462", "lower_deviation"),
    ],
    "Levers": [
        (0, "lowest", 221.0, "E365", ""),
        (0, "highest", 110.0, "E365", "lowest"),
        (0, "dimension", "wall thickness", "E361", ""),
        (1, "lowest", -0.5, "E207", ""),
        (3, "step", 1.0, "E362", ""),
        (3, "tolerance_may_change", "yes", "E362", ""),
    ],
    "Sweep": [
        (0, "variant", "case 7", "E366", ""),
        (0, "step", 101.0, "E368", ""),
        (0, "step", 0.01, "E369", ""),
        (0, "to", -100.0, "E207", ""),
        (0, "dimension", "bore_diameter", "E370", ""),
        (1, "second_step", None, "E201", ""),
        (1, "second_dimension", "wall_thickness", "E367", ""),
        (1, "second_from", 0.0, "E207", ""),
        (2, "step", 0.3, "E368", ""),
    ],
}
"""Row of a sheet, key and content, the code of what then contradicts it, and where that is told if not there."""


def _spoilt(random: Random, sheet: str, place: int) -> Spoilt:
    """Return one way to spoil a row."""
    related = [one for one in _RELATIONS[sheet] if one[0] == place]
    if related and random.random() < 0.5:
        _, key, content, code, told_at = random.choice(related)
    else:
        key = random.choice([key for key, value in ROWS[sheet][place].items() if value is not None])
        (content, code), told_at = _cell_fault(random, sheet, key), ""
    return Spoilt(sheet=sheet, row=place + 2, key=key, content=content, code=code, told_at=told_at)


@pytest.fixture(scope="module")
def judged(tmp_path_factory):
    """Return a function that checks the submission with some cells replaced, and the column letters of its sheets."""
    folder = tmp_path_factory.mktemp("spoilt")
    keys = {sheet: list(columns_of(sheet)) for sheet in ROWS}
    sheets = {
        sheet.lower().replace(" ", "_"): [{key: row.get(key) for key in keys[sheet]} for row in rows]
        for sheet, rows in ROWS.items()
    }
    path = entry_book(folder / "s.xlsx", variants=[CASE_3, CYLINDER], **sheets)

    def letter(sheet, key):
        return openpyxl.utils.get_column_letter(keys[sheet].index(key) + 1)

    def of(*spoilt):
        book = openpyxl.load_workbook(path)
        for one in spoilt:
            book[one.sheet][f"{letter(one.sheet, one.key)}{one.row}"].value = one.content
        book.save(folder / "spoilt.xlsx")
        return check(folder / "spoilt.xlsx")

    with reading_here():
        yield of, letter


def test_the_submission_is_sound_before(judged):
    """As it is nothing is found and every variant, source, lever and study counts."""
    outcome = judged[0]()
    assert {found.code for found in outcome.findings} <= {"I505", "W423"}
    found = outcome.validated
    assert (len(found.other_sources), len(found.levers), len(found.sweeps)) == (4, 4, 3)
    assert (found.sources_are_faulty, found.withheld_levers, found.faulty_sweeps) == (False, frozenset(), ())


def _kept(validated, spoilt):
    """Yield what is wrong with what validation keeps of sheets in which these rows have errors."""
    errors = [one for one in spoilt if one.code[0] == "E"]
    by_sheet = {sheet: [one for one in errors if one.sheet == sheet] for sheet in ROWS}
    if validated.sources_are_faulty is not bool(by_sheet["Other sources"]):
        yield "sources"
    withheld = {
        "wall_thickness" if one.code == "E361" else LEVERS[one.row - 2]["dimension"] for one in by_sheet["Levers"]
    }
    if not withheld <= validated.withheld_levers or any(validated.levers[name].row for name in withheld):
        yield "levers"
    if not by_sheet["Levers"] and validated.withheld_levers:
        yield "all levers"
    if set(validated.faulty_sweeps) != {one.row for one in by_sheet["Sweep"]}:
        yield "sweeps"


@pytest.mark.parametrize("seeds", [range(60), pytest.param(range(60, 200), marks=pytest.mark.long)], ids=str)
def test_corruptions_are_found_where_they_are_and_nothing_else_is_blamed(judged, seeds):
    """Of submissions with one to three spoilt rows, 200 in all, 99 % of the cells are told, and no sound one is.

    Both variants keep their numbers to the bit; a spoilt source takes the budget, a lever its dimension, a study none.
    """
    of, letter = judged
    before = {one.variant.name: one.nominal for one in of().computed.values()}
    missed, blamed, lost, wrong, expected = [], [], [], [], 0
    places = [(sheet, place) for sheet, rows in ROWS.items() for place in range(len(rows))]
    for seed in seeds:
        random = Random(seed)  # noqa: S311
        spoilt = [_spoilt(random, *place) for place in random.sample(places, random.randint(1, MOST_AT_ONCE))]
        outcome = of(*spoilt)
        told = {(found.sheet, found.cell, found.code) for found in outcome.findings}
        wanted = {(one.sheet, f"{letter(one.sheet, one.told_at or one.key)}{one.row}", one.code) for one in spoilt}
        expected += len(wanted)
        missed += [
            (seed, one, told)
            for one in wanted
            if told.isdisjoint((*one[:2], code) for code in _TEXTS.get(one[2], [one[2]]))
        ]
        rows = {(one.sheet, str(one.row)) for one in spoilt}
        doubled = any(one.code == "E361" for one in spoilt)
        blamed += [
            (seed, found)
            for found in told
            if found[2][0] == "E" and (found[0], found[1].lstrip("ABCDEFGHIJKLMN")) not in rows
            if not (doubled and found[2] == "E361")
        ]
        numbers = {one.variant.name: one.nominal for one in outcome.computed.values()}
        lost += [seed] if numbers != before else []
        wrong += [(seed, word, spoilt) for word in _kept(outcome.validated, spoilt)]
        if any(one.code[0] == "E" for one in spoilt):
            assert outcome.exit_code == 3, seed
    assert len(missed) <= (1 - RIGHT) * expected, missed
    assert (blamed, lost, wrong) == ([], [], [])
