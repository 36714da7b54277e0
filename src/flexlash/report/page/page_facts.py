"""An outcome → all that a page shows of it, in the report's own words and numbers, as JSON of bounded size."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from flexlash import __version__
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.run_summary import FindingGroup, points_words, state_words, to_fix
from flexlash.feedback.fixing.fix import Fix
from flexlash.feedback.returned_files import certain_fixes
from flexlash.report.layout.links import row_of, rule_counts
from flexlash.report.page.cards import cards_of
from flexlash.report.page.grids import Sheets
from flexlash.report.page.one_variant import variant_pages
from flexlash.report.page.shape import PageFacts, Refused, Sentence
from flexlash.report.page.tiles import finding_tiles, verdict_tiles
from flexlash.report.page.variants import chart_of, lost_variants, shown_names, table_rows
from flexlash.report.report_data import ReportData
from flexlash.report.wording.drive_sentences import DRIVE
from flexlash.report.wording.lever_sentences import LEVER_TOPICS
from flexlash.report.wording.lot_sentences import LOTS
from flexlash.report.wording.measured_parts import PARTS
from flexlash.report.wording.normal_theory import NORMAL
from flexlash.report.wording.review_sentences import ANOTHER
from flexlash.report.wording.sentences import sentences
from flexlash.report.wording.summary_facts import summary_facts
from flexlash.report.wording.verdict_sentences import WORST_CASE
from flexlash.schema.findings import CATALOGUE, Finding, shown

__all__ = ["PAGED", "TABLED", "Found", "page_bytes", "page_facts"]

PAGED, TABLED = 100, 500
"""Most variants with a page of their own, and most in the table; worst first."""

_NAME = 120
"""Most characters of the submission's name."""

_KINDS: Mapping[str, str] = {
    "Computed": "computed",
    "Which fail": "verdict",
    ANOTHER: "verdict",
    "How sure": "verdict",
    NORMAL: "verdict",
    WORST_CASE: "verdict",
    PARTS: "verdict",
    LOTS: "verdict",
    DRIVE: "verdict",
    "Why": "cause",
    **dict.fromkeys(LEVER_TOPICS, "advice"),
    "Findings": "findings",
}
"""What the topics of the Summary are about; any other is a note."""


@dataclass(frozen=True, kw_only=True)
class Found:
    """What was found in a submission, as its cards draw on it.

    `groups` are all findings by rule, of which `findings` are the first; None where these are all. `state` says in
    words how far it can be computed, `sheets` are those from which cells are drawn.
    """

    findings: Sequence[Finding]
    sheets: Sheets
    cells_to_fix: int
    fixable: int
    state: str
    groups: Sequence[FindingGroup] | None = None

    @classmethod
    def of(cls, outcome: Outcome, *, ran: bool, fixes: Sequence[Fix] | None = None) -> Found:
        """Return what was found in an outcome; `fixes` are those that were made, by default those that may be."""
        made = certain_fixes(outcome.findings) if fixes is None else fixes
        headers = outcome.validated.header_rows if outcome.validated else {}
        return cls(
            findings=outcome.findings,
            sheets=Sheets(submission=outcome.submission, header_rows=headers, fixes=made),
            cells_to_fix=to_fix(outcome.findings)[0],
            fixable=len({fix.place for fix in made}),
            state=state_words(outcome, ran=ran),
        )


def page_bytes(outcome: Outcome, found: Found, *, ran: bool, data: ReportData | None = None) -> bytes:
    """Return `page_facts` as JSON; the same bytes for the same outcome."""
    facts = page_facts(outcome, found, ran=ran, data=data)
    return json.dumps(facts, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode()


def page_facts(outcome: Outcome, found: Found, *, ran: bool, data: ReportData | None = None) -> PageFacts:
    """Return what a page shows of an outcome and what was found in it; `ran` says that its spread was computed.

    `data` is what the report draws, needed for variants.
    """
    refused = _refused(outcome)
    facts = PageFacts(
        name=shown(outcome.submission.name, _NAME),
        sha256=outcome.submission.sha256,
        version=__version__,
        ran=ran,
        method=outcome.settings.method,
        seed=outcome.settings.seed,
        points=points_words(outcome) if ran else "",
        target_percent=outcome.settings.verdict_bounds.target_words,
        counts=outcome.counts,
        cells_to_fix=found.cells_to_fix,
        fixable=found.fixable,
        state=found.state,
        tiles=list(finding_tiles(outcome, ran=ran, to_fix=found.cells_to_fix, fixable=found.fixable)),
        verdict_tiles=list(verdict_tiles(outcome)) if ran else [],
        refused=refused,
        findings=sum(rule_counts(outcome).values()),
        cards=[]
        if outcome.submission.kind == "refused"
        else list(cards_of(found.findings, found.sheets, found.groups)),
        sentences=[],
        chart=None,
        table=[],
        computed=outcome.counts["computed"],
        lost=[],
        lost_in_all=0,
        variants=[],
    )
    if ran and data is not None:
        _add_variants(facts, outcome, data)
    return facts


def _refused(outcome: Outcome) -> Refused | None:
    """Return why a file is no readable submission; None for one that is."""
    if outcome.submission.kind != "refused":
        return None
    found = outcome.findings[0]
    return Refused(
        code=found.code,
        title=CATALOGUE[found.code].title,
        message=found.message,
        fix=found.fix,
        skipped=outcome.skipped,
    )


def _add_variants(facts: PageFacts, outcome: Outcome, data: ReportData) -> None:
    """Add what the computed variants show."""
    summary = summary_facts(outcome, data.levers)
    rows = summary.ranked.head(TABLED).to_dicts()
    names = shown_names(rows)
    drawn = data.drawn[:PAGED]
    facts["sentences"] = [
        Sentence(topic=topic, text=" ".join(text.split("\n")), kind=_KINDS.get(topic, "note"))  # type: ignore[typeddict-item]
        for topic, text in sentences(outcome, data.levers, data.allocation)
    ]
    facts["chart"] = chart_of(summary, rows, names, len(drawn))
    facts["table"] = list(table_rows(summary, rows, names, len(drawn)))
    facts["lost"], facts["lost_in_all"] = lost_variants(outcome), facts["counts"]["rows"] - facts["computed"]
    by_row: dict[int, list[Finding]] = defaultdict(list)
    for one in outcome.findings:
        by_row[row_of(outcome, one)].append(one)
    facts["variants"] = list(variant_pages(summary, drawn, names[: len(drawn)], by_row))
