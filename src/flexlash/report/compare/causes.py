"""An outcome → what causes the spread, in words: which tolerance matters in every variant, which in one alone."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from flexlash.analysis.computed import Computed
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.run_summary import listed
from flexlash.report.report_data import Drawn
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.findings import shown

__all__ = [
    "MATTERS",
    "Cause",
    "cause_sentences",
    "causes_of",
    "causes_of_drawn",
    "left_out",
    "mean_share",
    "ranked_dimensions",
]

MATTERS = 0.005
"""Least share of variance that a dimension needs somewhere to have a row: what prints as 1 %."""

_HURTS = 0.1
_NAMED, _LISTED = 3, 8
_NAME = 30
"""Most characters of a name in a sentence or a heading."""


@dataclass(frozen=True, kw_only=True)
class Cause:
    """What causes the spread of one variant: the share of variance of each dimension, and the main one."""

    name: str
    shares: Mapping[str, float]
    main: str | None


def causes_of(outcome: Outcome) -> list[Cause]:
    """Return the causes of all computed variants that scatter, in submitted order."""
    main = dict(zip(outcome.results["variant"], outcome.results["main_contributor"], strict=True))
    return list(_causes((computed, main[computed.variant.name]) for computed in outcome.computed.values()))


def causes_of_drawn(drawn: Sequence[Drawn]) -> list[Cause]:
    """Return the causes of the drawn variants that scatter, worst first."""
    return list(_causes((variant.computed, variant.row["main_contributor"]) for variant in drawn))


def _causes(variants: Iterable[tuple[Computed, str | None]]) -> Iterator[Cause]:
    """Yield the causes of variants, each given with its main contributor, that scatter."""
    for computed, main in variants:
        if computed.spread is not None and computed.spread.shares:
            yield Cause(name=computed.variant.name, shares=computed.spread.shares, main=main)


def ranked_dimensions(causes: Sequence[Cause]) -> list[str]:
    """Return the dimensions that matter somewhere, the greatest mean share first."""
    mattering = {name for cause in causes for name, share in cause.shares.items() if share >= MATTERS}
    return sorted(filter(mattering.__contains__, DIMENSIONS), key=lambda name: -mean_share(causes, name))


def mean_share(causes: Sequence[Cause], dimension: str) -> float:
    """Return the mean share of a dimension; a variant that does not have it counts as none."""
    return math.fsum(cause.shares.get(dimension, 0.0) for cause in causes) / len(causes)


def left_out(causes: Sequence[Cause]) -> Iterator[str]:
    """Yield which dimensions have a tolerance that matters nowhere."""
    rest = {name for cause in causes for name in cause.shares} - set(ranked_dimensions(causes))
    names = [dimension_words(name) for name in DIMENSIONS if name in rest]
    if names:
        yield f"Below {100 * MATTERS:g} % everywhere and left out: {listed(names, _LISTED)}."


def cause_sentences(causes: Sequence[Cause]) -> Iterator[str]:
    """Yield which tolerance hurts everywhere and which in one variant only."""
    if not causes:
        yield "No dimension has a tolerance that counts: nothing scatters."
        return
    yield _sentence("; ".join(_main_words(causes)))
    if len(causes) > 1:
        yield from _hurting(causes)


def _main_words(causes: Sequence[Cause]) -> Iterator[str]:
    """Yield of each main contributor in how many variants it is, the most frequent first."""
    counts = Counter(cause.main for cause in causes if cause.main)
    ranked = sorted(counts, key=lambda name: (-counts[name], list(DIMENSIONS).index(name)))
    for rank, name in enumerate(ranked[: _NAMED + 1]):
        verb = " is the main contributor" if not rank else ""
        if counts[name] == len(causes):
            where = f"in all {len(causes)} variants" if len(causes) > 1 else f"of {_first(causes, name)}"
        elif counts[name] == 1:
            where = f"{'only ' if rank else ''}in {_first(causes, name)}"
        else:
            where = f"in {counts[name]}" + ("" if rank else f" of {len(causes)} variants")
        yield f"{dimension_words(name)}{verb} {where}"
    rest = sum(counts[name] for name in ranked[_NAMED + 1 :])
    if rest:
        yield f"other dimensions in {rest}"


def _first(causes: Sequence[Cause], main: str) -> str:
    """Return the name of the first variant with a main contributor, as a sentence shows it."""
    return shown(next(cause.name for cause in causes if cause.main == main), longest=_NAME)


def _hurting(causes: Sequence[Cause]) -> Iterator[str]:
    """Yield which dimensions take much of the variance of every variant, and which of one alone."""
    hurt = {
        name: [cause for cause in causes if cause.shares.get(name, 0.0) >= _HURTS] for name in ranked_dimensions(causes)
    }
    everywhere = [dimension_words(name) for name, where in hurt.items() if len(where) == len(causes)]
    only = [
        f"{dimension_words(name)} only in {shown(where[0].name, longest=_NAME)} ({100 * where[0].shares[name]:.0f} %)"
        for name, where in hurt.items()
        if len(where) == 1
    ]
    hurts = "hurts" if len(everywhere) == 1 else "hurt"
    start = f"{' and '.join(everywhere) or 'no dimension'} {hurts if everywhere else 'hurts'} everywhere"
    more = f"; {len(only) - _NAMED} more in one variant each" if len(only) > _NAMED else ""
    named = f"; {', '.join(only[:_NAMED])}" if only else ""
    yield _sentence(f"{start} (10 % of the variance or more){named}{more}")


def _sentence(text: str) -> str:
    return f"{text[0].upper()}{text[1:]}."
