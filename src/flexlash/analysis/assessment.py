"""Valid variants → limits and nominal numbers, with the engineering findings that only these can show."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import polars as pl

from flexlash.analysis.backlash_models import BACKLASH_OF
from flexlash.analysis.class_correlations import class_correlations
from flexlash.analysis.computed import ComputedRows, Nominal
from flexlash.analysis.drive_checks import report_system_limit, system_limits_are_fine
from flexlash.analysis.process_checks import processes_are_usual, report_processes
from flexlash.analysis.sample_findings import report_samples
from flexlash.mechanics.bending import ENDURANCE
from flexlash.mechanics.nominal import nominal_numbers
from flexlash.mechanics.nominal_record import NominalNumbers
from flexlash.mechanics.stiffness import catalogue_torque
from flexlash.schema.arrays import Array
from flexlash.schema.columns import DIMENSIONS, VARIANTS, columns_of
from flexlash.schema.findings import spelled_out
from flexlash.schema.spellings import plain
from flexlash.schema.units import ARCMIN, RPM
from flexlash.schema.variant import Limits, Settings, ToleranceRow, Variant
from flexlash.schema.variant_arrays import VariantArrays
from flexlash.tolerance.dimension_limits import LimitsProblem, limits_of, shape_problems
from flexlash.tolerance.limit_arrays import LimitArrays, beyond_doubt, limits_alike, varying
from flexlash.validation.ledger import Ledger
from flexlash.validation.validated import UnitMistake, Validated

__all__ = ["assess"]

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


def assess(validated: Validated, settings: Settings) -> Nominal:
    """Return the computable variants with their limits and nominal numbers, and what these show to be wrong.

    All variants are looked at together, and one by one only those of which there may be something to say.
    """
    ledger, variants = Ledger.after(validated), validated.variants
    correlations = class_correlations(validated, ledger)
    if not variants:
        return Nominal(findings=tuple(ledger.findings), blocked=ledger.blocked)
    arrays, rows = variants.arrays(), np.array(variants.rows)
    ledger.rows.update(rows[[owner in ledger.classes for owner in variants.classes]].tolist())
    for variant in variants.some(np.flatnonzero(~_limits_are_fine(validated, arrays)).tolist()):
        _report_all_limits(ledger, variant, validated)
    _report_exact(validated, arrays, ledger)
    report_samples(validated, ledger)
    sound = np.flatnonzero(~np.isin(rows, list(ledger.rows)))
    arrays = arrays.take(sound)
    numbers = pl.DataFrame({"row": rows[sound], "place": sound})
    numbers = numbers.hstack(nominal_numbers(arrays, settings.lost_motion_percent / 100))
    computed = ComputedRows(validated=validated, numbers=numbers, correlations=correlations)
    mistakes = _by_owner(validated.unit_mistakes.values())
    fine = _numbers_are_fine(arrays, numbers)
    fine &= system_limits_are_fine(validated, arrays, numbers["backlash"].to_numpy())
    doubtful = np.flatnonzero(~fine)
    for place, variant in zip(doubtful.tolist(), variants.some(sound[doubtful].tolist()), strict=True):
        nominal = computed.nominal(place)
        _report_numbers(ledger, variant, nominal, mistakes)
        report_system_limit(ledger, validated, variant, nominal.backlash)
    kept = numbers.filter(~np.isin(rows[sound], list(ledger.rows)))
    # What no variant has takes as much room as what all have.
    kept = kept.select(column.name for column in kept if column.null_count() < kept.height)
    return Nominal(
        computed=replace(computed, numbers=kept) if kept.height else ComputedRows(),
        findings=tuple(ledger.findings),
        blocked=ledger.blocked,
    )


def _limits_are_fine(validated: Validated, arrays: VariantArrays) -> npt.NDArray[np.bool_]:
    """Return of which variants there is surely nothing to say about limits."""
    fine = np.zeros(len(arrays.flexspline_types), dtype=bool)
    with np.errstate(all="ignore"):
        for flexspline_type, owner, places, sizes in arrays.alike(validated.variants.classes):
            rows = validated.classes[owner]
            limits = limits_alike(sizes, rows, BACKLASH_OF[flexspline_type])
            fine[places] = beyond_doubt(flexspline_type, sizes, limits) & _widths_are_usual(sizes, limits, rows)
            fine[places] &= processes_are_usual(limits, rows)
    return fine


def _widths_are_usual(
    sizes: Mapping[str, Array], limits: Mapping[str, LimitArrays], rows: Sequence[ToleranceRow]
) -> npt.NDArray[np.bool_]:
    """Return of which variants alike no limits are wide or hardly any beside their dimension."""
    general, meant = _general_and_meant(rows)
    usual = np.ones(len(sizes["torque"]), dtype=bool)
    for name, one in limits.items():
        share = (one.high - one.low) / 2 / np.where(sizes[name] == 0, 1.0, abs(sizes[name]))
        usual &= share <= (_COARSE if name in general & _THICKNESSES else _WIDE)
        usual &= (share >= _EXACT) | (name not in meant)
    return usual


def _numbers_are_fine(arrays: VariantArrays, numbers: pl.DataFrame) -> npt.NDArray[np.bool_]:
    """Return of which variants there is surely nothing to say about their nominal numbers."""
    of = {name: numbers[name].to_numpy() for name in _LOOKED_AT}
    sizes, asked, none = arrays.dimensions, arrays.numbers, np.full(numbers.height, np.nan)
    refined = np.any([np.isfinite(sizes.get(name, none)) for name in _REFINEMENTS], axis=0)
    listed = [catalogue_torque(radius) for radius in of["mean_radius"].tolist()]
    most = np.array([one.torque if one else np.nan for one in listed])
    return ~(  # type: ignore[no-any-return]
        ~((of["backlash"] > _LEAST) & (of["backlash"] < _GREATEST))
        | (refined & ((sizes["cylinder_calibration"] != 1) | (sizes["disk_calibration"] != 1)))
        | (of["von_mises"] > asked["yield_strength"])
        | (of["alternating_stress"] > ENDURANCE * asked["yield_strength"])
        | (of["wall_shear"] > of["buckling_shear"])
        | (sizes["torque"] > most)
        | (of["least_stiffness"] > of["stiffness"])
        | (of["resonance_speed_low"] < _USUAL_SPEED)
        | (of["backlash"] > asked["backlash_limit"])
    )


_LOOKED_AT = (
    "alternating_stress",
    "backlash",
    "buckling_shear",
    "least_stiffness",
    "mean_radius",
    "resonance_speed_low",
    "stiffness",
    "von_mises",
    "wall_shear",
)


def _report_all_limits(ledger: Ledger, variant: Variant, validated: Validated) -> None:
    """Record all that is to be said of a variant's limits."""
    rows = validated.classes[plain(variant.tolerance_class)]
    found, untabulated = limits_of(variant, rows, BACKLASH_OF[variant.flexspline_type])
    problems = (*untabulated, *shape_problems(variant, found)[1])
    for problem in problems:
        _report_limits(ledger, variant, problem)
    kinds = {problem.dimension: problem.kind for problem in problems if problem.kind != "overlap"}
    _judge_widths(ledger, variant, rows, found, kinds)
    report_processes(ledger, variant, validated, rows, found)


