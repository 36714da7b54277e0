"""From bytes to nominal numbers: read, validate, set the limits, compute at the entered dimensions.

All of this is done in the limited process, since nothing of it is the program's own before it was judged. What follows
validation, the nominal numbers, grows with the number of sound rows alone and has no limits.
"""

from __future__ import annotations

import hashlib
import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from flexlash.analysis.computed import ComputedRows, Nominal
from flexlash.analysis.options import Options
from flexlash.reading.limited_process import ask
from flexlash.reading.products import Companions, require_submission
from flexlash.reading.raw import Submission
from flexlash.reading.read import ReadReport, Source, limits_of_reports, of_table, report_of, submission_of, table_of
from flexlash.reading.refusal import Refusal
from flexlash.schema.findings import Finding, finding, readable
from flexlash.schema.variant import OVERRIDDEN, Settings
from flexlash.validation.validated import Validated

__all__ = ["Examined", "examined", "opened", "tables_beside"]


@dataclass(frozen=True, kw_only=True)
class Examined:
    """A submission with what is wrong with it, and the nominal numbers of its sound rows.

    `refusal` says why a file is no readable submission, or is skipped; then there is nothing else. `settings` are those
    that hold, the caller's before the submission's; `options` those of an earlier run where the caller's are open.
    """

    submission: Submission
    refusal: Finding | None = None
    settings: Settings = field(default_factory=Settings)
    options: Options = field(default_factory=Options)
    validated: Validated | None = None
    nominal: Nominal = field(default_factory=Nominal)
    processor_seconds: float = 0.0


def opened(given: str | Path | Source | ReadReport, options: Options) -> Source | ReadReport | Refusal:
    """Return a submission's bytes, or why its name or size alone refuse it; raise OSError when it cannot be opened."""
    if isinstance(given, Source | ReadReport):
        return given
    try:
        path = Path(given)
        return replace(Source.at(path, options.limits), companions=Companions.of(path, [*map(Path, options.given)]))
    except Refusal as refusal:
        return Refusal(refusal.code, **{"file": readable(Path(given).name), **refusal.facts})


def examined(
    source: Source | ReadReport | Refusal,
    options: Options,
    tables: Mapping[str, Source] | None = None,
    *,
    numbers: bool = True,
) -> Examined:
    """Return what the limited process finds in a submission, with its bytes; `numbers` says whether it is computed.

    `tables` are those beside it, by the sheet that each replaces; those that the options name where they are None.
    """
    if isinstance(source, Refusal):
        return _refused(str(source.facts["file"]), b"", source)
    limits = limits_of_reports(options.limits) if options.from_report else options.limits
    try:
        asked = replace(options, progress=None, marked_copy=None)
        beside = tables_beside(options) if tables is None else tables
        found = ask(_validated, limits, source, beside, asked, then=_with_numbers if numbers else None)
    except Refusal as refusal:
        return _refused(source.name, source.data, refusal)
    return replace(found, submission=replace(found.submission, data=source.data))


def tables_beside(options: Options) -> dict[str, Source]:
    """Return the tables given beside a submission by the sheet that each replaces."""
    found = {}
    for name, path in options.tables.items():
        try:
            found[name] = Source.at(path, options.limits)
        except Refusal as refusal:
            raise of_table(refusal, readable(path.name)) from refusal
    return found


def _validated(given: Source | ReadReport, tables: Mapping[str, Source], options: Options) -> Examined:
    """Return what a submission holds and what is wrong with it; nothing is computed yet.

    `tables` stand beside it, by the sheet that each replaces. Raises Refusal when the file is no readable submission.
    """
    from flexlash.validation.validate import validate

    start = time.process_time()
    submission = _submission(given, options)
    options = options.completed(submission.run_with)
    if isinstance(given, Source) and given.companions is not None:
        require_submission(submission, given.companions, marked_copies=options.marked_copies)
    beside = {name: table_of(table, name, options.limits) for name, table in tables.items()}
    submission = replace(submission, sheets=submission.sheets | beside)
    validated = validate(submission, options.limits)
    overrides = {name: given for name in OVERRIDDEN if (given := getattr(options, name)) is not None}
    return Examined(
        submission=submission,
        settings=replace(validated.settings, **overrides),
        options=options,
        validated=validated,
        processor_seconds=time.process_time() - start,
    )


def _with_numbers(found: Examined) -> Examined:
    """Return an examined submission with limits and nominal numbers of its sound rows."""
    from flexlash.analysis.assessment import assess

    if found.validated is None:
        return found
    nominal = assess(found.validated, found.settings)
    if found.options.strict and len(nominal.computed) < len(found.validated.submitted):
        nominal = replace(nominal, computed=ComputedRows())
    return replace(found, nominal=nominal)


def _submission(given: Source | ReadReport, options: Options) -> Submission:
    """Return the submission that a file is, or that a report carries."""
    if isinstance(given, ReadReport):
        return given.submission
    return report_of(given, options.limits).submission if options.from_report else submission_of(given, options.limits)


def _refused(name: str, data: bytes, refusal: Refusal) -> Examined:
    """Return a file that is no readable submission, or that is skipped, with the finding that says why."""
    digest = hashlib.sha256(data).hexdigest() if data else ""
    found = finding(refusal.code, **{"file": name, **refusal.facts})
    return Examined(submission=Submission(name=name, sha256=digest, kind="refused"), refusal=found)
