"""The outcome in words: plain sentences for the terminal and the report's first page."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flexlash.analysis.drive_notes import DriveNotes
from flexlash.analysis.outcome import Outcome, Written
from flexlash.analysis.whole_batch import worst_rows
from flexlash.analysis.written_files import is_picture, picture_words
from flexlash.schema.cell_addresses import CellAddress, cell_ranges
from flexlash.schema.finding_catalogue import Level
from flexlash.schema.findings import CATALOGUE, Finding, shown
from flexlash.schema.limit_verdict import VERDICTS
from flexlash.schema.lot_words import lots_words, some_lots_fail
from flexlash.schema.number_words import ALL_UNITS, grouped, range_words, rounded, share_words
from flexlash.validation.blocking_errors import Waiting, waiting_rows

if TYPE_CHECKING:
    import polars as pl

    from flexlash.schema.angle_unit import AngleUnit
    from flexlash.schema.variant import Settings

__all__ = [
    "SHOWN_MESSAGES",
    "FindingGroup",
    "SpreadNotes",
    "are",
    "by_rule",
    "closing_lines",
    "counted",
    "detail_lines",
    "finding_lines",
    "group_lines",
    "grouped",
    "limit_lines",
    "lines_of_limits",
    "listed",
    "points_range",
    "points_words",
    "quoted",
    "rounded",
    "share_words",
    "spread_notes",
    "state_words",
    "summary_lines",
    "to_fix",
    "to_fix_words",
    "words_of_fixes",
    "words_of_state",
    "words_of_waiting",
    "worst_first",
]

SHOWN_MESSAGES = 3
"""Findings of a rule that are told one by one."""

_NO_FIX = "Nothing to do"
"""How the fix begins of a finding that needs none."""

_NAME = 30
"""Most characters of a name in a sentence."""
_LEVELS = ("error", "warning", "info")


@dataclass(frozen=True, kw_only=True)
class FindingGroup:
    """Findings of one rule in one sheet: how many, at how many cells, the addresses of these and the first of them.

    Where there are very many cells the first addresses may stand for all.
    """

    level: Level
    code: str
    sheet: str
    count: int
    cells: int
    addresses: tuple[CellAddress, ...]
    first: tuple[Finding, ...]

    @property
    def ranges(self) -> str:
        """The cells, with runs in a column drawn together, as many as a line may hold."""
        ranges = cell_ranges(self.addresses)
        return f"{ranges.partition(' and ')[0]} and more" if len(self.addresses) < self.cells else ranges


def by_rule(findings: Iterable[Finding]) -> list[FindingGroup]:
    """Return findings by rule and sheet, worst first."""
    groups: dict[tuple[int, str, str], list[Finding]] = defaultdict(list)
    for found in findings:
        groups[_LEVELS.index(found.level), found.code, found.sheet].append(found)
    return [_group(group) for _, group in sorted(groups.items())]


def _group(findings: Sequence[Finding]) -> FindingGroup:
    cells = tuple(dict.fromkeys(found.address for found in findings if found.address))
    return FindingGroup(
        level=findings[0].level,
        code=findings[0].code,
        sheet=findings[0].sheet,
        count=len(findings),
        cells=len(cells),
        addresses=cells,
        first=tuple(findings[:SHOWN_MESSAGES]),
    )


def finding_lines(findings: Iterable[Finding]) -> Iterator[tuple[str, str]]:
    """Yield level (empty for details) and line: findings by_rule by rule, worst first, with count and ranges."""
    return group_lines(by_rule(findings), "the marked copy (check --annotate) lists them all")


def group_lines(groups: Iterable[FindingGroup], all_listed: str) -> Iterator[tuple[str, str]]:
    """Yield the same of findings that are by_rule already; `all_listed` says what lists all of them."""
    for group in groups:
        where = f", {counted(group.cells, 'cell')}: {shown(group.sheet)}!{group.ranges}" if group.cells else ""
        yield group.level, f"{group.level} {group.code} {CATALOGUE[group.code].title}{where}"
        for found in group.first:
            yield "", f"    {found.message}"
        if group.count > len(group.first):
            whole = "" if group.level == "info" else f"; {all_listed}"
            yield "", f"    … and {group.count - len(group.first)} more of the same kind{whole}"
        for fix in dict.fromkeys(found.fix for found in group.first):
            if not fix.startswith(_NO_FIX):
                yield "", f"    Fix: {fix}"


def summary_lines(outcome: Outcome, name: str, *, ran: bool) -> Iterator[str]:
    """Yield the closing lines of the terminal: what was computed, what it says, what to do next."""
    if not outcome.skipped:
        words, details = state_words(outcome, ran=ran), detail_lines(outcome, ran=ran)
        yield from closing_lines(name, words, details, outcome.counts, outcome.written, ran=ran)


def state_words(outcome: Outcome, *, ran: bool) -> str:
    """Return how much of a submission was computed, or is ready to be, and what is to fix."""
    return words_of_state(outcome.counts, to_fix_words(outcome.findings), _waiting_words(outcome), ran=ran)


def words_of_state(counts: Mapping[str, int], to_fix: str, waiting: Iterable[str], *, ran: bool) -> str:
    """Return the same of counts, and of how much there is to fix and what waits for what in words."""
    rows, computed = counts["rows"], counts["computed"]
    done = f"{grouped(computed)} of {grouped(rows)} rows {'computed' if ran else 'ready'}"
    ready = done if rows else "nothing to compute"
    warned = counted(counts["warnings"], "warning") if counts["warnings"] else ""
    return "; ".join(filter(None, [ready, to_fix, *waiting, warned]))


def detail_lines(outcome: Outcome, *, ran: bool) -> list[str]:
    """Return what a run says of the limits and of how the spread was found."""
    if not (ran and outcome.counts["rows"]):
        return []
    drives = DriveNotes.of(outcome.results, outcome.settings.target_percent)
    return [*limit_lines(outcome), *drives.lines(outcome.settings.angles), *spread_notes(outcome)]


def closing_lines(
    name: str,
    words: str,
    details: Iterable[str],
    counts: Mapping[str, int],
    written: Written,
    *,
    ran: bool,
    tells_levers: bool = False,
) -> Iterator[str]:
    """Yield the closing lines of a submission of this name, with what was written for it.

    `tells_levers` says that its changes are told beside; else a report or another command does so.
    """
    yield f"{name}: {words}."
    yield from details
    if ran and not counts["computed"]:
        nothing = "There is no change to tell" if tells_levers else "No report was written"
        yield f"{nothing}: no row could be computed."
    yield from (_written_line(written, path) for path in written.paths if not is_picture(path))
    yield from (f"Written: {words}" for words in picture_words(written.paths))
    quoted_name = f'"{name}"' if " " in name else name
    if not ran:
        yield f"Next: {_next_step(counts, quoted_name)}"
    elif counts["marginal"] + counts["fails"] and not (tells_levers or _has_report(written)):
        yield f"Which single change meets the limit: flexlash levers {quoted_name}"


def _has_report(written: Written) -> bool:
    """Whether a report was written, which tells the changes itself."""
    return any(path.suffix.lower() == ".xlsx" and path != written.marked_copy for path in written.paths)


def _waiting_words(outcome: Outcome) -> Iterator[str]:
    """Yield how many rows wait for which faulty material or class."""
    table = outcome.validated.table if outcome.validated else None
    return words_of_waiting(waiting_rows(table, outcome.blocked) if table is not None else ())


def words_of_waiting(waiting: Iterable[Waiting]) -> Iterator[str]:
    """Yield how many rows wait for which faulty material or class."""
    for one in waiting:
        rows = counted(len(one.rows), "row")
        yield f"{rows} wait{'s' if len(one.rows) == 1 else ''} for {one.kind} {shown(one.name, longest=_NAME)}"


def _written_line(written: Written, path: Path) -> str:
    """Return the sentence about a file that was written."""
    named = shown(path, longest=4096)
    if path != written.marked_copy:
        return f"Written: {named}"
    if written.not_carried is None:
        return f"Findings alone, without your file itself: {named}"
    without = f", without its {', '.join(written.not_carried)}" if written.not_carried else ""
    return f"Marked copy of your file{without}: {named}"


def _next_step(counts: Mapping[str, int], name: str) -> str:
    """Return what to do after a check, the command last."""
    computed = counts["computed"]
    if not computed:
        return f"fix that, then: flexlash check {name}"
    if computed < counts["rows"] or counts["errors"]:
        return f"fix that and check again, or compute the {counted(computed, 'row')}: flexlash run {name}"
    return f"flexlash run {name}"


def to_fix_words(findings: Iterable[Finding]) -> str:
    """Return how much there is to fix: `5 cells to fix`, an empty text where there is nothing."""
    return words_of_fixes(*to_fix(findings))


def to_fix(findings: Iterable[Finding]) -> tuple[int, int]:
    """Return at how many cells there are errors, and how many have no cell."""
    errors = [found for found in findings if found.level == "error"]
    return len({(found.sheet, found.cell) for found in errors if found.cell}), sum(not found.cell for found in errors)


def words_of_fixes(cells: int, others: int) -> str:
    """Return in words how many cells and other problems there are to fix.

    >>> words_of_fixes(5, 0), words_of_fixes(1, 2), words_of_fixes(0, 0)
    ('5 cells to fix', '1 cell to fix and 2 problems with the file', '')
    """
    words = (
        f"{counted(cells, 'cell')} to fix" * bool(cells),
        f"{counted(others, 'problem')} with the file" * bool(others),
    )
    return " and ".join(filter(None, words))


def counted(count: int, what: str) -> str:
    """Return a number with its noun: `1 cell`, `5 cells`."""
    return f"{grouped(count)} {what}{'' if count == 1 else 's'}"


def are(count: int) -> str:
    """Return the verb for so many."""
    return "is" if count == 1 else "are"


def quoted(name: str) -> str:
    """Return a name as it stands in a sentence."""
    return f"“{name}”"


def listed(words: Sequence[str], most: int, count: int = 0) -> str:
    """Return the first few of a list as a sentence names them, and how many more there are.

    `count` is how many there are where the list has the first of them alone.

    >>> listed(["a", "b"], 3), listed(["a", "b", "c", "d"], 2), listed(["a", "b"], 2, 12_002)
    ('a and b', 'a, b and 2 more', 'a, b and 12,000 more')
    """
    named = list(words[:most])
    if (more := max(count, len(words)) - len(named)) > 0:
        named.append(f"{grouped(more)} more")
    return " and ".join(filter(None, [", ".join(named[:-1]), *named[-1:]]))


def limit_lines(outcome: Outcome, most: int = 3) -> Iterator[str]:
    """Yield how many variants meet their limits, and by name the worst of those that do not."""
    yield from lines_of_limits(outcome.counts, worst_first(outcome, most), outcome.settings, most)


def lines_of_limits(
    counts: Mapping[str, int], worst: Iterable[Mapping[str, Any]], settings: Settings, most: int = 3
) -> Iterator[str]:
    """Yield the same of counts and of the worst rows of Results, worst first."""
    judged, bounds = sum(counts[verdict] for verdict in VERDICTS), settings.verdict_bounds
    if not judged:
        yield from _without_limits(worst, settings.angles)
        return
    most_over, most_marginal = (f"{100 * share:.10g} %" for share in (bounds.meets, bounds.marginal))
    marginal = f", {counts['marginal']} {are(counts['marginal'])} marginal" if bounds.any_marginal else ""
    rule = f"; marginal: at most {most_marginal}" if bounds.any_marginal else ""
    fail, meet = ("fails" if counts["fails"] == 1 else "fail"), ("meets" if counts["meets"] == 1 else "meet")
    yield (
        f"Of {counted(judged, 'variant')} with a limit {counts['fails']} {fail}{marginal} and {counts['meets']} {meet} "
        f"it: 2U at full torque, with at most {most_over} of units over the limit{rule}."
    )
    over = [row for row in worst if bounds.misses(row["probability_over_limit"])]
    for row in over[:most]:
        words = share_words(row)
        units = f"{words} units" if words in ALL_UNITS else f"{words} of units"
        lots = f"; {lots_words(row, 'fails', 'fail')}" if some_lots_fail(row) else ""
        variant, limit = shown(row["variant"], longest=200), settings.angles.entered(row["backlash_limit_arcmin"])
        yield f"  {variant}: {units} are over {limit}{lots}{_left_open(row)}."


def _without_limits(worst: Iterable[Mapping[str, Any]], angles: AngleUnit) -> Iterator[str]:
    """Yield that nothing is judged, and what the variant with most backlash has."""
    for row in islice(worst, 1):
        yield "No variant has a backlash limit, so there is no verdict. The most backlash:"
        nominal = angles.words(row["backlash_arcmin"])
        most = angles.words(row["p97_5_arcmin"], row["p97_5_standard_error_arcmin"])
        yield f"  {shown(row['variant'], longest=200)}: nominal {nominal}; 97.5 % of units stay below {most}."


def _left_open(row: Mapping[str, Any]) -> str:
    """Return what measured parts leave open of a row's share over the limit; an empty text where none were measured."""
    low, high = (row.get(f"probability_over_limit_sample_{end}") for end in ("low", "high"))
    return "" if low is None or high is None else f"; its measured parts leave open {range_words(low, high)}"


