"""A difference in words: short, in the reader's order, the most important line last."""

from __future__ import annotations

import pytest

from flexlash.comparison.changed_value import Change
from flexlash.comparison.difference import Difference, Differing
from flexlash.comparison.difference_lines import comparison_line, difference_lines
from flexlash.comparison.sides import Name, Side
from flexlash.reading.raw import Submission
from flexlash.validation.validated import Validated


def _side(file, *, is_report=True, version="1", **run_with):
    submission = Submission(name=file, sha256="", kind="csv", run_with=run_with if is_report else None)
    results = {} if is_report else None
    return Side(file=file, submission=submission, validated=Validated(), results=results, version=version)


def _lines(variants=(), common=3, removed=(), added=(), *, reports=True, new=None, **options):
    found = Difference(
        old=_side("a.xlsx", is_report=reports),
        new=new or _side("b.xlsx", is_report=reports),
        common=common,
        variants=list(variants),
        removed=[Name(text=name) for name in removed],
        added=[Name(text=name) for name in added],
    )
    return list(difference_lines(found, **options))


def _change(key, old, new, sheet="Variants", **rest):
    return Change(sheet=sheet, key=key, label=rest.pop("label", key), old=old, new=new, **rest)


WORDS = [
    (_change("wall_thickness_mm", 1.6, 1.7, label="Wall thickness Δ", unit="mm"),
     "Wall thickness Δ: 1.6 → 1.7 mm (+6.25 %)"),
    (_change("rim_length_mm", None, 20.0, unit="mm"), "rim_length_mm: – → 20 mm"),
    (_change("torque_Nm", 800.0, 800.0000001, unit="N·m"), "torque_Nm: 800 → 800.0000001 N·m (+1.25e−08 %)"),
    (_change("notes", "old\n", "\x1b[31mnew"), "notes: old· → ·[31mnew"),
    (_change("probability_over_limit", 0.412, 0.38), "probability_over_limit: 41.2 % → 38 %"),
    (_change("probability_over_limit", 2e-6, 1e-6), "probability_over_limit: 2 ppm → 1 ppm"),
    (_change("lots_failing", 1.15e-4, 2e-4), "lots_failing: 115 ppm → 200 ppm"),
    (_change("main_contributor_share", 0.0, 4e-9), "main_contributor_share: 0 ppb → 4 ppb"),
    (_change("main_contributor", "wall_thickness", "youngs_modulus"),
     "main_contributor: Wall thickness → Young's modulus"),
    (_change("p97_5_arcmin", 3.6, 3.5, unit="arcmin"), "p97_5_arcmin: 3.6 → 3.5 arcmin (−2.78 %)"),
]  # fmt: skip


@pytest.mark.parametrize(("change", "words"), WORDS)
def test_a_change_in_words(change, words):
    """A change names old and new with as few digits as tell them apart, its unit, and per cent where that helps."""
    lines = _lines([Differing(name=Name(text="C-1"), entered=[change])])
    assert lines[0] == "1 of 3 variants differs, 2 are equal."
    assert lines[1:] == ["C-1", f"    {words}", "1 of 3 variants differs: C-1 (1 in inputs)."]


def test_results_show_the_verdict_and_count_the_rest():
    """Without --all, columns that no verdict rests on are counted; a crossed limit is said beside P97.5."""
    results = [
        _change("p97_5_arcmin", 3.6, 3.8, unit="arcmin"),
        *(_change(f"x{place}", 1.0, 2.0) for place in range(4)),
    ]
    one = Differing(name=Name(text="C-1"), results=results, limit="over")
    short, long = _lines([one]), _lines([one], every=True)
    assert short[2:4] == ["    p97_5_arcmin: 3.6 → 3.8 arcmin (+5.56 %), now over its limit",
                          "    4 further columns of Results (--all)"]  # fmt: skip
    assert len(long) == 8
    assert short[-1] == long[-1] == "1 of 3 variants differs: C-1 (1 in results)."


def test_what_many_share_is_told_once():
    """A change of a table is one line with who uses it; variants without a change of their own get none."""
    steel = _change(
        "youngs_modulus", 210.0, 206.0, "Materials", owner="20Cr2Ni4", label="Young's modulus E", unit="GPa"
    )
    seed = _change("seed", 0, 7, "Settings")
    variants = [Differing(name=Name(text=f"C-{place}"), used=[steel, seed][: 2 - place % 2]) for place in range(3)]
    assert _lines(variants) == [
        "3 of 3 variants differ, 0 are equal.",
        "Material 20Cr2Ni4, Young's modulus E: 210 → 206 GPa (−1.9 %), used by all 3 variants",
        "Settings, seed: 0 → 7, used by C-0, C-2",
        "3 of 3 variants differ: C-0, C-1, C-2 (3 in inputs).",
    ]


