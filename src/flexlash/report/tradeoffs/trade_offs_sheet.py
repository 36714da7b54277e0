"""The Trade-offs sheet: the front of backlash and mass, or cost, and spiders of the worst variants."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from flexlash.analysis.outcome import Outcome
from flexlash.decisions.trade_offs import TradeOff, quantile_of, trade_offs
from flexlash.report.extent import extent_of
from flexlash.report.layout.links import write_link
from flexlash.report.layout.styles import Book
from flexlash.report.report_data import Drawn
from flexlash.report.tradeoffs.front_chart import front_chart
from flexlash.report.tradeoffs.front_table import WIDTHS, Figure, FrontTable
from flexlash.report.tradeoffs.spider_block import SPIDER_ROWS, SpiderBlock
from flexlash.report.wording.labels import distinct_labels
from flexlash.schema.angle_unit import AngleUnit

__all__ = ["SHEET", "write_trade_offs"]

SHEET = "Trade-offs"
_SPIDERS = 3
"""Variants whose spider is drawn, the worst ones."""

_NAME = 24
_FIRST_CHART, _CHART_ROWS, _HEIGHT = 6, 21, 405
_WHOLE, _HALF = 940, 445
"""Widths of a chart alone, and of two side by side [px]."""

_RIGHT = 5
"""Column, from 0, of the second chart."""


def write_trade_offs(book: Book, outcome: Outcome, drawn: Sequence[Drawn]) -> None:
    """Write the sheet of the drawn variants, worst first; nothing without one."""
    if not drawn:
        return
    rows = outcome.validated.levers if outcome.validated else {}
    percent = outcome.settings.target_percent
    computed = [variant.computed for variant in drawn]
    base = min(range(len(drawn)), key=lambda place: computed[place].variant.row)
    quantiles = [quantile_of(variant.computed, variant.curve, percent) for variant in drawn]
    offers = trade_offs(computed, quantiles, rows, base)
    sheet = book.sheet(SHEET, landscape=False)
    for column, width in enumerate(WIDTHS):
        sheet.set_column(column, column, width)
    figures = [figure for figure in _FIGURES if any(getattr(offer, figure) is not None for offer in offers)]
    charted = len(drawn) > 1 and bool(figures)
    table = FrontTable(
        book=book,
        sheet=sheet,
        top=_FIRST_CHART + (_CHART_ROWS if charted else 0) + 1,
        drawn=drawn,
        offers=offers,
        labels=distinct_labels([variant.row["variant"] for variant in drawn], _NAME),
        bounds=outcome.settings.verdict_bounds,
        has_cost="cost" in figures,
    )
    sheet.write_string(0, 0, "Trade-offs: backlash against mass and cost", book.format("title"))
    sheet.set_row(0, 28)
    for row, note in enumerate(_notes(outcome, table, table.labels[base]), start=1):
        sheet.write_string(row, 0, note, book.format("quiet"))
    spiders = table.rows[1] + 2
    write_link(sheet, 5, 0, f"'{SHEET}'!A{spiders + 1}", "To the curves of each dimension", style=book.format("link"))
    table.write()
    table.write_helpers()
    for place, figure in enumerate(figures if charted else ()):
        text = f"{table.percentile} of the backlash of each variant over its {figure}, with the front: "
        text += _ends(offers, figure, book.angles)
        size = _WHOLE if len(figures) == 1 else _HALF, _HEIGHT
        book.insert(sheet, _FIRST_CHART, _RIGHT * place, front_chart(book, table, figure), size=size, text=text)
    last = _write_spiders(table, spiders)
    sheet.print_area(0, 0, last, len(WIDTHS) - 1)


def _ends(offers: Sequence[TradeOff], figure: Figure, unit: AngleUnit) -> str:
    """Return between which numbers the variants lie, of the percentile and of a figure."""
    numbers = [value for value in (getattr(offer, figure) for offer in offers) if value is not None]
    angles = [unit.of_radians(offer.quantile) for offer in offers]
    behind = " kg" if figure == "mass" else ""
    return f"{min(angles):.4g} to {max(angles):.4g}{unit.sign}, {min(numbers):.4g} to {max(numbers):.4g}{behind}"


_FIGURES: tuple[Figure, ...] = ("mass", "cost")


def _notes(outcome: Outcome, table: FrontTable, base: str) -> Iterator[str]:
    """Yield what the sheet shows, and what it cannot."""
    extent = extent_of(outcome)
    part = f" {extent.note}" if extent.note else ""
    yield (
        f"On the front: no other variant of the same torque is as good in both and better in one; {table.percentile} "
        f"is the backlash that {table.bounds.target_words} of units stay below.{part}"
    )
    without = sum(offer.mass is None for offer in table.offers)
    weighed = "Mass: wall, tooth rim, disk and fillets; no hub, bolts or teeth."
    if without:
        variants = "1 variant has" if without == 1 else f"{without} variants have"
        weighed += f" {variants} no mass here, since the material has no density."
    yield weighed
    if table.has_cost:
        yield (
            f"Relative cost: of changing “{base}”, the first one, into the variant, by the sheet Levers: steps either "
            "way, grades of other classes."
        )
    else:
        yield "Relative cost: told where the submission has the sheet Levers with costs."
    if any(offer.light is None for offer in table.offers):
        yield "–: no other variant of its torque has a mass, or a cost, to be compared."


def _write_spiders(table: FrontTable, row: int) -> int:
    """Write the spiders of the worst variants; return the last row."""
    breaks = []
    for variant, offer, label in list(zip(table.drawn, table.offers, table.labels, strict=True))[:_SPIDERS]:
        breaks.append(row)
        block = SpiderBlock(
            book=table.book,
            sheet=table.sheet,
            top=row,
            variant=variant,
            offer=offer,
            label=label,
            bounds=table.bounds,
        )
        block.write(len(WIDTHS) - 1)
        row += SPIDER_ROWS + 1
    table.sheet.set_h_pagebreaks(breaks)
    return row - 1
