"""What the pages around a submission show: handing in, history, what fails most, explanations, errors."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from flexlash.schema.columns import ENTRY_SHEETS, columns_of
from flexlash.schema.finding_catalogue import CATALOGUE
from flexlash.schema.finding_explanations import Explanation, explanation_of
from flexlash.service.records import STATES, StoredSubmission
from flexlash.service.web.words import DOORS, Moment, StateLine, counted, state_line

__all__ = [
    "PER_PAGE",
    "HandInView",
    "HistoryView",
    "Line",
    "RulesView",
    "codes_by_level",
    "explained",
    "hand_in_view",
    "history_view",
    "rules_view",
]

PER_PAGE = 50
"""Submissions on a page of the history."""

_STATES = {"": "any state", "waiting": "waiting", "working": "at work", "done": "computed", "rejected": "rejected"}


@dataclass(frozen=True, kw_only=True)
class Line:
    """A submission in a list."""

    id: str
    name: str
    sender: str
    door: str
    when: Moment
    state: StateLine

    @classmethod
    def of(cls, submission: StoredSubmission, now: float) -> Line:
        """Return the line of a submission as it is now."""
        return cls(
            id=submission.id,
            name=submission.name,
            sender=submission.sender,
            door=DOORS[submission.door],
            when=Moment.of(submission.received_at, now),
            state=state_line(submission, now),
        )


@dataclass(frozen=True, kw_only=True)
class HandInView:
    """What was handed in lately, and in words how much waits."""

    lines: Sequence[Line]
    waiting: str


def hand_in_view(lately: Iterable[StoredSubmission], now: float, *, waiting: int = 0) -> HandInView:
    """Return what the first page shows beside its form."""
    return HandInView(
        lines=[Line.of(one, now) for one in lately], waiting=counted(waiting, "submission") if waiting else ""
    )


@dataclass(frozen=True, kw_only=True)
class HistoryView:
    """A page of the history, what it was asked for, and the number before which the next page begins."""

    lines: Sequence[Line]
    text: str
    state: str
    states: Mapping[str, str]
    totals: str
    older: int | None
    is_first: bool


def history_view(
    found: Sequence[StoredSubmission], now: float, *, text: str = "", state: str = "", before: int | None = None,
    totals: Mapping[str, int],
) -> HistoryView:  # fmt: skip
    """Return a page of the history; `found` has one more than a page holds where there are older ones."""
    shown = found[:PER_PAGE]
    return HistoryView(
        lines=[Line.of(one, now) for one in shown],
        text=text,
        state=state if state in STATES else "",
        states=_STATES,
        totals=", ".join(f"{totals[one]} {_STATES[one]}" for one in STATES if totals.get(one)),
        older=shown[-1].number if len(found) > PER_PAGE else None,
        is_first=before is None,
    )


@dataclass(frozen=True, kw_only=True)
class RuleLine:
    """A rule as it is broken in a column, over all submissions."""

    code: str
    level: str
    title: str
    sheet: str
    column: str
    cells: int
    submissions: int


@dataclass(frozen=True, kw_only=True)
class RulesView:
    """Which rules are broken most, and where."""

    lines: Sequence[RuleLine]


def rules_view(rows: Iterable[Mapping[str, Any]]) -> RulesView:
    """Return what fails most, from the rows of the store; a code that is no longer known is left out."""
    lines = [
        RuleLine(
            code=row["code"],
            level=CATALOGUE[row["code"]].level,
            title=CATALOGUE[row["code"]].title,
            sheet=row["sheet"],
            column=_label(row["sheet"], row["column"]),
            cells=row["cells"],
            submissions=row["submissions"],
        )
        for row in rows
        if row["code"] in CATALOGUE
    ]
    return RulesView(lines=lines)


def _label(sheet: str, key: str) -> str:
    """Return what a column is called in the template; one that is not of it keeps its own name."""
    known = columns_of(sheet).get(key) if sheet in ENTRY_SHEETS else None
    return known.label if known else key


def explained(code: str) -> Explanation | None:
    """Return what a finding means, by its code in any case; None for a code that there is not."""
    return explanation_of(code.upper()) if code.upper() in CATALOGUE else None


def codes_by_level() -> Mapping[str, Sequence[Explanation]]:
    """Return every finding by its level, worst first."""
    levels: dict[str, list[Explanation]] = {"error": [], "warning": [], "info": []}
    for code, rule in CATALOGUE.items():
        levels[rule.level].append(explanation_of(code, {}))
    return levels
