"""Every finding is explained in the same words everywhere, with a message that really came out."""

from __future__ import annotations

import pytest
import regenerate
from finding_examples import PENDING
from grids import for_each

from flexlash.schema.finding_catalogue import CATALOGUE
from flexlash.schema.finding_explanations import explanation_of, findings_page, real_examples


def test_every_code_has_a_real_example():
    """Each code of the catalogue comes out of a submission of the tests, but for those that wait for one."""
    assert sorted(set(CATALOGUE) - set(real_examples()) - PENDING) == []
    assert sorted(set(real_examples()) - set(CATALOGUE)) == []
    assert sorted(set(real_examples()) & PENDING) == []


@for_each("code", sorted(set(CATALOGUE) - PENDING))
def test_examples_are_short_enough(code):
    """A real message, its question included, has few words and no gap."""
    words = [word for word in real_examples()[code].split() if any(map(str.isalnum, word))]
    assert len(words) <= 25 + 5 * ("did you mean" in real_examples()[code])
    assert "  " not in real_examples()[code]


def test_an_explanation_has_its_parts():
    """Title, message in general, meaning, fix and example follow each other."""
    assert list(explanation_of("E303", {"E303": "Variants!J18 …"}).lines()) == [
        "E303 error: hub outside the disk",
        "",
        "Sheet!Cell Column = … mm: less than the disk's outer radius … mm is required.",
        "The disk reaches from its inner to its outer radius. A blank outer radius is the mean radius.",
        "",
        "Fix: Check for a diameter entered as a radius.",
        "Example: Variants!J18 …",
    ]


def test_an_unknown_code_has_no_explanation():
    """A code outside the catalogue is a fault of the program that asks."""
    with pytest.raises(KeyError):
        explanation_of("E999")


@for_each("code", CATALOGUE)
def test_the_page_says_what_the_command_says(code):
    """Pattern, meaning, fix and example of docs/findings.md are those of `flexlash explain`."""
    page = (regenerate.ROOT / "docs" / "findings.md").read_text(encoding="utf-8")
    one = explanation_of(code)
    section = page.partition(f"### {code} ")[2].partition("\n#")[0]
    assert section.startswith(one.title)
    for part in (one.pattern, one.meaning, one.fix, one.example):
        assert part in section


def test_the_page_has_every_code_once():
    """The page has one section for each code, in the order of the catalogue."""
    page = findings_page({})
    assert [line[4:8] for line in page.splitlines() if line.startswith("### ")] == list(CATALOGUE)
    assert "{" not in page
