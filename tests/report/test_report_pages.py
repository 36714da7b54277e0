"""The report on paper: every page of it looked at as a picture, on A4 and on Letter."""

from __future__ import annotations

import re
import subprocess
import zipfile
from collections import Counter

import pytest
import regenerate
from decided_drives import drive
from libreoffice import convert_all, needs_pages
from openpyxl.utils import range_boundaries
from report_entries import opened

from flexlash.feedback.template.template_workbook import Filling, study, template_bytes
from flexlash.pipeline import run
from flexlash.report.failing.failing_places import FAILING, MOST_PAGES
from flexlash.report.shown_sheets import ROOM

PAPERS = {"A4": (9, 595, 842), "Letter": (1, 612, 792)}
PRINTED = [("study", "A4"), ("study", "Letter"), ("faulty", "A4"), ("long names", "A4"), ("long names", "Letter"),
           ("drive and sweep", "Letter")]  # fmt: skip
LEAST = 6.9
"""Points of the smallest letters, with room for rounding."""

LIGHT = bytes(range(200, 256))
"""Greys that are not counted as print."""
EDGE = 8
"""Pixels at 40 to the inch that no page may print on: within the margins of all sheets."""


def _on_paper(report, target, code):
    """Write the report with another paper in every sheet's print set-up."""
    with zipfile.ZipFile(report) as source, zipfile.ZipFile(target, "w") as copy:
        for name in source.namelist():
            data = source.read(name)
            if name.startswith("xl/worksheets/sheet"):
                data = re.sub(rb'paperSize="9"', b'paperSize="%d"' % code, data)
            copy.writestr(name, data)
    return target


@pytest.fixture(scope="module")
def printed(tmp_path_factory):
    """Return the report on each example and its pages on each paper, by example and paper."""
    folder, reports, asked = tmp_path_factory.mktemp("pages"), {}, {}
    for name in dict(PRINTED):
        source, reports[name] = folder / f"{name}.xlsx", folder / f"{name}-report.xlsx"
        source.write_bytes(template_bytes(_example(name)))
        run(source, reports[name])
    for name, paper in PRINTED:
        asked[name, paper] = _on_paper(reports[name], folder / f"{name}-{paper}.xlsx", PAPERS[paper][0])
    documents = convert_all(list(asked.values()), "pdf", folder)
    return {(name, paper): (reports[name], pdf) for (name, paper), pdf in zip(asked, documents, strict=True)}


def _example(name):
    """Return what stands in the submission of a name."""
    if name == "long names":
        rows = regenerate.catalogue_sizes().variants
        long = [f"{row['variant']} {'of a very long name ' * 3}"[:60] for row in rows]
        return Filling(
            variants=[
                {**row, "variant": words, "backlash_limit_arcmin": (0.3, 2.6, None)[place % 3], "notes": "remark " * 12}
                for place, (row, words) in enumerate(zip(rows, long, strict=True))
            ]
        )
    return {"study": study, "faulty": regenerate.needs_fixing, "drive and sweep": drive}[name]()


def _greys(path):
    """Return width, height and rows of grey values of a picture in the plainest form."""
    data = path.read_bytes()
    head, width, height, _ = data.split(None, 3)[0], *map(int, data.split(None, 4)[1:4])
    assert head == b"P5"
    body = data[-width * height :]
    return width, height, [body[row * width : (row + 1) * width] for row in range(height)]


def _footers(pdf, sizes):
    """Return the words at the foot of each page."""
    feet = {}
    for width, height in set(sizes):
        area = ["-x", "0", "-y", str(round(height) - 32), "-W", str(round(width)), "-H", "32"]
        command = ["pdftotext", *area, "-layout", str(pdf), "-"]
        texts = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split("\f")
        feet[width, height] = [" ".join(text.split()) for text in texts]
    return [feet[size][place] for place, size in enumerate(sizes)]


