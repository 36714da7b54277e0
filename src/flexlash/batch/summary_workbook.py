"""How all submissions of a run ended → the summary beside their reports: a workbook, and lines for programs."""

from __future__ import annotations

import datetime
import io
import json
import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import xlsxwriter

from flexlash.analysis.run_summary import counted
from flexlash.batch.ended import Ended, how_many
from flexlash.report.layout.paper import print_readably
from flexlash.report.layout.styles import Book
from flexlash.schema.exit_codes import ExitCode, most_severe
from flexlash.schema.findings import CATALOGUE, shown
from flexlash.schema.limit_verdict import VERDICTS
from flexlash.schema.stamps import placeholder

__all__ = ["SUMMARY", "summary_lines_file", "summary_workbook"]

SUMMARY = "summary"
"""What the stamp of a summary says it is."""

_DATE = datetime.datetime(2000, 1, 1, tzinfo=datetime.UTC).replace(tzinfo=None)
_LEVELS = ("error", "warning", "info")
_STYLES = {"error": "error", "warning": "warning", "info": "text"}
_STATES = {
    ExitCode.FINE: ("computed", "ok"),
    ExitCode.OVER_LIMIT: ("computed, a limit is not met", "warning"),
    ExitCode.SOME_ROWS: ("computed in part", "warning"),
    ExitCode.NOTHING: ("nothing computed", "error"),
    ExitCode.NO_FILE: ("a file could not be opened or written", "error"),
    ExitCode.INTERNAL: ("internal error", "error"),
}
"""What each exit code says of a submission, and the look of the cell."""

_SUBMISSIONS = (
    ("Submission", 34),
    ("State", 24),
    ("Rows", 8),
    ("Computed", 10),
    ("Errors", 8),
    ("Warnings", 10),
    ("Meets", 8),
    ("Marginal", 9),
    ("Fails", 8),
    ("Worst variant", 26),
    ("Units over its limit", 28),
    ("Report", 32),
    ("Reason", 60),
)
_RULES = (
    ("Level", 10),
    ("Code", 8),
    ("Rule", 40),
    ("Findings", 10),
    ("Submissions", 12),
    ("First places", 80),
    ("More", 24),
)
_HEADER = 3
_PLACES = 3
_NAME = 200
_MOST_LINKS = 65_000
"""Excel keeps few more on one sheet."""

_LONGEST_LINK = 2_000
_UNSAFE = re.compile(r"[%#?\" <>\[\]^`{|}\\:]")
"""What a link may hold only by its number."""


def summary_lines_file(ended: Sequence[Ended]) -> bytes:
    """Return what `--json` prints of all submissions, without the time that each took, and the total.

    The last line has the stamp's place.
    """
    codes = [one.code for one in ended if not one.skipped]
    total = {"submissions": len(codes), **how_many(codes), "exit_code": most_severe(codes)}
    lines = [one.as_dictionary(timed=False) for one in ended]
    last = {"total": total, "stamp": placeholder(SUMMARY)}
    return "".join(f"{json.dumps(line, ensure_ascii=False)}\n" for line in [*lines, last]).encode()


def summary_workbook(ended: Sequence[Ended], folder: Path) -> bytes:
    """Return the workbook: a sheet of submissions, each with its report in `folder`, and one of findings by rule."""
    buffer = io.BytesIO()
    workbook = xlsxwriter.Workbook(buffer, {"in_memory": True, "strings_to_urls": False})
    workbook.set_properties({"title": "flexlash summary of submissions", "created": _DATE})
    workbook.set_custom_property("flexlash", SUMMARY)
    book = Book(workbook)
    given = [one for one in ended if not one.skipped]
    _write_submissions(book, given, folder)
    _write_rules(book, given)
    workbook.close()
    return buffer.getvalue()


def _sheet(book: Book, title: str, words: str, columns: Sequence[tuple[str, int]]) -> Any:
    """Return a sheet with its title, a sentence and the header of its list."""
    sheet = book.sheet(title)
    sheet.write_string(0, 0, title, book.format("title"))
    sheet.set_row(0, 28)
    sheet.write_string(1, 0, words, book.format("quiet"))
    for column, (label, width) in enumerate(columns):
        sheet.set_column(column, column, width)
        sheet.write_string(_HEADER, column, label, book.format("header"))
    sheet.freeze_panes(_HEADER + 1, 1)
    sheet.repeat_rows(_HEADER)
    print_readably(sheet, [width for _, width in columns])
    return sheet


