"""Levers of tolerances → how far each tolerance may be relaxed, or must be tightened, by variant and dimension."""

from __future__ import annotations

from collections.abc import Mapping

import polars as pl

from flexlash.analysis.computed import Computed
from flexlash.analysis.options import Options
from flexlash.decisions.found_widths import ALL
from flexlash.decisions.levers import present_of, terms_of
from flexlash.decisions.tolerance_levers import tolerance_levers
from flexlash.schema.decision_rows import LeverRow
from flexlash.schema.variant import Settings

__all__ = ["width_table", "width_table_of"]

_NAMES = {"variant": pl.String(), "dimension": pl.String()}
_COLUMNS = pl.Schema(_NAMES | {"relax_to": pl.Float64(), "tighten_to": pl.Float64()})


def width_table(levers: pl.DataFrame) -> pl.DataFrame:
    """Return half the widths [unit of the dimension] to which single tolerances may go, from the Levers table.

    `relax_to` of variants that keep their target, else `tighten_to`; null where there is none.
    """
    alone = levers.filter((pl.col("what") == "tolerance") & (pl.col("dimension") != ALL))
    by_direction = (
        pl.when(pl.col("direction") == direction).then(pl.col("drawing_value")).alias(name)
        for direction, name in (("relax", "relax_to"), ("meet", "tighten_to"))
    )
    return alone.select("variant", "dimension", *by_direction).cast(_COLUMNS)


def width_table_of(
    computed: Mapping[int, Computed], settings: Settings, levers: Mapping[str, LeverRow], options: Options
) -> pl.DataFrame:
    """Return the same where nothing else is asked of the variants: no other lever is looked for."""
    presents = [present for one in computed.values() if (present := present_of(one)) is not None]
    if not presents:
        return pl.DataFrame(schema=_COLUMNS)
    terms = terms_of(next(iter(computed.values())), settings, levers, options)
    rows = [
        {
            "variant": lever.variant.name,
            "dimension": lever.dimension,
            "what": lever.what,
            "direction": lever.direction,
            "drawing_value": lever.drawing_value,
        }
        for _, lever, _ in tolerance_levers(presents, terms)
    ]
    types = _NAMES | {"what": pl.String(), "direction": pl.String(), "drawing_value": pl.Float64()}
    return width_table(pl.DataFrame(rows, schema=types, orient="row"))
