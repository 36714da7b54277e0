"""A table read at once, and in excerpts: what comes of both, in forms that can be compared."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import polars as pl

from flexlash.analysis.examination import examined
from flexlash.analysis.options import Options
from flexlash.analysis.run_result import outcome_of
from flexlash.reading import survey as surveys
from flexlash.reading import survey_parquet
from flexlash.reading.excerpt import excerpt
from flexlash.reading.products import Companions
from flexlash.reading.read import Source
from flexlash.reading.refusal import Refusal
from flexlash.reading.survey import survey
from flexlash.report.results_table import results_table
from flexlash.validation.blocking_errors import waiting_rows, without_waiting
from flexlash.validation.consolidation import shared_by_excerpts

__all__ = ["at_once", "in_excerpts"]

_OF_UNITS = frozenset({"I515", "E219"})
"""What is told of a row of units, which every excerpt holds."""


def at_once(path, **options):
    """Return Results, findings at rows and other findings of a table read as one."""
    chosen = Options.of("check()", options)
    try:
        source = replace(Source.at(path, chosen.limits), companions=Companions())
    except Refusal as refusal:
        return refusal.code
    return _merged([outcome_of(examined(source, chosen))])


def in_excerpts(path, rows, block=1000, **options):
    """Return the same of a table surveyed in blocks and read in excerpts of so many rows."""
    chosen = Options.of("check()", options)
    before, surveys._ROWS = surveys._ROWS, block
    slices, survey_parquet._SLICE = survey_parquet._SLICE, block
    try:
        surveyed = survey(path, chosen.limits)
        excerpts = [excerpt(path, surveyed, chunk) for chunk in surveyed.chunks(rows)]
    except Refusal as refusal:
        return refusal.code
    finally:
        surveys._ROWS, survey_parquet._SLICE = before, slices
    sources = [Source(name=surveyed.name, data=data, companions=Companions()) for data in excerpts]
    return _merged([outcome_of(examined(source, chosen)) for source in sources])


def _merged(outcomes):
    """Return what the outcomes of excerpts in their order come to; of one, what it is."""
    first = outcomes[0]
    if first.validated is None:
        return first.findings[0].code
    results = pl.concat([results_table(outcome) for outcome in outcomes])
    own, shared = [], []
    for outcome in outcomes:
        table = outcome.validated.table
        waiting = waiting_rows(table, outcome.blocked) if table else []
        for found in without_waiting(outcome.findings, "Variants", waiting):
            if table and found.sheet == table.sheet and found.row > table.last_head_row and found.code not in _OF_UNITS:
                own.append(found)
            else:
                shared = shared_by_excerpts(shared, [found])
    submission = first.submission
    facts = (submission.name, submission.kind, submission.sha256, submission.delimiter, submission.encoding)
    return results, Counter(own), shared, facts, sum(len(one.computed) for one in outcomes)
