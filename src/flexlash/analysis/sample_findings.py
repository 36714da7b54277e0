"""What the samples that classes use are worth: too few parts to be sure, or values that no normal process has."""

from __future__ import annotations

from collections.abc import Iterator

from flexlash.schema.entry_words import dimension_words
from flexlash.schema.variant import MeasuredDimension, ToleranceRow
from flexlash.tolerance.sample_statistics import SampleStatistics, sample_statistics
from flexlash.validation.ledger import Ledger
from flexlash.validation.validated import Validated

__all__ = ["NOT_NORMAL", "normality_words", "report_samples"]

FEW = 20
"""Measured parts below which a class is warned."""

NOT_NORMAL = 0.05
"""Anderson–Darling p below which values are not taken for those of a normal process without a warning."""

_LEAST_P = 1e-4
_COARSE = 3
"""Parts for each different value from which on the steps of the gauge are told beside the test, which they spoil."""


def report_samples(validated: Validated, ledger: Ledger) -> None:
    """Warn of samples that classes without an error use, once at each row of Tolerances."""
    table = validated.tolerances
    if table is None:
        return
    for row, sample in _used(validated):
        statistics = sample_statistics(sample.values)
        facts = {
            "value": sample.sample,
            "dimension": dimension_words(row.dimension),
            "found": f"{statistics.count} values",
        }
        if statistics.count < FEW:
            ledger.add_in(table, "W445", row.row, "sample", detail=_widening(statistics), **facts)
        if "normal" in row.distribution and statistics.normality is not None and statistics.normality < NOT_NORMAL:
            detail = f"{normality_words(statistics.normality)}{_steps(sample.values)}"
            ledger.add_in(table, "W447", row.row, "sample", detail=detail, **facts)


def _used(validated: Validated) -> Iterator[tuple[ToleranceRow, MeasuredDimension]]:
    """Yield each row of a sound class that uses a sample, once however many classes take it over."""
    told: set[int] = set()
    for key, rows in validated.classes.items():
        for row in rows if key not in validated.blocked.classes else ():
            if row.sample is not None and row.row not in told:
                told.add(row.row)
                yield row, row.sample


def _widening(statistics: SampleStatistics) -> str:
    """Return between which multiples of what was found the true standard deviation lies."""
    low, high = (end / statistics.sd for end in (statistics.sd_low, statistics.sd_high))
    return f"{low:.2f} and {high:.2f} times"


def normality_words(p: float) -> str:
    """Return a p-value as it is told.

    >>> normality_words(0.0312), normality_words(1e-9), normality_words(0.4)
    ('p = 0.031', 'p below 0.0001', 'p = 0.40')
    """
    return f"p below {_LEAST_P:.4f}" if p < _LEAST_P else f"p = {p:#.2g}"


def _steps(values: tuple[float, ...]) -> str:
    """Return how few different values there are, where a coarse gauge may be why they fit no curve."""
    different = len(set(values))
    return f"; only {different} different values, a coarse gauge?" if different * _COARSE <= len(values) else ""
