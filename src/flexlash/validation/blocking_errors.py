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

__all__ = ["Waiting", "stopped_by", "waiting_rows", "with_waiting", "with_waiting_rows", "without_waiting"]


def stopped_by(table: Table, blocked: Blocked, findings: Iterable[Finding]) -> dict[int, list[Finding]]:
    """Return the errors elsewhere that stop each row of Variants, by its row number."""
    by_row: dict[tuple[str, int], list[Finding]] = defaultdict(list)
    for finding in findings:
        if finding.level == "error":
            by_row[finding.sheet, finding.row].append(finding)
    headers = by_row[table.sheet, table.heading.row]
    named = {source for sources in blocked.sources.values() for source in sources}
    own = {(table.sheet, row) for row in table.frame["row"]}
    of_rows = named | own
    general = [
        finding
        for source, group in by_row.items()
        if source not in of_rows and source[0] not in blocked.apart
        for finding in group
    ]
    stops: dict[int, list[Finding]] = {}
    for row, material, tolerance_class in table.frame.select("row", "material", "tolerance_class").iter_rows():
        owners: tuple[Owner, ...] = (
            ("material", plain(material or "")),
            ("class", plain(tolerance_class or "standard")),
        )
        errors = [error for owner in owners for source in blocked.sources.get(owner, ()) for error in by_row[source]]
        errors += general if blocked.everything else [error for error in headers if (row, error.column) in table.faulty]
        stops[row] = list(dict.fromkeys(errors))
    return stops


@dataclass(frozen=True, kw_only=True)
class Waiting:
    """Rows of Variants that wait for a faulty material or class; `sources` are the sheets and rows of its faults."""

    kind: str
    name: str
    rows: Sequence[int]
    sources: Sequence[tuple[str, int]]


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
            spoilt = blocked.materials if kind == "material" else blocked.classes
            if owner in sources and (row in blocked.rows or owner[1] in spoilt):
                rows[owner].append(row)
                names.setdefault(owner, name)
    return [
        Waiting(kind=owner[0], name=names[owner], rows=waiting, sources=sources[owner])
        for owner, waiting in rows.items()
    ]


def with_waiting_rows(findings: Sequence[Finding], table: Table, blocked: Blocked) -> list[Finding]:
    """Return findings of which errors in a material or class, or that stop everything, say which rows wait."""
    all_wait = blocked.everything and table.has_entries
    return with_waiting(findings, table.sheet, waiting_rows(table, blocked), all_wait=all_wait)


def with_waiting(
    findings: Iterable[Finding], sheet: str, waiting: Iterable[Waiting], *, all_wait: bool
) -> list[Finding]:
    """Return findings of which errors in other sheets say which rows of Variants, the sheet of this name, wait.

    `all_wait` says that every row waits for those errors for which none waits by its material or class.
    """
    sentences = _sentences(sheet, waiting)
    every = _every(sheet) if all_wait else ""
    return [
        replace(found, message=found.message + sentences.get((found.sheet, found.row), every))
        if _is_told_of_waiting(found, sheet)
        else found
        for found in findings
    ]


def without_waiting(findings: Iterable[Finding], sheet: str, waiting: Iterable[Waiting]) -> list[Finding]:
    """Return findings without what `with_waiting` added to them."""
    sentences, every = _sentences(sheet, waiting), _every(sheet)
    return [
        replace(found, message=found.message.removesuffix(sentences.get((found.sheet, found.row), every)))
        if _is_told_of_waiting(found, sheet)
        else found
        for found in findings
    ]


def _is_told_of_waiting(finding: Finding, sheet: str) -> bool:
    """Whether a finding says which rows of Variants, the sheet of this name, wait for it."""
    return finding.level == "error" and bool(finding.cell) and finding.sheet != sheet


def _every(sheet: str) -> str:
    return f" All rows of {shown(sheet)} wait for it."


def _sentences(sheet: str, waiting: Iterable[Waiting]) -> dict[tuple[str, int], str]:
    """Return which rows wait for a material or class, for the errors in it, by the sheet and row of these."""
    sentences: dict[tuple[str, int], str] = defaultdict(str)
    for one in waiting:
        wait = f"{_rows_words(one.rows)} of {shown(sheet)} wait{'s' if len(one.rows) == 1 else ''}"
        for source in dict.fromkeys(one.sources):
            sentences[source] += f" {wait} for {one.kind} {shown(one.name)}."
    return sentences


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
