"""Classes of Tolerances that are based on another: they take over every row that they do not have themselves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import Any

from flexlash.schema.columns import columns_of
from flexlash.schema.spellings import plain
from flexlash.schema.variant import ToleranceRow
from flexlash.validation.ledger import Ledger
from flexlash.validation.meant_names import MeantNames
from flexlash.validation.validated import Table

__all__ = ["ClassBases", "class_names"]

_KEY = "based_on"
_COLUMNS = columns_of("Tolerances")
_STANDARD = "standard"

_FAULTS = 10
"""Faults of a base that are told as those of each class based on it."""

_NAMED = 5
"""Classes of a circle that are named."""


def class_names(table: Table) -> dict[str, str]:
    """Return the classes of a sheet as first written, by plain name."""
    names: dict[str, str] = {}
    for name in table.frame["tolerance_class"].drop_nulls().unique(maintain_order=True):
        names.setdefault(plain(name), name)
    return names


@dataclass(frozen=True)
class ClassBases:
    """The rows of a sheet that say what a class is based on: row and name of the base by the class's plain name."""

    table: Table
    ledger: Ledger
    rows: dict[str, list[tuple[int, str]]] = field(default_factory=dict)

    def take(self, record: Mapping[str, Any]) -> bool:
        """Take a row that names a base, or should; return whether it is one. Cells with a fault are None in it."""
        row, base = record["row"], record[_KEY]
        if base is None and (row, _KEY) not in self.table.faulty:
            return False
        key, before = plain(record["tolerance_class"]), len(self.ledger.findings)
        if record["dimension"] is not None or (row, "dimension") in self.table.faulty:
            if base is not None:
                words = "a class is based on another in a row of its own, whose dimension is blank"
                self.ledger.add_in(self.table, "E338", row, _KEY, value=base, detail=words)
        else:
            for other in (key for key in _COLUMNS if key not in {"tolerance_class", "dimension", _KEY}):
                if record[other] is not None:
                    words = "a row that names the class another is based on holds nothing else"
                    self.ledger.add_in(self.table, "E338", row, other, value=record[other], detail=words)
        is_faulty = any((row, one) in self.table.faulty for one in _COLUMNS)
        if base is None or is_faulty or len(self.ledger.findings) > before:
            self.ledger.spoil("class", key, self.table.sheet, row)
        else:
            self.rows.setdefault(key, []).append((row, base))
        return True

    def resolved(
        self, own: Mapping[str, Sequence[ToleranceRow]], names: Mapping[str, str], standard: Sequence[ToleranceRow]
    ) -> dict[str, list[ToleranceRow]]:
        """Return all classes with what they take over; `names` are those of the classes, `standard` the built-in one.

        What is wrong with a base is told, and spoils the classes that are based on it.
        """
        classes = {key: list(rows) for key, rows in own.items()}
        if not self.rows:
            return classes
        bases = self._bases(names)
        known = {_STANDARD: list(standard)} | classes
        for key in self._base_first(bases, names):
            base = bases[key]
            self._take_over_faults(key, base)
            held = {row.dimension for row in classes[key]}
            classes[key] += [row for row in known.get(base, ()) if row.dimension not in held]
            known[key] = classes[key]
        return classes

    def _bases(self, names: Mapping[str, str]) -> dict[str, str]:
        """Return the plain name of the base of each class that has one which is there."""
        known = {_STANDARD: _STANDARD} | dict(names)
        meant = MeantNames(list(known.values()), len({base for rows in self.rows.values() for _, base in rows}))
        bases = {}
        for key, rows in self.rows.items():
            self._report_several(key, rows)
            row, base = rows[0]
            if (spelling := plain(base)) not in known:
                facts = meant.unknown("E224", _COLUMNS[_KEY], base)
                self.ledger.add_in(self.table, row=row, key=_KEY, value=base, **facts)
                self.ledger.spoil("class", key, self.table.sheet, row)
                continue
            if base != known[spelling]:
                name = known[spelling]
                self.ledger.add_in(self.table, "I504", row, _KEY, value=base, suggestion=name, certain_value=name)
            bases[key] = spelling
        return bases

    def _report_several(self, key: str, rows: Sequence[tuple[int, str]]) -> None:
        """Tell each row of a class that says anew what it is based on of the others."""
        entered = dict(rows)
        for row, others in self.table.partners([row for row, _ in rows], _KEY):
            words = f"the class is based on another in {others} already"
            self.ledger.add_in(self.table, "E338", row, _KEY, value=entered[row], detail=words)
            self.ledger.spoil("class", key, self.table.sheet, row)

    def _base_first(self, bases: Mapping[str, str], names: Mapping[str, str]) -> Iterator[str]:
        """Yield the classes that have a base, each after its base; tell those that lead back to themselves."""
        done: set[str] = set()
        for start in bases:
            path: dict[str, None] = {}
            key = start
            while key in bases and key not in done and key not in path:
                path[key] = None
                key = bases[key]
            chain = list(path)
            circle = chain[chain.index(key) :] if key in path else []
            self._report_circle(circle, names)
            done.update(circle)
            yield from (one for one in reversed(chain) if one not in done)
            done.update(chain)

    def _report_circle(self, circle: Sequence[str], names: Mapping[str, str]) -> None:
        """Tell every class of a circle where it leads back to itself."""
        for place, key in enumerate(circle):
            row, base = self.rows[key][0]
            others = [names[one] for one in [*circle[place + 1 :], *circle[:place]][:_NAMED]]
            by_way = f" by way of {', '.join(others)}" if others else ""
            words = f"class {names[key]} is based on itself{by_way}"
            self.ledger.add_in(self.table, "E338", row, _KEY, value=base, detail=words)
            self.ledger.spoil("class", key, self.table.sheet, row)

    def _take_over_faults(self, key: str, base: str) -> None:
        """Make a class unusable whose base is, by the same faults."""
        if base in self.ledger.classes:
            for sheet, row in [*islice(self.ledger.sources["class", base], _FAULTS)]:
                self.ledger.spoil("class", key, sheet, row)
