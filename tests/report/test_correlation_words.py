"""What a report says of dimensions that scatter together: only where there are some, and then wherever shares stand."""

from __future__ import annotations

import openpyxl
import pytest
from entry_books import CUP, UNIFORM_CUP, correlations, entry_book

from flexlash.pipeline import run

TIED = correlations(("disk_thickness", "wall_thickness", 0.5), ("mean_radius", "wall_thickness", -0.125))


@pytest.fixture(scope="module")
def texts(tmp_path_factory):
    """Return a function that gives all texts of sheets of the report with and without correlations."""
    folder, books = tmp_path_factory.mktemp("said"), {}
    for tied in (False, True):
        sheets = {"variants": [CUP], "tolerances": UNIFORM_CUP} | ({"correlations": TIED} if tied else {})
        path = entry_book(folder / f"{tied}.xlsx", **sheets)
        run(path, folder / f"report {tied}.xlsx", samples=64)
        books[tied] = openpyxl.load_workbook(folder / f"report {tied}.xlsx", read_only=True)

    def of(sheet, *, tied):
        return [cell for row in books[tied][sheet].iter_rows(values_only=True) for cell in row if isinstance(cell, str)]

    return of


@pytest.mark.slow
def test_about_names_the_pairs_and_how_their_numbers_are_made(texts):
    """About lists the pairs of each class, the cross terms of the first-order sd, and how shares are shared out."""
    about = "\n".join(texts("About", tied=True))
    assert "Class shop: Mean radius with wall thickness -0.125; Wall thickness with disk thickness 0.5." in about
    assert "2 r (slope × sd)(slope × sd)" in about
    assert "Shapley's value" in about
    assert "independently" not in about


@pytest.mark.slow
def test_about_says_that_all_is_independent_where_it_is(texts):
    """Without correlations About says so, and nothing of cross terms or Shapley."""
    about = "\n".join(texts("About", tied=False))
    assert "All dimensions of a variant scatter independently of one another." in about
    assert "2 r (slope" not in about
    assert "Shapley" not in about


@pytest.mark.slow
@pytest.mark.parametrize("sheet", ["Sensitivity", "Contributions"])
def test_notes_beside_shares_say_whose_they_are(texts, sheet):
    """Sheets with shares tell that those of dimensions which scatter together are shared out."""
    note = "What dimensions that scatter together cause as a group is shared out among them by Shapley's value."
    assert any(note in text for text in texts(sheet, tied=True))
    assert not any("Shapley" in text for text in texts(sheet, tied=False))
