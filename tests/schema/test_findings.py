"""The catalogue of findings: complete, in plain words, and filled without being fooled by what a cell holds."""

import datetime
import re
import string
from pathlib import Path

import pytest
from grids import for_each

import flexlash
from flexlash.schema.findings import CATALOGUE, Finding, finding, shown, spelled_out

SOURCE = Path(flexlash.__file__).parent
JARGON = re.compile(
    r"\b(schema|dtype|null|none|nan|dataframe|frame|exception|traceback|parse[dr]?|regex|string|float|int|boolean|enum|"
    r"reference variable|tuple|index|coerce|validator|expat|openpyxl|pandera|polars|python|xlsxwriter|(?<!Open )xml|"
    r"zip|utf-16le|unicode error)\b",
    re.IGNORECASE,
)
FACTS = {
    "file": "a.xlsx",
    "name": "Wall thickness Δ",
    "label": "Wall thickness Δ [mm]",
    "value": "1,6",
    "requirement": "a number in mm greater than 0",
    "other": 1.5,
    "detail": "0",
    "dimension": "wall_thickness",
    "unit": "mm",
    "found": "an old Excel file (.xls)",
    "known": 1,
    "what": "the file",
    "limit": "20 MiB",
    "suggestion": "1.6",
    "setting": "parts",
    "choices": "cup, hat, cylinder",
    "contradicted": "Disk inner radius r_ci",
    "added": "Disk cone angle, Disk thickness exponent and Load inertia",
}
LEVELS = {"E": "error", "W": "warning", "I": "info"}


def _used():
    """Return the codes that stand in the program outside the catalogue."""
    used = set()
    for path in SOURCE.rglob("*.py"):
        if path.name != "catalogue.py":
            used |= set(re.findall(r"""["']([EWI]\d{3})["']""", path.read_text(encoding="utf-8")))
    return used


def _filled(code, **facts):
    return finding(code, sheet="Variants", cell="D7", column="wall_thickness_mm", **FACTS | facts)


def test_every_code_in_use_is_in_the_catalogue():
    """No code is given to a user that `flexlash explain` does not know."""
    assert _used() - set(CATALOGUE) == set()


def test_every_code_of_the_catalogue_is_in_use():
    """The catalogue explains nothing that cannot be found."""
    assert set(CATALOGUE) - _used() == set()


def test_codes_rise_and_are_keyed_by_themselves():
    """The catalogue lists its codes in rising order within each letter, each under its own name."""
    assert all(code == rule.code for code, rule in CATALOGUE.items())
    for letter in LEVELS:
        own = [code for code in CATALOGUE if code[0] == letter]
        assert own == sorted(own)
        assert len(own) == len(set(own))


@for_each("code", CATALOGUE)
def test_level_is_the_letter(code):
    """E is an error, W a warning and I an information, in catalogue and finding alike."""
    assert re.fullmatch(r"E[123]\d\d|W4\d\d|I5\d\d", code)
    assert CATALOGUE[code].level == LEVELS[code[0]] == _filled(code).level


@for_each("code", CATALOGUE)
def test_every_code_has_its_words(code):
    """Title, message, fix and explanation are there, and the last three are sentences."""
    rule = CATALOGUE[code]
    assert rule.title
    assert not rule.title.endswith(".")
    for sentence in (rule.message, rule.fix, rule.explanation):
        assert sentence.endswith(".")
        assert sentence == sentence.strip()
        assert "  " not in sentence


@for_each("code", CATALOGUE)
def test_every_message_says_where(code):
    """A message names the cell or the file."""
    fields = {name for _, name, _, _ in string.Formatter().parse(CATALOGUE[code].message) if name}
    assert fields & {"place", "file"}
    message = _filled(code).message
    assert "Variants!D7" in message or "a.xlsx" in message
    assert "{" not in message + _filled(code).fix


@for_each("code", CATALOGUE)
def test_messages_are_short(code):
    """A message filled with short values has at most 25 words."""
    words = re.findall(r"\S*\w\S*", _filled(code, suggestion="").message)
    assert len(words) <= 25, " ".join(words)


