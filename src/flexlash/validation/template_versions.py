"""Which version of the template a submission was made from, and what later versions added."""

from __future__ import annotations

import re
from collections.abc import Mapping

from flexlash.reading.raw import Submission
from flexlash.reading.refusal import Refusal
from flexlash.schema.columns import ENTRY_SHEETS
from flexlash.schema.findings import shown
from flexlash.validation.entry_sheets import sheet_names
from flexlash.validation.ledger import Ledger
from flexlash.validation.validated import Heading

__all__ = ["TEMPLATE_VERSION", "check_version", "tell_additions", "template_version"]

TEMPLATE_VERSION = 2
"""The version that this program writes; the columns say with which version each of them came."""

_NUMBER = re.compile(r"0*([1-9]\d*)(?:\.0*)?", re.ASCII)
_VISIBLE = re.compile(rf"\s*template version ({_NUMBER.pattern})\s*", re.ASCII | re.IGNORECASE)
_TOP = 15
_DIGITS = 9


def template_version(submission: Submission) -> int | None:
    """Return the version of the template: its document property, else its visible cell, else None.

    Some programs save the property as a decimal number, others drop it.
    """
    texts = [match[1] for text in _visible_texts(submission) if (match := _VISIBLE.fullmatch(text))]
    for text in (submission.template_version.strip(), *texts):
        if match := _NUMBER.fullmatch(text):
            return int(match[1][:_DIGITS])
    return None


def _visible_texts(submission: Submission) -> list[str]:
    """Return the texts at the top of Variants."""
    name = sheet_names(submission).get("Variants", "")
    return [
        cell
        for number, cells in (submission.sheets[name].rows.items() if name else ())
        if number <= _TOP and submission.kind == "workbook"
        for cell in cells.values()
        if isinstance(cell, str)
    ]


def check_version(submission: Submission) -> None:
    """Refuse a template of a later version."""
    version = template_version(submission)
    if version is not None and version > TEMPLATE_VERSION:
        raise Refusal("E116", found=shown(version), known=TEMPLATE_VERSION)


def tell_additions(submission: Submission, headings: Mapping[str, Heading], ledger: Ledger) -> None:
    """Tell which columns the template of a submission did not have yet."""
    version = template_version(submission)
    if version is None or version >= TEMPLATE_VERSION:
        return
    added = [
        column.plain_name
        for sheet, heading in headings.items()
        for column in ENTRY_SHEETS[sheet]
        if column.since > version and column.key not in {*heading.places, *heading.doubtful.values()}
    ]
    if added:
        ledger.add("I512", found=version, known=TEMPLATE_VERSION, added=", ".join(added))
