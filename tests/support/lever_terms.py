"""What levers take of an outcome, as the report gives it."""

from flexlash.analysis.tolerance_spread import sampling_plan
from flexlash.decisions.lever import Present, Terms

__all__ = ["presents_of", "terms_of"]

_QUANTILES = {0.00135: "p0_135", 0.025: "p2_5", 0.5: "p50", 0.975: "p97_5", 0.99865: "p99_865"}


def terms_of(outcome, **changed):
    """Return what holds for all levers of an outcome."""
    among = next(iter(outcome.computed.values())).among
    rest = {
        "classes": outcome.validated.classes,
        "correlations": among.correlations,
        "rows": outcome.validated.levers,
        "plan": sampling_plan(outcome.settings, outcome.options),
        "target": 1 - outcome.settings.target_percent / 100,
    }
    return Terms(**rest | changed)


def presents_of(outcome):
    """Return the variants of an outcome that have a limit, as they are."""
    return [
        Present(
            variant=one.variant,
            limit=one.variant.backlash_limit,
            over=one.spread.numbers["probability_over_limit"],
            quantiles={level: one.spread.numbers[name] for level, name in _QUANTILES.items()},
        )
        for one in outcome.computed.values()
        if one.variant.backlash_limit is not None
    ]
