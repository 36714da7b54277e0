"""A row of Levers → words: what changes, from what to what, which share of units is then within the limit."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any, TypeAlias

import polars as pl

from flexlash.analysis.outcome import Outcome
from flexlash.decisions.found_widths import ALL
from flexlash.schema.decision_columns import MATERIAL
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.findings import shown, spelled_out
from flexlash.schema.number_words import LEAST_SHARE, places

__all__ = [
    "ALONE",
    "FROM_MATERIAL",
    "Lever",
    "change_words",
    "followers_words",
    "hats_of",
    "lever_name",
    "sentence_start",
    "shown_levers",
    "shown_unit",
    "shown_value",
    "within_words",
]

Lever: TypeAlias = Mapping[str, Any]
"""A row of the table of levers, by key, as `shown_levers` gives it."""

ALONE = "alone"
"""The column that `shown_levers` adds: the dimension is shared, and here it changes without the others."""

OF_HAT = "of_hat"
"""The other one: the variant is a hat, whose disk has no hub at its inner edge."""

FROM_MATERIAL = "from_material"
"""What a row may have beside its columns: the present material."""

_EXACT = 4
"""Digits in which an exact solution is told."""

_DIGITS = 10
"""Digits of a drawing value: those of a number that somebody typed, not the last of a double."""

_FINE = 1000.0
"""Micrometres in a millimetre: tolerances of less are told in them."""

_LEAST_PLACES = 2
"""Decimals of per cent in which a share within the limit is told, where its remainder does not ask for more."""

_NAME = 60
"""Most characters of a material's name."""

_HUB = {"disk_inner_radius": "hub radius"}
"""What a drawing calls the inner edge of a cup's disk."""


def hats_of(outcome: Outcome) -> frozenset[str]:
    """Return the names of the computed variants that are hats."""
    variants = (one.variant for one in outcome.computed.values())
    return frozenset(one.name for one in variants if one.flexspline_type == "hat")


def shown_levers(levers: pl.DataFrame, hats: Collection[str] = ()) -> pl.DataFrame:
    """Return the table of levers in the order in which it is read, variants in their order; `hats` names the hats.

    Variants that miss their limit come first; of each the changes by rank, then those that are out of range, then those
    that cannot do it; of one that meets it what saves most.
    """
    shared = {
        (variant, what, name)
        for variant, what, dimension, moves in levers.select("variant", "what", "dimension", "moves").iter_rows()
        if moves and dimension != ALL
        for name in (dimension, *moves.split("+"))
    }
    keys = levers.select("variant", "what", "dimension").iter_rows()
    alone = pl.Series(ALONE, [key in shared for key in keys], dtype=pl.Boolean)
    variants = {name: place for place, name in enumerate(levers["variant"].unique(maintain_order=True))}
    return (
        levers.with_columns(
            alone & (pl.col("moves").fill_null("") == ""),
            pl.col("variant").is_in([*hats]).alias(OF_HAT),
            pl.col("variant").replace_strict(variants, return_dtype=pl.Int64).alias("_place"),
        )
        .sort(
            pl.col("direction") != "meet",
            "_place",
            pl.col("possible") != "yes",
            pl.col("in_range") == "no",
            "rank",
            "relative_cost",
            nulls_last=True,
            maintain_order=True,
        )
        .drop("_place")
    )


def lever_name(lever: Lever) -> str:
    """Return what changes: `hub radius`, `wall and disk thickness`, `disk thickness alone`, `all 4 tolerances`.

    >>> lever_name({"dimension": "wall_thickness", "moves": "disk_thickness"})
    'wall and disk thickness'
    >>> lever_name({"dimension": "mean_radius", "moves": "disk_outer_radius"})
    'mean radius'
    >>> [lever_name({"dimension": "disk_inner_radius", "moves": None, "of_hat": hat}) for hat in (False, True)]
    ['hub radius', 'disk inner radius']
    """
    dimension = lever["dimension"]
    if dimension == MATERIAL:
        return MATERIAL
    if dimension == ALL:
        return f"all {len(lever['moves'].split('+'))} tolerances"
    own = (None if lever.get(OF_HAT) else _HUB.get(dimension)) or dimension_words(dimension)
    followers = [dimension_words(name) for name in (lever["moves"] or "").split("+") if name]
    kind = own.rpartition(" ")[2]
    if lever["dimension"] == "wall_thickness" and followers and all(name.endswith(kind) for name in followers):
        return " and ".join([own.removesuffix(f" {kind}"), *followers])
    return f"{own} alone" if lever.get(ALONE) else own