def test_many_variants_are_told_worst_first_and_cut():
    """Those whose limit was crossed come first, then the greatest changes; beyond twenty they are counted."""
    variants = [
        Differing(name=Name(text=f"C-{place}"), results=[_change("p97_5_arcmin", 1.0, 1.0 + place / 100)])
        for place in range(1, 31)
    ]
    crossed = Differing(name=Name(text="crossed"), results=[_change("p97_5_arcmin", 1.0, 1.001)], limit="over")
    lines = _lines([*variants, crossed], common=40)
    assert lines[0] == "31 of 40 variants differ, 9 are equal."
    assert lines[1] == "crossed"
    assert lines[3] == "C-30"
    assert lines[-2] == "… and 11 more variants (--all lists all)"
    assert lines[-1] == "31 of 40 variants differ: crossed, C-30, C-29 and 28 more (31 in results)."
    assert len(_lines([*variants, crossed], common=40, every=True)) == 64


LAST = [
    ({}, "No difference in inputs or results."),
    ({"reports": False}, "No difference in inputs."),
    ({"removed": ["x"], "added": ["y", "z"]}, "None of 3 common variants differs; 1 removed, 2 added."),
]


@pytest.mark.parametrize(("facts", "line"), LAST)
def test_the_last_line_says_the_most(facts, line):
    """The last line alone says whether anything differs."""
    assert _lines(**facts)[-1] == line


def test_rows_of_one_side_are_named():
    """Rows that only one side has are listed under its name."""
    lines = _lines(removed=["x"], added=[f"y{place}" for place in range(25)])
    assert lines[0] == "Only in a.xlsx: x"
    assert lines[1].startswith("Only in b.xlsx: y0, y1,")
    assert lines[1].endswith("y19 and 5 more")


def test_long_and_doubled_names_are_short():
    """Names are cut to thirty characters; rows of one name, and without one, can be told apart."""
    names = [Name(text="n" * 99), Name(text="a", occurrence=2), Name(text="")]
    lines = _lines([Differing(name=name, entered=[_change("x", "a", "b")]) for name in names])
    assert lines[1:7:2] == ["n" * 29 + "…", "a (row 2 of this name)", "(row without a name)"]


def test_whether_the_numbers_are_the_same():
    """One line says that all numbers are those of the given report, or how many are not."""
    assert comparison_line(0, 670, "r.xlsx") == "Every number of Results equals that of r.xlsx (670 compared)."
    assert comparison_line(3, 670, "r.xlsx").startswith("3 of 670 numbers of Results differ from r.xlsx")


SEED = _change("seed", 0, 7, "Settings")
MOVED = _change("p97_5_arcmin", 3.6, 3.601, unit="arcmin")


def test_what_another_seed_changes_is_one_line():
    """Results that are the same within their errors are one line with the rule; --all tells them all the same."""
    within = [Differing(name=Name(text=f"C-{n}"), used=[SEED], results=[MOVED], within_error=True) for n in range(3)]
    assert _lines(within) == [
        "0 of 3 variants differ beyond the error of the calculation, 3 within it.",
        "Settings, seed: 0 → 7, used by all 3 variants",
        "Within the error of the calculation (4 combined standard errors): all 3 variants",
        "No difference beyond the error of the calculation.",
    ]
    assert "    p97_5_arcmin: 3.6 → 3.601 arcmin (+0.0278 %)" in _lines(within, every=True)
    beyond = Differing(name=Name(text="far"), used=[SEED], results=[MOVED])
    lines = _lines([*within, beyond], common=5)
    assert lines[0] == "1 of 5 variants differs beyond the error of the calculation, 3 within it, 1 is equal."
    assert lines[-1] == "1 of 5 variants differs: far (1 in inputs, 1 in results)."
    gone = _lines(within, removed=["x"])
    assert gone[-1] == "None of 3 common variants differs beyond the error of the calculation; 1 removed."


MADE = {
    "another version": (
        _side("b.xlsx", version="2"),
        ["a.xlsx was made by flexlash 1, b.xlsx by flexlash 2."],
    ),
    "cross-check": (_side("b.xlsx", cross_check=True), ["Only b.xlsx was made with --cross-check."]),
    "elasticity, of one name": (_side("a.xlsx", elasticity=True), ["Only a.xlsx (B) was made with --elasticity."]),
    "a submission": (_side("b.xlsx", is_report=False, version=""), []),
    "alike": (_side("b.xlsx", cross_check=False), []),
}


@pytest.mark.parametrize("what", MADE)
def test_how_two_reports_were_made(what):
    """Other versions and switches of two reports are told in a line each, whether or not a variant differs."""
    new, lines = MADE[what]
    assert _lines(new=new)[:-1] == lines
