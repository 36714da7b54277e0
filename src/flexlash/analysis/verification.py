"""The elasticity check of all computed rows: numbers beside the formula's, findings where they part, pictures."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from flexlash.analysis.assessment import Computed, blame
from flexlash.mechanics.elasticity import MISSING, is_available
from flexlash.mechanics.elasticity.part import section_problem
from flexlash.mechanics.elasticity.twist import ElasticityCheck, elasticity_check
from flexlash.mechanics.strength import von_mises_stress
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.findings import spelled_out
from flexlash.schema.variant import Variant
from flexlash.validation.validate import Validated
from flexlash.workers import mapped

__all__ = ["WORTH_A_WORKER", "Checked", "pictured", "verified"]

WORTH_A_WORKER = 25
"""Rows per worker below which starting it costs more than it saves."""

_FAR = 0.02
"""Difference between formula and elasticity, as a share, above which a row is flagged."""

_MEGAPASCAL = 1e6

_UNSOLVED = 0.01
"""Error of the elasticity check, as a share, above which it says nothing."""

Task = tuple[str, Mapping[str, float]]


@dataclass(frozen=True, kw_only=True)
class Checked:
    """What the elasticity check of one variant found: wind-up [rad], its error [-], peak stresses at fillets [Pa]."""

    windup: float
    error: float
    hub_fillet_shear: float | None
    junction_fillet_shear: float | None


def verified(
    validated: Validated,
    computed: Mapping[int, Computed],
    *,
    jobs: int,
    progress: Callable[[int, int], None] | None = None,
) -> dict[int, Computed]:
    """Return the computed rows with their elasticity check; findings go to the ledger.

    A row whose dimensions make no closed half-section stays without one. Raises ModuleNotFoundError when the
    libraries of the check are not installed.
    """
    if not is_available():
        raise ModuleNotFoundError(MISSING)
    found = dict(computed)
    rows = list(_closed(validated, computed))
    tasks = [(computed[row].variant.flexspline_type, computed[row].variant.dimensions) for row in rows]
    results = mapped(_checked, tasks, min(jobs, len(tasks) // WORTH_A_WORKER))
    for done, (row, result) in enumerate(zip(rows, results, strict=True), start=1):
        one = computed[row]
        if result is None:
            _flag(validated, one.variant, "wall_thickness", "so extreme a part cannot be solved to 1 %")
        else:
            found[row] = replace(one, nominal=one.nominal | _numbers(one, result))
            _compare(validated, found[row])
        if progress:
            progress(done, len(rows))
    return found


def _closed(validated: Validated, computed: Mapping[int, Computed]) -> Iterator[int]:
    """Yield the rows whose dimensions make a half-section; flag the others at the dimension to blame."""
    for row, one in computed.items():
        problem = section_problem(one.variant.flexspline_type, one.variant.dimensions)
        if problem is None:
            yield row
        else:
            _flag(validated, one.variant, *problem)


def _flag(validated: Validated, variant: Variant, dimension: str, clause: str) -> None:
    """Record that a variant cannot be checked, at the dimension to blame."""
    column = DIMENSIONS[dimension]
    value = f"{variant.dimensions[dimension] / column.si_unit.si:.10g} {column.unit}"
    blame(validated, "W413", variant, column.key, name=column.name, value=value, detail=clause)


def _compare(validated: Validated, one: Computed) -> None:
    """Flag a row whose formula is far from elasticity, or whose fillet yields."""
    difference = one.nominal["elasticity_difference"]
    if isinstance(difference, float) and abs(difference) > _FAR:
        words = f"{abs(100 * difference):.1f} % {'above' if difference > 0 else 'below'}"
        blame(validated, "W414", one.variant, "variant", value=words)
    limit = one.variant.yield_strength
    for fillet in ("hub_fillet", "junction_fillet"):
        shear = one.nominal[f"elasticity_{fillet}_shear"]
        if isinstance(shear, float) and limit is not None and von_mises_stress(shear) > limit:
            column = DIMENSIONS[f"{fillet}_radius"]
            value = f"{one.variant.dimensions[column.dimension] / column.si_unit.si:.10g}"
            peak = spelled_out(float(von_mises_stress(shear)) / _MEGAPASCAL)
            facts = {"name": column.name, "value": value, "detail": peak, "other": limit / _MEGAPASCAL}
            blame(validated, "W417", one.variant, column.key, **facts)


def _checked(task: Task) -> Checked | None:
    """Return the check of one variant in numbers alone, None where its equations cannot be solved."""
    try:
        found = elasticity_check(*task)
    except (ArithmeticError, RuntimeError):
        return None
    if not (found.windup > 0 and found.error < _UNSOLVED):
        return None
    return Checked(
        windup=found.windup,
        error=found.error,
        hub_fillet_shear=found.hub_fillet_shear,
        junction_fillet_shear=found.junction_fillet_shear,
    )


def _numbers(one: Computed, result: Checked) -> dict[str, float | str | None]:
    """Return the check's results [SI] by result key without unit.

    The difference is that of the formula without calibration, relative to elasticity.
    """
    uncalibrated = 0.0
    for part in ("cylinder", "disk"):
        windup = one.nominal[f"{part}_windup"]
        if isinstance(windup, float):
            uncalibrated += windup / one.variant.dimensions.get(f"{part}_calibration", 1.0)
    return {
        "elasticity_windup": result.windup,
        "elasticity_difference": uncalibrated / result.windup - 1,
        "elasticity_error": result.error,
        "elasticity_hub_fillet_shear": result.hub_fillet_shear,
        "elasticity_junction_fillet_shear": result.junction_fillet_shear,
    }


def pictured(computed: Sequence[Computed]) -> dict[str, ElasticityCheck]:
    """Return the checks of variants with their stress fields, by name; only those that were checked."""
    return {
        one.variant.name: elasticity_check(one.variant.flexspline_type, one.variant.dimensions)
        for one in computed
        if "elasticity_windup" in one.nominal
    }
