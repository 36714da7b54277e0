"""Rows that are no entries of their table: totals, means, notes, legends; one finding a row."""

import pytest

from flexlash.pipeline import check
from flexlash.schema.columns import columns_of

KEYS = ("variant", "material", "torque_Nm", "cylinder_length_mm", "mean_radius_mm", "wall_thickness_mm", "notes")
HEADERS = [columns_of("Variants")[key].label for key in KEYS] + ["Disk inner radius r_ci [mm]", "Customer"]
FIRST, SECOND = (["H1", "20Cr2Ni4", 800, 160, 80, 1.6, None, 40], ["H2", "20Cr2Ni4", 900, 160, 80, 1.6, None, 40])


def _checked(book, *rows, **sheets):
    """Return the outcome of two sound rows and others, and what was found below these."""
    outcome = check(book({"Variants": [HEADERS, FIRST, SECOND, *rows], **sheets}))
    return outcome, [(one.code, one.cell) for one in outcome.findings if one.level != "info" and one.cell]


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        "Mean",
        "mean:",
        "TOTAL",
        "Sum",
        "Σ",
        "Ø",
        "Average",
        "Min",
        "max",
        "Std. dev.",
        "Summe",
        "Mittelwert",
        "Moyenne",
        "Anzahl",
    ],
)
def test_a_total_is_no_variant(book, name):
    """A row of sums or means lacks a material and is one warning; the variants are computed."""
    for row in ([name, None, 850, 160, 80, 1.6, None, 40], [None, name, 850, 160, 80], [name, None, 1700]):
        outcome, found = _checked(book, row)
        assert [code for code, _ in found] == ["W433"], row
        assert (outcome.counts["rows"], outcome.counts["computed"], outcome.exit_code) == (2, 2, 0)


@pytest.mark.slow
@pytest.mark.parametrize(
    "row",
    [
        ["Prepared by ACME, 2026-11-01"],
        ["Note: torque is the peak torque of the duty cycle"],
        ["* measured in 2025"],
        ["All lengths after grinding and hardening"],
        ["Legend:"],
        ["© ACME"],
        ["Erstellt: Müller"],
    ],
)
def test_a_remark_is_no_variant(book, row):
    """An author's line, a note or a legend below the table is one warning, directly below it or apart."""
    for rows in ([row], [[], row]):
        outcome, found = _checked(book, *rows)
        assert [code for code, _ in found] == ["W433"]
        assert (outcome.counts["computed"], outcome.exit_code) == (2, 0)


def test_a_legend_of_several_rows(book):
    """Each row of a legend is told once, and none is a variant."""
    outcome, found = _checked(book, [], ["Legend:"], ["r_m"], ["wall"])
    assert found == [("W433", f"A{row}") for row in (5, 6, 7)]
    assert outcome.exit_code == 0


@pytest.mark.parametrize("row", [["H3"], ["H3", "20Cr2Ni4"], ["H3", None, None, None, None, None, "not yet"]])
def test_a_variant_without_numbers_is_one_error(book, row):
    """A variant that was begun and forgotten is told once, by its name, and not cell by cell."""
    outcome, found = _checked(book, row)
    assert found == [("E217", "A4")]
    assert (outcome.counts["rows"], outcome.counts["computed"], outcome.exit_code) == (3, 2, 3)


@pytest.mark.parametrize(
    ("row", "code"),
    [
        (["Mean", "20Cr2Ni4", 800, 160, 80, 1.6, None, 40], None),
        (["Design for the new gearbox", "20Cr2Ni4", 800, 160, 80, 1.6, None, 40], None),
        (["Design for the new gearbox", "20Cr2Ni4"], "E217"),
        (["H3", "20Cr2Ni4", 800], "E201"),
        (["H3", "20Cr2Ni4", "800 Nm", "160 mm", "80 mm", "1.6 mm", None, "40 mm"], "E202"),
        (["Meanwhile", None, 850, 160, 80, 1.6, None, 40], "E201"),
    ],
)
def test_what_is_an_entry(book, row, code):
    """A complete row is a variant whatever its name, and a row with values keeps its own findings."""
    _, found = _checked(book, row)
    codes = {one for one, _ in found}
    assert code in codes if code else not codes
    assert "W433" not in codes


def test_remarks_below_the_other_tables(book):
    """Materials, Tolerances and Settings may have notes below them as well."""
    outcome, found = _checked(
        book,
        Materials=[["Material", "Shear modulus G [GPa]"], ["20Cr2Ni4", 81], [], ["Source: certificate 4711"]],
        Tolerances=[["Tolerance class", "Dimension", "Grade"], ["standard", "wall_thickness", "IT7"], ["Note: agreed"]],
        Settings=[["Setting", "Value"], ["seed", 3], [], ["Remark: default otherwise"]],
    )
    assert [code for code, _ in found] == ["W433"] * 3
    assert (outcome.exit_code, outcome.settings.seed) == (0, 3)
