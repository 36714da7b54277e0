"""A submission → the version of the template that it was made from, and the refusal of one that is newer."""

from __future__ import annotations

import re

from flexlash.reading.raw import Submission
from flexlash.reading.refusal import Refusal
from flexlash.schema.findings import shown
from flexlash.validation.entry_sheets import sheet_names

__all__ = ["TEMPLATE_VERSION", "check_version", "template_version"]

TEMPLATE_VERSION = 7
"""The version that this program writes. It rises whenever the template changes, and never goes down."""

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
        for row, cells in (submission.sheets[name].rows.items() if name else ())
        if row <= _TOP and submission.kind == "workbook"
        for cell in cells.values()
        if isinstance(cell, str)
    ]


def check_version(submission: Submission) -> None:
    """Refuse a template of a later version."""
    version = template_version(submission)
    if version is not None and version > TEMPLATE_VERSION:
        raise Refusal("E116", found=shown(version), known=TEMPLATE_VERSION)
