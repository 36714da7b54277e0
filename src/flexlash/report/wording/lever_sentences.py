"""The table of levers → sentences: the cheapest change of failing variants, what may be relaxed, what length may be."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

import polars as pl

from flexlash.analysis.run_summary import grouped, listed
from flexlash.decisions.found_widths import ALL
from flexlash.report.wording.lever_words import (
    FROM_MATERIAL,
    Lever,
    change_words,
    lever_name,
    shown_levers,
    shown_unit,
    shown_value,
    within_words,
)
from flexlash.report.wording.summary_facts import NAMED, Row, SummaryFacts
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.findings import shown, spelled_out

__all__ = [
    "CHANGE",
    "LENGTH",
    "LEVER_TOPICS",
    "RELAX",
    "cheapest",
    "cheapest_lines",
    "lengths",
    "relaxing",
    "what_to_change",
]

CHANGE, RELAX, LENGTH = "What to change", "What may be relaxed", "Length allowed"
LEVER_TOPICS = (CHANGE, RELAX, LENGTH)
"""Topics of the sentences that lead to the sheet Levers: the three questions of who decides."""

_TOLD, _CHANGED = 2, 3
"""Most variants of which a topic tells, and most whose change is told: the sheet has all."""

_IDLE = 0.01
"""Share of the variance below which a tolerance does nothing for the spread."""

_MOST = 0.5
"""Share of the variance from which on the material's is told."""

_SEEN = 0.05
"""Per cent of mass or stress below which a change is not told."""

_MEGAPASCAL = 1e6
_NAME = 200


def what_to_change(facts: SummaryFacts, most: int = _CHANGED) -> Iterator[str]:
    """Yield the cheapest single change of the worst variants that miss their limit, or why there is none."""
    names = _names(facts.levers, "meet")
    stuck, told = [], False
    for name in names[:most]:
        lever = cheapest(facts.levers, name)
        if lever is None:
            stuck.append(name)
        else:
            start = "For" if told else "Cheapest single change for"
            told = True
            yield f"{start} {_cheapest(facts, lever)}"
    for name in stuck:
        yield _stuck(facts, name)
    hopeless = [name for name in names[:most] if _no_tolerance_can(facts, name)]
    if hopeless:
        whose = "its units" if len(hopeless) == 1 else "their units"
        whom = facts.names(hopeless) if hopeless != names[:most] else "it" if len(hopeless) == 1 else "them"
        yield (
            f"Tighter tolerances cannot bring {whom} within, not even all of them at once: half of "
            f"{whose} or more are over the limit."
        )
    if (more := len(names) - most) > 0:
        yield f"{grouped(more)} more on Levers."


def cheapest(levers: pl.DataFrame, variant: str) -> Lever | None:
    """Return the cheapest single change that brings a variant within its limit; None where there is none."""
    first = levers.filter((pl.col("variant") == variant) & (pl.col("rank") == 1)).head(1)
    return first.row(0, named=True) if first.height else None


def cheapest_lines(levers: pl.DataFrame, hats: Collection[str] = ()) -> Iterator[str]:
    """Yield for the screen the cheapest change of the first variants that miss their limit.

    `levers` as computed; `hats` names the variants that are hats.
    """
    ordered = shown_levers(levers, hats)
    names = _names(ordered, "meet")
    for name in names[:NAMED]:
        lever = cheapest(ordered, name)
        what = "none, see sheet Levers" if lever is None else change_words(lever)
        yield f"  Cheapest single change for {shown(name, longest=_NAME)}: {what}."
    if (more := len(names) - NAMED) > 0:
        yield f"  Those of {grouped(more)} more are on sheet Levers."


def relaxing(facts: SummaryFacts) -> Iterator[str]:
    """Yield how far tolerances of the variant nearest to its limit may be relaxed: that which matters most, and all."""
    wider = _possible(facts.levers, "tolerance").filter(pl.col("drawing_value") > pl.col("from_value"))
    if wider.is_empty():
        return
    name = wider["variant"][0]
    row = _row(facts, name)
    spread = facts.computed(row).spread
    shares = spread.shares if spread else {}
    own = wider.filter(pl.col("variant") == name).to_dicts()
    single = [lever for lever in own if lever["dimension"] != ALL]
    if single:
        lever = max(single, key=lambda lever: shares.get(lever["dimension"], 0.0))
        yield _relaxed(facts, row, lever, shares)
    for lever in (lever for lever in own if lever["dimension"] == ALL):
        wide = _told(lever, "drawing_value")
        whose = "its" if single else f"the tolerances of {facts.named(name)}"
        count = len(lever["moves"].split("+"))
        yield f"All {count} of {whose}{' tolerances' if single else ''} together may be {wide} times as wide."


def lengths(facts: SummaryFacts) -> Iterator[str]:
    """Yield how long the variants nearest to their limit may still be."""
    longer = _possible(facts.levers, "nominal").filter(
        (pl.col("dimension") == "cylinder_length") & (pl.col("drawing_value") > pl.col("from_value"))
    )
    parts = [
        f"from {_told(lever, 'from_value')} to {_told(lever, 'drawing_value')}{shown_unit(lever)} in "
        f"{facts.named(lever['variant'])}"
        for lever in longer.head(_TOLD).iter_rows(named=True)
    ]
    if parts:
        yield f"Cylinder length may grow {listed(parts, _TOLD, longer.height)}."


def _cheapest(facts: SummaryFacts, lever: Lever) -> str:
    """Return the cheapest change with what it brings and what it does besides."""
    row = _row(facts, lever["variant"])
    effects = [
        f"{within_words(lever['probability_over_limit_after'])} of units are then within {_limit(facts, row)}",
        *_effects(facts, row, lever),
    ]
    note = f" Note: {lever['range_note']}." if lever["range_note"] else ""
    return f"{facts.named(lever['variant'])}: {_changed(facts, row, lever)}; {', '.join(effects)}.{note}"


