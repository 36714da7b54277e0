"""Valid variants → limits and nominal numbers, with the engineering findings that only these can show."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from flexlash.columns import DIMENSIONS, VARIANTS
from flexlash.mechanics.nominal import nominal_numbers
from flexlash.submission.headers import plain
from flexlash.submission.validate import Validated
from flexlash.tolerance.limits import Limits, LimitsProblem, limits_of, shape_problems
from flexlash.tolerance.variation import Variation
from flexlash.variant import Settings, Variant

__all__ = ["Computed", "assess"]

_REFINEMENTS = {column.dimension: column.key for column in VARIANTS if column.group == "Refinements"}
_LEAST, _GREATEST = 1e-12, 10.0
"""Backlash [rad] between which linear elasticity of a steel cup can have a meaning."""

_CODES = {"impossible": "E314", "untabulated": "E315", "cut": "W405", "overlap": "W409"}


@dataclass(frozen=True, kw_only=True)
class Computed:
    """One computed variant: its record, its limits, its nominal numbers and its spread, all in SI."""

    variant: Variant
    limits: dict[str, Limits]
    nominal: dict[str, float | None]
    variation: Variation | None = None


def assess(validated: Validated, settings: Settings) -> dict[int, Computed]:
    """Return the computable variants by row number; findings go to the ledger."""
    limits: dict[int, dict[str, Limits]] = {}
    for variant in validated.variants:
        rows = validated.classes[plain(variant.tolerance_class)]
        found, untabulated = limits_of(variant, rows)
        kept, misshapen = shape_problems(variant, found)
        for problem in (*untabulated, *misshapen):
            _blame_limits(validated, variant, problem)
        limits[variant.row] = kept
    sound = [variant for variant in validated.variants if variant.row not in validated.ledger.rows]
    numbers = nominal_numbers(sound, settings.lost_motion_percent / 100)
    for variant, nominal in zip(sound, numbers, strict=True):
        if not _LEAST < nominal["backlash"] < _GREATEST:  # type: ignore[operator]
            _add(validated, "E324", variant, "torque_Nm", value=f"{nominal['backlash']:.3g}")
            continue
        _warn_strength(validated, variant, nominal)
        _warn_calibration(validated, variant)
    return {
        variant.row: Computed(variant=variant, limits=limits[variant.row], nominal=nominal)
        for variant, nominal in zip(sound, numbers, strict=True)
        if variant.row not in validated.ledger.rows
    }


def _blame_limits(validated: Validated, variant: Variant, problem: LimitsProblem) -> None:
    """Record what is wrong with a variant's limits at the cell of the dimension, else at its material."""
    column = DIMENSIONS[problem.dimension]
    key = column.key if column.sheet == "Variants" else "material"
    value = variant.dimensions[problem.dimension] / column.si_unit.si
    details = dict(_details(problem))
    _add(
        validated,
        _CODES[problem.kind],
        variant,
        key,
        name=column.name,
        value=f"{value:.10g}",
        other=variant.tolerance_class,
        detail=details.get(problem.kind, ""),
    )


def _details(problem: LimitsProblem) -> Iterator[tuple[str, str]]:
    """Yield the words that say what the limits reach, or which grade has no entry."""
    yield "untabulated", problem.detail
    yield "overlap", problem.detail
    radius = problem.detail in DIMENSIONS
    yield "impossible", "the other radius of the disk" if radius else problem.detail


def _warn_strength(validated: Validated, variant: Variant, nominal: dict[str, float | None]) -> None:
    """Warn when the von Mises stress exceeds the yield strength."""
    stress, strength = nominal["von_mises"], variant.yield_strength
    if stress is not None and strength is not None and stress > strength:
        _add(validated, "W402", variant, "torque_Nm", value=f"{stress / 1e6:.4g}", other=strength / 1e6)


def _warn_calibration(validated: Validated, variant: Variant) -> None:
    """Warn when a calibration meets refinement columns, which it contains already."""
    used = [key for name, key in _REFINEMENTS.items() if name in variant.dimensions]
    factors = (variant.dimensions["cylinder_calibration"], variant.dimensions["disk_calibration"])
    if used and factors != (1.0, 1.0):
        _add(validated, "W407", variant, used[0])


def _add(validated: Validated, code: str, variant: Variant, key: str, **facts: object) -> None:
    """Record a finding at a cell of a variant."""
    if validated.table is None:
        raise LookupError("a variant without its table")
    validated.ledger.add(
        code,
        sheet=validated.table.sheet,
        cell=validated.table.address(variant.row, key),
        column=key,
        variant=variant.name,
        rows=[variant.row],
        **facts,
    )
