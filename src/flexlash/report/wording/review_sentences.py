"""Results rows → sentences for who judges a report: what is compared, other limits, limits used, trust in the model."""

from __future__ import annotations

import math
from collections.abc import Iterator

from flexlash.analysis.run_summary import listed
from flexlash.report.wording.distances import STORED, deciding_percentile
from flexlash.report.wording.summary_facts import NAMED, Row, SummaryFacts, first_rows
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.findings import shown, spelled_out
from flexlash.schema.number_words import glance, places, rounded
from flexlash.schema.units import as_entered
from flexlash.schema.variant import Limits

__all__ = [
    "ANOTHER",
    "COMPARED",
    "FINITE_ELEMENTS",
    "LIMITS",
    "MODEL",
    "TWO_TERMS",
    "WITH_FILLETS_AND_RIM",
    "another_limit",
    "another_limit_of",
    "limits_used",
    "model_trust",
    "strength_of",
    "what_is_compared",
]

COMPARED, ANOTHER, LIMITS, MODEL = "What is compared", "Another limit", "Limits used", "Model"
"""The topics of these sentences."""

FINITE_ELEMENTS, TWO_TERMS, WITH_FILLETS_AND_RIM = 3.390, 3.687, 3.405
"""Backlash [arcmin] of the published part: by published finite elements, by two terms, by all of its shape."""

_LENGTHS = 3
"""Most limits that a sentence tells."""

_CLASS, _DIGITS = 40, 3
_NEARLY = 1e-9
"""Part of a step by which a number may miss its round value."""


def what_is_compared(facts: SummaryFacts) -> Iterator[str]:
    """Yield what a limit is compared with, and what is not in it."""
    if facts.worst is None:
        return
    yield (
        "The limit is compared with 2U at full torque, the elastic lag of the flexspline when its whole torque "
        "reverses, which is no catalogue's definition of backlash."
    )
    sources = facts.outcome.validated.other_sources if facts.outcome.validated else ()
    how = "sheet Drive adds up those that are entered" if sources else "entered in Other sources they are added up"
    yield f"Clearances and hysteresis come on top; {how}."


def another_limit(facts: SummaryFacts) -> Iterator[str]:
    """Yield from which limit on the worst variants would meet it; nothing where that percentile is not stored."""
    if facts.bounds.target_words not in STORED:
        return
    rows = first_rows(facts.failing) or first_rows(facts.ranked, 1)
    verbs = [" meets any limit", *[""] * NAMED]
    told = [
        f"{facts.named(row['variant'])}{verb} from {_least_limit(facts, row)} on"
        for row, verb in zip(rows, verbs, strict=False)
    ]
    if told:
        yield f"{listed(told, NAMED, facts.failing.height)}. Any other: Explorer."


def limits_used(facts: SummaryFacts) -> Iterator[str]:
    """Yield between which limits the lengths of the worst variant lie, in the order of the template."""
    if facts.worst is None:
        return
    one = facts.computed(facts.worst)
    wide = {name: limits for name, limits in one.limits.items() if limits.low < limits.high}
    told = [_between(name, wide[name]) for name, column in DIMENSIONS.items() if name in wide and column.unit == "mm"]
    if told:
        klass = shown(one.variant.tolerance_class, longest=_CLASS)
        lengths = listed(told[:_LENGTHS], _LENGTHS, len(wide))
        yield f"{facts.named(one.variant.name)} (class {klass}): {lengths}."


def model_trust(facts: SummaryFacts) -> Iterator[str]:
    """Yield how far the formula is from finite elements, and what no number holds."""
    if facts.worst is None:
        return
    rough, fine = (100 * (formula / FINITE_ELEMENTS - 1) for formula in (TWO_TERMS, WITH_FILLETS_AND_RIM))
    yield (
        f"For B3-160 the formula is {fine:.1f} % above published finite elements with fillets and a rim of 20 mm (its "
        f"size is not published), {rough:.0f} % without; usual cups and hats are within 1.3 % of an independent "
        "program, others within 3 %. In no number: the wave generator's fit, which can add 20 to 130 %."
    )


def another_limit_of(facts: SummaryFacts, row: Row) -> Iterator[str]:
    """Yield from which limit on a variant would meet it, as `another_limit`."""
    if facts.bounds.target_words in STORED:
        yield f"It meets any limit from {_least_limit(facts, row)} on."


def strength_of(facts: SummaryFacts, row: Row) -> Iterator[str]:
    """Yield the greatest stress of torsion of a variant, and at how many times its torque it yields."""
    stress, limit = row["von_mises_MPa"], row["elastic_limit_torque_Nm"]
    if stress is None:
        return
    times = limit and spelled_out(limit / facts.computed(row).variant.dimensions["torque"], _DIGITS)
    yields = f"; it yields at {times} times the torque, corners not counted" if times else ""
    yield f"Von Mises of torsion only: {spelled_out(stress, _DIGITS)} MPa in the {row['governing_section']}{yields}."


def _least_limit(facts: SummaryFacts, row: Row) -> str:
    """Return the least limit that a variant meets, in the digits in which its deciding percentile is known."""
    key = deciding_percentile(facts.bounds)[0]
    value, error = (facts.angles.of(row[f"{name}_arcmin"] or 0.0) for name in (key, f"{key}_standard_error"))
    step = 10.0 ** -places(max(error, glance(value)))
    return f"{rounded(math.ceil(value / step - _NEARLY) * step, step)}{facts.angles.sign}"


def _between(name: str, limits: Limits) -> str:
    """Return a dimension with its limits: `wall thickness 1.5975 to 1.6025 mm`."""
    column = DIMENSIONS[name]
    low, high = (f"{as_entered(end, column.si_unit.si):.7g}" for end in (limits.low, limits.high))
    return f"{dimension_words(name)} {low} to {high} {column.unit}"
