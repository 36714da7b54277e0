"""The data sheet Curves: what the charts and the Explorer look up, one row per drawn variant, angles in arcmin."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from flexlash.analysis.run_summary import share_words
from flexlash.report.formula.stored import Stored
from flexlash.report.report_data import Drawn
from flexlash.report.wording.labels import distinct_labels
from flexlash.report.wording.measured_parts import left_open_words
from flexlash.schema.arrays import Array
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.units import ARCMIN
from flexlash.tolerance.distribution_curves import CURVE_SCORES, HISTOGRAM_BINS

__all__ = ["CAUSES", "CURVES_NOTE", "FIGURE_ERRORS", "SEGMENTS", "error_heading", "score_heading", "stored_curves"]

CURVES_NOTE = (
    "Stored distributions behind the charts [arcmin]. z: percentile at this normal score, computed, not interpolated; "
    "e: standard error of that score; bins and causes are shares of all units and of the variance."
)
CAUSES = 8
"""Most dimensions of a tornado."""

SEGMENTS = {
    "tooth_band": "Tooth face",
    "rim": "Tooth rim",
    "wall": "Wall",
    "junction_fillet": "Junction fillet",
    "disk_body": "Disk",
    "hub_fillet": "Hub fillet",
}
_LABEL = 24
"""Most characters of a name under a chart."""

_OUTPUT_DIGITS, _HEIGHT_DIGITS, _ERROR_DIGITS = 12, 6, 4
"""Digits that are stored: what the reading of a share asks for, and less where a number is drawn or an estimate."""
_RESULTS = {
    "Mean": "mean_arcmin",
    "sd": "sd_arcmin",
    "P97.5": "p97_5_arcmin",
    "P99.865": "p99_865_arcmin",
    "Nominal": "backlash_arcmin",
    "Worst case low": "worst_case_low_arcmin",
    "Worst case high": "worst_case_high_arcmin",
    "Cylinder only": "cylinder_only_backlash_arcmin",
    "Within-lot sd": "within_lot_sd_arcmin",
    "Between-lots sd": "between_lots_sd_arcmin",
}
"""Heading and Results key of each angle."""

FIGURE_ERRORS = {
    heading: (f"error of {heading}", f"{stem}_standard_error_arcmin")
    for heading, stem in {
        "Mean": "mean",
        "sd": "sd",
        "P2.5": "p2_5",
        "P50": "p50",
        "P97.5": "p97_5",
        "P99.865": "p99_865",
        "Within-lot sd": "within_lot_sd",
        "Between-lots sd": "between_lots_sd",
    }.items()
}
"""Heading and Results key of the standard error of a figure, by the figure's own heading."""


def score_heading(score: float) -> str:
    """Return the heading of the percentile at a normal score."""
    return f"z {score:+.1f}"


def error_heading(score: float) -> str:
    """Return the heading of the standard error of the score of a percentile."""
    return f"e {score:+.1f}"


def stored_curves(drawn: Sequence[Drawn]) -> Stored:
    """Return the data sheet of the drawn variants, worst first."""
    labels = distinct_labels([variant.row["variant"] for variant in drawn], _LABEL)
    return Stored("Curves", [dict(_entries(variant, label)) for variant, label in zip(drawn, labels, strict=True)])


def _entries(variant: Drawn, label: str) -> Iterator[tuple[str, str | float | None]]:
    """Yield a variant's headings and values in order."""
    row, curve = variant.row, variant.curve
    yield "Variant", row["variant"]
    yield "Label", label
    yield "Over limit", None if row["backlash_limit_arcmin"] is None else share_words(row)
    yield "P2.5", row["p2_5_arcmin"]
    yield "P2.5 to P97.5", row["p97_5_arcmin"] - row["p2_5_arcmin"]
    yield "P50", row["p50_arcmin"]
    yield "Limit", row["backlash_limit_arcmin"]
    yield from ((heading, row[key]) for heading, key in _RESULTS.items())
    yield from ((heading, row[key]) for heading, key in FIGURE_ERRORS.values())
    yield "Lots failing", row["lots_failing"]
    yield "error of Lots failing", row["lots_failing_standard_error"]
    yield "Von Mises", row["von_mises_MPa"]
    limit = row["elastic_limit_torque_Nm"]
    yield "Times to yield", None if limit is None else limit / variant.computed.variant.dimensions["torque"]
    yield "Left open", left_open_words(row) or None
    yield "Rarest share", curve.rarest
    outputs = _rounded(curve.outputs / ARCMIN, _OUTPUT_DIGITS)
    yield from ((score_heading(score), value) for score, value in zip(CURVE_SCORES, outputs, strict=True))
    errors = _rounded(curve.score_errors, _ERROR_DIGITS)
    yield from ((error_heading(score), error) for score, error in zip(CURVE_SCORES, errors, strict=True))
    yield "Bin start", float(curve.edges[0]) / ARCMIN
    yield "Bin width", float(curve.edges[-1] - curve.edges[0]) / HISTOGRAM_BINS / ARCMIN
    heights = _rounded(curve.heights, _HEIGHT_DIGITS)
    yield from ((f"Bin {number}", height) for number, height in enumerate(heights, start=1))
    yield from _causes(variant)
    for segment, name in SEGMENTS.items():
        angle = getattr(variant.computed.nominal, f"{segment}_windup")
        yield name, 2 * angle / ARCMIN if isinstance(angle, float) else 0.0


def _rounded(values: Array, digits: int) -> list[float]:
    """Return numbers with so many digits, which a reader need not load more of."""
    return [float(f"{value:.{digits - 1}e}") for value in values.tolist()]


def _causes(variant: Drawn) -> Iterator[tuple[str, str | float | None]]:
    """Yield the dimensions that move the backlash most, by their share of the variance, and how far each does."""
    spread = variant.computed.spread
    ranked: list[tuple[str, float]] = []
    if spread is not None:
        ranked = sorted(spread.shares.items(), key=lambda item: (-item[1], item[0]))[:CAUSES]
    for number in range(1, CAUSES + 1):
        name, share = ranked[number - 1] if number <= len(ranked) else ("", None)
        low, high = spread.swings[name] if spread is not None and name else (None, None)
        yield f"Cause {number}", dimension_words(name) if name else None
        yield f"Share {number}", share
        yield f"Low {number}", None if low is None else low / ARCMIN
        yield f"High {number}", None if high is None else high / ARCMIN
