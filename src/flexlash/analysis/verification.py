"""The elasticity check of all computed rows: numbers beside the formula's, findings where they part, pictures."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from flexlash.analysis.computed import Computed, Elasticity, Verified
from flexlash.analysis.examination import Examined
from flexlash.analysis.options import Options
from flexlash.mechanics.elasticity import require_libraries
from flexlash.mechanics.elasticity.part import section_problem
from flexlash.mechanics.elasticity.twist import ElasticityCheck, elasticity_check
from flexlash.mechanics.elasticity.two_lobes import ENGAGED_SHARE, TwoLobeBracket, bracket_problem, two_lobe_bracket
from flexlash.mechanics.strength import von_mises_stress
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.findings import spelled_out
from flexlash.schema.variant import Variant
from flexlash.validation.ledger import Ledger
from flexlash.workers import mapped

__all__ = ["WORTH_A_WORKER", "pictured", "verified_by_elasticity"]

WORTH_A_WORKER = 25
"""Rows per worker below which starting it costs more than it saves."""

_FAR = 0.02
"""Difference between formula and elasticity, as a share, above which a row is flagged."""

_MEGAPASCAL = 1e6

_UNSOLVED = 0.01
"""Error of the elasticity check, as a share, above which it says nothing."""

_Task = tuple[Variant, float]
"""A variant and its wind-up by the formula without calibration."""


def verified_by_elasticity(examined: Examined, options: Options) -> Verified:
    """Return the elasticity check of the computed rows, and where the formula is far from it or a fillet yields.

    A row whose dimensions make no closed half-section stays without one. Raises MissingLibrariesError when the
    libraries of the check are not installed.
    """
    require_libraries()
    computed, ledger = examined.nominal.computed, Ledger.after(examined.validated)
    rows = list(_closed(computed.values(), ledger))
    tasks = [(one.variant, _uncalibrated(one)) for one in rows]
    checks: dict[int, Elasticity] = {}
    found = mapped(_checked, tasks, min(options.jobs, len(tasks) // WORTH_A_WORKER))
    for done, (one, check) in enumerate(zip(rows, found, strict=True), start=1):
        if check is None:
            _report_unsolved(ledger, one.variant, "wall_thickness", "so extreme a part cannot be solved to 1 %")
        else:
            checks[one.variant.row] = check
            _compare(ledger, one.variant, check)
            _report_no_bounds(ledger, one.variant)
        if options.progress:
            options.progress(len(computed) + done, len(computed) + len(rows))
    return Verified(checks=checks, findings=tuple(ledger.findings))


def _closed(computed: Iterable[Computed], ledger: Ledger) -> Iterator[Computed]:
    """Yield the rows whose dimensions make a half-section; report the others at the dimension to blame."""
    for one in computed:
        problem = section_problem(one.variant.flexspline_type, one.variant.dimensions)
        if problem is None:
            yield one
        else:
            _report_unsolved(ledger, one.variant, *problem)


def _report_unsolved(ledger: Ledger, variant: Variant, dimension: str, clause: str) -> None:
    """Record that a variant cannot be checked, at the dimension to blame."""
    column = DIMENSIONS[dimension]
    value = f"{variant.dimensions[dimension] / column.si_unit.si:.10g} {column.unit}"
    ledger.add_at("W413", variant, column.key, name=column.name, value=value, detail=clause)


def _report_no_bounds(ledger: Ledger, variant: Variant) -> None:
    """Record why a variant whose teeth have a width has no bounds for two lobes."""
    width = variant.dimensions.get("tooth_face_width")
    problem = _bracket_problem(variant) if width else None
    if width and problem:
        column = DIMENSIONS["tooth_face_width"]
        value = f"{width / column.si_unit.si:.10g}"
        ledger.add_at("I540", variant, column.key, name=column.name, value=value, detail=problem)


def _bracket_problem(variant: Variant) -> str | None:
    """Return why a variant has no bounds for two lobes, as a clause."""
    return bracket_problem(
        variant.flexspline_type,
        variant.dimensions,
        poisson_ratio=variant.poisson_ratio,
        bearing_width=variant.bearing_width,
    )


def _compare(ledger: Ledger, variant: Variant, elasticity: Elasticity) -> None:
    """Record that a row's formula is far from elasticity, or that its fillet yields."""
    difference, limit = elasticity.difference, variant.yield_strength
    if abs(difference) > _FAR:
        words = f"{abs(100 * difference):.1f} % {'above' if difference > 0 else 'below'}"
        ledger.add_at("W414", variant, "variant", value=words)
    fillets = {"hub_fillet_radius": elasticity.hub_fillet_shear}
    fillets["junction_fillet_radius"] = elasticity.junction_fillet_shear
    for fillet, shear in fillets.items():
        if shear is not None and limit is not None and von_mises_stress(shear) > limit:
            column = DIMENSIONS[fillet]
            value = f"{variant.dimensions[fillet] / column.si_unit.si:.10g}"
            peak = spelled_out(float(von_mises_stress(shear)) / _MEGAPASCAL)
            facts = {"name": column.name, "value": value, "detail": peak, "other": limit / _MEGAPASCAL}
            ledger.add_at("W417", variant, column.key, **facts)


def _checked(task: _Task) -> Elasticity | None:
    """Return the check of one variant in numbers alone, None where its equations cannot be solved."""
    variant, uncalibrated = task
    try:
        found = elasticity_check(variant.flexspline_type, variant.dimensions)
        bracket = None if _bracket_problem(variant) else _bracket(variant)
    except (ArithmeticError, RuntimeError):
        return None
    if not (found.windup > 0 and found.error < _UNSOLVED):
        return None
    return Elasticity(
        windup=found.windup,
        difference=uncalibrated / found.windup - 1,
        error=found.error,
        hub_fillet_shear=found.hub_fillet_shear,
        junction_fillet_shear=found.junction_fillet_shear,
        two_lobe_low=2 * bracket.low if bracket else None,
        two_lobe_high=2 * bracket.high if bracket else None,
        face_width_change=bracket.face_factor - 1 if bracket else None,
    )


def _bracket(variant: Variant) -> TwoLobeBracket:
    """Return the bounds of a variant under two lobes."""
    engaged = ENGAGED_SHARE if variant.engaged_teeth is None else variant.engaged_teeth
    return two_lobe_bracket(
        variant.flexspline_type,
        variant.dimensions,
        poisson_ratio=variant.poisson_ratio,
        bearing_width=variant.bearing_width,
        engaged_share=engaged,
    )


def _uncalibrated(one: Computed) -> float:
    """Return the wind-up [rad] by the formula without calibration."""
    dimensions, nominal = one.variant.dimensions, one.nominal
    cylinder = nominal.cylinder_windup / dimensions.get("cylinder_calibration", 1.0)
    return cylinder + nominal.disk_windup / dimensions.get("disk_calibration", 1.0)


def pictured(computed: Iterable[Computed]) -> dict[str, ElasticityCheck]:
    """Return the checks of variants with their stress fields, by name; only those that were checked."""
    return {
        one.variant.name: elasticity_check(one.variant.flexspline_type, one.variant.dimensions)
        for one in computed
        if one.elasticity is not None
    }
