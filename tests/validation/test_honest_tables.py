"""A common fault costs a large table no more than its rows: a name is looked up once, and no more than can be paid."""

import pytest

from flexlash.pipeline import check
from flexlash.schema import spellings
from flexlash.validation import meant_names


@pytest.fixture
def asked(monkeypatch):
    """Return the texts for which a near name was sought while checking."""
    texts = []
    sought = meant_names.suggested

    def counted(text, *rest):
        texts.append(text)
        return sought(text, *rest)

    monkeypatch.setattr(meant_names, "suggested", counted)
    return texts


@pytest.mark.slow
def test_each_unknown_name_is_looked_up_once(asked, table, sound):
    """Three hundred rows with three unknown materials and two unknown classes ask five times."""
    rows = [
        {**sound, "variant": f"V{number}", "material": f"Stahl {number % 3}", "tolerance_class": f"grob {number % 2}"}
        for number in range(300)
    ]
    outcome = check(table(rows))
    assert outcome.counts["errors"] == 600
    assert sorted(asked) == ["Stahl 0", "Stahl 1", "Stahl 2", "grob 0", "grob 1"]


def test_names_in_other_case_are_not_looked_up(asked, table, sound):
    """Another letter case is found by its plain spelling, without a comparison."""
    rows = [{**sound, "variant": f"V{number}", "material": sound["material"].upper()} for number in range(50)]
    assert check(table(rows)).counts["computed"] == 50
    assert asked == []


def test_comparisons_have_an_end(asked, table, sound, monkeypatch):
    """Of more names than can be compared with all known ones none gets a suggestion, and each unknown its error."""
    monkeypatch.setattr(spellings, "_COMPARISONS", 1)
    outcome = check(table([{**sound, "variant": f"V{number}", "material": f"Stahl {number}"} for number in range(9)]))
    assert outcome.counts["errors"] == 9
    assert asked == []


def test_how_much_is_compared():
    """As many texts are compared as names allow, at least one."""
    assert spellings.affordable(["a"] * 1000) == spellings._COMPARISONS // 1000
    assert spellings.affordable([]) == spellings._COMPARISONS
    assert spellings.affordable(range(2 * spellings._COMPARISONS)) == 1
