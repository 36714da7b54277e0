"""Errors in a material or tolerance class that no variant uses: they stop no row, and so are warnings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from flexlash.findings import Finding, finding
from flexlash.submission.ledger import Ledger
from flexlash.submission.spellings import plain
from flexlash.submission.tabulate import Table

__all__ = ["excuse_unused"]


def excuse_unused(variants: Table, tables: Mapping[str, Table], ledger: Ledger) -> None:
    """Make warnings of the errors in rows of Materials and Tolerances that nothing depends on."""
    used = {("material", plain(name)) for name in variants.frame["material"].drop_nulls().unique()}
    used |= {("class", plain(name)) for name in variants.frame["tolerance_class"].fill_null("standard").unique()}
    kinds = {
        place: kind for (kind, name), places in ledger.sources.items() if (kind, name) not in used for place in places
    }
    if (materials := tables.get("Materials")) is not None:
        nameless = materials.frame.filter(materials.frame["material"].is_null())["row"]
        kinds |= {(materials.sheet, row): "material" for row in nameless}
    ledger.findings = [_excused(found, kinds) if found.level == "error" else found for found in ledger.findings]


def _excused(found: Finding, kinds: Mapping[tuple[str, int], str]) -> Finding:
    """Return the warning that an error in an unused row is, or the error itself."""
    digits = found.cell.lstrip("ABCDEFGHIJKLMNOPQRSTUVWXYZ")
    kind = kinds.get((found.sheet, int(digits))) if digits else None
    if kind is None:
        return found
    detail = found.message.removeprefix(found.place).lstrip(": ").removesuffix(".")
    warning = finding("W437", sheet=found.sheet, cell=found.cell, column=found.column, detail=detail, other=kind)
    return replace(warning, value=found.value, fix=found.fix, suggestion=found.suggestion, repair=found.repair)
