"""Changed Results → whether they lie within the error of the calculation, where only its points are others."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

from flexlash.schema.result_columns import result_columns

__all__ = ["AGREEING", "POINTS", "is_within_error"]

AGREEING = 4.0
"""Combined standard errors within which two numbers agree; errors are widened where few replicates are behind them."""

POINTS = frozenset({"seed", "method", "samples"})
"""Settings that change the points of the calculation and nothing of the gear."""

_NORMAL = 1.959963984540054
"""Standard errors in half of a 95 % interval."""

_KEYS = [column.key for column in result_columns(cross_check=True, elasticity=True)]
_SHARES = ("probability_over_limit", "ppm_over_limit")
_FOLLOWING = frozenset({
    "ppk", "ppk_normal", "main_contributor_share", "interaction_share", "random_probability_over_limit",
    "system_mean_arcmin", "system_rss_high_arcmin", "system_bender_high_arcmin", "system_mean_shift_high_arcmin",
    "system_worst_case_high_arcmin", "cross_check_deviation", "spread_method", "spread_points", "spread_note",
    "random_points",
    *(key for key in _KEYS if "standard_error" in key),
    *(f"{key}_{end}" for key in _SHARES for end in ("low", "high")),
    *(key for key in _KEYS if "_sample_" in key),
})  # fmt: skip
"""Results without an error of their own, which follow from those that have one, or say how they were found."""


def _error_key(key: str) -> str:
    """Return the key of a number's standard error, an empty text where it has none."""
    stem, _, unit = key.rpartition("_")
    return next((name for name in (f"{stem}_standard_error_{unit}", f"{key}_standard_error") if name in _KEYS), "")


_ERRORS = {key: error for key in _KEYS if (error := _error_key(key))}


def is_within_error(changed: Iterable[str], old: Mapping[str, Any], new: Mapping[str, Any]) -> bool:
    """Whether the changed Results of a variant, by key, say the same within their errors."""
    return all(_agrees(key, old, new) for key in changed)


def _agrees(key: str, old: Mapping[str, Any], new: Mapping[str, Any]) -> bool:
    """Whether a number of two Results is the same within its errors; what has none is not."""
    if key in _FOLLOWING:
        return True
    before, after = old.get(key), new.get(key)
    if before is None or after is None:
        return False
    rises = after > before
    old_error, new_error = _error(key, old, upper=rises), _error(key, new, upper=not rises)
    if old_error is None or new_error is None:
        return False
    return bool(abs(after - before) <= AGREEING * math.hypot(old_error, new_error))


def _error(key: str, row: Mapping[str, Any], *, upper: bool) -> float | None:
    """Return the standard error of a number; that of a share to the upper or lower end of its interval."""
    if key not in _SHARES:
        return row.get(_ERRORS.get(key, ""))
    end = row.get(f"{key}_{'high' if upper else 'low'}")
    return None if end is None else abs(end - row[key]) / _NORMAL
