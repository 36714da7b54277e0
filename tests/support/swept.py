"""Sweeps of a submission that was computed, and the submissions that their points are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from flexlash.analysis.outcome import Outcome
from flexlash.decisions.sweep import Study, sweeps_of
from flexlash.schema.decision_rows import SweepRow, SweptDimension
from flexlash.schema.swept_values import swept_values

__all__ = ["asked", "point_rows", "sweep_row", "swept"]


def sweep_row(variant: str | None, *dimensions: tuple[str, Sequence[float]]) -> SweepRow:
    """Return a sweep over one or two columns of Variants, each with its values, or with first, last and step."""
    first, *others = (
        SweptDimension(key=key, values=tuple(values) if isinstance(values, list) else swept_values(*values))
        for key, values in dimensions
    )
    return SweepRow(variant=variant, first=first, second=others[0] if others else None)


def asked(outcome: Outcome, *sweeps: SweepRow) -> Outcome:
    """Return an outcome whose submission asks for these sweeps."""
    return replace(outcome, validated=replace(outcome.validated, sweeps=sweeps))


def swept(outcome: Outcome, *sweeps: SweepRow) -> list[Study]:
    """Return the studies that these sweeps of an outcome's submission make."""
    return sweeps_of(asked(outcome, *sweeps))


def point_rows(study: Study, variant: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return a row of Variants for each point of a study: its variant with the values of the point entered."""
    points = study.results.select(study.keys).iter_rows(named=True)
    return [{**variant, **point, "variant": f"point {number}"} for number, point in enumerate(points)]
