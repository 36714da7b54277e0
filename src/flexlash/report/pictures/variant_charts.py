"""What is known of one variant → its charts: density, causes, segments."""

from __future__ import annotations

from collections.abc import Sequence

from flexlash.report.page.shape import Density, Segment, Share
from flexlash.report.pictures.chart import Cause, causes_chart, density_chart, shares_chart
from flexlash.report.pictures.drawing import Picture
from flexlash.schema.angle_unit import angle_sign

__all__ = ["variant_charts"]


def variant_charts(density: Density, shares: Sequence[Share], segments: Sequence[Segment]) -> dict[str, Picture]:
    """Return the charts of a variant by name: `density`, and `causes` and `segments` where there are any."""
    sign = angle_sign(density.get("unit", ""))
    charts = {"density": density_chart("density", density, sign)}
    if shares:
        causes = [
            Cause(name=one["name"], words=one["words"], share=one["share"], low=one["low"], high=one["high"])
            for one in shares
        ]
        charts["causes"] = causes_chart("causes", causes, density["nominal"], sign)
    if segments:
        parts = [(one["name"], one["share"]) for one in segments]
        charts["segments"] = shares_chart("segments", "Where the wind-up arises", parts)
    return charts
