"""The version of a template is found wherever it is written."""

from __future__ import annotations

import pytest

from flexlash.reading.raw import RawSheet, Submission
from flexlash.validation.template_versions import template_version


def _submission(version, visible=None, *, sheet="Variants", row=1, kind="workbook"):
    rows = {row: {10: visible}} if visible else {}
    return Submission(
        name="a.xlsx", sha256="", kind=kind, template_version=version, sheets={sheet: RawSheet(name=sheet, rows=rows)}
    )


@pytest.mark.parametrize(
    ("submission", "version"),
    [
        (_submission("1"), 1),
        (_submission("2.0"), 2),
        (_submission(" 12 "), 12),
        (_submission(""), None),
        (_submission("x"), None),
        (_submission("0"), None),
        (_submission("-1"), None),
        (_submission("1.5"), None),
        (_submission("²"), None),
        (_submission("9" * 9999), 999_999_999),
        (_submission("", "Template version 1"), 1),
        (_submission("x", "Template version 3"), 3),
        (_submission("2", "Template version 1"), 2),
        (_submission("", " template VERSION 1 "), 1),
        (_submission("", "Template version one"), None),
        (_submission("", "made from Template version 1"), None),
        (_submission("", "Template version 1", sheet="variants "), 1),
        (_submission("", "Template version 1", sheet="Notes"), None),
        (_submission("", "Template version 1", row=15), 1),
        (_submission("", "Template version 1", row=16), None),
        (_submission("", "Template version 1", kind="csv"), None),
        (_submission("", 1.0), None),
    ],
)
def test_where_the_version_stands(submission, version):
    """The document property counts, then the visible cell at the top of Variants; what is no version is ignored."""
    assert template_version(submission) == version
