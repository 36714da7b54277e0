"""The links of the chain on the sheet Drive: the wind-up and every source, from what was entered to the output."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from flexlash.analysis.drive_budget import WINDUP_SIGMAS
from flexlash.analysis.drive_sources import OutputPlay
from flexlash.mechanics.clearances import angle_at_output, play_angle, play_from_radial
from flexlash.report.drive.drive_page import COLUMNS, TABLE, DrivePage
from flexlash.report.formula.closed_forms import worked
from flexlash.report.formula.functions import IF, PI, SUM
from flexlash.report.formula.live import Live, Range, fill, live, put
from flexlash.schema.decision_rows import OtherSource
from flexlash.schema.findings import shown
from flexlash.schema.units import ARCMIN, as_entered

__all__ = ["Chain", "write_sources"]

(
    _NAME, _FORM, _VALUE, _LOWER, _UPPER, _RADIUS, _ANGLE, _RATIO, _KIND, _SHAPE, _SIGMAS, _HOW, _MEAN, _T, _C,
    _SQUARE, _REST, _OF_MEAN, _OF_VARIANCE, _OF_WORST,
) = range(len(COLUMNS))  # fmt: skip

_LONGEST = 30
_MILLIMETRE = 1e-3
_WAYS = {"arcmin": "φ", "mm at radius": "j/r", "mm radial play": "2 d tan α/r"}
"""How each form comes to an angle."""

_SHAPES = {"uniform": math.sqrt(3), "triangular": math.sqrt(1.5)}
"""c of what scatters between its limits alone."""


@dataclass(frozen=True, kw_only=True)
class Chain:
    """The sums of the table as references, angles and their squares, and the rows that it takes on the sheet."""

    mean: Live
    worst: Live
    square: Live
    rest: Live
    first_row: int
    last_row: int

    def series(self, row: int) -> list[int]:
        """Return the cells of a row's shares as a chart wants them: rows and columns, first and last."""
        return [row, _OF_MEAN, row, _OF_WORST]


def write_sources(page: DrivePage, links: Sequence[tuple[OtherSource, OutputPlay]]) -> Chain:
    """Write the table, the wind-up first and the sums last; `links` are the sources as entered and at the output."""
    headings = page.book.headings(*(heading for heading, _ in COLUMNS))
    for column, (heading, (_, width)) in enumerate(zip(headings, COLUMNS, strict=True)):
        page.sheet.set_column(column, column, width)
        page.sheet.write_string(TABLE, column, heading, page.book.format("header"))
    page.sheet.set_row(TABLE, 48)
    table = _Table(page, TABLE + 1)
    table.words({_NAME: "wind-up of the flexspline", _SHAPE: "as computed", _HOW: "its spread"})
    table.link(page.result("mean_arcmin"), WINDUP_SIGMAS * page.result("sd_arcmin"), live(1.0))
    for source, play in links:
        table.row += 1
        table.source(source, play)
    last = table.row
    return Chain(**table.sums(TABLE + 1), first_row=TABLE + 1, last_row=last)


