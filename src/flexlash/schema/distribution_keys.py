"""The columns of the tables that hold the distribution of each variant for other programs."""

from __future__ import annotations

__all__ = ["LAST_OF_UNITS", "PERCENTILES_TABLE", "UNITS_TABLE"]

PERCENTILES_TABLE = ("variant", "normal_score", "share_below", "backlash_arcmin", "score_standard_error")

UNITS_TABLE, LAST_OF_UNITS = ("variant", "unit"), "backlash_arcmin"
"""The columns of random units before and behind those of their dimensions."""
