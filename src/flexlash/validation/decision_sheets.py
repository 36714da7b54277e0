"""Other sources, Levers and Sweep: which drive a part is for, what of it may change, what is varied."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from flexlash.validation.ledger import Ledger
from flexlash.validation.lever_rows import ALL_LEVERS, Levers, lever_rows_of, withheld_levers
from flexlash.validation.other_source_rows import SourceRows, other_sources_of, report_unused_limits
from flexlash.validation.sweep_rows import Sweeps, sweep_rows_of
from flexlash.validation.validated import Table

__all__ = ["DECISION_SHEETS", "Decided", "decided_by"]

DECISION_SHEETS = ("Other sources", "Levers", "Sweep")


@dataclass(frozen=True, kw_only=True)
class Decided:
    """What was read of the three sheets; empty where there are none."""

    sources: SourceRows = field(default_factory=SourceRows)
    levers: Levers = field(default_factory=Levers)
    sweeps: Sweeps = field(default_factory=Sweeps)


def decided_by(
    tables: Mapping[str, Table], unclear: Collection[str], ledger: Ledger, own: Mapping[str, Ledger]
) -> Decided:
    """Return what the sheets say; `ledger` is that of Variants, `own` those of the sheets themselves.

    Nothing is taken from a sheet without a header row, or of a kind that several sheets may be (`unclear`): what would
    hang on it is withheld, and the variants are computed all the same.
    """
    variants = tables.get("Variants")
    unread = {schema for schema in own if schema not in tables and (own[schema].everything or schema in unclear)}
    return Decided(
        sources=_sources(tables, unread, ledger, own["Other sources"]),
        levers=(
            lever_rows_of(tables["Levers"], variants, own["Levers"])
            if "Levers" in tables
            else (Levers(rows=withheld_levers(ALL_LEVERS), withheld=ALL_LEVERS) if "Levers" in unread else Levers())
        ),
        sweeps=(
            sweep_rows_of(tables["Sweep"], variants, ledger.rows, own["Sweep"])
            if "Sweep" in tables and variants is not None
            else Sweeps()
        ),
    )


def _sources(tables: Mapping[str, Table], unread: Collection[str], ledger: Ledger, own: Ledger) -> SourceRows:
    """Return the sources of the drive; limits of a system without any are warned of."""
    table, variants = tables.get("Other sources"), tables.get("Variants")
    found = SourceRows(are_faulty="Other sources" in unread) if table is None else other_sources_of(table, own)
    if variants is not None and not found.rows and not found.are_faulty:
        report_unused_limits(variants, ledger)
    return found
