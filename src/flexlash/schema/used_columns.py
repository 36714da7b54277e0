"""The fields of Tolerances used: the limits of every dimension of every variant, and how parts scatter there."""

from __future__ import annotations

from typing import Any

from flexlash.schema.columns import DIMENSIONS, Column

__all__ = ["TOLERANCES_USED"]


def _used(key: str, label: str, text: str, **rest: Any) -> Column:
    return Column(sheet="Tolerances used", key=key, label=label, help=text, **{"role": "result", **rest})


TOLERANCES_USED = (
    _used("variant", "Variant", "Name of the variant as submitted.", type="text", role="identity"),
    _used(
        "dimension",
        "Dimension",
        "A dimension of the variant that scatters, or whose limits do not include its entered value; others are exact.",
        type="choice",
        choices=tuple(DIMENSIONS),
        role="identity",
    ),
    _used("unit", "Unit", "Unit of the numbers of this row: that of the dimension's own column.", type="text"),
    _used("nominal", "Nominal", "The entered value."),
    _used("lower", "Lower limit", "Smallest value that the drawing allows."),
    _used("upper", "Upper limit", "Largest value that the drawing allows."),
    _used("mean", "Mean", "Mean of the parts, after any cut of the distribution."),
    _used("standard_deviation", "Standard deviation", "Standard deviation of the parts, after any cut.", minimum=0),
    _used(
        "distribution",
        "Distribution",
        "How parts scatter; blank where they do not.",
        type="choice",
        choices=("normal", "truncated normal", "uniform", "triangular", "measured"),
    ),
    _used(
        "scatters_between",
        "Scatters between",
        "parts: every part has a value of its own. lots: one value for a whole lot.",
        type="choice",
        choices=("parts", "lots"),
    ),
    _used(
        "scatters_with",
        "Scatters with",
        "Dimensions that it scatters together with, and the correlations of their normal scores. Blank: independent.",
        type="text",
    ),
    _used(
        "outside_limits_ppm",
        "Outside limits [ppm]",
        "Parts outside the limits of the drawing, per million, by the process.",
        minimum=0,
        maximum=1_000_000,
    ),
    _used(
        "share", "Share of variance", "Its own share of the variance of the backlash, a fraction.", minimum=0, maximum=1
    ),
    _used(
        "relax_to",
        "Relax to ±",
        "Half the width of the limits, in whole drawing steps, to which this tolerance alone may grow so that the "
        "variant still keeps its target. Blank: it may not, or the variant has no limit or misses it, or there are "
        "more variants than a report draws.",
        minimum=0,
    ),
    _used(
        "tighten_to",
        "Tighten to ±",
        "Half the width of the limits, in whole drawing steps, that alone would bring the variant within its limit. "
        "Blank: none does, or the variant has no limit or meets it, or there are more variants than a report draws.",
        minimum=0,
    ),
    _used(
        "source",
        "Source",
        "Tolerance class and row; the class that it was taken over from; the measured sample; or built in.",
        type="text",
    ),
)
