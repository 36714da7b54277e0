"""What the report says where dimensions scatter together, and where they do not."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from flexlash.analysis.computed import Computed
from flexlash.schema.entry_words import dimension_title, dimension_words
from flexlash.schema.findings import shown
from flexlash.schema.spellings import plain

__all__ = ["correlation_sentences", "first_order_sentence", "share_sentence", "shared_out"]

_LISTED = 12
"""Most pairs of a class that are named."""

_COUPLED = "What dimensions that scatter together cause as a group is shared out among them by Shapley's value"


def correlation_sentences(computed: Mapping[int, Computed]) -> Iterator[str]:
    """Yield which dimensions scatter together, class by class, and what their correlations are."""
    first = _first(computed)
    if first is None or not first.among.correlations:
        yield "All dimensions of a variant scatter independently of one another."
        return
    yield (
        "Dimensions scatter together where sheet Correlations says so, else where they were measured on the same "
        "parts; all others are independent. Correlations are Pearson's of the normal scores (a Gaussian copula); a "
        "variant that lacks one of two dimensions does without the pair."
    )
    validated = first.among.validated
    entered = {(row.first, row.second, row.correlation) for row in validated.correlation_rows}
    for key, pairs in first.among.correlations.items():
        rows = validated.classes[key]
        name = next((row.tolerance_class for row in rows if plain(row.tolerance_class) == key), key)
        listed = [
            f"{_pair(*pair)} {value:.3g}{'' if (*pair, value) in entered else ' (measured)'}"
            for pair, value in list(pairs.items())[:_LISTED]
        ]
        more = f"; {len(pairs) - _LISTED} more pairs" if len(pairs) > _LISTED else ""
        yield f"Class {shown(name)}: {'; '.join(listed)}{more}."


def first_order_sentence(computed: Mapping[int, Computed]) -> str:
    """Return how the first-order standard deviation is made."""
    crossed = (
        ", and 2 r (slope × sd)(slope × sd) for each two dimensions that scatter together, r Pearson's correlation of "
        "their values"
    )
    ties = crossed if _are_coupled(computed) else ""
    return f"First-order sd: root of the sum of squared (slope × sd) at mid-limits{ties}, as in the GUM."


def share_sentence(computed: Mapping[int, Computed]) -> str:
    """Return what a share of the variance is."""
    coupled = f"{_COUPLED}, since neither's own part can be told from the other's. " if _are_coupled(computed) else ""
    return (
        "Shares: first-order Sobol' indices, each dimension's own part of the variance; total indices add every "
        f"interaction it takes part in. {coupled}Both are estimates, good to about 0.002 unless interactions are "
        "strong."
    )


def shared_out(computed: Mapping[int, Computed]) -> str:
    """Return what a note on shares adds where dimensions scatter together."""
    return f"{_COUPLED}." if _are_coupled(computed) else ""


def _are_coupled(computed: Mapping[int, Computed]) -> bool:
    first = _first(computed)
    return first is not None and bool(first.among.correlations)


def _first(computed: Mapping[int, Computed]) -> Computed | None:
    return next(iter(computed.values()), None)


def _pair(first: str, second: str) -> str:
    return f"{dimension_title(first)} with {dimension_words(second)}"
