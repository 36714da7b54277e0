"""Findings → one card a rule and sheet, worst first: how many, where, what is required, the first cells drawn."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence

from flexlash.analysis.run_summary import FindingGroup, by_rule
from flexlash.report.page.grids import Sheets
from flexlash.report.page.shape import Card, FindingFacts
from flexlash.schema.finding_explanations import explanation_of
from flexlash.schema.findings import CATALOGUE, Finding, shown

__all__ = ["cards_of", "finding_facts"]

_LISTED = 20
"""Most findings of a rule that are told one by one."""


def cards_of(
    findings: Sequence[Finding], sheets: Sheets, groups: Iterable[FindingGroup] | None = None
) -> Iterator[Card]:
    """Yield the cards of findings; `groups` are all of them by rule where these are but the first."""
    by_group: dict[tuple[str, str], list[Finding]] = defaultdict(list)
    for found in findings:
        by_group[found.code, found.sheet].append(found)
    for group in by_rule(findings) if groups is None else groups:
        yield _card(group, by_group.get((group.code, group.sheet)) or list(group.first), sheets)


def _card(group: FindingGroup, findings: Sequence[Finding], sheets: Sheets) -> Card:
    """Return the card of a rule in a sheet, with the first of its findings."""
    first, listed = findings[0], findings[:_LISTED]
    fixes = {found.fix for found in findings}
    suggestions = {found.suggestion for found in findings}
    is_one = len(fixes) == 1 and len(findings) == group.count
    return Card(
        code=group.code,
        level=group.level,
        title=CATALOGUE[group.code].title,
        sheet=shown(group.sheet),
        count=group.count,
        cells=group.cells,
        places=f"{shown(group.sheet)}!{group.ranges}" if group.cells else shown(group.sheet),
        message=first.message,
        fix=first.fix if is_one else explanation_of(group.code, {}).fix,
        suggestion=first.suggestion if len(suggestions) == 1 else "",
        grid=sheets.grid(findings),
        findings=[finding_facts(found) for found in listed],
        more=group.count - len(listed),
    )


def finding_facts(found: Finding) -> FindingFacts:
    """Return a finding as a page tells it."""
    return FindingFacts(
        place=shown(found.place),
        variant=shown(found.variant),
        value=found.value,
        message=found.message,
        fix=found.fix,
        suggestion=found.suggestion,
    )
