"""Where a stage gathers its findings while it works, with what each of them spoils; it returns them as records."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from typing import Any, Literal

from flexlash.schema.cell_addresses import CellAddress
from flexlash.schema.columns import columns_of
from flexlash.schema.findings import Finding, finding
from flexlash.schema.variant import Variant
from flexlash.validation.validated import Blocked, Owner, Table, UnitMistake, Validated

__all__ = ["Ledger"]


class Ledger:
    """Findings so far, and what is not to be computed because of them; `told` are their codes, sheets and cells.

    `rows` are rows of Variants; `materials` and `classes` names whose rows are faulty, `sources` the sheets and rows
    in which they are; `everything` is set when a fault leaves no row computable; `apart` are sheets whose faults stop
    none. `unit_mistakes` are the cells whose unit is mistaken, by sheet, row and column: an error there gets the value
    that was meant, and no other warning is recorded there.
    """

    def __init__(self, file: str) -> None:
        self.file = file
        self.findings: list[Finding] = []
        self.told: set[tuple[str, str, str]] = set()
        self.rows: set[int] = set()
        self.materials: set[str] = set()
        self.classes: set[str] = set()
        self.sources: dict[Owner, list[tuple[str, int]]] = defaultdict(list)
        self.everything = False
        self.apart: frozenset[str] = frozenset()
        self.unit_mistakes: dict[tuple[str, int, str], UnitMistake] = {}
        self.table: Table | None = None

    @classmethod
    def after(cls, validated: Validated | None) -> Ledger:
        """Return one without findings that knows what validation found not to be computable."""
        if validated is None:
            raise LookupError("a submission that was not validated")
        ledger, blocked = cls(validated.file), validated.blocked
        ledger.rows, ledger.materials, ledger.classes = set(blocked.rows), set(blocked.materials), set(blocked.classes)
        ledger.sources.update({owner: [*places] for owner, places in blocked.sources.items()})
        ledger.everything, ledger.apart = blocked.everything, blocked.apart
        ledger.unit_mistakes, ledger.table = dict(validated.unit_mistakes), validated.table
        return ledger

    @property
    def blocked(self) -> Blocked:
        """What is not to be computed so far."""
        return Blocked(
            rows=frozenset(self.rows),
            materials=frozenset(self.materials),
            classes=frozenset(self.classes),
            sources={owner: tuple(places) for owner, places in self.sources.items()},
            everything=self.everything,
            apart=self.apart,
        )

    def has_errors(self, since: int = 0) -> bool:
        """Return whether an error is among the findings, but for so many first ones."""
        return any(found.level == "error" for found in self.findings[since:])

    def add(self, code: str, *, rows: Iterable[int] = (), **facts: Any) -> None:
        """Record a finding; an error spoils the given rows of Variants."""
        if mistake := self._unit_mistake_at(facts):
            if code[0] == "W" and code != "W420":
                return
            facts = {**facts, "suggestion": facts.get("suggestion") or mistake.suggestion}
        found = finding(code, **{"file": self.file, **facts})
        self.findings.append(found)
        self.told.add((found.code, found.sheet, found.cell))
        if found.level == "error":
            self.rows.update(rows)

    def add_in(self, table: Table, code: str, row: int, key: str, **facts: Any) -> None:
        """Record a finding at a cell of a row of Materials, Tolerances or another entry sheet than Variants."""
        name = columns_of(table.schema)[key].name
        self.add(code, sheet=table.sheet, cell=table.address(row, key), column=key, name=name, **facts)

    def add_at(self, code: str, variant: Variant, key: str, **facts: Any) -> None:
        """Record a finding at a cell of a variant that validation has returned."""
        if self.table is None:
            raise LookupError("a variant without its table")
        cell = self.table.address(variant.row, key)
        rows = [variant.row]
        self.add(code, sheet=self.table.sheet, cell=cell, column=key, variant=variant.name, rows=rows, **facts)

    def spoil(self, kind: Literal["material", "class"], name: str, sheet: str, row: int) -> None:
        """Record a row that makes a material or a class, by its plain name, unusable."""
        (self.materials if kind == "material" else self.classes).add(name)
        self.sources[kind, name].append((sheet, row))

    def hold(self, kind: Literal["material", "class"], name: str, sheet: str, row: int, variant: int) -> None:
        """Record a row because of which one variant of a material or a class, by its plain name, is not computed."""
        self.rows.add(variant)
        if (sheet, row) not in self.sources[kind, name]:
            self.sources[kind, name].append((sheet, row))

    def _unit_mistake_at(self, facts: Mapping[str, Any]) -> UnitMistake | None:
        """Return the mistake of the cell that a finding is about."""
        address: CellAddress | None = facts.get("cell")
        return address and self.unit_mistakes.get((facts["sheet"], address.row, facts.get("column", "")))
