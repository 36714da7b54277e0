"""Valid variants → limits and nominal numbers, with the engineering findings that only these can show."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from flexlash.columns import DIMENSIONS, VARIANTS
from flexlash.mechanics.nominal import Numbers, nominal_numbers
from flexlash.submission.headers import plain
from flexlash.submission.validate import Validated
from flexlash.tolerance.limits import Limits, LimitsProblem, limits_of, shape_problems
from flexlash.tolerance.variation import Variation
from flexlash.units import RPM
from flexlash.variant import Settings, Variant

__all__ = ["Computed", "assess", "blame"]

_REFINEMENTS = {column.dimension: column.key for column in VARIANTS if column.group == "Refinements"}
_LEAST, _GREATEST = 1e-12, 10.0
"""Backlash [rad] between which linear elasticity of a steel cup can have a meaning."""

_USUAL_SPEED = 3000 * RPM
"""Input speed [rad/s] that usual motors reach."""

_CODES = {"impossible": "E314", "untabulated": "E315", "cut": "W405", "overlap": "W409"}


@dataclass(frozen=True, kw_only=True)
class Computed:
    """One computed variant: its record, its limits, its nominal numbers and its spread, all in SI."""

    variant: Variant
    limits: dict[str, Limits]
    nominal: Numbers
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
            blame(validated, "E324", variant, "torque_Nm", value=f"{nominal['backlash']:.3g}")
            continue
        _warn_strength(validated, variant, nominal)
        _warn_stiffness(validated, variant, nominal)
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
    blame(
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


def _warn_strength(validated: Validated, variant: Variant, nominal: Numbers) -> None:
    """Warn when the part yields or buckles."""
    stress, strength = nominal["von_mises"], variant.yield_strength
    if strength is not None and _exceeds(stress, strength):
        facts = {"value": _megapascals(stress), "other": strength / 1e6, "detail": nominal["governing_section"]}
        blame(validated, "W402", variant, "torque_Nm", **facts)
    shear, buckling = nominal["wall_shear"], nominal.get("buckling_shear")
    if _exceeds(shear, buckling):
        blame(validated, "W411", variant, "torque_Nm", value=_megapascals(shear), other=_megapascals(buckling))


def _warn_stiffness(validated: Validated, variant: Variant, nominal: Numbers) -> None:
    """Warn when the flexspline is softer than drives that contain one, or resonates within usual speeds."""
    stiffness, least = nominal["stiffness"], nominal.get("least_stiffness")
    if _exceeds(least, stiffness):
        key = "mean_radius_mm" if "mean_radius" in variant.dimensions else "bore_diameter_mm"
        size = f"{nominal['catalogue_size']:.0f}"
        blame(validated, "W412", variant, key, value=f"{stiffness:.4g}", other=f"{least:.4g}", detail=size)
    speeds = [nominal.get("resonance_speed_low"), nominal.get("resonance_speed")]
    if _exceeds(_USUAL_SPEED, speeds[0]):
        low, high = (f"{float(speed or 0) / RPM:.2g}" for speed in speeds)
        span = high if low == high else f"{low} to {high}"
        value = f"{nominal['natural_frequency']:.2g}"
        blame(validated, "W415", variant, "load_inertia_kg_m2", value=value, other=span)


def _exceeds(one: float | str | None, other: float | str | None) -> bool:
    """Whether both are numbers and the first is the greater."""
    return isinstance(one, float) and isinstance(other, float) and one > other


def _megapascals(stress: float | str | None) -> str:
    return f"{float(stress or 0) / 1e6:.4g}"


def _warn_calibration(validated: Validated, variant: Variant) -> None:
    """Warn when a calibration meets refinement columns, which it contains already."""
    used = [key for name, key in _REFINEMENTS.items() if name in variant.dimensions]
    factors = (variant.dimensions["cylinder_calibration"], variant.dimensions["disk_calibration"])
    if used and factors != (1.0, 1.0):
        blame(validated, "W407", variant, used[0])


def blame(validated: Validated, code: str, variant: Variant, key: str, **facts: object) -> None:
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
