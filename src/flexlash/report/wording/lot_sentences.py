"""Results rows → sentences on lots and parts: how far either scatter, how many lots fail, what a verdict is about."""

from __future__ import annotations

from collections.abc import Iterator

from flexlash.analysis.run_summary import listed
from flexlash.report.wording.summary_facts import NAMED, Row, SummaryFacts, first_rows
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.lot_words import (
    is_settled,
    lots_words,
    of_all_units,
    reach_words,
    scatters_between_lots,
    scatters_within_lots,
)

__all__ = ["LOTS", "lots_and_parts", "lots_of"]

LOTS = "Lots and parts"
"""The topic of these sentences."""

_SHARED = 6
"""Most dimensions that are named as one value for a whole lot."""

_ABOUT_LOTS = "Verdicts and shares are about all units of many lots, not about one lot."
_ABOUT_PARTS = "Verdicts and shares hold for every lot."


def lots_and_parts(facts: SummaryFacts) -> Iterator[str]:
    """Yield the same of the worst variants as `lots_of` of one, and what all verdicts are about."""
    named = first_rows(facts.failing) or first_rows(facts.judged, 1) or first_rows(facts.ranked, 1)
    scattering = [row for row in named if row["sd_arcmin"]]
    if not scattering:
        return
    worst, *others = scattering
    words = " ".join(_scatter(facts, worst))
    yield _sentence(words) if facts.extent.total == 1 else f"{facts.named(worst['variant'])}: {words}"
    failing = [row for row in others if scatters_between_lots(row) and row["lots_failing"] is not None]
    if failing:
        told = [f"{lots_words(row, 'of', 'of')} {facts.named(row['variant'])}" for row in failing]
        yield f"More than {_acceptable(facts)} over the limit: {listed(told, NAMED)}."
    yield from _shared(facts, worst)
    if facts.judged.height:
        lots = (facts.judged["between_lots_sd_arcmin"].fill_null(0.0) > 0).any()
        yield _ABOUT_LOTS if lots else _ABOUT_PARTS


def lots_of(facts: SummaryFacts, row: Row) -> Iterator[str]:
    """Yield of one variant how far parts of a lot and lots scatter, how many lots fail, what its verdict is about."""
    if not row["sd_arcmin"]:
        return
    yield _sentence(" ".join(_scatter(facts, row)))
    yield from _shared(facts, row)
    if row["backlash_limit_arcmin"] is not None and scatters_between_lots(row):
        yield "The verdict is about all units of many lots, not about one lot."


def _scatter(facts: SummaryFacts, row: Row) -> Iterator[str]:
    """Yield how far the parts of a lot and the lots scatter, and how many lots fail."""
    within, between = (
        reach_words(row[f"{name}_arcmin"], facts.angles) for name in ("within_lot_sd", "between_lots_sd")
    )
    ppm = _acceptable(facts)
    has_limit = row["lots_failing"] is not None
    if not scatters_between_lots(row):
        yield f"nothing scatters between lots: in every lot 95 % of parts lie within {within}."
        if has_limit:
            yield _alike(row, ppm)
        return
    whole = scatters_within_lots(row)
    parts = f"within one lot 95 % of parts lie within {within}" if whole else "all parts of a lot are identical"
    failing = ""
    if has_limit and whole:
        failing = f"; {lots_words(row, 'has', 'have')} more than {ppm} over the limit ({of_all_units(row)})"
    elif has_limit:
        failing = f"; {lots_words(row, 'lies', 'lie')} over the limit with every part"
    yield f"{parts}; lots differ by {between}{failing}."


def _sentence(words: str) -> str:
    """Return words with a capital."""
    return f"{words[0].upper()}{words[1:]}"


def _acceptable(facts: SummaryFacts) -> str:
    """Return the share of units over the limit from which a lot fails."""
    return f"{facts.outcome.settings.acceptable_ppm:.10g} ppm"


def _alike(row: Row, ppm: str) -> str:
    """Return whether lots fail that are all alike."""
    if not is_settled(row):
        return f"Whether more than {ppm} of them are over the limit is not settled."
    return f"{'More' if row['lots_failing'] else 'No more'} than {ppm} of them are over the limit."


def _shared(facts: SummaryFacts, row: Row) -> Iterator[str]:
    """Yield which dimensions are one value for a whole lot, and that a calibration is one for all lots."""
    shared = [name for name in DIMENSIONS if name in facts.computed(row).between]
    calibrations = [name for name in shared if DIMENSIONS[name].sheet == "Settings"]
    of_lots = [dimension_words(name) for name in shared if name not in calibrations]
    if of_lots:
        yield f"One value for a whole lot: {listed(of_lots, _SHARED)}."
    if calibrations:
        yield "A calibration is one unknown value for all lots; it counts with what differs between lots."
