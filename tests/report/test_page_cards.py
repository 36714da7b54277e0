"""The cards of a page: every finding once, its cells drawn where they stand, as other readers see them."""

from __future__ import annotations

import csv
import datetime
import json
from pathlib import Path

import openpyxl
import pytest
from finding_examples import SUBMISSIONS
from grids import for_each

from flexlash.feedback.returned_files import fixed
from flexlash.pipeline import Options, check
from flexlash.reading.read import Source
from flexlash.report.page.grids import GRID_ROWS
from flexlash.report.page.page_facts import Found, page_bytes, page_facts

DATA = Path(__file__).resolve().parents[2] / "data"
FAULTY = DATA / "needs-fixing.xlsx"


def _checked(path, **options):
    outcome = check(path, **options)
    return outcome, page_facts(outcome, Found.of(outcome, ran=False), ran=False)


def _sheets_of(path):
    """Return the cells of a file by sheet and address, as openpyxl or Python's csv read them."""
    if path.suffix == ".csv":
        try:
            text = path.read_bytes().decode("utf-8-sig")
        except UnicodeDecodeError:
            text = path.read_bytes().decode("cp1252")
        delimiter = ";" if text.count(";") > text.count(",") else ","
        rows = csv.reader(text.splitlines(), delimiter=delimiter)
        cells = {(row, column): cell for row, line in enumerate(rows, 1) for column, cell in enumerate(line, 1)}
        return {"Variants": cells}
    book = openpyxl.load_workbook(path, data_only=True)
    return {
        sheet.title: {(cell.row, cell.column): cell.value for row in sheet.iter_rows() for cell in row}
        for sheet in book.worksheets
    }


def _is_shown(text, value):
    """Whether a text shows a cell's value as it was entered."""
    if value is None or value == "":
        return text in {"", "(formula without a stored result)"}
    if isinstance(value, bool):
        return text == str(value).upper()
    if isinstance(value, datetime.datetime | datetime.date | datetime.time):
        return text in {str(value), str(value)[:10]}
    if isinstance(value, int | float) and text.endswith("%"):
        return float(text[:-1]) / 100 == pytest.approx(value)
    if isinstance(value, int | float):
        return float(text) == pytest.approx(value)
    return text == value or (len(value) > 60 and text == f"{value[:59]}…") or not value.isprintable()


def _column(letters):
    return openpyxl.utils.column_index_from_string(letters)


def _drawn(facts):
    return [(card, card["grid"]) for card in facts["cards"] if card["grid"]]


def _wrong_cells(facts, sheets):
    """Return the cells of grids that are not those of the file at their address."""
    wrong = []
    for card, grid in _drawn(facts):
        if grid["sheet"] not in sheets:
            continue  # a table that was given beside the submission
        cells = sheets[grid["sheet"]]
        lines = [(row["row"], row["cells"]) for row in grid["rows"]]
        lines += [(grid["header_row"], grid["header"])] if grid["header_row"] else []
        for row, texts in lines:
            assert len(texts) == len(grid["columns"])
            for letters, text in zip(grid["columns"], texts, strict=True):
                expected = "" if letters == "…" else cells.get((row, _column(letters)))
                if not _is_shown(text, expected):
                    wrong.append((card["code"], letters, row, text, expected))
    return wrong


@pytest.mark.slow
def test_cells_are_drawn_where_they_stand():
    """Letters, row numbers, headers and entries are those of the workbook, blank rows and rows above included."""
    _, facts = _checked(FAULTY)
    assert len(_drawn(facts)) > 20
    assert _wrong_cells(facts, _sheets_of(FAULTY)) == []
    headers = {grid["header"][0] for _, grid in _drawn(facts) if grid["header_row"]}
    assert "Variant" in headers


def test_guilty_cells_are_marked_and_no_others():
    """What is marked in a row are the cells of the card's findings there."""
    outcome, facts = _checked(FAULTY)
    for card, grid in _drawn(facts):
        cells = {found.cell for found in outcome.findings if (found.code, found.sheet) == (card["code"], card["sheet"])}
        marked = {f"{grid['columns'][place]}{row['row']}" for row in grid["rows"] for place in row["marked"]}
        drawn = {f"{letters}{row['row']}" for row in grid["rows"] for letters in grid["columns"]}
        assert marked == cells & drawn != set(), card["code"]


