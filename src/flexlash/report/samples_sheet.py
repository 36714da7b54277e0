"""The Samples sheet: what the measured parts tell of each dimension, with the intervals that their number leaves."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

from flexlash.analysis.outcome import Outcome
from flexlash.analysis.sample_findings import NOT_NORMAL
from flexlash.analysis.sample_uses import MOST_ROWS, MeasuredPair, SampleUse, measured_pairs, sample_uses
from flexlash.report.extent import extent_of
from flexlash.report.layout.paper import SMALL, print_readably
from flexlash.report.layout.styles import Book, decimals_of
from flexlash.report.report_data import Drawn

__all__ = ["SAMPLES", "write_samples"]

SAMPLES = "Samples"
_NOTES = (
    "Each sample is the measured parts of one process. From … to … are 95 % intervals: of a hundred samples of this "
    "size about 95 have the true figure of the process between them. More parts make them narrower.",
    "Mean by Student's t, standard deviation s (n − 1) by chi-square, Cp by the interval of s, Cpk by Bissell 1990. "
    "They are those of a normal process; with p below 0.05 Anderson and Darling's test says that the process is "
    "probably not normal.",
    "Cp and Cpk compare the process with the limits of the class that uses the sample. Deviations are what was "
    "measured above the entered value, and so are their limits.",
)
_PAIRS_NOTE = (
    "Correlation of dimensions measured on the same parts: Pearson's of the values, or of the normal scores of their "
    "ranks where a class takes one of them as measured; 95 % interval by Fisher's transformation."
)
_WIDTH = 8.5


class _Column(NamedTuple):
    """A column of the table: heading, value of a row, number format of a row, width."""

    heading: str
    value: Callable[[Any], str | float | None]
    code: Callable[[Any], str] = lambda _: "general"
    width: float = _WIDTH


def _mean_code(row: SampleUse) -> str:
    """Return the number format down to the first digit of the mean's standard error."""
    return decimals_of(row.statistics.sd / row.count**0.5, "general") if row.statistics else "general"


def _sd_code(row: SampleUse) -> str:
    """Return the number format that shows a standard deviation with two digits of its own."""
    return decimals_of(row.statistics.sd / 10, "general") if row.statistics else "general"


def _index_code(_: object) -> str:
    return "0.00"


def _p_code(row: SampleUse) -> str:
    p = row.statistics.normality if row.statistics else None
    return "0.0E+00" if p is not None and p < NOT_NORMAL / 50 else "0.000"


def _told(row: SampleUse, name: str) -> float | None:
    return getattr(row.statistics, name) if row.statistics else None


def _index(row: SampleUse, name: str) -> float | None:
    return getattr(row.capability, name) if row.capability else None


def _used_words(row: SampleUse) -> str:
    """Return which class takes the parts for what, and of how many variants."""
    if not row.used_by:
        return "no class"
    return f"{row.used_by}, as {row.distribution}; {row.variants} variant{'s' * (row.variants > 1)}"


_COLUMNS = (
    _Column("Sample", lambda row: row.sample, width=15.0),
    _Column("Dimension", lambda row: row.column.plain_name, width=18.0),
    _Column("Unit", lambda row: row.column.unit, width=6.0),
    _Column("Parts n", lambda row: row.count, lambda _: "count", 7.0),
    _Column("Mean", lambda row: _told(row, "mean"), _mean_code),
    _Column("from", lambda row: _told(row, "mean_low"), _mean_code),
    _Column("to", lambda row: _told(row, "mean_high"), _mean_code),
    _Column("s", lambda row: _told(row, "sd"), _sd_code),
    _Column("from", lambda row: _told(row, "sd_low"), _sd_code),
    _Column("to", lambda row: _told(row, "sd_high"), _sd_code),
    _Column("Least", lambda row: row.least, _sd_code),
    _Column("Greatest", lambda row: row.greatest, _sd_code),
    _Column("Lower limit", lambda row: row.low),
    _Column("Upper limit", lambda row: row.high),
    _Column("Cp", lambda row: _index(row, "cp"), _index_code, 6.5),
    _Column("from", lambda row: _index(row, "cp_low"), _index_code, 6.5),
    _Column("to", lambda row: _index(row, "cp_high"), _index_code, 6.5),
    _Column("Cpk", lambda row: _index(row, "cpk"), _index_code, 6.5),
    _Column("from", lambda row: _index(row, "cpk_low"), _index_code, 6.5),
    _Column("to", lambda row: _index(row, "cpk_high"), _index_code, 6.5),
    _Column("Normal: p", lambda row: _told(row, "normality"), _p_code),
    _Column("Used by", _used_words, width=38.0),
)
_DEVIATIONS = _Column("Measured as", lambda row: "deviation" if row.are_deviations else "value", width=10.0)
"""Shown where a sample holds deviations."""

