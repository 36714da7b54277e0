"""Correlations: from the typed table to records, and what is wrong with single rows of it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

from flexlash.schema.columns import DIMENSIONS, columns_of
from flexlash.schema.spellings import plain
from flexlash.schema.variant import CorrelationRow, ToleranceRow
from flexlash.validation.ledger import Ledger
from flexlash.validation.meant_names import MeantNames
from flexlash.validation.validated import Table

__all__ = ["correlation_rows_of"]

_COLUMNS = columns_of("Correlations")
_PAIR = ("dimension_1", "dimension_2")
_NEEDED = ("tolerance_class", *_PAIR, "correlation")
_ORDER = {name: place for place, name in enumerate(DIMENSIONS)}


_FAULTS = 10
"""Faulty rows of a class that are told as those of each class based on it."""


def correlation_rows_of(
    table: Table, classes: Mapping[str, Sequence[ToleranceRow]], ledger: Ledger, tolerances: Table | None = None
) -> tuple[CorrelationRow, ...]:
    """Return the sound rows of a sheet, each pair in the order of `DIMENSIONS`.

    Faulty ones spoil their class and those based on it, which would take them over. `classes` are those of Tolerances
    by plain name, `tolerances` is their sheet.
    """
    known = {key: rows[0].tolerance_class if rows else key for key, rows in classes.items()}
    meant = MeantNames(list(known.values()), table.frame["tolerance_class"].drop_nulls().n_unique())
    doubled = _report_twice(table, ledger)
    # Of a class with faulty rows of Tolerances it cannot be told which dimensions it leaves exact.
    whole = {key: _scattering(rows) for key, rows in classes.items() if key not in ledger.classes}
    found = []
    spoilt: dict[str, list[int]] = defaultdict(list)
    for record in table.frame.iter_rows(named=True):
        row, name = record["row"], record["tolerance_class"]
        if name is None or (row, "tolerance_class") in table.faulty:
            ledger.everything = True
            continue
        owner, likely = _owner(table, ledger, record, known, meant)
        if owner is None:
            if likely:
                spoilt[likely].append(row)
            continue
        faulty = row in doubled or any((row, key) in table.faulty or record[key] is None for key in _NEEDED)
        if _reports_pair(table, ledger, record, whole.get(owner, set(DIMENSIONS))) or faulty:
            spoilt[owner].append(row)
            continue
        first, second = sorted((record[key] for key in _PAIR), key=_ORDER.__getitem__)
        found.append(
            CorrelationRow(
                row=row, tolerance_class=known[owner], first=first, second=second, correlation=record["correlation"]
            )
        )
    for key, rows in [*spoilt.items(), *_following(spoilt, tolerances)]:
        for row in rows:
            ledger.spoil("class", key, table.sheet, row)
    return tuple(found)


def _following(spoilt: Mapping[str, Sequence[int]], tolerances: Table | None) -> Iterator[tuple[str, Sequence[int]]]:
    """Yield once each class that is based on a spoilt one, by way of others too, with the rows of one that spoil it."""
    if tolerances is None or not spoilt:
        return
    followers: dict[str, list[str]] = defaultdict(list)
    for name, base in tolerances.frame.select("tolerance_class", "based_on").drop_nulls().iter_rows():
        followers[plain(base)].append(plain(name))
    seen = set(spoilt)
    for key, rows in spoilt.items():
        pending = [*followers[key]]
        while pending:
            one = pending.pop()
            if one not in seen:
                seen.add(one)
                pending += followers[one]
                yield one, rows[:_FAULTS]


def _owner(
    table: Table, ledger: Ledger, record: Mapping[str, Any], known: Mapping[str, str], meant: MeantNames
) -> tuple[str | None, str]:
    """Return the plain name of the class of a row; of one that there is not, None and what it may mean, else ""."""
    row, name, column = record["row"], record["tolerance_class"], _COLUMNS["tolerance_class"]
    key = plain(name)
    if key in known:
        if name != known[key]:
            facts = {"suggestion": known[key], "certain_value": known[key]}
            ledger.add_in(table, "I504", row, column.key, value=name, **facts)
        return key, ""
    facts = meant.unknown("E309", column, name)
    ledger.add_in(table, row=row, key=column.key, value=name, **facts)
    likely = plain(facts.get("suggestion") or "")
    return None, likely if likely in known else ""


def _report_twice(table: Table, ledger: Ledger) -> set[int]:
    """Report every row whose class and pair, in either order, another row has too; return the rows."""
    groups: dict[tuple[str, frozenset[str]], list[int]] = defaultdict(list)
    for row, name, *pair in table.frame.select("row", "tolerance_class", *_PAIR).iter_rows():
        if name is not None and None not in pair and pair[0] != pair[1]:
            groups[plain(name), frozenset(pair)].append(row)
    doubled = {row: others for rows in groups.values() for row, others in table.partners(rows, _PAIR[1])}
    for row, others in doubled.items():
        ledger.add_in(table, "E345", row, _PAIR[1], value=table.entered(row, _PAIR[1]), other=others)
    return set(doubled)


def _scattering(rows: Sequence[ToleranceRow]) -> set[str]:
    return {row.dimension for row in rows if row.scatters}


def _reports_pair(table: Table, ledger: Ledger, record: Mapping[str, Any], scattering: Collection[str]) -> bool:
    """Report a dimension that is tied to itself, or that its class leaves exact; return whether there is one."""
    row, pair = record["row"], [record[key] for key in _PAIR]
    if pair[0] == pair[1] and pair[0] in DIMENSIONS:
        ledger.add_in(table, "E346", row, _PAIR[1], value=table.entered(row, _PAIR[1]))
        return True
    exact = [key for key, name in zip(_PAIR, pair, strict=True) if name in DIMENSIONS and name not in scattering]
    for key in exact:
        ledger.add_in(table, "E347", row, key, value=table.entered(row, key), other=record["tolerance_class"])
    return bool(exact)
