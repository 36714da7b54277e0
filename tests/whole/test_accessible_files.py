"""What a screen reader needs in every kind of workbook: texts for pictures, titles, headings, links with words.

The rules are those of Excel's accessibility checker that can be asked of a file.
"""

from __future__ import annotations

import re
from collections import Counter

import openpyxl
import pytest
from drawings import charts_of, drawings_of
from workbook_kinds import KINDS

pytestmark = pytest.mark.slow

LEAST, MOST = 50, 1200
"""Letters of an alternative text: enough to say what is seen, few enough to be heard."""

GENERIC = re.compile(r"(?i)^(chart|picture|image|graphic|diagram|shape|untitled|.*\.(png|emf|svg))\s*\d*$")
SKETCH = "Half-section of a "
"""How the texts of sketches begin, which have symbols instead of numbers."""

MIRRORED = {"Settings"}
"""Shown as it was submitted: what the template says beside each entry has no heading there."""

UNNAMED = re.compile(r"(?i)sheet ?\d*")


@pytest.mark.parametrize("name", KINDS)
def test_every_drawing_says_what_it_shows(kinds, name):
    """Charts, pictures and shapes have alternative texts with numbers or names in them, no two of them the same."""
    drawn = list(drawings_of(kinds / name))
    assert [one for one in drawn if GENERIC.match(one.text) or not LEAST <= len(one.text) <= MOST] == []
    told = [one for one in drawn if not one.text.startswith(SKETCH)]
    assert [one for one in told if not re.search(r"\d", one.text)] == []
    assert [text for text, count in Counter(one.text for one in drawn).items() if count > 1] == []


@pytest.mark.parametrize("name", KINDS)
def test_every_chart_has_a_title_and_names_its_series(kinds, name):
    """No chart is without a title; a chart of several seen series names each of them."""
    for title, series in charts_of(kinds / name):
        assert title
        assert len(series) == 1 or all(one.name for one in series), title


@pytest.mark.parametrize("name", KINDS)
def test_sheets_are_named_and_their_tables_are_read_in_rows(kinds, name):
    """Sheets have names, the file a title; no cells are merged downwards; the heading of a filtered table stays."""
    workbook = openpyxl.load_workbook(kinds / name)
    assert workbook.properties.title
    for sheet in workbook.worksheets:
        assert not UNNAMED.fullmatch(sheet.title)
        assert [str(area) for area in sheet.merged_cells.ranges if area.min_row < area.max_row] == [], sheet.title
        if sheet.auto_filter.ref and sheet.title not in MIRRORED:
            columns = zip(*sheet[sheet.auto_filter.ref], strict=True)
            unheaded = [one[0].column for one in columns if not one[0].value and any(cell.value for cell in one)]
            assert unheaded == [], sheet.title
            assert sheet.freeze_panes, sheet.title


@pytest.mark.parametrize("name", KINDS)
def test_links_have_words(kinds, name):
    """What leads somewhere says where in words: no cell with a link is empty or shows a bare address."""
    for sheet in openpyxl.load_workbook(kinds / name, data_only=True).worksheets:
        for row in sheet.iter_rows():
            for cell in row:
                if cell.hyperlink is not None:
                    assert str(cell.value or "").strip(), f"{sheet.title}!{cell.coordinate}"
                    assert not str(cell.value).startswith(("http:", "https:", "#")), f"{sheet.title}!{cell.coordinate}"
