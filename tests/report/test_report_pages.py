"""The report on paper: every page of it looked at as a picture, on A4 and on Letter."""

from __future__ import annotations

import re
import subprocess
import zipfile

import pytest
import regenerate
from libreoffice import convert_all, needs_pages

from flexlash.pipeline import run

PAPERS = {"A4": (9, 595, 842), "Letter": (1, 612, 792)}
EXAMPLES = ("b3-160-study", "needs-fixing", "catalogue-sizes")
ONE_PAGE = ("Summary", "Explorer", "Compare", "Contributions")
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
    folder, asked = tmp_path_factory.mktemp("pages"), {}
    for name in EXAMPLES:
        report = folder / f"{name}.xlsx"
        run(regenerate.ROOT / "data" / f"{name}.xlsx", report)
        for paper, (code, *_) in PAPERS.items():
            asked[name, paper] = report, _on_paper(report, folder / f"{name}-{paper}.xlsx", code)
    documents = convert_all([path for _, path in asked.values()], "pdf", folder)
    return {key: (report, pdf) for (key, (report, _)), pdf in zip(asked.items(), documents, strict=True)}


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
@pytest.mark.parametrize("paper", PAPERS)
@pytest.mark.parametrize("name", EXAMPLES)
def test_every_page_is_whole(printed, tmp_path, name, paper):
    """On either paper each page has its sheet's name, something on it and nothing on its edge; the glances take one."""
    _, width, height = PAPERS[paper]
    report, pdf = printed[name, paper]
    subprocess.run(["pdftoppm", "-r", "40", "-gray", str(pdf), str(tmp_path / "page")], check=True)
    pictures = sorted(tmp_path.glob("page-*.pgm"))
    told = subprocess.run(["pdfinfo", "-l", "99", str(pdf)], check=True, capture_output=True, text=True).stdout
    sizes = [(float(one), float(other)) for one, other in re.findall(r"size:\s+([\d.]+) x ([\d.]+)", told)]
    assert all(sorted(size) == pytest.approx([width, height], abs=1) for size in sizes)
    shown = []
    with zipfile.ZipFile(report) as archive:
        names = re.findall(r'<sheet name="([^"]+)" sheetId="\d+" r:id', archive.read("xl/workbook.xml").decode())
    for number, (picture, footer) in enumerate(zip(pictures, _footers(pdf, sizes), strict=True), start=1):
        sheet = footer.removesuffix(f"{number} / {len(pictures)} flexlash report").strip()
        shown.append(sheet)
        across, _, rows = _greys(picture)
        assert sum(len(row.translate(None, LIGHT)) for row in rows) > 50, f"page {number} is empty"
        edge = [*rows[:EDGE], *rows[-EDGE:], *(row[:EDGE] + row[across - EDGE :] for row in rows)]
        assert min(min(part) for part in edge) > 250, f"page {number} of {sheet} runs over its edge"
    assert shown == sorted(shown, key=names.index)
    assert set(shown) == set(names)
    for sheet in ONE_PAGE:
        assert shown.count(sheet) == 1, sheet
    assert shown.count("Results") == 8
    assert {shown.count(name) for name in ("Curves", "Compared", "Inputs", "Scatter", "Trace spread")} == {1}
    assert shown.count("Trace") == 2
