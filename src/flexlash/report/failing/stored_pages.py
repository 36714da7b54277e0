"""The data sheet Pages: what the charts of the failing variants' pages draw, one row per page."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from flexlash.report.explorer.curves_sheet import CAUSES, SEGMENTS
from flexlash.report.formula.stored import Stored
from flexlash.report.report_data import Drawn
from flexlash.report.wording.summary_facts import rough
from flexlash.schema.angle_unit import AngleUnit
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.units import ARCMIN
from flexlash.tolerance.distribution_curves import HISTOGRAM_BINS

__all__ = ["LINES", "PAGES_NOTE", "causes_of_page", "ends_of_histogram", "is_drawn", "stored_pages"]

PAGES_NOTE = (
    "Stored figures behind the charts of Failing variants, angles in the unit of the report: middle and share of each "
    "bin, within the limit and over it; lines from the axis to the highest bin; causes and segments."
)
LINES = {"Limit": "backlash_limit_arcmin", "Nominal": "backlash_arcmin", "Mean": "mean_arcmin"}
"""Lines of the density, by the key of Results where each stands."""

_TOPS = {"Limit": 1.3, "Nominal": 1.2, "Mean": 1.1}
"""How many times as high as the highest bin each line is: lines at one place are told apart above it."""

_FAR = 3.0
"""How many times as far as it is wide a distribution may lie from its limit that is drawn beside it."""

_CAUSE = 0.001
"""Share of the variance below which a dimension is no cause that a page shows."""


def stored_pages(variants: Sequence[Drawn], angles: AngleUnit) -> Stored:
    """Return the data sheet of the variants that have a page."""
    return Stored("Pages", [dict(_entries(variant, angles)) for variant in variants])


def is_drawn(variant: Drawn, line: str) -> bool:
    """Return whether a line lies near enough to the distribution to be drawn beside it."""
    low, high = ends_of_histogram(variant)
    value = variant.row[LINES[line]]
    return value is not None and low - _FAR * (high - low) <= value <= high + _FAR * (high - low)


def ends_of_histogram(variant: Drawn) -> tuple[float, float]:
    """Return the ends of the histogram [arcmin]."""
    edges = variant.curve.edges
    return float(edges[0]) / ARCMIN, float(edges[-1]) / ARCMIN


def _entries(variant: Drawn, angles: AngleUnit) -> Iterator[tuple[str, str | float | None]]:
    """Yield a variant's headings and values in order."""
    row, heights = variant.row, variant.curve.heights.tolist()
    low, high = ends_of_histogram(variant)
    width = (high - low) / HISTOGRAM_BINS
    middles = [float(f"{angles.of(low + (place + 0.5) * width):.9g}") for place in range(HISTOGRAM_BINS)]
    lines = {line: None if row[key] is None else angles.of(row[key]) for line, key in LINES.items()}
    limit = lines["Limit"]
    over = [limit is not None and middle > limit for middle in middles]
    yield "Variant", row["variant"]
    yield from ((f"Middle {place}", middle) for place, middle in enumerate(middles, start=1))
    for heading, side in (("Within", False), ("Over", True)):
        for place, (height, beyond) in enumerate(zip(heights, over, strict=True), start=1):
            yield f"{heading} {place}", float(f"{height:.6g}") if beyond == side else None
    for line, value in lines.items():
        yield f"{line} from", value
        yield f"{line} to", value
        yield f"{line} bottom", 0.0
        yield f"{line} top", float(f"{_TOPS[line] * max(heights):.6g}")
    causes = causes_of_page(variant, angles)
    for heading, place in (("Cause", 0), ("At lower limit", 1), ("At upper limit", 2)):
        for number in range(CAUSES):
            yield f"{heading} {number + 1}", causes[number][place] if number < len(causes) else None
    for segment, name in SEGMENTS.items():
        angle = getattr(variant.computed.nominal, f"{segment}_windup")
        yield name, angles.of(2 * angle / ARCMIN) if isinstance(angle, float) else 0.0


def causes_of_page(variant: Drawn, angles: AngleUnit) -> list[tuple[str, float, float]]:
    """Return name with share, and what the dimension does at its lower and upper limit, the greatest share first."""
    spread = variant.computed.spread
    if spread is None:
        return []
    about = "≈ " if rough(variant.row) else ""
    ranked = sorted(spread.shares.items(), key=lambda item: (-item[1], item[0]))
    causes: list[tuple[str, float, float]] = []
    for name, share in ranked[:CAUSES]:
        if share >= _CAUSE or not causes:
            low, high = spread.swings[name]
            half = angles.of_radians((high - low) / 2)
            words = dimension_words(name)
            causes.append((f"{words[:1].upper()}{words[1:]} ({about}{100 * share:.1f} %)", -half, half))
    return causes
