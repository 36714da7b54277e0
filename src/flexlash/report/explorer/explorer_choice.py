"""What the reader of the Explorer chooses: variant, angle unit, limit, wanted share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flexlash.report.live import Live, fill, place_of_name, put, when
from flexlash.report.stored import Stored
from flexlash.report.styles import Book

__all__ = ["USUAL_SHARE", "Choice"]

USUAL_SHARE = 0.00135
"""Share of a normal beyond its mean + 3 sd."""

_FIRST_ROW = 3
_SECONDS = 60.0


class Choice:
    """The reader's cells, as references, with the picked variant's entries of Curves."""

    def __init__(self, book: Book, sheet: Any, curves: Stored) -> None:
        self._curves = curves
        names = curves.cells("Variant")
        all_names = [str(row["Variant"]) for row in curves.rows]
        labels = ("Variant", "Angle unit", "Another limit", "Wanted share over a limit")
        hints = ("", "", "◄ blank: its own", "◄ gives the limit for it, below")
        for row, (label, hint) in enumerate(zip(labels, hints, strict=True), start=_FIRST_ROW):
            sheet.write_string(row, 0, label, book.format("label"))
            sheet.write_string(row, 2, hint, book.format("quiet"))
        self.name = fill(sheet, _FIRST_ROW, 1, all_names[0], book.format("input"))
        place = place_of_name(self.name, names, all_names)
        self.place = put(
            sheet, _FIRST_ROW, 2, place, book.format("hint", f'"◄ pick; now number "0" of {len(all_names)}"')
        )
        self.unit = fill(sheet, _FIRST_ROW + 1, 1, "arcmin", book.format("input"))
        self.other = fill(sheet, _FIRST_ROW + 2, 1, "", book.format("input", "general"))
        self.wanted = fill(sheet, _FIRST_ROW + 3, 1, USUAL_SHARE, book.format("input", "0.0000##%"))
        _list(sheet, _FIRST_ROW, f"={names}", "Variant", "Everything on this sheet follows.")
        _list(sheet, _FIRST_ROW + 1, ["arcmin", "arcsec"], "Angle unit", "The limit below is read in it, too.")
        _number(sheet, _FIRST_ROW + 2, (0, 1e9), "Any limit", "Blank: the limit of the variant.")
        _number(sheet, _FIRST_ROW + 3, (1e-6, 0.999999), "Wanted share", "From 0.0001 % (1 ppm) to 99.9999 %.")
        factor = when(self.unit.equals("arcsec"), _SECONDS, 1.0)
        words = '"◄ arcmin or arcsec (1 arcmin = "0")"'
        self.factor = put(sheet, _FIRST_ROW + 1, 2, factor, book.format("hint", words))

    def text(self, heading: str) -> Live:
        """Return what Curves holds for the variant; an empty text where it holds nothing."""
        return self._curves.pick(self.place, heading)

    def angle(self, heading: str) -> Live:
        """Return an angle of Curves in the chosen unit; an empty text where there is none."""
        return self._curves.pick(self.place, heading, self.factor)


def _list(sheet: Any, row: int, source: str | Sequence[str], title: str, message: str) -> None:
    sheet.data_validation(row, 1, row, 1, {
        "validate": "list",
        "source": source,
        "input_title": title,
        "input_message": message,
        "error_title": title,
        "error_message": "Pick an entry of the list.",
    })  # fmt: skip


def _number(sheet: Any, row: int, ends: tuple[float, float], title: str, message: str) -> None:
    sheet.data_validation(row, 1, row, 1, {
        "validate": "decimal",
        "criteria": "between",
        "minimum": ends[0],
        "maximum": ends[1],
        "input_title": title,
        "input_message": message,
        "error_title": title,
        "error_message": "A number is required here.",
    })  # fmt: skip