def _report_numbers(
    ledger: Ledger,
    variant: Variant,
    nominal: NominalNumbers,
    mistakes: Mapping[int | str, Sequence[UnitMistake]],
) -> None:
    """Record all that is to be said of a variant's nominal numbers."""
    mistaken = [*mistakes.get(variant.row, ()), *mistakes.get(plain(variant.material), ())]
    if not _LEAST < nominal.backlash < _GREATEST:
        _report_backlash(ledger, variant, nominal, mistaken)
        return
    _report_calibration(ledger, variant)
    if not mistaken:
        _report_strength(ledger, variant, nominal)
        _report_stiffness(ledger, variant, nominal)
        _report_limit(ledger, variant, nominal)


def _by_owner(mistakes: Iterable[UnitMistake]) -> dict[int | str, list[UnitMistake]]:
    """Return the mistakes of units by row of Variants, or by plain name of the material."""
    found: dict[int | str, list[UnitMistake]] = defaultdict(list)
    for mistake in mistakes:
        found[mistake.material if mistake.schema == "Materials" else mistake.row].append(mistake)
    return found


def _report_limits(ledger: Ledger, variant: Variant, problem: LimitsProblem) -> None:
    """Record what is wrong with a variant's limits at the cell of the dimension, else at its material."""
    column = DIMENSIONS[problem.dimension]
    value = variant.dimensions[problem.dimension] / column.si_unit.si
    ledger.add_at(
        _CODES[problem.kind],
        variant,
        column.variant_key,
        name=column.name,
        value=f"{value:.10g}",
        other=variant.tolerance_class,
        detail=problem.detail,
    )


