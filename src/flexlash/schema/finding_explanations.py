"""What every finding means, in the words that `flexlash explain` prints and docs/findings.md shows."""

from __future__ import annotations

import string
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from flexlash.schema import tables
from flexlash.schema.finding_catalogue import CATALOGUE, Rule

__all__ = ["EXAMPLES", "Explanation", "explanation_of", "findings_page", "real_examples"]

EXAMPLES = "finding_examples"
"""Table of real messages by code, made from submissions that have every finding."""

_FAMILIES = {
    "E1": "The file as a whole",
    "E2": "One cell by itself",
    "E3": "Cells that contradict one another",
    "W4": "Engineering warnings",
    "I5": "What was repaired or assumed",
}
_WORDS = {
    "place": "Sheet!Cell",
    "file": "File",
    "name": "Column",
    "label": "the header of the template",
    "unit": "the template's unit",
    "dimension": "the dimension",
    "requirement": "what the column holds",
    "setting": "SETTING",
    "choices": "the entries of the cell's drop-down list",
    "kind": "date or time",
    "contradicted": "another cell",
}
_ANY = "…"


@dataclass(frozen=True, kw_only=True)
class Explanation:
    """A rule in general: `pattern` is its message without a cell at hand, `example` a real one."""

    code: str
    level: str
    title: str
    pattern: str
    meaning: str
    fix: str
    example: str

    def lines(self) -> Iterator[str]:
        """Yield the explanation as the terminal shows it."""
        yield f"{self.code} {self.level}: {self.title}"
        yield ""
        yield self.pattern
        yield self.meaning
        yield ""
        yield f"Fix: {self.fix}"
        if self.example:
            yield f"Example: {self.example}"


def real_examples() -> dict[str, str]:
    """Return the real messages by code."""
    return {row["code"]: row["message"] for row in tables.rows(EXAMPLES)}


def explanation_of(code: str, examples: Mapping[str, str] | None = None) -> Explanation:
    """Return what a code means, with its example; raise KeyError for an unknown code."""
    rule: Rule = CATALOGUE[code]
    return Explanation(
        code=code,
        level=rule.level,
        title=rule.title,
        pattern=_generally(rule.message),
        meaning=rule.explanation,
        fix=_generally(rule.fix),
        example=(real_examples() if examples is None else examples).get(code, ""),
    )


def _generally(text: str) -> str:
    """Return a message or fix without a cell at hand.

    >>> _generally("{place} {name} = {value}: less than {other:g} mm is required.")
    'Sheet!Cell Column = …: less than … mm is required.'
    """
    return "".join(
        literal + ("" if field is None else _WORDS.get(field, _ANY))
        for literal, field, _, _ in string.Formatter().parse(text)
    )


def findings_page(examples: Mapping[str, str]) -> str:
    """Return the document that explains every finding."""
    parts = [
        "# Findings\n\nEvery finding has a code. Errors (E) keep a row from being computed, warnings (W) flag it, "
        "infos (I) say\nwhat was repaired or assumed. `flexlash explain CODE` prints the same text as this page.\n"
    ]
    for family, title in _FAMILIES.items():
        parts.append(f"## {title}\n")
        parts += [_section(explanation_of(code, examples)) for code in CATALOGUE if code.startswith(family)]
    return "\n".join(parts)


def _section(explanation: Explanation) -> str:
    """Return the section of a finding."""
    parts = (
        f"### {explanation.code} {explanation.title}",
        f"`{explanation.pattern}`",
        explanation.meaning,
        f"Fix: {explanation.fix}",
        f"Example: `{explanation.example}`\n" if explanation.example else "",
    )
    return "\n\n".join(filter(None, parts)).rstrip() + "\n"