def _write_submissions(book: Book, ended: Sequence[Ended], folder: Path) -> None:
    """Write a line for each submission, its report linked."""
    total = {name: sum(one.counts[name] for one in ended) for name in ("rows", "computed", *VERDICTS)}
    ends = how_many([one.code for one in ended])
    words = (
        f"{counted(len(ended), 'submission')}: {ends['computed']} computed, {ends['partly']} in part, {ends['not']} "
        f"not. {total['computed']} of {counted(total['rows'], 'row')} computed; of those with a limit "
        f"{total['meets']} meet it, {total['marginal']} are marginal, {total['fails']} fail."
    )
    sheet = _sheet(book, "Submissions", words, _SUBMISSIONS)
    for row, one in enumerate(ended, start=_HEADER + 1):
        state, look = _STATES[one.code]
        name = (one.below / one.told.get("submission", one.path.name)).as_posix()
        sheet.write_string(row, 0, shown(name, _NAME), book.format("text"))
        sheet.write_string(row, 1, state, book.format(look))
        for column, key in enumerate(("rows", "computed", "errors", "warnings", *VERDICTS), start=2):
            sheet.write_number(row, column, one.counts[key], book.format("text", "count"))
        if one.worst:
            worst = one.worst[0]
            sheet.write_string(row, 9, shown(worst.variant, _NAME), book.format("indented"))
            sheet.write_string(row, 10, worst.over_limit or "no limit", book.format("text"))
        reports = [path for path in one.written.paths if path != one.written.marked_copy]
        if reports:
            _write_link(book, sheet, row, Path(os.path.relpath(reports[0], folder)))
        if one.error or one.code == ExitCode.NOTHING:
            sheet.write_string(row, 12, shown(one.error or one.words, 1000), book.format("text"))
    if ended:
        sheet.autofilter(_HEADER, 0, _HEADER + len(ended), len(_SUBMISSIONS) - 1)


def _write_link(book: Book, sheet: Any, row: int, path: Path) -> None:
    """Write where a report lies beside the summary, as a link while Excel takes one more."""
    text = path.as_posix()
    target = _UNSAFE.sub(lambda match: f"%{ord(match[0]):02X}", text)
    if sheet.hlink_count >= _MOST_LINKS or len(target) > _LONGEST_LINK or text != shown(text, 4096):
        sheet.write_string(row, 11, shown(text, 4096), book.format("text"))
    else:
        sheet.write_url(row, 11, f"external:{target}", book.format("link"), string=text)


def _write_rules(book: Book, ended: Sequence[Ended]) -> None:
    """Write a line for each rule that was broken, worst level first."""
    codes = {code for one in ended for code in one.by_rule}
    rules = sorted(codes, key=lambda code: (_LEVELS.index(CATALOGUE[code].level), code))
    found = sum(sum(one.by_rule.values()) for one in ended)
    words = f"{counted(found, 'finding')} by {counted(len(rules), 'rule')}." if rules else "Nothing was found."
    sheet = _sheet(book, "Findings", words, _RULES)
    for row, code in enumerate(rules, start=_HEADER + 1):
        rule = CATALOGUE[code]
        having = [one for one in ended if one.by_rule.get(code)]
        sheet.write_string(row, 0, rule.level, book.format(_STYLES[rule.level]))
        sheet.write_string(row, 1, code, book.format("text"))
        sheet.write_string(row, 2, rule.title, book.format("text"))
        sheet.write_number(row, 3, sum(one.by_rule[code] for one in having), book.format("text", "count"))
        sheet.write_number(row, 4, len(having), book.format("text", "count"))
        sheet.write_string(row, 5, shown(_places(having, code), 1000), book.format("indented"))
        sheet.write_string(row, 6, f"flexlash explain {code}", book.format("text"))
    if rules:
        sheet.autofilter(_HEADER, 0, _HEADER + len(rules), len(_RULES) - 1)


def _places(having: Sequence[Ended], code: str) -> str:
    """Return the first places where a rule is broken."""
    places: list[str] = []
    for one in having:
        found: Sequence[Mapping[str, str]] = one.told.get("findings", ())
        for finding in found:
            if finding["code"] == code:
                cell = f"{finding['sheet']}!{finding['cell']}" if finding["cell"] else finding["sheet"]
                places.append(f"{one.told['submission']} {cell}".strip())
                if len(places) > _PLACES:
                    return ", ".join([*places[:_PLACES], "…"])
    return ", ".join(places)
