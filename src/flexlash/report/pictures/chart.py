"""Charts of page and files: all variants beside their limits, and of one variant its density, causes and segments."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flexlash.report.page.shape import Density
from flexlash.report.pictures.drawing import (
    AMBER,
    BLUE,
    DARK_AMBER,
    DARK_VERMILION,
    GREEN,
    GREY,
    INK,
    SKY,
    TRACK,
    VERMILION,
    Picture,
    Scale,
    finite,
    number,
)
from flexlash.schema.number_words import grouped

__all__ = ["Cause", "Spread", "causes_chart", "density_chart", "shares_chart", "spread_chart"]

_TOP, _NO_LIMIT, _ROW, _BAR, _BELOW = 26.0, 4.0, 38.0, 11.0, 26.0
_LEAST = 0.5
"""Per cent of the width below which no bar can be seen."""

_FAR = 1.0
"""Times its own width that a limit may lie beside a density and still be drawn with it."""

_BARS = {"fails": VERMILION, "marginal": AMBER, "meets": BLUE}
_WORDS = {"fails": DARK_VERMILION, "marginal": DARK_AMBER, "meets": GREEN}


@dataclass(frozen=True, kw_only=True)
class Spread:
    """A variant as the chart of all draws it: P2.5, median and P97.5, its limit and the verdict on it."""

    variant: str
    low: float
    median: float
    high: float
    limit: float | None = None
    verdict: str = ""


def spread_chart(
    name: str, spreads: Sequence[Spread], unit: str, *, of: int = 0, beside: Sequence[Spread] = ()
) -> Picture:
    """Return the chart of all variants, one below the other: a bar from P2.5 to P97.5, the median, the limit.

    `of` is how many variants there are, where not all of them are drawn. The scale has room for those `beside`, which
    another chart shows.
    """
    drawn = _finite(spreads)
    limits = sorted({one.limit for one in drawn if finite(one.limit)})
    scale = _scale([*drawn, *_finite(beside)])
    top = _TOP if limits else _NO_LIMIT
    bottom = top + _ROW * len(drawn)
    title = f"Backlash of {'the ' if of > len(drawn) else ''}{grouped(len(drawn))} variant{'s' * (len(drawn) != 1)}"
    title += f" that are worst, of {grouped(of)}" if of > len(drawn) else ""
    picture = Picture(name, title, _spread_words(drawn, limits, unit), bottom + _BELOW)
    picture.grid(scale, top, bottom, unit)
    for index, one in enumerate(drawn):
        _spread_row(picture, scale, one, top + _ROW * index, shares_limit=len(limits) == 1)
    if len(limits) == 1:
        picture.limit(scale, limits[0], top, bottom, f"limit {number(limits[0])}{unit}")
    elif limits:
        picture.text(0, top - 8, "dashed: each variant's limit", colour=DARK_VERMILION)
    return picture


def _finite(spreads: Sequence[Spread]) -> list[Spread]:
    return [one for one in spreads if all(map(finite, (one.low, one.median, one.high)))]


def _scale(spreads: Sequence[Spread]) -> Scale:
    values = [value for one in spreads for value in (one.low, one.high)]
    return Scale(values + [one.limit for one in spreads if finite(one.limit)])


def _spread_row(picture: Picture, scale: Scale, one: Spread, top: float, *, shares_limit: bool) -> None:
    """Draw a variant: its name and verdict above its bar."""
    picture.level(top + _ROW)
    low, middle, high = (scale.per_cent(value) for value in (one.low, one.median, one.high))
    bar = top + _ROW - _BAR - 5
    if finite(one.limit) and not shares_limit:
        picture.line(scale.per_cent(one.limit), bar - 5, bar + _BAR + 5, DARK_VERMILION, width=1.5, dashed=True)
    picture.bar(low, high, bar, _BAR, _BARS.get(one.verdict, GREY), least=_LEAST)
    picture.line(middle, bar - 3, bar + _BAR + 3, INK, width=2)
    picture.text(0, top + 15, one.variant, bold=True, longest=26)
    if one.verdict:
        picture.text(100, top + 15, one.verdict, anchor="end", colour=_WORDS.get(one.verdict, GREY), bold=True)


def _spread_words(drawn: Sequence[Spread], limits: Sequence[float], unit: str) -> str:
    """Return the chart of all variants in words."""
    if not drawn:
        return "There is no computed variant to draw."
    lowest, highest = min(one.low for one in drawn), max(one.high for one in drawn)
    limit = "No variant has a limit. " if not limits else (
        f"The limit is {number(limits[0])}{unit}. " if len(limits) == 1
        else f"The limits lie between {number(limits[0])}{unit} and {number(limits[-1])}{unit}. ")  # fmt: skip
    over = [one.variant for one in drawn if one.verdict == "fails"]
    failing = f"{grouped(len(over))} of them {'fails' if len(over) == 1 else 'fail'}. " if limits else ""
    return (
        "Worst first, a bar from the backlash that 2.5 % of units stay below to that which 97.5 % stay below, the "
        f"median as a line. They lie between {number(lowest)}{unit} and {number(highest)}{unit}. {limit}{failing}"
        "The table beside it has the numbers."
    )


def density_chart(name: str, density: Density, unit: str) -> Picture:
    """Return how the backlash of a variant is spread, vermilion over the limit; a far limit is told at the edge."""
    start, width, heights = density["start"], density["width"], density["heights"]
    limit, nominal, mean = density["limit"], density["nominal"], density.get("mean")
    most = max(heights, default=0.0) or 1.0
    edges = [start + index * width for index in range(len(heights) + 1)]
    points = [(x, height / most) for index, height in enumerate(heights) for x in edges[index : index + 2]]
    reach = _FAR * (edges[-1] - edges[0])
    is_far = finite(limit) and not edges[0] - reach <= limit <= edges[-1] + reach
    scale = Scale([*edges[:1], *edges[-1:], *filter(finite, (nominal, mean, None if is_far else limit))])
    top, bottom = 60.0, 230.0
    picture = Picture(name, "How the backlash is spread", _density_words(edges, limit, unit), bottom + _BELOW)
    picture.grid(scale, top, bottom, unit)
    for part, colour in zip(_parted(points, limit), (BLUE, VERMILION), strict=True):
        picture.area([(scale.per_cent(x), share) for x, share in part], top, bottom - top, colour)
    picture.level(bottom, INK)
    if finite(nominal):
        picture.line(scale.per_cent(nominal), top - 6, bottom, INK, width=1.5)
        picture.beside(scale.per_cent(nominal), top - 10, f"nominal {number(nominal)}{unit}", INK)
    if finite(mean):
        picture.line(scale.per_cent(mean), top - 22, bottom, GREY, width=1.5, dashed=True)
        picture.beside(scale.per_cent(mean), top - 26, f"mean {number(mean)}{unit}", GREY)
    if is_far and finite(limit):
        left = limit < edges[0]
        words = f"← limit {number(limit)}{unit}, far below" if left else f"limit {number(limit)}{unit}, far above →"
        picture.text(0 if left else 100, top - 43, words, anchor="start" if left else "end", colour=DARK_VERMILION)
    elif finite(limit):
        picture.limit(scale, limit, top - 38, bottom, f"limit {number(limit)}{unit}")
    return picture


def _density_words(edges: Sequence[float], limit: float | None, unit: str) -> str:
    """Return the density in words."""
    words = f"The backlash of units lies between {number(edges[0])}{unit} and {number(edges[-1])}{unit}. "
    if not finite(limit):
        return words + "No limit is given."
    if limit <= edges[0]:
        return words + f"All of it is over the limit of {number(limit)}{unit}."
    if limit >= edges[-1]:
        return words + f"All of it is within the limit of {number(limit)}{unit}."
    return words + f"What is over the limit of {number(limit)}{unit} is vermilion, the other part blue."


def _parted(
    points: Sequence[tuple[float, float]], limit: float | None
) -> tuple[list[tuple[float, float]], list[tuple[float, float]]]:
    """Return the points within a limit and those over it, both with the point at it."""
    within = [(x, y) for x, y in points if not finite(limit) or x <= limit]
    over = [(x, y) for x, y in points if finite(limit) and x > limit]
    if within and over and finite(limit):
        (x0, y0), (x1, y1) = within[-1], over[0]
        at = (limit, y0 + (y1 - y0) * (limit - x0) / (x1 - x0))
        within, over = [*within, at], [at, *over]
    return within, over


@dataclass(frozen=True, kw_only=True)
class Cause:
    """A dimension that scatters: its share of the variance, in words too, and the backlash at both of its limits."""

    name: str
    share: float
    words: str
    low: float | None = None
    high: float | None = None


def causes_chart(name: str, causes: Sequence[Cause], nominal: float, unit: str) -> Picture:
    """Return what causes the spread, greatest first: the backlash with each dimension at its limits, and its share."""
    ends = [value for cause in causes for value in (cause.low, cause.high) if finite(value)]
    scale = Scale([*ends, *filter(finite, (nominal,))])
    bottom = _ROW * len(causes) + 4
    told = "; ".join(f"{cause.name} {cause.words}" for cause in causes)
    words = f"With each dimension at its lower and upper limit, the others nominal. Shares of the variance: {told}."
    picture = Picture(name, "What causes the spread", words, bottom + _BELOW)
    picture.grid(scale, 0, bottom, unit)
    if finite(nominal):
        picture.line(scale.per_cent(nominal), 0, bottom, INK, width=1.5)
    for index, cause in enumerate(causes):
        top = _ROW * index
        for end, colour in ((cause.low, SKY), (cause.high, BLUE)):
            if finite(end) and finite(nominal):
                first, last = sorted((scale.per_cent(end), scale.per_cent(nominal)))
                picture.bar(first, last, top + 21, _BAR, colour)
        picture.text(0, top + 15, cause.name, longest=26)
        picture.text(100, top + 15, cause.words, anchor="end", bold=True)
    return picture


def shares_chart(name: str, title: str, shares: Sequence[tuple[str, float]]) -> Picture:
    """Return the parts of a whole, each from 0 to 1, one below the other: a bar for each on a track from 0 to 100 %."""
    shares = [(what, share) for what, share in shares if finite(share)]
    told = "; ".join(f"{what} {_per_cent(share)}" for what, share in shares)
    picture = Picture(name, title, told or "There is nothing to draw.", _ROW * len(shares) + 4)
    for index, (what, share) in enumerate(shares):
        top = _ROW * index
        picture.text(0, top + 15, what, longest=30)
        picture.text(100, top + 15, _per_cent(share), anchor="end", bold=True)
        picture.bar(0, 100, top + 21, _BAR, TRACK)
        picture.bar(0, 100 * min(1.0, max(0.0, share)), top + 21, _BAR, BLUE)
    return picture


def _per_cent(share: float) -> str:
    """Return a share in per cent, in three digits at most.

    >>> _per_cent(0.6912), _per_cent(0.0), _per_cent(0.00004), _per_cent(0.0312)
    ('69.1 %', '0 %', 'less than 0.1 %', '3.1 %')
    """
    return "less than 0.1 %" if 0 < share < 0.0005 else f"{100 * share:.1f}".removesuffix(".0") + " %"  # noqa: PLR2004
