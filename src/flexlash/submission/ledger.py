"""Where findings are gathered while a submission is validated, with what each of them spoils."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from flexlash.findings import Finding, finding

__all__ = ["Ledger"]

_LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"


class Ledger:
    """Findings so far, and what is not to be computed because of them.

    `rows` are rows of Variants; `materials` and `classes` names whose rows are faulty; `everything` is set
    when a fault leaves no row computable.
    """

    def __init__(self, file: str) -> None:
        self.file = file
        self.findings: list[Finding] = []
        self.rows: set[int] = set()
        self.materials: set[str] = set()
        self.classes: set[str] = set()
        self.everything = False

    def add(self, code: str, *, rows: Iterable[int] = (), **facts: Any) -> None:
        """Record a finding; an error spoils the given rows of Variants."""
        found = finding(code, file=self.file, **facts)
        self.findings.append(found)
        if found.level == "error":
            self.rows.update(rows)

    def name_variants(self, sheet: str, names: Mapping[int, str]) -> None:
        """Put the variant's name into the findings at cells of its row."""
        self.findings = [
            replace(found, variant=names.get(int(found.cell.lstrip(_LETTERS)), ""))
            if found.sheet == sheet and found.cell and not found.variant
            else found
            for found in self.findings
        ]
