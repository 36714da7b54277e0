"""The report on paper: every page of it looked at as a picture, on A4 and on Letter."""

from __future__ import annotations

import re
import subprocess
import zipfile

import pytest

import regenerate
from flexlash.pipeline import run
from libreoffice import convert, needs_libreoffice

PAPERS = {"A4": (9, 595, 842), "Letter": (1, 612, 792)}
ONE_PAGE = ("Summary", "Explorer", "Compare", "Contributions")
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


@pytest.fixture(scope="module", params=["b3-160-study", "needs-fixing", "catalogue-sizes"])
def report(request, tmp_path_factory):
    """Return the path of the report on an example."""
    path = tmp_path_factory.mktemp("pages") / "report.xlsx"
    run(regenerate.ROOT / "data" / f"{request.param}.xlsx", path)
    return path


def _greys(path):
    """Return width, height and rows of grey values of a picture in the plainest form."""
    data = path.read_bytes()
    head, width, height, _ = data.split(None, 3)[0], *map(int, data.split(None, 4)[1:4])
    assert head == b"P5"
    body = data[-width * height :]
    return width, height, [body[row * width : (row + 1) * width] for row in range(height)]


def _footer(pdf, number, size):
    """Return the words at the foot of a page."""
    width, height = (round(side) for side in size)
    area = ["-x", "0", "-y", str(height - 32), "-W", str(width), "-H", "32"]
    command = ["pdftotext", "-f", str(number), "-l", str(number), *area, "-layout", str(pdf), "-"]
    return " ".join(subprocess.run(command, check=True, capture_output=True, text=True).stdout.split())


@needs_libreoffice
@pytest.mark.parametrize("paper", PAPERS)
def test_every_page_is_whole(report, tmp_path, paper):
    """On either paper each page has its sheet's name, something on it and nothing on its edge; the glances take one."""
    code, width, height = PAPERS[paper]
    pdf = convert(_on_paper(report, tmp_path / f"{paper}.xlsx", code), "pdf", tmp_path)
    subprocess.run(["pdftoppm", "-r", "40", "-gray", str(pdf), str(tmp_path / "page")], check=True)
    pictures = sorted(tmp_path.glob("page-*.pgm"))
    told = subprocess.run(["pdfinfo", "-l", "99", str(pdf)], check=True, capture_output=True, text=True).stdout
    sizes = [(float(one), float(other)) for one, other in re.findall(r"size:\s+([\d.]+) x ([\d.]+)", told)]
    assert all(sorted(size) == pytest.approx([width, height], abs=1) for size in sizes)
    shown = []
    with zipfile.ZipFile(report) as archive:
        names = re.findall(r'<sheet name="([^"]+)" sheetId="\d+" r:id', archive.read("xl/workbook.xml").decode())
    for number, (picture, size) in enumerate(zip(pictures, sizes, strict=True), start=1):
        footer = _footer(pdf, number, size)
        name = footer.removesuffix(f"{number} / {len(pictures)} flexlash report").strip()
        shown.append(name)
        across, _, rows = _greys(picture)
        assert sum(grey < 200 for row in rows for grey in row) > 50, f"page {number} is empty"
        edge = [*rows[:EDGE], *rows[-EDGE:], *(row[:EDGE] + row[across - EDGE :] for row in rows)]
        assert min(min(part) for part in edge) > 250, f"page {number} of {name} runs over its edge"
    assert shown == sorted(shown, key=names.index)
    assert set(shown) == set(names)
    for name in ONE_PAGE:
        assert shown.count(name) == 1, name
    assert shown.count("Results") == 4
    assert shown.count("Trace") == 2
