"""Links between the sheets: where a submitted row stands on Results, on Submission and among the findings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from xlsxwriter.url import Url
from xlsxwriter.utility import quote_sheetname

from flexlash.analysis.outcome import Outcome
from flexlash.report.extent import MOST_FINDINGS, extent_of
from flexlash.report.report_data import ROW, Drawn
from flexlash.schema.cell_addresses import CellAddress
from flexlash.schema.findings import CATALOGUE, Finding

__all__ = [
    "FIRST_FINDING",
    "FIRST_ROW",
    "MOST_LINKS",
    "Mirrored",
    "finding_list",
    "finding_rows",
    "first_result",
    "listed_findings",
    "mirrored",
    "name_column",
    "result_rows",
    "row_of",
    "rule_counts",
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
    """Write a text that leads to a cell of the report, given as `Results!A3`.

    It is a plain text where that sheet cannot be seen, to which no program follows a link, and when links are used up.
    """
    title, _, cell = target.rpartition("!")
    title = title.strip("'")
    if sheet.hlink_count >= MOST_LINKS or not sheet.book.shows(title):
        sheet.write_string(row, column, text, sheet.book.unlinked(style))
        return
    url = Url(f"internal:{quote_sheetname(title)}!{cell}")
    url.text = text
    sheet.write_url(row, column, url, style)
    # The cell has the text already; a second copy of it beside every link would be a tenth of the file.
    url.text = ""


def result_rows(outcome: Outcome) -> dict[int, int]:
    """Return the row of Results, from 0, by the row number of the submission."""
    table = outcome.validated.table if outcome.validated else None
    first = first_result(outcome)
    return {} if table is None else {row: place for place, row in enumerate(table.frame["row"], start=first)}


def first_result(outcome: Outcome) -> int:
    """Return the row of Results, from 0, of its first variant: lower where a sentence above says what is left out."""
    return FIRST_ROW + bool(outcome.whole)


def finding_list(outcome: Outcome) -> list[Finding]:
    """Return the findings as the Findings sheet lists them: worst first, then in the order of the submission."""
    return sorted(outcome.findings, key=lambda finding: _LEVELS.index(finding.level))


def listed_findings(outcome: Outcome) -> list[Finding]:
    """Return the findings that have a line on the Findings sheet: of a large submission the first alone."""
    return finding_list(outcome)[: MOST_FINDINGS if extent_of(outcome).large else None]


def rule_counts(outcome: Outcome) -> Mapping[str, int]:
    """Return how many findings of the whole submission each rule has, in the order of the first of each."""
    own = Counter(finding.code for finding in outcome.findings)
    return {**own, **outcome.whole.rules} if outcome.whole else own


def rules_of(outcome: Outcome) -> dict[str, list[Finding]]:
    """Return the findings of the outcome by code, worst level first; a rule may have none of them."""
    by_code: dict[str, list[Finding]] = {code: [] for code in rule_counts(outcome)}
    for finding in outcome.findings:
        by_code.setdefault(finding.code, []).append(finding)
    return dict(sorted(by_code.items(), key=lambda item: (_LEVELS.index(CATALOGUE[item[0]].level), item[0])))


def row_of(outcome: Outcome, finding: Finding) -> int:
    """Return the row number in Variants that a finding is about, 0 for none."""
    table = outcome.validated.table if outcome.validated else None
    return finding.row if table is not None and finding.sheet == table.sheet else 0


def finding_rows(outcome: Outcome) -> dict[int, int]:
    """Return the row of Findings, from 0, of the first finding of each row of Variants."""
    first: dict[int, int] = {}
    for row, finding in enumerate(listed_findings(outcome), start=FIRST_FINDING + len(rules_of(outcome))):
        first.setdefault(row_of(outcome, finding), row)
    return first


def name_column(outcome: Outcome) -> int:
    """Return the column of Variants in which the variants' names stand."""
    table = outcome.validated.table if outcome.validated else None
    return table.heading.columns.get("variant", 1) if table is not None else 1


@dataclass(frozen=True, kw_only=True)
class Mirrored:
    """Where the cells of a sheet stand in the report: at their own addresses.

    With `rows` those of its rows that stand there have other places; before them is a column of row numbers.
    """

    rows: Mapping[int, int] | None = None

    @property
    def shift(self) -> int:
        """How far cells are moved to the right, and header rows down."""
        return 0 if self.rows is None else 1

    def place(self, address: CellAddress) -> CellAddress | None:
        """Return where a cell stands in the report, None where it does not."""
        row = address.row if self.rows is None else self.rows.get(address.row)
        return None if row is None else CellAddress(row=row, column=address.column + self.shift)


def mirrored(outcome: Outcome, drawn: Sequence[Drawn]) -> Mirrored:
    """Return where the cells of Variants stand on Submission: of a large submission those of the drawn variants.

    A sentence is above them, then what is above the variants in the submission, then the variants, worst first.
    """
    if not extent_of(outcome).large or outcome.validated is None:
        return Mirrored()
    header = outcome.validated.header_rows.get("Variants", 0)
    rows = [*range(1, header + 1), *(variant.row[ROW] for variant in drawn)]
    return Mirrored(rows={row: place for place, row in enumerate(rows, start=2)})
