"""Findings of all stages → one finding a cell and cause, in the order of the submission. Done once, at the end."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.findings import CATALOGUE, Finding
from flexlash.validation.blocking_errors import with_waiting_rows
from flexlash.validation.unit_mistakes import settled
from flexlash.validation.validated import Blocked, Validated

__all__ = ["consolidated", "in_order", "shared_by_excerpts"]

_UNKNOWN = frozenset({"E209", "E210", "E211", "E223", "E224", "E307", "E309"})
"""Codes of names that are unknown however they are spelt."""


_TOLD_BY_FIRST = frozenset({"E324", "E339", "W438", "W442", "W443", "W444", "W454"})
"""Codes of findings elsewhere that the first row which shows them gives their words."""


def consolidated(validated: Validated, later: Iterable[Finding] = (), blocked: Blocked | None = None) -> list[Finding]:
    """Return the findings of validation and later stages, one a cell and cause, as they were made.

    `blocked` is what is not to be computed after the last stage, what validation says where that is left out.
    """
    findings = settled([*validated.findings, *later], validated.unit_mistakes.values(), validated.file)
    findings = _with_variants(_one_spelling(findings), validated)
    if validated.table is None:
        return findings
    return with_waiting_rows(findings, validated.table, blocked or validated.blocked)


def _one_spelling(findings: Sequence[Finding]) -> list[Finding]:
    """Return the findings with each spelling repaired once, from entry to list, and not where the name is unknown."""
    unknown = {(found.sheet, found.cell) for found in findings if found.code in _UNKNOWN}
    first: dict[tuple[str, str], str] = {}
    last: dict[tuple[str, str], int] = {}
    for number, found in enumerate(findings):
        if found.code == "I504":
            first.setdefault((found.sheet, found.cell), found.value)
            last[found.sheet, found.cell] = number
    return [
        _respelt(found, first[found.sheet, found.cell]) if found.code == "I504" else found
        for number, found in enumerate(findings)
        if found.code != "I504"
        or (number == last[found.sheet, found.cell] and (found.sheet, found.cell) not in unknown)
    ]


def _respelt(found: Finding, value: str) -> Finding:
    """Return a repaired spelling with the value as it was entered."""
    message = found.message.replace(f'"{found.value}"', f'"{value}"', 1)
    return replace(found, value=value, message=message)


def _with_variants(findings: Sequence[Finding], validated: Validated) -> list[Finding]:
    """Return the findings with the variant's name in those at cells of its row."""
    sheet, names = validated.table.sheet if validated.table else "", {row: name for row, name, _ in validated.submitted}
    return [
        replace(found, variant=names.get(found.row, ""))
        if found.sheet == sheet and found.cell and not found.variant
        else found
        for found in findings
    ]


def shared_by_excerpts(earlier: Iterable[Finding], later: Iterable[Finding]) -> list[Finding]:
    """Return the findings that are not at rows of excerpts of one table, each once, in the order of the excerpts.

    A backlash that no flexspline has is told, at its material, of the first row that shows it, and so is, at its row of
    Tolerances, a process that cannot be meant; a class that leaves dimensions exact leaves those of any excerpt.
    """
    found: dict[object, Finding] = {}
    for one in (*earlier, *later):
        key = (one.code, one.sheet, one.cell) if one.code in _TOLD_BY_FIRST else one
        known = found.setdefault(key, one)
        if one.code == "W438" and known != one:
            found[key] = _both_exact(known, one)
    return list(found.values())


def _both_exact(known: Finding, other: Finding) -> Finding:
    """Return the warning of a class with the dimensions of two such warnings."""
    before, _, after = CATALOGUE["W438"].message.partition("{detail}")
    start = len(before.format(place=known.place, value=known.value))
    words = {word for one in (known, other) for word in one.message[start : -len(after)].split(", ")}
    ordered = ", ".join(column.plain_name for column in DIMENSIONS.values() if column.plain_name in words)
    return replace(known, message=known.message[:start] + ordered + after)


def in_order(findings: Iterable[Finding], sheets: Iterable[str]) -> tuple[Finding, ...]:
    """Return the findings in the order of the submission, whose `sheets` these are: by row, column and code."""
    return tuple(sorted(findings, key=_cell_order(sheets)))


def _cell_order(sheets: Iterable[str]) -> Callable[[Finding], tuple[int, int, int, str]]:
    numbers = {name: number for number, name in enumerate(sheets)}

    def key(found: Finding) -> tuple[int, int, int, str]:
        row, column = found.address or (0, 0)
        return numbers.get(found.sheet, -1), row, column, found.code

    return key
