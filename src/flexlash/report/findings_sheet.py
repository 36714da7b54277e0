"""The Findings sheet: each rule once with its count and what fixes it, below them every finding with its links."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

from flexlash.analysis.outcome import Outcome
from flexlash.report.layout.links import FIRST_FINDING, finding_list, result_rows, row_of, rules_of, write_link
from flexlash.report.layout.styles import Book
from flexlash.report.submission_sheets import titles_of
from flexlash.schema.columns import ENTRY_SHEETS
from flexlash.schema.finding_explanations import explanation_of
from flexlash.schema.findings import CATALOGUE, Finding, shown
from flexlash.schema.result_columns import FINDINGS

__all__ = ["write_findings"]

_WIDTHS = {"message": 66, "fix": 50, "suggestion": 18, "variant": 22, "column": 24, "value": 24}
_STYLES = {"error": "error", "warning": "warning", "info": "text"}
_NAME = 30
_PER_LINE = {"message": 68, "fix": 52, "value": 24, "suggestion": 18}
"""Characters of a column's text on one line."""

_MEND_PER_LINE = 130
_LINE = 15.5
_RULES_HEADER = 3
_LABELS = {(schema, column.key): column.label for schema, columns in ENTRY_SHEETS.items() for column in columns}
_BY_KEY = {key: label for (_, key), label in reversed(_LABELS.items())}


def write_findings(book: Book, outcome: Outcome) -> None:
    """Write the Findings sheet; cells link to the submission as read, variants to Results."""
    sheet = book.sheet("Findings")
    for column_index, column in enumerate(FINDINGS):
        sheet.set_column(column_index, column_index, _WIDTHS.get(column.key, 11))
    sheet.write_string(0, 0, "Findings", book.format("title"))
    sheet.set_row(0, 28)
    if not outcome.findings:
        sheet.write_string(1, 0, "Nothing was found.", book.format("quiet"))
        return
    sheet.write_string(1, 0, _counts(outcome), book.format("quiet"))
    header = _write_rules(book, sheet, rules_of(outcome))
    for column_index, column in enumerate(FINDINGS):
        sheet.write_string(header, column_index, column.label, book.format("header"))
        sheet.write_comment(header, column_index, column.help)
    findings, rows, by_name = finding_list(outcome), result_rows(outcome), _rows_by_name(outcome)
    titles = titles_of(outcome.submission)
    for row, finding in enumerate(findings, start=header + 1):
        result = rows.get(row_of(outcome, finding), by_name.get(finding.variant))
        _write_finding(book, sheet, row, finding, title=titles.get(finding.sheet, ""), result=result)
    sheet.autofilter(header, 0, header + len(findings), len(FINDINGS) - 1)
    sheet.freeze_panes(0, 2)


def _counts(outcome: Outcome) -> str:
    """Return how much was found, and where more is told."""
    levels: Counter[str] = Counter(finding.level for finding in outcome.findings)
    counts = f"Errors: {levels['error']}, warnings: {levels['warning']}, notes: {levels['info']}."
    return (
        f"{counts} An error keeps its row from being computed, a warning flags it. First each rule once, below every "
        "finding, with filters. The command flexlash explain CODE says what a rule means."
    )


def _rows_by_name(outcome: Outcome) -> dict[str, int]:
    """Return the row of Results by the variant's name, for findings on other sheets."""
    names = outcome.results["variant"].to_list()
    return {name: row for row, name in zip(result_rows(outcome).values(), names, strict=False) if name}


def _write_rules(book: Book, sheet: Any, rules: Mapping[str, list[Finding]]) -> int:
    """Write one line for each rule; return the row of the list's header."""
    row = _RULES_HEADER
    headings = {0: "Level", 1: "Code", 2: "Count", 3: "Rule", 6: "More", 7: "How to mend"}
    last = len(FINDINGS) - 1
    for column_index in range(last + 1):
        sheet.write_string(row, column_index, headings.get(column_index, ""), book.format("header"))
    sheet.merge_range(row, 3, row, 5, "Rule", book.format("header"))
    sheet.merge_range(row, 7, row, last, "How to mend", book.format("header"))
    for row, (code, group) in enumerate(rules.items(), start=_RULES_HEADER + 1):
        fixes = {finding.fix for finding in group}
        mend = fixes.pop() if len(fixes) == 1 else explanation_of(code, {}).mend
        sheet.write_string(row, 0, group[0].level, book.format(_STYLES[group[0].level]))
        sheet.write_string(row, 1, code, book.format("text"))
        sheet.write_number(row, 2, len(group), book.format("text"))
        sheet.merge_range(row, 3, row, 5, "", book.format("text"))
        sheet.write_string(row, 3, CATALOGUE[code].title, book.format("indented"))
        sheet.write_string(row, 6, f"flexlash explain {code}", book.format("text"))
        sheet.merge_range(row, 7, row, last, "", book.format("wrap"))
        sheet.write_string(row, 7, mend, book.format("wrap"))
        sheet.set_row(row, _LINE * (1 + len(mend) // _MEND_PER_LINE))
    header = FIRST_FINDING - 1 + len(rules)
    sheet.write_string(header - 1, 0, "Every finding", book.format("label"))
    return header


def _write_finding(book: Book, sheet: Any, row: int, finding: Finding, *, title: str, result: int | None) -> None:
    """Write one finding, its level coloured, its variant linked to Results and its cell to the submission."""
    texts = finding.as_dictionary()
    label = _LABELS.get((_schema(title), finding.column)) or _BY_KEY.get(finding.column)
    if label:
        texts["column"] = f"{label}\n{finding.column}"
    lines = [1 + len(texts[key]) // width for key, width in _PER_LINE.items()]
    sheet.set_row(row, _LINE * max(2 if label else 1, *lines))
    wrap = book.format("wrap")
    for column_index, (key, text) in enumerate(texts.items()):
        if key == "level":
            sheet.write_string(row, column_index, text, book.format(_STYLES[finding.level]))
        elif key == "cell" and text and title:
            write_link(sheet, row, column_index, f"{title}!{text}", text, style=book.format("link"))
        elif key == "variant" and text and result is not None:
            write_link(
                sheet,
                row,
                column_index,
                f"Results!A{result + 1}",
                shown(text, longest=_NAME),
                style=book.format("link"),
            )
        elif text:
            sheet.write_string(row, column_index, text, wrap)


def _schema(title: str) -> str:
    """Return the entry sheet that a sheet of the report mirrors."""
    return "Variants" if title == "Submission" else title
