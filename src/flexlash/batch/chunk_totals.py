"""The chunks of a large table, one after another in order → what is counted and told of the whole table."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import chain, islice
from typing import Any

from flexlash.analysis.drive_notes import DriveNotes
from flexlash.analysis.outcome import exit_code_of
from flexlash.analysis.run_summary import (
    SHOWN_MESSAGES,
    FindingGroup,
    SpreadNotes,
    by_rule,
    group_lines,
    lines_of_limits,
    to_fix,
    words_of_fixes,
    words_of_state,
    words_of_waiting,
)
from flexlash.analysis.whole_batch import DRAWN, WholeBatch
from flexlash.batch.answer import Answer, RuleTotal, WorstVariant
from flexlash.batch.chunk import FIRST_CELLS, FIRST_FINDINGS, ChunkSummary, WorstRow
from flexlash.schema.findings import Finding
from flexlash.schema.limit_verdict import VERDICTS, Verdict
from flexlash.schema.spellings import plain
from flexlash.schema.variant import Settings
from flexlash.validation.blocking_errors import Waiting, with_waiting
from flexlash.validation.consolidation import shared_by_excerpts

__all__ = ["Totals"]

_NAMED = 3
"""Worst variants that are named."""

_LEVELS = ("error", "warning", "info")


class Totals:
    """What is counted and told of the chunks that were added so far."""

    def __init__(self) -> None:
        self.rows = self.computed = self.seed = 0
        self.method = ""
        self._settings = Settings()
        self.columns: tuple[str, ...] = ()
        self.worst: list[WorstRow] = []
        self._before: list[Finding] = []
        self._after: list[Finding] = []
        self._own: list[Finding] = []
        self._groups: dict[tuple[int, str, str], FindingGroup] = {}
        self._verdicts, self._unsettled = Counter[Verdict](), Counter[Verdict]()
        self._notes, self._cross_checked = SpreadNotes(), False
        self._drives = DriveNotes()
        self._to_fix = 0
        self._sheet = ""
        self._waiting: dict[tuple[str, str], Waiting] = {}
        self._all_wait = False

    def add(self, chunk: ChunkSummary) -> None:
        """Add the chunk that follows."""
        self.rows += chunk.rows
        self.computed += chunk.computed
        self.seed, self.method = chunk.seed, chunk.method or self.method
        self._settings = Settings(target_percent=chunk.target_percent, angle_unit=chunk.angle_unit)
        self.columns = self.columns or chunk.columns
        self._verdicts.update(chunk.verdicts)
        self._unsettled.update(chunk.unsettled)
        self._notes += chunk.notes
        self._drives += chunk.drives
        self._cross_checked |= chunk.cross_checked
        self.worst = sorted((*self.worst, *chunk.worst), key=lambda one: one.order)[:DRAWN]
        # Findings of the whole file come with every chunk.
        self._before = shared_by_excerpts(self._before, chunk.before)
        self._after = shared_by_excerpts(self._after, chunk.after)
        self._own += chunk.own[: FIRST_FINDINGS - len(self._own)]
        self._to_fix += chunk.to_fix
        self._sheet = chunk.sheet or self._sheet
        self._all_wait |= chunk.all_wait
        for waiting in chunk.waiting:
            owner = (waiting.kind, plain(waiting.name))
            known = self._waiting.get(owner)
            rows = [*known.rows, *waiting.rows] if known else waiting.rows
            self._waiting[owner] = replace(known or waiting, rows=rows)
        for group in chunk.groups:
            self._add_group(group)

    def hold_back(self) -> None:
        """Count no row as computed."""
        self.computed = 0

    def _add_group(self, group: FindingGroup) -> None:
        key = (_LEVELS.index(group.level), group.code, group.sheet)
        known = self._groups.get(key)
        self._groups[key] = group if known is None else _joined(known, group)

    @property
    def before(self) -> list[Finding]:
        """Findings of the whole file that come before those at its rows."""
        return self._told(self._before)

    @property
    def after(self) -> list[Finding]:
        """Findings of the whole file that come after those at its rows."""
        return self._told(self._after)

    def _told(self, findings: Iterable[Finding]) -> list[Finding]:
        """Return findings with what they say of the rows that wait for them."""
        return with_waiting(findings, self._sheet, self._waiting.values(), all_wait=self._all_wait)

    @property
    def findings(self) -> list[Finding]:
        """The first of all findings, in the order of the submission."""
        return list(islice(chain(self.before, self._own, self.after), FIRST_FINDINGS))

    @property
    def rules(self) -> Counter[str]:
        """How many findings there are of each code."""
        rules = Counter(found.code for found in chain(self.before, self.after))
        for group in self._groups.values():
            rules[group.code] += group.count
        return rules

    def whole(self, results_file: str = "", findings_file: str = "") -> WholeBatch:
        """Return the whole table as the report of its worst rows names it, with the names of the files beside it."""
        return WholeBatch(
            rows=self.rows,
            computed=self.computed,
            verdicts={verdict: self._verdicts[verdict] for verdict in VERDICTS},
            unsettled={verdict: self._unsettled[verdict] for verdict in VERDICTS},
            rules=dict(sorted(self.rules.items())),
            results_file=results_file,
            findings_file=findings_file,
        )

    @property
    def counts(self) -> dict[str, int]:
        """What `Outcome.counts` says of a submission that is held as a whole."""
        whole = self.whole()
        levels = whole.levels
        counts = {
            "rows": self.rows,
            "computed": self.computed,
            "errors": levels["error"],
            "warnings": levels["warning"],
        }
        return counts | {str(verdict): number for verdict, number in whole.verdicts.items()}

    def answer(self, told: dict[str, Any], *, ran: bool, fail_over_limit: bool, findings_file: str) -> Answer:
        """Return what came of the whole table; `told` is what is known of the submission itself."""
        counts = self.counts
        groups = self.groups
        listed = f"{findings_file or 'the table beside a marked copy (--annotate)'} lists them all"
        limits = lines_of_limits(counts, self._named(), self._settings)
        details = [*limits, *self._drives.lines(self._settings.angles), *self._note_lines()] if ran else []
        return Answer(
            exit_code=exit_code_of(counts, fail_over_limit=fail_over_limit),
            told={
                **told,
                "seed": self.seed,
                "method": self.method,
                "counts": counts,
                "findings": [found.as_dictionary() for found in self.findings],
                "findings_by_rule": dict(sorted(self.rules.items())),
            },
            finding_lines=tuple(group_lines(groups, listed)),
            words=self.state_words(ran=ran),
            details=tuple(details),
            by_rule=self.rules,
            worst=tuple(map(WorstVariant.of, self._named())),
            rules=tuple(
                RuleTotal(
                    level=group.level,
                    code=group.code,
                    sheet=group.sheet,
                    cells=group.cells or group.count,
                    first=group.first[0].cell,
                )
                for group in groups
            ),
        )

    @property
    def cells_to_fix(self) -> int:
        """At how many cells there are errors."""
        return to_fix(chain(self.before, self.after))[0] + self._to_fix

    def state_words(self, *, ran: bool) -> str:
        """Return how much of the table was computed, or is ready to be, and what is to fix."""
        others = to_fix(chain(self.before, self.after))[1]
        fixes = words_of_fixes(self.cells_to_fix, others)
        return words_of_state(self.counts, fixes, self._waiting_words(), ran=ran)

    @property
    def first_rows(self) -> list[int]:
        """The rows of the first findings of each rule."""
        return sorted({found.row for group in self._groups.values() for found in group.first})

    def _named(self) -> list[dict[str, Any]]:
        return [dict(one.told) for one in self.worst[:_NAMED] if one.told is not None]

    def _note_lines(self) -> Iterator[str]:
        return self._notes.lines(cross_check=self._cross_checked, method=self.method)

    @property
    def groups(self) -> list[FindingGroup]:
        """Return all findings by rule and sheet, worst first."""
        groups = dict(self._groups)
        for group in by_rule(chain(self.before, self.after)):
            key = (_LEVELS.index(group.level), group.code, group.sheet)
            groups[key] = _joined(group, groups[key]) if key in groups else group
        return [group for _, group in sorted(groups.items())]

    def _waiting_words(self) -> Iterator[str]:
        return words_of_waiting(self._waiting.values())


def _joined(group: FindingGroup, later: FindingGroup) -> FindingGroup:
    """Return findings of one rule in one sheet and those that follow as one group."""
    return replace(
        group,
        count=group.count + later.count,
        cells=group.cells + later.cells,
        addresses=(*group.addresses, *later.addresses)[:FIRST_CELLS],
        first=(*group.first, *later.first)[:SHOWN_MESSAGES],
    )
