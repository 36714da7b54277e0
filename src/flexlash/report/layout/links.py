"""Links between the sheets: where a submitted row stands on Results, on Submission and among the findings."""

from __future__ import annotations

from typing import Any

from xlsxwriter.url import Url

from flexlash.analysis.outcome import Outcome
from flexlash.schema.cell_addresses import column_letters
from flexlash.schema.findings import Finding

__all__ = [
    "FIRST_FINDING",
    "FIRST_ROW",
    "MOST_LINKS",
    "finding_list",
    "finding_rows",
    "name_cell",
    "result_rows",
    "row_of",
    "rules_of",
    "write_link",
]

FIRST_ROW = 2
"""Row of Results, from 0, of the first variant; above it stand labels and keys."""

FIRST_FINDING = 7
"""Row of Findings, from 0, of the first finding, less the number of rules that are listed above."""

MOST_LINKS = 65_530
"""Links that Excel keeps on one sheet."""

_LEVELS = ("error", "warning", "info")


def write_link(sheet: Any, row: int, column: int, target: str, text: str, *, style: Any) -> None:
    """Write a text that leads to a cell of the report, given as `Results!A3`; a plain text when links are used up."""
    if sheet.hlink_count >= MOST_LINKS:
        sheet.write_string(row, column, text, style)
        return
    url = Url(f"internal:{target}")
    url.text = text
    sheet.write_url(row, column, url, style)
    # The cell has the text already; a second copy of it beside every link would be a tenth of the file.
    url.text = ""


def result_rows(outcome: Outcome) -> dict[int, int]:
    """Return the row of Results, from 0, by the row number of the submission."""
    submitted = outcome.validated.submitted if outcome.validated else []
    return {row: result_row for result_row, (row, _, _) in enumerate(submitted, start=FIRST_ROW)}


def finding_list(outcome: Outcome) -> list[Finding]:
    """Return the findings as the Findings sheet lists them: worst first, then in the order of the submission."""
    return sorted(outcome.findings, key=lambda finding: _LEVELS.index(finding.level))


def rules_of(outcome: Outcome) -> dict[str, list[Finding]]:
    """Return the findings by code, worst level first."""
    by_code: dict[str, list[Finding]] = {}
    for finding in finding_list(outcome):
        by_code.setdefault(finding.code, []).append(finding)
    return dict(sorted(by_code.items(), key=lambda item: (_LEVELS.index(item[1][0].level), item[0])))


def row_of(outcome: Outcome, finding: Finding) -> int:
    """Return the row number in Variants that a finding is about, 0 for none."""
    table = outcome.validated.table if outcome.validated else None
    return finding.row if table is not None and finding.sheet == table.sheet else 0


def finding_rows(outcome: Outcome) -> dict[int, int]:
    """Return the row of Findings, from 0, of the first finding of each row of Variants."""
    first: dict[int, int] = {}
    for row, finding in enumerate(finding_list(outcome), start=FIRST_FINDING + len(rules_of(outcome))):
        first.setdefault(row_of(outcome, finding), row)
    return first


def name_cell(outcome: Outcome) -> str:
    """Return the letters of the column of Submission in which the variants' names stand."""
    table = outcome.validated.table if outcome.validated else None
    return column_letters(table.heading.columns.get("variant", 1)) if table is not None else "A"