@for_each("code", CATALOGUE)
def test_words_are_an_engineers(code):
    """No programmer's word stands in title, message, fix or explanation."""
    rule = CATALOGUE[code]
    assert JARGON.findall(f"{rule.title} {rule.message} {rule.fix} {rule.explanation}") == []


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (1.5, "1.5"),
        (800.0, "800"),
        (0.1 + 0.2, "0.3"),
        (1e-9, "1e-09"),
        (7, "7"),
        (True, "TRUE"),
        (False, "FALSE"),
        ("", ""),
        ("Δ 1,6 mm", "Δ 1,6 mm"),
        ("a\nb\tc\r", "a·b·c·"),
        ("\x1b[31mred", "·[31mred"),
        ("\u202eevil\u200b", "·evil·"),
        ("\u00a01.6", "·1.6"),
        ("x" * 60, "x" * 60),
        ("x" * 61, "x" * 59 + "…"),
        (datetime.date(2026, 4, 1), "2026-04-01"),
        (float("inf"), "inf"),
    ],
)
def test_shown(value, expected):
    """A value is shown short, on one line, and without characters that could steer a terminal."""
    assert shown(value) == expected


def test_fields_of_a_finding():
    """A finding carries level, code, address, variant, column, value, message, fix and suggestion, in this order."""
    found = finding(
        "E202",
        sheet="Variants",
        cell="G7",
        column="wall_thickness_mm",
        name="Wall thickness Δ",
        value="1,6 mm",
        requirement="a number in mm greater than 0",
        suggestion="1.6",
        variant="C-12",
    )
    assert found.as_dictionary() == {
        "level": "error",
        "code": "E202",
        "sheet": "Variants",
        "cell": "G7",
        "variant": "C-12",
        "column": "wall_thickness_mm",
        "value": "1,6 mm",
        "message": 'Variants!G7 Wall thickness Δ = "1,6 mm": a number in mm greater than 0 is required; '
        "did you mean 1.6?",
        "fix": "Type the number alone, without unit, with the decimal sign that your program uses.",
        "suggestion": "1.6",
    }
    assert list(found.as_dictionary()) == [
        "level", "code", "sheet", "cell", "variant", "column", "value", "message", "fix", "suggestion",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("sheet", "cell", "place"),
    [("Variants", "D7", "Variants!D7"), ("Variants", "", "Variants"), ("", "", "")],
)
def test_place(sheet, cell, place):
    """A finding's place reads as Excel writes an address."""
    assert Finding(level="info", code="I502", sheet=sheet, cell=cell, message="", fix="").place == place


def test_text_of_a_cell_is_inert():
    """Braces and format marks in a cell come out as they are."""
    for text in ("{0}", "{place.__class__}", "%s", "{", "}}", "{value}"):
        assert f'"{text}"' in _filled("E202", value=text, suggestion="").message


def test_a_suggestion_is_asked_once():
    """A suggestion that the message already names is not asked for a second time."""
    assert _filled("E209", suggestion="cup").message.endswith("; did you mean cup?")
    assert _filled("I504", suggestion="cup").message.count("cup") == 1


def test_a_finding_without_a_file_name():
    """A finding of a file whose name nobody gave still reads as a sentence."""
    assert finding("E103").message == "The file is protected by a password and cannot be read."


def test_an_unknown_code_is_a_fault_of_the_program():
    """A code outside the catalogue fails loudly."""
    with pytest.raises(KeyError):
        finding("E999")


def test_texts_from_outside_are_inert_in_messages():
    """Names of sheets and files, suggestions and variants reach a message without control or bidi characters."""
    made = finding("E108", file="a\x1b[31m.xlsx", found="the sheets S\u202e\x9b", sheet="S\u202e", suggestion="S\u202e")
    assert made.message.isprintable()
    assert made.suggestion.isprintable()
    placed = finding("E201", sheet="S\n", cell="D7", name="Torque", requirement="a number", variant="a\x07")
    assert placed.message.isprintable()
    assert placed.variant == "a·"
    assert placed.sheet == "S\n"


@pytest.mark.parametrize(
    ("value", "kind"),
    [(datetime.date(2026, 4, 1), "date 2026-04-01"), (datetime.time(1, 6), "time 01:06:00")],
)
def test_a_time_is_no_date(value, kind):
    """A time in a cell is called a time."""
    assert f"holds the {kind}:" in _filled("E203", value=value).message


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (80000.0, 4, "80000"),
        (800000.0, 4, "800000"),
        (9999.0, 4, "9999"),
        (1600.0, 4, "1600"),
        (1234567.0, 4, "1235000"),
        (-80000.0, 4, "-80000"),
        (0.00016, 4, "0.00016"),
        (40.123456, 6, "40.1235"),
    ],
)
def test_numbers_without_a_power_of_ten(value, digits, text):
    """Large numbers are written out, without commas, which some take for the decimal sign."""
    assert spelled_out(value, digits) == text
    if digits == 6:
        assert f"radius {text} mm" in _filled("E303", other=value).message
