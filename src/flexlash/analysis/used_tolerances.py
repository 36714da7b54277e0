"""Computed variants → Tolerances used: limits, mean and scatter of each of their dimensions, and their source."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import polars as pl

from flexlash.analysis.computed import Computed
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.entry_words import dimension_title
from flexlash.schema.spellings import plain
from flexlash.schema.units import as_entered
from flexlash.schema.used_columns import TOLERANCES_USED
from flexlash.schema.variant import Limits, ToleranceRow
from flexlash.tolerance.correlation import Entry
from flexlash.tolerance.dimension_limits import distribution_of, share_outside

__all__ = ["source_words", "used_rows", "used_tolerances"]

_SCHEMA = {column.key: pl.Float64() if column.is_number else pl.String() for column in TOLERANCES_USED}


def used_tolerances(variants: Iterable[Computed], widths: pl.DataFrame | None = None) -> pl.DataFrame:
    """Return one row for each dimension that scatters or is shifted, of every variant in this order.

    Numbers are in the unit of the dimension's own column. `widths` tells by `variant` and `dimension` to what half a
    width tolerances may go, `relax_to`, or must, `tighten_to`; without it nothing is told of that.
    """
    used = pl.DataFrame([row for one in variants for row in used_rows(one)], schema=_SCHEMA, orient="row")
    if widths is None:
        return used
    found = used.drop("relax_to", "tighten_to").join(
        widths, on=["variant", "dimension"], how="left", maintain_order="left"
    )
    return found.select(used.columns)


def used_rows(one: Computed) -> Iterator[dict[str, Any]]:
    """Yield the rows of a variant in the order of its limits, each without what it has not."""
    variant, shares = one.variant, one.spread.shares if one.spread else {}
    rows = {row.dimension: row for row in one.among.validated.classes[plain(variant.tolerance_class)]}
    for name, limits in one.limits.items():
        column = DIMENSIONS[name]
        numbers = {"nominal": variant.dimensions[name], **_numbers(limits)}
        yield {
            "variant": variant.name,
            "dimension": name,
            "unit": column.unit,
            **{key: as_entered(number, column.si_unit.si) for key, number in numbers.items()},
            "distribution": limits.distribution if limits.low < limits.high else None,
            "scatters_between": limits.scatters_between if limits.low < limits.high else None,
            "scatters_with": _partners(one.correlation, name) or None,
            "outside_limits_ppm": 1e6 * share_outside(limits) if limits.low < limits.high else 0.0,
            "share": shares.get(name),
            "source": source_words(rows[name], variant.tolerance_class),
        }


def _partners(correlation: Iterable[Entry], name: str) -> str:
    """Return what a dimension scatters together with.

    >>> ties = ("mean_radius", "wall_thickness", -0.25), ("wall_thickness", "disk_thickness", 0.5)
    >>> _partners(ties, "wall_thickness")
    'Mean radius -0.25; Disk thickness 0.5'
    """
    partners = [
        (second if name == first else first, value) for first, second, value in correlation if name in (first, second)
    ]
    return "; ".join(f"{dimension_title(other)} {value:.4g}" for other, value in partners)


def _numbers(limits: Limits) -> dict[str, float]:
    """Return limits, mean and standard deviation [SI]; of what does not scatter the value and 0."""
    ends = {"lower": limits.low, "upper": limits.high}
    if not limits.low < limits.high:
        return {**ends, "mean": limits.low, "standard_deviation": 0.0}
    spread = distribution_of(limits)
    return {**ends, "mean": spread.expectation, "standard_deviation": spread.standard_deviation}


def source_words(row: ToleranceRow, tolerance_class: str) -> str:
    """Return where the tolerance of a variant of this class comes from.

    >>> source_words(ToleranceRow(row=7, tolerance_class="full", dimension="wall_thickness"), "shop")
    'class shop, taken over from class full, row 7'
    >>> source_words(ToleranceRow(row=0, tolerance_class="standard", dimension="wall_thickness"), "standard")
    'class standard, built in'
    """
    words = [f"class {tolerance_class}"]
    own = row.tolerance_class
    if own != tolerance_class and plain(own) != plain(tolerance_class):
        words.append(f"taken over from class {own}")
    words.append(f"row {row.row}" if row.row else "built in")
    if row.sample:
        words.append(f"sample {row.sample.sample} ({len(row.sample.values)} parts)")
    return ", ".join(words)
