"""Random corruptions of measured parts: each is found where it is, nothing else is blamed, nothing fails."""

from __future__ import annotations

import datetime
import math
from collections.abc import Callable
from random import Random
from typing import Any, NamedTuple

import pytest
from measured_parts import HEADERS, measured_rows, samples_of

from flexlash.analysis.assessment import assess
from flexlash.reading.raw import ERROR_WORDS, ErrorCell, Percentage, RawSheet, Submission, Unstored
from flexlash.validation.validate import validate

pytestmark = pytest.mark.slow

CORRUPTIONS = 200
MOST_AT_ONCE = 4
RIGHT = 0.99
LAST_OF_FIRST = 41
_COLUMNS = "ABCDE"
_WALL, _DISK = 3, 4
_VARIANT = {
    "variant": "C-1", "flexspline_type": "cup", "material": "20Cr2Ni4", "torque_Nm": 800, "cylinder_length_mm": 160,
    "mean_radius_mm": 80, "wall_thickness_mm": 1.6, "disk_thickness_mm": 1.6, "disk_inner_radius_mm": 40,
    "tolerance_class": "shop",
}  # fmt: skip
_TEXTS = (
    "1,607",
    "1.607 mm",
    "1,607 mm",
    "±0.02",
    "1.6.07",
    "0.02/-0.01",
    "1 607",
    "1'607",
    "5%",
    "Ø1.6",
    "x",
    "=1.607",
)


class Kind(NamedTuple):
    """What is put into which column of a row, and the code that it must give there."""

    code: str
    columns: tuple[int, ...]
    content: Callable[[Random, Any], Any]


def _scaled(random: Random, value: float) -> float:
    return value * random.choice((10, 0.1, 100, 0.01, 1000, 0.001, 25.4, 1 / 25.4))


KINDS = (
    Kind("E202", (_WALL, _DISK), lambda random, _: random.choice(_TEXTS)),
    Kind("E220", (_WALL, _DISK), lambda random, _: random.choice(("1.6071", " 1.6071", "1.60"))),
    Kind("E221", (_WALL, _DISK), lambda random, _: random.choice(("n/a", "-", "?", "NaN", "TBD"))),
    Kind("E204", (_WALL, _DISK, 0, 2), lambda random, _: random.choice((True, False))),
    Kind("E205", (_WALL, _DISK, 0, 2), lambda random, _: random.choice(("#REF!", "#DIV/0!", "#N/A", "#VALUE!"))),
    Kind("E207", (_WALL, _DISK), lambda random, _: random.choice((0, -1.6, -1e-9))),
    Kind("E201", (0,), lambda random, _: random.choice((None, " ", "\u00a0"))),
    Kind("E209", (2,), lambda random, _: random.choice(("nominal", "values", "dev", "0"))),
    Kind("E342", (2,), lambda *_: "deviation"),
    Kind("W453", (0,), lambda random, value: random.choice((f"{value}s", value[:-1] or value))),
    Kind("W446", (_WALL, _DISK), _scaled),
    Kind("I530", (1,), lambda random, value: value - random.choice((1, 2))),
)


def _made(seed: int) -> tuple[list[list[Any]], set[tuple[str, str]]]:
    """Return rows of two samples with up to four corrupted cells, each in a row of its own, and what is expected."""
    random = Random(seed)  # noqa: S311
    rows = [*measured_rows(40, "walls"), *measured_rows(24, "disks")]
    expected = set()
    used: set[int] = set()
    uses: set[str] = set()
    for _ in range(random.randint(1, MOST_AT_ONCE)):
        kind = random.choice(KINDS)
        place = random.choice([index for index in range(5, 62) if index not in used])
        # A sample has one finding of its parts and one of its use.
        if kind.code in {"E342", "I530"} and (kind.code in uses or not 5 < place < 36):
            continue
        uses.add(kind.code)
        used |= {place - 2, place - 1, place, place + 1, place + 2}
        column = random.choice(kind.columns)
        rows[place][column] = kind.content(random, rows[place][column])
        expected.add((f"{_COLUMNS[column]}{place + 2}", kind.code))
    return rows, expected


def _submission(rows: list[list[Any]]) -> Submission:
    """Return what reading yields of these sheets."""
    uses = samples_of(("shop", "wall_thickness", "walls"), ("shop", "disk_thickness", "disks"))
    lines = {
        "Variants": [list(_VARIANT), list(_VARIANT.values())],
        "Tolerances": uses,
        "Measurements": [HEADERS, *rows],
    }
    sheets = {
        name: RawSheet(
            name=name,
            rows={
                number: {
                    column: ErrorCell(value) if isinstance(value, str) and value in ERROR_WORDS else value
                    for column, value in enumerate(line, start=1)
                    if value is not None
                }
                for number, line in enumerate(table, start=1)
            },
        )
        for name, table in lines.items()
    }
    return Submission(name="corrupted.xlsx", sha256="", kind="workbook", sheets=sheets)


_ANYTHING = (
    1e308, -1e308, 5e-324, -5e-324, 1e-300, 1e200, 1e154, 1e30, 1e9, 0, -0.0, 2**53 + 1, 10**30, 1.6, math.nan,
    math.inf, "", " ", "1e999", "=1+1", "x" * 300, "\ud800", "{place}", "%s", "1,6", "#REF!", "TRUE", True, Unstored(),
    Percentage(0.05), Percentage(1e300), datetime.date(2026, 4, 1), datetime.time(23, 59), datetime.timedelta(days=-3),
)  # fmt: skip


@pytest.mark.parametrize("use", [None, "deviation"])
def test_whatever_was_measured_is_judged(use):
    """Cells of any content, tiny and huge numbers among them, end in findings at cells that are there."""
    for seed in range(150):
        random = Random(seed)  # noqa: S311
        rows = measured_rows(random.choice((5, 8, 40)), "walls", use)
        for _ in range(random.choice((1, 3, 60))):
            random.choice(rows)[random.randrange(5)] = random.choice(_ANYTHING)
        for row in rows if seed % 5 == 0 else ():
            row[_WALL] = random.choice([one for one in _ANYTHING if type(one) is float and math.isfinite(one)])
        validated = validate(_submission(rows))
        assess(validated, validated.settings)
        there = {f"{column}{number}" for column in _COLUMNS for number in range(1, len(rows) + 2)}
        assert {one.cell for one in validated.findings if one.sheet == "Measurements"} <= there, seed


def _is_spare(cell: str) -> bool:
    """Whether no class uses a cell: disks of the first sample, walls of the second."""
    return cell[0] == ("E" if int(cell[1:]) <= LAST_OF_FIRST else "D")


def test_each_corruption_is_found_where_it_is():
    """Of 200 corrupted sheets at least 99 % of the cells are named with their code, and no other cell ever is."""
    hits, missed, false = 0, [], []
    for seed in range(CORRUPTIONS):
        rows, expected = _made(seed)
        validated = validate(_submission(rows))
        found = {(one.cell, one.code) for one in validated.findings if one.sheet == "Measurements"}
        hits += len(expected & found)
        missed += [(seed, *one) for one in expected - found]
        false += [(seed, *one) for one in found - expected]
        waits = any(code[0] == "E" and not _is_spare(cell) for cell, code in expected)
        assert bool(validated.variants.rows) is not waits, seed
    assert hits / (hits + len(missed)) >= RIGHT, missed
    assert false == []
