"""Which errors elsewhere stop a row that has none itself: those of its material, its class, its headers, or of all.

And the other way round: which rows wait for an error.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from flexlash.schema.findings import Finding, shown
from flexlash.schema.spellings import plain
from flexlash.validation.validated import Blocked, Owner, Table

__all__ = ["Waiting", "stopped_by", "waiting_rows", "with_waiting_rows"]


def stopped_by(table: Table, blocked: Blocked, findings: Iterable[Finding]) -> dict[int, list[Finding]]:
    """Return the errors at other places that stop each row of Variants, by its row number."""
    by_place: dict[tuple[str, int], list[Finding]] = defaultdict(list)
    for found in findings:
        if found.level == "error":
            by_place[found.sheet, found.row].append(found)
    headers = by_place[table.sheet, table.heading.row]
    named = {place for places in blocked.sources.values() for place in places}
    own = {(table.sheet, row) for row in table.frame["row"]}
    of_rows = named | own
    general = [found for place, group in by_place.items() if place not in of_rows for found in group]
    stops: dict[int, list[Finding]] = {}
    for row, material, tolerance_class in table.frame.select("row", "material", "tolerance_class").iter_rows():
        owners: tuple[Owner, ...] = (
            ("material", plain(material or "")),
            ("class", plain(tolerance_class or "standard")),
        )
        errors = [one for owner in owners for place in blocked.sources.get(owner, ()) for one in by_place[place]]
        errors += general if blocked.everything else [one for one in headers if (row, one.column) in table.faulty]
        stops[row] = list(dict.fromkeys(errors))
    return stops


@dataclass(frozen=True, kw_only=True)
class Waiting:
    """Rows of Variants that wait for a faulty material or class; `places` are the sheets and rows of its faults."""

    kind: str
    name: str
    rows: Sequence[int]
    places: Sequence[tuple[str, int]]


def waiting_rows(table: Table, blocked: Blocked) -> list[Waiting]:
    """Return which rows of Variants wait for which faulty material or class, in the order of the rows."""
    sources = blocked.sources
    if not sources:
        return []
    rows: dict[Owner, list[int]] = defaultdict(list)
    names: dict[Owner, str] = {}
    for row, material, tolerance_class in table.frame.select("row", "material", "tolerance_class").iter_rows():
        owned: tuple[Owner, ...] = (("material", material or ""), ("class", tolerance_class or "standard"))
        for kind, name in owned:
            owner: Owner = (kind, plain(name))
            if owner in sources:
                rows[owner].append(row)
                names.setdefault(owner, name)
    return [Waiting(kind=one[0], name=names[one], rows=rows[one], places=sources[one]) for one in rows]


def with_waiting_rows(findings: Sequence[Finding], table: Table, blocked: Blocked) -> list[Finding]:
    """Return findings of which errors in a material or class, or that stop everything, say which rows wait."""
    sheet = shown(table.sheet)
    sentences: dict[tuple[str, int], str] = {}
    for one in waiting_rows(table, blocked):
        wait = f"{_rows_words(one.rows)} of {sheet} wait{'s' if len(one.rows) == 1 else ''}"
        sentences |= dict.fromkeys(one.places, f" {wait} for {one.kind} {shown(one.name)}.")
    every = f" All rows of {sheet} wait for it." if blocked.everything and not table.frame.is_empty() else ""
    return [
        replace(found, message=found.message + sentences.get((found.sheet, found.row), every))
        if found.level == "error" and found.cell and found.sheet != table.sheet
        else found
        for found in findings
    ]


def _rows_words(rows: Sequence[int], most: int = 5) -> str:
    """Return rows with runs drawn together.

    >>> _rows_words([2, 3, 4, 7]), _rows_words([2])
    ('Rows 2 to 4, 7', 'Row 2')
    """
    spans: list[list[int]] = []
    for row in rows:
        if spans and row == spans[-1][1] + 1:
            spans[-1][1] = row
        else:
            spans.append([row, row])
    words = [f"{first}" if first == last else f"{first} to {last}" for first, last in spans[:most]]
    more = f" and {len(spans) - most} more" if len(spans) > most else ""
    return f"Row{'' if len(rows) == 1 else 's'} {', '.join(words)}{more}"
