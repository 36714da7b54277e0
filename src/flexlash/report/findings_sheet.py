"""The Findings sheet: each rule once with its count and what fixes it, below them every finding with its links."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

from flexlash.analysis.outcome import Outcome
from flexlash.report.extent import extent_of
from flexlash.report.failing.failing_places import variant_targets
from flexlash.report.layout.links import (
    FIRST_FINDING,
    listed_findings,
    mirrored,
    row_of,
    rule_counts,
    rules_of,
    write_link,
)
from flexlash.report.layout.paper import Listed, print_one_page
from flexlash.report.layout.styles import Book
from flexlash.report.layout.wrapping import fitted
from flexlash.report.report_data import ROW, Drawn
from flexlash.report.submission_sheets import SUBMISSION, mirrored_schema, titles_of
from flexlash.schema.columns import ENTRY_SHEETS
from flexlash.schema.finding_explanations import explanation_of
from flexlash.schema.findings import CATALOGUE, Finding, shown
from flexlash.schema.number_words import grouped
from flexlash.schema.result_columns import FINDINGS

__all__ = ["write_findings"]

_WIDTHS = {
    "level": 8,
    "code": 7,
    "cell": 8,
    "variant": 20,
    "column": 20,
    "value": 21,
    "message": 49,
    "fix": 42,
    "suggestion": 14,
}
_STYLES = {"error": "error", "warning": "warning", "info": "text"}
_PER_LINE = {"message": 51, "fix": 44, "value": 21, "suggestion": 14}
"""Characters of a column's text on one line."""

_FIX_PER_LINE = 105
_LINE = 15.5
_RULES_HEADER = 3
_LABELS = {(schema, column.key): column.label for schema, columns in ENTRY_SHEETS.items() for column in columns}
_BY_KEY = {key: label for (_, key), label in reversed(_LABELS.items())}


def write_findings(book: Book, outcome: Outcome, drawn: Sequence[Drawn]) -> None:
    """Write the Findings sheet; cells link to the submission as read, variants to their pages."""
    sheet = book.sheet("Findings")
    for column_index, column in enumerate(FINDINGS):
        sheet.set_column(column_index, column_index, _WIDTHS.get(column.key, 11))
    sheet.write_string(0, 0, "Findings", book.format("title"))
    sheet.set_row(0, 28)
    findings = listed_findings(outcome)
    if not rule_counts(outcome):
        sheet.write_string(1, 0, "Nothing was found.", book.format("quiet"))
        return
    sheet.write_string(1, 0, _counts(outcome, len(findings)), book.format("quiet"))
    if left_out := _left_out(outcome, len(findings)):
        sheet.write_string(2, 0, left_out, book.format("quiet"))
    header = _write_rules(book, sheet, outcome, len(findings))
    for column_index, column in enumerate(FINDINGS):
        sheet.write_string(header, column_index, column.label, book.format("header"))
        sheet.write_comment(header, column_index, column.help)
    variants = mirrored(outcome, drawn)
    targets = variant_targets(drawn, outcome.settings.verdict_bounds)
    by_name = {variant.row["variant"]: targets[variant.row[ROW]] for variant in drawn}
    titles = titles_of(outcome.submission)
    for row, finding in enumerate(findings, start=header + 1):
        target = targets.get(row_of(outcome, finding)) or by_name.get(finding.variant, "")
        title = titles.get(finding.sheet, "")
        place = finding.address
        if place and title == SUBMISSION:
            place = variants.place(place)
        cell = str(place) if place and title else ""
        _write_finding(book, sheet, row, finding, title=title, links=(f"{title}!{cell}" if cell else "", target))
    sheet.autofilter(header, 0, header + len(findings), len(FINDINGS) - 1)
    sheet.freeze_panes(0, 2)
    listed = Listed(noun="findings", first=header + 1, columns=[column.label for column in FINDINGS])
    print_one_page(sheet, [_WIDTHS.get(column.key, 11) for column in FINDINGS], header + len(findings), listed=listed)


