"""Names as people spell them: what is the same, what is near, what can only be one slip."""

from __future__ import annotations

import pytest

from flexlash.submission.spellings import closest, misspelt, spelt_alike

CHOICES = ["cup", "hat", "cylinder"]
STEELS = ["20Cr2Ni4", "40CrNiMoA", "42CrMo4", "30CrMnSiA"]


@pytest.mark.parametrize(
    ("text", "names", "meant"),
    [
        ("cop", CHOICES, "cup"),
        ("cap", CHOICES, "cup"),
        ("cups", CHOICES, "cup"),
        ("cylindre", CHOICES, "cylinder"),
        ("zylinder", CHOICES, "cylinder"),
        ("tube", CHOICES, ""),
        ("x", CHOICES, ""),
        ("42CrMo", STEELS, "42CrMo4"),
        ("aluminium", STEELS, ""),
    ],
)
def test_the_nearest_name(text, names, meant):
    """One letter of a short word may differ; a word that resembles none gets no suggestion."""
    assert closest(text, names) == meant


@pytest.mark.parametrize(
    ("text", "names", "meant"),
    [
        ("standart", ["standard", "fine"], "standard"),
        ("Standrad", ["standard", "fine"], "standard"),
        ("cylindre", CHOICES, "cylinder"),
        ("truncated normel", ["normal", "truncated normal", "uniform"], "truncated normal"),
        ("40CrNiMo", STEELS, "40CrNiMoA"),
        ("cop", CHOICES, None),
        ("20Cr2Ni5", STEELS, None),
        ("42CrMo", STEELS, None),
        ("class fine", ["class fino", "class finer"], None),
        ("x", [], None),
    ],
)
def test_what_can_only_be_a_slip(text, names, meant):
    """A long name with one slip can be mended; a short one, another number, or one near two names cannot."""
    assert misspelt(text, spelt_alike(names)) == meant
