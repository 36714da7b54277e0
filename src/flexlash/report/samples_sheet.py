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
    "They are those of a normal process; below p = 0.05 Anderson and Darling's test says that it hardly is one.",
    "Cp and Cpk compare the process with the limits of the class that uses the sample. Deviations are what was "
    "measured above the entered value, and so are their limits.",
)
_PAIRS_NOTE = (
    "Correlation of dimensions measured on the same parts: Pearson's of the values, or of the normal scores of their "
    "ranks where a class takes one of them as measured; 95 % interval by Fisher's transformation."
)
_WIDTH, _FIRST = 11.0, 24.0


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


_COLUMNS = (
    _Column("Sample", lambda row: row.sample, width=_FIRST),
    _Column("Dimension", lambda row: row.column.plain_name, width=_FIRST),
    _Column("Unit", lambda row: row.column.unit, width=7.0),
    _Column("Measured as", lambda row: "deviation" if row.are_deviations else "value"),
    _Column("Parts n", lambda row: row.count, lambda _: "count", 8.0),
    _Column("Mean", lambda row: _told(row, "mean"), _mean_code),
    _Column("from", lambda row: _told(row, "mean_low"), _mean_code),
    _Column("to", lambda row: _told(row, "mean_high"), _mean_code),
    _Column("s", lambda row: _told(row, "sd"), _sd_code),
    _Column("from", lambda row: _told(row, "sd_low"), _sd_code),
    _Column("to", lambda row: _told(row, "sd_high"), _sd_code),
    _Column("Least", lambda row: row.least),
    _Column("Greatest", lambda row: row.greatest),
    _Column("Lower limit", lambda row: row.low),
    _Column("Upper limit", lambda row: row.high),
    _Column("Cp", lambda row: _index(row, "cp"), _index_code, 8.0),
    _Column("from", lambda row: _index(row, "cp_low"), _index_code, 8.0),
    _Column("to", lambda row: _index(row, "cp_high"), _index_code, 8.0),
    _Column("Cpk", lambda row: _index(row, "cpk"), _index_code, 8.0),
    _Column("from", lambda row: _index(row, "cpk_low"), _index_code, 8.0),
    _Column("to", lambda row: _index(row, "cpk_high"), _index_code, 8.0),
    _Column("Anderson–Darling p", lambda row: _told(row, "normality"), _p_code),
    _Column("Taken as", lambda row: row.distribution or None, width=17.0),
    _Column("Used by", lambda row: row.used_by or "no class", width=34.0),
    _Column("Variants", lambda row: row.variants, lambda _: "count", 9.0),
)
_PAIRS = (
    _Column("Sample", lambda row: row.sample),
    _Column("Dimension", lambda row: row.first.plain_name),
    _Column("", lambda _: None),
    _Column("and", lambda row: row.second.plain_name),
    _Column("Parts n", lambda row: row.correlation.count, lambda _: "count"),
    _Column("Correlation", lambda row: row.correlation.correlation, _index_code),
    _Column("from", lambda row: row.correlation.low, _index_code),
    _Column("to", lambda row: row.correlation.high, _index_code),
    _Column("of", lambda row: "normal scores" if row.by_scores else "values"),
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
    sheet.write_string(0, 0, "What the measured parts tell", book.format("title"))
    sheet.set_row(0, 28)
    more = f"The first {MOST_ROWS} dimensions of samples." if len(rows) >= MOST_ROWS else ""
    notes = [*_NOTES, *filter(None, (extent.note, more))]
    for place, note in enumerate(notes, start=1):
        sheet.write_string(place, 0, note, book.format("quiet"))
    widths = [column.width for column in _COLUMNS]
    for place, width in enumerate(widths):
        sheet.set_column(place, place, width)
    header = len(notes) + 2
    _write_table(book, sheet, header, _COLUMNS, rows)
    if pairs:
        below = header + len(rows) + 2
        sheet.write_string(below, 0, _PAIRS_NOTE, book.format("quiet"))
        _write_table(book, sheet, below + 1, _PAIRS, pairs)
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
                sheet.write_string(number, place, value, book.format("text"))
            elif value is not None:
                sheet.write_number(number, place, value, book.format("text", column.code(row)))