def _judge_widths(
    ledger: Ledger,
    variant: Variant,
    rows: Sequence[ToleranceRow],
    limits: Mapping[str, Limits],
    kinds: Mapping[str, str],
) -> None:
    """Report limits that are wide or hardly any beside their dimension, and general tolerances on thin parts.

    `kinds` are the problems that dimensions have already: beside a cut tail only an absurd width is reported.
    """
    general, meant = _general_and_meant(rows)
    for name, limit in limits.items():
        column, nominal = DIMENSIONS[name], variant.dimensions[name]
        share = (limit.high - limit.low) / 2 / (abs(nominal) or 1.0)
        code = _width_code(share, coarse=name in general & _THICKNESSES, meant=name in meant)
        told = kinds.get(name)
        if not code or (column.sheet == "Settings" and code == "W421") or (told and (told, code) != ("cut", "E333")):
            continue
        ledger.add_at(
            code,
            variant,
            column.variant_key,
            name=column.name,
            value=f"{nominal / column.si_unit.si:.10g}{column.unit_behind}",
            other=variant.tolerance_class,
            detail=f"{share:.2g}" if code == "W441" else f"{100 * share:.3g}",
        )


def _general_and_meant(rows: Sequence[ToleranceRow]) -> tuple[set[str], set[str]]:
    """Return the dimensions with a general tolerance, and those that are meant to scatter."""
    general = {row.dimension for row in rows if (row.grade or "").startswith("2768")}
    return general, {row.dimension for row in rows if row.scatters}


def _width_code(share: float, *, coarse: bool, meant: bool) -> str:
    """Return the code of what is wrong with half a width of limits, as a share of the value; empty for nothing."""
    if share > 1 + _ROUNDING:
        return "E333"
    if coarse and share > _COARSE + _ROUNDING:
        return "W422"
    if share > _WIDE + _ROUNDING:
        return "W421"
    return "W441" if meant and share < _EXACT else ""


def _report_exact(validated: Validated, arrays: VariantArrays, ledger: Ledger) -> None:
    """Warn once of each class that has no row for dimensions which `standard` scatters and one of its variants has."""
    table, standard = validated.tolerances, validated.classes.get("standard", [])
    if table is None:
        return
    exact: dict[str, set[str]] = defaultdict(set)
    for _, owner, _, sizes in arrays.alike(validated.variants.classes):
        exact[owner] |= varying(sizes, standard) - {row.dimension for row in validated.classes[owner]}
    for row, name in table.frame.select("row", "tolerance_class").iter_rows():
        if left := exact.pop(plain(name or ""), None):
            words = ", ".join(column.plain_name for one, column in DIMENSIONS.items() if one in left)
            place: dict[str, Any] = {"sheet": table.sheet, "cell": table.address(row, "tolerance_class")}
            ledger.add("W438", column="tolerance_class", value=name, detail=words, **place)


