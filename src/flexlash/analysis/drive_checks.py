"""The whole drive beside its limit: what its average says before anything is sampled, and what its spread says."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import polars as pl

from flexlash.analysis.computed import ComputedRows
from flexlash.analysis.drive_budget import plays_of
from flexlash.schema.arrays import Array
from flexlash.schema.columns import columns_of
from flexlash.schema.findings import Finding, spelled_out
from flexlash.schema.units import ARCMIN
from flexlash.schema.variant import Settings, Variant
from flexlash.schema.variant_arrays import VariantArrays
from flexlash.validation.ledger import Ledger
from flexlash.validation.validated import Validated

__all__ = ["drives_over_limit", "report_system_limit", "system_limits_are_fine"]

_KEY = "system_limit_arcmin"
_DIGITS = 4


def _plays(validated: Validated) -> float:
    """Return what the other sources add on average [rad], NaN where there are none to count."""
    plays = plays_of(validated)
    return math.fsum(play.mean for play in plays) if plays else math.nan


def system_limits_are_fine(validated: Validated, arrays: VariantArrays, backlash: Array) -> npt.NDArray[np.bool_]:
    """Return of which variants of this nominal backlash [rad] there is nothing to say about the limit of the drive."""
    limit = arrays.numbers["system_limit"]
    return ~((backlash + _plays(validated) > limit) | (limit < arrays.numbers["backlash_limit"]))


def report_system_limit(ledger: Ledger, validated: Validated, variant: Variant, backlash: float) -> None:
    """Warn of a limit of the drive below its average, or below that of the flexspline, which is a part of it."""
    limit, own = variant.system_limit, variant.backlash_limit
    if limit is None:
        return
    facts = {"name": columns_of("Variants")[_KEY].name, "value": _angle(limit)}
    average = backlash + _plays(validated)
    if average > limit:
        ledger.add_at("W470", variant, _KEY, other=_angle(average), **facts)
    if own is not None and limit < own:
        ledger.add_at("W472", variant, _KEY, other=_angle(own), **facts)


def drives_over_limit(computed: ComputedRows, spread: pl.DataFrame, settings: Settings) -> tuple[Finding, ...]:
    """Return a warning of each variant of whose drives more than the target allows are over their limit.

    Those are left out whose average is over it, which is told without a spread. `spread` has the statistics by row.
    """
    over = "system_probability_over_limit"
    if over not in spread.columns:
        return ()
    ledger, plays = Ledger.after(computed.validated), _plays(computed.validated)
    for row, share in spread.filter(pl.col(over) > 1 - settings.target_percent / 100).select("row", over).iter_rows():
        one = computed[row]
        limit = one.variant.system_limit
        if limit is not None and one.nominal.backlash + plays <= limit:
            facts = {"value": _angle(limit), "detail": f"{100 * (1 - share):.4g}", "other": settings.target_percent}
            ledger.add_at("W471", one.variant, _KEY, name=columns_of("Variants")[_KEY].name, **facts)
    return tuple(ledger.findings)


def _angle(angle: float) -> str:
    """Return an angle [rad] in arcmin."""
    return spelled_out(angle / ARCMIN, _DIGITS)
