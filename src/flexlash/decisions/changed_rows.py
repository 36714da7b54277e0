"""Changed variants as a submission of them would be spread."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from flexlash.analysis.backlash_models import BACKLASH_OF
from flexlash.decisions.lever import Terms
from flexlash.schema.spellings import plain
from flexlash.schema.variant import Limits, Variant
from flexlash.tolerance.dimension_limits import LimitsProblem, limits_of, shape_problems
from flexlash.tolerance.row_batches import TolerancedRow
from flexlash.tolerance.row_probabilities import probabilities_over
from flexlash.tolerance.sampling import SamplingPlan

__all__ = ["limits_as_submitted", "over_limit", "run_plan", "toleranced"]


def limits_as_submitted(variant: Variant, terms: Terms) -> tuple[dict[str, Limits], tuple[LimitsProblem, ...]]:
    """Return the limits that its class gives a variant, far tails cut, and what is wrong with them."""
    rows = terms.classes[plain(variant.tolerance_class)]
    limits, untabulated = limits_of(variant, rows, BACKLASH_OF[variant.flexspline_type])
    kept, problems = shape_problems(variant, limits)
    return kept, (*untabulated, *problems)


def toleranced(variant: Variant, limits: Mapping[str, Limits], limit: float, terms: Terms) -> TolerancedRow:
    """Return a variant between limits as the spread of it takes it, with its greatest backlash [rad]."""
    pairs = terms.correlations.get(plain(variant.tolerance_class), {})
    scattering = {name for name, one in limits.items() if one.low < one.high} if pairs else set()
    return TolerancedRow(
        model=BACKLASH_OF[variant.flexspline_type],
        nominal=variant.dimensions,
        limits=limits,
        upper_limit=limit,
        correlation=tuple((*pair, value) for pair, value in pairs.items() if scattering.issuperset(pair)),
    )


def run_plan(terms: Terms, *, by_lines: bool = False) -> SamplingPlan:
    """Return the plan of the run, or that of lines whatever the run's is."""
    plan = terms.plan
    return replace(plan, method="line", samples=None) if by_lines and plan.method != "line" else plan


def over_limit(rows: Sequence[TolerancedRow], terms: Terms, *, by_lines: bool = False) -> list[float]:
    """Return the share of units over the limit of each row, by the run's own plan, or by lines whatever that is."""
    return [one.probability for one in probabilities_over(rows, run_plan(terms, by_lines=by_lines))]
