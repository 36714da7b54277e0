"""Points of sweeps → their Results: each is computed as a submission of its own would be, all of them together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import polars as pl

from flexlash.analysis.assessment import assess
from flexlash.analysis.computed import Spread
from flexlash.analysis.examination import Examined
from flexlash.analysis.options import Progress
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.run_result import outcome_of
from flexlash.analysis.tolerance_spread import spread_of
from flexlash.schema.findings import Finding
from flexlash.schema.units import ARCMIN
from flexlash.validation.replaced_rows import Replacement, with_replacements

__all__ = ["point_levels", "point_results"]


def point_results(outcome: Outcome, points: Sequence[Replacement], progress: Progress | None = None) -> pl.DataFrame:
    """Return the Results of variants of a submission with other values in some cells, one row a point, in their order.

    The column `findings` says in words what is found at the point's own cells. Neither elasticity nor plain draws
    stand beside the numbers. Raises LookupError for a row that the submission does not have.
    """
    examined = _examined(outcome, points)
    found = outcome_of(examined, _spread(examined, progress))
    return found.results.with_columns(_words(found).alias("findings"))


def point_levels(outcome: Outcome, points: Sequence[Replacement], keys: Sequence[str]) -> pl.DataFrame:
    """Return columns of Results of such points that are angles [arcmin] or shares, with the backlash limit [arcmin].

    The numbers alone, without what makes a table of Results; null where a point is not computed.
    """
    examined = _examined(outcome, points)
    table = examined.validated.table if examined.validated else None
    if table is None:
        raise LookupError("points without rows")
    known = table.frame.select("row", "backlash_limit_arcmin")
    spread, numbers = _spread(examined), examined.nominal.computed.numbers
    if spread is None or numbers is None:
        return known.with_columns(pl.lit(None, dtype=pl.Float64).alias(key) for key in keys)
    for frame in (numbers, spread.statistics.frame):
        stems = {key.removesuffix("_arcmin"): key for key in keys}
        sizes = {stem: 1 / ARCMIN if key.endswith("_arcmin") else 1.0 for stem, key in stems.items()}
        own = [(pl.col(stem) * sizes[stem]).alias(key) for stem, key in stems.items() if stem in frame.columns]
        known = known.join(frame.select("row", *own), on="row", how="left", maintain_order="left")
    return known


def _examined(outcome: Outcome, points: Sequence[Replacement]) -> Examined:
    """Return the points as a submission that was validated and has nominal numbers."""
    if outcome.validated is None:
        raise LookupError("a submission that was not validated")
    validated = with_replacements(outcome.validated, points)
    return Examined(
        submission=outcome.submission,
        settings=outcome.settings,
        options=replace(outcome.options, elasticity=False, cross_check=False, strict=False, progress=None),
        validated=validated,
        nominal=assess(validated, outcome.settings),
    )


def _spread(examined: Examined, progress: Progress | None = None) -> Spread | None:
    """Return the spread of the points, None where none is computed."""
    computed = examined.nominal.computed
    return spread_of(computed, examined.settings, replace(examined.options, progress=progress)) if computed else None


def _words(found: Outcome) -> pl.Series:
    """Return what is found at the cells of each row in words, null where there is nothing but information."""
    table = found.validated.table if found.validated else None
    if table is None:
        raise LookupError("points without rows")
    told: dict[int, list[str]] = {row: [] for row in table.frame["row"]}
    for one in found.findings:
        if one.sheet == table.sheet and one.level != "info" and one.row in told:
            told[one.row].append(f"{one.code} {_message(one)}")
    texts = [" ".join(told[row]) or other for row, other in zip(told, found.results["findings"], strict=True)]
    return pl.Series(texts, dtype=pl.String)


def _message(found: Finding) -> str:
    """Return the message without the address, which is that of no cell of the submission."""
    words = found.message.removeprefix(found.place).lstrip(": ")
    return f"{words[:1].upper()}{words[1:]}"