def change_words(lever: Lever) -> str:
    """Return a change in words: what changes, from what to what; of a change that cannot do it, what it is now.

    >>> cup = {"dimension": "disk_inner_radius", "moves": None, "what": "nominal", "direction": "meet", "unit": "mm"}
    >>> change_words({**cup, "from_value": 40.0, "drawing_value": 46.0})
    'hub radius 40 → 46 mm'
    >>> wall = {**cup, "dimension": "wall_thickness", "what": "tolerance", "direction": "relax"}
    >>> change_words({**wall, "from_value": 0.0025, "drawing_value": 0.029})
    'wall thickness ± 2.5 µm, may go to ± 29 µm'
    """
    name, unit = lever_name(lever), shown_unit(lever)
    if lever["what"] == "material":
        known = filter(None, (lever.get(FROM_MATERIAL), lever["to_material"]))
        return f"{name} {' → '.join(shown(one, longest=_NAME) for one in known)}"
    now, then = (_value(shown_value(lever, key)) for key in ("from_value", "drawing_value"))
    if lever["dimension"] == ALL:
        return f"{name}{', may be' if then and lever['direction'] == 'relax' else ''}{then and f' × {then}'}"
    sign = "± " if lever["what"] == "tolerance" else ""
    if not then:
        return f"{name} {sign}{now}{unit}"
    if lever["drawing_value"] == lever["from_value"]:
        return f"{name} {sign}{now}{unit}, may go no further"
    if lever["direction"] == "relax":
        return f"{name} {sign}{now}{unit}, may go to {sign}{then}{unit}"
    return f"{name} {sign}{now} → {sign}{then}{unit}"


def followers_words(lever: Lever) -> str:
    """Return which dimensions follow a change without being named in it: `, disk outer radius with it`.

    >>> change = {"what": "nominal", "from_value": 80.0, "drawing_value": 87.0}
    >>> followers_words({"dimension": "mean_radius", "moves": "disk_outer_radius", **change})
    ', disk outer radius with it'
    >>> followers_words({"dimension": "wall_thickness", "moves": "disk_thickness", **change})
    ''
    """
    name = lever_name(lever)
    if lever["what"] != "nominal" or lever["drawing_value"] in {None, lever["from_value"]}:
        return ""
    followers = [dimension_words(one) for one in (lever["moves"] or "").split("+") if one]
    apart = [follower for follower in followers if not name.endswith(follower)]
    return f", {' and '.join(apart)} with it" if apart else ""


def shown_value(lever: Lever, key: str) -> float | None:
    """Return a value of a row in the unit in which it is told; an exact solution in four digits."""
    value = lever[key]
    if value is None:
        return None
    told = value * (_FINE if _is_fine(lever) else 1.0)
    return float(spelled_out(told, _EXACT if key == "to_value" else _DIGITS))


def shown_unit(lever: Lever) -> str:
    """Return the unit behind a value of a row as it is told, tolerances of lengths in µm; empty for a plain number."""
    unit = "µm" if _is_fine(lever) else lever["unit"]
    return "" if unit in {None, "", "-"} else f" {unit}"


def sentence_start(text: str) -> str:
    """Return a text with a capital at its start.

    >>> sentence_start("hub radius 40 → 46 mm")
    'Hub radius 40 → 46 mm'
    """
    return text[:1].upper() + text[1:]


def within_words(over: float) -> str:
    """Return which share of units is within a limit that so many are over, down to the first digit of the remainder.

    >>> within_words(320e-6), within_words(1052e-6), within_words(3.2e-6), within_words(0.0)
    ('99.97 %', '99.89 %', '99.9997 %', 'practically all')
    """
    if over < LEAST_SHARE:
        return "practically all"
    return f"{100 * (1 - over):.{max(_LEAST_PLACES, places(100 * over))}f} %"


def _is_fine(lever: Lever) -> bool:
    greatest = max(lever["from_value"] or 0.0, lever["drawing_value"] or 0.0)
    return lever["what"] == "tolerance" and lever["unit"] == "mm" and greatest < 1.0


def _value(value: float | None) -> str:
    return "" if value is None else f"{value:.10g}"
