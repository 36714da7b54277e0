"""The distribution of each variant for other programs: random units, percentiles, or a library of SIPmath 3.0."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator
from typing import Any

import numpy as np
import polars as pl
from scipy.special import ndtr

from flexlash.analysis.computed import Computed
from flexlash.analysis.drawn_units import BACKLASH, drawn_units
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.tolerance_spread import drawn_curves
from flexlash.report.results_table import csv_text
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.distribution_keys import PERCENTILES_TABLE, UNITS_TABLE
from flexlash.schema.stamps import placeholder
from flexlash.schema.units import ARCMIN
from flexlash.tolerance.distribution_curves import CURVE_SCORES, Curve
from flexlash.tolerance.metalog import metalog_coefficients, metalog_quantile

__all__ = ["ROLE", "distribution_bytes", "percentile_table", "sip_library", "unit_table"]

ROLE = "distribution"
"""What the stamp of such a file says that it is."""

_LEVELS = ndtr(np.array(CURVE_SCORES))
_FITTED = (_LEVELS > 1e-4) & (_LEVELS < 1 - 1e-4)  # noqa: PLR2004
"""Percentiles that a metalog follows: one that followed the last millionths would be worse everywhere else."""

_DENSITY_POINTS = 25
_TOLD = {"mean": "mean", "P2.5": "p2_5", "P50": "p50", "P97.5": "p97_5", "P99.865": "p99_865"}
"""Statistics beside a metalog, by the names that the standard has for them."""


def distribution_bytes(outcome: Outcome, ending: str, count: int, first: int | None = None) -> bytes:
    """Return the distributions of all variants in the form that an ending names, numbers with every digit.

    .parquet has so many random units of each variant, or the `first` of these, .csv percentiles from 3e-7 to 1 − 3e-7,
    .json a SIPmath library.
    """
    if ending == ".parquet":
        buffer = io.BytesIO()
        unit_table(outcome, count, first).write_parquet(buffer, metadata={"flexlash": placeholder(ROLE)})
        return buffer.getvalue()
    if ending == ".csv":
        return csv_text(percentile_table(outcome)).encode()
    content = {**sip_library(outcome), "stamp": placeholder(ROLE)}
    return (json.dumps(content, ensure_ascii=False, indent=1) + "\n").encode()


def unit_table(outcome: Outcome, count: int, first: int | None = None) -> pl.DataFrame:
    """Return random units of each variant, in submitted order: its name, the unit's number, sizes, backlash.

    Which units these are depends on their `count`, not on how many of the `first` are kept.

    Columns are those of the template by key and `backlash_arcmin`, in their units; blank what does not scatter.
    """
    pieces = [_units(variant, outcome, count).head(first or count) for variant in _computed(outcome)]
    columns = {column.dimension: column.key for column in DIMENSIONS.values()} | {BACKLASH: "backlash_arcmin"}
    used = [key for key in columns.values() if any(key in piece.columns for piece in pieces)]
    return pl.concat(pieces, how="diagonal").select(*UNITS_TABLE, *used)


def _units(variant: Computed, outcome: Outcome, count: int) -> pl.DataFrame:
    sizes = {BACKLASH: ("backlash_arcmin", ARCMIN)}
    sizes |= {column.dimension: (column.key, column.si_unit.si) for column in DIMENSIONS.values()}
    drawn = drawn_units(variant, outcome.settings, outcome.options, count)
    values = {sizes[name][0]: values / sizes[name][1] for name, values in drawn.items()}
    frame = pl.DataFrame({"unit": np.arange(1, count + 1), **values})
    return frame.with_columns(variant=pl.lit(variant.variant.name))


def percentile_table(outcome: Outcome) -> pl.DataFrame:
    """Return percentiles of the backlash of each variant [arcmin] in submitted order, with the share of units below.

    They are those of the report, exact but for `score_standard_error`, the standard error as one of the normal score.
    """
    pieces = [
        pl.DataFrame({
            "normal_score": np.array(CURVE_SCORES),
            "share_below": _LEVELS,
            "backlash_arcmin": curve.outputs / ARCMIN,
            "score_standard_error": curve.score_errors,
        }).with_columns(variant=pl.lit(variant.variant.name))
        for variant, curve in _curves(outcome)
    ]  # fmt: skip
    return pl.concat(pieces).select(PERCENTILES_TABLE)


def sip_library(outcome: Outcome) -> dict[str, Any]:
    """Return a library of the SIPmath 3.0 standard: the backlash of each variant [arcmin] as a metalog.

    Each has a random stream of its own: units of two variants are independent of one another. The seeds of the streams
    are the seed of the run and the row number, so that a variant's stream does not hang on those beside it.
    """
    found = list(_curves(outcome))
    return {
        "objectType": "sipModel",
        "libraryType": "SIPmath_3_0",
        "name": outcome.submission.name,
        "provenance": f"flexlash, submission {outcome.submission.sha256}",
        "version": "1",
        "U01": {"rng": [_stream(variant, outcome.settings.seed) for variant, _ in found]},
        "sips": [_sip(variant, curve) for variant, curve in found],
    }


def _stream(variant: Computed, seed: int) -> dict[str, Any]:
    seeds = {"counter": "PM_Index", "entity": 1, "varId": variant.variant.row, "seed3": seed, "seed4": 0}
    return {"name": _stream_name(variant), "function": "HDR_2_0", "arguments": seeds}


def _stream_name(variant: Computed) -> str:
    return f"row {variant.variant.row}"


def _sip(variant: Computed, curve: Curve) -> dict[str, Any]:
    coefficients = metalog_coefficients(_LEVELS[_FITTED], curve.outputs[_FITTED] / ARCMIN)
    levels = np.arange(1, _DENSITY_POINTS + 1) / (_DENSITY_POINTS + 1)
    step = 1e-3
    rise = metalog_quantile(coefficients, levels + step) - metalog_quantile(coefficients, levels - step)
    numbers = variant.spread.numbers if variant.spread else {}
    told = {name: (numbers[key] or 0.0) / ARCMIN for name, key in _TOLD.items()}
    density = [2 * step / one if one else 0.0 for one in rise.tolist()]
    return {
        "name": variant.variant.name,
        "ref": {"source": "rng", "name": _stream_name(variant)},
        "function": "Metalog_1_0",
        "arguments": {"aCoefficients": coefficients.tolist()},
        "metadata": {**told, "unit": "arcmin", "density": density},
    }


def _computed(outcome: Outcome) -> list[Computed]:
    return [variant for variant in outcome.computed.values() if variant.spread]


def _curves(outcome: Outcome) -> Iterator[tuple[Computed, Curve]]:
    variants = _computed(outcome)
    return zip(variants, drawn_curves(variants, outcome.settings, outcome.options), strict=True)