@pytest.mark.slow
@for_each("name", SUBMISSIONS)
def test_every_finding_is_on_one_card(name, tmp_path):
    """Counts of the cards add up to all findings, by rule; a place is named, a message and a fix are there."""
    path, options = SUBMISSIONS[name](tmp_path)
    outcome, facts = _checked(path, **{key: value for key, value in options.items() if key != "elasticity"})
    json.dumps(facts, allow_nan=False)
    if facts["refused"]:
        assert facts["refused"]["message"] == outcome.findings[0].message
        assert facts["cards"] == []
        return
    codes = [code for card in facts["cards"] for code in [card["code"]] * card["count"]]
    assert sorted(codes) == sorted(found.code for found in outcome.findings)
    for card in facts["cards"]:
        assert card["message"]
        assert card["fix"]
        assert card["more"] == card["count"] - len(card["findings"]) >= 0
    if path.suffix in {".csv", ".xlsx"}:
        assert _wrong_cells(facts, _sheets_of(path)) == []


BESIDE = {
    "E303": ("Variant", "Mean radius r_m [mm]", "Disk inner radius r_ci [mm]"),
    "E301": ("Variant", "Mean radius r_m [mm]", "Bore diameter [mm]"),
    "E310": ("Variant", "Flexspline type", "Disk thickness [mm]"),
}
"""What is drawn of rules between cells: a blank one only where blanks are what is wrong."""

OF_A_ROW = {
    "E362": ("Source", "Side", "Ratio"),
    "E364": ("Source", "Value", "Lower deviation", "Upper deviation"),
    "E365": ("Dimension", "Lowest", "Highest"),
    "E368": ("Variant", "Dimension", "From", "To", "Step"),
    "W464": ("Dimension", "Lowest", "Highest"),
}
"""The same on the sheets Other sources, Levers and Sweep."""


@for_each("code", BESIDE)
def test_a_rule_between_cells_shows_all_of_them(code):
    """Beside a guilty cell stand those that it is compared with, and no others."""
    _, facts = _checked(FAULTY)
    (card,) = (card for card in facts["cards"] if card["code"] == code)
    headers = [header for header in card["grid"]["header"] if header]
    assert set(BESIDE[code]) <= set(headers)
    assert len(headers) <= 5


def test_a_rule_of_a_row_shows_what_it_compares(tmp_path):
    """On Other sources, Levers and Sweep stand the name of the row, the guilty cell and those beside it."""
    path, _ = SUBMISSIONS["decided"](tmp_path)
    _, facts = _checked(path)
    drawn = {card["code"]: card["grid"]["header"] for card in facts["cards"] if card["grid"]}
    for code, headers in OF_A_ROW.items():
        assert set(headers) <= {header for header in drawn[code] if header}, code


@pytest.mark.slow
def test_what_is_drawn_as_fixed_stands_in_the_fixed_file(tmp_path):
    """The row below an entry has what the file with the certain fixes holds there."""
    outcome = check(FAULTY)
    made = fixed(Source(name=FAULTY.name, data=FAULTY.read_bytes()), Options())
    (tmp_path / "fixed.xlsx").write_bytes(made.data)
    cells = _sheets_of(tmp_path / "fixed.xlsx")
    facts = page_facts(outcome, Found.of(outcome, ran=False, fixes=made.fixes), ran=False)
    drawn = [
        (grid["sheet"], row["row"], letters, text)
        for _, grid in _drawn(facts)
        for row in grid["rows"]
        for letters, text in zip(grid["columns"], row["fixed"] or [], strict=False)
        if text
    ]
    assert len(drawn) == facts["fixable"] == len(made.fixes) == 2
    for sheet, row, letters, text in drawn:
        assert _is_shown(text, cells[sheet][row, _column(letters)])


