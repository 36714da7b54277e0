"""Drawn variants → the data sheet behind Compare and Ranking: one row each, with the parts that boxes consist of."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexlash.report.formula.stored import Row, Stored
from flexlash.report.report_data import Drawn
from flexlash.report.wording.labels import distinct_labels
from flexlash.schema.angle_unit import AngleUnit
from flexlash.schema.arrays import Array
from flexlash.tolerance.distribution_curves import CURVE_SCORES

__all__ = ["COMPARED_NOTE", "CONNECTED", "compared_variants", "percentile_between", "share_heading"]

COMPARED_NOTE = (
    "Stored figures behind Compare, Ranking and Contributions, worst first, angles in the unit of the report; "
    "l/r: cylinder length over mean radius."
)
CONNECTED = ("cup", "hat")
"""Types of flexspline that have a disk."""

_QUARTILE_SCORE = 0.6744897501960817
_LABEL = 24
"""Most characters of a name under a chart."""


def share_heading(kind: str) -> str:
    """Return the heading of the disk shares of one type of flexspline."""
    return f"Disk share of {kind}s"


def compared_variants(drawn: Sequence[Drawn], angles: AngleUnit) -> Stored:
    """Return the data sheet of the drawn variants."""
    labels = distinct_labels([variant.row["variant"] for variant in drawn], _LABEL)
    return Stored("Compared", [_figures(variant, label, angles) for variant, label in zip(drawn, labels, strict=True)])


def _figures(variant: Drawn, label: str, angles: AngleUnit) -> Row:
    """Return a variant's row: what Ranking shows of it, the parts of its box, its points in the disk share chart."""
    row, kind = variant.row, variant.computed.variant.flexspline_type
    low, median, high = (angles.of(row[f"{key}_arcmin"]) for key in ("p2_5", "p50", "p97_5"))
    limit = None if row["backlash_limit_arcmin"] is None else angles.of(row["backlash_limit_arcmin"])
    lower, upper = (
        angles.of_radians(percentile_between(score, np.array(CURVE_SCORES), variant.curve.outputs))
        for score in (-_QUARTILE_SCORE, _QUARTILE_SCORE)
    )
    lower, upper = min(max(lower, low), median), max(min(upper, high), median)
    return {
        "Variant": row["variant"],
        "Label": label,
        "P2.5": low,
        "P25": lower,
        "P50": median,
        "P75": upper,
        "P97.5": high,
        "P99.865": angles.of(row["p99_865_arcmin"]),
        "Limit": limit,
        "Margin": None if limit is None else limit - high,
        "sd": angles.of(row["sd_arcmin"]),
        "Disk share": row["disk_share"],
        "l/r": _slenderness(variant),
        "P2.5 to P25": lower - low,
        "P25 to P50": median - lower,
        "P50 to P75": upper - median,
        "P75 to P97.5": high - upper,
        "P25 less P50": lower - median,
        "P75 less P50": upper - median,
        **{share_heading(each): row["disk_share"] if kind == each else None for each in CONNECTED},
    }


def _slenderness(variant: Drawn) -> float:
    """Return cylinder length over mean radius."""
    return variant.computed.variant.dimensions["cylinder_length"] / variant.computed.nominal.mean_radius


def percentile_between(score: float, scores: Array, outputs: Array) -> float:
    """Return a percentile between stored ones: the cubic through the four nearest, kept between its two neighbours.

    >>> round(percentile_between(0.5, np.arange(-3.0, 4.0), np.arange(-3.0, 4.0) ** 3), 9)
    0.125
    """
    after = int(np.searchsorted(scores, score))
    knots, values = scores[after - 2 : after + 2], outputs[after - 2 : after + 2]
    percentile = 0.0
    for index, knot in enumerate(knots):
        others = np.delete(knots, index)
        percentile += float(values[index] * np.prod((score - others) / (knot - others)))
    return min(max(percentile, float(values[1])), float(values[2]))
