"""Names as people spell them: what is the same, what is near, what can only be one slip."""

from __future__ import annotations

import pytest

from flexlash.schema.spellings import closest, misspelt, spelt_alike, suggested, words

CHOICES = ["cup", "hat", "cylinder"]
DIMENSIONS = ["torque", "bore_diameter", "cylinder_length", "rim_length", "wall_thickness", "rim_thickness"]
DIMENSIONS += ["disk_thickness", "mean_radius"]
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
    """A long name with one slip can be fixed; a short one, another number, or one near two names cannot."""
    assert misspelt(text, spelt_alike(names)) == meant


@pytest.mark.parametrize(
    ("text", "names", "cutoff", "meant"),
    [
        ("bore", DIMENSIONS, 0.6, "bore_diameter"),
        ("Bore", DIMENSIONS, 0.6, "bore_diameter"),
        ("wall", DIMENSIONS, 0.6, "wall_thickness"),
        ("length", DIMENSIONS, 0.6, "cylinder_length or rim_length"),
        ("thickness", DIMENSIONS, 0.6, ""),
        ("wall_th", DIMENSIONS, 0.6, "wall_thickness"),
        ("torqe", DIMENSIONS, 0.6, "torque"),
        ("m", DIMENSIONS, 0.6, ""),
        ("", DIMENSIONS, 0.6, ""),
        ("Stahl", ["Ti-6Al-4V", *STEELS], 0.7, ""),
        ("Steel", ["Ti-6Al-4V", *STEELS], 0.7, ""),
        ("42CrMo", STEELS, 0.7, "42CrMo4"),
        ("4340", ["AISI 4340 (aged)", "AISI 4130"], 0.7, "AISI 4340 (aged)"),
        ("20Cr2Ni5", STEELS, 0.7, "20Cr2Ni4"),
    ],
)
def test_what_is_suggested(text, names, cutoff, meant):
    """The name with that word or beginning is suggested before one of like letters, two at most, none by chance."""
    assert suggested(text, names, cutoff) == meant


def test_words_of_a_header():
    """Symbols of one letter, units apart, signs and case do not count as words."""
    assert words("Disk inner radius r_ci") == ["disk", "inner", "radius", "ci"]
    assert words("  LÄNGE-l ") == ["länge"]
