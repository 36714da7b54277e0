"""A drawn variant → the figures on its page: percentiles, lots and parts, calculation error, worst case, stress."""

from __future__ import annotations

from collections.abc import Iterator

from flexlash.report.report_data import Drawn
from flexlash.schema.angle_unit import AngleUnit
from flexlash.schema.findings import spelled_out
from flexlash.schema.limit_verdict import VerdictBounds
from flexlash.schema.number_words import INTERVAL, brief_share

__all__ = ["page_figures"]

_DIGITS = 3
_TOLD = 1e-5
"""Least interval that is told [arcmin]."""


def page_figures(variant: Drawn, bounds: VerdictBounds, angles: AngleUnit) -> Iterator[tuple[str, str]]:
    """Yield name and value of each figure; what there is none of is left out."""
    row = variant.row
    yield "Limit", angles.entered(row["backlash_limit_arcmin"])
    for name, key in (
        ("Nominal", "backlash"),
        ("Mean", "mean"),
        ("97.5 % of units below", "p97_5"),
        ("99.865 % below", "p99_865"),
    ):
        yield name, angles.words(row[f"{key}_arcmin"], row.get(f"{key}_standard_error_arcmin"))
    yield "Units over the limit", brief_share(row)
    yield "Allowed over the limit", f"{100 * bounds.meets:.4g} %"
    for name, key in (
        ("Within one lot", "within_lot_sd_arcmin"),
        ("Lots differ by", "between_lots_sd_arcmin"),
        ("Calculation error", "p99_865_standard_error_arcmin"),
    ):
        if row[key] is not None:
            reach = INTERVAL * row[key]
            least = f"below {angles.of(_TOLD):.5f}{angles.sign}"
            yield name, f"± {angles.spelled_out(reach, 2)}" if reach >= _TOLD else least
    low, high = row["worst_case_low_arcmin"], row["worst_case_high_arcmin"]
    if low is not None:
        yield "Worst case", f"{angles.words(low)} to {angles.words(high)}"
    for name, key in (("Von Mises, torsion only", "von_mises_MPa"), ("Alternating, bending", "alternating_stress_MPa")):
        if row[key] is not None:
            yield name, f"{spelled_out(row[key], _DIGITS)} MPa"
    if row["elastic_limit_torque_Nm"] is not None:
        times = row["elastic_limit_torque_Nm"] / variant.computed.variant.dimensions["torque"]
        yield "Yields at", f"{spelled_out(times, _DIGITS)} × the torque"
    if row["disk_share"] is not None:
        yield "Disk share of wind-up", f"{100 * row['disk_share']:.1f} %"