class _Table:
    """The table as it grows: the present row, and what stands in its columns of numbers."""

    def __init__(self, page: DrivePage, row: int) -> None:
        self.book, self.sheet, self.shift, self.radians = page.book, page.sheet, page.shift, page.radians
        self.digits = page.book.angles.name
        self.row = row
        self._numbers: dict[int, list[Live]] = {}

    def words(self, texts: dict[int, str]) -> None:
        """Write texts by column."""
        for column, text in texts.items():
            self.sheet.write_string(self.row, column, text, self.book.format("text" if column == _NAME else "indented"))

    def source(self, source: OtherSource, play: OutputPlay) -> None:
        """Write a source as it was entered and what it comes to at the output."""
        is_angle = source.enter_as == "arcmin"
        size = ARCMIN if is_angle else _MILLIMETRE
        way = _WAYS[source.enter_as]
        self.words({
            _NAME: shown(source.name, longest=_LONGEST),
            _FORM: source.enter_as,
            _KIND: source.kind,
            _SHAPE: source.distribution if play.limits else "none",
            _HOW: way if source.side == "output" else f"{way}/i" if is_angle else f"{way}/i".replace("/r/i", "/(r i)"),
        })  # fmt: skip
        value, lower, upper = (
            self._entry(column, as_entered(number, size))
            for column, number in ((_VALUE, source.value), (_LOWER, source.lower), (_UPPER, source.upper))
        )
        to_output = self._conversion(source)
        middle = (lower + upper) / 2 if source.kind == "random" else value + (lower + upper) / 2
        self.link(to_output(middle), to_output((upper - lower) / 2), self._inflation(play))

    def _conversion(self, source: OtherSource) -> Callable[[Live], Live]:
        """Return what turns a play of a source into an angle at the output, with the numbers in their cells."""
        radius = angle = ratio = None
        if source.radius is not None:
            radius = self._entry(_RADIUS, as_entered(source.radius, _MILLIMETRE))
        if source.pressure_angle is not None:
            angle = self._entry(_ANGLE, as_entered(source.pressure_angle, math.pi / 180))
        if source.side == "input":
            ratio = self._entry(_RATIO, source.ratio)

        def to_output(play: Live) -> Live:
            if angle is not None:
                play = worked(play_from_radial, play, angle * PI / 180)
            if radius is not None:
                play = worked(play_angle, play, radius) / self.radians
            elif (times := self.book.angles.per_arcmin) != 1:
                play = times * play
            return play if ratio is None else worked(angle_at_output, play, ratio)

        return to_output

    def _inflation(self, play: OutputPlay) -> Live:
        """Return c of a source, in the cell of its sigma where that is what it follows from."""
        limits = play.limits
        if limits is None:
            return live(1.0)
        if limits.distribution == "normal":
            return 3.0 / self._entry(_SIGMAS, limits.sigma)
        if limits.distribution in _SHAPES:
            return live(_SHAPES[limits.distribution])
        self.sheet.write_number(self.row, _SIGMAS, limits.sigma, self.book.format("text", "general"))
        return live(play.inflation)

    def _entry(self, column: int, number: float) -> Live:
        """Write a number that a reader may change."""
        return fill(self.sheet, self.row, column, number, self.book.format("input", "general"))

    def link(self, mean: Live, tolerance: Live, inflation: Live) -> None:
        """Write what a link has of the chain: its average, T, c, and what follows from them."""
        self._put(_MEAN, mean)
        reach, factor = self._put(_T, tolerance), self._put(_C, inflation)
        self._put(_SQUARE, (factor * reach) ** 2.0)
        self._put(_REST, ((1.0 - self.shift) * factor * reach) ** 2.0)

    def _put(self, column: int, value: Live) -> Live:
        cell = put(self.sheet, self.row, column, value, self.book.format("text", self.digits))
        self._numbers.setdefault(column, []).append(cell)
        return cell

    def sums(self, first: int) -> dict[str, Live]:
        """Write the sums below the links, and beside each link its shares of them; return the sums."""
        self.row += 1
        self.sheet.write_string(self.row, _NAME, "sum", self.book.format("label"))
        found = {
            name: put(self.sheet, self.row, column, SUM(self._range(column)), self.book.format("label", self.digits))
            for name, column in (("mean", _MEAN), ("worst", _T), ("square", _SQUARE), ("rest", _REST))
        }
        shares = {_OF_MEAN: (_MEAN, "mean"), _OF_VARIANCE: (_SQUARE, "square"), _OF_WORST: (_T, "worst")}
        for column, (of, total) in shares.items():
            for row, number in enumerate(self._numbers[of], start=first):
                share = IF(found[total].equals(0.0), 0.0, number / found[total])
                put(self.sheet, row, column, share, self.book.format("text", "0.0%"))
        return found

    def _range(self, column: int) -> Range:
        cells = self._numbers[column]
        return Range(f"{cells[0].text}:{cells[-1].text}", [cell.value for cell in cells])
