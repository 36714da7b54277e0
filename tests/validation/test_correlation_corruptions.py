"""Random corruptions of the sheet Correlations: each is found at its cell, nothing else is blamed, the rest stays."""

from __future__ import annotations

import datetime
from dataclasses import dataclass
from random import Random
from typing import Any

import openpyxl
import pytest
from edited_workbooks import reading_here
from entry_books import CUP, UNIFORM_CUP, correlations, entry_book

from flexlash.pipeline import check

pytestmark = pytest.mark.slow

CORRUPTIONS, MOST_AT_ONCE, RIGHT = 200, 3, 0.99
CLASSES = ("shop", "careful", "coarse", "press 7")
PAIRS = (
    ("wall_thickness", "disk_thickness", 0.5),
    ("wall_thickness", "mean_radius", -0.2),
    ("cylinder_length", "disk_thickness", 0.25),
    ("youngs_modulus", "poisson_ratio", 0.1),
)
ROWS = [(*pair, name) for name in CLASSES for pair in PAIRS]
FIRST, COLUMNS = 2, {"class": "A", "first": "B", "second": "C", "value": "D"}
"""First row of entries, and where the sheet has its columns."""

_TEXTS = {"E202": ("E202", "E220", "E221")}
"""A text in the place of a number is told by what it is: a number stored as text, a word for no value, another text."""

NO_NUMBERS = ("1,6", "0.5 ", "half", "±0.2", "5%", "-", "n/a", "0.2/0.3")
OUT = (1.0000001, -1.5, 50, 1e9, -1e300)


@dataclass(frozen=True, kw_only=True)
class Spoilt:
    """A cell that is replaced, the code that must be told there, or at that of another column."""

    row: int
    column: str
    content: Any
    code: str
    told_at: str = ""

    @property
    def cell(self) -> str:
        """Where it is told."""
        return f"{COLUMNS[self.told_at or self.column]}{self.row}"


def _spoilt(random: Random, row: int) -> Spoilt:
    """Return one way to spoil a row."""
    first, second, _, name = ROWS[row - FIRST]
    column = random.choice(list(COLUMNS))
    wrong = [(True, "E204"), (datetime.datetime(2026, 12, 1), "E203"), ("=1/0", "E206"), ("#REF!", "E205")]  # noqa: DTZ001
    wrong.append((None, "E201"))
    if column == "value":
        out = random.choice(OUT)
        wrong += [(random.choice(NO_NUMBERS), "E202"), (out, "E208" if out > 0 else "E207")] * 3
    elif column == "class":
        wrong += [(f"{name}q", "E309"), ("nobody's", "E309")] * 3
    else:
        wrong += [("backlash_limit", "E209"), ("thick", "E209"), ("torque", "E347"), ("rim_thickness", "E347")] * 2
    content, code = random.choice(wrong)
    other = second if column == "first" else first
    if column in {"first", "second"} and random.random() < 0.2:
        return Spoilt(row=row, column=column, content=other, code="E346", told_at="second")
    return Spoilt(row=row, column=column, content=content, code=code)


@pytest.fixture(scope="module")
def judged(tmp_path_factory):
    """Return a function that checks the submission with some cells replaced."""
    folder = tmp_path_factory.mktemp("spoilt")
    variants = [CUP | {"variant": name, "tolerance_class": name} for name in CLASSES]
    tolerances = [row | {"tolerance_class": name} for name in CLASSES for row in UNIFORM_CUP]
    path = entry_book(folder / "s.xlsx", variants=variants, tolerances=tolerances, correlations=correlations(*ROWS))
    order = [cell.value for cell in openpyxl.load_workbook(path)["Correlations"][1]]
    assert order == ["Tolerance class", "Dimension 1", "Dimension 2", "Correlation"]

    def of(*spoilt):
        book = openpyxl.load_workbook(path)
        for one in spoilt:
            book["Correlations"][f"{COLUMNS[one.column]}{one.row}"].value = one.content
        book.save(folder / "spoilt.xlsx")
        return check(folder / "spoilt.xlsx")

    with reading_here():
        yield of


def _told(outcome):
    return {(found.cell, found.code) for found in outcome.findings if found.sheet == "Correlations"}


def test_the_submission_is_sound_before(judged):
    """As it is nothing is found and every variant is computed."""
    outcome = judged()
    assert {found.code for found in outcome.findings} <= {"I505"}
    assert outcome.counts["computed"] == len(CLASSES)


def test_corruptions_are_found_where_they_are_and_nothing_else_is_blamed(judged):
    """Of 200 submissions with one to three spoilt rows at least 99 % of the cells are told, and no sound one is.

    The class of a spoilt row waits, or all where its name is blank; all others keep their numbers to the bit.
    """
    before = {one.variant.name: one.nominal for one in judged().computed.values()}
    missed, blamed, wrong, expected = [], [], [], 0
    for seed in range(CORRUPTIONS):
        random = Random(seed)  # noqa: S311
        rows = random.sample(range(FIRST, FIRST + len(ROWS)), random.randint(1, MOST_AT_ONCE))
        spoilt = [_spoilt(random, row) for row in rows]
        outcome = judged(*spoilt)
        places = {(one.cell, one.code) for one in spoilt}
        expected += len(places)
        told = _told(outcome)
        missed += [
            (seed, place, told)
            for place in places
            if told.isdisjoint((place[0], code) for code in _TEXTS.get(place[1], [place[1]]))
        ]
        cells = {cell for cell, _ in places}
        blamed += [(seed, found) for found in told if found[0] not in cells and found[1][0] == "E"]
        waiting = {ROWS[one.row - FIRST][3] for one in spoilt}
        for name in set(CLASSES) - waiting:
            numbers = {one.variant.name: one.nominal for one in outcome.computed.values()}
            nameless = any(one.column == "class" and one.code != "E309" for one in spoilt)
            if not nameless and numbers.get(name) != before[name]:
                wrong.append((seed, name))
    assert len(missed) <= (1 - RIGHT) * expected, missed
    assert blamed == []
    assert wrong == []
