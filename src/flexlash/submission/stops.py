"""Which errors elsewhere stop a row that has none itself: those of its material, its class, its headers, or of all."""

from __future__ import annotations

import re
from collections import defaultdict

from flexlash.findings import Finding
from flexlash.submission.spellings import plain
from flexlash.submission.validate import Validated

__all__ = ["stopped_by"]

_ROW = re.compile(r"\d+$")


def _row(found: Finding) -> int:
    """Return the row of a finding's cell, 0 where it has none."""
    match = _ROW.search(found.cell)
    return int(match[0]) if match else 0


def stopped_by(validated: Validated) -> dict[int, list[Finding]]:
    """Return the errors at other places that stop each row of Variants, by its row number."""
    table, ledger = validated.table, validated.ledger
    if table is None:
        return {}
    by_place: dict[tuple[str, int], list[Finding]] = defaultdict(list)
    for found in ledger.findings:
        if found.level == "error":
            by_place[found.sheet, _row(found)].append(found)
    headers = by_place[table.sheet, table.heading.row]
    named = {place for places in ledger.sources.values() for place in places}
    own = {(table.sheet, row) for row in table.frame["row"]}
    of_rows = named | own
    general = [found for place, group in by_place.items() if place not in of_rows for found in group]
    stops: dict[int, list[Finding]] = {}
    for row, material, tolerance_class in table.frame.select("row", "material", "tolerance_class").iter_rows():
        owners = (("material", plain(material or "")), ("class", plain(tolerance_class or "standard")))
        errors = [one for owner in owners for place in ledger.sources.get(owner, ()) for one in by_place[place]]
        errors += general if ledger.everything else [one for one in headers if (row, one.column) in table.faulty]
        stops[row] = list(dict.fromkeys(errors))
    return stops