_PAIRS = (
    _Column("Sample", lambda row: row.sample),
    _Column("Dimension", lambda row: row.first.plain_name),
    _Column("", lambda _: None),
    _Column("Parts n", lambda row: row.correlation.count, lambda _: "count"),
    _Column("r", lambda row: row.correlation.correlation, _index_code),
    _Column("from", lambda row: row.correlation.low, _index_code),
    _Column("to", lambda row: row.correlation.high, _index_code),
    _Column("with", lambda row: f"{row.second.plain_name}, of {'normal scores' if row.by_scores else 'values'}"),
)


def write_samples(book: Book, outcome: Outcome, drawn: Sequence[Drawn]) -> None:
    """Write what each sample tells, where something was measured; those that classes use come first."""
    measured = outcome.validated.measured if outcome.validated else {}
    if not any(measured.values()):
        return
    extent = extent_of(outcome)
    variants = [one.computed for one in drawn] if extent.is_part else list(outcome.computed.values())
    rows, pairs = sample_uses(measured, variants), measured_pairs(measured, variants)
    sheet = book.sheet(SAMPLES)
    sheet.write_string(0, 0, "What the measured parts say", book.format("title"))
    sheet.set_row(0, 28)
    more = f"The first {MOST_ROWS} dimensions of samples." if len(rows) >= MOST_ROWS else ""
    notes = [*_NOTES, *filter(None, (extent.note, more))]
    for place, note in enumerate(notes, start=1):
        sheet.write_string(place, 0, note, book.format("quiet"))
    columns = [*_COLUMNS[:3], _DEVIATIONS, *_COLUMNS[3:]] if any(row.are_deviations for row in rows) else _COLUMNS
    pair_columns = [*_PAIRS[:3], _PAIRS[2], *_PAIRS[3:]] if len(columns) > len(_COLUMNS) else _PAIRS
    widths = [column.width for column in columns]
    for place, width in enumerate(widths):
        sheet.set_column(place, place, width)
    header = len(notes) + 2
    _write_table(book, sheet, header, columns, rows)
    if pairs:
        below = header + len(rows) + 2
        sheet.write_string(below, 0, _PAIRS_NOTE, book.format("quiet"))
        _write_table(book, sheet, below + 1, pair_columns, pairs)
    print_readably(sheet, widths, least=SMALL)
    sheet.freeze_panes(header + 1, 2)
    sheet.repeat_rows(header)


def _write_table(
    book: Book, sheet: Any, header: int, columns: Sequence[_Column], rows: Iterable[SampleUse | MeasuredPair]
) -> None:
    """Write headings and rows of a table; a blank for none."""
    sheet.set_row(header, 32)
    for place, column in enumerate(columns):
        sheet.write_string(header, place, column.heading, book.format("header"))
    for number, row in enumerate(rows, start=header + 1):
        for place, column in enumerate(columns):
            value = column.value(row)
            if isinstance(value, str):
                sheet.write_string(number, place, value, book.format("indented" if place > 1 else "text"))
            elif value is not None:
                sheet.write_number(number, place, value, book.format("text", column.code(row)))
