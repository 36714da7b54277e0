"""What the reader of the Explorer chooses: variant, unit, limit, wanted share, target; a wrong entry is not used."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flexlash.report.formula.functions import AND, CONCATENATE, IF, ISNUMBER, MAX, match_exactly
from flexlash.report.formula.live import Live, fill, live, put
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.styles import Book
from flexlash.schema.angle_unit import ANGLE_UNITS
from flexlash.schema.limit_verdict import MARGINAL, VerdictBounds

__all__ = ["NONE", "Choice"]

NONE = "none"
_FIRST_ROW = 3
_RAREST, _COMMONEST = 1e-6, 0.999999
_DIGITS = 12
"""Decimals of a share: 1 − 0.00135 need not be 0.99865 to the last bit."""

_LABELS = ("Variant", "Angle unit", "Another limit", "Wanted share over a limit", "Target within the limit")


class Choice:
    """The reader's cells, as references, with the picked variant's entries of Curves.

    `rank` is the number of the variant among the stored ones. `known` is whether variant and unit are of their lists;
    without, nothing is shown. `other` is the typed limit, an empty text where none is to be used; `wanted` is the share
    to find the limit of, at first what the target allows, `wants` whether it is one; `allowed` is the share over the
    limit with which a variant meets it.
    """

    def __init__(self, book: Book, sheet: Any, curves: Stored, bounds: VerdictBounds, unit: Live | None) -> None:
        self._curves = curves
        entry, hint = book.format("input"), book.format("hint")
        entry_of_share = book.format("input", "0.0000##%")
        names = curves.cells("Variant")
        for row, label in enumerate(_LABELS, start=_FIRST_ROW):
            sheet.write_string(row, 0, label, book.format("label"))
        self.name = fill(sheet, _FIRST_ROW, 1, str(names.values[0]), entry)
        if unit is None:
            unit = fill(sheet, _FIRST_ROW + 1, 1, book.angles.name, entry)
        else:
            unit = put(sheet, _FIRST_ROW + 1, 1, unit, entry)
        typed = fill(sheet, _FIRST_ROW + 2, 1, "", book.format("input", "general"))
        wanted = fill(sheet, _FIRST_ROW + 3, 1, bounds.meets, entry_of_share)
        _list(sheet, _FIRST_ROW, f"={names.text}", "Variant", "Everything on this sheet follows.")
        _list(sheet, _FIRST_ROW + 1, list(ANGLE_UNITS), "Angle unit", "The limit below is read in it, too.")
        _number(sheet, _FIRST_ROW + 2, (0, 1e9), "Any limit", "Blank: the limit of the variant.")
        _number(sheet, _FIRST_ROW + 3, (_RAREST, _COMMONEST), "Wanted share", "From 0.0001 % (1 ppm) to 99.9999 %.")
        words = f'"◄ number "0" of {len(names.values)}";;"◄ not in the list: pick one"'
        rank = put(sheet, _FIRST_ROW, 2, match_exactly(self.name, names), book.format("hint", words))
        words = '"◄ arcmin or arcsec (1 arcmin = "0")";;"◄ arcmin or arcsec, nothing else"'
        factor = IF(unit.equals("arcsec"), ANGLE_UNITS["arcsec"].per_arcmin, IF(unit.equals("arcmin"), 1.0, 0.0))
        factor = put(sheet, _FIRST_ROW + 1, 2, factor, book.format("hint", words))
        self.known = AND(rank > 0.0, factor > 0.0)
        self.rank, self._factor = MAX(rank, 1.0), MAX(factor, 1.0)
        self.unit = IF(factor > 0.0, unit, live(""))
        self._write_limit(sheet, hint, typed)
        sound = IF(ISNUMBER(wanted), AND(wanted >= _RAREST, wanted <= _COMMONEST), Live("FALSE", value=False))
        remark = IF(sound, "◄ gives the limit for it, below", "◄ a share from 0.0001 % to 99.9999 %")
        put(sheet, _FIRST_ROW + 3, 2, remark, hint)
        self.wants = AND(self.known, sound)
        self.wanted = IF(sound, wanted, bounds.meets)
        self.allowed = self._allowed(sheet, entry_of_share, hint, bounds)

    def _write_limit(self, sheet: Any, hint: Any, typed: Live) -> None:
        """Say in which unit the typed limit is read, or that it is none."""
        sound = IF(ISNUMBER(typed), typed > 0.0, Live("FALSE", value=False))
        remark = IF(sound, CONCATENATE("◄ read in ", self.unit), "◄ not a number above 0: not used")
        put(sheet, _FIRST_ROW + 2, 2, IF(typed.equals(""), "◄ blank: its own", remark), hint)
        self.other = IF(sound, typed, "")
        self.is_blank = typed.equals("")

    def _allowed(self, sheet: Any, entry: Any, hint: Any, bounds: VerdictBounds) -> Live:
        """Write the target, and return the share over the limit that it allows."""
        row, least = _FIRST_ROW + len(_LABELS) - 1, 1 - MARGINAL
        target = fill(sheet, row, 1, round(1 - bounds.meets, _DIGITS), entry)
        _number(sheet, row, (least, _COMMONEST), "Target", "Share of units that shall be within the limit.")
        sound = IF(ISNUMBER(target), AND(target >= least, target <= _COMMONEST), Live("FALSE", value=False))
        remark = IF(sound, "◄ what the verdict asks for", "◄ 97.5 % to 99.9999 %: not used")
        put(sheet, row, 2, remark, hint)
        return IF(sound, live(1.0) - target, bounds.meets)

    def text(self, heading: str) -> Live:
        """Return what Curves holds for the variant; an empty text where it holds nothing."""
        return self._curves.pick(self.rank, heading)

    def angle(self, heading: str) -> Live:
        """Return an angle of Curves in the chosen unit; an empty text where there is none."""
        return self._curves.pick(self.rank, heading, self._factor)

    def figure(self, value: Live) -> Live:
        """Return a figure, or that there is none where variant or unit are not of their lists."""
        return IF(self.known, value, NONE)


def _list(sheet: Any, row: int, source: str | Sequence[str], title: str, message: str) -> None:
    sheet.data_validation(row, 1, row, 1, {
        "validate": "list",
        "source": source,
        "input_title": title,
        "input_message": message,
        "error_title": title,
        "error_message": "Pick one from the list.",
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
