"""Which sheets are read, which were meant to be, and how large they may be."""

from __future__ import annotations

import pytest

from flexlash.reading.raw import RawSheet, Submission
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.schema.columns import columns_of
from flexlash.validation.entry_sheets import (
    entry_sheets,
    report_other_names,
    report_second_tables,
    with_tables,
)
from flexlash.validation.ledger import Ledger


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


@pytest.mark.parametrize(
    "name",
    ["Variant", "Varients", "Varianten", "Tabelle1", "Sheet1", "Copy of Variants", "Variants (2)", "Table 1-1"],
)
def test_a_sheet_that_alone_has_the_headers_of_variants_is_read(name):
    """The one sheet with the headers of Variants is read whatever its name, and an info says so."""
    submission = _submission(Materials="Materials", Notes=("Material", "Price"), **{name: "Variants"})
    found = entry_sheets(submission, ReadingLimits())
    assert {schema: sheet.name for schema, sheet in found.items()} == {"Variants": name, "Materials": "Materials"}
    ledger = Ledger("a.xlsx")
    assert report_other_names(submission, found, ledger) == set()
    assert [(one.code, one.place) for one in ledger.findings] == [("I520", name)]


@pytest.mark.parametrize(
    ("schema", "name", "headers"),
    [
        ("Materials", "Material", "Materials"),
        ("Materials", "Steels", "Materials"),
        ("Materials", "Materials - Table 1", "Materials"),
        ("Tolerances", "Tolerance", ("Tolerance class", "Dimension")),
        ("Tolerances", "Tolerances (2)", "Tolerances"),
        ("Tolerances", "Tabelle2", "Tolerances"),
        ("Settings", "Setting", "Settings"),
    ],
)
def test_a_side_sheet_of_another_name_is_read(schema, name, headers):
    """A sheet that alone has the headers of a missing one is read, so that no built-in table takes its place."""
    submission = _submission(Variants="Variants", **{name: headers})
    found = entry_sheets(submission, ReadingLimits())
    assert found[schema].name == name
    ledger = Ledger("a.xlsx")
    assert report_other_names(submission, found, ledger) == set()
    assert [(one.code, one.place) for one in ledger.findings] == [("I520", name)]
    assert not ledger.everything


def test_of_two_sheets_that_may_be_variants_both_are_named():
    """Two sheets with the headers of Variants, neither of its name, are refused by both names."""
    refusal = _refused(_submission(Sheet1="Variants", Sheet2="Variants", Materials="Materials"))
    assert (refusal.code, refusal.facts["found"], refusal.facts["other"]) == ("E127", "Sheet1, Sheet2", "Variants")


def test_of_two_side_sheets_none_is_read():
    """Two sheets that may be Tolerances stop the work: no built-in class takes their place."""
    submission = _submission(Variants="Variants", coarse="Tolerances", fine="Tolerances")
    ledger = Ledger("a.xlsx")
    assert report_other_names(submission, entry_sheets(submission, ReadingLimits()), ledger) == {"Tolerances"}
    assert [(found.code, found.place) for found in ledger.findings] == [("E127", "coarse")]
    assert "coarse, fine" in ledger.findings[0].message
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
    assert report_other_names(submission, entry_sheets(submission, ReadingLimits()), ledger) == set()
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
    report_second_tables(submission, entry_sheets(submission, ReadingLimits()), ledger)
    assert [(found.code, found.place) for found in ledger.findings] == [(code, f"{name}!A1") for code in told]


_MEASURED = [
    "Sample",
    "Part",
    "Wall thickness Δ [mm]",
    "Disk thickness [mm]",
    "Mean radius r_m [mm]",
    "Bore diameter [mm]",
]
_CORRELATED = ["Tolerance class", "Dimension 1", "Dimension 2", "Correlation"]


@pytest.mark.parametrize(("headers", "schema"), [(_MEASURED, "Measurements"), (_CORRELATED, "Correlations")])
@pytest.mark.parametrize("name", ["Messwerte", "Sheet2", "Measurements (2)", "wall 2026"])
def test_optional_sheets_of_other_names(headers, schema, name):
    """A sheet with a sample and dimensions is measured parts whatever its name, never variants."""
    submission = _submission(Variants="Variants", **{name: headers})
    found = entry_sheets(submission, ReadingLimits())
    assert {key: sheet.name for key, sheet in found.items()} == {"Variants": "Variants", schema: name}
    ledger = Ledger("a.xlsx")
    report_other_names(submission, found, ledger)
    report_second_tables(submission, found, ledger)
    assert [(one.code, one.place) for one in ledger.findings] == [("I520", name)]


@pytest.mark.parametrize("name", ["Messwerte", "Variants of May", "Sheet1"])
def test_measured_parts_alone_are_no_submission(name):
    """Dimensions beside a sample do not make a sheet of variants."""
    assert _refused(_submission(**{name: _MEASURED})).code == "E108"


def test_variants_are_never_taken_for_measured_parts():
    """A copy of Variants, also one with a column of its own called Sample, stays a second table of variants."""
    for headers in (
        list(columns_of("Variants")),
        ["Sample", *columns_of("Variants")],
        ["Sample", "Material", *_MEASURED[2:]],
    ):
        submission = _submission(Variants="Variants", Copy=headers)
        found = entry_sheets(submission, ReadingLimits())
        assert set(found) == {"Variants"}
        ledger = Ledger("a.xlsx")
        report_other_names(submission, found, ledger)
        report_second_tables(submission, found, ledger)
        assert [(one.code, one.place, one.message.count("Variants")) for one in ledger.findings][:1] == [
            ("W428", "Copy!A1", 2)
        ]


def test_measured_parts_are_no_second_table_of_variants():
    """Read or not, measured parts are told as such."""
    submission = _submission(Variants="Variants", Measurements=_MEASURED, May=_MEASURED)
    found = entry_sheets(submission, ReadingLimits())
    assert found["Measurements"].name == "Measurements"
    ledger = Ledger("a.xlsx")
    report_second_tables(submission, found, ledger)
    assert [(one.code, one.place) for one in ledger.findings] == [("W428", "May!A1")]
    assert "Measurements" in ledger.findings[0].message


def test_two_sheets_of_measured_parts_stop_no_row():
    """Two sheets that may be Measurements are an error, but variants without a sample are computed."""
    submission = _submission(Variants="Variants", May=_MEASURED, June=_MEASURED)
    found = entry_sheets(submission, ReadingLimits())
    ledger = Ledger("a.xlsx")
    assert report_other_names(submission, found, ledger) == {"Measurements"}
    assert [one.code for one in ledger.findings] == ["E127"]
    assert not ledger.everything


@pytest.mark.parametrize("name", ["Measurements", "Correlations"])
def test_a_sheet_of_an_optional_name_without_a_table(name):
    """A sheet that has no more than the name is left out with a warning, an empty one without."""
    for rows, told in ((["Mean", "Spread"], ["W452"]), ((), [])):
        submission = _submission(Variants="Variants", **{name: rows})
        ledger = Ledger("a.xlsx")
        assert set(with_tables(entry_sheets(submission, ReadingLimits()), ledger)) == {"Variants"}
        assert [one.code for one in ledger.findings] == told