def points_words(outcome: Outcome) -> str:
    """Return how many lines or points stand behind the spread of a variant."""
    counts = outcome.results["spread_points"].drop_nulls().to_list()
    return points_range(counts, "lines" if outcome.settings.method == "line" else "points") if counts else "no points"


def points_range(counts: Sequence[float], what: str) -> str:
    """Return how many lines or points there are, from the fewest to the most.

    >>> points_range([64.0, 16384.0], "lines"), points_range([64.0], "points")
    ('64 to 16384 lines', '64 points')
    """
    least, most = int(min(counts)), int(max(counts))
    return f"{least} {what}" if least == most else f"{least} to {most} {what}"


@dataclass(frozen=True, kw_only=True)
class SpreadNotes:
    """What is to be said of how the spread of some rows was found.

    So many rows have a note, of which `variant` and `note` are the first; so many were cross-checked and agree, with
    the `greatest` difference in combined standard errors.
    """

    noted: int = 0
    variant: str = ""
    note: str = ""
    checked: int = 0
    agreeing: int = 0
    greatest: float = 0.0

    @classmethod
    def of(cls, results: pl.DataFrame) -> SpreadNotes:
        """Return what is to be said of the rows of Results."""
        noted = results.filter(results["spread_note"].is_not_null())
        first = noted.row(0, named=True) if noted.height else {"variant": "", "spread_note": ""}
        notes = cls(noted=noted.height, variant=first["variant"], note=first["spread_note"])
        if "cross_check" not in results.columns:
            return notes
        checked = results.filter(results["cross_check"].is_not_null())
        return replace(
            notes,
            checked=checked.height,
            agreeing=int((checked["cross_check"] == "agrees").sum()),
            greatest=max(checked["cross_check_deviation"].to_list(), default=0.0),
        )

    def __add__(self, later: SpreadNotes) -> SpreadNotes:
        """Return what is to be said of these rows and of later ones together."""
        first = self if self.noted else later
        return SpreadNotes(
            noted=self.noted + later.noted,
            variant=first.variant,
            note=first.note,
            checked=self.checked + later.checked,
            agreeing=self.agreeing + later.agreeing,
            greatest=max(self.greatest, later.greatest),
        )

    def lines(self, *, cross_check: bool, method: str) -> Iterator[str]:
        """Yield what a reader must know of how the spread was found: other methods, precision missed, cross-check."""
        if self.noted:
            more = f" and {self.noted - 1} more, see Results" if self.noted > 1 else ""
            yield f"Spread of {quoted(shown(self.variant, longest=_NAME))}: {self.note}{more}."
        if cross_check and method == "random":
            yield "The spread is plain Monte Carlo already: there is nothing to cross-check it with."
        elif self.checked:
            yield (
                f"Plain Monte Carlo agrees for {self.agreeing} of {self.checked} variants; the greatest difference is "
                f"{self.greatest:.1f} combined standard errors."
            )


def spread_notes(outcome: Outcome) -> Iterator[str]:
    """Yield what a reader must know of how the spread of an outcome was found."""
    notes, cross_check = SpreadNotes.of(outcome.results), "cross_check" in outcome.results.columns
    return notes.lines(cross_check=cross_check, method=outcome.settings.method)


def worst_first(outcome: Outcome, most: int | None = None) -> list[dict[str, Any]]:
    """Return the computed Results rows, all or the first few, as `worst_rows` orders them."""
    return worst_rows(outcome.results, most).to_dicts()
