"""A file read as `check` would read it, for tests that look at the cells."""

from dataclasses import replace

from flexlash.reading.limited_process import ask
from flexlash.reading.read import Source, submission_of
from flexlash.reading.reading_limits import ReadingLimits


def read_submission(path, limits=None):
    """Return the cells of a workbook, text table or Parquet file, with its bytes."""
    limits = limits or ReadingLimits()
    source = Source.at(path, limits)
    return replace(ask(submission_of, limits, source, limits), data=source.data)
