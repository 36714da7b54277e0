"""The colours of every kind of workbook: letters and series stand out, and no kind of sight confuses two series."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
import openpyxl
import pytest
from colours import SIGHTS, contrast, difference, lab_difference, seen
from drawings import charts_of
from openpyxl.utils import range_boundaries
from workbook_kinds import KINDS

WHITE, BLACK = "#FFFFFF", "#000000"
LETTERS, LARGE_LETTERS, GRAPHICS = 4.5, 3.0, 3.0
"""Least contrasts by WCAG 2.2, 1.4.3 and 1.4.11."""

LARGE, LARGE_BOLD = 18, 14
"""Letters from this size [pt] on are large."""

APART = 12.0
"""Least difference CIEDE2000 of two series of a chart that are told apart by their colour alone."""

SHARMA = (
    ((50, 2.6772, -79.7751), (50, 0, -82.7485), 2.0425),
    ((50, -1, 2), (50, 0, 0), 2.3669),
    ((50, 2.49, -0.001), (50, -2.49, 0.0011), 7.2195),
    ((50, 2.5, 0), (50, 0, -2.5), 4.3065),
    ((50, 2.5, 0), (61, -5, 29), 22.8977),
    ((60.2574, -34.0099, 36.2677), (60.4626, -34.1751, 39.4387), 1.2644),
    ((6.7747, -0.2908, -2.4247), (5.8714, -0.0985, -2.2286), 0.6377),
    ((2.0776, 0.0795, -1.1350), (0.9033, -0.0636, -0.5514), 0.9082),
)
"""Pairs of CIELAB colours and their difference, from the table of Sharma, Wu and Dalal."""


def _shown(colour) -> str:
    """Return a colour of openpyxl in six digits, empty for one that no colour was given."""
    return f"#{colour.rgb[-6:]}" if colour is not None and colour.type == "rgb" else ""


def _ground(fill) -> str:
    return _shown(fill.fgColor) if fill is not None and fill.patternType == "solid" else ""


def _letters(path: Path) -> Iterator[tuple[str, str, str, float]]:
    """Yield where, colour of letters, ground and least contrast of each look that letters have in a workbook.

    A conditional format is looked at on each of the looks of the cells that it covers.
    """
    for sheet in openpyxl.load_workbook(path).worksheets:
        for cell in _looks(sheet, sheet.calculate_dimension()):
            yield f"{sheet.title}!{cell.coordinate}", *_own(cell), _least(cell.font)
        for covered in sheet.conditional_formatting:
            below = [cell for area in str(covered.sqref).split() for cell in _looks(sheet, area)]
            for rule in covered.rules:
                for cell, (letters, ground) in itertools.product(below, _conditional(rule)):
                    own = _own(cell)
                    yield f"{sheet.title}!{cell.coordinate} if", letters or own[0], ground or own[1], _least(cell.font)


def _looks(sheet, area: str) -> Iterable:
    """Return a cell of each look that a sheet has in an area."""
    left, top, right, bottom = range_boundaries(area)
    rows = sheet.iter_rows(min_row=top, max_row=min(bottom, sheet.max_row), min_col=left, max_col=right)
    return {cell.style_id: cell for row in rows for cell in row}.values()


def _own(cell) -> tuple[str, str]:
    return _shown(cell.font.color) or BLACK, _ground(cell.fill) or WHITE


def _conditional(rule) -> Iterator[tuple[str, str]]:
    """Yield colours of letters and ground that a rule of a conditional format gives, empty where it leaves them."""
    if rule.dxf is not None:
        fill = rule.dxf.fill
        ground = "" if fill is None else _shown(fill.bgColor) or _shown(fill.fgColor)
        yield "" if rule.dxf.font is None else _shown(rule.dxf.font.color), ground
    for colour in () if rule.colorScale is None else rule.colorScale.color:
        yield "", _shown(colour)


def _least(font) -> float:
    return LARGE_LETTERS if font.sz >= LARGE or (font.b and font.sz >= LARGE_BOLD) else LETTERS


@pytest.mark.slow
@pytest.mark.parametrize("name", KINDS)
def test_letters_stand_out_from_their_ground(kinds, name):
    """Every look of letters has the contrast that WCAG asks for, also where a conditional format colours the cell."""
    looks = list(_letters(kinds / name))
    assert looks
    faint = {
        f"{contrast(letters, ground):.2f} {letters} on {ground}": where
        for where, letters, ground, least in looks
        if letters != ground and contrast(letters, ground) < least
    }
    assert faint == {}


@pytest.mark.slow
@pytest.mark.parametrize("name", KINDS)
def test_series_stand_out_and_are_told_apart(kinds, name):
    """An area, line or mark of each series has 3:1 on white; no sight confuses two of a chart that differ by colour."""
    faint, alike = set(), set()
    for title, series in charts_of(kinds / name):
        for one in series:
            if max(contrast(colour, WHITE) for colour in one.colours) < GRAPHICS:
                faint.add(f"{title}: {one.name} {one.colours}")
        for one, other in itertools.combinations(series, 2):
            apart = min(difference(one.main, other.main, sight) for sight in SIGHTS)
            if one.form == other.form and apart < APART:
                alike.add(f"{title}: {one.name}, {other.name}: {one.main} {other.main} {apart:.1f}")
    assert (faint, alike) == (set(), set())


def test_contrast_is_that_of_wcag():
    """Black on white has 21, the grey that is known for it 4.54, and a colour on itself 1."""
    assert contrast(BLACK, WHITE) == pytest.approx(21)
    assert contrast("#767676", WHITE) == pytest.approx(4.54, abs=0.005)
    assert contrast("#D55E00", "#D55E00") == 1


@pytest.mark.parametrize(("one", "other", "known"), SHARMA)
def test_difference_is_ciede2000(one, other, known):
    """The differences are those of the published table, either way round."""
    assert lab_difference(np.array(one), np.array(other)) == pytest.approx(known, abs=5e-5)
    assert lab_difference(np.array(other), np.array(one)) == pytest.approx(known, abs=5e-5)


def test_colours_are_seen_as_published():
    """White stays white; who lacks red or green hardly tells these two apart, who lacks blue this from green."""
    for sight in SIGHTS:
        assert seen(WHITE, sight) == pytest.approx([100, 0, 0], abs=0.05)
    known = difference("#FF0000", "#00A000")
    assert all(difference("#FF0000", "#00A000", sight) < known / 2 for sight in list(SIGHTS)[1:3])
    assert difference("#0060FF", "#00A0A0", "no blue (tritanopia)") < difference("#0060FF", "#00A0A0") / 2