@pytest.mark.slow
def test_a_fix_has_the_decimal_sign_of_the_table(tmp_path):
    """In a text with decimal commas a number is fixed with one, as the fixed file has it."""
    path = tmp_path / "study.csv"
    header = "Variant;Material;Torque T [N·m];Cylinder length l [mm];Mean radius r_m [mm];Wall thickness Δ [mm];"
    line = "C-1;20Cr2Ni4;800;160;80;1,6;40\nC-2;20Cr2Ni4;800;160;80;1,8 mm;40\n"
    path.write_text(f"{header}Disk inner radius r_ci [mm]\n{line}", encoding="utf-8")
    outcome, facts = _checked(path)
    (card,) = (card for card in facts["cards"] if card["code"] == "E202")
    (row,) = card["grid"]["rows"]
    assert (row["row"], row["fixed"][row["marked"][0]]) == (3, "1,8")
    text = fixed(Source(name=path.name, data=path.read_bytes()), Options()).data.decode("utf-8-sig")
    assert ";1,8;40" in text
    (found,) = (found for found in outcome.findings if found.code == "E202")
    assert found.cell == f"{card['grid']['columns'][row['marked'][0]]}3"


def test_a_finding_at_a_header_draws_the_header_once(book):
    """Where the header itself is guilty its row is drawn as a row, marked."""
    headers = ["variant", "material", "torque_Nm", "cylinder_length_mm", "mean_radius_mm", "Wall thicknes [mm]",
               "disk_inner_radius_mm"]  # fmt: skip
    row = ["C-1", "20Cr2Ni4", 800, 160, 80, 1.6, 40]
    path = book({"Variants": [["A study"], [], headers, row]})
    _, facts = _checked(path)
    (card,) = (card for card in facts["cards"] if card["code"] == "E112")
    grid = card["grid"]
    assert (grid["header_row"], grid["header"]) == (0, [])
    assert [line["row"] for line in grid["rows"]] == [3]
    assert grid["rows"][0]["cells"][grid["rows"][0]["marked"][0]] == "Wall thicknes [mm]"


@pytest.mark.slow
def test_many_findings_stay_few_on_the_page(table, sound):
    """Of a rule the first cells are drawn and the first findings told; the rest is counted, and its ranges named."""
    rows = [sound | {"variant": f"V{number}", "torque_Nm": "much"} for number in range(1000)]
    outcome = check(table(rows))
    facts = page_facts(outcome, Found.of(outcome, ran=False), ran=False)
    (card,) = facts["cards"]
    assert (card["count"], card["cells"], card["more"]) == (1000, 1000, 980)
    assert card["places"] == "Variants!D2:D1001"
    assert len(card["grid"]["rows"]) == GRID_ROWS
    assert facts["tiles"][1]["number"] == "1000"
    assert len(page_bytes(outcome, Found.of(outcome, ran=False), ran=False)) < 20_000


HOSTILE = {
    "a script": "<script>alert(1)</script>",
    "a formula": '=HYPERLINK("http://x","y")',
    "another direction": "abc\u202egnp.exe",
    "a bell": "a\x07b",
    "very long": "x" * 30_000,
    "half a character": "a\ud800b",
}


@pytest.mark.slow
@for_each("name", HOSTILE)
def test_hostile_texts_are_short_and_on_one_line(name, tmp_path):
    """Whatever is entered is told on one line, cut and without control characters, in a name as in a number."""
    path, text = tmp_path / "study.csv", HOSTILE[name].replace('"', '""')
    header = "variant,material,torque_Nm,cylinder_length_mm,mean_radius_mm,wall_thickness_mm,disk_inner_radius_mm,own"
    line = f'"{text}",20Cr2Ni4,"{text}",160,80,1.6,40,"{text}"\nV,"{text}",800,160,80,1.6,40,x\n'
    path.write_bytes(f"{header}\n{line}".encode("utf-8", "surrogatepass"))
    outcome = check(path)
    data = page_bytes(outcome, Found.of(outcome, ran=False), ran=False)
    for told in _texts(json.loads(data.decode())):
        assert told.isprintable(), told
        assert len(told) <= 2000
    assert len(data) < 20_000


def _texts(content):
    """Yield every text in an object of JSON."""
    if isinstance(content, str):
        yield content
    for inner in content.values() if isinstance(content, dict) else content if isinstance(content, list) else ():
        yield from _texts(inner)