@pytest.mark.slow
@needs_pages
@pytest.mark.parametrize(("name", "paper"), PRINTED)
def test_every_page_is_whole(printed, tmp_path, name, paper):
    """On either paper each sheet that can be seen takes one page, each failing variant one, whole and not empty.

    Beside the pages of failing variants there are eight at most.
    """
    _, width, height = PAPERS[paper]
    report, pdf = printed[name, paper]
    subprocess.run(["pdftoppm", "-r", "40", "-gray", str(pdf), str(tmp_path / "page")], check=True)
    pictures = sorted(tmp_path.glob("page-*.pgm"))
    told = subprocess.run(["pdfinfo", "-l", "99", str(pdf)], check=True, capture_output=True, text=True).stdout
    sizes = [(float(one), float(other)) for one, other in re.findall(r"size:\s+([\d.]+) x ([\d.]+)", told)]
    assert all(sorted(size) == pytest.approx([width, height], abs=1) for size in sizes)
    shown = []
    book = opened(report)
    names = [name for name in book.sheetnames if book[name].sheet_state == "visible"]
    for number, (picture, footer) in enumerate(zip(pictures, _footers(pdf, sizes), strict=True), start=1):
        sheet = re.sub(rf"{number} ?/ ?{len(pictures)} flexlash report$", "", footer).strip()
        shown.append(sheet)
        across, _, rows = _greys(picture)
        assert sum(len(row.translate(None, LIGHT)) for row in rows) > 50, f"page {number} is empty"
        edge = [*rows[:EDGE], *rows[-EDGE:], *(row[:EDGE] + row[across - EDGE :] for row in rows)]
        assert min(min(part) for part in edge) > 250, f"page {number} of {sheet} runs over its edge"
    assert shown == sorted(shown, key=names.index)
    assert set(shown) == set(names)
    pages = Counter(shown)
    failing = pages.pop(FAILING, 0)
    assert set(pages.values()) == {1}
    assert pages.total() <= ROOM
    assert failing == min(MOST_PAGES, sum(cell.value in ("fails", "marginal") for cell in book["Results"]["B"]))


@pytest.mark.slow
@needs_pages
@pytest.mark.parametrize("name", dict(PRINTED))
def test_no_chart_is_chopped_or_stands_on_cells(printed, name):
    """A chart is printed whole or not at all, and no cell behind it has an entry that it would hide."""
    report = next(path for (example, _), (path, _) in printed.items() if example == name)
    checked = 0
    for sheet in (sheet for sheet in opened(report) if sheet.sheet_state == "visible"):
        _, _, right, bottom = range_boundaries(sheet.print_area.partition("!")[2] or sheet.dimensions)
        for chart in sheet._charts:
            start, end = chart.anchor._from, chart.anchor.to
            last_row, last_column = end.row + (end.rowOff > 0), end.col + (end.colOff > 0)
            behind = sheet.iter_rows(start.row + 1, last_row, start.col + 1, last_column, values_only=True)
            assert not any(value is not None for row in behind for value in row), (sheet.title, start.row)
            if start.row < bottom:
                assert last_row <= bottom, (sheet.title, "is chopped at the end of the page")
                assert last_column <= right, (sheet.title, "is chopped at the side")
                checked += 1
    assert checked > 4


_WORD = re.compile(r'<word xMin="([\d.]+)" yMin="([\d.]+)" xMax="([\d.]+)" yMax="([\d.]+)">([^<]+)</word>')
_SHORT = 5
_HIGH = 1.22
"""Height of a line in the report's font, by the size of its letters."""


@pytest.mark.slow
@needs_pages
@pytest.mark.parametrize(("name", "paper"), PRINTED)
def test_no_letter_is_smaller_than_seven_points(printed, name, paper):
    """Whatever is scaled to a page has letters of 7 points at least, in cells, charts and drawings."""
    _, pdf = printed[name, paper]
    told = subprocess.run(["pdftotext", "-bbox", str(pdf), "-"], check=True, capture_output=True, text=True).stdout
    small = {}
    for left, top, right, bottom, word in _WORD.findall(told):
        wide, high = float(right) - float(left), float(bottom) - float(top)
        # Words that are turned are as wide as others are high; short ones may be less wide than high.
        if (size := (min if len(word) > _SHORT else max)(high, wide) / _HIGH) < LEAST:
            small[word] = round(size, 1)
    assert small == {}
