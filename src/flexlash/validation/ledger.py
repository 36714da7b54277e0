"""Where findings are gathered while a submission is validated, with what each of them spoils."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

from flexlash.schema.cell_addresses import CellAddress
from flexlash.schema.findings import Finding, finding

__all__ = ["Ledger", "UnitMistake"]

_UNKNOWN = frozenset({"E209", "E210", "E211", "E307", "E309"})
"""Codes of names that are unknown however they are spelt."""


@dataclass(frozen=True, kw_only=True)
class UnitMistake:
    """A cell whose unit is mistaken, with what to say of it: `suggestion` is what was probably meant.

    `material` is the plain name of the material whose row it stands in, empty for a cell of Variants.
    """

    sheet: str
    schema: str
    cell: CellAddress
    column: str
    variant: str
    material: str
    row: int
    shown: str
    entered: Any
    times: str
    beside: str
    suggestion: str


class Ledger:
    """Findings so far, and what is not to be computed because of them.

    `rows` are rows of Variants; `materials` and `classes` names whose rows are faulty, `sources` the sheets and rows
    in which they are; `everything` is set when a fault leaves no row computable. `unit_mistakes` are the cells whose
    unit is mistaken, by sheet, row and column: an error there gets the value that was meant, and no other warning is
    recorded there.
    """

    def __init__(self, file: str) -> None:
        self.file = file
        self.findings: list[Finding] = []
        self.rows: set[int] = set()
        self.materials: set[str] = set()
        self.classes: set[str] = set()
        self.sources: dict[tuple[str, str], list[tuple[str, int]]] = defaultdict(list)
        self.everything = False
        self.unit_mistakes: dict[tuple[str, int, str], UnitMistake] = {}

    def add(self, code: str, *, rows: Iterable[int] = (), **facts: Any) -> None:
        """Record a finding; an error spoils the given rows of Variants."""
        if mistake := self._unit_mistake_at(facts):
            if code[0] == "W" and code != "W420":
                return
            facts = {**facts, "suggestion": facts.get("suggestion") or mistake.suggestion}
        found = finding(code, **{"file": self.file, **facts})
        self.findings.append(found)
        if found.level == "error":
            self.rows.update(rows)

    def spoil(self, kind: Literal["material", "class"], name: str, sheet: str, row: int) -> None:
        """Record a row that makes a material or a class, by its plain name, unusable."""
        (self.materials if kind == "material" else self.classes).add(name)
        self.sources[kind, name].append((sheet, row))

    def settle(self) -> None:
        """Leave one finding per cell and cause: a spelling is not repaired twice, nor where the name is unknown."""
        unknown = {(found.sheet, found.cell) for found in self.findings if found.code in _UNKNOWN}
        first: dict[tuple[str, str], str] = {}
        last: dict[tuple[str, str], int] = {}
        for place, found in enumerate(self.findings):
            if found.code == "I504":
                first.setdefault((found.sheet, found.cell), found.value)
                last[found.sheet, found.cell] = place
        self.findings = [
            self._respelt(found, first[found.sheet, found.cell]) if found.code == "I504" else found
            for place, found in enumerate(self.findings)
            if found.code != "I504"
            or (place == last[found.sheet, found.cell] and (found.sheet, found.cell) not in unknown)
        ]

    @staticmethod
    def _respelt(found: Finding, value: str) -> Finding:
        """Return a repaired spelling with the value as it was entered."""
        message = found.message.replace(f'"{found.value}"', f'"{value}"', 1)
        return replace(found, value=value, message=message)

    def _unit_mistake_at(self, facts: Mapping[str, Any]) -> UnitMistake | None:
        """Return the mistake of the cell that a finding is about."""
        address: CellAddress | None = facts.get("cell")
        return address and self.unit_mistakes.get((facts["sheet"], address.row, facts.get("column", "")))

    def unit_mistakes_by_owner(self) -> dict[int | str, list[UnitMistake]]:
        """Return the mistakes by row of Variants, or by plain name of the material."""
        found: dict[int | str, list[UnitMistake]] = defaultdict(list)
        for mistake in self.unit_mistakes.values():
            found[mistake.material if mistake.schema == "Materials" else mistake.row].append(mistake)
        return found

    def name_variants(self, sheet: str, names: Mapping[int, str]) -> None:
        """Put the variant's name into the findings at cells of its row."""
        self.findings = [
            replace(found, variant=names.get(found.row, ""))
            if found.sheet == sheet and found.cell and not found.variant
            else found
            for found in self.findings
        ]