def _changed(facts: SummaryFacts, row: Row, lever: Lever) -> str:
    """Return a change in words, with the material that there is now."""
    return change_words({**lever, FROM_MATERIAL: facts.computed(row).variant.material})


def _effects(facts: SummaryFacts, row: Row, lever: Lever) -> Iterator[str]:
    """Yield what else a change does: to the greatest stress, to the mass, to bending by the wave generator."""
    verb = ""
    for what, amount, change in _changes(facts, row, lever):
        falls = "falls" if change < 0 else "rises"
        yield f"{what} {amount}" if falls == verb else f"{what} {falls} {amount}"
        verb = falls


def _changes(facts: SummaryFacts, row: Row, lever: Lever) -> Iterator[tuple[str, str, float]]:
    """Yield what changes beside the backlash, from what to what or by how much, and by how much in per cent."""
    nominal, after = facts.computed(row).nominal, lever["von_mises_MPa_after"]
    before = nominal.von_mises / _MEGAPASCAL
    if after is not None and abs(change := 100 * (after / before - 1)) >= _SEEN:
        # What changes a section for the better does no other one harm: one that is still the greatest is the same.
        sections = {"wall": nominal.wall_von_mises, "tooth rim": nominal.rim_von_mises, "disk": nominal.hub_von_mises}
        others = [stress or 0.0 for section, stress in sections.items() if section != nominal.governing_section]
        where = nominal.governing_section if after > max(others) / _MEGAPASCAL else "greatest"
        yield f"the {where} stress", f"from {_stress(before)} to {_stress(after)} MPa", change
    for key, what in (("mass_change_percent", "the mass"), ("bending_stress_change_percent", "the bending stress")):
        change = lever[key]
        if change is not None and abs(change) >= _SEEN:
            yield what, f"by {abs(change):.1f} %", change


def _stress(stress: float) -> str:
    """Return a stress [MPa] in whole numbers, or in two digits where it is small.

    >>> _stress(86.174), _stress(133.2), _stress(4.321)
    ('86', '133', '4.3')
    """
    return spelled_out(stress, max(2, len(f"{stress:.0f}")))


def _stuck(facts: SummaryFacts, variant: str) -> str:
    """Return that no single change brings a variant within its limit, and why."""
    row = _row(facts, variant)
    own = facts.levers.filter(pl.col("variant") == variant)
    outside = own.filter((pl.col("possible") == "yes") & (pl.col("what") != "material")).head(1)
    start = f"No single change can bring {facts.named(variant)} within {_limit(facts, row)}"
    if outside.height:
        lever = outside.row(0, named=True)
        return f"{start} and stay in range: {change_words(lever)} would, but {lever['range_note']}."
    reasons = own.filter(pl.col("what") == "nominal")["reason"].drop_nulls().unique(maintain_order=True).to_list()
    median = facts.angles.words(row["p50_arcmin"], row["p50_standard_error_arcmin"])
    why = f": {reasons[0]}" if len(reasons) == 1 else f", half of its units being over {median}; Levers says why"
    return f"{start}{why}."


def _no_tolerance_can(facts: SummaryFacts, variant: str) -> bool:
    """Whether a variant is over its limit in the middle of its tolerances, and no single one brings it within."""
    own = facts.levers.filter((pl.col("variant") == variant) & (pl.col("what") == "tolerance"))
    row = _row(facts, variant)
    return row["p50_arcmin"] > row["backlash_limit_arcmin"] and not (own["possible"] == "yes").any()


def _relaxed(facts: SummaryFacts, row: Row, lever: Lever, shares: Mapping[str, float]) -> str:
    """Return how far a tolerance may be relaxed, and whether it buys anything as it is."""
    name, unit = facts.named(lever["variant"]), shown_unit(lever)
    now, then = f"± {_told(lever, 'from_value')}{unit}", f"± {_told(lever, 'drawing_value')}{unit}"
    kept = f"{facts.outcome.settings.target_percent:.10g} % within {_limit(facts, row)}"
    of_material = sum(share for cause, share in shares.items() if DIMENSIONS[cause].sheet == "Materials")
    why = f"; {min(100 * of_material, 100):.1f} % of the spread comes from the material" if of_material >= _MOST else ""
    what = lever_name(lever)
    if shares.get(lever["dimension"], 0.0) < _IDLE:
        return f"Holding the {what} of {name} so tight buys nothing: {then} instead of {now} still keeps {kept}{why}."
    return f"The {what} of {name} may be {then} instead of {now}: that still keeps {kept}{why}."


def _names(levers: pl.DataFrame, direction: str) -> list[str]:
    """Return the variants that have levers of a direction, in their order."""
    return levers.filter(pl.col("direction") == direction)["variant"].unique(maintain_order=True).to_list()


def _possible(levers: pl.DataFrame, what: str) -> pl.DataFrame:
    """Return the rows of variants that meet their limit which may be relaxed within range."""
    return levers.filter(
        (pl.col("direction") == "relax")
        & (pl.col("what") == what)
        & (pl.col("possible") == "yes")
        & (pl.col("in_range").fill_null("yes") == "yes")
    )


def _row(facts: SummaryFacts, variant: str) -> Row:
    """Return the Results row of a variant."""
    return facts.ranked.row(by_predicate=pl.col("variant") == variant, named=True)


def _limit(facts: SummaryFacts, row: Row) -> str:
    return facts.angles.entered(row["backlash_limit_arcmin"])


def _told(lever: Lever, key: str) -> str:
    return f"{shown_value(lever, key):.10g}"