def _counts(outcome: Outcome, listed: int) -> str:
    """Return how much was found, and where more is told; so many findings are listed."""
    counts, levels = rule_counts(outcome), Counter[str]()
    for code, count in counts.items():
        levels[CATALOGUE[code].level] += count
    errors, warnings, notes = (grouped(levels[level]) for level in ("error", "warning", "info"))
    which = "every finding" if listed == sum(counts.values()) else "the first findings"
    return (
        f"Errors: {errors}, warnings: {warnings}, notes: {notes}. An error keeps its row from being computed, a "
        f"warning flags it. First each rule once, below {which}, with filters. The command flexlash explain CODE says "
        "what a rule means."
    )


def _left_out(outcome: Outcome, listed: int) -> str:
    """Return how many findings have no line, and where they are; an empty text where all have one."""
    more = sum(rule_counts(outcome).values()) - listed
    if more <= 0:
        return ""
    file = extent_of(outcome).findings_file
    where = f"all are in {file}" if file else "flexlash check with --json or --annotate tells all"
    return f"{grouped(listed)} findings are listed below, {grouped(more)} more are not; {where}."


def _write_rules(book: Book, sheet: Any, outcome: Outcome, listed: int) -> int:
    """Write one line for each rule, above a list of so many findings; return the row of the list's header."""
    rules, counts = rules_of(outcome), rule_counts(outcome)
    row = _RULES_HEADER
    headings = {0: "Level", 1: "Code", 2: "Count", 3: "Rule", 6: "More", 7: "Fix"}
    last = len(FINDINGS) - 1
    for column_index in range(last + 1):
        sheet.write_string(row, column_index, headings.get(column_index, ""), book.format("header"))
    sheet.merge_range(row, 3, row, 5, "Rule", book.format("header"))
    sheet.merge_range(row, 7, row, last, "Fix", book.format("header"))
    for row, (code, group) in enumerate(rules.items(), start=_RULES_HEADER + 1):
        fixes = {finding.fix for finding in group}
        fix = fixes.pop() if len(fixes) == 1 and len(group) == counts[code] else explanation_of(code, {}).fix
        level = CATALOGUE[code].level
        sheet.write_string(row, 0, level, book.format(_STYLES[level]))
        sheet.write_string(row, 1, code, book.format("text"))
        sheet.write_number(row, 2, counts[code], book.format("text"))
        sheet.merge_range(row, 3, row, 5, "", book.format("text"))
        sheet.write_string(row, 3, CATALOGUE[code].title, book.format("indented"))
        sheet.write_string(row, 6, f"flexlash explain {code}", book.format("text"))
        sheet.merge_range(row, 7, row, last, "", book.format("wrap"))
        sheet.write_string(row, 7, fix, book.format("wrap"))
        sheet.set_row(row, _LINE * (1 + len(fix) // _FIX_PER_LINE))
    header = FIRST_FINDING - 1 + len(rules)
    heading = "Every finding" if listed == sum(counts.values()) else "The first findings"
    sheet.write_string(header - 1, 0, heading, book.format("label"))
    return header


def _write_finding(book: Book, sheet: Any, row: int, finding: Finding, *, title: str, links: tuple[str, str]) -> None:
    """Write one finding, its level coloured, its cell linked to the submission, its variant to its page or Explorer.

    `links` are both targets, empty where there is none.
    """
    cell, target = links
    texts = finding.as_dictionary()
    label = _LABELS.get((mirrored_schema(title), finding.column)) or _BY_KEY.get(finding.column)
    if label:
        texts["column"] = f"{label}\n{finding.column}"
    lines = [1 + len(texts[key]) // width for key, width in _PER_LINE.items()]
    sheet.set_row(row, _LINE * max(2 if label else 1, *lines))
    texts["variant"] = fitted(shown(texts["variant"]), _WIDTHS["variant"])
    wrap = book.format("wrap")
    for column_index, (key, text) in enumerate(texts.items()):
        if key == "level":
            sheet.write_string(row, column_index, text, book.format(_STYLES[finding.level]))
        elif key == "cell" and text and cell:
            write_link(sheet, row, column_index, cell, text, style=book.format("link"))
        elif key == "variant" and text and target:
            write_link(sheet, row, column_index, target, text, style=book.format("link"))
        elif text:
            sheet.write_string(row, column_index, text, wrap)
