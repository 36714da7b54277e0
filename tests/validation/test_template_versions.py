"""The version of a template is found wherever it is written, and what later ones added is told once."""

from __future__ import annotations

import pytest
from old_templates import LABELS, old_workbook, rows_of

from flexlash.pipeline import check
from flexlash.reading.raw import RawSheet, Submission
from flexlash.schema.columns import ENTRY_SHEETS, columns_of
from flexlash.validation.template_versions import TEMPLATE_VERSION, template_version

ADDED = "Disk thickness exponent, Disk cone angle, Load inertia"


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


def test_every_column_says_its_version():
    """No column came with a version that does not exist yet, and version 2 brought three."""
    assert all(1 <= column.since <= TEMPLATE_VERSION for columns in ENTRY_SHEETS.values() for column in columns)
    assert ", ".join(one.plain_name for one in columns_of("Variants").values() if one.since == 2) == ADDED


@pytest.mark.parametrize(
    ("version", "extra", "told"),
    [
        (1, (), ADDED),
        (1, ("Load inertia J [kg·m²]",), "Disk thickness exponent, Disk cone angle"),
        (1, tuple(one.label for one in columns_of("Variants").values() if one.since == 2), None),
        (2, (), None),
        (None, (), None),
    ],
)
def test_an_older_template_is_told_what_it_lacks(tmp_path, sound, version, extra, told):
    """A version 1 gets one information that names the columns it does not have; without a version nothing is said."""
    path = tmp_path / "old.xlsx"
    headers = [*LABELS["Variants"], *extra]
    old_workbook(rows_of("Variants", [sound]), version=version, headers=headers).save(path)
    outcome = check(path)
    messages = [one.message for one in outcome.findings if one.code == "I512"]
    expected = f"old.xlsx was made from template version 1; version 2 adds {told}."
    assert messages == ([expected] if told else [])
    assert outcome.exit_code == 0