def _report_backlash(
    ledger: Ledger, variant: Variant, nominal: NominalNumbers, mistaken: Iterable[UnitMistake]
) -> None:
    """Record a backlash that no flexspline has: where a unit is mistaken, once for a material; else here."""
    value = f"{nominal.backlash:.3g}"
    cause = next((mistake for mistake in mistaken if mistake.column != "yield_MPa"), None)
    if cause is None:
        ledger.add_at("E324", variant, "torque_Nm", value=value)
        return
    ledger.rows.add(variant.row)
    if cause.material in ledger.materials:
        return
    place: dict[str, Any] = {"sheet": cause.sheet, "cell": cause.cell, "column": cause.column}
    ledger.add("E324", variant=cause.variant, value=value, entered=cause.entered, **place)
    if cause.material:
        ledger.spoil("material", cause.material, cause.sheet, cause.row)


def _report_strength(ledger: Ledger, variant: Variant, nominal: NominalNumbers) -> None:
    """Warn when the part yields, buckles or tires, or else where its torque is above that of drives of its size."""
    stress, strength = nominal.von_mises, variant.yield_strength
    shear, buckling = nominal.wall_shear, nominal.buckling_shear
    yields, buckles = strength is not None and stress > strength, buckling is not None and shear > buckling
    if strength is not None and yields:
        facts = {"value": _megapascals(stress), "other": strength / 1e6, "detail": nominal.governing_section}
        ledger.add_at("W402", variant, "torque_Nm", **facts)
    if buckling is not None and buckles:
        ledger.add_at("W411", variant, "torque_Nm", value=_megapascals(shear), other=_megapascals(buckling))
    alternating, key = nominal.alternating_stress, "radial_deflection_mm"
    if strength is not None and alternating is not None and alternating > ENDURANCE * strength:
        facts = {"value": _megapascals(alternating), "other": strength / 1e6, "detail": f"{ENDURANCE:g}"}
        ledger.add_at("W460", variant, key, name=_name(key), **facts)
    listed, torque = catalogue_torque(nominal.mean_radius), variant.dimensions["torque"]
    if listed and torque > listed.torque and not (yields or buckles):
        facts = {"value": f"{torque:.10g}", "other": listed.torque, "detail": listed.size}
        ledger.add_at("W424", variant, "torque_Nm", name=_name("torque_Nm"), **facts)


def _report_stiffness(ledger: Ledger, variant: Variant, nominal: NominalNumbers) -> None:
    """Warn when the flexspline is softer than drives that contain one, or resonates within usual speeds."""
    stiffness, least = nominal.stiffness, nominal.least_stiffness
    if least is not None and least > stiffness:
        key = "mean_radius_mm" if "mean_radius" in variant.dimensions else "bore_diameter_mm"
        size = f"{nominal.catalogue_size:.0f}"
        ledger.add_at("W412", variant, key, value=spelled_out(stiffness), other=spelled_out(least), detail=size)
    frequency, speed, least_speed = nominal.natural_frequency, nominal.resonance_speed, nominal.resonance_speed_low
    if frequency is not None and speed is not None and least_speed is not None and least_speed < _USUAL_SPEED:
        low, high = (spelled_out(one / RPM, 2) for one in (least_speed, speed))
        span = high if low == high else f"{low} to {high}"
        ledger.add_at("W415", variant, "load_inertia_kg_m2", value=spelled_out(frequency, 2), other=span)


def _report_limit(ledger: Ledger, variant: Variant, nominal: NominalNumbers) -> None:
    """Warn when the nominal backlash is over the limit already."""
    limit, key = variant.backlash_limit, "backlash_limit_arcmin"
    if limit is not None and nominal.backlash > limit:
        value, backlash = (f"{angle / ARCMIN:.5g}" for angle in (limit, nominal.backlash))
        ledger.add_at("W423", variant, key, name=_name(key), value=value, other=backlash)


def _name(key: str) -> str:
    """Return the name of a column of Variants."""
    return columns_of("Variants")[key].name


def _megapascals(stress: float) -> str:
    return spelled_out(stress / 1e6)


def _report_calibration(ledger: Ledger, variant: Variant) -> None:
    """Warn when a calibration meets refinement columns, which it contains already."""
    used = [key for name, key in _REFINEMENTS.items() if name in variant.dimensions]
    factors = (variant.dimensions["cylinder_calibration"], variant.dimensions["disk_calibration"])
    if used and factors != (1.0, 1.0):
        ledger.add_at("W407", variant, used[0])
