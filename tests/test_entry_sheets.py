"""Which sheets are read, which were meant to be, and how large they may be."""

from __future__ import annotations

import pytest

from flexlash.columns import columns_of
from flexlash.submission.entry_sheets import entry_sheets, tell_misspelt_sheets, tell_second_tables
from flexlash.submission.ledger import Ledger
from flexlash.submission.reading.limits import ReadingLimits
from flexlash.submission.reading.raw import RawSheet, Submission
from flexlash.submission.reading.refusal import Refusal
from flexlash.submission.repairs import repair_of


def _submission(kind="workbook", **sheets):
    """Return a submission whose sheets hold the headers of a schema, or the given ones."""
    raw = {}
    for name, headers in sheets.items():
        titles = list(columns_of(headers)) if isinstance(headers, str) else headers
        raw[name] = RawSheet(name=name, rows={1: dict(enumerate(titles, start=1))} if titles else {})
    return Submission(name="a.xlsx", sha256="", kind=kind, sheets=raw)


def _refused(submission, limits=None):
    with pytest.raises(Refusal) as caught:
        entry_sheets(submission, limits or ReadingLimits())
    return caught.value


@pytest.mark.parametrize(
    ("sheets", "found", "suggestion"),
    [
        (["Varaints"], "the sheets Varaints", "Varaints"),
        (["Sheet1", "Variant"], "the sheets Sheet1, Variant", "Variant"),
        (["Materials", "Tolerances"], "the sheets Materials, Tolerances", ""),
        (["Sheet1"], "the sheets Sheet1", ""),
        ([], "no sheet", ""),
        ([f"S{number}" for number in range(1, 20)], "the sheets S1, S2, S3, S4, S5", ""),
    ],
)
def test_a_missing_sheet_gets_the_nearest(sheets, found, suggestion):
    """Without Variants the file is refused with the sheets it has, and the one with the nearest name."""
    refusal = _refused(_submission(**dict.fromkeys(sheets, ())))
    assert (refusal.code, refusal.facts) == ("E108", {"found": found, "suggestion": suggestion})


@pytest.mark.parametrize("name", ["Variant", "Varients", "Tabelle1", "Sheet1", "Variants (2)"])
def test_a_sheet_with_the_headers_of_variants_was_meant(name):
    """A sheet with the headers of Variants is suggested whatever its name, and renaming it mends the file."""
    refusal = _refused(_submission(Materials="Materials", **{name: "Variants"}))
    assert refusal.facts["suggestion"] == refusal.facts["sheet"] == name
    assert refusal.facts["repair"] == "Variants"


@pytest.mark.parametrize(
    ("schema", "name", "headers"),
    [
        ("Materials", "Material", "Materials"),
        ("Materials", "Steels", "Materials"),
        ("Tolerances", "Tolerance", ("Tolerance class", "Dimension")),
        ("Tolerances", "Tolerences", "Tolerances"),
        ("Tolerances", "Tabelle2", "Tolerances"),
        ("Settings", "Setting", "Settings"),
    ],
)
def test_a_side_sheet_of_another_name_is_an_error(schema, name, headers):
    """A sheet meant for a missing one stops the work, so that no built-in table takes its place without a word."""
    submission = _submission(Variants="Variants", **{name: headers})
    ledger = Ledger("a.xlsx")
    assert tell_misspelt_sheets(submission, entry_sheets(submission, ReadingLimits()), ledger) == {schema}
    (found,) = ledger.findings
    assert (found.code, found.place, found.suggestion, repair_of(found)) == ("E119", name, schema, schema)
    assert ledger.everything


@pytest.mark.parametrize(
    "sheets",
    [
        {"Notes": ("Material", "Price")},
        {"Material": ("Price", "Supplier")},
        {"Material": ()},
        {"Materials": "Materials", "Material": "Materials"},
        {"Lists": "Settings"} | {"Settings": "Settings"},
    ],
)
def test_other_sheets_are_left_alone(sheets):
    """A sheet with few or no such headers, or beside the right one, is the author's own."""
    submission = _submission(Variants="Variants", **sheets)
    ledger = Ledger("a.xlsx")
    assert tell_misspelt_sheets(submission, entry_sheets(submission, ReadingLimits()), ledger) == set()
    assert ledger.findings == []


@pytest.mark.parametrize(("setting", "size"), [("rows", 3), ("columns", 28)])
def test_a_sheet_at_its_limit(setting, size):
    """Rows and columns of an entry sheet at their limit are read; one more is refused, in a workbook alone."""
    rows = {1: {1: "variant", 2: "material"}, 6: {28: 1.0}, 900: {1: "a"}}
    sheets = {"Variants": RawSheet(name="Variants", rows=rows)}
    workbook, plain = (Submission(name="a", sha256="", kind=kind, sheets=sheets) for kind in ("workbook", "parquet"))
    assert entry_sheets(workbook, ReadingLimits(**{setting: size})) == sheets
    assert entry_sheets(plain, ReadingLimits(**{setting: size - 1})) == sheets
    assert _refused(workbook, ReadingLimits(**{setting: size - 1})).code == "E110"


@pytest.mark.parametrize(
    ("name", "headers", "told"),
    [
        ("Variants (2)", "Variants", ["W428"]),
        ("steels", "Materials", ["W428"]),
        ("Other", ["Variant", "Material", "a", "b"], []),
        ("Notes", [], []),
    ],
)
def test_a_second_table_is_not_read_in_silence(name, headers, told):
    """A sheet that holds the table of an entry sheet once more is warned of, by its own name; other sheets are not."""
    submission = _submission(Variants="Variants", Materials="Materials", **{name: headers})
    ledger = Ledger("a.xlsx")
    tell_second_tables(submission, entry_sheets(submission, ReadingLimits()), ledger)
    assert [(found.code, found.place) for found in ledger.findings] == [(code, f"{name}!A1") for code in told]
