"""Random corruptions of a valid submission: each is found where it is, nothing else is blamed, the rest is computed."""

from __future__ import annotations

from dataclasses import dataclass
from random import Random

import pytest
from corruptions import KINDS, Corruption, corruption
from edited_workbooks import FIRST, LETTERS, edited, reading_here, records, small_template

from flexlash.analysis.outcome import Outcome
from flexlash.pipeline import check
from flexlash.reading.read import Source
from flexlash.schema.findings import Finding

pytestmark = pytest.mark.slow
CORRUPTIONS = 200
MOST_AT_ONCE = 5
RIGHT = 0.99
"""Share of the corrupted cells that must be found where they are."""

_NAMED = {
    "E307": ("Materials", "material", "material"),
    "E309": ("Tolerances", "tolerance_class", "tolerance_class"),
    "E223": ("Measurements", "sample", "sample"),
    "E224": ("Tolerances", "tolerance_class", "based_on"),
}
"""Errors that can follow from another sheet: which, the column of names there, and that of those who use them."""

_OF_ITS_CLASS = {"E339", "E340", "E347"}
"""Errors that can follow from a sample, or from another row of the class."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """A corrupted submission and what came out of it."""

    seed: int
    made: list[Corruption]
    outcome: Outcome

    @property
    def touched(self) -> set[tuple[str, str]]:
        """The cells that were changed, or hidden under others, or named by a finding that is expected."""
        changed = {place for one in self.made for place in one.cells}
        return changed | {(sheet, cell) for one in self.made for sheet, cell, _ in one.expected}

    @property
    def places(self) -> set[tuple[str, str, str]]:
        """Sheet, cell and code of every finding."""
        return {(found.sheet, found.cell, found.code) for found in self.outcome.findings}


def _checked(data: bytes) -> Outcome:
    return check(Source(name="corrupted.xlsx", data=data))


def _case(seed: int, made: list[Corruption]) -> Case:
    cells = {place: content for one in made for place, content in one.cells.items()}
    hidden = [place for one in made for place in one.hidden]
    merged = [area for one in made for area in one.merged]
    return Case(seed=seed, made=made, outcome=_checked(edited(cells, hidden, merged)))


@pytest.fixture(scope="module")
def cases():
    """Return all corrupted submissions."""
    with reading_here():
        return [_case(seed, corruption(Random(seed), MOST_AT_ONCE)) for seed in range(CORRUPTIONS)]  # noqa: S311


@pytest.fixture(scope="module")
def sound():
    """Return what comes out of the submission as it was."""
    with reading_here():
        return _checked(small_template())


_TEXTS = {"E202": ("E202", "E220", "E221")}
"""A text in the place of a number is told by what it is: a number stored as text, a word for no value, another text."""


def _row(cell: str) -> int:
    return int(cell.lstrip("ABCDEFGHIJKLMNOPQRSTUVWXYZ"))


def _owners(case: Case, key: str, sheet: str) -> set[str]:
    """Return the materials or classes of whose rows something was changed, by the name they had."""
    return {str(records(sheet).get(_row(cell), {}).get(key, "")) for name, cell in case.touched if name == sheet} - {""}


def _is_consequence(case: Case, found: Finding) -> bool:
    """Whether an error at an untouched cell follows from a touched one: of a name, a sample or a row of its class."""
    record = records(found.sheet).get(_row(found.cell), {})
    if found.code in _OF_ITS_CLASS:
        return str(record.get("tolerance_class")) in _classes(case)
    if found.code not in _NAMED:
        return False
    sheet, key, named = _NAMED[found.code]
    return str(record.get(named)) in _owners(case, key, sheet)


def _classes(case: Case) -> set[str]:
    """Return the classes of which something was changed, in them, their samples or what they are based on."""
    samples = _owners(case, "sample", "Measurements")
    found = _owners(case, "tolerance_class", "Tolerances") | _owners(case, "tolerance_class", "Correlations")
    rows = [record for record in records("Tolerances").values() if "tolerance_class" in record]
    found |= {str(record["tolerance_class"]) for record in rows if record.get("sample") in samples}
    while more := {str(record["tolerance_class"]) for record in rows if record.get("based_on") in found} - found:
        found |= more
    return found


def _stopped(case: Case) -> set[int]:
    """Return the rows that a corruption may stop: their own, those of a spoilt material or class, or all."""
    harmful = [one for one in case.made if not one.is_harmless]
    touched = {place for one in harmful for place in one.cells}
    if any(sheet == "Settings" or _row(cell) < FIRST for sheet, cell in touched):
        return set(records("Variants"))
    names = {"Tolerances": "tolerance_class", "Correlations": "tolerance_class", "Measurements": "sample"}
    if any(cell.startswith(LETTERS[sheet][names[sheet]]) for sheet, cell in touched if sheet in names):
        return set(records("Variants"))
    harmful_case = Case(seed=case.seed, made=harmful, outcome=case.outcome)
    materials = _owners(harmful_case, "material", "Materials")
    classes = _classes(harmful_case)
    return {_row(cell) for sheet, cell in harmful_case.touched if sheet == "Variants"} | {
        row
        for row, record in records("Variants").items()
        if record["material"] in materials or record.get("tolerance_class", "standard") in classes
    }


@pytest.mark.slow
def test_the_submission_is_sound_before(sound):
    """Without a corruption only its short classes are told and every row is computed: what is found was corrupted."""
    assert {found.code for found in sound.findings} == {"W438", "I531"}
    assert sound.counts["computed"] == len(records("Variants"))


def test_every_kind_is_drawn(cases):
    """The corruptions are many, of nearly every kind, and several at once."""
    assert len({one.kind for case in cases for one in case.made}) > 0.9 * len(KINDS)
    assert sum(len(case.made) for case in cases) > 2 * len(cases)


def test_corrupted_cells_are_found_where_they_are(cases):
    """Nearly every corrupted cell has the finding that names its fault, at its own address."""
    expected = [(case.seed, *place) for case in cases for one in case.made for place in one.expected]
    missed = [
        (seed, sheet, cell, code)
        for seed, sheet, cell, code in expected
        if cases[seed].places.isdisjoint((sheet, cell, one) for one in _TEXTS.get(code, (code,)))
    ]
    assert len(missed) <= (1 - RIGHT) * len(expected), missed


def test_untouched_cells_have_no_error(cases):
    """No cell is blamed that is as it was, unless it names a material or class whose own row is spoilt."""
    wrong = [
        (case.seed, found.place, found.code)
        for case in cases
        for found in case.outcome.findings
        if found.level == "error" and (found.sheet, found.cell) not in case.touched and not _is_consequence(case, found)
    ]
    assert wrong == []


def test_untouched_rows_keep_every_bit(cases, sound):
    """A row that neither it nor its material, class or settings was corrupted of is computed, to the same last bit."""
    nominal = {row: one.nominal for row, one in sound.computed.items()}
    kept = 0
    for case in cases:
        for row in records("Variants").keys() - _stopped(case):
            assert row in case.outcome.computed, (case.seed, row)
            assert case.outcome.computed[row].nominal == nominal[row], (case.seed, row)
            kept += 1
    assert kept > 2 * len(cases)


def test_rows_with_an_error_are_not_computed(cases):
    """A row with a corrupted cell that is an error has no number, and the exit code says so."""
    for case in cases:
        errors = [place for one in case.made for place in one.expected if place[2].startswith("E")]
        rows = {_row(cell) for sheet, cell, _ in errors if sheet == "Variants" and _row(cell) >= FIRST}
        assert not rows & case.outcome.computed.keys(), case.seed
        assert not errors or case.outcome.exit_code in {3, 4} or not rows, case.seed


@pytest.mark.parametrize(("sheet", "free"), [("Materials", "H"), ("Tolerances", "Q"), ("Variants", "AD")])
def test_a_lost_header_of_names_is_told_once(sheet, free):
    """Where the column of names has no header nobody blames those who use the names: one cause, one finding."""
    outcome = _checked(edited({(sheet, f"A{FIRST - 1}"): ("blank", "")}))
    errors = [(found.place, found.code) for found in outcome.findings if found.level == "error"]
    assert errors == [(f"{sheet}!{free}{FIRST - 1}", "E111")]
    assert outcome.computed == {}
