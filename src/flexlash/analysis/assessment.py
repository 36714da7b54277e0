"""Valid variants → limits and nominal numbers, with the engineering findings that only these can show."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from flexlash.mechanics.nominal import Numbers, nominal_numbers
from flexlash.mechanics.stiffness import catalogue_torque
from flexlash.schema.columns import DIMENSIONS, VARIANTS, columns_of
from flexlash.schema.findings import spelled_out
from flexlash.schema.units import ARCMIN, RPM
from flexlash.schema.variant import Settings, ToleranceRow, Variant
from flexlash.tolerance.dimension_limits import Limits, LimitsProblem, limits_of, shape_problems
from flexlash.tolerance.spread_statistics import SpreadStatistics
from flexlash.validation.blocking_errors import name_waiting
from flexlash.validation.headers import plain
from flexlash.validation.ledger import UnitMistake
from flexlash.validation.unit_mistakes import settle
from flexlash.validation.validate import Validated

__all__ = ["Computed", "assess", "blame"]

_REFINEMENTS = {column.dimension: column.key for column in VARIANTS if column.group == "Refinements"}
_LEAST, _GREATEST = 1e-12, 10.0
"""Backlash [rad] between which linear elasticity of a steel cup can have a meaning."""

_USUAL_SPEED = 3000 * RPM
"""Input speed [rad/s] that usual motors reach."""

_WIDE, _COARSE = 0.1, 0.02
"""Half the width of the limits as a share of the value: unusual for any dimension, too much for a thin part."""

_EXACT = 1e-6
"""Half the width of the limits as a share of the value below which no part can be measured."""

_ROUNDING = 1e-9
"""Shares miss a threshold by their last digits; so much counts as on it."""

_THICKNESSES = frozenset({"wall_thickness", "disk_thickness", "disk_hub_thickness", "rim_thickness"})
_CODES = {"impossible": "E314", "untabulated": "E315", "cut": "W405", "overlap": "W409"}


@dataclass(frozen=True, kw_only=True)
class Computed:
    """One computed variant: its record, its limits, its nominal numbers and its spread, all in SI."""

    variant: Variant
    limits: dict[str, Limits]
    nominal: Numbers
    spread: SpreadStatistics | None = None


def assess(validated: Validated, settings: Settings) -> dict[int, Computed]:
    """Return the computable variants by row number; findings go to the ledger."""
    limits: dict[int, dict[str, Limits]] = {}
    for variant in validated.variants:
        rows = validated.classes[plain(variant.tolerance_class)]
        found, untabulated = limits_of(variant, rows)
        kept, misshapen = shape_problems(variant, found)
        for problem in (*untabulated, *misshapen):
            _blame_limits(validated, variant, problem)
        kinds = {problem.dimension: problem.kind for problem in (*untabulated, *misshapen) if problem.kind != "overlap"}
        _judge_widths(validated, variant, rows, found, kinds)
        limits[variant.row] = kept
    _warn_exact(validated)
    sound = [variant for variant in validated.variants if variant.row not in validated.ledger.rows]
    numbers = nominal_numbers(sound, settings.lost_motion_percent / 100)
    mistakes = validated.ledger.unit_mistakes_by_owner()
    for variant, nominal in zip(sound, numbers, strict=True):
        mistaken = [*mistakes.get(variant.row, ()), *mistakes.get(plain(variant.material), ())]
        if not _LEAST < nominal["backlash"] < _GREATEST:  # type: ignore[operator]
            _blame_backlash(validated, variant, nominal, mistaken)
            continue
        _warn_calibration(validated, variant)
        if not mistaken:
            _warn_strength(validated, variant, nominal)
            _warn_stiffness(validated, variant, nominal)
            _warn_limit(validated, variant, nominal)
    settle(validated.ledger)
    name_waiting(validated)
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
    blame(
        validated,
        _CODES[problem.kind],
        variant,
        key,
        name=column.name,
        value=f"{value:.10g}",
        other=variant.tolerance_class,
        detail=problem.detail,
    )


def _judge_widths(
    validated: Validated,
    variant: Variant,
    rows: Sequence[ToleranceRow],
    limits: Mapping[str, Limits],
    kinds: Mapping[str, str],
) -> None:
    """Report limits that are wide or hardly any beside their dimension, and general tolerances on thin parts.

    `kinds` are the problems that dimensions have already: beside a cut tail only an absurd width is reported.
    """
    general = {row.dimension for row in rows if (row.grade or "").startswith("2768")}
    meant = {row.dimension for row in rows if row.grade or row.lower < row.upper}
    for name, limit in limits.items():
        column, nominal = DIMENSIONS[name], variant.dimensions[name]
        share = (limit.high - limit.low) / 2 / (abs(nominal) or 1.0)
        code = _width_code(share, coarse=name in general & _THICKNESSES, meant=name in meant)
        told = kinds.get(name)
        if not code or (column.sheet == "Settings" and code == "W421") or (told and (told, code) != ("cut", "E333")):
            continue
        unit = "" if column.unit in {"", "-"} else f" {column.unit}"
        blame(
            validated,
            code,
            variant,
            column.key if column.sheet == "Variants" else "material",
            name=column.name,
            value=f"{nominal / column.si_unit.si:.10g}{unit}",
            other=variant.tolerance_class,
            detail=f"{share:.2g}" if code == "W441" else f"{100 * share:.3g}",
        )


def _width_code(share: float, *, coarse: bool, meant: bool) -> str:
    """Return the code of what is wrong with half a width of limits, as a share of the value; empty for nothing."""
    if share > 1 + _ROUNDING:
        return "E333"
    if coarse and share > _COARSE + _ROUNDING:
        return "W422"
    if share > _WIDE + _ROUNDING:
        return "W421"
    return "W441" if meant and share < _EXACT else ""


def _warn_exact(validated: Validated) -> None:
    """Warn once of each class that has no row for dimensions which `standard` scatters and one of its variants has."""
    table, standard = validated.tolerances, validated.classes.get("standard", [])
    if table is None:
        return
    exact: dict[str, set[str]] = defaultdict(set)
    for variant in validated.variants:
        name = plain(variant.tolerance_class)
        scattered = limits_of(variant, standard)[0].keys() - {row.dimension for row in validated.classes[name]}
        exact[name] |= scattered
    for row, name in table.frame.select("row", "tolerance_class").iter_rows():
        if left := exact.pop(plain(name or ""), None):
            words = ", ".join(column.plain_name for one, column in DIMENSIONS.items() if one in left)
            place: dict[str, Any] = {"sheet": table.sheet, "cell": table.address(row, "tolerance_class")}
            validated.ledger.add("W438", column="tolerance_class", value=name, detail=words, **place)


def _blame_backlash(validated: Validated, variant: Variant, nominal: Numbers, mistaken: Sequence[UnitMistake]) -> None:
    """Record a backlash that no flexspline has: where a unit is mistaken, once for a material; else here."""
    value = f"{nominal['backlash']:.3g}"
    cause = next((mistake for mistake in mistaken if mistake.column != "yield_MPa"), None)
    if cause is None:
        blame(validated, "E324", variant, "torque_Nm", value=value)
        return
    ledger = validated.ledger
    ledger.rows.add(variant.row)
    if cause.material in ledger.materials:
        return
    place: dict[str, Any] = {"sheet": cause.sheet, "cell": cause.cell, "column": cause.column}
    ledger.add("E324", variant=cause.variant, value=value, entered=cause.entered, **place)
    if cause.material:
        ledger.spoil("material", cause.material, cause.sheet, cause.row)


def _warn_strength(validated: Validated, variant: Variant, nominal: Numbers) -> None:
    """Warn when the part yields or buckles, or else when its torque is above what drives of its size may bear."""
    stress, strength = nominal["von_mises"], variant.yield_strength
    if strength is not None and _exceeds(stress, strength):
        facts = {"value": _megapascals(stress), "other": strength / 1e6, "detail": nominal["governing_section"]}
        blame(validated, "W402", variant, "torque_Nm", **facts)
    shear, buckling = nominal["wall_shear"], nominal.get("buckling_shear")
    if _exceeds(shear, buckling):
        blame(validated, "W411", variant, "torque_Nm", value=_megapascals(shear), other=_megapascals(buckling))
    listed, torque = catalogue_torque(float(nominal["mean_radius"] or 0)), variant.dimensions["torque"]
    if listed and torque > listed.torque and not (_exceeds(stress, strength) or _exceeds(shear, buckling)):
        facts = {"value": f"{torque:.10g}", "other": listed.torque, "detail": listed.size}
        blame(validated, "W424", variant, "torque_Nm", name=_name("torque_Nm"), **facts)


def _warn_stiffness(validated: Validated, variant: Variant, nominal: Numbers) -> None:
    """Warn when the flexspline is softer than drives that contain one, or resonates within usual speeds."""
    stiffness, least = nominal["stiffness"], nominal.get("least_stiffness")
    if _exceeds(least, stiffness):
        key = "mean_radius_mm" if "mean_radius" in variant.dimensions else "bore_diameter_mm"
        size = f"{nominal['catalogue_size']:.0f}"
        blame(validated, "W412", variant, key, value=_digits(stiffness, 4), other=_digits(least, 4), detail=size)
    speeds = [nominal.get("resonance_speed_low"), nominal.get("resonance_speed")]
    if _exceeds(_USUAL_SPEED, speeds[0]):
        low, high = (_digits(float(speed or 0) / RPM, 2) for speed in speeds)
        span = high if low == high else f"{low} to {high}"
        value = _digits(nominal["natural_frequency"], 2)
        blame(validated, "W415", variant, "load_inertia_kg_m2", value=value, other=span)


def _warn_limit(validated: Validated, variant: Variant, nominal: Numbers) -> None:
    """Warn when the nominal backlash is over the limit already."""
    if _exceeds(nominal["backlash"], variant.backlash_limit):
        key = "backlash_limit_arcmin"
        limit, backlash = (
            f"{float(angle or 0) / ARCMIN:.5g}" for angle in (variant.backlash_limit, nominal["backlash"])
        )
        blame(validated, "W423", variant, key, name=_name(key), value=limit, other=backlash)


def _name(key: str) -> str:
    """Return the name of a column of Variants."""
    return columns_of("Variants")[key].name


def _digits(value: float | str | None, digits: int) -> str:
    """Return a number rounded to so many digits, without a power of ten."""
    return f"{float(f'{float(value or 0):.{digits}g}'):.15g}"


def _exceeds(one: float | str | None, other: float | str | None) -> bool:
    """Whether both are numbers and the first is the greater."""
    return isinstance(one, float) and isinstance(other, float) and one > other


def _megapascals(stress: float | str | None) -> str:
    return spelled_out(float(stress or 0) / 1e6)


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
