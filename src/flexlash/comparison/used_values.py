"""What a variant uses of a table, as it is compared and shown: rows of Tolerances in the words of a drawing."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from flexlash.schema.columns import DIMENSIONS, LOT_DIMENSIONS
from flexlash.schema.variant import MeasuredDimension, ToleranceRow

__all__ = ["Used", "Value", "correlation_value", "tolerance_value"]


@dataclass(frozen=True, kw_only=True)
class Value:
    """A value of a table: what is compared, how it is shown, what it is called."""

    value: Any
    shown: str | float | None
    label: str
    unit: str = ""


@dataclass(frozen=True, kw_only=True)
class Used:
    """What a variant uses of a table: the rows' owner, in plain letters and as written, and their values by key."""

    owner: str
    name: str
    values: Mapping[str, Value]


def tolerance_value(row: ToleranceRow) -> Value:
    """Return a row of Tolerances as it is compared and shown.

    >>> row = ToleranceRow(row=5, tolerance_class="shop", dimension="wall_thickness", lower=-2e-5, upper=2e-5)
    >>> tolerance_value(row).shown
    '± 0.02 mm'
    >>> from dataclasses import replace
    >>> tolerance_value(replace(row, limits_sigma=3.3, harmful_shift=0.1, scatters_between="lots")).shown
    '± 0.02 mm, Cp 1.1, Cpk 0.88, one value a lot'
    """
    limits = () if row.grade else (row.lower, row.upper)
    sample = row.sample
    is_spread = "normal" in row.distribution and row.sd is None and sample is None
    facts = (sorted(sample.values), sample.are_deviations) if sample else ((), False)
    return Value(
        value=(
            limits,
            row.relative and bool(limits),
            row.grade,
            row.distribution,
            row.limits_sigma if is_spread else None,
            row.mean_shift,
            row.sd,
            row.harmful_shift,
            (tuple(facts[0]), facts[1]),
            row.scatters_between,
        ),
        shown=", ".join(_words(row, is_spread=is_spread)),
        label=DIMENSIONS[row.dimension].plain_name,
    )


def _words(row: ToleranceRow, *, is_spread: bool) -> Iterator[str]:
    """Yield limits, distribution and process of a row of Tolerances."""
    column = DIMENSIONS[row.dimension]
    size, unit = (0.01, "%") if row.relative else (column.si_unit.si, column.unit)
    space = "" if unit == "-" else f" {unit}"
    yield row.grade or _deviations(row.lower / size, row.upper / size, "" if unit == "-" else unit)
    if row.distribution != "normal":
        yield row.distribution
    if row.harmful_shift:
        cp = row.limits_sigma / 3
        yield f"Cp {cp:.10g}"
        yield f"Cpk {cp * (1 - 2 * row.harmful_shift):.10g}"
    elif is_spread and row.limits_sigma != 3:  # noqa: PLR2004
        yield f"limits at ± {row.limits_sigma:.10g} sigma"
    if row.sd is not None:
        yield f"sd {row.sd / size:.10g}{space}"
    if row.mean_shift:
        yield f"mean shifted by {row.mean_shift / size:+.10g}{space}".replace("-", "−")
    if row.sample:
        yield _sample(row.sample)
    if row.scatters_between != ("lots" if row.dimension in LOT_DIMENSIONS else "parts"):
        yield "one value a lot" if row.scatters_between == "lots" else "a value a part"


def _sample(sample: MeasuredDimension) -> str:
    """Return what a sample tells of its dimension: `sample lot 7 of 60 parts (mean 1.607 mm, s 0.0041 mm)`."""
    column = DIMENSIONS[sample.dimension]
    size, unit = column.si_unit.si, "" if column.unit == "-" else f" {column.unit}"
    mean = f"{sample.mean / size:{'+' if sample.are_deviations else ''}.10g}".replace("-", "−")
    name = "mean deviation" if sample.are_deviations else "mean"
    facts = f"{name} {mean}{unit}, s {sample.standard_deviation / size:.6g}{unit}"
    return f"sample {sample.sample} of {len(sample.values)} parts ({facts})"


def _deviations(lower: float, upper: float, unit: str) -> str:
    """Return two deviations as a drawing gives them: `± 0.05 mm`, `−0.1 to +0.2 mm`."""
    space = " " if unit else ""
    if lower == -upper:
        return f"± {upper:.10g}{space}{unit}"
    ends = (f"{end:+.10g}".replace("-", "−") if end else "0" for end in (lower, upper))
    return f"{' to '.join(ends)}{space}{unit}"


def correlation_value(pair: Iterable[str], correlation: float) -> Value:
    """Return how two dimensions of a class scatter together, as it is compared and shown.

    >>> correlation_value(("wall_thickness", "disk_thickness"), 0.6).label
    'Wall thickness with Disk thickness'
    """
    label = " with ".join(DIMENSIONS[name].plain_name for name in pair)
    return Value(value=correlation, shown=correlation, label=label)
