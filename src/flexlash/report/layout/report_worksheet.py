"""A worksheet of the report: it knows the book whose sheet it is, and with it which other sheets can be seen."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from xlsxwriter.worksheet import Worksheet

if TYPE_CHECKING:
    from flexlash.report.layout.styles import Book

__all__ = ["ReportWorksheet"]


class ReportWorksheet(Worksheet):  # type: ignore[misc]  # XlsxWriter has no types
    """A worksheet that `Book.sheet` made."""

    book: Book

    def __init__(self) -> None:
        """Make a worksheet whose rows have the usual height."""
        super().__init__()
        self.heights: dict[int, float] = {}

    def set_row(self, row: int, height: float | None = None, *rest: Any, **options: Any) -> Any:
        """Set the height [pt] of a row, which is remembered for the printed page."""
        if height is not None:
            self.heights[row] = height
        return super().set_row(row, height, *rest, **options)

    def print_area(self, *cells: Any) -> Any:
        """Set the area that is printed, of a sheet that can be seen: LibreOffice prints that of a hidden one, too."""
        return super().print_area(*cells) if self.book.shows(self.get_name()) else 0
